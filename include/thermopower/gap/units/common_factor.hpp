// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/units/evidence.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

/// @file common_factor.hpp
/// Constants that are off where no unit of the table is wrong: by one factor that several share, or by more than constants are.

namespace thermopower::gap::engine {

/// Thresholds of a common factor. Factors are compared by the magnitudes of their logarithms.
/// Held by tests/gap/units/unit_posterior_test.cpp.
struct CommonFactorThresholds {
  double least = 1.5;    ///< factor that is worth a word
  double alike = 1.08;   ///< times that two constants may differ in it
  double sd = 0.15;      ///< of the logarithm of a constant that tells one
  double beyond = 30.0;  ///< factor that no constant is off by, as KnownConstants::farthest_factor
};

/// The measures of all recordings of a source.
struct SharedMeasures {
  const std::vector<UnitEvidence>& parts;        ///< recordings
  std::function<double(UnitMeasure)> logarithm;  ///< of the factor that all of them share

  /// Whether recordings tell a measure well.
  bool is_told(UnitMeasure kind) const {
    return std::any_of(parts.begin(), parts.end(), [&](const UnitEvidence& one) {
      return one[kind].is_told() && one[kind].sd < CommonFactorThresholds().sd;
    });
  }
  /// Whether a measure is off by a factor, within what two constants may differ.
  bool is(UnitMeasure kind, double log_factor) const {
    return is_told(kind) && std::abs(logarithm(kind) - log_factor) < std::log(CommonFactorThresholds().alike);
  }
};

/// Adds a warning where one factor, or one that no constant has, explains what several constants would have to.
inline void report_common_factor(const SharedMeasures& of, const std::string& recording,
                                 std::vector<Finding>& findings) {
  assert(!of.parts.empty());
  constexpr CommonFactorThresholds limit;
  const auto add = [&](FindingKind kind, const char* column, const std::string& message, const char* mend) {
    findings.push_back({kind, Severity::warning, recording, column, message, mend, FindingAction::none, {}});
  };
  const double drive = of.logarithm(UnitMeasure::drive), slope = of.logarithm(UnitMeasure::slope);
  const std::string moves = short_number(std::exp(drive));
  const std::string command = of.parts.front().has("voltage_V") ? "voltage_V" : "drive_A";
  const bool is_off = std::abs(drive) > std::log(limit.least) && of.is_told(UnitMeasure::drive);
  if (is_off && of.is(UnitMeasure::drag, drive) &&
      (!of.is_told(UnitMeasure::slope) || of.is(UnitMeasure::slope, 0.0)))
    add(FindingKind::common_factor, command.c_str(),
        "moves the axis " + moves +
            " times as much as the model says, against inertia and drag alike: one factor, such as a unit, "
            "a gear, a supply or torque_constant_Nm_per_A",
        "look at the unit of the command, the gear ratio and the supply");
  else if (is_off && of.is(UnitMeasure::slope, -drive) && of.is(UnitMeasure::drag, 0.0))
    add(FindingKind::common_factor, "t_s",
        "runs " + short_number(std::exp(slope)) +
            " times too fast, or angle_deg is in another unit: one factor explains both that "
            "rate_dps is " +
            short_number(std::exp(slope)) +
            " times the slope of angle_deg and that the command moves the axis " + moves +
            " times as much as the model says",
        "look at the clock that stamps the rows");
  else if (std::abs(drive) > std::log(limit.beyond))
    add(FindingKind::wrong_unit, command.c_str(),
        "moves the axis " + moves +
            " times as much as the model says: the model's inertia_kgm2 or torque_constant_Nm_per_A is off "
            "by more than constants are",
        "look at the unit of the command and at the model's constants");
  const double heating = of.logarithm(UnitMeasure::heating), cooling = of.logarithm(UnitMeasure::cooling);
  if (std::abs(heating) > std::log(limit.beyond) && std::abs(cooling) > std::log(limit.beyond))
    add(FindingKind::wrong_unit, "t_s",
        "or the model's heat_capacity_J_per_K is off by more than constants are: the motor warms " +
            short_number(std::exp(heating)) + " times as fast as the model's, and cools " +
            short_number(std::exp(cooling)) + " times as fast",
        "look at the clock's unit and at the model's constants");
}

}  // namespace thermopower::gap::engine
