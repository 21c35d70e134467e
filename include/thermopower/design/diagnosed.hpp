// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/signal.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// A signal that will be recorded, and how far a prediction is off.
///
/// How to: @ref design_the_next_experiment.
struct Watched {
  Signal signal = Signal::motor_C;  ///< that is watched
  double noise = 1.0;               ///< standard deviation in the signal's unit, > 0
  double left = noise;              ///< what the likeliest explanation leaves of it, `noise` or more

  /// From a report's scores. @param recalibrated  with refitted constants  @param after  with the named causes
  static Watched of(Signal signal, double noise, double recalibrated, double after) {
    return {signal, noise, std::fmax(noise, std::fmin(recalibrated, after))};
  }
};

/// What a diagnosis leaves open, as a design needs it.
///
/// How to: @ref design_the_next_experiment.
struct DiagnosedGap {
  Model model;                              ///< that was diagnosed
  Verdict verdict = Verdict::insufficient;  ///< of that diagnosis
  std::vector<RankedExplanation> ranking;   ///< likeliest first
  std::vector<Watched> watched;             ///< the signals that were judged, with their noise
  double horizon_s = 0.5;                   ///< of the axis' windows, s

  /// What the likeliest explanation leaves, in units of the noise: the most of all signals, 1 or more.
  double times_noise() const {
    double most = 1.0;
    for (const Watched& one : watched) most = std::max(most, one.left / one.noise);
    return most;
  }
};

/// What was diagnosed, without a report in between.
inline DiagnosedGap gap_of(const Model& model, const Diagnosis& diagnosis) {
  DiagnosedGap gap{model, diagnosis.verdict, diagnosis.ranking, {}, 0.5};
  for (const GapScore& one : diagnosis.gap) {
    if (const auto known = one.signal.known(); known && one.noise_floor > 0.0)
      gap.watched.push_back(Watched::of(*known, one.noise_floor, one.recalibrated, one.after));
    if (one.horizon_s) gap.horizon_s = *one.horizon_s;
  }
  return gap;
}

/// Which input the limits lack for a model, in a sentence that names the field; nothing where all are there.
inline std::optional<std::string> lacking_for(const DiagnosedGap& gap, const Limits& limits) {
  const Model& model = gap.model;
  if (model.own) return "the model is a plant of its own; expected an axis, or a motor that warms up";
  if (gap.watched.empty()) return "the report judged no signal; expected one to record";
  const auto gives_one_of = [&](std::initializer_list<const char*> columns) {
    return std::any_of(columns.begin(), columns.end(), [&](const char* one) { return limits.gives(one); });
  };
  const auto moves = [](const Watched& one) {
    return one.signal == Signal::angle_deg || one.signal == Signal::rate_dps;
  };
  if (std::any_of(gap.watched.begin(), gap.watched.end(), moves)) {
    const char* const drive = model.axis && model.axis->voltage_driven() ? "voltage_V" : "drive_A";
    const bool is_driven = model.has_servo()
                               ? gives_one_of({"drive_A", "voltage_V", "target_deg", "target_dps"})
                               : limits.gives(drive);
    if (!is_driven)
      return std::string("vary.") + (model.has_servo() ? "target_deg" : drive) +
             " is missing; the axis of the model is driven by it";
  }
  if (!std::all_of(gap.watched.begin(), gap.watched.end(), moves)) {
    if (model.has_thermal() && !limits.gives("ambient_C"))
      return "hold.ambient_C is missing; the model's body loses heat to the air";
    if (!gives_one_of({"power_param", "current_A", "heat_W", "drive_A"}))
      return "vary.power_param is missing; the model's body is heated by it (or by current_A or heat_W)";
    if (model.has_thermal() && limits.gives("motor_C"))
      return "motor_C is an input here, and the model simulates it; expected it in start";
  }
  return std::nullopt;
}

}  // namespace thermopower::design
