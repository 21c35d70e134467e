// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/plant/signal.hpp>

#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// A signal that will be recorded, and its noise.
struct Watched {
  Signal signal = Signal::motor_C;  ///< that is watched
  double noise = 1.0;               ///< standard deviation in the signal's unit, > 0
};

/// What a diagnosis leaves open, as a design needs it.
struct DiagnosedGap {
  Model model;                              ///< that was diagnosed
  Verdict verdict = Verdict::insufficient;  ///< of that diagnosis
  std::vector<RankedExplanation> ranking;   ///< likeliest first
  std::vector<Watched> watched;             ///< the signals that were judged, with their noise
  double horizon_s = 0.5;                   ///< of the axis' windows, s
};

/// What was diagnosed, without a report in between.
inline DiagnosedGap gap_of(const Model& model, const Diagnosis& diagnosis) {
  DiagnosedGap gap{model, diagnosis.verdict, diagnosis.ranking, {}, 0.5};
  for (const GapScore& one : diagnosis.gap) {
    for (int i = 0; i < plant::actuator_signal_count; ++i)
      if (to_string(one.signal) == std::string(to_string(static_cast<Signal>(i))) && one.noise_floor > 0.0)
        gap.watched.push_back({static_cast<Signal>(i), one.noise_floor});
    if (one.horizon_s) gap.horizon_s = *one.horizon_s;
  }
  return gap;
}

}  // namespace thermopower::design
