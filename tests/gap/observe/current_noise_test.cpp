// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The noise of a current sensor is what it reads where nothing flows. Ripple that heats is none, and neither is a current that
// no rest tells from noise.
#include "../../catch.hpp"

#include <thermopower/gap/observe/current_noise.hpp>

#include <cmath>
#include <random>

using namespace thermopower::gap::engine;
using thermopower::plant::RunSpan;

namespace {

constexpr double pi = 3.14159265358979;

/// Currents of 0, 5 and 10 A for a hundred rows each, or none of 0 A. @param sensor_A  noise of the sensor, at rest, too
/// @param ripple  of the current itself, as a share of it
Eigen::VectorXd steps(double rest_A, double sensor_A, double ripple) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Eigen::VectorXd amps(1800);
  for (Eigen::Index i = 0; i < amps.size(); ++i) {
    const double level_A = i / 100 % 3 == 0 ? rest_A : i / 100 % 3 == 1 ? 5.0 : 10.0;
    amps[i] = level_A * (1.0 + ripple * normal(random)) + sensor_A * normal(random);
  }
  return amps;
}

std::optional<double> noise_of(const Eigen::VectorXd& amps) {
  CurrentNoise noise;
  noise.add(amps, {RunSpan{0, amps.size(), ""}});
  return noise.sd_A();
}

TEST_CASE("what a current sensor reads where nothing flows is its noise") {
  const auto found = noise_of(steps(0.0, 0.8, 0.0));
  REQUIRE(found);
  // Thirty-some blocks of sixteen rows tell a scatter to three per cent.
  CHECK(std::abs(*found - 0.8) < 0.08);
  // Ripple beside it is another matter.
  const auto with_ripple = noise_of(steps(0.0, 0.8, 0.2));
  REQUIRE(with_ripple);
  CHECK(std::abs(*with_ripple - 0.8) < 0.08);
}

TEST_CASE("what may be a current is not taken for noise of its sensor") {
  CHECK_FALSE(noise_of(steps(0.0, 0.0, 0.2)));   // the sensor is quiet at rest
  CHECK_FALSE(noise_of(steps(2.0, 0.8, 0.0)));   // nothing rests
  CHECK_FALSE(noise_of(steps(0.0, 0.05, 0.0)));  // 0.06 % of the heat
  CHECK_FALSE(noise_of(steps(0.0, 20.0, 0.0)));  // hardly any current beside the noise
  // A slow current that turns round in each block scatters, but not from row to row.
  Eigen::VectorXd slow = steps(0.0, 0.0, 0.0);
  for (Eigen::Index i = 0; i < slow.size(); ++i)
    slow[i] += 0.8 * std::sin(2.0 * pi * static_cast<double>(i) / 16.0);
  CHECK_FALSE(noise_of(slow));
}

}  // namespace
