// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/diagnosis.hpp>
#include <thermopower/robot/joint_fit.hpp>
#include <thermopower/robot/log.hpp>
#include <thermopower/robot/series.hpp>
#include <thermopower/robot/wiring.hpp>

#include <vector>

namespace thermopower::robot {

/// @brief How a robot is diagnosed.
struct Options {
  SmoothingOptions smoothing;   ///< of the log
  FitOptions fit;               ///< of each joint
  WiringOptions wiring;         ///< of what is checked before
  double held_out_share = 0.3;  ///< end of each run that is kept for judging, where no other log is
  double latest_rows = 4.0;     ///< longest delay of the bus that is looked for, in rows
  bool as_recorded = false;     ///< the wiring's findings are said, and the log stays as it is
  bool in_the_air = false;      ///< the user says that nothing touches the robot
  double ground_share = 0.3;    ///< share of the weight in the limbs' efforts above which the robot stands
};

/// @brief Several logs of the same robot as one: each run of each of them is a run of its own.
Log together(const std::vector<Log>& logs);

/// @brief Diagnoses a whole robot: which joint, which effect, how far.
///
/// First the wiring is checked (check_wiring()), and the log is put right.
/// With the measured motion the rigid body says for each row what it asks of each joint, so that a robot of n joints becomes n single
/// joints. In each of them the causes are found by regression of the effort on the motion. Joints that are built alike are compared.
/// What was found goes back into the whole robot, and its simulation under the logged targets is judged on rows that no fit has seen.
/// @param body      the robot; its joints have the gains with which efforts follow from targets
/// @param robot     its joints, with gains that the user gave
/// @param log       to find and fit on
/// @param held_out  to judge on; empty: the end of each run of `log`
RobotDiagnosis diagnose(const Body& body, const Robot& robot, const Log& log,
                        const std::vector<Log>& held_out, const Options& options = {});

}  // namespace thermopower::robot
