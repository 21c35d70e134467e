// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_files.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thermopower::robot {
namespace {

using Json = nlohmann::ordered_json;

constexpr double two_sided_95 = 1.96;  // standard errors

// A string of Python; names of joints come from a file.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + "\"";
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return text;
}

// A joint's name as a pattern that matches nothing else.
std::string pattern(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::string("\\^$.|?*+()[]{}").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

double found_kp(const Joint& joint, const JointDynamics& d) { return d.effort_scale * joint.kp; }
double found_kd(const Joint& joint, const JointDynamics& d) {
  return d.effort_scale * (std::isfinite(joint.kd) ? joint.kd : 0.0);
}

// What none of the simulators' joints has.
std::vector<std::string> left_over(const JointDiagnosis& joint) {
  std::vector<std::string> out;
  for (const Change& change : joint.changes) {
    const bool has_place = change.name == "armature" || change.name == "damping" ||
                           change.name == "friction" || change.name == "effort_scale";
    if (!has_place)
      out.push_back(change.name + " " + four_digits(change.to) +
                    (change.unit == "1" ? "" : " " + change.unit));
  }
  return out;
}

std::string steps_text(const RobotDiagnosis& robot) {
  double delay = 0.0;
  for (const JointDiagnosis& joint : robot.joints) delay = std::max(delay, joint.found.delay_s);
  return four_digits(delay);
}

const char* program_name(TrainingFormat format) {
  return format == TrainingFormat::isaac_lab ? "Isaac Lab"
         : format == TrainingFormat::mjlab   ? "mjlab"
                                             : "Newton";
}

std::string call(const std::vector<std::pair<std::string, std::string>>& arguments) {
  std::string out;
  for (const auto& [name, value] : arguments) out += (out.empty() ? "" : ", ") + name + "=" + value;
  return out;
}

}  // namespace

AmendedFile training_file(const RobotDiagnosis& robot, TrainingFormat format) {
  AmendedFile out;
  std::string& text = out.text;
  text = "# Actuators of " + one_line(robot.robot.name) + " for " + program_name(format) +
         ", written by thermopower-gap from " + one_line(robot.log) + ".\n# Units: rad, N m, s.\n";
  const std::string delay = steps_text(robot);
  const bool late = delay != "0";
  if (format != TrainingFormat::newton) {
    text += "\nPHYSICS_STEP_S = 0.005  # of your simulation\nDELAY_S = " + delay +
            "  # of the targets, in all joints\n";
    text += "DELAY_STEPS = round(DELAY_S / PHYSICS_STEP_S)\n\n";
  }
  if (format == TrainingFormat::isaac_lab)
    text += "from isaaclab.actuators import DelayedPDActuatorCfg\n\nACTUATORS = {\n";
  if (format == TrainingFormat::mjlab)
    text += "from mjlab.actuator import BuiltinPositionActuatorCfg\n\nACTUATORS = (\n";
  if (format == TrainingFormat::newton) {
    text += "# The delay of the targets is " + delay + " s; send them later by as much.\n\nJOINTS = {\n";
    if (late) out.left_out.push_back("the delay of the targets, " + delay + " s");
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const JointDiagnosis& joint = robot.joints[j];
    const Joint& model = robot.robot.joints[j];
    if (!std::isfinite(model.kp)) {
      out.left_out.push_back(joint.name + ": no gains are known; --kp and --kd give them");
      continue;
    }
    const JointDynamics& d = joint.found;
    std::vector<std::string> rest = left_over(joint);
    std::vector<std::pair<std::string, std::string>> numbers{{"stiffness", four_digits(found_kp(model, d))},
                                                             {"damping", four_digits(found_kd(model, d))},
                                                             {"armature", four_digits(d.armature)}};
    const bool limited = std::isfinite(model.effort_limit);
    if (format == TrainingFormat::isaac_lab) {
      numbers.insert(numbers.begin(), {"joint_names_expr", "[" + quoted(pattern(joint.name)) + "]"});
      numbers.emplace_back("friction", four_digits(d.friction + d.stribeck));
      numbers.emplace_back("dynamic_friction", four_digits(d.friction));
      numbers.emplace_back("viscous_friction", four_digits(d.damping));
      if (limited) numbers.emplace_back("effort_limit", four_digits(model.effort_limit));
      numbers.emplace_back("min_delay", "DELAY_STEPS");
      numbers.emplace_back("max_delay", "DELAY_STEPS");
      rest.erase(std::remove_if(rest.begin(), rest.end(),
                                [](const std::string& one) { return one.compare(0, 9, "stribeck ") == 0; }),
                 rest.end());
      text += "    " + quoted(joint.name) + ": DelayedPDActuatorCfg(" + call(numbers) + "),\n";
    } else if (format == TrainingFormat::mjlab) {
      // Passive damping and the servo's act alike: both follow the rate.
      numbers[1].second = four_digits(found_kd(model, d) + d.damping - joint.configured.damping);
      numbers.insert(numbers.begin(), {"target_names_expr", "(" + quoted(pattern(joint.name)) + ",)"});
      numbers.emplace_back("frictionloss", four_digits(d.friction));
      if (limited) numbers.emplace_back("effort_limit", four_digits(model.effort_limit));
      numbers.emplace_back("delay_min_lag", "DELAY_STEPS");
      numbers.emplace_back("delay_max_lag", "DELAY_STEPS");
      text += "    # The joint keeps its damping of " + four_digits(joint.configured.damping) +
              " N m s/rad in the MJCF; what it has more or less is in the servo's.\n";
      text += "    BuiltinPositionActuatorCfg(" + call(numbers) + "),\n";
    } else {
      text += "    " + quoted(joint.name) + ": dict(ke=" + four_digits(found_kp(model, d)) +
              ", kd=" + four_digits(found_kd(model, d) + d.damping) +
              ", armature=" + four_digits(d.armature) + ", friction=" + four_digits(d.friction) +
              (limited ? ", effort_limit=" + four_digits(model.effort_limit) : "") + "),\n";
    }
    if (!rest.empty()) {
      std::string said;
      for (const std::string& one : rest) said += (said.empty() ? "" : "; ") + one;
      text += "    # " + one_line(joint.name) + " has no place for: " + said + "\n";
      out.left_out.push_back(joint.name + ": " + said);
    }
  }
  text += format == TrainingFormat::mjlab ? ")\n" : "}\n";
  if (format == TrainingFormat::newton)
    text +=
        "\n\ndef apply(builder):\n"
        "    \"\"\"Sets the joints of a newton.ModelBuilder into which the robot's file was read.\"\"\"\n"
        "    labels = getattr(builder, \"joint_label\", None) or builder.joint_key\n"
        "    for joint, label in enumerate(labels):\n"
        "        numbers = JOINTS.get(label.split(\"/\")[-1])\n"
        "        if numbers is None:\n"
        "            continue\n"
        "        dof = builder.joint_qd_start[joint]\n"
        "        builder.joint_target_ke[dof] = numbers[\"ke\"]\n"
        "        builder.joint_target_kd[dof] = numbers[\"kd\"]\n"
        "        builder.joint_armature[dof] = numbers[\"armature\"]\n"
        "        builder.joint_friction[dof] = numbers[\"friction\"]\n"
        "        if \"effort_limit\" in numbers:\n"
        "            builder.joint_effort_limit[dof] = numbers[\"effort_limit\"]\n";
  return out;
}

std::string ranges_json(const RobotDiagnosis& robot) {
  const auto value = [](double one) { return std::isfinite(one) ? Json(one) : Json(nullptr); };
  Json joints = Json::array(), groups = Json::array();
  for (const JointDiagnosis& joint : robot.joints) {
    if (joint.changes.empty()) continue;
    Json numbers = Json::array(), covariance = Json::array();
    for (const Change& one : joint.changes)
      numbers.push_back(
          {{"name", one.name},
           {"unit", one.unit},
           {"value", value(one.to)},
           {"standard_error", value(one.error)},
           {"range95",
            {value(one.to - two_sided_95 * one.error), value(one.to + two_sided_95 * one.error)}}});
    for (Eigen::Index i = 0; i < joint.covariance.rows(); ++i) {
      Json row = Json::array();
      for (Eigen::Index k = 0; k < joint.covariance.cols(); ++k) row.push_back(value(joint.covariance(i, k)));
      covariance.push_back(row);
    }
    joints.push_back({{"joint", joint.name}, {"numbers", numbers}, {"covariance", covariance}});
  }
  for (const GroupDiagnosis& group : robot.groups) {
    if (group.pooled.empty()) continue;
    Json members = Json::array(), numbers = Json::array();
    for (const int one : group.members) members.push_back(robot.joints[static_cast<std::size_t>(one)].name);
    for (const Change& one : group.pooled)
      numbers.push_back(
          {{"name", one.name}, {"unit", one.unit}, {"mean", value(one.to)}, {"spread", value(one.error)}});
    groups.push_back({{"name", group.name}, {"joints", members}, {"numbers", numbers}});
  }
  const Json out{{"format", "thermopower-ranges/1"},
                 {"robot", robot.robot.name},
                 {"log", robot.log},
                 {"joints", joints},
                 {"groups", groups}};
  return out.dump(2) + "\n";
}

}  // namespace thermopower::robot
