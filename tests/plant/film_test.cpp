// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/plant/effects/stribeck_friction.hpp>
#include <thermopower/plant/film.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/sine_cosine.hpp>
#include <thermopower/plant/terms.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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
      const auto slope_at = [](double rate, double tail_there) {
        return FilmWithSlope<double>(rate, tail_there).slope;
      };
      CHECK(slope_at(x, tail) == Approx(by_x).margin(1e-7));
      CHECK(FilmWithSlope<double>(x, tail).share == Approx(film_share(x, tail)).epsilon(1e-14));
      Dual rate(x), shape(tail);
      rate.seed(0);
      shape.seed(1);
      const Dual share = film_share(rate, shape);
      CHECK(share.value() == Approx(film_share(x, tail)).epsilon(1e-14));
      CHECK(share.slope(0) == Approx(by_x).margin(1e-5));  // single precision
      CHECK(share.slope(1) == Approx(by_tail).margin(1e-5));
      const FilmWithSlope<Dual> film(rate, shape);
      CHECK(film.share.slope(0) == share.slope(0));
      CHECK(film.share.slope(1) == share.slope(1));
      CHECK(film.slope.value() == Approx(slope_at(x, tail)).epsilon(1e-14));
      CHECK(film.slope.slope(0) ==
            Approx((slope_at(x + h, tail) - slope_at(x - h, tail)) / (2.0 * h)).margin(1e-5));
      CHECK(film.slope.slope(1) ==
            Approx((slope_at(x, tail + h) - slope_at(x, tail - h)) / (2.0 * h)).margin(1e-5));
    }
}

TEST_CASE("what is left of a friction's rise, differentiated, is its differences") {
  constexpr double h = 1e-6;
  const auto left = [](double x, double exponent) { return std::exp(-std::pow(x, exponent)); };
  for (double exponent : {0.9, 2.0, 3.5})
    for (double x : {0.01, 0.4, 1.0, 1.7}) {
      INFO("x " << x << ", exponent " << exponent);
      CHECK(stribeck_share(x, exponent) == Approx(left(x, exponent)).epsilon(1e-12));
      Dual rate(x), power(exponent);
      rate.seed(0);
      power.seed(1);
      const Dual share = stribeck_share(rate, power);
      CHECK(share.value() == Approx(left(x, exponent)).epsilon(1e-12));
      CHECK(share.slope(0) ==
            Approx((left(x + h, exponent) - left(x - h, exponent)) / (2.0 * h)).margin(1e-5));
      CHECK(share.slope(1) ==
            Approx((left(x, exponent + h) - left(x, exponent - h)) / (2.0 * h)).margin(1e-5));
    }
  Dual still(0.0), two(2.0);
  still.seed(0);
  CHECK(stribeck_share(still, two).value() == Approx(1.0));
  CHECK(stribeck_share(still, two).slope(0) == 0.0);
}

TEST_CASE("sine and cosine are the C library's to some units in the last place, at every angle") {
  const auto close = [](double ours, double theirs) { return std::abs(ours - theirs) <= 4e-16; };
  for (const double step : {0.0137, 0.731, 41.9, 977.3})
    for (int i = -1000; i <= 1000; ++i) {
      const double angle = step * i;
      CAPTURE(angle);
      const SineCosine at(angle);
      CHECK(close(at.sine, std::sin(angle)));
      CHECK(close(at.cosine, std::cos(angle)));
    }
  for (int quarter = -9; quarter <= 9; ++quarter)  // where a quarter turn ends and the next one begins
    for (const double beside : {-1e-9, 0.0, 1e-9}) {
      const double angle = (quarter + 0.5) * 1.5707963267948966 + beside;
      CHECK(close(SineCosine(angle).sine, std::sin(angle)));
      CHECK(close(SineCosine(angle).cosine, std::cos(angle)));
    }
  CHECK(SineCosine(0.0).sine == 0.0);
  CHECK(SineCosine(0.0).cosine == 1.0);
  CHECK(SineCosine(3e9).sine == std::sin(3e9));
  CHECK(std::isnan(SineCosine(std::numeric_limits<double>::quiet_NaN()).sine));
  CHECK(std::isnan(SineCosine(std::numeric_limits<double>::infinity()).cosine));
}

TEST_CASE("the hyperbolic tangent is the C library's to 1e-15 of itself, at every size") {
  for (const double step : {1e-9, 1.3e-4, 0.0137, 0.731})
    for (int i = -4000; i <= 4000; ++i) {
      const double x = step * i;
      CAPTURE(x);
      CHECK(std::abs(hyperbolic_tangent(x) - std::tanh(x)) <= 1e-15 * std::abs(std::tanh(x)));
    }
  for (const double beside :
       {-1e-12, 0.0, 1e-12})  // where one form gives way to the other, and where it is 1
    for (const double x : {0.55, 20.0})
      CHECK(std::abs(hyperbolic_tangent(x + beside) - std::tanh(x + beside)) <= 1e-15);
  CHECK(hyperbolic_tangent(std::numeric_limits<double>::infinity()) == 1.0);
  CHECK(hyperbolic_tangent(-1e300) == -1.0);
  CHECK(std::isnan(hyperbolic_tangent(std::numeric_limits<double>::quiet_NaN())));
}

namespace {

template <int width>
void check_that_each_direction_counts() {
  using Number = DualOf<width>;
  CHECK(is_constant(Number(0.0), 0.0));
  for (int direction = 0; direction < width; ++direction) {
    Number moved(0.0);
    moved.seed(direction);
    CHECK_FALSE(is_constant(moved, 0.0));
    moved.forget(0);
    CHECK(is_constant(moved, 0.0));
  }
  CHECK_FALSE(is_constant(Number(-0.3), 0.0));
}

}  // namespace

TEST_CASE("a tail that is 0 is none only where no direction moves it") {
  check_that_each_direction_counts<dual_width>();
  check_that_each_direction_counts<wide_dual_width>();
}
