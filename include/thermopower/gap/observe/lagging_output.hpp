// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file lagging_output.hpp
/// A rate that comes behind its own angle, or an angle behind its rate. A drive reports the rate as filtered differences of
/// the angle, or a bus later than the rest. No model of the axis explains that, and what tries to is named for it. The two
/// columns tell without a model: the slope of the angle is the rate.

namespace thermopower::gap::engine {

/// Thresholds of the question whether rate and angle belong together.
/// Held by tests/gap/observe/lagging_output_test.cpp.
struct LagThresholds {
  double sure = 8.0;     ///< standard errors that a lag differs from 0 by
  double matters = 0.5;  ///< noise scales of the rate that the lag makes: less is nobody's concern
  double precise = 0.1;  ///< largest standard error of a lag, of the lag
  double within_a_row =
      0.5;  ///< intervals between rows up to which a late reading is as good as one a little earlier
};

/// A column read earlier by what it comes late: linear between its rows, missing where a run ends before that.
/// @param lag_s  at least 0
inline Eigen::VectorXd read_earlier(const Eigen::VectorXd& values, const Eigen::VectorXd& t_s,
                                    const std::vector<RunSpan>& runs, double lag_s) {
  Eigen::VectorXd earlier = Eigen::VectorXd::Constant(values.size(), plant::missing);
  for (const RunSpan& run : runs) {
    Eigen::Index next = run.begin;  // the first row that is not before the instant
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      const double at_s = t_s[row] + lag_s;
      while (next < run.end && t_s[next] < at_s) ++next;
      if (next == run.end) break;
      const Eigen::Index last = std::max(next - 1, row);
      const double step_s = t_s[next] - t_s[last];
      const double share = step_s > 0.0 ? (at_s - t_s[last]) / step_s : 0.0;
      earlier[row] = values[last] + share * (values[next] - values[last]);
    }
  }
  return earlier;
}

/// Regresses what the slope of the angle has more than the rate on the acceleration: their ratio is the lag.
///
/// The acceleration's own noise would make the lag smaller: a difference over other rows stands in for it (an instrument:
/// Wooldridge 2010, chapter 5). A wrong scale, an offset and an eccentric encoder are regressed out.
class RateLag {
public:
  /// Adds a recording of which angle and rate are judged.
  void add(const Inputs& inputs) {
    if (!inputs.judged(Signal::angle_deg) || !inputs.judged(Signal::rate_dps)) return;
    const Eigen::VectorXd& deg = inputs.of(Signal::angle_deg);
    const Eigen::VectorXd& dps = inputs.of(Signal::rate_dps);
    noise_dps_ = std::max(noise_dps_, white_scale(dps, inputs.runs));
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index k = run.begin + 1; k + 2 < run.end; ++k) {
        const double step_s = inputs.t_s[k + 1] - inputs.t_s[k];
        const double mean_dps = 0.5 * (dps[k] + dps[k + 1]), rad = 0.5 * (deg[k] + deg[k + 1]) * rad_per_deg;
        const Row row{(deg[k + 1] - deg[k]) / step_s - mean_dps,
                      (dps[k + 1] - dps[k]) / step_s,
                      {(dps[k + 2] - dps[k - 1]) / (inputs.t_s[k + 2] - inputs.t_s[k - 1]), 1.0, mean_dps,
                       mean_dps * std::sin(rad), mean_dps * std::cos(rad)}};
        if (std::isfinite(row.more_dps) && row.others.allFinite()) rows_.push_back(row);
      }
  }

  /// The difference between rate and angle.
  struct Found {
    std::optional<double>
        lag_s;  ///< that the rate comes behind the angle, negative where the angle does; nothing where
                ///< they belong together or nobody can tell
    bool differ_by_more = false;  ///< whether a factor, or an eccentric encoder, makes more than the lag does
  };
  /// Asks the recordings.
  Found found() const {
    constexpr LagThresholds limit;
    if (rows_.size() < JackknifeThresholds().least_rows) return {};
    constexpr std::size_t parts = JackknifeThresholds().blocks;
    std::vector<NormalEquations> blocks(parts, NormalEquations(terms));
    double squares = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Vector regressors = rows_[i].others;
      regressors[0] = rows_[i].steeper;
      blocks[i * parts / rows_.size()].add(rows_[i].others, regressors, rows_[i].more_dps);
      squares += rows_[i].others[0] * rows_[i].others[0] / static_cast<double>(rows_.size());
    }
    const auto [all, without] = left_out(blocks, [](const NormalEquations& sums) { return sums.solve()[0]; });
    const Eigen::VectorXd coefficients = all.solve();
    const double lag = coefficients[0], standard_error = jackknife_error(without);
    const bool sure =
        std::abs(lag) > limit.sure * standard_error && standard_error < limit.precise * std::abs(lag);
    const double made_by_lag = std::abs(lag) * std::sqrt(squares);
    if (!sure || made_by_lag < limit.matters * noise_dps_) return {};
    // A factor, or an eccentric encoder: the last three of the others, by as much as each makes.
    double made_by_others = 0.0;
    for (const Row& row : rows_) {
      double more = 0.0;
      for (int k = 2; k < terms; ++k) more += coefficients[k] * row.others[k];
      made_by_others += more * more / static_cast<double>(rows_.size());
    }
    return {lag, std::sqrt(made_by_others) > made_by_lag};
  }

private:
  static constexpr int terms = 5;
  using Vector = Eigen::Matrix<double, terms, 1>;
  struct Row {
    double more_dps, steeper;
    Vector others;  ///< the instrument, and what else makes a difference
  };

  std::vector<Row> rows_;
  double noise_dps_ = 0.0;
};

}  // namespace thermopower::gap::engine
