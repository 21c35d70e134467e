// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Writes raw logs of eight kinds, as machines write them, and the model that each is compared with. The machines are simulated here: a
// printer's hotend behind a thermometer that comes late, one whose connector takes a part of its power, a bed whose heater loses
// power as it warms, one whose log has no power, and a joint with dry friction. Their models know nothing of that. The scripts beside this file go from a log to a report.
//
//   raw_logs FOLDER

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

std::string number(const char* format, double value) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A row a second of a heater that is logged: what its thermometer shows, its target and the share of its power.
struct HeaterRow {
  double shown_C, target_C, duty;
};

struct Heater {
  double full_W, tempco_per_K, J_per_K, W_per_K, lag_s;
};

/// A heater under its loop. @param pid  gains of Klipper's loop (of 255, as its configuration has them); else on and off by half a kelvin
std::vector<HeaterRow> heated(const Heater& heater, const std::vector<double>& targets_C, bool pid,
                              unsigned seed, int hold_s = 150) {
  const double kp = 20.0 / 255.0, ki = 0.4 / 255.0, kd = 60.0 / 255.0, air_C = 24.0, step_s = 0.1;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_K(0.0, 0.05);
  std::vector<HeaterRow> rows;
  double body_C = air_C, shown_C = air_C, before_C = air_C, sum = 0.0, duty = 0.0;
  for (const double target_C : targets_C)
    for (int second = 0; second < hold_s; ++second) {
      const double read_C = shown_C + noise_K(random), error_K = target_C - read_C;
      if (pid) {
        sum = std::fmin(std::fmax(sum + error_K, 0.0), 1.0 / ki);
        duty = std::fmin(std::fmax(kp * error_K + ki * sum - kd * (read_C - before_C), 0.0), 1.0);
      } else if (std::fabs(error_K) > 0.5) {
        duty = error_K > 0.0 ? 1.0 : 0.0;
      }
      duty = std::round(1000.0 * duty) / 1000.0;
      before_C = read_C;
      rows.push_back({read_C, target_C, duty});
      for (int i = 0; i < 10; ++i) {
        const double heat_W = duty * heater.full_W / (1.0 + heater.tempco_per_K * (body_C - 25.0));
        body_C += step_s * (heat_W - heater.W_per_K * (body_C - air_C)) / heater.J_per_K;
        shown_C += heater.lag_s > 0.0 ? step_s * (body_C - shown_C) / heater.lag_s : body_C - shown_C;
      }
    }
  return rows;
}

/// A row each 10 ms of a joint: the command in A, angle in rad and rate in rad/s as read.
struct JointRow {
  double command_A, angle_rad, rate_rad_per_s;
};

std::vector<JointRow> moved(double friction_Nm, unsigned seed) {
  const double inertia = 0.004, viscous = 0.02, Nm_per_A = 0.5, step_s = 1e-4;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> level_A(-1.2, 1.2);
  std::normal_distribution<double> angle_noise(0.0, 2e-4), rate_noise(0.0, 5e-3);
  std::vector<JointRow> rows;
  double angle = 0.0, rate = 0.0, command = 0.0;
  for (int row = 0; row < 2000; ++row) {
    if (row % 25 == 0) command = std::round(100.0 * (level_A(random) - 0.4 * std::sin(angle))) / 100.0;
    rows.push_back({command, angle + angle_noise(random), rate + rate_noise(random)});
    for (int i = 0; i < 100; ++i) {
      rate += step_s * (Nm_per_A * command - viscous * rate - friction_Nm * std::tanh(rate / 0.01)) / inertia;
      angle += step_s * rate;
    }
  }
  return rows;
}

std::string klippy(const std::vector<HeaterRow>& rows) {
  std::string text =
      "Start printer at Sun Nov 29 10:00:00 2026\n===== Config file =====\n[extruder]\nheater_pin = PA1\ncontrol = pid\npid_kp = 20.0\n"
      "pid_ki = 0.4\npid_kd = 60.0\nmin_temp = 0\nmax_temp = 280\n=======================\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += "Stats " + number("%.1f", 1000.0 + static_cast<double>(i)) +
            ": gcodein=0 mcu: mcu_awake=0.001 freq=72000000 sysload=0.10 extruder: target=" +
            number("%.0f", rows[i].target_C) + " temp=" + number("%.1f", rows[i].shown_C) +
            " pwm=" + number("%.3f", rows[i].duty) + "\n";
  return text;
}

/// The log up to where Klipper's check stops the printer: full power for a minute, and no two kelvins gained in 20 s.
std::vector<HeaterRow> until_heating_failed(std::vector<HeaterRow> rows) {
  constexpr std::size_t full_s = 60, gain_s = 20;
  constexpr double gain_K = 2.0, missing_K = 5.0;
  std::size_t at_full = 0;
  for (std::size_t i = gain_s; i < rows.size(); ++i) {
    at_full = rows[i].duty >= 1.0 ? at_full + 1 : 0;
    const bool is_failed = at_full > full_s && rows[i].shown_C < rows[i].target_C - missing_K &&
                           rows[i].shown_C - rows[i - gain_s].shown_C < gain_K;
    if (!is_failed) continue;
    rows.resize(i + 1);
    break;
  }
  return rows;
}

std::string marlin(const std::vector<HeaterRow>& rows) {
  std::string text = "start\necho:Marlin 2.1.2\n";
  for (const HeaterRow& row : rows)
    text += " T:24.00 /0.00 B:" + number("%.2f", row.shown_C) + " /" + number("%.2f", row.target_C) +
            " @:0 B@:" + number("%.0f", 127.0 * row.duty) + "\n";
  return text;
}

/// A temperature graph as the web page of a printer exports it: no power.
std::string graph(const std::vector<HeaterRow>& rows) {
  std::string text = "time,bed_temp,bed_target\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += number("%.1f", static_cast<double>(i)) + "," + number("%.2f", rows[i].shown_C) + "," +
            number("%.0f", rows[i].target_C) + "\n";
  return text;
}

/// Replies of a motor on a CAN bus: current in hundredths of an ampere, rate in deg/s, angle in 65536 counts a turn.
std::string candump(const std::vector<JointRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto word = [](double value) {
      const unsigned bits = static_cast<unsigned>(std::lround(value)) & 0xFFFFu;
      char bytes[8];
      std::snprintf(bytes, sizeof bytes, "%02X%02X", bits & 0xFFu, bits >> 8);
      return std::string(bytes);
    };
    text += "(" + number("%.6f", 1764410400.0 + 0.01 * static_cast<double>(i)) + ") can0 141#A120" +
            word(100.0 * rows[i].command_A) + word(57.29577951 * rows[i].rate_rad_per_s) +
            word(std::fmod(rows[i].angle_rad * 65536.0 / 6.283185307, 65536.0)) + "\n";
  }
  return text;
}

std::string json_lines(const std::vector<JointRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += "{\"stamp\": " + number("%.3f", 0.01 * static_cast<double>(i)) + ", \"joint\": {\"q\": [" +
            number("%.6f", rows[i].angle_rad) + "], \"dq\": [" + number("%.5f", rows[i].rate_rad_per_s) +
            "], \"tau\": [" + number("%.4f", 0.5 * rows[i].command_A) + "]}}\n";
  return text;
}

std::string moteus(const std::vector<JointRow>& rows) {
  std::string text = "timestamp,mode,position,velocity,q_current,fault\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += number("%.3f", 0.01 * static_cast<double>(i)) + ",10," +
            number("%.7f", rows[i].angle_rad / 6.283185307) + "," +
            number("%.6f", rows[i].rate_rad_per_s / 6.283185307) + "," + number("%.2f", rows[i].command_A) +
            ",0\n";
  return text;
}

/// As pandas writes a frame: its index without a name, and dates.
std::string pandas(const std::vector<JointRow>& rows) {
  std::string text = ",when,command_mA,angle_rad,speed_rad_s\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t_s = 0.01 * static_cast<double>(i);
    char when[48];
    std::snprintf(when, sizeof when, "2026-11-29 10:00:%09.6f", std::fmod(t_s, 60.0));
    text += std::to_string(i) + "," + when + "," + number("%.0f", 1000.0 * rows[i].command_A) + "," +
            number("%.6f", rows[i].angle_rad) + "," + number("%.5f", rows[i].rate_rad_per_s) + "\n";
  }
  return text;
}

}  // namespace

int main(int count, char** values) {
  if (count != 2) {
    std::fprintf(stderr, "usage: raw_logs FOLDER\n");
    return 2;
  }
  const std::string folder = values[1];
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream file(folder + "/" + name, std::ios::binary);
    if (!(file << text)) {
      std::fprintf(stderr, "raw_logs: %s/%s cannot be written\n", folder.c_str(), name.c_str());
      std::exit(3);
    }
  };
  const std::vector<double> hotend = {200, 240, 0, 180, 230, 60, 210, 250, 0, 220},
                            bed = {60, 100, 0, 80, 110, 40, 90, 0, 70, 105};
  write("klippy.log", klippy(heated({40.0, 0.0, 12.0, 0.12, 3.0}, hotend, true, 1)));
  write(
      "hotend.json",
      "{\"format\": \"thermopower-model/1\", \"name\": \"hotend\", \"supply\": {\"nominal_V\": 24},\n"
      " \"current\": {\"law\": \"ohmic\", \"resistance_ohm\": 14.4, \"tempco_per_K\": 0},\n"
      " \"thermal\": {\"law\": \"lumped\", \"heat_capacity_J_per_K\": 12.2, \"conductance_W_per_K\": 0.118}}\n");
  // 9 ohm in a connector beside the 14.4 of the cartridge: 15 W of 40 are left in it.
  const std::vector<HeaterRow> failed = until_heating_failed(heated(
      {40.0 * 14.4 * 14.4 / (23.4 * 23.4), 0.0, 12.0, 0.12, 0.0}, {120, 60, 100, 0, 130, 200}, true, 4));
  write("failed.log", klippy(failed) +
                          "Heater extruder not heating at expected rate\n"
                          "See the 'verify_heater' section in docs/Config_Reference.md\n"
                          "for the parameters that control this check.\n");
  write("serial.log", marlin(heated({200.0, 0.004, 90.0, 0.9, 0.0}, bed, false, 2)));
  write(
      "bed.json",
      "{\"format\": \"thermopower-model/1\", \"name\": \"bed\", \"supply\": {\"nominal_V\": 24},\n"
      " \"current\": {\"law\": \"ohmic\", \"resistance_ohm\": 2.88, \"tempco_per_K\": 0},\n"
      " \"thermal\": {\"law\": \"lumped\", \"heat_capacity_J_per_K\": 91, \"conductance_W_per_K\": 0.89}}\n");
  write("graph.csv", graph(heated({200.0, 0.0, 600.0, 1.2, 12.0}, bed, false, 5, 600)));
  write(
      "bed_loop.json",
      "{\"format\": \"thermopower-model/1\", \"name\": \"bed\", \"supply\": {\"nominal_V\": 24},\n"
      " \"current\": {\"law\": \"ohmic\", \"resistance_ohm\": 2.88, \"tempco_per_K\": 0},\n"
      " \"thermal\": {\"law\": \"lumped\", \"heat_capacity_J_per_K\": 606, \"conductance_W_per_K\": 1.19},\n"
      " \"heater\": {\"law\": \"bang_bang\", \"max_delta_K\": 0.5, \"period_s\": 1}}\n");
  const std::vector<JointRow> joint = moved(0.12, 3);
  write("candump.log", candump(joint));
  write("robot.jsonl", json_lines(joint));
  write("moteus.csv", moteus(joint));
  write("pandas.csv", pandas(joint));
  write(
      "joint.json",
      "{\"format\": \"thermopower-model/1\", \"name\": \"joint\", \"axis\": {\"law\": \"rigid\", \"inertia_kgm2\": 0.0041,\n"
      " \"viscous_Nms_per_rad\": 0.02, \"torque_constant_Nm_per_A\": 0.5}}\n");
  std::printf(
      "%s: klippy.log, failed.log, serial.log, graph.csv, candump.log, robot.jsonl, moteus.csv, pandas.csv, and their models\n",
      folder.c_str());
  return 0;
}
