// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

#include "assess.hpp"
#include "axis_effects.hpp"
#include "axis_replay.hpp"
#include "recording.hpp"

namespace gap_benchmark {

/// How somebody moves an axis: a position loop that follows something, or a bare current.
enum class Motion {
  follow_sines,
  follow_steps,
  follow_chirp,
  rate_staircase,
  open_sines,
  open_prbs,
  open_chirp
};

inline const char* name(Motion motion) {
  static const char* const names[] = {
      "closed loop, multisine", "closed loop, steps", "closed loop, chirp", "closed loop, rate staircase",
      "open loop, multisine",   "open loop, PRBS",    "open loop, chirp"};
  return names[static_cast<int>(motion)];
}

inline Motion any_motion(Random& random) {
  return random.pick({Motion::follow_sines, Motion::follow_sines, Motion::follow_steps, Motion::follow_chirp,
                      Motion::rate_staircase, Motion::open_sines, Motion::open_prbs, Motion::open_chirp});
}

/// Everything that stays the same between the recordings of one axis.
struct AxisSetup {
  AxisContext context;
  AxisParameters plant;  ///< with the effect
  AxisUnknown unknown = AxisUnknown::none;
  double noise_angle_deg = 0.02, noise_rate_dps = 0.15, quantum_angle_deg = 0.0, quantum_rate_dps = 0.0;
  double amplitude_deg = 40.0, bandwidth_Hz = 2.5, top_A = 1.0, first_C = 28.0, rise_K = 8.0, coloured = 0.0;
  NoiseKind noise_kind = NoiseKind::mild;
  bool jitter = false, missing_cells = false;
  std::vector<std::string> decoys;
  double unknown_size = 0.0, unknown_time_s = 1.0;
  bool servo = false;  ///< a position servo moves it, and the log holds the target

  /// Its gains, A/deg and A s/deg: those of the position loop that follows a goal, for the axis as it should be.
  double kp_A_per_deg() const {
    const double omega = 6.283185307179586 * bandwidth_Hz;
    return context.model[inertia] * omega * omega / degrees_per_radian / context.model[torque_constant];
  }
  double kd_A_s_per_deg() const {
    const double omega = 6.283185307179586 * bandwidth_Hz;
    return context.model[inertia] * 1.6 * omega / degrees_per_radian / context.model[torque_constant];
  }
};

/// What one experiment on the axis is: it can be done again, with other switching times and noise.
struct AxisSession {
  Motion motion = Motion::follow_sines;
  double length_s = 40.0, unknown_phase = 0.0;
  int runs = 1;
  std::uint64_t seed = 1;  ///< of what belongs to the experiment: frequencies, where it starts from
  /// A schedule: the current at each row, in the place of `motion`; the axis begins at 0. Empty: there is none.
  std::vector<double> commands_A = {};
};

struct AxisRecording {
  AxisDrive drive;
  AxisOutput truth;  ///< noise-free sensor values
  Recording log;
};

/// The command of a session, sample by sample.
class MotionSource {
public:
  MotionSource(const AxisSetup& setup, const AxisSession& session, Random& random)
      : setup_(setup), session_(session) {
    for (int i = 0; i < 4; ++i) {
      frequency_Hz_[i] = random.log_uniform(0.12, i == 3 ? 2.5 : 1.2);
      phase_[i] = random.uniform(0.0, 6.283);
      weight_[i] = random.uniform(0.15, 0.4);
    }
  }

  double next(Random& random, double t_s, double angle_deg, double rate_dps) {
    const AxisParameters& p = setup_.context.model;
    const double two_pi = 6.283185307179586;
    goal_deg = goal_dps = 0.0;
    switch (session_.motion) {
      case Motion::follow_sines:
        for (int i = 0; i < 4; ++i) {
          const double omega = two_pi * frequency_Hz_[i],
                       size = setup_.amplitude_deg * weight_[i] / (1.0 + frequency_Hz_[i]);
          goal_deg += 1.6 * size * std::sin(omega * t_s + phase_[i]);
          goal_dps += 1.6 * size * omega * std::cos(omega * t_s + phase_[i]);
        }
        break;
      case Motion::follow_steps:
        if (t_s >= until_s_) {
          level_ = setup_.amplitude_deg * random.uniform(-1.0, 1.0);
          until_s_ = t_s + random.log_uniform(0.3, 2.5);
        }
        smooth_ += (level_ - smooth_) * std::min(1.0, 6.0 * setup_.context.dt_s);
        goal_deg = smooth_;
        goal_dps = (level_ - smooth_) * 6.0;
        break;
      case Motion::follow_chirp: {
        const double span_s = 20.0, x = std::fmod(t_s, span_s) / span_s, low = 0.15, high = 2.5,
                     ratio = std::log(high / low);
        const double now_Hz = low * std::exp(ratio * x),
                     turn = two_pi * span_s * low * (std::exp(ratio * x) - 1.0) / ratio + phase_[0];
        const double size = setup_.amplitude_deg / (1.0 + 1.2 * now_Hz);
        goal_deg = size * std::sin(turn);
        goal_dps = size * two_pi * now_Hz * std::cos(turn);
        break;
      }
      case Motion::rate_staircase: {
        if (t_s >= until_s_) {
          level_ = setup_.amplitude_deg * 3.0 * random.integer(-4, 4) / 4.0;
          until_s_ = t_s + random.uniform(0.5, 2.0);
        }
        if (std::fabs(angle_deg) > 150.0 && level_ * angle_deg > 0.0) level_ = -level_;
        const double gain = two_pi * setup_.bandwidth_Hz * p[inertia];
        return clipped((gain * (level_ - rate_dps) + p[viscous] * level_) / degrees_per_radian /
                       p[torque_constant]);
      }
      case Motion::open_sines: {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) sum += weight_[i] * std::sin(two_pi * frequency_Hz_[i] * t_s + phase_[i]);
        return clipped(0.6 * setup_.top_A * sum + home(angle_deg));
      }
      case Motion::open_prbs:
        if (t_s >= until_s_) {
          level_ = 0.4 * setup_.top_A * random.sign();
          until_s_ = t_s + random.pick({0.1, 0.2, 0.2, 0.4});
        }
        return clipped(level_ + home(angle_deg));
      case Motion::open_chirp: {
        const double span_s = 15.0, x = std::fmod(t_s, span_s) / span_s, low = 0.3, high = 5.0,
                     ratio = std::log(high / low);
        return clipped(0.5 * setup_.top_A *
                           std::sin(two_pi * span_s * low * (std::exp(ratio * x) - 1.0) / ratio + phase_[0]) +
                       home(angle_deg));
      }
    }
    if (setup_.servo) {
      goal_deg = quantise(goal_deg, 1e-4);
      goal_dps = quantise(goal_dps, 1e-3);
      return clipped(setup_.kp_A_per_deg() * (goal_deg - angle_deg) +
                     setup_.kd_A_s_per_deg() * (goal_dps - rate_dps));
    }
    const double omega = two_pi * setup_.bandwidth_Hz;
    const double torque =
        p[inertia] * (omega * omega * (goal_deg - angle_deg) + 1.6 * omega * (goal_dps - rate_dps)) +
        p[viscous] * goal_dps;
    return clipped(torque / degrees_per_radian / p[torque_constant]);
  }

  double goal_deg = 0.0, goal_dps = 0.0;  ///< what was asked of a loop that follows a goal

private:
  const AxisSetup& setup_;
  const AxisSession& session_;
  double frequency_Hz_[4], phase_[4], weight_[4];
  double level_ = 0.0, smooth_ = 0.0, until_s_ = -1.0;

  double clipped(double current_A) const { return std::clamp(current_A, -setup_.top_A, setup_.top_A); }
  /// An open loop drifts away; a weak pull keeps it in the room.
  double home(double angle_deg) const {
    return -0.05 * setup_.top_A * std::clamp(angle_deg / 90.0, -2.0, 2.0);
  }
};

/// Moves the axis and writes down what the log would hold.
inline AxisRecording record(const AxisSetup& setup, const AxisSession& session, Random random) {
  const AxisContext& c = setup.context;
  const AxisPlant plant(setup.plant);
  AxisRecording out;
  out.drive.servo.closed = setup.servo;
  out.drive.servo.kp_A_per_deg = setup.kp_A_per_deg();
  out.drive.servo.kd_A_s_per_deg = setup.kd_A_s_per_deg();
  out.drive.servo.limit_A = setup.top_A;
  std::vector<std::string> labels;
  std::vector<double> board;
  for (int run = 0; run < session.runs; ++run) {
    Random fixed(session.seed + static_cast<std::uint64_t>(run));
    MotionSource source(setup, session, fixed);
    Wander gust(1.0, 0.4), warmth(0.15, 3.0);
    const double start_s = 0.0, length_s = session.length_s / session.runs;
    AxisState x;
    if (session.commands_A.empty())
      x.angle = x.far_angle = session.runs > 1 || fixed.chance(0.3) ? fixed.uniform(-0.3, 0.3) : 0.0;
    const std::size_t first = out.drive.t_s.size();
    out.drive.run_start.push_back(first);
    const double breaks_s = length_s * (0.35 + 0.3 * session.unknown_phase / 6.2832);
    for (std::size_t k = first;; ++k) {
      const auto n = static_cast<double>(k - first);
      if (n * c.dt_s >= length_s) break;
      double t = start_s + n * c.dt_s;
      if (setup.jitter && k > first) t += c.dt_s * random.uniform(-0.2, 0.2);
      t = std::round(t * 1e5) * 1e-5;
      out.drive.t_s.push_back(t);
      if (k > first) advance_row(plant, x, out.drive, first, k - 1, t);
      const double angle = plant.sensed_angle_deg(x, t - start_s), rate = plant.sensed_rate_dps(x);
      out.truth.angle_deg.push_back(angle);
      out.truth.rate_dps.push_back(rate);
      AxisInput u;
      // The loop closes over the sensors' noise; a wrong scale in the log is not in the loop.
      const double seen_deg = x.angle * degrees_per_radian + setup.noise_angle_deg * random.gauss(),
                   seen_dps = x.rate * degrees_per_radian + setup.noise_rate_dps * random.gauss();
      u.drive_A = session.commands_A.empty()
                      ? source.next(random, t, seen_deg, seen_dps)
                      : session.commands_A[std::min(k - first, session.commands_A.size() - 1)];
      out.drive.servo.target_deg.push_back(source.goal_deg);
      out.drive.servo.target_dps.push_back(source.goal_dps);
      if (setup.servo && plant.target_delay() > 0.0)
        u.drive_A = out.drive.servo.command_A(row_of_target(out.drive.t_s, first, k, plant.target_delay()),
                                              seen_deg, seen_dps);
      u.drive_A = quantise(u.drive_A, 1e-5);
      // The motor warms up, and cools in a pause of the bench: both directions in every recording.
      u.motor_C = setup.first_C + setup.rise_K * 0.5 * (1.0 - std::cos(6.283 * t / (0.8 * length_s))) +
                  warmth.next(random, c.dt_s);
      switch (setup.unknown) {
        case AxisUnknown::gusts:
          u.hidden_Nm = setup.unknown_size * gust.next(random, c.dt_s);
          break;
        case AxisUnknown::vibration:
          u.hidden_Nm =
              setup.unknown_size * std::sin(6.2831853 * t / setup.unknown_time_s + session.unknown_phase);
          break;
        case AxisUnknown::wear:
          u.hidden_wear = t > breaks_s ? setup.unknown_size : 1.0;
          break;
        default:
          break;
      }
      out.drive.input.push_back(u);
      labels.push_back("run" + std::to_string(run + 1));
      board.push_back(36.0 + 3.0 * std::sin(t / 17.0));
    }
  }
  const std::size_t n = out.drive.t_s.size();
  const auto column = [&](const std::string& title, int decimals, auto value) {
    Column made{title, decimals, {}};
    for (std::size_t k = 0; k < n; ++k) made.values.push_back(quantise(value(k), std::pow(10.0, -decimals)));
    out.log.columns.push_back(std::move(made));
  };
  SensorNoise angle_noise(setup.noise_angle_deg, setup.coloured, 4.0, setup.noise_kind),
      rate_noise(setup.noise_rate_dps, setup.coloured, 4.0, setup.noise_kind);
  const auto lost = [&](std::size_t k) { return k > 0 && setup.missing_cells && random.chance(0.006); };
  column("t_s", 5, [&](std::size_t k) { return out.drive.t_s[k]; });
  if (session.runs > 1) out.log.run = labels;
  if (setup.servo) {
    column("target_deg", 4, [&](std::size_t k) { return out.drive.servo.target_deg[k]; });
    column("target_dps", 3, [&](std::size_t k) { return out.drive.servo.target_dps[k]; });
  } else {
    column("drive_A", 5, [&](std::size_t k) { return out.drive.input[k].drive_A; });
  }
  column("angle_deg", 4, [&](std::size_t k) {
    const double noisy = quantise(out.truth.angle_deg[k] + angle_noise.next(random), setup.quantum_angle_deg);
    return lost(k) ? missing : noisy;
  });
  column("rate_dps", 3, [&](std::size_t k) {
    const double noisy = quantise(out.truth.rate_dps[k] + rate_noise.next(random), setup.quantum_rate_dps);
    return lost(k) ? missing : noisy;
  });
  if (c.has_motor)
    column("motor_C", 1, [&](std::size_t k) { return out.drive.input[k].motor_C + 0.05 * random.gauss(); });
  double packets = random.integer(0, 30000);
  for (const auto& decoy : setup.decoys) {
    if (decoy == "packet_counter") column(decoy, 0, [&](std::size_t) { return packets += 1.0; });
    if (decoy == "board_C") column(decoy, 1, [&](std::size_t k) { return board[k] + 0.1 * random.gauss(); });
    if (decoy == "battery_pct")
      column(decoy, 0,
             [&](std::size_t k) { return 97.0 - 4.0 * static_cast<double>(k) / static_cast<double>(n); });
    if (decoy == "humidity_pct")
      column(decoy, 1,
             [&](std::size_t k) { return 41.0 + 0.4 * random.gauss() + std::sin(out.drive.t_s[k] / 9.0); });
  }
  return out;
}

/// What anybody who replays the log has to go by.
inline AxisDrive drive_from_log(const AxisSetup& setup, const AxisRecording& recording) {
  AxisDrive drive = recording.drive;
  if (setup.context.has_motor)
    for (std::size_t k = 0; k < drive.t_s.size(); ++k) drive.input[k].motor_C = recording.log["motor_C"][k];
  return drive;
}

}  // namespace gap_benchmark
