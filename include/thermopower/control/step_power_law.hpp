// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "detail/composition.hpp"
#include "limit_reason.hpp"

/// @file control/step_power_law.hpp
/// How much power a position error is worth, eq 4.22.
///
/// | rule | power | when to take it |
/// |---|---|---|
/// | `ProgrammedLevels` | ten levels, 25 .. 250 | the original program; the default |
/// | `PrintedLevels` | eq 4.22 as printed: 0, 25 .. 250, capped at 255 | to compare with the text; 0 is sent as the least power |
/// | `HysteresisLevels` | ten levels that a noisy error does not toggle | the error is near a level's edge for long |
/// | `ContinuousPower` | proportional | no visible steps wanted; every count of error moves the power |
///
/// A rule of your own has `Config` with `full_power_error_deg`, `standard()` and `validate()`, a `State`, and
/// `static uint8_t power(magnitude_deg, config, state)`.

namespace thermopower {

/// What one tunes in every stepped rule.
/// @ingroup control
struct StepPowerConfig {
  float full_power_error_deg;  ///< Error worth full power: error_max of eq 4.22. Above 0. The program: 1
                               ///< degree.
  uint8_t power_step;          ///< Power of one level, at least 1, at most 25. The program: 25.
  float hysteresis_deg;  ///< Read by `HysteresisLevels` only: how far the error must fall below a level's
                         ///< edge. >= 0.

  /// The program's values; hysteresis of a quarter of a level.
  static StepPowerConfig standard() noexcept {
    StepPowerConfig config = {1.0f, 25, 0.025f};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.full_power_error_deg, self.power_step, self.hysteresis_deg);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_positive(full_power_error_deg, ConfigError::full_power_error_deg)))
      return ConfigError::full_power_error_deg;
    if (power_step < 1 || power_step > 25) return ConfigError::power_step;
    return detail::require_not_negative(hysteresis_deg, ConfigError::hysteresis_deg);
  }
};

/// Nothing to remember.
/// @ingroup control
struct NoState {};

/// Levels per degree, divided once: a division in every step is dear on a small chip.
///
/// @snippet control_examples.cpp level scale
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
class LevelScale {
public:
  /// int(10 e / e_max), saturated at `highest`; 0 where a refused configuration makes it NaN or negative.
  /// @param magnitude_deg  size of the error, finite and >= 0
  uint8_t level(float magnitude_deg, const StepPowerConfig& config, uint8_t highest) noexcept {
    if (detail::is_same(per_deg_, 0.0f)) per_deg_ = 10.0f / config.full_power_error_deg;
    const float level = magnitude_deg * per_deg_;
    if (detail::is_from_zero_to(level, static_cast<float>(highest))) return static_cast<uint8_t>(level);
    return level > 0.0f ? highest : 0;
  }

private:
  float per_deg_ = 0.0f;  // 0: not yet known
};

/// Ten levels, never none: level = 1 to 10, power = 25 level (program lines 192 to 195).
///
/// @snippet control_examples.cpp power law rules
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct ProgrammedLevels {
  typedef StepPowerConfig Config;  ///< What one tunes.
  typedef LevelScale State;        ///< Nothing but the scale.
  /// @param magnitude_deg  size of the error, finite and >= 0  @return power parameter
  static uint8_t power(float magnitude_deg, const Config& config, State& scale) noexcept {
    const uint8_t level = scale.level(magnitude_deg, config, 10);
    return static_cast<uint8_t>(config.power_step * (level < 1 ? 1 : level));
  }
};

/// Eq 4.22 as printed: no power below a tenth of the full error, and a cap at 255.
///
/// @snippet control_examples.cpp power law rules
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct PrintedLevels {
  typedef StepPowerConfig Config;  ///< What one tunes.
  typedef LevelScale State;        ///< Nothing but the scale.
  /// @param magnitude_deg  size of the error, finite and >= 0  @return power parameter
  static uint8_t power(float magnitude_deg, const Config& config, State& scale) noexcept {
    const uint16_t power = static_cast<uint16_t>(config.power_step * scale.level(magnitude_deg, config, 255));
    return static_cast<uint8_t>(power > 255u ? 255u : power);
  }
};

/// `ProgrammedLevels` that rise at a level's edge and fall only `hysteresis_deg` below it.
///
/// @snippet control_examples.cpp power law
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct HysteresisLevels {
  typedef StepPowerConfig Config;  ///< What one tunes.
  /// The level held.
  struct State {
    uint8_t level = 1;  ///< 1 .. 10
    LevelScale scale;   ///< Levels per degree.
  };
  /// @param magnitude_deg  size of the error, finite and >= 0  @return power parameter
  static uint8_t power(float magnitude_deg, const Config& config, State& state) noexcept {
    const uint8_t up = state.scale.level(magnitude_deg, config, 10);
    const uint8_t down = state.scale.level(magnitude_deg + config.hysteresis_deg, config, 10);
    if (up > state.level) state.level = up;
    if (down < state.level) state.level = down < 1 ? 1 : down;
    return static_cast<uint8_t>(config.power_step * state.level);
  }
};

/// Proportional to the error, from one level to ten.
///
/// @snippet control_examples.cpp power law rules
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct ContinuousPower {
  typedef StepPowerConfig Config;  ///< What one tunes.
  typedef NoState State;           ///< Nothing to remember.
  /// @param magnitude_deg  size of the error, finite and >= 0  @return power parameter
  static uint8_t power(float magnitude_deg, const Config& config, State&) noexcept {
    const uint8_t highest = static_cast<uint8_t>(10u * config.power_step);
    const float power = static_cast<float>(highest) * (magnitude_deg / config.full_power_error_deg);
    if (!(power > static_cast<float>(config.power_step))) return config.power_step;
    return power >= static_cast<float>(highest) ? highest : static_cast<uint8_t>(power + 0.5f);
  }
};

/// Power demanded by a position error.
/// @tparam Rule  one of the rules above
///
/// @snippet control_examples.cpp power law
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Rule = ProgrammedLevels>
class StepPowerLaw {
  static_assert(
      detail::IsPowerRule<Rule>::value,
      "thermopower: the parameter of StepPowerLaw must be a rule: a type with Config, State and static power(magnitude_deg, config, state), such as ProgrammedLevels");

public:
  typedef typename Rule::Config Config;  ///< What one tunes.
  typedef typename Rule::State State;    ///< What the rule remembers.

  /// @param config  constants; ask `validate()` once
  explicit StepPowerLaw(const Config& config = Config::standard()) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param error_deg  folded position error; NaN and Inf ask for the least power
  /// @return power parameter; at least 1
  uint8_t step(float error_deg) noexcept {
    if (!detail::is_finite(error_deg)) return least_power();
    const uint8_t power = Rule::power(detail::magnitude(error_deg), config_, state_);
    return power < least_power() ? least_power() : power;
  }

  const State& state() const noexcept { return state_; }     ///< What the rule remembers.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  Config config_;
  State state_;
};

}  // namespace thermopower
