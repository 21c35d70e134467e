// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// One policy per program (THERMOPOWER_POLICY), so that its flash and RAM can be told from the size of the
// program. The work is marked in GPIOR0: 1 begins, 2 ends; 3 says that all is done. GPIOR1 says that a step was
// refused, which costs less than one that is not. Inputs come from volatile memory and change from call to call.

#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/interrupt.h>

#include <thermopower/actuator/cached_current.hpp>
#include <thermopower/actuator/observer_thermal.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/power_up.hpp>
#include <thermopower/control/adaptive_holding_law.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/axis_controller.hpp>
#include <thermopower/control/eased_gain.hpp>
#include <thermopower/control/node_limiter.hpp>
#include <thermopower/control/reserve_law.hpp>
#include <thermopower/control/sag_aware_law.hpp>
#include <thermopower/control/voltage_gain.hpp>
#include <thermopower/detail/flash.hpp>

using namespace thermopower;

namespace {

volatile float error_deg = 0.7f, supply_V = 12.6f, air_C = 24.0f, heat_W = 6.0f, winding_C = 58.0f,
               body_C = 52.0f, current_A = 0.8f;
volatile float cycle_s = 0.01f;
volatile uint8_t demand = 200, result;
volatile uint16_t call;

inline TwoNodeThermalModel<float>::Config constants() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }

struct Motor {
  typedef CachedCurrent<OhmicCurrent<float>> Current;
  typedef ObservedThermal Thermal;
  static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
  static SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() {
    return {TemperatureObserverConfig::standard(constants()), 110.0f, 1, 0};
  }
};

inline CertifiedUse use() {
  const Bounds ohm = {7.6f, 8.4f}, tempco = {0.0038f, 0.0040f};
  return {HeatBounds::ohmic(13.0f, 0.02f, ohm, tempco, 20.0f, 0.0f, 110.0f, 9.0f), 35.0f, 0.1f, 30.0f, 1, 0};
}
inline CertifiedLimiter<>::Config bounds() {
  return {CertifiedTwoNode::Config::around(constants(), 0.1f, 110.0f, 60.0f), use(), 5.0f};
}

inline TemperatureObserver new_observer() {
  return TemperatureObserver(TemperatureObserverConfig::standard(constants()), 110.0f, 25.0f);
}

inline WindingResistance::Config copper() {
  WindingResistance::Config config = WindingResistance::Config::standard();
  config.resistance_ohm = 8.0f;
  return config;
}

inline GuardedCelsius told(float temperature_C) { return GuardedCelsius::unchecked(temperature_C); }
inline AxisFacts known() {
  const AxisFacts facts = {demand, told(winding_C),  told(body_C), 0.0f, air_C, supply_V, 0.0f,
                           0.0f,   LimitReason::none};
  return facts;
}

}  // namespace

#if THERMOPOWER_POLICY == 0  // nothing: what the markers, the loop and the inputs cost
static void work() { result = demand; }
#elif THERMOPOWER_POLICY == 1
static StepPowerLaw<> law;
static void work() { result = law.step(error_deg); }
#elif THERMOPOWER_POLICY == 2
static AdaptiveHoldingLaw<8> law;
static void work() {
  const AxisFacts facts = known();
  result = law.step(error_deg * 0.2f, facts, cycle_s);
}
#elif THERMOPOWER_POLICY == 3
static SagAwareLaw<> law;
static void work() {
  const AxisFacts facts = known();
  result = law.step(error_deg, facts, cycle_s);
}
#elif THERMOPOWER_POLICY == 4
static SafetyLimiter<> limiter;
static void work() {
  const SafetyLimiter<>::Inputs inputs = {demand, told(winding_C), 0.01f};
  result = limiter.step(inputs, cycle_s).power;
}
#elif THERMOPOWER_POLICY == 5
static NodeLimiter limiter;
static void work() {
  const NodeLimiter::Inputs inputs = {demand, told(winding_C), told(body_C), air_C};
  result = limiter.step(inputs, cycle_s).power;
}
#elif THERMOPOWER_POLICY == 6
static CertifiedLimiter<CertifiedOneNode> limiter({{{8.0f, 12.0f}, 0.18f, 60.0f}, use(), 5.0f});
static void work() {
  const CertifiedLimiter<CertifiedOneNode>::Inputs inputs = {demand, supply_V, air_C};
  result = limiter.step(inputs, cycle_s).power;
}
#elif THERMOPOWER_POLICY == 7
static CertifiedLimiter<> limiter(bounds());
static void work() {
  const CertifiedLimiter<>::Inputs inputs = {demand, supply_V, air_C};
  result = limiter.step(inputs, cycle_s).power;
}
#elif THERMOPOWER_POLICY == 8
static CertifiedLimiter<> limiter(bounds());
static void work() {  // a loop that is never the same length
  const CertifiedLimiter<>::Inputs inputs = {demand, supply_V, air_C};
  result = limiter.step(inputs, cycle_s + 1.0e-5f * static_cast<float>(call & 15)).power;
}
#elif THERMOPOWER_POLICY == 9
static TwoNodeThermalModel<float> model(constants(), 25.0f);
static void work() {
  const TwoNodeThermalModel<float>::Inputs inputs = {heat_W, 0.0f, {air_C, 0.0f}};
  const float dt_s = cycle_s;
  model.step(inputs, dt_s);
}
#elif THERMOPOWER_POLICY == 10
static TemperatureObserver observer = new_observer();
static void work() { observer.step(heat_W, air_C, cycle_s); }
#elif THERMOPOWER_POLICY == 11
static TemperatureObserver observer = new_observer();
static WindingResistance winding(copper());
static void work() { result = observer.correct_winding(winding, 8.0f, current_A) ? 1 : 0; }
#elif THERMOPOWER_POLICY == 12
static GainScheduler<> gain(GainConfig{20.0f, 4.0f});
static void work() { result = gain.step(demand); }
#elif THERMOPOWER_POLICY == 13
static VoltageGain gain({60.0f, 100, 13.0f, 25.0f, 0.00393f, 0.0011f, 255});
static void work() {
  const AxisFacts facts = known();
  result = gain.step(demand, facts);
}
#elif THERMOPOWER_POLICY == 14
static uint8_t bytes[StoredState::size()];
static void work() {
  StoredState state = {winding_C, body_C, winding_C, body_C, heat_W, 1.0f, 0, call};
  state.write(bytes);
  result = state.read(bytes) ? 1 : 0;
}
#elif THERMOPOWER_POLICY == 15
static ReserveLaw<AdaptiveHoldingLaw<8>> law;
static void work() {
  const AxisFacts facts = known();
  result = law.step(error_deg * 0.2f, facts, cycle_s);
}
#elif THERMOPOWER_POLICY == 16
static EasedGain<VoltageGain> gain({{60.0f, 100, 13.0f, 25.0f, 0.00393f, 0.0011f, 255}, 1.5f, 3});
static void work() {
  AxisFacts facts = known();
  facts.error_deg = 4.0f * error_deg;
  result = gain.step(demand, facts);
}
#elif THERMOPOWER_POLICY == 17
static CertifiedLimiter<CertifiedCoupledTwoNode> limiter({{bounds().network, 1.1f}, use(), 5.0f});
static void work() {
  const CertifiedLimiter<CertifiedCoupledTwoNode>::Inputs inputs = {demand, supply_V, air_C};
  result = limiter.step(inputs, cycle_s).power;
}
#elif THERMOPOWER_POLICY == 18 || THERMOPOWER_POLICY == 19
static CertifiedLimiter<CertifiedChain<3>>::Config chain() {
  CertifiedLimiter<CertifiedChain<3>>::Config config = {{}, use(), 5.0f};
  const CertifiedChainNode nodes[3] = {
      {{7.2f, 8.8f}, 0.9f, 110.0f}, {{36.0f, 44.0f}, 1.8f, 80.0f}, {{72.0f, 88.0f}, 0.18f, 60.0f}};
  for (uint8_t k = 0; k < 3; ++k) config.network.nodes[k] = nodes[k];
  return config;
}
static CertifiedLimiter<CertifiedChain<3>> limiter(chain());
static void work() {  // of the second, no step is as long as another
  const CertifiedLimiter<CertifiedChain<3>>::Inputs inputs = {demand, supply_V, air_C};
  const float more_s = THERMOPOWER_POLICY == 19 ? 1.0e-5f * static_cast<float>(call & 15) : 0.0f;
  result = limiter.step(inputs, cycle_s + more_s).power;
}
#else                         // the whole: three axes, each with observer and certified limiter
struct GainTable {
  static const uint8_t entries[2] thermopower_flash;
  static constexpr uint8_t size() { return 2; }
  static const uint8_t* gains() { return entries; }
};
const uint8_t GainTable::entries[2] thermopower_flash = {24, 2};
typedef AxisController<Motor, StepPowerLaw<>, CertifiedLimiter<>, GainScheduler<TableGain<GainTable>>> Axis;
// What docs/explain/certified-limiter.md says of an axis's RAM.
static_assert(sizeof(Axis) == 454, "an axis");
static_assert(sizeof(CertifiedLimiter<>) == 182 && sizeof(CertifiedTwoNode) == 118,
              "its limiter, and the bounds in it");
static_assert(sizeof(Motor::Thermal) == 186 && sizeof(TemperatureObserver) == 151, "and the observer");
static_assert(sizeof(Motor::Current) == 23 && sizeof(Axis::State) == 29, "its current; what it logs");
// Temperatures move in seconds: each axis observes in one of its steps of `every`, plans in the next and
// measures in a third.
static const uint8_t every = THERMOPOWER_POLICY == 21 ? 9 : 3;
static Axis::Config axis_config(uint8_t axis) {
  Axis::Config config = Axis::Config::standard();
  config.limiter = bounds();
  config.limiter.use.every = config.thermal.every = every;
  config.limiter.use.phase = THERMOPOWER_POLICY == 21 ? static_cast<uint8_t>(3 * axis) : 0;
  config.thermal.phase = static_cast<uint8_t>(config.limiter.use.phase + 1);
  return config;
}
// Made one after the other: three configurations at once would fill the stack of a chip with 2 KB.
static Axis roll(axis_config(0)), pitch(axis_config(1)), yaw(axis_config(2));
static WindingResistance winding(copper());
static void step(Axis& axis, float dt_s) {
  const Axis::Inputs inputs = {error_deg, supply_V, air_C, LimitReason::none};
  const Axis::State& state = axis.step(inputs, dt_s);
  result = state.power;
  if (is_fault(state.reason)) GPIOR1 = 1;
}
static MeasuredTemperature measured = MeasuredTemperature::unchecked(NAN, 1.0f, 0.0f);
static void measure(const Axis& axis) {
  measured = winding.measure(8.0f, current_A, axis.thermal().observer().state().winding_C);
}
static void correct(Axis& axis) {
  if (axis.thermal().observer().is_carrying()) return;  // in its next turn
  if (measured.is_valid) axis.thermal().observer().correct_winding(measured);
  measured.is_valid = false;
}
static Axis& axis_of(uint8_t index) { return index == 0 ? roll : (index == 1 ? pitch : yaw); }
#if THERMOPOWER_POLICY == 21  // all three in every cycle of 10 ms
static void work() {
  step(roll, cycle_s);
  step(pitch, cycle_s);
  step(yaw, cycle_s);
  // Every third cycle is left for this by plans and observers: in one an axis is read, in the next the reading
  // is taken in. So each is measured every 270 ms, and no cycle does more than one of all that there is to do.
  static uint8_t turn = 0;
  Axis& axis = axis_of(static_cast<uint8_t>(turn / 9));
  if (turn % 9 == 0) measure(axis);
  if (turn % 9 == 3) correct(axis);
  turn = static_cast<uint8_t>(turn < 26 ? turn + 1 : 0);
}
#else  // one in every cycle of 10 ms, in turn: each axis every 30 ms, as the original program
static void work() {
  Axis& axis = axis_of(static_cast<uint8_t>(call % 3));
  step(axis, 3.0f * cycle_s);
  if ((call / 3) % 3 == 0) {
    measure(axis);
    correct(axis);
  }
}
#endif
#endif

int main() {
  for (uint16_t i = 0; i < 600; ++i) {
    call = i;
    // Demands that come and go, an error that moves, a supply that no two cycles read alike, air that warms.
    demand = (i & 16) != 0 ? 250 : static_cast<uint8_t>(20 + (i & 15));
    error_deg = 0.05f * static_cast<float>(i & 31);
    supply_V = 13.0f - 0.002f * static_cast<float>(i) + ((i & 1) != 0 ? 0.01f : 0.0f);
    if ((i & 63) == 0) air_C = 24.0f + 0.01f * static_cast<float>(i);
    winding_C = 40.0f + 0.05f * static_cast<float>(i);
    body_C = 35.0f + 0.04f * static_cast<float>(i);
    current_A = 8.0f / (8.0f + 0.01f * static_cast<float>(i & 127));
    GPIOR0 = 1;
    work();
    GPIOR0 = 2;
  }
  GPIOR0 = 3;
  cli();
  for (;;) sleep_mode();
}
