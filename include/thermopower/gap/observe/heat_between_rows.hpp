// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/plant/bench_at_rows.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file heat_between_rows.hpp
/// When a power that differs from row to row was switched. A row's power holds until the next one: so says the format, and
/// so it is where the loop that sets it also logs. A logger of its own sees the power some time after it was switched, and
/// a loop that sets, waits and then logs writes the power of the interval that is over. The temperature tells which.

namespace thermopower::gap::engine {

/// Thresholds of the question when a power was switched.
/// Held by tests/gap/observe/heat_test.cpp.
struct HeatThresholds {
  Eigen::Index block_rows = 17;  ///< through which a body goes as the terms say, but for a straight line
  std::size_t least_blocks = 6;  ///< in which the heat changes
  double least_share = 0.25;     ///< switched at any time is a half
  double most_share = 1.25;      ///< of the interval that is over is one
  double whole = 0.8;            ///< from here on it is the interval that is over
  double agree = 2.5;            ///< standard errors that few and all bodies, and recordings, may differ by
  double precise = 0.12;         ///< largest standard error of the share
};

/// Asks temperatures when the heat changed.
///
/// In a block of some rows a temperature is a straight line and what the heat does to it: its sum over time, and that of what
/// bodies with some time constants still hold of it, since the run began; and, where a change to the next row's heat came
/// earlier than that row, what it did until there: (q_{k+1} - q_k) dt_k, summed up. Nothing that a body or a thermometer
/// does later makes the coefficient of that positive. No term is made of temperatures: their noise would bias it.
class HeatBetweenRows {
public:
  /// Adds a recording. @param heat_W  of each row, by the model's law
  void add(const Inputs& inputs, const Eigen::VectorXd& heat_W) {
    if (!inputs.judged(Signal::motor_C) || heat_W.size() == 0) return;
    constexpr HeatThresholds limit;
    const double usual_s = plant::median_interval_s(inputs.t_s, inputs.runs, 0.0);
    for (const RunSpan& run : inputs.runs) {
      const Eigen::MatrixXd did = heat_until(inputs, heat_W, run, usual_s);
      for (Eigen::Index begin = run.begin; begin + limit.block_rows <= run.end;
           begin += limit.block_rows - 1) {
        const auto heat = heat_W.segment(begin, limit.block_rows);
        if (heat.maxCoeff() - heat.minCoeff() > 1e-6 * heat.cwiseAbs().maxCoeff())
          add_block(inputs, did.middleRows(begin - run.begin, limit.block_rows), begin);
      }
    }
  }

  /// Part of an interval in which the next row's heat is there already: a half where it is switched at any time, 1 where
  /// rows are written after their interval; nothing where it holds or where nobody knows.
  std::optional<double> share() const {
    constexpr HeatThresholds limit;
    const Estimate best = told();
    if (!(best.error < limit.precise) || !(best.value > JackknifeThresholds().sure * best.error))
      return std::nullopt;
    if (!(best.value > limit.least_share) || !(best.value < limit.most_share)) return std::nullopt;
    return best.value > limit.whole ? 1.0 : best.value;
  }

  /// Whether what other recordings tell is another share by more than chance has it: one logger writes all of them.
  bool differs_from(const HeatBetweenRows& others) const {
    constexpr HeatThresholds limit;
    const Estimate here = told(), there = others.told();
    return there.error < limit.precise &&
           std::abs(here.value - there.value) > limit.agree * std::hypot(here.error, there.error);
  }

private:
  static constexpr std::size_t bodies = 3;
  static constexpr Eigen::Index terms = bodies + 2;  ///< what came earlier, the sum, and the bodies

  /// Of the heat's earlier change in the heat, which all terms but the first are given at once.
  /// @param used  terms, from the first on
  static double share_of(const NormalEquations& sums, Eigen::Index used) {
    const Eigen::VectorXd fitted = sums.solve_first(used);
    const double at_once = fitted.tail(used - 1).sum();
    return at_once > 0.0 ? fitted[0] / at_once : plant::missing;
  }

  /// The share as it is told best: one body tells more where it suffices (Hausman 1978, Econometrica 46).
  Estimate told() const {
    const Estimate few = estimate(terms - 2), all = estimate(terms);
    const bool suffices = std::abs(few.value - all.value) < HeatThresholds().agree * all.error;
    return suffices && few.error < all.error ? few : all;
  }

  Estimate estimate(Eigen::Index used) const {
    constexpr HeatThresholds limit;
    const Estimate none{plant::missing, 1e9};
    if (blocks_.size() < limit.least_blocks) return none;
    const std::size_t parts = std::min(JackknifeThresholds().blocks, blocks_.size());
    std::vector<NormalEquations> sums(parts, NormalEquations(terms));
    for (std::size_t i = 0; i < blocks_.size(); ++i) sums[i * parts / blocks_.size()].add(blocks_[i], 1.0);
    const auto [all, without] =
        left_out(sums, [used](const NormalEquations& some) { return share_of(some, used); });
    const double error = jackknife_error(without);
    return std::isfinite(error) ? Estimate{share_of(all, used), error} : none;
  }

  /// The terms of each row of a run: the effect of its heat until there, in J.
  static Eigen::MatrixXd heat_until(const Inputs& inputs, const Eigen::VectorXd& heat_W, const RunSpan& run,
                                    double usual_s) {
    constexpr std::array<double, bodies> hold{30.0, 6.0, 1.5};  // intervals
    Eigen::MatrixXd did(run.size(), terms);
    Eigen::RowVectorXd now = Eigen::RowVectorXd::Zero(terms);
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      did.row(row - run.begin) = now;
      if (row + 1 == run.end) break;
      const double step_s = inputs.t_s[row + 1] - inputs.t_s[row];
      now[0] += (heat_W[row + 1] - heat_W[row]) * step_s;
      now[1] += heat_W[row] * step_s;
      for (std::size_t k = 0; k < bodies; ++k) {
        const double time_constant_s = hold[k] * usual_s, kept = std::exp(-step_s / time_constant_s);
        double& held_J = now[static_cast<Eigen::Index>(k) + 2];
        held_J = kept * held_J + (1.0 - kept) * time_constant_s * heat_W[row];
      }
    }
    return did;
  }

  /// Leaves of each column what its straight line does not tell. @param along  abscissa of the rows
  static void take_line_off(const Eigen::VectorXd& along, Eigen::MatrixXd& columns) {
    const Eigen::VectorXd away = along.array() - along.mean();
    double spread = 0.0;
    for (const double one : away) spread += one * one;
    for (auto column : columns.colwise()) {
      const double mean = column.mean();
      double slope = 0.0;
      for (Eigen::Index i = 0; i < away.size(); ++i) slope += away[i] * column[i] / spread;
      column.array() -= mean + slope * away.array();
    }
  }

  void add_block(const Inputs& inputs, const Eigen::Ref<const Eigen::MatrixXd>& did, Eigen::Index begin) {
    const auto motor_C = inputs.of(Signal::motor_C).segment(begin, did.rows());
    std::vector<Eigen::Index> read;
    for (Eigen::Index i = 0; i < did.rows(); ++i)
      if (std::isfinite(motor_C[i])) read.push_back(i);
    const auto rows = static_cast<Eigen::Index>(read.size());
    if (2 * rows < did.rows()) return;
    Eigen::MatrixXd left(rows, terms + 1);
    left << did(read, Eigen::all), motor_C(read);
    take_line_off(inputs.t_s.segment(begin, did.rows())(read).array() - inputs.t_s[begin], left);
    NormalEquations block(terms);
    for (Eigen::Index i = 0; i < rows; ++i) block.add(left.row(i).head(terms), left(i, terms));
    blocks_.push_back(std::move(block));
  }

  std::vector<NormalEquations> blocks_;
};

/// Part of each interval in which the next row's inputs are in force: `share` where they make another heat, else 0.
inline Eigen::VectorXd switched_share(const Inputs& inputs, const Eigen::VectorXd& heat_W, double share) {
  constexpr double other = 0.01;  // of the range of the heat: less is as well held
  const double least_W = other * (heat_W.maxCoeff() - heat_W.minCoeff());
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(inputs.rows());
  for (const RunSpan& run : inputs.runs)
    for (Eigen::Index row = run.begin; row + 1 < run.end; ++row)
      if (std::abs(heat_W[row + 1] - heat_W[row]) > least_W) shares[row] = share;
  return shares;
}

/// The heat of each row, by the model's law. @param inputs  whose inputs hold until the next row
inline Eigen::VectorXd heat_at_rows(const Model& model, const Catalogue& catalogue, const Inputs& inputs) {
  return plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(plant::heat_told(inputs)).heat_W;
}

/// Whether a loop set the power anew at most rows where it was between its ends. It may have done so between the rows as well, and
/// answered the noise of the very readings that would tell.
inline bool is_set_anew(const Inputs& inputs) {
  const Eigen::VectorXd& power = inputs.power_param;
  if (!inputs.judged(Signal::motor_C) || inputs.heat != HeatSource::law || inputs.next_share.size() > 0 ||
      inputs.target_C.size() > 0 || power.size() < 2)
    return false;
  const double least = power.minCoeff(), most = power.maxCoeff();
  Eigen::Index between = 0, changes = 0;
  for (Eigen::Index row = 1; row < power.size(); ++row)
    if (power[row] > least && power[row] < most) ++between, changes += power[row] != power[row - 1];
  return 2 * changes > between;
}

/// The column that tells the heat.
inline std::string heat_column(const Inputs& inputs) {
  if (inputs.heat_W.size() > 0) return "heat_W";
  if (inputs.heat == HeatSource::law) return "power_param";
  return inputs.heat == HeatSource::drive ? "drive_A" : "current_A";
}

/// The finding about a recording whose power was not held until the next row. @param share  as HeatBetweenRows::share()
inline Finding switched_between_rows(const std::string& recording, const Inputs& inputs, double share) {
  const bool late = share == 1.0;
  return {FindingKind::sampled_command,
          Severity::warning,
          recording,
          heat_column(inputs),
          late ? "is that of the interval before its row, as motor_C shows: it is used for that"
               : "was switched between the rows, as motor_C shows: the next row's is in force for " +
                     short_number(100.0 * share) +
                     " % of an interval on average, and what a simulation wanders by not knowing more "
                     "counts as noise",
          late ? "log the power that is set until the next row"
               : "log the power when it is switched, or its mean between the rows"};
}

}  // namespace thermopower::gap::engine
