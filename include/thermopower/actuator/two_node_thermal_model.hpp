// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"
#include "newton_cooling.hpp"
#include "two_node_rates.hpp"

/// @file two_node_thermal_model.hpp
/// The temperature of an actuator with two nodes: a winding that is heated, and a body that loses the heat.

namespace thermopower {

/// Two-node thermal model, stepped exactly for constant inputs at any step size:
///
/// \f[
/// \begin{aligned}
/// C_w \, \dot T_w &= P - K \, (T_w - T_b) \\[.5em]
/// C_b \, \dot T_b &= K \, (T_w - T_b) - G \, (T_b - T_\mathrm{air})
/// \end{aligned}
/// \f]
///
/// Take it when the winding is much faster than the housing, so that a short overload heats copper long
/// before a thermometer on the housing shows it. Both eigenvalues are real and negative (the network has no
/// way to store what would oscillate).
///
/// @snippet actuator_examples.cpp two nodes
/// How to: @ref custom_motor, @ref laws.
/// @ingroup actuator
template <class Number = float>
class TwoNodeThermalModel {
public:
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  /// What one tunes.
  struct Config {
    Number winding_heat_capacity_J_per_K;  ///< C_w, above 0.
    Number body_heat_capacity_J_per_K;     ///< C_b, above 0.
    Number coupling_W_per_K;               ///< K, above 0.
    NewtonCooling<Number> cooling;         ///< G, from the body to the air.

    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.winding_heat_capacity_J_per_K, self.body_heat_capacity_J_per_K, self.coupling_W_per_K,
              self.cooling);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      return first_error(
          detail::require_positive(winding_heat_capacity_J_per_K, ConfigError::winding_heat_capacity_J_per_K),
          first_error(
              detail::require_positive(body_heat_capacity_J_per_K, ConfigError::body_heat_capacity_J_per_K),
              first_error(detail::require_positive(coupling_W_per_K, ConfigError::coupling_W_per_K),
                          cooling.validate())));
    }
  };

  /// What acts on the actuator during a step; constant over the step.
  struct Inputs {
    Number power_W;               ///< Heat in the winding.
    Number v_rms_V;               ///< Not read; here so that both thermal models take the same inputs.
    Surroundings<Number> around;  ///< Air temperature.
  };

  /// What one logs.
  struct State {
    Number winding_C;             ///< The hot node.
    Number body_C;                ///< What a thermometer on the housing reads.
    Number winding_rate_K_per_s;  ///< dT_w/dt at the start of the last step.
  };

  /// @param config   constants; call `validate()` once
  /// @param motor_C  temperature to start from, of both nodes
  TwoNodeThermalModel(const Config& config, const Number& motor_C) noexcept : config_(config) {
    start(motor_C);
    // Rates in 1/s of the 2 x 2 system and its eigenvalues -fast, -slow, once: the step then costs two
    // exponentials.
    winding_to_body_ = config.coupling_W_per_K / config.winding_heat_capacity_J_per_K;
    body_to_winding_ = config.coupling_W_per_K / config.body_heat_capacity_J_per_K;
    const Number to_air = config.cooling.conductance_W_per_K / config.body_heat_capacity_J_per_K;
    const TwoNodeRates<Number> rates = two_node_rates(winding_to_body_, body_to_winding_, to_air);
    fast_per_s_ = rates.fast_per_s;
    slow_per_s_ = rates.slow_per_s;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// Sets both nodes to one temperature.
  void start(const Number& motor_C) noexcept { start(motor_C, motor_C); }
  /// Sets both temperatures.
  void start(const Number& winding_C, const Number& body_C) noexcept {
    state_.winding_C = winding_C;
    state_.body_C = body_C;
    state_.winding_rate_K_per_s = winding_C * Real(0);
  }

  /// Advances by `dt_s` seconds (>= 0). NaN or Inf in an input makes both temperatures NaN.
  const State& step(const Inputs& inputs, const Number& dt_s) noexcept {
    typedef detail::Numeric<Number> Math;
    const Number settled_body_C = inputs.around.air_C + inputs.power_W / config_.cooling.conductance_W_per_K;
    const Number settled_winding_C = settled_body_C + inputs.power_W / config_.coupling_W_per_K;
    const Number winding = state_.winding_C - settled_winding_C;
    const Number body = state_.body_C - settled_body_C;
    state_.winding_rate_K_per_s = winding_to_body_ * (body - winding);

    // exp(A dt) = slow decay * I + (fast decay - slow decay) / (fast - slow) * -(A + slow I)
    const Number slow = Math::exponential(Number(-slow_per_s_ * dt_s));
    const Number gap = fast_per_s_ - slow_per_s_;
    const Number mixing = slow * dt_s * detail::mean_decay(Number(gap * dt_s));
    const Number body_diagonal = slow_per_s_ - (fast_per_s_ + slow_per_s_ - winding_to_body_);
    state_.winding_C = settled_winding_C + slow * winding +
                       mixing * ((slow_per_s_ - winding_to_body_) * winding + winding_to_body_ * body);
    state_.body_C =
        settled_body_C + slow * body + mixing * (body_to_winding_ * winding + body_diagonal * body);
    return state_;
  }

  const State& state() const noexcept { return state_; }  ///< After the last step.
  /// The node that decides.
  Number hottest_C() const noexcept { return detail::at_least(state_.winding_C, state_.body_C); }
  Number hottest_rate_K_per_s() const noexcept { return state_.winding_rate_K_per_s; }  ///< dT_w/dt.
  const Config& config() const noexcept { return config_; }                             ///< The constants.

private:
  typedef typename detail::Numeric<Number>::Real Real;
  Config config_;
  State state_;
  Number winding_to_body_, body_to_winding_, fast_per_s_, slow_per_s_;
};

}  // namespace thermopower
