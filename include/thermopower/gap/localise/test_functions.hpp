// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/rows.hpp>
#include <thermopower/gap/data/noise.hpp>

/// @file test_functions.hpp
/// What a moving axis recorded, and integrals of it against smooth bumps (the weak form): no noisy signal is
/// ever differentiated, the derivative goes to the bump.

namespace thermopower::gap::detail {

/// What an axis recorded, without holes, in SI.
struct AxisRows {
  std::vector<RunSpan> runs;
  Eigen::VectorXd t_s, drive_A, rate, angle;  ///< s, A, rad/s, rad
  Eigen::VectorXd raw_rate, raw_angle;        ///< with holes
  Eigen::VectorXd motor_C;                    ///< empty where not recorded
  std::vector<Column> covariates;
  bool has_rate = false, has_angle = false;
  double interval_s = 0.01, rate_noise = 0.0, angle_noise = 0.0;
};

constexpr Eigen::Index axis_rows_kept = 60000;

/// At most `most` rows: evenly spread stretches of consecutive ones, each a run of its own.
inline Recording stretches(const Recording& recording, Eigen::Index most) {
  if (recording.rows() <= most) return recording;
  constexpr Eigen::Index parts = 40;
  const Eigen::Index length = most / parts;
  Recording out;
  out.name = recording.name;
  out.t_s.resize(length * parts);
  for (const Column& column : recording.columns)
    out.columns.push_back({column.name, Eigen::VectorXd(length * parts)});
  for (Eigen::Index p = 0; p < parts; ++p) {
    const Eigen::Index begin = p * (recording.rows() - length) / (parts - 1), to = p * length;
    out.t_s.segment(to, length) = recording.t_s.segment(begin, length);
    for (std::size_t c = 0; c < recording.columns.size(); ++c) {
      out.columns[c].values.segment(to, length) = recording.columns[c].values.segment(begin, length);
    }
    for (const RunSpan& run : recording.spans()) {
      const Eigen::Index from = std::max(run.begin, begin), end = std::min(run.end, begin + length);
      if (from < end) out.runs.push_back({from - begin + to, end - begin + to, run.label});
    }
  }
  return out;
}

inline AxisRows axis_rows(const Recording& full) {
  const Recording recording = stretches(full, axis_rows_kept);
  AxisRows a;
  const Eigen::Index n = recording.rows();
  a.runs = recording.spans();
  a.t_s = recording.t_s;
  std::vector<double> steps;
  for (const RunSpan& run : a.runs) {
    for (Eigen::Index i = run.begin; i + 1 < run.end; ++i) steps.push_back(a.t_s[i + 1] - a.t_s[i]);
  }
  if (!steps.empty()) {
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                     steps.end());
    a.interval_s = steps[steps.size() / 2];
  }
  a.drive_A = held(recording.find("drive_A"), a.runs, n, 0.0);
  a.has_rate = recording.has("rate_dps");
  a.has_angle = recording.has("angle_deg");
  if (a.has_angle) {
    a.raw_angle = *recording.find("angle_deg") * rad_per_deg;
    a.angle = held(recording.find("angle_deg"), a.runs, n, 0.0) * rad_per_deg;
  } else {
    a.angle = Eigen::VectorXd::Zero(n);
  }
  if (a.has_rate) {
    a.raw_rate = *recording.find("rate_dps") * rad_per_deg;
    a.rate = held(recording.find("rate_dps"), a.runs, n, 0.0) * rad_per_deg;
  } else if (a.has_angle) {  // slopes over four intervals
    a.raw_rate = Eigen::VectorXd::Constant(n, missing);
    for (const RunSpan& run : a.runs) {
      for (Eigen::Index i = run.begin + 2; i + 2 < run.end; ++i) {
        a.raw_rate[i] =
            (2.0 * (a.raw_angle[i + 2] - a.raw_angle[i - 2]) + (a.raw_angle[i + 1] - a.raw_angle[i - 1])) /
            (2.0 * (a.t_s[i + 2] - a.t_s[i - 2]) + (a.t_s[i + 1] - a.t_s[i - 1]));
      }
    }
    a.rate = held(&a.raw_rate, a.runs, n, 0.0);
  }
  a.rate_noise =
      a.has_rate ? noise_of(a.raw_rate, a.runs) : noise_of(a.raw_angle, a.runs) / (3.2 * a.interval_s);
  if (a.has_angle) a.angle_noise = noise_of(a.raw_angle, a.runs);
  if (recording.has("motor_C")) a.motor_C = held(recording.find("motor_C"), a.runs, n, 25.0);
  for (const Column& column : recording.columns) {
    if (column.name == "drive_A" || column.name == "rate_dps" || column.name == "angle_deg" ||
        column.name == "motor_C")
      continue;
    if (!recording.has(column.name)) continue;
    Column copy{column.name, held(&column.values, a.runs, n, 0.0)};
    if (copy.values.maxCoeff() > copy.values.minCoeff()) a.covariates.push_back(std::move(copy));
  }
  return a;
}

/// Bumps (1 - s^2)^4 of unit area over the rows, and integrals against them.
class Bumps {
public:
  struct One {
    Eigen::Index begin, end;  ///< rows [begin, end) inside its support
    double middle, half;      ///< s
    std::size_t weights;      ///< where its weights begin
  };

  Bumps(const AxisRows& rows, const Eigen::VectorXd& needed, int half_rows, Eigen::Index most) : a_(rows) {
    const double half = half_rows * a_.interval_s;
    Eigen::Index count = 0;
    for (const RunSpan& run : a_.runs) count += run.size() / std::max(1, half_rows);
    const Eigen::Index keep = std::max<Eigen::Index>(1, (count + most - 1) / most);
    Eigen::Index number = 0;
    for (const RunSpan& run : a_.runs) {
      for (Eigen::Index i = run.begin + half_rows + 1; i + half_rows + 1 < run.end; i += half_rows) {
        if (number++ % keep != 0) continue;
        if (a_.t_s[i + half_rows] - a_.t_s[i - half_rows] > 2.5 * half) continue;  // a hole in the stamps
        One one{i - half_rows, i + half_rows + 1, a_.t_s[i], half, bump_.size()};
        bool whole = true;
        for (Eigen::Index k = one.begin; k < one.end; ++k) whole = whole && std::isfinite(needed[k]);
        if (!whole) continue;
        list_.push_back(one);
        for (Eigen::Index k = one.begin; k < one.end; ++k) {
          const double from = k == one.begin ? a_.t_s[k] : a_.t_s[k - 1],
                       to = k + 1 == one.end ? a_.t_s[k] : a_.t_s[k + 1];
          bump_.push_back(0.5 * (area(one, to) - area(one, from)));
          slope_.push_back(mean_before(one, k) - mean_before(one, k + 1));
        }
      }
    }
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(list_.size()); }
  const std::vector<One>& list() const { return list_; }

  /// Integral of the bump times values that are straight between their samples, each interval at its mean.
  Eigen::VectorXd integral(const Eigen::VectorXd& values) const { return sum(bump_, values); }

  /// Integral of the bump times the derivative of sampled values.
  Eigen::VectorXd derivative(const Eigen::VectorXd& values) const { return sum(slope_, values); }

  /// Integral of the bump times values that are held over the interval that starts at their row, `delay_s`
  /// later.
  Eigen::VectorXd held_integral(const Eigen::VectorXd& values, double delay_s = 0.0) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(size());
    for (Eigen::Index r = 0; r < size(); ++r) {
      const One& one = list_[static_cast<std::size_t>(r)];
      const RunSpan& run = run_of(one.begin);
      for (Eigen::Index k = one.end - 1; k >= run.begin; --k) {
        const double from = a_.t_s[k] + delay_s,
                     to = (k + 1 < run.end ? a_.t_s[k + 1] : a_.t_s[k] + a_.interval_s) + delay_s;
        if (to <= one.middle - one.half) break;
        out[r] += values[k] * (area(one, to) - area(one, from));
      }
    }
    return out;
  }

  /// Standard deviation of derivative() per unit of white noise on the samples.
  double derivative_gain() const {
    double sum = 0.0;
    if (list_.empty()) return 1.0;
    const One& one = list_[list_.size() / 2];
    for (Eigen::Index k = 0; k < one.end - one.begin; ++k)
      sum += std::pow(slope_[one.weights + static_cast<std::size_t>(k)], 2.0);
    return std::sqrt(sum);
  }

private:
  // Mean of the bump over the interval that ends at a row. Differences of such means integrate the bump times
  // the derivative of a signal that is straight between its samples without error: as a rate is while the
  // torque is held.
  double mean_before(const One& one, Eigen::Index k) const {
    if (k == one.begin || k == one.end) return 0.0;
    return (area(one, a_.t_s[k]) - area(one, a_.t_s[k - 1])) / (a_.t_s[k] - a_.t_s[k - 1]);
  }
  double area(const One& one, double t) const {  // integral of the bump up to t
    const double s = std::min(1.0, std::max(-1.0, (t - one.middle) / one.half)), q = s * s;
    return 0.5 + 315.0 / 256.0 * s * (1.0 + q * (-4.0 / 3.0 + q * (6.0 / 5.0 + q * (-4.0 / 7.0 + q / 9.0))));
  }
  const RunSpan& run_of(Eigen::Index row) const {
    for (const RunSpan& run : a_.runs) {
      if (row >= run.begin && row < run.end) return run;
    }
    return a_.runs.front();
  }
  Eigen::VectorXd sum(const std::vector<double>& weights, const Eigen::VectorXd& values) const {
    Eigen::VectorXd out(size());
    for (Eigen::Index r = 0; r < size(); ++r) {
      const One& one = list_[static_cast<std::size_t>(r)];
      out[r] = values.segment(one.begin, one.end - one.begin)
                   .dot(Eigen::Map<const Eigen::VectorXd>(weights.data() + one.weights, one.end - one.begin));
    }
    return out;
  }

  const AxisRows& a_;
  std::vector<One> list_;
  std::vector<double> bump_, slope_;  ///< weights of values and of derivatives, bump after bump
};

}  // namespace thermopower::gap::detail
