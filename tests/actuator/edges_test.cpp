// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The actuator where a measurement is absurd, a step is none, or nothing is known: what counts as no measurement, what as hot.

#include "../catch.hpp"

#include <cmath>
#include <limits>

#include <thermopower/actuator/energy_meter.hpp>
#include <thermopower/actuator/field_oriented.hpp>
#include <thermopower/actuator/observer_thermal.hpp>
#include <thermopower/actuator/start_bounds.hpp>
#include <thermopower/actuator/temperature_observer.hpp>
#include <thermopower/actuator/two_node_forecast.hpp>

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

TwoNodeThermalModel<float>::Config motor() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
ObservedThermal::Config observed() { return {TemperatureObserverConfig::standard(motor()), 110.0f, 1, 0}; }
WindingResistance::Config copper() {
  WindingResistance::Config config = WindingResistance::Config::standard();
  config.resistance_ohm = 8.0f;
  return config;
}
StartAssumptions assumed() { return StartAssumptions::around(motor(), 0.2f, 30.0f, 110.0f, 60.0f); }

}  // namespace

TEST_CASE("a wrong constant of a winding's measurement is refused by name") {
  REQUIRE(copper().validate() == ConfigError::none);
  const auto with = [](float WindingResistance::Config::*field, float value) {
    WindingResistance::Config config = copper();
    config.*field = value;
    return WindingResistance(config).validate();
  };
  typedef WindingResistance::Config Config;
  for (const float bad : {0.0f, -0.001f, 0.021f, nan_, infinite})
    CHECK(with(&Config::tempco_per_K, bad) == ConfigError::tempco_per_K);
  for (const float bad : {-51.0f, 201.0f, nan_})
    CHECK(with(&Config::reference_C, bad) == ConfigError::reference_C);
  for (const float bad : {-1.0f, nan_, infinite}) {
    CHECK(with(&Config::minimum_V_rms, bad) == ConfigError::minimum_V_rms);
    CHECK(with(&Config::current_offset_A, bad) == ConfigError::current_offset_A);
    CHECK(with(&Config::current_step_A, bad) == ConfigError::current_step_A);
    CHECK(with(&Config::voltage_std_fraction, bad) == ConfigError::voltage_std_fraction);
  }
  for (const float bad : {0.0f, -1.0f, nan_})
    CHECK(with(&Config::current_std_A, bad) == ConfigError::current_std_A);
  CHECK(with(&Config::tempco_per_K, 0.02f) == ConfigError::none);
  CHECK(WindingResistance(copper()).config().resistance_ohm == 8.0f);
}

TEST_CASE(
    "a voltage or current that no actuator has, and a temperature that no winding has, measure nothing") {
  const WindingResistance winding(copper());
  CHECK(winding.measure(12.0f, 1.5f).is_valid);
  CHECK_FALSE(winding.measure(1.0e4f, 1.5f).is_valid);
  CHECK_FALSE(winding.measure(12.0f, 1.0e4f).is_valid);
  CHECK_FALSE(winding.measure(infinite, 1.5f).is_valid);
  // 12 V and 0.3 A are 40 ohm, the copper of 8 ohm at 20 + 4 / 0.00393 = 1038 degC.
  CHECK_FALSE(winding.measure(12.0f, 0.3f).is_valid);
  // How warm it is expected to be changes how sure the reading is, not the reading; what cannot be is not used.
  const WindingReading plain = winding.measure(12.0f, 1.5f);
  const MeasuredTemperature hot = winding.measure(12.0f, 1.5f, 150.0f),
                            absurd = winding.measure(12.0f, 1.5f, 400.0f);
  CHECK(hot.value_C == plain.value_C);
  CHECK(hot.std_K > plain.std_K);
  CHECK(absurd.std_K == plain.std_K);
}

TEST_CASE(
    "an observer takes no step of a time that is none, and no more than a fraction of 1 of the heat for wrong") {
  TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  observer.start(60.0f, 50.0f, 1.0f, 1.0f, 0.0f);
  for (const float dt_s : {-1.0f, nan_, infinite}) {
    observer.step(20.0f, 25.0f, dt_s);
    CHECK(observer.state().winding_C == 60.0f);
    CHECK(observer.state().body_C == 50.0f);
  }
  TemperatureObserverConfig config = TemperatureObserverConfig::standard(motor());
  config.heat_error = 1.0f;
  CHECK(config.validate() == ConfigError::none);
  config.heat_error = 1.001f;
  CHECK(config.validate() == ConfigError::heat_error);
}

TEST_CASE(
    "after a gap of days the temperature is the settled one, and the observer as sure as its errors leave it") {
  TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  observer.step(2.0f, 25.0f, 5.0e5f);
  CHECK(observer.state().body_C == Approx(25.0 + 2.0 / 0.2));
  CHECK(observer.state().winding_C == Approx(25.0 + 2.0 / 0.2 + 2.0 / 1.0));
  // A fifth of the heat over what it flows through, and 2 K of air: both for good, and nothing of the start.
  CHECK(observer.body_std_K() == Approx(std::hypot(0.4 / 0.2, 2.0)).epsilon(0.001));
  CHECK(observer.winding_std_K() == Approx(std::hypot(0.4 / 0.2 + 0.4 / 1.0, 2.0)).epsilon(0.001));
  TemperatureObserver stepped(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  for (int i = 0; i < 10000; ++i) stepped.step(2.0f, 25.0f, 1.0f);
  CHECK(observer.winding_std_K() == Approx(stepped.winding_std_K()).epsilon(0.001));
  CHECK(observer.body_std_K() == Approx(stepped.body_std_K()).epsilon(0.001));
}

TEST_CASE("the count of believed measurements stops at its largest instead of starting again") {
  TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  observer.start(50.0f, 50.0f, 1.0f, 1.0f, 0.0f);
  const MeasuredTemperature measured = MeasuredTemperature::unchecked(50.0f, 1.0f, 0.0f);
  for (long i = 0; i < 65535L; ++i) observer.correct_winding(measured);
  CHECK(observer.state().accepted == 65535u);
  CHECK(observer.correct_winding(measured));
  CHECK(observer.state().accepted == 65535u);
}

TEST_CASE("an observed model refuses to take turns that are none") {
  REQUIRE(observed().validate() == ConfigError::none);
  ObservedThermal::Config config = observed();
  config.every = 0;
  CHECK(config.validate() == ConfigError::every);
  ObservedThermal refused(config, 40.0f);  // and steps all the same, each time
  refused.step({0.0f, 0.0f, {25.0f, 0.0f}}, 1.0f);
  CHECK(refused.hottest_C() < 40.0f);
  config = observed();
  config.every = 3;
  config.phase = 3;
  CHECK(config.validate() == ConfigError::every);
  config.phase = 2;
  CHECK(config.validate() == ConfigError::none);
  config.maximum_C = 201.0f;
  CHECK(config.validate() == ConfigError::maximum_C);
}

TEST_CASE(
    "an observed model that is told nothing starts at its limit, unsure; told a temperature, it is sure to 2 K") {
  ObservedThermal unknown(observed(), nan_);
  CHECK(unknown.hottest_C() == 110.0f);
  CHECK(unknown.observer().winding_std_K() > 50.0f);
  const ObservedThermal known(observed(), 40.0f);
  CHECK(known.hottest_C() == 40.0f);
  CHECK(known.observer().winding_std_K() == Approx(2.0));
  // In air that is at least 30 degC it is not sure by half of the way there, and a kelvin.
  unknown.start_in(30.0f);
  CHECK(unknown.hottest_C() == 110.0f);
  CHECK(unknown.observer().winding_std_K() == Approx(0.5 * (110.0 - 30.0) + 1.0));
  CHECK(unknown.hottest_rate_K_per_s() == 0.0f);
}

TEST_CASE("an observed model knows how fast its winding warms, in every step when it is asked to") {
  ObservedThermal thermal(observed(), 40.0f);
  thermal.step({12.0f, 0.0f, {25.0f, 0.0f}}, 0.1f);
  CHECK(thermal.hottest_rate_K_per_s() ==
        Approx(12.0 / 8.0));  // both nodes alike: all heat stays in the winding
  // Steps of no length take a turn each, and no heat.
  ObservedThermal::Config config = observed();
  config.every = 2;
  ObservedThermal turns(config, 40.0f);
  turns.step({12.0f, 0.0f, {25.0f, 0.0f}}, 0.5f);
  for (int i = 0; i < 3; ++i) turns.step({12.0f, 0.0f, {25.0f, 0.0f}}, 0.0f);
  ObservedThermal same(observed(), 40.0f);
  same.step({12.0f, 0.0f, {25.0f, 0.0f}}, 0.5f);
  CHECK(turns.state().winding_C == Approx(same.state().winding_C).margin(1e-4));
}

TEST_CASE("a wrong assumption about a start is refused by name") {
  REQUIRE(assumed().validate() == ConfigError::none);
  const auto with = [](float StartAssumptions::*field, float value) {
    StartAssumptions changed = assumed();
    changed.*field = value;
    return changed.validate();
  };
  typedef StartAssumptions S;
  for (const float bad : {-1.0f, nan_, infinite})
    CHECK(with(&S::largest_heat_W, bad) == ConfigError::heat_when_cold_W);
  for (const float bad : {0.0f, -1.0f, nan_}) {
    CHECK(with(&S::least_winding_J_per_K, bad) == ConfigError::winding_heat_capacity_J_per_K);
    CHECK(with(&S::least_body_J_per_K, bad) == ConfigError::body_heat_capacity_J_per_K);
    CHECK(with(&S::least_coupling_W_per_K, bad) == ConfigError::coupling_W_per_K);
    CHECK(with(&S::least_conductance_W_per_K, bad) == ConfigError::conductance_W_per_K);
  }
  for (const float bad : {0.1f, nan_, infinite}) {  // below the least, or no number
    CHECK(with(&S::most_winding_J_per_K, bad) == ConfigError::winding_heat_capacity_J_per_K);
    CHECK(with(&S::most_body_J_per_K, bad) == ConfigError::body_heat_capacity_J_per_K);
    CHECK(with(&S::most_conductance_W_per_K, bad) == ConfigError::conductance_W_per_K);
  }
  for (const float bad : {-1.0f, 251.0f, nan_}) {
    CHECK(with(&S::hottest_winding_C, bad) == ConfigError::maximum_winding_C);
    CHECK(with(&S::hottest_body_C, bad) == ConfigError::maximum_body_C);
  }
}

TEST_CASE(
    "an actuator that was driven on for a time that nobody knows may have settled at its largest heat") {
  const StoredState stored = {50.0f, 40.0f, 55.0f, 45.0f, 1.0f, 1.0f, StoredState::no_clock(), 0};
  const StartFacts facts = {true, stored, {61.0f, 2.0f, 601.0f}, nan_, 30.0f, true};
  const StartBounds bounds = assumed().start(facts);
  CHECK(bounds.body_upper_C >= 30.0f + 30.0f / (0.2f * 0.8f));
  CHECK(bounds.winding_upper_C >= bounds.body_upper_C);
}

TEST_CASE("a forecast sees that a body still warms while the winding cools") {
  const TwoNodeForecast cooling(motor(), {100.0f, 30.0f, 25.0f}, 0.0f);
  const float body_limit_C = 33.0f, body_s = cooling.seconds_to({infinite, body_limit_C});
  CHECK(std::isfinite(body_s));
  CHECK(cooling.body_C(body_s) == Approx(body_limit_C).margin(0.05));
  CHECK(cooling.body_C(0.99f * body_s) < body_limit_C);
  CHECK(cooling.seconds_to({100.0f, infinite}) == 0.0f);
}

TEST_CASE("no heat, no resistance, no current; no first energy, no saving") {
  CHECK(highest_current_A(6.0f, 1.0f) == Approx(std::sqrt(6.0 / 1.5)));
  for (const float bad : {0.0f, -1.0f, nan_}) {
    CHECK(highest_current_A(bad, 1.0f) == 0.0f);
    CHECK(highest_current_A(6.0f, bad) == 0.0f);
  }
  CHECK(std::isnan(difference_percent(0.0f, 1.0f)));
  CHECK(difference_percent(-2.0f, -1.0f) == Approx(50.0));
}
