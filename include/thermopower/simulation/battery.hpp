// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/detail/check.hpp>

/// @file battery.hpp
/// A supply that is not stiff.

namespace thermopower::simulation {

/// A battery: an open-circuit voltage that falls from full to empty, and a resistance in series.
/// A bench supply is a battery with next to no resistance and equal voltages.
///
/// @snippet simulation_examples.cpp parts of an axis
/// How to: @ref rig.
template <class Number>
class Battery {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  using Real = typename thermopower::detail::Numeric<Number>::Real;

public:
  /// What describes the battery.
  struct Config {
    Number full_V;      ///< Open-circuit voltage when full, above 0.
    Number empty_V;     ///< Open-circuit voltage when empty, above 0; in between it falls in a straight line.
    Number capacity_C;  ///< Charge, coulomb (1 Ah is 3600 C), above 0.
    Number resistance_ohm;  ///< In series, >= 0.
  };

  /// What one logs.
  struct State {
    Number used_C;    ///< Charge taken out.
    Number supply_V;  ///< At the terminals, under the last load.
    Number energy_J;  ///< Delivered at the terminals since the start.
  };

  /// @param config  constants  @param charge  0 empty .. 1 full
  Battery(const Config& config, const Number& charge) noexcept : config_(config) {
    state_.used_C = (Real(1) - charge) * config.capacity_C;
    state_.supply_V = open_circuit_V();
    state_.energy_J = charge * Real(0);
  }

  /// Voltage without load; never below `empty_V`.
  Number open_circuit_V() const noexcept {
    const Number left = Real(1) - state_.used_C / config_.capacity_C;
    const Number share =
        thermopower::detail::at_least(left, thermopower::detail::Numeric<Number>::constant(Real(0)));
    return config_.empty_V + (config_.full_V - config_.empty_V) * share;
  }

  /// Voltage at the terminals across a conductance, and the charge that flows in `dt_s`. @param load_S  >= 0
  const State& step(const Number& load_S, Real dt_s) noexcept {
    state_.supply_V = open_circuit_V() / (Real(1) + config_.resistance_ohm * load_S);
    const Number current_A = state_.supply_V * load_S;
    state_.used_C = state_.used_C + current_A * dt_s;
    state_.energy_J = state_.energy_J + state_.supply_V * current_A * dt_s;
    return state_;
  }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  Config config_;
  State state_;
};

}  // namespace thermopower::simulation
