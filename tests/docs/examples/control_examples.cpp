// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the control's classes, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/thermopower.hpp>

#include <cmath>
#include <string>

namespace tp = thermopower;

namespace {

struct Motor {
  typedef tp::CurrentModel<tp::OhmicCurrent<>> Current;
  typedef tp::TwoNodeThermalModel<> Thermal;
  static Current::Config current() { return {6.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
};

//! [gain table]
struct TunedGains {  // gains found at POWER 0, 85, 170 and 255
  static constexpr uint8_t size() { return 4; }
  static const uint8_t* gains() {
    static constexpr uint8_t list[4] thermopower_flash = {60, 40, 30, 25};
    return list;
  }
};
typedef tp::GainScheduler<tp::TableGain<TunedGains>> Tuned;
//! [gain table]

struct Port {  // stands in for Serial
  std::string text;
  size_t write(const uint8_t* bytes, size_t count) {
    text.append(reinterpret_cast<const char*>(bytes), count);
    return count;
  }
};

struct Fan {  // its decisions, apart from its pins
  struct Told {
    uint16_t passed_ms, heat_counts;
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.passed_ms, self.heat_counts);
    }
  };
  struct Answered {
    uint8_t power;
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.power);
    }
  };
  Answered step(const Told& told) {
    warmth += told.heat_counts / 1023.0f - 0.001f * told.passed_ms * warmth;
    return {static_cast<uint8_t>(warmth > 25.0f ? 250 : 10.0f * warmth)};
  }
  float warmth = 0.0f;
};

//! [recorded run]
// On the board, behind recorder.begin(Fan::Told(), Fan::Answered()):
void run(Fan& fan, tp::RunWriter<Port>& recorder, const Fan::Told& told) {
  recorder.step(told, fan.step(told));
}
// Anywhere:
bool is_same(const std::string& recording) {
  tp::RunReplay<Fan> replay;
  for (const char character : recording) replay.feed(character);
  const tp::RunReplayed result = replay.result();  // else: which step differs first, and how
  return result.is_identical();
}
//! [recorded run]

}  // namespace

TEST_CASE("an axis: a motor, a power law, a limiter, a gain") {
  //! [axis]
  typedef tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::GainScheduler<>> Axis;
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));  // P at the least and at full power
  if (tp::is_error(axis.validate())) return;          // names the first wrong field

  // Each cycle: error in degrees, supply in V, air in degC, no fault of the caller's; 30 ms.
  const Axis::State& state = axis.step({0.5f, 12.0f, 25.0f, tp::LimitReason::none}, 0.03f);
  // send state.power as POWER and state.p_gain as P; log state.motor_C and state.reason
  //! [axis]
  CHECK(state.power == 125);  // half of a degree is five of ten levels of 25
  CHECK(state.reason == tp::LimitReason::none);
}

TEST_CASE("power laws: levels, and the laws around them") {
  //! [power law]
  tp::StepPowerLaw<tp::HysteresisLevels>
      law;                               // or ProgrammedLevels (the default), PrintedLevels, ContinuousPower
  const uint8_t half = law.step(0.55f);  // degrees of error; a degree is worth full power
  const uint8_t same = law.step(0.49f);  // below the level's edge, by less than the hysteresis
  //! [power law]
  CHECK(half == 125);
  CHECK(same == 125);

  //! [power law rules]
  tp::StepPowerLaw<tp::ProgrammedLevels> levels;     // 25, 50 .. 250
  tp::StepPowerLaw<tp::PrintedLevels> printed;       // none below a tenth of the full error: the least
  tp::StepPowerLaw<tp::ContinuousPower> continuous;  // in proportion, no steps
  //! [power law rules]
  CHECK(levels.step(0.05f) == 25);
  CHECK(printed.step(0.05f) == tp::least_power());
  CHECK(continuous.step(0.55f) == Approx(0.55 * 250.0).margin(1.0));

  //! [axis facts]
  tp::AxisFacts facts = tp::AxisFacts::unknown();  // what an axis tells its policies; say what you know
  facts.last_reason = tp::LimitReason::none;
  facts.supply_V = 13.0f;
  //! [axis facts]
  //! [level scale]
  tp::LevelScale scale;  // what a rule of levels remembers
  const uint8_t level = scale.level(0.55f, tp::StepPowerConfig::standard(), 10);
  //! [level scale]
  CHECK(level == 5);
  //! [reserve law]
  tp::ReserveLaw<tp::StepPowerLaw<>> reserve;  // 50 counts of reserve while the axis is being disturbed
  for (int i = 0; i < 20; ++i) reserve.step(0.5f, facts, 0.03f);  // a gust
  const uint8_t after = reserve.step(0.01f, facts, 0.03f);        // over; the next one finds the reserve
  //! [reserve law]
  CHECK(after >= 50);

  //! [sag-aware law]
  tp::SagAwareLaw<tp::StepPowerLaw<>> sag;  // tuned at 13 V, corrected down to 9 V
  facts.supply_V = 11.0f;
  const uint8_t corrected = sag.step(0.5f, facts, 0.03f);  // as many watts as 125 at 13 V
  //! [sag-aware law]
  CHECK(corrected == std::lround(125.0 * (13.0 / 11.0) * (13.0 / 11.0)));

  //! [holding law]
  tp::AdaptiveHoldingLaw<8> holding;  // eight ranges of poses, each with a memory
  facts.pose_deg = 30.0f;  // where the axis stands: AxisController::step(inputs, pose_deg, dt_s) tells it
  for (int i = 0; i < 100; ++i)
    holding.step(0.3f, facts, 0.03f);  // an error stands: it learns what holding takes
  const float learned = holding.learned_power(holding.state().bin);
  //! [holding law]
  CHECK(learned > 10.0f);
}

namespace {
//! [air range]
struct Indoors : Motor {
  // What reads otherwise is no air; what reads so says that the thermometer lives, and 35 counts.
  static tp::AirRange air() { return {15.0f, 35.0f}; }
};
//! [air range]
}  // namespace

TEST_CASE("the range of the air") {
  typedef tp::AxisController<Indoors, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> Axis;
  Axis axis;
  CHECK(axis.step({0.5f, 12.0f, 25.0f, tp::LimitReason::none}, 0.03f).reason == tp::LimitReason::none);
  CHECK(axis.step({0.5f, 12.0f, 0.0f, tp::LimitReason::none}, 0.03f).reason ==
        tp::LimitReason::air_implausible);
  //! [air bound]
  Axis told;  // this one is told a bound, such as AirTemperature gives, and believes it
  told.step({0.5f, 12.0f, tp::AxisAirCelsius::bound(20.0f), tp::LimitReason::none}, 0.03f);
  //! [air bound]
  CHECK(told.state().motor_C == Approx(20.0f).margin(0.01));
  Axis read;
  CHECK(read.step({0.5f, 12.0f, 20.0f, tp::LimitReason::none}, 0.03f).motor_C == Approx(35.0f).margin(0.01));
}

namespace {
//! [step time]
struct InALoop : Motor {
  static tp::StepTime step_time() {
    return {0.01f};
  }  // of a loop of 30 ms; 3 ms is a wrong unit, or a wrong clock
};
//! [step time]
}  // namespace

TEST_CASE("the shortest step") {
  tp::AxisController<InALoop, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> axis;
  CHECK(axis.step({0.5f, 12.0f, 25.0f, tp::LimitReason::none}, 0.03f).reason == tp::LimitReason::none);
  CHECK(axis.step({0.5f, 12.0f, 25.0f, tp::LimitReason::none}, 0.003f).reason ==
        tp::LimitReason::time_invalid);
}

TEST_CASE("the range of a supply") {
  typedef tp::AxisController<Motor> Axis;
  //! [supply range]
  const tp::SupplyRange supply = {11.0f,
                                  12.6f};  // three cells, empty and full; what reads otherwise is no supply
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}, supply));
  const tp::LimitReason open_pin = axis.step({0.5f, 0.0f, 25.0f, tp::LimitReason::none}, 0.03f).reason;
  //! [supply range]
  CHECK(open_pin == tp::LimitReason::supply_low);
}

TEST_CASE("limiters: the ceiling, the nodes, the sensor, and all of them") {
  //! [safety limiter]
  tp::SafetyLimiter<tp::PerSecond> limiter;  // 60 degC, 30 s: eq 4.23. PerCycle moves by a count per call
  const tp::ThermalModel<> motor({{18.0f}, {0.05f}}, 61.0f);  // its estimate; of a sensor: SensorGuard
  const tp::LimitedPower granted =
      limiter.step({200, tp::GuardedCelsius::hottest_of(motor), 0.1f}, 0.03f);  // demand, degC, K/s; s
  // granted.power, and granted.reason where that is less than the demand
  //! [safety limiter]
  CHECK(granted.power == tp::least_power());
  CHECK(granted.reason == tp::LimitReason::over_temperature);
  tp::SafetyLimiter<tp::PerCycle> programmed;
  // 50 + 30 s * 1 K/s is above 60: a count down
  CHECK(programmed.step({255, tp::GuardedCelsius::unchecked(50.0f), 1.0f}, 0.03f).power == 254);

  //! [node limiter]
  tp::NodeLimiter::Config config = tp::NodeLimiter::Config::standard();
  config.node[tp::NodeLimiter::bracket] = {55.0f,
                                           0.7f};  // softens at 55 degC; 70 % of the way from air to body
  tp::NodeLimiter nodes(config);
  const tp::GuardedCelsius winding_C = tp::GuardedCelsius::unchecked(70.0f);  // or from a model, or a guard
  const tp::GuardedCelsius body_C = tp::GuardedCelsius::unchecked(62.0f);
  const tp::LimitedPower given = nodes.step({255, winding_C, body_C, 25.0f}, 0.03f);
  // nodes.state().node is the part that is nearest to its limit
  //! [node limiter]
  CHECK(nodes.state().node == tp::NodeLimiter::bracket);
  const double margin_K = 55.0 - (25.0 + 0.7 * (62.0 - 25.0));
  CHECK(given.power == static_cast<int>(1.0 + std::floor(254.0 * margin_K / 8.0)));

  //! [sensor guard]
  tp::SensorGuard guard;                                                         // a thermistor on a housing
  const tp::TwoNodeThermalModel<> model({120.0f, 900.0f, 1.9f, {0.8f}}, 30.0f);  // not corrected by it
  const tp::GuardedCelsius housing_C = guard.step({29.5f, model.state().body_C}, 0.1f);
  const tp::GuardedCelsius torn_C = guard.step({-88.6f, model.state().body_C}, 60.0f);
  const tp::MeasuredTemperature for_observer =
      guard.measured(0.5f, 1.0f);  // not valid while the cable is torn
  // torn_C is NaN, and torn_C.reason() says why; every limiter answers it with the least power
  //! [sensor guard]
  CHECK(housing_C == 29.5f);
  CHECK(std::isnan(torn_C));
  CHECK_FALSE(for_observer.is_valid);
  CHECK(torn_C.reason() == tp::LimitReason::sensor_out_of_range);

  //! [sensor limiter]
  tp::SensorLimiter sensor;  // no power without a measurement in ten seconds
  const uint8_t unmeasured = sensor.step({200}, 0.03f).power;
  sensor.measured();  // an observer believed one
  const uint8_t measured = sensor.step({200}, 0.03f).power;
  //! [sensor limiter]
  CHECK(unmeasured == tp::least_power());
  CHECK(measured == 200);

  //! [limiter chain]
  typedef tp::LimiterChain<tp::SensorLimiter, tp::NodeLimiter> Limiter;  // the strictest wins
  typedef tp::AxisController<Motor, tp::StepPowerLaw<>, Limiter, tp::NoGain> Axis;
  Axis::Config chained = Axis::Config::standard();
  chained.limiter.first =
      tp::SensorLimiter::Config::standard();  // a LimiterChainConfig: the first limiter's,
  chained.limiter.rest.first = config;        // the second's
  Axis axis(chained);
  axis.limiter().limiter<0>().measured();
  const Axis::State& state = axis.step({0.5f, 12.0f, 25.0f, tp::LimitReason::none}, 0.03f);
  //! [limiter chain]
  CHECK(axis.validate() == tp::ConfigError::none);
  CHECK(state.power == 125);
}

TEST_CASE("the certified limiter: bounds instead of constants") {
  //! [certified two nodes]
  typedef tp::CertifiedLimiter<tp::CertifiedTwoNode> Limiter;
  Limiter::Config config = Limiter::Config::standard();
  config.network =
      tp::CertifiedTwoNode::Config::around(Motor::thermal(), 0.1f, 110.0f, 60.0f);  // each to 10 %
  config.use.heat = tp::HeatBounds::ohmic(12.6f, 0.02f, tp::Bounds::around(6.0f, 0.05f), {0.0038f, 0.0040f},
                                          20.0f, 0.0f, 110.0f);  // V, share, ohm, 1/K, at, coldest air, limit
  config.use.highest_air_C = 35.0f;
  Limiter limiter(config);
  if (tp::is_error(limiter.validate())) return;
  limiter.start(25.0f, 25.0f);                                               // never below the truth
  const tp::LimitedPower granted = limiter.step({255, 12.0f, 25.0f}, 0.1f);  // demand, supply, air
  // limiter.state(): the upper bounds, the power that is bearable for ever, the time to the limit
  //! [certified two nodes]
  REQUIRE(limiter.validate() == tp::ConfigError::none);
  CHECK(granted.power > limiter.state().sustainable);
  CHECK(limiter.state().is_certified);

  //! [certified bounds]
  tp::CertifiedUse use = config.use;  // what the network is told of its surroundings
  use.hold_s = 0.1f;                  // a plan at least this often
  use.horizon_s = 60.0f;              // authority falls over a minute
  tp::CertifiedTwoNodeConfig network = config.network;
  network.least_conductance_W_per_K = 0.15f;  // dust: it may lose less than 10 % below what was measured
  //! [certified bounds]
  config.use = use;
  config.network = network;
  CHECK(config.validate() == tp::ConfigError::none);
  CHECK(Limiter(config).state().sustainable < limiter.state().sustainable);

  //! [certified coupled]
  // It is also known that winding and body are coupled by no more than 1.4 W/K: more power for the same safety.
  typedef tp::CertifiedLimiter<tp::CertifiedCoupledTwoNode> Coupled;
  tp::CertifiedCoupledTwoNodeConfig both_ends = {config.network, 1.4f};  // INFINITY where nothing is known
  Coupled coupled({both_ends, use, 5.0f});
  //! [certified coupled]
  CHECK(coupled.validate() == tp::ConfigError::none);
  CHECK(coupled.state().sustainable >= Limiter(config).state().sustainable);

  //! [certified one node]
  typedef tp::CertifiedLimiter<tp::CertifiedOneNode, tp::SquareHeat> OneNode;  // or LinearHeat, of Ohm's law
  OneNode::Config one = OneNode::Config::standard();
  one.network = {tp::Bounds::around(88.0f, 0.1f), 0.18f, 60.0f};  // J/K; W/K at least; limit
  one.use = use;
  one.use.heat = tp::HeatBounds::ohmic(12.6f, 1.0f, {5.7f, 6.3f}, {0.0038f, 0.0040f}, 20.0f, 0.0f, 60.0f);
  OneNode small(one);
  //! [certified one node]
  CHECK(small.validate() == tp::ConfigError::none);
  CHECK(tp::LinearHeat::count(128) == 128);
  CHECK(tp::SquareHeat::count(128) == std::ceil(128.0 * 128.0 / 255.0));

  //! [certified chain]
  typedef tp::CertifiedLimiter<tp::CertifiedChain<3>> Chain;  // winding, housing, bracket
  Chain::Config three = Chain::Config::standard();
  three.network.nodes[0] = {
      {4.0f, 5.0f}, 0.5f, 120.0f};  // each a CertifiedChainNode: J/K, W/K onwards, limit
  three.network.nodes[1] = {{20.0f, 25.0f}, 0.3f, 90.0f};
  three.network.nodes[2] = {{60.0f, 75.0f}, 0.2f, 60.0f};  // to the air
  three.use = use;
  Chain chain(three);
  //! [certified chain]
  CHECK(chain.validate() == tp::ConfigError::none);
  const tp::CertifiedChainNode last = three.network.nodes[2];
  CHECK(last.maximum_C == 60.0f);

  //! [certified measurement]
  // A reading, and its largest error: the bounds come down to it.
  limiter.tighten(tp::GuardedCelsius::unchecked(30.0f + 2.0f), tp::GuardedCelsius::unchecked(28.0f + 2.0f));
  limiter.step({1, 12.0f, 25.0f}, 0.1f);
  //! [certified measurement]
  CHECK(limiter.winding_upper_C() <= 33.0f);
}

TEST_CASE("parts of a certified network, for one of one's own") {
  //! [certified parts]
  // How far a bound goes in 0.1 s towards where it settles, at rates between 0.05 and 0.08 per second:
  const tp::CertifiedTravel travel = tp::CertifiedTravel::over(0.08f, 0.05f, 0.1f);
  // the same in whole numbers: a third of a hold that is 0.8 of the time constant long, rates up to 1/2 slower,
  tp::CertifiedPace pace;
  pace.set(0.8f);
  const tp::CertifiedTravel third = pace.over(21846, 32768);
  // what a warm winding draws less,
  tp::CertifiedRelief relief;
  relief.set(tp::HeatBounds::ohmic(12.0f, 1.0f, {5.4f, 6.6f}, {0.0038f, 0.0040f}, 20.0f, 0.0f, 110.0f),
             110.0f, 110.0f);
  // and how many counts of a size fit into what is left.
  tp::CertifiedCount largest = {254, tp::CertifiedNode::none, 0};
  largest.fit(1000, 10, tp::CertifiedNode::body);
  // What was measured at one instant, or NaN:
  const tp::CertifiedMeasurement measured = {61.0f, std::nanf("")};
  //! [certified parts]
  CHECK(travel.heating > travel.cooling);
  CHECK(third.heating > third.cooling);
  CHECK(relief.at(50 * 262144) < relief.at(0));
  CHECK(largest.count == 100);
  CHECK(largest.node == tp::CertifiedNode::body);
  CHECK(measured.is_any());
}

TEST_CASE("gains: a line, a table, the voltage, and none") {
  //! [gain scheduler]
  tp::GainScheduler<tp::RoundedGain> gain({24.0f, 4.0f});  // P at POWER 0 and at 255, eq 4.27
  tp::GainScheduler<tp::TruncatedGain> as_programmed({24.0f, 4.0f});
  const uint8_t p_gain = gain.step(100), cut = as_programmed.step(100);
  //! [gain scheduler]
  const double exact = 24.0 - 20.0 * 100.0 / 255.0;
  CHECK(p_gain == std::lround(exact));
  CHECK(cut == std::floor(exact));
  CHECK(Tuned().step(85) == 40);
  CHECK(Tuned().step(255) == 25);

  tp::AxisFacts facts = tp::AxisFacts::unknown();
  //! [voltage gain]
  tp::VoltageGain::Config config = tp::VoltageGain::Config::standard();
  config.gain_low_power = 40.0f;  // P where it was tuned: POWER 100, 13 V, 25 degC
  tp::BasicVoltageGain<tp::SwitchedDrive> voltage(
      config);  // VoltageGain; SineDrive where POWER scales a sine
  facts.supply_V = 11.0f;
  const uint8_t sagging = voltage.step(100, facts);
  //! [voltage gain]
  CHECK(sagging == std::lround(40.0 * 13.0 / 11.0));
  tp::BasicVoltageGain<tp::SineDrive>::Config amplitude =
      tp::BasicVoltageGain<tp::SineDrive>::Config::standard();
  amplitude.gain_low_power = 40.0f;
  const tp::BasicVoltageGain<tp::SineDrive> sine(amplitude);
  CHECK(sine.step(50) == 80);  // half the amplitude, twice the gain

  //! [eased gain]
  tp::EasedGain<tp::GainScheduler<>>::Config easing = tp::EasedGain<tp::GainScheduler<>>::Config::standard();
  easing.gain = {40.0f, 40.0f};
  tp::EasedGain<tp::GainScheduler<>> eased(
      easing);  // beyond 1.5 degrees gain times error stays what it was there
  facts.error_deg = 6.0f;
  const uint8_t far = eased.step(100, facts);
  //! [eased gain]
  CHECK(far == 10);

  //! [no gain]
  typedef tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> WithoutGain;
  //! [no gain]
  CHECK(WithoutGain().state().p_gain == 0);
}

TEST_CASE("a gimbal: several axes behind one board, its air, its supply, what is in force") {
  //! [gimbal]
  typedef tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> Axis;
  // GimbalController has NominalSupply; this one takes what the board measures.
  typedef tp::BasicGimbalController<tp::MeasuredSupply, Axis, Axis> Gimbal;
  Gimbal gimbal(tp::GimbalConfig::standard(), Axis::Config::standard(), Axis::Config::standard());
  // Each cycle: errors in degrees, both thermometers in degC, supply in V; or straight from sbgc::RealtimeData.
  const Gimbal::Command& command = gimbal.step({{0.5f, 0.1f}, 30.0f, 28.0f, 12.1f}, 0.03f);
  // command.power[0], command.power[1]; where nothing came: gimbal.step_silent(0.03f)
  //! [gimbal]
  CHECK(gimbal.validate().field == tp::ConfigError::none);
  CHECK(command.reason[0] != tp::LimitReason::supply_low);
  CHECK(tp::NominalSupply::supply_V(13.0f, 12.1f) == 13.0f);
  CHECK(tp::MeasuredSupply::supply_V(13.0f, 12.1f) == 12.1f);

  //! [air]
  // No air here is warmer than 35 degC. Both thermometers say 30 on average (eq 4.20), once they have moved; but nothing else does.
  tp::AirTemperature air(tp::AirTemperature::Config::declared(35.0f));
  air.step(30.0f, 28.0f, 1.0f);
  const tp::AirTemperature::State& now = air.step(31.0f, 29.0f, 1.0f);
  //! [air]
  CHECK(now.air_C == 35.0f);
  CHECK(now.read_C == 30.0f);
  CHECK(now.source == tp::AirSource::both);

  const float camera_C = 24.0f, frame_C = 24.5f, thermistor_C = 61.0f, loop_s = 0.1f;
  float air_C = 45.0f;
  air.step(camera_C, frame_C, loop_s);
  //! [air witness]
  tp::AirTemperature room(tp::AirTemperature::Config::declared(45.0f));
  tp::AirWitness witness;                               // its standard: 3 K, 1 K/min, 6 min
  tp::SensorGuard guard;                                // in front of the motor's thermistor
  tp::ThermalModel<> model({{18.0f}, {0.05f}}, 60.0f);  // stands in the air as read; nothing corrects it
  for (int cycle = 0; cycle < 20000; ++cycle) {         // half an hour, and some minutes
    const float heat_W = 0.05f * (61.0f - 24.25f);
    model.step({heat_W, 0.0f, {cycle == 0 ? 24.0f : room.state().read_C, 0.0f}}, loop_s);
    const tp::GuardedCelsius motor_C = guard.step({thermistor_C, model.hottest_C()}, loop_s);
    witness.step(motor_C, model.hottest_C(), loop_s);             // witness.state().reason: who disagrees
    air_C = room.step(camera_C, frame_C, witness, loop_s).air_C;  // for the limiter's own model
  }
  //! [air witness]
  CHECK(air_C == Approx(24.5f + 12.0f));  // the warmer reading and the margin
  CHECK(room.state().is_witnessed);

  //! [power in force]
  tp::PowerInForce<1> force;                     // one axis
  force.unheard(0, 200);                         // told 200, and nothing heard since:
  const uint8_t may_act = force.unheard(0, 10);  // told 10, but 200 may still act
  //! [power in force]
  CHECK(may_act == 200);
}

TEST_CASE("utilisation: how much of what an actuator bears is in use") {
  //! [utilisation]
  tp::UtilisationConfig limits = tp::UtilisationConfig::standard();
  limits.maximum_winding_C = 110.0f;
  limits.maximum_body_C = 60.0f;
  tp::Utilisation utilisation(limits);
  const tp::Utilisation::State& use = utilisation.step(60.0f, 55.0f, 25.0f);  // winding, body, air
  // use.percent, use.level: normal, warning from 85 %, error from 100 %
  //! [utilisation]
  CHECK(use.percent == Approx(100.0 * (55.0 - 25.0) / (60.0 - 25.0)));
  CHECK(use.level == tp::UtilisationLevel::warning);
}

TEST_CASE("what one tunes, stored as a record") {
  //! [config]
  tp::SafetyLimiterConfig tuned = tp::SafetyLimiterConfig::standard();
  tuned.maximum_C = 75.0f;
  tp::StepPowerConfig levels = tp::StepPowerConfig::standard();
  levels.full_power_error_deg = 2.0f;
  tp::GainConfig gains = tp::GainConfig::standard();  // no gain suits every rig: NaN, refused until it is set
  const tp::ConfigError unset = gains.validate();

  uint8_t bytes[64];
  const size_t size = tp::write_config(tuned, 1, bytes, sizeof bytes);
  tp::SafetyLimiterConfig found = tp::SafetyLimiterConfig::standard();
  const tp::ConfigRead read = tp::read_config(found, 1, bytes, size);
  //! [config]
  CHECK(unset == tp::ConfigError::gain_low_power);
  CHECK(levels.validate() == tp::ConfigError::none);
  CHECK(read.error == tp::ConfigRecordError::none);
  CHECK(found.maximum_C == 75.0f);

  //! [version]
  static_assert(tp::Version::major_number() == 0, "written for 0.x");
  //! [version]
}

TEST_CASE("a recorded run: what a firmware was told and answered, and the same again elsewhere") {
  Port port;
  Fan fan;
  tp::RunWriter<Port> recorder(port);
  recorder.begin(Fan::Told(), Fan::Answered());
  for (uint16_t i = 0; i < 100; ++i) run(fan, recorder, {20, static_cast<uint16_t>(i * 9)});
  CHECK(is_same(port.text));
  port.text[port.text.size() - 10] ^= 1;
  CHECK_FALSE(is_same(port.text));
}
