// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/io/simulator_export.hpp>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

Model axis() {
  Model model;
  model.name = "joint \"1\" <a>";
  model.axis = RigidAxisModel{2e-3, 3e-3, 0.05};
  return model;
}

std::size_t count_of(const std::string& what, const std::string& text) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

/// An effect of the test's own: a counterweight's bearing, which drags by half of what it carries.
struct DraggingWeight {
  enum Parameters { weight_Nm };
  static thermopower::plant::EffectInfo info() {
    using namespace thermopower::plant;
    EffectInfo one = {"dragging_weight",
                      Submodel::mechanical_load,
                      "torque -= weight (1 + sign(w) / 2)",
                      "A counterweight hangs on a rope over a stiff pulley.",
                      {parameter(weight_Nm, "weight_Nm").unit("N m").within(0.0, 10.0).starts({0.0})},
                      {Need::axis_model},
                      "slow motion both ways"};
    one.in_a_joint = [](const double* p, JointDescription& joint) {
      joint.offset_Nm -= p[weight_Nm];
      joint.friction_Nm += 0.5 * p[weight_Nm];
      joint.remarks.push_back({{weight_Nm}, "the rope does not swing"});
    };
    return one;
  }
  template <class Scalar>
  static void act(const Scalar* p, thermopower::plant::FrictionTerms<Scalar>& terms) {
    terms.add_friction(1.5 * p[weight_Nm], -0.5 * p[weight_Nm], thermopower::plant::constant<Scalar>(0.01));
  }
};

}  // namespace

TEST_CASE("an effect of one's own reaches the simulators by what it says of itself") {
  Catalogue catalogue = standard_catalogue();
  catalogue.add<DraggingWeight>();
  Model model = axis();
  model.effects["constant_torque"] = {{"Nm", 0.03}};
  model.effects["dragging_weight"] = {{"weight_Nm", 0.2}};
  const io::SimulatorFile file = io::mjcf(model, "a test", catalogue);
  CHECK_THAT(file.text, ContainsSubstring("frictionloss=\"0.1\"") && ContainsSubstring("biasprm=\"-0.17"));
  REQUIRE(file.left_out.size() == 1);
  CHECK(file.left_out[0] == "dragging_weight: weight_Nm 0.2; the rope does not swing");
  CHECK_THAT(io::urdf(model, "a test", catalogue).text, ContainsSubstring("friction=\"0.1\""));
  // Who does not know it leaves it out, with its numbers.
  REQUIRE(io::mjcf(model, "a test").left_out.size() == 1);
  CHECK(io::mjcf(model, "a test").left_out[0] == "dragging_weight: weight_Nm 0.2");
}

TEST_CASE("a joint's constants are where MuJoCo and robots look for them") {
  Model model = axis();
  model.effects["coulomb_friction"] = {{"Nm", 0.02}, {"transition_rad_per_s", 0.0}};
  model.effects["torque_saturation"] = {{"A", 1.5}};
  const io::SimulatorFile mujoco = io::mjcf(model, "a test");
  CHECK(mujoco.left_out.empty());
  CHECK_THAT(mujoco.text, ContainsSubstring("damping=\"0.003\" frictionloss=\"0.02\"") &&
                              ContainsSubstring("gainprm=\"0.05\"") &&
                              ContainsSubstring("diaginertia=\"0.002 0.002 0.002\"") &&
                              ContainsSubstring("ctrlrange=\"-1.5 1.5\"") &&
                              ContainsSubstring("model=\"joint &quot;1&quot; &lt;a>\""));
  const io::SimulatorFile robot = io::urdf(model, "a test");
  CHECK_THAT(robot.text, ContainsSubstring("<dynamics damping=\"0.003\" friction=\"0.02\"/>") &&
                             ContainsSubstring("effort=\"0.075") && ContainsSubstring("izz=\"0.002\""));
  REQUIRE(robot.left_out.size() == 1);
  CHECK_THAT(robot.left_out[0], ContainsSubstring("A to N m: 0.05"));
}

TEST_CASE("a servo is a position or velocity actuator, in newton metres and radians") {
  Model model = axis();
  model.name = "left_knee";
  thermopower::plant::PositionPidServo servo;
  servo.kp_A_per_deg = 0.04;
  servo.kd_A_s_per_deg = 0.002;
  servo.ki_A_per_deg_s = 0.5;
  servo.limit_A = 2.0;
  model.servo = servo;
  const io::SimulatorFile file = io::mjcf(model, "a test");
  // 0.04 A/deg at 0.05 N m/A are 0.114591559 N m/rad; 2 A are 0.1 N m.
  CHECK_THAT(file.text,
             ContainsSubstring("<joint name=\"left_knee\"") &&
                 ContainsSubstring("<position name=\"servo\" joint=\"left_knee\" kp=\"0.1145915") &&
                 ContainsSubstring("kv=\"0.0057295") && ContainsSubstring("forcerange=\"-0.1 0.1\"") &&
                 ContainsSubstring("the control is the servo's target in rad."));
  REQUIRE(file.left_out.size() == 2);
  CHECK_THAT(file.left_out[0], ContainsSubstring("ki_A_per_deg_s 0.5"));
  CHECK_THAT(file.left_out[1], ContainsSubstring("period_s 0.001"));
  // A lower limit that was found is the servo's, too.
  model.effects["torque_saturation"] = {{"A", 1.5}};
  CHECK_THAT(io::mjcf(model, "a test").text, ContainsSubstring("forcerange=\"-0.075"));
  CHECK_THAT(io::urdf(model, "a test").text, ContainsSubstring("kp_A_per_deg 0.04"));
  thermopower::plant::VelocityPiServo velocity;
  velocity.kp_A_s_per_deg = 0.01;
  model.servo = velocity;
  CHECK_THAT(io::mjcf(model, "a test").text,
             ContainsSubstring("<velocity name=\"servo\"") && ContainsSubstring("target in rad/s."));
}

TEST_CASE("nothing is dropped in silence: each effect is in the file or in the list, with its numbers") {
  Model model = axis();
  model.effects["cogging"] = {{"sin_Nm", 0.011}, {"cos_Nm", 0.012}, {"cycles_per_turn", 7.0}};
  model.effects["actuation_delay"] = {{"s", 0.013}};
  model.effects["asymmetric_friction"] = {
      {"forward_Nm", 0.014}, {"backward_Nm", 0.016}, {"transition_rad_per_s", 0.017}};
  model.effects["my--effect"] = {{"size", 0.018}};
  model.thermal = LumpedThermalModel{};
  for (const io::SimulatorFile& file : {io::mjcf(model, "x --> y"), io::urdf(model, "x --> y")}) {
    for (const char* value :
         {"0.011", "0.012", " 7", "0.013", "0.014", "0.016", "0.017", "0.018", "temperature"}) {
      CAPTURE(value);
      std::string all;
      for (const std::string& one : file.left_out) all += one + "\n";
      CHECK_THAT(all, ContainsSubstring(value));
      CHECK_THAT(file.text, ContainsSubstring(value));
    }
    CHECK_THAT(file.text, ContainsSubstring("0.015"));  // the mean of both directions
    // Comments stay comments, whatever names are in them.
    CHECK(count_of("<!--", file.text) == count_of("-->", file.text));
  }
  model.axis.reset();
  CHECK_THROWS_AS(io::mjcf(model, ""), InvalidInput);
  CHECK_THROWS_AS(io::urdf(model, ""), InvalidInput);
}
