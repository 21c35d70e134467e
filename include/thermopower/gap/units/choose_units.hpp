// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/units/posterior.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

/// @file choose_units.hpp
/// The test of units: the likeliest line of the table for all recordings of a source together, and for those of them, or runs of
/// them, that differ from the others.

namespace thermopower::gap::engine {

/// Where the runs of a recording are, once nothing else is left of it as it was given.
inline std::vector<RunSpan> given_spans(const Recording& recorded) {
  std::vector<RunSpan> spans = recorded.spans();
  for (RunSpan& one : spans) one.begin += recorded.first_row, one.end += recorded.first_row;
  return spans;
}

/// Whether the numbers of some column, or the intervals between rows, are of another size in one run than in another: one of them may be in another unit.
/// @param runs  rows of the recording
inline bool sizes_differ(const Recording& recording, const std::vector<RowRange>& runs) {
  constexpr double apart = 1.5, share = 0.9;
  constexpr Eigen::Index looked_at = 400;
  const auto differ = [&](const Eigen::VectorXd& of, bool steps) {
    double least = 0.0, most = 0.0;
    for (const RowRange& run : runs) {
      std::vector<double> sizes;
      for (Eigen::Index i = run.begin; i + 1 < run.end; i += 1 + (run.end - run.begin) / looked_at)
        if (const double size = std::abs(steps ? of[i + 1] - of[i] : of[i]); std::isfinite(size))
          sizes.push_back(size);
      const double size = quantile_of(sizes, share);
      if (!(size > 0.0)) continue;
      least = most > 0.0 ? std::min(least, size) : size, most = std::max(most, size);
    }
    return most > apart * least;
  };
  return differ(recording.t_s, true) ||
         std::any_of(recording.columns.begin(), recording.columns.end(),
                     [&](const Column& one) { return differ(one.values, false); });
}

/// Chooses the units of all recordings that were given together.
class UnitChoice {
public:
  /// Both must outlive this object. @param most_power  largest power_param of all recordings
  UnitChoice(const Model& model, const Catalogue& catalogue, double most_power)
      : model_(model), catalogue_(catalogue), most_power_(most_power) {}

  /// Takes a recording: as a whole, or run by run where those are of different sizes.
  /// @param prepared  must outlive this object @param spans  given_spans() of it
  void add(const PreparedRecording& prepared, const std::vector<RunSpan>& spans) {
    constexpr std::size_t most_runs = 40;
    constexpr Eigen::Index least_rows = 20;
    const std::vector<Eigen::Index>& source = prepared.source_rows();
    const auto place = [&](Eigen::Index row) {
      return static_cast<Eigen::Index>(std::lower_bound(source.begin(), source.end(), row) - source.begin());
    };
    std::vector<RowRange> runs;
    for (const RunSpan& run : spans) runs.push_back({place(run.begin), place(run.end)});
    if (runs.size() < 2 || runs.size() > most_runs || !sizes_differ(prepared.recording(), runs)) {
      add_part({&prepared, {}, {}}, prepared);
      return;
    }
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (runs[k].end - runs[k].begin >= least_rows)
        add_part({&prepared, {spans[k].begin, spans[k].end}, spans[k].label},
                 PreparedRecording(model_, prepared.recording().slice(runs[k].begin, runs[k].end)));
  }

  /// To be called once, after all recordings were added: adds what is wrong.
  void find(std::vector<Finding>& findings) {
    if (parts_.empty()) return;
    table_ = unit_hypotheses([&](const std::string& column) {
      return std::any_of(evidence_.begin(), evidence_.end(),
                         [&](const UnitEvidence& part) { return part.has(column); });
    });
    choose();
    for (std::size_t i = 0; i < parts_.size(); ++i) report(i, findings);
    if (is_as_expected()) report_common_factor(findings);
  }

  /// Whether all parts are as expected; after find().
  bool is_as_expected() const {
    return std::all_of(chosen_.begin(), chosen_.end(),
                       [](const UnitHypothesis* one) { return one->is_none(); });
  }

private:
  typedef UnitPosterior::Assignment Assignment;
  struct Part {
    const PreparedRecording* from;
    RowRange rows;  // of a run, as it was given; empty: the whole recording
    std::string label;
  };

  void add_part(Part part, const PreparedRecording& prepared) {
    parts_.push_back(std::move(part));
    evidence_.push_back(measure_units(model_, prepared, catalogue_));
    UnitEvidence& evidence = evidence_.back();
    // Two columns are exchanged where the measure that they make together is as expected only so. Some thousand rows show it.
    constexpr UnitThresholds limit;
    constexpr Eigen::Index asked = 4000;
    const Recording some = prepared.recording().slice(0, std::min(asked, prepared.recording().rows()));
    for (const ColumnPair& pair : exchangeable_columns) {
      const Eigen::VectorXd *first = some.find(pair.first), *second = some.find(pair.second);
      const bool moves = pair.second == "angle_deg" || pair.second == "rate_dps",
                 cools = pair.second == "ambient_C";
      const UnitMeasure told = moves   ? UnitMeasure::slope
                               : cools ? UnitMeasure::heating
                                       : UnitMeasure::current;
      const double factor = cools ? limit.near_heat : limit.near_motion;
      // A column that warms with the heat is neither air nor a supply.
      if (first == nullptr || second == nullptr || evidence.is_near(told, factor) ||
          (pair.first == "motor_C" && evidence[UnitMeasure::heating].is_told()))
        continue;
      Recording other = some;
      other.set(pair.first, *second), other.set(pair.second, *first);
      const UnitEvidence then = measure_units(model_, PreparedRecording(model_, other), catalogue_);
      if (then.is_near(told, factor)) evidence.exchanged.push_back(pair);
    }
  }

  /// The likeliest line for all parts, with single parts that differ.
  void choose() {
    constexpr UnitThresholds limit;
    const UnitPosterior posterior(evidence_, most_power_);
    const UnitHypothesis& none = table_.front();
    const UnitHypothesis* common = &none;
    chosen_.assign(parts_.size(), &none);
    double most = search(posterior, none, chosen_);
    for (const UnitHypothesis& one : table_) {
      if (one.is_none()) continue;
      Assignment units(parts_.size(), &none);
      for (std::size_t i = 0; i < parts_.size(); ++i)
        if (one.applies_to(evidence_[i])) units[i] = &one;
      const double now = search(posterior, one, units);
      if (!posterior.holds_everywhere(one, units)) continue;
      if (now > most + (common->is_none() ? limit.sure : 0.0)) most = now, chosen_ = units, common = &one;
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (chosen_[i] == common || chosen_[i]->is_none()) continue;
      Assignment without = chosen_;
      without[i] = &none;
      if (posterior.of(without, *common) + limit.sure > most) chosen_ = without;
    }
  }

  /// Lets single parts differ from what is common. @return the log posterior
  double search(const UnitPosterior& posterior, const UnitHypothesis& common, Assignment& units) const {
    double most = posterior.of(units, common);
    if (parts_.size() == 1) return most;
    const UnitPosterior::Shared shared = posterior.shared_by(units);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const UnitHypothesis* best = units[i];
      double here = posterior.of_part(i, *best, shared, common);
      for (const UnitHypothesis& one : table_) {
        // Signs and places are those of the wiring: they hold in every recording of a source.
        if (!one.applies_to(evidence_[i]) || ((one.turns_sign() || one.exchanges()) && &one != &common))
          continue;
        if (const double then = posterior.of_part(i, one, shared, common); then > here)
          here = then, best = &one;
      }
      if (best == units[i]) continue;
      Assignment other = units;
      other[i] = best;
      if (const double now = posterior.of(other, common); now > most) most = now, units = other;
    }
    return most;
  }

  /// One finding for all runs of a recording that are in the same unit as this one, the first of them.
  void report(std::size_t first, std::vector<Finding>& findings) const {
    const UnitHypothesis& unit = *chosen_[first];
    const Part& part = parts_[first];
    if (unit.is_none()) {
      report_impossible(first, findings);
      return;
    }
    Finding said{
        unit.kind(), severity(unit.column()), part.from->recording().name, unit.column(), unit.words(),
        unit.mend()};
    std::string runs;
    std::size_t of_recording = 0, alike = 0, possible = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      possible += unit.applies_to(evidence_[i]) ? 1 : 0;
      alike += chosen_[i] == &unit ? 1 : 0;
      if (parts_[i].from != part.from) continue;
      ++of_recording;
      if (chosen_[i] != &unit) continue;
      if (i < first) return;
      constexpr std::size_t named = 8;
      said.rows.push_back(parts_[i].rows);
      if (said.rows.size() > named) continue;
      runs += (runs.empty() ? "" : "; ") + (parts_[i].label.empty() ? "" : "'" + parts_[i].label + "', ") +
              "rows " + std::to_string(parts_[i].rows.begin) + " to " +
              std::to_string(parts_[i].rows.end - 1);
    }
    const std::size_t wrong = said.rows.size();
    if (wrong == of_recording) {
      said.rows.clear();
      said.message += words_of_evidence(first);
      if (alike < possible)
        said.message +=
            "; not all recordings show it: where the others are right, convert this file alone, for the option "
            "goes for all of them";
    } else {
      said.message +=
          (wrong == 1 ? " in run " + runs + "," : " in " + std::to_string(wrong) + " runs: " + runs) +
          " and not in the others" + words_of_evidence(first);
      said.mend = "convert " + std::string(wrong == 1 ? "that run" : "those runs") + " alone, as " +
                  unit.mend() + " would, which goes for all runs of all files; or leave " +
                  (wrong == 1 ? "it" : "them") + " out";
    }
    findings.push_back(std::move(said));
  }

  /// A column that the model does not use stops nothing.
  Severity severity(const std::string& column) const {
    const bool is_temperature = column == "motor_C" || column == "ambient_C";
    return is_temperature && !model_.has_thermal() && !model_.has_current() ? Severity::warning
                                                                            : Severity::error;
  }

  /// The measures that the hypothesis mends, in parentheses.
  std::string words_of_evidence(std::size_t part) const {
    assert(part < parts_.size() && chosen_.size() == parts_.size());
    const UnitHypothesis& unit = *chosen_[part];
    const UnitEvidence& of = evidence_[part];
    std::string text;
    const auto say = [&](UnitMeasure kind, const std::string& before, const std::string& after) {
      if (of[kind].is_told() && std::abs(unit.expected(kind, of)) != 1.0)
        text += (text.empty() ? "" : "; ") + before + short_number(of[kind].value) + after;
    };
    say(UnitMeasure::slope, "rate_dps is ", " times the slope of angle_deg");
    say(UnitMeasure::drive, "the command moves the axis ", " times as much as the model says");
    say(UnitMeasure::current, "the current is ", " times what the circuit draws");
    say(UnitMeasure::supply, "the supply is ", " times the model's nominal_V");
    say(UnitMeasure::heating, "the motor warms ", " times as fast as the model's");
    say(UnitMeasure::cooling, "it cools ", " times as fast");
    const std::string column = unit.column();
    if (column == "power_param")
      text += (text.empty() ? "" : "; ") + std::string("it never exceeds ") + short_number(most_power_);
    if (text.empty() && column == "ambient_C") text = "it is about " + short_number(of.air.typical);
    if (text.empty() && column == "motor_C") text = "it is at least " + short_number(of.motor.low);
    return text.empty() ? "" : " (" + text + ")";
  }

  /// Says where a temperature cannot be, in no unit of the table.
  void report_impossible(std::size_t part, std::vector<Finding>& findings) const {
    for (const std::string column : {"ambient_C", "motor_C"}) {
      const UnitEvidence& of = evidence_[part];
      const TemperatureRange& range = column == "motor_C" ? of.motor : of.air;
      if (!range.is_known() || !range.is_odd()) continue;
      findings.push_back({FindingKind::impossible_samples, severity(column),
                          parts_[part].from->recording().name, column,
                          "is about " + short_number(range.typical) + ": no temperature of " +
                              (column == "motor_C" ? "a motor" : "air") + " in degrees Celsius",
                          "look at its unit, and at what --column makes of it"});
    }
  }

  /// Constants that are off where no unit is wrong. Warns where one factor, or one that no constant has, explains what several
  /// constants would have to.
  void report_common_factor(std::vector<Finding>& findings) const {
    constexpr UnitThresholds limit;
    constexpr double alike = 1.08;  // factor that two constants may differ by
    constexpr double well = 0.15;   // deviation of one that tells a factor
    const UnitPosterior posterior(evidence_, most_power_);
    const auto shift = [&](UnitMeasure kind) { return posterior.shift(kind, chosen_); };
    const auto is_told = [&](UnitMeasure kind) {
      return std::any_of(evidence_.begin(), evidence_.end(),
                         [&](const UnitEvidence& one) { return one[kind].is_told() && one[kind].sd < well; });
    };
    const auto is = [&](UnitMeasure kind, double log_factor) {
      return is_told(kind) && std::abs(shift(kind) - log_factor) < std::log(alike);
    };
    const auto add = [&](FindingKind kind, const std::string& column, const std::string& message,
                         const char* mend) {
      findings.push_back(
          {kind, Severity::warning, parts_.front().from->recording().name, column, message, mend});
    };
    const double drive = shift(UnitMeasure::drive), slope = shift(UnitMeasure::slope);
    const std::string moves = short_number(std::exp(drive)), faster = short_number(std::exp(slope));
    const std::string command = evidence_.front().has("voltage_V") ? "voltage_V" : "drive_A";
    const bool is_off = std::abs(drive) > std::log(limit.common) && is_told(UnitMeasure::drive);
    if (is_off && is(UnitMeasure::drag, drive) &&
        (!is_told(UnitMeasure::slope) || is(UnitMeasure::slope, 0.0)))
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

  const Model& model_;
  const Catalogue& catalogue_;
  double most_power_;
  std::vector<Part> parts_;
  std::vector<UnitEvidence> evidence_;
  std::vector<UnitHypothesis> table_;
  Assignment chosen_;
};

}  // namespace thermopower::gap::engine
