// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>

// Gears that lose another part when they are driven from behind, and magnets that hold with two harmonics, stepped here apart from
// the library's equations: each is named with its numbers, and where data cannot tell it from its neighbour, that is said.

using namespace thermopower::gap;

namespace {

/// A motor behind a gear; everything off by default.
struct Geared {
  double forward = 1.0,
         backward = 1.0;       ///< part of the torque that arrives, from the motor and from the load
  double known_load_Nm = 0.0;  ///< size of a torque on the load's side that is recorded
  bool one_way = false;        ///< it is driven forward only, and never brakes
  double magnets_Nm = 0.0, second_Nm = 0.0;
};

constexpr double inertia = 1e-3, viscous = 1e-3, torque_constant = 0.2, magnet_cycles = 12.0;

Recording record(const Geared& joint, int rows, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "gear";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows), outside(rows);
  double theta = 0.0, omega = 0.0;
  for (int i = 0; i < rows; ++i) {
    const double t = 0.01 * i, phase = static_cast<double>(seed);
    const double wave = 0.10 * std::sin(2.1 * t + phase) + 0.08 * std::sin(5.3 * t + 1.0 + phase) +
                        0.05 * std::sin(11.0 * t) + 0.03 * std::sin(0.7 * t + 2.0 * phase);
    r.t_s[i] = t;
    drive[i] = joint.one_way ? 0.06 + 0.2 * std::fabs(wave) : wave;
    outside[i] = joint.known_load_Nm * (std::sin(1.3 * t + 0.4) + 0.6 * std::sin(3.7 * t + phase));
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.15 * noise();
    constexpr int steps = 500;
    for (int k = 0; k < steps; ++k) {
      const double h = 0.01 / steps, motor = torque_constant * drive[i];
      const auto net = [&](double way) {
        const double arrives = motor * way > 0.0 ? joint.forward * motor : motor / joint.backward;
        const double magnets = joint.magnets_Nm * std::sin(magnet_cycles * theta + 0.7) +
                               joint.second_Nm * std::sin(2.0 * magnet_cycles * theta - 0.4);
        return arrives + outside[i] - magnets - viscous * omega;
      };
      if (omega == 0.0) {  // it turns the way that something pushes it through the gear, or holds
        if (net(1.0) > 0.0) omega = h * net(1.0) / inertia;
        else if (net(-1.0) < 0.0) omega = h * net(-1.0) / inertia;
      } else {
        const double next = omega + h * net(omega) / inertia;
        omega = next * omega < 0.0 ? 0.0 : next;
      }
      theta += h * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  if (joint.known_load_Nm > 0.0) r.set("torque_Nm", outside);
  return r;
}

Diagnosis diagnosed(const Geared& joint, double torque_constant_known_to = 0.05) {
  Model model;
  model.name = "gear";
  model.axis = RigidAxisModel{inertia, viscous, torque_constant};
  model.uncertainty["axis.torque_constant_Nm_per_A"] = torque_constant_known_to;
  Options options;
  options.effects_at_once = 1;
  return diagnose(model, {record(joint, 2000, 3)}, {record(joint, 1200, 8)}, options);
}

/// Whether the interval of a parameter of the cause holds a value.
bool holds(const Diagnosis& diagnosis, const std::string& name, double value) {
  for (const Cause& cause : diagnosis.cause)
    for (const ParameterEstimate& one : cause.parameters)
      if (one.name == name) return one.ci95.low <= value && value <= one.ci95.high;
  return false;
}

bool is_cause(const Diagnosis& diagnosis, const std::string& id) {
  return std::any_of(diagnosis.cause.begin(), diagnosis.cause.end(),
                     [&](const Cause& one) { return one.effect == id; });
}

/// Whether it is the answer or one of those that the data cannot tell from it.
bool is_in_class(const Diagnosis& diagnosis, const std::string& id) {
  return is_cause(diagnosis, id) || std::any_of(diagnosis.alternatives.begin(), diagnosis.alternatives.end(),
                                                [&](const std::vector<std::string>& one) {
                                                  return std::find(one.begin(), one.end(), id) != one.end();
                                                });
}

}  // namespace

TEST_CASE("under a load that is known, a gear that loses more from behind is named with both efficiencies") {
  Geared gear;
  gear.forward = 0.85;
  gear.backward = 0.6;
  gear.known_load_Nm = 0.012;
  const Diagnosis diagnosis = diagnosed(gear);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "drive_efficiency");
  CHECK(test::parameter_of(diagnosis, "efficiency") == Approx(0.85).epsilon(0.03));
  CHECK(test::parameter_of(diagnosis, "back_efficiency") == Approx(0.6).epsilon(0.05));
  CHECK(holds(diagnosis, "efficiency", 0.85));
  CHECK(holds(diagnosis, "back_efficiency", 0.6));
}

TEST_CASE("without a load it is friction in the teeth and another torque constant, unless that is known") {
  Geared gear;
  gear.forward = 0.85;
  gear.backward = 0.6;
  const Diagnosis known = diagnosed(gear, 0.01);
  INFO(known.reason);
  REQUIRE(known.cause.size() == 1);
  CHECK(known.cause.front().effect == "drive_efficiency");
  CHECK(holds(known, "efficiency", 0.85));
  CHECK(holds(known, "back_efficiency", 0.6));

  const Diagnosis open = diagnosed(gear, 0.3);
  INFO(open.reason);
  CHECK(is_in_class(open, "load_friction"));
  CHECK_FALSE((is_cause(open, "drive_efficiency") && open.alternatives.empty()));
}

TEST_CASE("driven one way only, a gear's loss is a smaller torque constant") {
  Geared gear;
  gear.forward = 0.8;
  gear.backward = 0.6;
  gear.one_way = true;
  const Diagnosis diagnosis = diagnosed(gear);
  INFO(diagnosis.reason);
  CHECK(is_in_class(diagnosis, "calibration.torque_constant"));
  CHECK_FALSE(is_cause(diagnosis, "drive_efficiency"));
}

TEST_CASE(
    "friction in the teeth that is the same both ways is not taken for another efficiency from behind") {
  Geared gear;
  gear.forward = 0.8;
  gear.backward = 1.0 / 1.2;
  const Diagnosis diagnosis = diagnosed(gear);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "load_friction");
  CHECK(test::parameter_of(diagnosis, "share") == Approx(0.2).epsilon(0.03));
}

TEST_CASE("the second harmonic of cogging is found where there is one, and nowhere else") {
  Geared joint;
  joint.magnets_Nm = 0.004;
  joint.second_Nm = 0.0024;
  const Diagnosis two = diagnosed(joint);
  INFO(two.reason);
  REQUIRE(two.cause.size() == 1);
  CHECK(two.cause.front().effect == "cogging");
  CHECK(test::parameter_of(two, "cycles_per_turn") == Approx(12.0).epsilon(0.002));
  // The first is sin(12 theta + 0.7), the second 0.6 sin(24 theta - 0.4): 1.1 rad behind what is in phase with the first.
  CHECK(test::parameter_of(two, "second_sin") == Approx(0.6 * std::cos(1.1)).margin(0.02));
  CHECK(test::parameter_of(two, "second_cos") == Approx(-0.6 * std::sin(1.1)).margin(0.02));

  joint.second_Nm = 0.0;
  const Diagnosis one = diagnosed(joint);
  INFO(one.reason);
  REQUIRE(one.cause.size() == 1);
  CHECK(one.cause.front().effect == "cogging");
  CHECK(test::parameter_of(one, "cycles_per_turn") == Approx(12.0).epsilon(0.002));
  CHECK(std::isnan(test::parameter_of(one, "second_sin")));  // not even asked for
}
