// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/family.hpp>
#include <thermopower/robot/joint_fit.hpp>
#include <thermopower/robot/joint_simulation.hpp>
#include <thermopower/robot/series.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::robot {

/// @brief Constants of a joint as the model file has them, for a simulation.
inline JointDynamics configured(const Joint& joint) {
  JointDynamics d;
  d.armature = joint.armature;
  d.damping = joint.damping;
  d.friction = joint.friction;
  d.stiffness = joint.stiffness;
  d.bias = -joint.stiffness * joint.spring_rest;
  d.kp = std::isfinite(joint.kp) ? joint.kp : 0.0;
  d.kd = std::isfinite(joint.kd) ? joint.kd : 0.0;
  d.limit = std::min(1e300, joint.effort_limit);
  return d;
}

/// @brief The same with what a regression found.
inline JointDynamics with_terms(const Joint& joint, const JointProblem& problem, const JointFit& fit) {
  JointDynamics d = configured(joint);
  d.stribeck_rate =
      JointProblem::stribeck_shares[static_cast<std::size_t>(fit.stribeck)] * problem.usual_rate();
  d.friction_middle = problem.middle();
  // Numbers that several terms share are the same in each of them.
  std::vector<std::string> done;
  for (const Term& term : fit.terms)
    for (const Coefficient& one : term.numbers) {
      if (std::find(done.begin(), done.end(), one.name) != done.end()) continue;
      done.push_back(one.name);
      if (one.name == "armature") d.armature += one.value;
      if (one.name == "damping") d.damping += one.value;
      if (one.name == "friction") d.friction += one.value;
      if (one.name == "constant") d.bias += one.value;
      if (one.name == "stiffness") d.stiffness += one.value, d.bias -= one.value * problem.middle();
      if (one.name == "gravity_share") d.gravity_error += one.value;
      if (one.name == "moment_a") d.moment_a += one.value;
      if (one.name == "moment_b") d.moment_b += one.value;
      if (one.name == "stribeck") d.stribeck += one.value;
      if (one.name == "friction_slope") d.friction_slope += one.value;
      if (one.name == "load_share") d.load_friction += one.value;
      if (one.name == "drag") d.drag += one.value;
      if (one.name == "effort_share") d.effort_scale /= 1.0 + one.value;
      if (one.name == "sine") d.ripple = {static_cast<double>(fit.ripple_cycles), one.value, 0.0};
      if (one.name == "cosine" && d.ripple.size() == 3) d.ripple[2] = one.value;
    }
  return d;
}

/// @brief Fits the constants of one joint to its tracking: simulated under its controller while all other joints move as measured.
///
/// How to: @ref diagnose_a_robot.
class ForwardFitter {
public:
  /// @param series  the log; its targets are what the controller was given
  /// @param body    what the rigid body asks for
  /// @param index   of the joint
  ForwardFitter(const Series& series, const BodyRows& body, Eigen::Index index)
      : stretches_(series.stretches) {
    joint_.step_s = series.step_s;
    joint_.target = series.target.col(index);
    joint_.position = series.measured.col(index);
    joint_.velocity = series.motion.velocity.col(index);
    joint_.inertia = body.inertia.col(index);
    joint_.rest =
        body.torque.col(index) - body.inertia.col(index).cwiseProduct(series.motion.acceleration.col(index));
    joint_.gravity = body.gravity.col(index);
    joint_.moment_a = body.moment_a.col(index);
    joint_.moment_b = body.moment_b.col(index);
  }

  /// Shares of each stretch, as pairs of begin and end.
  using Shares = std::vector<std::pair<double, double>>;

  /// @brief Root mean square of the tracking error in rad over shares of each stretch; infinite where it diverges. Each share begins
  /// at the measured state.
  double error(const JointDynamics& d, const Shares& shares = whole()) const {
    const Eigen::VectorXd left = residual(d, shares);
    if (!left.allFinite() || left.size() == 0) return std::numeric_limits<double>::infinity();
    return std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
  }

  /// @brief Moves the constants and the numbers of the given families so that the tracking error falls (Levenberg-Marquardt).
  JointDynamics fit(JointDynamics d, const std::vector<Family>& families,
                    const Shares& shares = whole()) const {
    const std::vector<Number> numbers = numbers_of(d, families);
    const auto count = static_cast<Eigen::Index>(numbers.size());
    if (count == 0) return d;
    Eigen::VectorXd left = residual(d, shares);
    if (!left.allFinite() || left.size() == 0) return d;
    double cost = left.squaredNorm(), lambda = 1e-3;
    for (int pass = 0; pass < most_passes; ++pass) {
      Eigen::MatrixXd jacobian(left.size(), count);
      for (Eigen::Index i = 0; i < count; ++i) {
        const Number& one = numbers[static_cast<std::size_t>(i)];
        JointDynamics moved = d;
        at(moved, one) += one.step;
        jacobian.col(i) = (residual(moved, shares) - left) / one.step;
      }
      if (!jacobian.allFinite()) break;
      const Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
      const Eigen::VectorXd slope = jacobian.transpose() * left;
      bool is_lower = false;
      double won = 0.0;
      for (int trial = 0; trial < 6 && !is_lower; ++trial) {
        Eigen::MatrixXd damped = normal;
        damped.diagonal() *= 1.0 + lambda;
        damped.diagonal().array() += 1e-12;
        const Eigen::VectorXd move = damped.ldlt().solve(-slope);
        JointDynamics then = d;
        for (Eigen::Index i = 0; i < count; ++i) {
          const Number& one = numbers[static_cast<std::size_t>(i)];
          at(then, one) = std::clamp(at(then, one) + move[i], one.least, one.most);
        }
        const Eigen::VectorXd after = residual(then, shares);
        const double square =
            after.allFinite() ? after.squaredNorm() : std::numeric_limits<double>::infinity();
        if (square < cost) {
          won = 1.0 - square / cost;
          d = then;
          left = after;
          cost = square;
          lambda = std::max(1e-9, 0.2 * lambda);
          is_lower = true;
        } else {
          lambda *= 8.0;
        }
      }
      if (!is_lower || won < 1e-4) break;
    }
    return d;
  }

private:
  static constexpr int most_passes = 20;
  static constexpr double step_s = 2.5e-3;  // of the fit's simulation; the judge takes shorter ones

  struct Number {
    double JointDynamics::*member;
    int ripple;  // index in JointDynamics::ripple instead
    double step, least, most;
  };

  static double& at(JointDynamics& d, const Number& one) {
    return one.member != nullptr ? d.*one.member : d.ripple[static_cast<std::size_t>(one.ripple)];
  }

  static std::vector<Number> numbers_of(const JointDynamics& d, const std::vector<Family>& families) {
    constexpr double far = 1e6;
    std::vector<Number> out;
    for (const Family family : families) {
      switch (family) {
        case Family::armature:
          out.push_back({&JointDynamics::armature, 0, 1e-3, 0.0, far});
          break;
        case Family::damping:
          out.push_back({&JointDynamics::damping, 0, 1e-2, 0.0, far});
          break;
        case Family::friction:
          out.push_back({&JointDynamics::friction, 0, 1e-2, 0.0, far});
          break;
        case Family::constant:
          out.push_back({&JointDynamics::bias, 0, 1e-2, -far, far});
          break;
        case Family::spring:
          out.push_back({&JointDynamics::stiffness, 0, 1e-2, -far, far});
          if (std::find(families.begin(), families.end(), Family::constant) == families.end())
            out.push_back({&JointDynamics::bias, 0, 1e-2, -far, far});
          break;
        case Family::gravity:
          out.push_back({&JointDynamics::gravity_error, 0, 1e-2, -1.0, 2.0});
          break;
        case Family::imbalance:
          out.push_back({&JointDynamics::moment_a, 0, 1e-3, -far, far});
          out.push_back({&JointDynamics::moment_b, 0, 1e-3, -far, far});
          break;
        case Family::stribeck:
          out.push_back({&JointDynamics::stribeck, 0, 1e-2, 0.0, far});
          break;
        case Family::load_friction:
          out.push_back({&JointDynamics::load_friction, 0, 1e-2, 0.0, 1.0});
          break;
        case Family::position_friction:
          out.push_back({&JointDynamics::friction_slope, 0, 1e-2, -far, far});
          break;
        case Family::drag:
          out.push_back({&JointDynamics::drag, 0, 1e-2, 0.0, far});
          break;
        case Family::effort_scale:
          out.push_back({&JointDynamics::effort_scale, 0, 1e-2, 0.5, 2.0});
          break;
        case Family::ripple:
          if (d.ripple.size() == 3) {
            out.push_back({nullptr, 1, 1e-2, -far, far});
            out.push_back({nullptr, 2, 1e-2, -far, far});
          }
          break;
      }
    }
    return out;
  }

  static Shares whole() { return {{0.0, 1.0}}; }

  Eigen::VectorXd residual(const JointDynamics& d, const Shares& shares) const {
    std::vector<Eigen::VectorXd> parts;
    Eigen::Index rows = 0;
    for (const Stretch& one : stretches_)
      for (const auto& share : shares) {
        const auto row = [&](double at) {
          return one.begin + static_cast<Eigen::Index>(at * static_cast<double>(one.rows()));
        };
        const Stretch part{row(share.first), row(share.second)};
        if (part.rows() < 2) continue;
        parts.push_back(simulate(joint_, d, part.begin, part.end, step_s) -
                        joint_.position.segment(part.begin, part.rows()));
        rows += part.rows();
      }
    Eigen::VectorXd all(rows);
    Eigen::Index at_row = 0;
    for (const auto& part : parts) {
      all.segment(at_row, part.size()) = part;
      at_row += part.size();
    }
    return all;
  }

  SingleJoint joint_;
  std::vector<Stretch> stretches_;
};

}  // namespace thermopower::robot
