// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The examples on the pages of the actuator's classes, and what each of them must give.

#include "../../catch.hpp"

#include <thermopower/thermopower.hpp>

#include <cmath>
#include <cstring>

namespace tp = thermopower;

namespace {

/// Memory of a chip that keeps its bytes without power.
struct Eeprom {
  uint8_t bytes[1024];
  Eeprom() { std::memset(bytes, 0xff, sizeof bytes); }
  uint8_t read(size_t at) const { return bytes[at]; }
  void write(size_t at, uint8_t value) { bytes[at] = value; }
  bool is_ready() const { return true; }
};

constexpr tp::TwoNodeThermalModel<>::Config hoist() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }

}  // namespace

TEST_CASE("currents: a law, its model, and the model that remembers") {
  //! [current]
  const tp::OhmicCurrent<> copper = {12.0f, 0.00393f, 20.0f};  // ohm, 1/K, degC
  const tp::CurrentModel<tp::OhmicCurrent<>> current(copper);
  const auto cold = current.at_power(255.0f, 12.0f, 20.0f);  // full POWER, 12 V, a winding of 20 degC
  // cold.v_rms_V, cold.current_A, cold.winding_power_W
  //! [current]
  CHECK(cold.current_A == Approx(12.0 / 12.0));
  CHECK(cold.winding_power_W == Approx(12.0 * 12.0 / 12.0));

  //! [cached current]
  // In firmware: what has not changed since the last step is not computed again.
  tp::CachedCurrent<tp::OhmicCurrent<>> cached(copper);
  const float full_A = cached.at_power(255.0f, 12.0f, 20.0f).current_A;
  const float again_A = cached.at_power(255.0f, 12.0f, 20.0f).current_A;  // no root, no division
  //! [cached current]
  CHECK(full_A == Approx(1.0));
  CHECK(again_A == full_A);
}

TEST_CASE("currents: the thesis's polynomial, and its table in flash") {
  //! [thesis current]
  // I = m(V) T + base V^exponent, eq 4.2 and 4.3: constants in milliampere, as printed
  const auto law = tp::ThesisCurrent<>::from_milliampere(-0.0134f, 0.0156f, 0.0167f, 0.1551f, 3.4591f, 1.0f);
  const float measured_A = law.current_A(9.2f, 40.0f);  // at 9.2 V and 40 degC
  //! [thesis current]
  CHECK(measured_A == Approx(1e-3 * ((-0.0134 * 9.2 * 9.2 + 0.0156 * 9.2 + 0.0167) * 40.0 +
                                     0.1551 * std::pow(9.2, 3.4591))));

  //! [tabulated current]
  typedef tp::motors::Bgm2606_90t Motor;
  const tp::TabulatedCurrent<tp::ThesisCurrentSource<Motor>>
      table;  // 65 nodes up to 16 V, made by the compiler
  const float by_table_A = table.current_A(9.2f, 40.0f), by_law_A = Motor::current().current_A(9.2f, 40.0f);
  //! [tabulated current]
  CHECK(by_table_A == Approx(by_law_A).margin(0.6e-3));
}

TEST_CASE("motors: the two of the thesis, with their constants") {
  //! [motors]
  typedef tp::motors::Bgm2606_90t Pitch;  // or tp::motors::Bgm5208_200_12, the yaw motor
  Pitch::Thermal motor(Pitch::thermal(), 25.0f);
  const Pitch::Current current(Pitch::current());
  for (int second = 0; second < 180; ++second) {  // three minutes at full POWER and 13 V
    const auto drawn = current.at_power(255.0f, 13.0f, motor.hottest_C());
    motor.step({drawn.winding_power_W, drawn.v_rms_V, {25.0f, 0.0f}}, 1.0f);
  }
  //! [motors]
  CHECK(motor.hottest_C() > 60.0f);  // Table 4.1: at its highest voltages it passes 70 degC within minutes

  typedef tp::motors::Bgm5208_200_12 Yaw;
  CHECK(Yaw::current().current_A(12.0f, 40.0f) > 0.0f);
}

TEST_CASE("one node: heating, cooling, and where it settles") {
  //! [thermal model]
  typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>> Thermal;  // the default laws
  Thermal motor({{18.0f}, {0.05f}}, 25.0f);  // 18 J/K, 0.05 W/K, starts at 25 degC
  for (int minute = 0; minute < 120; ++minute)
    motor.step({2.0f, 0.0f, {25.0f, 0.0f}}, 60.0f);  // 2 W, air 25 degC
  const float settled_C = motor.hottest_C();
  //! [thermal model]
  CHECK(settled_C == Approx(25.0 + 2.0 / 0.05));
}

TEST_CASE("air that is left out is not 0 degC") {
  //! [air left out]
  tp::ThermalModel<> motor({{18.0f}, {0.05f}}, 25.0f);
  motor.step(
      {2.0f, 0.0f, {}},
      1.0f);  // no air: its AirCelsius is NaN, and so is the temperature, which a limiter takes for hot
  const float unknown_C = motor.hottest_C();
  //! [air left out]
  CHECK(std::isnan(unknown_C));

  struct Motor {
    typedef tp::CurrentModel<tp::OhmicCurrent<>> Current;
    typedef tp::ThermalModel<> Thermal;
    static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
    static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
    static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
  };
  typedef tp::AxisController<Motor, tp::StepPowerLaw<>, tp::SafetyLimiter<>, tp::NoGain> Axis;
  Axis axis;
  const Axis::Inputs without_air = {0.5f, 12.0f, {}, tp::LimitReason::none};
  CHECK(axis.step(without_air, 0.03f).reason == tp::LimitReason::air_implausible);
  CHECK(axis.state().power == tp::least_power());
  // To the others air that is not known is the warmest there is: never more power than any air gives.
  tp::NodeLimiter nodes;
  const tp::GuardedCelsius winding_C = tp::GuardedCelsius::unchecked(90.0f),
                           body_C = tp::GuardedCelsius::unchecked(57.0f);
  CHECK(nodes.step({255, winding_C, body_C, {}}, 0.03f).power <=
        nodes.step({255, winding_C, body_C, 25.0f}, 0.03f).power);
  const tp::TwoNodeForecast forecast(hoist(), {60.0f, 50.0f, {}}, 5.0f);
  CHECK(std::isnan(forecast.seconds_to({100.0f, 60.0f})));
}

TEST_CASE("the thesis's laws of heating and cooling") {
  //! [thesis heating]
  // dT/dt = r P - k (T - T_air): r from the motor's own measurements, k per minute, eq 4.21 with Euler's step
  typedef tp::ThermalModel<tp::ThesisHeating<>, tp::RateCooling<>, tp::EulerStep> AsInTheThesis;
  AsInTheThesis motor({tp::ThesisHeating<>::per_minute(-0.0002f, 0.0062f, 0.0255f, -0.105f, 1.0f),
                       tp::RateCooling<>::per_minute(0.11f)},
                      60.0f);
  motor.step({0.0f, 0.0f, {25.0f, 0.0f}},
             0.03f);  // no power: it cools by 0.11 / 60 of the difference per second
  //! [thesis heating]
  CHECK(motor.state().cooling_K_per_s == Approx(0.11 / 60.0 * (60.0 - 25.0)));
  CHECK(motor.hottest_C() == Approx(60.0 - 0.03 * 0.11 / 60.0 * 35.0));
}

TEST_CASE("laws of cooling") {
  //! [cooling]
  const tp::NewtonCooling<> newton = {0.05f};                       // W/K
  const tp::NaturalConvection<> still_air = {0.05f, 0.25f, 40.0f};  // W/K at a difference of 40 K, exponent
  const tp::RadiationCooling<> radiation = {0.004f, 0.9f};          // m2, emissivity
  const tp::ForcedAirflow<> fan = {0.05f, 0.8f, 0.6f};  // W/K in still air, gain at 1 m/s, exponent
  const tp::SumOfCooling<tp::NaturalConvection<>, tp::RadiationCooling<>> both = {still_air, radiation};

  const tp::Surroundings<> around = {25.0f, 2.0f};  // air of 25 degC that moves with 2 m/s
  const float loss_W = both.loss_W(65.0f, around);
  //! [cooling]
  const double fourth = std::pow(65.0 + 273.15, 4) - std::pow(25.0 + 273.15, 4);
  CHECK(newton.loss_W(65.0f, around) == Approx(0.05 * 40.0));
  CHECK(still_air.loss_W(65.0f, around) == Approx(0.05 * 40.0));  // at its reference: as Newton's
  CHECK(radiation.loss_W(65.0f, around) == Approx(5.670374e-8 * 0.004 * 0.9 * fourth).epsilon(1e-4));
  CHECK(fan.loss_W(65.0f, around) == Approx(0.05 * (1.0 + 0.8 * std::pow(2.0, 0.6)) * 40.0));
  CHECK(loss_W == Approx(still_air.loss_W(65.0f, around) + radiation.loss_W(65.0f, around)));
}

TEST_CASE("steps: Euler's, the tangent's, and the exact one") {
  //! [steps]
  // dT/dt = -0.1 (T - 25) from 65 degC, over 10 s: as it begins, and as it goes on
  const float rate_K_per_s = -0.1f * (65.0f - 25.0f), slope_per_s = 0.1f;
  const float euler_K = tp::EulerStep::change_K(rate_K_per_s, slope_per_s, 10.0f);
  const float exact_K = tp::ExactStep::change_K(rate_K_per_s, slope_per_s, 10.0f);
  const float tangent_K = tp::LinearizedStep::change_K(rate_K_per_s, slope_per_s, 10.0f);  // of any law
  //! [steps]
  CHECK(euler_K == Approx(-40.0));
  CHECK(exact_K == Approx(40.0 * (std::exp(-1.0) - 1.0)));
  CHECK(tangent_K == exact_K);
}

TEST_CASE("two nodes: the winding is ahead of the body") {
  //! [two nodes]
  tp::TwoNodeThermalModel<> motor({8.0f, 80.0f, 1.0f, {0.2f}},
                                  25.0f);  // J/K, J/K, W/K, W/K; starts at 25 degC
  for (int second = 0; second < 60; ++second) motor.step({10.0f, 0.0f, {25.0f, 0.0f}}, 1.0f);  // 10 W
  // motor.state().winding_C, motor.state().body_C; motor.hottest_C() is what a limiter watches
  //! [two nodes]
  CHECK(motor.state().winding_C > motor.state().body_C + 5.0f);
  // What came in is in the two heat capacities, but for what the air took.
  const float stored_J = 8.0f * (motor.state().winding_C - 25.0f) + 80.0f * (motor.state().body_C - 25.0f);
  CHECK(stored_J < 600.0f);
  CHECK(stored_J > 600.0f - 60.0f * 0.2f * (motor.state().body_C - 25.0f));

  //! [forecast]
  // How long full heat is bearable from here, until the winding has 100 or the body 60 degC.
  const tp::TwoNodeForecast forecast(motor.config(), {motor.state().winding_C, motor.state().body_C, 25.0f},
                                     20.0f);
  const float bearable_s = forecast.seconds_to({100.0f, 60.0f});
  //! [forecast]
  motor.step({20.0f, 0.0f, {25.0f, 0.0f}}, bearable_s);
  const float left_K = std::fmin(100.0f - motor.state().winding_C, 60.0f - motor.state().body_C);
  CHECK(left_K == Approx(0.0).margin(0.1));
}

TEST_CASE("the observer: a model and what is measured") {
  //! [observer]
  // A temperature of the winding from what the driver measures anyway: voltage and current of the copper.
  tp::WindingResistance::Config copper = tp::WindingResistance::Config::standard();
  copper.resistance_ohm = 6.0f;  // at 20 degC
  const tp::WindingResistance winding(copper);

  // Nothing is known at first: the observer begins at the limit, 100 degC, and not sure.
  tp::TemperatureObserver observer(tp::TemperatureObserver::Config::standard(hoist()), 100.0f, 25.0f);
  for (int second = 0; second < 120; ++second) {
    observer.step(4.0f, 25.0f, 1.0f);               // 4 W in the winding, air of 25 degC, a second
    observer.correct_winding(winding, 6.0f, 0.9f);  // 6 V, 0.9 A
  }
  // observer.state().winding_C, and how sure: observer.winding_std_K()
  //! [observer]
  const double measured_C = 20.0 + (6.0 / 0.9 / 6.0 - 1.0) / 0.00393;
  CHECK(observer.state().winding_C ==
        Approx(measured_C).margin(static_cast<double>(3.0f * observer.winding_std_K())));
  CHECK(observer.winding_std_K() < 5.0f);
}

TEST_CASE("the observer in the place of a thermal model") {
  //! [observed thermal]
  // A motor type whose temperature is observed: for an AxisController in the place of TwoNodeThermalModel.
  struct Motor {
    typedef tp::CurrentModel<tp::OhmicCurrent<>> Current;
    typedef tp::ObservedThermal Thermal;
    static Current::Config current() { return {6.0f, 0.00393f, 20.0f}; }
    static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
    static Thermal::Config thermal() {
      return {tp::TemperatureObserverConfig::standard(hoist()), 100.0f, 1, 0};  // its limit; in every step
    }
  };
  tp::ObservedThermal thermal(Motor::thermal(), 40.0f);
  thermal.step({0.0f, 0.0f, {25.0f, 0.0f}}, 1.0f);
  const float sure_K = thermal.observer().winding_std_K();
  //! [observed thermal]
  CHECK(thermal.hottest_C() < 40.0f);
  CHECK(sure_K > 0.0f);
}

TEST_CASE("energy: a meter on each side of the bridge") {
  //! [energy]
  tp::EnergyMeter<tp::AtWinding> winding;  // V_rms I: what warms the motor
  tp::EnergyMeter<tp::AtSupply> supply;    // V_supply I: what the battery gives
  for (int second = 0; second < 60; ++second) {
    winding.step(6.0f, 12.0f, 0.5f, 1.0f);  // V_rms, V_supply, A, s
    supply.step(6.0f, 12.0f, 0.5f, 1.0f);
  }
  const float mean_W = winding.average_W(), drawn_J = supply.state().energy_J;
  //! [energy]
  CHECK(mean_W == Approx(6.0 * 0.5));
  CHECK(drawn_J == Approx(12.0 * 0.5 * 60.0));
}

TEST_CASE("what is kept over a loss of power, and what is made of it") {
  //! [journal]
  Eeprom eeprom;  // anything with read(at), write(at, byte)
  tp::StateJournal<Eeprom> journal(eeprom, tp::StateJournal<Eeprom>::Config::standard());
  const tp::StoredState now = {61.0f, 48.0f, 65.0f, 52.0f, 6.0f, 1.5f, tp::StoredState::no_clock(), 0};
  journal.step(now, 60.0f);  // once a second; writes only what has changed, at most once a minute

  tp::StoredState found;  // after the next power-up
  tp::StateJournal<Eeprom> next(eeprom, tp::StateJournal<Eeprom>::Config::standard());
  const bool has_stored = next.load(found);
  //! [journal]
  REQUIRE(has_stored);
  CHECK(found.winding_C == Approx(61.0).margin(0.011));

  //! [power-up]
  tp::PowerUpFacts facts = {has_stored, found, 120.0f, 25.0f, 2.0f, 40.0f, 110.0f, 60.0f, 0.0f};
  const tp::PowerUpTemperatures at =
      tp::AsCooled::start(facts, hoist());  // was off for two minutes, and cooled
  //! [power-up]
  CHECK(at.rests_on_record);
  CHECK(at.winding_C < 61.0f);
  CHECK(at.winding_C > 25.0f);

  //! [power-up rules]
  const float hottest_C = tp::AsHottest::start(facts, hoist()).winding_C;  // worst case: at its limit
  const float preset_C = tp::AsPreset::start(facts, hoist()).winding_C;    // what a setting says
  const float stored_C = tp::AsStored::start(facts, hoist()).winding_C;    // as it was
  const float new_C = tp::AsNewLoad::start(facts, hoist()).winding_C;      // heated meanwhile as it is now
  const float old_C = tp::AsOldLoad::start(facts, hoist()).winding_C;      // heated meanwhile as it was then
  //! [power-up rules]
  CHECK(hottest_C == 110.0f);
  CHECK(preset_C == 40.0f);
  CHECK(stored_C == found.winding_C);
  CHECK(at.winding_C < new_C);  // 2 W against none
  CHECK(new_C < old_C);         // 6 W against 2

  //! [start bounds]
  // Not how warm it probably is, but how warm it can be: constants known to 20 %, 30 W at most.
  const auto assumed = tp::StartAssumptions::around(hoist(), 0.2f, 30.0f, 110.0f, 60.0f);
  const tp::StartBounds bounds = assumed.cooled({65.0f, 52.0f}, 25.0f, 120.0f);  // bounds then, air, s
  //! [start bounds]
  CHECK(bounds.winding_upper_C < 65.0f);
  CHECK(bounds.winding_upper_C >= at.winding_C);
}

TEST_CASE("what is kept over a reset, and records of one's own") {
  //! [retained]
  static tp::Retained<tp::StoredState> kept;  // in a section that a reset does not clear
  tp::StoredState found;
  const bool was_kept = kept.recall(found);  // first of all: false after a loss of power, true after a reset
  const tp::StoredState now = {61.0f, 48.0f, 65.0f, 52.0f, 6.0f, 1.5f, tp::StoredState::no_clock(), 0};
  kept.keep(now, 0);  // in each cycle
  //! [retained]
  CHECK_FALSE(was_kept);
  const bool was_reset = kept.recall(found);  // as after a reset
  CHECK(was_reset);
  CHECK(found.body_C == 48.0f);

  //! [record ring]
  Eeprom eeprom;
  tp::RecordRing<Eeprom, tp::StoredState> ring(eeprom, 0, 16);  // 16 slots from byte 0
  ring.begin(now);
  while (!ring.work()) {
  }  // a slow memory takes a byte at a time
  const bool is_there = ring.load(found);
  //! [record ring]
  CHECK(is_there);
  CHECK(found.sequence == 0);
}

TEST_CASE("the journal of whole numbers") {
  //! [hottest journal]
  Eeprom eeprom;
  typedef tp::HottestJournal<Eeprom, tp::OffTogether, tp::StandardJournal> Journal;  // or tp::DrivenOn<110>
  Journal journal(eeprom);
  journal.step(61, 31250);  // 61 degC, 8 s in ticks of 256 us: a record is due
  while (!journal.is_idle()) journal.work();

  int16_t hottest_C = 0;  // after the next power-up
  Journal next(eeprom);
  const bool is_found = next.load(hottest_C);
  //! [hottest journal]
  REQUIRE(is_found);
  CHECK(hottest_C == 61 + tp::StandardJournal::change_K());  // not below what it may have become unrecorded

  //! [retained hottest]
  tp::RetainedHottest retained;              // in .noinit: a reset leaves it as it was
  retained.keep(61 * 128, 250);              // in every cycle: 61 degC, and POWER 250 was told
  const bool was_reset = retained.recall();  // at the start: was this a reset?
  const float motor_C = retained.hottest / 128.0f;
  //! [retained hottest]
  CHECK(was_reset);
  CHECK(motor_C == 61.0f);
}

TEST_CASE("in whole numbers: a motor, its heating and its temperature") {
  //! [fixed-point motor]
  namespace fp = tp::fixed_point;
  struct Constants {
    static constexpr double supply_V() { return 12.0; }
    static constexpr double resistance_ohm() { return 12.0; }
    static constexpr double reference_C() { return 20.0; }
    static constexpr double tempco_per_K() { return 0.00393; }
    static constexpr double heat_capacity_J_per_K() { return 18.0; }
    static constexpr double conductance_W_per_K() { return 0.05; }
  };
  typedef fp::OhmicMotor<Constants> Own;                   // a resistance on a heat capacity
  typedef fp::ThesisMotor<tp::motors::Bgm2606_90t> Pitch;  // a motor of motors/ at fp::ThirteenVolts
  fp::ThermalModel<Own>
      motor;                  // its state, and what steps it, is an fp::ThermalCore: one code for all motors
  motor.start(25 * 8388608);  // 25 degC in 2^-23 K
  for (int second = 0; second < 60; ++second) {
    motor.prepare(255);          // while waiting: the heating at full POWER
    motor.step(25 * 128, 3906);  // when telemetry comes: air in 1/128 K, a second in 256 us
  }
  const float motor_C = motor.motor_C();
  // What prepare() looks up: dT/dt by heating, from POWER and temperature.
  const fp::Rate heating = fp::Heating<Pitch>::rate(255, 40 * 128);
  //! [fixed-point motor]
  tp::ThermalModel<> same({{18.0f}, {0.05f}}, 25.0f);
  for (int second = 0; second < 60; ++second) {
    const float current_A = 12.0f / (12.0f * (1.0f + 0.00393f * (same.hottest_C() - 20.0f)));
    same.step({12.0f * current_A, 12.0f, {25.0f, 0.0f}}, 3906 * 256e-6f);
  }
  CHECK(motor_C == Approx(same.hottest_C()).margin(0.1));
  CHECK(heating > 0);
}

TEST_CASE("constants with bounds from three numbers of a data sheet") {
  //! [data sheet]
  // A sheet that says 1.4 A continuous, 2 ohm and a time constant of 12 minutes; 0: not said.
  constexpr tp::MotorDataSheet sheet = {2.0, 0.0, 0.0, 0.0, 1.4, 125.0, 0.0, 0.0, 0.0, 720.0};
  static_assert(sheet.is_enough(), "resistance, continuous current and time constant are");
  const float winding_J_per_K = static_cast<float>(sheet.winding_heat_capacity().nominal),
              body_J_per_K = static_cast<float>(sheet.body_heat_capacity().nominal),
              coupling_W_per_K = static_cast<float>(sheet.coupling().nominal),
              loss_W_per_K = static_cast<float>(sheet.conductance().nominal);
  tp::TwoNodeThermalModel<> thermal({winding_J_per_K, body_J_per_K, coupling_W_per_K, {loss_W_per_K}}, 25.0f);
  // For a limiter that is proved, the bounds themselves.
  tp::CertifiedTwoNodeConfig network = tp::CertifiedTwoNodeConfig::standard();
  constexpr tp::ConstantRange winding = sheet.winding_heat_capacity(), body = sheet.body_heat_capacity();
  network.winding_heat_capacity_J_per_K = {static_cast<float>(winding.lowest),
                                           static_cast<float>(winding.highest)};
  network.body_heat_capacity_J_per_K = {static_cast<float>(body.lowest), static_cast<float>(body.highest)};
  network.least_coupling_W_per_K = static_cast<float>(sheet.coupling().lowest);
  network.least_conductance_W_per_K = static_cast<float>(sheet.conductance().lowest);
  network.maximum_winding_C = static_cast<float>(sheet.hottest_C());
  network.maximum_body_C = 100.0f;
  //! [data sheet]
  CHECK(network.validate() == tp::ConfigError::none);
  // At the continuous current the nominal winding is at its limit, for ever.
  const float heat_W = 1.4f * 1.4f * 2.0f * (1.0f + 0.00393f * 100.0f);
  for (int i = 0; i < 200; ++i) thermal.step({heat_W, 0.0f, {25.0f, 0.0f}}, 60.0f);
  CHECK(thermal.hottest_C() == Approx(125.0f).epsilon(0.002));
}
