// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/robot/diagnosis.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace thermopower::robot {

/// A family in one or two words, for a narrow table.
inline const char* in_short(Family family) {
  switch (family) {
    case Family::armature:
      return "armature";
    case Family::damping:
      return "damping";
    case Family::friction:
      return "friction";
    case Family::constant:
      return "constant";
    case Family::spring:
      return "spring";
    case Family::gravity:
      return "weight";
    case Family::imbalance:
      return "imbalance";
    case Family::stribeck:
      return "Stribeck";
    case Family::load_friction:
      return "load friction";
    case Family::position_friction:
      return "position friction";
    case Family::drag:
      return "drag";
    case Family::effort_scale:
      return "effort scale";
    case Family::ripple:
      return "cogging";
  }
  return "";
}

namespace detail {

/// A number with so many significant digits.
inline std::string number_text(double value, int digits = 3) {
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// A share in percent.
inline std::string percent_text(double share) {
  if (!std::isfinite(share)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

/// `before -> after` of a gap.
inline std::string gap_text(const Gap& gap, double factor, bool percent) {
  const auto one = [&](double value) {
    return percent ? percent_text(value * factor) : number_text(value * factor, 2);
  };
  if (!std::isfinite(gap.before)) return "-";
  return one(gap.before) + " -> " + one(gap.after);
}

/// Rows of cells as text, columns as wide as they need.
inline std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (width.size() <= i) width.push_back(0);
      width[i] = std::max(width[i], row[i].size());
    }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i];
      if (i + 1 < row.size()) line += std::string(width[i] - row[i].size() + 2, ' ');
    }
    out += line + "\n";
  }
  return out;
}

}  // namespace detail

/// @brief How much of a joint's gap the causes take: of the tracking error where the robot was simulated, else of the effort.
inline double share_taken(const JointDiagnosis& joint) {
  const Gap& gap = std::isfinite(joint.tracking.after) ? joint.tracking : joint.effort;
  return 1.0 - gap.after / gap.before;
}

/// @brief The diagnosis of a robot as text that fits on a screen: one row per joint.
inline std::string table_text(const RobotDiagnosis& robot) {
  constexpr double degrees = 180.0 / 3.14159265358979323846;
  std::string out = "Robot '" + robot.robot.name + "': " + std::to_string(robot.joints.size()) + " joints, " +
                    std::to_string(robot.rows) + " rows fitted, " + std::to_string(robot.held_out_rows) +
                    " rows judged, effort " +
                    (robot.effort_is_measured ? "as measured" : "from targets and gains") + ".\n";
  if (robot.delay_s > 0.0)
    out += "The whole bus is late by " + detail::number_text(1e3 * robot.delay_s) + " ms.\n";
  for (const WiringFinding& one : robot.wiring)
    out += "Wiring: " + one.text + (one.mended ? " (put right here; --as-recorded leaves it)" : "") + ".\n";
  for (const std::string& one : robot.notes) out += "Note: " + one + ".\n";
  if (std::isfinite(robot.tracking.before))
    out += "All joints together track their log with an error of " +
           detail::number_text(degrees * robot.tracking.before) + " deg as configured, " +
           detail::number_text(degrees * robot.tracking.recalibrated) + " deg with refitted constants, " +
           detail::number_text(degrees * robot.tracking.after) + " deg with the causes.\n";
  std::vector<std::vector<std::string>> rows{
      {"joint", "verdict", "cause", "effort left", "tracking/deg", "taken"}};
  for (const JointDiagnosis& joint : robot.joints) {
    std::string causes;
    for (const Term& term : joint.causes)
      causes += (causes.empty() ? "" : ", ") + std::string(in_short(term.family));
    if (joint.verdict == JointVerdict::not_judged) {
      rows.push_back({joint.name, to_string(joint.verdict), joint.reason});
      continue;
    }
    rows.push_back({joint.name, to_string(joint.verdict), causes.empty() ? "-" : causes,
                    detail::gap_text(joint.effort, 1.0 / joint.effort_rms, true),
                    detail::gap_text(joint.tracking, degrees, false),
                    joint.causes.empty() ? "-" : detail::percent_text(share_taken(joint))});
  }
  // A reason may be long: it takes part in no column's width.
  std::vector<std::vector<std::string>> even;
  for (const auto& row : rows)
    if (row.size() > 3) even.push_back(row);
  std::string table = detail::aligned(even);
  std::size_t name_width = 0;
  for (const auto& row : rows) name_width = std::max(name_width, row[0].size());
  out += "\n" + table;
  for (const auto& row : rows)
    if (row.size() == 3)
      out += row[0] + std::string(name_width - row[0].size() + 2, ' ') + row[1] + ": " + row[2] + "\n";
  bool any = false;
  for (const GroupDiagnosis& group : robot.groups) {
    if (group.pooled.empty()) continue;
    out += any ? "" : "\nJoints that are built alike, mean and spread:\n";
    any = true;
    out += "  " + group.name + " (" + std::to_string(group.members.size()) + "):";
    for (std::size_t i = 0; i < group.pooled.size(); ++i) {
      const Change& one = group.pooled[i];
      out += (i == 0 ? " " : ", ") + one.name + " " + detail::number_text(one.from) + " -> " +
             detail::number_text(one.to) + " +- " + detail::number_text(one.error, 2) + " " +
             (one.unit == "1" ? "" : one.unit);
    }
    out += "\n";
    for (const int member : group.different) {
      const JointDiagnosis& joint = robot.joints[static_cast<std::size_t>(member)];
      out += "    " + joint.name + " differs: " + joint.difference + "\n";
    }
  }
  return out;
}

}  // namespace thermopower::robot
