// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/composition.hpp"
#include "../config_error.hpp"
#include "duty.hpp"

/// @file current_model.hpp
/// How much current an actuator draws, and what power that is.

namespace thermopower {

/// Current and power of one actuator, from its power parameter, supply and temperature.
///
/// | law | when to take it |
/// |---|---|
/// | `OhmicCurrent` | the winding's resistance is known; physical everywhere |
/// | `ThesisCurrent` | the two thesis motors, as measured in Tables 4.1 and 4.2 |
/// | `TabulatedCurrent` | a law that is too slow for the chip, as a table in flash |
///
/// A law of your own is a struct with `typedef ... Scalar`, `Scalar current_A(v_rms_V, motor_C) const` and
/// `ConfigError validate() const`.
/// @tparam Law  one of the above
///
/// @snippet actuator_examples.cpp current
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Law>
class CurrentModel {
  static_assert(
      detail::IsCurrentLaw<Law>::value,
      "thermopower: the parameter of CurrentModel and CachedCurrent must be a current law: a type with Scalar, current_A(v_rms_V, motor_C) and validate(), such as OhmicCurrent");

public:
  typedef Law Config;                   ///< The law's constants are the configuration.
  typedef typename Law::Scalar Scalar;  ///< What it computes in.

  /// Every intermediate of one evaluation.
  struct State {
    Scalar v_rms_V;          ///< eq 3.11
    Scalar current_A;        ///< by the law
    Scalar winding_power_W;  ///< V_rms I, eq 4.13: what the thesis calls the motor's power
  };

  /// @param config  constants; ask `validate()` once
  explicit CurrentModel(const Config& config) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param power_param  0 .. 255
  /// @param supply_V     >= 0
  /// @param motor_C      winding temperature
  State at_power(const Scalar& power_param, const Scalar& supply_V, const Scalar& motor_C) const noexcept {
    return at_voltage(v_rms_from_power<Scalar>(supply_V, power_param), motor_C);
  }

  /// The same from a voltage that is known. @param v_rms_V  >= 0
  State at_voltage(const Scalar& v_rms_V, const Scalar& motor_C) const noexcept {
    const Scalar current_A = config_.current_A(v_rms_V, motor_C);
    State state = {v_rms_V, current_A, v_rms_V * current_A};
    return state;
  }

  const Config& config() const noexcept { return config_; }  ///< The law with its constants.

private:
  Config config_;
};

}  // namespace thermopower
