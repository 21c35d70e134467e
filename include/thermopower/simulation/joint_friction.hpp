// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/vector_math.hpp>

/// @file joint_friction.hpp
/// Friction in the bearing of an axis.

namespace thermopower::simulation {

/// Coulomb, Stribeck and viscous friction:
///
///     M(w) = (M_c + (M_s - M_c) / (1 + (w / w_s)^2)) w / sqrt(w^2 + w_0^2) + b w
///
/// The Stribeck term falls off as 1 / (1 + (w/w_s)^2) (Hess and Soom, J. Tribology 112, 1990). Below the
/// speed w_0 the joint creeps instead of sticking: the law stays smooth, so that a fixed-step integrator
/// keeps its order.
///
/// @snippet simulation_examples.cpp joint friction
/// How to: @ref rig.
template <class Number>
struct JointFriction {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  Number coulomb_Nm;            ///< M_c, >= 0.
  Number breakaway_Nm;          ///< M_s, >= M_c.
  Number stribeck_rad_per_s;    ///< w_s, above 0.
  Number creep_rad_per_s;       ///< w_0, above 0; small against w_s.
  Number viscous_Nm_s_per_rad;  ///< b, >= 0.

  /// Torque against the motion. @param joint_rad_per_s  speed of the camera side relative to the base side
  Number torque_Nm(const Number& joint_rad_per_s) const noexcept {
    const Number square = joint_rad_per_s * joint_rad_per_s;
    const Number stribeck_square = stribeck_rad_per_s * stribeck_rad_per_s;
    // One root for both quotients: 1 / (sum sqrt(smooth)) = 1 / sqrt(sum^2 smooth).
    const Number smooth = square + creep_rad_per_s * creep_rad_per_s;
    const Number sum = square + stribeck_square;
    const Number dry = coulomb_Nm * sum + (breakaway_Nm - coulomb_Nm) * stribeck_square;
    const Number both = VectorMath<Number>::inverse_root(Number(sum * sum * smooth));
    return joint_rad_per_s * (dry * both + viscous_Nm_s_per_rad);
  }
};

}  // namespace thermopower::simulation
