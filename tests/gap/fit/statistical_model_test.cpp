// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../../catch.hpp"

#include <thermopower/gap/fit/statistical_model.hpp>
#include <thermopower/plant/effect.hpp>

#include <cmath>
#include <vector>

using namespace thermopower::gap::engine;

TEST_CASE("the price of a constant grows like a square near what is known and like a logarithm far away") {
  const Prior prior{0.05};
  CHECK(prior.cost(0.0) == 0.0);
  CHECK(prior.cost(0.005) == Approx(1.5 * 0.01).epsilon(0.01));
  const double far = prior.cost(10.0) - prior.cost(5.0);
  CHECK(far == Approx(3.0 * std::log(4.0)).epsilon(0.001));
  // Its weight has the gradient of half the cost.
  for (double at : {0.01, 0.1, 0.7}) {
    const double step = 1e-6, slope = (prior.cost(at + step) - prior.cost(at - step)) / (2.0 * step);
    CHECK(prior.weight(at) * at == Approx(0.5 * slope).epsilon(1e-6));
  }
  CHECK(Prior{}.cost(3.0) == 0.0);
  // What decides between explanations prefers one constant that is far off to two that are half as far off.
  CHECK(prior.price(std::log(1.2)) < 2.0 * prior.price(0.5 * std::log(1.2)));
  CHECK(prior.price(std::log(1.1)) > 2.0 * prior.price(0.5 * std::log(1.1)));
}

TEST_CASE("the deviance of residuals is twice the least negative log likelihood over all variances") {
  // Normal residuals with the mean square q: -2 ln L = n ln v + n q / v, by a search over v; at q = 1 it is the reference.
  const double samples = 40.0;
  const auto least = [&](double mean_square) {
    double lowest = 1e300;
    for (double variance = 0.01; variance < 100.0; variance *= 1.0005)
      lowest = std::min(lowest, samples * (std::log(variance) + mean_square / variance));
    return lowest;
  };
  for (const double mean_square : {0.2, 1.0, 7.0})
    CHECK(misfit(samples, 1.0, mean_square) == Approx(least(mean_square) - least(1.0)).margin(1e-3));
  // Samples of which five count as one weigh a fifth, and no samples nothing.
  CHECK(misfit(samples, 5.0, 7.0) == Approx(misfit(samples / 5.0, 1.0, 7.0)));
  CHECK(misfit(0.0, 1.0, 0.0) == 0.0);
}

TEST_CASE("log odds are those of the normal distribution's two sides, to the accuracy that Page states") {
  for (double z = 0.0; z < 6.0; z += 0.1) {
    const double below = 0.5 * std::erfc(-z / std::sqrt(2.0));
    CHECK(std::fabs(1.0 / (1.0 + std::exp(-log_odds_of(z))) - below) < 1.45e-4);  // he states 0.00014
  }
}

TEST_CASE("odds are no larger than the standard error of a difference allows") {
  CHECK(log_odds(8.0, 0.0) == 4.0);               // nothing is known of it
  CHECK(log_odds(8.0, 1.0) == 4.0);               // eight standard errors claim more than that
  CHECK(log_odds(8.0, 8.0) == log_odds_of(1.0));  // one claims less
  CHECK(log_odds(8e6, 8e6) == log_odds_of(1.0));  // however many rows there are
  CHECK(log_odds(0.0, 1.0) == 0.0);
}

TEST_CASE("a parameter costs what the data tell of it, and at most the logarithm of the samples") {
  CHECK(most_price_of_parameter(std::exp(9.0)) == Approx(9.0));
  CHECK(most_price_of_parameter(0.0) == Approx(std::log(2.0)));
  // A range of 10 that the data narrow to a standard deviation of 0.1: the integral of the normal distribution over the range,
  // divided by the range, is what the evidence loses beside the best fit.
  const double pi = 3.14159265358979, sd = 0.1, range = 10.0;
  const double share = std::sqrt(2.0 * pi) * sd / range;
  CHECK(price_of_parameter({range}, 1.0 / (sd * sd), 99.0) == Approx(-2.0 * std::log(share)));
  CHECK(price_of_parameter({range}, 1.0 / (sd * sd), 5.0) == 5.0);
  CHECK(price_of_parameter({range}, 0.0, 9.0) == 0.0);       // not told
  CHECK(price_of_parameter({range, 4.0}, 4.0, 9.0) == 0.0);  // told by what was known alone
  CHECK(price_of_parameter({range, 4.0}, 4.0 * std::exp(2.0), 9.0) == Approx(2.0));
}

TEST_CASE("a cause of which nothing is said is one in twenty, wherever it is asked") {
  CHECK(thermopower::plant::EffectInfo().rarity == usual_rarity);
  CHECK(std::exp(-0.5 * usual_rarity) == Approx(1.0 / 20.0).epsilon(0.01));
}

TEST_CASE("probabilities have the ratios of their odds, and add up to one") {
  const std::vector<double> shares = probabilities({0.0, std::log(3.0), 800.0});
  CHECK(shares[0] == Approx(3.0 / 4.0));
  CHECK(shares[1] == Approx(1.0 / 4.0));
  CHECK(shares[2] < 1e-300);
}
