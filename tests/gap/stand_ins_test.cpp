// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/compare/covariance.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/report/parts.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

/// @file
/// Causes that stand in for one that the catalogue lacks: what gives them away.

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
namespace plant = thermopower::plant;

namespace {

SignalSums level(double mean_square) {
  SignalSums sums;
  sums.set(3, std::vector<double>(2400, std::sqrt(mean_square)), 1.0);
  return sums;
}

/// Effects whose fit leaves a mean square, the constants as the model has them, every size known to a thousandth.
Candidate candidate(const Model& model, const std::vector<const char*>& ids, double mean_square) {
  Candidate one;
  for (const char* id : ids) one.explanation.effects.push_back(standard_catalogue().find(id));
  one.list = coordinates(model, one.explanation, standard_catalogue());
  const auto count = static_cast<Eigen::Index>(one.list.size());
  one.fit.point = Eigen::VectorXd::Zero(count);
  for (auto i = static_cast<Eigen::Index>(model.calibrated().size()); i < count; ++i) one.fit.point[i] = 1.0;
  one.fit.information = Eigen::MatrixXd::Identity(count, count) * 1e6;
  one.fit.at_bound.assign(one.list.size(), false);
  one.train = one.held_out = level(mean_square);
  one.probability = ids.empty() ? 0.0 : 1.0;
  return one;
}

Eigen::Index place_of(const Candidate& candidate, const char* id, const char* parameter) {
  return static_cast<Eigen::Index>(candidate.place_of(*standard_catalogue().find(id), parameter));
}

/// A motor under power steps whose iron warms with the magnitude of the rate, which steps between the given ones.
Recording hysteresis(const std::vector<double>& rates_dps, std::uint64_t seed) {
  constexpr int rows = 1500;
  constexpr double W_per_rad_per_s = 0.15, pi = 3.141592653589793;
  test::Noise noise(seed);
  Recording r;
  r.name = "turning motor";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows), supply(rows), rate(rows);
  double motor_C = 24.0;
  for (int i = 0; i < rows; ++i) {
    const double phase = static_cast<double>(seed) + 1.7 * (i / 75);
    r.t_s[i] = 2.0 * i;
    power[i] = (i / 75) % 4 == 3 ? 0.0 : 25.0 * std::floor(5.2 + 5.0 * std::sin(phase));
    rate[i] = rates_dps[static_cast<std::size_t>((i / 40 * 7 + 3) % static_cast<int>(rates_dps.size()))];
    supply[i] = 12.0;
    ambient[i] = 23.0;
    const double v = 12.0 * std::sqrt(power[i] / 255.0);
    const auto ohm = [&] { return 8.0 * (1.0 + 0.00393 * (motor_C - 25.0)); };
    current[i] = v / ohm() + 0.003 * noise();
    motor[i] = motor_C + 0.1 * noise();
    for (int k = 0; k < 50; ++k)
      motor_C +=
          0.04 *
          (v * v / ohm() + W_per_rad_per_s * std::abs(rate[i]) * pi / 180.0 - 0.15 * (motor_C - 23.0)) / 60.0;
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  r.set("supply_V", supply);
  r.set("rate_dps", rate);
  return r;
}

}  // namespace

TEST_CASE(
    "what fits the rates it was fitted to, and fails at others, gives way to a cause that takes long to try") {
  // Over rates of about one magnitude, heat that goes with the rate goes with its square, too.
  const Diagnosis diagnosis =
      diagnose(test::bench_model(), {hysteresis({0.0, 190.0, -230.0, 260.0, -290.0}, 1)},
               {hysteresis({0.0, 80.0, -400.0}, 2)});
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "iron_loss");
}

TEST_CASE("a set of causes is not named where one of them may as well not be there") {
  // Friction that differs by direction and a constant torque do the same to an axis in motion: of f+ - f- + 2 c alone the data
  // tell something.
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0),
                             candidate(model, {"asymmetric_friction", "constant_torque"}, 1.1)};
  Candidate& set = all[1];
  const Eigen::Index sizes[] = {place_of(set, "asymmetric_friction", "forward_Nm"),
                                place_of(set, "asymmetric_friction", "backward_Nm"),
                                place_of(set, "constant_torque", "Nm")};
  Eigen::VectorXd told = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(set.list.size()));
  told[sizes[0]] = 1.0;
  told[sizes[1]] = -1.0;
  told[sizes[2]] = 2.0;
  Eigen::MatrixXd& information = set.fit.information;
  for (const Eigen::Index one : sizes) information(one, one) = 0.01;  // to 10 N m, where the sizes are 1 N m
  information += 1e6 * told * told.transpose();
  mark_doubtful(all, model, Weight());
  CHECK(set.doubtful);
  CHECK_FALSE(in_the_running(set));
  // With each told by itself the set is one.
  set.fit.information = 1e6 * Eigen::MatrixXd::Identity(information.rows(), information.cols());
  mark_doubtful(all, model, Weight());
  CHECK_FALSE(set.doubtful);
  CHECK(in_the_running(set));
}

TEST_CASE("a cause of which the data leave a size open is not named, however well it fits") {
  // The hidden start of a second mass moves a held-out run, too. That is nothing that the cause does.
  const Model model = test::bench_model();
  std::vector<Candidate> all{candidate(model, {}, 1.0), candidate(model, {"second_thermal_mass"}, 1.0)};
  all[0].held_out = level(40.0);
  all[1].fit.information =
      Eigen::MatrixXd::Identity(all[1].fit.information.rows(), all[1].fit.information.cols());
  Eigen::MatrixXd& information = all[1].fit.information;
  const Eigen::Index share = place_of(all[1], "second_thermal_mass", "winding_share");
  information *= 1e6;
  mark_doubtful(all, model, Weight());
  CHECK(in_the_running(all[1]));
  information(share, share) = 1e-9;
  mark_doubtful(all, model, Weight());
  CHECK(all[1].open);
  all[0].train = level(40.0);  // its fit imitates something else, then
  mark_doubtful(all, model, Weight());
  CHECK(all[1].open);
  CHECK_FALSE(in_the_running(all[1]));
}

TEST_CASE("a cause whose size is told stays one, whatever the data leave open of a length or a time of it") {
  // A static friction above the kinetic one: how slow the motion must be for it, rows at speed do not say.
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"stribeck_friction"}, 1.1)};
  all[1].fit.information =
      1e6 * Eigen::MatrixXd::Identity(all[1].fit.information.rows(), all[1].fit.information.cols());
  const Eigen::Index knee = place_of(all[1], "stribeck_friction", "knee_rad_per_s");
  all[1].fit.information(knee, knee) = 1e-9;
  mark_doubtful(all, model, Weight());
  CHECK(in_the_running(all[1]));
}

TEST_CASE("a set is not named one of whose causes is no more than a constant that moved") {
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0),
                             candidate(model, {"coulomb_friction", "asymmetric_viscous"}, 1.1)};
  mark_doubtful(all, model, Weight());
  CHECK(all[1].doubtful);  // a drag that is the same forwards and backwards is the model's viscous friction
  all[1].fit.point[all[1].fit.point.size() - 1] = 2.0;
  mark_doubtful(all, model, Weight());
  CHECK_FALSE(all[1].doubtful);
}

TEST_CASE(
    "friction that is alike in both directions is dry friction, whatever its transition does elsewhere") {
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"coulomb_friction"}, 4.0),
                             candidate(model, {"asymmetric_friction"}, 4.0)};
  all[1].held_out =
      level(40.0);  // the same equation, with a transition that the training motion does not tell
  weigh(all, Weight(), model);
  CHECK(all[2].idle);
  CHECK(all[1].probability > 0.9);
  // What does not fit the training data either is another matter: that fit has failed.
  all[1].train = level(8.0);
  weigh(all, Weight(), model);
  CHECK_FALSE(all[2].idle);
  // Nor is it where the directions differ.
  all[1].train = level(4.0);
  all[2].fit.point[place_of(all[2], "asymmetric_friction", "forward_Nm")] = 1.2;
  weigh(all, Weight(), model);
  CHECK_FALSE(all[2].idle);
}

TEST_CASE(
    "friction that varies over the turn is placed in the friction, and no constant friction explains all of it") {
  test::AxisFault bent;
  bent.coulomb_Nm = 0.004;
  bent.run_out_share = 0.9;
  const Diagnosis diagnosis = diagnose(test::axis_model(), {test::axis_recording(bent, 4000, 3)},
                                       {test::axis_recording(bent, 2000, 8)});
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict != Verdict::explained);
  CHECK(diagnosis.verdict != Verdict::no_gap);
  REQUIRE_FALSE(diagnosis.where.empty());
  CHECK(diagnosis.where.front().submodel == plant::SubmodelName(Submodel::mechanical_friction));
  // The same friction all round is.
  bent.run_out_share = 0.0;
  const Diagnosis even = diagnose(test::axis_model(), {test::axis_recording(bent, 4000, 3)},
                                  {test::axis_recording(bent, 2000, 8)});
  REQUIRE(even.cause.size() == 1);
  CHECK(even.cause.front().effect == "coulomb_friction");
}

TEST_CASE("causes are named beside a third one, though the viscous friction was fitted without the dry one") {
  test::AxisFault joint;
  joint.spring_Nm_per_rad = 0.02;
  joint.coulomb_Nm = 0.004;
  joint.ripple_share = 0.15;
  Model model = test::axis_model();
  model.axis->viscous_Nms_per_rad *= 8.0;
  const std::vector<Recording> train{test::axis_recording(joint, 4000, 1)},
      held_out{test::axis_recording(joint, 4000, 2)};
  Options in_pairs;
  in_pairs.effects_at_once = 2;
  const Diagnosis diagnosis = diagnose(model, train, held_out, in_pairs);
  INFO(diagnosis.reason);
  // A pair alone leaves the ripple, and another pair may leave about as much of it.
  CHECK((diagnosis.verdict == Verdict::partial || diagnosis.verdict == Verdict::ambiguous));
  CHECK(test::causes_in_order(diagnosis) == std::vector<std::string>{"cable_spring", "coulomb_friction"});
  CHECK(test::parameter_of(diagnosis, "Nm_per_rad") == Approx(0.02).epsilon(0.1));
  const auto moved = std::find_if(diagnosis.constants.begin(), diagnosis.constants.end(),
                                  [](const ConstantEstimate& one) { return one.name == "viscous"; });
  REQUIRE(moved != diagnosis.constants.end());
  CHECK(moved->fitted < 2e-3);  // 1e-3 in truth
  const Diagnosis all = diagnose(model, train, held_out);
  INFO(all.reason);
  CHECK(all.verdict == Verdict::explained);
  CHECK(test::causes_of(all) ==
        std::vector<std::string>{"cable_spring", "coulomb_friction", "torque_ripple"});
}

TEST_CASE(
    "friction in a motion one way is weighed beside what looks like it, whichever curves follow it as well") {
  // A drum that never turns back, with 4 mN m of dry friction: a constant torque does the same.
  constexpr double step_s = 1e-3, inertia_kgm2 = 2e-3, viscous_Nms_per_rad = 2e-3, friction_Nm = 4e-3,
                   Nm_per_A = 0.1;
  constexpr double deg_per_rad = 57.29577951308232;
  Model drum;
  drum.axis = plant::RigidAxisModel{inertia_kgm2, viscous_Nms_per_rad, Nm_per_A};
  const auto recorded = [&](std::uint64_t seed) {
    constexpr int rows = 600;
    test::Noise noise(seed);
    Recording r;
    r.name = "drum";
    r.t_s.resize(rows);
    Eigen::VectorXd drive(rows), angle(rows), rate(rows);
    double turned_rad = 0.0, omega = 20.0;
    for (int i = 0; i < rows; ++i) {
      r.t_s[i] = 10.0 * step_s * i;
      drive[i] = 0.4 + (std::sin(2.0 * r.t_s[i]) < 0.0 ? -0.2 : 0.2);
      angle[i] = deg_per_rad * turned_rad + 0.02 * noise();
      rate[i] = deg_per_rad * omega + 0.2 * noise();
      for (int k = 0; k < 10; ++k) {
        omega += step_s * (Nm_per_A * drive[i] - viscous_Nms_per_rad * omega - friction_Nm) / inertia_kgm2;
        turned_rad += step_s * omega;
      }
    }
    r.set("drive_A", drive);
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    return r;
  };
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    const Diagnosis found = diagnose(drum, {recorded(seed)}, {recorded(seed + 100)});
    CAPTURE(seed);
    double friction = 0.0;
    for (const RankedExplanation& one : found.ranking)
      if (one.effects == std::vector<std::string>{"coulomb_friction"}) friction = one.probability;
    CHECK(friction > 0.01);
  }
}
