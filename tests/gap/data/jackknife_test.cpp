// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The standard error by leaving out one after another.

#include <cmath>
#include <limits>
#include <thermopower/gap/data/normal_equations.hpp>
#include <vector>

#include "../../catch.hpp"

using thermopower::gap::engine::jackknife_error;

TEST_CASE("the jackknife of a mean is its standard error") {
  // Of 1, 2, 4, 5 the mean is 3, the sum of squares around it 10, and the standard error sqrt(10 / (4 * 3)). The means of
  // the three others:
  const std::vector<double> left_out = {11.0 / 3.0, 10.0 / 3.0, 8.0 / 3.0, 7.0 / 3.0};
  CHECK(jackknife_error(left_out) == Approx(std::sqrt(10.0 / 12.0)));
}

TEST_CASE("a jackknife of fewer than two has no spread, and one of what is not finite no number") {
  CHECK(jackknife_error({}) == 0.0);
  CHECK(jackknife_error({3.0}) == 0.0);
  CHECK(std::isnan(jackknife_error({1.0, std::numeric_limits<double>::infinity(), 2.0})));
  CHECK(std::isnan(jackknife_error({1.0, std::numeric_limits<double>::quiet_NaN()})));
}
