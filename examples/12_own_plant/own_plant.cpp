// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

/// @file own_plant.cpp
/// Problem: a heated tank behaves otherwise than its simulation says. No actuator of this library is like it.
/// Model: heated_tank.hpp states its two balances once; the diagnosis needs no more.
/// Here the "real" tank seeps, which the diagnosis is to find out from a recording with sensor noise.

#include "../print_diagnosis.hpp"
#include "heated_tank.hpp"

#include <thermopower/gap.hpp>

#ifdef OWN_PLANT_WRITES_FILES
#include <thermopower/io/header_export.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>

#include <fstream>
#endif

#include <cmath>
#include <cstdint>
#include <string>

namespace tp = thermopower;

namespace {

/// Noise that is the same everywhere.
double noise(std::uint64_t& state) {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    sum += static_cast<double>(state >> 11) / 9007199254740992.0;
  }
  return sum;
}

/// The real tank over half an hour: the pump and the heater go on and off.
tp::gap::Recording recorded(const tp::gap::Model& truth, std::uint64_t seed) {
  const Eigen::Index rows = 900;
  tp::gap::Recording recording;
  recording.name = "tank";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 2.0 * static_cast<double>(rows - 1));
  Eigen::VectorXd inflow(rows), heater(rows), inlet(rows), room(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const double phase = static_cast<double>(row + static_cast<Eigen::Index>(seed % 97));
    inflow[row] = std::fmod(phase, 180.0) < 90.0 ? 2.4e-4 : 0.6e-4;
    heater[row] = std::fmod(phase, 300.0) < 170.0 ? 9000.0 : 0.0;
    inlet[row] = 14.0;
    room[row] = 21.0;
  }
  recording.set("inflow_m3_per_s", inflow);
  recording.set("heater_W", heater);
  recording.set("inlet_C", inlet);
  recording.set("room_C", room);
  recording.set("level_m", Eigen::VectorXd::Constant(rows, 0.3));
  recording.set("water_C", Eigen::VectorXd::Constant(rows, 25.0));
  for (const auto& one : tp::gap::simulate(truth, recording)) {
    Eigen::VectorXd values = one.values;
    const double sd = to_string(one.signal) == "level_m" ? 0.0008 : 0.04;
    for (double& value : values) value += sd * noise(seed);
    recording.set(to_string(one.signal), values);
  }
  return recording;
}

}  // namespace

int main(int count, char** values) {
  //! [diagnosing an own plant]
  const tp::gap::Model simulation = tp::plant::adapt<HeatedTank, Seepage, Evaporation>("heated tank");
  tp::gap::Model truth = simulation;
  truth.effects["seepage"] = {{"m2_per_s", 1.2e-4}};

  const tp::gap::Diagnosis diagnosis =
      tp::gap::diagnose(simulation, {recorded(truth, 1)}, {recorded(truth, 40)});
  //! [diagnosing an own plant]

  print(diagnosis);
#ifdef OWN_PLANT_WRITES_FILES
  if (count > 1) {
    namespace io = tp::io;
    const std::string folder = values[1];
    std::ofstream(folder + "/report.json") << io::report_json(diagnosis);
    std::ofstream(folder + "/report.html")
        << io::report_html(diagnosis, simulation.name, simulation.own->equations->effects()->list());
    std::ofstream(folder + "/augmented.json") << io::to_json(diagnosis.augmented);
    std::ofstream(folder + "/tank_model.hpp")
        << io::motor_model_header(diagnosis.augmented, "heated tank").text;
  }
#else
  static_cast<void>(count);
  static_cast<void>(values);
#endif
  return diagnosis.verdict == tp::gap::Verdict::explained ? 0 : 1;
}
