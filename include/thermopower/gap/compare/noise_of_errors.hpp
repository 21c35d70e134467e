// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/compare/rate_beside_angle.hpp>
#include <thermopower/gap/compare/score.hpp>

#include <algorithm>
#include <array>
#include <cassert>
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

/// The longest memory from one row to the next that noise of a thermometer has: over a quarter of its body's time constant it is
/// forgotten. What lasts longer is heat that the model gets wrong, even if slow rows make it look rough.
inline double memory_beside_body(const Errors& errors, const std::vector<Segment>& segments) {
  constexpr auto at = static_cast<std::size_t>(Signal::motor_C);
  constexpr double of_time_constant = 0.25;
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < errors.row[at].size(); ++i) {
    if (errors.segment[at][i] != errors.segment[at][i - 1]) continue;
    const Eigen::VectorXd& t_s = segments[static_cast<std::size_t>(errors.segment[at][i])].inputs->t_s;
    steps_s.push_back(t_s[errors.row[at][i]] - t_s[errors.row[at][i - 1]]);
  }
  if (steps_s.empty()) return 1.0;
  return std::exp(-median_of(steps_s) / (of_time_constant * errors.time_constant_s));
}

/// The most that noise can be in a signal's errors, by what else is known of it.
inline MostNoise most_noise_of(Signal signal, const Errors& errors, const std::vector<Segment>& segments,
                               const RateBesideAngle::Most& of_motion) {
  MostNoise most = of_motion.of(signal);
  if (signal == Signal::motor_C && std::isfinite(errors.time_constant_s))
    most.longest_memory = memory_beside_body(errors, segments);
  return most;
}

/// Noise of every signal in a simulation's errors. The error of a wrong model jumps where the power does: a current's errors
/// are compared where it has the same voltage, whatever was between. A sweep has another one in every row, and neighbours
/// alone would not tell how long the noise remembers.
inline std::array<NoiseEstimate, signal_count> noise_estimates_of(const Errors& errors,
                                                                  const std::vector<Segment>& segments,
                                                                  const std::vector<Inputs>& inputs) {
  std::array<NoiseEstimate, signal_count> noise{};
  const RateBesideAngle both(errors, segments);
  const RateBesideAngle::Most of_motion = both.most_noise();
  for (std::size_t i = 0; i < signal_count; ++i) {
    const std::size_t count = errors.of[i].size();
    assert(errors.segment[i].size() == count && errors.row[i].size() == count);
    std::vector<double> levels, measured;  // the latter where what drives it is integrated
    for (std::size_t k = 0; k < count; ++k) {
      const Segment& of = segments[static_cast<std::size_t>(errors.segment[i][k])];
      const Eigen::VectorXd& power = of.inputs->power_param;
      if (of.axis || (static_cast<Signal>(i) == Signal::motor_C && std::isfinite(errors.time_constant_s)))
        measured.push_back(errors.simulated[i][k] - errors.of[i][k]);
      if (power.size() > 0 && static_cast<Signal>(i) == Signal::current_A)
        levels.push_back(
            v_rms_from_duty<double>(1.0, duty_from_power(std::clamp(power[errors.row[i][k]], 0.0, 255.0))));
    }
    if (levels.size() < count) levels.clear();
    if (measured.size() < count) measured.clear();
    const auto signal = static_cast<Signal>(i);
    noise[i] = noise_of_sequence(errors.of[i], errors.gaps(signal), coarsest_quantum(inputs, signal), levels,
                                 measured, most_noise_of(signal, errors, segments, of_motion));
    // A handful of readings tells no noise from an error: all of it may be noise.
    if (count < NoiseThresholds().least_pairs) noise[i].sd = noise[i].by_chance = errors.rms(signal);
  }
  NoiseEstimate& of_rate = noise[static_cast<std::size_t>(Signal::rate_dps)];
  if (const std::optional<double> lasting = both.lasting_noise()) {
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
