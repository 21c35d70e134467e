// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Heaters as people log them: more than one thing that their simulation lacks, at once. What is missing then follows
// nothing recorded, as a heat would that no column shows; only with the causes in the model it is seen to be none.
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

using namespace thermopower;
using namespace thermopower::gap;

namespace {

constexpr double stefan_W_per_m2K4 = 5.670374e-8;

double radiated_W(double area_m2, double body_C, double air_C) {
  return stefan_W_per_m2K4 * area_m2 * (std::pow(body_C + 273.15, 4.0) - std::pow(air_C + 273.15, 4.0));
}

double rounded(double value, double quantum) { return std::round(value / quantum) * quantum; }

Model lumped(double J_per_K, double W_per_K) {
  Model model;
  model.name = "heater";
  model.thermal = LumpedThermalModel{J_per_K, W_per_K};
  return model;
}

/// Two heaters on a board, each with a sensor that comes 12 s late; they radiate, and heat each other. One of them is
/// simulated. @param hidden_W  heats it by the time, and no column shows it
Recording two_heaters(double air_C, unsigned seed, const std::function<double(double)>& hidden_W = {}) {
  constexpr Eigen::Index rows = 2400;
  constexpr int steps = 20;  // of 0.05 s
  constexpr double J_per_K = 2.0, lag_s = 12.0, between_W_per_K = 0.0056, quantum_K = 0.1;
  std::mt19937_64 random(seed);
  Recording r;
  r.name = "two heaters";
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  Eigen::VectorXd heat(rows), motor(rows), neighbour(rows);
  double one_W = 0.0, other_W = 0.0, one_C = air_C, other_C = air_C, shown_C = air_C, other_shown_C = air_C;
  const auto loss_W = [&](double body_C) {
    return 0.018 * (body_C - air_C) + radiated_W(0.0009, body_C, air_C);
  };
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (k % 60 == 0) one_W = std::vector<double>{0.0, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0}[random() % 7];
    if (k % 150 == 0) other_W = std::vector<double>{0.0, 0.0, 0.22, 0.45, 0.6}[random() % 5];
    heat[k] = one_W;
    motor[k] = rounded(shown_C, quantum_K);
    neighbour[k] = rounded(other_shown_C, quantum_K);
    for (int i = 0; i < steps; ++i) {
      constexpr double step_s = 1.0 / steps;
      const double across_W = between_W_per_K * (other_C - one_C);
      const double more_W = hidden_W ? hidden_W(r.t_s[k]) : 0.0;
      one_C += step_s * (one_W + more_W - loss_W(one_C) + across_W) / J_per_K;
      other_C += step_s * (other_W - loss_W(other_C) - across_W) / J_per_K;
      shown_C += step_s * (one_C - shown_C) / lag_s;
      other_shown_C += step_s * (other_C - other_shown_C) / lag_s;
    }
  }
  r.set("heat_W", heat);
  r.set("motor_C", motor);
  r.set("neighbour_C", neighbour);
  r.set("ambient_C", Eigen::VectorXd::Constant(rows, air_C));
  return r;
}

/// A hotend held at temperatures by a PID loop; it radiates, the air around it rises, and its thermistor comes 3 s late.
struct Hold {
  double until_s, target_C;
};

Recording hotend(double air_C, unsigned seed, const std::vector<Hold>& holds) {
  constexpr int steps = 20;
  constexpr double J_per_K = 22.0, lag_s = 3.0, noise_K = 0.05, full_W = 12.0 * 12.0 / 3.6;
  const auto rows = static_cast<Eigen::Index>(holds.back().until_s);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Recording r;
  r.name = "hotend";
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  Eigen::VectorXd power(rows), motor(rows);
  double body_C = air_C, shown_C = air_C, integral = 0.0, before_C = air_C;
  for (Eigen::Index k = 0; k < rows; ++k) {
    motor[k] = shown_C + noise_K * normal(random);
    std::size_t hold = 0;
    while (!(r.t_s[k] < holds[hold].until_s)) ++hold;
    const double off_K = holds[hold].target_C - motor[k];
    const double wanted = 0.05 * off_K + integral - 0.15 * (motor[k] - before_C);
    if (wanted > 0.0 && wanted < 1.0) integral += 0.0012 * off_K;
    before_C = motor[k];
    power[k] = std::round(255.0 * std::clamp(wanted, 0.0, 1.0));
    const double heat_W = full_W * power[k] / 255.0;
    for (int i = 0; i < steps; ++i) {
      const double rise_K = body_C - air_C;
      const double loss_W = 0.06 * rise_K + 0.05 * rise_K * std::pow(std::max(rise_K, 0.0) / 100.0, 0.25) +
                            radiated_W(0.0016, body_C, air_C);
      body_C += (heat_W - loss_W) / J_per_K / steps;
      shown_C += (body_C - shown_C) / lag_s / steps;
    }
  }
  r.set("power_param", power);
  r.set("motor_C", motor);
  r.set("ambient_C", Eigen::VectorXd::Constant(rows, air_C));
  return r;
}

// The constants are a least-squares fit of one body to such a recording.
TEST_CASE("two causes whose sum follows nothing recorded are named where the course is over with them") {
  for (const unsigned seed : {3u, 4u, 5u, 6u}) {
    CAPTURE(seed);
    const Diagnosis found =
        diagnose(lumped(2.4, 0.0243), {two_heaters(23.5, seed)}, {two_heaters(22.0, seed + 100)});
    CHECK((found.verdict == Verdict::partial || found.verdict == Verdict::explained));
    // One more may be named for what is left of a periodic heat; these two are never missed.
    const std::vector<std::string> causes = test::causes_of(found);
    for (const char* one : {"neighbour_heating", "thermometer_lag"})
      CHECK(std::find(causes.begin(), causes.end(), one) != causes.end());
  }
}

TEST_CASE("a heat that no column shows is not named for what is missing beside it") {
  // Another device on the same board, by a clock of its own.
  const auto hidden_W = [](double t_s) { return std::fmod(t_s, 700.0) > 400.0 ? 0.35 : 0.0; };
  for (const unsigned seed : {3u, 4u}) {
    CAPTURE(seed);
    const Diagnosis found = diagnose(lumped(2.4, 0.0243), {two_heaters(23.5, seed, hidden_W)},
                                     {two_heaters(22.0, seed + 100, hidden_W)});
    CHECK(found.verdict == Verdict::unexplained);
  }
}

TEST_CASE("what a hotend loses is named beside its thermistor's lag") {
  Model model = lumped(22.7, 0.14);
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{3.6, 0.0, 25.0};
  for (const unsigned seed : {1u, 3u, 5u}) {
    CAPTURE(seed);
    const Diagnosis found = diagnose(
        model,
        {hotend(24.3, seed,
                {{300, 200}, {700, 230}, {1000, 150}, {1500, 245}, {2000, 100}, {2600, 210}, {3000, 0}})},
        {hotend(21.0, seed + 1, {{400, 215}, {900, 120}, {1300, 240}, {1700, 180}, {2200, 0}})});
    // The loss is of both kinds, so that either is right, and a curve of the loss is their sum.
    const std::vector<std::string> causes = test::causes_of(found),
                                   losses{"natural_convection", "radiation", "unknown.loss(rise_K)"};
    CHECK(std::find(causes.begin(), causes.end(), "thermometer_lag") != causes.end());
    CHECK(std::find_first_of(causes.begin(), causes.end(), losses.begin(), losses.end()) != causes.end());
  }
}

/// A motor under a loop that sets its power ten times a second by what its thermometer reads, and logs each tenth time.
Recording of_a_faster_loop(int rows, unsigned seed) {
  constexpr int steps_a_row = 10;
  test::Noise noise(seed);
  Recording r;
  r.name = "faster loop";
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  Eigen::VectorXd power(rows), motor(rows);
  double body_C = 23.0, goal_C = 40.0, integral = 0.0;
  for (int row = 0; row < rows; ++row) {
    if (row % 300 == 0) goal_C = 42.5 + 12.5 * std::sin(2.3 * row + seed), integral = 0.0;
    for (int step = 0; step < steps_a_row; ++step) {
      const double seen_C = rounded(body_C + 0.1 * noise(), 0.1);
      integral = std::clamp(integral + 0.03 * (goal_C - seen_C), 0.0, 255.0);
      const double set = std::round(std::clamp(25.0 * (goal_C - seen_C) + integral, 0.0, 255.0));
      if (step == 0) power[row] = set, motor[row] = seen_C;
      for (int k = 0; k < steps_a_row; ++k)
        body_C += 0.01 *
                  (144.0 * set / 255.0 / (8.0 * (1.0 + 0.00393 * (body_C - 25.0))) - 0.15 * (body_C - 23.0)) /
                  60.0;
    }
  }
  r.set("power_param", power);
  r.set("motor_C", motor);
  r.set("ambient_C", Eigen::VectorXd::Constant(rows, 23.0));
  r.set("supply_V", Eigen::VectorXd::Constant(rows, 12.0));
  return r;
}

}  // namespace

TEST_CASE("one row a second of a loop that is faster names no cause in a motor that has none") {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    const Diagnosis diagnosis =
        diagnose(test::bench_model(), {of_a_faster_loop(2400, seed)}, {of_a_faster_loop(1500, seed + 50)});
    for (const Cause& cause : diagnosis.cause) CHECK(plant::is_calibration(cause.effect));
  }
}
