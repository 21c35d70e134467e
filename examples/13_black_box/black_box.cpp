// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

/// @file black_box.cpp
/// Problem: an oven's simulator is a program of its own, behind a function call, and cannot be differentiated.
/// Model: what it is called with, and what it answers. The diagnosis takes differences of its answers.
/// Here the "real" oven loses heat through a draught while its fan runs.

#include "../print_diagnosis.hpp"

#include <thermopower/gap.hpp>
#include <thermopower/plant/function_plant.hpp>

#include <cmath>
#include <cstdint>

namespace tp = thermopower;

namespace {

//! [black box]
/// The simulator: an oven with a wall between its air and the room, in steps of 0.25 s. Its wall's temperature
/// is not measured. Nobody outside sees these equations.
tp::plant::SimulatorAnswer oven(const tp::plant::SimulatorCall& call) {
  const double air_J_per_K = call.constants[0], wall_J_per_K = call.constants[1];
  const double inside_W_per_K = call.constants[2], outside_W_per_K = call.constants[3];
  const double draught_W_per_K = call.effect(0, 0, 0.0), fan_heat_W = call.effect(1, 0, 0.0);
  double air_C = call.start[0], wall_C = call.start[1];
  tp::plant::SimulatorAnswer answer;
  answer.signals.resize(call.t_s.size(), 1);
  for (Eigen::Index row = 0; row < call.t_s.size(); ++row) {
    answer.signals(row, 0) = air_C;
    if (row + 1 == call.t_s.size()) break;
    const double power_W = call.inputs(row, 0), fan = call.inputs(row, 1), room_C = call.inputs(row, 2);
    const double lasts_s = call.t_s[row + 1] - call.t_s[row];
    const int steps = static_cast<int>(std::ceil(lasts_s / 0.25));
    for (int i = 0; i < steps; ++i) {
      const double to_wall_W = inside_W_per_K * (air_C - wall_C);
      const double out_W = draught_W_per_K * fan * (air_C - room_C);
      air_C += lasts_s / steps * (power_W + fan_heat_W * fan - to_wall_W - out_W) / air_J_per_K;
      wall_C += lasts_s / steps * (to_wall_W - outside_W_per_K * (wall_C - room_C)) / wall_J_per_K;
    }
  }
  answer.end = {air_C, wall_C};
  return answer;
}

tp::gap::Model oven_model() {
  tp::plant::PlantInfo info;
  info.type = "oven";
  info.constants = {{"oven", "air_J_per_K", "J/K", 900.0},
                    {"oven", "wall_J_per_K", "J/K", 9000.0},
                    {"oven", "inside_W_per_K", "W/K", 12.0},
                    {"oven", "outside_W_per_K", "W/K", 6.0}};
  info.inputs = {{"power_W", "W"}, {"fan", "1"}, {"room_C", "degC"}};
  info.states = {{"air", "degC", 0, 20.0, 50.0}, {"wall", "degC", -1, 20.0, 30.0}};
  info.signals = {{"air_C", "degC", "oven.loss"}};
  const tp::plant::EffectInfo draught = {
      "draught",
      tp::plant::SubmodelName("oven.loss"),
      "loss += k fan (T_air - T_room)",
      "While the fan runs, warm air leaves through the door.",
      {tp::plant::parameter(0, "W_per_K").unit("W/K").within(0.0, 100.0).starts({0.2, 2.0})},
      {},
      "switch the fan on and off while the oven is hot"};
  const tp::plant::EffectInfo fan_heat = {
      "fan_heat",
      tp::plant::SubmodelName("oven.heating"),
      "heat += P fan",
      "The fan's motor warms the oven.",
      {tp::plant::parameter(0, "W").unit("W").within(0.0, 1000.0).starts({5.0, 50.0})},
      {},
      "run the fan in a cold oven"};
  return tp::plant::adapt_function("oven", info, {draught, fan_heat}, oven);
}
//! [black box]

double noise(std::uint64_t& state) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    sum += static_cast<double>(state >> 11) / 9007199254740992.0;
  }
  return sum;
}

/// The real oven over twenty minutes.
tp::gap::Recording recorded(const tp::gap::Model& truth, std::uint64_t seed) {
  const Eigen::Index rows = 600;
  tp::gap::Recording recording;
  recording.name = "oven";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 2.0 * static_cast<double>(rows - 1));
  Eigen::VectorXd power(rows), fan(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double phase = static_cast<double>(row + static_cast<Eigen::Index>(seed % 97));
    power[row] = std::fmod(phase, 220.0) < 140.0 ? 1200.0 : 0.0;
    fan[row] = std::fmod(phase, 90.0) < 45.0 ? 1.0 : 0.0;
  }
  recording.set("power_W", power);
  recording.set("fan", fan);
  recording.set("room_C", Eigen::VectorXd::Constant(rows, 20.0));
  recording.set("air_C", Eigen::VectorXd::Constant(rows, 20.0));
  Eigen::VectorXd air;
  Eigen::VectorXd room = recording.column("room_C");
  tp::plant::SimulatorCall call;
  for (const auto& constant : truth.own->constants) call.constants.push_back(constant.value);
  call.start = {20.0, 20.0};
  call.t_s = recording.t_s;
  call.inputs.resize(rows, 3);
  call.inputs << power, fan, room;
  call.effects.resize(2);
  if (truth.effects.count("draught") > 0) call.effects[0] = {truth.effects.at("draught").at("W_per_K")};
  air = oven(call).signals.col(0);
  for (double& value : air) value += 0.1 * noise(seed);
  recording.set("air_C", air);
  return recording;
}

}  // namespace

int main() {
  const tp::gap::Model simulation = oven_model();
  tp::gap::Model truth = simulation;
  truth.effects["draught"] = {{"W_per_K", 1.5}};
  const tp::gap::Diagnosis diagnosis =
      tp::gap::diagnose(simulation, {recorded(truth, 1)}, {recorded(truth, 60)});
  print(diagnosis);
  return diagnosis.verdict == tp::gap::Verdict::explained ? 0 : 1;
}
