// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>
#include <thermopower/gap/simulate.hpp>

#include <array>
#include <vector>

namespace thermopower::gap {

THERMOPOWER_GAP_INLINE std::vector<SimulatedSignal> simulate(const Model& model, const Recording& recording,
                                                             const SimulationOptions& options,
                                                             const Catalogue& catalogue) {
  const std::vector<Inputs> inputs{prepare(model, recording)};
  const Instance<double> instance(model, {}, {}, catalogue);
  std::vector<SimulatedSignal> results;
  std::array<int, signal_count> place{-1, -1, -1, -1};
  for (int i = 0; i < signal_count; ++i)
    if (inputs[0].judged(static_cast<Signal>(i))) {
      place[static_cast<std::size_t>(i)] = static_cast<int>(results.size());
      results.push_back({static_cast<Signal>(i), Eigen::VectorXd::Constant(recording.rows(), missing)});
    }
  detail::simulate_segments<double>(instance, cut(inputs, options.horizon_s), options.mode,
                                    [&](std::size_t, Signal signal, Eigen::Index row, double value) {
                                      const int at = place[static_cast<std::size_t>(signal)];
                                      if (at >= 0) results[static_cast<std::size_t>(at)].values[row] = value;
                                    });
  return results;
}

}  // namespace thermopower::gap
