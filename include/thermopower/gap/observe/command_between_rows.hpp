// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/command_noise.hpp>
#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/gap/rule.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

/// @file command_between_rows.hpp
/// The command of an axis between the rows, and its noise, as the motion shows them. By the format, a row's command holds until
/// the next row. A log may keep each twentieth command of a faster loop. To hold it is then half a row late, which looks like
/// compliance or a slow drive. A log may keep the current that a sensor measured. Its noise is not a torque.

namespace thermopower::gap::engine {

/// Thresholds of the questions what a command did between the rows, and whether it is noisy.
/// Held by tests/gap/observe/command_test.cpp.
struct CommandThresholds {
  double least_share = 0.2;  ///< every second command logged is felt by a quarter
  double most_share = 0.65;  ///< a command that changes steadily by half; more is another thing
  double precise = 0.08;     ///< largest standard error of the share
  double agree = 2.0;        ///< standard errors that two shares may differ by
  double matters = 0.2;      ///< noise scales of what half a row changes: less is nobody's concern
  double wander = 0.3;       ///< noise scales that a simulation wanders by: less is nobody's concern
};

/// Where a share may be none it is none; nothing where it is not known well enough.
inline std::optional<Estimate> sure_of(Estimate share) {
  constexpr CommandThresholds limit;
  if (!(share.error < limit.precise)) return std::nullopt;
  if (std::abs(share.value) < JackknifeThresholds().sure * share.error) share.value = 0.0;
  return share;
}

/// A share that is that of a command which went on; nothing of others. @param least  that it has at least
inline std::optional<Estimate> steady_share(const std::optional<Estimate>& share, double least) {
  return share && share->value > least && share->value < CommandThresholds().most_share ? share
                                                                                        : std::nullopt;
}

/// Whether the motion follows the first term of a fit by enough to tell of the next. @param noise_dps  of the rate
inline bool is_followed(const MotionFit& fit, double noise_dps) {
  return fit.value[0] != 0.0 && !(0.5 * fit.first_dps < CommandThresholds().matters * noise_dps);
}

/// Asks the motion of axes what their command did.
class CommandBetweenRows {
public:
  /// @param motion     of these axes; must outlive this object
  /// @param horizon_s  over which simulations will run: what noise matters is asked over it; not positive: whole runs
  explicit CommandBetweenRows(const MotionRegression& motion, double horizon_s = 0.5)
      : motion_(motion), smooth_(motion.fit(around_and_slope)) {
    noise_ = find_noise(horizon_s > 0.0 ? horizon_s : 1e9);
    if (noise_ > 0.0 && !holds(Rule::command_noise)) noise_ = 0.0;
  }

  /// Standard deviation of the noise in the command, in its unit: what it is rough by from row to row and no motion
  /// follows. 0 where there is none, where it moves no simulation over the horizon, or where nobody can tell.
  double noise() const { return noise_; }

  /// How much of a command's next step the motion shows already before it is logged: 0 of a command that holds, 0.5 of one
  /// that changes steadily, a little less where it is set some times between two rows; nothing where the recordings do not
  /// tell.
  ///
  /// Noise of single rows would make every share a half, more so the fewer rows are taken together: means around the rows tell
  /// first. Where these do not, a share that is the same for rows and for their means is no noise's, but that of a loop that went on
  /// between the rows and whose own noise is in the command.
  std::optional<Estimate> share() const {
    const std::optional<Estimate> around_rows = share_around_rows();
    if (noise_ > 0.0 && around_rows) return around_rows;
    const std::optional<MotionFit> rows = motion_.fit(held_and_next());
    const std::optional<Estimate> held = share_of_held(rows);
    if (held || noise_ > 0.0) return held;
    // Single rows may be too rough.
    const std::optional<Estimate> from_rows = share_of(rows);
    return from_rows && tells(smooth_) ? around_rows : from_rows;
  }

  /// The share where the command went on between the rows; nothing where it held, where it was late, or where nobody knows.
  std::optional<Estimate> steady() const { return steady_share(share(), CommandThresholds().least_share); }

private:
  using Terms = MotionRegression::Terms;
  static constexpr Eigen::Index around = 4;  ///< rows before, and after, of a mean that noise hardly moves

  /// A row's command, its next step, and what a drive bends it by.
  MotionRegression::TermsOf held_and_next() const {
    return [bent = motion_.bent_command()](const Inputs& inputs, const Eigen::VectorXd& c, const RunSpan& run,
                                           Eigen::Index k) {
      const bool moves = k > run.begin || inputs.judged(Signal::rate_dps);
      if (k + 1 >= run.end || !moves) return Terms();
      return Terms{{c[k], c[k + 1] - c[k], bent.small(c[k]), bent.large(c[k]),
                    BentCommand::rubbed(c[k], MeasuredMotion(inputs, k).rate_dps)}};
    };
  }

  /// Mean and slope of a row of a command around an interval.
  static Terms around_and_slope(const Inputs&, const Eigen::VectorXd& c, const RunSpan& run, Eigen::Index k) {
    if (k + 1 - around < run.begin || k + around >= run.end) return Terms();
    const double before = c.segment(k + 1 - around, around).mean(), after = c.segment(k + 1, around).mean();
    return Terms{{0.5 * (before + after), (after - before) / static_cast<double>(around)}};
  }

  /// From single rows and from means of them, as they can tell a command that holds from one that goes on: the more precise
  /// where both agree, else the means. A controller that was given a noisy motion has its noise in the command, and
  /// the acceleration from row to row the same: means of most rows are freest of that.
  /// @param rows  the fit of single ones
  std::optional<Estimate> share_of_held(const std::optional<MotionFit>& rows) const {
    const auto told_by = [&](const std::optional<MotionFit>& fit) {
      return tells(fit) ? share_of(fit) : std::nullopt;
    };
    std::optional<Estimate> means;
    for (const std::size_t together : {16, 8, 4})
      if (!means) means = told_by(motion_.fit(held_and_next(), together));
    const std::optional<Estimate> single = told_by(rows);
    if (!means || !single) return means ? means : single;
    const bool agree = std::abs(single->value - means->value) <
                       CommandThresholds().agree * std::hypot(single->error, means->error);
    return agree && single->error < means->error ? single : means;
  }

  std::optional<Estimate> share_around_rows() const {
    return smooth_ && smooth_->value[0] != 0.0 ? sure_of(smooth_->second_by_first(0.5)) : std::nullopt;
  }

  /// Whether a share of none can be told from the least that is believed.
  static bool tells(const std::optional<MotionFit>& fit) {
    return fit && fit->value[0] != 0.0 &&
           JackknifeThresholds().sure * fit->second_by_first().error < CommandThresholds().least_share;
  }

  /// Of the next step of what the first term is.
  std::optional<Estimate> share_of(const std::optional<MotionFit>& fit) const {
    const bool is_told = fit && is_followed(*fit, motion_.noise(Signal::rate_dps));
    return is_told ? sure_of(fit->second_by_first()) : std::nullopt;
  }

  double find_noise(double horizon_s) const {
    if (!smooth_) return 0.0;
    const CommandNoise spectra(motion_, *smooth_);
    const double sd = spectra.sd();
    // A random walk of the rate, and its sum.
    const double wander_dps = std::abs(smooth_->value[0]) * sd * std::sqrt(spectra.step_s() * horizon_s),
                 wander_deg = wander_dps * horizon_s / std::sqrt(3.0);
    const auto matters = [&](double wander, Signal signal) {
      const double noise = motion_.noise(signal);
      return noise > 0.0 && wander > CommandThresholds().wander * noise;
    };
    return matters(wander_dps, Signal::rate_dps) || matters(wander_deg, Signal::angle_deg) ? sd : 0.0;
  }

  const MotionRegression& motion_;
  std::optional<MotionFit> smooth_;  ///< what of the command around each row the motion follows
  double noise_ = 0.0;
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
inline Eigen::VectorXd unknown_between(const Eigen::VectorXd& command, const std::vector<RunSpan>& runs) {
  const double of_a_step = 1.0 / std::sqrt(12.0);  // a uniform distribution's
  // Of white noise: that of a mean of four or more, which nobody logged, and two fifths to a half of either end's.
  constexpr double of_noise = 0.7;
  const double noise = of_noise * white_scale(command, runs);
  const Eigen::VectorXd steps = steps_of(command, runs);
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
  return command + share * steps_of(command, runs);
}

}  // namespace thermopower::gap::engine
