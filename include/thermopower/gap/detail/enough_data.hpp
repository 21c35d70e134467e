// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cassert>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// The least data that anything is said of. Whoever asks for less is told what to record, and not what fits a
/// handful of rows. A cause wants more (DecisionThresholds::least_readings): a table of some ten readings by hand
/// can tell that there is a gap. Held by tests/gap/data/enough_data_test.cpp.
struct LeastData {
  /// Rows of a run. A simulation starts on the first one, which then tells nothing of it; in a run of two there is one
  /// difference, and an effect that only acts on starts (a lag, a second mass) explains them all.
  Eigen::Index run_rows = 3;
  Eigen::Index readings = 12;  ///< of some signal, to fit to and to judge on
  double windows = 2.0;        ///< of an axis, in time: one alone has no other to agree with
};

/// How much of a signal a simulation can be held against in a part of the data.
struct ReadingCount {
  Eigen::Index told = 0;      ///< in runs that are long enough, but for the first one of each
  Eigen::Index recorded = 0;  ///< all of them
  double lasts_s = 0.0;       ///< from the first to the last row of the runs, summed up
};

/// Counts the readings of a signal. Of a run that goes on from before, the first row tells nothing, either.
inline ReadingCount readings_of(const std::vector<Inputs>& part, Signal signal) {
  constexpr LeastData least;
  ReadingCount sum;
  for (const Inputs& one : part) {
    if (!one.judged(signal)) continue;
    for (const RunSpan& run : one.runs) {
      assert(run.begin >= 0 && run.begin <= run.end && run.end <= one.rows());
      if (run.size() == 0) continue;
      const Eigen::Index here = one.of(signal).segment(run.begin, run.size()).array().isFinite().count();
      sum.recorded += here;
      if (run.size() < least.run_rows || here == 0) continue;
      sum.told += here - 1;
      sum.lasts_s += one.t_s[run.end - 1] - one.t_s[run.begin];
    }
  }
  return sum;
}

/// A part of the data in words, such as "the held-out rows of a.csv".
inline std::string part_in_words(const std::vector<Inputs>& part, bool held_out) {
  constexpr std::size_t most = 3;
  std::vector<std::string> names;
  for (const Inputs& one : part) names.push_back(one.name);
  const std::string words = listed(names, most);
  return (held_out ? "the held-out rows" : "the training rows") + (words.empty() ? "" : " of " + words);
}

/// The data that are lacking in a part of the data; empty where there is enough. `mend` receives what to do about it.
/// @param horizon_s  over which simulations of an axis are judged
inline std::string lacking(const Model& model, const std::vector<Inputs>& part, bool held_out,
                           double horizon_s, std::string& mend) {
  constexpr LeastData least;
  // Whoever asks for longer windows than usual wants to see an axis run freely for long, once if need be.
  const double lasts_s = least.windows * std::min(horizon_s, Options().horizon_s);
  ReadingCount most;
  std::string name;
  bool is_long_enough = false;
  for (int i = 0; i < signal_count; ++i) {
    const auto signal = static_cast<Signal>(i);
    const ReadingCount here = readings_of(part, signal);
    if (here.recorded == 0) continue;
    const bool moves = !model.own && (signal == Signal::angle_deg || signal == Signal::rate_dps);
    const bool lasts = !moves || here.lasts_s >= lasts_s;
    if (here.told >= least.readings && lasts) return {};
    if (!name.empty() && here.told <= most.told) continue;
    most = here;
    name = model.own ? model.own->equations->info()->signals[static_cast<std::size_t>(i)].name
                     : to_string(signal);
    is_long_enough = lasts;
  }
  const std::string words = part_in_words(part, held_out);
  if (name.empty()) {
    std::string why;
    for (const std::string& one : not_judged_in({&part})) why += (why.empty() ? ": " : "; ") + one;
    mend =
        "record what is missing, or say which columns it is in: 'thermopower-gap columns FILE' proposes options --column "
        "NAME=HEADER:UNIT";
    return "no signal of the model can be judged in " + words + why;
  }
  if (most.told >= least.readings && !is_long_enough) {
    mend = "record for several seconds, in which the axis turns back more than once";
    return "too little data: " + words + " last " + short_number(most.lasts_s) +
           " s, less than two windows of " + short_number(lasts_s / least.windows) + " s";
  }
  const bool is_short = most.recorded >= least.readings && 2 * most.told < most.recorded;
  mend = is_short
             ? "give what was recorded in one go one label in the column run: runs of at least " +
                   std::to_string(least.run_rows) + " rows, better of hundreds"
             : "record for longer: at least " + std::to_string(least.readings) + " rows to train on and " +
                   std::to_string(least.readings) + " held out, better ten times as many";
  return "too little data: " + words + " hold " + std::to_string(most.told) +
         (most.told == 1 ? " reading" : " readings") + " of " + plant::the_variable(name) +
         " that a simulation can be held against, fewer than " + std::to_string(least.readings) +
         (is_short ? ": a run's first row only starts one, and runs of fewer than " +
                         std::to_string(least.run_rows) + " rows tell little else"
                   : "");
}

/// Whether there is enough to diagnose: data that can be believed, enough readings of some signal in either part
/// (LeastData), and a row that a simulation can start from. Else says in `result` what is lacking, and what would
/// mend it.
/// @param horizon_s  over which simulations are judged
inline bool enough_data(Diagnosis& result, const Model& model, const std::vector<Inputs>& train,
                        const std::vector<Inputs>& held_out, double horizon_s) {
  const auto refuse = [&result](const std::string& reason, const std::string& mend) {
    result.verdict = Verdict::insufficient;
    result.reason = reason;
    result.next_experiment = mend;
    return false;
  };
  if (const Finding* finding = deciding(result.findings))
    return refuse("the data cannot be believed as they stand: " +
                      (finding->column.empty() ? "'" + finding->recording + "'" : finding->column) + " " +
                      finding->message,
                  finding->mend.empty() ? "mend that, or leave the column out" : finding->mend);
  for (const auto* part : {&train, &held_out}) {
    std::string mend;
    const std::string reason = lacking(model, *part, part == &held_out, horizon_s, mend);
    if (!reason.empty()) return refuse(reason, mend);
  }
  for (const auto* part : {&train, &held_out})
    if (cut(*part, horizon_s, plant_of(model)).empty())
      return refuse(
          "no row has a reading of each signal that the model judges, so that no simulation can start in " +
              part_in_words(*part, part == &held_out),
          "log all signals in the same rows, at least now and then, or leave the one out that is never there");
  return true;
}

}  // namespace thermopower::gap::engine
