// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "current_model.hpp"

/// @file cached_current.hpp
/// A current model that is evaluated only when something changed.

namespace thermopower {

/// A `CurrentModel` that remembers its last answer: a square root and a division, or a power, are dear on a
/// small chip, and most cycles ask the same again. Exact in power and supply; the temperature may have moved
/// by half a kelvin, 0.2 % of a copper winding's current.
/// @tparam Law  as for CurrentModel, with float as its scalar
template <class Law>
class CachedCurrent {
 public:
  typedef Law Config;                               ///< The law's constants are the configuration.
  typedef float Scalar;                             ///< Firmware only.
  typedef typename CurrentModel<Law>::State State;  ///< Every intermediate of one evaluation.

  /// @param config  the constants of the law; ask `validate()` once
  explicit CachedCurrent(const Config& config) noexcept : model_(config) {
    const State none = {0.0f, 0.0f, 0.0f};
    state_ = none;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return model_.validate(); }

  /// As `CurrentModel::at_power`. A NaN is never equal to what was asked before, so it is always looked at.
  const State& at_power(float power_param, float supply_V, float motor_C) noexcept {
    if (power_param == power_ && supply_V == supply_V_ && detail::magnitude(motor_C - motor_C_) < 0.5f)
      return state_;
    power_ = power_param;
    supply_V_ = supply_V;
    motor_C_ = motor_C;
    state_ = model_.at_power(power_param, supply_V, motor_C);
    return state_;
  }

  const Config& config() const noexcept { return model_.config(); }  ///< The law with its constants.

 private:
  CurrentModel<Law> model_;
  State state_;
  float power_ = -1.0f, supply_V_ = 0.0f, motor_C_ = 0.0f;
};

}  // namespace thermopower
