// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/run_sizes.hpp>
#include <thermopower/gap/units/common_factor.hpp>
#include <thermopower/gap/units/measure_units.hpp>
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

/// A recording, or a run of one, whose units are asked for.
struct UnitPart {
  const PreparedRecording* from = nullptr;  ///< recording
  RowRange rows{};                          ///< of a run, as it was given; empty: the whole recording
  std::string label{};                      ///< of the run; may be empty
};

/// Chooses the units of all recordings that were given together.
class UnitChoice {
public:
  /// Both must outlive this object. @param most_power  largest power_param of all recordings
  UnitChoice(const Model& model, const Catalogue& catalogue, double most_power)
      : model_(model), catalogue_(catalogue), most_power_(most_power) {}

  /// Takes a recording. @param prepared  must outlive this object @param spans  given_spans() of it
  void add(const PreparedRecording& prepared, const std::vector<RunSpan>& spans) {
    recordings_.push_back({&prepared, spans});
  }

  /// To be called once, after all recordings were added: adds what is wrong.
  void find(std::vector<Finding>& findings) {
    measure();
    if (parts_.empty()) return;
    choose();
    report(findings);
    if (is_as_expected())
      report_common_factor({evidence_, [&](UnitMeasure kind) { return shift(kind); }},
                           parts_.front().from->recording().name, findings);
  }

  /// What each part says, for other tests; after find().
  const std::vector<UnitEvidence>& evidence() const { return evidence_; }
  /// Whether all parts are as expected; after find().
  bool is_as_expected() const {
    return std::all_of(chosen_.begin(), chosen_.end(),
                       [](const UnitHypothesis* one) { return one->is_none(); });
  }
  /// By how much the logarithm of a measure is off in all recordings; after find().
  double shift(UnitMeasure kind) const { return UnitPosterior(evidence_, most_power_).shift(kind, chosen_); }

private:
  struct Given {
    const PreparedRecording* prepared;
    std::vector<RunSpan> spans;
  };
  typedef UnitPosterior::Assignment Assignment;

  /// Recordings are asked as a whole; those with a run whose numbers are of another size, run by run.
  void measure() {
    constexpr std::size_t most_runs = 40;
    std::vector<std::vector<RunSize>> sizes;
    std::vector<std::vector<std::pair<Eigen::Index, Eigen::Index>>> believed;
    for (const Given& one : recordings_) {
      const std::vector<Eigen::Index>& source = one.prepared->source_rows();
      const auto place = [&](Eigen::Index row) {
        return static_cast<Eigen::Index>(std::lower_bound(source.begin(), source.end(), row) -
                                         source.begin());
      };
      believed.emplace_back();
      for (const RunSpan& run : one.spans) {
        believed.back().push_back({place(run.begin), place(run.end)});
        sizes.push_back(RunSizes(model_, one.prepared->recording(), believed.back().back()).all());
      }
    }
    const std::vector<OddSizes> odd = odd_sizes(sizes);
    assert(odd.size() == sizes.size() && believed.size() == recordings_.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < recordings_.size(); ++i) {
      const Given& one = recordings_[i];
      const std::size_t runs = one.spans.size();
      const bool is_odd = runs > 1 && runs <= most_runs &&
                          std::any_of(odd.begin() + static_cast<std::ptrdiff_t>(at),
                                      odd.begin() + static_cast<std::ptrdiff_t>(at + runs),
                                      [](const OddSizes& size) { return !size.columns.empty(); });
      if (!is_odd) add_part({one.prepared}, *one.prepared);
      for (std::size_t k = 0; is_odd && k < runs; ++k) {
        if (sizes[at + k].empty()) continue;
        const auto [begin, end] = believed[i][k];
        add_part({one.prepared, {one.spans[k].begin, one.spans[k].end}, one.spans[k].label},
                 PreparedRecording(model_, one.prepared->recording().slice(begin, end)));
      }
      at += runs;
    }
    table_ = unit_hypotheses([&](const std::string& column) {
      return std::any_of(evidence_.begin(), evidence_.end(),
                         [&](const UnitEvidence& part) { return part.has(column); });
    });
  }

  void add_part(UnitPart part, const PreparedRecording& prepared) {
    parts_.push_back(std::move(part));
    evidence_.push_back(measure_units(model_, prepared, catalogue_));
  }

  void choose() {
    const UnitPosterior posterior(evidence_, most_power_);
    assert(!table_.empty() && evidence_.size() == parts_.size());
    const UnitHypothesis& none = table_.front();
    chosen_.assign(parts_.size(), &none);
    common_ = &none;
    double most = search(posterior, none, chosen_);
    // Single parts may differ from the likeliest few.
    struct Common {
      const UnitHypothesis* unit;
      Assignment units;
      double nats;
    };
    std::vector<Common> all;
    for (const UnitHypothesis& one : table_) {
      if (one.is_none()) continue;
      Assignment units(parts_.size(), &none);
      for (std::size_t i = 0; i < parts_.size(); ++i)
        if (one.applies_to(evidence_[i])) units[i] = &one;
      const double nats = posterior.of(units, one);
      all.push_back({&one, std::move(units), nats});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Common& a, const Common& b) { return a.nats > b.nats; });
    constexpr std::size_t asked = 4;
    for (std::size_t k = 0; k < std::min(asked, all.size()); ++k) {
      Common& one = all[k];
      const double now = search(posterior, *one.unit, one.units);
      if (!posterior.holds_everywhere(*one.unit, one.units)) continue;
      if (now > most + posterior.beliefs.sure || (now > most && !common_->is_none()))
        most = now, chosen_ = one.units, common_ = one.unit;
    }
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (chosen_[i] == common_ || chosen_[i]->is_none()) continue;
      Assignment without = chosen_;
      without[i] = &none;
      if (posterior.of(without, *common_) + posterior.beliefs.sure > most) chosen_ = without;
    }
  }

  /// Lets single parts differ from what is common. @return the log posterior
  double search(const UnitPosterior& posterior, const UnitHypothesis& common, Assignment& units) const {
    double most = posterior.of(units, common);
    constexpr int passes = 3;
    for (int pass = 0; pass < passes && parts_.size() > 1; ++pass) {
      bool changed = false;
      const UnitPosterior::Shared shared = posterior.shared_by(units);
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        const UnitHypothesis* best = units[i];
        double here = posterior.of_part(i, *best, shared, common);
        for (const UnitHypothesis& one : table_) {
          // A sign is that of the wiring: it holds in every recording of a source.
          if (!one.applies_to(evidence_[i]) || (one.turns_sign() && &one != &common)) continue;
          if (const double then = posterior.of_part(i, one, shared, common); then > here)
            here = then, best = &one;
        }
        if (best == units[i]) continue;
        Assignment other = units;
        other[i] = best;
        if (const double now = posterior.of(other, common); now > most)
          most = now, units = other, changed = true;
      }
      if (!changed) break;
    }
    return most;
  }

  void report(std::vector<Finding>& findings) const {
    const UnitPosterior posterior(evidence_, most_power_);
    std::vector<std::size_t> done;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const UnitHypothesis& here = *chosen_[i];
      if (here.is_none()) {
        report_impossible(i, posterior, findings);
        continue;
      }
      // One finding for all runs of a recording that are in the same unit.
      if (std::any_of(done.begin(), done.end(),
                      [&](std::size_t k) { return parts_[k].from == parts_[i].from && chosen_[k] == &here; }))
        continue;
      done.push_back(i);
      findings.push_back(finding(i));
    }
  }

  Finding finding(std::size_t first) const {
    assert(first < parts_.size() && chosen_.size() == parts_.size());
    const UnitHypothesis& unit = *chosen_[first];
    const Recording& recording = parts_[first].from->recording();
    Finding said{unit.kind(),  severity(first), recording.name,      unit.column(),
                 unit.words(), unit.mend(),     FindingAction::none, {}};
    std::vector<std::string> runs;
    std::size_t of_recording = 0, alike = 0, possible = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      possible += unit.applies_to(evidence_[i]) ? 1 : 0;
      alike += chosen_[i] == &unit ? 1 : 0;
      if (parts_[i].from != parts_[first].from) continue;
      ++of_recording;
      if (chosen_[i] != &unit) continue;
      said.rows.push_back(parts_[i].rows);
      runs.push_back((parts_[i].label.empty() ? "" : "'" + parts_[i].label + "', ") + "rows " +
                     std::to_string(parts_[i].rows.begin) + " to " + std::to_string(parts_[i].rows.end - 1));
    }
    const std::string evidence = words_of_evidence(first);
    if (runs.size() == of_recording) {
      said.rows.clear();
      said.message += evidence;
      if (alike < possible)
        said.message +=
            runs.size() == alike
                ? "; no other recording shows it: where those are right, convert this file alone, for "
                  "the option goes for all of them"
                : "; not all recordings show it: the option goes for all of them";
      return said;
    }
    constexpr std::size_t most = 8;
    std::string list = runs.size() == 1 ? " in run " : " in " + std::to_string(runs.size()) + " runs: ";
    for (std::size_t i = 0; i < std::min(runs.size(), most); ++i) list += (i > 0 ? "; " : "") + runs[i];
    if (runs.size() > most) list += "; and others";
    said.message += list + (runs.size() == 1 ? "," : "") + " and not in the others" + evidence;
    said.mend = std::string("convert ") + (runs.size() == 1 ? "that run" : "those runs") + " alone, as " +
                unit.mend() + " would, which goes for all runs of all files; or leave " +
                (runs.size() == 1 ? "it" : "them") + " out";
    return said;
  }

  /// A column that the model does not use stops nothing.
  Severity severity(std::size_t part) const {
    const std::string column = chosen_[part]->column();
    const bool temperature = column == "motor_C" || column == "ambient_C";
    return temperature && !evidence_[part].uses_temperature ? Severity::warning : Severity::error;
  }

  /// The measures that the hypothesis mends, in parentheses.
  std::string words_of_evidence(std::size_t part) const {
    const UnitEvidence& of = evidence_[part];
    const auto expected = chosen_[part]->expected(of);
    const auto mends = [&](UnitMeasure kind) {
      return of[kind].is_told() &&
             std::abs(std::log(std::abs(expected[static_cast<std::size_t>(kind)]))) > 0.1;
    };
    std::string text;
    const auto say = [&](UnitMeasure kind, const std::string& before, const std::string& after) {
      if (mends(kind)) text += (text.empty() ? "" : "; ") + before + short_number(of[kind].value) + after;
    };
    say(UnitMeasure::slope, "rate_dps is ", " times the slope of angle_deg");
    say(UnitMeasure::drive, "the command moves the axis ", " times as much as the model says");
    say(UnitMeasure::current, "the current is ", " times what the circuit draws");
    say(UnitMeasure::supply, "the supply is ", " times the model's nominal_V");
    say(UnitMeasure::heating, "the motor warms ", " times as fast as the model's");
    say(UnitMeasure::cooling, "it cools ", " times as fast");
    const std::string column = chosen_[part]->column();
    if (column == "power_param")
      text += (text.empty() ? "" : "; ") + std::string("it never exceeds ") + short_number(most_power_);
    if (text.empty() && column == "ambient_C") text = "it is about " + short_number(of.air.typical);
    if (text.empty() && column == "motor_C") text = "it is at least " + short_number(of.motor.low);
    return text.empty() ? "" : " (" + text + ")";
  }

  void report_impossible(std::size_t part, const UnitPosterior& posterior,
                         std::vector<Finding>& findings) const {
    if (posterior.is_possible(part, *chosen_[part])) return;
    const UnitEvidence& of = evidence_[part];
    for (const char* column : {"ambient_C", "motor_C"}) {
      const TemperatureRange& range = column == std::string("motor_C") ? of.motor : of.air;
      constexpr PossibleUnits limit;
      if (!range.is_known() || (range.typical > limit.coldest_C && range.low < limit.another_unit_C))
        continue;
      findings.push_back({FindingKind::impossible_samples,
                          of.uses_temperature ? Severity::error : Severity::warning,
                          parts_[part].from->recording().name,
                          column,
                          "is about " + short_number(range.typical) + ": no temperature of " +
                              (column == std::string("motor_C") ? "a motor" : "air") + " in degrees Celsius",
                          "look at its unit, and at what --column makes of it",
                          FindingAction::none,
                          {}});
    }
  }

  const Model& model_;
  const Catalogue& catalogue_;
  double most_power_;
  std::vector<Given> recordings_;
  std::vector<UnitPart> parts_;
  std::vector<UnitEvidence> evidence_;
  std::vector<UnitHypothesis> table_;
  Assignment chosen_;
  const UnitHypothesis* common_ = nullptr;
};

}  // namespace thermopower::gap::engine
