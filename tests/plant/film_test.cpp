// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/plant/film.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/terms.hpp>

#include <algorithm>
#include <cmath>

using namespace thermopower::plant;

TEST_CASE("a film is odd, turns over at slope 1, never carries more than all, and is what its tail says") {
  for (double tail : {-1.0, -0.6, 0.0, 0.3, 1.0}) {
    INFO("tail " << tail);
    CHECK((film_share(1e-6, tail) - film_share(-1e-6, tail)) / 2e-6 == Approx(1.0).epsilon(1e-5));
    double before = 0.0;
    for (double x = 0.0; x < 40.0; x += 0.125) {
      const double share = film_share(x, tail);
      CHECK(share >= before);
      CHECK(share <= 1.0);
      CHECK(film_share(-x, tail) == -share);
      before = share;
    }
  }
  for (double x : {-7.0, -0.4, 0.2, 0.9, 3.0}) {
    CHECK(film_share(x, -1.0) == Approx(std::max(-1.0, std::min(1.0, x))));
    CHECK(film_share(x, 0.0) == Approx(std::tanh(x)));
    CHECK(film_share(x, 1.0) == Approx(x / (1.0 + std::abs(x))));
  }
}

TEST_CASE("a film's slope, and what differentiation makes of the film, are its differences") {
  constexpr double h = 1e-6;
  for (double tail : {-0.8, 0.4})
    for (double x : {-2.5, -0.7, 0.3, 0.8, 1.6, 5.0}) {
      INFO("x " << x << ", tail " << tail);
      const double by_x = (film_share(x + h, tail) - film_share(x - h, tail)) / (2.0 * h);
      const double by_tail = (film_share(x, tail + h) - film_share(x, tail - h)) / (2.0 * h);
      CHECK(film_slope(x, tail) == Approx(by_x).margin(1e-7));
      Dual rate(x), shape(tail);
      rate.seed(0);
      shape.seed(1);
      const Dual share = film_share(rate, shape);
      CHECK(share.value() == Approx(film_share(x, tail)).epsilon(1e-14));
      CHECK(share.slope(0) == Approx(by_x).margin(1e-5));  // single precision
      CHECK(share.slope(1) == Approx(by_tail).margin(1e-5));
      const Dual slope = film_slope(rate, shape);
      CHECK(slope.value() == Approx(film_slope(x, tail)).epsilon(1e-14));
      CHECK(slope.slope(0) ==
            Approx((film_slope(x + h, tail) - film_slope(x - h, tail)) / (2.0 * h)).margin(1e-5));
      CHECK(slope.slope(1) ==
            Approx((film_slope(x, tail + h) - film_slope(x, tail - h)) / (2.0 * h)).margin(1e-5));
    }
}
