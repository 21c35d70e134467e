// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/gap/recording.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// Random numbers that are the same on every machine: the distributions of the standard library are not.
///
/// How to: @ref design_the_next_experiment.
class Random {
public:
  /// @param seed  the same seed draws the same numbers
  explicit Random(unsigned seed) : engine_(seed) {}

  /// From 0 to 1, 1 not included.
  double share() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// Between two values.
  double uniform(double low, double high) { return low + (high - low) * share(); }
  /// Between two values above 0, each factor as likely as another.
  double log_uniform(double low, double high) {
    assert(low > 0.0 && high > 0.0);
    return low * std::pow(high / low, share());
  }
  /// 0 to count - 1. @param count  above 0
  std::size_t index(std::size_t count) {
    assert(count > 0);
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }
  /// Of a normal distribution around 0 with a standard deviation of 1 (Box and Muller 1958).
  double gauss() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - share()));
    return radius * std::cos(6.283185307179586 * share());
  }

private:
  std::mt19937_64 engine_;
};

/// The shapes that an experiment is made of. A repeated one may become faster or slower: a sine is then a chirp.
enum class Shape {
  hold,      ///< one level; at rest a body cools and an axis runs out
  square,    ///< between two levels, again and again: steps and fast reversals
  triangle,  ///< up and down in straight lines: slow reversals
  sine,      ///< one frequency, or a chirp
};

/// One part of an experiment: a shape, for how long, and how large.
///
/// How to: @ref design_the_next_experiment.
struct Piece {
  Shape shape = Shape::hold;   ///< what it does
  double duration_s = 1.0;     ///< how long, s, > 0
  double level = 0.0;          ///< middle, -1..1: 0 is at rest, 1 the largest value and -1 the smallest
  double size = 0.0;           ///< amplitude around the middle, 0..1
  double period_s = 1.0;       ///< of a repeated shape, s, > 0: the first one
  double last_period_s = 1.0;  ///< the last one, s, > 0

  /// Where it is after a time, -1..1.
  double at(double t_s) const {
    assert(duration_s > 0.0 && period_s > 0.0 && last_period_s > 0.0);
    constexpr double turn = 6.283185307179586;
    // The frequency grows exponentially.
    const double growth = std::log(period_s / last_period_s), share = t_s / duration_s;
    const double cycles =
        growth == 0.0 ? t_s / period_s : duration_s / period_s * std::expm1(growth * share) / growth;
    const double wave = std::sin(turn * (cycles - std::floor(cycles)));
    double place = level;
    if (shape == Shape::square) place += wave >= 0.0 ? size : -size;
    if (shape == Shape::triangle) place += size * std::asin(wave) / (0.25 * turn);
    if (shape == Shape::sine) place += size * wave;
    return std::clamp(place, -1.0, 1.0);
  }
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
  /// Makes every piece longer by a factor. @param by  > 0
  void stretch(double by) {
    for (Course& course : courses)
      for (Piece& part : course.pieces) part.duration_s *= by;
  }
};

/// The schedule of an experiment: one column for each varied and each held input, in rows of Limits::row_s. A change that is too
/// fast for the input's slope is drawn out. Where an input's range has rest at one end, the other half of a shape is at rest.
/// @param limits  valid ones
inline Recording schedule_of(const Experiment& experiment, const Limits& limits) {
  assert(experiment.courses.size() == limits.vary.size() && limits.row_s > 0.0);
  const double length_s = std::min(experiment.duration_s(), limits.duration_s);
  const auto rows = std::max<Eigen::Index>(2, static_cast<Eigen::Index>(length_s / limits.row_s + 1e-9) + 1);
  Recording schedule;
  schedule.name = "schedule";
  schedule.t_s = limits.row_s * Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  for (std::size_t i = 0; i < limits.vary.size(); ++i) {
    const VariedInput& input = limits.vary[i];
    const Course& course = experiment.courses[i];
    const double rest = input.at_rest(), step = input.slope_per_s * limits.row_s;
    const auto value_at = [&](double place) {
      return rest + place * (place >= 0.0 ? input.to - rest : rest - input.from);
    };
    Eigen::VectorXd values = Eigen::VectorXd::Constant(rows, value_at(course.once));
    auto piece = course.pieces.begin();
    double began_s = 0.0, last = rest;
    for (Eigen::Index row = 0; row < rows && !input.once; ++row) {
      const double t_s = schedule.t_s[row];
      while (piece != course.pieces.end() && t_s >= began_s + piece->duration_s - 1e-9)
        began_s += (piece++)->duration_s;
      const double wanted =
          value_at(piece != course.pieces.end() ? experiment.scale * piece->at(t_s - began_s) : 0.0);
      // An input with a slope begins at rest.
      const double reach = row == 0 && std::isfinite(step) ? 0.0 : step;
      values[row] = last = std::clamp(wanted, last - reach, last + reach);
    }
    schedule.set(input.column, std::move(values));
  }
  for (const auto& [column, value] : limits.hold)
    schedule.set(column, Eigen::VectorXd::Constant(rows, value));
  return schedule;
}

/// Draws experiments from the library of shapes, and changes them a little.
///
/// How to: @ref design_the_next_experiment.
class Library {
public:
  /// @param limits  must outlive the object
  explicit Library(const Limits& limits) : limits_(limits) {}

  /// An experiment of a random length, its courses of one to four pieces.
  Experiment draw(Random& random) const {
    Experiment experiment;
    const double length_s = random.log_uniform(limits_.shortest_s(), limits_.duration_s);
    for (const VariedInput& input : limits_.vary) {
      Course course;
      if (input.once) course.once = std::clamp(random.uniform(-2.0, 2.0), least(input), most(input));
      for (std::size_t count = input.once ? 0 : 1 + random.index(4); count > 0; --count)
        course.pieces.push_back(piece(input, length_s * random.uniform(0.4, 1.6), random));
      experiment.courses.push_back(std::move(course));
    }
    if (experiment.duration_s() > 0.0) experiment.stretch(length_s / experiment.duration_s());
    return fitted(std::move(experiment));
  }

  /// The same experiment with one thing changed: a piece, its level and size, its periods or its length, or the length of the whole.
  Experiment changed(Experiment experiment, Random& random) const {
    assert(experiment.courses.size() == limits_.vary.size());
    const std::size_t which = random.index(experiment.courses.size());
    Course& course = experiment.courses[which];
    const VariedInput& input = limits_.vary[which];
    experiment.scale = std::min(1.0, experiment.scale * random.log_uniform(0.8, 1.6));
    if (input.once) {
      course.once = std::clamp(course.once + random.uniform(-0.5, 0.5), least(input), most(input));
      return experiment;
    }
    assert(!course.pieces.empty());
    const std::size_t at = random.index(course.pieces.size());
    Piece& one = course.pieces[at];
    switch (random.index(7)) {
      case 0:
        one = piece(input, one.duration_s, random);
        break;
      case 1:
        one.level = std::clamp(one.level + random.uniform(-0.4, 0.4), least(input), most(input));
        break;
      case 2:
        one.size = std::min(one.size * random.log_uniform(0.5, 2.0), 1.0);
        break;
      case 3:
        one.period_s = within(one.period_s * random.log_uniform(0.4, 2.5));
        one.last_period_s = within(one.last_period_s * random.log_uniform(0.4, 2.5));
        break;
      case 4:
        one.duration_s *= random.log_uniform(0.5, 1.8);
        break;
      case 5:
        experiment.stretch(random.log_uniform(0.6, 1.0));
        break;
      default:
        if (course.pieces.size() > 1 && random.share() < 0.5)
          course.pieces.erase(course.pieces.begin() + static_cast<std::ptrdiff_t>(at));
        else
          course.pieces.push_back(piece(input, experiment.duration_s() * random.uniform(0.1, 0.5), random));
    }
    return fitted(std::move(experiment));
  }

private:
  static double least(const VariedInput& input) { return input.from < input.at_rest() ? -1.0 : 0.0; }
  static double most(const VariedInput& input) { return input.to > input.at_rest() ? 1.0 : 0.0; }

  double within(double period_s) const {
    return std::clamp(period_s, 8.0 * limits_.row_s, 2.0 * limits_.duration_s);
  }

  Piece piece(const VariedInput& input, double duration_s, Random& random) const {
    Piece one;
    one.shape = static_cast<Shape>(random.index(4));
    one.duration_s = duration_s;
    // An axis that is pushed to one side only leaves its range: half of the pieces are even.
    const bool both_ways = least(input) < 0.0 && most(input) > 0.0;
    if (!both_ways || random.share() < 0.5) one.level = random.uniform(least(input), most(input));
    one.size = random.log_uniform(0.1, 1.0);
    one.period_s = within(duration_s * random.log_uniform(0.02, 1.0));
    one.last_period_s =
        random.share() < 0.5 ? one.period_s : within(duration_s * random.log_uniform(0.02, 1.0));
    return one;
  }

  /// No experiment longer than the longest, nor shorter than the shortest.
  Experiment fitted(Experiment experiment) const {
    const double length_s = experiment.duration_s();
    if (length_s > 0.0)
      experiment.stretch(std::clamp(length_s, limits_.shortest_s(), limits_.duration_s) / length_s);
    return experiment;
  }

  const Limits& limits_;
};

}  // namespace thermopower::design
