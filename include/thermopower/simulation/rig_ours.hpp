// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/control/adaptive_holding_law.hpp>
#include <thermopower/control/certified/limiter.hpp>
#include <thermopower/control/eased_gain.hpp>
#include <thermopower/control/reserve_law.hpp>
#include <thermopower/control/sag_aware_law.hpp>
#include <thermopower/control/voltage_gain.hpp>
#include <thermopower/simulation/rig_policies.hpp>

/// @file rig_ours.hpp
/// The library's own choice for the rig: learned holding power, corrected for the supply, with a reserve while
/// the axis is disturbed, under a certified limiter, with the gain from the torque that is there, eased for
/// errors that no tracking makes.

namespace thermopower::simulation {

/// Its gain: the motors' current rises nearly with POWER, and the torque with it.
using AdaptiveGain = EasedGain<BasicVoltageGain<SineDrive>>;

/// One axis of it.
template <class Motor>
using AdaptiveAxis = AxisController<Motor, ReserveLaw<SagAwareLaw<AdaptiveHoldingLaw<8>>>,
                                    CertifiedLimiter<CertifiedTwoNode, SquareHeat>, AdaptiveGain>;

/// What was tuned for the rig, on draws (see `standard_scenarios`) that no table in the documentation uses.
struct AdaptiveTuning {
  float tolerance_deg = 0.2f;         ///< Error that is good enough.
  float full_power_error_deg = 0.8f;  ///< Error worth full power at once.
  /// Holds each axis at rest: roll carries the most weight.
  std::array<std::uint8_t, 3> least_power = {26, 20, 18};
  /// Kept while the axis is being disturbed.
  std::array<std::uint8_t, 3> reserve_power = {50, 46, 46};
  float moving_error_deg = 0.08f;  ///< An error beyond this is a disturbance.
  float calm_s = 4.0f;             ///< The reserve outlasts the last disturbance by this.
  float forgetting_per_s = 2.0f;   ///< Counts per second that a learned power sinks.
  /// Stiffness of the loop at every POWER, against that of eq 4.27 at POWER 89; as far as a P of 255 reaches.
  float stiffness = 2.67f;
  float ease_from_deg = 1.5f;  ///< Error beyond which the gain is eased.
  std::uint8_t far_gain = 3;   ///< Not eased below this.
};

/// Configuration of one axis. @param axis  0 roll, 1 pitch, 2 yaw
template <class Motor>
typename AdaptiveAxis<Motor>::Config adaptive_axis(std::size_t axis, const AdaptiveTuning& tuning = {}) {
  typedef AdaptiveAxis<Motor> Axis;
  const bool is_large = axis == 2;
  typename Axis::Config config = Axis::Config::standard();
  auto& reserve = config.power_law;
  reserve.reserve_power = tuning.reserve_power[axis];
  reserve.moving_error_deg = tuning.moving_error_deg;
  reserve.calm_s = tuning.calm_s;
  auto& holding = reserve.law.law;
  holding.tolerance_deg = tuning.tolerance_deg;
  holding.full_power_error_deg = tuning.full_power_error_deg;
  holding.least_power = tuning.least_power[axis];
  holding.forgetting_per_s = tuning.forgetting_per_s;
  holding.first_pose_deg = -180.0f, holding.last_pose_deg = 180.0f;

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
                                       {0.0038f, 0.0040f}, 25.0f, 0.0f, 120.0f, 3.0f);
  limiter.use.heat.heat_when_cold_W *= 1.5f, limiter.use.heat.heat_when_hot_W *= 1.5f;
  limiter.use.highest_air_C = 45.0f;

  constexpr float gain_at_89[3] = {17.0f, 154.0f, 26.7f};
  auto& gain = config.gain.gain;
  gain.gain_low_power = std::fmin(255.0f, tuning.stiffness * gain_at_89[axis]);
  gain.tuned_power = standard_power;
  gain.magnet_tempco_per_K = 0.0012f;
  config.gain.ease_from_deg = tuning.ease_from_deg;
  config.gain.far_gain = tuning.far_gain;
  return config;
}

/// Constant power with the gain that ours has at that power: what the stiffness alone is worth.
inline ConstantPower stiff_constant_power(const AdaptiveTuning& tuning = {},
                                          std::uint8_t power = standard_power) {
  const auto gain = [power](const AdaptiveGain::Config& config) {
    return AdaptiveGain(config).step(power, AxisFacts::unknown());
  };
  return ConstantPower({power, power, power}, {gain(adaptive_axis<motors::Bgm2606_90t>(0, tuning).gain),
                                               gain(adaptive_axis<motors::Bgm2606_90t>(1, tuning).gain),
                                               gain(adaptive_axis<motors::Bgm5208_200_12>(2, tuning).gain)});
}

/// The gimbal of three such axes.
///
/// @snippet simulation_examples.cpp rig
/// How to: @ref rig.
class AdaptiveGimbal {
  using Small = AdaptiveAxis<motors::Bgm2606_90t>;
  using Large = AdaptiveAxis<motors::Bgm5208_200_12>;

public:
  /// @param started_C  temperature of each motor at the start, not below the truth: from a stored state and
  ///                   the time off, from the winding's resistance, or 60 (its limit) when nothing is known.
  ///                   "As warm as the air" is wrong after a hot run.
  /// @param tuning     the same for every axis
  /// @param air_C      air measured at the start; NaN: its highest until the first step
  explicit AdaptiveGimbal(const std::array<float, 3>& started_C = {60.0f, 60.0f, 60.0f},
                          const AdaptiveTuning& tuning = {},
                          float air_C = thermopower::detail::not_a_number())
      : gimbal_(GimbalConfig::believing(), adaptive_axis<motors::Bgm2606_90t>(0, tuning),
                adaptive_axis<motors::Bgm2606_90t>(1, tuning),
                adaptive_axis<motors::Bgm5208_200_12>(2, tuning)) {
    gimbal_.axis<0>().limiter().start(started_C[0], started_C[0], air_C);
    gimbal_.axis<1>().limiter().start(started_C[1], started_C[1], air_C);
    gimbal_.axis<2>().limiter().start(started_C[2], started_C[2], air_C);
  }

  /// One control cycle, as `GimbalController::step`.
  template <class Telemetry>
  const GimbalCommand<3>& step(const Telemetry& telemetry, float dt_s) noexcept {
    return gimbal_.step(telemetry, dt_s);
  }
  /// One silent cycle.
  const GimbalCommand<3>& step_silent(float dt_s) noexcept { return gimbal_.step_silent(dt_s); }

  /// Inside.
  const BasicGimbalController<MeasuredSupply, Small, Small, Large>& gimbal() const noexcept {
    return gimbal_;
  }

private:
  BasicGimbalController<MeasuredSupply, Small, Small, Large> gimbal_;
};

}  // namespace thermopower::simulation
