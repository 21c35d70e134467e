// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "axis_draw.hpp"
#include "part.hpp"

namespace gap_benchmark {

/// A controller of a joint: it asks for an effort in A, once a row.
struct LoopGains {
  double kp_A_per_rad = 0.0, kd_A_s_per_rad = 0.0, ki_A_per_rad_s = 0.0, limit_A = 1.0;
};

/// Effects whose kind can be told from the effort of a joint, with those that are of the same kind.
inline const std::vector<std::pair<std::string, std::vector<std::string>>>& loop_families() {
  static const std::vector<std::string> dry = {"coulomb_friction",  "asymmetric_friction",
                                               "stribeck_friction", "presliding_friction",
                                               "load_friction",     "drive_efficiency"};
  static const std::vector<std::pair<std::string, std::vector<std::string>>> list = {
      {"coulomb_friction", dry},
      {"stribeck_friction", dry},
      {"load_friction", dry},
      {"imbalance", {"imbalance"}},
      {"cable_spring", {"cable_spring"}},
      {"cogging", {"cogging"}},
      {"constant_torque", {"constant_torque", "asymmetric_friction"}},
      {"quadratic_drag", {"quadratic_drag"}}};
  return list;
}

/// What a joint is asked to follow, in rad and rad/s.
class LoopTarget {
public:
  LoopTarget(Random& random, double size_rad, double fastest_Hz) : size_rad_(size_rad) {
    for (int i = 0; i < 4; ++i) {
      hertz_[i] = random.log_uniform(0.06, fastest_Hz);
      phase_[i] = random.uniform(0.0, 6.28);
    }
  }
  double angle(double t_s) const { return sum(t_s, 0); }
  double rate(double t_s) const { return sum(t_s, 1); }

private:
  double sum(double t_s, int derivative) const {
    double value = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double omega = 6.283185307179586 * hertz_[i], size = size_rad_ / 4.0;
      value += derivative == 0 ? size * (std::sin(omega * t_s + phase_[i]) - std::sin(phase_[i]))
                               : size * omega * std::cos(omega * t_s + phase_[i]);
    }
    return value;
  }

  double size_rad_, hertz_[4], phase_[4];
};

/// A joint that follows a target under its controller, as it is: nothing of the log's noise is in the effort.
inline AxisRecording follow(const AxisSetup& setup, const AxisParameters& parameters, const LoopGains& gains,
                            const LoopTarget& target, double length_s, std::uint64_t seed) {
  const AxisPlant plant(parameters);
  Random random(seed);
  AxisRecording out;
  out.drive.run_start = {0};
  AxisState x;
  double integral = 0.0;
  const double dt_s = setup.context.dt_s;
  for (std::size_t k = 0; static_cast<double>(k) * dt_s < length_s; ++k) {
    const double t_s = std::round(static_cast<double>(k) * dt_s * 1e5) * 1e-5;
    out.drive.t_s.push_back(t_s);
    if (k > 0) advance_row(plant, x, out.drive, 0, k - 1, t_s);
    out.truth.angle_deg.push_back(plant.sensed_angle_deg(x, t_s));
    out.truth.rate_dps.push_back(plant.sensed_rate_dps(x));
    const double error = target.angle(t_s) - x.angle -
                         setup.noise_angle_deg / degrees_per_radian * random.gauss(),
                 late =
                     target.rate(t_s) - x.rate - setup.noise_rate_dps / degrees_per_radian * random.gauss();
    integral += error * dt_s;
    const double most = gains.ki_A_per_rad_s > 0.0 ? gains.limit_A / gains.ki_A_per_rad_s : 0.0;
    integral = std::clamp(integral, -most, most);
    AxisInput u;
    u.drive_A =
        std::clamp(gains.kp_A_per_rad * error + gains.kd_A_s_per_rad * late + gains.ki_A_per_rad_s * integral,
                   -gains.limit_A, gains.limit_A);
    out.drive.input.push_back(u);
    out.drive.servo.target_deg.push_back(target.angle(t_s) * degrees_per_radian);
    out.drive.servo.target_dps.push_back(target.rate(t_s) * degrees_per_radian);
  }
  return out;
}

/// Writes the log of a joint, the effort measured with noise.
inline void write_loop_log(const AxisSetup& setup, AxisRecording& recording, double effort_noise_A,
                           bool with_target, Random& random) {
  const std::size_t rows = recording.drive.t_s.size();
  const auto column = [&](const std::string& title, int decimals, auto value) {
    Column made{title, decimals, {}};
    for (std::size_t k = 0; k < rows; ++k)
      made.values.push_back(quantise(value(k), std::pow(10.0, -decimals)));
    recording.log.columns.push_back(std::move(made));
  };
  column("t_s", 5, [&](std::size_t k) { return recording.drive.t_s[k]; });
  if (with_target)
    column("target_deg", 4, [&](std::size_t k) { return recording.drive.servo.target_deg[k]; });
  column("drive_A", 5,
         [&](std::size_t k) { return recording.drive.input[k].drive_A + effort_noise_A * random.gauss(); });
  column("angle_deg", 4, [&](std::size_t k) {
    return quantise(recording.truth.angle_deg[k] + setup.noise_angle_deg * random.gauss(),
                    setup.quantum_angle_deg);
  });
  column("rate_dps", 3, [&](std::size_t k) {
    return quantise(recording.truth.rate_dps[k] + setup.noise_rate_dps * random.gauss(),
                    setup.quantum_rate_dps);
  });
}

/// RMS of the effort.
inline double effort_rms(const AxisRecording& recording) {
  SquaredError sum;
  for (const AxisInput& u : recording.drive.input) sum.add(u.drive_A);
  return sum.rms();
}

/// One joint in a closed loop. @param number  of the case: its effect, and how well its constants are known
inline DrawnCase draw_closed_loop_case(int number, Random& random) {
  const auto& families = loop_families();
  const bool none = number % 5 == 4;
  const auto& family = families[static_cast<std::size_t>(number - number / 5) % families.size()];
  const int knowledge = (number / 5 + number) % 3;  // known, guessed, bent by a fit
  static const char* const known[] = {"known", "guessed", "fitted without it"};
  for (int attempt = 0; attempt < 60; ++attempt) {
    const std::vector<std::string> effects =
        none ? std::vector<std::string>() : std::vector<std::string>{family.first};
    AxisSetup setup = draw_axis(effects, random);
    AxisContext& c = setup.context;
    c.has_motor = false;
    c.dt_s = random.pick({0.002, 0.004, 0.005, 0.01, 0.02});
    const double length_s = std::min(random.pick({20.0, 30.0, 40.0}), 8000.0 * c.dt_s);
    const double stiffness_Hz = std::min(random.pick({2.0, 4.0, 8.0}), 0.08 / c.dt_s),
                 omega = 6.283185307179586 * stiffness_Hz;
    LoopGains gains;
    gains.kp_A_per_rad = c.model[inertia] * omega * omega / c.model[torque_constant];
    gains.kd_A_s_per_rad = 1.4 * c.model[inertia] * omega / c.model[torque_constant];
    if (random.chance(0.5)) gains.ki_A_per_rad_s = 0.25 * omega * gains.kp_A_per_rad;
    gains.limit_A = 20.0 * setup.top_A;
    const double size_rad = random.uniform(2.0, 6.0), fastest_Hz = std::min(1.0, 0.3 * stiffness_Hz);
    const LoopTarget train(random, size_rad, fastest_Hz), heldout(random, size_rad, fastest_Hz);
    const std::uint64_t seed = random.bits();
    const AxisRecording plain = follow(setup, c.plant, gains, train, length_s, seed);
    c.drive_A = effort_rms(plain);
    c.torque_Nm = c.drive_A * c.model[torque_constant];
    SquaredError rate, angle;
    for (const double one : plain.truth.rate_dps) rate.add(one);
    for (const double one : plain.truth.angle_deg) angle.add(one);
    c.rate_dps = rate.rms();
    c.swing_rad = std::max(0.1, angle.rms() / degrees_per_radian);
    setup.plant = c.plant;
    for (const auto& id : effects) named(axis_effects(), id).draw(random, c, setup.plant);
    AxisRecording first = follow(setup, setup.plant, gains, train, length_s, seed),
                  second = follow(setup, setup.plant, gains, heldout, 0.7 * length_s, random.bits());
    // The effect must be a good part of the effort, or nobody sees it.
    const double noise_A = effort_rms(first) * random.uniform(0.02, 0.12);
    SquaredError by_effect;
    for (std::size_t k = 0; k < first.drive.input.size(); ++k)
      by_effect.add(first.drive.input[k].drive_A - plain.drive.input[k].drive_A);
    if (!none && !(by_effect.rms() > 0.15 * effort_rms(first))) continue;
    bool held = true;
    for (const AxisRecording* one : {&first, &second})
      for (std::size_t k = 0; k < one->drive.t_s.size(); ++k)
        held = held && std::fabs(one->truth.angle_deg[k] - one->drive.servo.target_deg[k]) < 60.0;
    if (!held) continue;
    const bool with_target = random.chance(0.5);
    for (AxisRecording* one : {&first, &second}) write_loop_log(setup, *one, noise_A, with_target, random);
    if (knowledge == 1)
      for (const int i : {inertia, viscous, torque_constant})
        c.model[static_cast<std::size_t>(i)] =
            five_digits(c.model[static_cast<std::size_t>(i)] * std::exp(random.uniform(-0.35, 0.35)));
    if (knowledge == 2)
      refit(c.model,
            axis_scenario(first, {setup.noise_rate_dps, setup.noise_angle_deg}, axis_horizon_s, 10.0),
            axis_slack(c));
    DrawnCase drawn;
    drawn.model = axis_model_json(setup);
    if (knowledge == 1)
      drawn.model["axis"]["uncertainty"] = {
          {"inertia_kgm2", 0.35}, {"viscous_Nms_per_rad", 0.35}, {"torque_constant_Nm_per_A", 0.35}};
    drawn.train = first.log;
    drawn.heldout = second.log;
    PartTruth truth;
    truth.title = (none ? std::string("none") : family.first) + ", constants " + known[knowledge] +
                  (gains.ki_A_per_rad_s > 0.0 ? ", PID" : ", PD");
    truth.causes = effects;
    if (!none) truth.family = family.second;
    drawn.label = truth.label(Part::closed_loops, "axis");
    return drawn;
  }
  throw std::runtime_error("no joint of this kind followed its target");
}

}  // namespace gap_benchmark
