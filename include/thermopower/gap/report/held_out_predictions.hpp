// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/simulated_signal.hpp>

#include <array>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

/// @file held_out_predictions.hpp
/// The simulations that a gap was measured on, row by row.

namespace thermopower::gap::engine {

/// Where the rows of a prepared recording are in the recording as it was given.
struct RowsAsGiven {
  std::vector<Eigen::Index> place;  ///< of each row
  Eigen::Index count = 0;           ///< rows that were given
};

/// Where the rows of a recording are that the check has prepared.
inline RowsAsGiven rows_as_given(const PreparedRecording& prepared) {
  RowsAsGiven rows{prepared.source_rows(), prepared.recorded_rows()};
  for (Eigen::Index& place : rows.place) {
    place -= prepared.recording().first_row;
    assert(place >= 0 && place < rows.count);
  }
  return rows;
}

/// The signals of a model for recordings, simulated in the segments that a gap is measured in, at all rows as they were
/// given.
/// @param segments  of `inputs`
/// @param rows      of each of `inputs`
inline std::vector<std::vector<SimulatedSignal>> simulated_as_given(const Model& model,
                                                                    const std::vector<Segment>& segments,
                                                                    const std::vector<Inputs>& inputs,
                                                                    const std::vector<RowsAsGiven>& rows,
                                                                    const Catalogue& catalogue) {
  assert(rows.size() == inputs.size());
  std::vector<std::array<Eigen::VectorXd, signal_count>> values(inputs.size());  // empty where not judged
  for (std::size_t r = 0; r < inputs.size(); ++r)
    for (std::size_t i = 0; i < signal_count; ++i)
      if (inputs[r].judged(static_cast<Signal>(i)))
        values[r][i] = Eigen::VectorXd::Constant(rows[r].count, missing);
  const Plant& plant = plant_of(model);
  const auto take = [&](std::size_t index, const Readings& readings) {
    const Segment& segment = segments[index];
    if (segment.warm_up) return;
    const auto r = static_cast<std::size_t>(segment.inputs - inputs.data());
    assert(r < inputs.size() && segment.end <= static_cast<Eigen::Index>(rows[r].place.size()));
    const std::vector<Signal>& signals = plant.signals(segment);
    for (std::size_t k = 0; k < signals.size(); ++k) {
      Eigen::VectorXd& of = values[r][static_cast<std::size_t>(signals[k])];
      for (Eigen::Index row = segment.begin; of.size() > 0 && row < segment.end; ++row)
        of[rows[r].place[static_cast<std::size_t>(row)]] = readings.value(row, static_cast<int>(k));
    }
  };
  simulate_segments(model, catalogue, segments, SimulationMode::free_running, take);
  std::vector<std::vector<SimulatedSignal>> result(inputs.size());
  for (std::size_t r = 0; r < inputs.size(); ++r)
    for (std::size_t i = 0; i < signal_count; ++i)
      if (inputs[r].judged(static_cast<Signal>(i)))
        result[r].push_back({signal_name(model, static_cast<Signal>(i)), std::move(values[r][i])});
  return result;
}

/// The signals of the configured model and of the one with the causes, for the held-out recordings.
inline std::vector<HeldOutPrediction> predictions_of(const Model& baseline, const Model& augmented,
                                                     const std::vector<Segment>& segments,
                                                     const std::vector<Inputs>& inputs,
                                                     const std::vector<RowsAsGiven>& rows,
                                                     const Catalogue& catalogue) {
  auto before = simulated_as_given(baseline, segments, inputs, rows, catalogue),
       after = simulated_as_given(augmented, segments, inputs, rows, catalogue);
  std::vector<HeldOutPrediction> predictions;
  for (std::size_t r = 0; r < inputs.size(); ++r)
    predictions.push_back({std::move(before[r]), std::move(after[r])});
  return predictions;
}

}  // namespace thermopower::gap::engine
