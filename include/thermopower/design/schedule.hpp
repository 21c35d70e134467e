// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/gap/recording.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// The shapes that an experiment is made of.
enum class Shape {
  rest,      ///< the input at rest: a body cools, an axis runs out
  hold,      ///< one level
  square,    ///< between two levels, again and again: steps and fast reversals
  triangle,  ///< up and down in straight lines: slow reversals
  sine,      ///< one frequency
  chirp,     ///< a sine that becomes faster
};

/// One part of an experiment: a shape, for how long, and how large.
///
/// How to: @ref design_the_next_experiment.
struct Piece {
  Shape shape = Shape::rest;   ///< what it does
  double duration_s = 1.0;     ///< how long, s, > 0
  double level = 0.0;          ///< middle, -1..1: 0 is at rest, 1 the largest value and -1 the smallest
  double size = 0.0;           ///< amplitude around the middle, 0..1
  double period_s = 1.0;       ///< of a repeated shape, s, > 0; of a chirp the first one
  double last_period_s = 1.0;  ///< of a chirp the last one, s, > 0

  /// Where it is after a time, -1..1.
  double at(double t_s) const {
    assert(duration_s > 0.0 && period_s > 0.0 && last_period_s > 0.0);
    constexpr double turn = 6.283185307179586;
    const double phase = t_s / period_s - std::floor(t_s / period_s);
    switch (shape) {
      case Shape::rest:
        return 0.0;
      case Shape::hold:
        return limited(level);
      case Shape::square:
        return limited(level + (phase < 0.5 ? size : -size));
      case Shape::triangle:
        return limited(level + size * (phase < 0.25   ? 4.0 * phase
                                       : phase < 0.75 ? 2.0 - 4.0 * phase
                                                      : 4.0 * phase - 4.0));
      case Shape::sine:
        return limited(level + size * std::sin(turn * phase));
      case Shape::chirp: {
        const double ratio = period_s / last_period_s, log_ratio = std::log(ratio);
        const double cycles =
            std::abs(log_ratio) < 1e-6
                ? t_s / period_s
                : duration_s / period_s * (std::pow(ratio, t_s / duration_s) - 1.0) / log_ratio;
        return limited(level + size * std::sin(turn * cycles));
      }
    }
    return 0.0;
  }

private:
  static double limited(double value) { return std::clamp(value, -1.0, 1.0); }
};

/// What one varied input does during an experiment.
///
/// How to: @ref design_the_next_experiment.
struct Course {
  std::vector<Piece> pieces;  ///< one after the other; then the input is at rest
  double once = 0.0;          ///< of an input that has one value: where that is, -1..1

  /// How long its pieces take together, s.
  double duration_s() const {
    double sum = 0.0;
    for (const Piece& one : pieces) sum += one.duration_s;
    return sum;
  }
};

/// An experiment: a course for each varied input, in the order of Limits::vary.
///
/// How to: @ref design_the_next_experiment.
struct Experiment {
  std::vector<Course> courses;  ///< of the inputs, one each
  double scale = 1.0;           ///< multiplies everything, 0..1: how far the limits of the motion allow it

  /// How long it takes, s: the longest course.
  double duration_s() const {
    double longest = 0.0;
    for (const Course& one : courses) longest = std::max(longest, one.duration_s());
    return longest;
  }
};

/// The value of a varied input at a place of its range. @param place  -1..1, 0 is at rest
inline double value_at(const VariedInput& input, double place) {
  assert(place >= -1.0 && place <= 1.0);
  const double rest = input.at_rest();
  return place >= 0.0 ? rest + place * (input.to - rest) : rest + place * (rest - input.from);
}

/// The schedule of an experiment: one column for each varied and each held input, in rows of Limits::row_s. A change that is too
/// fast for the input's slope is drawn out. Where an input's range has rest at one end, the other half of a shape is at rest.
/// @param limits  valid ones
inline Recording schedule_of(const Experiment& experiment, const Limits& limits) {
  assert(experiment.courses.size() == limits.vary.size() && limits.row_s > 0.0);
  const double length_s = std::min(experiment.duration_s(), limits.duration_s);
  const auto rows =
      std::max<Eigen::Index>(2, static_cast<Eigen::Index>(std::floor(length_s / limits.row_s + 1e-9)) + 1);
  Recording schedule;
  schedule.name = "schedule";
  schedule.t_s.resize(rows);
  for (Eigen::Index row = 0; row < rows; ++row) schedule.t_s[row] = static_cast<double>(row) * limits.row_s;
  for (std::size_t i = 0; i < limits.vary.size(); ++i) {
    const VariedInput& input = limits.vary[i];
    const Course& course = experiment.courses[i];
    Eigen::VectorXd values(rows);
    if (input.once) {
      values.setConstant(value_at(input, course.once));
    } else {
      std::size_t piece = 0;
      double began_s = 0.0, last = input.at_rest();
      for (Eigen::Index row = 0; row < rows; ++row) {
        const double t_s = schedule.t_s[row];
        while (piece < course.pieces.size() && t_s >= began_s + course.pieces[piece].duration_s - 1e-9)
          began_s += course.pieces[piece++].duration_s;
        const double place = piece < course.pieces.size() ? course.pieces[piece].at(t_s - began_s) : 0.0;
        const double step = input.slope_per_s * limits.row_s;
        const double wanted = value_at(input, experiment.scale * place);
        last =
            row == 0 ? (std::isfinite(step) ? last : wanted) : std::clamp(wanted, last - step, last + step);
        values[row] = last;
      }
    }
    schedule.set(input.column, std::move(values));
  }
  for (const auto& [column, value] : limits.hold)
    schedule.set(column, Eigen::VectorXd::Constant(rows, value));
  return schedule;
}

}  // namespace thermopower::design
