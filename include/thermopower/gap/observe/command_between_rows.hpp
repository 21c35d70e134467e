// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/command_noise.hpp>
#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/gap/rule.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// @file command_between_rows.hpp
/// What a command did between the rows, and how much of it is noise. A row's command holds until the next one: so says the
/// format, and so it is where the loop that commands also logs. Where a log keeps each twentieth command of a faster loop,
/// holding it is half a row late, and half a row late looks like compliance or a slow drive. Where a log keeps the current
/// that a sensor measured, its noise is no torque. The motion tells which.

namespace thermopower::gap::engine {

/// Thresholds of the questions what a command did between the rows, and whether it is noisy.
/// Held by tests/gap/observe/command_test.cpp.
struct CommandThresholds {
  double least_share = 0.2;  ///< every second command logged is felt by a quarter
  double most_share = 0.65;  ///< a command that changes steadily by half; more is another thing
  double sure = 5.0;         ///< standard errors that a share differs from 0 by
  double precise = 0.08;     ///< largest standard error of the share
  double agree = 2.0;        ///< standard errors that two shares may differ by
  double matters = 0.2;      ///< noise scales of what half a row changes: less is nobody's concern
  double wander = 0.3;       ///< noise scales that a simulation wanders by: less is nobody's concern
};

/// Asks the motion of axes what their command did.
class CommandBetweenRows {
public:
  /// @param horizon_s  over which simulations will run: what noise matters is asked over it; not positive: whole runs
  explicit CommandBetweenRows(double horizon_s = 0.5) : horizon_s_(horizon_s > 0.0 ? horizon_s : 1e9) {}

  /// Adds a recording whose axis is driven by `command`. Keeps references to both: they must outlive this object.
  void add(const Inputs& inputs, const Eigen::VectorXd& command) { motion_.add(inputs, command); }

  /// Part of a command's next step, and how well it is known.
  struct Share {
    double value = 0.0;  ///< 0..1
    double error = 0.0;  ///< standard error
  };

  /// How much of a command's next step the motion shows already before it is logged: 0 of a command that holds, 0.5 of one
  /// that changes steadily, a little less where it is set some times between two rows; nothing where the recordings do not
  /// tell.
  std::optional<Share> share() const { return noise() > 0.0 ? share_of_noisy() : share_of_clean(); }

  /// The share where the command went on between the rows; nothing where it held, where it was late, or where nobody knows.
  std::optional<Share> steady() const { return steady_share(share(), CommandThresholds().least_share); }

  /// A share that is that of a command which went on; nothing of others.
  /// @param least  that it has at least
  static std::optional<Share> steady_share(const std::optional<Share>& share, double least) {
    constexpr CommandThresholds limit;
    return share && share->value > least && share->value < limit.most_share ? share : std::nullopt;
  }

  /// A share and its standard error: none where it may be none, nothing where it is not known well enough.
  static std::optional<Share> sure_of(const std::pair<double, double>& share) {
    constexpr CommandThresholds limit;
    if (!(share.second < limit.precise)) return std::nullopt;
    return Share{std::abs(share.first) < limit.sure * share.second ? 0.0 : share.first, share.second};
  }

  /// Whether the motion follows the first term of a fit by enough to tell of the next. @param noise_dps  of the rate
  static bool is_followed(const MotionFit& fit, double noise_dps) {
    return fit.value[0] != 0.0 && !(0.5 * fit.first_dps < CommandThresholds().matters * noise_dps);
  }

  /// Standard deviation of the noise in the command, in its unit: what it is rough by from row to row and no motion
  /// follows. 0 where there is none, where it moves no simulation over the horizon, or where nobody can tell.
  double noise() const {
    if (!noise_) noise_ = find_noise();
    if (*noise_ > 0.0 && !holds(Rule::command_noise)) noise_ = 0.0;
    return *noise_;
  }

private:
  using Terms = MotionRegression::Terms;
  static constexpr Eigen::Index around = 4;  ///< rows before, and after, of a mean that noise hardly moves

  template <std::size_t count>
  static Terms terms(const double (&values)[count]) {
    Terms list(static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) list[static_cast<Eigen::Index>(i)] = values[i];
    return list;
  }

  /// A row's command, its next step, and what a drive bends it by.
  const MotionRegression::TermsOf& held_and_next() const {
    if (held_and_next_) return held_and_next_;
    held_and_next_ = [bent = motion_.bent_command()](const Inputs& inputs, const Eigen::VectorXd& c,
                                                     const RunSpan& run, Eigen::Index k) {
      const bool moves = k > run.begin || inputs.judged(Signal::rate_dps);
      if (k + 1 >= run.end || !moves) return Terms();
      return terms({c[k], c[k + 1] - c[k], bent.small(c[k]), bent.large(c[k]),
                    BentCommand::rubbed(c[k], MeasuredMotion(inputs, k).rate_dps)});
    };
    return held_and_next_;
  }

  /// Mean and slope of a row of a command around an interval.
  static Terms around_and_slope(const Inputs&, const Eigen::VectorXd& c, const RunSpan& run, Eigen::Index k) {
    if (k + 1 - around < run.begin || k + around >= run.end) return Terms();
    const double before = c.segment(k + 1 - around, around).mean(), after = c.segment(k + 1, around).mean();
    return terms({0.5 * (before + after), (after - before) / static_cast<double>(around)});
  }

  /// From rows and means of them, else from the means around them where single rows are too rough.
  std::optional<Share> share_of_clean() const {
    const std::optional<MotionFit> rows = motion_.fit(held_and_next());
    if (const std::optional<Share> held = share_of_held(rows)) return held;
    const std::optional<Share> from_rows = rows ? share_of(*rows) : std::nullopt;
    return from_rows && smooth() && tells(*smooth()) ? share_around_rows() : from_rows;
  }

  /// From means around the rows: the noise of single ones would make every share a half, more so the fewer rows are taken
  /// together. Where these do not tell, a share that is the same for rows and for their means is no noise's, but that
  /// of a loop that went on between the rows and whose own noise is in the command.
  std::optional<Share> share_of_noisy() const {
    const std::optional<Share> around_rows = share_around_rows();
    return around_rows ? around_rows : share_of_held(motion_.fit(held_and_next()));
  }

  /// From single rows and from means of them, as they can tell a command that holds from one that goes on: the more precise
  /// where both agree, else the means. A controller that was given a noisy motion has its noise in the command, and
  /// the acceleration from row to row the same: means of most rows are freest of that.
  /// @param rows  the fit of single ones
  std::optional<Share> share_of_held(const std::optional<MotionFit>& rows) const {
    constexpr CommandThresholds limit;
    const auto told_by = [&](const std::optional<MotionFit>& fit) {
      return fit && tells(*fit) ? share_of(*fit) : std::nullopt;
    };
    std::optional<Share> means;
    for (const Eigen::Index together : {16, 8, 4})
      if (!means) means = told_by(motion_.fit(held_and_next(), together));
    const std::optional<Share> single = told_by(rows);
    if (!means || !single) return means ? means : single;
    const bool agree =
        std::abs(single->value - means->value) < limit.agree * std::hypot(single->error, means->error);
    return agree && single->error < means->error ? single : means;
  }

  std::optional<Share> share_around_rows() const {
    const std::optional<MotionFit>& fit = smooth();
    if (!fit || fit->value[0] == 0.0) return std::nullopt;
    return sure_of(fit->estimate([](const Eigen::VectorXd& of) { return 0.5 + of[1] / of[0]; }));
  }

  /// Whether a share of none can be told from the least that is believed.
  static bool tells(const MotionFit& fit) {
    constexpr CommandThresholds limit;
    if (fit.value[0] == 0.0) return false;
    const double error = fit.estimate([](const Eigen::VectorXd& of) { return of[1] / of[0]; }).second;
    return limit.sure * error < limit.least_share;
  }

  /// Of the next step of what the first term is.
  std::optional<Share> share_of(const MotionFit& fit) const {
    if (!is_followed(fit, motion_.noise(Signal::rate_dps))) return std::nullopt;
    return sure_of(fit.estimate([](const Eigen::VectorXd& of) { return of[1] / of[0]; }));
  }

  /// What of the command around each row the motion follows.
  const std::optional<MotionFit>& smooth() const {
    if (!smooth_) smooth_ = motion_.fit(around_and_slope);
    return *smooth_;
  }

  /// What the command turns the rate by, deg/s^2 for each of its unit; 0 where nobody knows.
  double response() const { return smooth() ? std::abs(smooth()->value[0]) : 0.0; }

  double find_noise() const {
    constexpr CommandThresholds limit;
    const std::optional<MotionFit>& fit = smooth();
    if (!fit) return 0.0;
    const double response = this->response();
    double step_s = 0.0;
    Eigen::Index rows = 0;
    for (const auto& one : motion_.recordings()) {
      step_s = std::max(step_s, plant::median_interval_s(one.inputs->t_s, one.inputs->runs, 0.0));
      rows += one.inputs->rows();
    }
    CommandNoise spectra(step_s, rows);
    for (const auto& one : motion_.recordings()) {
      spectra.add(*one.inputs, *one.command,
                  [&](double dps, double rad) { return MotionRegression::beside(*fit, dps, rad); });
    }
    const double sd = spectra.sd(response, 0.5 + fit->value[1] / fit->value[0]);
    // A random walk of the rate, and its sum.
    const double wander_dps = response * sd * std::sqrt(step_s * horizon_s_),
                 wander_deg = wander_dps * horizon_s_ / std::sqrt(3.0);
    const double noise_dps = motion_.noise(Signal::rate_dps), noise_deg = motion_.noise(Signal::angle_deg);
    const bool matters = (noise_dps > 0.0 && wander_dps > limit.wander * noise_dps) ||
                         (noise_deg > 0.0 && wander_deg > limit.wander * noise_deg);
    return matters ? sd : 0.0;
  }

  double horizon_s_;
  MotionRegression motion_;
  mutable std::optional<double> noise_;                     ///< once it was asked for
  mutable std::optional<std::optional<MotionFit>> smooth_;  ///< the same
  mutable MotionRegression::TermsOf held_and_next_;         ///< the same
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
  assert(steps.size() == command.size());
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

/// The means of a command over the intervals after each row: it goes straight to the next one; a run's last row holds.
/// @param share  of the next row's command in the mean of an interval: 0.5 where it was set all the time, less where each
///               step of a loop holds a while
inline Eigen::VectorXd mean_command(const Eigen::VectorXd& command, const std::vector<RunSpan>& runs,
                                    double share) {
  Eigen::VectorXd mean = command;
  for (const RunSpan& run : runs)
    for (Eigen::Index row = run.begin; row + 1 < run.end; ++row)
      mean[row] += share * (command[row + 1] - command[row]);
  return mean;
}

}  // namespace thermopower::gap::engine
