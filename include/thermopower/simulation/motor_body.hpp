// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/forced_airflow.hpp>
#include <thermopower/actuator/natural_convection.hpp>
#include <thermopower/actuator/radiation_cooling.hpp>

/// @file motor_body.hpp
/// The temperatures of a motor: richer than what the controllers assume.

namespace thermopower::simulation {

/// Two nodes, a winding that is heated and a body that loses the heat by natural convection, radiation and a
/// forced stream:
///
///     C_w dT_w/dt = P - K (T_w - T_b)
///     C_b dT_b/dt = K (T_w - T_b) - convection(T_b) - stream(T_b) - radiation(T_b)
///
/// The controllers believe in one node with a loss proportional to the rise. Magnets and the printed bracket
/// are as warm as the body.
///
/// @snippet simulation_examples.cpp parts of an axis
/// How to: @ref rig.
template <class Number>
class MotorBody {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  using Real = typename thermopower::detail::Numeric<Number>::Real;

public:
  /// What describes the motor.
  struct Config {
    Number winding_heat_capacity_J_per_K;  ///< C_w, above 0.
    Number body_heat_capacity_J_per_K;     ///< C_b, above 0.
    Number coupling_W_per_K;               ///< K, above 0.
    NaturalConvection<Number> convection;  ///< Still air.
    Number stream_W_per_K;                 ///< What a stream of 1 m/s adds, >= 0.
    Number stream_exponent;                ///< How that grows with the speed, 0.2 .. 1.
    RadiationCooling<Number> radiation;    ///< To surroundings as warm as the air.
  };

  /// The two temperatures.
  struct State {
    Number winding_C;  ///< Copper.
    Number body_C;     ///< Iron, magnets, bracket: what a thermometer or a thermal camera sees.
  };

  /// @param config  constants  @param state  to start from
  MotorBody(const Config& config, const State& state) noexcept : config_(config), state_(state) {}

  /// Advances by `dt_s` with the midpoint rule; small against C_w / K (ten seconds for the smallest motor
  /// here).
  const State& step(const Number& heat_W, const Surroundings<Number>& around, Real dt_s) noexcept {
    const State first = slope(state_, heat_W, around);
    const State middle = {state_.winding_C + (dt_s * Real(0.5)) * first.winding_C,
                          state_.body_C + (dt_s * Real(0.5)) * first.body_C};
    const State rate = slope(middle, heat_W, around);
    state_.winding_C = state_.winding_C + dt_s * rate.winding_C;
    state_.body_C = state_.body_C + dt_s * rate.body_C;
    return state_;
  }

  /// Heat lost by the body. @return W
  Number loss_W(const Number& body_C, const Surroundings<Number>& around) const noexcept {
    const Number speed = thermopower::detail::at_least(around.airspeed_mps, Math::constant(Real(1e-9)));
    const Number stream = config_.stream_W_per_K * Math::power(speed, config_.stream_exponent);
    return config_.convection.loss_W(body_C, around) + config_.radiation.loss_W(body_C, around) +
           stream * (body_C - around.air_C);
  }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  using Math = thermopower::detail::Numeric<Number>;

  State slope(const State& at, const Number& heat_W, const Surroundings<Number>& around) const noexcept {
    const Number flow_W = config_.coupling_W_per_K * (at.winding_C - at.body_C);
    State rate = {(heat_W - flow_W) / config_.winding_heat_capacity_J_per_K,
                  (flow_W - loss_W(at.body_C, around)) / config_.body_heat_capacity_J_per_K};
    return rate;
  }

  Config config_;
  State state_;
};

}  // namespace thermopower::simulation
