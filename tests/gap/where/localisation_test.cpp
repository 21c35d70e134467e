// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/where/localisation.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <map>
#include <string>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
namespace plant = thermopower::plant;

namespace {

using Effects = std::map<std::string, EffectParameters>;

Localisation bench(const test::BenchFault& fault, const Effects& baseline = {}) {
  Model model = test::bench_model();
  model.effects = baseline;
  return localise(model, {test::bench_recording(fault, 1500, 3)}, standard_catalogue());
}
Localisation axis(const test::AxisFault& fault, const Effects& baseline = {}) {
  Model model = test::axis_model();
  model.effects = baseline;
  return localise(model, {test::axis_recording(fault, 4000, 3)}, standard_catalogue());
}

void check_first(const Localisation& found, Signal signal, plant::Submodel submodel) {
  REQUIRE_FALSE(found.where.empty());
  CHECK(found.where.front().signal == signal);
  CHECK(found.where.front().submodel == submodel);
  CHECK(found.where.front().share > 0.8);
  CHECK_FALSE(found.where.front().evidence.empty());
  CHECK_FALSE(found.quantities.empty());
}

}  // namespace

TEST_CASE("nothing is accused where the model holds, nor where its constants are within their slack") {
  CHECK(bench({}).where.empty());
  CHECK(axis({}).where.empty());
  test::BenchFault slack;
  slack.motor_scale = 1.035;
  CHECK(bench(slack).where.empty());
}

TEST_CASE("a loss that grows faster than the rise is placed in the loss") {
  test::BenchFault fault;
  fault.extra_loss_W_per_K2 = 0.003;
  check_first(bench(fault), Signal::motor_C, plant::Submodel::thermal_loss);
}

TEST_CASE("a lagging thermometer is placed in the thermometer") {
  test::BenchFault fault;
  fault.lag_s = 25.0;
  check_first(bench(fault), Signal::motor_C, plant::Submodel::sensing_temperature);
}

TEST_CASE("a current sensor's faults are not blamed on the motor, nor a wire's on the temperature") {
  test::BenchFault fault;
  fault.sensor_offset_A = 0.03;
  check_first(bench(fault), Signal::current_A, plant::Submodel::sensing_current);
  CHECK(bench(fault).where.size() == 1);
  fault = {};
  fault.sensor_gain = 1.15;
  check_first(bench(fault), Signal::current_A, plant::Submodel::sensing_current);
  CHECK(bench(fault).where.size() == 1);
  fault = {};
  fault.series_ohm = 1.2;
  check_first(bench(fault), Signal::current_A, plant::Submodel::electrical);
  CHECK(bench(fault).where.size() == 1);
}

TEST_CASE("friction, spring, delay and a wrong angle are told apart") {
  test::AxisFault fault;
  fault.coulomb_Nm = 0.004;
  check_first(axis(fault), Signal::rate_dps, plant::Submodel::mechanical_friction);
  fault = {};
  fault.spring_Nm_per_rad = 0.01;
  check_first(axis(fault), Signal::rate_dps, plant::Submodel::mechanical_load);
  CHECK(axis(fault).where.front().regime->variable == "angle_deg");
  fault = {};
  fault.delay_rows = 2;
  check_first(axis(fault), Signal::rate_dps, plant::Submodel::mechanical_drive);
  fault = {};
  fault.angle_gain = 1.1;
  check_first(axis(fault), Signal::angle_deg, plant::Submodel::sensing_angle);
}

TEST_CASE("an encoder that errs several times a turn is placed in the angle") {
  for (const double repeats : {1.0, 2.0, 8.0}) {
    CAPTURE(repeats);
    Recording recording = test::axis_recording({}, 4000, 3);
    Eigen::VectorXd angle = recording.column("angle_deg");
    for (double& one : angle) one += 0.8 * std::sin(repeats * one / 57.29577951308232);
    recording.set("angle_deg", angle);
    const Localisation found = localise(test::axis_model(), {recording}, standard_catalogue());
    check_first(found, Signal::angle_deg, plant::Submodel::sensing_angle);
    CHECK(found.where.front().regime->variable == "angle_deg");
  }
}

TEST_CASE(
    "a torque constant that varies over the turn is the drive's fault, and friction that warmth thins is friction's") {
  test::AxisFault fault;
  fault.ripple_share = 0.2;
  check_first(axis(fault), Signal::rate_dps, plant::Submodel::mechanical_drive);
  CHECK(axis(fault).where.front().regime->variable == "angle_deg");
  CHECK(axis(fault).where.size() == 1);
  fault = {};
  fault.thinning_per_K = 0.02;
  check_first(axis(fault), Signal::rate_dps, plant::Submodel::mechanical_friction);
  CHECK(axis(fault).where.front().regime->variable == "motor_C");
  CHECK(axis(fault).where.size() == 1);
}

TEST_CASE("the missing quantity has the size that was put in") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.01;
  const Localisation found = axis(fault);
  REQUIRE_FALSE(found.quantities.empty());
  const MissingQuantity& q = found.quantities.front();
  REQUIRE(q.variable == "angle_deg");
  REQUIRE(q.unit == "N m");
  const Eigen::Index last = q.x.size() - 1;
  const double slope = (q.value[last] - q.value[0]) / (q.x[last] - q.x[0]) * 57.29577951;
  CHECK(slope == Approx(-0.01).epsilon(0.05));
}

TEST_CASE("recordings without the needed columns, or too short, place nothing") {
  Recording r;
  r.t_s = Eigen::VectorXd::LinSpaced(100, 0.0, 99.0);
  r.set("motor_C", Eigen::VectorXd::Constant(100, 20.0));
  CHECK(localise(test::bench_model(), {r}, standard_catalogue()).where.empty());
  CHECK(localise(test::axis_model(), {r}, standard_catalogue()).where.empty());
  CHECK(
      localise(test::bench_model(), {test::bench_recording({}, 20, 1)}, standard_catalogue()).where.empty());
}

TEST_CASE(
    "what the model has already is not missing: its effects act in its balances as they do when it is simulated") {
  test::BenchFault fault;
  fault.sensor_offset_A = 0.03;
  CHECK(bench(fault, {{"current_sensor_offset", {{"A", 0.03}}}}).where.empty());
  fault = {};
  fault.sensor_gain = 1.15;
  CHECK(bench(fault, {{"current_sensor_gain", {{"gain", 1.15}}}}).where.empty());
  fault = {};
  fault.series_ohm = 1.2;
  CHECK(bench(fault, {{"series_resistance", {{"ohm", 1.2}}}}).where.empty());
  fault = {};
  fault.lag_s = 25.0;
  // The circuit is judged at what the thermometer shows; the body is not blamed for its lag.
  for (const Location& one : bench(fault, {{"thermometer_lag", {{"lag_s", 25.0}}}}).where)
    CHECK(one.signal != Signal::motor_C);
  test::AxisFault joint;
  joint.coulomb_Nm = 0.004;
  CHECK(axis(joint, {{"coulomb_friction", {{"Nm", 0.004}}}}).where.empty());
  joint = {};
  joint.spring_Nm_per_rad = 0.01;
  CHECK(axis(joint, {{"cable_spring", {{"Nm_per_rad", 0.01}, {"centre_rad", 0.0}}}}).where.empty());
  joint = {};
  joint.delay_rows = 2;
  CHECK(axis(joint, {{"actuation_delay", {{"s", 0.02}}}}).where.empty());
  joint = {};
  joint.angle_gain = 1.1;
  CHECK(axis(joint, {{"angle_scale", {{"gain", 1.1}}}}).where.empty());
}

TEST_CASE("a second fault is placed beside what the model has already") {
  test::AxisFault joint;
  joint.coulomb_Nm = 0.004;
  joint.spring_Nm_per_rad = 0.01;
  check_first(axis(joint, {{"coulomb_friction", {{"Nm", 0.004}}}}), Signal::rate_dps,
              plant::Submodel::mechanical_load);
  check_first(axis(joint, {{"cable_spring", {{"Nm_per_rad", 0.01}, {"centre_rad", 0.0}}}}), Signal::rate_dps,
              plant::Submodel::mechanical_friction);
}
