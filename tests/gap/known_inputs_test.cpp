// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <map>

// Inputs besides command and power: the voltage of a brushed motor, a torque from outside, a heat that is known. The
// plants are stepped here, apart from the library's equations.

using namespace thermopower::gap;

namespace {

/// A brushed motor at a voltage; what its simulation does not know is 0.
struct BrushedMotor {
  double inertia = 2e-4, viscous = 2e-4, torque_constant = 0.04, ohm = 2.0;
  double coulomb_Nm = 0.0;
  double inductance_H = 0.0;
};

double sines(double t, double seed) {
  return 0.4 * std::sin(2.1 * t + seed) + 0.35 * std::sin(5.3 * t + 1.0 + seed) + 0.25 * std::sin(13.0 * t) +
         0.15 * std::sin(0.7 * t + 2.0 * seed);
}

Recording record(const BrushedMotor& motor, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "brushed";
  r.t_s.resize(rows);
  Eigen::VectorXd voltage(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0, current = 0.0;
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 0.01 * i;
    voltage[i] = 0.5 * sines(r.t_s[i], static_cast<double>(seed));
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.3 * noise();
    for (int k = 0; k < 400; ++k) {
      const double h = 2.5e-5, drop = voltage[i] - motor.torque_constant * omega;
      if (motor.inductance_H > 0.0) current += h * (drop - motor.ohm * current) / motor.inductance_H;
      else current = drop / motor.ohm;
      const double push = motor.torque_constant * current - motor.viscous * omega;
      const double next = omega + h * push / motor.inertia, brake = h * motor.coulomb_Nm / motor.inertia;
      omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      theta += h * omega;
    }
  }
  r.set("voltage_V", voltage);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

Model brushed_model() {
  const BrushedMotor motor;
  Model model;
  model.name = "brushed";
  model.axis = RigidAxisModel{motor.inertia, motor.viscous, motor.torque_constant, motor.ohm};
  return model;
}

/// An axis at a commanded current that somebody pulls at.
Recording pulled(double per_Nm, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "pulled";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), pull(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0;
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 0.01 * i;
    drive[i] = 0.2 * sines(r.t_s[i], static_cast<double>(seed));
    const double pull_Nm = 0.02 * std::sin(3.1 * r.t_s[i]) * std::sin(0.37 * r.t_s[i] + 1.0);
    pull[i] = per_Nm * pull_Nm;
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.15 * noise();
    for (int k = 0; k < 100; ++k) {
      omega += 1e-4 * (0.2 * drive[i] + pull_Nm - 1e-3 * omega) / 1e-3;
      theta += 1e-4 * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("torque_Nm", pull);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

Model axis_model() {
  Model model;
  model.name = "axis";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.2};
  return model;
}

/// A brake whose heat is known, of one node or of two.
Recording heated(double winding_share, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "brake";
  r.t_s.resize(rows);
  Eigen::VectorXd heat(rows), motor(rows), air(rows);
  double inner = 22.0, outer = 22.0;
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 2.0 * i;
    heat[i] = (i / 60) % 3 == 2 ? 0.0 : 3.0 + 2.5 * std::sin(2.3 * (i / 60) + static_cast<double>(seed));
    air[i] = 22.0;
    motor[i] = inner + 0.08 * noise();
    for (int k = 0; k < 50; ++k) {
      const double h = 0.04, flow = 0.6 * (inner - outer);
      if (winding_share < 1.0) {
        inner += h * (heat[i] - flow) / (winding_share * 80.0);
        outer += h * (flow - 0.12 * (outer - 22.0)) / ((1.0 - winding_share) * 80.0);
      } else {
        inner += h * (heat[i] - 0.12 * (inner - 22.0)) / 80.0;
      }
    }
  }
  r.set("heat_W", heat);
  r.set("motor_C", motor);
  r.set("ambient_C", air);
  return r;
}

Model brake_model() {
  Model model;
  model.name = "brake";
  model.thermal = LumpedThermalModel{80.0, 0.12};
  return model;
}

Diagnosis diagnosed(const Model& model, const Recording& train, const Recording& held_out) {
  Options options;
  options.effects_at_once = 1;
  return diagnose(model, {train}, {held_out}, options);
}

bool names(const Diagnosis& diagnosis, const std::string& id) {
  return std::any_of(diagnosis.cause.begin(), diagnosis.cause.end(),
                     [&](const Cause& one) { return one.effect == id; });
}

bool names_or_lists(const Diagnosis& diagnosis, const std::string& id) {
  for (const auto& alternative : diagnosis.alternatives)
    if (std::find(alternative.begin(), alternative.end(), id) != alternative.end()) return true;
  return names(diagnosis, id);
}

}  // namespace

TEST_CASE("an axis at a voltage follows its law, back-EMF included") {
  // Nine seconds hold eighteen windows: what they score scatters about the floor by a tenth, and on average it is there.
  constexpr unsigned draws = 8;
  std::map<std::string, double> scores;
  for (unsigned seed = 3; seed < 3 + draws; ++seed) {
    const Diagnosis diagnosis =
        diagnosed(brushed_model(), record({}, 1500, seed), record({}, 900, seed + 100));
    INFO(diagnosis.reason);
    CHECK(test::holds(diagnosis));
    for (const GapScore& gap : diagnosis.gap)
      scores[to_string(gap.signal)] += gap.before / gap.noise_floor / draws;
  }
  REQUIRE(scores.size() == 2);
  for (const auto& [signal, score] : scores) {
    CAPTURE(signal);
    CHECK(score == Approx(1.0).margin(0.1));
  }
}

TEST_CASE("what an axis at a voltage lacks is found") {
  BrushedMotor rubbing;
  rubbing.coulomb_Nm = 0.002;
  const Diagnosis friction = diagnosed(brushed_model(), record(rubbing, 1500, 3), record(rubbing, 900, 5));
  INFO(friction.reason);
  REQUIRE(friction.cause.size() == 1);
  CHECK(friction.cause.front().effect == "coulomb_friction");
  CHECK(test::parameter_of(friction, "Nm") == Approx(0.002).epsilon(0.05));
  REQUIRE_FALSE(friction.where.empty());
  CHECK(friction.where.front().submodel == Submodel::mechanical_friction);

  // The current follows the voltage by the time constant L / R.
  BrushedMotor inductive;
  inductive.inductance_H = 0.06;
  const Diagnosis lag = diagnosed(brushed_model(), record(inductive, 1500, 3), record(inductive, 900, 5));
  INFO(lag.reason);
  CHECK(names(lag, "drive_lag"));
  CHECK(test::parameter_of(lag, "lag_s") == Approx(0.03).epsilon(0.05));
}

TEST_CASE("a motor's wrong constant is told from the others as far as its equation allows") {
  // Resistance and inertia both divide what the voltage does; only bearing friction tells them apart.
  BrushedMotor motor;
  motor.ohm = 2.9;
  const Diagnosis resistance = diagnosed(brushed_model(), record(motor, 1500, 3), record(motor, 900, 5));
  INFO(resistance.reason);
  CHECK(names_or_lists(resistance, "calibration.motor_resistance"));
  // The torque constant enters as itself and, by back-EMF, as its square.
  motor = {};
  motor.torque_constant = 0.055;
  const Diagnosis constant = diagnosed(brushed_model(), record(motor, 1500, 3), record(motor, 900, 5));
  INFO(constant.reason);
  REQUIRE(constant.cause.size() == 1);
  CHECK(constant.cause.front().effect == "calibration.torque_constant");
  CHECK(constant.augmented.get("torque_constant_Nm_per_A") == Approx(0.055).epsilon(0.04));
}

TEST_CASE("a recorded torque from outside is an input, and without it there is a gap") {
  const Recording train = pulled(1.0, 1500, 3), held_out = pulled(1.0, 900, 5);
  const Diagnosis known = diagnosed(axis_model(), train, held_out);
  INFO(known.reason);
  CHECK(test::holds(known));
  Recording blind = train, blind_held_out = held_out;
  for (Recording* one : {&blind, &blind_held_out}) one->remove("torque_Nm");
  const Diagnosis unknown = diagnosed(axis_model(), blind, blind_held_out);
  INFO(unknown.reason);
  CHECK(unknown.verdict != Verdict::no_gap);
  CHECK(unknown.verdict != Verdict::explained);
}

TEST_CASE("units and signs of the inputs are checked") {
  const auto finding = [](const DataReport& report, const std::string& column) -> std::string {
    for (const Finding& one : report.findings)
      if (one.column == column && one.severity == Severity::error) return one.mend;
    return "";
  };
  CHECK(finding(check_data(axis_model(), {pulled(1000.0, 1500, 3)}), "torque_Nm") ==
        "--column torque_Nm=torque_Nm:mNm");
  Recording hot = heated(1.0, 600, 3);
  hot.set("heat_W", (hot.column("heat_W") * 1000.0).eval());
  CHECK(finding(check_data(brake_model(), {hot}), "heat_W") == "--column heat_W=heat_W:mW");
  Recording turned = record({}, 1500, 3);
  turned.set("voltage_V", (-turned.column("voltage_V")).eval());
  CHECK(finding(check_data(brushed_model(), {turned}), "voltage_V") == "--column voltage_V=voltage_V:-V");
}

TEST_CASE("a recorded heat stands in the place of the winding's") {
  const Diagnosis known = diagnosed(brake_model(), heated(1.0, 600, 3), heated(1.0, 400, 5));
  INFO(known.reason);
  CHECK(test::holds(known));
  const Diagnosis two = diagnosed(brake_model(), heated(0.25, 600, 3), heated(0.25, 400, 5));
  INFO(two.reason);
  REQUIRE(two.cause.size() == 1);
  CHECK(two.cause.front().effect == "second_thermal_mass");
  CHECK(test::parameter_of(two, "winding_share") == Approx(0.25).epsilon(0.05));
  REQUIRE_FALSE(two.where.empty());
  CHECK(two.where.front().submodel == Submodel::thermal_storage);
}

TEST_CASE("what lacks its column is not judged, and the report says which") {
  Recording commanded = record({}, 300, 3);
  commanded.set("drive_A", commanded.column("voltage_V"));
  commanded.remove("voltage_V");
  const DataReport report = check_data(brushed_model(), {commanded});
  REQUIRE_FALSE(report.not_judged.empty());
  CHECK_THAT(report.not_judged.front(), ContainsSubstring("voltage_V"));
}
