// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/gap/data/noise.hpp>
#include <thermopower/gap/report/score.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// @file noise_of_errors.hpp
/// The noise in what a simulation misses recordings by.

namespace thermopower::gap::engine {

/// The coarsest quantum of a signal among recordings; 0 where none has it.
inline double coarsest_quantum(const std::vector<Inputs>& inputs, Signal signal) {
  double quantum = 0.0;
  for (const Inputs& one : inputs)
    if (one.judged(signal)) quantum = std::max(quantum, quantum_of(one.of(signal)));
  return quantum;
}

/// Noise of a rate that lasts over more than a few rows, as the angle beside it tells it: standard deviation, nothing where there
/// is too little to tell. Whatever a model lacks moves both, and what the rate's errors say in the mean of a few rows beyond
/// the slope of the angle's is noise of the sensors'. What lasts is what neighbouring means, which share no reading, have in common;
/// it was larger at the first of them by what it loses from one to the next.
inline std::optional<double> lasting_rate_noise(const Errors& errors, const std::vector<Segment>& segments) {
  constexpr auto angle = static_cast<std::size_t>(Signal::angle_deg),
                 rate = static_cast<std::size_t>(Signal::rate_dps);
  constexpr std::size_t together = 5;
  constexpr double enough = 100.0;
  struct Row {
    int segment;
    Eigen::Index row;
    double angle, rate;
  };
  std::vector<Row> rows;
  for (std::size_t i = 0, k = 0; i < errors.of[rate].size(); ++i) {
    const auto place = [&](std::size_t signal, std::size_t at) {
      return std::make_pair(errors.segment[signal][at], errors.row[signal][at]);
    };
    while (k < errors.of[angle].size() && place(angle, k) < place(rate, i)) ++k;
    if (k < errors.of[angle].size() && place(angle, k) == place(rate, i))
      rows.push_back({errors.segment[rate][i], errors.row[rate][i], errors.of[angle][k], errors.of[rate][i]});
  }
  // By how much the mean rate of some rows is beyond the slope of the angle; NaN where they do not follow on each other.
  std::vector<double> beyond(rows.size(), std::nan(""));
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i + together <= rows.size(); ++i) {
    const Row &first = rows[i], &last = rows[i + together - 1];
    if (first.segment != last.segment || last.row - first.row != static_cast<Eigen::Index>(together - 1))
      continue;
    const Eigen::VectorXd& t_s = segments[static_cast<std::size_t>(first.segment)].inputs->t_s;
    double went = 0.0;
    for (std::size_t k = i; k + 1 < i + together; ++k)
      went += 0.5 * (rows[k].rate + rows[k + 1].rate) * (t_s[rows[k + 1].row] - t_s[rows[k].row]);
    beyond[i] = (went - (last.angle - first.angle)) / (t_s[last.row] - t_s[first.row]);
    sum += beyond[i], count += 1.0;
  }
  const auto in_common = [&](std::size_t apart) -> std::optional<double> {
    double product = 0.0, pairs = 0.0;
    for (std::size_t i = 0; i + apart < rows.size(); ++i) {
      const double both = (beyond[i] - sum / count) * (beyond[i + apart] - sum / count);
      if (std::isfinite(both) && rows[i].segment == rows[i + apart].segment) product += both, pairs += 1.0;
    }
    if (pairs < enough) return std::nullopt;
    return product / pairs;
  };
  const std::optional<double> next = in_common(together), after = in_common(2 * together);
  if (!next) return std::nullopt;
  if (!(*next > 0.0)) return 0.0;
  constexpr double loses = 1.7;  // what an AR(1) of 0.9 does
  return std::sqrt(*next * (after && *after > 0.0 ? std::clamp(*next / *after, 1.0, loses) : 1.0));
}

/// Noise of every signal in a simulation's errors. The error of a wrong model jumps where the power does: a current's errors
/// are compared where it has the same voltage, whatever was between. A sweep has another one in every row, and neighbours
/// alone would not tell how long the noise remembers.
inline std::array<NoiseEstimate, signal_count> noise_estimates_of(const Errors& errors,
                                                                  const std::vector<Segment>& segments,
                                                                  const std::vector<Inputs>& inputs) {
  std::array<NoiseEstimate, signal_count> noise{};
  for (std::size_t i = 0; i < signal_count; ++i) {
    const std::size_t count = errors.of[i].size();
    std::vector<bool> gaps(count, false);
    std::vector<double> levels, measured;  // the latter of an axis: what drives it is integrated twice
    for (std::size_t k = 0; k < count; ++k) {
      const int segment = errors.segment[i][k];
      gaps[k] = k > 0 && segment != errors.segment[i][k - 1];
      const Segment& of = segments[static_cast<std::size_t>(segment)];
      const Eigen::VectorXd& power = of.inputs->power_param;
      if (of.axis) measured.push_back(errors.simulated[i][k] - errors.of[i][k]);
      if (power.size() > 0 && static_cast<Signal>(i) == Signal::current_A)
        levels.push_back(
            v_rms_from_duty<double>(1.0, duty_from_power(std::clamp(power[errors.row[i][k]], 0.0, 255.0))));
    }
    if (levels.size() < count) levels.clear();
    if (measured.size() < count) measured.clear();
    const auto signal = static_cast<Signal>(i);
    noise[i] = noise_of_sequence(errors.of[i], gaps, coarsest_quantum(inputs, signal), levels, measured);
    // A handful of readings tells no noise from an error: all of it may be noise.
    if (count < NoiseThresholds().least_pairs) noise[i].sd = noise[i].by_chance = errors.rms(signal);
  }
  NoiseEstimate& of_rate = noise[static_cast<std::size_t>(Signal::rate_dps)];
  if (const std::optional<double> lasting = lasting_rate_noise(errors, segments)) {
    constexpr double at_most = 2.0;  // times what the angle tells: some hundred rows know it to a third
    of_rate.sd = std::max(of_rate.sd, std::min(*lasting, of_rate.by_chance));
    of_rate.by_chance = std::max(of_rate.sd, std::min(of_rate.by_chance, at_most * *lasting));
  }
  return noise;
}

/// Standard deviations of the noise of every signal.
inline std::array<double, signal_count> sd_of(const std::array<NoiseEstimate, signal_count>& noise) {
  std::array<double, signal_count> sigma{};
  for (std::size_t i = 0; i < signal_count; ++i) sigma[i] = noise[i].sd;
  return sigma;
}

/// Standard deviation of the noise of every signal in a simulation's errors.
inline std::array<double, signal_count> noise_of(const Errors& errors, const std::vector<Segment>& segments,
                                                 const std::vector<Inputs>& inputs) {
  return sd_of(noise_estimates_of(errors, segments, inputs));
}

}  // namespace thermopower::gap::engine
