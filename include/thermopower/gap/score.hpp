// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/noise.hpp>
#include <thermopower/gap/simulate.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thermopower::gap {

/// Errors of a free-running simulation against recordings, signal by signal, in the order of the rows.
struct Errors {
  std::array<std::vector<double>, signal_count> of;    ///< simulated minus measured
  std::array<std::vector<int>, signal_count> segment;  ///< which segment each belongs to
  std::array<std::vector<double>, signal_count> simulated;  ///< simulated value, in the signal's unit
  std::array<std::vector<Eigen::Index>, signal_count> row;  ///< row in the recording of that segment

  /// Root mean square of a signal's errors; 0 without any.
  double rms(Signal signal) const {
    const std::vector<double>& errors = of[static_cast<std::size_t>(signal)];
    double sum = 0.0;
    for (double error : errors) sum += error * error;
    return errors.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(errors.size()));
  }
};

/// Simulates a model as a gap is judged and subtracts what was measured. The rows where the axis restarts
/// from the measured state say nothing and are left out.
inline Errors errors_of(const Model& model, const std::vector<Segment>& segments,
                        const Catalogue& catalogue) {
  Errors errors;
  const Instance<double> instance(model, {}, {}, catalogue);
  for (std::size_t i = 0; i < signal_count; ++i) {
    std::size_t rows = 0;
    for (const Segment& segment : segments) rows += static_cast<std::size_t>(segment.end - segment.begin);
    if (!segments.empty() && segments.front().inputs->judged(static_cast<Signal>(i)))
      errors.of[i].reserve(rows);
  }
  detail::simulate_segments<double>(
      instance, segments, SimulationMode::free_running,
      [&](std::size_t index, Signal signal, Eigen::Index row, double value) {
        const Segment& segment = segments[index];
        const Inputs& inputs = *segment.inputs;
        if (!inputs.judged(signal)) return;
        const double measured = inputs.of(signal)[row];
        if (!std::isfinite(measured) || (segment.axis && row == segment.begin)) return;
        const std::size_t at = static_cast<std::size_t>(signal);
        // A simulation that ran away counts as very bad, not as undefined.
        errors.of[at].push_back(std::isfinite(value) ? std::clamp(value - measured, -1e9, 1e9) : 1e9);
        errors.segment[at].push_back(static_cast<int>(index));
        errors.simulated[at].push_back(value);
        errors.row[at].push_back(row);
      });
  return errors;
}

/// What a perfect model would score: the signal's own noise, and the noise of the measured state it starts
/// from, carried through the model.
inline std::array<double, signal_count> noise_floor(const Model& model, const std::vector<Segment>& segments,
                                                    const std::array<double, signal_count>& sigma,
                                                    const Catalogue& catalogue) {
  const Instance<Dual> instance(model, {}, {}, catalogue);
  std::array<double, signal_count> sum{}, count{};
  for (const Segment& segment : segments) {
    const Inputs& inputs = *segment.inputs;
    const auto put = [&](Signal signal, Eigen::Index row, const Dual& value, int first, int second) {
      const std::size_t at = static_cast<std::size_t>(signal);
      if (!inputs.judged(signal) || !std::isfinite(inputs.of(signal)[row])) return;
      const double by_first =
          derivative_of(value, 0) * (first >= 0 ? sigma[static_cast<std::size_t>(first)] : 0.0);
      const double by_second =
          derivative_of(value, 1) * (second >= 0 ? sigma[static_cast<std::size_t>(second)] : 0.0);
      sum[at] += sigma[at] * sigma[at] + by_first * by_first + by_second * by_second;
      count[at] += 1.0;
    };
    if (segment.axis) {
      const AxisRollout<Dual> rollout(instance, inputs);
      AxisState<Dual> state = FitProblem::measured_start(rollout, inputs, segment.run, segment.begin);
      Dual angle = constant<Dual>(0.0), rate = constant<Dual>(0.0);
      seed(angle, 0);
      seed(rate, 1);
      const AxisState<Dual> unit = rollout.start(segment.begin, inputs.t_s[segment.run.begin], 1.0, 1.0);
      const AxisState<Dual> zero = rollout.start(segment.begin, inputs.t_s[segment.run.begin], 0.0, 0.0);
      state.angle_rad += angle * value_of(Dual(unit.angle_rad - zero.angle_rad));
      state.rate_rad_per_s += rate * value_of(Dual(unit.rate_rad_per_s - zero.rate_rad_per_s));
      rollout.window(segment.run, segment.begin, segment.end, state,
                     [&](Eigen::Index row, const AxisReadings<Dual>& read) {
                       if (row == segment.begin) return;
                       const int first = inputs.judged(Signal::angle_deg) ? 2 : -1;
                       const int second = inputs.judged(Signal::rate_dps) ? 3 : -1;
                       put(Signal::angle_deg, row, read.angle_deg, first, second);
                       put(Signal::rate_dps, row, read.rate_dps, first, second);
                     });
    } else {
      typename BenchRollout<Dual>::Feed feed;
      feed.measured_motor = !inputs.judged(Signal::motor_C);
      const BenchRollout<Dual> rollout(instance, inputs, feed);
      BenchState<Dual> state = rollout.start(
          segment.begin, inputs.held_motor_C.size() > 0 ? inputs.held_motor_C[segment.begin] : 25.0);
      Dual warm = constant<Dual>(0.0);
      seed(warm, 0);
      state.winding_C += warm;
      state.surface_C += warm;
      state.thermometer_C += warm;
      rollout.run(segment.begin, segment.end, inputs.t_s[segment.run.begin], state,
                  [&](Eigen::Index row, const BenchReadings<Dual>& read) {
                    const int first = inputs.judged(Signal::motor_C) ? 1 : -1;
                    put(Signal::current_A, row, read.current_A, first, -1);
                    put(Signal::motor_C, row, read.motor_C, first, -1);
                  });
    }
  }
  std::array<double, signal_count> floor{};
  for (std::size_t i = 0; i < signal_count; ++i)
    floor[i] = count[i] > 0.0 ? std::sqrt(sum[i] / count[i]) : 0.0;
  return floor;
}

/// Small, fast and the same everywhere: the generator of the bootstrap (SplitMix64).
class BlockDice {
public:
  /// Equal seeds give equal sequences, on every platform.
  explicit BlockDice(std::uint64_t seed) : state_(seed) {}

  /// A whole number in [0, count).
  std::size_t below(std::size_t count) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
    return static_cast<std::size_t>((mixed ^ (mixed >> 31)) % count);
  }

private:
  std::uint64_t state_;
};

/// 95 % interval of 1 - rms(after) / rms(before) by a paired block bootstrap: blocks of at least five
/// correlation lengths of the squared errors, drawn for both simulations alike.
inline Interval shrinkage_interval(const std::vector<double>& before, const std::vector<double>& after,
                                   unsigned seed) {
  const std::size_t count = before.size();
  if (count == 0 || after.size() != count) return {0.0, 0.0};
  std::vector<double> squared(count);
  for (std::size_t i = 0; i < count; ++i) squared[i] = before[i] * before[i];
  double length = correlation_samples(squared);
  for (std::size_t i = 0; i < count; ++i) squared[i] = after[i] * after[i];
  length = std::max(length, correlation_samples(squared));
  // At least eight blocks, or there is nothing to draw from.
  const std::size_t block = std::max<std::size_t>(
      1, std::min<std::size_t>(static_cast<std::size_t>(2.5 * length), (count + 7) / 8));
  const std::size_t blocks = (count + block - 1) / block;
  std::vector<double> sum_before(blocks, 0.0), sum_after(blocks, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    sum_before[i / block] += before[i] * before[i];
    sum_after[i / block] += after[i] * after[i];
  }
  BlockDice dice(seed);
  constexpr int draws = 1000;
  std::vector<double> shrunk;
  shrunk.reserve(draws);
  for (int draw = 0; draw < draws; ++draw) {
    double total_before = 0.0, total_after = 0.0;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t pick = dice.below(blocks);
      total_before += sum_before[pick];
      total_after += sum_after[pick];
    }
    if (total_before > 0.0) shrunk.push_back(1.0 - std::sqrt(total_after / total_before));
  }
  if (shrunk.empty()) return {0.0, 0.0};
  std::sort(shrunk.begin(), shrunk.end());
  const auto quantile = [&](double q) {
    return shrunk[static_cast<std::size_t>(q * static_cast<double>(shrunk.size() - 1))];
  };
  return {quantile(0.025), quantile(0.975)};
}

}  // namespace thermopower::gap
