// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "command.hpp"
#include "command_options.hpp"
#include "program.hpp"
#include "robot_file.hpp"

#include <thermopower/io.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

/// A constant of the model that may be asked for.
struct Question {
  const char* option;
  const char* question;
  const char* usual;  ///< what is taken where nothing is known; empty: it must be said
};

constexpr Question of_a_motor[] = {
    {"--supply", "supply, V", "12"},
    {"--resistance", "winding resistance at 25 degC, ohm", ""},
    {"--heat-capacity", "heat capacity of the motor, J/K (450 J/K a kilogram does for a start)", ""},
    {"--conductance", "heat that it loses to the air, W/K (0.1 for a motor of 100 g)", ""}};
constexpr Question of_a_heater[] = {
    {"--supply", "supply, V", "24"},
    {"--heater-power", "power of the heater at that supply, W", ""},
    {"--heat-capacity", "heat capacity of what it warms, J/K (12 for a hotend's block, 600 for a bed)", ""},
    {"--conductance", "heat that this loses to the air, W/K (0.1 for a hotend, 1 for a bed)", ""}};
constexpr Question of_a_joint[] = {
    {"--inertia", "inertia that turns with the joint, kg m^2", ""},
    {"--viscous", "viscous friction, N m s/rad", "0.001"},
    {"--torque-constant", "torque constant at the joint, N m/A (gear ratio times the motor's)", ""}};

struct Description {
  std::string file, joint, out, name, loop;
  std::vector<double> gains;  ///< of a PID: kp, ki, kd, as the printer's configuration has them
  std::map<std::string, std::optional<double>> constants;
  std::optional<double> value(const char* option) const {
    const auto found = constants.find(option);
    return found == constants.end() ? std::nullopt : found->second;
  }
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value + 0.0);
  return text;
}

// A line of an answer. Where there is none, what follows begins a line of its own.
bool answered(std::string& line) {
  if (std::getline(std::cin, line)) return true;
  std::fputs("\n", stderr);
  return false;
}

// Asks at a terminal, or reads the answers from a pipe, one a line.
double ask(const Question& question) {
  for (;;) {
    std::fprintf(stderr, "%s%s%s%s: ", question.question, question.usual[0] != '\0' ? " [" : "",
                 question.usual, question.usual[0] != '\0' ? "]" : "");
    std::string line;
    if (!answered(line))
      throw UsageError(std::string("init: no answer to '") + question.question + "'; " + question.option +
                       " gives it");
    if (line.empty()) line = question.usual;
    char* end = nullptr;
    const double value = std::strtod(line.c_str(), &end);
    if (!line.empty() && *end == '\0' && std::isfinite(value)) return value;
    if (isatty(STDIN_FILENO) == 0)
      throw UsageError(std::string("init: ") + io::excerpt(line) + " is not an answer to '" +
                       question.question + "'; expected a number");
    std::fputs("a number is expected\n", stderr);
  }
}

template <std::size_t count>
void ask_all(const Question (&questions)[count], Description& asked) {
  for (const Question& one : questions)
    if (!asked.value(one.option)) asked.constants[one.option] = ask(one);
}

template <std::size_t count>
bool knows_any(const Question (&questions)[count], const Description& asked) {
  for (const Question& one : questions)
    if (asked.value(one.option) && std::string(one.option) != "--supply") return true;
  return false;
}

// A heater is told from a motor by what only a heater has.
bool is_heater(const Description& asked) {
  return asked.value("--heater-power") || !asked.loop.empty() || !asked.gains.empty() ||
         asked.value("--band") || asked.value("--max-power");
}

template <std::size_t count>
void expect_all(const Question (&questions)[count], Description& asked) {
  std::string missing;
  for (const Question& one : questions) {
    if (asked.value(one.option)) continue;
    if (one.usual[0] != '\0') asked.constants[one.option] = std::strtod(one.usual, nullptr);
    else missing += (missing.empty() ? "" : ", ") + std::string(one.option);
  }
  if (!missing.empty())
    throw UsageError(
        "init: " + missing +
        " missing; expected all constants of a motor, a heater or a joint, or none, and then they are asked for");
}

std::string json_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\') out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) >= 0x20) out += c;
  return out + "\"";
}

// The blocks of a model, each with the comments above it.
std::string motor_blocks(const Description& asked) {
  return " // The supply's voltage, where a recording has no column supply_V.\n \"supply\": {\"nominal_V\": " +
         number(*asked.value("--supply")) +
         "},\n // I = V / R, at reference_C. tempco_per_K: 0.00393 is copper's; 0 is a simulation that ignores it.\n"
         " // \"uncertainty\" says how well a constant is known, as a share of it; 0.05 where nothing is said.\n"
         " \"current\": {\"law\": \"ohmic\", \"resistance_ohm\": " +
         number(*asked.value("--resistance")) +
         ", \"tempco_per_K\": " + number(asked.value("--tempco").value_or(0.0)) +
         ", \"reference_C\": 25,\n  \"uncertainty\": {\"resistance_ohm\": 0.05}},\n"
         " // C dT/dt = heat - G (T - T_air).\n \"thermal\": {\"law\": \"lumped\", \"heat_capacity_J_per_K\": " +
         number(*asked.value("--heat-capacity")) +
         ", \"conductance_W_per_K\": " + number(*asked.value("--conductance")) +
         ",\n  \"uncertainty\": {\"heat_capacity_J_per_K\": 0.2, \"conductance_W_per_K\": 0.3}}";
}

// The heater's resistance from its power. Its constants then stand where a motor's do.
void take_heater(Description& asked) {
  if (asked.value("--resistance"))
    throw UsageError(
        "init: --resistance beside --heater-power; expected one of them, the other follows from it");
  const double supply_V = *asked.value("--supply"), power_W = *asked.value("--heater-power");
  if (!(power_W > 0.0))
    throw UsageError("init: --heater-power: is " + number(power_W) + "; expected a number above 0");
  asked.constants["--resistance"] = supply_V * supply_V / power_W;
}

// The loop that sets the heater's power, for recordings that hold target_C and no power.
std::string loop_block(const Description& asked) {
  const bool is_pid = asked.loop == "klipper_pid" || asked.loop == "marlin_pid";
  if (is_pid && asked.gains.empty())
    throw UsageError(
        "init: --gains missing; expected three numbers, P, I and D of the printer's configuration");
  if (!is_pid && !asked.gains.empty())
    throw UsageError(
        "init: --gains without a PID; expected --loop klipper_pid or --loop marlin_pid beside it");
  if (is_pid && asked.value("--band"))
    throw UsageError("init: --band beside a PID; expected --loop bang_bang beside it");
  if (asked.loop.empty()) {
    if (asked.value("--band") || asked.value("--max-power"))
      throw UsageError("init: --loop missing; expected klipper_pid, marlin_pid or bang_bang");
    return {};
  }
  const double max_power = asked.value("--max-power").value_or(1.0);
  if (!(max_power > 0.0 && max_power <= 1.0))
    throw UsageError("init: --max-power: is " + number(max_power) + "; expected a share above 0 to 1");
  std::string out =
      ",\n // The loop of the heater, for recordings that hold target_C and no power.\n \"heater\": {\"law\": \"" +
      asked.loop + "\"";
  if (is_pid)
    out += ", \"kp_per_K\": " + number(asked.gains[0]) + ", \"ki_per_K_s\": " + number(asked.gains[1]) +
           ", \"kd_s_per_K\": " + number(asked.gains[2]);
  else out += ", \"max_delta_K\": " + number(asked.value("--band").value_or(2.0));
  return out + ", \"max_power\": " + number(max_power) + "}";
}

std::string joint_blocks(const Description& asked, const RobotJoint* robot) {
  std::string out;
  if (robot != nullptr) {
    out += " // Joint " + robot->name + ", with all joints behind it held at 0.\n";
    for (const std::string& remark : robot->remarks) out += " // " + remark + ".\n";
  }
  out += " // J dw/dt = Kt I - b w, in kg m^2, N m s/rad and N m/A, all at the joint.\n";
  const double constant = *asked.value("--torque-constant");
  if (robot != nullptr && robot->Nm_per_command && constant == *robot->Nm_per_command)
    out += " // The torque constant is the motor's gear: drive_A is its command as the simulation has it.\n";
  else if (robot != nullptr && constant == 1.0)
    out +=
        " // The file has no torque constant: with 1, drive_A is the drive's torque in N m (--column drive_A=effort:A).\n";
  out +=
      " \"axis\": {\"law\": \"rigid\", \"inertia_kgm2\": " + number(*asked.value("--inertia")) +
      ", \"viscous_Nms_per_rad\": " + number(*asked.value("--viscous")) +
      ", \"torque_constant_Nm_per_A\": " + number(constant) +
      ",\n  \"uncertainty\": {\"inertia_kgm2\": 0.1, \"viscous_Nms_per_rad\": 0.5, \"torque_constant_Nm_per_A\": 0.05}}";
  if (robot == nullptr) return out;
  if (robot->kp_Nm_per_rad) {
    constexpr double rad_per_deg = 0.017453292519943295;
    out +=
        ",\n // The position servo of the file, for recordings that hold target_deg and no command.\n"
        " \"servo\": {\"law\": \"position_pid\", \"kp_A_per_deg\": " +
        number(*robot->kp_Nm_per_rad * rad_per_deg / constant) +
        ", \"kd_A_s_per_deg\": " + number(robot->kd_Nms_per_rad * rad_per_deg / constant) +
        ", \"limit_A\": " + number(robot->limit_Nm.value_or(1e3 * constant) / constant) +
        ", \"period_s\": " + number(robot->step_s) + "}";
  }
  std::string effects;
  if (robot->coulomb_Nm > 0.0) effects += "\"coulomb_friction\": {\"Nm\": " + number(robot->coulomb_Nm) + "}";
  constexpr double least_Nm = 1e-6;
  if (robot->gravity_Nm > least_Nm)
    effects += (effects.empty() ? "" : ",\n  ") + std::string("\"imbalance\": {\"Nm\": ") +
               number(robot->gravity_Nm) + ", \"phase_rad\": " + number(robot->gravity_phase_rad) + "}";
  if (!effects.empty())
    out +=
        ",\n // What the simulation has besides: dry friction, and gravity on what the joint carries: torque -= Nm sin(angle + phase).\n"
        " \"effects\": {" +
        effects + "}";
  return out;
}

// Where the constants of the options stand in the model.
constexpr struct {
  const char *place, *option;
} places[] = {{"/supply/nominal_V", "--supply"},
              {"/current/resistance_ohm", "--resistance"},
              {"/current/tempco_per_K", "--tempco"},
              {"/thermal/heat_capacity_J_per_K", "--heat-capacity"},
              {"/thermal/conductance_W_per_K", "--conductance"},
              {"/heater/kp_per_K", "--gains"},
              {"/heater/ki_per_K_s", "--gains"},
              {"/heater/kd_s_per_K", "--gains"},
              {"/heater/max_delta_K", "--band"},
              {"/axis/inertia_kgm2", "--inertia"},
              {"/axis/viscous_Nms_per_rad", "--viscous"},
              {"/axis/torque_constant_Nm_per_A", "--torque-constant"}};

// What is written must be what the reader takes: a wrong answer is told here, with the option's name.
void expect_model(const Description& asked, const std::string& text) {
  try {
    io::parse_model(asked.out.empty() ? "model" : asked.out, text, gap::standard_catalogue());
  } catch (const io::InputError& error) {
    const std::string what = error.what();
    for (const auto& one : places) {
      const std::string place = std::string(one.place) + ": ";
      const std::size_t at = what.find(place);
      if (at == std::string::npos) continue;
      const std::size_t begin = at + place.size();
      throw UsageError(std::string("init: ") + one.option + ": " +
                       what.substr(begin, what.rfind(" (line ") - begin));
    }
    throw;
  }
}

int init(Description& asked) {
  io::OutputFiles outputs;
  if (!asked.out.empty()) outputs.expect(asked.out);
  std::optional<RobotJoint> robot;
  if (!asked.file.empty()) {
    robot = read_robot_joint(asked.file, asked.joint);
    const auto take = [&](const char* option, double value) {
      if (!asked.value(option)) asked.constants[option] = value;
    };
    take("--inertia", robot->inertia_kgm2);
    take("--viscous", robot->viscous_Nms_per_rad);
    take("--torque-constant", robot->Nm_per_command.value_or(1.0));
  }
  bool heater = is_heater(asked), joint = knows_any(of_a_joint, asked),
       motor = !heater && knows_any(of_a_motor, asked);
  if (heater && joint)
    throw UsageError("init: options of a heater and of a joint; expected those of one of them");
  if (joint) expect_all(of_a_joint, asked);
  if (motor) expect_all(of_a_motor, asked);
  if (heater) expect_all(of_a_heater, asked);
  if (!joint && !motor && !heater) {
    std::fputs("What was recorded: 1 a motor that warms, 2 a joint that moves, 3 both, 4 a heater? ", stderr);
    std::string line;
    if (!answered(line) || line.size() != 1 || line[0] < '1' || line[0] > '4')
      throw UsageError(
          "init: expected 1, 2, 3 or 4, an MJCF or URDF file, or options such as --resistance, --inertia and "
          "--heater-power");
    heater = line == "4";
    motor = line == "1" || line == "3";
    joint = line == "2" || line == "3";
    if (motor) ask_all(of_a_motor, asked);
    if (joint) ask_all(of_a_joint, asked);
    if (heater) ask_all(of_a_heater, asked);
  }
  if (heater) take_heater(asked);
  std::string name = asked.name;
  if (name.empty()) name = robot ? robot->name : joint ? "joint" : heater ? "heater" : "motor";
  std::string text =
      "{\n // The simulation under test. Comments like this one are skipped.\n \"format\": \"thermopower-model/1\",\n \"name\": " +
      json_text(name) + ",\n";
  if (motor || heater)
    text += motor_blocks(asked) + (heater ? loop_block(asked) : std::string()) + (joint ? ",\n" : "\n");
  if (joint) text += joint_blocks(asked, robot ? &*robot : nullptr) + "\n";
  text += "}\n";
  expect_model(asked, text);
  if (asked.out.empty()) {
    std::fputs(text.c_str(), stdout);
  } else {
    outputs.put(asked.out, text);
    outputs.commit();
    std::printf("%s is written. Next: thermopower-gap columns RECORDING\n", asked.out.c_str());
  }
  return made;
}

}  // namespace

Command add_init(CLI::App& program) {
  const auto asked = std::make_shared<Description>();
  CLI::App* const app = program.add_subcommand(
      "init", "write a model file with comments: from MJCF or URDF, from options, or from a few questions");
  app->add_option("file", asked->file, "a robot (MJCF or URDF)");
  app->add_option("--joint", asked->joint, "name of the joint that is meant, where several turn");
  app->add_option("--out", asked->out, "where the model goes (JSON); without it to standard output");
  app->add_option("--name", asked->name, "of the model, as reports call it");
  const auto constant = [&](const char* option, const char* help) {
    app->add_option_function<double>(
           option, [asked, option](const double& value) { asked->constants[option] = value; }, help)
        ->check(a_number);
  };
  for (const Question& one : of_a_motor) constant(one.option, one.question);
  constant("--tempco",
           "how much of its resistance the winding gains a kelvin, 1/K: 0.00393 for copper, 0 without it");
  for (const Question& one : of_a_joint) constant(one.option, one.question);
  constant("--heater-power", "power of a heater at its supply, W; the model is that of a heater then");
  app->add_option("--loop", asked->loop, "the loop that sets a heater's power, for logs that hold none")
      ->check(CLI::IsMember({"klipper_pid", "marlin_pid", "bang_bang"}));
  app->add_option("--gains", asked->gains, "its P, I and D, as the printer's configuration has them")
      ->expected(3)
      ->check(a_number);
  constant("--band", "half the band of a bang_bang loop, K (2 without it)");
  constant("--max-power", "largest duty of the loop, above 0 to 1 (1 without it)");
  return {app, [asked] { return init(*asked); }};
}
