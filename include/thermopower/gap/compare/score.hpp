// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

namespace thermopower::gap::engine {

/// Errors of a free-running simulation against recordings, signal by signal, in the order of the rows.
struct Errors {
  std::array<std::vector<double>, signal_count> of;         ///< simulated minus measured
  std::array<std::vector<int>, signal_count> segment;       ///< which segment each belongs to
  std::array<std::vector<double>, signal_count> simulated;  ///< simulated value, in the signal's unit
  std::array<std::vector<Eigen::Index>, signal_count> row;  ///< row in the recording of that segment
  double time_constant_s =
      std::numeric_limits<double>::infinity();  ///< of the simulated body; infinite: none is known

  /// Of each of a signal's errors whether it does not follow on the one before it: the first one of each segment.
  std::vector<bool> gaps(Signal signal) const {
    const std::vector<int>& places = segment[static_cast<std::size_t>(signal)];
    std::vector<bool> begins(places.size(), true);
    for (std::size_t i = 1; i < places.size(); ++i) begins[i] = places[i] != places[i - 1];
    return begins;
  }
  /// Root mean square of a signal's errors; 0 without any.
  double rms(Signal signal) const { return rms_of(of[static_cast<std::size_t>(signal)]); }
};

/// Simulates a model as a gap is judged and subtracts what was measured. The rows where the axis restarts
/// from the measured state say nothing and are left out.
/// @param sigma  noise of each signal within which the measured starts of whole runs are fitted; none: they are taken
///               as they are
inline Errors errors_of(const Model& model, const std::vector<Segment>& segments, const Catalogue& catalogue,
                        const std::array<double, signal_count>* sigma = nullptr) {
  Errors errors;
  errors.time_constant_s = model.time_constant_s();
  const Plant& plant = plant_of(model);
  for (std::size_t i = 0; i < signal_count; ++i) {
    std::size_t rows = 0;
    for (const Segment& segment : segments) rows += static_cast<std::size_t>(segment.end - segment.begin);
    if (!segments.empty() && segments.front().inputs->judged(static_cast<Signal>(i)))
      errors.of[i].reserve(rows);
  }
  const auto take = [&](std::size_t index, const Readings& readings) {
    const Segment& segment = segments[index];
    const Inputs& inputs = *segment.inputs;
    assert(segment.begin >= 0 && segment.end <= inputs.rows());
    if (segment.warm_up) return;
    const std::vector<Signal>& signals = plant.signals(segment);
    for (std::size_t k = 0; k < signals.size(); ++k) {
      if (!inputs.judged(signals[k])) continue;
      const std::size_t at = static_cast<std::size_t>(signals[k]);
      for (Eigen::Index row = segment.begin + (segment.axis ? 1 : 0); row < segment.end; ++row) {
        const double measured = inputs.of(signals[k])[row];
        if (!std::isfinite(measured)) continue;
        const double value = readings.value(row, static_cast<int>(k));
        // A simulation that ran away counts as very bad, not as undefined.
        errors.of[at].push_back(std::isfinite(value) ? std::clamp(value - measured, -1e9, 1e9) : 1e9);
        errors.segment[at].push_back(static_cast<int>(index));
        errors.simulated[at].push_back(value);
        errors.row[at].push_back(row);
      }
    }
  };
  simulate_segments(model, catalogue, segments, SimulationMode::free_running, take, sigma);
  return errors;
}

/// Small, fast and the same everywhere: the generator of draws (SplitMix64).
class Dice {
public:
  /// Equal seeds give equal sequences, on every platform.
  explicit Dice(std::uint64_t seed) : state_(seed) {}

  /// A whole number in [0, count).
  std::size_t below(std::size_t count) {
    assert(count > 0);
    return static_cast<std::size_t>(bits() % count);
  }

  /// A number in [0, 1).
  double share() { return static_cast<double>(bits() >> 11) * (1.0 / 9007199254740992.0); }

  /// A number with a normal distribution, mean 0 and variance 1 (Box and Muller).
  double normal() {
    constexpr double per_step = 1.0 / 9007199254740992.0, turn = 6.283185307179586;
    const double above_0 = (static_cast<double>(bits() >> 11) + 1.0) * per_step,
                 angle = static_cast<double>(bits() >> 11) * per_step * turn;
    return std::sqrt(-2.0 * std::log(above_0)) * std::cos(angle);
  }

private:
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t mixed = state_;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
    return mixed ^ (mixed >> 31);
  }

  std::uint64_t state_;
};

/// How far two simulations of the same rows lie apart: root mean squares by signal.
inline std::array<double, signal_count> rms_between(const Errors& one, const Errors& other) {
  std::array<double, signal_count> apart{};
  for (std::size_t i = 0; i < signal_count; ++i) {
    double squares = 0.0;
    const std::size_t count = std::min(one.of[i].size(), other.of[i].size());
    for (std::size_t k = 0; k < count; ++k) squares += std::pow(other.of[i][k] - one.of[i][k], 2.0);
    apart[i] = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
  }
  return apart;
}

/// How far a simulation wanders from itself: root mean squares by signal, 0 without a reason. The reasons are noise of a
/// measured command or heating current, and power of the bench that switched at any time between two rows. One draw, the
/// same each time.
inline std::array<double, signal_count> wander_of_command(const Model& model,
                                                          const std::vector<Segment>& segments,
                                                          const Catalogue& catalogue) {
  std::array<double, signal_count> wander{};
  std::map<const Inputs*, Inputs> noisy;
  Dice dice(1);
  for (const Segment& segment : segments) {
    const Inputs& inputs = *segment.inputs;
    if ((!inputs.errs_in_command() && !inputs.switched_anytime()) || noisy.count(&inputs) > 0) continue;
    Inputs& copy = noisy[&inputs] = inputs;
    // More noise on a current that heats does not add heat.
    if (inputs.current_noise_A > 0.0)
      copy.current_noise_A = std::hypot(copy.current_noise_A, copy.command_noise);
    for (double& share : copy.next_share)  // of its mean; within the interval
      share += (2.0 * dice.share() - 1.0) * std::min(share, 1.0 - share);
    for (Eigen::Index row = 0; row < inputs.rows() && inputs.errs_in_command(); ++row) {
      const UnknownCommand& unknown = inputs.command_unknown;
      const double by = (inputs.command_noise > 0.0 ? inputs.command_noise * dice.normal() : 0.0) +
                        unknown.error(row, unknown.between.size() > 0 ? dice.normal() : 0.0);
      if (copy.drive_A.size() > 0) copy.drive_A[row] += by;
      if (inputs.heat == HeatSource::measured) copy.held_current_A[row] += by;
      if (copy.voltage_V.size() > 0) copy.voltage_V[row] += by;
      if (inputs.heater_answers()) copy.power_param[row] += by;
    }
  }
  if (noisy.empty()) return wander;
  std::vector<Segment> others = segments;
  for (Segment& segment : others)
    if (const auto found = noisy.find(segment.inputs); found != noisy.end()) segment.inputs = &found->second;
  return rms_between(errors_of(model, segments, catalogue), errors_of(model, others, catalogue));
}

/// Noise with what a noisy command adds to it, at most `rms`, which the best simulation leaves: that has both.
inline double with_wander(double noise, double wander, double rms) {
  assert(!(noise < 0.0) && !(rms < 0.0));
  return wander > 0.0 ? std::max(noise, std::min(std::hypot(noise, wander), rms)) : noise;
}

/// The part of an error in one coordinate of a start that another, fitted coordinate takes back. By least squares: units of
/// the latter for one of the former.
/// @param signal  place of that signal among the plant's
inline double taken_back(const Readings& readings, const Segment& segment, int signal, int coordinate,
                         int fitted) {
  double product = 0.0, square = 0.0;
  for (Eigen::Index row = segment.begin; row < segment.end; ++row) {
    const double with = readings.slope(row, signal, fitted);
    product += with * readings.slope(row, signal, coordinate);
    square += with * with;
  }
  return square > 0.0 ? product / square : 0.0;
}

/// The starts of the whole runs that a floor is for.
enum class FirstReadings {
  within_their_noise,  ///< where a start within their noise fits best
  as_they_are          ///< the readings themselves
};

/// The error of the measured start of a whole run, by the model and the first readings; 0 if it is no more than noise. A
/// perfect model simulates on from that.
/// @param sd  noise of the start
inline Start known_off(const Plant& plant, Rollout& rollout, const Segment& segment,
                       const std::array<double, signal_count>& sigma, const Start& sd) {
  constexpr double more_than_noise = 2.0;
  Start off = Start::Zero(sd.size());
  if (segment.axis || !begins_off(plant, segment)) return off;
  const Start fitted = start_of(plant, rollout, segment, &sigma);
  assert(fitted.size() == sd.size());
  for (Eigen::Index i = 0; i < sd.size(); ++i)
    if (sd[i] > 0.0 && std::abs(fitted[i]) > more_than_noise * sd[i]) off[i] = std::abs(fitted[i]);
  return off;
}

/// The score of a perfect model: the signal's own noise, and the noise of the measured state it starts from, carried
/// through the model. The part of that state that nobody measures is fitted, and takes a part of the error back. If a
/// window starts at a wrong angle, a slightly wrong rate leaves a quarter of the mean square.
inline std::array<double, signal_count> noise_floor(const Model& model, const std::vector<Segment>& segments,
                                                    const std::array<double, signal_count>& sigma,
                                                    const Catalogue& catalogue, FirstReadings first) {
  const Plant& plant = plant_of(model);
  std::array<double, signal_count> sum{}, count{};
  Readings readings;
  const auto rollout = plant.rollout(model, catalogue, {}, {0, largest_start_size(plant, segments)},
                                     SimulationMode::free_running);
  for (Segment segment : segments) {
    segment.carries_on = false;
    const Inputs& inputs = *segment.inputs;
    Start sd = rollout->measured_start_sd(segment, sigma);
    if (first == FirstReadings::as_they_are) sd = sd.cwiseMax(known_off(plant, *rollout, segment, sigma, sd));
    rollout->roll(segment, Start::Zero(sd.size()), readings);
    const std::vector<Signal>& signals = plant.signals(segment);
    Start back = Start::Zero(sd.size());
    int fitted = 0;
    for (const HiddenStart& hidden :
         segment.axis ? rollout->hidden_starts(segment) : std::vector<HiddenStart>()) {
      const auto shows = std::find(signals.begin(), signals.end(), hidden.shows_in);
      fitted = hidden.coordinate;
      for (int i = 0; i < sd.size() && shows != signals.end(); ++i)
        back[i] = taken_back(readings, segment, static_cast<int>(shows - signals.begin()), i, fitted);
    }
    for (Eigen::Index row = segment.begin + (segment.axis ? 1 : 0); row < segment.end; ++row)
      for (std::size_t k = 0; k < signals.size(); ++k) {
        const std::size_t at = static_cast<std::size_t>(signals[k]);
        if (!inputs.judged(signals[k]) || !std::isfinite(inputs.of(signals[k])[row])) continue;
        double variance = sigma[at] * sigma[at];
        for (Eigen::Index i = 0; i < sd.size(); ++i) {
          const auto slope = [&](Eigen::Index coordinate) {
            return readings.slope(row, static_cast<int>(k), static_cast<int>(coordinate));
          };
          const double carried = (slope(i) - back[i] * slope(fitted)) * sd[i];
          variance += carried * carried;
        }
        sum[at] += variance;
        count[at] += 1.0;
      }
  }
  std::array<double, signal_count> floor{};
  for (std::size_t i = 0; i < signal_count; ++i)
    floor[i] = count[i] > 0.0 ? std::sqrt(sum[i] / count[i]) : 0.0;
  return floor;
}

/// The score of a perfect model that carries states nobody measures from window to window. The noise of all earlier starts
/// counts there, and if sides meet and part, it grows with each blow. Root mean squares by signal, 0 where nothing is
/// carried on; the noise is drawn once, the same each time.
inline std::array<double, signal_count> wander_of_starts(const Model& model,
                                                         const std::vector<Segment>& segments,
                                                         const std::array<double, signal_count>& sigma,
                                                         const Catalogue& catalogue) {
  std::array<double, signal_count> wander{};
  const auto rollout = plant_of(model).rollout(model, catalogue, {}, {}, SimulationMode::free_running);
  if (!rollout->carries_states()) return wander;
  std::map<const Inputs*, Inputs> noisy;
  Dice dice(2);
  for (const Segment& segment : segments) {
    const Inputs& inputs = *segment.inputs;
    if (!segment.axis || noisy.count(&inputs) > 0) continue;
    Inputs& copy = noisy[&inputs] = inputs;
    for (const Signal signal : {Signal::angle_deg, Signal::rate_dps}) {
      const auto at = static_cast<std::size_t>(signal);
      if (!inputs.judged(signal)) continue;
      for (Eigen::Index row = 0; row < inputs.rows(); ++row)
        copy.measured[at][row] += sigma[at] * dice.normal();
    }
  }
  if (noisy.empty()) return wander;
  std::vector<Segment> others = segments;
  for (Segment& segment : others)
    if (const auto found = noisy.find(segment.inputs); found != noisy.end()) segment.inputs = &found->second;
  return rms_between(errors_of(model, segments, catalogue), errors_of(model, others, catalogue));
}

/// Factor to which a floor is known in a few hundred samples.
inline constexpr double floor_known_to = 1.2;

/// The score of a perfect model if a command may be noisy, too. The best simulation is no better than a perfect one: a floor above
/// what it scores by more than floors are known to is too high, and comes down to that.
/// @param errors  of the best simulation  @param sigma  noise of the signals
/// @param first   what the simulations begin with that it is for
inline std::array<double, signal_count> floor_of(const Model& best, const Errors& errors,
                                                 const std::array<double, signal_count>& sigma,
                                                 const std::vector<Segment>& segments,
                                                 const Catalogue& catalogue, FirstReadings first) {
  std::array<double, signal_count> floor = noise_floor(best, segments, sigma, catalogue, first);
  const std::array<double, signal_count> wander = wander_of_command(best, segments, catalogue);
  const std::array<double, signal_count> carried = wander_of_starts(best, segments, sigma, catalogue);
  for (std::size_t i = 0; i < signal_count; ++i) {
    const double rms = errors.rms(static_cast<Signal>(i));
    floor[i] = with_wander(std::max(floor[i], std::min(carried[i], rms)), wander[i], rms);
    if (rms > 0.0) floor[i] = std::min(floor[i], floor_known_to * rms);
  }
  return floor;
}

/// The scatter of the logarithm of a shrinkage between two days, which no single recording can show: a standard half-width.
inline constexpr double between_days = 0.15;

/// 95 % interval of 1 - rms(after) / rms(before), for recordings like this one, by a paired block bootstrap.
///
/// Both simulations' squared errors are drawn in the same six long blocks. Sixths of a recording show slow changes that
/// shorter blocks average away. The logarithm of the ratio varies evenly. Its deviations are widened as Student's t asks
/// with so few blocks, and by a seventh (0.15) for the difference between two days.
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
  Dice dice(seed);
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
    const double student = 2.571 / 1.960 * std::sqrt(6.0 / 5.0);
    const double by = ratios[static_cast<std::size_t>(quantile * (draws - 1))] - middle;
    return middle + std::copysign(std::hypot(student * by, between_days), quantile - 0.5);
  };
  const Interval interval{1.0 - std::exp(widened(0.975)), 1.0 - std::exp(widened(0.025))};
  assert(!(interval.low > interval.high));
  return interval;
}

}  // namespace thermopower::gap::engine
