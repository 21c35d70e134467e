// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Opens what the judge left and what the generator sealed, and says how good the diagnosis is.
//   gap_benchmark_score --dir DIR [--out FILE.md] [--heading FILE] [--brief yes] [--require NAME=RATE ...]
// Exit status 1 when a required rate is not reached.

#include <cstdio>
#include <filesystem>
#include <iostream>

#include "answer.hpp"
#include "tally.hpp"

namespace {

using namespace gap_benchmark;

std::string join(const Explanation& ids) {
  std::string all;
  for (const auto& id : ids) all += (all.empty() ? "" : " + ") + id;
  return all.empty() ? "-" : all;
}

std::string top_level(const std::string& submodel) { return submodel.substr(0, submodel.find('.')); }

/// A current sensor and a winding cannot be told apart when nothing but the current is measured, nor can a
/// thermometer and a heat path; on an axis the angle checks the rate, and no such excuse holds.
bool same_place(const std::string& reported, const std::string& truth, const std::string& kind) {
  if (kind == "axis") return top_level(reported) == top_level(truth);
  const auto place = [](const std::string& submodel) -> std::string {
    if (submodel == "sensing.current") return "electrical";
    if (submodel == "sensing.temperature") return "thermal";
    return top_level(submodel);
  };
  return place(reported) == place(truth);
}

struct Miss {
  std::string job, what, truth, answer, reason;
};

class Score {
public:
  explicit Score(std::string directory) : directory_(std::move(directory)) {
    std::ifstream file(directory_ + "/sealed/labels.json");
    sealed_ = Json::parse(file);
  }

  void run() {
    // A directory that was made of another one may lack some of its recordings.
    for (const auto& entry : sealed_["cases"].items())
      if (std::filesystem::exists(directory_ + "/cases/" + entry.key()))
        judge_case(entry.key(), entry.value());
    if (sealed_.contains("leave_one_out"))
      for (const auto& entry : sealed_["leave_one_out"].items()) judge_left_out(entry.key(), entry.value());
  }

  const Tallies& tallies() const { return tallies_; }
  void print(std::ostream& out) const;
  /// One screen: rates, times, and what was missed.
  void print_brief(std::ostream& out) const;

private:
  std::string directory_;
  Json sealed_;
  Tallies tallies_;
  std::vector<Miss> misses_;
  std::map<std::string, std::map<std::string, int>> confusion_;
  struct Row {
    int cases = 0, top = 0, in_class = 0, where = 0, clear = 0, clear_top = 0;
    double confusability = 0.0;
  };
  std::map<std::string, Row> rows_;
  /// Causes of like size: what they change, over the floor, in the recording that shows less of it.
  struct Size {
    double below;
    int cases = 0, named = 0, in_class = 0, unseen = 0, wrong = 0;
  };
  std::vector<Size> sizes_ = {{1.6}, {3.0}, {5.0}, {10.0}, {30.0}, {1e300}};
  std::vector<double> seconds_, processor_s_, class_sizes_, floor_ratios_;

  void miss(const std::string& job, const std::string& what, const std::string& truth, const Verdict& v,
            const std::string& reason) {
    char odds[24] = "";
    if (!v.cause.empty()) std::snprintf(odds, sizeof odds, " (p %.2f)", v.probability);
    misses_.push_back(
        {job, what, truth, v.verdict + (v.cause.empty() ? "" : ": " + join(v.cause) + odds), reason});
  }

  static std::string why(const Verdict& v, const Json& label, const Explanation& truth) {
    if (v.verdict.rfind("exit", 0) == 0 || v.verdict == "missing") return "no report";
    if (v.verdict == "no_gap")
      return "gap not seen, though " + rounded(number(label["visible"], "heldout")) + " times the floor";
    if (v.verdict == "unexplained") return "called unexplained";
    if (v.verdict == "insufficient") return "called insufficient";
    if (std::includes(v.cause.begin(), v.cause.end(), truth.begin(), truth.end()))
      return "named more than there is";
    std::string reason;
    for (const auto& id : v.cause) {
      const double likeness = label.contains("likeness") ? number(label["likeness"], id.c_str(), -1.0) : -1.0;
      if (likeness >= 0.0)
        reason += (reason.empty() ? "" : ", ") + id + " passes for it to " + rounded(likeness);
    }
    return reason.empty() ? "another cause" : reason;
  }

  static std::string rounded(double value) {
    char digits[24];
    std::snprintf(digits, sizeof digits, "%.2f", value);
    return digits;
  }

  void judge_case(const std::string& job, const Json& label) {
    const std::string report = directory_ + "/reports/" + job;
    const Verdict v = read_verdict(report);
    seconds_.push_back(v.seconds);
    processor_s_.push_back(v.processor_s);
    const std::string kind = text(label, "kind");
    Explanation truth;
    for (const auto& id : label["effects"]) truth.insert(id.get<std::string>());
    const std::string half = text(label, "half");
    if (half == "beginner") return judge_beginner(job, label, v);
    if (half == "closed_loops") return judge_family(job, label, v, "loops");
    if (half == "slow_logs") return judge_family(job, label, v, "slow");
    judge_odds(v, label, truth);
    if (half == "dirty") return judge_dirty(job, label, v, truth);
    if (half == "misspecified") return judge_misspecified(job, label, v, truth);
    if (half == "servo") return judge_servo(job, label, v, truth);
    const bool unknown = label["unknown"].is_string();
    const std::string name = unknown ? text(label, "unknown") : truth.empty() ? "none" : join(truth);
    confusion_[unknown ? "outside the catalogue"
               : truth.size() == 2
                   ? "two effects"
                   : name][v.named() ? (v.cause == truth ? "(right)" : join(v.cause)) : v.verdict]++;

    if (truth.empty() && !unknown) {
      const bool false_gap = v.verdict != "no_gap" && v.verdict != "insufficient";
      tallies_.add("false_gap", false_gap);
      if (false_gap) miss(job, "false gap", name, v, "the simulation matches up to its constants");
      if (v.verdict == "insufficient") miss(job, "insufficient", name, v, "enough was recorded");
      return;
    }
    judge_where(job, label, v, kind, name);
    if (unknown) {
      const bool curve = names_curves(v.cause);
      const bool right = v.verdict == "unexplained" || curve;
      tallies_.add("unknown", right);
      tallies_.add("unknown_curve", curve);
      if (!right) {
        std::string reason =
            "left of it by the catalogue: " + rounded(number(label, "left_over")) + " times the floor";
        for (const auto& id : v.cause)
          if (label.contains("likeness"))
            reason += ", " + id + " passes for it to " + rounded(number(label["likeness"], id.c_str()));
        miss(job, "unknown", name, v, reason);
      }
      return;
    }
    const auto all = v.everything();
    const bool top = v.named() && v.cause == truth;
    const bool classed = in_class(v, label, truth);
    if (truth.size() == 1) {
      Row& row = rows_[name];
      ++row.cases;
      row.top += top;
      row.in_class += classed;
      const double confusability = number(label, "confusability", -1.0);
      row.confusability += std::max(0.0, confusability);
      const double visible = std::min(number(label["visible"], "train"), number(label["visible"], "heldout"));
      Size& size =
          *std::find_if(sizes_.begin(), sizes_.end(), [&](const Size& s) { return visible < s.below; });
      ++size.cases;
      size.named += top;
      size.in_class += classed;
      size.unseen += v.verdict == "no_gap";
      size.wrong += v.named() && !classed;
      tallies_.add("class", classed);
      tallies_.add("top1_all", top);
      if (v.named()) class_sizes_.push_back(static_cast<double>(all.size()));
      if (confusability < 0.9) {
        tallies_.add("top1", top);
        ++row.clear;
        row.clear_top += top;
        if (!top) miss(job, classed ? "top-1, in class" : "top-1 and class", name, v, why(v, label, truth));
      } else if (!classed) {
        miss(job, "class", name, v,
             why(v, label, truth) + "; confusability " + rounded(confusability) + " with " +
                 text(label, "confused_with"));
      }
    } else {
      // A constant that is off beside an effect belongs into the report's list of constants, not among the causes.
      const Explanation told = v.told(truth);
      const bool both = v.named() && std::includes(told.begin(), told.end(), truth.begin(), truth.end());
      tallies_.add("both", both);
      tallies_.add("both_as_causes",
                   v.named() && std::includes(v.cause.begin(), v.cause.end(), truth.begin(), truth.end()));
      tallies_.add("both_exactly", v.named() && told == truth);
      tallies_.add("both_in_class", classed);
      if (!both) {
        std::string reason = why(v, label, truth);
        for (const auto& id : truth)
          if (v.cause.count(id))
            reason = "only " + id + " found, the other " + rounded(number(label["visible"], "heldout")) +
                     " times the floor beside it";
        miss(job, classed ? "pair, in class" : "pair", name, v, reason);
      }
    }
    judge_gap(job, label, v, name, top, report);
  }

  /// What holds for every stated probability and every interval of a parameter, whatever the half.
  void judge_odds(const Verdict& v, const Json& label, const Explanation& truth) {
    if (!v.named() || v.cause.empty()) return;
    if (names_curves(v.cause)) return;  // no name is stated
    const bool right = v.told(truth) == truth && !label["unknown"].is_string();
    const bool beyond_telling = !right && passes_for_truth(v, label);
    if (beyond_telling) return;  // nobody could know
    if (v.probability >= 0.95) tallies_.add("odds_95", right);
    else if (v.probability >= 0.8) tallies_.add("odds_80", right);
    else if (v.probability >= 0.5) tallies_.add("odds_50", right);
    if (!right || truth.size() != 1 || label.contains("form") || text(label, "half") == "dirty") return;
    // Parameters that have the same meaning in the plant and in the catalogue, with the factor between their units.
    struct Same {
      const char *effect, *parameter;
      std::size_t index;
      double factor;
    };
    constexpr double per_rad = 57.295779513082323;
    static const Same list[] = {{"second_thermal_mass", "winding_share", 0, 1.0},
                                {"second_thermal_mass", "coupling", 1, 1.0},
                                {"natural_convection", "exponent", 0, 1.0},
                                {"forced_airflow", "gain", 0, 1.0},
                                {"ambient_bias", "bias_K", 0, 1.0},
                                {"neighbour_heating", "coupling", 0, 1.0},
                                {"motion_heating", "W_s2_per_rad2", 0, per_rad * per_rad},
                                {"iron_loss", "hysteresis_W_s_per_rad", 0, per_rad},
                                {"iron_loss", "eddy_W_s2_per_rad2", 1, per_rad * per_rad},
                                {"contact_resistance", "K_per_W", 0, 1.0},
                                {"contact_resistance", "W_per_K", 1, 1.0},
                                {"contact_resistance", "J_per_K", 2, 1.0},
                                {"thermometer_lag", "lag_s", 0, 1.0},
                                {"thermometer_gain", "gain", 0, 1.0},
                                {"supply_sag", "internal_ohm", 0, 1.0},
                                {"supply_sag", "V_per_Ah", 1, 1.0},
                                {"series_resistance", "ohm", 0, 1.0},
                                {"dead_time", "duty_lost", 0, 1.0},
                                {"back_emf", "V_s_per_rad", 0, per_rad},
                                {"current_sensor_offset", "A", 0, 1.0},
                                {"current_sensor_gain", "gain", 0, 1.0},
                                {"winding_tempco", "tempco_per_K", 0, 1.0},
                                {"coulomb_friction", "Nm", 0, 1.0},
                                {"load_friction", "share", 0, 1.0},
                                {"drive_efficiency", "efficiency", 0, 1.0},
                                {"drive_efficiency", "back_efficiency", 1, 1.0},
                                {"constant_torque", "Nm", 0, 1.0},
                                {"asymmetric_viscous", "forward_Nms_per_rad", 0, 1.0},
                                {"asymmetric_viscous", "backward_Nms_per_rad", 1, 1.0},
                                {"warm_friction", "per_K", 0, 1.0},
                                {"drive_lag", "lag_s", 0, 1.0},
                                {"torque_ripple", "cycles_per_turn", 2, 1.0},
                                {"drive_deadband", "A", 0, 1.0},
                                {"quadratic_drag", "Nm_s2_per_rad2", 0, per_rad * per_rad},
                                {"idle_heat", "W", 0, 1.0},
                                {"target_delay", "s", 0, 1.0},
                                {"cable_spring", "Nm_per_rad", 0, 1.0},
                                {"compliance", "far_share", 0, 1.0},
                                {"compliance", "frequency_Hz", 1, 1.0},
                                {"backlash", "far_share", 0, 1.0},
                                {"backlash", "gap_rad", 3, 1.0 / per_rad},
                                {"presliding_friction", "Nm", 0, 1.0},
                                {"presliding_friction", "bend_rad", 1, 1.0 / per_rad},
                                {"enclosure", "W_per_K", 0, 1.0},
                                {"actuation_delay", "s", 0, 1.0},
                                {"torque_fade", "per_K", 0, 1.0},
                                {"angle_scale", "gain", 0, 1.0},
                                {"angle_bias_drift", "deg_per_s", 0, 1.0},
                                {"rate_bias", "dps", 0, 1.0}};
    for (const Same& same : list) {
      const auto found = v.parameters.find(std::string(same.effect) + "." + same.parameter);
      if (*truth.begin() != same.effect || found == v.parameters.end()) continue;
      const double value = label["parameters"][same.effect][same.index].get<double>() * same.factor;
      tallies_.add("parameters",
                   found->second.has_interval && found->second.low <= value && value <= found->second.high);
    }
  }

  /// Whether a wrong answer is one that the recording cannot tell from the truth.
  static bool passes_for_truth(const Verdict& v, const Json& label) {
    return v.cause.size() == 1 && label.contains("likeness") &&
           number(label["likeness"], v.cause.begin()->c_str()) >= 0.9;
  }

  /// A name stated with at least 0.9 that is wrong, and could have been known to be.
  static bool confidently_wrong(const Verdict& v, const Json& label, const Explanation& truth) {
    return (v.verdict == "explained" || v.verdict == "partial") && v.cause != truth && v.probability >= 0.9 &&
           !names_curves(v.cause) && !passes_for_truth(v, label);
  }

  void judge_dirty(const std::string& job, const Json& label, const Verdict& v, const Explanation& truth) {
    const bool unknown = label["unknown"].is_string();
    std::string what;
    for (const auto& dirt : label["dirt"]) what += (what.empty() ? "" : ", ") + dirt.get<std::string>();
    const std::string title = (unknown         ? text(label, "unknown")
                               : truth.empty() ? "none"
                                               : join(truth)) +
                              " under " + what;
    const bool wrong = confidently_wrong(v, label, truth);
    tallies_.add("dirty_confident", wrong);
    bool right = false;
    if (unknown) {
      right = v.verdict == "unexplained" || v.verdict == "insufficient" || names_curves(v.cause);
      tallies_.add("dirty_unknown", right);
    } else if (truth.empty()) {
      right = v.verdict == "no_gap";
      tallies_.add("dirty_none", right);
    } else {
      right = v.named() && v.cause == truth;
      tallies_.add("dirty_class", in_class(v, label, truth));
      if (number(label, "confusability", 0.0) < 0.9) tallies_.add("dirty_named", right);
    }
    if (!right) miss(job, wrong ? "dirty, confident" : "dirty", title, v, why(v, label, truth));
  }

  void judge_beginner(const std::string& job, const Json& label, const Verdict& v) {
    const bool right = is_right_for_a_beginner(v, label);
    const bool wrong = !right && v.named() && v.verdict != "ambiguous" && v.probability >= 0.9;
    tallies_.add("beginner", right);
    tallies_.add("beginner_confident", wrong);
    if (!right) miss(job, wrong ? "beginner, confident" : "beginner", text(label, "title"), v, "");
  }

  /// @param key  of the tallies
  void judge_family(const std::string& job, const Json& label, const Verdict& v, const std::string& key) {
    const FamilyAnswer answer = answer_of_family(v, label);
    const bool has_cause = !label["family"].empty();
    tallies_.add(key + "_honest", answer.honest);
    if (has_cause) tallies_.add(key + "_named", answer.named);
    tallies_.add(key + "_false", answer.wrong);
    if (!answer.honest || (has_cause && !answer.named))
      miss(job,
           answer.wrong    ? key + ", false"
           : answer.honest ? key + ", not named"
                           : key,
           text(label, "title"), v, "");
  }

  void judge_servo(const std::string& job, const Json& label, const Verdict& v, const Explanation& truth) {
    const bool right = v.named() && v.cause == truth;
    tallies_.add("servo_class", in_class(v, label, truth));
    if (number(label, "confusability", 0.0) < 0.9) tallies_.add("servo_named", right);
    if (!right) miss(job, "servo", join(truth) + ", target logged", v, why(v, label, truth));
  }

  void judge_misspecified(const std::string& job, const Json& label, const Verdict& v,
                          const Explanation& truth) {
    const bool form = label.contains("form");
    const bool wrong = confidently_wrong(v, label, truth);
    tallies_.add("misspecified_confident", wrong);
    const bool right = in_class(v, label, truth);
    tallies_.add(form ? "other_form" : "refitted", right);
    if (!right)
      miss(job, wrong ? "misspecified, confident" : "misspecified",
           form ? text(label, "form") : join(truth) + ", constants fitted without it", v,
           why(v, label, truth));
  }

  void judge_where(const std::string& job, const Json& label, const Verdict& v, const std::string& kind,
                   const std::string& name) {
    bool right = false, fine = false;
    if (!v.where.empty())
      for (const auto& place : label["where"]) {
        const auto& signals = place["signals"];
        const bool signal = std::any_of(signals.begin(), signals.end(), [&](const Json& s) {
          return s.get<std::string>() == v.where.front().signal;
        });
        const std::string submodel = text(place, "submodel");
        if (signal && same_place(v.where.front().submodel, submodel, kind)) right = true;
        if (signal && v.where.front().submodel == submodel) fine = true;
      }
    tallies_.add("where", right);
    tallies_.add("where_exact", fine);
    Row& row = rows_[name];
    if (label["effects"].size() == 1) row.where += right;
    if (!right) {
      std::string said =
          v.where.empty() ? "nowhere" : v.where.front().signal + ", " + v.where.front().submodel;
      std::string meant;
      for (const auto& place : label["where"])
        meant += (meant.empty() ? "" : " or ") + text(place, "submodel");
      misses_.push_back({job, "where", name, said, "it is " + meant});
    }
  }

  void judge_gap(const std::string& job, const Json& label, const Verdict& v, const std::string& name,
                 bool top, const std::string& report) {
    if (!v.named() || !label.contains("gap")) return;
    bool low = true;
    std::string worst;
    for (const auto& entry : label["gap"].items()) {
      const auto found = v.gap.find(entry.key());
      const double floor = number(entry.value(), "floor"), before = number(entry.value(), "before");
      if (found == v.gap.end()) {
        low = false;
        worst = entry.key() + " not judged";
        continue;
      }
      const Verdict::Gap& g = found->second;
      if (g.after >= 1.3 * floor) {
        low = false;
        worst = entry.key() + " " + rounded(g.after / floor) + " times the floor";
      }
      if (g.floor > 0.0) floor_ratios_.push_back(g.floor / floor);
      // An interval is judged where the cause is right and there is something to shrink.
      if (top && before > 1.5 * floor) {
        const double population = number(entry.value(), "shrunk_population"),
                     sample = number(entry.value(), "shrunk_sample");
        const bool covers = g.has_interval && g.low <= population && population <= g.high;
        tallies_.add("coverage", covers);
        tallies_.add("coverage_sample", g.has_interval && g.low <= sample && sample <= g.high);
        if (!covers) tallies_.add("coverage_below", g.has_interval && population < g.low);
      }
      const double recomputed = predicted_rms(directory_ + "/cases/" + job, report, entry.key(), v);
      if (recomputed >= 0.0 && g.after > 0.0) honest(job, entry.key(), recomputed / g.after);
    }
    tallies_.add("after", low);
    if (!low) misses_.push_back({job, "after", name, join(v.cause), worst});
  }

  /// Whether a report's score is that of its own predictions.
  void honest(const std::string& job, const std::string& signal, double ratio) {
    const bool agrees = std::fabs(ratio - 1.0) < 0.05;
    tallies_.add("honest", agrees);
    if (!agrees)
      misses_.push_back({job, "predictions", signal, rounded(ratio) + " times what the report says", ""});
  }

  void judge_left_out(const std::string& job, const Json& entry) {
    const std::string original = text(entry, "case");
    const Json& label = sealed_["cases"][original];
    const Verdict v = read_verdict(directory_ + "/reports/" + job);
    Explanation truth, without;
    for (const auto& id : label["effects"]) truth.insert(id.get<std::string>());
    for (const auto& id : entry["without"]) without.insert(id.get<std::string>());
    if (!without.count(*truth.begin())) {
      // Bystanders were taken out: the answer must be what it was.
      const Verdict whole = read_verdict(directory_ + "/reports/" + original);
      const bool same = whole.verdict == v.verdict && whole.cause == v.cause;
      tallies_.add("bystanders", same);
      if (!same)
        miss(job, "bystanders", *truth.begin(), v,
             "with the whole catalogue: " + whole.verdict + " " + join(whole.cause));
      return;
    }
    double likeness = 0.0;
    if (v.cause.size() == 1 && label.contains("likeness"))
      likeness = number(label["likeness"], v.cause.begin()->c_str());
    bool to_the_floor = !v.gap.empty();
    for (const auto& g : label["gap"].items()) {
      const auto found = v.gap.find(g.key());
      to_the_floor =
          to_the_floor && found != v.gap.end() && found->second.after < 1.1 * number(g.value(), "floor");
    }
    const bool confident = v.verdict == "explained" && v.probability > 0.9;
    const bool equivalent = confident && (likeness >= 0.9 || to_the_floor);
    const bool right = v.verdict == "unexplained" || v.verdict == "ambiguous" ||
                       (v.verdict == "explained" && !confident) || equivalent;
    tallies_.add("left_out", right);
    tallies_.add("left_out_unexplained", v.verdict == "unexplained");
    tallies_.add("left_out_equivalent", equivalent);
    if (!right)
      miss(job, "left out", *truth.begin() + " (case " + original + ")", v,
           v.cause.size() == 1 ? "passes for it to " + rounded(likeness) : "a confident neighbour");
  }
};

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

void Score::print_brief(std::ostream& out) const {
  tallies_.print_brief(out);
  out << "seconds of a diagnosis: median " << rounded(quantile(seconds_, 0.5)) << ", 95 % "
      << rounded(quantile(seconds_, 0.95)) << "; missed:\n";
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < misses_.size() && i < most; ++i)
    out << "  " << misses_[i].job << "  " << misses_[i].what << "  " << misses_[i].truth << "  ->  "
        << misses_[i].answer << "\n";
  if (misses_.size() > most) out << "  and " << misses_.size() - most << " more\n";
}

void Score::print(std::ostream& out) const {
  out << "| what | result | 95 % interval | cases | target |\n|---|---|---|---|---|\n";
  tallies_.print(out);
  const auto line = [&](const char* what, double a, double b, const char* unit) {
    out << "| " << what << " | " << rounded(a) << unit << " (95 %: " << rounded(b) << unit << ") | | | |\n";
  };
  line("wall time of a diagnosis, median", quantile(seconds_, 0.5), quantile(seconds_, 0.95), " s");
  line("processor time of a diagnosis, median", quantile(processor_s_, 0.5), quantile(processor_s_, 0.95),
       " s");
  line("explanations in the reported class, median", quantile(class_sizes_, 0.5),
       quantile(class_sizes_, 0.95), "");
  line("reported noise floor over the true one, median", quantile(floor_ratios_, 0.5),
       quantile(floor_ratios_, 0.95), "");

  out << "\n## Smallest causes named\n\nSingle causes by what they change, over the noise floor, in the recording "
         "that shows less of it, once the simulation's own constants have used their slack.\n\n"
         "| RMS over the floor | cases | named | in class | no gap seen | another cause named |\n|---|---|---|---|---|---|\n";
  double from = 0.0;
  for (const Size& size : sizes_) {
    if (size.cases)
      out << "| "
          << (size.below < 1e300 ? rounded(from) + " to " + rounded(size.below) : rounded(from) + " and more")
          << " | " << size.cases << " | " << size.named << " | " << size.in_class << " | " << size.unseen
          << " | " << size.wrong << " |\n";
    from = size.below;
  }
  out << "\n## Effect by effect\n\n| effect | cases | named | of those told apart | in class | where | mean "
         "confusability |\n|---|---|---|---|---|---|---|\n";
  for (const auto& entry : rows_) {
    const Row& r = entry.second;
    if (!r.cases) continue;
    out << "| `" << entry.first << "` | " << r.cases << " | " << r.top << " | " << r.clear_top << " / "
        << r.clear << " | " << r.in_class << " | " << r.where << " | " << rounded(r.confusability / r.cases)
        << " |\n";
  }
  out << "\n## Confusions\n\n| truth | answers |\n|---|---|\n";
  for (const auto& entry : confusion_) {
    out << "| " << entry.first << " |";
    for (const auto& answer : entry.second) out << " " << answer.first << " " << answer.second << "x;";
    out << " |\n";
  }
  out << "\n## Misses\n\n";
  if (misses_.empty()) out << "Nothing.\n";
  else {
    out << "| job | what | truth | answer | reason |\n|---|---|---|---|---|\n";
    for (const auto& m : misses_)
      out << "| " << m.job << " | " << m.what << " | " << m.truth << " | " << m.answer << " | " << m.reason
          << " |\n";
  }
}

int usage() {
  std::cerr
      << "usage: gap_benchmark_score --dir DIR [--out FILE.md] [--heading FILE] [--brief yes] [--require NAME=RATE ...]\n";
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc % 2 == 0) return usage();
  std::string directory, out_path, heading;
  bool brief = false;
  std::vector<std::pair<std::string, double>> required;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--dir") directory = value;
    else if (option == "--out") out_path = value;
    else if (option == "--heading") heading = value;
    else if (option == "--brief") brief = value == "yes";
    else if (option == "--require" && value.find('=') != std::string::npos)
      required.emplace_back(value.substr(0, value.find('=')), std::stod(value.substr(value.find('=') + 1)));
    else return usage();
  }
  if (directory.empty()) return usage();
  try {
    Score score(directory);
    score.run();
    if (brief) {
      score.print_brief(std::cout);
    } else if (out_path.empty()) {
      score.print(std::cout);
    } else {
      std::ofstream out(out_path);
      if (!heading.empty()) out << std::ifstream(heading).rdbuf() << "\n";
      score.print(out);
      if (!out) throw std::runtime_error("cannot write " + out_path);
    }
    int status = 0;
    for (const auto& need : required) {
      const Tally* tally = score.tallies().find(need.first);
      const double rate = tally ? tally->rate() : 0.0;
      const bool reached = tally && (tally->at_most ? rate <= need.second : rate >= need.second);
      std::cerr << need.first << " " << rate << (reached ? " reaches " : " MISSES ") << need.second << "\n";
      if (!reached) status = 1;
    }
    return status;
  } catch (const std::exception& error) {
    std::cerr << "gap_benchmark_score: " << error.what() << "\n";
    return 1;
  }
}
