// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "plants.hpp"

#include <thermopower/gap/decide/covariance.hpp>
#include <thermopower/gap/decide/verdict.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/report/opposites.hpp>
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

Conclusion concluded(const std::vector<Candidate>& candidates, double recalibrated,
                     const Witness& rows = {}) {
  return conclude(candidates, {level(900.0), level(recalibrated)}, Weight(), Options(), test::axis_model(),
                  rows);
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

TEST_CASE("a constant that moves far only beside a cause and a rest gives the cause away as a stand-in") {
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"drive_deadband"}, 50.0)};
  CHECK(concluded(all, 850.0).verdict == Verdict::partial);
  const auto moved = [&](const char* constant, double by) {
    all[1].fit.point.head(static_cast<Eigen::Index>(model.calibrated().size())).setZero();
    for (std::size_t i = 0; i < model.calibrated().size(); ++i)
      if (model.calibrated()[i].id == constant) all[1].fit.point[static_cast<Eigen::Index>(i)] = std::log(by);
  };
  moved("torque_constant", 2.2);  // what a fit without the cause was bent by, and is put right
  CHECK(concluded(all, 850.0).verdict == Verdict::partial);
  moved("torque_constant", 3.0);
  CHECK(concluded(all, 850.0).reason == bends_a_constant);
  // An inertia is told by each acceleration, whatever a joint loses.
  moved("inertia", 1.0 / 1.8);
  CHECK(concluded(all, 850.0).verdict == Verdict::partial);
  moved("inertia", 1.0 / 2.2);
  const Conclusion stood_in = concluded(all, 850.0);
  CHECK(stood_in.verdict == Verdict::unexplained);
  CHECK(stood_in.reason == bends_a_constant);
  // A constant that is that far off takes most of the gap away by itself.
  CHECK(concluded(all, 150.0).verdict == Verdict::partial);
  // What takes nearly all of the gap is no stand-in: the constant was fitted without it.
  all[1].train = all[1].held_out = level(30.0);
  CHECK(concluded(all, 850.0).verdict == Verdict::partial);
  // Nothing above the noise is left: the constant was that far off, and the cause explains the rest.
  all[1].train = all[1].held_out = level(1.1);
  CHECK(concluded(all, 850.0).verdict == Verdict::explained);
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
    "a cause that leaves a rest of what began in the middle of runs stands in for what happened there") {
  const Model model = test::axis_model();
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"coulomb_friction"}, 50.0)};
  Witness rows;
  rows.where.push_back({Signal::rate_dps, plant::SubmodelName(Submodel::mechanical_friction), 0.9, {}, ""});
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  rows.where.back().only_in = {{"train", "", false, 12.0}, {"heldout", "", true, 7.0}};
  CHECK(concluded(all, 850.0, rows).reason == was_not_there_before);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::unexplained);
  // It began in one recording, and shows throughout the other one, which asks more of it.
  rows.where.back().only_in = {{"train", "", false, 12.0}, {"heldout", "", true, {}}};
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  // What brings everything to the noise needs no such witness: a bias that drifts shows late.
  rows.where.back().only_in = {{"train", "", false, 12.0}, {"heldout", "", true, 7.0}};
  all[1].train = all[1].held_out = level(1.1);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::explained);
}

TEST_CASE("a cause of a joint that leaves a rest acts in a place that the rows find at fault") {
  const Model model = test::axis_model();
  const plant::SubmodelName friction(Submodel::mechanical_friction), drive(Submodel::mechanical_drive);
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"coulomb_friction"}, 50.0)};
  Witness rows;
  rows.where = {{Signal::rate_dps, drive, 0.9, {}, ""}, {Signal::rate_dps, friction, 0.02, {}, ""}};
  CHECK(concluded(all, 850.0, rows).reason == acts_where_nothing_is_wrong);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::unexplained);
  rows.where.back().share = 0.3;
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  // One of two causes is enough; of a state that nobody measures, and of readings that are bent, balances say little.
  rows.where.back().share = 0.02;
  for (const char* beside : {"presliding_friction", "rate_bias"}) {
    all[1] = candidate(model, {beside}, 50.0);
    CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  }
  // Where they blame nothing of the joint, nobody knows.
  all[1] = candidate(model, {"coulomb_friction"}, 50.0);
  rows.where = {{Signal::angle_deg, plant::SubmodelName(Submodel::sensing_angle), 0.9, {}, ""}};
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  // And what brings everything to the noise needs no such witness.
  rows.where = {{Signal::rate_dps, drive, 0.9, {}, ""}};
  all[1].train = all[1].held_out = level(1.1);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::explained);
}

TEST_CASE("a cause that leaves a good part of the gap in the place that it should mend is a stand-in") {
  const Model model = test::axis_model();
  const plant::SubmodelName friction(Submodel::mechanical_friction), drive(Submodel::mechanical_drive);
  std::vector<Candidate> all{candidate(model, {}, 850.0), candidate(model, {"coulomb_friction"}, 150.0)};
  Witness rows;
  rows.where.push_back({Signal::rate_dps, friction, 0.9, {}, ""});
  std::vector<Location> left;
  rows.blamed_beside = [&](const Candidate&) { return left; };
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  left.push_back({Signal::rate_dps, drive, 0.8, {}, ""});  // something else acts, too
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  left.back().submodel = friction;
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::unexplained);
  left.back().share = 0.0;  // no freedom there helps: the place is a guess
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  left.back().share = 0.8;
  // Another signal has a fault of its own that no cause mends: what is left may be that one's.
  rows.where.push_back({Signal::angle_deg, Submodel::sensing_angle, 0.7, {}, ""});
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  rows.where.back().share = 0.0;  // a trace
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::unexplained);
  // A law of friction that is a little wrong leaves a little in its place.
  all[1].train = all[1].held_out = level(40.0);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  // What acts elsewhere and leaves the fault where it was mends nothing of it.
  all[1] = candidate(model, {"torque_ripple"}, 150.0);
  CHECK(concluded(all, 850.0, rows).reason == does_not_mend_its_place);
  left.back().submodel = Submodel::mechanical_load;  // but the drive was never at fault
  CHECK(concluded(all, 850.0, rows).reason == acts_where_nothing_is_wrong);
  // Of a state that nobody measures the rows know nothing; an instrument bends what they say.
  left.back().submodel = friction;
  all[1] = candidate(model, {"presliding_friction"}, 150.0);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
  all[1] = candidate(model, {"compliance"},
                     150.0);  // but acts elsewhere than where they find the fault, before and after
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::unexplained);
  all[1] = candidate(model, {"rate_bias"}, 150.0);
  CHECK(concluded(all, 850.0, rows).verdict == Verdict::partial);
}

TEST_CASE(
    "two causes of which each is larger than what is seen are a difference that stands for something else") {
  test::AxisFault fault;
  fault.spring_Nm_per_rad = 0.01;
  fault.coulomb_Nm = 0.004;
  const Recording recording = test::axis_recording(fault, 1500, 3);
  const Model model = test::axis_model();
  const std::vector<Inputs> inputs{prepare(model, recording)};
  const std::vector<Segment> segments = cut(inputs, 0.5, plant_of(model));
  Model with = model;
  with.effects["cable_spring"] = {{"Nm_per_rad", 0.01}, {"centre_rad", 0.0}};
  with.effects["coulomb_friction"] = {{"Nm", 0.004}};
  CHECK_FALSE(are_opposites(with, {"cable_spring", "coulomb_friction"}, segments, standard_catalogue()));
  // The same stiffness as the difference of a spring and a load that falls over.
  with.effects = {{"cable_spring", {{"Nm_per_rad", 0.11}, {"centre_rad", 0.0}}},
                  {"imbalance", {{"Nm", 0.1}, {"phase_rad", 3.141592653589793}}}};
  CHECK(are_opposites(with, {"cable_spring", "imbalance"}, segments, standard_catalogue()));
  CHECK_FALSE(are_opposites(with, {"cable_spring"}, segments, standard_catalogue()));
}

TEST_CASE("friction that varies over the turn is no friction of one size, and is not called one") {
  test::AxisFault bent;
  bent.coulomb_Nm = 0.004;
  bent.run_out_share = 0.9;
  const Diagnosis diagnosis = diagnose(test::axis_model(), {test::axis_recording(bent, 4000, 3)},
                                       {test::axis_recording(bent, 2000, 8)});
  INFO(diagnosis.reason);
  CHECK(diagnosis.verdict == Verdict::unexplained);
  CHECK(diagnosis.cause.empty());
  REQUIRE_FALSE(diagnosis.where.empty());
  CHECK(diagnosis.where.front().submodel == plant::SubmodelName(Submodel::mechanical_friction));
  CHECK(diagnosis.where.front().has_own_course);
  // The same friction all round is.
  bent.run_out_share = 0.0;
  const Diagnosis even = diagnose(test::axis_model(), {test::axis_recording(bent, 4000, 3)},
                                  {test::axis_recording(bent, 2000, 8)});
  REQUIRE(even.cause.size() == 1);
  CHECK(even.cause.front().effect == "coulomb_friction");
  CHECK_FALSE(even.where.front().has_own_course);
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
  CHECK(diagnosis.verdict == Verdict::partial);
  CHECK(test::causes_in_order(diagnosis) == std::vector<std::string>{"cable_spring", "coulomb_friction"});
  CHECK(test::parameter_of(diagnosis, "Nm_per_rad") == Approx(0.02).epsilon(0.1));
  const auto moved = std::find_if(diagnosis.constants.begin(), diagnosis.constants.end(),
                                  [](const MovedConstant& one) { return one.name == "viscous"; });
  REQUIRE(moved != diagnosis.constants.end());
  CHECK(moved->fitted < 2e-3);  // 1e-3 in truth
  const Diagnosis all = diagnose(model, train, held_out);
  INFO(all.reason);
  CHECK(all.verdict == Verdict::explained);
  CHECK(test::causes_in_order(all) ==
        std::vector<std::string>{"cable_spring", "coulomb_friction", "torque_ripple"});
}
