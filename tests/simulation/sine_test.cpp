// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/sine.hpp>

#include <cmath>
#include <limits>

#include "../catch.hpp"

using thermopower::simulation::sine;

TEST_CASE("The simulation's sine is right to 1e-12 in double") {
  double worst = 0.0;
  for (int i = -200000; i <= 200000; ++i) {
    const double angle = 0.0314159 * i;  // a thousand turns either way
    worst = std::fmax(worst, std::fabs(sine(angle) - std::sin(angle)));
  }
  CHECK(worst < 1e-12);
}

TEST_CASE("The simulation's sine is right to 1e-6 in float") {
  double worst = 0.0;
  for (int i = -40000; i <= 40000; ++i) {
    const float angle = 1e-4f * static_cast<float>(i);
    worst =
        std::fmax(worst, std::fabs(static_cast<double>(sine(angle)) - std::sin(static_cast<double>(angle))));
  }
  CHECK(worst < 1e-6);
}

TEST_CASE("The sine of what is no angle is no number") {
  CHECK(std::isnan(sine(std::numeric_limits<double>::quiet_NaN())));
  CHECK(std::isnan(sine(std::numeric_limits<double>::infinity())));
}
