// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

/// @file command_noise.hpp
/// The noise of a command. A log often keeps the current that a sensor measured, not the one that was asked for. Its
/// noise turns nothing, and a simulation that is driven by it wanders.

namespace thermopower::gap::engine {

/// Thresholds of the question whether a command is noisy.
/// Held by tests/gap/observe/command_test.cpp.
struct CommandNoiseThresholds {
  double flat = 1.6;               ///< largest ratio to the lowest band of a spectrum that is its floor
  double least_bins = 24.0;        ///< of the floor, and of what tells: less may be a shape of the command
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
  /// All that turns the axis beside its command is taken off the acceleration first: a stiff gear or a heavy arm that moves slowly
  /// balances nearly all of the command, and its acceleration alone follows none of it.
  /// @param fit  of that motion on the mean and the slope of its command around each row
  CommandNoise(const MotionRegression& motion, const MotionFit& fit)
      : response_(std::abs(fit.value[0])), ahead_rows_(0.5 + fit.value[1] / fit.value[0]) {
    constexpr CommandNoiseThresholds limit;
    Eigen::Index rows = 0;
    for (const MotionRegression::Driven& one : motion.recordings()) {
      step_s_ = std::max(step_s_, plant::median_interval_s(one.inputs->t_s, one.inputs->runs, 0.0));
      rows += one.inputs->rows();
    }
    while (2 * length_ <= limit.longest && 2.0 * static_cast<double>(length_) * step_s_ <= limit.window_s &&
           rows / length_ >= 2 * static_cast<Eigen::Index>(limit.least_windows))
      length_ *= 2;
    spectrum_.resize(static_cast<std::size_t>(length_ / 2));
    for (const MotionRegression::Driven& one : motion.recordings()) add(*one.inputs, *one.command, fit);
  }

  /// The longest usual interval between rows.
  double step_s() const { return step_s_; }

  /// Standard deviation of what is noise in the command, in its unit; 0 where nothing is, or nobody can tell.
  double sd() const {
    constexpr CommandNoiseThresholds limit;
    if (windows_ < limit.least_windows || !(response_ > 0.0)) return 0.0;
    const std::vector<Band> all = octaves();
    double lowest = 1e300, floor = 0.0, bins = 0.0;
    for (const Band& one : all) lowest = std::min(lowest, one.command / one.bins);
    for (const Band& one : all)
      if (one.command / one.bins < limit.flat * lowest) floor += one.command, bins += one.bins;
    if (bins < limit.least_bins) return 0.0;
    floor /= bins;
    if (!(floor > 0.0)) return 0.0;
    bool is_followed = false;
    double witnesses = 0.0, rough_bins = 0.0, rough_weight = 0.0;
    std::complex<double> rough = 0.0;
    for (const Band& one : all) {
      const double left = std::max(0.0, 1.0 - floor / (one.command / one.bins));
      const std::complex<double> followed = one.cross / (response_ * one.command);
      const double error =
          std::sqrt(one.response / one.command / (independent * count() * one.bins)) / response_;
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
    return is_followed && witnesses >= limit.least_bins ? std::sqrt(floor) : 0.0;
  }

private:
  static constexpr double turn = 6.283185307179586;
  static constexpr double independent = 0.5;  ///< windows that overlap by a half, under a bell
  struct Band {
    double command = 0.0, response = 0.0, bins = 0.0;
    std::complex<double> cross = 0.0;
  };

  void add(const Inputs& inputs, const Eigen::VectorXd& command, const MotionFit& fit) {
    // Windows that overlap by a half, or fewer of a long recording.
    const Eigen::Index stride =
        std::max<Eigen::Index>(length_ / 2, inputs.rows() * length_ / CommandNoiseThresholds().most_rows);
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index from = run.begin + 1; from + length_ + 1 < run.end; from += stride) {
        Eigen::VectorXd response(length_);
        for (Eigen::Index i = 0; i < length_; ++i) {
          const MeasuredMotion motion(inputs, from + i);
          response[i] = motion.acceleration_dps2 - fit.beside(motion.rate_dps, motion.angle_rad);
        }
        const Eigen::VectorXd driven = command.segment(from, length_);
        if (fill_holes(response) && driven.allFinite()) take(response, driven);
      }
    before_rows_ = inputs.judged(Signal::rate_dps) ? 0.0 : 0.5;
  }

  /// Puts the mean where samples are missing; no where those are many.
  static bool fill_holes(Eigen::VectorXd& values) {
    const auto known = values.array().isFinite();
    const double holes = static_cast<double>(values.size() - known.count());
    if (holes > CommandNoiseThresholds().most_holes * static_cast<double>(values.size())) return false;
    const double mean = known.select(values.array(), 0.0).sum() / static_cast<double>(known.count());
    values = known.select(values.array(), mean).matrix().eval();
    return true;
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

  /// The sums of a window, octave by octave.
  std::vector<Band> octaves() const {
    std::vector<Band> all;
    for (std::size_t first = 1; 2 * first <= spectrum_.size(); first *= 2) {
      Band band;
      for (std::size_t bin = first; bin < 2 * first; ++bin) {
        band.command += spectrum_[bin].command / count();
        band.response += spectrum_[bin].response / count();
        // A second difference of angles lies around a row, the difference of two rates after it.
        band.cross += spectrum_[bin].cross / count() *
                      std::polar(1.0, -(ahead_rows_ - before_rows_) * turn * static_cast<double>(bin) /
                                          static_cast<double>(length_));
        ++band.bins;
      }
      all.push_back(band);
    }
    return all;
  }

  double response_;    ///< deg/s^2 that the command turns the rate by, for each of its unit
  double ahead_rows_;  ///< of the motion before the rows' commands: 0 where they hold, 0.5 where they go on
  double step_s_ = 0.0;
  Eigen::Index length_ = CommandNoiseThresholds().shortest;  ///< rows of a window, a power of two
  std::vector<Band> spectrum_;                               ///< of each frequency
  std::size_t windows_ = 0;
  double before_rows_ = 0.0;
};

}  // namespace thermopower::gap::engine
