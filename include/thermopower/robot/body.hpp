// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/joint.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief Motion of a whole robot. Each matrix has one row per sample and one column per joint of the model.
struct Motion {
  Eigen::MatrixXd position;      ///< in rad
  Eigen::MatrixXd velocity;      ///< in rad/s
  Eigen::MatrixXd acceleration;  ///< in rad/s2
  /// Motion of the base, one row per sample; empty where the base does not move.
  Eigen::MatrixXd base_pose;          ///< 7 columns: position in m, orientation as a unit quaternion w x y z
  Eigen::MatrixXd base_velocity;      ///< 6 columns: m/s in the world's frame, rad/s in the body's frame
  Eigen::MatrixXd base_acceleration;  ///< 6 columns: m/s2 and rad/s2, in the same frames
};

/// @brief What the rigid body asks of each joint. Each matrix has one row per sample and one column per joint.
struct BodyRows {
  Eigen::MatrixXd inertia;  ///< apparent inertia in kg m2: diagonal of the mass matrix, without the armature
  Eigen::MatrixXd
      torque;  ///< effort in N m that moves the rigid body: inertia, coupling, gravity and motion of the base
  Eigen::MatrixXd gravity;   ///< its part that holds the weight, in N m
  Eigen::MatrixXd moment_a;  ///< effort in N m that 1 kg m of unbalanced mass on the joint's link asks for
  Eigen::MatrixXd moment_b;  ///< the same for mass a quarter of a turn ahead
};

/// @brief Constants of one joint and the effects that act in it, for a simulation of the whole robot.
struct JointDynamics {
  double armature = 0.0;            ///< kg m2
  double damping = 0.0;             ///< N m s/rad
  double friction = 0.0;            ///< N m
  double bias = 0.0;                ///< constant effort that the drive loses, in N m
  double stiffness = 0.0;           ///< of a spring, in N m/rad
  double stribeck = 0.0;            ///< friction at rest above `friction`, in N m
  double stribeck_rate = 1.0;       ///< rad/s at which that falls to 1/e
  double friction_slope = 0.0;      ///< friction per rad of position, in N m/rad
  double friction_middle = 0.0;     ///< position in rad at which `friction` holds
  double load_friction = 0.0;       ///< friction per N m of load
  double drag = 0.0;                ///< N m s2/rad2
  double moment_a = 0.0;            ///< unbalanced mass in kg m
  double moment_b = 0.0;            ///< a quarter of a turn ahead, in kg m
  double gravity_error = 0.0;       ///< share of the weight that the model lacks
  double effort_scale = 1.0;        ///< effort at the joint per effort that is commanded
  double delay_s = 0.0;             ///< of the target
  double kp = 0.0;                  ///< N m/rad
  double kd = 0.0;                  ///< N m s/rad
  double limit = 1e300;             ///< N m
  std::vector<double> ripple = {};  ///< triples: cycles per turn, sine and cosine in N m
};

/// @brief Effort in N m at each joint that a force of 1 N straight up at the end of its limb asks for.
struct LimbForces {
  Eigen::MatrixXd
      effort;  ///< one row per sample, one column per joint; zero where the limb's end does not hang on the joint
  std::vector<int> limb_of_joint;  ///< number of the limb of each joint; -1: none
};

/// @brief A rigid robot that answers for measured motion and that can be simulated.
///
/// How to: @ref diagnose_a_robot.
class Body {
public:
  virtual ~Body() = default;

  /// The joints, with the constants of the model file.
  virtual const Robot& robot() const = 0;

  /// What the rigid body asks of each joint in each row. The constants of the joints take no part.
  virtual BodyRows ask(const Motion& motion) const = 0;

  /// @brief Simulates all joints together under their position controllers.
  /// @param t_s     time of each row in s, strictly increasing
  /// @param target  in rad, one row per time and one column per joint; held to the next row
  /// @param start   position in rad and velocity in rad/s of each joint in the first row: two rows
  /// @param joints  constants, one per joint
  /// @param base    motion whose base is replayed; its base is empty where the base stands still
  /// @return position in rad of each joint in each row; NaN from the row on in which the simulation diverges
  virtual Eigen::MatrixXd simulate(const Eigen::VectorXd& t_s, const Eigen::MatrixXd& target,
                                   const Eigen::MatrixXd& start, const std::vector<JointDynamics>& joints,
                                   const Motion& base) const = 0;

  /// @brief Position in m of a body, a site or a geom in the world, for each row of joint positions.
  /// @param kind  `body`, `site` or `geom`; empty: whichever has that name
  /// @return three columns; empty where the robot has none of that name
  virtual Eigen::MatrixXd place_of(const std::string& kind, const std::string& name,
                                   const Eigen::MatrixXd& position, const Motion& base) const {
    static_cast<void>(kind), static_cast<void>(name), static_cast<void>(position), static_cast<void>(base);
    return {};
  }

  /// What a force of the ground at the ends of the limbs would ask for. Empty: the robot has no limbs.
  virtual LimbForces upward_force(const Motion&) const { return {}; }
};

}  // namespace thermopower::robot
