// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>
#include <thermopower/gap/simulate.hpp>

#include <array>
#include <vector>

namespace thermopower::gap {

THERMOPOWER_GAP_INLINE std::vector<SimulatedSignal> simulate(const Model& model, const Recording& recording,
                                                             const SimulationOptions& options,
                                                             const Catalogue& given) {
  const Catalogue& catalogue = catalogue_of(model, given);
  const std::vector<Inputs> inputs{engine::prepare(model, recording)};
  std::vector<SimulatedSignal> results;
  std::array<int, signal_count> column;
  column.fill(-1);
  for (int i = 0; i < signal_count; ++i)
    if (inputs[0].judged(static_cast<Signal>(i))) {
      column[static_cast<std::size_t>(i)] = static_cast<int>(results.size());
      results.push_back(
          {signal_name(model, static_cast<Signal>(i)), Eigen::VectorXd::Constant(recording.rows(), missing)});
    }
  const Plant& plant = plant_of(model);
  std::vector<Segment> segments = engine::cut(inputs, options.horizon_s, plant);
  for (Segment& segment : segments) segment.warm_up = false;  // what is not judged is asked for, too
  engine::simulate_segments(
      model, catalogue, segments, options.mode, [&](std::size_t index, const Readings& readings) {
        const std::vector<Signal>& signals = plant.signals(segments[index]);
        for (std::size_t k = 0; k < signals.size(); ++k) {
          const int at = column[static_cast<std::size_t>(signals[k])];
          for (Eigen::Index row = segments[index].begin; at >= 0 && row < segments[index].end; ++row)
            results[static_cast<std::size_t>(at)].values[row] = readings.value(row, static_cast<int>(k));
        }
      });
  return results;
}

}  // namespace thermopower::gap
