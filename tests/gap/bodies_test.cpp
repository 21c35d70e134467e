// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>

// Bodies of more nodes than their simulation knows, stepped here apart from the library's equations.

using namespace thermopower::gap;

namespace {

/// Heat capacities in J/K and conductances in W/K; 0: there is no such part.
struct Body {
  double winding = 0.0, coupling = 1.0;                  ///< heated part of its own, coupled to the surface
  double surface = 60.0, to_air = 0.15;                  ///< loses the heat
  double mount = 0.0, to_mount = 0.0;                    ///< behind the surface
  double box = 0.0, box_to_room = 0.0;                   ///< air around it
  double sink = 0.0, contact = 1.0, sink_to_room = 0.0;  ///< what it is bolted to; the contact in K/W
  double hysteresis = 0.0, eddy = 0.0;                   ///< heat of the iron, W s/rad and W s^2/rad^2
};

Recording record(const Body& body, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "body";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows), supply(rows);
  Eigen::VectorXd rate(rows);
  double winding = 23.0, surface = 23.0, mount = 23.0, box = 23.0, sink = 23.0, level = 200.0;
  for (int i = 0; i < rows; ++i) {
    if (i % 150 == 0) level = 25.0 * std::floor(5.2 + 5.0 * std::sin(1.7 * i + static_cast<double>(seed)));
    if ((i / 150) % 4 == 3) level = 0.0;
    // Still, turning slowly forward, fast backward, at changing power.
    const double turning = (i / 110) % 3 == 0 ? 0.0 : (i / 110) % 3 == 1 ? 8.0 : -25.0;
    rate[i] = turning * 57.29577951308232;
    r.t_s[i] = 2.0 * i;
    power[i] = level;
    supply[i] = 12.0;
    ambient[i] = 23.0;
    double& hot = body.winding > 0.0 ? winding : surface;
    const double v = 12.0 * std::sqrt(level / 255.0);
    const auto ohm = [&] { return 8.0 * (1.0 + 0.00393 * (hot - 25.0)); };
    current[i] = v / ohm() + 0.003 * noise();
    motor[i] = hot + 0.05 * noise();
    constexpr int steps = 100;
    for (int k = 0; k < steps; ++k) {
      const double h = 2.0 / steps, heat = v * v / ohm();
      const double air = body.box > 0.0 ? box : 23.0;
      const double lost = body.to_air * (surface - air), soaked = body.to_mount * (surface - mount);
      const double iron = body.hysteresis * std::fabs(turning) + body.eddy * turning * turning;
      const double sunk = body.sink > 0.0 ? (surface - sink) / body.contact : 0.0;
      double into_surface = heat;
      if (body.winding > 0.0) {
        into_surface = body.coupling * (winding - surface);
        winding += h * (heat - into_surface) / body.winding;
      }
      surface += h * (into_surface + iron - lost - soaked - sunk) / body.surface;
      if (body.sink > 0.0) sink += h * (sunk - body.sink_to_room * (sink - 23.0)) / body.sink;
      if (body.mount > 0.0) mount += h * soaked / body.mount;
      if (body.box > 0.0) box += h * (lost - body.box_to_room * (box - 23.0)) / body.box;
    }
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  r.set("supply_V", supply);
  if (body.hysteresis + body.eddy > 0.0) r.set("rate_dps", rate);
  return r;
}

/// Whether the interval of a parameter of the cause holds a value.
bool holds(const Diagnosis& diagnosis, const std::string& name, double value) {
  for (const Cause& cause : diagnosis.cause)
    for (const ParameterEstimate& one : cause.parameters)
      if (one.name == name) return one.ci95.low <= value && value <= one.ci95.high;
  return false;
}

Diagnosis diagnosed(const Model& model, const Body& body, int effects_at_once = 1) {
  Options options;
  options.effects_at_once = effects_at_once;
  return diagnose(model, {record(body, 2400, 3)}, {record(body, 1500, 8)}, options);
}

/// What a motor is bolted to is the one cause, with its numbers.
void check_sink_is_found(const Body& body) {
  const Diagnosis diagnosis = diagnosed(test::bench_model(), body);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "contact_resistance");
  CHECK(holds(diagnosis, "J_per_K", body.sink));
  CHECK(holds(diagnosis, "K_per_W", body.contact));
  CHECK(holds(diagnosis, "W_per_K", body.sink_to_room));
}

}  // namespace

TEST_CASE("behind a winding and a surface that the simulation knows, the third mass is found too") {
  Body body;
  body.winding = 15.0;
  body.coupling = 0.8;
  body.surface = 45.0;
  body.mount = 60.0;
  body.to_mount = 0.08;
  Model model = test::bench_model();
  model.set("heat_capacity_J_per_K", 120.0);
  model.effects["second_thermal_mass"] = {{"winding_share", 0.25}, {"coupling", 0.8}};
  const Diagnosis diagnosis = diagnosed(model, body);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "third_thermal_mass");
  CHECK(test::parameter_of(diagnosis, "coupling") == Approx(0.08).epsilon(0.1));
}

TEST_CASE("air that warms up around the body is found") {
  Body body;
  body.box = 50.0;
  body.box_to_room = 0.2;
  const Diagnosis diagnosis = diagnosed(test::bench_model(), body);
  INFO(diagnosis.reason);
  // A box and a mount differ in where the heat goes in the end; here both are told apart by their times.
  REQUIRE_FALSE(diagnosis.cause.empty());
  CHECK(diagnosis.cause.front().effect == "enclosure");
  CHECK(test::parameter_of(diagnosis, "W_per_K") == Approx(0.2).epsilon(0.1));
}

TEST_CASE(
    "what a motor is bolted to is found behind its contact, and what is known of the motor tells it from a box") {
  Body body;
  body.sink = 180.0;
  body.contact = 4.0;
  body.sink_to_room = 0.3;
  check_sink_is_found(body);

  // Were nothing known of the motor, a surface with a winding in it would be the same circuit.
  Model unknown = test::bench_model();
  unknown.uncertainty["thermal.heat_capacity_J_per_K"] = 1.0;
  unknown.uncertainty["thermal.conductance_W_per_K"] = 1.0;
  const Diagnosis open = diagnosed(unknown, body);
  INFO(open.reason);
  CHECK_FALSE((open.cause.size() == 1 && open.cause.front().effect == "contact_resistance" &&
               open.alternatives.empty()));
}

TEST_CASE("a frame that takes most of a run to warm up is a frame, and no box of air") {
  Body body;
  body.sink = 1800.0;
  body.contact = 4.0;
  body.sink_to_room = 0.3;  // 0.68 of a run of 4800 s
  check_sink_is_found(body);
}

TEST_CASE(
    "heat of the iron is told from heat that goes with the square of the rate, and by where it enters") {
  Body body;
  body.hysteresis = 0.12;
  const Diagnosis by_rate = diagnosed(test::bench_model(), body);
  INFO(by_rate.reason);
  REQUIRE(by_rate.cause.size() == 1);
  CHECK(by_rate.cause.front().effect == "iron_loss");
  CHECK(holds(by_rate, "hysteresis_W_s_per_rad", 0.12));

  body.hysteresis = 0.0;
  body.eddy = 0.004;
  const Diagnosis by_square = diagnosed(test::bench_model(), body);
  INFO(by_square.reason);
  REQUIRE(by_square.cause.size() == 1);
  CHECK(by_square.cause.front().effect == "motion_heating");
  CHECK(holds(by_square, "W_s2_per_rad2", 0.004));

  // In a body whose winding the simulation knows, the iron's heat enters behind it.
  body.winding = 15.0;
  body.coupling = 0.5;
  body.surface = 45.0;
  Model model = test::bench_model();
  model.effects["second_thermal_mass"] = {{"winding_share", 0.25}, {"coupling", 0.5}};
  const Diagnosis in_stator = diagnosed(model, body);
  INFO(in_stator.reason);
  REQUIRE(in_stator.cause.size() == 1);
  CHECK(in_stator.cause.front().effect == "iron_loss");
  CHECK(holds(in_stator, "eddy_W_s2_per_rad2", 0.004));
}

TEST_CASE("two nodes are not taken for three") {
  Body body;
  body.winding = 15.0;
  body.coupling = 0.8;
  body.surface = 45.0;
  const Diagnosis diagnosis = diagnosed(test::bench_model(), body);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "second_thermal_mass");
}

TEST_CASE("a heating law that was called with its arguments exchanged is named") {
  // dT/dt = V I / c(V) - k (T - Ta) with c = 60 (0.2435 V - 0.4952) J/K, and a current of its own.
  test::Noise noise(5);
  const auto recorded = [&](int rows, double phase) {
    Recording r;
    r.name = "heating law";
    r.t_s.resize(rows);
    Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows), supply(rows);
    double motor_C = 24.0;
    for (int i = 0; i < rows; ++i) {
      const double level = (i / 120) % 4 == 3 ? 0.0 : 60.0 + 40.0 * std::sin(phase + i / 120);
      const double v = 13.0 * std::sqrt(level / 255.0);
      const auto ampere = [&] {
        return v > 1.0 ? 1e-3 * ((0.6311 * v - 2.497) * motor_C + 0.1257 * std::pow(v, 3.4135)) : 0.0;
      };
      r.t_s[i] = 5.0 * i;
      power[i] = level;
      supply[i] = 13.0;
      ambient[i] = 24.0;
      current[i] = std::fmax(ampere(), 0.0) + 0.0005 * noise();
      motor[i] = motor_C + 0.05 * noise();
      for (int k = 0; k < 50; ++k) {
        const double heating = v > 1.0 ? v * std::fmax(ampere(), 0.0) / (60.0 * (0.2435 * v - 0.4952)) : 0.0;
        motor_C += 0.1 * (heating - 0.05 / 60.0 * (motor_C - 24.0));
      }
    }
    r.set("power_param", power);
    r.set("current_A", current);
    r.set("motor_C", motor);
    r.set("ambient_C", ambient);
    r.set("supply_V", supply);
    return r;
  };
  Model model;
  model.name = "heating law";
  model.supply = SupplyModel{13.0};
  model.current = ThesisCurrentModel{0.0, 0.6311, -2.497, 0.1257, 3.4135, 1.0};
  model.thermal = ThesisThermalModel{0.05, 0.0, 0.2435, 0.0, -0.4952, 1.0};  // 0.2435 times the temperature
  Options options;
  options.effects_at_once = 1;
  const Diagnosis diagnosis = diagnose(model, {recorded(1500, 0.3)}, {recorded(900, 1.1)}, options);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.verdict == Verdict::explained);
  CHECK(diagnosis.cause.front().effect == "law.exchanged_heating");
  CHECK(diagnosis.augmented.effects.count("law.exchanged_heating") == 1);
  std::get<ThesisThermalModel>(model.thermal) = {0.05, 0.0, 0.0, 0.2435, -0.4952, 1.0};
  CHECK(test::holds(diagnose(model, {recorded(1500, 0.3)}, {recorded(900, 1.1)}, options)));
}
