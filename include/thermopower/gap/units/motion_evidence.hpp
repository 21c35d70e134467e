// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/bell_regression.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/units/evidence.hpp>
#include <thermopower/plant/sine_cosine.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file motion_evidence.hpp
/// What the columns of an axis say of their units: the rate against the slope of the angle, and the effort that the measured
/// motion needs, with friction, drag, a constant load and gravity left free.

namespace thermopower::gap::engine {

/// Thresholds of what counts as told about an axis' columns.
/// Held by tests/gap/data/scale_test.cpp.
struct MotionEvidenceThresholds {
  Eigen::Index looked_at = 10000;  ///< rows of a recording, about; of longer ones stretches
  Eigen::Index stretch = 1250;     ///< rows of such a stretch
  std::size_t shortest = 2;        ///< intervals of the shortest bell
  std::size_t longest = 512;       ///< of the longest
  int least_bells = 20;            ///< that compare two columns
  std::size_t least_windows = 40;  ///< of a regression
  double moving = 0.05;            ///< of the speed's 95th percentile: slower rows may be stuck
  double over_noise = 3.0;         ///< standard deviations of the rate's noise: slower rows may be stuck
  double alike = 0.97;             ///< correlation of two columns of which one is the other's slope
  double follows = 0.9;            ///< correlation of a target and the motion that follows it
  double partial = 0.7;            ///< correlation of effort and acceleration beside everything else
  double tells_sign =
      0.3;  ///< of the effort's variance that inertia, drag and friction may leave where they tell a sign
  double independent = 10.0;  ///< half the windows that count as independent, at most: a misfit remembers
  double most_nats = 12.0;    ///< that one recording says of a sign
};

/// How one column follows from another: the factor between them, and how alike they are.
struct ColumnRatio {
  double value = missing;  ///< of the one by the other, with its sign; NaN: not told
  double alike = 0.0;      ///< magnitude of their correlation, 0..1

  /// Whether the one is so many times the other.
  bool is_told() const { return alike > MotionEvidenceThresholds().alike; }
};

/// The effort that a motion needs.
struct EffortOnMotion {
  ToldCoefficient inertia;  ///< effort for each deg/s^2
  ToldCoefficient drag;     ///< effort for each deg/s
  ToldCoefficient torque;   ///< effort for each N m from outside; negative where it helps
  double forwards_nats =
      0.0;  ///< log likelihood that inertia, drag and friction are positive, against negative

  /// Whether a coefficient is told.
  static bool is_told(const ToldCoefficient& one) {
    return one.partial > MotionEvidenceThresholds().partial && one.value != 0.0;
  }
};

/// The integral of a column over time, also across rows in which another one was not read: by trapezoids, and over the few rows in
/// which it was not read itself it holds.
class Travel {
public:
  /// @param column  NaN: not read
  Travel(const Eigen::VectorXd& t_s, const std::vector<RunSpan>& runs, const Eigen::VectorXd& column)
      : went_(Eigen::VectorXd::Zero(column.size())), lost_(static_cast<std::size_t>(column.size()), 0) {
    assert(column.size() > 0 && column.size() == t_s.size());
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
class MotionEvidence {
public:
  /// @param inputs  of an axis; must outlive this object
  /// @param voltage  whether a voltage drives it, and not a current
  MotionEvidence(const Inputs& inputs, bool voltage)
      : t_s_(inputs.t_s),
        runs_(some_of(inputs.runs)),
        command_(voltage ? inputs.voltage_V : inputs.drive_A),
        torque_(inputs.torque_Nm),
        interval_s_(plant::median_interval_s(inputs.t_s, inputs.runs)) {
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

  /// The effort regressed on acceleration, rate, direction, a constant and the angle, by the bells that tell most.
  /// @param by_rate  the slope of the recorded rate; else the curvature of the recorded angle
  /// @param earlier  rows by which the command is read later than it was stamped
  /// @param only     intervals of the bells; 0: all lengths
  EffortOnMotion effort(bool by_rate, Eigen::Index earlier = 0, std::size_t only = 0) const {
    constexpr MotionEvidenceThresholds limit;
    EffortOnMotion best;
    const Eigen::VectorXd& moved = by_rate ? rate_ : angle_;
    if (moved.size() == 0 || command_.size() == 0) return best;
    const ReadRows rows(t_s_, runs_, moved);
    const double fastest = fast(rows, moved, by_rate), noise = white_scale(moved, runs_);
    const Eigen::VectorXd angle = last_known(angle_, runs_);
    double least_left = 1.0;
    for (std::size_t length = by_rate ? limit.shortest : 2 * limit.shortest; length <= limit.longest;
         length *= 2) {
      if (only != 0 && length != only) continue;
      const double of_rate = by_rate ? noise : noise / (interval_s_ * static_cast<double>(length / 8 + 1));
      const Reading reading{angle, std::max(limit.moving * fastest, limit.over_noise * of_rate), earlier};
      KeptRegression all, moving;
      rows.for_each_bell(length, [&](const std::vector<ReadRows::Part>& parts) {
        const Window window = by_rate ? window_of_rate(parts, reading) : window_of_angle(parts, reading);
        all.add(window.terms, window.response);
        if (window.moves) moving.add(window.terms, window.response);
      });
      for (const KeptRegression* one : {&moving, &all}) {
        if (one->rows() < limit.least_windows) continue;
        const std::vector<ToldCoefficient> told = one->solve();
        if (told.empty()) continue;
        if (told[0].partial > best.inertia.partial) best.inertia = told[0];
        if (one != &moving) continue;  // one that is held may be driven either way
        if (told[1].partial > best.drag.partial) best.drag = told[1];
        if (has_torque() && told.back().partial > best.torque.partial) best.torque = told.back();
        const double free = one->least_square(directed, 0.0), forwards = one->least_square(directed, 1.0),
                     backwards = one->least_square(directed, -1.0);
        const double left = std::min(forwards, backwards) / free;
        if (!(left < least_left) || left > limit.tells_sign) continue;
        least_left = left;
        const double independent = std::min(limit.independent, 0.5 * one->events(directed));
        best.forwards_nats =
            std::clamp(independent * std::log(backwards / forwards), -limit.most_nats, limit.most_nats);
      }
    }
    return best;
  }

  /// The sign of the effort, as EffortOnMotion::forwards_nats has it. An effort that acts some rows later than its stamp looks
  /// like one of the other sign where it changes from row to row: with the right delay it tells more.
  /// @param at_once  the sign without a delay
  double sign_with_delays(bool by_rate, double at_once) const {
    constexpr Eigen::Index rows_late = 4;
    if (!(at_once < 0.0)) return at_once;
    double told = at_once;
    for (Eigen::Index late = 1; late <= rows_late; ++late) {
      const double delayed = effort(by_rate, -late).forwards_nats;
      if (delayed >= std::abs(told)) told = delayed;
    }
    return told;
  }

  /// The target by the motion that follows it. @param target  of the angle or of the rate
  ColumnRatio target_by(const Eigen::VectorXd& target, const Eigen::VectorXd& motion) const {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    if (target.size() == 0 || motion.size() == 0) return {};
    for (const RunSpan& run : runs_)
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        if (!std::isfinite(target[i]) || !std::isfinite(motion[i])) continue;
        n += 1.0, x += motion[i], y += target[i];
        xx += motion[i] * motion[i], xy += motion[i] * target[i], yy += target[i] * target[i];
      }
    if (n < MotionEvidenceThresholds().least_bells) return {};
    xx -= x * x / n, xy -= x * y / n, yy -= y * y / n;
    if (!(xx > 0.0) || !(yy > 0.0)) return {};
    return {std::copysign(std::sqrt(yy / xx), xy), std::abs(xy) / std::sqrt(xx * yy)};
  }

private:
  static constexpr Eigen::Index directed =
      3;  // first terms, whose sign is that of the effort: inertia, drag, friction

  struct Reading {
    const Eigen::VectorXd& angle;  // without holes
    double slow;                   // below it a row may be stuck
    Eigen::Index earlier;          // rows
  };
  struct Window {
    Eigen::VectorXd terms;
    double response = 0.0;
    bool moves = true;  // throughout
  };

  /// Stretches all over long recordings: some thousand rows tell an order of magnitude as well as a million.
  static std::vector<RunSpan> some_of(const std::vector<RunSpan>& runs) {
    constexpr MotionEvidenceThresholds limit;
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
    constexpr MotionEvidenceThresholds limit;
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
    rows.for_each_bell(
        2 * MotionEvidenceThresholds().shortest, [&](const std::vector<ReadRows::Part>& parts) {
          const Eigen::Index from = parts.front().row, to = parts.back().next;
          speeds.push_back(
              std::abs(by_rate ? moved[from] : (moved[to] - moved[from]) / (t_s_[to] - t_s_[from])));
        });
    return quantile_of(speeds, share);
  }

  bool has_torque() const { return torque_.size() > 0; }

  Window empty_window() const {
    constexpr Eigen::Index without = 4, of_angle = 3;
    Window window;
    window.terms =
        Eigen::VectorXd::Zero(without + (angle_.size() > 0 ? of_angle : 0) + (has_torque() ? 1 : 0));
    return window;
  }

  /// Adds one interval of everything but the acceleration.
  void add(Window& window, const ReadRows::Part& part, double rate, const Reading& reading) const {
    assert(part.row >= 0 && part.row < part.next && part.next < t_s_.size());
    for (Eigen::Index row = part.row; row < part.next; ++row) {
      const Eigen::Index later = std::clamp<Eigen::Index>(row + reading.earlier, 0, command_.size() - 1);
      window.response += part.weight * command_[later] * (t_s_[row + 1] - t_s_[row]);
      if (has_torque())
        window.terms[window.terms.size() - 1] += part.weight * torque_[row] * (t_s_[row + 1] - t_s_[row]);
    }
    const double weight_s = part.weight * part.step_s;
    window.moves = window.moves && std::abs(rate) > reading.slow;
    window.terms[1] += weight_s * rate;
    window.terms[2] += weight_s * std::clamp(rate / reading.slow, -1.0, 1.0);
    window.terms[3] += weight_s;
    if (angle_.size() == 0) return;
    const double deg = 0.5 * (reading.angle[part.row] + reading.angle[part.next]);
    window.terms[4] += weight_s * deg;
    const plant::SineCosine at(deg * rad_per_deg);
    window.terms[5] += weight_s * at.sine;
    window.terms[6] += weight_s * at.cosine;
  }

  Window window_of_rate(const std::vector<ReadRows::Part>& parts, const Reading& reading) const {
    Window window = empty_window();
    for (const ReadRows::Part& one : parts) {
      window.terms[0] += one.weight * (rate_[one.next] - rate_[one.row]);
      add(window, one, 0.5 * (rate_[one.row] + rate_[one.next]), reading);
    }
    return window;
  }

  Window window_of_angle(const std::vector<ReadRows::Part>& parts, const Reading& reading) const {
    assert(!parts.empty());
    constexpr std::size_t part_of_bell = 8;
    Window window = empty_window();
    const std::size_t around = std::max<std::size_t>(1, parts.size() / part_of_bell);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const ReadRows::Part& one = parts[i];
      const Eigen::Index from = parts[i >= around ? i - around : 0].row,
                         to = parts[std::min(i + around, parts.size() - 1)].next;
      window.terms[0] -= one.slope_per_s * (angle_[one.next] - angle_[one.row]);
      add(window, one, (angle_[to] - angle_[from]) / (t_s_[to] - t_s_[from]), reading);
    }
    return window;
  }

  const Eigen::VectorXd& t_s_;
  const std::vector<RunSpan> runs_;  ///< those that are looked at
  const Eigen::VectorXd& command_;
  const Eigen::VectorXd& torque_;
  const double interval_s_;
  Eigen::VectorXd angle_;
  Eigen::VectorXd rate_;
};

}  // namespace thermopower::gap::engine
