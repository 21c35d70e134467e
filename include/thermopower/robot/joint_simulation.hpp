// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace thermopower::robot {

/// @brief One joint as it is left when all the others move as measured: an inertia and a torque that are known row by row.
///
/// All series have one value per row. Rows are evenly spaced.
struct SingleJoint {
  double step_s = 0.0;       ///< between rows
  Eigen::VectorXd target;    ///< rad, held to the next row
  Eigen::VectorXd position;  ///< rad, as measured
  Eigen::VectorXd velocity;  ///< rad/s, as measured and smoothed
  Eigen::VectorXd inertia;   ///< apparent inertia in kg m2, without the armature
  Eigen::VectorXd rest;      ///< N m of all the rest: gravity, coupling, motion of the base
  Eigen::VectorXd gravity;   ///< N m, the part of `rest` that holds the weight
  Eigen::VectorXd moment_a;  ///< see BodyRows
  Eigen::VectorXd moment_b;  ///< see BodyRows
};

/// @brief Simulates a single joint under its position controller, from its measured start.
///
/// Each step treats the damping implicitly, the position gain by its middle position, and dry friction as a force that can hold the
/// joint: the error is of second order, so that steps of some milliseconds do not look like damping.
/// @param begin  first row
/// @param end    one past the last row
/// @return position in rad of each row from `begin` on
inline Eigen::VectorXd simulate(const SingleJoint& joint, const JointDynamics& d, Eigen::Index begin,
                                Eigen::Index end, double longest_step_s = 1e-3) {
  Eigen::VectorXd out(end - begin);
  if (end <= begin) return out;
  double q = joint.position[begin], w = joint.velocity[begin], load = std::fabs(joint.rest[begin]);
  const int parts = std::max(1, static_cast<int>(std::ceil(joint.step_s / longest_step_s - 1e-6)));
  const double h = joint.step_s / parts;
  const double late = d.delay_s / joint.step_s;
  const bool curved = d.stribeck != 0.0;
  for (Eigen::Index row = begin; row < end; ++row) {
    out[row - begin] = q;
    if (row + 1 == end) break;
    for (int part = 0; part < parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const auto between = [&](const Eigen::VectorXd& series) {
        return series[row] + share * (series[row + 1] - series[row]);
      };
      const double sent = static_cast<double>(row) + share - late;
      const Eigen::Index at = std::max(begin, static_cast<Eigen::Index>(std::floor(sent + 1e-6)));
      const double rigid_inertia = between(joint.inertia), inertia = rigid_inertia + d.armature;
      const double command = std::clamp(d.kp * (joint.target[at] - q) - d.kd * w, -d.limit, d.limit);
      double effort =
          d.effort_scale * (command + d.kd * w) - d.bias - d.stiffness * q - d.drag * w * std::fabs(w);
      for (std::size_t i = 0; i + 2 < d.ripple.size(); i += 3)
        effort -= d.ripple[i + 1] * std::sin(d.ripple[i] * q) + d.ripple[i + 2] * std::cos(d.ripple[i] * q);
      const double rest = between(joint.rest) + d.gravity_error * between(joint.gravity) +
                          d.moment_a * between(joint.moment_a) + d.moment_b * between(joint.moment_b);
      double friction = d.friction + d.friction_slope * (q - d.friction_middle) + d.load_friction * load;
      if (curved) friction += d.stribeck * std::exp(-std::fabs(w) / d.stribeck_rate);
      friction = std::max(0.0, friction);
      const double damping = d.damping + d.effort_scale * (d.kd + 0.5 * h * d.kp);
      const double free = (inertia * w + h * (effort - rest)) / (inertia + h * damping);
      const double held = h * friction / (inertia + h * damping);
      const double next = std::fabs(free) <= held ? 0.0 : free - std::copysign(held, free);
      load = std::fabs(rest + rigid_inertia * (next - w) / h);
      w = next;
      q += h * w;
      if (!(std::fabs(q) < 1e3)) {
        out.tail(end - row - 1).setConstant(std::nan(""));
        return out;
      }
    }
  }
  return out;
}

}  // namespace thermopower::robot
