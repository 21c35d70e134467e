// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// When a recording of a moving axis is averaged down.
/// Held by tests/gap/joint_effects_test.cpp: a loop of 1 kHz gets the same answer logged at any rate.
struct AveragingThresholds {
  double rows_per_horizon =
      100.0;  ///< of a window that is scored: finer than any effect of the catalogue needs
  double smooth =
      1.3;  ///< robust scale of the samples about a block's parabola, over that of neighbours: more is motion
  double kinks = 5.0;  ///< the same for the 95th percentile: blocks in which the torque steps
};

/// Averages a fast recording of a moving axis down in time, so that a budget of rows spans the same motion at any
/// sampling rate.
///
/// Blocks of k rows become one row at their centre. Outputs are the value of the parabola through their samples there,
/// because a mean would cut the tops of fast motions. Inputs are the mean over the time from centre to centre, so that the
/// torque's integral stays. Blocks are halved until parabolas describe the samples to within their noise.
class AxisAveraging {
public:
  /// @param full  the rows to average; must outlive this object
  explicit AxisAveraging(const Inputs& full) : full_(full) {}

  /// The shorter recording, or the full one where it is not faster than needed.
  Inputs run(double horizon_s) const {
    const double interval_s = plant::median_interval_s(full_.t_s, full_.runs, 0.0);
    if (!(interval_s > 0.0)) return full_;
    if (full_.closed_loop) return full_;  // a servo answers each sample
    auto rows = static_cast<Eigen::Index>(horizon_s / (AveragingThresholds().rows_per_horizon * interval_s));
    while (rows > 1 && !smooth_within(rows)) rows /= 2;
    return rows > 1 ? averaged(rows) : full_;
  }

private:
  /// The parabola through the samples of a block, at the block's mean stamp. Missing if it has at most half as many as
  /// usual. @param known  share of the rows with a sample
  static double at_centre(const Eigen::VectorXd& values, const Eigen::VectorXd& t_s, Eigen::Index begin,
                          Eigen::Index end, double centre_s, double known) {
    // Sums of powers of the stamps about the centre, in units of the block's length.
    const double unit_s = std::max(t_s[end - 1] - t_s[begin], 1e-300);
    double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0, s4 = 0.0, y0 = 0.0, y1 = 0.0, y2 = 0.0;
    Eigen::Index count = 0;
    for (Eigen::Index i = begin; i < end; ++i) {
      if (!std::isfinite(values[i])) continue;
      const double s = (t_s[i] - centre_s) / unit_s;
      s0 += 1.0, s1 += s, s2 += s * s, s3 += s * s * s, s4 += s * s * s * s;
      y0 += values[i], y1 += s * values[i], y2 += s * s * values[i];
      ++count;
    }
    if (2.0 * static_cast<double>(count) <= known * static_cast<double>(end - begin)) return missing;
    if (count < 4) {  // too few for a parabola: a straight line
      if (count < 2) return y0 / static_cast<double>(std::max<Eigen::Index>(count, 1));
      return (y0 * s2 - y1 * s1) / (s0 * s2 - s1 * s1);
    }
    // The first unknown of the normal equations, by Cramer's rule.
    const double c0 = s2 * s4 - s3 * s3, c1 = s2 * s3 - s1 * s4, c2 = s1 * s3 - s2 * s2;
    return (y0 * c0 + y1 * c1 + y2 * c2) / (s0 * c0 + s1 * c1 + s2 * c2);
  }

  /// Share of the rows with a sample.
  static double known_share(const Eigen::VectorXd& values) {
    return static_cast<double>(values.array().isFinite().count()) /
           static_cast<double>(std::max<Eigen::Index>(1, values.size()));
  }

  bool smooth_within(Eigen::Index rows) const {
    constexpr AveragingThresholds limit;
    constexpr Eigen::Index looked_at = 400;  // blocks
    for (const Signal signal : {Signal::angle_deg, Signal::rate_dps}) {
      if (!full_.judged(signal)) continue;
      const Eigen::VectorXd& values = full_.of(signal);
      const double scale = white_scale(values, full_.runs) + quantum_of(values) / std::sqrt(12.0);
      const double known = known_share(values);
      std::vector<double> left;
      const Eigen::Index stride = std::max(rows, full_.rows() / looked_at);
      for (const RunSpan& run : full_.runs)
        for (Eigen::Index begin = run.begin; begin + rows <= run.end; begin += stride) {
          const Eigen::Index middle = begin + rows / 2;
          const double off =
              values[middle] - at_centre(values, full_.t_s, begin, begin + rows, full_.t_s[middle], known);
          if (std::isfinite(off)) left.push_back(std::abs(off));
        }
      std::vector<double> again = left;
      if (median_of(left) > limit.smooth * 0.6745 * scale || quantile_of(again, 0.95) > limit.kinks * scale)
        return false;
    }
    return true;
  }

  Inputs averaged(Eigen::Index rows) const {
    Inputs thin = full_;
    thin.runs.clear();
    std::vector<Eigen::Index> blocks;  // their first rows
    for (const RunSpan& run : full_.runs) {
      const auto begin = static_cast<Eigen::Index>(blocks.size());
      for (Eigen::Index row = run.begin; row + rows <= run.end; row += rows) blocks.push_back(row);
      thin.runs.push_back({begin, static_cast<Eigen::Index>(blocks.size()), run.label, run.goes_on,
                           run.drawn_Ah, run.was_driven});
    }
    const auto count = static_cast<Eigen::Index>(blocks.size());
    thin.t_s.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) thin.t_s[i] = full_.t_s.segment(blocks[i], rows).mean();
    const auto picked = [&](Eigen::VectorXd& values) {
      if (values.size() > 0) values = Eigen::VectorXd(values(blocks));
    };
    for (Eigen::VectorXd* values : {&thin.power_param, &thin.supply_V, &thin.ambient_C, &thin.airspeed_mps,
                                    &thin.neighbour_C, &thin.covariate_rate_dps, &thin.covariate_motor_C,
                                    &thin.held_current_A, &thin.held_motor_C, &thin.heat_W})
      picked(*values);
    // The value of a parabola at its middle has 9/4 times the variance of a mean.
    thin.repeats = Eigen::VectorXd::Constant(count, std::max(1.0, 4.0 / 9.0 * static_cast<double>(rows)));
    for (Eigen::VectorXd& values : thin.between_samples) values.resize(0);
    thin.command_noise = full_.command_noise / std::sqrt(static_cast<double>(rows));
    const auto& unknown = full_.command_unknown;
    if (unknown.between.size() > 0)
      thin.command_unknown.between =
          (held_means(unknown.between.cwiseAbs2(), thin) / static_cast<double>(rows)).cwiseSqrt();
    if (unknown.shift.size() > 0) thin.command_unknown.shift = held_means(unknown.shift, thin);
    for (Eigen::VectorXd Inputs::*input : {&Inputs::drive_A, &Inputs::voltage_V, &Inputs::torque_Nm})
      if ((full_.*input).size() > 0) thin.*input = held_means(full_.*input, thin);
    for (std::size_t k = 0; k < thin.measured.size(); ++k) {
      Eigen::VectorXd& values = thin.measured[k];
      const auto signal = static_cast<Signal>(k);
      picked(values);
      if (values.size() == 0 || (signal != Signal::angle_deg && signal != Signal::rate_dps)) continue;
      const double known = known_share(full_.measured[k]);
      for (Eigen::Index i = 0; i < count; ++i)
        values[i] = at_centre(full_.measured[k], full_.t_s, blocks[i], blocks[i] + rows, thin.t_s[i], known);
    }
    return thin;
  }

  /// Means of a held input over the intervals that start at the rows of `thin`.
  Eigen::VectorXd held_means(const Eigen::VectorXd& values, const Inputs& thin) const {
    Eigen::VectorXd means(thin.t_s.size());
    assert(values.size() == full_.t_s.size());
    for (std::size_t r = 0; r < thin.runs.size(); ++r) {
      const RunSpan& run = thin.runs[r];
      const RunSpan& whole = full_.runs[r];
      Eigen::Index row = whole.begin;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        const double from_s = thin.t_s[i];
        const double to_s = i + 1 < run.end ? thin.t_s[i + 1] : full_.t_s[whole.end - 1];
        while (row + 1 < whole.end && full_.t_s[row + 1] <= from_s) ++row;
        double sum = 0.0, length_s = 0.0;
        for (Eigen::Index k = row; k < whole.end; ++k) {
          const double begin_s = std::max(from_s, full_.t_s[k]);
          const double end_s = k + 1 < whole.end ? std::min(to_s, full_.t_s[k + 1]) : to_s;
          if (!(begin_s < to_s)) break;
          if (end_s > begin_s) sum += values[k] * (end_s - begin_s), length_s += end_s - begin_s;
        }
        means[i] = length_s > 0.0 ? sum / length_s : values[row];
      }
    }
    return means;
  }

  const Inputs& full_;
};

}  // namespace thermopower::gap::engine
