// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/columns.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace thermopower::gap::engine {

/// How the noise of a residual is told from the error of a model, by the variogram: half the mean square of the
/// differences over a lag. Noise loses its memory fast (white noise at once, an AR(1) of 0.95 within some 20 samples)
/// and is rough: its variogram is as steep at the first lag as it ever gets. The error of a model is smooth, its
/// variogram starts with the square of the lag; or it jumps where an input does, or something hits something, which is rare
/// or slow. Between such jumps it is smooth, and noise is not: the third differences of most samples bound it.
/// Held by tests/gap/observe/noise_test.cpp.
struct NoiseThresholds {
  double farthest =
      8.0;  ///< robust scales of a lag's differences beyond which one counts as a jump of its own
  double pairs_per_lag = 4000.0;  ///< differences looked at for one lag
  std::size_t least_pairs = 12;   ///< a lag with fewer tells nothing
  std::size_t block = 150;        ///< samples that have a scale of their own (runs differ)
  double known_shape = 0.03;      ///< relative error of a variogram's values however many samples there are
  double part_penalty = 2.0;      ///< by which a further part must lower the weighted squares (Akaike)
  double quanta = 2.5;            ///< quanta up to which a difference is no jump
  double same_level = 0.01;       ///< by which levels may differ that are the same, where the largest is 1
  double as_likely =
      6.0;  ///< penalised squares by which a sum may be behind the best: two and a half standard errors
  double rough = 2.0;   ///< times the usual scale of third differences up to which those of noise may be
  double smooth = 0.7;  ///< times the scale of the least of them that those of noise have at least
  double standard_errors = 2.6;  ///< of a mean square: one-sided 99.5 %, as several signals are asked twice
  double uncorrelated = 0.05;    ///< autocorrelation below which samples are taken for independent
  std::size_t least_for_correlation = 8;  ///< samples; fewer count one by one
};

/// Memories of noise from one sample to the next that are looked for; what remembers longer is the error of a model.
inline constexpr std::array<double, 7> noise_memories = {0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97};

/// How much noise a residual can have at most, by what else is known of it: over stretches of several lengths something was seen
/// that noise in the residual adds to.
struct MostNoise {
  /// Stretches of one length.
  struct Stretch {
    double squares = 0.0;  ///< mean square of what was seen over them, at most
    std::array<double, noise_memories.size()> of_noise{};  ///< that noise of variance 1 adds, by its memory
  };
  std::vector<Stretch> stretches;  ///< none: nothing is known
  double longest_memory = 1.0;     ///< from one sample to the next, 0..1; noise that remembers longer is none

  /// Variance of noise of a memory beside white noise, at most; infinite where nothing is known.
  double beside(double white, std::size_t memory) const {
    double most = std::numeric_limits<double>::infinity();
    for (const Stretch& one : stretches)
      most = std::min(most, (one.squares - white * one.of_noise[0]) / one.of_noise[memory]);
    return std::max(most, 0.0);
  }
};

/// The noise in a residual.
struct NoiseEstimate {
  double sd = 0.0;  ///< standard deviation; 0 of too few samples, never more than the root mean square of all
  double by_chance = 0.0;  ///< root mean square up to which the residual may be noise alone
};

/// Factor by which the noise of a mean of samples is larger than that of as many independent ones, at most: an AR(1)'s.
inline double most_of_a_mean() {
  return std::sqrt((1.0 + noise_memories.back()) / (1.0 - noise_memories.back()));
}

/// Minimises |A x - y|^2 over x >= 0 for a handful of columns, by cyclic coordinate descent.
inline Eigen::VectorXd non_negative_fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
  assert(columns.rows() == y.size());
  constexpr int sweeps = 200;
  const Eigen::MatrixXd square = gram(columns);
  const Eigen::VectorXd right = transposed_times(columns, y);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(columns.cols());
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (Eigen::Index k = 0; k < columns.cols(); ++k)
      if (square(k, k) > 0.0) x[k] = std::max(0.0, x[k] + (right[k] - square.col(k).dot(x)) / square(k, k));
  return x;
}

/// Noise in a variogram.
struct VariogramNoise {
  double variance = 0.0;       ///< the mean over all sums
  double most = 0.0;           ///< the largest among those that are as likely
  double squares_alike = 1.0;  ///< samples of that one whose squares count as one
};

/// Mean square of the third differences of noise of variance 1. @param memory  from one sample to the next
inline double third_differences(double memory) {
  return 20.0 - memory * (30.0 - memory * (12.0 - 2.0 * memory));
}

/// Magnitude of the third differences of a sequence that a share of them is below, over that of normal noise of scale 1.
/// Samples that are held have none and do not count.
/// @param since   of each sample, how many before it follow on each other
/// @param share   0..1
/// @param normal  magnitude that this share of a standard normal distribution is below
/// @return 0 where there are too few
inline double third_difference_scale(const std::vector<double>& sequence, const std::vector<int>& since,
                                     double share, double normal) {
  std::vector<double> sizes;
  for (std::size_t i = 3; i < sequence.size(); ++i) {
    const double size = std::abs(sequence[i] - 3.0 * (sequence[i - 1] - sequence[i - 2]) - sequence[i - 3]);
    if (since[i] >= 3 && size > 0.0) sizes.push_back(size);
  }
  return sizes.size() < NoiseThresholds().least_pairs ? 0.0 : quantile_of(sizes, share) / normal;
}

/// Variance of the noise in a variogram: the mean over all sums of white noise, one AR(1) and one error of a model
/// (smooth of one width, or slow), weighted by how well each fits for its number of parts (Akaike weights).
/// @param lags       in samples, ascending
/// @param variogram  there, > 0
/// @param weights    of the relative errors there
/// @param roughness  mean square that third differences of the noise have at most
/// @param most       in the same units; what is beyond it is an error
inline VariogramNoise noise_of_variogram(const std::vector<double>& lags,
                                         const std::vector<double>& variogram,
                                         const std::vector<double>& weights, double roughness,
                                         const MostNoise& most = {}) {
  constexpr NoiseThresholds limit;
  const auto rows = static_cast<Eigen::Index>(lags.size());
  assert(variogram.size() == lags.size() && weights.size() == lags.size());
  const auto shape = [&](auto&& function) {
    Eigen::VectorXd column(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      column[i] = function(lags[at]) / variogram[at] * std::sqrt(weights[at]);
    }
    return column;
  };
  std::vector<Eigen::VectorXd> noises, errors;
  // Widths of a model's errors in samples.
  constexpr double widths[] = {4.0, 6.0, 9.0, 13.0, 20.0, 30.0, 45.0, 68.0, 100.0, 400.0};
  for (const double memory : noise_memories)
    noises.push_back(shape([&](double lag) { return 1.0 - std::pow(memory, lag); }));
  for (const double width : widths)
    errors.push_back(shape([&](double lag) { return 1.0 - std::exp(-lag * lag / (width * width)); }));
  errors.push_back(shape([](double lag) { return lag; }));
  const Eigen::VectorXd wanted = shape([&, i = std::size_t{0}](double) mutable { return variogram[i++]; });
  std::vector<double> costs, variances, alike;
  for (std::size_t k = 0; k < noises.size(); ++k) {
    if (k > 0 && noise_memories[k] > most.longest_memory) continue;
    for (std::size_t e = 0; e <= errors.size(); ++e) {
      const Eigen::VectorXd none = Eigen::VectorXd::Zero(rows);
      const Eigen::MatrixXd columns =
          plant::columns_of({noises[0], k == 0 ? none : noises[k], e < errors.size() ? errors[e] : none});
      const Eigen::VectorXd parts = non_negative_fit(columns, wanted);
      const double cost = (columns * parts - wanted).squaredNorm() +
                          limit.part_penalty * static_cast<double>((parts.array() > 0.0).count());
      costs.push_back(cost);
      const double remembering = std::min(parts[1], most.beside(parts[0], k)),
                   of_rough =
                       third_differences(0.0) * parts[0] + third_differences(noise_memories[k]) * remembering;
      variances.push_back((parts[0] + remembering) * (of_rough > roughness ? roughness / of_rough : 1.0));
      // Squares of Gaussian samples correlate as the squares of the samples' correlation (Isserlis).
      const double remembered = variances.back() > 0.0 ? remembering / variances.back() : 0.0,
                   square = noise_memories[k] * noise_memories[k];
      alike.push_back(1.0 + 2.0 * remembered * remembered * square / (1.0 - square));
    }
  }
  const double least = *std::min_element(costs.begin(), costs.end());
  VariogramNoise noise;
  double total = 0.0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const double share = std::exp(-0.5 * (costs[i] - least));
    noise.variance += share * variances[i];
    total += share;
    if (costs[i] <= least + limit.as_likely && variances[i] > noise.most)
      noise.most = variances[i], noise.squares_alike = alike[i];
  }
  noise.variance /= total;
  return noise;
}

/// Squares of the differences over one lag, in units of the blocks' scales, without jumps.
/// @param alike  (i, k) -> whether two samples may be compared
template <class Alike>
double half_mean_square(const std::vector<double>& scaled, const std::vector<int>& since_gap, int lag,
                        double least_jump, std::size_t& pairs, Alike&& alike) {
  constexpr NoiseThresholds limit;
  constexpr double normal_quartile = 0.6745;  // of a standard normal distribution: its median magnitude
  std::vector<double> sizes;
  const std::size_t stride = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(scaled.size()) / limit.pairs_per_lag));
  const auto back = static_cast<std::size_t>(lag);
  for (std::size_t i = back; i < scaled.size(); i += stride)
    if (since_gap[i] >= lag && alike(i, i - back)) sizes.push_back(std::abs(scaled[i] - scaled[i - back]));
  std::vector<double> sorted = sizes;
  const double scale = median_of(sorted) / normal_quartile;
  double sum = 0.0;
  pairs = 0;
  for (const double size : sizes)
    if (!(size > std::max(limit.farthest * scale, least_jump)) || !(scale > 0.0)) sum += size * size, ++pairs;
  return pairs > 0 ? 0.5 * sum / static_cast<double>(pairs) : 0.0;
}

/// Whether two samples are at the same level.
inline bool are_alike(const std::vector<double>& levels, std::size_t i, std::size_t k) {
  assert(i < levels.size() && k < levels.size());
  return std::abs(levels[i] - levels[k]) <= NoiseThresholds().same_level;
}

/// Whether neighbours at different levels differ by more than those at the same one, medians, beyond two standard errors.
/// Where they do not, nothing jumps there, and all samples may be compared: those that come back to a level may be few, and
/// at the ends of a sweep only.
inline bool jumps_with(const std::vector<double>& levels, const std::vector<double>& sequence,
                       const std::vector<int>& since_gap) {
  if (levels.empty()) return false;
  std::vector<double> same, apart;
  for (std::size_t i = 1; i < sequence.size(); ++i)
    if (since_gap[i] > 0)
      (are_alike(levels, i, i - 1) ? same : apart).push_back(std::abs(sequence[i] - sequence[i - 1]));
  if (same.empty() || apart.empty()) return !apart.empty();
  constexpr double of_a_median =
      1.17;  // its relative standard error times the root of the samples, of normal magnitudes
  const double error = of_a_median * std::sqrt(1.0 / static_cast<double>(same.size()) +
                                               1.0 / static_cast<double>(apart.size()));
  return median_of(apart) > (1.0 + 2.0 * error) * median_of(same);
}

/// Of each sample, how many before it follow on each other. @param starts  samples that follow on none
inline std::vector<int> since_start(const std::vector<bool>& starts) {
  std::vector<int> since(starts.size(), 0);
  for (std::size_t i = 1; i < starts.size(); ++i) since[i] = starts[i] ? 0 : since[i - 1] + 1;
  return since;
}

/// The noise in a residual: white, coloured up to an AR(1) of 0.97, with heavy tails, other in other parts of the sequence; without
/// what a wrong model leaves.
///
/// A variogram of differences, each scaled by its block's own robust scale, is fitted by non-negative least squares as
/// a sum of noise (white, AR(1) of 0.5 to 0.97) and of what is none (smooth errors, slow ones); see
/// @ref NoiseThresholds. Cressie, Statistics for Spatial Data (1993), sections 2.4 and 2.6.
///
/// Of the sums that explain the variogram as well (NoiseThresholds::as_likely), the one with the most noise says how large the
/// residual may be by chance. Its mean square over so few samples may be larger the longer it remembers (one-sided 99.5 %).
/// White noise knows itself; a few hundred samples of noise that remembers twenty know it to a third.
/// @param sequence  residuals in order
/// @param gaps      as long; `gaps[i]` true: entry i does not follow on entry i-1
/// @param quantum   of the measured channel, 0 where it has none; a rounded channel has at least the noise of rounding
/// @param levels    as long, or empty: of what the error of a model jumps with; samples at levels farther apart than
///                  NoiseThresholds::same_level tell nothing of each other, those at the same level do across the jumps
/// @param measured  as long, or empty: what was measured, where the simulation has no noise of its own; what noise there is
///                  is in it, too, and where it is smooth there is little
/// @param most      of noise that remembers; white noise is as large as the residual says
inline NoiseEstimate noise_of_sequence(const std::vector<double>& sequence, const std::vector<bool>& gaps,
                                       double quantum = 0.0, const std::vector<double>& levels = {},
                                       const std::vector<double>& measured = {}, const MostNoise& most = {}) {
  constexpr NoiseThresholds limit;
  const std::size_t count = sequence.size();
  if (count < limit.least_pairs) return {};
  std::vector<int> since_gap = since_start(gaps);
  const int longest = *std::max_element(since_gap.begin(), since_gap.end());
  const bool jumps = jumps_with(levels, sequence, since_gap);
  const auto alike = [&](std::size_t i, std::size_t k) { return !jumps || are_alike(levels, i, k); };
  // Each block in units of its own scale; the mean square of the scales brings the units back.
  const std::size_t blocks = std::max<std::size_t>(1, count / limit.block);
  const auto begin_of = [&](std::size_t block) { return block * count / blocks; };
  std::vector<double> scales(blocks, 0.0);
  for (std::size_t b = 0; b < blocks; ++b) {
    std::vector<double> steps;
    for (std::size_t i = begin_of(b) + 1; i < begin_of(b + 1); ++i)
      if (since_gap[i] > 0 && alike(i, i - 1)) steps.push_back(std::abs(sequence[i] - sequence[i - 1]));
    scales[b] = median_of(steps);
  }
  // In coarse steps most neighbours read nearly the same and some a step more: the median tells nothing of those, and no block
  // has a smaller scale than a step.
  std::vector<double> typical = scales;
  const double usual = median_of(typical);
  std::vector<double> scaled = sequence, measured_scaled = measured;
  std::vector<bool> starts = gaps;
  double squares = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const double scale = std::max(scales[b] > 0.0 ? scales[b] : usual, quantum);
    if (!(scale > 0.0)) continue;
    const std::size_t from = begin_of(b), to = begin_of(b + 1);
    for (std::size_t i = from; i < to; ++i) scaled[i] /= scale;
    for (std::size_t i = from; i < to && !measured.empty(); ++i) measured_scaled[i] /= scale;
    squares += scale * scale * static_cast<double>(to - from) / static_cast<double>(count);
    starts[from] = true;  // in other units than what comes before
  }
  since_gap = since_start(starts);
  double mean_square = 0.0;
  for (const double value : sequence) mean_square += value * value / static_cast<double>(count);
  const double rounding = std::min(quantum / std::sqrt(12.0), std::sqrt(mean_square));
  if (!(squares > 0.0)) return {std::sqrt(mean_square), std::sqrt(mean_square)};
  std::vector<double> lags, variogram, weights;
  for (const int lag : {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64}) {
    if (lag > std::max(longest / 2, 1)) break;
    std::size_t pairs = 0;
    const double value =
        half_mean_square(scaled, since_gap, lag, limit.quanta * quantum / std::sqrt(squares), pairs, alike);
    if (pairs < limit.least_pairs) {
      if (jumps) continue;  // of levels that a sweep goes through neighbours are rarely alike
      break;
    }
    lags.push_back(lag);
    variogram.push_back(std::max(value, 1e-300));
    // Neighbouring pairs share their samples: about n / lag of them are independent, where levels leave so many.
    double independent = static_cast<double>(count) / lag;
    if (jumps) independent = std::min(independent, static_cast<double>(pairs));
    weights.push_back(1.0 / (limit.known_shape * limit.known_shape + 2.0 / independent));
  }
  if (lags.empty()) return {std::sqrt(mean_square), std::sqrt(mean_square)};
  // Twice the usual third difference of the measurement bounds the noise. The least fifth of those of the error are noise
  // wherever the error of a model is smooth.
  std::vector<int> since_jump = since_gap;
  for (std::size_t i = 1; i < count && jumps; ++i)
    since_jump[i] = are_alike(levels, i, i - 1) ? std::min(since_gap[i], since_jump[i - 1] + 1) : 0;
  const double usual_rough = third_difference_scale(measured_scaled, since_jump, 0.5, 0.6745);
  // Of a channel in coarse steps most may be 0: rounding is noise, too.
  const double rough = usual_rough > 0.0 ? std::pow(limit.rough * usual_rough, 2.0) +
                                               third_differences(0.0) * std::pow(0.6 * quantum, 2.0) / squares
                                         : std::numeric_limits<double>::infinity();
  const double smooth =
      std::pow(limit.smooth * third_difference_scale(scaled, since_jump, 0.2, 0.2533), 2.0) /
      third_differences(0.0);
  MostNoise most_scaled = most;
  for (MostNoise::Stretch& one : most_scaled.stretches) one.squares /= squares;
  const VariogramNoise noise = noise_of_variogram(lags, variogram, weights, rough, most_scaled);
  const double variance = std::min(std::max(noise.variance, smooth) * squares, mean_square);
  const double by_chance =
      limit.standard_errors * std::sqrt((noise.squares_alike - 1.0) / (2.0 * static_cast<double>(count)));
  return {std::max(std::sqrt(variance), rounding),
          std::max(std::sqrt(noise.most * squares) * (1.0 + by_chance), rounding)};
}

/// The standard deviation alone, as noise_of_sequence() has it.
inline double noise_sd(const std::vector<double>& sequence, const std::vector<bool>& gaps,
                       double quantum = 0.0, const std::vector<double>& levels = {},
                       const std::vector<double>& measured = {}, const MostNoise& most = {}) {
  return noise_of_sequence(sequence, gaps, quantum, levels, measured, most).sd;
}

/// How many samples in a row count as one: 1 + 2 sum of the autocorrelations, up to their first fall below
/// 0.05. At least 1, at most a quarter of the sequence.
inline double correlation_samples(const std::vector<double>& sequence) {
  const std::size_t count = sequence.size();
  constexpr NoiseThresholds limit;
  if (count < limit.least_for_correlation) return 1.0;
  double mean = 0.0, variance = 0.0;
  for (double value : sequence) mean += value;
  mean /= static_cast<double>(count);
  for (double value : sequence) variance += (value - mean) * (value - mean);
  if (!(variance > 0.0)) return 1.0;
  double total = 1.0;
  // Lags grow by a quarter beyond 16, so that slow residuals cost no more than fast ones.
  for (std::size_t lag = 1, previous = 0; lag < count / 4;) {
    double product = 0.0;
    for (std::size_t i = lag; i < count; ++i) product += (sequence[i] - mean) * (sequence[i - lag] - mean);
    const double correlation = product / variance;
    if (correlation < limit.uncorrelated) break;
    total += 2.0 * correlation * static_cast<double>(lag - previous);
    previous = lag;
    lag = lag < 16 ? lag + 1 : lag + lag / 4;
  }
  return std::min(total, static_cast<double>(count) / 4.0);
}

}  // namespace thermopower::gap::engine
