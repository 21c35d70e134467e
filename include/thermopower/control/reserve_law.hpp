// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/composition.hpp"
#include "detail/policy_call.hpp"
#include "step_power_law.hpp"

/// @file reserve_law.hpp
/// Keeps a reserve of torque while an axis is being disturbed.

namespace thermopower {

/// Any power law, with a floor under it while the axis is in motion.
/// @tparam Law  the law that says what is needed beyond that
///
/// A board's integral holds a share of the torque that POWER makes available. So a POWER that follows every
/// error up and down pushes the camera each time it changes, and one that waits for an error is too late for
/// the next gust. Here an error beyond `moving_error_deg` lifts the power to a steady reserve, which stays
/// until there was none for `calm_s`, and then sinks slowly. An axis at rest pays for none of it.
///
/// @snippet control_examples.cpp reserve law
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Law = StepPowerLaw<>>
class ReserveLaw {
  static_assert(
      detail::IsPowerLaw<Law>::value,
      "thermopower: the parameter of ReserveLaw must be a power law: a type with Config and step(error_deg) or "
      "step(error_deg, facts, dt_s)");

public:
  /// What one tunes.
  struct Config {
    typename Law::Config law;  ///< Of the law itself.
    uint8_t reserve_power;     ///< Power kept while the axis is being disturbed. At least 1.
    float moving_error_deg;    ///< An error beyond this is a disturbance. Above 0, and above noise.
    float calm_s;              ///< The reserve is kept for this long after the last one. >= 0.
    float rise_per_s;          ///< Counts per second that it rises at. Above 0.
    float fall_per_s;          ///< Counts per second that it sinks at. Above 0.

    /// The law's standard; a reserve of 50 for errors beyond 0.08 degree (four steps of the telemetry), for
    /// 4 s; up in a quarter of a second, down in twenty-five.
    static Config standard() noexcept {
      const Config config = {Law::Config::standard(), 50, 0.08f, 4.0f, 200.0f, 2.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.law, self.reserve_power, self.moving_error_deg, self.calm_s, self.rise_per_s,
              self.fall_per_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (is_error(law.validate())) return law.validate();
      if (reserve_power < 1) return ConfigError::reserve_power;
      if (is_error(detail::require_positive(moving_error_deg, ConfigError::moving_error_deg)))
        return ConfigError::moving_error_deg;
      return first_error(detail::require_not_negative(calm_s, ConfigError::calm_s),
                         detail::require_positive(rise_per_s, ConfigError::rise_per_s),
                         detail::require_positive(fall_per_s, ConfigError::fall_per_s));
    }
  };

  /// What one logs.
  struct State {
    uint8_t asked;  ///< What the law asked for.
    float reserve;  ///< Power kept in reserve, 0 .. `reserve_power`.
    float calm_s;   ///< Time since the last disturbance; stops at the configured one.
  };

  /// Starts calm, without a reserve. @param config  constants; ask `validate()` once
  explicit ReserveLaw(const Config& config = Config::standard()) noexcept
      : config_(config), law_(config.law) {
    state_.asked = least_power();
    state_.reserve = 0.0f;
    state_.calm_s = config.calm_s;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param error_deg  folded position error; NaN and Inf count as neither calm nor a disturbance
  /// @param facts      what the law itself reads
  /// @param dt_s       time since the last step; a bad one leaves the reserve as it is
  uint8_t step(float error_deg, const AxisFacts& facts, float dt_s) noexcept {
    state_.asked = detail::demanded_power(law_, error_deg, facts, dt_s, 0);
    if (detail::is_finite_positive(dt_s) && detail::is_finite(error_deg)) carry(error_deg, dt_s);
    const uint8_t floor = static_cast<uint8_t>(state_.reserve);
    return state_.asked > floor ? state_.asked : floor;
  }

  const Law& law() const noexcept { return law_; }           ///< The law inside.
  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  void carry(float error_deg, float dt_s) noexcept {
    const float highest = static_cast<float>(config_.reserve_power);
    if (detail::magnitude(error_deg) > config_.moving_error_deg) state_.calm_s = 0.0f;
    else state_.calm_s = detail::at_most(state_.calm_s + dt_s, config_.calm_s);
    state_.reserve = state_.calm_s < config_.calm_s
                         ? detail::at_most(state_.reserve + config_.rise_per_s * dt_s, highest)
                         : detail::at_least(state_.reserve - config_.fall_per_s * dt_s, 0.0f);
  }

  Config config_;
  Law law_;
  State state_;
};

}  // namespace thermopower
