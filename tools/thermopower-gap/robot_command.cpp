// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_command.hpp"

#include "progress.hpp"

#ifdef THERMOPOWER_HAS_MUJOCO
#include "mujoco_body.hpp"
#include "nearest_name.hpp"
#include "robot_files.hpp"
#include "robot_log.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/output_files.hpp>
#include <thermopower/robot/diagnose.hpp>
#include <thermopower/robot/impact.hpp>
#include <thermopower/robot/table.hpp>
#endif

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>

void add_robot_options(CLI::App& app, RobotArguments& arguments) {
  app.add_option("--kp", arguments.kp,
                 "of a robot: position gain in N m/rad, for all joints or as JOINT=NUMBER; may be repeated");
  app.add_option("--kd", arguments.kd,
                 "of a robot: rate gain in N m s/rad, for all joints or as JOINT=NUMBER; may be repeated");
  app.add_option("--joint", arguments.renamed,
                 "of a robot: LOG=MODEL, a joint's name in the log and in the model; may be repeated");
  app.add_flag("--in-air", arguments.in_air,
               "of a robot: nothing touches it, whatever the efforts look like");
}

void add_training_outputs(CLI::App& app, RobotArguments& arguments) {
  app.add_option("--isaac", arguments.isaac, "of a robot: write its actuators for Isaac Lab (Python)");
  app.add_option("--mjlab", arguments.mjlab, "of a robot: write its actuators for mjlab (Python)");
  app.add_option("--newton", arguments.newton, "of a robot: write its joints for Newton (Python)");
  app.add_option("--ranges", arguments.ranges,
                 "of a robot: write ranges for domain randomisation, with their covariance (JSON)");
}

#ifdef THERMOPOWER_HAS_MUJOCO
namespace {

namespace robot = thermopower::robot;
namespace io = thermopower::io;

std::string whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

double number_of(const std::string& option, const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !std::isfinite(value) || value < 0.0)
    throw UsageError(option + ": " + io::excerpt(text) + " is no gain; expected a number from 0 on");
  return value;
}

void set_gains(robot::Robot& body, const char* option, const std::vector<std::string>& given,
               double robot::Joint::*member) {
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      for (robot::Joint& joint : body.joints) joint.*member = number_of(option, text);
      continue;
    }
    const std::string name = text.substr(0, equals);
    std::vector<std::string> names;
    bool found = false;
    for (robot::Joint& joint : body.joints) {
      names.push_back(joint.name);
      if (joint.name != name) continue;
      joint.*member = number_of(option, text.substr(equals + 1));
      found = true;
    }
    if (found) continue;
    const std::string nearest = io::nearest_name(name, names);
    throw UsageError(std::string(option) + ": the robot has no joint " + io::excerpt(name) +
                     (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
}

/// A robot's file with its gains, and the logs.
struct Loaded {
  std::unique_ptr<robot::MujocoBody> body;
  robot::Robot joints;
  std::vector<robot::Log> logs, held_out;
};

const std::string& robot_path(const Arguments& arguments) {
  if (!arguments.mjcf.empty() && !arguments.urdf.empty())
    throw UsageError("--mjcf and --urdf are two robots; expected one");
  return arguments.mjcf.empty() ? arguments.urdf : arguments.mjcf;
}

Loaded load(const Arguments& arguments, const RobotArguments& asked) {
  Loaded out;
  out.body = std::make_unique<robot::MujocoBody>(robot_path(arguments));
  out.joints = out.body->robot();
  set_gains(out.joints, "--kp", asked.kp, &robot::Joint::kp);
  set_gains(out.joints, "--kd", asked.kd, &robot::Joint::kd);
  std::vector<std::pair<std::string, std::string>> renamed;
  for (const std::string& text : asked.renamed) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--joint " + text + ": expected LOG=MODEL, as in --joint hip_l=FL_hip_joint");
    renamed.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  for (const std::string& one : arguments.recordings)
    out.logs.push_back(robot::read_robot_log(one, out.joints, renamed));
  for (const std::string& one : arguments.held_out)
    out.held_out.push_back(robot::read_robot_log(one, out.joints, renamed));
  return out;
}

// Checks before anything is read that an output, where one is named, can be written and is not the robot's own file.
void expect(io::OutputFiles& outputs, const std::string& output, const std::string& input) {
  if (output.empty()) return;
  if (plain_path(output) == plain_path(input))
    throw UsageError("'" + output + "' is named twice; an output must not be an input");
  outputs.expect(output);
}

robot::RobotDiagnosis diagnosed(const Loaded& loaded, const Arguments& arguments,
                                const RobotArguments& asked) {
  robot::Options options;
  options.in_the_air = asked.in_air;
  options.as_recorded = arguments.as_recorded;
  robot::RobotDiagnosis out =
      robot::diagnose(*loaded.body, loaded.joints, robot::together(loaded.logs), loaded.held_out, options);
  out.notes.insert(out.notes.begin(), loaded.body->notes().begin(), loaded.body->notes().end());
  return out;
}

}  // namespace

int check_robot(const Arguments& arguments, const RobotArguments& asked) {
  robot::Wiring wiring;
  {
    Progress progress;
    const Loaded loaded = load(arguments, asked);
    progress.stage("checking");
    wiring = robot::check_wiring(*loaded.body, loaded.joints, robot::together(loaded.logs));
  }
  for (const robot::WiringFinding& one : wiring.findings) std::printf("Wiring: %s.\n", one.text.c_str());
  if (wiring.findings.empty())
    std::puts("The wiring is sound: joints, signs, units, zeros and gains fit each other.");
  return made;
}

int diagnose_robot(const Arguments& arguments, const RobotArguments& asked) {
  for (const std::string* other : {&arguments.predictions, &arguments.header})
    if (!other->empty())
      throw UsageError(
          "--predictions and --header are of a single actuator; a robot has --report, --html and --augmented");
  const std::string& path = robot_path(arguments);
  const std::vector<const std::string*> files{&arguments.report, &arguments.html, &arguments.augmented,
                                              &asked.isaac,      &asked.mjlab,    &asked.newton,
                                              &asked.ranges};
  io::OutputFiles outputs;
  for (const std::string* output : files) expect(outputs, *output, path);
  robot::RobotDiagnosis diagnosis;
  {
    Progress progress;
    const Loaded loaded = load(arguments, asked);
    const robot::MujocoBody& body = *loaded.body;
    progress.stage("diagnosing");
    diagnosis = diagnosed(loaded, arguments, asked);
    progress.stage("writing");
    const auto put = [&](const std::string& file, const robot::AmendedFile& amended) {
      for (const std::string& one : amended.left_out)
        std::fprintf(stderr, "%s: left out: %s\n", file.c_str(), one.c_str());
      outputs.put(file, amended.text);
    };
    if (!arguments.report.empty()) outputs.put(arguments.report, robot::robot_json(diagnosis));
    if (!arguments.html.empty()) outputs.put(arguments.html, robot::robot_html(diagnosis));
    if (!asked.ranges.empty()) outputs.put(asked.ranges, robot::ranges_json(diagnosis));
    if (!arguments.augmented.empty()) {
      const std::string text = whole_file(path);
      put(arguments.augmented,
          body.is_urdf() ? robot::amended_urdf(text, diagnosis) : robot::amended_mjcf(text, diagnosis));
    }
    using robot::TrainingFormat;
    if (!asked.isaac.empty()) put(asked.isaac, robot::training_file(diagnosis, TrainingFormat::isaac_lab));
    if (!asked.mjlab.empty()) put(asked.mjlab, robot::training_file(diagnosis, TrainingFormat::mjlab));
    if (!asked.newton.empty()) put(asked.newton, robot::training_file(diagnosis, TrainingFormat::newton));
    outputs.commit();
  }
  std::fputs(robot::table_text(diagnosis).c_str(), stdout);
  for (const robot::JointDiagnosis& joint : diagnosis.joints)
    if (joint.verdict != robot::JointVerdict::not_judged) return made;
  return too_little_data;
}

int rank_impact(const Arguments& arguments, const RobotArguments& asked) {
  io::OutputFiles outputs;
  expect(outputs, arguments.report, robot_path(arguments));
  robot::RobotDiagnosis diagnosis;
  robot::Impact ranking;
  {
    Progress progress;
    const Loaded loaded = load(arguments, asked);
    progress.stage("diagnosing");
    diagnosis = diagnosed(loaded, arguments, asked);
    progress.stage("replaying");
    try {
      ranking = robot::impact(*loaded.body, diagnosis, asked.of);
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("--of: ") + error.what());
    }
    if (!arguments.report.empty()) outputs.put(arguments.report, robot::impact_json(diagnosis, ranking));
    outputs.commit();
  }
  std::fputs(robot::impact_text(diagnosis, ranking).c_str(), stdout);
  return made;
}

#else

int diagnose_robot(const Arguments&, const RobotArguments&) {
  throw UsageError(
      "a whole robot needs MuJoCo, which this program was built without: install libmujoco-dev and build it again");
}

int check_robot(const Arguments& arguments, const RobotArguments& robot) {
  return diagnose_robot(arguments, robot);
}

int rank_impact(const Arguments& arguments, const RobotArguments& robot) {
  return diagnose_robot(arguments, robot);
}

#endif
