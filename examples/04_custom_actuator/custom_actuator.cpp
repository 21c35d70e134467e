// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a proportional solenoid valve holds a pressure; its coil must stay below 80 degC, its winding is
//           hotter than its body.
// Model:    coil 40 ohm, two nodes (winding 25 J/K, body 160 J/K); duty proportional to the pressure that is
//           missing.
// Notation: "error" is here the missing pressure in bar; duty 0 .. 255.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;

//! [coil]
struct Solenoid {
  typedef tp::CurrentModel<tp::OhmicCurrent<> > Current;
  typedef tp::TwoNodeThermalModel<> Thermal;
  static Current::Config current() { return {40.0f, 0.00393f, 20.0f}; }
  static tp::SupplyRange supply() { return {1.0f, 30.0f}; }
  static Thermal::Config thermal() { return {25.0f, 160.0f, 0.5f, {0.13f}}; }
};
//! [coil]

//! [law]
// A power law of one's own: Config with standard() and validate(), step(error).
class PressureDuty {
public:
  struct Config {
    float full_duty_bar;
    static Config standard() { return {0.5f}; }
    tp::ConfigError validate() const {
      return full_duty_bar > 0.0f ? tp::ConfigError::none : tp::ConfigError::user_defined;
    }
  };
  explicit PressureDuty(const Config& config = Config::standard()) : config_(config) {}

  uint8_t step(float missing_bar) {
    if (!(missing_bar > 0.0f)) return 0;  // also when it is no number: a valve may be switched off
    const float duty = 255.0f * missing_bar / config_.full_duty_bar;
    return static_cast<uint8_t>(duty < 255.0f ? duty : 255.0f);
  }

private:
  Config config_;
};

typedef tp::AxisController<Solenoid, PressureDuty, tp::SafetyLimiter<>, tp::NoGain> Valve;
//! [law]

int main() {
  Valve::Config config = Valve::Config::standard();
  config.limiter.maximum_C = 80.0f;
  Valve valve(config);
  if (tp::is_error(valve.validate())) return 1;

  printf("  minute   missing/bar   demand   duty   coil/degC   reason\n");
  float hottest_C = 0.0f;
  bool was_limited = false;
  for (int i = 0; i <= 20 * 600; ++i) {
    const float missing_bar = i < 12 * 600 ? 0.9f : (i < 16 * 600 ? 0.1f : -0.2f);
    const Valve::State& state = valve.step({missing_bar, 24.0f, 35.0f, tp::LimitReason::none}, 0.1f);
    if (state.motor_C > hottest_C) hottest_C = state.motor_C;
    was_limited = was_limited || state.power < state.demand;
    if (i % 1200 == 0)
      printf("  %6d   %11.1f   %6d   %4d   %9.1f   %d\n", i / 600, static_cast<double>(missing_bar),
             state.demand, state.power, static_cast<double>(state.motor_C), static_cast<int>(state.reason));
  }
  printf("  hottest: %.1f degC, the coil was limited: %s\n", static_cast<double>(hottest_C),
         was_limited ? "yes" : "no");
  return hottest_C < 80.2f && was_limited && valve.state().power == 0 ? 0 : 1;
}
