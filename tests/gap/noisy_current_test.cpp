// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A motor on a test bench, whose measured current is all that is known of its heat: what the current sensor makes up heats
// the simulation and not the motor.
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace thermopower;
using namespace thermopower::gap;

namespace {

/// A motor that is loaded and rests, an hour and a half at 2 Hz.
struct Bench {
  double sensor_A = 0.0;     ///< noise of the current sensor
  double ripple = 0.0;       ///< of the current itself from row to row, up to this share of it either way
  bool has_winding = false;  ///< apart from the stator

  static Model model() {
    Model model;
    model.name = "motor on a bench";
    model.current = OhmicCurrentModel{0.018, 0.0039, 25.0};
    model.thermal = LumpedThermalModel{5200.0, 9.0};
    return model;
  }

  Recording recording(unsigned seed, Eigen::Index rows) const {
    constexpr double rows_s = 0.5, coolant_C = 21.0, noise_K = 0.05;
    constexpr int steps = 10;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> holds(120.0, 800.0), either_way(-1.0, 1.0);
    const std::vector<double> levels_A{0.0, 40.0, 80.0, 120.0, 160.0, 200.0, 230.0};
    Recording r;
    r.name = "bench";
    r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, rows_s * static_cast<double>(rows - 1));
    Eigen::VectorXd current(rows), motor(rows);
    double winding_C = 26.0, stator_C = 26.0, level_A = 0.0, until = 0.0;
    for (Eigen::Index k = 0; k < rows; ++k) {
      if (!(static_cast<double>(k) < until)) {
        level_A = levels_A[random() % levels_A.size()];
        until = static_cast<double>(k) + holds(random);
      }
      const double flows_A = level_A * (1.0 + ripple * either_way(random));
      current[k] = flows_A + sensor_A * normal(random);
      motor[k] = winding_C + noise_K * normal(random);
      for (int i = 0; i < steps; ++i) {
        constexpr double step_s = rows_s / steps;
        const double heat_W = flows_A * flows_A * 0.018 * (1.0 + 0.0039 * (winding_C - 25.0));
        if (has_winding) {
          const double across_W = 20.0 * (winding_C - stator_C);
          winding_C += step_s * (heat_W - across_W) / 1500.0;
          stator_C += step_s * (across_W - 9.0 * (stator_C - coolant_C)) / 3700.0;
        } else {
          winding_C += step_s * (heat_W - 9.0 * (winding_C - coolant_C)) / 5200.0;
        }
      }
    }
    r.set("current_A", current);
    r.set("motor_C", motor);
    r.set("ambient_C", Eigen::VectorXd::Constant(rows, coolant_C));
    return r;
  }

  Diagnosis answer(unsigned seed) const {
    return diagnose(model(), {recording(seed, 10800)}, {recording(seed + 100, 5400)});
  }
};

bool says_noisy(const Diagnosis& found) {
  return std::any_of(found.findings.begin(), found.findings.end(), [](const Finding& one) {
    return one.kind == FindingKind::noisy_command && one.column == "current_A";
  });
}

TEST_CASE("the noise of a current sensor heats no motor, and makes no gap") {
  Bench bench;
  for (const double sensor_A : {12.0, 30.0})
    for (const unsigned seed : {1u, 2u}) {
      CAPTURE(sensor_A, seed);
      bench.sensor_A = sensor_A;
      const Diagnosis found = bench.answer(seed);
      CHECK(says_noisy(found));
      CHECK(test::holds(found));
    }
}

TEST_CASE("a ripple of the current that heats the motor stays") {
  Bench bench;
  bench.ripple = 0.5;  // 8 % more heat
  const Diagnosis found = bench.answer(3);
  CHECK_FALSE(says_noisy(found));
  CHECK(test::holds(found));
}

TEST_CASE(
    "a disturbance of the training data alone is no gap where the simulation holds on what is held out") {
  Bench bench;
  Recording train = bench.recording(5, 10800);
  Eigen::VectorXd motor = train.column("motor_C");
  // Somebody leans on the housing for a minute: 0.4 K, gone after ten.
  for (Eigen::Index k = 4000; k < motor.size(); ++k)
    motor[k] -= 0.4 * std::min(1.0, static_cast<double>(k - 4000) / 120.0) *
                std::exp(-static_cast<double>(std::max<Eigen::Index>(k - 4120, 0)) / 1156.0);
  train.set("motor_C", motor);
  const Diagnosis found = diagnose(Bench::model(), {train}, {bench.recording(105, 5400)});
  CHECK(test::holds(found));
}

TEST_CASE("the noise of a current sensor hides no winding apart from the stator") {
  Bench bench;
  bench.sensor_A = 12.0;
  bench.has_winding = true;
  const Diagnosis found = bench.answer(4);
  CHECK((found.verdict == Verdict::explained || found.verdict == Verdict::ambiguous));
  REQUIRE_FALSE(found.cause.empty());
  // A stator behind a contact is the same two nodes.
  const std::vector<std::string> two_nodes{"second_thermal_mass", "contact_resistance", "enclosure"};
  CHECK(std::find(two_nodes.begin(), two_nodes.end(), found.cause.front().effect) != two_nodes.end());
}

}  // namespace
