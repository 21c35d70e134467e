// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/jackknife.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

/// @file command_between_rows.hpp
/// What a command did between the rows. A row's command holds until the next one: so says the format, and so it is where
/// the loop that commands also logs. Where a log keeps each twentieth command of a faster loop, holding it is half a row
/// late, and half a row late looks like compliance or a slow drive. The motion tells which.

namespace thermopower::gap::engine {

/// Thresholds of the question what a command did between the rows.
struct CommandThresholds {
  std::size_t least_rows = 300;   ///< that move: fewer do not tell
  std::size_t most_rows = 30000;  ///< that are looked at
  std::size_t blocks = 20;        ///< of the jackknife
  double moving = 0.05;           ///< of the rate's 95th percentile: slower rows may be stuck
  double least_share = 0.2;       ///< every second command logged is felt by a quarter
  double most_share = 0.65;       ///< a command that changes steadily by half; more is another thing
  double sure = 5.0;              ///< standard errors that the share differs from 0 by
  double precise = 0.08;          ///< largest standard error of the share
  double matters = 0.2;           ///< noise scales of what half a row changes: less is nobody's concern
  int periods = 2;                ///< of the angle that are taken away
  int most_cogs = 60;             ///< a turn
};

/// Regresses the acceleration between rows on the command, on how much of its next step is felt already, and on what
/// else turns an axis.
class CommandBetweenRows {
public:
  /// Adds a recording whose axis is driven by `command`.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) {
    const bool rate = inputs.judged(Signal::rate_dps), angle = inputs.judged(Signal::angle_deg);
    if (command.size() == 0 || (!rate && !angle)) return;
    const Eigen::VectorXd none;
    const Eigen::VectorXd& dps = rate ? inputs.of(Signal::rate_dps) : none;
    const Eigen::VectorXd& deg = angle ? inputs.of(Signal::angle_deg) : none;
    noise_dps_ = std::max(noise_dps_, rate ? white_scale(dps, inputs.runs) : 0.0);
    for (const RunSpan& run : inputs.runs)
      for (Eigen::Index k = run.begin + 1; k + 1 < run.end; ++k) {
        const double step_s = inputs.t_s[k + 1] - inputs.t_s[k], before_s = inputs.t_s[k] - inputs.t_s[k - 1];
        Row row;
        double middle_deg = angle ? deg[k] : 0.0;
        if (rate) {
          row.response = (dps[k + 1] - dps[k]) / step_s;
          row.dps = 0.5 * (dps[k] + dps[k + 1]);
          row.held = command[k];
          row.next = command[k + 1] - command[k];
          if (angle) middle_deg = 0.5 * (deg[k] + deg[k + 1]);
        } else {
          const double after = (deg[k + 1] - deg[k]) / step_s, before = (deg[k] - deg[k - 1]) / before_s;
          row.response = 2.0 * (after - before) / (step_s + before_s);
          row.dps = 0.5 * (after + before);
          row.held = 0.5 * (command[k - 1] + command[k]);
          row.next = 0.5 * (command[k + 1] - command[k - 1]);
        }
        row.rad = middle_deg * rad_per_deg;
        row.step_s = step_s;
        if (std::isfinite(row.response) && std::isfinite(row.rad) && std::isfinite(row.dps))
          rows_.push_back(row);
      }
  }

  /// How much of a command's next step the motion shows already before it is logged: 0 of a command that holds, 0.5 of one
  /// that changes steadily, a little less where it is set some times between two rows; nothing where the recordings do not
  /// tell.
  std::optional<double> share() const {
    constexpr CommandThresholds limit;
    const std::vector<Row> rows = moving_rows();
    if (rows.size() < limit.least_rows) return std::nullopt;
    const std::vector<int> cogs = cogging_of(rows);
    std::vector<Normal> blocks(limit.blocks, Normal(cogs));
    for (std::size_t i = 0; i < rows.size(); ++i) blocks[i * limit.blocks / rows.size()].add(rows[i]);
    Normal all(cogs);
    for (const Normal& one : blocks) all.add(one, 1.0);
    const Eigen::VectorXd fitted = all.solve();
    if (!fitted.allFinite() || fitted[0] == 0.0) return std::nullopt;
    double squares = 0.0;
    for (const Row& row : rows) {
      const double half_dps = 0.5 * fitted[0] * row.held * row.step_s;
      squares += half_dps * half_dps / static_cast<double>(rows.size());
    }
    if (std::sqrt(squares) < limit.matters * noise_dps_) return std::nullopt;
    std::vector<double> without;
    for (const Normal& one : blocks) {
      Normal rest = all;
      rest.add(one, -1.0);
      const Eigen::VectorXd left = rest.solve();
      without.push_back(left[1] / left[0]);
    }
    const double share = fitted[1] / fitted[0], standard_error = jackknife_error(without);
    if (!(standard_error < limit.precise)) return std::nullopt;
    return std::abs(share) < limit.sure * standard_error ? 0.0 : share;
  }

  /// The share where the command went on between the rows; nothing where it held, where it was late, or where nobody knows.
  std::optional<double> steady() const {
    constexpr CommandThresholds limit;
    const std::optional<double> found = share();
    return found && *found > limit.least_share && *found < limit.most_share ? found : std::nullopt;
  }

private:
  struct Row {
    double response = 0.0, held = 0.0, next = 0.0, dps = 0.0, rad = 0.0, step_s = 0.0;
  };

  /// Sums of a linear regression on the command, its next step, and what turns most axes: friction, a spring, an
  /// imbalance, a constant, and cogs.
  class Normal {
  public:
    explicit Normal(const std::vector<int>& cogs)
        : cogs_(cogs),
          square_(Eigen::MatrixXd::Zero(terms(), terms())),
          product_(Eigen::VectorXd::Zero(terms())) {}

    void add(const Row& row) {
      const Eigen::VectorXd x = regressors(row);
      square_.selfadjointView<Eigen::Lower>().rankUpdate(x);
      product_ += x * row.response;
    }

    void add(const Normal& other, double weight) {
      square_ += weight * other.square_;
      product_ += weight * other.product_;
    }

    Eigen::VectorXd solve() const {
      return Eigen::MatrixXd(square_.selfadjointView<Eigen::Lower>())
          .completeOrthogonalDecomposition()
          .solve(product_);
    }

    Eigen::VectorXd regressors(const Row& row) const {
      Eigen::VectorXd x(terms());
      x.head(9) << row.held, row.next, row.dps, std::abs(row.dps), row.dps > 0.0 ? 1.0 : -1.0, row.rad,
          std::sin(row.rad), std::cos(row.rad), 1.0;
      Eigen::Index at = 9;
      for (const int cogs : cogs_) {
        x[at++] = std::sin(cogs * row.rad);
        x[at++] = std::cos(cogs * row.rad);
      }
      return x;
    }

  private:
    Eigen::Index terms() const { return 9 + 2 * static_cast<Eigen::Index>(cogs_.size()); }

    std::vector<int> cogs_;
    Eigen::MatrixXd square_;
    Eigen::VectorXd product_;
  };

  /// Rows that move, at most as many as are needed.
  std::vector<Row> moving_rows() const {
    constexpr CommandThresholds limit;
    std::vector<double> speeds;
    for (const Row& row : rows_) speeds.push_back(std::abs(row.dps));
    const double slowest = limit.moving * quantile_of(speeds, 0.95);
    std::vector<Row> moving;
    for (const Row& row : rows_)
      if (std::abs(row.dps) > slowest) moving.push_back(row);
    const std::size_t stride = moving.size() / limit.most_rows + 1;
    for (std::size_t i = 0; i * stride < moving.size(); ++i) moving[i] = moving[i * stride];
    moving.resize((moving.size() + stride - 1) / stride);
    return moving;
  }

  /// Cogs a turn of the two strongest periods of the angle in what the rest leaves.
  static std::vector<int> cogging_of(const std::vector<Row>& rows) {
    constexpr CommandThresholds limit;
    std::vector<int> cogs;
    for (int round = 0; round < limit.periods; ++round) {
      Normal all(cogs);
      for (const Row& row : rows) all.add(row);
      const Eigen::VectorXd fitted = all.solve();
      std::vector<std::complex<double>> sums(static_cast<std::size_t>(limit.most_cogs) + 1);
      for (const Row& row : rows) {
        const double left = row.response - all.regressors(row).dot(fitted);
        const std::complex<double> turn = std::polar(1.0, row.rad);
        std::complex<double> at = left * turn;
        for (std::complex<double>& sum : sums) sum += at *= turn;  // from two cogs on: one is an imbalance
      }
      const auto strongest = std::max_element(
          sums.begin(), sums.end(), [](const auto& a, const auto& b) { return std::norm(a) < std::norm(b); });
      cogs.push_back(static_cast<int>(strongest - sums.begin()) + 2);
    }
    return cogs;
  }

  std::vector<Row> rows_;
  double noise_dps_ = 0.0;
};

/// The means of a command between each row and the next of its run; a run's last row keeps its own.
/// @param share  of the next row's command in the mean
inline Eigen::VectorXd mean_until_next(const Eigen::VectorXd& command, const std::vector<RunSpan>& runs,
                                       double share) {
  Eigen::VectorXd means = command;
  for (const RunSpan& run : runs)
    for (Eigen::Index row = run.begin; row + 1 < run.end; ++row)
      means[row] += share * (command[row + 1] - command[row]);
  return means;
}

}  // namespace thermopower::gap::engine
