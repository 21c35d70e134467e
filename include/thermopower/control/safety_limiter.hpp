// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "detail/composition.hpp"
#include "guarded_celsius.hpp"
#include "limit_reason.hpp"

/// @file control/safety_limiter.hpp
/// Keeps an actuator below its limit temperature, eq 4.23: T_safety = T_max - t_safety dT/dt.
///
/// | rule | the ceiling moves | when to take it |
/// |---|---|---|
/// | `PerSecond` | at a rate in counts per second | the default: the same at any loop rate |
/// | `PerCycle` | by 1 per call | the original program |
///
/// A rule of your own has a `State` with the ceiling, `start()`, and `lower(state, config, dt_s)`,
/// `raise(...)`, `cut(state)`, `ceiling(state)`.

namespace thermopower {

/// What one tunes.
/// @ingroup control
struct SafetyLimiterConfig {
  float maximum_C;  ///< T_max: above it the power is cut to the least. 0 .. 200 degC. The thesis: 60, because
                    ///< PLA softens.
  float safety_time_s;  ///< t_safety: how long the actuator must be able to go on at its present rate. Above
                        ///< 0. The thesis: 30.
  float rate_per_s;  ///< Read by `PerSecond` only: speed of the ceiling, counts per second, above 0. 33.3 is
                     ///< 1 per 30 ms.

  /// The thesis's values.
  static SafetyLimiterConfig standard() noexcept {
    SafetyLimiterConfig config = {60.0f, 30.0f, 1.0f / 0.03f};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.maximum_C, self.safety_time_s, self.rate_per_s);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(detail::require_within(maximum_C, 0.0f, 200.0f, ConfigError::maximum_C),
                       detail::require_positive(safety_time_s, ConfigError::safety_time_s),
                       detail::require_positive(rate_per_s, ConfigError::rate_per_s));
  }
};

/// The thesis's rule: one count per call, so the speed depends on the loop rate.
///
/// @snippet control_examples.cpp safety limiter
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
struct PerCycle {
  /// The ceiling.
  struct State {
    uint8_t ceiling = 255;  ///< Highest power granted, 1 .. 255.
  };
  /// One step down, not below the least power.
  static void lower(State& state, const SafetyLimiterConfig&, float) noexcept {
    if (state.ceiling > least_power()) --state.ceiling;
  }
  /// One step up, not above 255.
  static void raise(State& state, const SafetyLimiterConfig&, float) noexcept {
    if (state.ceiling < 255) ++state.ceiling;
  }
  static void cut(State& state) noexcept { state.ceiling = least_power(); }      ///< To the least power.
  static uint8_t ceiling(const State& state) noexcept { return state.ceiling; }  ///< In whole counts.
};

/// The same rule in counts per second: independent of the loop rate.
///
/// @snippet control_examples.cpp safety limiter
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
struct PerSecond {
  /// The ceiling.
  struct State {
    float ceiling = 255.0f;  ///< Highest power granted, 1 .. 255, with its fraction.
  };
  /// One step down, not below the least power.
  static void lower(State& state, const SafetyLimiterConfig& config, float dt_s) noexcept {
    state.ceiling =
        detail::at_least(state.ceiling - config.rate_per_s * dt_s, static_cast<float>(least_power()));
  }
  /// One step up, not above 255.
  static void raise(State& state, const SafetyLimiterConfig& config, float dt_s) noexcept {
    state.ceiling = detail::at_most(state.ceiling + config.rate_per_s * dt_s, 255.0f);
  }
  /// To the least power.
  static void cut(State& state) noexcept { state.ceiling = static_cast<float>(least_power()); }
  /// In whole counts.
  static uint8_t ceiling(const State& state) noexcept { return static_cast<uint8_t>(state.ceiling); }
};

/// Limits the power so that the actuator stays below its limit temperature.
/// @tparam Rule  how the ceiling moves
///
/// Guarantees: the power is never above the demand; above T_max it is the least; a temperature, rate or time
/// that is NaN, infinite or impossible (below absolute zero, a negative time) counts as too hot, and so does one for
/// which SensorGuard gives a reason; at equal history a hotter actuator never gets more.
///
/// @snippet control_examples.cpp safety limiter
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
template <class Rule = PerSecond>
class SafetyLimiter {
  static_assert(
      detail::IsCeilingRule<Rule>::value,
      "thermopower: the parameter of SafetyLimiter must be a rule: a type with State, lower, raise, cut and ceiling, such as PerSecond");

public:
  typedef SafetyLimiterConfig Config;  ///< What one tunes.
  typedef typename Rule::State State;  ///< The ceiling.

  /// What the limiter decides on.
  struct Inputs {
    uint8_t demand;          ///< Power parameter asked for.
    GuardedCelsius motor_C;  ///< Temperature: a model's, or one that SensorGuard let through.
    float rate_K_per_s;      ///< dT/dt at the power of the last step.
  };

  /// @param config  constants; ask `validate()` once
  explicit SafetyLimiter(const Config& config = Config::standard()) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param dt_s  time since the last step, >= 0
  LimitedPower step(const Inputs& inputs, float dt_s) noexcept {
    if (is_fault(inputs.motor_C.fault())) return cut(inputs.motor_C.fault(), inputs.demand);
    if (!detail::is_finite(inputs.rate_K_per_s))
      return cut(LimitReason::temperature_not_finite, inputs.demand);
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return cut(LimitReason::time_invalid, inputs.demand);
    if (inputs.motor_C > config_.maximum_C) return cut(LimitReason::over_temperature, inputs.demand);

    const float safety_C = config_.maximum_C - config_.safety_time_s * inputs.rate_K_per_s;  // eq 4.23
    const bool is_safe = inputs.motor_C <= safety_C;
    if (is_safe) Rule::raise(state_, config_, dt_s);
    else Rule::lower(state_, config_, dt_s);

    const uint8_t ceiling = Rule::ceiling(state_);
    LimitedPower granted = {inputs.demand, LimitReason::none};
    if (inputs.demand > ceiling) {
      granted.power = ceiling;
      granted.reason = is_safe ? LimitReason::recovering : LimitReason::safety_temperature;
    }
    return granted;
  }

  /// Least power, or the demand if that is less, for a reason found elsewhere; the ceiling starts again from
  /// there, so that power returns gradually.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    Rule::cut(state_);
    LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }

  uint8_t ceiling() const noexcept { return Rule::ceiling(state_); }  ///< Highest power granted now.
  const State& state() const noexcept { return state_; }              ///< The rule's own memory.
  const Config& config() const noexcept { return config_; }           ///< The constants.

private:
  Config config_;
  State state_;
};

}  // namespace thermopower
