// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  gaps as they come: a hobby servo that carries a pendulum, a joint behind a gear, a motor that is
//           bolted to a frame, known as a whole or part by part. Here are models and recordings of each to try the how-tos on.
// Model:    what the models lack stands beside each recording below. The equations are this file's own, stepped a
//           hundred times in a row of the log.
// Notation: angles in rad inside, N m, A, V; T in degC, heat capacities in J/K, conductances in W/K.
//
//     joints_and_bodies DIR      writes DIR/{pendulum,gear,frame,bolted}.json, DIR/{...}_train.csv and DIR/{...}_heldout.csv

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>

namespace {

constexpr double deg = 57.29577951308232;

/// Dry friction stops a joint at most: the rate after it.
double rubbed(double rate, double by) { return rate > by ? rate - by : rate < -by ? rate + by : 0.0; }

// A joint with dry friction, in steps of 0.1 ms.
struct Joint {
  double inertia_kgm2, angle = 0.0, rate = 0.0;
  explicit Joint(double inertia) : inertia_kgm2(inertia) {}
  void step(double torque_Nm, double friction_Nm) {
    rate = rubbed(rate + 1e-4 * torque_Nm / inertia_kgm2, 1e-4 * friction_Nm / inertia_kgm2);
    angle += 1e-4 * rate;
  }
};

// A recording, and what makes it one: noise.
class Log {
public:
  std::mt19937 random;

  Log(const std::string& path, unsigned seed, const char* header) : random(seed), csv_(path) {
    csv_ << header << "\n";
  }
  double noise() { return normal_(random); }
  template <class... Values>
  void row(const char* format, Values... values) {
    char line[160];
    std::snprintf(line, sizeof line, format, values...);
    csv_ << line << "\n";
  }
  bool good() const { return csv_.good(); }

private:
  std::ofstream csv_;
  std::normal_distribution<double> normal_;
};

// A position servo (a brushed motor behind gears, sampled every 5 ms) that holds a pendulum. The model knows the
// gears' dry friction from a recording without load. What it lacks: the pendulum's weight, m g l = 0.15 N m at 90
// degrees. No current is logged.
bool pendulum(const std::string& path, int seconds, unsigned seed) {
  Log log(path, seed, "t_s,target_deg,angle_deg");
  Joint joint(4e-3);
  double level = 0.0;
  constexpr double viscous = 4e-3, torque_constant = 0.9, ohm = 5.0;
  for (int row = 0; row < 100 * seconds; ++row) {
    const double t = 0.01 * row;
    if (row % 90 == 0) level = 35.0 * log.noise();
    const double target = std::max(-80.0, std::min(80.0, level)) + 15.0 * std::sin(3.1 * t);
    log.row("%.2f,%.3f,%.3f", t, target, joint.angle * deg + 0.05 * log.noise());
    for (int sample = 0; sample < 2; ++sample) {
      const double amps = 0.05 * (target - joint.angle * deg) - 0.0015 * joint.rate * deg;
      const double volts = ohm * std::max(-1.2, std::min(1.2, amps));
      for (int i = 0; i < 50; ++i) {
        const double torque = torque_constant * (volts - torque_constant * joint.rate) / ohm -
                              viscous * joint.rate - 0.15 * std::sin(joint.angle);
        joint.step(torque, 0.04);
      }
    }
  }
  return log.good();
}

// A joint behind a gear that loses a quarter of what its teeth transmit, with a known load on it. What the model
// lacks: that loss.
bool gear(const std::string& path, int seconds, unsigned seed) {
  Log log(path, seed, "t_s,drive_A,torque_Nm,angle_deg,rate_dps");
  Joint joint(2e-3);
  const double phase = seed;
  double load = 0.0;
  constexpr double viscous = 2e-3, torque_constant = 0.5;
  for (int row = 0; row < 100 * seconds; ++row) {
    const double t = 0.01 * row;
    if (row % 130 == 0) load = 0.04 * log.noise();
    const double drive =
        0.2 * std::sin(1.9 * t + phase) + 0.15 * std::sin(4.7 * t) + 0.08 * std::sin(10.3 * t);
    log.row("%.2f,%.4f,%.4f,%.3f,%.2f", t, drive, load, joint.angle * deg + 0.02 * log.noise(),
            joint.rate * deg + 0.2 * log.noise());
    for (int i = 0; i < 100; ++i) {
      const double transmitted = std::fabs(torque_constant * drive - load);
      const double torque = torque_constant * drive + load - viscous * joint.rate;
      joint.step(torque, 0.25 * transmitted);
    }
  }
  return log.good();
}

// A motor whose model was made on the bench: winding and housing. Now it is bolted to a frame of 80 J/K through
// 0.1 W/K, which the model lacks.
bool frame(const std::string& path, int minutes, unsigned seed) {
  Log log(path, seed, "t_s,power_param,supply_V,ambient_C,current_A,motor_C");
  std::uniform_int_distribution<int> levels(0, 10), lasts(60, 240);
  double winding = 22.0, housing = 22.0, bolted = 22.0;
  int level = 8, left = 120;
  for (int t = 0; t < 60 * minutes; t += 2) {
    if (left-- == 0) level = levels(log.random), left = lasts(log.random);
    const double volts = 12.0 * std::sqrt(25.0 * level / 255.0);
    const auto ohm = [&] { return 8.0 * (1.0 + 0.00393 * (winding - 25.0)); };
    log.row("%d,%d,12,22,%.4f,%.3f", t, 25 * level, volts / ohm() + 0.003 * log.noise(),
            winding + 0.05 * log.noise());
    for (int i = 0; i < 100; ++i) {
      const double into_housing = 0.8 * (winding - housing), into_frame = 0.1 * (housing - bolted);
      winding += 0.02 * (volts * volts / ohm() - into_housing) / 15.0;
      housing += 0.02 * (into_housing - into_frame - 0.15 * (housing - 22.0)) / 45.0;
      bolted += 0.02 * into_frame / 80.0;
    }
  }
  return log.good();
}

// The same with its parts by name: winding, stator, frame and mount, with thermometers on winding and frame. The model has
// the four; what it lacks: the bearing's shield, which takes 0.25 W/K from the winding's end straight to the frame.
bool bolted(const std::string& path, int minutes, unsigned seed) {
  Log log(path, seed, "t_s,current_A,ambient_C,winding_C,frame_C");
  double air = 21.0 + seed, winding = air, stator = air, frame = air, mount = air, amps = 0.0;
  for (int row = 0; row < 12 * minutes; ++row) {
    if (row % 72 == 0) amps = row % 288 == 216 ? 0.0 : 1.0 + 0.1 * static_cast<double>(log.random() % 50);
    log.row("%d,%.1f,%.1f,%.1f,%.1f", 5 * row, amps, air, winding + 0.05 * log.noise(),
            frame + 0.05 * log.noise());
    for (int i = 0; i < 100; ++i) {
      const double heat = amps * amps * 0.8 * (1.0 + 0.00393 * (winding - 25.0));
      const double to_stator = 0.9 * (winding - stator), to_frame = 1.6 * (stator - frame),
                   shield = 0.25 * (winding - frame), to_mount = 1.1 * (frame - mount);
      winding += 0.05 * (heat - to_stator - shield) / 22.0;
      stator += 0.05 * (to_stator - to_frame) / 95.0;
      frame += 0.05 * (to_frame + shield - to_mount - 0.35 * (frame - air)) / 420.0;
      mount += 0.05 * (to_mount - 1.3 * (mount - air)) / 1500.0;
    }
  }
  return log.good();
}

constexpr const char* pendulum_model = R"({
  "format": "thermopower-model/1", "name": "servo without its pendulum",
  "axis": {"law": "voltage", "inertia_kgm2": 4e-3, "viscous_Nms_per_rad": 4e-3,
           "torque_constant_Nm_per_A": 0.9, "resistance_ohm": 5.0},
  "servo": {"law": "position_pid", "kp_A_per_deg": 0.05, "kd_A_s_per_deg": 0.0015,
            "limit_A": 1.2, "period_s": 0.005},
  "effects": {"coulomb_friction": {"Nm": 0.04}}
}
)";

constexpr const char* gear_model = R"({
  "format": "thermopower-model/1", "name": "joint behind a gear without losses",
  "axis": {"law": "rigid", "inertia_kgm2": 2e-3, "viscous_Nms_per_rad": 2e-3, "torque_constant_Nm_per_A": 0.5}
}
)";

constexpr const char* frame_model = R"({
  "format": "thermopower-model/1", "name": "motor by itself",
  "current": {"law": "ohmic", "resistance_ohm": 8.0, "tempco_per_K": 0.00393, "reference_C": 25.0},
  "thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.15},
  "effects": {"second_thermal_mass": {"winding_share": 0.25, "coupling": 0.8}}
}
)";

constexpr const char* bolted_model = R"({
  "format": "thermopower-model/1", "name": "motor on a frame",
  "network": {
    "nodes": {
      "winding": {"heat_capacity_J_per_K": 22, "column": "winding_C"},
      "stator": {"heat_capacity_J_per_K": 95},
      "frame": {"heat_capacity_J_per_K": 420, "column": "frame_C"},
      "mount": {"heat_capacity_J_per_K": 1500, "uncertainty": {"heat_capacity_J_per_K": 0.2}}
    },
    "given": {"air": {"column": "ambient_C"}},
    "links": [
      {"from": "winding", "to": "stator", "conductance_W_per_K": 0.9},
      {"from": "stator", "to": "frame", "conductance_W_per_K": 1.6},
      {"from": "frame", "to": "mount", "conductance_W_per_K": 1.1},
      {"from": "frame", "to": "air", "conductance_W_per_K": 0.35},
      {"from": "mount", "to": "air", "conductance_W_per_K": 1.3}
    ],
    "heat": [{"column": "current_A", "node": "winding", "resistance_ohm": 0.8, "tempco_per_K": 0.00393}]
  }
}
)";

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: joints_and_bodies DIR\n", stderr);
    return 2;
  }
  const std::string folder = std::string(arguments[1]) + "/";
  std::ofstream(folder + "pendulum.json") << pendulum_model;
  std::ofstream(folder + "gear.json") << gear_model;
  std::ofstream(folder + "frame.json") << frame_model;
  std::ofstream(folder + "bolted.json") << bolted_model;
  const bool written =
      pendulum(folder + "pendulum_train.csv", 15, 1) && pendulum(folder + "pendulum_heldout.csv", 10, 2) &&
      gear(folder + "gear_train.csv", 15, 1) && gear(folder + "gear_heldout.csv", 10, 2) &&
      frame(folder + "frame_train.csv", 80, 1) && frame(folder + "frame_heldout.csv", 50, 2) &&
      bolted(folder + "bolted_train.csv", 120, 1) && bolted(folder + "bolted_heldout.csv", 90, 2);
  if (!written) {
    std::fprintf(stderr, "joints_and_bodies: %s cannot be written to\n", folder.c_str());
    return 3;
  }
  return 0;
}
