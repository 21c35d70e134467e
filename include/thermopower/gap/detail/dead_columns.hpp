// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/experiment.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

/// @file dead_columns.hpp
/// Outputs that stand still over a whole recording in which what drives them moves. Any gain or offset explains
/// such a column, and nothing in it tells which: it is left out.

namespace thermopower::gap::engine {

/// Thresholds of what stands still.
/// Held by tests/gap/data/dead_columns_test.cpp.
struct DeadColumnThresholds {
  Eigen::Index least_samples = 12;  ///< fewer may be the same by chance
  double much = 0.2;                ///< of the largest command of all recordings: less need not move anything
  double as_hard = 0.9;             ///< of the weakest drive that moves it elsewhere: less may not move it
  double tail = 0.02;               ///< of a command's samples at either end are not counted: spikes
};

/// The column that drives an output, and how far it goes.
struct DrivingColumn {
  std::string name;      ///< of the column
  double range = 0.0;    ///< that it goes through
  double largest = 0.0;  ///< magnitude
};

/// The column that drives an output of a recording; a range of 0 where none does.
inline DrivingColumn driving(const Model& model, const Inputs& inputs, Signal signal) {
  const bool current = signal == Signal::current_A;
  assert(current || inputs.closed_loop || model.axis);
  const Eigen::VectorXd& values = current ? inputs.power_param
                                  : inputs.closed_loop
                                      ? (inputs.target_deg.size() > 0 ? inputs.target_deg : inputs.target_dps)
                                      : plant::command(inputs, model.axis->voltage_driven());
  DrivingColumn one{current ? "power_param" : command_column(inputs)};
  std::vector<double> list = finite_samples(values);
  if (list.empty()) return one;
  constexpr DeadColumnThresholds limit;
  one.largest = values.cwiseAbs().maxCoeff();
  one.range = quantile_of(list, 1.0 - limit.tail) - quantile_of(list, limit.tail);
  return one;
}

/// Whether a column has samples enough, and all of them are the same.
inline bool stands_still(const Eigen::VectorXd& values) {
  const std::vector<double> list = finite_samples(values);
  return static_cast<Eigen::Index>(list.size()) >= DeadColumnThresholds().least_samples &&
         std::all_of(list.begin(), list.end(), [&](double one) { return one == list.front(); });
}

/// Leaves outputs out that stand still in a recording though what drives them moves: a sensor that nobody reads, or
/// an axis that static friction holds throughout. Where nothing is left to judge in the training recordings, or in
/// those held out, that is an error. Said of a column so, what else was found in it says nothing.
/// @param as_recorded  it is said, and nothing is left out
inline void leave_out_what_is_dead(const Model& model, CheckedRecordings& checked, bool as_recorded,
                                   std::vector<Finding>& findings) {
  if (model.own) return;
  constexpr Signal signals[] = {Signal::current_A, Signal::angle_deg, Signal::rate_dps};
  constexpr double never = std::numeric_limits<double>::infinity();
  struct Drives {
    double largest = 0.0;             // of all recordings
    double least_that_moves = never;  // of the recordings in which the output lives
    bool is_dead = false;             // in every recording, and in some of them it cannot be
  };
  std::array<Drives, signal_count> drives_of;
  const auto drives = [&](Signal signal) -> Drives& { return drives_of[static_cast<std::size_t>(signal)]; };
  const auto for_each_judged = [&](auto&& use) {
    for (const PreparedRecording* const one : checked.all())
      for (const Signal signal : signals)
        if (one->inputs().judged(signal)) use(one->inputs(), signal, driving(model, one->inputs(), signal));
  };
  for_each_judged([&](const Inputs& inputs, Signal signal, const DrivingColumn& by) {
    Drives& all = drives(signal);
    all.largest = std::max(all.largest, by.largest);
    if (!stands_still(inputs.of(signal))) all.least_that_moves = std::min(all.least_that_moves, by.largest);
  });
  // A drive that moves it elsewhere moves it here. An axis that is driven less may be held by friction, and its
  // standstill tells how large that is.
  const auto must_move = [&](const Inputs& inputs, Signal signal, const DrivingColumn& by) {
    constexpr DeadColumnThresholds limit;
    const auto rests = [&](Signal one) { return !inputs.judged(one) || stands_still(inputs.of(one)); };
    const double least_that_moves = drives(signal).least_that_moves;
    const bool may_be_held = signal != Signal::current_A && rests(Signal::angle_deg) &&
                             rests(Signal::rate_dps) && least_that_moves < never &&
                             by.largest < limit.as_hard * least_that_moves;
    return by.range > limit.much * drives(signal).largest && !may_be_held;
  };
  for_each_judged([&](const Inputs& inputs, Signal signal, const DrivingColumn& by) {
    Drives& all = drives(signal);
    all.is_dead = all.is_dead || (all.least_that_moves == never && must_move(inputs, signal, by));
  });
  std::vector<Finding> dead;
  for (auto* all : {&checked.train, &checked.held_out}) {
    const std::size_t first = dead.size();
    bool is_left = false;
    for (PreparedRecording& one : *all) {
      std::vector<Finding> here;
      std::size_t judged = 0;
      for (int i = 0; i < actuator_signal_count; ++i)
        judged += one.inputs().judged(static_cast<Signal>(i)) ? 1 : 0;
      for (const Signal signal : signals) {
        if (!one.inputs().judged(signal) || !stands_still(one.inputs().of(signal))) continue;
        const DrivingColumn by = driving(model, one.inputs(), signal);
        if (!drives(signal).is_dead && !must_move(one.inputs(), signal, by)) continue;
        if (!holds(Rule::dead_columns)) return;
        const bool current = signal == Signal::current_A;
        here.push_back({FindingKind::constant_column, Severity::warning, one.recording().name,
                        to_string(signal),
                        "never changes, where " + by.name + " goes through " + short_number(by.range) +
                            (current ? ": a sensor that nobody reads"
                                     : ": the axis never moves, or nobody reads its sensor"),
                        current ? "look at what reads the sensor, or leave the column out"
                                : "drive it hard enough to move, look at what reads the sensor, or leave the "
                                  "column out",
                        as_recorded ? FindingAction::none : FindingAction::masked});
      }
      for (const Finding& finding : here) {
        if (!as_recorded)
          one.leave_out(model, finding.column,
                        plant::the_variable(finding.column) + " is not judged: it " + finding.message);
        findings.erase(std::remove_if(findings.begin(), findings.end(),
                                      [&](const Finding& other) {
                                        return other.recording == finding.recording &&
                                               other.column == finding.column;
                                      }),
                       findings.end());
      }
      is_left = is_left || (as_recorded ? judged > here.size() : one.inputs().bench() || one.inputs().axis());
      dead.insert(dead.end(), here.begin(), here.end());
    }
    for (std::size_t i = first; i < dead.size() && !is_left; ++i) dead[i].severity = Severity::error;
  }
  findings.insert(findings.end(), dead.begin(), dead.end());
}

}  // namespace thermopower::gap::engine
