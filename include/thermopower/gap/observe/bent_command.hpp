// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// What a drive may give beside a torque in proportion to its command: less of a small one, as a dead band does, less of a large
/// one, as saturation does, and less of one that its gears rub. In a loop the command falls as it is followed, and what a small one gives
/// less of passes for a part of the next one without these.
class BentCommand {
public:
  /// @param commands  that there are, in one unit
  explicit BentCommand(const std::vector<const Eigen::VectorXd*>& commands) {
    const double squares = sum_over(commands, [](double c) { return c * c; }),
                 count = sum_over(commands, [](double) { return 1.0; });
    if (!(squares > 0.0)) return;
    usual_ = std::sqrt(squares / count);
    small_part_ = sum_over(commands, [&](double c) { return c * part_of_small(c); }) / squares;
    large_part_ = sum_over(commands, [&](double c) { return c * part_of_large(c); }) / squares;
  }

  /// Grows in the smallest commands alone; without what of it is in proportion to all of them.
  double small(double command) const { return part_of_small(command) - small_part_ * command; }
  /// Grows most in the largest; without the same.
  double large(double command) const { return part_of_large(command) - large_part_ * command; }
  /// What gears rub of it, against the motion. @param rate  its sign counts
  static double rubbed(double command, double rate) { return std::copysign(command, rate); }

private:
  template <class Of>
  static double sum_over(const std::vector<const Eigen::VectorXd*>& commands, Of&& of) {
    double sum = 0.0;
    for (const Eigen::VectorXd* all : commands)
      for (const double one : *all)
        if (std::isfinite(one)) sum += of(one);
    return sum;
  }
  double part_of_small(double command) const {
    constexpr double small = 0.1;  // of what is usual
    return command / std::hypot(command, small * usual_);
  }
  double part_of_large(double command) const { return command * std::abs(command) / usual_; }

  double usual_ = 1.0;  ///< root mean square
  double small_part_ = 0.0, large_part_ = 0.0;
};

}  // namespace thermopower::gap::engine
