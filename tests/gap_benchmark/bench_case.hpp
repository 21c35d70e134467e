// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "assess.hpp"
#include "bench_effects.hpp"
#include "power_profile.hpp"
#include "recording.hpp"

namespace gap_benchmark {

/// One motor on one bench: everything that stays the same between its recordings.
struct BenchSetup {
  BenchContext context;
  BenchParameters plant;  ///< with the effect
  BenchUnknown unknown = BenchUnknown::none;
  double dt_s = 1.0, tau_s = 300.0, limit_C = 90.0, top_power = 255.0;
  double noise_current_A = 0.003, noise_motor_C = 0.1, noise_ambient_C = 0.05, coloured = 0.0;
  NoiseKind noise_kind = NoiseKind::mild;
  double quantum_motor_C = 0.1, quantum_ambient_C = 0.01;
  int current_decimals = 3;
  bool jitter = false, gaps = false, missing_cells = false, warm_start = false;
  std::vector<std::string> decoys;
  double unknown_size = 0.0, unknown_time_s = 0.0;
};

/// What one experiment on the bench is: it can be done again, with other switching times, weather and noise.
struct BenchSession {
  PowerProfile::Kind kind = PowerProfile::Kind::steps;
  double length_s = 3000.0, ambient_C = 22.0, run_gap_K = 0.0, unknown_phase = 0.0;
  int runs = 1;
  std::uint64_t seed = 1;  ///< of what belongs to the experiment: levels, frequencies, where it starts from
  /// A schedule: POWER at each row, in the place of `kind`. Empty: there is none.
  std::vector<double> commands = {};
};

struct BenchRecording {
  BenchParameters exact{};  ///< the plant, with the hidden temperatures this recording began with
  BenchDrive drive;         ///< true inputs, true temperature at the starts
  BenchOutput truth;        ///< noise-free outputs
  Recording log;
};

inline std::vector<double> bench_stamps(const BenchSetup& setup, double length_s, Random& random) {
  std::vector<double> t;
  for (double s = 0.0; s <= length_s; s += setup.dt_s) {
    if (setup.gaps && !t.empty() && random.chance(0.004)) s += setup.dt_s * random.integer(1, 8);
    t.push_back(
        std::round((s + (setup.jitter && !t.empty() ? random.uniform(-0.2, 0.2) * setup.dt_s : 0.0)) * 1e3) *
        1e-3);
  }
  return t;
}

/// Runs the motor and writes down what the log would hold. The same setup and session with another `random`
/// is another recording of the same kind.
inline BenchRecording record(const BenchSetup& setup, const BenchSession& session, Random random) {
  const BenchContext& c = setup.context;
  const BenchPlant plant(setup.plant);
  BenchRecording out;
  out.exact = setup.plant;
  std::vector<double> board, humidity;
  std::vector<std::string> labels;
  for (int run = 0; run < session.runs; ++run) {
    const auto t = bench_stamps(setup, session.length_s / session.runs, random);
    Random fixed(session.seed + static_cast<std::uint64_t>(run));
    PowerProfile power(session.kind, setup.tau_s, setup.top_power, setup.limit_C, fixed);
    Wander air(0.35, 400.0), supply(0.006 * c.nominal_V, 900.0), gust(0.5, 30.0), motion(70.0, 6.0),
        loss(0.4, 0.6 * setup.tau_s);
    const double swing_K = fixed.uniform(0.0, 1.2), swing_s = fixed.uniform(3000.0, 9000.0),
                 swing_phase = fixed.uniform(0.0, 6.3);
    double wind_mps = 0.0, wind_until_s = -1.0, moving = 0.0, moving_until_s = -1.0, neighbour_goal_C = 30.0,
           neighbour_until_s = -1.0;
    double neighbour_C = session.ambient_C + random.uniform(2.0, 30.0), contact_ohm = 0.0,
           contact_until_s = -1.0, hidden_W = 0.0, heater_until_s = -1.0, board_C = session.ambient_C + 6.0;
    BenchState x;
    const std::size_t first = out.drive.t_s.size();
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double elapsed_s = k ? t[k] - t[k - 1] : 0.0;
      BenchInput u;
      u.ambient_C = session.ambient_C + swing_K * std::sin(6.283 * t[k] / swing_s + swing_phase) +
                    air.next(random, elapsed_s);
      u.supply_V = c.nominal_V + (c.has_supply ? supply.next(random, elapsed_s) -
                                                     0.01 * c.nominal_V * t[k] / session.length_s
                                               : 0.0);
      if (t[k] >= wind_until_s) {
        wind_mps = random.chance(0.35) ? 0.0 : random.uniform(0.8, 9.0);
        wind_until_s = t[k] + setup.tau_s * random.log_uniform(0.15, 1.2);
      }
      u.airspeed_mps = wind_mps > 0.0 ? std::max(0.0, wind_mps + gust.next(random, elapsed_s)) : 0.0;
      if (t[k] >= moving_until_s) {
        moving = random.chance(0.4) ? 0.0 : random.uniform(0.4, 3.0);
        moving_until_s = t[k] + setup.tau_s * random.log_uniform(0.1, 0.9);
      }
      u.rate_dps = std::clamp(moving * motion.next(random, elapsed_s), -400.0, 400.0);
      if (t[k] >= neighbour_until_s) {
        neighbour_goal_C = session.ambient_C + random.uniform(5.0, 75.0);
        neighbour_until_s = t[k] + setup.tau_s * random.log_uniform(0.3, 1.5);
      }
      neighbour_C += (neighbour_goal_C - neighbour_C) * (1.0 - std::exp(-elapsed_s / (0.25 * setup.tau_s)));
      u.neighbour_C = neighbour_C;
      switch (setup.unknown) {
        case BenchUnknown::periodic_heat:
          u.hidden_W =
              setup.unknown_size *
              (std::sin(6.2831853 * t[k] / setup.unknown_time_s + session.unknown_phase) > 0.0 ? 1.0 : 0.0);
          break;
        case BenchUnknown::random_heat:
          if (t[k] >= heater_until_s) {
            hidden_W = hidden_W > 0.0 ? 0.0 : setup.unknown_size * random.uniform(0.6, 1.4);
            heater_until_s = t[k] + setup.unknown_time_s * random.uniform(0.4, 1.6);
          }
          u.hidden_W = hidden_W;
          break;
        case BenchUnknown::intermittent_contact:
          if (t[k] >= contact_until_s) {
            contact_ohm = contact_ohm > 0.0 ? 0.0 : setup.unknown_size * random.uniform(0.5, 1.5);
            contact_until_s = t[k] + setup.unknown_time_s * random.log_uniform(0.2, 2.0);
          }
          u.hidden_ohm = contact_ohm;
          break;
        case BenchUnknown::loosening:
          u.hidden_loss =
              t[k] > (0.35 + 0.2 * session.unknown_phase / 6.2832) * t.back() ? setup.unknown_size : 1.0;
          break;
        case BenchUnknown::draughts:
          u.hidden_loss = std::exp(setup.unknown_size * loss.next(random, elapsed_s));
          break;
        default:
          break;
      }
      if (k == 0) {
        x.winding_C = x.housing_C = x.sensor_C = x.soak_C = x.sink_C =
            u.ambient_C + (run ? session.run_gap_K : fixed.uniform(0.0, 4.0));
        x.box_C = u.ambient_C + setup.plant[air_bias_K];
        if (setup.warm_start && run == 0) {
          BenchInput before = u;
          before.power_param = std::round(setup.top_power * fixed.uniform(0.3, 0.9));
          for (int i = 0; i < 100 && x.winding_C < setup.limit_C - 15.0; ++i)
            plant.advance(x, before, setup.tau_s * 0.01);
          x.charge_Ah = 0.0;
          out.exact[housing_start_K] = x.housing_C - x.winding_C;
          out.exact[winding_start_K] = x.winding_C - x.sensor_C;
          out.exact[sink_start_K] = x.sink_C - x.housing_C;
          out.exact[box_start_K] = x.box_C - u.ambient_C - setup.plant[air_bias_K];
        }
        out.drive.run_start.push_back(first);
      } else {
        plant.advance(x, out.drive.input.back(), elapsed_s);
      }
      u.power_param = session.commands.empty()
                          ? power.next(random, t[k], x.winding_C)
                          : std::round(session.commands[std::min(k, session.commands.size() - 1)]);
      if (c.current_is_input) u.measured_current_A = plant.current(u, x);
      const double sensed_C = plant.sensed_temperature(u, x);
      if (k == 0) out.drive.start_C.push_back(sensed_C);
      out.drive.t_s.push_back(t[k]);
      out.drive.input.push_back(u);
      out.truth.current_A.push_back(plant.sensed_current(u, x));
      out.truth.motor_C.push_back(sensed_C);
      board_C += (session.ambient_C + 8.0 + 6.0 * std::sin(t[k] / 700.0) - board_C) *
                 (1.0 - std::exp(-elapsed_s / 200.0));
      board.push_back(board_C);
      humidity.push_back(45.0 + 6.0 * std::sin(t[k] / 1300.0 + swing_phase) + 0.4 * random.gauss());
      labels.push_back("run" + std::to_string(run + 1));
    }
  }
  // The log: every sensor with its noise and its quantum.
  const std::size_t n = out.drive.t_s.size();
  const auto column = [&](const std::string& name, int decimals, auto value) {
    Column made{name, decimals, {}};
    for (std::size_t k = 0; k < n; ++k) made.values.push_back(value(k));
    out.log.columns.push_back(std::move(made));
  };
  SensorNoise current_noise(setup.noise_current_A, setup.coloured, 4.0, setup.noise_kind),
      motor_noise(setup.noise_motor_C, setup.coloured, 4.0, setup.noise_kind);
  const auto lost = [&] { return setup.missing_cells && random.chance(0.008); };
  const auto& in = out.drive.input;
  column("t_s", 3, [&](std::size_t k) { return out.drive.t_s[k]; });
  if (session.runs > 1) out.log.run = labels;
  if (!c.current_is_input) column("power_param", 0, [&](std::size_t k) { return in[k].power_param; });
  if (c.has_current)
    column("current_A", setup.current_decimals, [&](std::size_t k) {
      const double noisy = out.truth.current_A[k] + current_noise.next(random);
      return lost() && !c.current_is_input ? missing : noisy;
    });
  column("motor_C", 4, [&](std::size_t k) {
    const double noisy = quantise(out.truth.motor_C[k] + motor_noise.next(random), setup.quantum_motor_C);
    return k > 0 && lost() ? missing : noisy;
  });
  column("ambient_C", 4, [&](std::size_t k) {
    return quantise(in[k].ambient_C + setup.noise_ambient_C * random.gauss(), setup.quantum_ambient_C);
  });
  if (c.has_supply)
    column("supply_V", 3,
           [&](std::size_t k) { return in[k].supply_V + 0.001 * c.nominal_V * random.gauss(); });
  if (c.has_airspeed)
    column("airspeed_mps", 2, [&](std::size_t k) {
      return in[k].airspeed_mps > 0.0 ? std::max(0.0, in[k].airspeed_mps + 0.05 * random.gauss()) : 0.0;
    });
  if (c.has_neighbour)
    column("neighbour_C", 1, [&](std::size_t k) { return in[k].neighbour_C + 0.3 * random.gauss(); });
  if (c.has_rate) column("rate_dps", 2, [&](std::size_t k) { return in[k].rate_dps + 0.2 * random.gauss(); });
  double battery = 99.0 - random.uniform(0.0, 20.0), packets = random.integer(0, 4000);
  for (const auto& decoy : setup.decoys) {
    if (decoy == "humidity_pct") column(decoy, 1, [&](std::size_t k) { return humidity[k]; });
    if (decoy == "board_C") column(decoy, 1, [&](std::size_t k) { return board[k] + 0.1 * random.gauss(); });
    if (decoy == "battery_pct")
      column(decoy, 0,
             [&](std::size_t k) { return battery - 12.0 * static_cast<double>(k) / static_cast<double>(n); });
    if (decoy == "packet_counter")
      column(decoy, 0, [&](std::size_t) { return packets += random.chance(0.02) ? 2.0 : 1.0; });
    if (decoy == "rssi_dBm") column(decoy, 0, [&](std::size_t) { return -58.0 + 4.0 * random.gauss(); });
  }
  // What stands in the file is what counts, to the last decimal.
  for (auto& made : out.log.columns)
    for (auto& value : made.values) value = quantise(value, std::pow(10.0, -made.decimals));
  return out;
}

/// What anybody who replays the log has to go by.
inline BenchDrive drive_from_log(const BenchSetup& setup, const BenchRecording& recording) {
  const BenchContext& c = setup.context;
  BenchDrive drive = recording.drive;
  const auto filled = [&](const char* name) { return held(recording.log[name]); };
  const auto motor = filled("motor_C"), ambient = filled("ambient_C");
  for (std::size_t k = 0; k < drive.t_s.size(); ++k) {
    BenchInput& u = drive.input[k];
    u.ambient_C = ambient[k];
    u.hidden_W = recording.drive.input[k].hidden_W;
    if (!c.has_airspeed) u.airspeed_mps = 0.0;
    if (!c.has_rate) u.rate_dps = 0.0;
    if (!c.has_supply) u.supply_V = c.nominal_V;
  }
  const auto copy = [&](bool has, const char* name, double BenchInput::*member) {
    if (!has) return;
    const auto values = filled(name);
    for (std::size_t k = 0; k < values.size(); ++k) drive.input[k].*member = values[k];
  };
  copy(c.has_supply, "supply_V", &BenchInput::supply_V);
  copy(c.has_airspeed, "airspeed_mps", &BenchInput::airspeed_mps);
  copy(c.has_neighbour, "neighbour_C", &BenchInput::neighbour_C);
  copy(c.has_rate, "rate_dps", &BenchInput::rate_dps);
  copy(c.current_is_input, "current_A", &BenchInput::measured_current_A);
  for (std::size_t r = 0; r < drive.run_start.size(); ++r) drive.start_C[r] = motor[drive.run_start[r]];
  return drive;
}

}  // namespace gap_benchmark
