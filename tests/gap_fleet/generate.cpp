// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Draws a fleet whose secrets are known, and seals them in a file of their own:
//   DIR/model.json, DIR/logs/*.csv, DIR/manifest.csv   what the judge sees
//   DIR/sealed/labels.json                             what only the scorer sees
// The motors are those of the benchmark, written apart from the library.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "../gap_benchmark/bench_draw.hpp"

namespace {

using namespace gap_benchmark;
using Json = nlohmann::ordered_json;

/// The motor as its data sheet has it, and the bench.
BenchSetup standard() {
  BenchSetup s;
  BenchContext& c = s.context;
  BenchParameters& m = c.model;
  c.nominal_V = 12.0;
  m[resistance_ohm] = 8.2;
  c.top_A = c.nominal_V / m[resistance_ohm];
  c.top_W = c.nominal_V * c.top_A;
  m[conductance] = 0.27;
  m[heat_capacity] = 60.0;
  s.tau_s = m[heat_capacity] / m[conductance];
  s.limit_C = 80.0;
  s.dt_s = 2.0;
  s.noise_current_A = 0.006;
  s.current_decimals = 4;
  c.length_s = 7.0 * s.tau_s;
  return s;
}

enum class Kind { sound, low_conductance, high_resistance, draughts };

struct Unit {
  std::string name, family;
  Kind kind = Kind::sound;
  BenchParameters plant{};
  int logs = 1, drift_from = -1;  ///< the log from which on it is another one
  double drift = 0.0;             ///< of the conductance, as a logarithm
  bool steady = false;
};

constexpr const char* usage = "usage: gap_fleet_generate --out DIR --seed S --units N\n";

}  // namespace

int main(int argc, char** argv) {
  std::string out;
  unsigned long long seed = 1;
  int count = 200;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const bool more = i + 1 < argc;
    if (option == "--out" && more) out = argv[++i];
    else if (option == "--seed" && more) seed = std::strtoull(argv[++i], nullptr, 10);
    else if (option == "--units" && more) count = std::atoi(argv[++i]);
    else return std::fputs(usage, stderr), 2;
  }
  if (out.empty() || count < 1) return std::fputs(usage, stderr), 2;
  std::filesystem::create_directories(out + "/logs");
  std::filesystem::create_directories(out + "/sealed");
  const BenchSetup bench = standard();
  std::ofstream(out + "/model.json") << bench_model_json(bench.context).dump(1) << "\n";

  Random random(seed * 0x100000001b3ull);
  std::vector<Unit> units(static_cast<std::size_t>(count));
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < units.size(); ++i) order.push_back(i);
  random.shuffle(order);
  // One in twenty is odd, and one in twelve has logs over months; of those every other one drifts.
  const std::size_t odd = static_cast<std::size_t>(std::lround(0.05 * count)),
                    followed = static_cast<std::size_t>(std::lround(count / 12.0));
  for (std::size_t place = 0; place < order.size(); ++place) {
    Unit& unit = units[order[place]];
    char name[20];
    std::snprintf(name, sizeof name, "U%04zu", order[place] + 1);
    unit.name = name;
    const double draw = random.uniform();
    unit.family = draw < 0.35 ? "second_thermal_mass" : draw < 0.6 ? "thermometer_lag" : "";
    unit.plant = bench.context.model;
    unit.plant[resistance_ohm] *= std::exp(0.02 * random.gauss());
    unit.plant[heat_capacity] *= std::exp(0.03 * random.gauss());
    unit.plant[conductance] *= std::exp(0.04 * random.gauss());
    if (unit.family == "second_thermal_mass") {
      unit.plant[winding_share] = 0.25 * std::exp(0.08 * random.gauss());
      unit.plant[coupling_W_per_K] = 6.0 * bench.context.model[conductance] * std::exp(0.1 * random.gauss());
    } else if (unit.family == "thermometer_lag") {
      unit.plant[sensor_lag_s] = 25.0 * std::exp(0.12 * random.gauss());
    }
    // Common to all, and in no single log of any account: a fifth of the current's noise.
    unit.plant[current_offset_A] = 0.2 * bench.noise_current_A * (1.0 + 0.2 * random.gauss());
    if (place < odd) {
      unit.kind = place % 3 == 0   ? Kind::low_conductance
                  : place % 3 == 1 ? Kind::high_resistance
                                   : Kind::draughts;
      if (unit.kind == Kind::low_conductance) unit.plant[conductance] *= 0.65;
      if (unit.kind == Kind::high_resistance) unit.plant[resistance_ohm] *= 1.3;
    } else if (place < odd + followed) {
      unit.logs = 8;
      const std::size_t which = place - odd;
      if (which % 2 == 0) {
        unit.drift = which % 4 == 0 ? -0.2 : 0.2;
        unit.steady = which % 8 >= 4;
        unit.drift_from = random.integer(3, 5);
      }
    }
  }
  Json labels;
  labels["weak"] = "current_sensor_offset";
  std::vector<std::string> rows;
  int number = 0;
  for (const Unit& unit : units) {
    labels["units"][unit.name] = {
        {"family", unit.family},
        {"odd", unit.kind != Kind::sound},
        {"drift", unit.drift},
        {"steady", unit.steady},
        {"drift_after_day", unit.drift_from >= 0 ? 30 * (unit.drift_from - 1) : -1},
        {"resistance", unit.plant[resistance_ohm] / bench.context.model[resistance_ohm]},
        {"conductance", unit.plant[conductance] / bench.context.model[conductance]},
        {"heat_capacity", unit.plant[heat_capacity] / bench.context.model[heat_capacity]}};
    for (int k = 0; k < unit.logs; ++k, ++number) {
      BenchSetup setup = bench;
      setup.plant = unit.plant;
      if (unit.drift != 0.0) {
        const double part = unit.steady ? k / (unit.logs - 1.0) : k >= unit.drift_from ? 1.0 : 0.0;
        setup.plant[conductance] *= std::exp(unit.drift * part);
      }
      if (unit.kind == Kind::draughts) {
        setup.unknown = BenchUnknown::draughts;
        setup.unknown_size = 0.6;
      }
      BenchSession session;
      session.kind =
          random.pick({PowerProfile::Kind::steps, PowerProfile::Kind::cycles, PowerProfile::Kind::prbs});
      session.length_s = bench.context.length_s;
      session.ambient_C = random.uniform(18.0, 28.0);
      session.seed = random.bits();
      BenchRecording made = record(setup, session, Random(random.bits()));
      char name[40];
      std::snprintf(name, sizeof name, "logs/%s_%d.csv", unit.name.c_str(), k + 1);
      const std::string path = out + "/" + name;
      // One log in fifty is broken, in one of three ways; of a unit with several logs, and of an odd one, none is.
      const bool broken = unit.logs == 1 && unit.kind == Kind::sound && random.chance(0.02 * 200.0 / 174.0);
      const int way = broken ? number % 3 : -1;
      if (way == 0)
        for (Column& column : made.log.columns) column.values.resize(9);
      if (way == 1)
        for (Column& column : made.log.columns)
          if (column.name == "motor_C") std::fill(column.values.begin(), column.values.end(), 25.0);
      made.log.write(path);
      if (way == 2) std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3 + 1);
      if (way == 2) std::ofstream(path, std::ios::app) << "\nx,y\n";
      if (broken) labels["broken"].push_back(name);
      char row[120];
      std::snprintf(row, sizeof row, "%s,model.json,%s,%d\n", name, unit.name.c_str(), 20000 + 30 * k);
      rows.push_back(row);
    }
  }
  random.shuffle(rows);
  std::ofstream manifest(out + "/manifest.csv");
  manifest << "log,model,unit,time\n";
  for (const std::string& row : rows) manifest << row;
  std::ofstream(out + "/sealed/labels.json") << labels.dump(1) << "\n";
  std::printf("%d units, %zu logs\n", count, rows.size());
  return 0;
}
