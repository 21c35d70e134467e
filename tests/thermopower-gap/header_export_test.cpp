// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Every effect of the catalogue, and effects that only this test knows, as firmware: the exported header is
// compiled, for the chip too, and follows the simulation on random inputs.

#include "../catch.hpp"

#include "expression_text.hpp"
#include "own_effects.hpp"
#include <thermopower/io/header_export.hpp>

#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/derivative.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace thermopower::gap;
namespace io = thermopower::io;
using namespace thermopower::plant;
namespace fs = std::filesystem;

namespace {

const Catalogue& catalogue() {
  static const Catalogue all = [] {
    Catalogue with_own = standard_catalogue();
    with_own.add<own_effects::HeatPipe>();
    with_own.add<own_effects::Paddle>();
    with_own.add<own_effects::Rounded>();
    return with_own;
  }();
  return all;
}

/// One model to export, and how far the firmware may be from the simulation.
struct Trial {
  std::string name;
  std::map<std::string, EffectParameters> effects;
  bool axis = false;
  double resistance_ohm = 0.0;  ///< of a motor at a voltage
};

/// The parameters of a curve that goes with u^3, u from -1 at its first knot to 1 at its last.
EffectParameters knots(const std::string& of_variable, double from, double to, const std::string& unit,
                       double size) {
  EffectParameters list{{"from_" + of_variable, from}, {"to_" + of_variable, to}};
  for (int i = 0; i < 10; ++i) list[unit + "_" + std::to_string(i + 1)] = size * std::pow(i / 4.5 - 1.0, 3.0);
  return list;
}

/// Values at which each effect shows in the recordings of this test.
std::vector<Trial> trials() {
  return {
      {"none", {}},
      {"second_thermal_mass", {{"second_thermal_mass", {{"winding_share", 0.2}, {"coupling", 0.8}}}}},
      {"radiation", {{"radiation", {{"emissive_area_m2", 0.02}}}}},
      {"natural_convection", {{"natural_convection", {{"exponent", 0.3}, {"reference_K", 20.0}}}}},
      {"forced_airflow", {{"forced_airflow", {{"gain", 0.6}, {"exponent", 0.7}}}}},
      {"ambient_bias", {{"ambient_bias", {{"bias_K", 6.0}}}}},
      {"neighbour_heating", {{"neighbour_heating", {{"coupling", 0.08}}}}},
      {"motion_heating", {{"motion_heating", {{"W_s2_per_rad2", 0.05}}}}},
      {"idle_heat", {{"idle_heat", {{"W", 3.0}}}}},
      {"iron_loss", {{"iron_loss", {{"hysteresis_W_s_per_rad", 0.1}, {"eddy_W_s2_per_rad2", 0.03}}}}},
      {"thermometer_lag", {{"thermometer_lag", {{"lag_s", 25.0}}}}},
      {"thermometer_gain", {{"thermometer_gain", {{"gain", 0.8}}}}},
      {"supply_power_heating", {{"supply_power_heating", {{"share", 0.7}}}}},
      {"supply_sag", {{"supply_sag", {{"internal_ohm", 1.5}, {"V_per_Ah", 20.0}}}}},
      {"series_resistance", {{"series_resistance", {{"ohm", 2.0}}}}},
      {"dead_time", {{"dead_time", {{"duty_lost", 0.1}}}}},
      {"back_emf", {{"back_emf", {{"V_s_per_rad", 0.2}}}}},
      {"current_sensor_offset", {{"current_sensor_offset", {{"A", 0.2}}}}},
      {"current_sensor_gain", {{"current_sensor_gain", {{"gain", 1.3}}}}},
      {"winding_tempco", {{"winding_tempco", {{"tempco_per_K", 0.004}}}}},
      {"heat_pipe", {{"heat_pipe", {{"W_per_K", 0.15}, {"starts_at_C", 28.0}}}}},
      {"several_of_the_bench",
       {{"radiation", {{"emissive_area_m2", 0.01}}},
        {"natural_convection", {{"exponent", 0.2}, {"reference_K", 20.0}}},
        {"forced_airflow", {{"gain", 0.3}, {"exponent", 0.6}}},
        {"ambient_bias", {{"bias_K", -3.0}}},
        {"supply_sag", {{"internal_ohm", 0.8}, {"V_per_Ah", 5.0}}},
        {"dead_time", {{"duty_lost", 0.05}}},
        {"series_resistance", {{"ohm", 1.0}}},
        {"winding_tempco", {{"tempco_per_K", 0.002}}},
        {"neighbour_heating", {{"coupling", 0.03}}},
        {"heat_pipe", {{"W_per_K", 0.1}, {"starts_at_C", 28.0}}}}},
      {"rigid", {}, true},
      {"coulomb_friction", {{"coulomb_friction", {{"Nm", 0.01}, {"transition_rad_per_s", 0.2}}}}, true},
      {"coulomb_friction_with_a_tail",
       {{"coulomb_friction", {{"Nm", 0.01}, {"transition_rad_per_s", 0.2}, {"tail", 0.6}}}},
       true},
      {"asymmetric_friction",
       {{"asymmetric_friction",
         {{"forward_Nm", 0.004}, {"backward_Nm", 0.012}, {"transition_rad_per_s", 0.2}}}},
       true},
      {"stribeck_friction",
       {{"stribeck_friction",
         {{"Nm", 0.005}, {"rise_Nm", 0.008}, {"knee_rad_per_s", 0.5}, {"transition_rad_per_s", 0.2}}}},
       true},
      {"load_friction", {{"load_friction", {{"share", 0.3}, {"transition_rad_per_s", 0.2}}}}, true},
      {"drive_efficiency",
       {{"drive_efficiency", {{"efficiency", 0.8}, {"back_efficiency", 0.5}, {"transition_rad_per_s", 0.2}}}},
       true},
      {"load_friction_under_a_load",
       {{"load_friction", {{"share", 0.3}, {"transition_rad_per_s", 0.2}}},
        {"imbalance", {{"Nm", 0.03}, {"phase_rad", 0.4}}}},
       true},
      {"drive_deadband", {{"drive_deadband", {{"A", 0.05}}}}, true},
      {"imbalance", {{"imbalance", {{"Nm", 0.03}, {"phase_rad", 0.4}}}}, true},
      {"cable_spring", {{"cable_spring", {{"Nm_per_rad", 0.01}, {"centre_rad", 0.3}}}}, true},
      {"cogging", {{"cogging", {{"sin_Nm", 0.01}, {"cos_Nm", 0.004}, {"cycles_per_turn", 7.0}}}}, true},
      {"cogging_with_a_second_harmonic",
       {{"cogging",
         {{"sin_Nm", 0.01},
          {"cos_Nm", 0.004},
          {"cycles_per_turn", 7.0},
          {"second_sin", 0.4},
          {"second_cos", -0.3}}}},
       true},
      {"compliance", {{"compliance", {{"far_share", 0.4}, {"frequency_Hz", 9.0}, {"damping", 0.05}}}}, true},
      {"actuation_delay", {{"actuation_delay", {{"s", 0.023}}}}, true},
      {"backlash",
       {{"backlash", {{"gap_rad", 0.3}, {"far_share", 0.4}, {"contact_Hz", 6.0}, {"damping", 0.2}}}},
       true},
      {"stribeck_friction_of_another_exponent",
       {{"stribeck_friction",
         {{"Nm", 0.005},
          {"rise_Nm", 0.008},
          {"knee_rad_per_s", 0.5},
          {"transition_rad_per_s", 0.2},
          {"exponent", 1.3}}}},
       true},
      {"servo_delay", {{"servo_delay", {{"s", 0.023}}}}, true},
      {"quadratic_drag", {{"quadratic_drag", {{"Nm_s2_per_rad2", 4e-4}}}}, true},
      {"unknown_load", {{"unknown.load(angle_deg)", knots("deg", -60.0, 60.0, "Nm", -0.03)}}, true},
      {"unknown_friction", {{"unknown.friction(rate_dps)", knots("dps", -900.0, 900.0, "Nm", 0.03)}}, true},
      {"unknown_drive", {{"unknown.drive(drive_A)", knots("A", -0.3, 0.3, "A", -0.1)}}, true},
      {"unknown_loss", {{"unknown.loss(rise_K)", knots("K", -10.0, 40.0, "W", 3.0)}}},
      {"unknown_heat", {{"unknown.heat(current_A)", knots("A", 0.0, 2.0, "W", 4.0)}}},
      {"unknown_voltage", {{"unknown.voltage(motor_C)", knots("C", 15.0, 60.0, "V", 1.0)}}},
      {"torque_saturation", {{"torque_saturation", {{"A", 0.1}}}}, true},
      {"torque_fade", {{"torque_fade", {{"per_K", 0.004}}}}, true},
      {"angle_scale", {{"angle_scale", {{"gain", -1.7}}}}, true},
      {"angle_bias_drift", {{"angle_bias_drift", {{"deg_per_s", 4.0}}}}, true},
      {"rate_bias", {{"rate_bias", {{"dps", 9.0}}}}, true},
      {"constant_torque", {{"constant_torque", {{"Nm", 0.02}}}}, true},
      {"asymmetric_viscous",
       {{"asymmetric_viscous", {{"forward_Nms_per_rad", 1e-3}, {"backward_Nms_per_rad", 4e-3}}}},
       true},
      {"torque_ripple",
       {{"torque_ripple", {{"sin_share", 0.2}, {"cos_share", -0.1}, {"cycles_per_turn", 6.0}}}},
       true},
      {"warm_friction",
       {{"warm_friction", {{"per_K", 0.03}}},
        {"coulomb_friction", {{"Nm", 0.01}, {"transition_rad_per_s", 0.2}}}},
       true},
      {"drive_lag", {{"drive_lag", {{"lag_s", 0.06}}}}, true},
      {"presliding_friction",
       {{"presliding_friction", {{"Nm", 0.02}, {"bend_rad", 0.05}, {"damping_s", 0.002}}}},
       true},
      {"drive_lag_under_load_friction_and_presliding",
       {{"drive_lag", {{"lag_s", 0.06}}},
        {"load_friction", {{"share", 0.3}, {"transition_rad_per_s", 0.2}}},
        {"imbalance", {{"Nm", 0.03}, {"phase_rad", 0.4}}},
        {"presliding_friction", {{"Nm", 0.02}, {"bend_rad", 0.05}, {"damping_s", 0.0}}}},
       true},
      {"at_a_voltage", {}, true, 0.5},
      {"at_a_voltage_with_fade_and_lag",
       {{"torque_fade", {{"per_K", 0.004}}},
        {"drive_lag", {{"lag_s", 0.06}}},
        {"load_friction", {{"share", 0.3}, {"transition_rad_per_s", 0.2}}}},
       true,
       0.5},
      {"paddle", {{"paddle", {{"drag", 2e-4}, {"bump_Nm", 0.01}}}}, true},
  };
}

Model model_of(const Trial& trial) {
  Model model;
  model.name = trial.name;
  if (trial.axis) model.axis = RigidAxisModel{1e-3, 2e-3, 0.2, trial.resistance_ohm};
  else {
    model.supply = SupplyModel{12.0};
    model.current = OhmicCurrentModel{6.0, 0.002, 25.0};
    model.thermal = LumpedThermalModel{40.0, 0.15};
  }
  model.effects = trial.effects;
  return model;
}

/// Random inputs that hold for a row each.
Inputs inputs_of(bool axis, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const Eigen::Index rows = axis ? 60 : 80;
  Inputs inputs;
  inputs.name = "random";
  inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, (axis ? 0.05 : 5.0) * static_cast<double>(rows - 1));
  inputs.runs = {{0, rows, ""}};
  const auto column = [&](double low, double high) {
    Eigen::VectorXd values(rows);
    for (Eigen::Index i = 0; i < rows; ++i) values[i] = low + (high - low) * share(random);
    return values;
  };
  inputs.power_param = column(0.0, 255.0);
  for (Eigen::Index i = 0; i < rows; ++i)
    if (share(random) < 0.2) inputs.power_param[i] = 0.0;
  inputs.drive_A = column(-0.3, 0.3);
  inputs.voltage_V = inputs.drive_A;
  inputs.supply_V = column(11.0, 13.0);
  inputs.ambient_C = column(18.0, 24.0);
  inputs.airspeed_mps = column(0.0, 3.0);
  inputs.neighbour_C = column(20.0, 60.0);
  inputs.covariate_rate_dps = column(-900.0, 900.0);
  inputs.covariate_motor_C = column(20.0, 80.0);
  inputs.heat = HeatSource::law;
  return inputs;
}

/// What the simulation's instruments show: first and second signal by row.
struct Shown {
  std::vector<double> first, second;
};

Shown simulated(const Trial& trial, const Inputs& inputs) {
  const Model model = model_of(trial);
  const Instance<double> instance(model, {}, {}, catalogue());
  Shown shown;
  if (trial.axis) {
    const AxisRollout<double> rollout(instance, inputs);
    AxisState<double> state = rollout.start(0, 0.0, 10.0, 0.0);
    rollout.window(inputs.runs[0], 0, inputs.rows(), state,
                   [&](Eigen::Index, const AxisReadings<double>& read) {
                     shown.first.push_back(read.angle_deg);
                     shown.second.push_back(read.rate_dps);
                   });
  } else {
    const BenchRollout<double> rollout(instance, inputs);
    BenchState<double> state = rollout.start(0, 26.0);
    rollout.run(0, inputs.rows(), 0.0, state, [&](Eigen::Index, const BenchReadings<double>& read) {
      shown.first.push_back(read.current_A);
      shown.second.push_back(read.motor_C);
    });
  }
  return shown;
}

std::string array(const std::string& name, const std::vector<double>& values) {
  std::ostringstream text;
  text.precision(17);
  text << "const double " << name << "[] = {";
  for (const double value : values) text << value << ", ";
  text << "};\n";
  return text.str();
}

std::string rows_text(const Inputs& inputs) {
  std::ostringstream text;
  text.precision(17);
  text << "const Row rows[] = {\n";
  for (Eigen::Index i = 0; i < inputs.rows(); ++i)
    text << "{" << inputs.t_s[i] << ", " << inputs.power_param[i] << ", " << inputs.supply_V[i] << ", "
         << inputs.ambient_C[i] << ", " << inputs.airspeed_mps[i] << ", " << inputs.neighbour_C[i] << ", "
         << inputs.covariate_rate_dps[i] << ", " << inputs.drive_A[i] << ", " << inputs.covariate_motor_C[i]
         << "},\n";
  text << "};\nconst int count = " << inputs.rows() << ";\n";
  return text.str();
}

/// Largest distances between firmware and simulation, of the first and the second signal.
struct Distance {
  double first = 0.0, second = 0.0;
};

}  // namespace

TEST_CASE("every effect, the user's own too, writes itself as firmware that does what the simulation does") {
  const fs::path folder = fs::temp_directory_path() / "thermopower_export_effects";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const Inputs bench = inputs_of(false, 1), axis = inputs_of(true, 2);
  std::ofstream program(folder / "firmware.cpp");
  std::ofstream chip(folder / "chip.cpp");
  program << "#include <thermopower/thermopower.hpp>\n#include \"exported_firmware.hpp\"\nnamespace bench {\n"
          << rows_text(bench) << "}\nnamespace axis {\n"
          << rows_text(axis) << "}\n";
  chip << "#include <thermopower/thermopower.hpp>\n#include <math.h>\n";
  std::string calls;
  const std::vector<Trial> all = trials();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Trial& trial = all[i];
    CAPTURE(trial.name);
    const io::MotorModelHeader header = io::motor_model_header(model_of(trial), "a test", catalogue());
    CHECK(header.left_out.empty());
    std::ofstream(folder / (trial.name + ".hpp")) << header.text;
    const Shown shown = simulated(trial, trial.axis ? axis : bench);
    const std::string place = "trial_" + std::to_string(i);
    program << "namespace " << place << " {\n#include \"" << trial.name << ".hpp\"\n"
            << array("first", shown.first) << array("second", shown.second) << "}\n";
    chip << "namespace " << place << " {\n#include \"" << trial.name << ".hpp\"\n}\n";
    calls += std::string("  run_") + (trial.axis ? "axis" : "bench") + "<" + place +
             "::motor_model::Motor>(" + (trial.axis ? "axis" : "bench") + "::rows, " +
             (trial.axis ? "axis" : "bench") + "::count, " + place + "::first, " + place + "::second);\n";
  }
  program << "int main() {\n" << calls << "  return 0;\n}\n";
  program.close();
  chip.close();

  const std::string quoted = "'" + folder.string() + "'";
  const std::string flags = " -I'" THERMOPOWER_INCLUDE "' -I'" THERMOPOWER_TESTS_HERE "' ";
  REQUIRE(std::system(("cd " + quoted + " && c++ -std=gnu++11 -O1 -Wall -Wextra -Werror" + flags +
                       "firmware.cpp -o firmware && ./firmware > out.txt")
                          .c_str()) == 0);
  if (std::system("avr-gcc --version > /dev/null 2>&1") == 0)
    CHECK(
        std::system(("cd " + quoted + " && avr-gcc -std=gnu++11 -mmcu=atmega328p -Os -Wall -Wextra -Werror" +
                     flags + "-c chip.cpp -o chip.o")
                        .c_str()) == 0);

  std::ifstream out(folder / "out.txt");
  for (const Trial& trial : all) {
    CAPTURE(trial.name);
    const Inputs& inputs = trial.axis ? axis : bench;
    Trial without = trial;
    without.effects.clear();
    const Shown plain = simulated(without, inputs);
    Distance apart, effect;
    for (std::size_t row = 0; row < static_cast<std::size_t>(inputs.rows()); ++row) {
      double first, first_truth, second, second_truth;
      REQUIRE(out >> first >> first_truth >> second >> second_truth);
      apart.first = std::max(apart.first, std::abs(first - first_truth));
      apart.second = std::max(apart.second, std::abs(second - second_truth));
      const Shown& shown = plain;
      effect.first = std::max(effect.first, std::abs(shown.first[row] - first_truth));
      effect.second = std::max(effect.second, std::abs(shown.second[row] - second_truth));
    }
    // The firmware's float and its own steps: 0.03 K and 2 mA, 0.1 degrees and 0.5 deg/s of some hundred.
    CHECK(apart.first < (trial.axis ? 0.1 : 0.002));
    CHECK(apart.second < (trial.axis ? 0.5 : 0.03));
    // And the effect is there to be got wrong. A sensor's error leaves the motor alone.
    const bool sensor = trial.name.find("sensor") != std::string::npos || trial.name == "thermometer_gain" ||
                        trial.name == "angle_scale" || trial.name == "angle_bias_drift" ||
                        trial.name == "rate_bias";
    if (!trial.effects.empty() && !sensor)
      CHECK((effect.first > 10.0 * (trial.axis ? 0.1 : 0.002) ||
             effect.second > 10.0 * (trial.axis ? 0.5 : 0.03)));
  }
  fs::remove_all(folder);
}

TEST_CASE("an equation that cannot be followed is listed, with its constants, and the rest is written") {
  Trial trial{"rounded", {{"rounded", {{"step_V", 0.5}}}, {"dead_time", {{"duty_lost", 0.1}}}}};
  const io::MotorModelHeader header = io::motor_model_header(model_of(trial), "a test", catalogue());
  REQUIRE(header.left_out.size() == 1);
  CHECK(header.left_out[0].rfind("rounded: ", 0) == 0);
  CHECK(header.text.find("// Left out: rounded: ") != std::string::npos);
  CHECK(header.text.find("static float rounded_step_V() { return 0.5f; }") != std::string::npos);
  CHECK(header.text.find("duty - 0.1f") != std::string::npos);
}

TEST_CASE("nodes that firmware's types do not have are listed, with their constants") {
  for (const Trial& trial :
       {Trial{"soaking", {{"third_thermal_mass", {{"share", 0.4}, {"coupling", 0.1}}}}},
        Trial{"boxed", {{"enclosure", {{"share", 0.8}, {"W_per_K", 0.25}}}}},
        Trial{"bolted", {{"contact_resistance", {{"J_per_K", 90.0}, {"K_per_W", 4.0}, {"W_per_K", 0.2}}}}}}) {
    const io::MotorModelHeader header = io::motor_model_header(model_of(trial), "a test", catalogue());
    REQUIRE(header.left_out.size() == 1);
    CHECK(header.left_out[0].find("winding and surface") != std::string::npos);
    for (const auto& [id, parameters] : trial.effects)
      for (const auto& parameter : parameters)
        CHECK(header.text.find("static float " + id + "_" + parameter.first + "()") != std::string::npos);
  }
}

TEST_CASE("a reading that bends is listed, and an exchanged law is written as it is") {
  const Trial bent{"bent",
                   {{"encoder_eccentricity", {{"sin_deg", 1.0}, {"cos_deg", 0.5}, {"cycles_per_turn", 2.0}}}},
                   true};
  const io::MotorModelHeader header = io::motor_model_header(model_of(bent), "a test", catalogue());
  REQUIRE(header.left_out.size() == 1);
  CHECK(header.left_out[0].rfind("encoder_eccentricity: ", 0) == 0);
  CHECK(header.text.find("static float encoder_eccentricity_sin_deg() { return 1.0f; }") !=
        std::string::npos);
  CHECK(header.text.find("true_angle_deg") == std::string::npos);

  Model law;
  law.name = "law";
  law.supply = SupplyModel{12.0};
  law.thermal = ThesisThermalModel{0.05, 0.0, 0.2435, 0.125, -0.5, 1.0};
  law.effects["law.exchanged_heating"] = {};
  const io::MotorModelHeader exchanged = io::motor_model_header(law, "a test", catalogue());
  CHECK(exchanged.left_out.empty());
  CHECK(exchanged.text.find("per_minute(0.0f, 0.125f, 0.2435f, -0.5f, 1.0f)") != std::string::npos);
}

TEST_CASE(
    "a target that comes late is a constant of the header, and its torques are those of the axis alone") {
  const Trial late{"late", {{"target_delay", {{"s", 0.023}}}}, true};
  const io::MotorModelHeader header = io::motor_model_header(model_of(late), "a test", catalogue());
  CHECK(header.left_out.empty());
  CHECK(header.text.find("static float target_delay_s() { return 0.023f; }") != std::string::npos);
  CHECK(header.text.find("static float delay_s()") == std::string::npos);
}

TEST_CASE("there is a trial for every effect of the catalogue") {
  // These are above: they do not write themselves, have no parameters, or act on a servo that firmware brings itself.
  std::set<std::string> tried{"third_thermal_mass",    "enclosure",
                              "contact_resistance",    "encoder_eccentricity",
                              "law.exchanged_heating", "target_delay"};
  for (const Trial& trial : trials())
    for (const auto& effect : trial.effects) tried.insert(effect.first);
  for (const EffectInfo& info : standard_catalogue().list()) {
    CAPTURE(info.id);
    CHECK(tried.count(info.id) == 1);
  }
}

TEST_CASE("an expression keeps each step once, folds constants, follows branches and differentiates itself") {
  Trace trace;
  const Expression x = trace.symbol("x"), y = trace.symbol("y");
  CHECK((x * y).node() == (x * y).node());
  CHECK((x + 0.0).node() == x.node());
  CHECK((x * 0.0).is_constant());
  CHECK((x - x).is_constant());
  CHECK(io::expression_text(Expression(2.0) * (x + y), io::Spelling::firmware) == "2.0f * (x + y)");
  CHECK(io::expression_text(x - (y - 1.0), io::Spelling::formula) == "x - (y - 1)");
  CHECK(io::expression_text(x / (y * x), io::Spelling::firmware) == "x / (y * x)");
  const auto joined = trace.every_branch([&] {
    Expression result = x;
    if (x > 0.0) result = y;
    else if (y > 1.0) result = -x;
    return std::vector<Expression>{result};
  });
  CHECK(io::expression_text(joined[0], io::Spelling::firmware) == "0.0f < x ? y : 1.0f < y ? -x : x");
  CHECK(io::expression_text(derivative(x * x * y, x), io::Spelling::firmware) == "(x + x) * y");
  const auto endless = [&] {
    Expression sum = x;
    for (int i = 0; i < 40; ++i)
      if (sum > static_cast<double>(i)) sum += y;
    return std::vector<Expression>{sum};
  };
  CHECK_THROWS_AS(trace.every_branch(endless), NotTraceable);
}
