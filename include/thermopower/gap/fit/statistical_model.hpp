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

/// @file statistical_model.hpp
/// The statistical model of the diagnosis, stated once, in the order of @ref gap_method. It has what is known before the data (priors),
/// what the data say (the likelihood of residuals), what freedom costs, and how far a difference is believed (odds). Every stage that
/// fits, compares or prints takes these formulas from here.

namespace thermopower::gap::engine {

/// @name Priors
/// @{

/// The assumed knowledge of a model's constants.
struct KnownConstants {
  /// Standard deviation of a constant as a share of its value, where the model file states none. Data sheets
  /// and careful fits are that good. A place is known to
  /// plant::Model::place_known_to_rad.
  double uncertainty = 0.05;
  /// In standard deviations. A constant that moved by more is listed, and it moves no further if no effect explains the
  /// data. 95 % of a normal distribution.
  double within = 2.0;
  /// Degrees of freedom of Student's t. With 2 a constant that is off by 10 % costs 1.6 nats, by 30 % 4.1 and by a factor
  /// of 2 6.9. Strong data pay that; it is more than the price of an effect with one parameter that does as well.
  double degrees_of_freedom = 2.0;
  /// The same where explanations are compared. With 1 a constant that is off by 10 % costs 1.5 nats, by 30 % 3.4 and by
  /// a factor of 2 5.3. From 16 % on, one constant that is far off costs less than two that are half as far off each. With
  /// 2 that begins at 23 %. There a single cause is the natural answer. A fit that leaned on it would lose its way:
  /// constants of a wrong explanation ran off.
  double degrees_of_freedom_of_price = 1.0;
  /// A fit moves no constant further than this factor: an inertia that was fitted without friction is off by up to twelve.
  double farthest_factor = 30.0;
  /// The same of a place (CalibratedConstant::is_place), in radians: a quarter of a turn away a load pulls the other way.
  double farthest_place_rad = 1.5707963;
  /// Standard deviation of a curve's value at a knot, as a share of what it is relative to (plant::CurveShape::size).
  double curve_value = 1.0;
  /// The same of twice the distance between a value and the mean of its neighbours: how smooth a curve is before any data.
  double curve_bend = 0.1;
};

/// The values in force.
inline constexpr KnownConstants known_constants{};

/// Prior knowledge of a coordinate: Student's t around 0. Near the centre it is a normal distribution; far away its price
/// grows with the logarithm only, so that data which insist can move it.
struct Prior {
  double sd = 0.0;  ///< scale, in the coordinate; 0: nothing is known, and nothing is paid

  /// Twice the negative logarithm of its density, 0 at the centre.
  double cost(double at) const { return cost(at, known_constants.degrees_of_freedom); }

  /// The price of having moved where explanations are compared: as `cost`, with the heavier tail.
  double price(double at) const { return cost(at, known_constants.degrees_of_freedom_of_price); }

  /// The weight w for which w at^2 / 2 has the gradient of half the cost. It is the inverse variance of a normal
  /// distribution with the same pull.
  double weight(double at) const {
    if (!(sd > 0.0)) return 0.0;
    const double degrees = known_constants.degrees_of_freedom;
    return (degrees + 1.0) / (degrees * sd * sd + at * at);
  }

private:
  double cost(double at, double degrees) const {
    return sd > 0.0 ? (degrees + 1.0) * std::log1p(at * at / (degrees * sd * sd)) : 0.0;
  }
};

/// Prior knowledge of a combination of coordinates.
struct CombinedPrior {
  std::vector<std::pair<Eigen::Index, double>> weights;  ///< coordinates and what they are multiplied with
  Prior prior = {};                                      ///< of the sum, around 0

  /// The sum.
  double value(const Eigen::VectorXd& at) const {
    double sum = 0.0;
    for (const auto& [coordinate, weight] : weights) sum += weight * at[coordinate];
    return sum;
  }
};

/// Twice the log odds against a cause of which nothing else is said (plant::EffectInfo::rarity): one in twenty of those that are
/// looked for is there.
inline constexpr double usual_rarity = 6.0;

/// @}
/// @name Likelihood
/// @{

/// Deviance of Gaussian residuals of one signal whose variance nobody knows: n / c ln q.
/// @param samples     n, >= 0
/// @param correlated  c, how many of them count as one, >= 1
/// @param mean_square  q, of the residuals in units of the noise; below a millionth no smaller one is better
inline double misfit(double samples, double correlated, double mean_square) {
  assert(samples >= 0.0 && correlated > 0.0);
  constexpr double least = 1e-6;
  return samples / correlated * std::log(std::max(mean_square, least));
}

/// @}
/// @name The price of freedom
/// @{

/// Twice the log odds that one free parameter costs at most: the logarithm of the samples that count (Schwarz 1978).
/// @param samples  that count as one, over all signals of the training data
inline double most_price_of_parameter(double samples) {
  constexpr double least = 2.0;
  return std::log(std::max(samples, least));
}

/// What is known of a parameter before the data.
struct ParameterPrior {
  double range = 0.0;      ///< that it may be in, in its coordinate, > 0
  double precision = 0.0;  ///< inverse variance of a prior of its own; 0: anywhere in the range is as likely
};

/// Twice the log odds that a free parameter costs (Laplace's approximation): the logarithm of the precision that the data give it, over
/// the one that it has without them. What the data do not tell costs nothing, and gains nothing.
/// @param precision  of the parameter with data and prior, others of the model left free
/// @param most       most_price_of_parameter()
inline double price_of_parameter(const ParameterPrior& prior, double precision, double most) {
  // Of a range r the density is 1 / r, and a normal distribution of precision p has sqrt(p / 2 pi) at its top.
  const double before =
      prior.precision > 0.0 ? prior.precision : plant::rad_per_turn / (prior.range * prior.range);
  return std::clamp(std::log(std::max(precision, 1e-300) / before), 0.0, most);
}

/// @}
/// @name Odds
/// @{

/// Log odds that go with a difference of so many standard errors, by the normal distribution (Page 1977).
/// @param standard_errors  >= 0; from 40 on they are the same
inline double log_odds_of(double standard_errors) {
  assert(!(standard_errors < 0.0));
  const double z = std::min(standard_errors, 40.0);
  return 1.5976 * z + 0.07056 * z * z * z;
}

/// Log odds of one explanation against another: half the difference of their deviances, but no more than its standard error allows.
/// Every model is wrong, and a model error does not average out as noise does (Vuong 1989).
/// @param difference      of the deviances, >= 0
/// @param standard_error  of that difference; 0: none is known
inline double log_odds(double difference, double standard_error) {
  const double claimed = 0.5 * difference;
  return standard_error > 0.0 ? std::min(claimed, log_odds_of(difference / standard_error)) : claimed;
}

/// Probabilities that go with log odds against the best of them.
/// @param against  in nats, the least of them 0
inline std::vector<double> probabilities(const std::vector<double>& against) {
  std::vector<double> shares;
  double total = 0.0;
  for (const double one : against) total += shares.emplace_back(std::exp(-one));
  for (double& one : shares) one /= total;
  return shares;
}

/// @}

}  // namespace thermopower::gap::engine
