// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Recordings made with the library's own equations: what an engine must recover before it may judge others'.
namespace engine_fixture {

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

/// The same numbers with every standard library.
class Noise {
public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return (static_cast<double>(state_ >> 11) + 0.5) / 9007199254740992.0;
  }
  double normal() { return std::sqrt(-2.0 * std::log(uniform())) * std::cos(6.283185307179586 * uniform()); }

private:
  std::uint64_t state_;
};

inline Model bench_model() {
  Model model;
  model.name = "bench";
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{6.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.2};
  return model;
}

inline Model axis_model() {
  Model model;
  model.name = "axis";
  model.axis = RigidAxisModel{1e-3, 1e-3, 0.1};
  return model;
}

/// Power steps with rests, moving air, a neighbour and bursts of rotation; no outputs yet.
inline Recording bench_inputs(Eigen::Index rows, double dt_s, std::uint64_t seed, bool with_supply) {
  Noise noise(seed);
  Recording recording;
  recording.name = "bench";
  recording.t_s.resize(rows);
  Eigen::VectorXd power(rows), ambient(rows), air(rows), neighbour(rows), rate(rows), supply(rows);
  double level = 150.0, wind = 0.0, near = 40.0, speed = 0.0;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (row % 25 == 0) level = std::floor(noise.uniform() * 6.0) * 50.0;
    if (row % 60 == 0) wind = std::floor(noise.uniform() * 3.0) * 3.0;
    if (row % 90 == 0) near = 30.0 + 50.0 * noise.uniform();
    if (row % 40 == 0) speed = std::floor(noise.uniform() * 3.0) * 200.0;
    recording.t_s[row] = static_cast<double>(row) * dt_s;
    power[row] = level;
    ambient[row] = 24.0 + std::sin(recording.t_s[row] / 900.0);
    air[row] = wind;
    neighbour[row] = near;
    rate[row] = speed;
    supply[row] = 12.0;
  }
  recording.set("power_param", power);
  recording.set("ambient_C", ambient);
  recording.set("airspeed_mps", air);
  recording.set("neighbour_C", neighbour);
  recording.set("rate_dps", rate);
  if (with_supply) recording.set("supply_V", supply);
  return recording;
}

/// A smooth command of several frequencies, and a motor that warms up.
inline Recording axis_inputs(Eigen::Index rows, double dt_s, std::uint64_t seed) {
  Noise noise(seed);
  Recording recording;
  recording.name = "axis";
  recording.t_s.resize(rows);
  Eigen::VectorXd drive(rows), motor(rows);
  double phase[4];
  for (double& one : phase) one = 6.28 * noise.uniform();
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double t_s = static_cast<double>(row) * dt_s;
    recording.t_s[row] = t_s;
    drive[row] = 0.12 * std::sin(1.1 * t_s + phase[0]) + 0.15 * std::sin(2.9 * t_s + phase[1]) +
                 0.12 * std::sin(7.3 * t_s + phase[2]) + 0.08 * std::sin(17.0 * t_s + phase[3]);
    motor[row] = 28.0 + 25.0 * t_s / (static_cast<double>(rows) * dt_s);
  }
  recording.set("drive_A", drive);
  recording.set("motor_C", motor);
  return recording;
}

/// Simulates the truth on the recording's inputs, from equilibrium, and writes its noisy readings as outputs.
inline void measure(Recording& recording, const Model& truth, std::uint64_t seed,
                    const Catalogue& catalogue = standard_catalogue()) {
  Noise noise(seed);
  const Eigen::Index rows = recording.rows();
  Recording blank = recording;
  if (truth.has_axis()) {
    blank.set("angle_deg", Eigen::VectorXd::Zero(rows));
    blank.set("rate_dps", Eigen::VectorXd::Zero(rows));
  } else {
    blank.set("motor_C", Eigen::VectorXd::Constant(rows, 25.0));
    blank.set("current_A", Eigen::VectorXd::Zero(rows));
  }
  const Inputs inputs = prepare(truth, blank);
  const Instance<double> instance(truth, {}, {}, catalogue);
  Eigen::VectorXd first(rows), second(rows);
  if (truth.has_axis()) {
    const AxisRollout<double> rollout(instance, inputs);
    AxisState<double> state{0.0, 0.0, 0.0, 0.0};
    rollout.window({0, rows, ""}, 0, rows, state, [&](Eigen::Index row, const AxisReadings<double>& read) {
      first[row] = read.angle_deg + 0.02 * noise.normal();
      second[row] = read.rate_dps + 0.15 * noise.normal();
    });
    recording.set("angle_deg", first);
    recording.set("rate_dps", second);
  } else {
    const BenchRollout<double> rollout(instance, inputs);
    BenchState<double> state = rollout.start(0, 25.0);
    rollout.run(0, rows, 0.0, state, [&](Eigen::Index row, const BenchReadings<double>& read) {
      first[row] = read.motor_C + 0.05 * noise.normal();
      second[row] = read.current_A + 0.002 * noise.normal();
    });
    recording.set("motor_C", first);
    recording.set("current_A", second);
  }
}

/// One effect and the parameters it is tried with.
struct Trial {
  std::string id;
  EffectParameters parameters;
  bool axis = false;
};

/// A curve whose values go with u + bend u^3, where u is -1 at the first knot and 1 at the last; with a bend of 0 with u^2.
inline Trial curve(const std::string& id, double from, double to, double size, double bend, bool axis) {
  Trial trial{id, {}, axis};
  const std::vector<Parameter>& list = standard_catalogue().find(id)->info.parameters;
  trial.parameters[list[0].name] = from;
  trial.parameters[list[1].name] = to;
  for (int i = 0; i < curve_knot_count; ++i) {
    const double u = 2.0 * i / (curve_knot_count - 1) - 1.0;
    trial.parameters[list[static_cast<std::size_t>(curve_support_count + i)].name] =
        size * (bend != 0.0 ? u + bend * u * u * u : u * u);
  }
  return trial;
}

/// The standard catalogue, in which the curve of a trial has its range, and a size as large as its largest value.
inline Catalogue catalogue_for(const Trial& trial) {
  Catalogue catalogue = standard_catalogue();
  const EffectInfo& info = catalogue.find(trial.id)->info;
  if (!info.curve) return catalogue;
  double largest = 0.0;
  for (std::size_t i = curve_support_count; i < info.parameters.size(); ++i)
    largest = std::max(largest, std::abs(trial.parameters.at(info.parameters[i].name)));
  catalogue.support(trial.id, trial.parameters.at(info.parameters[0].name),
                    trial.parameters.at(info.parameters[1].name), largest);
  return catalogue;
}

/// Every effect of the standard catalogue, at a size that shows.
inline std::vector<Trial> trials() {
  return {
      {"second_thermal_mass", {{"winding_share", 0.25}, {"coupling", 0.6}}, false},
      {"third_thermal_mass", {{"share", 0.4}, {"coupling", 0.1}}, false},
      {"enclosure", {{"share", 0.8}, {"W_per_K", 0.25}}, false},
      {"contact_resistance", {{"J_per_K", 90.0}, {"K_per_W", 4.0}, {"W_per_K", 0.2}}, false},
      {"law.exchanged_heating", {}, false},
      {"radiation", {{"emissive_area_m2", 0.02}}, false},
      {"natural_convection", {{"exponent", 0.3}, {"reference_K", 20.0}}, false},
      {"forced_airflow", {{"gain", 0.2}, {"exponent", 0.7}}, false},
      {"ambient_bias", {{"bias_K", 4.0}}, false},
      {"neighbour_heating", {{"coupling", 0.03}}, false},
      {"motion_heating", {{"W_s2_per_rad2", 0.02}}, false},
      {"iron_loss", {{"hysteresis_W_s_per_rad", 0.1}, {"eddy_W_s2_per_rad2", 0.01}}, false},
      {"idle_heat", {{"W", 2.0}}, false},
      {"thermometer_lag", {{"lag_s", 25.0}}, false},
      {"thermometer_gain", {{"gain", 0.85}}, false},
      {"supply_power_heating", {{"share", 1.0}}, false},
      {"supply_sag", {{"internal_ohm", 0.4}, {"V_per_Ah", 0.8}}, false},
      {"series_resistance", {{"ohm", 1.2}}, false},
      {"dead_time", {{"duty_lost", 0.03}}, false},
      {"back_emf", {{"V_s_per_rad", 0.15}}, false},
      {"current_sensor_offset", {{"A", 0.05}}, false},
      {"current_sensor_gain", {{"gain", 1.2}}, false},
      {"winding_tempco", {{"tempco_per_K", 0.0039}}, false},
      {"coulomb_friction", {{"Nm", 0.008}, {"transition_rad_per_s", 0.01}, {"tail", 0.5}}, true},
      {"asymmetric_friction",
       {{"forward_Nm", 0.009}, {"backward_Nm", 0.004}, {"transition_rad_per_s", 0.03}, {"tail", 0.3}},
       true},
      {"stribeck_friction",
       {{"Nm", 0.004},
        {"rise_Nm", 0.006},
        {"knee_rad_per_s", 0.6},
        {"transition_rad_per_s", 0.01},
        {"tail", 0.2},
        {"exponent", 1.6}},
       true},
      {"load_friction", {{"share", 0.3}, {"transition_rad_per_s", 0.02}, {"tail", 0.7}}, true},
      {"drive_efficiency",
       {{"efficiency", 0.8}, {"back_efficiency", 0.6}, {"transition_rad_per_s", 0.02}, {"tail", 0.4}},
       true},
      {"drive_deadband", {{"A", 0.05}}, true},
      {"imbalance", {{"Nm", 0.006}, {"phase_rad", 0.5}}, true},
      {"cogging",
       {{"sin_Nm", 0.003},
        {"cos_Nm", -0.002},
        {"cycles_per_turn", 7.0},
        {"second_sin", 0.3},
        {"second_cos", -0.2}},
       true},
      {"cable_spring", {{"Nm_per_rad", 0.01}, {"centre_rad", 0.4}}, true},
      {"compliance", {{"far_share", 0.4}, {"frequency_Hz", 8.0}, {"damping", 0.05}}, true},
      {"backlash", {{"gap_rad", 0.05}, {"far_share", 0.4}, {"contact_Hz", 18.0}, {"damping", 0.2}}, true},
      {"presliding_friction", {{"Nm", 0.003}, {"bend_rad", 0.03}, {"damping_s", 0.002}}, true},
      {"actuation_delay", {{"s", 0.0173}}, true},
      {"servo_delay", {{"s", 0.0173}}, true},
      {"target_delay", {{"s", 0.0373}}, true},
      {"torque_saturation", {{"A", 0.2}}, true},
      {"torque_fade", {{"per_K", 0.006}}, true},
      {"constant_torque", {{"Nm", 0.004}}, true},
      {"asymmetric_viscous", {{"forward_Nms_per_rad", 4e-4}, {"backward_Nms_per_rad", 1.2e-3}}, true},
      {"torque_ripple", {{"sin_share", 0.2}, {"cos_share", -0.1}, {"cycles_per_turn", 6.0}}, true},
      {"warm_friction", {{"per_K", 0.02}}, true},
      {"quadratic_drag", {{"Nm_s2_per_rad2", 2e-4}}, true},
      {"drive_lag", {{"lag_s", 0.03}}, true},
      {"angle_scale", {{"gain", 57.29578}}, true},
      {"angle_bias_drift", {{"deg_per_s", 0.4}}, true},
      {"encoder_eccentricity", {{"sin_deg", 0.8}, {"cos_deg", -0.5}, {"cycles_per_turn", 3.0}}, true},
      {"rate_bias", {{"dps", 1.5}}, true},
      curve("unknown.load(angle_deg)", -120.0, 120.0, -0.01, 2.0, true),
      curve("unknown.friction(rate_dps)", -300.0, 300.0, 0.005, 1.0, true),
      curve("unknown.drive(drive_A)", -0.6, 0.6, 0.05, 0.0, true),
      curve("unknown.loss(rise_K)", -40.0, 60.0, 2.0, 0.0, false),
      curve("unknown.heat(current_A)", 0.0, 2.0, 5.0, 0.0, false),
      curve("unknown.voltage(motor_C)", 0.0, 80.0, 0.4, 0.0, false),
  };
}

/// The baseline for a trial: without the effect, and without what the effect needs to be absent.
inline Model baseline_of(const Trial& trial) {
  Model model = trial.axis ? axis_model() : bench_model();
  if (trial.id == "winding_tempco") model.set("tempco_per_K", 0.0);
  if (trial.id == "law.exchanged_heating") {
    model.current = ThesisCurrentModel{0.0, 0.0, -0.5, 10.0, 1.9, 1.0};
    model.thermal = ThesisThermalModel{0.15, 0.0, 0.02, 0.05, 0.3, 1.0};
  }
  if (trial.id == "third_thermal_mass")
    model.effects["second_thermal_mass"] = {{"winding_share", 0.25}, {"coupling", 0.6}};
  if (trial.id == "servo_delay" || trial.id == "target_delay")
    model.servo = PositionPidServo{0.02, 0.002, 0.0, 2.0, 0.005, 0.0};
  return model;
}

/// What was recorded while the effect of the trial acted.
inline Recording recorded(const Trial& trial, std::uint64_t seed) {
  Model truth = baseline_of(trial);
  truth.effects[trial.id] = trial.parameters;
  Recording recording =
      trial.axis ? axis_inputs(1500, 0.01, seed) : bench_inputs(600, 2.0, seed, trial.id != "supply_sag");
  if (truth.has_servo()) {  // what was a current, is a target in degrees
    const Eigen::VectorXd target = 100.0 * recording.column("drive_A");
    recording.remove("drive_A");
    recording.set("target_deg", target);
  }
  measure(recording, truth, seed + 1);
  return recording;
}

/// What is fitted to these recordings: windows of a second, and the noise that they were given.
inline FitProblem problem_of(const Model& model, const std::vector<Inputs>& inputs) {
  FitProblem problem;
  problem.model = &model;
  problem.catalogue = &standard_catalogue();
  problem.segments = cut(inputs, 1.0, plant_of(model));
  problem.sigma = {0.002, 0.05, 0.02, 0.15};
  return problem;
}

}  // namespace engine_fixture
