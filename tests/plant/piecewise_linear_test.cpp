// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Functions of a variable without a formula: interpolation between knots says what they must be.

#include "../catch.hpp"

#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/piecewise_linear.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace thermopower::plant;

namespace {

/// A function that is linear between knots, and constant outside of them.
double interpolated(const std::vector<double>& knots, const std::vector<double>& heights, double x) {
  if (x <= knots.front()) return heights.front();
  for (std::size_t k = 1; k < knots.size(); ++k)
    if (x <= knots[k])
      return heights[k - 1] + (heights[k] - heights[k - 1]) * (x - knots[k - 1]) / (knots[k] - knots[k - 1]);
  return heights.back();
}

}  // namespace

TEST_CASE("hats times heights are the function that is linear between the knots") {
  const std::vector<double> knots{-2.0, -0.5, 0.25, 3.0}, heights{1.0, -4.0, 2.5, 0.5};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(301, -4.0, 5.0);
  const Eigen::MatrixXd all = hats(x, knots);
  REQUIRE(all.cols() == 4);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < 4; ++k) {
      CHECK(hat(x, knots, k)[i] == all(i, k));
      sum += heights[static_cast<std::size_t>(k)] * all(i, k);
    }
    CHECK(sum == Approx(interpolated(knots, heights, x[i])).margin(1e-12));
    CHECK(all.row(i).sum() == Approx(1.0));
  }
}

TEST_CASE("a hat is 1 at its knot, a single one everywhere, and none where a value is missing") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> knots{0.0, 1.0, 2.0};
  const Eigen::Vector4d x(0.0, 1.0, 2.0, nan);
  for (Eigen::Index k = 0; k < 3; ++k)
    for (Eigen::Index i = 0; i < 3; ++i) CHECK(hat(x, knots, k)[i] == (i == k ? 1.0 : 0.0));
  CHECK(hats(x, knots).row(3).norm() == 0.0);
  CHECK(hat(x, {0.7}, 0).head(3) == Eigen::Vector3d::Ones());
  CHECK(even_knots(Eigen::Vector3d::Constant(4.0), 5).empty());
  CHECK(even_knots(Eigen::Vector2d(1.0, 3.0), 3) == std::vector<double>{1.0, 2.0, 3.0});
}

TEST_CASE("directions that are made when asked for hold no rows until then") {
  int made = 0;
  const std::vector<Direction> list =
      made_directions(BalancePart::Kind::flow_held, 3, [&made](Eigen::Index k) {
        ++made;
        return Eigen::VectorXd(Eigen::VectorXd::Constant(5, static_cast<double>(k)));
      });
  REQUIRE(list.size() == 3);
  for (const Direction& one : list) CHECK(one.front().values.size() == 0);
  CHECK(made == 0);
  CHECK(list[2].front().make() == Eigen::VectorXd::Constant(5, 2.0));
  CHECK(made == 1);
}
