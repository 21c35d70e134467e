// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/actuator_plant.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap::detail {

/// Where a segment starts relative to the measured start. What nobody measures is what fits the segment's data
/// best (linear least squares); 0 for the rest.
inline Start unmeasured_start(const Plant& plant, Rollout& rollout, const Segment& segment) {
  Start start = Start::Zero(plant.start_size(segment));
  const std::vector<Signal>& signals = plant.signals(segment);
  for (const HiddenStart& hidden : rollout.hidden_starts(segment)) {
    const auto found = std::find(signals.begin(), signals.end(), hidden.shows_in);
    if (found == signals.end() || !segment.inputs->judged(hidden.shows_in)) continue;
    const int place = static_cast<int>(found - signals.begin());
    const Eigen::VectorXd& measured = segment.inputs->of(hidden.shows_in);
    Readings without, with;
    rollout.roll(segment, start, without);
    Start moved = start;
    moved[hidden.coordinate] += hidden.trial;
    rollout.roll(segment, moved, with);
    double product = 0.0, square = hidden.noise_per_spread * hidden.noise_per_spread;
    for (Eigen::Index row = segment.begin; row < segment.end; ++row) {
      const double at_0 = without.value(row, place);
      const double effect = with.value(row, place) - at_0, left = measured[row] - at_0;
      if (!std::isfinite(left) || !std::isfinite(effect)) continue;
      product += effect * left;
      square += effect * effect;
    }
    start[hidden.coordinate] = std::clamp(product / square * hidden.trial, -hidden.farthest, hidden.farthest);
  }
  return start;
}

/// Simulates segments from their measured starts and hands each one's readings to `use(segment index, readings)`.
template <class Use>
void simulate_segments(const Model& model, const Catalogue& catalogue, const std::vector<Segment>& segments,
                       SimulationMode mode, Use&& use) {
  const Plant& plant = plant_of(model);
  const auto rollout = plant.rollout(model, catalogue, {}, {}, mode);
  Readings readings;
  for (std::size_t index = 0; index < segments.size(); ++index) {
    const Segment& segment = segments[index];
    const Start start = unmeasured_start(plant, *rollout, segment);
    rollout->roll(segment, start, readings);
    use(index, readings);
  }
}

}  // namespace thermopower::gap::detail
