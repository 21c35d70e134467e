// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "robot_command.hpp"

#include "progress.hpp"

#ifdef THERMOPOWER_HAS_MUJOCO
#include "mujoco_body.hpp"
#include "nearest_name.hpp"
#include "robot_files.hpp"
#include "robot_log.hpp"

#include <thermopower/io/column_list.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/output_files.hpp>
#include <thermopower/robot/diagnose.hpp>
#include <thermopower/robot/impact.hpp>
#include <thermopower/robot/table.hpp>
#endif

#include <algorithm>
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
    throw UsageError(option + ": " + io::excerpt(text) + " is not a gain; expected a number, 0 or more");
  return value;
}

[[noreturn]] void no_such_joint(const std::string& option, const std::string& name,
                                const std::vector<std::string>& names) {
  const std::string nearest = io::nearest_name(name, names);
  std::string list;
  for (const std::string& one : names) list += (list.empty() ? "" : ", ") + one;
  throw UsageError(option + ": the robot has no joint " + io::excerpt(name) +
                   (nearest.empty() ? "; it has " + list : "; did you mean " + nearest + "?"));
}

// A name of the log that no column has, or of a joint that the robot lacks, would rename nothing in silence.
void expect_renames(const std::vector<std::pair<std::string, std::string>>& renamed, const robot::Robot& body,
                    const std::vector<std::string>& recordings) {
  if (renamed.empty()) return;
  std::vector<std::string> joints;
  for (const robot::Joint& joint : body.joints) joints.push_back(joint.name);
  std::vector<std::string> headers;
  for (const std::string& path : recordings)
    for (const io::ListedColumn& column : io::list_columns(path)) headers.push_back(column.header);
  for (const auto& [in_log, in_model] : renamed) {
    const std::string option = "--joint " + in_log + "=" + in_model;
    if (std::find(joints.begin(), joints.end(), in_model) == joints.end())
      no_such_joint(option, in_model, joints);
    const std::string& name = in_log;
    if (std::none_of(headers.begin(), headers.end(),
                     [&name](const std::string& header) { return header.find(name) != std::string::npos; }))
      throw UsageError(option + ": no column of the log has " + io::excerpt(name) +
                       " in its header; 'thermopower-gap columns' lists them");
  }
}

// Options of a single actuator would be passed over in silence.
void refuse_options_of_one(const Arguments& asked) {
  const Arguments standard;
  const std::pair<bool, const char*> given[] = {{!asked.predictions.empty(), "--predictions"},
                                                {!asked.header.empty(), "--header"},
                                                {!asked.without.empty(), "--without"},
                                                {!asked.columns.empty(), "--column"},
                                                {!asked.maps.empty(), "--map"},
                                                {asked.rows_per_s != standard.rows_per_s, "--rate"},
                                                {asked.has_ambient, "--ambient"},
                                                {asked.has_supply, "--supply"},
                                                {!asked.constants.empty(), "--constant"},
                                                {asked.horizon_s != standard.horizon_s, "--horizon"},
                                                {asked.tolerance != standard.tolerance, "--tolerance"},
                                                {asked.summary != standard.summary, "--summary"}};
  for (const auto& [is_given, option] : given)
    if (is_given)
      throw UsageError(std::string(option) + " is of a single actuator; leave it out for a whole robot");
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
    no_such_joint(option, name, names);
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
  expect_renames(renamed, out.joints, arguments.recordings);
  for (const std::string& one : arguments.recordings)
    out.logs.push_back(robot::read_robot_log(one, out.joints, renamed));
  for (const std::string& one : arguments.held_out)
    out.held_out.push_back(robot::read_robot_log(one, out.joints, renamed));
  return out;
}

// Checks before anything is read that the outputs can be written, and that no file is named twice.
void expect(io::OutputFiles& outputs, const std::vector<const std::string*>& files,
            const Arguments& arguments) {
  std::vector<std::string> taken = arguments.recordings;
  taken.insert(taken.end(), arguments.held_out.begin(), arguments.held_out.end());
  taken.push_back(robot_path(arguments));
  for (const std::string* output : files) {
    if (output->empty()) continue;
    for (const std::string& other : taken)
      if (*output != "-" && plain_path(*output) == plain_path(other))
        throw UsageError("'" + *output +
                         "' is named twice; an output must not be an input or another output");
    outputs.expect(*output);
    taken.push_back(*output);
  }
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
  refuse_options_of_one(arguments);
  if (!arguments.report.empty())
    throw UsageError("--report: the check of a robot's wiring is printed and not written; leave it out");
  robot::Wiring wiring;
  {
    Progress progress;
    const Loaded loaded = load(arguments, asked);
    progress.stage("checking");
    const robot::Log log = robot::together(loaded.logs);
    if (robot::make_series(log).rows() == 0) {
      std::printf("The log is too short for any statement: %td rows; expected a run of at least %td.\n",
                  log.rows(), robot::SmoothingOptions().fewest_rows);
      return too_little_data;
    }
    wiring = robot::check_wiring(*loaded.body, loaded.joints, log);
  }
  for (const robot::WiringFinding& one : wiring.findings) std::printf("Wiring: %s.\n", one.text.c_str());
  if (wiring.findings.empty())
    std::puts("The wiring is sound: joints, signs, units, zeros and gains fit each other.");
  return made;
}

int diagnose_robot(const Arguments& arguments, const RobotArguments& asked) {
  refuse_options_of_one(arguments);
  const std::string& path = robot_path(arguments);
  const std::vector<const std::string*> files{&arguments.report, &arguments.html, &arguments.augmented,
                                              &asked.isaac,      &asked.mjlab,    &asked.newton,
                                              &asked.ranges};
  io::OutputFiles outputs;
  expect(outputs, files, arguments);
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
  expect(outputs, {&arguments.report}, arguments);
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
