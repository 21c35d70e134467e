// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/data/noise.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thermopower::gap {

/// Errors of a free-running simulation against recordings, signal by signal, in the order of the rows.
struct Errors {
  std::array<std::vector<double>, signal_count> of;         ///< simulated minus measured
  std::array<std::vector<int>, signal_count> segment;       ///< which segment each belongs to
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

/// 95 % interval of 1 - rms(after) / rms(before), for recordings like this one, by a paired block bootstrap.
///
/// Both simulations' squared errors are drawn in the same six long blocks: how much sixths of a recording
/// differ tells of slow changes that shorter blocks average away. The logarithm of the ratio is what varies
/// evenly; its deviations are widened as Student's t asks with so few blocks, and by a seventh (0.15) for
/// what no single recording can show, the difference between two days.
/// @return {0, 0} where both are the same or there are no errors
inline Interval shrinkage_interval(const std::vector<double>& before, const std::vector<double>& after,
                                   unsigned seed) {
  const std::size_t count = before.size();
  if (count == 0 || after.size() != count || before == after) return {0.0, 0.0};
  const std::size_t blocks = std::min<std::size_t>(count, 6);
  std::vector<double> sum_before(blocks, 0.0), sum_after(blocks, 0.0);
  double all_before = 0.0, all_after = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t block = i * blocks / count;
    sum_before[block] += before[i] * before[i];
    sum_after[block] += after[i] * after[i];
    all_before += before[i] * before[i];
    all_after += after[i] * after[i];
  }
  const double least = 1e-30;
  const auto half_log = [least](double above, double below) {
    return 0.5 * std::log(std::max(above, least) / std::max(below, least));
  };
  BlockDice dice(seed);
  constexpr int draws = 1000;
  std::vector<double> ratios;
  ratios.reserve(draws);
  for (int draw = 0; draw < draws; ++draw) {
    double total_before = 0.0, total_after = 0.0;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::size_t pick = dice.below(blocks);
      total_before += sum_before[pick];
      total_after += sum_after[pick];
    }
    ratios.push_back(half_log(total_after, total_before));
  }
  std::sort(ratios.begin(), ratios.end());
  const double middle = half_log(all_after, all_before);
  const auto widened = [&](double quantile) {
    // 2.571 / 1.960: t with five degrees of freedom against the normal; 6/5: a bootstrap of six is too
    // narrow.
    const double student = 2.571 / 1.960 * std::sqrt(6.0 / 5.0), between_days = 0.15;
    const double by = ratios[static_cast<std::size_t>(quantile * (draws - 1))] - middle;
    return middle + std::copysign(std::hypot(student * by, between_days), quantile - 0.5);
  };
  return {1.0 - std::exp(widened(0.975)), 1.0 - std::exp(widened(0.025))};
}

}  // namespace thermopower::gap
