// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The inverse problem of an axis: the effort that a motion needs is worked out by hand here.

#include "../../catch.hpp"

#include <thermopower/gap/compare/effort_lead.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/gap/propose/effort_problem.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using thermopower::plant::standard_catalogue;

namespace {

/// An axis that moves as it is told to, and the current that this takes.
struct Motion {
  double dt_s = 0.005;
  double inertia_kgm2 = 0.02, viscous_Nms_per_rad = 0.05, torque_constant_Nm_per_A = 0.5;
  double late_s = 0.0;    ///< from current to torque
  double noise_A = 0.01;  ///< of the current
  std::function<double(double angle_rad, double rate_rad_per_s)> extra_Nm = [](double, double) {
    return 0.0;
  };

  Recording recording(int rows, double phase) const {
    std::uint64_t state = 88172645463325252u + static_cast<std::uint64_t>(1000.0 * phase);
    const auto noise = [&] {
      double sum = 0.0;
      for (int k = 0; k < 12; ++k) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        sum += static_cast<double>(state >> 11) / 9007199254740992.0;
      }
      return sum - 6.0;
    };
    Recording one;
    one.name = "axis";
    one.t_s.resize(rows);
    Eigen::VectorXd drive(rows), angle(rows), rate(rows);
    constexpr double deg = 57.29577951308232;
    for (int i = 0; i < rows; ++i) {
      const double t = dt_s * i;
      one.t_s[i] = t;
      angle[i] = deg * angle_at(t, phase);
      rate[i] = deg * slope(t, phase);
      // Held from its row on: what the middle of the interval needs, the delay later.
      const double at = t + 0.5 * dt_s + late_s, h = 1e-4;
      const double acceleration = (slope(at + h, phase) - slope(at - h, phase)) / (2.0 * h);
      const double torque = inertia_kgm2 * acceleration + viscous_Nms_per_rad * slope(at, phase) +
                            extra_Nm(angle_at(at, phase), slope(at, phase));
      drive[i] = torque / torque_constant_Nm_per_A + noise_A * noise();
    }
    one.set("drive_A", drive);
    one.set("angle_deg", angle);
    one.set("rate_dps", rate);
    return one;
  }

  static double angle_at(double t, double phase) {
    return 2.0 * std::sin(1.7 * t + phase) + 0.7 * std::sin(4.1 * t) + 0.25 * std::sin(9.3 * t + 2.0 * phase);
  }
  static double slope(double t, double phase) {
    return 3.4 * std::cos(1.7 * t + phase) + 2.87 * std::cos(4.1 * t) +
           2.325 * std::cos(9.3 * t + 2.0 * phase);
  }
};

Model model_of(const Motion& motion) {
  Model model;
  model.name = "axis";
  model.axis =
      RigidAxisModel{motion.inertia_kgm2, motion.viscous_Nms_per_rad, motion.torque_constant_Nm_per_A};
  return model;
}

/// The problem with what it refers to.
struct Posed {
  Model model;
  std::vector<Inputs> train, held_out;
  EffortProblem problem;

  Posed(Model simulated, const Motion& motion)
      : model(std::move(simulated)),
        train({prepare(model, motion.recording(2400, 0.3))}),
        held_out({prepare(model, motion.recording(1600, 1.9))}),
        problem(model, standard_catalogue(), train, held_out) {}

  const InverseScore& score(std::initializer_list<const char*> ids) {
    std::vector<const CatalogueEntry*> set;
    for (const char* id : ids) set.push_back(standard_catalogue().find(id));
    return problem.score(set);
  }
  EffortLead lead() {
    FitProblem fit;
    fit.model = &model;
    fit.catalogue = &standard_catalogue();
    return EffortLead(problem, fit);
  }
  std::string told() {
    std::string ids;
    for (const auto* effect : problem.told().effects) ids += (ids.empty() ? "" : " + ") + effect->info.id;
    return ids;
  }
};

double value(const InverseScore& score, const std::string& parameter) {
  for (const InverseEstimate& one : score.parameters)
    if (one.effect->info.parameters[one.parameter].name == parameter) return one.value;
  return std::nan("");
}

/// Mean log density of a block of held-out effort over "nothing missing", nats.
double gain(const InverseScore& score) {
  double sum = 0.0;
  for (const double one : score.block_gain) sum += one;
  return sum / static_cast<double>(score.block_gain.size());
}

}  // namespace

TEST_CASE("a sound axis needs the effort that was recorded, and nothing is told") {
  const Motion motion;
  Posed posed(model_of(motion), motion);
  REQUIRE(posed.problem.is_judged());
  CHECK(posed.problem.score({}).share < 0.02);
  CHECK(posed.told().empty());
}

TEST_CASE("dry friction is told with its size, whatever the inertia in the file") {
  Motion motion;
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? 0.08 : -0.08; };
  for (const double factor : {1.0, 12.0, 0.2, 27000.0}) {
    CAPTURE(factor);
    Model model = model_of(motion);
    model.axis->inertia_kgm2 *= factor;
    Posed posed(model, motion);
    CHECK(posed.told() == "coulomb_friction");
    CHECK(value(posed.score({"coulomb_friction"}), "Nm") == Approx(0.08).epsilon(0.05));
  }
}

TEST_CASE("an inertia that the effort does not hold stays where a part of the effort would still show it") {
  Motion motion;
  motion.inertia_kgm2 = 1e-9;  // a wrist behind a torque sensor
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? 0.08 : -0.08; };
  Model model = model_of(motion);
  model.axis->inertia_kgm2 = 0.002;
  Posed posed(model, motion);
  const InverseScore told = posed.score({"coulomb_friction"});
  double inertia_kgm2 = 0.0;
  for (const InverseConstant& one : told.constants)
    if (model.calibrated()[one.constant].id == "inertia") inertia_kgm2 = 0.002 * one.moved_by;
  // The motion's acceleration is some tens of rad/s2, and friction and drag are some 0.2 N m.
  CHECK(inertia_kgm2 > 1e-5);
  CHECK(inertia_kgm2 < 1e-3);
  CHECK(value(told, "Nm") == Approx(0.08).epsilon(0.1));
}

TEST_CASE("a friction that would drive the motion is refused") {
  Motion motion;
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? -0.03 : 0.03; };
  Posed posed(model_of(motion), motion);
  CHECK(posed.score({"coulomb_friction"}).refusal == InverseRefusal::not_itself);
}

TEST_CASE("cogging is told with its cycles, and a delay in seconds") {
  Motion motion;
  SECTION("cogging") {
    motion.extra_Nm = [](double angle, double) { return 0.06 * std::sin(14.0 * angle + 0.4); };
    Posed posed(model_of(motion), motion);
    CHECK(posed.told() == "cogging");
    CHECK(value(posed.score({"cogging"}), "cycles_per_turn") == Approx(14.0).epsilon(0.01));
  }
  SECTION("a delay of three rows and a half") {
    motion.late_s = 0.0175;
    Posed posed(model_of(motion), motion);
    CHECK(posed.told() == "actuation_delay");
    CHECK(value(posed.score({"actuation_delay"}), "s") == Approx(0.0175).epsilon(0.05));
  }
}

TEST_CASE("what a motion does not tell is not scored") {
  const Motion motion;
  Posed posed(model_of(motion), motion);
  CHECK(posed.score({"backlash"}).refusal == InverseRefusal::not_told);
  CHECK(posed.score({"compliance"}).refusal == InverseRefusal::not_told);
  CHECK(posed.score({"torque_fade"}).refusal == InverseRefusal::not_told);
  CHECK(posed.score({"rate_bias"}).refusal == InverseRefusal::not_told);
}

TEST_CASE("a drive that is switched off explains nothing") {
  Motion motion;
  motion.noise_A = 0.2;
  Posed posed(model_of(motion), motion);
  const InverseScore& saturated = posed.score({"torque_saturation"});
  CHECK((saturated.refusal != InverseRefusal::none || !(gain(saturated) > 0.0)));
}

TEST_CASE("a true cause does not lose, and one that is not there gains nothing") {
  Motion motion;
  motion.extra_Nm = [](double angle, double rate) {
    return (rate > 0.0 ? 0.05 : -0.05) + 0.1 * std::sin(angle + 0.5);
  };
  Posed posed(model_of(motion), motion);
  CHECK(gain(posed.score({"coulomb_friction"})) > 0.0);
  CHECK(gain(posed.score({"imbalance"})) > 0.0);
  const InverseScore& both = posed.score({"coulomb_friction", "imbalance"});
  CHECK(both.share < 0.03);
  CHECK(gain(both) > gain(posed.score({"coulomb_friction"})));
  CHECK(gain(posed.score({"coulomb_friction", "imbalance", "cable_spring"})) < gain(both) + 1.0);
}

TEST_CASE(
    "more parameters than a scalar carries are fitted as well: friction is told beside eight other causes") {
  Motion motion;
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? 0.08 : -0.08; };
  Posed posed(model_of(motion), motion);
  const InverseScore few = posed.score({"coulomb_friction"});
  const InverseScore many =
      posed.score({"coulomb_friction", "asymmetric_viscous", "constant_torque", "imbalance", "cable_spring",
                   "quadratic_drag", "load_friction", "cogging", "torque_ripple"});
  std::size_t free = many.constants.size();
  for (const InverseEstimate& one : many.parameters) free += one.fitted ? 1 : 0;
  REQUIRE(many.refusal != InverseRefusal::not_told);
  CHECK(free >= 16);
  CHECK(many.share < 1.1 * few.share);
}

TEST_CASE("what makes the motion far worse is not the answer, however well it needs the effort") {
  Motion motion;
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? 0.08 : -0.08; };
  Posed posed(model_of(motion), motion);
  EffortLead lead = posed.lead();
  REQUIRE(lead.is_told());
  const auto chosen = [&] {
    return lead.candidates()[lead.answer(posed.problem.told()).chosen].explanation.ids(posed.model);
  };
  CHECK(chosen() == std::vector<std::string>{"coulomb_friction"});
  Eigen::VectorXd nats = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(lead.candidates().size()));
  for (std::size_t i = 0; i < lead.candidates().size(); ++i)
    if (lead.candidates()[i].explanation.ids(posed.model) == std::vector<std::string>{"coulomb_friction"})
      nats[static_cast<Eigen::Index>(i)] = 1e4;
  lead.weigh_with(nats);
  CHECK(chosen() != std::vector<std::string>{"coulomb_friction"});
  double sum = 0.0;
  for (const Candidate& one : lead.candidates()) sum += one.probability;
  CHECK(sum == Approx(1.0));
}

TEST_CASE("where a dead band does what dry friction does, the friction is the likelier one") {
  Motion motion;
  motion.inertia_kgm2 = 1e-6;  // effort and motion have one sign, and so the two are the same
  motion.extra_Nm = [](double, double rate) { return rate > 0.0 ? 0.08 : -0.08; };
  Posed posed(model_of(motion), motion);
  EffortLead lead = posed.lead();
  const auto probability = [&](const char* id) {
    for (const Candidate& one : lead.candidates())
      if (one.explanation.ids(posed.model) == std::vector<std::string>{id}) return one.probability;
    return 0.0;
  };
  CHECK(probability("coulomb_friction") > probability("drive_deadband"));
}
