// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "current_model.hpp"

/// @file cached_current.hpp
/// A current model in which what is dear is evaluated only when something changed.

namespace thermopower {

namespace detail {

// What is remembered of any law: its last answer.
template <class Law, class = int>
class CurrentMemory {
public:
  typedef typename CurrentModel<Law>::State State;

  const State& at(const Law& law, float v_rms_V, float motor_C, bool is_near) noexcept {
    if (!is_near || !is_same(v_rms_V, state_.v_rms_V)) {
      state_.v_rms_V = v_rms_V;
      state_.current_A = law.current_A(v_rms_V, motor_C);
      state_.winding_power_W = v_rms_V * state_.current_A;
    }
    return state_;
  }

private:
  State state_ = {not_a_number(), not_a_number(), not_a_number()};
};
// What is remembered of a law that has a conductance: that. Two products make a current of it.
template <class Law>
class CurrentMemory<Law, typename Exists<decltype(probe<const Law>().conductance_S(0.0f))>::Type> {
public:
  typedef typename CurrentModel<Law>::State State;

  State at(const Law& law, float v_rms_V, float motor_C, bool is_near) noexcept {
    if (!is_near) conductance_S_ = law.conductance_S(motor_C);
    const float current_A = v_rms_V * conductance_S_;
    const State state = {v_rms_V, current_A, v_rms_V * current_A};
    return state;
  }

private:
  float conductance_S_ = not_a_number();
};

}  // namespace detail

/// A `CurrentModel` that remembers: the square root of a POWER, and of a law like Ohm's its conductance at the last
/// temperature; of any other law its last answer. A square root, a division or a power are dear on a small chip, and
/// most cycles ask the same again. Exact in power and supply; the temperature may have moved by less than 1/128 of
/// itself: by half a kelvin between 64 and 128 degC, a kelvin above and less below, 0.3 % of a copper winding's
/// current.
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
  explicit CachedCurrent(const Config& config) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// As `CurrentModel::at_power`. A POWER that is not a whole number is not remembered.
  State at_power(float power_param, float supply_V, float motor_C) noexcept {
    if (detail::is_from_zero_to(power_param, 255.0f)) {
      const uint8_t count = static_cast<uint8_t>(power_param);
      if (!(static_cast<float>(count) < power_param)) return at_count(count, supply_V, motor_C);
    }
    return at_voltage(v_rms_from_power<float>(supply_V, power_param), motor_C);
  }

  /// The same from a whole POWER: only one that changed is converted.
  State at_count(uint8_t power_param, float supply_V, float motor_C) noexcept {
    if (power_param != count_) {
      share_ = v_rms_from_power<float>(1.0f, static_cast<float>(power_param));
      count_ = power_param;
    }
    return at_voltage(supply_V * share_, motor_C);
  }

  const Config& config() const noexcept { return config_; }  ///< The law with its constants.

private:
  State at_voltage(float v_rms_V, float motor_C) noexcept {
    // Sign, exponent and seven digits: equal halves are near, and two bytes are remembered instead of four.
    uint32_t bits;
    memcpy(&bits, &motor_C, sizeof bits);
    const uint16_t upper = static_cast<uint16_t>(bits >> 16);
    const bool is_near = upper == upper_;
    upper_ = upper;
    return memory_.at(config_, v_rms_V, motor_C, is_near);
  }

  Config config_;
  detail::CurrentMemory<Law> memory_;
  float share_ = 0.0f;  // V_rms / V_supply at `count_`
  uint16_t upper_ =
      0xffffu;  // of the temperature that is remembered: at first a NaN, and so is what is remembered
  uint8_t count_ = 0;
};

}  // namespace thermopower
