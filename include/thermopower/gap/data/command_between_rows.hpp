// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/jackknife.hpp>
#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file command_between_rows.hpp
/// What a command did between the rows. A row's command holds until the next one: so says the format, and so it is where the
/// loop that commands also logs. Where a log keeps each twentieth command of a faster loop, holding it is half a row late, and
/// half a row late looks like compliance or a slow drive. The motion tells which.

namespace thermopower::gap::engine {

/// Thresholds of the question what a command did between the rows. Held by tests/gap/data/command_test.cpp.
struct CommandThresholds {
  double least_share = 0.2;      ///< every second command logged is felt by a quarter
  double most_share = 0.65;      ///< a command that changes steadily by half; more is another thing
  double sure = 5.0;             ///< standard errors that a share differs from 0 by
  double precise = 0.08;         ///< largest standard error of the share
  double agree = 2.0;            ///< standard errors that shares of rows and of their means may differ by
  double moving = 0.05;          ///< of the rate's 95th percentile: slower rows may be stuck
  std::size_t least_rows = 300;  ///< that move: fewer do not tell
};

/// Asks the motion of axes what their command did between the rows: the acceleration, regressed on the command, on its next
/// step, and on what else turns most axes.
class CommandBetweenRows {
public:
  /// Part of a command's next step that is in force before it is logged, and how well it is known.
  struct Share {
    double value = 0.0;  ///< 0 of a command that holds, 0.5 of one that changes steadily
    double error = 0.0;  ///< standard error
  };

  /// Adds the rows of a recording whose axis is driven by `command`.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) {
    if (command.size() == 0 || !inputs.axis()) return;
    const bool by_rate = inputs.judged(Signal::rate_dps);
    const Eigen::VectorXd& values = inputs.of(by_rate ? Signal::rate_dps : Signal::angle_deg);
    for (const RunSpan& run : inputs.runs) {
      if (!rows_.empty()) rows_.back().is_last = true;
      for (Eigen::Index k = run.begin + 1; k + 1 < run.end; ++k) {
        const double step_s = inputs.t_s[k + 1] - inputs.t_s[k], before_s = inputs.t_s[k] - inputs.t_s[k - 1],
                     after = (values[k + 1] - values[k]) / step_s,
                     before = (values[k] - values[k - 1]) / before_s;
        Row row;
        row.command = command[k];
        row.step = command[k + 1] - command[k];
        if (by_rate) {
          row.response = after;
          row.dps = 0.5 * (values[k] + values[k + 1]);
        } else {  // a second difference: of the intervals before and after
          row.response = 2.0 * (after - before) / (step_s + before_s);
          row.dps = 0.5 * (after + before);
          row.command = 0.5 * (command[k] + command[k - 1]);
          row.step = 0.5 * (command[k + 1] - command[k - 1]);
        }
        if (inputs.judged(Signal::angle_deg)) row.rad = inputs.of(Signal::angle_deg)[k] * rad_per_deg;
        if (std::isfinite(row.response) && std::isfinite(row.rad)) rows_.push_back(row);
        else if (!rows_.empty()) rows_.back().is_last = true;
      }
    }
  }

  /// The share where the command went on between the rows; nothing where it held, or where the recordings do not tell. Rows
  /// and means of them must agree: what a controller makes of a noisy motion moves with the noise of single rows.
  std::optional<Share> steady() const {
    constexpr CommandThresholds limit;
    constexpr Eigen::Index together = 8;
    const std::optional<Share> single = fit(1), means = fit(together);
    if (!single || !means) return std::nullopt;
    const Share& best = single->error < means->error ? *single : *means;
    const bool agree =
        std::abs(single->value - means->value) < limit.agree * std::hypot(single->error, means->error);
    if (!agree || !(best.error < limit.precise) || !(best.value > limit.sure * best.error))
      return std::nullopt;
    return best.value > limit.least_share && best.value < limit.most_share ? std::optional<Share>(best)
                                                                           : std::nullopt;
  }

private:
  struct Row {
    double response = 0.0, dps = 0.0, rad = 0.0, command = 0.0, step = 0.0;
    bool is_last = false;  ///< the next one is no neighbour
  };

  /// The share by means of so many rows, each half of them after the one before.
  std::optional<Share> fit(Eigen::Index together) const {
    constexpr CommandThresholds limit;
    constexpr Eigen::Index terms = 9;
    std::vector<double> speeds;
    for (const Row& row : rows_) speeds.push_back(std::abs(row.dps));
    const double slowest = limit.moving * quantile_of(speeds, 0.95);
    std::vector<Eigen::VectorXd> list;  // terms, then the response
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(terms + 1);
    Eigen::Index in_a_row = 0;
    for (const Row& row : rows_) {
      if (std::abs(row.dps) > slowest) {
        const plant::SineCosine once(row.rad);
        Eigen::VectorXd one(terms + 1);
        one << row.command, row.step, row.dps, std::abs(row.dps), std::copysign(1.0, row.dps), row.rad,
            once.sine, once.cosine, 1.0, row.response;
        sum += one;
        ++in_a_row;
      }
      if (in_a_row == together) list.push_back(sum / static_cast<double>(together));
      if (in_a_row == together || row.is_last || !(std::abs(row.dps) > slowest)) {
        sum.setZero();
        in_a_row = 0;
      }
    }
    if (list.size() * static_cast<std::size_t>(together) < limit.least_rows) return std::nullopt;
    constexpr std::size_t parts = 20;  // of the jackknife
    std::vector<NormalEquations> blocks(parts, NormalEquations(terms));
    NormalEquations all(terms);
    for (std::size_t i = 0; i < list.size(); ++i)
      blocks[i * parts / list.size()].add(list[i].head(terms), list[i][terms]);
    for (const NormalEquations& one : blocks) all.add(one, 1.0);
    const auto share_of = [](const Eigen::VectorXd& of) { return of[1] / of[0]; };
    std::vector<double> without;
    for (const NormalEquations& one : blocks) {
      NormalEquations rest = all;
      rest.add(one, -1.0);
      without.push_back(share_of(rest.solve()));
    }
    return Share{share_of(all.solve()), jackknife_error(without)};
  }

  std::vector<Row> rows_;
};

/// Steps of a command from each row to the next; 0 from a run's last one.
inline Eigen::VectorXd steps_of(const Eigen::VectorXd& command, const std::vector<RunSpan>& runs) {
  Eigen::VectorXd steps = Eigen::VectorXd::Zero(command.size());
  for (const RunSpan& run : runs)
    for (Eigen::Index row = run.begin; row + 1 < run.end; ++row) steps[row] = command[row + 1] - command[row];
  return steps;
}

/// Standard deviation of the command's mean until the next row that a straight line does not tell: a step between two rows is at
/// any instant there, and of what a loop's own noise did meanwhile the rows say nothing. Where steps follow on each
/// other as those of a smooth command do, nothing is unknown.
/// @param steps  of the command, as steps_of() has them
inline Eigen::VectorXd unknown_between(const Eigen::VectorXd& command, const Eigen::VectorXd& steps,
                                       const std::vector<RunSpan>& runs) {
  const double of_a_step = 1.0 / std::sqrt(12.0);  // a uniform distribution's
  // Of white noise: that of a mean of four or more, which nobody logged, and two fifths to a half of either end's.
  constexpr double of_noise = 0.7;
  const double noise = of_noise * white_scale(command, runs);
  Eigen::VectorXd sd = Eigen::VectorXd::Zero(command.size());
  for (const RunSpan& run : runs)
    for (Eigen::Index row = run.begin; row + 1 < run.end; ++row) {
      const double step = steps[row], before = row > run.begin ? steps[row - 1] : step,
                   after = row + 2 < run.end ? steps[row + 1] : step;
      sd[row] =
          std::max(of_a_step * std::min(std::abs(step), std::abs(step - 0.5 * (before + after))), noise);
    }
  return sd;
}

}  // namespace thermopower::gap::engine
