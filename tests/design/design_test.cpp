// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "../gap/plants.hpp"

#include <thermopower/design/design.hpp>
#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <string>

// A drum with dry friction that the model does not have. In the first recording it turns one way only, and there a constant torque
// looks the same. The drum is stepped here, apart from the library's equations.

using namespace thermopower::gap;
using namespace thermopower::design;

namespace {

constexpr double row_s = 0.01;

Recording play(const Eigen::VectorXd& drive_A, double friction_Nm, double constant_Nm, std::uint64_t seed) {
  test::Noise noise(seed);
  Recording r;
  r.name = "drum" + std::to_string(seed);
  const Eigen::Index rows = drive_A.size();
  r.t_s.resize(rows);
  Eigen::VectorXd angle(rows), rate(rows);
  constexpr double inertia = 1.02e-3, viscous = 0.98e-3, torque_constant = 0.1, deg = 57.29577951308232;
  constexpr int steps = 100;
  double theta = 0.0, omega = 0.0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    r.t_s[row] = static_cast<double>(row) * row_s;
    angle[row] = theta * deg + 0.02 * noise();
    rate[row] = omega * deg + 0.2 * noise();
    for (int i = 0; i < steps; ++i) {
      const double h = row_s / steps,
                   next =
                       omega + h * (torque_constant * drive_A[row] + constant_Nm - viscous * omega) / inertia,
                   brake = h * friction_Nm / inertia;
      omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      theta += h * omega;
    }
  }
  r.set("drive_A", drive_A);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

Model drum() {
  Model model;
  model.name = "drum";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.1};
  return model;
}

Eigen::VectorXd one_way() {
  Eigen::VectorXd drive(2000);
  for (Eigen::Index row = 0; row < drive.size(); ++row)
    drive[row] = 0.45 + 0.25 * std::sin(0.011 * static_cast<double>(row)) + (row / 230 % 2 == 0 ? 0.1 : -0.1);
  return drive;
}

Limits limits() {
  Limits limits;
  limits.duration_s = 10.0;
  limits.row_s = row_s;
  limits.vary = {{"drive_A", -0.6, 0.6}};
  limits.rate_dps = {-3000.0, 3000.0};
  return limits;
}

bool names(const std::vector<Cause>& causes, const std::string& id) {
  return std::any_of(causes.begin(), causes.end(), [&](const Cause& one) { return one.effect == id; });
}

}  // namespace

TEST_CASE("What one recording leaves open the next experiment decides, whichever cause is true") {
  for (const bool rubs : {true, false}) {
    const double friction_Nm = rubs ? 0.012 : 0.0, constant_Nm = rubs ? 0.0 : -0.012;
    const std::string truth = rubs ? "coulomb_friction" : "constant_torque";
    const Recording first = play(one_way(), friction_Nm, constant_Nm, 1);
    const Diagnosis before = diagnose(drum(), {first});
    const Design next = design_experiment(gap_of(drum(), before), limits());
    INFO(next.sentence);
    REQUIRE(next.ending == Ending::schedule);
    CHECK(next.schedule.column("drive_A").minCoeff() <= 0.0);  // rest or a reversal tells
    CHECK(next.classes.size() > 1);
    // The limits hold for the real drum.
    const Recording second = play(next.schedule.column("drive_A"), friction_Nm, constant_Nm, 2);
    CHECK(second.column("rate_dps").cwiseAbs().maxCoeff() <= 3000.0);
    const Diagnosis after = diagnose(drum(), {first, second});
    CHECK(names(after.cause, truth));
  }
}

TEST_CASE(
    "Where the drum must turn one way, no experiment decides, and the design says which limit would help") {
  const Recording first = play(one_way(), 0.012, 0.0, 1);
  const DiagnosedGap gap = gap_of(drum(), diagnose(drum(), {first}));
  Limits tight = limits();
  tight.vary = {{"drive_A", 0.3, 0.6}};
  const Design next = design_experiment(gap, tight);
  INFO(next.sentence);
  CHECK(next.ending == Ending::cannot_decide);
  CHECK(next.schedule.rows() == 0);
  CHECK(next.limit_to_raise == "vary.drive_A.from");
  CHECK_THAT(next.sentence, ContainsSubstring("lower the limit of vary.drive_A.from to"));
}

TEST_CASE("The same seed gives the same design") {
  const Recording first = play(one_way(), 0.012, 0.0, 1);
  const DiagnosedGap gap = gap_of(drum(), diagnose(drum(), {first}));
  DesignOptions options;
  options.rows = 3e5;
  const Design one = design_experiment(gap, limits(), options),
               other = design_experiment(gap, limits(), options);
  CHECK(one.sentence == other.sentence);
  REQUIRE(one.schedule.rows() == other.schedule.rows());
  CHECK(one.schedule.column("drive_A") == other.schedule.column("drive_A"));
}

TEST_CASE("A limit holds for every explanation that is drawn from what the recordings leave possible") {
  const Recording first = play(one_way(), 0.012, 0.0, 1);
  const DiagnosedGap gap = gap_of(drum(), diagnose(drum(), {first}));
  Limits close = limits();
  close.angle_deg = {-2000.0, 2000.0};
  close.rate_dps = {-900.0, 900.0};
  DesignOptions options;
  options.rows = 6e5;
  const Design next = design_experiment(gap, close, options);
  INFO(next.sentence);
  REQUIRE(next.ending == Ending::schedule);
  const Predictor predictor(gap, standard_catalogue(), close);
  Random random(99);
  for (const Possible& one : still_open(gap, standard_catalogue()))
    for (int i = 0; i < 100; ++i)
      CHECK(use_of(predictor.free_run(next.schedule, one.draw(random)), close).share <= 1.0);
}

TEST_CASE("An explanation with one cause more than a likelier one is no rival to it") {
  const Diagnosis diagnosis = diagnose(drum(), {play(one_way(), 0.012, 0.0, 1)});
  const DiagnosedGap gap = gap_of(drum(), diagnosis);
  const std::vector<Possible> open = still_open(gap, standard_catalogue());
  REQUIRE(!open.empty());
  for (std::size_t i = 1; i < open.size(); ++i)
    if (open[i].is_tied) CHECK(!open[i].is_more_than(open.front()));
  CHECK(open.front().is_more_than(open.front()));
}

TEST_CASE("The larger the rest that the likeliest explanation leaves, the less an experiment tells") {
  DiagnosedGap gap = gap_of(drum(), diagnose(drum(), {play(one_way(), 0.012, 0.0, 1)}));
  const double before = design_experiment(gap, limits()).expected_right;
  for (Watched& one : gap.watched) one.left = 1e6 * one.noise;
  CHECK(gap.times_noise() == Approx(1e6));
  const Design next = design_experiment(gap, limits());
  INFO(next.sentence);
  CHECK(next.expected_right < before);
  CHECK(next.ending == Ending::none_of_these);
  CHECK_THAT(next.sentence, ContainsSubstring("times the noise"));
}
