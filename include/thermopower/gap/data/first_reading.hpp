// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/data/neighbour_motion.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thermopower::gap::engine {

/// How far a sample lies from where those after it go back to.
struct BeforeOthers {
  double off = 0.0;      ///< above the parabola through some that follow; 0 where there are not so many
  double off_sds = 0.0;  ///< the same in standard deviations of that difference, >= 0
};

/// @param place    of the sample among the others of its run
/// @param told_by  so many that follow, more than 3
/// @param noise    standard deviation of one of them; more where they show more
inline BeforeOthers before_others(const OrderedSamples& samples, std::size_t place, std::size_t told_by,
                                  double noise) {
  if (samples.size() < place + told_by + 1) return {};
  constexpr Eigen::Index terms = 3;
  const auto rows = static_cast<Eigen::Index>(told_by);
  const double length = samples.at[place + told_by] - samples.at[place];
  Eigen::MatrixXd powers(rows, terms);
  Eigen::VectorXd falls(rows);
  for (std::size_t k = 0; k < told_by; ++k) {
    const std::size_t other = place + k + 1;
    const double x = (samples.at[other] - samples.at[place]) / length;
    powers.row(static_cast<Eigen::Index>(k)) << 1.0, x, x * x;
    falls[static_cast<Eigen::Index>(k)] = samples.values[place] - samples.values[other];
  }
  Eigen::MatrixXd inverse = gram(powers);
  invert_symmetric(inverse);
  const Eigen::VectorXd fitted = transposed_times(inverse, transposed_times(powers, falls));
  const double left = (falls - powers * fitted).squaredNorm() / static_cast<double>(rows - terms);
  const double sd = std::max(noise, std::sqrt(left)) * std::sqrt(1.0 + inverse(0, 0));
  return {fitted[0], sd > 0.0 ? std::abs(fitted[0]) / sd : 0.0};
}

/// How far the first sample of a run lies from where those after it go back to, as a spike does; 0 where it does not.
/// A run that begins with a steep fall has a second sample that lies off, too.
/// @param samples  of a run of a column that cannot jump
/// @param noise    standard deviation of one of them
/// @param sds      standard deviations from which on it is far
inline double first_reading_off(const OrderedSamples& samples, double noise, double sds) {
  constexpr double goes_on = 0.35;  // of how far the first one lies
  double farthest = 0.0;
  for (const std::size_t told_by : {std::size_t{12}, std::size_t{24}}) {
    const BeforeOthers first = before_others(samples, 0, told_by, noise),
                       second = before_others(samples, 1, told_by, noise);
    if (first.off_sds > sds && second.off / first.off < goes_on)
      farthest = std::max(farthest, std::abs(first.off));
  }
  return farthest;
}

}  // namespace thermopower::gap::engine
