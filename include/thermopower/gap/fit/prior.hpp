// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/radians.hpp>

#include <Eigen/Core>

#include <cmath>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

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
  double cost(double at) const {
    if (!(sd > 0.0)) return 0.0;
    const double degrees = known_constants.degrees_of_freedom;
    return (degrees + 1.0) * std::log1p(at * at / (degrees * sd * sd));
  }

  /// The price of having moved where explanations are compared: as `cost`, with the heavier tail.
  double price(double at) const {
    if (!(sd > 0.0)) return 0.0;
    const double degrees = known_constants.degrees_of_freedom_of_price;
    return (degrees + 1.0) * std::log1p(at * at / (degrees * sd * sd));
  }

  /// How dense it is at its centre where explanations are compared, per unit of the coordinate: Cauchy's, of one degree of freedom.
  /// Infinite where it is exact.
  double density_at_centre() const {
    static_assert(known_constants.degrees_of_freedom_of_price == 1.0,
                  "another density goes with another price");
    return 2.0 / (plant::rad_per_turn * sd);
  }

  /// The weight w for which w at^2 / 2 has the gradient of half the cost. It is the inverse variance of a normal
  /// distribution with the same pull.
  double weight(double at) const {
    if (!(sd > 0.0)) return 0.0;
    const double degrees = known_constants.degrees_of_freedom;
    return (degrees + 1.0) / (degrees * sd * sd + at * at);
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

}  // namespace thermopower::gap::engine
