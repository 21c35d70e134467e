// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file driven_before.hpp
/// Whether a run's first command was in force before its first row. A drive that is late acts on commands from before the log,
/// and nobody wrote them down: a program that starts to log sends its first command some time before, one that starts
/// to drive does not. Where the command stays over the first rows the motion alone tells (was_driven_before()); where it
/// changes from row to row, what the motion makes of earlier commands later in the log has to be known.

namespace thermopower::gap::engine {

/// Thresholds of the question what drove an axis before its first row.
/// Held by tests/gap/observe/driven_before_test.cpp.
struct DrivenBeforeThresholds {
  double near = 0.25;  ///< of the way from idle to driven that a run may be off by
  double sure = 4.0;   ///< standard errors of it that the other answer is away by at least
  double left =
      0.1;  ///< of the squared difference of the answers: the right one leaves no more, beyond the noise
  double back =
      0.3;  ///< of the way that a lasting command pushes: what earlier rows' push back by is no more
};

/// Asks what axes did in their first rows, by what they make of later and earlier commands in all others.
class DrivenBefore {
public:
  /// Adds a recording whose axis is driven by `command`. Keeps references to both: they must outlive this object.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) { motion_.add(inputs, command); }

  /// Whether the first command of a run was in force before it, for as long as the motion remembers, or none was. Nothing
  /// where nobody can tell, and of an axis that remembers no command.
  /// @param command  of the axis by row
  std::optional<bool> was(const Inputs& inputs, const Eigen::VectorXd& command, const RunSpan& run) const {
    constexpr DrivenBeforeThresholds limit;
    if (!memory()) return std::nullopt;
    const Beginning first = beginning_of(inputs, command, run);
    const Answer all = answer_of(first, memory()->value);
    if (!(all.apart > 0.0)) return std::nullopt;
    std::vector<double> without;
    for (const Eigen::VectorXd& one : memory()->without) without.push_back(answer_of(first, one).place);
    const double noise_dps2 = memory()->left_dps2, rows = static_cast<double>(first.dps2.size()),
                 of_noise = noise_dps2 * noise_dps2 * (rows + limit.sure * std::sqrt(2.0 * rows)),
                 error = std::hypot(jackknife_error(without), noise_dps2 / std::sqrt(all.apart));
    const auto is_at = [&](double place, double left) {
      return std::abs(all.place - place) < limit.near && left - of_noise < limit.left * all.apart;
    };
    if (!(limit.sure * error < 1.0 - limit.near)) return std::nullopt;
    if (is_at(1.0, all.left_driven)) return true;
    return is_at(0.0, all.left_idle) ? std::optional<bool>(false) : std::nullopt;
  }

private:
  static constexpr Eigen::Index lags = 13;
  /// Rows that a command is older by from which on it belongs to a term, and the row after the last: the next row's, single ones,
  /// then ever more together.
  static constexpr std::array<Eigen::Index, lags + 1> older = {-1, 0, 1, 2, 3, 4, 5, 6, 7, 9, 12, 16, 21, 27};

  /// What of a command acts between a row and the next. @param before  the command before the run's first row
  static Eigen::VectorXd terms_at(const Eigen::VectorXd& command, const RunSpan& run, Eigen::Index row,
                                  double before) {
    Eigen::VectorXd terms = Eigen::VectorXd::Zero(lags);
    for (std::size_t i = 0; i < lags; ++i)
      for (Eigen::Index age = older[i]; age < older[i + 1]; ++age)
        terms[static_cast<Eigen::Index>(i)] += row - age >= run.begin ? command[row - age] : before;
    return terms;
  }

  static Eigen::VectorXd remembered(const Inputs&, const Eigen::VectorXd& command, const RunSpan& run,
                                    Eigen::Index row) {
    const bool is_whole = row - older.back() >= run.begin && row + 1 < run.end;
    return is_whole ? terms_at(command, run, row, 0.0) : Eigen::VectorXd();
  }

  /// What the motion makes of the commands around a row; nothing where the recordings do not tell.
  const std::optional<MotionFit>& memory() const {
    if (!memory_) {
      memory_ = motion_.fit(remembered);
      if (*memory_ && !is_of_a_drive((*memory_)->value)) memory_->reset();
    }
    return *memory_;
  }

  /// Whether a response to earlier commands is a drive's that is late. Where a command changes so slowly that one row's cannot be told
  /// from the next one's, what comes out follows the log, pushes forth and back by turns, and says nothing of a step.
  static bool is_of_a_drive(const Eigen::VectorXd& response) {
    double forth = 0.0, back = 0.0;
    for (std::size_t i = 0; i < lags; ++i) {
      const double push =
          response[static_cast<Eigen::Index>(i)] * static_cast<double>(older[i + 1] - older[i]);
      (push > 0.0 ? forth : back) += std::abs(push);
    }
    return std::min(forth, back) < DrivenBeforeThresholds().back * std::max(forth, back);
  }

  /// The first rows of a run: their accelerations, less what turns the axis beside its command, and the terms of either answer.
  struct Beginning {
    std::vector<double> dps2;
    std::vector<double> brake_dps2;  ///< of dry friction
    std::vector<bool> rests;         ///< so slow that dry friction may hold it
    std::vector<Eigen::VectorXd> idle, driven;
  };

  /// How two answers do in the first rows.
  struct Answer {
    double place = 0.0;  ///< of the motion, from what an idle axis does, 0, to what a driven one does, 1
    double apart = 0.0;  ///< sum of the squares that the two differ by
    double left_idle = 0.0, left_driven = 0.0;  ///< sums of the squares that either leaves
  };

  Beginning beginning_of(const Inputs& inputs, const Eigen::VectorXd& command, const RunSpan& run) const {
    const bool by_rate = inputs.judged(Signal::rate_dps);
    const double slowest = motion_.slowest_dps();
    Beginning first;
    const Eigen::Index from = by_rate ? run.begin : run.begin + 1,
                       to = std::min(run.begin + older.back(), run.end - 1);
    for (Eigen::Index row = from; row < to; ++row) {
      const MeasuredMotion motion(inputs, row);
      const double rad = MotionRegression::angle_rad(inputs, row);
      if (!std::isfinite(motion.acceleration_dps2) || !std::isfinite(rad)) continue;
      const double forward = MotionRegression::beside(*memory(), 1e-9, rad),
                   backward = MotionRegression::beside(*memory(), -1e-9, rad);
      const bool rests = std::abs(motion.rate_dps) < slowest;
      first.rests.push_back(rests);
      first.brake_dps2.push_back(std::max(0.0, 0.5 * (backward - forward)));
      first.dps2.push_back(
          motion.acceleration_dps2 -
          (rests ? 0.5 * (forward + backward) : MotionRegression::beside(*memory(), motion.rate_dps, rad)));
      const auto terms = [&](double before) {
        const Eigen::VectorXd here = terms_at(command, run, row, before);
        return by_rate ? here : Eigen::VectorXd(0.5 * (here + terms_at(command, run, row - 1, before)));
      };
      first.idle.push_back(terms(0.0));
      first.driven.push_back(terms(command[run.begin]));
    }
    return first;
  }

  static Answer answer_of(const Beginning& first, const Eigen::VectorXd& response) {
    Answer answer;
    double product = 0.0;
    for (std::size_t i = 0; i < first.dps2.size(); ++i) {
      // Dry friction holds what rests against no more than itself.
      const auto turned = [&](const Eigen::VectorXd& terms) {
        const double by = response.dot(terms);
        return first.rests[i] ? std::copysign(std::max(0.0, std::abs(by) - first.brake_dps2[i]), by) : by;
      };
      const double idle = turned(first.idle[i]), driven = turned(first.driven[i]);
      product += (driven - idle) * (first.dps2[i] - idle);
      answer.apart += (driven - idle) * (driven - idle);
      answer.left_idle += (first.dps2[i] - idle) * (first.dps2[i] - idle);
      answer.left_driven += (first.dps2[i] - driven) * (first.dps2[i] - driven);
    }
    if (answer.apart > 0.0) answer.place = product / answer.apart;
    return answer;
  }

  MotionRegression motion_;
  mutable std::optional<std::optional<MotionFit>> memory_;  ///< once it was asked for
};

}  // namespace thermopower::gap::engine
