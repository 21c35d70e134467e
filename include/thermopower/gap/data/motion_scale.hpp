// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/bell_regression.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file motion_scale.hpp
/// How large the numbers of an axis' columns are against each other and against what drives it, whatever friction or load
/// a simulation lacks.

namespace thermopower::gap::engine {

/// Thresholds of what counts as told about the size of an axis' columns.
/// Held by tests/gap/data/scale_test.cpp.
struct MotionScaleThresholds {
  Eigen::Index looked_at = 10000;  ///< rows of a recording, about; of longer ones stretches
  Eigen::Index stretch = 1250;     ///< rows of such a stretch
  std::size_t shortest = 2;        ///< intervals of the shortest bell
  std::size_t longest = 512;       ///< of the longest
  int least_bells = 20;            ///< that compare two columns
  std::size_t least_windows = 40;  ///< of a regression
  double moving = 0.05;            ///< of the speed's 95th percentile: slower rows may be stuck
  double alike = 0.97;             ///< correlation of two columns of which one is the other's slope
  double partial = 0.7;            ///< correlation of command and acceleration beside everything else
  double significance = 8.0;       ///< standard errors that the coefficient of the command is from 0
};

/// How one column follows from another: the factor between them, and how alike they are.
struct ColumnRatio {
  double value = missing;  ///< of the one by the other, with its sign; NaN: not told
  double alike = 0.0;      ///< magnitude of their correlation, 0..1

  /// Whether the one is so many times the other.
  bool is_told() const { return alike > MotionScaleThresholds().alike; }
};

/// What the command and the rate do to the acceleration.
struct MotionTold {
  ToldCoefficient drive;  ///< deg/s^2 as recorded for each A or V
  ToldCoefficient drag;   ///< 1/s, negative for a drag

  /// Whether the command's part is told.
  bool is_told() const {
    constexpr MotionScaleThresholds limit;
    return drive.partial > limit.partial && drive.significance() > limit.significance && drive.value != 0.0;
  }
};

/// The integral of a column over time, also across rows in which another one was not read: by trapezoids, and over the few rows in
/// which it was not read itself it holds.
class Travel {
public:
  /// @param column  NaN: not read
  Travel(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs, const Eigen::VectorXd& column)
      : went_(Eigen::VectorXd::Zero(column.size())), lost_(static_cast<std::size_t>(column.size()), 0) {
    // A column may be read more seldom than others.
    const Eigen::Index read = std::max<Eigen::Index>(1, column.array().isFinite().count()),
                       longest_hole = 8 * (column.size() / read);
    const Eigen::VectorXd held = last_known(column, runs);
    for (const RunSpan& run : runs) {
      Eigen::Index known = run.begin;
      for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
        if (std::isfinite(column[i])) known = i;
        const double way = 0.5 * (held[i - 1] + held[i]) * (t_s[i] - t_s[i - 1]);
        const bool is_lost = i - known > longest_hole || !std::isfinite(way);
        went_[i] = went_[i - 1] + (is_lost ? 0.0 : way);
        lost_[static_cast<std::size_t>(i)] = lost_[static_cast<std::size_t>(i - 1)] + (is_lost ? 1 : 0);
      }
    }
  }

  /// Of two rows of one run.
  double between(Eigen::Index row, Eigen::Index next) const { return went_[next] - went_[row]; }
  /// Whether it was read between them.
  bool is_known(Eigen::Index row, Eigen::Index next) const {
    return lost_[static_cast<std::size_t>(row)] == lost_[static_cast<std::size_t>(next)];
  }

private:
  Eigen::VectorXd went_;
  std::vector<int> lost_;  // rows so far in which it was not
};

/// The columns of an axis against each other and against what drives it.
class MotionScale {
public:
  /// @param inputs  of an axis; must outlive this object
  /// @param voltage  whether a voltage drives it, and not a current
  MotionScale(const Inputs& inputs, bool voltage)
      : t_s_(inputs.t_s), runs_(some_of(inputs.runs)), command_(voltage ? inputs.voltage_V : inputs.drive_A) {
    if (inputs.judged(Signal::angle_deg)) angle_ = inputs.of(Signal::angle_deg);
    if (inputs.judged(Signal::rate_dps)) rate_ = inputs.of(Signal::rate_dps);
  }

  /// The rate by the slope of the angle: 1 in one unit.
  ColumnRatio rate_by_slope_of_angle() const { return ratio_to_slope(rate_, angle_); }
  /// The angle by the slope of the rate: 1 where they are exchanged.
  ColumnRatio angle_by_slope_of_rate() const { return ratio_to_slope(angle_, rate_); }
  /// The rate by the slope of the command: 1 where angle and command are exchanged.
  ColumnRatio rate_by_slope_of_command() const { return ratio_to_slope(rate_, command_); }
  /// The command by the slope of the angle: 1 where rate and command are exchanged.
  ColumnRatio command_by_slope_of_angle() const { return ratio_to_slope(command_, angle_); }

  /// The acceleration regressed on command, rate, direction, a constant and the angle, by the bells that tell the command's
  /// part best.
  /// @param by_rate  the slope of the recorded rate; else the curvature of the recorded angle
  MotionTold regressed(bool by_rate) const {
    constexpr MotionScaleThresholds limit;
    MotionTold best;
    const Eigen::VectorXd& moved = by_rate ? rate_ : angle_;
    if (moved.size() == 0 || command_.size() == 0) return best;
    const ReadRows rows(t_s_, runs_, moved);
    const double slow = limit.moving * fast(rows, moved, by_rate);
    const Eigen::VectorXd angle = last_known(angle_, runs_);
    for (std::size_t length = by_rate ? limit.shortest : 2 * limit.shortest; length <= limit.longest;
         length *= 2) {
      KeptRegression all, moving;
      rows.for_each_bell(length, [&](const std::vector<ReadRows::Part>& parts) {
        const Window window =
            by_rate ? window_of_rate(parts, angle, slow) : window_of_angle(parts, angle, slow);
        all.add(window.terms, window.response);
        if (window.moves) moving.add(window.terms, window.response);
      });
      for (const KeptRegression* one : {&moving, &all}) {
        if (one->rows() < limit.least_windows) continue;
        const std::vector<ToldCoefficient> told = one->solve();
        if (!told.empty() && told[0].partial > best.drive.partial) best = {told[0], told[1]};
      }
    }
    return best;
  }

private:
  struct Window {
    Eigen::VectorXd terms;
    double response = 0.0;
    bool moves = true;  // throughout
  };

  /// Stretches all over long recordings: some thousand rows tell an order of magnitude as well as a million.
  static std::vector<RunSpan> some_of(const std::vector<RunSpan>& runs) {
    constexpr MotionScaleThresholds limit;
    Eigen::Index rows = 0;
    for (const RunSpan& run : runs) rows += run.size();
    const Eigen::Index parts = rows / limit.looked_at;
    if (parts < 2) return runs;
    std::vector<RunSpan> some;
    Eigen::Index before = 0;  // rows of the runs so far
    for (const RunSpan& run : runs) {
      for (Eigen::Index from = run.begin; from < run.end; from += limit.stretch) {
        const Eigen::Index place = (before + from - run.begin) / limit.stretch;
        if (place % parts != 0) continue;
        some.push_back(run);
        some.back().begin = from;
        some.back().end = std::min(from + limit.stretch, run.end);
      }
      before += run.size();
    }
    return some;
  }

  /// What one column is of another one's slope in time, by the bells under which they are most alike.
  ColumnRatio ratio_to_slope(const Eigen::VectorXd& column, const Eigen::VectorXd& whole) const {
    constexpr MotionScaleThresholds limit;
    ColumnRatio best;
    if (column.size() == 0 || whole.size() == 0) return best;
    const Travel travel(t_s_, runs_, column);
    const ReadRows rows(t_s_, runs_, whole);
    for (std::size_t length = limit.shortest; length <= limit.longest; length *= 2) {
      double xx = 0.0, xy = 0.0, yy = 0.0;
      int count = 0;
      rows.for_each_bell(length, [&](const std::vector<ReadRows::Part>& parts) {
        if (!travel.is_known(parts.front().row, parts.back().next)) return;
        double x = 0.0, y = 0.0;
        for (const ReadRows::Part& one : parts) {
          x += one.weight * (whole[one.next] - whole[one.row]);
          y += one.weight * travel.between(one.row, one.next);
        }
        if (!std::isfinite(x) || !std::isfinite(y)) return;
        xx += x * x, xy += x * y, yy += y * y, ++count;
      });
      if (count < limit.least_bells || !(xx > 0.0) || !(yy > 0.0)) continue;
      const double alike = std::abs(xy) / std::sqrt(xx * yy);
      if (alike > best.alike) best = {std::copysign(std::sqrt(yy / xx), xy), alike};
    }
    return best;
  }

  /// 95th percentile of the speed.
  double fast(const ReadRows& rows, const Eigen::VectorXd& moved, bool by_rate) const {
    constexpr double share = 0.95;
    std::vector<double> speeds;
    rows.for_each_bell(2 * MotionScaleThresholds().shortest, [&](const std::vector<ReadRows::Part>& parts) {
      const Eigen::Index from = parts.front().row, to = parts.back().next;
      speeds.push_back(std::abs(by_rate ? moved[from] : (moved[to] - moved[from]) / (t_s_[to] - t_s_[from])));
    });
    return quantile_of(speeds, share);
  }

  /// Adds to the terms what the command and everything but the drag is in one interval.
  void add_terms(Window& window, const ReadRows::Part& part, double rate, double slow,
                 const Eigen::VectorXd& angle) const {
    double command = 0.0;
    for (Eigen::Index row = part.row; row < part.next; ++row)
      command += command_[row] * (t_s_[row + 1] - t_s_[row]);
    const double weight_s = part.weight * part.step_s;
    window.moves = window.moves && std::abs(rate) > slow;
    window.terms[0] += part.weight * command;
    window.terms[2] += weight_s * std::clamp(rate / slow, -1.0, 1.0);
    window.terms[3] += weight_s;
    if (angle.size() == 0) return;
    const double deg = 0.5 * (angle[part.row] + angle[part.next]);
    window.terms[4] += weight_s * deg;
    const plant::SineCosine at(deg * rad_per_deg);
    window.terms[5] += weight_s * at.sine;
    window.terms[6] += weight_s * at.cosine;
  }

  Window empty_window(const Eigen::VectorXd& angle) const {
    constexpr Eigen::Index with_angle = 7, without = 4;
    Window window;
    window.terms = Eigen::VectorXd::Zero(angle.size() > 0 ? with_angle : without);
    return window;
  }

  Window window_of_rate(const std::vector<ReadRows::Part>& parts, const Eigen::VectorXd& angle,
                        double slow) const {
    Window window = empty_window(angle);
    for (const ReadRows::Part& one : parts) {
      const double rate = 0.5 * (rate_[one.row] + rate_[one.next]);
      window.response += one.weight * (rate_[one.next] - rate_[one.row]);
      window.terms[1] += one.weight * rate * one.step_s;
      add_terms(window, one, rate, slow, angle);
    }
    return window;
  }

  Window window_of_angle(const std::vector<ReadRows::Part>& parts, const Eigen::VectorXd& angle,
                         double slow) const {
    constexpr std::size_t part_of_bell = 8;
    Window window = empty_window(angle);
    const std::size_t around = std::max<std::size_t>(1, parts.size() / part_of_bell);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const ReadRows::Part& one = parts[i];
      const Eigen::Index from = parts[i >= around ? i - around : 0].row,
                         to = parts[std::min(i + around, parts.size() - 1)].next;
      const double change = angle_[one.next] - angle_[one.row];
      window.response -= one.slope_per_s * change;
      window.terms[1] += one.weight * change;
      add_terms(window, one, (angle_[to] - angle_[from]) / (t_s_[to] - t_s_[from]), slow, angle);
    }
    return window;
  }

  const Eigen::VectorXd& t_s_;
  const std::vector<RunSpan> runs_;  ///< those that are looked at
  const Eigen::VectorXd& command_;
  Eigen::VectorXd angle_;
  Eigen::VectorXd rate_;
};

}  // namespace thermopower::gap::engine
