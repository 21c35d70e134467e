// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <cmath>
#include <random>

#include <thermopower/actuator/cached_current.hpp>
#include <thermopower/actuator/observer_thermal.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/temperature_observer.hpp>

using namespace thermopower;

namespace {

typedef TwoNodeThermalModel<double> Truth;

TwoNodeThermalModel<float>::Config motor() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
Truth::Config true_motor(double factor = 1.0) { return {8.0 * factor, 80.0 * factor, 1.0, {0.2}}; }

/// Whose readings are noisy and right on average, as they are here; observer_coverage_test.cpp has the others.
WindingResistance::Config copper() {
  WindingResistance::Config config = WindingResistance::Config::standard();
  config.resistance_ohm = 8.0f;
  config.current_offset_A = config.voltage_std_fraction = 0.0f;
  return config;
}

double true_current_A(double v_rms_V, double winding_C) {
  return v_rms_V / (8.0 * (1.0 + 0.00393 * (winding_C - 20.0)));
}

/// As REALTIME_DATA_4 sends it: whole milliampere, after 5 mA of noise.
float sent_current_A(double current_A, std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, 0.005);
  return static_cast<float>(std::round((current_A + noise(random)) * 1000.0) * 0.001);
}

}  // namespace

TEST_CASE("without measurements the observer is the two-node model, at any step size") {
  for (const float dt_s : {0.001f, 0.01f, 1.0f, 10.0f}) {
    TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
    observer.start(25.0f, 25.0f, 0.5f, 0.5f, 0.0f);
    Truth truth(true_motor(), 25.0);
    for (int i = 0; i < static_cast<int>(200.0f / dt_s + 0.5f); ++i) {
      observer.step(6.0f, 25.0f, dt_s);
      truth.step({6.0, 0.0, {25.0, 0.0}}, static_cast<double>(dt_s));
    }
    INFO("step " << dt_s << " s");
    CHECK(observer.state().winding_C == Approx(truth.state().winding_C).margin(0.1));
    CHECK(observer.state().body_C == Approx(truth.state().body_C).margin(0.1));
  }
}

TEST_CASE("resistance: exact without noise, and its own idea of the noise is right") {
  WindingResistance::Config config = copper();
  config.voltage_std_fraction = 0.01f;
  const WindingResistance winding(config);
  REQUIRE(winding.validate() == ConfigError::none);
  const double v_rms_V = 8.0, winding_C = 71.0;
  const WindingReading exact = winding.measure(8.0f, static_cast<float>(true_current_A(v_rms_V, winding_C)));
  CHECK(exact.is_valid);
  CHECK(exact.value_C == Approx(71.0f).margin(0.01));
  std::mt19937 random(1);
  std::normal_distribution<double> voltage_noise(0.0, 0.01);
  double sum = 0.0, squares = 0.0;
  const int samples = 20000;
  for (int i = 0; i < samples; ++i) {
    const double error_K =
        static_cast<double>(winding
                                .measure(static_cast<float>(v_rms_V * (1.0 + voltage_noise(random))),
                                         sent_current_A(true_current_A(v_rms_V, winding_C), random))
                                .value_C) -
        winding_C;
    sum += error_K;
    squares += error_K * error_K;
  }
  // The voltage differs from sensor to sensor, the current from reading to reading.
  const double std_K =
      std::hypot(static_cast<double>(exact.std_K), static_cast<double>(exact.standing_std_K));
  CHECK(std::sqrt(squares / samples) == Approx(std_K).epsilon(0.05));
}

TEST_CASE("a lost or broken reading is not valid, and never cold") {
  const WindingResistance winding(copper());
  const float nan = detail::not_a_number();
  CHECK_FALSE(winding.measure(2.9f, 0.3f).is_valid);   // too little voltage
  CHECK_FALSE(winding.measure(8.0f, 0.0f).is_valid);   // broken wire
  CHECK_FALSE(winding.measure(8.0f, 0.01f).is_valid);  // within the sensor's noise
  CHECK_FALSE(winding.measure(8.0f, -1.0f).is_valid);
  CHECK_FALSE(winding.measure(8.0f, nan).is_valid);
  CHECK_FALSE(winding.measure(nan, 1.0f).is_valid);
  CHECK_FALSE(winding.measure(8.0f, 100.0f).is_valid);  // a short circuit would be colder than any winding
  CHECK(std::isnan(winding.measure(8.0f, 0.0f).value_C));
}

TEST_CASE("a hot start is found out by resistance") {
  for (const double start_C : {25.0, 60.0, 105.0}) {
    TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
    const WindingResistance winding(copper());
    Truth truth(true_motor(), start_C);
    std::mt19937 random(static_cast<unsigned>(start_C));
    CHECK(observer.state().winding_C == 110.0f);  // until something was measured: the worst
    for (int i = 0; i < 3000; ++i) {
      const double v_rms_V = 4.0, current_A = true_current_A(v_rms_V, truth.state().winding_C);
      truth.step({v_rms_V * current_A, 0.0, {25.0, 0.0}}, 0.01);
      observer.step(static_cast<float>(v_rms_V * current_A), 25.0f, 0.01f);
      if (i % 10 == 0) observer.correct_winding(winding, 4.0f, sent_current_A(current_A, random));
    }
    INFO("really " << start_C << " degC");
    CHECK(observer.state().winding_C ==
          Approx(truth.state().winding_C).margin(4.0 * static_cast<double>(observer.winding_std_K())));
    CHECK(observer.winding_std_K() < 2.0f);
    CHECK(observer.state().body_C ==
          Approx(truth.state().body_C).margin(4.0 * static_cast<double>(observer.body_std_K())));
  }
}

TEST_CASE("the standard deviation is honest: over many wrong models the errors are as large as it says") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  int within_1 = 0, within_3 = 0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
    observer.start(25.0f, 25.0f, 1.0f, 1.0f, 0.0f);
    Truth truth(true_motor(), 25.0);
    const double heat_factor = 1.0 + 0.2 * normal(random), air_C = 25.0 + 2.0 * normal(random);
    for (int i = 0; i < 30000; ++i) {
      const double power_W = (i / 3000) % 2 == 0 ? 6.0 : 2.0;
      truth.step({power_W * heat_factor, 0.0, {air_C, 0.0}}, 0.05);
      observer.step(static_cast<float>(power_W), 25.0f, 0.05f);
    }
    const double error_K = std::abs(static_cast<double>(observer.state().body_C) - truth.state().body_C);
    if (error_K <= static_cast<double>(observer.body_std_K())) ++within_1;
    if (error_K <= 3.0 * static_cast<double>(observer.body_std_K())) ++within_3;
  }
  CHECK(within_1 > 0.5 * runs);  // normal errors: 0.68
  CHECK(within_1 < 0.9 * runs);  // nor is it inflated
  CHECK(within_3 > 0.98 * runs);
}

TEST_CASE("measurements help: the error with resistance is a fraction of the error without") {
  std::mt19937 random(6);
  double with_K = 0.0, without_K = 0.0;
  const WindingResistance winding(copper());
  TemperatureObserver measured(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f), blind = measured;
  measured.start(25.0f, 25.0f, 1.0f, 1.0f, 0.0f);
  blind.start(25.0f, 25.0f, 1.0f, 1.0f, 0.0f);
  Truth truth(true_motor(0.8), 25.0);
  for (int i = 0; i < 60000; ++i) {
    const double v_rms_V = 7.0, current_A = true_current_A(v_rms_V, truth.state().winding_C);
    truth.step({1.3 * v_rms_V * current_A, 0.0, {25.0, 0.0}},
               0.01);  // a third more heat than the model thinks
    for (TemperatureObserver* observer : {&measured, &blind})
      observer->step(static_cast<float>(v_rms_V * current_A), 25.0f, 0.01f);
    if (i % 25 == 0) measured.correct_winding(winding, 7.0f, sent_current_A(current_A, random));
    with_K =
        std::max(with_K, std::abs(static_cast<double>(measured.state().winding_C) - truth.state().winding_C));
    without_K =
        std::max(without_K, std::abs(static_cast<double>(blind.state().winding_C) - truth.state().winding_C));
  }
  CHECK(without_K > 8.0);
  CHECK(with_K < 0.4 * without_K);
}

TEST_CASE("a stray is gated; a run of hot readings is believed, a run of cold ones never") {
  TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  observer.start(50.0f, 50.0f, 1.0f, 1.0f, 0.0f);
  const MeasuredTemperature cold = MeasuredTemperature::unchecked(0.0f, 1.0f, 0.0f),
                            hot = MeasuredTemperature::unchecked(90.0f, 1.0f, 0.0f);
  for (int i = 0; i < 100; ++i) CHECK_FALSE(observer.correct_winding(cold));
  CHECK(observer.state().winding_C == 50.0f);
  CHECK_FALSE(observer.correct_winding(hot));
  int believed = 0;
  for (int i = 0; i < 10; ++i) believed += observer.correct_winding(hot) ? 1 : 0;
  CHECK(believed > 0);
  CHECK(observer.state().winding_C > 80.0f);
}

TEST_CASE("the variances stay positive through anything") {
  std::mt19937 random(8);
  TemperatureObserver observer(TemperatureObserverConfig::standard(motor()), 110.0f, 25.0f);
  std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
  for (int i = 0; i < 200000; ++i) {
    observer.step(20.0f * uniform(random), 25.0f, 0.01f + uniform(random));
    MeasuredTemperature measured = MeasuredTemperature::unchecked(
        100.0f * uniform(random), 0.001f + 10.0f * uniform(random) * uniform(random),
        5.0f * uniform(random) * uniform(random));
    measured.is_valid = uniform(random) < 0.9f;
    if (i % 2) observer.correct_winding(measured);
    else observer.correct_body(measured);
    const TemperatureObserver::State& state = observer.state();
    if (!(state.winding_variance_K2 > 0.0f) || !(state.body_variance_K2 > 0.0f) ||
        state.shared_variance_K2 * state.shared_variance_K2 >
            1.001f * state.winding_variance_K2 * state.body_variance_K2)
      FAIL("not a covariance after " << i);
  }
}

TEST_CASE("a gap makes the observer no surer than the same time in small steps, however long it is") {
  // A body with a lag of four and a half days.
  const TwoNodeThermalModel<float>::Config slow = {8.0f, 80000.0f, 1.0f, {0.2f}};
  const TemperatureObserverConfig config = TemperatureObserverConfig::standard(slow);
  for (const float gap_s : {30.0f, 999.0f, 20000.0f, 86400.0f}) {
    INFO(gap_s << " s");
    TemperatureObserver at_once(config, 110.0f, 25.0f), in_steps(config, 110.0f, 25.0f);
    at_once.start(30.0f, 25.0f, 0.5f, 0.1f, 0.5f);
    in_steps.start(30.0f, 25.0f, 0.5f, 0.1f, 0.5f);
    at_once.step(2.0f, 25.0f, gap_s);
    for (float passed_s = 0.0f; passed_s < gap_s; passed_s += 0.5f) in_steps.step(2.0f, 25.0f, 0.5f);
    // Half a step of a second is early or late.
    CHECK(at_once.winding_std_K() == Approx(in_steps.winding_std_K()).epsilon(0.02).margin(0.02));
    CHECK(at_once.body_std_K() == Approx(in_steps.body_std_K()).epsilon(0.02).margin(0.001));
    // What stands in the estimate is told apart from chance: a measurement afterwards counts alike.
    const MeasuredTemperature measured = MeasuredTemperature::unchecked(at_once.state().body_C, 0.1f, 0.1f);
    CHECK(at_once.correct_body(measured));
    CHECK(in_steps.correct_body(measured));
    CHECK(at_once.winding_std_K() == Approx(in_steps.winding_std_K()).epsilon(0.02).margin(0.02));
  }
  // One that comes while short steps are still being carried finds all of them done.
  TemperatureObserver between(config, 110.0f, 25.0f), whole(config, 110.0f, 25.0f);
  between.start(30.0f, 25.0f, 0.5f, 0.1f, 0.5f);
  whole.start(30.0f, 25.0f, 0.5f, 0.1f, 0.5f);
  float short_s = 0.0f;
  for (; !between.is_carrying(); short_s += 0.05f) between.step(2.0f, 25.0f, 0.05f);
  between.step(2.0f, 25.0f, 20000.0f);
  CHECK_FALSE(between.is_carrying());
  whole.step(2.0f, 25.0f, 20000.0f + short_s);
  CHECK(between.winding_std_K() == Approx(whole.winding_std_K()).epsilon(1e-3));
  CHECK(between.body_std_K() == Approx(whole.body_std_K()).epsilon(1e-3));
  // By hand: a fifth of 2 W over 0.2 W/K and 2 K of air, as far as a body of 80 kJ/K follows them in a day.
  TemperatureObserver observer(config, 110.0f, 25.0f);
  observer.start(25.0f, 25.0f, 0.001f, 0.001f, 0.0f);
  observer.step(2.0f, 25.0f, 86400.0f);
  const double settled_s = 80008.0 / 0.2;
  const double all_K = std::hypot(0.4 / 0.2, 2.0);
  CHECK(observer.body_std_K() == Approx(all_K * (1.0 - std::exp(-86400.0 / settled_s))).epsilon(0.01));
  // And for ever: all the errors that there are, and no more.
  observer.step(2.0f, 25.0f, 1.0e9f);
  CHECK(observer.body_std_K() == Approx(all_K).epsilon(1e-3));
  CHECK(observer.winding_std_K() == Approx(std::hypot(0.4 / 0.2 + 0.4, 2.0)).epsilon(1e-3));
}

TEST_CASE("an observer with a wrong field is refused by name") {
  TemperatureObserverConfig config = TemperatureObserverConfig::standard(motor());
  CHECK(config.validate() == ConfigError::none);
  config.heat_error = 0.0f;
  CHECK(config.validate() == ConfigError::heat_error);
  config = TemperatureObserverConfig::standard({});
  CHECK(is_error(config.validate()));  // all-zero parameters
  CHECK(WindingResistance::Config::standard().validate() == ConfigError::resistance_ohm);
}

TEST_CASE("a cached current is the current, whatever changes, and NaN comes through") {
  const OhmicCurrent<float> law = {8.0f, 0.0039f, 20.0f};
  CachedCurrent<OhmicCurrent<float>> cached(law);
  const CurrentModel<OhmicCurrent<float>> model(law);
  std::mt19937 random(5);
  float power = 1.0f, supply_V = 12.0f, motor_C = 25.0f;
  for (int i = 0; i < 100000; ++i) {
    if (random() % 4 == 0) power = static_cast<float>(random() % 256);
    if (random() % 4 == 0) supply_V = 9.0f + 0.01f * static_cast<float>(random() % 400);
    if (random() % 2 == 0) motor_C += 0.1f * (static_cast<float>(random() % 21) - 10.0f);
    motor_C = std::fmin(std::fmax(motor_C, -20.0f), 120.0f);
    const auto expected = model.at_power(power, supply_V, motor_C);
    const auto& given = cached.at_power(power, supply_V, motor_C);
    REQUIRE(given.v_rms_V == Approx(expected.v_rms_V).epsilon(1e-6));
    REQUIRE(given.current_A == Approx(expected.current_A).epsilon(0.0024));  // half a kelvin
    REQUIRE(given.winding_power_W == Approx(expected.winding_power_W).epsilon(0.0024));
  }
  const float nan = detail::not_a_number();
  for (int twice = 0; twice < 2; ++twice) {
    CHECK(std::isnan(cached.at_power(nan, 12.0f, 25.0f).winding_power_W));
    CHECK(cached.at_power(100.0f, 12.0f, 25.0f).winding_power_W > 0.0f);
    CHECK(std::isnan(cached.at_power(100.0f, nan, 25.0f).winding_power_W));
    CHECK(std::isnan(cached.at_power(100.0f, 12.0f, nan).winding_power_W));
    CHECK(std::isnan(cached.at_power(100.0f, 12.0f, nan).winding_power_W));
    CHECK(cached.at_power(100.0f, 12.0f, 25.0f).winding_power_W > 0.0f);
  }
}

namespace {
// A law without a conductance: the current is not in proportion to the voltage. Counts how often it is asked.
struct SquareLaw {
  typedef float Scalar;
  static int asked;
  static float current_A(float v_rms_V, float motor_C) {
    ++asked;
    return v_rms_V * v_rms_V * (0.01f - 0.00002f * motor_C);
  }
  static ConfigError validate() { return ConfigError::none; }
};
int SquareLaw::asked = 0;
}  // namespace

TEST_CASE("a law without a conductance is asked only when something changed, and by whole and broken POWER") {
  CachedCurrent<SquareLaw> cached((SquareLaw()));
  const CurrentModel<SquareLaw> model((SquareLaw()));
  const float powers[] = {0.0f, 1.0f, 0.5f, 99.75f, 254.9f, 255.0f, 300.0f};
  for (const float power : powers) {
    CAPTURE(power);
    CHECK(cached.at_power(power, 12.0f, 25.0f).current_A ==
          Approx(model.at_power(power, 12.0f, 25.0f).current_A).epsilon(1e-6));
  }
  CHECK(std::isnan(cached.at_power(-1.0f, 12.0f, 25.0f).current_A));
  SquareLaw::asked = 0;
  for (int i = 0; i < 10; ++i) cached.at_count(100, 12.0f, 70.0f + 0.04f * static_cast<float>(i));
  CHECK(SquareLaw::asked == 1);
  cached.at_count(101, 12.0f, 70.0f);
  cached.at_count(101, 12.5f, 70.0f);
  CHECK(SquareLaw::asked == 3);
  // Less than a kelvin at any temperature that a motor has: half of one up to 128 degC.
  for (float motor_C = 20.0f; motor_C < 250.0f; motor_C += 0.37f) {
    cached.at_count(101, 12.0f, motor_C);
    SquareLaw::asked = 0;
    cached.at_count(101, 12.0f, motor_C + (motor_C < 127.0f ? 0.5f : 1.0f));
    REQUIRE(SquareLaw::asked == 1);
    cached.at_count(101, 12.0f, -motor_C);
    REQUIRE(SquareLaw::asked == 2);
  }
}

TEST_CASE("an observer that steps every n-th time sees the same heat, at equal and at changing steps") {
  for (const bool is_even : {true, false}) {
    INFO((is_even ? "equal" : "changing") << " steps");
    const ObservedThermal::Config config = {TemperatureObserverConfig::standard(motor()), 110.0f, 9, 4};
    ObservedThermal thermal(config, 25.0f);
    Truth truth(true_motor(), 25.0);
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
      const float dt_s = is_even ? 0.01f : 0.005f + 0.001f * static_cast<float>(random() % 11);
      const float heat_W = (i / 7) % 3 == 0 ? 9.0f : 2.0f + static_cast<float>(random() % 3);
      thermal.step({heat_W, 0.0f, {25.0f, 0.0f}}, dt_s);
      truth.step({static_cast<double>(heat_W), 0.0, {25.0, 0.0}}, static_cast<double>(dt_s));
      if (i < 100) continue;
      REQUIRE(thermal.state().winding_C == Approx(truth.state().winding_C).margin(0.25));
      REQUIRE(thermal.state().body_C == Approx(truth.state().body_C).margin(0.1));
      REQUIRE(thermal.hottest_C() == std::fmax(thermal.state().winding_C, thermal.state().body_C));
    }
  }
  ObservedThermal thermal({TemperatureObserverConfig::standard(motor()), 110.0f, 3, 0}, 25.0f);
  for (int i = 0; i < 3; ++i) thermal.step({detail::not_a_number(), 0.0f, {25.0f, 0.0f}}, 0.01f);
  CHECK(std::isnan(thermal.hottest_C()));
}

TEST_CASE("no network gives the observer NaN, also where the eigenvalues nearly meet") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> small(-8.0f, -2.0f), near_one(0.999999f, 1.000001f);
  for (int trial = 0; trial < 5000; ++trial) {
    // Winding and body with the same own rate, all but uncoupled: the discriminant is lost in rounding.
    const float coupling = std::pow(10.0f, small(random));
    const TwoNodeThermalModel<float>::Config config = {
        coupling, near_one(random), coupling, {near_one(random)}};
    TemperatureObserver observer(TemperatureObserverConfig::standard(config), 110.0f, 25.0f);
    observer.start(25.0f, 25.0f, 0.5f, 0.5f, 0.0f);
    observer.step(coupling, 25.0f, 0.5f);
    REQUIRE(std::isfinite(observer.state().winding_C));
    REQUIRE(std::isfinite(observer.state().body_C));
  }
}
