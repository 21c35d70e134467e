// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/normal_equations.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/rule.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file under_way.hpp
/// Runs that begin while an axis moves already, and what drove it before.
///
/// Whether a run's first command was in force before its first row. A drive that is late acts on commands from before the log,
/// and nobody wrote them down: a program that starts to log sends its first command some time before, one that starts
/// to drive does not. Where the command stays over the first rows the motion alone tells (was_driven_before()); where it
/// changes from row to row, what the motion makes of earlier commands later in the log has to be known.

namespace thermopower::gap::engine {

/// Thresholds of what begins under way. Held by tests/gap/joint_effects_test.cpp.
struct UnderWayThresholds {
  Eigen::Index rows = 5;      ///< at the beginning of a run that are looked at
  Eigen::Index least = 40;    ///< rows of a run: in fewer nobody can do without its beginning
  Eigen::Index followed = 8;  ///< over which the motion follows a command that stays
  double steady = 0.2;        ///< of the command: what it may change by over these
  double seen = 6.0;          ///< times the noise that the rate must have changed by
  double there = 0.1;         ///< of what is large in the run: less is noise, or a beginning from nothing
};

/// Whether something is there at the first rows of a run already, which is beyond its noise: not one of them is small.
/// @param values  a rate or a command by row, NaN where missing
/// @param rows    of the beginning
inline bool is_there_at_once(const Eigen::VectorXd& values, const RunSpan& run, Eigen::Index rows) {
  constexpr UnderWayThresholds limit;
  std::vector<double> all = finite_samples(values.segment(run.begin, run.size()).cwiseAbs());
  std::vector<double> first = finite_samples(values.segment(run.begin, rows).cwiseAbs());
  if (all.empty() || first.empty()) return false;
  const double large = quantile_of(all, 0.95);
  return large > 0.0 && quantile_of(first, 0.0) > limit.there * large;
}

/// Whether the command at the beginning of a run was in force before it: the motion follows it from the very first row on. A run
/// that begins with its command follows it later, by the drive's delay, or cannot tell a delay of none.
/// @param rate       deg/s by row, NaN where missing
/// @param command    of the drive by row
/// @param of_slopes  the rate is the slope of an angle from each row to the next
inline bool was_driven_before(const Eigen::VectorXd& rate, const Eigen::VectorXd& command,
                              const Eigen::VectorXd& t_s, const RunSpan& run, bool of_slopes = false) {
  constexpr UnderWayThresholds limit;
  if (!is_there_at_once(command, run, 1)) return false;
  const double first = command[run.begin];
  // Seconds that the first command would have had to be in force for, to push as much as those until a row did.
  Eigen::VectorXd pushed_s = Eigen::VectorXd::Zero(limit.followed);
  double at_row_s = 0.0;
  for (Eigen::Index i = 0; i < limit.followed; ++i) {
    const Eigen::Index row = run.begin + i;
    if (!std::isfinite(rate[row]) || !(std::abs(command[row] - first) < limit.steady * std::abs(first)))
      return false;
    const double push_s = (t_s[row + 1] - t_s[row]) * command[row] / first;
    pushed_s[i] = at_row_s + (of_slopes ? 0.5 * push_s : 0.0);
    at_row_s += push_s;
  }
  // The first row stands still in either case: it would draw the line to itself.
  const Eigen::Index fitted = limit.followed - 1;
  const Eigen::VectorXd at_s = pushed_s.tail(fitted), dps = rate.segment(run.begin + 1, fitted);
  const Eigen::VectorXd away_s = at_s.array() - at_s.mean();
  const double slope = away_s.dot(dps) / away_s.squaredNorm(), begins_s = at_s.mean() - dps.mean() / slope;
  const double rise = std::abs(slope) * (pushed_s[fitted] - pushed_s[0]);
  return rise > limit.seen * white_scale(rate, {run}) &&
         begins_s < 0.5 * (t_s[run.begin + 1] - t_s[run.begin]);
}

/// Marks the runs of an axis that begin under way (RunSpan::goes_on): the log was cut out of a longer one, and the axis moves
/// already. Nobody knows then what drove it before, and how far a spring is bent. And those that begin at rest under a command
/// that was there before (RunSpan::was_driven).
inline void mark_under_way(Recording& recording) {
  const Eigen::VectorXd* rate = recording.find("rate_dps");
  Eigen::VectorXd slope;
  recording.runs = recording.spans();
  if (rate == nullptr) {
    const Eigen::VectorXd* angle = recording.find("angle_deg");
    if (angle == nullptr) return;
    const Eigen::VectorXd turns = unwrapped(*angle, recording.runs);
    slope = Eigen::VectorXd::Constant(turns.size(), missing);
    for (const RunSpan& run : recording.runs)
      for (Eigen::Index row = run.begin; row + 1 < run.end; ++row)
        slope[row] = (turns[row + 1] - turns[row]) / (recording.t_s[row + 1] - recording.t_s[row]);
    rate = &slope;
  }
  constexpr UnderWayThresholds limit;
  for (RunSpan& run : recording.runs) {
    if (run.size() < limit.least || run.goes_on) continue;
    run.goes_on = is_there_at_once(*rate, run, limit.rows) && holds(Rule::under_way);
    for (const char* column : {"drive_A", "voltage_V"})
      if (const Eigen::VectorXd* command = recording.find(column))
        run.was_driven =
            was_driven_before(*rate, *command, recording.t_s, run, rate == &slope) && holds(Rule::under_way);
  }
}

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
  /// @param motion  of axes; must outlive this object
  explicit DrivenBefore(const MotionRegression& motion)
      : memory_(motion.fit(remembered)), slowest_dps_(motion.slowest_dps()) {
    if (memory_ && !is_of_a_drive(memory_->value)) memory_.reset();
  }

  /// Whether the first command of a run was in force before it, for as long as the motion remembers, or none was. Nothing
  /// where nobody can tell, and of an axis that remembers no command.
  /// @param command  of the axis by row
  std::optional<bool> was(const Inputs& inputs, const Eigen::VectorXd& command, const RunSpan& run) const {
    constexpr DrivenBeforeThresholds limit;
    if (!memory_) return std::nullopt;
    const std::vector<FirstRow> first = first_rows(inputs, command, run);
    const Answer all = answer_of(first, memory_->value);
    if (!(all.apart > 0.0)) return std::nullopt;
    std::vector<double> without;
    for (const Eigen::VectorXd& one : memory_->without) without.push_back(answer_of(first, one).place);
    const double noise_dps2 = memory_->left_dps2, rows = static_cast<double>(first.size()),
                 of_noise = noise_dps2 * noise_dps2 * (rows + limit.sure * std::sqrt(2.0 * rows)),
                 error = std::hypot(jackknife_error(without), noise_dps2 / std::sqrt(all.apart));
    if (!(limit.sure * error < 1.0 - limit.near)) return std::nullopt;
    const auto is_at = [&](double place, double left) {
      return std::abs(all.place - place) < limit.near && left - of_noise < limit.left * all.apart;
    };
    if (is_at(1.0, all.left_driven)) return true;
    if (is_at(0.0, all.left_idle)) return false;
    return std::nullopt;
  }

private:
  static constexpr Eigen::Index lags = 13;
  /// Rows that a command is older by from which on it belongs to a term, and the row after the last: the next row's, single ones,
  /// then ever more together.
  static constexpr std::array<Eigen::Index, lags + 1> older = {-1, 0, 1, 2, 3, 4, 5, 6, 7, 9, 12, 16, 21, 27};

  /// The commands that act between a row and the next. @param before  the command before the run's first row
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

  /// One of the first rows of a run.
  struct FirstRow {
    double dps2;        ///< its acceleration, less what turns the axis beside its command
    double brake_dps2;  ///< of dry friction, where the axis is so slow that this may hold it; else 0
    Eigen::VectorXd idle, driven;  ///< the terms of either answer

    /// Its acceleration by the command: dry friction holds what rests against no more than itself.
    double turned(const Eigen::VectorXd& response, const Eigen::VectorXd& terms) const {
      const double by = response.dot(terms);
      return std::copysign(std::max(0.0, std::abs(by) - brake_dps2), by);
    }
  };

  /// How two answers do in the first rows.
  struct Answer {
    double place = 0.0;  ///< of the motion, from what an idle axis does, 0, to what a driven one does, 1
    double apart = 0.0;  ///< sum of the squares that the two differ by
    double left_idle = 0.0, left_driven = 0.0;  ///< sums of the squares that either leaves
  };

  std::vector<FirstRow> first_rows(const Inputs& inputs, const Eigen::VectorXd& command,
                                   const RunSpan& run) const {
    const bool by_rate = inputs.judged(Signal::rate_dps);
    std::vector<FirstRow> first;
    const Eigen::Index from = by_rate ? run.begin : run.begin + 1,
                       to = std::min(run.begin + older.back(), run.end - 1);
    for (Eigen::Index row = from; row < to; ++row) {
      const MeasuredMotion motion(inputs, row);
      if (!std::isfinite(motion.acceleration_dps2) || !std::isfinite(motion.angle_rad)) continue;
      const double forward = memory_->beside(1e-9, motion.angle_rad),
                   backward = memory_->beside(-1e-9, motion.angle_rad);
      const bool rests = std::abs(motion.rate_dps) < slowest_dps_;
      const double beside =
          rests ? 0.5 * (forward + backward) : memory_->beside(motion.rate_dps, motion.angle_rad);
      const auto terms = [&](double before) -> Eigen::VectorXd {
        const Eigen::VectorXd here = terms_at(command, run, row, before);
        if (by_rate) return here;
        return 0.5 * (here + terms_at(command, run, row - 1, before));
      };
      first.push_back({motion.acceleration_dps2 - beside,
                       rests ? std::max(0.0, 0.5 * (backward - forward)) : 0.0, terms(0.0),
                       terms(command[run.begin])});
    }
    return first;
  }

  static Answer answer_of(const std::vector<FirstRow>& first, const Eigen::VectorXd& response) {
    Answer answer;
    double product = 0.0;
    for (const FirstRow& row : first) {
      const double idle = row.turned(response, row.idle), driven = row.turned(response, row.driven);
      product += (driven - idle) * (row.dps2 - idle);
      answer.apart += (driven - idle) * (driven - idle);
      answer.left_idle += (row.dps2 - idle) * (row.dps2 - idle);
      answer.left_driven += (row.dps2 - driven) * (row.dps2 - driven);
    }
    if (answer.apart > 0.0) answer.place = product / answer.apart;
    return answer;
  }

  std::optional<MotionFit> memory_;  ///< what the motion makes of the commands around a row
  double slowest_dps_;               ///< slower axes may be stuck
};

}  // namespace thermopower::gap::engine
