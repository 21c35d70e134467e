// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../control/adaptive_holding_law.hpp"
#include "../control/certified_limiter.hpp"
#include "../control/sag_aware_law.hpp"
#include "../control/voltage_gain.hpp"
#include "rig_policies.hpp"

/// @file rig_ours.hpp
/// The library's own choice for the rig: learned holding power, corrected for the supply, under a certified
/// limiter, with the gain from the torque that is there.

namespace thermopower::simulation {

/// One axis of it.
template <class Motor>
using AdaptiveAxis =
    AxisController<Motor, SagAwareLaw<AdaptiveHoldingLaw<8>>, CertifiedLimiter<CertifiedTwoNode, SquareHeat>,
                   GainScheduler<VoltageGain>>;

/// What was tuned for the rig, on draws (see `standard_scenarios`) that no table in the documentation uses.
struct AdaptiveTuning {
  float tolerance_deg = 0.14f;                             ///< Error that is good enough.
  float full_power_error_deg = 0.8f;                       ///< Error worth full power at once.
  std::array<std::uint8_t, 3> least_power = {30, 22, 20};  ///< Holds each axis at rest: roll carries the most
                                                           ///< weight.
  float forgetting_per_s = 8.0f;                           ///< Counts per second that a learned power sinks.
  float stiffness = 1.7f;  ///< Gain at POWER 45 against the one that is as stiff as eq 4.27 is at POWER 89.
};

/// Configuration of one axis. @param axis  0 roll, 1 pitch, 2 yaw
template <class Motor>
typename AdaptiveAxis<Motor>::Config adaptive_axis(std::size_t axis, const AdaptiveTuning& tuning = {}) {
  typedef AdaptiveAxis<Motor> Axis;
  const bool is_large = axis == 2;
  typename Axis::Config config = Axis::Config::standard();
  config.power_law.law.tolerance_deg = tuning.tolerance_deg;
  config.power_law.law.full_power_error_deg = tuning.full_power_error_deg;
  config.power_law.law.least_power = tuning.least_power[axis];
  config.power_law.law.forgetting_per_s = tuning.forgetting_per_s;
  config.power_law.law.first_pose_deg = -180.0f, config.power_law.law.last_pose_deg = 180.0f;

  // Measured in Tables 4.1 to 4.3 and 4.6; bounds of 15 %. The heat of Tables 4.1 and 4.2 rises with
  // POWER^1.86 to 1.9, a little less than its square: half as much again at full POWER covers that down to
  // POWER 14, below which there is less than 0.1 W.
  const float resistance_ohm = is_large ? 17.5f : 11.1f;
  auto& limiter = config.limiter;
  limiter.network = {is_large ? Bounds::around(18.0f, 0.15f) : Bounds::around(4.5f, 0.15f),
                     is_large ? Bounds::around(138.0f, 0.15f) : Bounds::around(21.5f, 0.15f),
                     is_large ? 1.0f : 0.38f,
                     is_large ? 0.11f : 0.045f,
                     120.0f,
                     60.0f};
  limiter.use.heat = HeatBounds::ohmic(13.0f, 0.02f, Bounds::around(resistance_ohm, 0.10f),
                                       {0.0038f, 0.0040f}, 25.0f, 0.0f, 120.0f);
  limiter.use.heat.heat_when_cold_W *= 1.5f, limiter.use.heat.heat_when_hot_W *= 1.5f;
  limiter.use.highest_air_C = 45.0f;

  constexpr float gain_at_89[3] = {17.0f, 154.0f, 26.7f};
  config.gain.gain_low_power = std::fmin(255.0f, tuning.stiffness * gain_at_89[axis] * 1.88f);  // (89 /
                                                                                                // 45)^0.93
  config.gain.tuned_power = 45;
  config.gain.magnet_tempco_per_K = 0.0012f;
  return config;
}

/// The gimbal of three such axes. It tells each law where its axis stands, and not to learn while the limiter
/// holds it back.
class AdaptiveGimbal {
  using Small = AdaptiveAxis<motors::Bgm2606_90t>;
  using Large = AdaptiveAxis<motors::Bgm5208_200_12>;

 public:
  /// @param started_C  temperature of each motor at the start, not below the truth: from a stored state and
  /// the time off, from the
  ///                   winding's resistance, or 60 (its limit) when nothing is known. "As warm as the air" is
  ///                   wrong after a hot run.
  /// @param tuning     the same for every axis
  explicit AdaptiveGimbal(const std::array<float, 3>& started_C = {60.0f, 60.0f, 60.0f},
                          const AdaptiveTuning& tuning = {})
      : gimbal_(GimbalConfig::standard(), adaptive_axis<motors::Bgm2606_90t>(0, tuning),
                adaptive_axis<motors::Bgm2606_90t>(1, tuning),
                adaptive_axis<motors::Bgm5208_200_12>(2, tuning)) {
    gimbal_.axis<0>().limiter().start(started_C[0], started_C[0]);
    gimbal_.axis<1>().limiter().start(started_C[1], started_C[1]);
    gimbal_.axis<2>().limiter().start(started_C[2], started_C[2]);
  }

  /// One control cycle, as `GimbalController::step`.
  template <class Telemetry>
  const GimbalCommand<3>& step(const Telemetry& telemetry, float dt_s) noexcept {
    tell(gimbal_.axis<0>(), telemetry.imu_angle_deg(0));
    tell(gimbal_.axis<1>(), telemetry.imu_angle_deg(1));
    tell(gimbal_.axis<2>(), telemetry.imu_angle_deg(2));
    return gimbal_.step(telemetry, dt_s);
  }
  /// One silent cycle.
  const GimbalCommand<3>& step_silent(float dt_s) noexcept { return gimbal_.step_silent(dt_s); }

  /// Inside.
  const BasicGimbalController<MeasuredSupply, Small, Small, Large>& gimbal() const noexcept {
    return gimbal_;
  }

 private:
  template <class Axis>
  static void tell(Axis& axis, float pose_deg) noexcept {
    axis.power_law().law().at_pose(pose_deg);
    axis.power_law().law().hold_memory(axis.state().reason != LimitReason::none);
  }

  BasicGimbalController<MeasuredSupply, Small, Small, Large> gimbal_;
};

}  // namespace thermopower::simulation
