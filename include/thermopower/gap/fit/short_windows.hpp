// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <vector>

namespace thermopower::gap::engine {

/// Whether an effect brings states of a moving axis that nobody measures: the far side of a spring, a bristle.
inline bool remembers(const CatalogueEntry& entry) {
  return !entry.info.states.empty() || entry.hooks.axis_structure;
}

/// Length in s of windows so short that a simulation hardly leaves the measurement: a fifth of `short_s`, with 16 rows at
/// least. It is `short_s` itself if the model has states that nobody measures, or there is no axis.
inline double shortest_window_s(const Model& model, const Catalogue& catalogue,
                                const std::vector<Inputs>& recordings, double short_s) {
  constexpr double share = 0.2, rows = 16.0;
  bool remembering = model.own.has_value();
  for (const auto& effect : model.effects) {
    const CatalogueEntry* entry = catalogue.find(effect.first);
    remembering = remembering || entry == nullptr || remembers(*entry);
  }
  double interval_s = 0.0;
  for (const Inputs& one : recordings)
    if (one.axis()) interval_s = std::max(interval_s, plant::median_interval_s(one.t_s, one.runs));
  if (remembering || interval_s == 0.0) return short_s;
  return std::min(std::max(share * short_s, rows * interval_s), short_s);
}

}  // namespace thermopower::gap::engine
