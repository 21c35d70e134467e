// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/quantity.hpp>

#include <cstdio>

namespace thermopower::gap {

/// What a localisation may be told.
struct LocalisationOptions {
  /// How far the baseline's constants may be off without that being a gap, as a fraction.
  double slack = 0.04;
};

/// Where simulation and recordings part, and the missing quantity itself.
struct Localisation {
  std::vector<Location> where;              ///< the largest first; empty where no submodel is at fault
  std::vector<MissingQuantity> quantities;  ///< one per faulty submodel (`effect` still empty)
};

/// Finds where a model and recordings part, from residuals alone: it knows no effect.
///
/// Each submodel is judged on its measured inputs (the current given the measured temperature and supply, the
/// temperature given the heat, the axis given the measured motion), so that a fault upstream is not blamed on
/// what is downstream. A submodel is accused when freedom in *its* equation, without any formula, predicts
/// stretches of the recording that the fit has not seen, the baseline's constants moving within their slack.
/// Where no freedom helps, the fault is still placed, by what orders it best.
///
/// Recordings that lack input columns of the longest one are left out. A fault in a signal that is not
/// recorded cannot be seen.
/// @throws InvalidInput where a recording is invalid
Localisation localise(const Model& model, const std::vector<Recording>& recordings,
                      const LocalisationOptions& options = {});

/// Fills MissingQuantity::effect: the missing quantity that the baseline would show if the augmented
/// simulation were the truth.
/// @param simulated the recordings with their outputs replaced by the augmented model's simulation, in the
///   same order
void draw_effect(const Model& baseline, const std::vector<Recording>& simulated,
                 std::vector<MissingQuantity>& quantities);

namespace detail {

/// Recordings one after another, as far as they have the same input columns as the longest.
inline Recording joined(const std::vector<Recording>& recordings) {
  const Recording* longest = nullptr;
  for (const Recording& one : recordings) {
    if (longest == nullptr || one.rows() > longest->rows()) longest = &one;
  }
  Recording out;
  if (longest == nullptr) return out;
  std::vector<const Recording*> parts;
  Eigen::Index rows = 0;
  for (const Recording& one : recordings) {
    bool same = true;
    for (const Column& column : longest->columns)
      same = same && (one.has(column.name) || !longest->has(column.name));
    if (!same) continue;
    parts.push_back(&one);
    rows += one.rows();
  }
  if (parts.size() == 1) return *parts.front();
  out.name = longest->name;
  out.t_s.resize(rows);
  for (const Column& column : longest->columns) out.columns.push_back({column.name, Eigen::VectorXd(rows)});
  Eigen::Index at = 0;
  for (const Recording* part : parts) {
    out.t_s.segment(at, part->rows()) = part->t_s;
    for (Column& column : out.columns) {
      const Eigen::VectorXd* values = part->find(column.name);
      if (values != nullptr) {
        column.values.segment(at, part->rows()) = *values;
      } else {
        column.values.segment(at, part->rows()).setConstant(missing);
      }
    }
    for (const RunSpan& run : part->spans()) out.runs.push_back({run.begin + at, run.end + at, run.label});
    at += part->rows();
  }
  return out;
}

/// One judged submodel and what was made of it.
struct Verdicts {
  Judged judged;
  Choice choice;

  explicit Verdicts(Judged j) : judged(std::move(j)) {
    const BlockFitter fitter(judged.problem, judged.blocks);
    choice = choose_blocks(fitter, judged.floor);
    excess = std::max(choice.none.unseen_total - judged.floor, 1e-300);
    for (const std::size_t i : choice.best.blocks) {
      if (choice.best.blocks.size() == 1) {
        worth.push_back(choice.none.unseen_total - choice.best.unseen_total);
      } else {
        const std::size_t other = choice.best.blocks[i == choice.best.blocks[0] ? 1 : 0];
        worth.push_back(std::max(0.0, fitter.fit({other}).unseen_total - choice.best.unseen_total));
      }
    }
    double sum = 0.0;
    for (const double one : worth) sum += one;
    const double all = std::max(0.0, choice.none.unseen_total - choice.best.unseen_total);
    for (double& one : worth) one *= sum > 0.0 ? std::min(1.0, all / excess) / sum : 0.0;
  }

  std::vector<double> worth;  ///< share of the excess that each chosen block explains
  double excess = 0.0;

  bool any() const { return !choice.best.blocks.empty(); }
  double left() const { return choice.best.unseen_total / judged.floor; }
  double before() const { return choice.none.unseen_total / judged.floor; }
  bool gap() const { return choice.none.seen_total > 1.5 * judged.floor && before() > 2.0; }
  double explained() const {
    return std::min(1.0, (choice.none.unseen_total - choice.best.unseen_total) / excess);
  }
};

inline std::string percent_text(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

inline std::string evidence_text(const std::string& given, const std::string& words, double share,
                                 const Observed& o) {
  const Ordered ordered = strongest_axis(o);
  std::string text = given + ", " + words + " explains " + percent_text(share) +
                     " of the excess on stretches that the fit has not seen.";
  char more[200];
  if (ordered.ratio > ordered.chance) {
    std::snprintf(more, sizeof more,
                  " The %s follows %s most (correlation ratio %.2f, by chance up to %.2f).",
                  to_string(o.quantity).c_str(), ordered.axis.c_str(), ordered.ratio, ordered.chance);
    text += more;
  }
  const double period = half_power_period(o.value, o.interval_s);
  if (period > 0.0) {
    std::snprintf(more, sizeof more, " Half of its power lies at periods above %.3g s.", period);
    text += more;
  }
  return text;
}

inline void report(Localisation& out, const std::string& signal, const std::string& submodel, double share,
                   const std::string& variable, const std::string& given, const std::string& words,
                   const Observed& observed) {
  Location location;
  location.signal = plant::SignalName(signal);
  location.submodel = plant::SubmodelName(submodel);
  const plant::SignalName location_signal = location.signal;
  location.share = std::min(1.0, std::max(0.0, share));
  const OrderingAxis* axis = observed.find(variable);
  if (axis == nullptr) axis = observed.find(strongest_axis(observed).axis);
  if (axis != nullptr) location.regime = regime_of(observed, *axis);
  location.evidence = evidence_text(given, words, location.share, observed);
  out.where.push_back(std::move(location));
  if (axis == nullptr || (share < 0.15 && !out.quantities.empty()))
    return;  // a picture of a trace shows nothing
  MissingQuantity quantity = binned(observed, *axis, equal_count_edges(axis->values, 28));
  quantity.signal = location_signal;
  for (const MissingQuantity& one : out.quantities) {
    if (one.signal == quantity.signal && one.variable == quantity.variable) return;
  }
  if (quantity.x.size() > 1) out.quantities.push_back(std::move(quantity));
}

inline void localise_axis(const Model& model, const Recording& recording, double slack, Localisation& out) {
  const AxisRows rows = axis_rows(recording);
  const AxisJudge judge(*model.axis, rows);
  Verdicts torque(judge.judge(slack));
  if (rows.has_rate && rows.has_angle) {
    const Verdicts instruments(judge_instruments(rows));
    if (instruments.gap() && instruments.any() && instruments.explained() > 0.5) {
      const Block& block = instruments.judged.blocks[instruments.choice.best.blocks[0]];
      const Observed observed = observe_instruments(rows);
      std::string submodel = block.submodel, signal = "angle_deg";
      if (submodel == "sensing.bias") {
        // A gyro's bias drags along a torque that is not there; a drifting angle does not.
        const double pace = instruments.choice.best.coefficients[0];
        Verdicts corrected(judge.judge(slack, -pace));
        const bool biased = corrected.choice.best.unseen_total < torque.choice.best.unseen_total;
        submodel = biased ? "sensing.rate" : "sensing.angle";
        if (biased) {
          signal = "rate_dps";
          torque = std::move(corrected);
        }
      }
      report(out, signal, submodel, instruments.explained(), block.variable,
             "With angle and rate held against each other", block.words, observed);
    }
  }
  if (!torque.gap() || (torque.explained() < 0.3 && torque.before() < 15.0)) return;
  const Observed observed = observe_torque(*model.axis, rows);
  const std::string signal = rows.has_rate ? "rate_dps" : "angle_deg";
  if (torque.left() > 15.0 && torque.choice.best.seen_total > 0.03 * torque.choice.none.seen_total) {
    const UnnamedTorque unnamed = judge.unnamed(torque.judged);
    if (unnamed.left < 0.5 * torque.choice.best.seen_total) {
      report(out, signal, unnamed.submodel, 1.0 - unnamed.left / torque.choice.none.seen_total,
             unnamed.variable, "Given the measured motion and command", unnamed.words, observed);
      return;
    }
  }
  if (torque.any() && torque.explained() > 0.3) {
    for (std::size_t k = 0; k < torque.worth.size(); ++k) {
      const Block& block = torque.judged.blocks[torque.choice.best.blocks[k]];
      report(out, signal, block.submodel, torque.worth[k], block.variable,
             "Given the measured motion and command", block.words, observed);
    }
    return;
  }
  const std::string axis = strongest_axis(observed).axis;
  const std::string submodel = axis == "rate_dps"                     ? "mechanical.friction"
                               : axis == "angle_deg" || axis == "t_s" ? "mechanical.load"
                               : axis == "acceleration_rad_per_s2"    ? "mechanical.structure"
                                                                      : "mechanical.drive";
  report(out, signal, submodel, torque.any() ? torque.explained() : 0.0, axis,
         "Given the measured motion and command", "no smooth freedom in one submodel helps much, the best",
         observed);
}

inline void localise_bench(const Model& model, const Recording& recording, double slack, Localisation& out) {
  const BenchRows rows = bench_rows(model, recording);
  std::optional<Verdicts> current;
  if (model.has_current() && rows.has_power && rows.has_current)
    current.emplace(judge_current(model, rows, slack));
  const bool current_gap = current && current->gap();

  double offset_A = 0.0;
  if (current_gap) {
    Eigen::Index at = current->judged.problem.nuisance.cols();
    for (const std::size_t i : current->choice.best.blocks) {
      const Block& block = current->judged.blocks[i];
      if (block.submodel == "sensing.current") offset_A = current->choice.best.coefficients[at];
      at += block.columns.cols();
    }
  }
  struct Heated {
    HeatSource source;
    Verdicts verdicts;
    Eigen::VectorXd heat;
  };
  std::vector<Heated> heated;
  if (model.has_thermal() && rows.has_temperature) {
    for (const HeatSource source :
         {HeatSource::law, HeatSource::measured_current, HeatSource::electrical_power}) {
      Eigen::VectorXd heat = heat_of(model, rows, source, offset_A);
      if (heat.size() == 0) continue;
      // Where law and measurement agree there is one heat, and the law's carries no noise.
      if (!current_gap && !heated.empty()) break;
      Verdicts verdicts(ThermalJudge(model, rows, heat).judge(slack, source));
      heated.push_back({source, std::move(verdicts), std::move(heat)});
    }
  }
  const Heated* best = nullptr;
  for (const Heated& one : heated) {
    const auto cost = [](const Heated& h) {
      return h.verdicts.choice.best.unseen_total *
             (1.0 + 0.5 * static_cast<double>(h.verdicts.choice.best.blocks.size()));
    };
    if (best == nullptr || cost(one) < cost(*best)) best = &one;
  }
  const bool thermometer =
      best != nullptr && best->verdicts.gap() && best->verdicts.any() &&
      best->verdicts.judged.blocks[best->verdicts.choice.best.blocks[0]].submodel == "sensing.temperature" &&
      best->verdicts.explained() > 0.5;
  if (current_gap) {
    const std::string given = "Given the measured temperature and supply";
    bool placed = false;
    if (current->any() && current->explained() > 0.3) {
      for (std::size_t k = 0; k < current->worth.size(); ++k) {
        const Block& block = current->judged.blocks[current->choice.best.blocks[k]];
        // A thermometer that is wrong makes the resistance seem to depend on it.
        if (thermometer && block.variable == "motor_C") {
          placed = true;
          continue;
        }
        std::string submodel = block.submodel;
        // One factor on the current is the sensor's if the heat follows the law all the same, and the motor's
        // if it does not.
        if (submodel == "electrical.scale") {
          submodel = best != nullptr && best->source == HeatSource::law ? "sensing.current" : "electrical";
        }
        report(out, "current_A", submodel, current->worth[k], block.variable, given, block.words,
               observe_current(rows, submodel == "sensing.current"));
        placed = true;
      }
    }
    if (!placed && !thermometer) {
      report(out, "current_A", "electrical", current->any() ? current->explained() : 0.0, "", given,
             "no smooth freedom helps much, the best", observe_current(rows, false));
    }
  }
  if (best == nullptr || !best->verdicts.gap()) return;
  const ThermalJudge judge(model, rows, best->heat);
  const Observed observed = observe_heat(rows, judge);
  const std::string given = "Given the heat and the air temperature";
  const Verdicts& v = best->verdicts;
  if (v.left() > 8.0 && v.explained() < 0.99 && v.choice.best.seen_total > 0.03 * v.choice.none.seen_total) {
    auto [submodel, left] = judge.unnamed(v.judged);
    if (left < 0.5 * v.choice.best.seen_total) {
      if (submodel != "thermal.storage")
        submodel = scatters_with_rise(observed) ? "thermal.loss" : "thermal.heating";
      const double share = std::min(1.0, std::max(0.0, 1.0 - left / v.choice.none.seen_total));
      report(out, "motor_C", submodel, share, submodel == "thermal.storage" ? "motor_C" : "", given,
             submodel == "thermal.storage" ? "a heat capacity with a peak at some temperature"
                                           : "nothing recorded orders it; a course of its own in time",
             observed);
      return;
    }
  }
  for (std::size_t k = 0; k < v.worth.size(); ++k) {
    const Block& block = v.judged.blocks[v.choice.best.blocks[k]];
    report(out, "motor_C", block.submodel, v.worth[k], block.variable, given, block.words, observed);
  }
  if (v.worth.empty())
    report(out, "motor_C", "thermal.heating", 0.0, "", given, "no freedom in one submodel helps; the best",
           observed);
}

}  // namespace detail

inline Localisation localise(const Model& model, const std::vector<Recording>& recordings,
                             const LocalisationOptions& options) {
  Localisation out;
  for (const Recording& one : recordings) {
    if (const auto problem = one.validate()) throw InvalidInput("recording '" + one.name + "': " + *problem);
  }
  const Recording recording = detail::joined(recordings);
  if (recording.rows() < 30) return out;
  if (model.has_axis() && recording.has("drive_A") &&
      (recording.has("rate_dps") || recording.has("angle_deg"))) {
    detail::localise_axis(model, recording, options.slack, out);
  }
  if (model.has_current() || model.has_thermal()) {
    if (recording.has("motor_C") || recording.has("current_A"))
      detail::localise_bench(model, recording, options.slack, out);
  }
  std::stable_sort(out.where.begin(), out.where.end(),
                   [](const Location& a, const Location& b) { return a.share > b.share; });
  return out;
}

inline void draw_effect(const Model& baseline, const std::vector<Recording>& simulated,
                        std::vector<MissingQuantity>& quantities) {
  const Recording recording = detail::joined(simulated);
  if (recording.rows() < 30) return;
  for (MissingQuantity& q : quantities) {
    detail::Observed observed;
    if (q.quantity == plant::Quantity::missing_torque && baseline.has_axis()) {
      observed = detail::observe_torque(*baseline.axis, detail::axis_rows(recording));
    } else if (q.quantity == plant::Quantity::angle_slope_minus_rate) {
      observed = detail::observe_instruments(detail::axis_rows(recording));
    } else if (q.quantity == plant::Quantity::missing_heat && baseline.has_thermal()) {
      const detail::BenchRows rows = detail::bench_rows(baseline, recording);
      Eigen::VectorXd heat = detail::heat_of(baseline, rows, detail::HeatSource::measured_current);
      if (heat.size() == 0) heat = detail::heat_of(baseline, rows, detail::HeatSource::law);
      if (heat.size() == 0) continue;
      observed = detail::observe_heat(rows, detail::ThermalJudge(baseline, rows, heat));
    } else if (baseline.has_current()) {
      observed = detail::observe_current(detail::bench_rows(baseline, recording),
                                         q.quantity == plant::Quantity::missing_current);
    }
    const detail::OrderingAxis* axis = observed.find(q.variable);
    if (axis == nullptr || q.x.size() < 2) continue;
    std::vector<double> edges{q.x[0] - 0.5 * (q.x[1] - q.x[0])};
    for (Eigen::Index i = 0; i + 1 < q.x.size(); ++i) edges.push_back(0.5 * (q.x[i] + q.x[i + 1]));
    edges.push_back(q.x[q.x.size() - 1] + 0.5 * (q.x[q.x.size() - 1] - q.x[q.x.size() - 2]));
    const MissingQuantity drawn = detail::binned(observed, *axis, edges);
    q.effect = Eigen::VectorXd::Constant(q.x.size(), missing);
    for (Eigen::Index i = 0; i < drawn.x.size(); ++i) {
      const auto k = std::upper_bound(edges.begin(), edges.end(), drawn.x[i]) - edges.begin() - 1;
      if (k >= 0 && k < q.effect.size()) q.effect[k] = drawn.value[i];
    }
  }
}

}  // namespace thermopower::gap
