// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The parts of a way in whole numbers, against the exponential in double precision.

#include <thermopower/control/certified/bounds.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "../../catch.hpp"

using namespace thermopower;

TEST_CASE("in whole numbers, too, heating is never below the exponential and cooling never above it") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double whole = 4294967296.0;
  double most_above = 0.0, most_below = 0.0;
  for (long i = 0; i < 2000000; ++i) {
    // Holds of 1e-7 to one time constant, and any part of a hold, the shortest among them.
    const float way = static_cast<float>(std::pow(10.0, -7.0 + 7.0 * uniform(random)));
    CertifiedPace pace;
    pace.set(way);
    if (!pace.is_known()) {
      CHECK(way > 0.99f);
      continue;
    }
    const double true_part = uniform(random) < 0.2 ? 20.0 * uniform(random) : 65530.0 * uniform(random);
    const auto told =
        static_cast<std::uint16_t>(static_cast<int>(true_part) + 1 + static_cast<int>(random() % 2));
    const auto slowest =
        static_cast<std::uint16_t>(uniform(random) < 0.3 ? 65535.0 : 65535.0 * uniform(random));
    const CertifiedTravel travel = pace.over(told, slowest);
    const double x = static_cast<double>(way) * true_part / 65536.0;
    const double fast = -std::expm1(-x), slow = -std::expm1(-x * slowest / 65536.0);
    const double heating = travel.heating / whole, cooling = travel.cooling / whole;
    if (heating < fast || cooling > slow)
      FAIL(way << " of a time constant, part " << true_part << ", slowest " << slowest);
    // A tenth of a hold and more: little is given away.
    if (true_part > 6554.0 && way > 1e-4f && way < 0.1f) {
      most_above = std::max(most_above, heating / fast - 1.0);
      if (slowest > 30000) most_below = std::max(most_below, 1.0 - cooling / slow);
    }
  }
  CHECK(most_above < 0.002);
  CHECK(most_below < 0.01);
}

TEST_CASE("a hold of a time constant or more is left to the floats") {
  CertifiedPace pace;
  for (const float way : {1.0f, 5.0f, static_cast<float>(INFINITY), static_cast<float>(NAN), 0.0f, -1.0f}) {
    pace.set(way);
    CHECK_FALSE(pace.is_known());
  }
  pace.set(0.5f);
  CHECK(pace.is_known());
}
