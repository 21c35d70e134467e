// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/gap/data/linear_solve.hpp>

#include <random>

#include "../../catch.hpp"

using thermopower::gap::engine::invert_symmetric;
using thermopower::gap::engine::LeastSquares;
using thermopower::gap::engine::SymmetricSystem;

namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index k = 0; k < columns; ++k) matrix(i, k) = normal(random);
  return matrix;
}

Eigen::VectorXd random_vector(Eigen::Index size, std::mt19937& random) {
  return random_matrix(size, 1, random).col(0);
}

}  // namespace

TEST_CASE("A symmetric system is solved") {
  std::mt19937 random(1);
  for (const Eigen::Index n : {1, 2, 7, 40}) {
    const Eigen::MatrixXd half = random_matrix(2 * n, n, random);
    const Eigen::MatrixXd a = half.transpose() * half;
    const Eigen::VectorXd x = random_vector(n, random);
    CHECK((SymmetricSystem(a).solve(a * x) - x).norm() < 1e-10 * x.norm());
  }
}

TEST_CASE("An unknown that no equation of a symmetric system holds is 0") {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3, 3);
  a(0, 0) = 2.0, a(2, 2) = 4.0;
  const Eigen::VectorXd x = SymmetricSystem(a).solve(Eigen::Vector3d(1.0, 5.0, 2.0));
  CHECK(x == Eigen::VectorXd(Eigen::Vector3d(0.5, 0.0, 0.5)));
}

TEST_CASE("A matrix times its inverse is the identity") {
  std::mt19937 random(2);
  for (const Eigen::Index n : {1, 2, 5, 8}) {
    const Eigen::MatrixXd half = random_matrix(2 * n, n, random);
    const Eigen::MatrixXd a = half.transpose() * half;
    Eigen::MatrixXd inverse = a;
    invert_symmetric(inverse);
    CHECK((a * inverse - Eigen::MatrixXd::Identity(n, n)).norm() < 1e-10);
  }
}

TEST_CASE("What least squares leave stands at right angles to every column") {
  std::mt19937 random(3);
  for (const Eigen::Index n : {1, 3, 20}) {
    const Eigen::MatrixXd a = random_matrix(3 * n, n, random);
    const Eigen::VectorXd b = random_vector(3 * n, random);
    const Eigen::VectorXd left = b - a * LeastSquares(a).solve(b);
    CHECK((a.transpose() * left).norm() < 1e-10 * b.norm());
  }
}

TEST_CASE("Of all solutions of a matrix of lower rank the shortest is found") {
  std::mt19937 random(4);
  for (const Eigen::Index rank : {1, 2, 6}) {
    const Eigen::MatrixXd rows = random_matrix(rank, 9, random);
    const Eigen::MatrixXd a = random_matrix(12, rank, random) * rows;
    // The shortest solution is a sum of rows of the matrix: what is at right angles to them adds length and nothing else.
    const Eigen::VectorXd x = rows.transpose() * random_vector(rank, random);
    CHECK((LeastSquares(a).solve(a * x) - x).norm() < 1e-9 * x.norm());
    CHECK((LeastSquares(a.transpose() * a).solve(a.transpose() * (a * x)) - x).norm() < 1e-7 * x.norm());
  }
}

TEST_CASE("Fewer equations than unknowns, and none that says anything, have a shortest solution, too") {
  Eigen::MatrixXd a(1, 2);
  a << 3.0, 4.0;
  const Eigen::VectorXd x = LeastSquares(a).solve(Eigen::VectorXd::Constant(1, 50.0));
  CHECK(x[0] == Approx(6.0));
  CHECK(x[1] == Approx(8.0));
  CHECK(LeastSquares(Eigen::MatrixXd::Zero(3, 2)).solve(Eigen::VectorXd::Ones(3)).norm() == 0.0);
}
