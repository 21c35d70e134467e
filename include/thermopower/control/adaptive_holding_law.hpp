// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/policy_call.hpp"
#include "step_power_law.hpp"

/// @file adaptive_holding_law.hpp
/// Learns how much power each pose needs to be held, instead of waiting for an error to ask for it.
///
/// The thesis's law gives power in proportion to an error, so an axis that must hold a weight always stands
/// off its target. Here the power that held the error within its tolerance is remembered for each range of
/// poses; it sinks slowly while the axis stands well, to find out whether less will do, and rises fast when
/// it does not.

namespace thermopower {

/// What one tunes.
struct AdaptiveHoldingConfig {
  float tolerance_deg;  ///< Error that is good enough. Above 0.
  float
      full_power_error_deg;  ///< Error worth full power at once, whatever was learned. Above `tolerance_deg`.
  float learning_per_s;      ///< Counts per second that the memory rises at twice the tolerance. Above 0.
  float forgetting_per_s;    ///< Counts per second that it sinks within the tolerance. >= 0; far below
                             ///< `learning_per_s`.
  uint8_t least_power;       ///< The memory does not sink below this. At least 1.
  uint8_t highest_power;     ///< Nor is more than this asked for. Not below `least_power`.
  float first_pose_deg;      ///< Pose at the first range's edge.
  float last_pose_deg;       ///< Pose at the last range's edge; above `first_pose_deg`.

  /// A tenth of a degree, full power at one degree, 40 counts up and 1 down per second, poses -90 to 90
  /// degrees.
  static AdaptiveHoldingConfig standard() noexcept {
    const AdaptiveHoldingConfig config = {0.1f, 1.0f, 40.0f, 1.0f, 10, 250, -90.0f, 90.0f};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.tolerance_deg, self.full_power_error_deg, self.learning_per_s, self.forgetting_per_s,
            self.least_power, self.highest_power, self.first_pose_deg, self.last_pose_deg);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_positive(tolerance_deg, ConfigError::tolerance_deg)))
      return ConfigError::tolerance_deg;
    if (!detail::is_finite(full_power_error_deg) || full_power_error_deg <= tolerance_deg)
      return ConfigError::full_power_error_deg;
    if (is_error(detail::require_positive(learning_per_s, ConfigError::learning_per_s)))
      return ConfigError::learning_per_s;
    if (is_error(
            detail::require_within(forgetting_per_s, 0.0f, learning_per_s, ConfigError::forgetting_per_s)))
      return ConfigError::forgetting_per_s;
    if (least_power < 1) return ConfigError::least_power;
    if (highest_power < least_power) return ConfigError::highest_power;
    return detail::is_finite(first_pose_deg) && detail::is_finite(last_pose_deg) &&
                   last_pose_deg > first_pose_deg
               ? ConfigError::none
               : ConfigError::pose_deg;
  }
};

/// Power law with a memory per range of poses.
/// @tparam bins  ranges of poses, 1 .. 64; each costs two bytes
///
/// The power is the memory of this pose plus what the error beyond its tolerance is worth. It never exceeds
/// `highest_power`, and at a limiter's mercy it learns nothing: what was not granted is no evidence that
/// it was not enough. The pose and what was granted come with the axis's facts.
///
/// @snippet control_examples.cpp holding law
/// How to: @ref custom_actuator. Menu: @ref policies.
template <uint8_t bins = 8>
class AdaptiveHoldingLaw {
  static_assert(bins >= 1 && bins <= 64, "thermopower: AdaptiveHoldingLaw takes 1 .. 64 ranges of poses");

public:
  typedef AdaptiveHoldingConfig Config;  ///< What one tunes.

  /// What one logs.
  struct State {
    uint16_t learned[bins];  ///< Power that held each range, in 1/128 count.
    float rest;              ///< Part of a 1/128 count that has not been learned yet.
    uint8_t bin;             ///< The range of the present pose.
    bool is_held;            ///< Nothing was learned in the last step: less was granted than was asked for.
  };

  /// Every range starts from the least power: what holds it has to be learned.
  /// @param config  constants; ask `validate()` once
  explicit AdaptiveHoldingLaw(const Config& config = Config::standard()) noexcept : config_(config) {
    for (uint8_t i = 0; i < bins; ++i) state_.learned[i] = units(static_cast<float>(config.least_power));
    state_.rest = 0.0f;
    state_.bin = 0;
    state_.is_held = false;
    per_bin_ = static_cast<float>(bins) / (config.last_pose_deg - config.first_pose_deg);
    boost_ = static_cast<float>(config.highest_power) / (config.full_power_error_deg - config.tolerance_deg);
    per_tolerance_ = 1.0f / config.tolerance_deg;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param error_deg  folded position error; NaN and Inf ask for the least power and teach nothing
  /// @param facts      read are the pose (beyond the configured ones the nearest range counts; NaN changes nothing)
  ///                   and why less was granted last time
  /// @param dt_s       time since the last step; a bad one teaches nothing
  uint8_t step(float error_deg, const AxisFacts& facts, float dt_s) noexcept {
    at_pose(facts.pose_deg);
    state_.is_held = facts.last_reason != LimitReason::none;
    if (!detail::is_finite(error_deg)) return config_.least_power;
    const float beyond_deg = detail::magnitude(error_deg) - config_.tolerance_deg;
    // An axis that was thrown this far teaches nothing about what its pose needs.
    const bool is_thrown = !(beyond_deg < config_.full_power_error_deg - config_.tolerance_deg);
    if (!state_.is_held && !is_thrown && detail::is_finite_positive(dt_s)) learn(beyond_deg, dt_s);
    const float held = static_cast<float>(state_.learned[state_.bin]) * (1.0f / 128.0f);
    const float power = held + (beyond_deg > 0.0f ? beyond_deg * boost_ : 0.0f) + 0.5f;
    const float highest = static_cast<float>(config_.highest_power);
    return power >= highest ? config_.highest_power : static_cast<uint8_t>(power);
  }

  /// Power that holds a range of poses, as learned. @param bin  0 .. bins - 1
  float learned_power(uint8_t bin) const noexcept {
    return static_cast<float>(state_.learned[bin < bins ? bin : bins - 1]) * (1.0f / 128.0f);
  }
  const State& state() const noexcept { return state_; }     ///< What was learned.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  static uint16_t units(float power) noexcept { return static_cast<uint16_t>(power * 128.0f); }

  void at_pose(float pose_deg) noexcept {
    const float place = (pose_deg - config_.first_pose_deg) * per_bin_;
    if (!detail::is_finite(place)) return;
    const uint8_t bin = place >= static_cast<float>(bins) ? static_cast<uint8_t>(bins - 1)
                                                          : static_cast<uint8_t>(place > 0.0f ? place : 0.0f);
    if (bin != state_.bin) state_.rest = 0.0f;
    state_.bin = bin;
  }

  void learn(float beyond_deg, float dt_s) noexcept {
    // Up in proportion, but no faster than at four times the tolerance: one bump must not teach a pose to
    // cost full power.
    const float rate = beyond_deg > 0.0f
                           ? config_.learning_per_s * detail::at_most(beyond_deg * per_tolerance_, 3.0f)
                           : -config_.forgetting_per_s;
    state_.rest += rate * dt_s * 128.0f;
    const int16_t whole =
        static_cast<int16_t>(detail::at_most(detail::at_least(state_.rest, -32000.0f), 32000.0f));
    state_.rest -= static_cast<float>(whole);
    const int32_t least = units(static_cast<float>(config_.least_power)),
                  most = units(static_cast<float>(config_.highest_power));
    const int32_t next = static_cast<int32_t>(state_.learned[state_.bin]) + whole;
    state_.learned[state_.bin] = static_cast<uint16_t>(next < least ? least : (next > most ? most : next));
  }

  Config config_;
  State state_;
  float per_bin_, boost_, per_tolerance_;
};

}  // namespace thermopower
