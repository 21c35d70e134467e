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
///
/// @snippet actuator_examples.cpp cached current
/// How to: @ref custom_motor. Menu: @ref policies.
template <class Law>
class CachedCurrent {
  static_assert(
      detail::IsCurrentLaw<Law>::value,
      "thermopower: the parameter of CurrentModel and CachedCurrent must be a current law: a type with Scalar, current_A(v_rms_V, motor_C) and validate(), such as OhmicCurrent");

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
    const bool is_same_voltage = detail::is_same(power_param, power_) && detail::is_same(supply_V, supply_V_);
    const bool is_same_winding = is_near(motor_C);
    if (is_same_voltage && is_same_winding) return state_;
    if (!detail::is_same(power_param, power_)) {
      share_ = v_rms_from_power<float>(1.0f, power_param);
      power_ = power_param;
      count_ = 0;
    }
    supply_V_ = supply_V;
    if (!is_same_winding) {
      motor_C_ = motor_C;
      conductance_S_ = conductance_of(model_.config(), motor_C, 0);
      is_near_ = true;
    }
    evaluate(model_.config(), supply_V * share_, 0);
    return state_;
  }

  /// The same from a whole POWER: only one that changed is converted.
  const State& at_count(uint8_t power_param, float supply_V, float motor_C) noexcept {
    const bool is_known = power_param == count_ && count_ != 0;
    const State& state = at_power(is_known ? power_ : static_cast<float>(power_param), supply_V, motor_C);
    count_ = power_param;
    return state;
  }

  const Config& config() const noexcept { return model_.config(); }  ///< The law with its constants.

private:
  // Most steps ask for the very temperature that was asked for last: that is seen by its bits.
  bool is_near(float motor_C) noexcept {
    if (detail::is_same(motor_C, asked_C_)) return is_near_;
    asked_C_ = motor_C;
    is_near_ = detail::magnitude(motor_C - motor_C_) < 0.5f;
    return is_near_;
  }

  // A law that has a conductance is evaluated by a product, any other as it is.
  template <class Any>
  static auto conductance_of(const Any& law, float motor_C, int) noexcept
      -> decltype(law.conductance_S(motor_C)) {
    return law.conductance_S(motor_C);
  }
  template <class Any>
  static float conductance_of(const Any&, float, long) noexcept {
    return 0.0f;
  }
  template <class Any>
  auto evaluate(const Any& law, float v_rms_V, int) noexcept
      -> decltype(static_cast<void>(law.conductance_S(v_rms_V))) {
    state_.v_rms_V = v_rms_V;
    state_.current_A = v_rms_V * conductance_S_;
    state_.winding_power_W = v_rms_V * state_.current_A;
  }
  template <class Any>
  void evaluate(const Any&, float v_rms_V, long) noexcept {
    state_ = model_.at_voltage(v_rms_V, motor_C_);
  }

  CurrentModel<Law> model_;
  State state_;
  float power_ = -1.0f, supply_V_ = 0.0f, motor_C_ = 0.0f, asked_C_ = 0.0f;
  float share_ = 0.0f;          // V_rms / V_supply
  float conductance_S_ = 0.0f;  // at `motor_C_`
  uint8_t count_ = 0;           // `power_` where that came as one; 0 where not
  bool is_near_ = false;
};

}  // namespace thermopower
