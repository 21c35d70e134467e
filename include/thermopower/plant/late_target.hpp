// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace thermopower::plant {

/// A servo's target a part of the way from a row to the next one of its run; 0 where none is recorded.
/// @param values  `target_deg` or `target_dps` of the inputs
/// @param part    0 at the row, 1 at the next one
inline double target_between(const Inputs& inputs, const Eigen::VectorXd& values, const RunSpan& run,
                             Eigen::Index row, double part) {
  if (values.size() == 0) return 0.0;
  if (!inputs.target_moves || row + 1 >= run.end) return values[row];
  return values[row] + (part + inputs.target_lead) * (values[row + 1] - values[row]);
}

/// A servo's target that reaches the servo late: what was recorded a delay ago, with its derivative by the delay.
///
/// Before its first row a run had the target of that row. A target that holds between the rows is averaged over a servo's
/// period or a row's interval, whichever is shorter: delays that differ by less look alike, and a fit needs a slope.
///
/// @snippet plant_examples.cpp bench rollout
/// How to: @ref gap_method, @ref servo_on_a_pendulum.
template <class Scalar>
class LateTarget {
public:
  /// Keeps references to inputs and run.
  /// @param delay_s   >= 0
  /// @param period_s  between the servo's samples, > 0
  LateTarget(const Inputs& inputs, const RunSpan& run, const Scalar& delay_s, double period_s)
      : inputs_(inputs), run_(run), delay_s_(delay_s), period_s_(period_s) {}

  /// The target that has arrived at an instant.
  /// @param values  `target_deg` or `target_dps` of the inputs; 0 where it is empty
  /// @param row     at or before the instant
  /// @param part    how far the instant is on the way to the next row, 0..1
  Scalar operator()(const Eigen::VectorXd& values, Eigen::Index row, double part) const {
    if (values.size() == 0) return constant<Scalar>(0.0);
    const double now_s = stamp(row) + part * interval_s(row), late_s = value_of(delay_s_);
    if (!(late_s > 0.0)) return constant<Scalar>(target_between(inputs_, values, run_, row, part));
    const Eigen::Index then = row_at(row, now_s - late_s);
    if (inputs_.target_moves) return moving(values, then, now_s - late_s);
    const double width_s = std::min({period_s_, interval_s(then), 2.0 * late_s});
    const double to_s = now_s - late_s + 0.5 * width_s, from_s = to_s - width_s;
    if (!(width_s > 0.0)) return constant<Scalar>(values[then]);
    const double mean = integral(values, row, from_s, to_s) / width_s;
    const double first = values[row_at(row, from_s)];
    // A window that ends now widens with the delay; one that does not moves with it.
    const bool widens = 2.0 * late_s <= width_s;
    const double slope = widens ? (first - mean) / late_s : (first - values[row_at(row, to_s)]) / width_s;
    return mean + slope * (delay_s_ - late_s);
  }

  /// Integral over time, from the start of the run to a row, of what the delay takes off the target: the target at once less the
  /// late one.
  Scalar missing_integral(const Eigen::VectorXd& values, Eigen::Index row) const {
    const double late_s = value_of(delay_s_), now_s = stamp(row);
    if (values.size() == 0) return constant<Scalar>(0.0);
    const double first = values[run_.begin], then = values[row_at(row, now_s - late_s)];
    const double lacks = integral(values, row, now_s - late_s, now_s) - late_s * first;
    return lacks + (then - first) * (delay_s_ - late_s);
  }

private:
  double stamp(Eigen::Index row) const { return inputs_.t_s[row]; }
  double interval_s(Eigen::Index row) const { return row + 1 < run_.end ? stamp(row + 1) - stamp(row) : 0.0; }

  /// The row whose target is in force at an instant that is not after the next row of `from`.
  Eigen::Index row_at(Eigen::Index from, double t_s) const {
    Eigen::Index row = from;
    while (row > run_.begin && stamp(row) > t_s + stamp_rounding_s(t_s, stamp(run_.begin))) --row;
    return row;
  }

  Scalar moving(const Eigen::VectorXd& values, Eigen::Index then, double then_s) const {
    const double length_s = interval_s(then);
    if (!(length_s > 0.0) || then_s < stamp(run_.begin)) return constant<Scalar>(values[then]);
    const double per_s = (values[then + 1] - values[then]) / length_s;
    const double target = target_between(inputs_, values, run_, then, (then_s - stamp(then)) / length_s);
    return target - per_s * (delay_s_ - value_of(delay_s_));
  }

  /// Of a target that holds, between two instants that are not after the next row of `row`.
  double integral(const Eigen::VectorXd& values, Eigen::Index row, double from_s, double to_s) const {
    double sum = 0.0;
    for (double end_s = to_s; end_s > from_s; --row) {
      const double begin_s = row > run_.begin ? std::max(stamp(row), from_s) : from_s;
      if (begin_s < end_s) {
        sum += values[row] * (end_s - begin_s);
        end_s = begin_s;
      }
    }
    return sum;
  }

  const Inputs& inputs_;
  const RunSpan& run_;
  Scalar delay_s_;
  double period_s_;
};

}  // namespace thermopower::plant
