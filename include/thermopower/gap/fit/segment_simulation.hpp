// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/first_reading.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace thermopower::gap::engine {

/// How many unknowns the start has of the segment with the most of them.
inline int largest_start_size(const Plant& plant, const std::vector<Segment>& segments) {
  int largest = 0;
  for (const Segment& segment : segments) largest = std::max(largest, plant.start_size(segment));
  return largest;
}

/// The row up to which a segment tells where it started. For a whole run that is the first tenth, so that most scored rows
/// have no part in it. A window of an axis is too short for that.
inline Eigen::Index beginning_of(const Segment& segment) {
  constexpr Eigen::Index shares = 10, fewest = 12;
  const Eigen::Index rows = segment.end - segment.begin;
  return segment.axis ? segment.end : segment.begin + std::min(rows, std::max(fewest, rows / shares));
}

/// The step of one coordinate of a start, in multiples of `trial`, that fits the samples best that tell it (beginning_of();
/// linear least squares about where it is).
/// @param start  to step from
/// @param held   weight of the coordinate itself, in units of the samples: how strongly it stays at 0
/// @param unit   of each place among the plant's signals: residuals are divided by it; 0 leaves a signal out
inline double best_step(const Plant& plant, Rollout& rollout, const Segment& segment, const Start& start,
                        int coordinate, double trial, double held, const std::vector<double>& unit) {
  const std::vector<Signal>& signals = plant.signals(segment);
  Readings without, with;
  rollout.roll(segment, start, without);
  Start moved = start;
  moved[coordinate] += trial;
  rollout.roll(segment, moved, with);
  const Eigen::Index told_until = beginning_of(segment);
  double product = -held * start[coordinate] / trial, square = held;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    if (!(unit[k] > 0.0) || !segment.inputs->judged(signals[k])) continue;
    const Eigen::VectorXd& measured = segment.inputs->of(signals[k]);
    for (Eigen::Index row = segment.begin; row < told_until; ++row) {
      const double at_0 = without.value(row, static_cast<int>(k));
      const double effect = (with.value(row, static_cast<int>(k)) - at_0) / unit[k],
                   left = (measured[row] - at_0) / unit[k];
      if (!std::isfinite(left) || !std::isfinite(effect)) continue;
      product += effect * left;
      square += effect * effect;
    }
  }
  return square > 0.0 ? product / square : 0.0;
}

/// Moves the starts of a segment that nobody measures to where they fit its samples best, within their bounds. The rate
/// between two readings of a coarse encoder is off by many times its fit's error, and no axis is linear that far. So steps
/// are taken until they are small.
inline void fit_hidden_start(const Plant& plant, Rollout& rollout, const Segment& segment, Start& start) {
  const std::vector<Signal>& signals = plant.signals(segment);
  for (const HiddenStart& hidden : rollout.hidden_starts(segment)) {
    const auto found = std::find(signals.begin(), signals.end(), hidden.shows_in);
    if (found == signals.end() || !segment.inputs->judged(hidden.shows_in)) continue;
    std::vector<double> unit(signals.size(), 0.0);
    unit[static_cast<std::size_t>(found - signals.begin())] = 1.0;
    constexpr int most_steps = 4;
    constexpr double small = 1e-3;  // of how far it may go
    double& at = start[hidden.coordinate];
    at = 0.0;
    for (int i = 0; i < most_steps; ++i) {
      const double before = at;
      const double step = best_step(plant, rollout, segment, start, hidden.coordinate, hidden.trial,
                                    hidden.noise_per_spread * hidden.noise_per_spread, unit);
      at = std::clamp(before + step * hidden.trial, -hidden.farthest, hidden.farthest);
      if (std::abs(at - before) <= small * hidden.farthest) break;
    }
  }
}

/// Whether a first reading of a whole run is off what its signal says after it, alone: a steep or bent beginning is the signal's.
inline bool begins_off(const Plant& plant, const Segment& segment) {
  constexpr double off_sds = 1.2;
  constexpr Eigen::Index told_by = 26;  // rows: two more than the longest parabola
  const RunSpan beginning{segment.begin, std::min(segment.end, segment.begin + told_by), ""};
  const auto is_off = [&](Signal signal) {
    if (!segment.inputs->judged(signal)) return false;
    const OrderedSamples samples(segment.inputs->of(signal), nullptr, beginning);
    return first_reading_off(samples, 0.0, off_sds) > 0.0;
  };
  const std::vector<Signal>& signals = plant.signals(segment);
  return std::any_of(signals.begin(), signals.end(), is_off);
}

/// Moves the measured starts of a segment to where they fit its samples best, within their noise. A single reading is off
/// by that much, and the body remembers the error for long. Where the first readings themselves say that one is off,
/// farther. Readings farther still are masked.
/// @param sigma  noise of each signal
inline void fit_measured_start(const Plant& plant, Rollout& rollout, const Segment& segment,
                               const std::array<double, signal_count>& sigma, Start& start) {
  constexpr double prior = 1.0;
  const double farthest_sd = begins_off(plant, segment) ? 4.0 : 2.0;
  const std::vector<Signal>& signals = plant.signals(segment);
  std::vector<double> unit;
  for (const Signal signal : signals) unit.push_back(sigma[static_cast<std::size_t>(signal)]);
  const Start sd = rollout.measured_start_sd(segment, sigma);
  for (int i = 0; i < sd.size(); ++i) {
    if (!(sd[i] > 0.0)) continue;
    Start from = start;
    from[i] = 0.0;
    const double step = best_step(plant, rollout, segment, from, i, sd[i], prior, unit);
    start[i] = std::clamp(step, -farthest_sd, farthest_sd) * sd[i];
  }
}

/// Where a segment starts relative to the measured start: what nobody measures is what fits the segment's samples best.
/// @param sigma  if given, the measured start is fitted too, within this noise. Not for windows of an axis, whose noise
///               at each restart is part of what a perfect model scores.
inline Start start_of(const Plant& plant, Rollout& rollout, const Segment& segment,
                      const std::array<double, signal_count>* sigma) {
  Start start = Start::Zero(plant.start_size(segment));
  fit_hidden_start(plant, rollout, segment, start);
  if (sigma == nullptr || segment.axis) return start;
  fit_measured_start(plant, rollout, segment, *sigma, start);
  fit_hidden_start(plant, rollout, segment, start);
  return start;
}

/// Simulates segments from their measured starts and hands each one's readings to `use(segment index, readings)`.
/// @param sigma  as start_of() takes it
inline void simulate_segments(const Model& model, const Catalogue& catalogue,
                              const std::vector<Segment>& segments, SimulationMode mode,
                              const std::function<void(std::size_t index, const Readings& readings)>& use,
                              const std::array<double, signal_count>* sigma = nullptr) {
  const Plant& plant = plant_of(model);
  const auto rollout = plant.rollout(model, catalogue, {}, {}, mode);
  Readings readings;
  for (std::size_t index = 0; index < segments.size(); ++index) {
    const Segment& segment = segments[index];
    const Start start = start_of(plant, *rollout, segment, sigma);
    rollout->roll(segment, start, readings);
    use(index, readings);
  }
}

}  // namespace thermopower::gap::engine
