// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <set>
#include <string>

#include "axis_case.hpp"
#include "case.hpp"

namespace gap_benchmark {

constexpr double axis_horizon_s = 0.5;

inline nlohmann::ordered_json axis_model_json(const AxisSetup& s) {
  const AxisContext& c = s.context;
  nlohmann::ordered_json j;
  j["format"] = "thermopower-model/1";
  j["name"] = "bench axis";
  j["axis"] = {{"law", "rigid"},
               {"inertia_kgm2", c.model[inertia]},
               {"viscous_Nms_per_rad", c.model[viscous]},
               {"torque_constant_Nm_per_A", c.model[torque_constant]}};
  if (s.servo)
    j["servo"] = {{"law", "position_pid"},
                  {"kp_A_per_deg", s.kp_A_per_deg()},
                  {"kd_A_s_per_deg", s.kd_A_s_per_deg()},
                  {"limit_A", s.top_A},
                  {"period_s", c.dt_s}};
  return j;
}

/// An axis and a log, before any effect.
inline AxisSetup draw_axis(const std::vector<std::string>& wanted, Random& random) {
  const auto wants = [&](const char* id) { return std::count(wanted.begin(), wanted.end(), id) > 0; };
  AxisSetup s;
  AxisContext& c = s.context;
  AxisParameters& m = c.model;
  const auto digits = [](double value) {
    char t[32];
    std::snprintf(t, sizeof t, "%.4g", value);
    return std::stod(t);
  };
  m[inertia] = digits(random.log_uniform(3e-4, 4e-3));
  m[viscous] = digits(m[inertia] / random.log_uniform(0.3, 2.0));
  m[torque_constant] = digits(random.log_uniform(0.06, 0.26));
  c.plant = m;
  for (const int i : {inertia, viscous, torque_constant})
    c.plant[static_cast<std::size_t>(i)] *= 1.0 + random.uniform(-0.035, 0.035);
  c.dt_s = random.pick({0.001, 0.002, 0.004, 0.004, 0.005, 0.01, 0.01, 0.01, 0.02});
  if (wants("compliance") || wants("backlash")) c.dt_s = std::min(c.dt_s, 0.01);
  const bool by_warmth = wants("torque_fade") || wants("warm_friction");
  c.has_motor = by_warmth || random.chance(0.35);
  s.noise_angle_deg = random.log_uniform(0.006, 0.05);
  s.noise_rate_dps = random.log_uniform(0.05, 0.4);
  s.quantum_angle_deg = random.pick({0.0, 0.0, 0.0, 360.0 / 16384.0, 360.0 / 4096.0, 0.01});
  s.quantum_rate_dps = random.pick({0.0, 0.0, 0.061, 0.1});
  s.amplitude_deg = random.uniform(20.0, 60.0);
  s.bandwidth_Hz = std::min(random.uniform(1.5, 4.0), 0.05 / c.dt_s);
  if (wants("actuation_delay") || wants("drive_lag")) s.bandwidth_Hz = std::min(s.bandwidth_Hz, 2.2);
  const double brisk = m[inertia] * random.uniform(12.0, 30.0) + m[viscous] * 3.0;
  s.top_A = brisk / m[torque_constant];
  s.first_C = random.uniform(22.0, 32.0);
  s.rise_K = by_warmth ? random.uniform(25.0, 60.0) : random.uniform(5.0, 40.0);
  s.coloured = random.chance(0.3) ? random.uniform(0.05, 0.2) : 0.0;
  s.jitter = random.chance(0.12);
  s.missing_cells = random.chance(0.12);
  for (const char* decoy : {"packet_counter", "board_C", "battery_pct", "humidity_pct"})
    if (random.chance(0.12)) s.decoys.push_back(decoy);
  // Half of the bearings are greased. The simulation under test knows nothing of dry friction, so it is not told.
  const bool rubs = wants("coulomb_friction") || wants("asymmetric_friction") || wants("stribeck_friction") ||
                    wants("load_friction") || wants("drive_efficiency");
  if (rubs && random.chance(0.5)) c.model[film_dps] = c.plant[film_dps] = random.log_uniform(0.3, 3.0);
  s.plant = c.plant;
  return s;
}

inline void draw_unknown(AxisSetup& s, AxisUnknown unknown, Random& random) {
  const AxisContext& c = s.context;
  s.unknown = unknown;
  switch (unknown) {
    case AxisUnknown::slipping_clutch:
      s.plant[far_share] = random.uniform(0.35, 0.7);
      s.plant[clutch_Nm] = c.torque_Nm * random.uniform(0.25, 0.8);
      s.plant[clutch_dps] = random.log_uniform(2.0, 8.0);
      break;
    case AxisUnknown::notch:
      s.plant[notch_Nm] = c.torque_Nm * random.uniform(0.7, 2.0);
      s.plant[notch_deg] = random.uniform(-8.0, 8.0);
      s.plant[notch_width_deg] = random.uniform(1.5, 5.0);
      break;
    case AxisUnknown::run_out:
      s.plant[coulomb_Nm] = c.torque_Nm * random.uniform(0.2, 0.6);
      s.plant[run_out_share] = random.uniform(0.7, 0.98);
      s.plant[run_out_count] = random.pick({1.0, 2.0, 3.0});
      break;
    case AxisUnknown::warming_grease:
      s.plant[viscous] *= 1.02;
      s.plant[warming_share] = random.uniform(0.5, 0.85);
      s.plant[warming_s] = random.uniform(3.0, 10.0);
      break;
    case AxisUnknown::gusts:
      s.unknown_size = c.torque_Nm * random.uniform(0.1, 0.5);
      break;
    case AxisUnknown::wear:
      s.unknown_size = random.chance(0.6) ? random.uniform(2.0, 4.0) : random.uniform(0.2, 0.45);
      break;
    case AxisUnknown::hardening_cable:
      s.plant[hardening_Nm_per_rad3] =
          c.torque_Nm * random.uniform(0.1, 0.4) / (c.swing_rad * c.swing_rad * c.swing_rad);
      break;
    case AxisUnknown::vibration:
      s.unknown_size = c.torque_Nm * random.uniform(0.1, 0.5);
      s.unknown_time_s = 1.0 / random.uniform(2.0, 7.0);
      break;
    case AxisUnknown::weak_brake:
      s.plant[brake_share] = random.uniform(0.3, 0.7);
      break;
    case AxisUnknown::end_stop:
      s.plant[stop_deg] = c.swing_rad * degrees_per_radian * random.uniform(0.7, 1.2);
      s.plant[stop_Nm_per_rad] = c.torque_Nm * random.uniform(6.0, 25.0);
      break;
    case AxisUnknown::none:
      break;
  }
}

/// Gives a drawn effect another form than the catalogue's.
inline void draw_form(AxisSetup& s, OtherForm form, Random& random) {
  if (form == OtherForm::stribeck_exponent) s.plant[stribeck_exponent] = random.pick({1.0, 4.0});
  if (form == OtherForm::cogging_harmonic) {
    s.plant[cogging_second] = random.uniform(0.3, 0.8);
    s.plant[cogging_second_phase] = random.uniform(-3.1, 3.1);
  }
}

/// Noise-free residuals in windows of `window_s`, over at most `limit_s` of the recording.
inline Scenario<AxisParameters> axis_scenario(const AxisRecording& recording,
                                              const std::vector<double>& floors, double window_s,
                                              double limit_s) {
  Scenario<AxisParameters> scenario;
  scenario.signals = 2;
  AxisDrive drive = recording.drive;
  for (auto& u : drive.input) {
    u.hidden_Nm = 0.0;
    u.hidden_wear = 1.0;
  }
  const double dt = drive.t_s[1] - drive.t_s[0];
  const std::size_t rows = std::min(drive.t_s.size(), static_cast<std::size_t>(limit_s / dt));
  const std::size_t stride = std::max<std::size_t>(1, rows / 2500);
  const AxisOutput truth = recording.truth;
  scenario.residuals = [=](const AxisParameters& p) {
    const AxisOutput y = replay(p, drive, truth, window_s, 8.0, false, nullptr, rows);
    const auto n = static_cast<Eigen::Index>((rows + stride - 1) / stride);
    Eigen::VectorXd r(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i) * stride;
      r(i) = (y.rate_dps[k] - truth.rate_dps[k]) / floors[0];
      r(n + i) = (y.angle_deg[k] - truth.angle_deg[k]) / floors[1];
    }
    return r;
  };
  return scenario;
}

/// Squared error of a windowed replay per signal, over the rows that hold a measurement and did not restart.
inline void add_errors(const AxisParameters& parameters, const AxisDrive& drive,
                       const AxisRecording& recording, bool absolute, SquaredErrors& errors) {
  const AxisOutput measured{recording.log["angle_deg"], recording.log["rate_dps"]};
  std::vector<char> restarted;
  const AxisOutput y = replay(parameters, drive, measured, axis_horizon_s, 1.0, absolute, &restarted);
  for (std::size_t k = 0; k < restarted.size(); ++k) {
    if (restarted[k]) continue;
    if (!std::isnan(measured.angle_deg[k])) errors["angle_deg"].add(y.angle_deg[k] - measured.angle_deg[k]);
    if (!std::isnan(measured.rate_dps[k])) errors["rate_dps"].add(y.rate_dps[k] - measured.rate_dps[k]);
  }
}

/// The size of what a session asks of an axis: RMS of current, torque, rate and angle.
inline void measure_session(AxisSetup& s, const AxisSession& session, Random random) {
  AxisSetup bare = s;
  bare.plant = s.context.plant;
  bare.unknown = AxisUnknown::none;
  const AxisRecording trial = record(bare, session, random);
  SquaredError drive, rate, angle;
  for (std::size_t k = 0; k < trial.drive.t_s.size(); ++k) {
    drive.add(trial.drive.input[k].drive_A);
    rate.add(trial.truth.rate_dps[k]);
    angle.add(trial.truth.angle_deg[k]);
  }
  AxisContext& c = s.context;
  c.drive_A = drive.rms();
  c.torque_Nm = c.drive_A * c.model[torque_constant];
  c.rate_dps = rate.rms();
  c.swing_rad = std::max(0.1, angle.rms() / degrees_per_radian);
}

/// One case on an axis, drawn until its cause is plain in both recordings; throws when that does not happen.
inline DrawnCase draw_axis_case(const CaseOrder& order, Random& random) {
  int patience = 6;
  for (int attempt = 0; attempt < most_drawings(order, 80); ++attempt) {
    AxisSetup setup = draw_axis(order.effects, random);
    AxisContext& c = setup.context;
    setup.servo = c.servo = order.half == Half::servo;
    if (setup.servo) setup.jitter = false;  // it samples at the rows
    const auto motion = [&] {
      if (!setup.servo) return any_motion(random);
      return random.pick({Motion::follow_sines, Motion::follow_steps, Motion::follow_chirp});
    };
    AxisSession train{motion(), random.pick({25.0, 30.0, 40.0, 40.0, 60.0}), 0.0, 1, 0};
    while (train.length_s / c.dt_s > 22000.0) train.length_s *= 0.7;
    if (random.chance(0.15)) train.runs = random.integer(2, 3);
    AxisSession heldout = train;
    heldout.motion = random.chance(0.6) ? train.motion : motion();
    heldout.length_s *= 0.62;
    heldout.runs = 1;
    train.unknown_phase = random.uniform(0.0, 6.28);
    heldout.unknown_phase = random.uniform(0.0, 6.28);
    train.seed = random.bits();
    heldout.seed = random.bits();
    measure_session(setup, train, Random(random.bits()));
    setup.plant = c.plant;
    bool possible = true;
    for (const auto& id : order.effects) {
      const auto& effect = named(axis_effects(), id);
      if (!effect.possible(c)) possible = false;
      else effect.draw(random, c, setup.plant);
    }
    if (!possible) continue;
    draw_form(setup, order.form, random);
    setup.noise_kind = noise_kind(order);
    if (has(order.dirt, Dirt::coarse)) {
      setup.quantum_angle_deg = setup.noise_angle_deg * random.uniform(3.0, 6.0);
      setup.quantum_rate_dps = setup.noise_rate_dps * random.uniform(3.0, 6.0);
    }
    const auto unknown = static_cast<AxisUnknown>(order.unknown);
    draw_unknown(setup, unknown, random);

    const AxisRecording first = record(setup, train, Random(random.bits()));
    const AxisRecording second = record(setup, heldout, Random(random.bits()));
    double widest = 0.0, fastest = 0.0;
    for (const auto* recording : {&first, &second})
      for (std::size_t k = 0; k < recording->truth.angle_deg.size(); ++k) {
        widest = std::max(widest, std::fabs(recording->truth.angle_deg[k] / setup.plant[angle_gain]));
        fastest = std::max(fastest, std::fabs(recording->truth.rate_dps[k]));
      }
    if (!(widest < 4000.0) || !(fastest < 900.0)) continue;  // an unstable loop is a story of its own
    SquaredErrors before, perfect, literal;
    if (order.refitted)
      refit(c.model,
            axis_scenario(first, {setup.noise_rate_dps, setup.noise_angle_deg}, axis_horizon_s, 10.0),
            axis_slack(c));
    add_errors(c.model, drive_from_log(setup, second), second, false, before);
    add_errors(setup.plant, drive_from_log(setup, second), second, false, perfect);
    add_errors(setup.plant, drive_from_log(setup, second), second, true, literal);
    const std::vector<double> floors = {perfect["rate_dps"].rms(), perfect["angle_deg"].rms()};

    DrawnCase drawn;
    if (!order.effects.empty() || unknown != AxisUnknown::none) {
      const double limit_s = order.effects.size() == 2 ? 8.0 : 10.0;
      Inquiry inquiry{order.effects, order.thorough, order.gate};
      const auto judge = [&](double window_s) {
        return assess(axis_scenario(first, floors, window_s, limit_s),
                      axis_scenario(second, floors, window_s, limit_s), c, axis_effects(), axis_slack(c),
                      inquiry);
      };
      drawn.assessment = judge(axis_horizon_s);
      if (!drawn.assessment.is_within(order.gate, order.ceiling)) continue;
      if (order.thorough) {
        if (drawn.assessment.confusability() >= 0.9) {
          // What looks alike over half a second may not do so over three.
          const Assessment half_second = drawn.assessment;
          inquiry.seeds = &half_second;
          drawn.assessment.least(judge(3.0));
        }
        if (unknown != AxisUnknown::none && !drawn.assessment.beyond_catalogue()) continue;
        if (order.clear && drawn.assessment.confusability() >= 0.9 && --patience > 0) continue;
      }
    }
    SquaredErrors all_before = before, all_perfect = perfect;
    for (int i = 0; i < order.replicates; ++i) {
      const AxisRecording again = record(setup, heldout, Random(random.bits()));
      add_errors(c.model, drive_from_log(setup, again), again, false, all_before);
      add_errors(setup.plant, drive_from_log(setup, again), again, false, all_perfect);
    }
    drawn.model = axis_model_json(setup);
    drawn.train = first.log;
    drawn.heldout = second.log;
    auto& label = drawn.label;
    label["kind"] = "axis";
    label["effects"] = order.effects;
    // A torque that comes late and a servo that answers late are one where no current is logged.
    if (setup.servo && !order.effects.empty() && order.effects.front() == "actuation_delay")
      label["effects"] = {"servo_delay"};
    for (const auto& same : axis_same_physics()) {
      const std::set<std::string> truth(order.effects.begin(), order.effects.end());
      if (truth == std::set<std::string>(same.one.begin(), same.one.end()))
        label["same"].push_back(same.other);
      if (truth == std::set<std::string>(same.other.begin(), same.other.end()))
        label["same"].push_back(same.one);
    }
    label["unknown"] =
        unknown == AxisUnknown::none
            ? nlohmann::ordered_json()
            : nlohmann::ordered_json(axis_unknowns()[static_cast<std::size_t>(order.unknown) - 1].second);
    nlohmann::ordered_json where = nlohmann::ordered_json::array(), values = nlohmann::ordered_json::object();
    for (const auto& id : order.effects) {
      const auto& effect = named(axis_effects(), id);
      where.push_back({{"signals", effect.signals}, {"submodel", effect.submodel}});
      for (const auto& f : effect.suspect(c))
        values[id].push_back(setup.plant[static_cast<std::size_t>(f.index)]);
    }
    if (unknown != AxisUnknown::none)
      where.push_back({{"signals", {"rate_dps", "angle_deg"}},
                       {"submodel", unknown == AxisUnknown::slipping_clutch ? "mechanical.structure"
                                    : unknown == AxisUnknown::gusts || unknown == AxisUnknown::vibration ||
                                            unknown == AxisUnknown::end_stop
                                        ? "mechanical.load"
                                    : unknown == AxisUnknown::weak_brake ? "mechanical.drive"
                                                                         : "mechanical.friction"}});
    label["where"] = where;
    label["parameters"] = values;
    label["excitation"] = {name(train.motion), name(heldout.motion)};
    label["interval_s"] = c.dt_s;
    label["noise"] = {{"angle_deg", setup.noise_angle_deg}, {"rate_dps", setup.noise_rate_dps}};
    write_gap(label, before, perfect, all_before, all_perfect);
    for (const auto& entry : literal) label["gap"][entry.first]["floor_absolute"] = entry.second.rms();
    drawn.finish(order, random);
    return drawn;
  }
  throw std::runtime_error("no drawing of this kind passed the gate");
}

}  // namespace gap_benchmark
