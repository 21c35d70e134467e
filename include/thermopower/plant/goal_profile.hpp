// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/model.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace thermopower::plant {

/// @brief The set point of a servo on its way to a new target: at most at a rate, and at most with an acceleration.
///
/// The servos of hobby and robot kits call this a profile, a goal speed or a goal acceleration. At each new target the set point goes
/// on from where it is.
///
/// @snippet plant_examples.cpp goal profile
/// How to: @ref servo_on_a_pendulum.
class GoalProfile {
public:
  /// @param dps   fastest rate, deg/s, > 0  @param dps2  acceleration, deg/s^2; 0: any  @param start_deg  where it begins, at rest
  GoalProfile(double dps, double dps2, double start_deg) : dps_(dps), dps2_(dps2), deg_(start_deg) {}

  /// Goes on toward a target for `length_s`, in steps of at most `step_s`.
  void go(double target_deg, double length_s, double step_s) {
    const int steps = std::max(1, static_cast<int>(std::ceil(length_s / step_s - 1e-9)));
    for (int i = 0; i < steps; ++i) step(target_deg, length_s / steps);
  }

  /// The set point, in degrees.
  double deg() const { return deg_; }
  /// The rate of the set point, in deg/s.
  double dps() const { return rate_dps_; }

private:
  void step(double target_deg, double step_s) {
    const double left = target_deg - deg_;
    double wanted = std::copysign(dps_, left);
    if (dps2_ > 0.0) {
      // The rate from which it still stops at the target, at the step's end.
      const double lost = 0.5 * dps2_ * step_s,
                   stops = std::sqrt(lost * lost + 2.0 * dps2_ * std::abs(left)) - lost;
      wanted = std::copysign(std::min(dps_, stops), left);
      wanted = std::clamp(wanted, rate_dps_ - dps2_ * step_s, rate_dps_ + dps2_ * step_s);
    }
    const bool arrives = std::abs(left) <= std::abs(wanted) * step_s && left * wanted >= 0.0 &&
                         (!(dps2_ > 0.0) || std::abs(wanted) <= 2.0 * dps2_ * step_s);
    deg_ = arrives ? target_deg : deg_ + wanted * step_s;
    rate_dps_ = arrives ? 0.0 : wanted;
  }

  double dps_, dps2_, deg_, rate_dps_ = 0.0;
};

/// @brief Replaces the target of a position servo that has a profile by its set point: `target_deg`, and `target_dps` where none is
/// recorded. Both then go straight from row to row. Each run starts at rest at its first measured angle.
/// @param model   of the axis; without `profile_dps` nothing changes
/// @param inputs  whose targets are replaced
inline void follow_profile(const Model& model, Inputs& inputs) {
  const auto* servo = std::get_if<PositionPidServo>(&model.servo);
  if (servo == nullptr || !(servo->profile_dps > 0.0) || inputs.target_deg.size() == 0) return;
  const Eigen::VectorXd& angle = inputs.of(Signal::angle_deg);
  Eigen::VectorXd deg = inputs.target_deg, dps = Eigen::VectorXd::Zero(inputs.rows());
  for (const RunSpan& run : inputs.runs) {
    Eigen::Index first = run.begin;
    while (first + 1 < run.end && !(angle.size() > 0 && std::isfinite(angle[first]))) ++first;
    const bool known = angle.size() > 0 && first < run.end && std::isfinite(angle[first]);
    GoalProfile profile(servo->profile_dps, servo->profile_dps2,
                        known ? angle[first] : inputs.target_deg[run.begin]);
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      deg[row] = profile.deg();
      dps[row] = profile.dps();
      if (row + 1 < run.end)
        profile.go(inputs.target_deg[row], inputs.t_s[row + 1] - inputs.t_s[row], servo->period_s);
    }
  }
  inputs.target_deg = deg;
  if (inputs.target_dps.size() == 0) inputs.target_dps = dps;
  inputs.target_moves = true;
}

}  // namespace thermopower::plant
