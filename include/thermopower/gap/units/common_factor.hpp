// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/units/posterior.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

/// @file common_factor.hpp
/// Constants that are off where no unit of the table is wrong: by one factor that several share, or by more than constants are.

namespace thermopower::gap::engine {

/// Adds a warning where one factor, or one that no constant has, explains what several constants would have to.
/// @param parts  recordings
/// @param shift  (UnitMeasure) -> logarithm of the factor that all of them share
template <class Shift>
void report_common_factor(const std::vector<UnitEvidence>& parts, Shift&& shift, const std::string& recording,
                          std::vector<Finding>& findings) {
  assert(!parts.empty());
  constexpr UnitThresholds limit;
  constexpr double alike = 1.08,
                   well = 0.15;  // factor that two constants differ by; deviation of one that tells a factor
  const auto is_told = [&](UnitMeasure kind) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const UnitEvidence& one) { return one[kind].is_told() && one[kind].sd < well; });
  };
  const auto is = [&](UnitMeasure kind, double log_factor) {
    return is_told(kind) && std::abs(shift(kind) - log_factor) < std::log(alike);
  };
  const auto add = [&](FindingKind kind, const std::string& column, const std::string& message,
                       const char* mend) {
    findings.push_back({kind, Severity::warning, recording, column, message, mend, FindingAction::none, {}});
  };
  const double drive = shift(UnitMeasure::drive), slope = shift(UnitMeasure::slope);
  const std::string moves = short_number(std::exp(drive)), faster = short_number(std::exp(slope));
  const std::string command = parts.front().has("voltage_V") ? "voltage_V" : "drive_A";
  const bool is_off = std::abs(drive) > std::log(limit.common) && is_told(UnitMeasure::drive);
  if (is_off && is(UnitMeasure::drag, drive) && (!is_told(UnitMeasure::slope) || is(UnitMeasure::slope, 0.0)))
    add(FindingKind::common_factor, command,
        "moves the axis " + moves +
            " times as much as the model says, against inertia and drag alike: one factor, such as "
            "a unit, a gear, a supply or torque_constant_Nm_per_A",
        "look at the unit of the command, the gear ratio and the supply");
  else if (is_off && is(UnitMeasure::slope, -drive) && is(UnitMeasure::drag, 0.0))
    add(FindingKind::common_factor, "t_s",
        "runs " + faster +
            " times too fast, or angle_deg is in another unit: one factor explains both that rate_dps is " +
            faster + " times the slope of angle_deg and that the command moves the axis " + moves +
            " times as much as the model says",
        "look at the clock that stamps the rows");
  else if (std::abs(drive) > std::log(limit.farthest))
    add(FindingKind::wrong_unit, command,
        "moves the axis " + moves +
            " times as much as the model says: the model's inertia_kgm2 or "
            "torque_constant_Nm_per_A is off by more than constants are",
        "look at the unit of the command and at the model's constants");
  const double heating = shift(UnitMeasure::heating), cooling = shift(UnitMeasure::cooling);
  if (std::min(std::abs(heating), std::abs(cooling)) > std::log(limit.farthest))
    add(FindingKind::wrong_unit, "t_s",
        "or the model's heat_capacity_J_per_K is off by more than constants are: the motor warms " +
            short_number(std::exp(heating)) + " times as fast as the model's, and cools " +
            short_number(std::exp(cooling)) + " times as fast",
        "look at the clock's unit and at the model's constants");
}

}  // namespace thermopower::gap::engine
