// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/thresholds.hpp>
#include <thermopower/gap/report/score.hpp>

#include <algorithm>
#include <string>
#include <vector>

/// @file opposites.hpp
/// Causes that are each larger than what is seen, and cancel.

namespace thermopower::gap::engine {

/// Whether causes nearly cancel each other: with any of them taken out of the model, and the others kept, a simulation is
/// further from the rows than with none of them, with one of them by a factor (DecisionThresholds::opposites). A spring
/// and a load of nearly its stiffness that push against each other are a curve that neither has.
/// @param with    the model with the causes
/// @param causes  their ids
inline bool are_opposites(const Model& with, const std::vector<std::string>& causes,
                          const std::vector<Segment>& segments, const Catalogue& catalogue) {
  if (causes.size() < 2) return false;
  Model none = with;
  for (const std::string& id : causes) none.effects.erase(id);
  const Errors neither = errors_of(none, segments, catalogue);
  double largest = 0.0;
  for (const std::string& id : causes) {
    Model without = with;
    without.effects.erase(id);
    const Errors others = errors_of(without, segments, catalogue);
    double further = 0.0;
    for (int i = 0; i < signal_count; ++i) {
      const Signal signal = static_cast<Signal>(i);
      if (neither.rms(signal) > 0.0) further = std::max(further, others.rms(signal) / neither.rms(signal));
    }
    if (further <= decision.worse) return false;
    largest = std::max(largest, further);
  }
  return largest > decision.opposites;
}

}  // namespace thermopower::gap::engine
