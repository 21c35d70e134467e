// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Causes beside constants that could stand in their place, on plants stepped here apart from the library's equations: what a fit
// can bend the constants to is not what is missing.
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace thermopower::gap;

namespace {

/// A thermometer shows a part of the rise above the air, and late.
Recording shown_in_part(double share, int rows, std::uint64_t seed) {
  test::BenchFault fault;
  fault.lag_s = 25.0;
  Recording recording = test::bench_recording(fault, rows, seed);
  const Eigen::ArrayXd motor_C = recording.column("motor_C").array(),
                       air_C = recording.column("ambient_C").array();
  recording.set("motor_C", (air_C + share * (motor_C - air_C)).matrix());
  return recording;
}

/// A coil that a controller heats: it sets a current, and holds it for eight readings.
Recording set_and_held(double coupled_share, double length_s, std::uint64_t seed) {
  test::Noise noise(seed);
  const auto rows = static_cast<Eigen::Index>(length_s);
  Recording r;
  r.name = "coil";
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1));
  Eigen::VectorXd current(rows), motor(rows), ambient = Eigen::VectorXd::Constant(rows, 22.0);
  double winding_C = 22.0, housing_C = 22.0, set_A = 0.0;
  const double winding_J_per_K = 120.0 * (1.0 - coupled_share), housing_J_per_K = 120.0 * coupled_share;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (row % 8 == 0)
      set_A = std::max(
          0.0, std::round(1e3 * (2.0 + 1.2 * std::sin(0.011 * static_cast<double>(row)) +
                                 0.9 * std::sin(0.037 * static_cast<double>(row) + 1.0) + 0.2 * noise())) /
                   1e3);
    current[row] = set_A;
    motor[row] = std::round(10.0 * (winding_C + 0.05 * noise())) / 10.0;
    for (int k = 0; k < 20; ++k) {
      const double step_s = 0.05, heat_W = set_A * set_A * 2.0;
      if (coupled_share > 0.0) {
        const double across_W = 1.5 * (winding_C - housing_C);
        winding_C += step_s * (heat_W - across_W) / winding_J_per_K;
        housing_C += step_s * (across_W - 0.4 * (housing_C - 22.0)) / housing_J_per_K;
      } else {
        winding_C += step_s * (heat_W - 0.4 * (winding_C - 22.0)) / 120.0;
      }
    }
  }
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  return r;
}

}  // namespace

TEST_CASE("a thermometer's gain beside its lag is not a re-scaling of every constant") {
  const Diagnosis diagnosis =
      diagnose(test::bench_model(), {shown_in_part(0.8, 1200, 3)}, {shown_in_part(0.8, 800, 4)});
  INFO(diagnosis.reason);
  std::vector<std::vector<std::string>> said{test::causes_of(diagnosis)};
  for (std::vector<std::string> one : diagnosis.alternatives) {
    std::sort(one.begin(), one.end());
    said.push_back(one);
  }
  CHECK(std::count(said.begin(), said.end(),
                   std::vector<std::string>{"thermometer_gain", "thermometer_lag"}) == 1);
}

TEST_CASE("a current that is set and held heats as it stands: it is no slow sensor's") {
  Model coil;
  coil.name = "coil";
  coil.current = OhmicCurrentModel{2.0, 0.0, 25.0};
  coil.thermal = LumpedThermalModel{120.0, 0.4};
  const Diagnosis sound = diagnose(coil, {set_and_held(0.0, 2400.0, 5)}, {set_and_held(0.0, 1600.0, 6)});
  INFO(sound.reason);
  CHECK(test::holds(sound));
  for (const Finding& finding : sound.findings)
    CHECK((finding.column != "current_A" || finding.action == FindingAction::none));
  const Diagnosis split = diagnose(coil, {set_and_held(0.6, 2400.0, 7)}, {set_and_held(0.6, 1600.0, 8)});
  INFO(split.reason);
  CHECK(test::causes_of(split) == std::vector<std::string>{"second_thermal_mass"});
}

TEST_CASE("a friction that the model has may stick, and hides nothing beside it") {
  test::AxisFault weighed;
  weighed.coulomb_Nm = 0.006;
  weighed.weight_Nm = 0.010;
  Model model = test::axis_model();
  model.effects["coulomb_friction"] = {{"Nm", 0.006}, {"transition_rad_per_s", 0.01}};
  const Diagnosis diagnosis =
      diagnose(model, {test::axis_recording(weighed, 2000, 3)}, {test::axis_recording(weighed, 1200, 8)});
  INFO(diagnosis.reason);
  CHECK(test::causes_of(diagnosis) == std::vector<std::string>{"imbalance"});
  CHECK(diagnosis.verdict == Verdict::explained);
}

TEST_CASE("friction that softens within two thirds of a radian a second is dry friction") {
  test::AxisFault soft;
  soft.coulomb_Nm = 0.008;
  soft.soft_within_rad_per_s = 0.7;
  const Diagnosis diagnosis = diagnose(test::axis_model(), {test::axis_recording(soft, 2000, 3)},
                                       {test::axis_recording(soft, 1200, 8)});
  INFO(diagnosis.reason);
  CHECK(test::causes_of(diagnosis) == std::vector<std::string>{"coulomb_friction"});
}

TEST_CASE("a drag of the air beside dry friction is no friction that vanishes in motion") {
  for (const double drag_Nms2 : {1e-4, 3e-4}) {
    CAPTURE(drag_Nms2);
    test::AxisFault rough;
    rough.coulomb_Nm = 0.004;
    rough.drag_Nms2 = drag_Nms2;
    const Diagnosis diagnosis = diagnose(test::axis_model(), {test::axis_recording(rough, 2500, 3)},
                                         {test::axis_recording(rough, 1500, 8)});
    INFO(diagnosis.reason);
    const std::vector<std::string> causes = test::causes_of(diagnosis);
    CHECK(std::count(causes.begin(), causes.end(), "stribeck_friction") == 0);
    CHECK(diagnosis.verdict != Verdict::no_gap);
  }
}

TEST_CASE("a drag that goes with the rate is no noise that remembers, however rough the rate is") {
  // A propeller that a voltage turns, told by its controller's telemetry: its drag grows with the square of the rate.
  const auto record = [](int rows, std::uint64_t seed) {
    constexpr double J = 6.5e-5, b = 1e-5, drag_Nms2 = 4e-8, Kt = 0.01, ohm = 0.11,
                     degrees = 57.29577951308232;
    test::Noise noise(seed);
    Recording r;
    r.name = "propeller";
    r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.02 * (rows - 1));
    Eigen::VectorXd voltage(rows), rate(rows);
    double omega = 0.0, volts = 0.0;
    for (int i = 0; i < rows; ++i) {
      if (i % 40 == 0) volts = 4.0 + 2.5 * std::sin(0.9 * i + static_cast<double>(seed)) + noise();
      voltage[i] = volts;
      rate[i] = degrees * omega + 60.0 * noise();
      for (int k = 0; k < 100; ++k)
        omega +=
            2e-4 * (Kt * (volts - Kt * omega) / ohm - b * omega - drag_Nms2 * omega * std::fabs(omega)) / J;
    }
    r.set("voltage_V", voltage);
    r.set("rate_dps", rate);
    return r;
  };
  Model model;
  model.name = "propeller";
  RigidAxisModel axis{6.5e-5, 2.9e-5, 0.01};
  axis.resistance_ohm = 0.11;
  model.axis = axis;
  const Diagnosis diagnosis = diagnose(model, {record(2500, 3)}, {record(1500, 8)});
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict != Verdict::no_gap);
}
