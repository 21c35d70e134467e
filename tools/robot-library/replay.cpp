// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "replay.hpp"

#include <utility>

namespace thermopower::robot {

Replay::Replay(const Body& body, const Series& series, std::vector<char> driven)
    : body_(body), series_(series), driven_(std::move(driven)) {}

Motion Replay::base(const Stretch& stretch) const {
  Motion out;
  const Motion& all = series_.motion;
  if (all.base_pose.rows() == 0) return out;
  out.base_pose = all.base_pose.middleRows(stretch.begin, stretch.rows());
  if (all.base_velocity.rows() > 0) {
    out.base_velocity = all.base_velocity.middleRows(stretch.begin, stretch.rows());
    out.base_acceleration = all.base_acceleration.middleRows(stretch.begin, stretch.rows());
  }
  return out;
}

Eigen::MatrixXd Replay::positions(std::vector<JointDynamics> joints) const {
  Eigen::MatrixXd target = series_.target;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (driven_[j] != 0) continue;
    // Stiff enough to follow what was measured.
    JointDynamics& d = joints[j];
    d = {};
    d.armature = 1.0;
    d.kp = 1e5;
    d.kd = 6e2;
    target.col(static_cast<Eigen::Index>(j)) = series_.measured.col(static_cast<Eigen::Index>(j));
  }
  const auto count = static_cast<Eigen::Index>(joints.size());
  Eigen::MatrixXd out(series_.rows(), count);
  for (const Stretch& one : series_.stretches) {
    Eigen::MatrixXd start(2, count);
    start.row(0) = series_.measured.row(one.begin);
    start.row(1) = series_.motion.velocity.row(one.begin);
    out.middleRows(one.begin, one.rows()) =
        body_.simulate(series_.t_s.segment(one.begin, one.rows()), target.middleRows(one.begin, one.rows()),
                       start, joints, base(one));
  }
  return out;
}

}  // namespace thermopower::robot
