// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/series.hpp>

#include <Eigen/Core>

#include <vector>

namespace thermopower::robot {

/// @brief Simulates all joints of a robot together under the logged targets. Each stretch of the log begins at the measured state.
class Replay {
public:
  /// @param driven  joints with targets and gains; each other joint follows its measured motion
  Replay(const Body& body, const Series& series, std::vector<char> driven);

  /// @brief Position in rad of each joint in each row of the series; NaN from the row on in which it diverges.
  Eigen::MatrixXd positions(std::vector<JointDynamics> joints) const;

  /// Motion of the base in the rows of a stretch; empty where the base stands still.
  Motion base(const Stretch& stretch) const;

private:
  const Body& body_;
  const Series& series_;
  std::vector<char> driven_;
};

}  // namespace thermopower::robot
