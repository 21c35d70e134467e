// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/body.hpp>
#include <thermopower/robot/diagnosis.hpp>

#include <string>
#include <vector>

namespace thermopower::robot {

/// @brief What one cause is worth for the quantity that the user names.
struct ImpactRow {
  int joint = -1;          ///< of the robot; -1: the whole bus
  std::string cause;       ///< id of a family, or `delay`
  bool told = false;       ///< the diagnosis tells it; else it is a constant that moved along
  double put_in = 0.0;     ///< error with this cause alone in the model as configured
  double taken_out = 0.0;  ///< error with all causes but this one
  double share =
      0.0;  ///< of the error that all causes take: mean of what it takes first and what it takes last
};

/// @brief Which causes matter for a quantity.
struct Impact {
  std::string of;               ///< as the user named it
  std::string unit;             ///< rad, or m
  double configured = 0.0;      ///< error of the model as configured, root mean square
  double found = 0.0;           ///< error with all causes
  double replayed_s = 0.0;      ///< of the held-out log
  std::vector<ImpactRow> rows;  ///< largest share first
};

/// @brief Ranks causes by the error in a joint's or a link's position. Each is put into the whole model alone, and taken out of it
/// alone, while the logged targets of the held-out rows are replayed in the simulation of the whole robot.
///
/// How to: @ref diagnose_a_robot.
/// @param diagnosis  with its replayed rows; its joints have targets and gains
/// @param of         `joint:NAME`, `body:NAME`, `site:NAME` or `geom:NAME`; empty: all joints together
/// @throws std::invalid_argument where the robot has none of that name, or nothing can be replayed; the text says what is expected
Impact impact(const Body& body, const RobotDiagnosis& diagnosis, const std::string& of);

/// @brief The ranking as text that fits on a screen.
std::string impact_text(const RobotDiagnosis& diagnosis, const Impact& impact);

}  // namespace thermopower::robot
