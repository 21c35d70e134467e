// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/check.hpp"

/// @file control/utilisation.hpp
/// How much of what an actuator can bear is in use, in per cent, with a warning and an error.

namespace thermopower {

/// What a utilisation says.
/// @ingroup control
enum class UtilisationLevel : uint8_t {
  normal = 0,   ///< Below the warning.
  warning = 1,  ///< A limit is near: plan for less.
  error = 2,    ///< A limit is reached, or no temperature is known.
};

/// What one tunes.
/// @ingroup control
struct UtilisationConfig {
  float maximum_winding_C;  ///< 100 % of the winding. 0 .. 250.
  float maximum_body_C;     ///< 100 % of the body. 0 .. 250.
  float warning_percent;    ///< From here on a warning. Above 0, below `error_percent`.
  float error_percent;      ///< From here on an error. Finite.
  float
      hysteresis_percent;  ///< A level is left this much below where it began, so that noise toggles none. >= 0.

  /// Warning at 85 %, error at 100 %, 3 % hysteresis; the limits are NaN until they are set.
  static UtilisationConfig standard() noexcept {
    const float unset = detail::not_a_number();
    const UtilisationConfig config = {unset, unset, 85.0f, 100.0f, 3.0f};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.maximum_winding_C, self.maximum_body_C, self.warning_percent, self.error_percent,
            self.hysteresis_percent);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_within(maximum_winding_C, 0.0f, 250.0f, ConfigError::maximum_winding_C),
        detail::require_within(maximum_body_C, 0.0f, 250.0f, ConfigError::maximum_body_C),
        detail::require_positive(warning_percent, ConfigError::warning_percent),
        detail::is_finite(error_percent) && error_percent > warning_percent ? ConfigError::none
                                                                            : ConfigError::error_percent,
        detail::require_not_negative(hysteresis_percent, ConfigError::hysteresis_percent));
  }
};

/// Thermal utilisation: (T - T_air) / (T_limit - T_air) of the node that is nearer to its limit. 0 % is as warm as
/// the air, 100 % is the limit, whatever the weather; at a constant power it settles in proportion to the heat.
///
/// @snippet control_examples.cpp utilisation
/// How to: @ref choose_a_limiter.
/// @ingroup control
class Utilisation {
public:
  typedef UtilisationConfig Config;  ///< What one tunes.

  /// What one logs or sends.
  struct State {
    float percent;    ///< Of the node that is nearer to its limit; NaN when a temperature is not known.
    bool is_winding;  ///< Which one.
    UtilisationLevel level;  ///< What it means.
  };

  /// @param config  constants; ask `validate()` once. An invalid one says `error` for ever
  explicit Utilisation(const Config& config) noexcept : config_(config) {
    const State none = {detail::not_a_number(), true, UtilisationLevel::error};
    state_ = none;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param winding_C, body_C, air_C  estimated or measured; NaN is an error, never a cold actuator. Air that is as
  /// hot as a limit is 100 % and more
  const State& step(float winding_C, float body_C, float air_C) noexcept {
    const float winding = share(winding_C, config_.maximum_winding_C, air_C);
    const float body = share(body_C, config_.maximum_body_C, air_C);
    state_.is_winding = winding >= body;
    state_.percent = state_.is_winding ? winding : body;
    if (is_error(validate()) || !detail::is_finite(winding) || !detail::is_finite(body)) {
      state_.percent = detail::not_a_number();
      state_.level = UtilisationLevel::error;
      return state_;
    }
    const float rest = config_.hysteresis_percent;
    const bool was_error = state_.level == UtilisationLevel::error;
    const bool was_warning = state_.level != UtilisationLevel::normal;
    if (state_.percent >= config_.error_percent - (was_error && is_known_ ? rest : 0.0f))
      state_.level = UtilisationLevel::error;
    else if (state_.percent >= config_.warning_percent - (was_warning && is_known_ ? rest : 0.0f))
      state_.level = UtilisationLevel::warning;
    else state_.level = UtilisationLevel::normal;
    is_known_ = true;
    return state_;
  }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  static float share(float temperature_C, float limit_C, float air_C) noexcept {
    const float room_K = limit_C - air_C;
    if (!(room_K > 0.0f)) return room_K <= 0.0f ? 1000.0f : detail::not_a_number();
    return 100.0f * (temperature_C - air_C) / room_K;
  }

  Config config_;
  State state_;
  bool is_known_ = false;
};

}  // namespace thermopower
