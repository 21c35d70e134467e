// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/mask_thresholds.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/model.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// @file segments.hpp
/// Where time passes unrecorded, or an input is not known: there a run is cut, because a simulation that holds the
/// last value through it is wrong without the model being so.

namespace thermopower::gap::engine {

/// Thresholds of the cutting of runs.
/// Held by tests/gap/data/check_test.cpp.
struct SegmentThresholds {
  double regular_gap =
      1.6;  ///< intervals: of stamps on a grid, a row is missing (a rounded stamp moves by less)
  double irregular_gap = 2.5;  ///< of the longest usual interval (95th percentile): of stamps that jitter
  double beyond_jitter =
      5.0;              ///< robust scales of the intervals by which a rare one is longer that misses a row
  double rare = 0.95;   ///< share of the intervals that have to be shorter for that
  double jitter = 1.1;  ///< 95th percentile over the median above which stamps count as jittering
  double same_command = 0.02;     ///< of the command's range: what lies between two such values is known
  Eigen::Index bridged_rows = 5;  ///< a hole in a slow input (air, supply) of at most so many rows is bridged
  Eigen::Index held_rows = 20;    ///< a command is believed to have stood still for at most so many rows
  double slow_noise = 4.0;        ///< noise units within which a slow input counts as unchanged over a hole
  double reset_speeds =
      10.0;  ///< times the rates of the rows around at which an angle that jumps would have moved
  double reset_noise = 30.0;      ///< noise scales of the angle, and quanta, that it jumps by at least
  Eigen::Index reset_rows = 5;    ///< on both sides that know nothing of such a rate
  Eigen::Index glitch_rows = 50;  ///< what comes back within so many is a sensor's fault
  double comes_back = 0.2;        ///< of a jump by which the next one may miss where the first began
  double nearly_all = 0.98;       ///< of the rates: what is beyond may be a spike's
  double went_on = 0.3;      ///< of a jump by which the rate may miss it where the angle stood still before
  double slow_body = 0.002;  ///< of a body's time constant: a pause as short hides a thousandth of its rise
  Eigen::Index least_rows = 4;  ///< shorter segments tell nothing and are left out
};

/// How an input behaves between its rows.
enum class InputPace {
  command,  ///< may step at any row: power, drive, targets
  slow,     ///< air, supply: straight between its samples
};

/// An input column and its pace.
struct InputColumn {
  const char* name;  ///< of the column
  InputPace pace;    ///< what a hole in it means
};

/// The columns that are inputs wherever they are recorded.
inline constexpr InputColumn input_columns[] = {
    {"power_param", InputPace::command}, {"drive_A", InputPace::command},
    {"voltage_V", InputPace::command},   {"target_deg", InputPace::command},
    {"target_dps", InputPace::command},  {"target_C", InputPace::command},
    {"torque_Nm", InputPace::command},   {"heat_W", InputPace::command},
    {"supply_V", InputPace::slow},       {"ambient_C", InputPace::slow},
    {"airspeed_mps", InputPace::slow},   {"neighbour_C", InputPace::slow}};

/// Whether a baseline ignores an input: then its holes cut no run.
inline bool is_ignored(const Model& model, const std::string& column) {
  if (column == "target_C") return !model.own && !model.has_heater();
  return column == "neighbour_C" && !model.own &&
         model.effects.find("neighbour_heating") == model.effects.end();
}

/// How long an unknown input does not matter: a small part of the time constant of a body; 0 s of all that answers
/// at once.
inline double unnoticed_s(const Model& model) {
  if (model.own || model.has_axis()) return 0.0;
  double time_constant_s = 0.0;
  if (const auto* lumped = std::get_if<LumpedThermalModel>(&model.thermal))
    time_constant_s = lumped->heat_capacity_J_per_K / lumped->conductance_W_per_K;
  else if (const auto* polynomial = std::get_if<ThesisThermalModel>(&model.thermal))
    time_constant_s = 60.0 / polynomial->cooling_per_min;
  return SegmentThresholds().slow_body * time_constant_s;
}

/// Runs cut at some rows: `starts[row]` set means that a new segment begins there. The cut pieces keep their
/// run's label.
/// @param goes_on  whether what a cut separates went on meanwhile; else each piece begins at rest
inline std::vector<RunSpan> cut_at(const std::vector<RunSpan>& runs, const RowMask& starts, bool goes_on) {
  assert(runs.empty() || runs.back().end <= static_cast<Eigen::Index>(starts.size()));
  std::vector<RunSpan> result;
  for (const RunSpan& run : runs) {
    RunSpan piece = run;
    for (Eigen::Index row = run.begin + 1; row < run.end; ++row) {
      if (starts[static_cast<std::size_t>(row)] == 0) continue;
      piece.end = row;
      result.push_back(piece);
      piece.begin = row;
      piece.goes_on = goes_on;
    }
    piece.end = run.end;
    result.push_back(piece);
  }
  return result;
}

/// The runs cut wherever the power steps.
inline std::vector<RunSpan> steady_runs(const Eigen::VectorXd& power, const std::vector<RunSpan>& runs) {
  RowMask starts(static_cast<std::size_t>(power.size()), 0);
  for (Eigen::Index i = 1; i < power.size(); ++i)
    starts[static_cast<std::size_t>(i)] = std::isfinite(power[i]) && power[i] != power[i - 1] ? 1 : 0;
  return cut_at(runs, starts, true);
}

/// Runs without the rows that are set in `unknown`: what is left of each, as segments.
inline std::vector<RunSpan> without(const std::vector<RunSpan>& runs, const RowMask& unknown) {
  assert(runs.empty() || runs.back().end <= static_cast<Eigen::Index>(unknown.size()));
  std::vector<RunSpan> result;
  for (const RunSpan& run : runs)
    for_each_stretch(
        run.begin, run.end, [&](Eigen::Index row) { return unknown[static_cast<std::size_t>(row)] == 0; },
        [&](Eigen::Index begin, Eigen::Index end) {
          RunSpan piece = run;
          piece.begin = begin;
          piece.end = end;
          piece.goes_on = run.goes_on || begin > run.begin;
          result.push_back(piece);
        });
  return result;
}

/// By how much two values of a command may differ that count as the same: then it is taken to have stood still
/// between them.
/// @param values  of the column, NaN where missing
inline double same_command_within(const Eigen::VectorXd& values) {
  std::vector<double> list = finite_samples(values);
  return SegmentThresholds().same_command * (quantile_of(list, 0.98) - quantile_of(list, 0.02));
}

/// The intervals between the stamps of runs, in s.
inline std::vector<double> intervals_of(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs) {
  std::vector<double> steps;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  return steps;
}

/// The interval from which more than a row or two are missing, of such intervals. Reorders them.
inline double long_pause(std::vector<double>& steps) {
  return SegmentThresholds().irregular_gap * quantile_of(steps, 0.95);
}

/// The interval from which time passed unrecorded, of such intervals. Where one in twenty is longer than a missing
/// row would tell, the log has no interval of its own, and only far longer ones count.
inline double shortest_pause(std::vector<double> steps) {
  constexpr SegmentThresholds limit;
  constexpr double normal_median = 0.6745;
  const double usual = median_of(steps), is_long = long_pause(steps);
  std::vector<double> off;
  for (const double step : steps) off.push_back(std::abs(step - usual));
  const double of_a_row =
      std::max(limit.regular_gap * usual, usual + limit.beyond_jitter / normal_median * median_of(off));
  return quantile_of(steps, limit.rare) < of_a_row ? std::min(of_a_row, is_long) : is_long;
}

/// Runs cut at long pauses: over such a one a clock may have started anew.
inline std::vector<RunSpan> cut_at_long_pauses(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs) {
  std::vector<double> steps = intervals_of(t_s, runs);
  const double is_long = long_pause(steps);
  RowMask starts(static_cast<std::size_t>(t_s.size()), 0);
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i)
      starts[static_cast<std::size_t>(i)] = t_s[i] - t_s[i - 1] > is_long ? 1 : 0;
  return cut_at(runs, starts, true);
}

/// Looks at the stamps, and says where they vary or pause.
/// @return the rows that follow on a pause over which a command did not stand still, and which the model notices
inline RowMask check_stamps(const Model& model, FindingList& list, const std::vector<RunSpan>& runs) {
  constexpr SegmentThresholds limit;
  const Recording& r = list.recording();
  std::vector<double> steps = intervals_of(r.t_s, runs);
  RowMask cut(static_cast<std::size_t>(r.rows()), 0);
  if (steps.size() < 3) return cut;
  const double usual = median_of(steps), longest = quantile_of(steps, 0.95),
               shortest = quantile_of(steps, 0.05);
  const bool jitters = longest > limit.jitter * usual || shortest < usual / limit.jitter;
  if (jitters)
    list.add(FindingKind::irregular_stamps, Severity::note, "t_s",
             "the interval varies from " + short_number(shortest) + " to " + short_number(longest) +
                 " s around " + short_number(usual) + " s");
  const double pause = std::max(shortest_pause(steps), unnoticed_s(model));
  std::vector<std::pair<const Eigen::VectorXd*, double>> commands;  // and within how much they are the same
  for (const InputColumn& input : input_columns)
    if (input.pace == InputPace::command && r.has(input.name) && !is_ignored(model, input.name))
      commands.emplace_back(r.find(input.name), same_command_within(*r.find(input.name)));
  double worst = 0.0;
  for (const RunSpan& run : runs)
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      const double step = r.t_s[i] - r.t_s[i - 1];
      if (!(step > pause)) continue;
      bool stood_still = step <= static_cast<double>(limit.held_rows) * usual && !commands.empty();
      for (const auto& [values, within] : commands)
        stood_still = stood_still && std::abs((*values)[i] - (*values)[i - 1]) <= within;
      if (stood_still) continue;
      cut[static_cast<std::size_t>(i)] = 1;
      worst = std::max(worst, step);
    }
  list.add_rows(FindingKind::gap_in_stamps, Severity::note, "t_s", cut, FindingAction::segmented,
                std::string("follow a pause (up to ") + short_number(worst) +
                    " s where the usual interval is " + short_number(usual) +
                    " s) in which the inputs are unknown",
                "log without losing rows");
  return cut;
}

/// How fast an axis gets, but for a spike's rates, deg/s. 0 where the rate often reads the same twice: then it may
/// well stand.
inline double fastest_that_rarely_stands(const Eigen::VectorXd& rate_dps, const std::vector<RunSpan>& runs) {
  std::vector<double> rates = finite_samples(rate_dps.cwiseAbs());
  const bool stands = !(equal_share_of(step_sizes(rate_dps, runs)) < MaskThresholds().rarely_equal);
  return rates.empty() || stands ? 0.0 : quantile_of(rates, SegmentThresholds().nearly_all);
}

/// Whether an axis went on by a jump while its angle stood still up to a row, the interval after that included, as
/// far as its rate tells. Where that stood still, too, in a motion, or was not read, it may have gone as far as it
/// is fast.
/// @param fastest_dps  0: a rate that stands still tells as much as any other
inline bool went_on_while_standing(const Eigen::VectorXd& angle, const Eigen::VectorXd& rate_dps,
                                   double fastest_dps, const Eigen::VectorXd& t_s, Eigen::Index row,
                                   Eigen::Index begin) {
  const double jump = angle[row + 1] - angle[row];
  double went = 0.0, read_dps = missing;
  Eigen::Index first = row;
  bool is_one = true;
  const auto stands = [&](Eigen::Index i) {  // a spike in between says nothing
    return angle[i] == angle[row] || (i > begin && angle[i - 1] == angle[row]);
  };
  for (Eigen::Index i = row; i >= begin && stands(i); first = i--) {
    if (!std::isfinite(rate_dps[i])) continue;
    is_one = is_one && !(std::abs(rate_dps[i] - read_dps) > 0.0);
    read_dps = rate_dps[i];
    went += rate_dps[i] * (t_s[i + 1] - t_s[i]);
  }
  if (fastest_dps > 0.0 && is_one && first < row && read_dps != 0.0)
    return std::abs(jump) <= fastest_dps * (t_s[row + 1] - t_s[first]);
  return std::abs(went - jump) <= SegmentThresholds().went_on * std::abs(jump);
}

/// Says where an axis was put elsewhere between two rows: swings of a pendulum that were held, let
/// go and logged on end. The rows before and after move slowly, or stand, at places that no motion between them joins.
/// An angle that stood still while its rate went on as far was a sensor's that had stopped.
/// @param angle     without wraps, degrees
/// @param rate_dps  null: none was recorded
/// @return the rows that begin elsewhere
inline RowMask check_resets(FindingList& list, const Eigen::VectorXd& angle, const Eigen::VectorXd* rate_dps,
                            const std::vector<RunSpan>& runs) {
  constexpr SegmentThresholds limit;
  const Eigen::VectorXd& t_s = list.recording().t_s;
  const double least = limit.reset_noise * (white_scale(angle, runs) + quantum_of(angle));
  std::optional<double> fastest_dps;  // of the whole recording: asked where something jumps
  RowMask cut(static_cast<std::size_t>(angle.size()), 0);
  double largest = 0.0;
  for (const RunSpan& run : runs)
    for (Eigen::Index k = run.begin + limit.reset_rows; k + 1 + limit.reset_rows < run.end; ++k) {
      const double jump = angle[k + 1] - angle[k];
      if (!(std::abs(jump) > least)) continue;
      const double speed = std::abs(jump) / (t_s[k + 1] - t_s[k]);
      bool is_reset = true;
      for (Eigen::Index i = k - limit.reset_rows; i <= k + limit.reset_rows && is_reset; ++i)
        is_reset =
            i == k || limit.reset_speeds * std::abs(angle[i + 1] - angle[i]) < speed * (t_s[i + 1] - t_s[i]);
      // A jump back, soon after or before: this one is an end of a burst.
      const auto is_burst = [&](Eigen::Index from, Eigen::Index to, Eigen::Index step) {
        return std::abs(angle[step + 1] - angle[step]) > (1.0 - limit.comes_back) * std::abs(jump) &&
               std::abs(angle[to] - angle[from]) < limit.comes_back * std::abs(jump);
      };
      for (Eigen::Index i = 1; i <= limit.glitch_rows && is_reset; ++i)
        is_reset = !(k + 1 + i < run.end && is_burst(k, k + 1 + i, k + i)) &&
                   !(k - i >= run.begin && is_burst(k - i, k + 1, k - i));
      if (is_reset && rate_dps != nullptr) {
        if (!fastest_dps) fastest_dps = fastest_that_rarely_stands(*rate_dps, runs);
        is_reset = !went_on_while_standing(angle, *rate_dps, *fastest_dps, t_s, k, run.begin);
      }
      if (!is_reset) continue;
      cut[static_cast<std::size_t>(k + 1)] = 1;
      largest = std::max(largest, std::abs(jump));
    }
  list.add_rows(FindingKind::position_reset, Severity::note, "angle_deg", cut, FindingAction::segmented,
                "begin elsewhere (by up to " + short_number(largest) +
                    " deg) than the row before them, as no motion around them does: the axis was put there",
                "give each swing a label in the column run");
  return cut;
}

/// Fills the holes of an input where its neighbours tell what it was, and sets `unknown` where they do not.
/// @param stands_s  longest time between two samples in which it stood, or went straight, though they differ; infinite:
///                  no hole matters
/// @param untold    samples that were taken away because they stood still or at the end of a range: the ends of a hole
///                  of them are the same whatever was between
/// @return the column with known holes filled
inline Eigen::VectorXd known_input(const InputColumn& input, const Eigen::VectorXd& values,
                                   const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs,
                                   RowMask& unknown, double stands_s = 0.0, const RowMask& untold = {}) {
  constexpr SegmentThresholds limit;
  assert(values.size() == t_s.size() && static_cast<Eigen::Index>(unknown.size()) == values.size());
  Eigen::VectorXd filled = values;
  const double same_within = same_command_within(values);
  const double noise = white_scale(values, runs) + quantum_of(values);
  const auto is_missing = [&](Eigen::Index row) { return !std::isfinite(values[row]); };
  for (const RunSpan& run : runs)
    for_each_stretch(run.begin, run.end, is_missing, [&](Eigen::Index row, Eigen::Index end) {
      const bool inside = row > run.begin && end < run.end;
      const double before = row > run.begin ? values[row - 1] : missing,
                   after = end < run.end ? values[end] : missing;
      bool known = (inside && t_s[end] - t_s[row - 1] <= stands_s) || std::isinf(stands_s);
      if (input.pace == InputPace::command)
        // A command that is off at one end only was switched in between.
        known = known || (inside && end - row <= limit.held_rows && std::abs(after - before) <= same_within &&
                          (before == 0.0) == (after == 0.0));
      else if (row > run.begin || end < run.end)
        known = known || end - row <= limit.bridged_rows ||
                (inside && std::abs(after - before) <= limit.slow_noise * noise);
      if (!untold.empty() && end - row > limit.bridged_rows)
        known = known && std::find(untold.begin() + row, untold.begin() + end, 1) == untold.begin() + end;
      for (Eigen::Index i = row; i < end; ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (!known) unknown[at] = 1;
        else if (input.pace == InputPace::command || !inside)
          filled[i] = std::isfinite(before) ? before : after;
        else filled[i] = before + (after - before) * (t_s[i] - t_s[row - 1]) / (t_s[end] - t_s[row - 1]);
      }
    });
  return filled;
}

}  // namespace thermopower::gap::engine
