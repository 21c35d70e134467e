// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/radians.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// The whole numbers of cycles in a turn that values go with most, best first.
/// @param angle_rad  one per value
/// @param periods    that must lie within the travel, at least
/// @param most       cycles that are tried
/// @param count      of them that are returned, at most; those beside a better one are left out
inline std::vector<double> cycles_in_turn(const Eigen::VectorXd& angle_rad, const Eigen::VectorXd& values,
                                          double periods, int most, std::size_t count) {
  assert(angle_rad.size() == values.size());
  if (values.size() < 8) return {};
  const double travel = angle_rad.maxCoeff() - angle_rad.minCoeff();
  const int first =
      std::max(2, static_cast<int>(std::ceil(periods * plant::rad_per_turn / std::max(travel, 1e-3))));
  std::vector<std::pair<double, int>> power;
  Eigen::ArrayXd sine = (angle_rad.array() * static_cast<double>(first)).sin(),
                 cosine = (angle_rad.array() * static_cast<double>(first)).cos();
  const Eigen::ArrayXd step_sine = angle_rad.array().sin(), step_cosine = angle_rad.array().cos();
  for (int cycles = first; cycles <= most; ++cycles) {
    const double with_sine = (values.array() * sine).sum(), with_cosine = (values.array() * cosine).sum();
    power.emplace_back(-(with_sine * with_sine + with_cosine * with_cosine), cycles);
    const Eigen::ArrayXd next = cosine * step_cosine - sine * step_sine;
    sine = sine * step_cosine + cosine * step_sine;
    cosine = next;
  }
  std::sort(power.begin(), power.end());
  std::vector<double> best;
  for (const auto& [ignored, cycles] : power) {
    if (best.size() == count) break;
    const double at = static_cast<double>(cycles);
    const bool beside =
        std::any_of(best.begin(), best.end(), [&](double one) { return std::abs(one - at) < 1.5; });
    if (!beside) best.push_back(at);
  }
  return best;
}

}  // namespace thermopower::gap::engine
