// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/two_node_thermal_model.hpp>
#include <thermopower/actuator/thermal_model.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include "near.hpp"

#include <random>

namespace tp = thermopower;

namespace {
using Model = tp::TwoNodeThermalModel<double>;

const Model::Config motor = {2.0, 16.0, 0.4, {0.06}};

Eigen::Vector2d rates(const Model::Config& config, const Eigen::Vector2d& nodes_C, double power_W,
                      double air_C) {
  const double between_W = config.coupling_W_per_K * (nodes_C[0] - nodes_C[1]);
  const double lost_W = config.cooling.conductance_W_per_K * (nodes_C[1] - air_C);
  return {(power_W - between_W) / config.winding_heat_capacity_J_per_K,
          (between_W - lost_W) / config.body_heat_capacity_J_per_K};
}

// Constants drawn over four decades each, so that stiff, slack and nearly degenerate networks all occur.
struct Networks {
  std::mt19937 random{7};
  double decades(double from, double to) {
    return std::pow(10.0, std::uniform_real_distribution<double>(std::log10(from), std::log10(to))(random));
  }
  Model::Config next() {
    return {decades(0.1, 1e3), decades(0.1, 1e3), decades(1e-3, 10.0), {decades(1e-3, 10.0)}};
  }
};
}  // namespace

TEST_CASE("two nodes follow their differential equation, by Runge-Kutta in fine steps") {
  Model model(motor, 25.0);
  Eigen::Vector2d nodes_C(25.0, 25.0);
  const double dt_s = 0.01;
  for (int second = 0; second < 300; ++second) {
    const double power_W = second < 120 ? 6.0 : (second < 180 ? 0.0 : 2.0),
                 air_C = second < 150 ? 25.0 : 10.0;
    model.step({power_W, 0.0, {air_C, 0.0}}, 1.0);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d a = rates(motor, nodes_C, power_W, air_C),
                            b = rates(motor, nodes_C + dt_s / 2 * a, power_W, air_C),
                            c = rates(motor, nodes_C + dt_s / 2 * b, power_W, air_C),
                            d = rates(motor, nodes_C + dt_s * c, power_W, air_C);
      nodes_C += dt_s / 6 * (a + 2 * b + 2 * c + d);
    }
    REQUIRE(model.state().winding_C == Near(nodes_C[0]).epsilon(1e-10));
    REQUIRE(model.state().body_C == Near(nodes_C[1]).epsilon(1e-10));
  }
}

TEST_CASE("two nodes equal the matrix exponential for any network and any step") {
  Networks networks;
  for (int trial = 0; trial < 2000; ++trial) {
    const Model::Config config = networks.next();
    const double dt_s = networks.decades(1e-3, 1e4), power_W = networks.decades(0.1, 10.0), air_C = 20.0;
    Model model(config, 0.0);
    model.start(80.0, 40.0);
    // Air, power and nodes as one homogeneous system, so that the reference needs no settled state of its
    // own.
    Eigen::Matrix3d system = Eigen::Matrix3d::Zero();
    const Eigen::Vector2d drift = rates(config, Eigen::Vector2d::Zero(), power_W, air_C);
    system.topLeftCorner<2, 1>() = rates(config, {1.0, 0.0}, power_W, air_C) - drift;
    system.block<2, 1>(0, 1) = rates(config, {0.0, 1.0}, power_W, air_C) - drift;
    system.topRightCorner<2, 1>() = drift;
    const Eigen::Vector3d expected = (system * dt_s).exp() * Eigen::Vector3d(80.0, 40.0, 1.0);
    model.step({power_W, 0.0, {air_C, 0.0}}, dt_s);
    // Of the largest temperature in play: the reference squares its way up and loses a few digits itself.
    const double scale =
        80.0 + power_W / config.cooling.conductance_W_per_K + power_W / config.coupling_W_per_K;
    CAPTURE(trial, dt_s, config.winding_heat_capacity_J_per_K, config.body_heat_capacity_J_per_K,
            config.coupling_W_per_K);
    REQUIRE(std::abs(model.state().winding_C - expected[0]) < 1e-9 * scale);
    REQUIRE(std::abs(model.state().body_C - expected[1]) < 1e-9 * scale);
  }
}

TEST_CASE("two nodes do not depend on how the time is cut") {
  Networks networks;
  for (int trial = 0; trial < 500; ++trial) {
    const Model::Config config = networks.next();
    const double dt_s = networks.decades(1e-3, 1e4);
    Model whole(config, 30.0), cut(config, 30.0);
    whole.step({2.0, 0.0, {20.0, 0.0}}, dt_s);
    for (int i = 0; i < 7; ++i) cut.step({2.0, 0.0, {20.0, 0.0}}, dt_s / 7.0);
    const double scale = 30.0 + 2.0 / config.cooling.conductance_W_per_K + 2.0 / config.coupling_W_per_K;
    REQUIRE(std::abs(whole.state().winding_C - cut.state().winding_C) < 1e-12 * scale);
    REQUIRE(std::abs(whole.state().body_C - cut.state().body_C) < 1e-12 * scale);
  }
}

TEST_CASE("two nodes settle at T_air + P/G and a P/K above it") {
  Model model(motor, 60.0);
  model.step({3.0, 0.0, {20.0, 0.0}}, 1e7);
  CHECK(model.state().body_C == Near(20.0 + 3.0 / 0.06).epsilon(1e-13));
  CHECK(model.state().winding_C == Near(20.0 + 3.0 / 0.06 + 3.0 / 0.4).epsilon(1e-13));
  CHECK(model.hottest_C() == model.state().winding_C);
}

TEST_CASE("heat in less heat lost is what warms the two nodes") {
  Model model(motor, 25.0);
  double lost_J = 0.0;
  const double dt_s = 0.1;
  for (int i = 0; i < 3000; ++i) {
    const double before_W = 0.06 * (model.state().body_C - 25.0);
    model.step({4.0, 0.0, {25.0, 0.0}}, dt_s);
    lost_J += dt_s * 0.5 * (before_W + 0.06 * (model.state().body_C - 25.0));
  }
  const double stored_J = 2.0 * (model.state().winding_C - 25.0) + 16.0 * (model.state().body_C - 25.0);
  CHECK(stored_J == Near(4.0 * 300.0 - lost_J).epsilon(1e-6));
}

TEST_CASE("a tight coupling makes one node of the two") {
  Model two({2.0, 16.0, 1e6, {0.06}}, 25.0);
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>> one({{18.0}, {0.06}}, 25.0);
  for (int i = 0; i < 100; ++i) {
    two.step({3.0, 0.0, {25.0, 0.0}}, 5.0);
    one.step({3.0, 0.0, {25.0, 0.0}}, 5.0);
    REQUIRE(two.state().winding_C == Near(one.state().motor_C).epsilon(1e-6));
  }
}

TEST_CASE("without power both nodes stay between the air and the hottest they were") {
  Networks networks;
  for (int trial = 0; trial < 500; ++trial) {
    Model model(networks.next(), 20.0);
    model.start(90.0, 50.0);
    double hottest_C = 90.0;
    for (int i = 0; i < 50; ++i) {
      model.step({0.0, 0.0, {20.0, 0.0}}, networks.decades(1e-3, 1e3));
      REQUIRE(model.hottest_C() <= hottest_C + 1e-10);
      REQUIRE(model.state().winding_C >= 20.0 - 1e-10);
      REQUIRE(model.state().body_C >= 20.0 - 1e-10);
      hottest_C = model.hottest_C();
    }
  }
}

TEST_CASE("the rate is the winding's at the start of the step") {
  Model model(motor, 0.0);
  model.start(60.0, 40.0);
  const double expected = rates(motor, {60.0, 40.0}, 3.0, 25.0)[0];
  model.step({3.0, 0.0, {25.0, 0.0}}, 0.5);
  CHECK(model.hottest_rate_K_per_s() == Near(expected).epsilon(1e-12));
}

TEST_CASE("in single precision no network gives NaN, also where the eigenvalues nearly meet") {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> small(-8.0f, -2.0f), near_one(0.999999f, 1.000001f);
  for (int trial = 0; trial < 20000; ++trial) {
    // Winding and body with the same own rate, all but uncoupled: the discriminant is lost in rounding.
    const float coupling = std::pow(10.0f, small(random));
    const tp::TwoNodeThermalModel<float>::Config config = {
        coupling, near_one(random), coupling, {near_one(random)}};
    tp::TwoNodeThermalModel<float> model(config, 25.0f);
    model.step({1.0f * coupling, 0.0f, {25.0f, 0.0f}}, 0.5f);
    REQUIRE(std::isfinite(model.state().winding_C));
    REQUIRE(std::isfinite(model.state().body_C));
    REQUIRE(model.state().winding_C >= 24.99f);
    REQUIRE(model.state().winding_C < 27.0f);
  }
}

TEST_CASE("a network whose time constants lie eight decades apart keeps its slow one in single precision") {
  tp::TwoNodeThermalModel<float> quick({0.01f, 1000.0f, 10.0f, {0.01f}}, 60.0f);
  Model exact({0.01, 1000.0, 10.0, {0.01}}, 60.0);
  for (int i = 0; i < 3; ++i) {
    quick.step({0.0f, 0.0f, {20.0f, 0.0f}}, 50000.0f);
    exact.step({0.0, 0.0, {20.0, 0.0}}, 50000.0);
    CHECK(static_cast<double>(quick.state().body_C) == Near(exact.state().body_C).margin(0.01));
  }
  CHECK(exact.state().body_C < 35.0);
}
