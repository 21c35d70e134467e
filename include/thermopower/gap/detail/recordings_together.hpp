// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// @file recordings_together.hpp
/// What recordings of one rig that are given together say of each other's units.

namespace thermopower::gap::engine {

/// Thresholds of what recordings say of each other.
/// Held by tests/gap/data/scale_test.cpp.
struct TogetherThresholds {
  double apart_K =
      25.0;  ///< by which the air of one recording is warmer than that of the others, in the numbers
  double same_K = 10.0;      ///< by which it may be, once converted
  double hottest_C = 45.0;   ///< of the others
  double coldest_C = -10.0;  ///< of the others
};

/// What of recordings that are given together is kept until all of them have been looked at.
class RecordingsTogether {
public:
  /// Takes a recording.
  void add(const Recording& recording) {
    Kept kept{recording.name, {"t_s"}, missing, missing};
    for (const Column& one : recording.columns)
      if (recording.has(one.name)) kept.columns.push_back(one.name);
    constexpr double low = 0.05, middle = 0.5;
    const auto quantile = [&](const char* name, double share) {
      if (!recording.has(name)) return missing;
      std::vector<double> values = finite_samples(recording.column(name));
      return quantile_of(values, share);
    };
    kept.air = quantile("ambient_C", middle);
    kept.coldest = quantile("motor_C", low);
    recordings_.push_back(std::move(kept));
  }

  /// Adds air that is in degrees Fahrenheit in one recording and in degrees Celsius in the others.
  void find_air(std::vector<Finding>& findings) const {
    constexpr TogetherThresholds limit;
    constexpr double per_kelvin = 1.8, ice_F = 32.0;
    for (const Kept& one : recordings_) {
      if (!std::isfinite(one.air) || is_found(findings, one.name)) continue;
      std::vector<double> others;
      for (const Kept& other : recordings_)
        if (&other != &one && std::isfinite(other.air)) others.push_back(other.air);
      if (others.empty()) continue;
      const double air_C = median_of(others), then_C = (one.air - ice_F) / per_kelvin;
      if (!(air_C > limit.coldest_C && air_C < limit.hottest_C && one.air - air_C > limit.apart_K &&
            std::abs(then_C - air_C) < limit.same_K))
        continue;
      std::string mend = column_option("ambient_C", "degF");
      // No motor is colder than its air: one that is not in these numbers is in the same unit.
      if (one.coldest > one.air - limit.same_K) mend = column_option("motor_C", "degF") + " " + mend;
      findings.push_back({FindingKind::wrong_unit,
                          Severity::error,
                          one.name,
                          "ambient_C",
                          "is about " + short_number(one.air) + ", and in the other recordings " +
                              short_number(air_C) +
                              ": in degrees Fahrenheit where degrees Celsius are expected",
                          mend,
                          FindingAction::none,
                          {}});
    }
  }

  /// Of findings about one column that contradict each other, leaves those that most recordings show; and says where a mistake is
  /// not in all recordings.
  void settle(std::vector<Finding>& findings) const {
    std::vector<Finding> settled;
    for (const Finding& one : findings) {
      const bool loses =
          is_unit(one) && std::any_of(findings.begin(), findings.end(), [&](const Finding& other) {
            return is_unit(other) && other.column == one.column && other.mend != one.mend &&
                   weight_of(other, findings) > weight_of(one, findings);
          });
      const bool contradicts =
          is_unit(one) && std::any_of(settled.begin(), settled.end(), [&](const Finding& before) {
            return is_unit(before) && before.column == one.column && before.mend != one.mend;
          });
      if (!loses && !contradicts) settled.push_back(one);
    }
    for (Finding& one : settled) {
      if (!is_unit(one)) continue;
      const auto alike = std::count_if(settled.begin(), settled.end(), [&](const Finding& other) {
        return is_unit(other) && other.column == one.column;
      });
      const auto possible = std::count_if(recordings_.begin(), recordings_.end(), [&](const Kept& kept) {
        return std::find(kept.columns.begin(), kept.columns.end(), one.column) != kept.columns.end();
      });
      if (alike < possible)
        one.message +=
            alike == 1 ? "; no other recording shows it: where those are right, convert this file alone, for "
                         "the option goes for all of them"
                       : "; not all recordings show it: the option goes for all of them";
    }
    findings = std::move(settled);
  }

private:
  struct Kept {
    std::string name;
    std::vector<std::string> columns;
    double air;      // median
    double coldest;  // of the motor
  };

  static bool is_decided(const Finding& one) {
    return one.severity == Severity::error &&
           (one.kind == FindingKind::wrong_unit || one.kind == FindingKind::wrong_sign ||
            one.kind == FindingKind::swapped_columns);
  }

  /// Whether it is about the unit of a whole column: what is said of some runs names them itself.
  static bool is_unit(const Finding& one) { return is_decided(one) && one.rows.empty(); }

  /// How many recordings show what a finding says; one that names no option counts for nothing.
  static std::ptrdiff_t weight_of(const Finding& one, const std::vector<Finding>& findings) {
    if (one.mend.rfind("--column", 0) != 0) return 0;
    return std::count_if(findings.begin(), findings.end(), [&](const Finding& other) {
      return is_unit(other) && other.column == one.column && other.mend == one.mend;
    });
  }

  static bool is_found(const std::vector<Finding>& findings, const std::string& recording) {
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return is_decided(one) && one.recording == recording &&
             (one.column == "ambient_C" || one.column == "motor_C");
    });
  }

  std::vector<Kept> recordings_;
};

}  // namespace thermopower::gap::engine
