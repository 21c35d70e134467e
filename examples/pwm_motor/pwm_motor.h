// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The sketch without its pins: what it decides from what it reads. It runs on a PC as it is, and a recorded run replays there.
#pragma once

#include <thermopower/thermopower.hpp>

// Measure them on your motor: docs/how-to/custom-motor.md. At a standstill a winding takes V / R, the most that it can.
template <class Step>
class BasicPwmMotor {
public:
  // Everything that a step reads.
  struct Told {
    uint16_t passed_ms;      // since the last step
    uint16_t supply_counts;  // of 1023 at 15 V
    uint16_t demand_counts;  // of 1023

    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.passed_ms, self.supply_counts, self.demand_counts);
    }
  };
  struct Answered {
    uint8_t demand;  // counts of 255
    uint8_t power;   // for the pin
    float motor_C;   // the winding

    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.demand, self.power, self.motor_C);
    }
  };

  // 6 ohm at 20 degC, copper; 9 J/K, 0.12 W/K. After a reset nobody knows how warm the winding is: as warm as it may be.
  BasicPwmMotor()
      : current_({6.0f, 0.00393f, 20.0f}),
        motor_({{9.0f}, {0.12f}}, limit_C()),
        limiter_({limit_C(), 5.0f, 50.0f}) {}

  bool is_wrong() const {
    return thermopower::is_error(current_.validate()) || thermopower::is_error(motor_.validate()) ||
           thermopower::is_error(limiter_.validate());
  }

  Answered step(const Told& told) {
    const float dt_s = 0.001f * static_cast<float>(told.passed_ms);
    const float read_V = static_cast<float>(told.supply_counts) * (15.0f / 1023.0f);
    const bool is_supply_known = read_V > lowest_V() && read_V < highest_V();
    // What was in force since the last step heated the winding; at an unknown supply as much as it can.
    const typename Current::State drawn = current_.at_power(
        static_cast<float>(power_), is_supply_known ? read_V : highest_V(), motor_.hottest_C());
    motor_.step({drawn.winding_power_W, drawn.v_rms_V, {warmest_air_C(), 0.0f}}, dt_s);

    const uint8_t demand = static_cast<uint8_t>(is_supply_known ? told.demand_counts / 4 : 0);
    power_ =
        limiter_
            .step({demand, thermopower::GuardedCelsius::hottest_of(motor_), motor_.hottest_rate_K_per_s()},
                  dt_s)
            .power;
    const Answered answered = {demand, power_, motor_.hottest_C()};
    return answered;
  }

private:
  typedef thermopower::CurrentModel<thermopower::OhmicCurrent<> > Current;
  typedef thermopower::ThermalModel<thermopower::HeatCapacityHeating<>, thermopower::NewtonCooling<>, Step>
      Motor;
  static constexpr float limit_C() { return 80.0f; }
  static constexpr float warmest_air_C() { return 40.0f; }
  // Of the supply; outside of it the divider is broken.
  static constexpr float lowest_V() { return 5.0f; }
  static constexpr float highest_V() { return 15.0f; }

  Current current_;
  Motor motor_;
  thermopower::SafetyLimiter<> limiter_;
  uint8_t power_ = 0;  // in force
};

typedef BasicPwmMotor<thermopower::ExactStep> PwmMotor;
