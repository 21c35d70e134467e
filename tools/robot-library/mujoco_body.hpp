// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>

#include <memory>
#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief A robot in MuJoCo.
class MujocoBody : public Body {
public:
  /// @brief Reads a robot from an MJCF or URDF file; the root element says which it is.
  /// @throws io::InputError with the file and what MuJoCo says
  explicit MujocoBody(const std::string& path);

  /// @brief The same from a text in memory; `name` stands in messages where a path would.
  MujocoBody(const std::string& name, const std::string& text);

  ~MujocoBody() override;

  const Robot& robot() const override;
  BodyRows ask(const Motion& motion) const override;
  Eigen::MatrixXd simulate(const Eigen::VectorXd& t_s, const Eigen::MatrixXd& target,
                           const Eigen::MatrixXd& start, const std::vector<JointDynamics>& joints,
                           const Motion& base) const override;

  Eigen::MatrixXd place_of(const std::string& kind, const std::string& name, const Eigen::MatrixXd& position,
                           const Motion& base) const override;

  /// The end of a limb is the geom that is farthest from the limb's first joint.
  LimbForces upward_force(const Motion& motion) const override;

  /// @brief Whether the file is a URDF file.
  bool is_urdf() const;

  /// @brief What was left out while the file was read, one sentence each.
  const std::vector<std::string>& notes() const;

private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace thermopower::robot
