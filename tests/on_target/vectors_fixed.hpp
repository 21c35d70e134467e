// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/thermopower.hpp>

#include "report.hpp"

/// Input vectors for what computes in whole numbers: every result is the same to the bit on every machine, so
/// sums over many of them are compared. The products are assembly on AVR.
namespace on_target {

/// A sum in which order and every bit count.
class Digest {
public:
  void add(uint32_t value) { sum_ = (sum_ << 5 | sum_ >> 27) ^ (sum_ + value); }
  int32_t value() const { return static_cast<int32_t>(sum_); }

private:
  uint32_t sum_ = 1;
};

inline void run_products(Report& report) {
  namespace detail = thermopower::fixed_point::detail;
  report.section("products");
  uint32_t random = 1;
  const auto next = [&random]() {
    random = random * 1664525u + 1013904223u;
    return random;
  };
  for (uint8_t block = 0; block < 20; ++block) {
    Digest scaled, q15, part, product, three, quotient;
    for (uint8_t count = 0; count < 250; ++count) {
      const uint32_t first = next(), second = next();
      // One in five at the ends of the range.
      const bool is_end = count % 5u == 0;
      const uint16_t factor =
          static_cast<uint16_t>(is_end ? (first & 0x10000u ? 0xFFFFu : 0u) : second >> 16);
      const int16_t left = static_cast<int16_t>(is_end ? (first & 0x20000u ? 0x7FFF : -0x7FFF)
                                                       : static_cast<int16_t>(first >> 16));
      const int16_t right = static_cast<int16_t>(second >> 16 == 0x8000u ? 0 : second >> 16);
      const uint8_t byte = static_cast<uint8_t>(is_end ? (first & 0x40000u ? 255u : 0u) : first >> 8);
      scaled.add(static_cast<uint32_t>(detail::scaled(static_cast<int32_t>(first), factor)));
      q15.add(static_cast<uint32_t>(detail::product_q15(left == -0x7FFF - 1 ? int16_t(0) : left, right)));
      part.add(static_cast<uint32_t>(detail::part_of(left, byte)));
      product.add(static_cast<uint32_t>(detail::product(left, factor & 0x7FFFu)));
      three.add(detail::product_of_three(static_cast<uint16_t>(left) & 0x7FFFu, factor, byte));
      quotient.add(static_cast<uint32_t>(
          detail::quotient(static_cast<uint16_t>(left) & 0x7FFFu, byte,
                           static_cast<int8_t>(static_cast<int8_t>(first % 17u) - 8), right)));
    }
    const Digest digests[] = {scaled, q15, part, product, three, quotient};
    for (const Digest& digest : digests) report.integer(digest.value());
  }
}

template <class Motor>
[[gnu::noinline]] void run_fixed_heating(Report& report) {
  report.section("fixed heating");
  for (uint16_t level = 0; level < 256; ++level) {
    Digest digest;
    // -50 .. 180 degC by 1.3 K.
    for (int16_t motor = -6400; motor <= 23040; motor = static_cast<int16_t>(motor + 167))
      digest.add(static_cast<uint32_t>(
          thermopower::fixed_point::Heating<thermopower::fixed_point::ThesisMotor<Motor> >::rate(
              static_cast<uint8_t>(level), motor)));
    report.integer(digest.value());
  }
}

/// As sbgc::RealtimeData.
struct FixedTelemetry {
  uint16_t cycle;
  int16_t target_angle(uint8_t axis) const { return static_cast<int16_t>(cycle * (axis == 2 ? 577u : 0u)); }
  int16_t imu_angle(uint8_t axis) const { return static_cast<int16_t>(axis == 0 ? 90 : cycle % 97u * axis); }
  int8_t imu_C() const { return cycle < 300 ? 38 : 45; }
  int8_t frame_imu_C() const { return static_cast<int8_t>(cycle % 50u == 7u ? 0 : 39); }
  uint16_t battery_cV() const { return cycle > 500 && cycle < 510 ? 200 : 1260; }
};

[[gnu::noinline]] inline void run_fixed_gimbal(Report& report) {
  namespace tp = thermopower;
  namespace fixed = thermopower::fixed_point;
  typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t::AsProgrammed> > Small;
  typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm5208_200_12> > Large;
  typedef fixed::AxisController<Small, fixed::ProgrammedLevels<>,
                                fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle>,
                                fixed::TruncatedGain<24, 4> >
      Roll;
  typedef fixed::AxisController<Small, fixed::HysteresisLevels<>, fixed::SafetyLimiter<>,
                                fixed::RoundedGain<180, 105> >
      Pitch;
  typedef fixed::AxisController<Large, fixed::ProgrammedLevels<>, fixed::SafetyLimiter<>, fixed::NoGain> Yaw;
  report.section("fixed gimbal");
  static fixed::GimbalController<Roll, Pitch, Yaw> gimbal;
  for (uint16_t cycle = 0; cycle < 900; ++cycle) {
    const FixedTelemetry telemetry = {cycle};
    const fixed::Ticks ticks = static_cast<fixed::Ticks>(120u + cycle * 7u % 20u);
    const auto& command = cycle % 211u == 200u ? gimbal.step_silent(2500) : gimbal.step(telemetry, ticks);
    gimbal.prepare();
    Digest digest;
    for (uint8_t axis = 0; axis < 3; ++axis) {
      digest.add(command.power[axis]);
      digest.add(command.p_gain[axis]);
      digest.add(static_cast<uint8_t>(command.reason[axis]));
    }
    digest.add(static_cast<uint32_t>(gimbal.axis<0>().thermal().state().motor));
    digest.add(static_cast<uint32_t>(gimbal.axis<1>().thermal().state().motor));
    digest.add(static_cast<uint32_t>(gimbal.axis<2>().thermal().state().motor));
    report.integer(digest.value());
  }
}

/// A motor with all balances of the monitor: its inputs are binary fractions, the same on every machine.
struct WatchedMotor {
  static constexpr thermopower::MonitorConfig monitor() { return {2.0, 1000.0, true}; }
  static constexpr thermopower::HeatBalanceConfig heat_balance() {
    return thermopower::HeatBalanceConfig::measured_body(30.0, 8.0, 80.0, 1.0, 0.2, 0.1, 0.1);
  }
  static constexpr thermopower::WindingBalanceConfig winding_balance() {
    return {24.0, 12.0, 0.05, 0.00393, 25.0, 15.0, 0.2, 0.1};
  }
  static constexpr thermopower::MotionBalanceConfig motion_balance() {
    return {4.0, 400.0, 2.0, 0.05, 0.05, 1e-5, 0.05, 0.004, 1e-5, 0.3, 0.002, 0.002};
  }
};

[[gnu::noinline]] inline void run_monitor(Report& report) {
  namespace tp = thermopower;
  report.section("monitor");
  static tp::ModelMonitor<WatchedMotor> monitor;
  for (uint8_t block = 0; block < 24; ++block) {
    Digest digest;
    for (uint8_t count = 0; count < 100; ++count) {
      // Heat and a housing that follows it at first, and then stands still.
      const uint16_t step = static_cast<uint16_t>(block * 100u + count);
      const uint16_t warmer = step < 1200 ? step : uint16_t(1200);
      const tp::MonitorInputs inputs = tp::MonitorInputs::motor(
          block == 20 && count == 7 ? tp::detail::not_a_number() : 12.0f,
          25.0f + static_cast<float>(warmer) * 0.0078125f, 25.0f, static_cast<float>(step % 128u) * 0.125f,
          static_cast<float>(step % 64u) * 0.03125f - 1.0f, 25.0f + static_cast<float>(warmer) * 0.015625f,
          static_cast<float>(step % 512u) - 128.0f);
      digest.add(static_cast<uint32_t>(monitor.step(inputs, 0.125f)));
      digest.add(monitor.heat().evidence().more);
      digest.add(monitor.heat().evidence().less);
      digest.add(static_cast<uint32_t>(monitor.heat().heater_set()) << 16 |
                 static_cast<uint32_t>(monitor.heat().loss_set()) << 8 | monitor.heat().air_set());
      digest.add(monitor.suspects());
      digest.add(monitor.record().since_s);
    }
    report.integer(digest.value());
  }
}

}  // namespace on_target
