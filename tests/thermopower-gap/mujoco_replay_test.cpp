// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Exported models, run in MuJoCo, against an integrator of this test and against the library's own simulation.

#include "../catch.hpp"
#include "../mujoco_model.hpp"

#include <thermopower/gap/simulate.hpp>
#include <thermopower/io/simulator_export.hpp>

#include <cmath>
#include <memory>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

constexpr double deg = 57.29577951308232;

/// A model of MuJoCo that is driven.
class Mujoco {
public:
  explicit Mujoco(const std::string& xml) : loaded_(xml) {
    INFO(loaded_.error);
    INFO(xml);
    REQUIRE(loaded_.model != nullptr);
  }

  void start(double angle, double rate, double drive_A) {
    mj_resetData(model_, data_);
    data_->qpos[0] = angle;
    data_->qvel[0] = rate;
    if (model_->na > 0) data_->act[0] = drive_A;
  }
  void run(double drive_A, double seconds) {
    data_->ctrl[0] = drive_A;
    const int steps = static_cast<int>(std::lround(seconds / model_->opt.timestep));
    for (int i = 0; i < steps; ++i) mj_step(model_, data_);
  }
  double angle() const { return data_->qpos[0]; }
  double rate() const { return data_->qvel[0]; }

private:
  test::MujocoModel loaded_;
  mjModel* const model_ = loaded_.model;
  mjData* const data_ = loaded_.data;
};

/// The same joint, stated here once more, in steps of 10 us.
struct Truth {
  double inertia = 1e-3, viscous = 2e-3, torque_constant = 0.2;
  double friction = 0.0, spring = 0.0, spring_at = 0.0, constant = 0.0, limit = 1e9, lag = 0.0, weight = 0.0,
         phase = 0.0;
  double angle = 0.0, rate = 0.0, torque = 0.0;

  void run(double drive_A, double seconds) {
    const double h = 1e-5, wanted = torque_constant * std::fmax(-limit, std::fmin(limit, drive_A));
    for (int i = 0, n = static_cast<int>(std::lround(seconds / h)); i < n; ++i) {
      torque = lag > 0.0 ? torque + h * (wanted - torque) / lag : wanted;
      const double other = torque + constant - viscous * rate - spring * (angle - spring_at) -
                           weight * std::sin(angle + phase);
      double slope = (other - friction * (rate > 0.0 ? 1.0 : -1.0)) / inertia;
      if (std::fabs(rate) < 1e-9) {
        slope = std::fabs(other) <= friction ? 0.0 : (other - std::copysign(friction, other)) / inertia;
      } else if (friction > 0.0 && rate * (rate + h * slope) < 0.0 && std::fabs(other) <= friction) {
        slope = -rate / h;  // it comes to rest
      }
      rate += h * slope;
      angle += h * rate;
    }
  }
};

double drive_at(double t) { return 0.5 * std::sin(3.1 * t) + 0.35 * std::sin(11.0 * t + 1.0); }

/// Largest difference of the angle over three seconds, in rad, and the travel.
std::pair<double, double> apart(const Model& model, Truth truth) {
  const io::SimulatorFile file = io::mjcf(model, "a test");
  CHECK(file.left_out.empty());
  Mujoco mujoco(file.text);
  mujoco.start(0.0, 0.0, 0.0);
  double worst = 0.0, travel = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double drive = drive_at(0.01 * i);
    mujoco.run(drive, 0.01);
    truth.run(drive, 0.01);
    worst = std::fmax(worst, std::fabs(mujoco.angle() - truth.angle));
    travel = std::fmax(travel, std::fabs(truth.angle));
  }
  return {worst, travel};
}

Model model_of(const Truth& truth) {
  Model model;
  model.name = "joint";
  model.axis = RigidAxisModel{truth.inertia, truth.viscous, truth.torque_constant};
  return model;
}

void agree(const Model& model, const Truth& truth, double share) {
  const auto [worst, travel] = apart(model, truth);
  CAPTURE(worst, travel);
  CHECK(travel > 0.05);
  CHECK(worst < share * travel);
}

}  // namespace

TEST_CASE("MuJoCo moves the exported axis as its equation says, effect by effect") {
  Truth truth;
  Model model = model_of(truth);
  SECTION("bare") { agree(model, truth, 0.01); }
  SECTION("spring") {
    truth.spring = 0.08;
    truth.spring_at = 0.3;
    model.effects["cable_spring"] = {{"Nm_per_rad", 0.08}, {"centre_rad", 0.3}};
    agree(model, truth, 0.01);
  }
  SECTION("constant torque and a lag") {
    truth.constant = -0.012;
    truth.lag = 0.06;
    model.effects["constant_torque"] = {{"Nm", -0.012}};
    model.effects["drive_lag"] = {{"lag_s", 0.06}};
    agree(model, truth, 0.01);
  }
  SECTION("saturation") {
    truth.limit = 0.3;
    model.effects["torque_saturation"] = {{"A", 0.3}};
    agree(model, truth, 0.01);
  }
  SECTION("imbalance, from all sides") {
    for (const double phase : {0.0, 0.9, 2.5, -1.7}) {
      CAPTURE(phase);
      Truth heavy = truth;
      heavy.weight = 0.04;
      heavy.phase = phase;
      model.effects["imbalance"] = {{"Nm", 0.04}, {"phase_rad", phase}};
      agree(model, heavy, 0.02);
    }
  }
  SECTION("a motor at a voltage: 0.2 (u - 0.2 w) / 5") {
    truth.viscous = 2e-3 + 0.04 / 5.0;
    truth.torque_constant = 0.2 / 5.0;
    truth.limit = 0.3 * 5.0;
    model.axis->resistance_ohm = 5.0;
    model.effects["torque_saturation"] = {{"A", 0.3}};
    agree(model, truth, 0.01);
  }
  SECTION("dry friction") {
    truth.friction = 0.03;
    model.effects["coulomb_friction"] = {{"Nm", 0.03}, {"transition_rad_per_s", 0.0}};
    agree(model, truth, 0.01);
  }
}

TEST_CASE("MuJoCo's servo goes where the library's goes, friction, limit and all") {
  Truth truth;
  truth.friction = 0.01;
  Model model = model_of(truth);
  model.effects["coulomb_friction"] = {{"Nm", 0.01}, {"transition_rad_per_s", 0.0}};
  thermopower::plant::PositionPidServo servo;
  servo.kp_A_per_deg = 0.03;
  servo.kd_A_s_per_deg = 0.0015;
  servo.limit_A = 0.8;
  servo.period_s = 5e-4;
  model.servo = servo;
  // Debian's MuJoCo has no kv: a position actuator is a general one with these numbers, as its documentation says.
  std::string xml = io::mjcf(model, "a test").text;
  const std::regex position("<position (.*) kp=\"([^\"]+)\" kv=\"([^\"]+)\"");
  REQUIRE(std::regex_search(xml, position));
  xml = std::regex_replace(
      xml, position,
      "<general $1 gaintype=\"fixed\" gainprm=\"$2\" biastype=\"affine\" biasprm=\"0 -$2 -$3\"");
  Mujoco mujoco(xml);
  mujoco.start(0.0, 0.0, 0.0);
  const Eigen::Index rows = 500;
  Recording recording;
  recording.t_s.resize(rows);
  Eigen::VectorXd target(rows), angle = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    recording.t_s[i] = 0.01 * static_cast<double>(i);
    target[i] = (i / 60) % 2 == 0 ? 30.0 : -20.0;
  }
  recording.set("target_deg", target);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", angle);
  SimulationOptions options;
  options.horizon_s = 0.0;
  Eigen::VectorXd ours;
  for (const auto& one : simulate(model, recording, options))
    if (to_string(one.signal) == "angle_deg") ours = one.values;
  REQUIRE(ours.size() == rows);
  double worst = 0.0;
  for (Eigen::Index row = 1; row < rows; ++row) {
    mujoco.run(target[row - 1] / deg, 0.01);
    worst = std::fmax(worst, std::fabs(deg * mujoco.angle() - ours[row]));
  }
  CAPTURE(worst);
  CHECK(worst <
        0.5);  // of 50 degrees; the library's servo samples every half millisecond, MuJoCo's at every step
}

TEST_CASE("on held-out data MuJoCo's residual is at most 1.1 times the library's own") {
  Truth truth;
  truth.friction = 0.02;
  truth.spring = 0.05;
  Model model = model_of(truth);
  model.effects["coulomb_friction"] = {{"Nm", 0.02}, {"transition_rad_per_s", 0.0}};
  model.effects["cable_spring"] = {{"Nm_per_rad", 0.05}, {"centre_rad", 0.0}};
  std::mt19937 random(5);
  std::normal_distribution<double> angle_noise(0.0, 0.05 / deg), rate_noise(0.0, 0.5 / deg);
  const Eigen::Index rows = 1000;
  Recording recording;
  recording.name = "held out";
  recording.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    recording.t_s[i] = 0.01 * static_cast<double>(i);
    drive[i] = drive_at(recording.t_s[i]);
    angle[i] = deg * (truth.angle + angle_noise(random));
    rate[i] = deg * (truth.rate + rate_noise(random));
    truth.run(drive[i], 0.01);
  }
  recording.set("drive_A", drive);
  recording.set("angle_deg", angle);
  recording.set("rate_dps", rate);

  // Both run free from rest over the whole recording: a start that each estimates from noise would be compared else.
  recording.columns[1].values[0] = recording.columns[2].values[0] = 0.0;
  SimulationOptions options;
  options.horizon_s = 0.0;
  Eigen::VectorXd ours;
  for (const auto& one : simulate(model, recording, options))
    if (to_string(one.signal) == "angle_deg") ours = one.values;
  REQUIRE(ours.size() == rows);
  Mujoco mujoco(io::mjcf(model, "a test").text);
  double own = 0.0, theirs = 0.0;
  mujoco.start(0.0, 0.0, 0.0);
  for (Eigen::Index row = 1; row < rows; ++row) {
    mujoco.run(drive[row - 1], 0.01);
    REQUIRE(std::isfinite(ours[row]));
    own += std::pow(ours[row] - angle[row], 2);
    theirs += std::pow(deg * mujoco.angle() - angle[row], 2);
  }
  CAPTURE(std::sqrt(own / static_cast<double>(rows)), std::sqrt(theirs / static_cast<double>(rows)));
  CHECK(own > 0.0);
  CHECK(std::sqrt(theirs) <= 1.1 * std::sqrt(own));
}
