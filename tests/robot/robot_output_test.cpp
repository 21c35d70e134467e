// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What comes out of a robot's diagnosis: the ranking of causes, the page, files for other simulators.

#include "../catch.hpp"
#include "two_links.hpp"

#include "mujoco_body.hpp"
#include "robot_files.hpp"

#include <thermopower/robot/diagnose.hpp>
#include <thermopower/robot/impact.hpp>

#include <nlohmann/json.hpp>

#include <cmath>

namespace robot = thermopower::robot;

namespace {

const robot::MujocoBody& body() {
  static const robot::MujocoBody one("two links", test::TwoLinks::mjcf());
  return one;
}

// More friction in the elbow than its model has.
const robot::RobotDiagnosis& rubbing_elbow() {
  static const robot::RobotDiagnosis diagnosis = [] {
    test::TwoLinks::Truth truth;
    truth.friction = {0.1, 0.4};
    robot::Robot joints = body().robot();
    for (robot::Joint& joint : joints.joints) joint.kp = test::TwoLinks::kp, joint.kd = test::TwoLinks::kd;
    return robot::diagnose(body(), joints, test::TwoLinks::log(truth, 1e-4, 11, false), {});
  }();
  return diagnosis;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t out = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++out;
  return out;
}

}  // namespace

TEST_CASE("the cause that was put in matters most, for its joint and for the link that hangs on it") {
  for (const char* of : {"joint:left_elbow", "body:lower", ""}) {
    CAPTURE(of);
    const robot::Impact impact = robot::impact(body(), rubbing_elbow(), of);
    REQUIRE(!impact.rows.empty());
    CHECK(impact.found < impact.configured);
    CHECK(impact.rows[0].joint == 1);
    CHECK(impact.rows[0].cause == "coulomb_friction");
    CHECK(impact.rows[0].told);
    for (const robot::ImpactRow& row : impact.rows) CHECK(row.share <= impact.rows[0].share);
    // Put in alone it does nearly what all causes do; without it nearly nothing is won.
    CHECK(impact.rows[0].put_in < 0.5 * (impact.configured + impact.found));
    CHECK(impact.rows[0].taken_out > 0.5 * (impact.configured + impact.found));
    CHECK(robot::impact_text(rubbing_elbow(), impact).find("left_elbow  coulomb_friction") !=
          std::string::npos);
  }
  const robot::Impact of_elbow = robot::impact(body(), rubbing_elbow(), "joint:left_elbow");
  const auto json = nlohmann::json::parse(robot::impact_json(rubbing_elbow(), of_elbow));
  CHECK(json.at("of") == "joint:left_elbow");
  CHECK(json.at("causes").size() == of_elbow.rows.size());
  CHECK(json.at("causes").at(0).at("joint") == "left_elbow");
  CHECK(json.at("causes").at(0).at("cause") == "coulomb_friction");
  CHECK(json.at("causes").at(0).at("share") == of_elbow.rows[0].share);
  CHECK(of_elbow.unit == "rad");
  CHECK(robot::impact(body(), rubbing_elbow(), "body:lower").unit == "m");
}

TEST_CASE("an impact of nothing is refused with what there is") {
  CHECK_THROWS_WITH(robot::impact(body(), rubbing_elbow(), "joint:knee"),
                    "the robot has no joint 'knee'; it has left_shoulder, left_elbow");
  CHECK_THROWS_WITH(robot::impact(body(), rubbing_elbow(), "site:foot"), "the robot has no site 'foot'");
  CHECK_THROWS_WITH(
      robot::impact(body(), rubbing_elbow(), "foot"),
      "'foot' names nothing to measure; expected joint:NAME, body:NAME, site:NAME or geom:NAME");
}

TEST_CASE("the page has a row for each joint, and each row links to that joint's report") {
  const std::string page = robot::robot_html(rubbing_elbow());
  for (const char* name : {"left_shoulder", "left_elbow"}) {
    std::string id = std::string("joint-") + name;
    for (char& c : id)
      if (c == '_') c = '-';
    CHECK(count(page, "<a href=\"#" + id + "\">") == 1);
    CHECK(count(page, "<section id=\"" + id + "\">") == 1);
  }
  CHECK(page.find("http") == std::string::npos);  // it loads nothing
  CHECK(count(page, "<svg") >= 2);
}

TEST_CASE("files for training hold each joint's numbers, and say what has no place") {
  const robot::JointDynamics& found = rubbing_elbow().joints[1].found;
  char friction[40];
  std::snprintf(friction, sizeof friction, "%.4g", found.friction);
  const struct {
    robot::TrainingFormat format;
    const char *call, *name;
  } cases[] = {{robot::TrainingFormat::isaac_lab, "DelayedPDActuatorCfg(joint_names_expr=[\"left_elbow\"]",
                "dynamic_friction="},
               {robot::TrainingFormat::mjlab,
                "BuiltinPositionActuatorCfg(target_names_expr=(\"left_elbow\",)", "frictionloss="},
               {robot::TrainingFormat::newton, "\"left_elbow\": dict(ke=30", "friction="}};
  for (const auto& one : cases) {
    const std::string text = robot::training_file(rubbing_elbow(), one.format).text;
    CAPTURE(text);
    CHECK(text.find(one.call) != std::string::npos);
    CHECK(text.find(one.name + std::string(friction)) != std::string::npos);
  }
  robot::RobotDiagnosis with_drag = rubbing_elbow();
  with_drag.joints[1].changes.push_back({"drag", "N m s2/rad2", 0.0, 0.2, 0.01});
  const robot::AmendedFile file = robot::training_file(with_drag, robot::TrainingFormat::isaac_lab);
  REQUIRE(!file.left_out.empty());
  CHECK(file.left_out.back().find("drag 0.2 N m s2/rad2") != std::string::npos);
}

TEST_CASE("ranges hold the standard errors' squares on the covariance's diagonal") {
  const nlohmann::json ranges = nlohmann::json::parse(robot::ranges_json(rubbing_elbow()));
  bool any = false;
  for (const auto& joint : ranges["joints"]) {
    const auto& numbers = joint["numbers"];
    REQUIRE(joint["covariance"].size() == numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double error = numbers[i]["standard_error"];
      CHECK(joint["covariance"][i][i].get<double>() == Approx(error * error));
      const double low = numbers[i]["range95"][0], high = numbers[i]["range95"][1];
      any = any ||
            (joint["joint"] == "left_elbow" && numbers[i]["name"] == "friction" && low < 0.4 && high > 0.35);
    }
  }
  CHECK(any);
}
