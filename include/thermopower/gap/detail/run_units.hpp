// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/run_sizes.hpp>
#include <thermopower/gap/detail/unit_check.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file run_units.hpp
/// Units that differ between the runs of a recording: runs whose numbers are of another size than those of the others are asked
/// what whole recordings are asked.

namespace thermopower::gap::engine {

/// Thresholds of the check of runs against each other.
/// Held by tests/gap/data/run_units_test.cpp.
struct RunUnitThresholds {
  std::size_t asked = 4;  ///< odd runs, the oddest first; all of them once one is in another unit
  std::size_t named = 8;  ///< runs that a sentence names
  double fahrenheit_heat =
      1.35;                 ///< by which a heat warms a motor more in degrees Fahrenheit than in other runs
  double same_ratio = 1.1;  ///< times that angle by rate may be off a unit's, against other runs
};

/// A run as it was given, and what is believed of it.
struct GivenRun {
  const PreparedRecording* from = nullptr;           ///< recording that it is a part of
  std::pair<Eigen::Index, Eigen::Index> believed{};  ///< its rows there
  RowRange rows;                                     ///< as they were given
  std::string label;                                 ///< may be empty
};

/// Where the runs of a recording are, once nothing else is left of it as it was given.
inline std::vector<RunSpan> given_spans(const Recording& recorded) {
  std::vector<RunSpan> spans = recorded.spans();
  for (RunSpan& one : spans) one.begin += recorded.first_row, one.end += recorded.first_row;
  return spans;
}

/// The runs of a prepared recording. @param spans  given_spans() of the recording
inline std::vector<GivenRun> given_runs(const PreparedRecording& prepared,
                                        const std::vector<RunSpan>& spans) {
  const std::vector<Eigen::Index>& source = prepared.source_rows();
  const auto place = [&](Eigen::Index row) {
    return static_cast<Eigen::Index>(std::lower_bound(source.begin(), source.end(), row) - source.begin());
  };
  std::vector<GivenRun> runs;
  for (const RunSpan& one : spans)
    runs.push_back({&prepared, {place(one.begin), place(one.end)}, {one.begin, one.end}, one.label});
  return runs;
}

/// Asks runs what recordings are asked.
class RunUnits {
public:
  /// Both must outlive this object.
  RunUnits(const Model& model, const Catalogue& catalogue) : model_(model), catalogue_(catalogue) {}

  /// Takes the runs of a recording. @param prepared  must outlive this object
  void add(const PreparedRecording& prepared, const std::vector<RunSpan>& spans) {
    for (GivenRun& one : given_runs(prepared, spans)) {
      sizes_.push_back(RunSizes(model_, prepared.recording(), one.believed).all());
      runs_.push_back({std::move(one), {}, {}});
    }
  }

  /// Adds the runs that are in another unit than the rest, and takes away what was said of their recordings as a whole.
  void find(std::vector<Finding>& findings) {
    const std::vector<OddSizes> odd = odd_sizes(sizes_);
    for (std::size_t i = 0; i < runs_.size(); ++i) runs_[i].odd = odd[i];
    ask_the_odd();
    std::vector<Finding> said;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (is_wrong(runs_[i]) && is_first_of_its_kind(i) && !is_said_of_all(runs_[i], findings))
        said.push_back(finding_of(runs_[i]));
    for (const Finding& one : said) forget_what_is_no_longer_told(one, findings);
    findings.insert(findings.end(), said.begin(), said.end());
  }

private:
  struct Asked {
    GivenRun run;
    OddSizes odd;
    std::optional<Finding> unit;  // what is wrong with it
  };

  static bool is_wrong(const Asked& one) { return one.unit.has_value(); }
  static bool are_alike(const Asked& a, const Asked& b) {
    return a.run.from->recording().name == b.run.from->recording().name && a.unit->mend == b.unit->mend;
  }

  /// Asks the oddest, and one of the others: what that one shows, too, is not a matter of runs.
  void ask_the_odd() {
    std::vector<Asked*> odd, others;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (!sizes_[i].empty()) (runs_[i].odd.columns.empty() ? others : odd).push_back(&runs_[i]);
    if (odd.empty()) return;
    const auto is_odder = [](const Asked* a, const Asked* b) { return a->odd.apart > b->odd.apart; };
    std::stable_sort(odd.begin(), odd.end(), is_odder);
    if (others.empty()) others.push_back(odd.back()), odd.pop_back();
    if (odd.empty()) return;
    const PreparedRecording usual = on_its_own(*others.front()), oddest = on_its_own(*odd.front());
    ask(*odd.front(), oddest, odd.front()->odd, usual);
    for (std::size_t i = 1; i < odd.size() && (i < RunUnitThresholds().asked || any_wrong(odd)); ++i)
      ask(*odd[i], on_its_own(*odd[i]), odd[i]->odd, usual);
    OddSizes all;
    for (const Asked* one : odd)
      all.columns.insert(all.columns.end(), one->odd.columns.begin(), one->odd.columns.end());
    ask(*others.front(), usual, all, oddest);
    if (!is_wrong(*others.front())) return;
    for (const Asked* one : odd)
      if (is_wrong(*one) && one->unit->mend == others.front()->unit->mend) return forget_all();
    // Most runs are those that are in another unit.
    for (std::size_t i = 1; i < others.size(); ++i) ask(*others[i], on_its_own(*others[i]), all, oddest);
  }

  static bool any_wrong(const std::vector<Asked*>& list) {
    return std::any_of(list.begin(), list.end(), [](const Asked* one) { return is_wrong(*one); });
  }
  void forget_all() {
    for (Asked& one : runs_) one.unit.reset();
  }

  PreparedRecording on_its_own(const Asked& one) const {
    return PreparedRecording(
        model_, one.run.from->recording().slice(one.run.believed.first, one.run.believed.second));
  }

  /// Asks a run; only what makes a column odd counts.
  /// @param prepared  the run on its own
  /// @param usual     a run that is not odd as it is
  void ask(Asked& one, const PreparedRecording& prepared, const OddSizes& odd,
           const PreparedRecording& usual) {
    const Recording& part = prepared.recording();
    for (const Finding& found : check_units(model_, part, prepared, catalogue_, most_power(part)))
      if (found.kind == FindingKind::wrong_unit && found.severity == Severity::error &&
          names_one_of(found.mend, odd) &&
          (found.mend.find("motor_C:degF") == std::string::npos || warms_more(prepared, usual)))
        one.unit = found;
    if (!one.unit && odd.has("angle_deg")) one.unit = unit_of_angle(prepared, usual);
  }

  /// Whether options of the program are about a column whose size is odd.
  static bool names_one_of(const std::string& mend, const OddSizes& odd) {
    return std::any_of(odd.columns.begin(), odd.columns.end(), [&](const std::string& column) {
      return mend.find("--column " + column + "=") != std::string::npos;
    });
  }

  /// The largest power of a run. One of whole numbers up to 1 is hardly driven, and no duty.
  static double most_power(const Recording& part) {
    constexpr double full = 255.0;
    if (!part.has("power_param")) return 0.0;
    std::vector<double> values = finite_samples(part.column("power_param"));
    const bool whole = std::all_of(values.begin(), values.end(), [](double x) { return x == std::round(x); });
    const double most = quantile_of(values, 1.0);
    return most <= 1.0 && whole ? full : most;
  }

  /// Whether heat warms a motor so much more than in a usual run as it does in degrees Fahrenheit: a warm room does not.
  bool warms_more(const PreparedRecording& prepared, const PreparedRecording& usual) const {
    return heat_of(prepared) > RunUnitThresholds().fahrenheit_heat * heat_of(usual);
  }
  double heat_of(const PreparedRecording& prepared) const {
    if (!prepared.inputs().bench()) return missing;
    const ToldCoefficient heat = BenchScaleCheck(model_, prepared, catalogue_, 0.0).warming().heat;
    return heat.significance() > HeatScaleThresholds().significance ? heat.value : missing;
  }

  /// An angle that moves by another factor than its rate is a cause, but none that comes and goes with the runs.
  std::optional<Finding> unit_of_angle(const PreparedRecording& prepared,
                                       const PreparedRecording& usual) const {
    struct Unit {
      const char* option;
      const char* words;
      double factor;
    };
    constexpr Unit units[] = {{"rad", "radians", deg_per_rad}, {"rev", "turns", 360.0}};
    const ColumnRatio here = ratio_of(prepared), there = ratio_of(usual);
    if (!here.is_told() || !there.is_told()) return std::nullopt;
    // Where it is the other run whose columns are apart, its rate may be what is wrong.
    if (times_off(here.value, 1.0) < times_off(there.value, 1.0)) return std::nullopt;
    for (const Unit& one : units)
      if (times_off(here.value / there.value, one.factor) < RunUnitThresholds().same_ratio)
        return Finding{FindingKind::wrong_unit,
                       Severity::error,
                       prepared.recording().name,
                       "angle_deg",
                       std::string("is in ") + one.words + " where degrees are expected (rate_dps is " +
                           short_number(here.value) + " times its slope)",
                       column_option("angle_deg", one.option),
                       FindingAction::none,
                       {}};
    return std::nullopt;
  }
  ColumnRatio ratio_of(const PreparedRecording& prepared) const {
    if (!prepared.inputs().axis()) return {};
    return MotionScale(prepared.inputs(), model_.axis->voltage_driven()).rate_by_slope_of_angle();
  }

  bool is_first_of_its_kind(std::size_t i) const {
    for (std::size_t k = 0; k < i; ++k)
      if (is_wrong(runs_[k]) && are_alike(runs_[k], runs_[i])) return false;
    return true;
  }

  /// Whether all runs of a recording show the same, and it was said of the recording as a whole.
  bool is_said_of_all(const Asked& wrong, const std::vector<Finding>& findings) const {
    const std::string& name = wrong.run.from->recording().name;
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (runs_[i].run.from->recording().name == name && !sizes_[i].empty() &&
          !(is_wrong(runs_[i]) && are_alike(runs_[i], wrong)))
        return false;
    return std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.recording == name && one.kind == FindingKind::wrong_unit && one.severity == Severity::error;
    });
  }

  static std::string run_words(const GivenRun& run) {
    return (run.label.empty() ? "" : "'" + run.label + "', ") + "rows " + std::to_string(run.rows.begin) +
           " to " + std::to_string(run.rows.end - 1);
  }

  Finding finding_of(const Asked& first) const {
    Finding said = *first.unit;
    std::vector<std::string> names;
    for (const Asked& one : runs_) {
      if (!is_wrong(one) || !are_alike(one, first)) continue;
      said.rows.push_back(one.run.rows);
      names.push_back(run_words(one.run));
    }
    constexpr std::size_t most = RunUnitThresholds().named;
    std::string list = names.size() == 1 ? " in run " : " in " + std::to_string(names.size()) + " runs: ";
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i) list += (i > 0 ? "; " : "") + names[i];
    if (names.size() > most) list += "; and others";
    const std::size_t evidence = said.message.find(" (");
    said.message.insert(evidence == std::string::npos ? said.message.size() : evidence,
                        list + (names.size() == 1 ? "," : "") + " and not in the others");
    said.mend = std::string("convert ") + (names.size() == 1 ? "that run" : "those runs") + " alone, as " +
                said.mend + " would, which goes for all runs of all files; or leave " +
                (names.size() == 1 ? "it" : "them") + " out";
    return said;
  }

  /// What a mixture of units makes of a recording as a whole says nothing.
  static void forget_what_is_no_longer_told(const Finding& said, std::vector<Finding>& findings) {
    const auto is_of_mixture = [&](const Finding& one) {
      return one.recording == said.recording && one.severity == Severity::error &&
             (one.kind == FindingKind::wrong_unit || one.kind == FindingKind::wrong_sign ||
              one.kind == FindingKind::swapped_columns || one.kind == FindingKind::impossible_samples);
    };
    findings.erase(std::remove_if(findings.begin(), findings.end(), is_of_mixture), findings.end());
  }

  const Model& model_;
  const Catalogue& catalogue_;
  std::vector<Asked> runs_;
  std::vector<std::vector<RunSize>> sizes_;
};

}  // namespace thermopower::gap::engine
