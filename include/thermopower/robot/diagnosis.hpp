// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/family.hpp>
#include <thermopower/robot/groups.hpp>
#include <thermopower/robot/joint_fit.hpp>
#include <thermopower/robot/series.hpp>
#include <thermopower/robot/wiring.hpp>

#include <limits>
#include <string>
#include <vector>

namespace thermopower::robot {

/// What is said of one joint.
enum class JointVerdict {
  no_gap,       ///< the model as configured accounts for the joint's effort
  explained,    ///< with the causes told, little of the gap is left
  partial,      ///< the causes told take a material share; a rest stays
  unexplained,  ///< there is a gap, and no cause takes a material share of it
  not_judged,   ///< the log says nothing of this joint; `reason` says why
};

/// The word of a verdict, as reports have it.
inline const char* to_string(JointVerdict verdict) {
  switch (verdict) {
    case JointVerdict::no_gap:
      return "no_gap";
    case JointVerdict::explained:
      return "explained";
    case JointVerdict::partial:
      return "partial";
    case JointVerdict::unexplained:
      return "unexplained";
    case JointVerdict::not_judged:
      return "not_judged";
  }
  return "";
}

/// A constant of a joint that changes.
struct Change {
  std::string name;    ///< such as `damping`
  std::string unit;    ///< such as `N m s/rad`
  double from = 0.0;   ///< in the model file
  double to = 0.0;     ///< as found
  double error = 0.0;  ///< standard error of `to`
};

/// A gap, on rows that no fit has seen.
struct Gap {
  double before = std::numeric_limits<double>::quiet_NaN();  ///< with the model as configured
  double recalibrated =
      std::numeric_limits<double>::quiet_NaN();  ///< with armature, damping, friction and a constant refitted
  double after = std::numeric_limits<double>::quiet_NaN();  ///< with the causes told
};

/// @brief What was found in one joint.
struct JointDiagnosis {
  std::string name;                             ///< in the model file
  JointVerdict verdict = JointVerdict::no_gap;  ///< what is said
  std::string reason;                           ///< why it is not judged
  std::vector<Term> causes;                     ///< told, most important first
  std::vector<Term> seen;       ///< that lower the effort and not the tracking error: not told
  std::vector<Change> changes;  ///< constants that move, and new ones
  double effort_rms = 0.0;      ///< of the joint, in N m, held out
  Gap effort;                   ///< effort not accounted for in N m, root mean square
  Gap tracking;  ///< tracking error of the simulated robot in rad, root mean square; NaN without targets
  JointDynamics configured;    ///< constants as in the model file
  JointDynamics recalibrated;  ///< with four constants refitted
  JointDynamics found;         ///< with the causes
  Eigen::MatrixXd covariance;  ///< of `changes`, in their order
  int group = -1;              ///< of joints that are built alike
  bool differs = false;        ///< it does not fit the others of its group
  std::string difference;      ///< how
};

/// @brief What joints that are built alike have in common.
struct GroupDiagnosis {
  std::string name;            ///< what their names have in common
  std::vector<int> members;    ///< of the robot
  std::vector<Family> causes;  ///< told for at least half of the joints
  std::vector<Change> pooled;  ///< mean over the joints; `error` is the spread
  std::vector<int> different;  ///< joints that do not fit the others
};

/// @brief What was found in a whole robot.
struct RobotDiagnosis {
  Robot robot;                         ///< with the gains that were used
  std::string log;                     ///< file that was fitted on
  Eigen::Index rows = 0;               ///< fitted on
  Eigen::Index held_out_rows = 0;      ///< judged on
  double step_s = 0.0;                 ///< between rows
  double cutoff_Hz = 0.0;              ///< of the filter
  double delay_s = 0.0;                ///< of the whole bus
  bool effort_is_measured = false;     ///< else it follows from targets and gains
  bool stands_on_ground = false;       ///< the legs carry a load that nobody logged
  std::vector<WiringFinding> wiring;   ///< findings about the log, before any physics
  std::vector<std::string> notes;      ///< what else is worth knowing
  std::vector<JointDiagnosis> joints;  ///< in the order of the model
  std::vector<GroupDiagnosis> groups;  ///< of joints that are built alike
  Gap tracking;                        ///< of all joints together, in rad
  Series replayed;                     ///< rows that it was judged on
  Eigen::MatrixXd
      position_configured;         ///< simulated in those rows, in rad; empty where nothing was simulated
  Eigen::MatrixXd position_found;  ///< the same with the causes
};

}  // namespace thermopower::robot
