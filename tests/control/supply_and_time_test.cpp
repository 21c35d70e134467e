// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a user's wiring and clock get wrong: supplies that read what they are not, and times that stand still. The motor is integrated here.

#include "../catch.hpp"

#include <cmath>
#include <limits>
#include <thermopower/thermopower.hpp>

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

struct Motor {
  typedef CurrentModel<OhmicCurrent<>> Current;
  typedef ThermalModel<HeatCapacityHeating<>, NewtonCooling<>> Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
  static SupplyRange supply() { return {12.5f, 13.0f}; }
  static AirRange air() { return {20.0f, 40.0f}; }
  static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
};
typedef AxisController<Motor> Plain;
typedef AxisController<Motor, StepPowerLaw<>, CertifiedLimiter<CertifiedOneNode>> Certified;

Plain::Config config(const Plain*) { return Plain::Config::with_gain({24.0f, 4.0f}); }
Certified::Config config(const Certified*) {
  Certified::Config config = Certified::Config::with_gain({24.0f, 4.0f});
  config.limiter.network = {{17.9f, 18.1f}, 0.0499f, 60.0f};
  config.limiter.use.heat =
      HeatBounds::ohmic(13.0f, 0.0f, {11.9f, 12.1f}, {0.0038f, 0.0040f}, 20.0f, -10.0f, 60.0f, 12.5f);
  config.limiter.use.highest_air_C = 45.0f;
  return config;
}

struct Outcome {
  double peak_C = 25.0;
  int faults = 0, steps = 0;
  LimitReason last = LimitReason::none;
};

/// An hour at full demand on 13 V. @param told  what the axis is told at a time: supply, V, and time step, s
template <class Axis, class Told, class Thermometer>
Outcome hour(Told told, Thermometer thermometer) {
  Axis axis(config(static_cast<const Axis*>(nullptr)));
  REQUIRE(axis.validate() == ConfigError::none);
  Outcome outcome;
  double motor_C = 25.0;
  int power = 1;
  for (double now_s = 0.0; now_s < 3600.0; now_s += 0.02) {
    motor_C +=
        0.02 *
        (169.0 / (12.0 * (1.0 + 0.00393 * (motor_C - 20.0))) * power / 255.0 - 0.05 * (motor_C - 25.0)) /
        18.0;
    outcome.peak_C = std::max(outcome.peak_C, motor_C);
    float supply_V = 13.0f, dt_s = 0.02f;
    told(now_s, supply_V, dt_s);
    const typename Axis::State& state =
        axis.step({2.0f, supply_V, thermometer(now_s), LimitReason::none}, dt_s);
    power = state.power;
    outcome.last = state.reason;
    outcome.faults += is_fault(state.reason) ? 1 : 0;
    ++outcome.steps;
  }
  return outcome;
}

template <class Axis, class Told>
Outcome hour(Told told) {
  return hour<Axis>(told, [](double) { return 25.0f; });
}

// The reading is believed inside its range: a motor at its limit may be warmer by what the range leaves open.
const double open_K = 35.0 * (13.0 * 13.0 / (12.5 * 12.5) - 1.0) + 0.5;

template <class Told>
void check_named(const char* name, LimitReason reason, Told told) {
  INFO(name);
  const Outcome plain = hour<Plain>(told), certified = hour<Certified>(told);
  CHECK(plain.peak_C < 60.0 + open_K);
  CHECK(certified.peak_C < 60.0);
  CHECK(plain.last == reason);
  CHECK(certified.last == reason);
}

}  // namespace

TEST_CASE("a supply that reads what it cannot be heats with the highest there is, and the reason says so") {
  check_named("an open pin", LimitReason::supply_low,
              [](double, float& supply_V, float&) { supply_V = 0.0f; });
  check_named("an open pin after a while", LimitReason::supply_low,
              [](double now_s, float& supply_V, float&) { supply_V = now_s < 60.0 ? 13.0f : 0.0f; });
  check_named("half the voltage", LimitReason::supply_low,
              [](double, float& supply_V, float&) { supply_V = 6.5f; });
  check_named("negative", LimitReason::supply_low,
              [](double, float& supply_V, float&) { supply_V = -13.0f; });
  check_named("drifts down to 3 V", LimitReason::supply_low, [](double now_s, float& supply_V, float&) {
    supply_V = static_cast<float>(13.0 - 10.0 * now_s / 3600.0);
  });
  check_named("655 V", LimitReason::supply_implausible,
              [](double, float& supply_V, float&) { supply_V = 655.35f; });
  check_named("1e30 V", LimitReason::supply_implausible,
              [](double, float& supply_V, float&) { supply_V = 1e30f; });
  check_named("no number", LimitReason::supply_not_finite,
              [](double, float& supply_V, float&) { supply_V = nan_; });
  check_named("infinite", LimitReason::supply_not_finite,
              [](double, float& supply_V, float&) { supply_V = infinite; });
  // Every second reading is a zero.
  const Outcome flickers = hour<Plain>([](double now_s, float& supply_V, float&) {
    if (static_cast<int>(now_s * 50.0 + 0.5) % 2 == 0) supply_V = 0.0f;
  });
  CHECK(flickers.peak_C < 60.5);
}

TEST_CASE(
    "a thermometer that reads what no air in the declared range can be is named, and the warmest air counts") {
  const auto nothing = [](double, float&, float&) {};
  const auto check = [&](const char* name, auto thermometer) {
    INFO(name);
    const Outcome plain = hour<Plain>(nothing, thermometer),
                  certified = hour<Certified>(nothing, thermometer);
    CHECK(plain.peak_C < 60.5);
    CHECK(certified.peak_C < 60.0);
    CHECK(plain.last == LimitReason::air_implausible);
    CHECK(certified.last == LimitReason::air_implausible);
  };
  check("reads 0", [](double) { return 0.0f; });
  check("torn", [](double) { return -88.6f; });
  check("no number", [](double) { return nan_; });
  check("a radiator", [](double) { return 80.0f; });
  check("drifts down by a kelvin a minute",
        [](double now_s) { return static_cast<float>(25.0 - now_s / 60.0); });
}

TEST_CASE("one reading that cannot be costs seconds of power, and not an hour") {
  for (const float once_V : {0.0f, 655.35f, 1e30f, nan_}) {
    Plain axis(config(static_cast<const Plain*>(nullptr)));
    for (int i = 0; i < 100; ++i)
      axis.step({2.0f, 13.0f, AxisAirCelsius::bound(25.0f), LimitReason::none}, 0.02f);
    const int before = axis.state().power;
    const float motor_C = axis.state().motor_C;
    CHECK(axis.step({2.0f, once_V, AxisAirCelsius::bound(25.0f), LimitReason::none}, 0.02f).power ==
          least_power());
    int steps = 0;
    while (axis.step({2.0f, 13.0f, AxisAirCelsius::bound(25.0f), LimitReason::none}, 0.02f).power < before &&
           steps < 10000)
      ++steps;
    INFO(once_V << " V");
    CHECK(steps * 0.02 < 10.0);
    CHECK(std::abs(axis.state().motor_C - motor_C) < 3.0f);
  }
}

TEST_CASE("a time that stands still is a fault as soon as it has stood for what the limiter vouches for") {
  check_named("never set", LimitReason::time_stands_still, [](double, float&, float& dt_s) { dt_s = 0.0f; });
  check_named("milliseconds divided as integers", LimitReason::time_stands_still,
              [](double, float&, float& dt_s) {
                dt_s = static_cast<float>(static_cast<int>(dt_s * 1000.0f) / 1000);
              });
  check_named("stops after a while", LimitReason::time_stands_still,
              [](double now_s, float&, float& dt_s) { dt_s = now_s < 60.0 ? dt_s : 0.0f; });
  // A clock that ticks more slowly than the loop runs is no fault: the time comes later.
  const Outcome coarse = hour<Plain>([](double now_s, float&, float& dt_s) {
    dt_s = static_cast<int>(now_s * 50.0 + 0.5) % 2 == 1 ? 0.04f : 0.0f;
  });
  CHECK(coarse.peak_C < 60.5);
  CHECK(coarse.faults == 0);
}

TEST_CASE("how long a time may stand still") {
  const auto steps_until_fault = [](auto axis, float step_s) {
    for (int i = 0; i < 10; ++i) axis.step({2.0f, 13.0f, 25.0f, LimitReason::none}, step_s);
    int steps = 0;
    while (axis.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.0f).reason != LimitReason::time_stands_still)
      ++steps;
    return steps;
  };
  const Plain plain(config(static_cast<const Plain*>(nullptr)));
  const Certified certified(config(static_cast<const Certified*>(nullptr)));
  CHECK(steps_until_fault(plain, 0.01f) == Approx(10).margin(1));      // a tenth of a second
  CHECK(steps_until_fault(certified, 0.01f) == Approx(10).margin(1));  // hold_s
  CHECK(steps_until_fault(certified, 0.05f) == Approx(2).margin(1));
  CHECK(steps_until_fault(plain, 1.0f) <= 1);
  // Before any time was told the first step is the start, and the second too many.
  Plain fresh = plain;
  CHECK(fresh.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.0f).reason == LimitReason::none);
  CHECK(fresh.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.0f).reason == LimitReason::time_stands_still);
  Certified alone = certified;
  CHECK_FALSE(is_fault(alone.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.0f).reason));
  CHECK(alone.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.0f).reason == LimitReason::time_stands_still);
}

TEST_CASE("a supply is declared, or the axis does not drive") {
  struct Undeclared {
    typedef CurrentModel<OhmicCurrent<>> Current;
    typedef ThermalModel<HeatCapacityHeating<>, NewtonCooling<>> Thermal;
    static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
    static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
  };
  typedef AxisController<Undeclared> Axis;
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));
  CHECK(axis.validate() == ConfigError::lowest_supply_V);
  CHECK(axis.step({2.0f, 13.0f, 25.0f, LimitReason::none}, 0.02f).reason == LimitReason::config_invalid);
  CHECK(Axis(Axis::Config::with_gain({24.0f, 4.0f}, {11.0f, 13.0f})).validate() == ConfigError::none);
  CHECK(SupplyRange{0.0f, 13.0f}.validate() == ConfigError::lowest_supply_V);
  CHECK(SupplyRange{13.0f, 13.0f}.validate() == ConfigError::highest_supply_V);
  CHECK(SupplyRange{11.0f, infinite}.validate() == ConfigError::highest_supply_V);
  // A certified limiter uses no reading whose lowest is not declared.
  CertifiedLimiter<CertifiedOneNode>::Config told = config(static_cast<const Certified*>(nullptr)).limiter,
                                             untold = told;
  untold.use.heat.lowest_supply_V = 0.0f;
  CertifiedLimiter<CertifiedOneNode> with(told), without(untold), low(told);
  for (int i = 0; i < 20000; ++i) {
    with.step({255, 12.5f, 25.0f}, 0.05f);
    without.step({255, 12.5f, 25.0f}, 0.05f);
    low.step({255, 6.0f, 25.0f}, 0.05f);
  }
  CHECK(with.ceiling() > without.ceiling());
  CHECK(low.ceiling() == without.ceiling());
  told.use.heat.lowest_supply_V = 13.0f;
  CHECK(told.validate() == ConfigError::lowest_supply_V);
  told.use.heat.lowest_supply_V = nan_;
  CHECK(told.validate() == ConfigError::lowest_supply_V);
}
