// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../../catch.hpp"

#include <thermopower/gap/fit/candidate.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <vector>

using namespace thermopower::gap::engine;

TEST_CASE("parameters that the data tell together only are paid for once") {
  // Of a curvature with the same pull on both, the second one adds nothing to the first; the product is the determinant.
  Candidate candidate;
  candidate.list.resize(2);
  candidate.fit.information = Eigen::MatrixXd::Constant(2, 2, 8.0);
  CHECK(precisions(candidate, {0, 1}, 2.0)[0] == Approx(4.0));
  CHECK(precisions(candidate, {0, 1}, 2.0)[1] == 0.0);
  CHECK(precisions(candidate, {1, 0}, 2.0)[0] == 0.0);
  candidate.fit.information(1, 1) = 10.0;
  const std::vector<double> told = precisions(candidate, {1, 0}, 1.0);
  CHECK(told[0] * told[1] == Approx(candidate.fit.information.determinant()));
  candidate.fit.information.resize(0, 0);  // nobody looked
  CHECK(precisions(candidate, {0, 1}, 1.0).empty());
}
