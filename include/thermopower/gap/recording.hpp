// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/charge_before.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thermopower::gap {

using namespace plant;  // NOLINT: what a user of the diagnosis names comes from both

/// One recorded channel.
struct Column {
  std::string name;        ///< with its unit, as in `motor_C`
  Eigen::VectorXd values;  ///< one per row; NaN is a missing sample
};

/// A recording of the real actuator, in memory.
///
/// Inputs (`power_param`, `drive_A`, `supply_V`, `ambient_C`, ...) are held from their row to the next one.
/// Outputs are samples at the row's time. Every other numeric column is a covariate.
/// Invariants (see validate()): all columns are as long as `t_s`, which is finite and strictly increasing inside a run. The
/// runs are in order and do not overlap.
///
/// @snippet plant_examples.cpp recording
/// How to: @ref diagnose_a_gap, @ref take_logs_in.
struct Recording {
  std::string name;                             ///< for messages, usually the file's name
  Eigen::VectorXd t_s;                          ///< time of each row in s
  std::vector<RunSpan> runs;                    ///< independent runs; empty means that all rows are one run
  std::vector<Column> columns;                  ///< everything else, in the order recorded
  Eigen::Index first_row = 0;                   ///< of a part: which row of the whole its first one is
  std::vector<std::string> empty_columns = {};  ///< that were there without a sample, and were left out

  /// Number of rows.
  Eigen::Index rows() const { return t_s.size(); }

  /// The column of that name, or nullptr.
  const Eigen::VectorXd* find(std::string_view column_name) const {
    for (const Column& one : columns)
      if (one.name == column_name) return &one.values;
    return nullptr;
  }

  /// Whether there is such a column with at least one sample in it.
  bool has(std::string_view column_name) const {
    const Eigen::VectorXd* values = find(column_name);
    return values != nullptr && values->array().isFinite().any();
  }

  /// Whether there was such a column without any sample in it.
  bool is_empty(std::string_view column_name) const {
    for (const std::string& one : empty_columns)
      if (one == column_name) return true;
    return false;
  }

  /// The column of that name. @throws InvalidInput where there is none.
  const Eigen::VectorXd& column(std::string_view column_name) const {
    const Eigen::VectorXd* values = find(column_name);
    if (values == nullptr)
      throw InvalidInput("recording '" + name + "': there is no column '" + std::string(column_name) + "'");
    return *values;
  }

  /// Adds a column, or replaces the one of that name.
  void set(std::string_view column_name, Eigen::VectorXd values) {
    for (Column& one : columns) {
      if (one.name == column_name) {
        one.values = std::move(values);
        return;
      }
    }
    columns.push_back({std::string(column_name), std::move(values)});
  }

  /// Removes the column of that name, as if it had not been recorded; where there is none, nothing changes.
  /// @return whether there was one
  bool remove(std::string_view column_name) {
    const auto kept = std::remove_if(columns.begin(), columns.end(),
                                     [&](const Column& one) { return one.name == column_name; });
    const bool found = kept != columns.end();
    columns.erase(kept, columns.end());
    return found;
  }

  /// The runs, or the whole recording as one run where none are given.
  std::vector<RunSpan> spans() const {
    if (!runs.empty()) return runs;
    return {RunSpan{0, rows(), std::string()}};
  }

  /// The rows [begin, end) as a recording of their own; the runs are cut accordingly.
  Recording slice(Eigen::Index begin, Eigen::Index end) const {
    assert(begin >= 0 && begin <= end && end <= rows());
    Recording part;
    part.name = name;
    part.first_row = first_row + begin;
    part.t_s = t_s.segment(begin, end - begin);
    const Eigen::VectorXd none, *amps = find("current_A"), *power = find("power_param");
    const RecordedCharge charge(t_s, amps != nullptr ? *amps : none, power != nullptr ? *power : none);
    for (const RunSpan& run : spans()) {
      const Eigen::Index first = run.begin > begin ? run.begin : begin;
      const Eigen::Index last = run.end < end ? run.end : end;
      if (first >= last) continue;
      const bool is_cut = run.begin < first;
      part.runs.push_back({first - begin, last - begin, run.label, run.goes_on || is_cut,
                           charge.until(run, first), run.was_driven && !is_cut});
    }
    for (const Column& one : columns)
      part.columns.push_back({one.name, one.values.segment(begin, end - begin)});
    return part;
  }

  /// The first fault in it, in one sentence, or nothing.
  std::optional<std::string> validate() const {
    for (const Column& one : columns)
      if (one.values.size() != rows())
        return "column '" + one.name + "' has " + std::to_string(one.values.size()) + " rows, t_s has " +
               std::to_string(rows());
    Eigen::Index previous_end = 0;
    for (const RunSpan& run : spans()) {
      if (run.begin < previous_end || run.end < run.begin || run.end > rows())
        return "run '" + run.label + "' spans rows that are out of order or out of range";
      previous_end = run.end;
      for (Eigen::Index row = run.begin; row < run.end; ++row) {
        if (!(t_s[row] - t_s[row] == 0.0)) return "t_s is not finite in row " + std::to_string(row);
        if (row > run.begin && !(t_s[row] > t_s[row - 1]))
          return "t_s does not increase from row " + std::to_string(row - 1) + " to row " +
                 std::to_string(row);
      }
    }
    return std::nullopt;
  }
};

}  // namespace thermopower::gap
