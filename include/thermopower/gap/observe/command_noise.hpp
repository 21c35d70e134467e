// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/motion_regression.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

/// @file command_noise.hpp
/// What of a command is noise. A log often keeps the current that a sensor measured, not the one that was asked for: its
/// noise turns nothing, and a simulation that is driven by it wanders.

namespace thermopower::gap::engine {

/// Thresholds of the question whether a command is noisy.
/// Held by tests/gap/observe/command_test.cpp.
struct CommandNoiseThresholds {
  double flat = 1.6;               ///< largest ratio to the lowest band of a spectrum that is its floor
  std::size_t least_bins = 24;     ///< of the floor, and of what tells: less may be a shape of the command
  std::size_t least_windows = 20;  ///< fewer tell nothing
  Eigen::Index most_rows = 76800;  ///< of a recording that are looked at
  Eigen::Index shortest = 128;     ///< rows of a window
  Eigen::Index longest = 1024;     ///< the same: sums over all its frequencies take its square
  /// That a window lasts where its rows are many: an arm follows little above 10 Hz, and what nobody follows shows best just
  /// above, before the differences of positions drown it.
  double window_s = 1.1;
  double most_holes = 0.05;   ///< share of a window's rows that may be missing: masked samples leave some
  double not_followed = 0.5;  ///< share of what a band's noise leaves: bands above it are no witnesses
  double mostly = 0.7;        ///< of a band without noise that the motion must follow
  double error = 0.1;   ///< standard error of what is followed in a band from which on the band tells nothing
  double match = 0.12;  ///< what is followed may differ by from what the noise leaves
  double short_of = 0.2;  ///< that, in a band of which it leaves most: a drive that falls shorter is slow
};

/// Compares how strong a command is at each frequency with how much of that the acceleration follows.
///
/// White noise of variance N under a command with the spectrum S leaves 1 - N / S of it to be followed (the gain of errors in
/// a regressor: Fuller 1987, section 1.1; by frequency: Bendat & Piersol 2010, section 6.1). A drive that is slow or late
/// follows less, too, but with another phase and whatever the spectrum.
class CommandNoise {
public:
  /// @param step_s  between rows
  /// @param rows    of all recordings together
  CommandNoise(double step_s, Eigen::Index rows) : length_(CommandNoiseThresholds().shortest) {
    constexpr CommandNoiseThresholds limit;
    while (2 * length_ <= limit.longest && 2.0 * static_cast<double>(length_) * step_s <= limit.window_s &&
           rows / length_ >= 2 * static_cast<Eigen::Index>(limit.least_windows))
      length_ *= 2;
    spectrum_.resize(static_cast<std::size_t>(length_ / 2));
  }

  /// Adds a recording of an axis that is driven by `command`, one for each row.
  ///
  /// What turns the axis beside its command is taken off the acceleration first: a stiff gear or a heavy arm that moves slowly
  /// balances nearly all of the command, and its acceleration alone follows none of it.
  /// @param beside  what that is, in deg/s^2, by rate in deg/s and angle in rad
  template <class Beside>
  void add(const Inputs& inputs, const Eigen::VectorXd& command, Beside&& beside) {
    // Windows that overlap by a half, or fewer of a long recording.
    const Eigen::Index stride =
        std::max<Eigen::Index>(length_ / 2, inputs.rows() * length_ / CommandNoiseThresholds().most_rows);
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index from = run.begin + 1; from + length_ + 1 < run.end; from += stride) {
        Eigen::VectorXd response(length_), driven(length_);
        for (Eigen::Index i = 0; i < length_; ++i) {
          const MeasuredMotion motion(inputs, from + i);
          response[i] = motion.acceleration_dps2 -
                        beside(motion.rate_dps, MotionRegression::angle_rad(inputs, from + i));
          driven[i] = command[from + i];
        }
        if (fill_holes(response) && driven.allFinite()) take(response, driven);
      }
    before_rows_ = inputs.judged(Signal::rate_dps) ? 0.0 : 0.5;
  }

  /// Standard deviation of what is noise in the command, in its unit; 0 where nothing is, or nobody can tell.
  /// @param response  what the command turns the rate by, deg/s^2 for each of its unit
  /// @param share     rows by which the motion is ahead of the rows' commands: 0 where they hold, 0.5 where they go on
  double sd(double response, double share) const {
    constexpr CommandNoiseThresholds limit;
    if (windows_ < limit.least_windows || !(response > 0.0)) return 0.0;
    std::vector<Band> all(bands());
    double lowest = 1e300;
    for (std::size_t b = 0; b < all.size(); ++b) {
      for (std::size_t bin = std::size_t{1} << b; bin < std::size_t{2} << b; ++bin) {
        all[b].command += spectrum_[bin].command / count();
        all[b].response += spectrum_[bin].response / count();
        // A second difference of angles lies around a row, the difference of two rates after it.
        all[b].cross += spectrum_[bin].cross / count() *
                        std::polar(1.0, -(share - before_rows_) * turn * static_cast<double>(bin) /
                                            static_cast<double>(length_));
        ++all[b].bins;
      }
      lowest = std::min(lowest, all[b].command / all[b].bins);
    }
    double floor = 0.0, bins = 0.0;
    for (const Band& one : all)
      if (one.command / one.bins < limit.flat * lowest) floor += one.command, bins += one.bins;
    if (bins < static_cast<double>(limit.least_bins)) return 0.0;
    floor /= bins;
    if (!(floor > 0.0)) return 0.0;
    bool is_followed = false;
    double witnesses = 0.0, rough_bins = 0.0, rough_weight = 0.0;
    std::complex<double> rough = 0.0;
    for (const Band& one : all) {
      const double left = std::max(0.0, 1.0 - floor / (one.command / one.bins));
      const std::complex<double> followed = one.cross / (response * one.command);
      const double error =
          std::sqrt(one.response / one.command / (independent * count() * one.bins)) / response;
      is_followed = is_followed || (left > limit.mostly && followed.real() > limit.mostly);
      if (left > limit.not_followed) {
        if (error < limit.error && left - followed.real() > limit.short_of + 3.0 * error) return 0.0;
        continue;
      }
      if (error > limit.error) {
        const double weight = 1.0 / (error * error);
        rough += weight * (followed - left);
        rough_weight += weight;
        rough_bins += one.bins;
        continue;
      }
      if (std::abs(followed - left) > limit.match + 3.0 * error) return 0.0;
      witnesses += one.bins;
    }
    // Bands of which each alone is too rough may tell together.
    if (rough_weight * limit.error * limit.error > 1.0) {
      if (std::abs(rough / rough_weight) > limit.match + 3.0 / std::sqrt(rough_weight)) return 0.0;
      witnesses += rough_bins;
    }
    return is_followed && witnesses >= static_cast<double>(limit.least_bins) ? std::sqrt(floor) : 0.0;
  }

private:
  static constexpr double turn = 6.283185307179586;
  static constexpr double independent = 0.5;  ///< windows that overlap by a half, under a bell
  struct Band {
    double command = 0.0, response = 0.0, bins = 0.0;
    std::complex<double> cross = 0.0;
  };

  /// Puts the mean where samples are missing; no where those are many.
  static bool fill_holes(Eigen::VectorXd& values) {
    const auto known = values.array().isFinite();
    const double holes = static_cast<double>(values.size() - known.count());
    if (holes > CommandNoiseThresholds().most_holes * static_cast<double>(values.size())) return false;
    if (holes == 0.0) return true;
    const double mean = known.select(values.array(), 0.0).sum() / static_cast<double>(known.count());
    values = known.select(values.array(), mean).matrix().eval();
    return true;
  }

  /// Octaves of a window.
  std::size_t bands() const {
    std::size_t octaves = 0;
    while ((std::size_t{2} << octaves) <= spectrum_.size()) ++octaves;
    return octaves;
  }

  double count() const { return static_cast<double>(windows_); }

  void take(const Eigen::VectorXd& response, const Eigen::VectorXd& driven) {
    ++windows_;
    Eigen::VectorXd bell(length_);
    for (Eigen::Index i = 0; i < length_; ++i)
      bell[i] = 0.5 - 0.5 * std::cos(turn * (static_cast<double>(i) + 0.5) / static_cast<double>(length_));
    const double unit = 1.0 / bell.norm();
    const double mean = driven.mean(), mean_response = response.mean();
    for (std::size_t bin = 1; bin < spectrum_.size(); ++bin) {
      const double radians = turn * static_cast<double>(bin) / static_cast<double>(length_);
      const std::complex<double> step = std::polar(1.0, -radians);
      std::complex<double> at = 1.0, command = 0.0, acceleration = 0.0;
      for (Eigen::Index i = 0; i < length_; ++i, at *= step) {
        command += at * (bell[i] * (driven[i] - mean) * unit);
        acceleration += at * (bell[i] * (response[i] - mean_response) * unit);
      }
      spectrum_[bin].command += std::norm(command);
      spectrum_[bin].response += std::norm(acceleration);
      spectrum_[bin].cross += acceleration * std::conj(command);
    }
  }

  Eigen::Index length_;         ///< rows of a window, a power of two
  std::vector<Band> spectrum_;  ///< of each frequency
  std::size_t windows_ = 0;
  double before_rows_ = 0.0;
};

}  // namespace thermopower::gap::engine
