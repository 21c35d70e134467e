// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// A motor written out from the thesis's tables, what a board says, and the two gimbal controllers behind one face. The
// motor shares no code with the library.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <thermopower/thermopower.hpp>

namespace failing {

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;
using tp::LimitReason;

constexpr double air_C = 25.0, limit_C = 60.0, cycle_s = 0.03;

/// The roll motor: regression of Table 4.1 (current), Table 4.9 (heating), k = 0.11 per minute.
struct Motor {
  double now_C = air_C;
  void spend(int power, double supply_V, double dt_s = cycle_s) {
    const double volt = supply_V * std::sqrt(power / 255.0);
    double rate_per_min = -0.11 * (now_C - air_C);
    if (volt > 1.0) {
      const double slope_mA_per_K = -0.013445 * volt * volt + 0.015576 * volt + 0.016839;
      const double current_A = (slope_mA_per_K * now_C + 0.155098 * std::pow(volt, 3.459071)) / 1000.0;
      rate_per_min += volt * std::max(0.0, current_A) /
                      ((-0.00024249 * volt + 0.00620096) * now_C + 0.02545869 * volt - 0.10495822);
    }
    now_C += rate_per_min / 60.0 * dt_s;
  }
};

/// What the board says.
struct Telemetry {
  double error = 5.0;
  int camera = static_cast<int>(air_C), frame = static_cast<int>(air_C);
  double supply_V = 13.0;
  int reported = 0;
  float error_deg(std::uint8_t) const { return static_cast<float>(error); }
  std::int16_t target_angle(std::uint8_t) const { return static_cast<std::int16_t>(error * 45.5111); }
  std::int16_t imu_angle(std::uint8_t) const { return 0; }
  std::int8_t imu_C() const { return static_cast<std::int8_t>(camera); }
  std::int8_t frame_imu_C() const { return static_cast<std::int8_t>(frame); }
  float battery_V() const { return static_cast<float>(supply_V); }
  std::uint16_t battery_cV() const { return static_cast<std::uint16_t>(supply_V * 100.0 + 0.5); }
  std::uint8_t motor_power(std::uint8_t) const { return static_cast<std::uint8_t>(reported); }
};

/// The controllers under test behind one face.
struct FloatGimbal {
  typedef tp::BasicGimbalController<tp::MeasuredSupply, tp::AxisController<tp::motors::Bgm2606_90t>> Gimbal;
  Gimbal gimbal{tp::GimbalConfig::believing(),
                tp::AxisController<tp::motors::Bgm2606_90t>::Config::with_gain({24.0f, 4.0f})};
  const Gimbal::Command& step(const Telemetry& telemetry, double dt_s = cycle_s) {
    return gimbal.step(telemetry, static_cast<float>(dt_s));
  }
  const Gimbal::Command& step_silent(double dt_s = cycle_s) {
    return gimbal.step_silent(static_cast<float>(dt_s));
  }
  double motor_C() { return static_cast<double>(gimbal.axis<0>().state().motor_C); }
};
struct FixedGimbal {
  typedef fixed::BasicGimbalController<
      fixed::BelievingGimbal,
      fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t>>>>
      Gimbal;
  Gimbal gimbal;
  fixed::Clock clock;
  std::uint32_t now_us = 0;
  fixed::Ticks elapsed(double dt_s) {
    return clock.elapsed(now_us += static_cast<std::uint32_t>(dt_s * 1e6));
  }
  const Gimbal::Command& step(const Telemetry& telemetry, double dt_s = cycle_s) {
    gimbal.step(telemetry, elapsed(dt_s));
    gimbal.prepare();
    return gimbal.command();
  }
  const Gimbal::Command& step_silent(double dt_s = cycle_s) {
    gimbal.step_silent(elapsed(dt_s));
    gimbal.prepare();
    return gimbal.command();
  }
  double motor_C() { return static_cast<double>(gimbal.axis<0>().thermal().motor_C()); }
};

/// What a board answers to a command that sets POWER, or to any other.
inline tp::sbgc::Confirm confirm_of(std::uint8_t command) {
  tp::sbgc::Confirm confirm;
  confirm.confirmed_id = command;
  return confirm;
}

}  // namespace failing
