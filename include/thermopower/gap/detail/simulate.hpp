// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>
#include <thermopower/gap/report/held_out_predictions.hpp>
#include <thermopower/gap/simulate.hpp>

#include <array>
#include <cassert>
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
    if (inputs[0].judged(static_cast<Signal>(i)) ||
        (static_cast<Signal>(i) == Signal::power_param && inputs[0].bench() && inputs[0].heater_closed)) {
      column[static_cast<std::size_t>(i)] = static_cast<int>(results.size());
      results.push_back(
          {signal_name(model, static_cast<Signal>(i)), Eigen::VectorXd::Constant(recording.rows(), missing)});
    }
  const Plant& plant = plant_of(model);
  std::vector<Segment> segments = engine::cut(inputs, options.horizon_s, plant);
  for (Segment& segment : segments) segment.warm_up = false;  // what is not judged is asked for, too
  engine::simulate_segments(
      model, catalogue, segments, options.mode, [&](std::size_t index, const Readings& readings) {
        assert(segments[index].begin >= 0 && segments[index].end <= recording.rows());
        const std::vector<Signal>& signals = plant.signals(segments[index]);
        for (std::size_t k = 0; k < signals.size(); ++k) {
          const int at = column[static_cast<std::size_t>(signals[k])];
          for (Eigen::Index row = segments[index].begin; at >= 0 && row < segments[index].end; ++row)
            results[static_cast<std::size_t>(at)].values[row] = readings.value(row, static_cast<int>(k));
        }
      });
  return results;
}

THERMOPOWER_GAP_INLINE std::vector<SimulatedSignal> simulate_as_believed(const Model& model,
                                                                         const Recording& recording,
                                                                         double horizon_s,
                                                                         const Catalogue& given) {
  const Catalogue& catalogue = catalogue_of(model, given);
  std::vector<SimulatedSignal> results =
      simulate(model, recording, {SimulationMode::free_running, horizon_s}, given);
  engine::CheckedRecordings checked = engine::check(model, {recording}, {}, {horizon_s, false}, catalogue);
  const engine::RowsAsGiven rows = engine::rows_as_given(checked.train.front());
  std::vector<Inputs> inputs;
  inputs.push_back(std::move(checked.train.front()).take_inputs());
  std::vector<Segment> segments = engine::cut(inputs, horizon_s, plant_of(model));
  for (Segment& segment : segments) segment.warm_up = false;  // what is not judged is asked for, too
  const auto simulated = engine::simulated_as_given(model, segments, inputs, {rows}, catalogue);
  for (const SimulatedSignal& believed : simulated.front())
    for (SimulatedSignal& one : results)
      if (to_string(one.signal) == to_string(believed.signal)) {
        assert(believed.values.size() == one.values.size());
        one.values = believed.values.array().isFinite().select(believed.values, one.values);
      }
  return results;
}

}  // namespace thermopower::gap
