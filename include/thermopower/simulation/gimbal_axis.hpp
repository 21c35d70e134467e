// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/joint_friction.hpp>
#include <thermopower/simulation/sine.hpp>

/// @file gimbal_axis.hpp
/// The mechanics of one gimbal axis: a camera on a bearing, between a moving base and the air.

namespace thermopower::simulation {

/// How the base moves during one step: a parabola, so that a step may be cut without changing the motion.
template <class Number>
struct BaseMotion {
  Number angle_rad;         ///< At the start of the step, in space.
  Number rate_rad_per_s;    ///< At the start of the step.
  Number accel_rad_per_s2;  ///< Constant over the step.
};

/// One axis: inertia, imbalance, bearing friction, the spring of the cable, the cogging of the motor.
///
///     J dw/dt = M_motor + M_disturbance - m g l sin(angle - hanging) - M_friction(w - w_base)
///               - k (joint - rest) - M_cogging sin(n joint)        joint = angle - angle_base
///
/// Integrated by the classical Runge-Kutta rule; torques are constant over a step, the base moves on its
/// parabola.
/// @tparam Number  double, float, or `Lanes`: one axis per lane
///
/// @snippet simulation_examples.cpp parts of an axis
/// How to: @ref rig.
template <class Number>
class GimbalAxis {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  using Real = typename thermopower::detail::Numeric<Number>::Real;

public:
  using Scalar = Number;  ///< What it computes in.

  /// What describes the axis.
  struct Config {
    Number inertia_kg_m2;  ///< J, above 0.
    Number imbalance_Nm;   ///< m g l: torque of the weight when the centre of mass lies level with the
                           ///< bearing. >= 0.
    Number hanging_rad;    ///< Angle in space at which the centre of mass hangs straight down.
    JointFriction<Number> friction;  ///< In the bearing.
    Number cable_Nm_per_rad;         ///< k, >= 0.
    Number cable_rest_rad;           ///< Joint angle at which the cable is slack.
    Number cogging_Nm;               ///< Amplitude, >= 0.
    Number cogging_per_turn;  ///< n: periods per turn; the least common multiple of slots and poles. Whole,
                              ///< above 0.
  };

  /// The camera, in space.
  struct State {
    Number angle_rad;       ///< Any number of turns.
    Number rate_rad_per_s;  ///< Its speed.
  };

  /// What acts during a step.
  struct Inputs {
    Number motor_Nm;          ///< Torque of the motor.
    Number disturbance_Nm;    ///< Wind, hands, walls.
    BaseMotion<Number> base;  ///< What the bearing is fixed to.
  };

  /// @param config  the mechanics; taken as it is
  /// @param state   where it starts from
  explicit GimbalAxis(const Config& config, const State& state) noexcept
      : config_(config), per_inertia_(Real(1) / config.inertia_kg_m2), state_(state) {}

  /// Advances by `dt_s`; any value at which the axis's fastest motion is resolved. NaN stays NaN.
  const State& step(const Inputs& inputs, Real dt_s) noexcept {
    const Real half = dt_s * Real(0.5);
    const Number angle = state_.angle_rad, rate = state_.rate_rad_per_s;
    const Number accel1 = acceleration(angle, rate, inputs, Real(0));
    const Number rate2 = rate + half * accel1;
    const Number accel2 = acceleration(Number(angle + half * rate), rate2, inputs, half);
    const Number rate3 = rate + half * accel2;
    const Number accel3 = acceleration(Number(angle + half * rate2), rate3, inputs, half);
    const Number rate4 = rate + dt_s * accel3;
    const Number accel4 = acceleration(Number(angle + dt_s * rate3), rate4, inputs, dt_s);
    const Real sixth = dt_s / Real(6);
    state_.angle_rad = angle + sixth * (rate + Real(2) * (rate2 + rate3) + rate4);
    state_.rate_rad_per_s = rate + sixth * (accel1 + Real(2) * (accel2 + accel3) + accel4);
    return state_;
  }

  /// Angular acceleration in a state, `since_s` after the start of the step. The right-hand side, for other
  /// integrators.
  Number acceleration(const Number& angle_rad, const Number& rate_rad_per_s, const Inputs& inputs,
                      Real since_s) const noexcept {
    const BaseMotion<Number>& base = inputs.base;
    const Number base_rate = base.rate_rad_per_s + since_s * base.accel_rad_per_s2;
    const Number base_angle = base.angle_rad + (since_s * Real(0.5)) * (base.rate_rad_per_s + base_rate);
    const Number joint = angle_rad - base_angle;
    const Number weight = config_.imbalance_Nm * sine(Number(angle_rad - config_.hanging_rad));
    const Number cogging = config_.cogging_Nm * sine(Number(config_.cogging_per_turn * joint));
    const Number cable = config_.cable_Nm_per_rad * (joint - config_.cable_rest_rad);
    const Number friction = config_.friction.torque_Nm(Number(rate_rad_per_s - base_rate));
    return (inputs.motor_Nm + inputs.disturbance_Nm - weight - cogging - cable - friction) * per_inertia_;
  }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  Config config_;
  Number per_inertia_;  // four divisions a step less
  State state_;
};

}  // namespace thermopower::simulation
