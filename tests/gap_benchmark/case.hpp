// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "assess.hpp"
#include "dirt.hpp"
#include "recording.hpp"

namespace gap_benchmark {

/// Which half of the benchmark a case belongs to.
enum class Half {
  clean,         ///< the plant's physics are the catalogue's, the log is as a careful person records it
  dirty,         ///< the same physics, and a log as logs are
  misspecified,  ///< constants fitted with the wrong structure, or physics of another form than the catalogue's
  servo          ///< the log of an axis holds the target of its servo, and not the current
};

inline const char* name(Half half) {
  static const char* const names[] = {"clean", "dirty", "misspecified", "servo"};
  return names[static_cast<int>(half)];
}

/// Physics that the catalogue knows in another form.
enum class OtherForm {
  none,
  stribeck_exponent,  ///< friction falls with exp(-|w / knee|^n), n of 1 or 4 instead of 2
  cogging_harmonic,   ///< cogging whose second harmonic is a good part of the first
  third_node,         ///< a body behind the winding soaks up heat beside the housing
  curved_sensor       ///< the current sensor's gain changes with the current
};

inline const char* name(OtherForm form) {
  static const char* const names[] = {"none", "Stribeck friction of another exponent",
                                      "cogging with a second harmonic", "a third node",
                                      "a current sensor that is not straight"};
  return names[static_cast<int>(form)];
}

/// The effect of the catalogue that comes nearest to a form, though it is not the same.
inline const char* nearest(OtherForm form) {
  static const char* const ids[] = {"", "stribeck_friction", "cogging", "second_thermal_mass",
                                    "current_sensor_gain"};
  return ids[static_cast<int>(form)];
}

/// What is asked of the generator for one case.
struct CaseOrder {
  Half half = Half::clean;
  std::vector<Dirt> dirt;            ///< of both recordings
  bool refitted = false;             ///< the simulation's constants were fitted without the effect
  OtherForm form = OtherForm::none;  ///< acts besides, or instead of, `effects`
  bool axis = false, thesis = false;
  std::vector<std::string> effects;
  int unknown = 0;       ///< number of the cause outside the catalogue, 0 for none
  bool thorough = true;  ///< look for the best wrong cause, too
  bool clear = false;    ///< draw again, a few times, when a wrong cause passes for the true one
  double gate = 3.0;     ///< least RMS of the cause over the floor, in train and in held-out
  double ceiling = 1e9;  ///< the largest one, in whichever shows less of it
  int replicates = 12;   ///< further held-out recordings for the shrinkage of the population
};

/// How often a case is drawn before there is said to be none: a narrow range of sizes takes patience.
inline int most_drawings(const CaseOrder& order, int usually) {
  return order.ceiling < 1e9 ? 12 * usually : usually;
}

struct DrawnCase {
  nlohmann::ordered_json model, label;
  Recording train, heldout;
  Assessment assessment;

  /// The logs as the judge gets them, and what the label says of that.
  void finish(const CaseOrder& order, Random& random) {
    label["half"] = name(order.half);
    label["refitted"] = order.refitted;
    if (order.form != OtherForm::none) label["form"] = name(order.form);
    label["dirt"] = nlohmann::ordered_json::array();
    for (const Dirt dirt : order.dirt) label["dirt"].push_back(name(dirt));
    for (Recording* log : {&train, &heldout}) Soiling(*log, random).apply(order.dirt);
  }
};

/// The noise of a dirty log; of a clean one what was drawn.
inline NoiseKind noise_kind(const CaseOrder& order) {
  if (has(order.dirt, Dirt::coloured)) return NoiseKind::coloured;
  return has(order.dirt, Dirt::heavy_tailed) ? NoiseKind::heavy_tailed : NoiseKind::mild;
}

/// The simulation's constants as somebody fits them who does not know of the effect: what brings the training
/// recording nearest, up to a factor of 2.5.
template <class Values>
void refit(Values& model, const Scenario<Values>& train, std::vector<Free> constants) {
  for (auto& f : constants) {
    const double value = f.starts.front(), a = value / 2.5, b = value * 2.5;
    f.from = std::min(a, b);
    f.to = std::max(a, b);
  }
  for (const auto& fitted : train.explained(model, constants, 25).fitted) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.5g", fitted.second);
    model[static_cast<std::size_t>(fitted.first)] = std::stod(digits);
  }
}

struct SquaredError {
  double sum = 0.0;
  std::size_t count = 0;

  void add(const std::vector<double>& simulated, const std::vector<double>& measured) {
    for (std::size_t k = 0; k < measured.size(); ++k)
      if (!std::isnan(measured[k])) add(simulated[k] - measured[k]);
  }
  void add(double error) {
    sum += error * error;
    ++count;
  }
  double rms() const { return count ? std::sqrt(sum / static_cast<double>(count)) : 0.0; }
};

using SquaredErrors = std::map<std::string, SquaredError>;

/// `floor` is what the true model scores on this very recording; `shrunk_population` is what it would achieve
/// over many held-out recordings of the same kind, which is what a confidence interval has to cover.
inline void write_gap(nlohmann::ordered_json& label, SquaredErrors& before, SquaredErrors& perfect,
                      SquaredErrors& all_before, SquaredErrors& all_perfect) {
  for (const auto& entry : before) {
    const std::string& signal = entry.first;
    label["gap"][signal] = {
        {"before", entry.second.rms()},
        {"floor", perfect[signal].rms()},
        {"shrunk_sample", 1.0 - perfect[signal].rms() / entry.second.rms()},
        {"shrunk_population", 1.0 - all_perfect[signal].rms() / all_before[signal].rms()}};
  }
}

}  // namespace gap_benchmark
