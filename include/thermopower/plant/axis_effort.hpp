// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/film.hpp>
#include <thermopower/plant/instance.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <cmath>

/// @file axis_effort.hpp
/// The equation of an axis solved for its effort: which current or voltage does a measured motion need?

namespace thermopower::plant {

/// Measured motion at an instant.
struct MotionAtRow {
  Eigen::Index row = 0;                  ///< of the inputs, for recorded covariates and torques from outside
  double t_s = 0.0;                      ///< since the start of the run
  double angle_rad = 0.0;                ///< of the driven inertia
  double rate_rad_per_s = 0.0;           ///< its derivative
  double acceleration_rad_per_s2 = 0.0;  ///< the derivative of that
};

/// The balance of torques of a rigid axis at measured motion, as AxisStep states them.
///
/// How the whole works: @ref gap_method.
///
/// @tparam Scalar  a plain number, or one that differentiates itself
template <class Scalar>
class AxisEffort {
public:
  /// Keeps references to both arguments: they must outlive this object.
  /// @param rest_rad_per_s  dry friction turns over within this rate at least: noise hides what is steeper
  AxisEffort(const Instance<Scalar>& instance, const Inputs& inputs, double rest_rad_per_s)
      : instance_(instance), rollout_(instance, inputs), rest_rad_per_s_(rest_rad_per_s) {}

  /// Torque in N m that an effort leaves over once the motion has taken what it needs. Zero at the effort that the motion
  /// needs.
  /// @param effort  current in A; of a motor at a voltage, that voltage in V
  Scalar surplus_Nm(const Scalar& effort, const MotionAtRow& at) const {
    const Scalar zero = constant<Scalar>(0.0);
    const AxisDrive<Scalar> drive = instance_.voltage_driven
                                        ? rollout_.drive(Scalar(effort / instance_.motor_ohm), at.row, at.t_s)
                                        : rollout_.drive(effort, at.row, at.t_s);
    const AxisState<Scalar> state{
        constant<Scalar>(at.angle_rad), constant<Scalar>(at.rate_rad_per_s), zero, zero, {}};
    const auto now = rollout_.step().torques(state, at.t_s, drive);
    Scalar left_Nm = now.torque_Nm - instance_.inertia_kgm2 * at.acceleration_rad_per_s2;
    if (now.dry) {
      const Scalar within = at_least(now.transition_rad_per_s, rest_rad_per_s_);
      const Scalar share = film_share(Scalar(at.rate_rad_per_s / within), now.tail);
      left_Nm -= (at.rate_rad_per_s >= 0.0 ? now.forward_Nm : now.backward_Nm) * share;
    }
    return left_Nm;
  }

  /// Torque per unit of effort of the drive as the model states it, its effects left out. N m/A or N m/V.
  double torque_per_effort() const {
    const double per_A = value_of(instance_.torque_constant_Nm_per_A);
    return instance_.voltage_driven ? per_A / value_of(instance_.motor_ohm) : per_A;
  }

private:
  const Instance<Scalar>& instance_;
  const AxisRollout<Scalar> rollout_;
  const double rest_rad_per_s_;
};

}  // namespace thermopower::plant
