// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/compare/score.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// @file rate_beside_angle.hpp
/// The noise of a rate and of the angle beside it, each told by the other.

namespace thermopower::gap::engine {

/// Errors of a rate beside those of the angle in the same rows. Whatever motion a model lacks moves both alike: the mean rate
/// of some rows is then the slope of the angle over them. The rest is noise of the two sensors.
class RateBesideAngle {
public:
  /// @param errors    of a simulation; nothing is told where it has none of an angle or of a rate, nor of a plant of the user's own,
  ///                  which has other signals in their places
  /// @param segments  that they are numbered by
  RateBesideAngle(const Errors& errors, const std::vector<Segment>& segments) {
    constexpr auto angle = static_cast<std::size_t>(Signal::angle_deg),
                   rate = static_cast<std::size_t>(Signal::rate_dps);
    assert(errors.segment[angle].size() == errors.of[angle].size() &&
           errors.row[angle].size() == errors.of[angle].size());
    assert(errors.segment[rate].size() == errors.of[rate].size() &&
           errors.row[rate].size() == errors.of[rate].size());
    const auto place = [&](std::size_t signal, std::size_t at) {
      return std::make_pair(errors.segment[signal][at], errors.row[signal][at]);
    };
    for (std::size_t i = 0, k = 0; i < errors.of[rate].size(); ++i) {
      while (k < errors.of[angle].size() && place(angle, k) < place(rate, i)) ++k;
      if (k == errors.of[angle].size() || place(angle, k) != place(rate, i)) continue;
      const auto [segment, row] = place(rate, i);
      const Inputs& inputs = *segments[static_cast<std::size_t>(segment)].inputs;
      if (!inputs.axis()) continue;
      const double t_s = inputs.t_s[row];
      Row one{segment, t_s, errors.of[angle][k], errors.of[rate][i], 0.0, 0};
      if (!rows_.empty() && segment == last_.first && row == last_.second + 1) {
        const Row& before = rows_.back();
        assert(t_s > before.t_s);
        one.went = before.went + 0.5 * (before.rate + one.rate) * (t_s - before.t_s);
        one.since = before.since + 1;
      }
      rows_.push_back(one);
      last_ = {segment, row};
    }
  }

  /// Noise of the rate that lasts over more than a few rows: standard deviation, nothing where there is too little to tell.
  /// Neighbouring means share no reading, so their common part lasts. It was larger at the first of them by its loss from
  /// one to the next.
  std::optional<double> lasting_noise() const {
    constexpr std::size_t together = 5;
    const std::vector<double> beyond = beyond_slope(together - 1);
    const double middle = mean_of(beyond);
    const auto in_common = [&](std::size_t apart) -> std::optional<double> {
      constexpr double enough = 100.0;
      double product = 0.0, pairs = 0.0;
      for (std::size_t i = apart; i < beyond.size(); ++i) {
        const double both = (beyond[i] - middle) * (beyond[i - apart] - middle);
        if (std::isfinite(both) && rows_[i].segment == rows_[i - apart].segment)
          product += both, pairs += 1.0;
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

  /// The most that noise can be in one of the two.
  struct Most {
    MostNoise angle;  ///< in it
    MostNoise rate;   ///< in it

    /// Nothing is known of any other.
    MostNoise of(Signal signal) const {
      return signal == Signal::angle_deg ? angle : signal == Signal::rate_dps ? rate : MostNoise();
    }
  };

  /// Noise of the rate moves its mean over some rows, and noise of the angle both ends of its slope. Neither can be larger
  /// than the difference between the two, at any number of rows. A blow or a wobble that a model lacks looks like noise
  /// with memory in one signal, but both signals show it. White noise is told by each signal itself. A rate that was made
  /// from the angle holds its noise, too, and tells nothing: see has_noise_of_its_own().
  Most most_noise() const {
    constexpr double certain = 2.0;  // standard errors
    const std::vector<Stretches> all = stretches();
    if (!has_noise_of_its_own(all)) return {};
    Most most;
    for (const Stretches& one : all) {
      const double at_most = one.variance * (1.0 + certain * std::sqrt(2.0 / one.apart));
      MostNoise::Stretch of_rate{at_most, {}}, of_angle{at_most * one.length_s * one.length_s, {}};
      for (std::size_t i = 0; i < noise_memories.size(); ++i) {
        of_rate.of_noise[i] = of_mean(noise_memories[i], one.intervals);
        of_angle.of_noise[i] = 2.0 * (1.0 - std::pow(noise_memories[i], static_cast<double>(one.intervals)));
      }
      most.rate.stretches.push_back(of_rate);
      most.angle.stretches.push_back(of_angle);
    }
    return most;
  }

private:
  struct Row {
    int segment;
    double t_s, angle, rate,
        went;  // the last: integral of the rate since the first of the rows that follow on each other
    std::size_t since;  // of those rows, how many before this one
  };

  /// Stretches of rows that follow on each other, all of as many intervals.
  struct Stretches {
    std::size_t intervals;
    double variance, length_s;  // of the mean rate beyond the slope of the angle, deg/s; mean
    double apart;               // how many of them share no row
  };

  /// Of as many lengths as there are enough stretches of.
  std::vector<Stretches> stretches() const {
    constexpr double fewest = 8.0;
    std::vector<Stretches> all;
    for (const std::size_t intervals : {1, 2, 4, 8, 16, 32, 64}) {
      const std::vector<double> beyond = beyond_slope(intervals);
      const double middle = mean_of(beyond);
      double squares = 0.0, length_s = 0.0, count = 0.0;
      for (std::size_t i = 0; i < beyond.size(); ++i)
        if (std::isfinite(beyond[i])) {
          squares += (beyond[i] - middle) * (beyond[i] - middle);
          length_s += rows_[i].t_s - rows_[i - intervals].t_s;
          count += 1.0;
        }
      const double apart = count / static_cast<double>(intervals);
      if (apart < fewest) break;
      all.push_back({intervals, squares / count, length_s / count, apart});
    }
    return all;
  }

  /// Whether neither was made from the other. An angle that was summed up from the rate is equally far from its integral
  /// everywhere. Less lies between them than the rate's white noise would leave. A rate that was made from the angle
  /// follows from the angles around it by some filter. It also leaves less than its white noise.
  bool has_noise_of_its_own(const std::vector<Stretches>& all) const {
    if (all.empty()) return false;
    constexpr double of_white = 0.25;
    const double white = of_white * white_variance();
    return all.back().variance >= white * of_mean(0.0, all.back().intervals) && beyond_angles() >= white;
  }

  /// Mean square of what the rate is beyond a sum of the angle's steps around it, fitted to all of them, (deg/s)^2.
  double beyond_angles() const {
    constexpr std::size_t around = 8, terms = 2 * around, most_rows = 20000;
    const std::size_t stride = std::max<std::size_t>(1, rows_.size() / most_rows);
    std::vector<std::size_t> middles;
    for (std::size_t i = around; i + around < rows_.size(); i += stride)
      if (rows_[i + around].since >= terms) middles.push_back(i);
    if (middles.size() <= terms) return 0.0;
    Eigen::MatrixXd steps(static_cast<Eigen::Index>(middles.size()), static_cast<Eigen::Index>(terms));
    Eigen::VectorXd rates(steps.rows());
    for (Eigen::Index i = 0; i < steps.rows(); ++i) {
      const std::size_t middle = middles[static_cast<std::size_t>(i)];
      rates[i] = rows_[middle].rate;
      for (Eigen::Index k = 0; k < steps.cols(); ++k) {
        const std::size_t at = middle - around + static_cast<std::size_t>(k);
        steps(i, k) = rows_[at + 1].angle - rows_[at].angle;
      }
    }
    const Eigen::VectorXd shares = NormalEquations(steps, rates).solve();
    return (rates - steps * shares).squaredNorm() / static_cast<double>(middles.size() - terms);
  }

  /// The excess of the mean rate over some intervals beyond the slope of the angle, at the row that each ends at, deg/s.
  /// NaN where rows do not follow on each other.
  std::vector<double> beyond_slope(std::size_t intervals) const {
    std::vector<double> beyond(rows_.size(), std::nan(""));
    for (std::size_t i = intervals; i < rows_.size(); ++i) {
      const Row &first = rows_[i - intervals], &last = rows_[i];
      if (last.since >= intervals)
        beyond[i] = (last.went - first.went - (last.angle - first.angle)) / (last.t_s - first.t_s);
    }
    return beyond;
  }

  /// Of those that are there.
  static double mean_of(const std::vector<double>& values) {
    double sum = 0.0, count = 0.0;
    for (const double one : values)
      if (std::isfinite(one)) sum += one, count += 1.0;
    return count > 0.0 ? sum / count : 0.0;
  }

  /// Variance of the mean of noise of variance 1 over some intervals, by trapezoids.
  static double of_mean(double memory, std::size_t intervals) {
    assert(memory >= 0.0 && memory < 1.0 && intervals > 0);
    const auto count = static_cast<double>(intervals);
    double variance = (count - 0.5) / (count * count), kept = 1.0;
    for (std::size_t lag = 1; lag <= intervals; ++lag) {
      kept *= memory;
      // Of the products at this lag two have an end in them, the last has both.
      const double products = lag < intervals ? count - static_cast<double>(lag) : 0.25;
      variance += 2.0 * kept * products / (count * count);
    }
    return variance;
  }

  /// Variance of the white noise in the rate, by the differences of most.
  double white_variance() const {
    std::vector<double> rate;
    std::vector<int> since;
    for (const Row& row : rows_) {
      rate.push_back(row.rate);
      since.push_back(static_cast<int>(row.since));
    }
    const double scale = third_difference_scale(rate, since, 0.5, 0.6745);
    return scale * scale / third_differences(0.0);
  }

  std::vector<Row> rows_;
  std::pair<int, Eigen::Index> last_{-1, -1};
};

}  // namespace thermopower::gap::engine
