// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace thermopower::gap {

/// The faults that the check of a recording can find. `to_string` gives the id that reports spell.
enum class FindingKind {
  // Stamps.
  irregular_stamps,  ///< intervals vary more than by rounding
  jittering_stamps,  ///< stamps stray around a clock by which the outputs were read; its ticks are used
  gap_in_stamps,     ///< rows are missing: what the inputs did meanwhile is unknown
  // One column.
  empty_column,      ///< a column without a sample; it counts as absent
  constant_column,   ///< an output that never changes
  missing_samples,   ///< empty cells of an output or covariate
  unknown_input,     ///< empty cells of an input between values that differ
  spiked_samples,    ///< isolated samples far from their neighbours
  glitched_samples,  ///< a stretch that jumps away and back (0 A, 85.0 degC, a 16-bit word that wrapped)
  repeated_frames,   ///< rows that repeat the outputs of the row before them
  held_samples,  ///< an output that repeats the last word of a sensor slower than the rows; only new words count
  interpolated_samples,  ///< an output with straight lines between the readings of a slower sensor; only those count
  separate_samples,    ///< an angle and a rate that never stand in one row; windows start between samples
  frozen_samples,      ///< an output that stands still where it cannot
  clipped_samples,     ///< an output cut off at the end of its sensor's range
  impossible_samples,  ///< outside what the quantity can be
  position_reset,      ///< an axis that was put elsewhere between two rows; a new run begins there
  wrapped_angle,       ///< an angle given inside one turn; it is unwrapped
  coarse_quantum,      ///< steps that limit what any model can score
  // Columns against each other and the simulation.
  wrong_unit,       ///< the simulation follows the data in another unit
  wrong_sign,       ///< the simulation follows the data with the sign turned round
  swapped_columns,  ///< the simulation follows the data with two columns exchanged
  clock_shift,      ///< an input stamped by another clock than the outputs
  lagging_output,  ///< a rate that comes behind its angle, or the angle behind the rate: read earlier, or not judged
  sampled_command,  ///< a command that changed between the rows; its mean until the next row is used
  noisy_command,  ///< a command or current with noise that no motion or heat follows; the noise floor counts it
  // The experiment.
  sampled_too_slowly,     ///< hardly a row in each window of the horizon
  never_driven,           ///< an input that is 0 throughout
  held_out_not_excited,   ///< held-out data in which nothing is driven and nothing moves
  held_out_in_training,   ///< held-out data that are training data, too
  recording_given_twice,  ///< two training recordings are the same
  // The file.
  text_column_ignored,  ///< a column of text that is not a run label
  no_final_line_break,  ///< a file that may have been cut off
  // The model beside the recording.
  common_factor,    ///< several constants are off by one factor: a unit, a gear or a supply
  detached_sensor,  ///< a thermometer that does not follow the power at all
};

/// The kind as reports spell it.
inline const char* to_string(FindingKind kind) {
  static constexpr const char* names[] = {
      "irregular_stamps",     "jittering_stamps",     "gap_in_stamps",         "empty_column",
      "constant_column",      "missing_samples",      "unknown_input",         "spiked_samples",
      "glitched_samples",     "repeated_frames",      "held_samples",          "interpolated_samples",
      "separate_samples",     "frozen_samples",       "clipped_samples",       "impossible_samples",
      "position_reset",       "wrapped_angle",        "coarse_quantum",        "wrong_unit",
      "wrong_sign",           "swapped_columns",      "clock_shift",           "lagging_output",
      "sampled_command",      "noisy_command",        "sampled_too_slowly",    "never_driven",
      "held_out_not_excited", "held_out_in_training", "recording_given_twice", "text_column_ignored",
      "no_final_line_break",  "common_factor",        "detached_sensor"};
  static_assert(std::size(names) == static_cast<std::size_t>(FindingKind::detached_sensor) + 1,
                "each kind has a name");
  return names[static_cast<std::size_t>(kind)];
}

/// How much a finding matters.
enum class Severity {
  note,     ///< good to know
  warning,  ///< may distort the answer
  error,    ///< the data cannot be believed as they stand: the verdict is `insufficient`
};

/// The severity as reports spell it.
inline const char* to_string(Severity severity) {
  constexpr const char* names[] = {"note", "warning", "error"};
  return names[static_cast<std::size_t>(severity)];
}

/// The check's answer to a finding.
enum class FindingAction {
  none,       ///< nothing
  masked,     ///< the samples count as missing
  segmented,  ///< the run is cut there: the state starts anew after it
};

/// The action as reports spell it.
inline const char* to_string(FindingAction action) {
  constexpr const char* names[] = {"none", "masked", "segmented"};
  return names[static_cast<std::size_t>(action)];
}

/// Half-open range of rows [begin, end), counted from 0 over the data rows of the recording as it was given.
struct RowRange {
  Eigen::Index begin = 0;  ///< first row
  Eigen::Index end = 0;    ///< one past the last row
};

/// Something about the data themselves, found before any effect is looked for.
///
/// @snippet plant_examples.cpp finding
/// How to: @ref diagnose_a_gap.
struct Finding {
  FindingKind kind = FindingKind::missing_samples;  ///< what it is
  Severity severity = Severity::note;               ///< an error decides the verdict
  std::string recording;                            ///< name of the recording it was found in
  std::string column;                               ///< may be empty
  std::string message;                              ///< one sentence: the fault, where, by how much
  std::string mend = {};  ///< what would mend it, such as `--column motor_C=motor_C:degF`; may be empty
  FindingAction action = FindingAction::none;  ///< what was done about it
  std::vector<RowRange> rows = {};             ///< which rows, in order; empty: the column as a whole

  /// Number of rows in `rows`.
  Eigen::Index row_count() const {
    Eigen::Index count = 0;
    for (const RowRange& range : rows) {
      assert(range.begin <= range.end);
      count += range.end - range.begin;
    }
    return count;
  }
};

/// The first finding that makes the data unbelievable, or nullptr.
inline const Finding* deciding(const std::vector<Finding>& findings) {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [](const Finding& one) { return one.severity == Severity::error; });
  return found == findings.end() ? nullptr : &*found;
}

}  // namespace thermopower::gap
