// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/low_pass.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/axis_at_rows.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

/// @file sampled_motion.hpp
/// Effort and motion of recordings on even grids.

namespace thermopower::gap::engine {

/// The recordings of one part on grids as fine as they were sampled, before any low-pass.
class SampledMotion {
public:
  /// A stretch of motion without a hole, as it was sampled.
  struct Stretch {
    std::size_t recording = 0;  ///< place of its recording among those given
    std::size_t run = 0;        ///< place of its run in that recording
    double from_s = 0.0;        ///< since the start of its run
    double interval_s = 0.0;    ///< between samples
    Eigen::VectorXd effort;     ///< in A, of a motor at a voltage in V
    Eigen::VectorXd angle;      ///< in rad; empty: not measured
    Eigen::VectorXd rate;       ///< in rad/s; empty: not measured
    Eigen::VectorXd torque_Nm;  ///< from outside; empty: none is recorded
    Eigen::VectorXd motor_C;    ///< as recorded; empty: it is not
  };
  std::vector<Stretch> stretches;  ///< in the order recorded
  double angle_noise = 0.0;        ///< of a sample, rad
  double rate_noise = 0.0;         ///< of a sample, rad/s

  /// @param model      reads its instruments, and says which column drives the axis
  /// @param recordings prepared ones; those without an axis are left out
  /// @param most       samples that are kept of all, about
  SampledMotion(const Model& model, const Catalogue& catalogue, const std::vector<Inputs>& recordings,
                Eigen::Index most) {
    std::vector<Span> spans;
    std::vector<plant::AxisAtRows> measured;
    measured.reserve(recordings.size());
    std::size_t run_count = 0;
    for (const Inputs& inputs : recordings) {
      const std::size_t first_run = run_count;
      run_count += inputs.runs.size();
      measured.emplace_back(model, catalogue, inputs, plant::ReadingOffsets{});
      const plant::AxisAtRows& rows = measured.back();
      if (!inputs.axis() || rows.command().size() == 0) continue;
      find_spans(rows, measured.size() - 1, first_run, spans);
      if (rows.has_rate) rate_noise = std::max(rate_noise, rows.rate_noise);
      else angle_noise = std::max(angle_noise, plant::sample_noise(rows.raw_angle, inputs.runs));
    }
    thin(spans, most);
    for (const Span& one : spans) stretches.push_back(sampled(measured[one.recording], one));
  }

  /// Variance of the acceleration's noise after a low-pass, as a share of all of its variance, were noise white; may exceed 1.
  double noise_share(double cutoff) const {
    double noise = 0.0, all = 0.0;
    for (const Stretch& one : stretches) {
      noise += white(one, cutoff);
      all += acceleration(one, cutoff).squaredNorm();
    }
    return all > 0.0 ? noise / all : 0.0;
  }

  /// Slopes of evenly spaced values.
  static Eigen::VectorXd slope(const Eigen::VectorXd& values, double interval_s) {
    const Eigen::Index n = values.size();
    Eigen::VectorXd result(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Index before = std::max<Eigen::Index>(0, i - 1), after = std::min(n - 1, i + 1);
      result[i] = (values[after] - values[before]) / (static_cast<double>(after - before) * interval_s);
    }
    return result;
  }

  /// The rate of a stretch after a low-pass.
  static Eigen::VectorXd rate(const Stretch& one, double cutoff) {
    Eigen::VectorXd values = one.rate.size() > 0 ? one.rate : one.angle;
    const LowPass low_pass(cutoff);
    low_pass(values);
    return one.rate.size() > 0 ? values : slope(values, one.interval_s);
  }

  /// The acceleration of a stretch after a low-pass.
  static Eigen::VectorXd acceleration(const Stretch& one, double cutoff) {
    return slope(rate(one, cutoff), one.interval_s);
  }

private:
  /// Sum of squares of an acceleration that is noise alone: the spectrum of white noise times the square of what differentiates.
  double white(const Stretch& one, double cutoff) const {
    const double turn = plant::rad_per_turn, h = one.interval_s;
    return static_cast<double>(one.effort.size()) *
           (one.rate.size() > 0
                ? 2.0 / 3.0 * std::pow(rate_noise * turn / h, 2) * std::pow(cutoff, 3)
                : 2.0 / 5.0 * std::pow(angle_noise * turn * turn / (h * h), 2) * std::pow(cutoff, 5));
  }

  /// Rows of a recording between holes, and the grid laid over them.
  struct Span {
    std::size_t recording = 0, run = 0, place = 0;
    double from_s = 0.0, interval_s = 0.0;
    Eigen::Index count = 0;
  };

  /// The samples of the signal that the rate comes from.
  static const Eigen::VectorXd& moving(const plant::AxisAtRows& measured) {
    return measured.has_rate ? measured.raw_rate : measured.raw_angle;
  }

  static void find_spans(const plant::AxisAtRows& measured, std::size_t recording, std::size_t first_run,
                         std::vector<Span>& spans) {
    const Inputs& inputs = measured.inputs();
    const Eigen::VectorXd& samples = moving(measured);
    for (std::size_t k = 0; k < inputs.runs.size(); ++k) {
      std::vector<double> stamps, steps;
      for (Eigen::Index i = inputs.runs[k].begin; i < inputs.runs[k].end; ++i)
        if (std::isfinite(samples[i])) stamps.push_back(inputs.t_s[i]);
      for (std::size_t i = 0; i + 1 < stamps.size(); ++i) steps.push_back(stamps[i + 1] - stamps[i]);
      if (steps.size() < 2) continue;
      const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
      std::nth_element(steps.begin(), middle, steps.end());
      const double interval_s = *middle;
      assert(interval_s > 0.0);
      for (std::size_t i = 0, first = 0; i < stamps.size(); ++i) {
        const bool last = i + 1 == stamps.size();
        if (!last && stamps[i + 1] - stamps[i] <= propose_thresholds.longest_hole * interval_s) continue;
        const double length = (stamps[i] - stamps[first]) / interval_s;
        const Eigen::Index count = static_cast<Eigen::Index>(length + 1e-6) + 1;
        if (count >= propose_thresholds.shortest_piece)
          spans.push_back({recording, first_run + k, k, stamps[first], interval_s, count});
        first = i + 1;
      }
    }
  }

  /// Keeps pieces spread evenly over long ones.
  static void thin(std::vector<Span>& spans, Eigen::Index most) {
    constexpr Eigen::Index pieces = 24, least = 200;
    Eigen::Index rows = 0;
    for (const Span& one : spans) rows += one.count;
    if (rows <= most) return;
    const Eigen::Index length = std::max(least, most / pieces);
    std::vector<Span> parts;
    for (const Span& one : spans) {
      const Eigen::Index count = std::max<Eigen::Index>(1, one.count / length);
      for (Eigen::Index k = 0; k < count; ++k) {
        Span part = one;
        const Eigen::Index begin = k * one.count / count;
        part.from_s += static_cast<double>(begin) * one.interval_s;
        part.count = (k + 1) * one.count / count - begin;
        parts.push_back(part);
      }
    }
    const double every = std::max(1.0, static_cast<double>(rows) / static_cast<double>(most));
    spans.clear();
    for (double at = 0.5 * every; at < static_cast<double>(parts.size()); at += every)
      spans.push_back(parts[static_cast<std::size_t>(at)]);
    if (spans.empty() && !parts.empty()) spans.push_back(parts.front());
  }

  static Stretch sampled(const plant::AxisAtRows& measured, const Span& one) {
    const Inputs& inputs = measured.inputs();
    assert(one.place < inputs.runs.size() && one.interval_s > 0.0);
    const RunSpan& run = inputs.runs[one.place];
    Stretch result;
    result.recording = one.recording;
    result.run = one.run;
    result.from_s = one.from_s - inputs.t_s[run.begin];
    result.interval_s = one.interval_s;
    result.effort = held_means(inputs, run, measured.command(), one);
    if (inputs.torque_Nm.size() > 0) result.torque_Nm = held_means(inputs, run, inputs.torque_Nm, one);
    if (inputs.covariate_motor_C.size() > 0)
      result.motor_C = held_means(inputs, run, inputs.covariate_motor_C, one);
    if (measured.has_angle) result.angle = straight(inputs, run, measured.raw_angle, one);
    if (measured.has_rate) result.rate = straight(inputs, run, measured.raw_rate, one);
    return result;
  }

  /// Means of held values over the intervals of the grid.
  static Eigen::VectorXd held_means(const Inputs& inputs, const RunSpan& run, const Eigen::VectorXd& values,
                                    const Span& one) {
    assert(run.begin >= 0 && run.end <= values.size());
    Eigen::VectorXd means(one.count);
    Eigen::Index row = run.begin;
    for (Eigen::Index i = 0; i < one.count; ++i) {
      const double from_s = one.from_s + static_cast<double>(i) * one.interval_s,
                   to_s = from_s + one.interval_s;
      const double rounding = 1e-6 * one.interval_s;
      while (row + 1 < run.end && inputs.t_s[row + 1] <= from_s + rounding) ++row;
      double sum = 0.0, at_s = from_s;
      for (Eigen::Index k = row; k < run.end; ++k) {
        const double until_s = k + 1 < run.end ? std::min(inputs.t_s[k + 1], to_s) : to_s;
        if (until_s > at_s) sum += values[k] * (until_s - at_s), at_s = until_s;
        if (at_s >= to_s - rounding) break;
      }
      means[i] = at_s > from_s ? sum / (at_s - from_s) : values[row];
    }
    return means;
  }

  /// Samples joined by straight lines, at the rows of the grid.
  static Eigen::VectorXd straight(const Inputs& inputs, const RunSpan& run, const Eigen::VectorXd& samples,
                                  const Span& one) {
    assert(run.begin >= 0 && run.end <= samples.size());
    Eigen::VectorXd values(one.count);
    Eigen::Index before = -1, after = run.begin;
    const auto next = [&](Eigen::Index from) {
      while (from < run.end && !std::isfinite(samples[from])) ++from;
      return from;
    };
    after = next(after);
    for (Eigen::Index i = 0; i < one.count; ++i) {
      const double at_s = one.from_s + static_cast<double>(i) * one.interval_s;
      while (after < run.end && inputs.t_s[after] <= at_s) before = after, after = next(after + 1);
      if (before < 0) values[i] = after < run.end ? samples[after] : 0.0;
      else if (after >= run.end) values[i] = samples[before];
      else {
        const double share = (at_s - inputs.t_s[before]) / (inputs.t_s[after] - inputs.t_s[before]);
        values[i] = samples[before] + share * (samples[after] - samples[before]);
      }
    }
    return values;
  }
};

}  // namespace thermopower::gap::engine
