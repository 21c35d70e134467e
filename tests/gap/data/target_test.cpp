// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a servo's target did between the rows, found from the motion of an axis that is stepped here, apart from the library's
// equations: the axis two hundred times in a row, the servo at its own period. The angle alone is recorded unless said.
#include "../../catch.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/target_between_rows.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

constexpr double deg_per_radian = 57.29577951308232, turn = 6.283185307179586;
constexpr double inertia_kgm2 = 1e-3, viscous_per_s = 1.0, torque_constant_Nm_per_A = 0.2;

enum class Path { chirp, multisine, steps };

/// An axis behind a position servo, and what a log keeps of it.
struct Bench {
  Path path = Path::multisine;
  double natural_radps = 9.0;  ///< of the closed loop
  double row_s = 0.05;
  int samples_a_row = 1;      ///< of the servo
  bool moves = false;         ///< the target goes on between the rows
  double ahead_rows = 0.0;    ///< by which the servo's target is ahead of what is logged
  bool logs_rate = false;     ///< beside the angle
  double coulomb_Nm = 0.0;    ///< that the simulation does not know
  double gravity_Nm = 0.0;    ///< the same
  double noise_deg = 0.02;    ///< of the angle, standard deviation
  double file_inertia = 1.0;  ///< that the simulation has, of the true one
  double most_A = 1e6;        ///< that the drive gives, which the simulation does not know

  double kp_A_per_deg() const {
    return inertia_kgm2 * natural_radps * natural_radps / torque_constant_Nm_per_A / deg_per_radian;
  }
  double kd_A_s_per_deg() const {
    return inertia_kgm2 * (1.4 * natural_radps - viscous_per_s) / torque_constant_Nm_per_A / deg_per_radian;
  }
  double period_s() const { return row_s / samples_a_row; }

  Model model() const {
    Model model;
    model.name = "axis behind a servo";
    model.axis =
        RigidAxisModel{file_inertia * inertia_kgm2, viscous_per_s * inertia_kgm2, torque_constant_Nm_per_A};
    model.servo = PositionPidServo{kp_A_per_deg(), kd_A_s_per_deg(), 0.0, 1000.0, period_s(), 0.0};
    return model;
  }

  double target_deg(double t_s, double length_s) const {
    if (path == Path::chirp) {  // 0.2 to 4 Hz
      const double growth = std::log(20.0) / length_s;
      return 40.0 * (0.3 + 0.7 * t_s / length_s) * std::sin(turn * 0.2 / growth * std::expm1(growth * t_s));
    }
    if (path == Path::steps) return 40.0 * std::sin(1.7 * std::pow(std::floor(t_s / 0.4), 2.0));
    double sum = 0.0;
    for (const double hz : {0.31, 0.57, 0.83, 1.37, 2.9}) sum += 13.0 * std::sin(turn * hz * t_s + 9.0 * hz);
    return sum;
  }

  Recording record(std::uint64_t seed = 5) const {
    constexpr Eigen::Index rows = 2000;
    const int inner = 200 / samples_a_row;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Recording r;
    r.name = "servo";
    r.t_s.resize(rows);
    Eigen::VectorXd target(rows), angle(rows), rate(rows);
    const double length_s = row_s * static_cast<double>(rows);
    const double step_s = row_s / samples_a_row / inner;
    double rad = 0.0, radps = 0.0;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double now_s = row_s * static_cast<double>(i);
      r.t_s[i] = now_s;
      target[i] = target_deg(now_s, length_s);
      angle[i] = rad * deg_per_radian + noise_deg * normal(random);
      rate[i] = radps * deg_per_radian + 0.3 * normal(random);
      for (int sample = 0; sample < samples_a_row; ++sample) {
        const double taken_s = now_s + (moves ? sample * period_s() : 0.0) + ahead_rows * row_s;
        const double command_A = kp_A_per_deg() * (target_deg(taken_s, length_s) - rad * deg_per_radian) -
                                 kd_A_s_per_deg() * radps * deg_per_radian,
                     given_A = std::clamp(command_A, -most_A, most_A);
        for (int n = 0; n < inner; ++n) {
          const double push_Nm = torque_constant_Nm_per_A * given_A - viscous_per_s * inertia_kgm2 * radps -
                                 coulomb_Nm * std::tanh(radps / 0.02) - gravity_Nm * std::sin(rad + 0.5);
          const double before = radps;
          radps += step_s * push_Nm / inertia_kgm2;
          rad += 0.5 * step_s * (before + radps);
        }
      }
    }
    r.set("target_deg", target);
    r.set("angle_deg", angle);
    if (logs_rate) r.set("rate_dps", rate);
    return r;
  }

  /// How far a target is said to have gone to its next row's; nothing where it is not said to have gone on.
  std::optional<double> said_share() const {
    const Inputs inputs = prepare(model(), record());
    const Model file = model();
    TargetBetweenRows between(file, thermopower::plant::standard_catalogue());
    between.add(inputs);
    const auto share = between.steady();
    return share ? std::optional<double>(share->value) : std::nullopt;
  }
};

TEST_CASE("a target that holds is not said to move, however few rows an axis takes to turn") {
  for (const Path path : {Path::chirp, Path::multisine, Path::steps})
    for (const double row_s : {0.05, 0.02})
      for (const double natural_radps : {6.0, 9.0, 16.0})
        for (const int samples : {1, 2, 10}) {
          Bench bench;
          bench.path = path;
          bench.row_s = row_s;
          bench.natural_radps = natural_radps;
          bench.samples_a_row = samples;
          CAPTURE(static_cast<int>(path), row_s, natural_radps, samples);
          CHECK_FALSE(bench.said_share());
        }
}

TEST_CASE("nor is it where the simulation lacks friction, a load or much of the inertia") {
  for (const double file_inertia : {0.6, 1.0, 1.6, 2.5})
    for (const double coulomb_Nm : {0.0, 0.003})
      for (const double gravity_Nm : {0.0, 0.03}) {
        Bench bench;
        bench.samples_a_row = 2;
        bench.file_inertia = file_inertia;
        bench.coulomb_Nm = coulomb_Nm;
        bench.gravity_Nm = gravity_Nm;
        CAPTURE(file_inertia, coulomb_Nm, gravity_Nm);
        CHECK_FALSE(bench.said_share());
      }
}

TEST_CASE("nor is it where the drive gives less of its largest commands than it is asked for") {
  for (const Path path : {Path::chirp, Path::multisine, Path::steps})
    for (const double row_s : {0.02, 0.05})
      for (const double natural_radps : {6.0, 14.0})
        for (const int samples : {1, 2})
          for (const bool logs_rate : {false, true}) {
            Bench bench;
            bench.path = path;
            bench.row_s = row_s;
            bench.natural_radps = natural_radps;
            bench.samples_a_row = samples;
            bench.logs_rate = logs_rate;
            bench.most_A = 12.0 * bench.kp_A_per_deg();  // what 12 degrees of the target's 40 ask for
            CAPTURE(static_cast<int>(path), row_s, natural_radps, samples, logs_rate);
            CHECK_FALSE(bench.said_share());
          }
}

TEST_CASE("a target that moves is given as far as the servo takes it on the way") {
  for (const Path path : {Path::chirp, Path::multisine})
    for (const double natural_radps : {6.0, 9.0, 14.0})
      for (const double file_inertia : {0.8, 1.0, 1.5})
        for (const int samples : {2, 10}) {
          Bench bench;
          bench.path = path;
          bench.natural_radps = natural_radps;
          bench.file_inertia = file_inertia;
          bench.samples_a_row = samples;
          bench.moves = true;
          CAPTURE(static_cast<int>(path), natural_radps, file_inertia, samples);
          const std::optional<double> share = bench.said_share();
          REQUIRE(share);
          CHECK(*share == Approx(0.5 - 0.5 / samples).margin(0.1));
          bench.logs_rate = true;
          REQUIRE(bench.said_share());
          CHECK(*bench.said_share() == Approx(0.5 - 0.5 / samples).margin(0.1));
        }
}

TEST_CASE("of targets that move nothing is felt by a servo that takes one a row, but of one that is ahead") {
  Bench bench;
  bench.moves = true;
  CHECK_FALSE(bench.said_share());
  bench.ahead_rows = 0.4;
  const std::optional<double> share = bench.said_share();
  REQUIRE(share);
  CHECK(*share == Approx(0.4).margin(0.1));
}

TEST_CASE("nothing is said of a target where the loop of the simulation runs away") {
  Bench bench;
  bench.natural_radps = 14.0;
  bench.moves = true;
  bench.samples_a_row = 2;
  REQUIRE(bench.said_share());
  bench.file_inertia = 0.1;
  CHECK_FALSE(bench.said_share());
}

TEST_CASE("the check leaves a target that holds as it is, and says of one that moves what it takes") {
  Bench bench;
  bench.samples_a_row = 2;
  for (const bool moves : {false, true}) {
    bench.moves = moves;
    const CheckedRecordings checked = check(bench.model(), {bench.record(5)}, {bench.record(6)}, {},
                                            thermopower::plant::standard_catalogue());
    CHECK(std::count_if(checked.findings.begin(), checked.findings.end(), [](const Finding& finding) {
            return finding.kind == FindingKind::sampled_command;
          }) == (moves ? 2 : 0));
    CHECK(checked.train.front().inputs().target_moves == moves);
    CHECK(checked.held_out.front().inputs().target_moves == moves);
    CHECK(checked.train.front().inputs().target_lead == 0.0);
  }
}

}  // namespace
