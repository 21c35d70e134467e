// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
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

/// Keeps about `most` of the rows of some pieces: parts of them, spread evenly over long ones.
/// @param part  makes the rows [begin, end) of a piece a piece of its own
template <class Piece, class Part>
void spread_out(std::vector<Piece>& pieces, Eigen::Index most, Part&& part) {
  constexpr Eigen::Index long_parts = 24, least_rows = 200;
  Eigen::Index rows = 0;
  for (const Piece& one : pieces) rows += one.rows();
  if (rows <= most) return;
  const Eigen::Index length = std::max(least_rows, most / long_parts);
  std::vector<Piece> all;
  for (const Piece& one : pieces) {
    const Eigen::Index size = one.rows(), count = std::max<Eigen::Index>(1, size / length);
    for (Eigen::Index k = 0; k < count; ++k)
      all.push_back(part(one, k * size / count, (k + 1) * size / count));
  }
  const double every = static_cast<double>(rows) / static_cast<double>(most);
  pieces.clear();
  for (double at = 0.5 * every; at < static_cast<double>(all.size()); at += every)
    pieces.push_back(all[static_cast<std::size_t>(at)]);
}

/// The recordings of one part on grids as fine as they were sampled, before any low-pass.
class SampledMotion {
public:
  /// A stretch of motion without a hole, as it was sampled.
  struct Stretch {
    std::size_t run = 0;        ///< it is of, counted over all recordings
    double from_s = 0.0;        ///< since the start of its run
    double interval_s = 0.0;    ///< between samples
    Eigen::VectorXd effort;     ///< in A, of a motor at a voltage in V
    Eigen::VectorXd angle;      ///< in rad; empty: not measured
    Eigen::VectorXd rate;       ///< in rad/s; empty: not measured
    Eigen::VectorXd torque_Nm;  ///< from outside; empty: none is recorded
    Eigen::VectorXd motor_C;    ///< as recorded; empty: it is not

    /// The rate after a low-pass.
    Eigen::VectorXd smooth_rate(double cutoff) const {
      Eigen::VectorXd values = rate.size() > 0 ? rate : angle;
      low_pass(values, cutoff);
      return rate.size() > 0 ? values : slope(values);
    }

    /// Slopes of values at its samples.
    Eigen::VectorXd slope(const Eigen::VectorXd& values) const {
      const Eigen::Index n = values.size();
      Eigen::VectorXd result(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const Eigen::Index before = std::max<Eigen::Index>(0, i - 1), after = std::min(n - 1, i + 1);
        result[i] = (values[after] - values[before]) / (static_cast<double>(after - before) * interval_s);
      }
      return result;
    }
  };
  std::vector<Stretch> stretches;  ///< in the order recorded
  double angle_noise = 0.0;        ///< of a sample, rad
  double rate_noise = 0.0;         ///< of a sample, rad/s

  /// @param model      reads its instruments, and says which column drives the axis
  /// @param recordings prepared ones; those without an axis are left out
  SampledMotion(const Model& model, const Catalogue& catalogue, const std::vector<Inputs>& recordings) {
    std::vector<Span> spans;
    std::vector<plant::AxisAtRows> measured;
    measured.reserve(recordings.size());  // spans refer to these
    std::size_t first_run = 0;
    for (const Inputs& inputs : recordings) {
      const plant::AxisAtRows& rows =
          measured.emplace_back(model, catalogue, inputs, plant::ReadingOffsets{});
      if (inputs.axis() && rows.command().size() > 0) {
        find_spans(rows, first_run, spans);
        if (rows.has_rate) rate_noise = std::max(rate_noise, rows.rate_noise);
        else angle_noise = std::max(angle_noise, plant::sample_noise(rows.raw_angle, inputs.runs));
      }
      first_run += inputs.runs.size();
    }
    spread_out(spans, propose_thresholds.most_samples, [](Span one, Eigen::Index begin, Eigen::Index end) {
      one.from_s += static_cast<double>(begin) * one.interval_s;
      one.count = end - begin;
      return one;
    });
    for (const Span& one : spans) stretches.push_back(sampled(one));
  }

private:
  /// Rows of a run between holes, and the grid laid over them.
  struct Span {
    const plant::AxisAtRows* of = nullptr;
    const RunSpan* in = nullptr;
    std::size_t run = 0;  // counted over all recordings
    double from_s = 0.0, interval_s = 0.0;
    Eigen::Index count = 0;

    Eigen::Index rows() const { return count; }
    double at_s(Eigen::Index i) const { return from_s + static_cast<double>(i) * interval_s; }
  };

  static void find_spans(const plant::AxisAtRows& measured, std::size_t first_run, std::vector<Span>& spans) {
    const Inputs& inputs = measured.inputs();
    const Eigen::VectorXd& samples = measured.has_rate ? measured.raw_rate : measured.raw_angle;
    for (std::size_t k = 0; k < inputs.runs.size(); ++k) {
      const RunSpan& run = inputs.runs[k];
      std::vector<double> stamps, steps;
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        if (std::isfinite(samples[i])) stamps.push_back(inputs.t_s[i]);
      for (std::size_t i = 0; i + 1 < stamps.size(); ++i) steps.push_back(stamps[i + 1] - stamps[i]);
      if (steps.size() < 2) continue;
      const double interval_s = median_of(steps);
      assert(interval_s > 0.0);
      for (std::size_t i = 0, first = 0; i < stamps.size(); ++i) {
        const bool last = i + 1 == stamps.size();
        if (!last && stamps[i + 1] - stamps[i] <= propose_thresholds.longest_hole * interval_s) continue;
        const double length = (stamps[i] - stamps[first]) / interval_s;
        const Eigen::Index count = static_cast<Eigen::Index>(length + 1e-6) + 1;
        if (count >= propose_thresholds.shortest_piece)
          spans.push_back({&measured, &run, first_run + k, stamps[first], interval_s, count});
        first = i + 1;
      }
    }
  }

  static Stretch sampled(const Span& one) {
    const plant::AxisAtRows& measured = *one.of;
    const Inputs& inputs = measured.inputs();
    Stretch result;
    result.run = one.run;
    result.from_s = one.from_s - inputs.t_s[one.in->begin];
    result.interval_s = one.interval_s;
    result.effort = held_means(measured.command(), one);
    result.torque_Nm = held_means(inputs.torque_Nm, one);
    result.motor_C = held_means(inputs.covariate_motor_C, one);
    if (measured.has_angle) result.angle = straight(measured.raw_angle, one);
    if (measured.has_rate) result.rate = straight(measured.raw_rate, one);
    return result;
  }

  /// Means of held values over the intervals of the grid; empty where there are none.
  static Eigen::VectorXd held_means(const Eigen::VectorXd& values, const Span& one) {
    if (values.size() == 0) return {};
    const Eigen::VectorXd& t_s = one.of->inputs().t_s;
    const Eigen::Index end = one.in->end;
    const double rounding = 1e-6 * one.interval_s;
    Eigen::VectorXd means(one.count);
    Eigen::Index row = one.in->begin;
    for (Eigen::Index i = 0; i < one.count; ++i) {
      const double from_s = one.at_s(i), to_s = from_s + one.interval_s;
      while (row + 1 < end && t_s[row + 1] <= from_s + rounding) ++row;
      double sum = 0.0, at_s = from_s;
      for (Eigen::Index k = row; k < end; ++k) {
        const double until_s = k + 1 < end ? std::min(t_s[k + 1], to_s) : to_s;
        if (until_s > at_s) sum += values[k] * (until_s - at_s), at_s = until_s;
        if (at_s >= to_s - rounding) break;
      }
      means[i] = at_s > from_s ? sum / (at_s - from_s) : values[row];
    }
    return means;
  }

  /// Samples joined by straight lines, at the rows of the grid; held before the first and after the last.
  static Eigen::VectorXd straight(const Eigen::VectorXd& samples, const Span& one) {
    const Eigen::VectorXd& t_s = one.of->inputs().t_s;
    const Eigen::Index end = one.in->end;
    const auto next = [&](Eigen::Index from) {
      while (from < end && !std::isfinite(samples[from])) ++from;
      return from;
    };
    Eigen::VectorXd values(one.count);
    Eigen::Index before = -1, after = next(one.in->begin);
    for (Eigen::Index i = 0; i < one.count; ++i) {
      const double at_s = one.at_s(i);
      while (after < end && t_s[after] <= at_s) before = after, after = next(after + 1);
      if (before < 0) values[i] = after < end ? samples[after] : 0.0;
      else if (after >= end) values[i] = samples[before];
      else {
        const double share = (at_s - t_s[before]) / (t_s[after] - t_s[before]);
        values[i] = samples[before] + share * (samples[after] - samples[before]);
      }
    }
    return values;
  }
};

}  // namespace thermopower::gap::engine
