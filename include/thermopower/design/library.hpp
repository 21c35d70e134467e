// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/random.hpp>
#include <thermopower/design/schedule.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::design {

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
    const double length_s = random.log_uniform(limits_.shortest_s(), limits_.duration_s * 1.0001);
    for (const VariedInput& input : limits_.vary) {
      Course course;
      if (input.once) {
        course.once = random.chance(0.5)   ? random.uniform(least(input), most(input))
                      : random.chance(0.5) ? most(input)
                                           : least(input);
      } else {
        const std::size_t count = 1 + random.index(4);
        std::vector<double> parts;
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) sum += parts.emplace_back(random.uniform(0.4, 1.6));
        for (const double part : parts) course.pieces.push_back(piece(input, length_s * part / sum, random));
      }
      experiment.courses.push_back(std::move(course));
    }
    return experiment;
  }

  /// The same experiment with one thing changed: a piece's shape, level, size, period or length, or the length of the whole.
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
    Piece& one = course.pieces[random.index(course.pieces.size())];
    switch (random.index(7)) {
      case 0:
        one = piece(input, one.duration_s, random);
        break;
      case 1:
        one.level = std::clamp(one.level + random.uniform(-0.4, 0.4), least(input), most(input));
        break;
      case 2:
        one.size = std::clamp(one.size * random.log_uniform(0.5, 2.0), 0.02, 1.0);
        break;
      case 3:
        one.period_s = within(one.period_s * random.log_uniform(0.4, 2.5));
        one.last_period_s = within(one.last_period_s * random.log_uniform(0.4, 2.5));
        break;
      case 4:
        one.duration_s = std::max(4.0 * limits_.row_s, one.duration_s * random.log_uniform(0.5, 1.8));
        break;
      case 5:
        for (Course& each : experiment.courses)
          for (Piece& part : each.pieces) part.duration_s *= 0.8;
        break;
      default:
        if (course.pieces.size() > 1 && random.chance(0.5))
          course.pieces.erase(course.pieces.begin() +
                              static_cast<std::ptrdiff_t>(random.index(course.pieces.size())));
        else if (course.pieces.size() < 6)
          course.pieces.push_back(piece(input, experiment.duration_s() * random.uniform(0.1, 0.5), random));
    }
    fit_in(experiment);
    return experiment;
  }

private:
  static double least(const VariedInput& input) { return input.from < input.at_rest() ? -1.0 : 0.0; }
  static double most(const VariedInput& input) { return input.to > input.at_rest() ? 1.0 : 0.0; }

  double within(double period_s) const {
    assert(8.0 * limits_.row_s <= 2.0 * limits_.duration_s);
    return std::clamp(period_s, 8.0 * limits_.row_s, 2.0 * limits_.duration_s);
  }

  Piece piece(const VariedInput& input, double duration_s, Random& random) const {
    Piece one;
    one.shape = static_cast<Shape>(random.index(6));
    one.duration_s = std::max(4.0 * limits_.row_s, duration_s);
    const bool both_ways = least(input) < 0.0 && most(input) > 0.0;
    // An axis that is pushed to one side only leaves its range: more than half of the shapes are even.
    if (both_ways)
      one.level = one.shape == Shape::hold || random.chance(0.4) ? random.uniform(-1.0, 1.0) : 0.0;
    else one.level = random.uniform(0.1, 1.0) * (most(input) > 0.0 ? 1.0 : -1.0);
    one.size = random.log_uniform(0.1, 1.0);
    one.period_s = within(duration_s * random.log_uniform(0.02, 1.0));
    one.last_period_s = within(duration_s * random.log_uniform(0.02, 1.0));
    return one;
  }

  /// No course longer than the longest experiment, and the longest one no shorter than the shortest.
  void fit_in(Experiment& experiment) const {
    for (Course& course : experiment.courses)
      stretch(course, std::min(1.0, limits_.duration_s / course.duration_s()));
    const double length_s = experiment.duration_s();
    if (length_s < limits_.shortest_s())
      for (Course& course : experiment.courses) stretch(course, limits_.shortest_s() / length_s);
    assert(experiment.duration_s() <= limits_.duration_s * (1.0 + 1e-9));
  }

  static void stretch(Course& course, double by) {
    if (by == 1.0 || !std::isfinite(by)) return;
    for (Piece& part : course.pieces) part.duration_s *= by;
  }

  const Limits& limits_;
};

}  // namespace thermopower::design
