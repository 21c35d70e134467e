// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/simulation/scenarios.hpp>

#include <cmath>

#include "../catch.hpp"

using namespace thermopower::simulation;

TEST_CASE("A wave begins and ends at nothing and is whole in between") {
  const Wave wave = {2.0, 0.25, 0.0, 10.0, 20.0};
  CHECK(wave.at(10.0) == 0.0);
  CHECK(wave.at(20.0) == 0.0);
  CHECK(wave.at(25.0) == 0.0);
  CHECK(wave.at(13.0) == Approx(2.0));
}

TEST_CASE("A push is half a sine") {
  const Push push = {1.0, 0.1, -0.5};
  CHECK(push.at(0.99) == 0.0);
  CHECK(push.at(1.05) == Approx(-0.5));
  CHECK(push.at(1.11) == 0.0);
}

TEST_CASE("Equal seeds give equal runs, others others") {
  const Scenario one = gusts(60.0, 5), same = gusts(60.0, 5), other = gusts(60.0, 6);
  bool differs = false;
  for (double t_s = 1.0; t_s < 59.0; t_s += 0.37)
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(one.axes[i].torque_Nm(t_s) == same.axes[i].torque_Nm(t_s));
      CHECK(one.axes[i].base_deg(t_s) == same.axes[i].base_deg(t_s));
      differs = differs || one.axes[i].torque_Nm(t_s) != other.axes[i].torque_Nm(t_s);
    }
  CHECK(differs);
}

TEST_CASE("Gusts are as strong as they say") {
  const Scenario windy = gusts(400.0);
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0.0;
    int count = 0;
    for (double t_s = 1.0; t_s < 399.0; t_s += 0.05, ++count)
      sum += windy.axes[i].torque_Nm(t_s) * windy.axes[i].torque_Nm(t_s);
    CHECK(std::sqrt(sum / count) == Approx(detail::gust_rms_Nm[i]).epsilon(0.15));
  }
}

TEST_CASE("The random numbers are those of SplitMix64") {
  Random random(1234567);  // first outputs of the published reference implementation
  CHECK(random.next() == 6457827717110365317u);
  CHECK(random.next() == 3203168211198807973u);
}
