// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Examples on the pages of the monitor.

#include "../../catch.hpp"

#include <thermopower/thermopower.hpp>

#include <cmath>

namespace tp = thermopower;

namespace heater_page {
//! [heater monitor]
/// A bed of 220 W. The compiler makes whole numbers of these; an object holds nothing but its state.
struct Bed {
  static constexpr tp::MonitorConfig monitor() {
    return {10.0, 1000.0, true};
  }  // block s, false alarm h, cuts
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return {220.0, 0.05,        // W at full duty, off by 5 %
            900.0, 0.05,        // J/K that follow the thermometer
            0.0,   0.0,  0.0,   // no second mass
            5.0,   0.15,        // s until heat shows
            1.5,   0.06,        // W/K to the air
            0.0,   0.0,         // no fan
            3.0,   0.1,  0.05,  // K: air, noise, resolution
            1.0};               // J by which the heat of a second is off at random
  }
};
//! [heater monitor]
}  // namespace heater_page

namespace motor_page {
//! [motor monitor]
/// A motor: thermometer on the housing, current, voltage and speed. Three balances are watched.
struct Motor {
  static constexpr tp::MonitorConfig monitor() { return {8.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig
  heat_balance() {  // winding, body J/K; W/K between, to the air; 10 %; 0.1 K
    return tp::HeatBalanceConfig::measured_body(60.0, 20.0, 150.0, 1.2, 0.45, 0.1, 0.1);
  }
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {14.0,    2.0,  0.05,  // V, ohm, 5 %
            0.00393, 25.0, 25.0,  // copper, at 25 degC; the winding's temperature to 25 K
            0.05,    0.05};       // V: offset, noise
  }
  static constexpr tp::MotionBalanceConfig motion_balance() {
    return {5.0,   300.0, 5.0,  // A, rad/s, slowest rad/s that is judged
            0.05,  0.05,        // N m/A, 5 %
            5e-5,  0.05,        // kg m2, 5 %
            0.006, 2e-5,  0.3,  // dry friction, damping, 30 %
            0.01,  0.002};      // N m: load, noise
  }
};
//! [motor monitor]
}  // namespace motor_page

TEST_CASE("a bed on half its heater is noticed, cut, and told what it may be") {
  using heater_page::Bed;
  float measured_C = 20.0f;
  uint8_t suspects = 0;
  //! [watch a heater]
  tp::ModelMonitor<Bed> monitor;
  const auto control_cycle = [&](float heat_W, float air_C, float dt_s) {
    // heat_W: what the model says that duty and supply made of the heater since the last cycle.
    monitor.step(tp::MonitorInputs::heater(heat_W, measured_C, air_C), dt_s);
    const tp::LimitedPower granted = monitor.limit(255);
    if (granted.reason != tp::LimitReason::none)
      suspects = monitor.record().suspects;  // keep the record, too
    return granted.power;
  };
  //! [watch a heater]
  uint8_t power = 255;
  double real_C = 20.0, arrives_W = 0.0;
  for (int i = 0; i < 6000 && power == 255; ++i) {
    power = control_cycle(200.0f, 20.0f, 0.1f);
    arrives_W += 0.1 / 5.0 * (100.0 - arrives_W);  // of 200 W that are commanded
    real_C += 0.1 * (arrives_W - 1.5 * (real_C - 20.0)) / 900.0;
    measured_C = static_cast<float>(real_C);
  }
  CHECK(power == tp::least_power());
  CHECK(monitor.disagreement() == tp::Disagreement::heat_missing);
  CHECK(tp::is_suspect(suspects, tp::Suspect::heater));
}

TEST_CASE("a motor with shorted turns is told from one that brakes") {
  using motor_page::Motor;
  tp::ModelMonitor<Motor> shorted, braked;
  for (int i = 0; i < 6000; ++i) {
    // 2 A at 25 degC through three quarters of the winding; 0.04 N m of friction at 100 rad/s.
    shorted.step(tp::MonitorInputs::motor(8.0f, 25.0f, 25.0f, 3.0f, 2.0f, 25.0f, 0.0f), 0.05f);
    braked.step(tp::MonitorInputs::motor(0.0f, 25.0f, 25.0f, 1.6f, 0.8f, 25.0f, 100.0f), 0.05f);
  }
  CHECK(shorted.disagreement() == tp::Disagreement::resistance_low);
  CHECK(shorted.reason() == tp::LimitReason::winding_disagrees);
  CHECK(braked.disagreement() == tp::Disagreement::drag_high);
  CHECK(braked.suspects() == static_cast<uint8_t>(tp::Suspect::friction));
}

namespace axis_page {
struct MyMotor {
  typedef tp::CurrentModel<tp::OhmicCurrent<>> Current;
  typedef tp::ThermalModel<tp::HeatCapacityHeating<>, tp::NewtonCooling<>> Thermal;
  static Current::Config current() { return {12.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {11.0f, 13.5f}; }
  static Thermal::Config thermal() { return {{18.0f}, {0.05f}}; }
};
}  // namespace axis_page

TEST_CASE("an axis takes what the monitor says as its fault") {
  using motor_page::Motor;
  tp::AxisController<axis_page::MyMotor> axis(
      tp::AxisController<axis_page::MyMotor>::Config::with_gain({24.0f, 4.0f}));
  tp::ModelMonitor<Motor> monitor;
  const auto cycle = [&](float volt) {
    const tp::MonitorInputs measured = tp::MonitorInputs::motor(8.0f, 25.0f, 25.0f, volt, 2.0f, 25.0f, 0.0f);
    //! [monitor of an axis]
    monitor.step(measured, 0.05f);
    const auto& now = axis.step({5.0f, 13.0f, 25.0f, monitor.limit(255).reason}, 0.05f);
    //! [monitor of an axis]
    return now;
  };
  CHECK(cycle(4.0f).reason == tp::LimitReason::none);
  for (int i = 0; i < 3000; ++i) cycle(3.0f);
  CHECK(cycle(3.0f).reason == tp::LimitReason::winding_disagrees);
  CHECK(cycle(3.0f).power == tp::least_power());
}
