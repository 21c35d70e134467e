// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  a recording that several causes explain. Which one is it? The next experiment tells.
// Model:    the simulation under test is J dw/dt = Kt i - b w. The real drum has dry friction, too: - F sign(w). In the first
//           recording it turns one way only, and there a constant torque would look the same.
// Notation: J in kg m^2, b in N m s/rad, Kt in N m/A, F in N m, i in A, w in rad/s.
//
//     next_experiment DIR                     writes model.json, first.csv and limits.json
//     next_experiment DIR schedule.csv        plays the schedule on the real drum, and writes second.csv
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr double row_s = 0.01, friction_Nm = 0.012;  // what the simulation does not know

/// The real drum, logged by an encoder and a gyroscope.
bool record(const std::string& path, const std::vector<double>& drive_A, unsigned seed) {
  constexpr double inertia = 1.02e-3, viscous = 0.98e-3, torque_constant = 0.1, degrees = 57.29577951308232;
  constexpr int steps = 100;
  std::ofstream csv(path);
  std::mt19937 random(seed);
  std::normal_distribution<double> encoder_deg(0.0, 0.02), gyroscope_dps(0.0, 0.2);
  csv << "t_s,drive_A,angle_deg,rate_dps\n";
  double angle = 0.0, rate = 0.0;
  for (std::size_t row = 0; row < drive_A.size(); ++row) {
    char line[96];
    std::snprintf(line, sizeof line, "%.2f,%.6g,%.4f,%.3f\n", static_cast<double>(row) * row_s, drive_A[row],
                  angle * degrees + encoder_deg(random), rate * degrees + gyroscope_dps(random));
    csv << line;
    for (int i = 0; i < steps; ++i) {
      const double h = row_s / steps, push = torque_constant * drive_A[row] - viscous * rate;
      const double next = rate + h * push / inertia, brake = h * friction_Nm / inertia;
      rate = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      angle += h * rate;
    }
  }
  return csv.good();
}

/// The column drive_A of a schedule; empty where it cannot be read.
std::vector<double> read_schedule(const std::string& path) {
  std::ifstream csv(path);
  std::string line, cell;
  std::vector<double> drive_A;
  std::size_t wanted = 0;
  if (!std::getline(csv, line)) return drive_A;
  std::stringstream header(line);
  for (std::size_t i = 0; std::getline(header, cell, ','); ++i)
    if (cell == "drive_A") wanted = i;
  while (std::getline(csv, line)) {
    std::stringstream cells(line);
    for (std::size_t i = 0; i <= wanted; ++i) std::getline(cells, cell, ',');
    drive_A.push_back(std::stod(cell));
  }
  return drive_A;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2 && count != 3) {
    std::fputs("usage: next_experiment DIR [SCHEDULE]\n", stderr);
    return 2;
  }
  const std::string directory = arguments[1];
  if (count == 3) {
    const std::vector<double> drive_A = read_schedule(arguments[2]);
    if (drive_A.empty() || !record(directory + "/second.csv", drive_A, 2)) {
      std::fprintf(stderr, "next_experiment: %s cannot be played into %s\n", arguments[2], directory.c_str());
      return 3;
    }
    std::printf("%s/second.csv: %zu rows\n", directory.c_str(), drive_A.size());
    return 0;
  }
  std::vector<double> drive_A;
  for (int row = 0; row < 2000; ++row)
    drive_A.push_back(0.45 + 0.25 * std::sin(0.011 * row) + (row / 230 % 2 == 0 ? 0.1 : -0.1));
  std::ofstream model(directory + "/model.json"), limits(directory + "/limits.json");
  model << R"({
  "format": "thermopower-model/1",
  "name": "drum without friction",
  "axis": {"law": "rigid", "inertia_kgm2": 1e-3, "viscous_Nms_per_rad": 1e-3, "torque_constant_Nm_per_A": 0.1}
}
)";
  limits << R"({
  "format": "thermopower-limits/1",
  "duration_s": 10,
  "row_s": 0.01,
  "vary": {"drive_A": {"from": -0.6, "to": 0.6}},
  "rate_dps": 3000
}
)";
  if (!model.good() || !limits.good() || !record(directory + "/first.csv", drive_A, 1)) {
    std::fprintf(stderr, "next_experiment: %s: cannot be written to\n", directory.c_str());
    return 3;
  }
  std::printf("%s: model.json, first.csv, limits.json; what is missing: dry friction of %g N m\n",
              directory.c_str(), friction_Nm);
  return 0;
}
