// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Joints in closed loops: motion follows its target whatever the joint lacks, and the effort tells it.
// The large draw of the same kind is the part `closed_loops` of tests/gap_benchmark.

#include "../../catch.hpp"
#include "closed_loop.hpp"

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/propose/effort_problem.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using thermopower::plant::standard_catalogue;

namespace {

Recording recording_of(const closed_loop::Log& log) {
  const auto vector = [](const std::vector<double>& values) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  Recording one;
  one.name = "joint";
  one.t_s = vector(log.t_s);
  one.set("drive_A", vector(log.drive_A));
  one.set("angle_deg", vector(log.angle_deg));
  one.set("rate_dps", vector(log.rate_dps));
  return one;
}

Model model_of(const closed_loop::Joint& joint) {
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{joint.inertia_kgm2, joint.viscous_Nms_per_rad, joint.torque_constant_Nm_per_A};
  return model;
}

/// A kind of joint: what it has besides, and which effects are of that kind.
struct Kind {
  const char* name;
  std::vector<std::string> family;  ///< empty: nothing is missing
  closed_loop::Extra per_torque;    ///< relative to the RMS torque of the joint without it
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list = [] {
    std::vector<Kind> all;
    const auto add = [&](const char* name, std::vector<std::string> family, auto set) {
      all.push_back({name, std::move(family), {}});
      set(all.back().per_torque);
    };
    add("nothing", {}, [](closed_loop::Extra&) {});
    add("dry friction",
        {"coulomb_friction", "asymmetric_friction", "stribeck_friction", "load_friction", "drive_deadband"},
        [](closed_loop::Extra& one) { one.coulomb = 0.4; });
    add("gravity", {"imbalance"},
        [](closed_loop::Extra& one) { one.gravity = 0.8, one.gravity_phase = 0.6; });
    add("a spring", {"cable_spring"}, [](closed_loop::Extra& one) { one.spring_per_rad = 0.3; });
    add("cogging", {"cogging"}, [](closed_loop::Extra& one) { one.cogging = 0.6, one.cycles = 14.0; });
    add("a weight", {"constant_torque"}, [](closed_loop::Extra& one) { one.constant = 0.6; });
    return all;
  }();
  return list;
}

}  // namespace

TEST_CASE(
    "the kind of what a joint lacks is told from its effort, under three controllers and with guessed constants") {
  struct Controller {
    double stiffness_Hz, dt_s;
    bool integral;
    double noise, guessed;
  };
  const Controller controllers[] = {
      {2.0, 0.01, false, 0.02, 1.0}, {4.0, 0.005, true, 0.12, 1.35}, {8.0, 0.002, true, 0.06, 0.7}};
  std::uint64_t seed = 1;
  for (const Kind& kind : kinds())
    for (const Controller& controller : controllers) {
      CAPTURE(kind.name, controller.stiffness_Hz);
      closed_loop::Joint joint;
      joint.stiffness_Hz = controller.stiffness_Hz;
      joint.integral = controller.integral;
      joint.effort_noise = controller.noise;
      const double torque_Nm = joint.torque_constant_Nm_per_A * closed_loop::effort_rms(closed_loop::follow(
                                                                    joint, controller.dt_s, 2000, seed));
      joint.extra = kind.per_torque;
      for (double* one : {&joint.extra.coulomb, &joint.extra.gravity, &joint.extra.spring_per_rad,
                          &joint.extra.cogging, &joint.extra.constant})
        *one *= torque_Nm;
      Model model = model_of(joint);
      model.axis->inertia_kgm2 *= controller.guessed;
      model.axis->viscous_Nms_per_rad /= controller.guessed;
      const std::vector<Inputs> train = {prepare(model, recording_of(closed_loop::follow(
                                                            joint, controller.dt_s, 2000, seed)))},
                                held_out = {prepare(model, recording_of(closed_loop::follow(
                                                               joint, controller.dt_s, 1500, seed + 1)))};
      seed += 2;
      EffortProblem problem(model, standard_catalogue(), train, held_out);
      REQUIRE(problem.is_judged());
      CHECK(problem.loop() == LoopKind::closed_found);
      const InverseScore told = problem.told();
      const std::string first = told.effects.empty() ? "nothing" : told.effects.front()->info.id;
      CAPTURE(first);
      if (kind.family.empty()) CHECK(told.effects.empty());
      else CHECK(std::count(kind.family.begin(), kind.family.end(), first) == 1);
      // What acts does not lose in this direction.
      if (!kind.family.empty())
        CHECK(problem.score({standard_catalogue().find(kind.family.front())}).share <
              problem.score({}).share);
    }
}

TEST_CASE("a ramp and a staircase both come from outside, however many files there are of each") {
  const Model model = model_of(closed_loop::Joint());
  const auto commanded = [&](auto&& command) {
    Recording one;
    one.name = "open";
    constexpr Eigen::Index rows = 600;
    one.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 5.99);
    Eigen::VectorXd drive(rows), rate(rows);
    for (int i = 0; i < rows; ++i) drive[i] = command(i), rate[i] = 40.0 * std::sin(0.02 * i);
    one.set("drive_A", drive);
    one.set("rate_dps", rate);
    return prepare(model, one);
  };
  const Inputs ramp = commanded([](int i) { return 0.003 * i; }),
               stairs = commanded([](int i) { return 0.2 * (i / 60 % 7); }),
               rough = commanded([](int i) { return 0.2 * std::sin(1.7 * i * i); });
  CHECK(loop_of(model, {ramp, ramp, stairs}) == LoopKind::open);
  CHECK(loop_of(model, {ramp, stairs, stairs}) == LoopKind::open);
  CHECK(loop_of(model, {rough, stairs, rough}) == LoopKind::closed_found);
}

TEST_CASE("a flywheel cannot win: the effort that it would need is not there") {
  closed_loop::Joint joint;
  joint.extra.coulomb = 0.02;
  Model model = model_of(joint);
  model.axis->inertia_kgm2 *= 10.0;
  const std::vector<Inputs> train = {prepare(model,
                                             recording_of(closed_loop::follow(joint, 0.005, 2000, 7)))},
                            held_out = {
                                prepare(model, recording_of(closed_loop::follow(joint, 0.005, 1500, 8)))};
  EffortProblem problem(model, standard_catalogue(), train, held_out);
  const InverseScore& told = problem.score({standard_catalogue().find("coulomb_friction")});
  const auto inertia = std::find_if(
      told.constants.begin(), told.constants.end(),
      [&](const InverseConstant& one) { return model.calibrated()[one.constant].id == "inertia"; });
  REQUIRE(inertia != told.constants.end());
  CHECK(inertia->moved_by == Approx(0.1).epsilon(0.1));
  CHECK(told.parameters.front().value == Approx(0.02).epsilon(0.1));
  // The interval is an honest one.
  CHECK(std::fabs(told.parameters.front().value - 0.02) <
        4.0 * told.parameters.front().standard_error + 0.0005);
}
