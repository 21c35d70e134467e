// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <filesystem>
#include <fstream>

#include "bench_case.hpp"
#include "case.hpp"

namespace gap_benchmark {

inline nlohmann::ordered_json bench_model_json(const BenchContext& c) {
  nlohmann::ordered_json j;
  j["format"] = "thermopower-model/1";
  j["name"] = "bench motor";
  const auto& m = c.model;
  if (!c.current_is_input) j["supply"] = {{"nominal_V", c.nominal_V}};
  if (c.thesis()) {
    j["current"] = {{"law", "thesis"},
                    {"slope_V2_mA_per_K", m[slope_V2]},
                    {"slope_V1_mA_per_K", m[slope_V1]},
                    {"slope_V0_mA_per_K", m[slope_V0]},
                    {"base_mA", m[base_mA]},
                    {"exponent", m[exponent]},
                    {"minimum_V_rms", 1.0}};
    j["thermal"] = {{"law", "thesis"},
                    {"cooling_per_min", m[cooling_per_min]},
                    {"rinv_slope_V1", m[rinv_slope_V1]},
                    {"rinv_slope_V0", m[rinv_slope_V0]},
                    {"rinv_offset_V1", m[rinv_offset_V1]},
                    {"rinv_offset_V0", m[rinv_offset_V0]},
                    {"minimum_V_rms", 1.0}};
  } else {
    j["current"] = {{"law", "ohmic"},
                    {"resistance_ohm", m[resistance_ohm]},
                    {"tempco_per_K", m[tempco_per_K]},
                    {"reference_C", m[reference_C]}};
    j["thermal"] = {{"law", "lumped"},
                    {"heat_capacity_J_per_K", m[heat_capacity]},
                    {"conductance_W_per_K", m[conductance]}};
  }
  return j;
}

/// A motor, a bench and a log, before any effect. `wanted` are the causes that have to be possible on it.
inline BenchSetup draw_bench(const std::vector<std::string>& wanted, bool thesis, Random& random) {
  const auto wants = [&](const char* id) { return std::count(wanted.begin(), wanted.end(), id) > 0; };
  BenchSetup s;
  BenchContext& c = s.context;
  BenchParameters& m = c.model;
  c.nominal_V = random.pick({7.4, 11.1, 12.0, 13.0, 14.8, 22.2, 24.0});
  double top_rise_K = random.uniform(45.0, 95.0);
  if (thesis) {
    c.nominal_V = 13.0;
    m[thesis_law] = 1.0;
    m[slope_V2] = -0.0134;
    m[slope_V1] = 0.0156;
    m[slope_V0] = 0.0167;
    m[base_mA] = 0.1551;
    m[exponent] = 3.4591;
    m[cooling_per_min] = 0.11;
    m[rinv_slope_V1] = -0.0002;
    m[rinv_slope_V0] = 0.0062;
    m[rinv_offset_V1] = 0.0255;
    m[rinv_offset_V0] = -0.105;
    const double bigger = random.uniform(0.7, 1.5);  // other motors of the family
    for (const int i : {rinv_slope_V1, rinv_slope_V0, rinv_offset_V1, rinv_offset_V0})
      m[static_cast<std::size_t>(i)] *= bigger;
    m[cooling_per_min] *= random.uniform(0.6, 1.3);
    m[heat_capacity] = 60.0 * 0.3 * bigger;
    m[conductance] = m[heat_capacity] * m[cooling_per_min] / 60.0;
    s.tau_s = 60.0 / m[cooling_per_min];
    s.top_power = random.uniform(90.0, 170.0);
    s.limit_C = random.uniform(60.0, 85.0);
    c.top_A = 0.3;
    c.top_W = 2.0;
  } else {
    m[resistance_ohm] = random.log_uniform(2.0, 26.0);
    m[reference_C] = random.pick({20.0, 25.0, 25.0});
    c.top_A = c.nominal_V / m[resistance_ohm];
    c.top_W = c.nominal_V * c.top_A;
    s.tau_s = random.log_uniform(120.0, 520.0);
    m[conductance] = c.top_W / top_rise_K;
    m[heat_capacity] = m[conductance] * s.tau_s;
    if (wants("winding_tempco") || (wanted.empty() && random.chance(0.05))) c.knows_tempco = false;
    s.limit_C = 22.0 + top_rise_K * random.uniform(0.6, 0.95);
  }
  const auto digits = [](double value) {
    return std::stod([&] {
      char t[32];
      std::snprintf(t, sizeof t, "%.5g", value);
      return std::string(t);
    }());
  };
  for (auto& value : m) value = digits(value);

  const double off = thesis ? 0.02 : 0.035;
  c.plant = m;
  for (const auto& f : bench_slack(c, 1.0)) {
    const auto i = static_cast<std::size_t>(f.index);
    c.plant[i] = m[i] * (1.0 + random.uniform(-off, off));
  }
  // Copper is copper: without a coefficient in the model there must be none in the motor, unless that is the
  // story.
  if (!c.knows_tempco) m[tempco_per_K] = c.plant[tempco_per_K] = 0.0;
  c.has_airspeed = wants("forced_airflow") || random.chance(0.25);
  c.has_neighbour = wants("neighbour_heating") || random.chance(0.25);
  c.has_rate = wants("motion_heating") || wants("iron_loss") || wants("back_emf") || random.chance(0.2);
  c.has_supply = !wants("supply_sag") && random.chance(0.6);
  bool electrical = false;
  for (const auto& id : wanted) {
    const auto& e = named(bench_effects(), id);
    electrical = electrical || e.signals.front() == "current_A";
  }
  if (!electrical && !thesis && random.chance(0.12)) {
    if (random.chance(0.5)) {
      c.current_is_input = true;
      c.has_supply = false;
    } else {
      c.has_current = false;
    }
  }
  s.dt_s = random.pick({0.1, 0.2, 0.5, 1.0, 1.0, 2.0, 2.0, 5.0});
  s.dt_s = std::min(s.dt_s, s.tau_s / 60.0);
  s.dt_s = s.dt_s > 3.0 ? 5.0 : s.dt_s;
  c.length_s = s.tau_s * random.uniform(5.5, 9.0);
  while (c.length_s / s.dt_s > 16000.0) s.dt_s *= 2.0;
  s.dt_s = std::round(s.dt_s * 1e3) * 1e-3;
  s.noise_motor_C = random.log_uniform(0.03, 0.2);
  s.quantum_motor_C = random.pick({0.1, 0.1, 0.1, 0.0625, 0.01, 0.0});
  s.quantum_ambient_C = random.pick({0.01, 0.01, 0.1});
  s.noise_ambient_C = random.uniform(0.02, 0.07);
  s.noise_current_A = c.top_A * random.log_uniform(0.0015, 0.006);
  s.current_decimals = s.noise_current_A < 0.002 ? 4 : 3;
  s.coloured = random.chance(0.35) ? random.uniform(0.05, 0.2) : 0.0;
  s.jitter = random.chance(0.15);
  s.gaps = random.chance(0.12);
  s.missing_cells = random.chance(0.15);
  s.warm_start = random.chance(0.4);
  for (const char* decoy : {"humidity_pct", "board_C", "battery_pct", "packet_counter", "rssi_dBm"})
    if (random.chance(0.14)) s.decoys.push_back(decoy);
  s.plant = c.plant;
  return s;
}

inline void draw_unknown(BenchSetup& s, BenchUnknown unknown, Random& random) {
  const BenchContext& c = s.context;
  s.unknown = unknown;
  switch (unknown) {
    case BenchUnknown::periodic_heat:
      s.unknown_size = c.top_W * random.uniform(0.08, 0.3);
      s.unknown_time_s = s.tau_s * random.log_uniform(0.4, 1.3);
      break;
    case BenchUnknown::random_heat:
      s.unknown_size = c.top_W * random.uniform(0.1, 0.35);
      s.unknown_time_s = s.tau_s * random.log_uniform(0.3, 0.9);
      break;
    case BenchUnknown::melting:
      s.plant[latent_J] = s.plant[heat_capacity] * random.uniform(8.0, 30.0);
      s.plant[melting_C] = random.uniform(38.0, 55.0);
      s.plant[melting_width_K] = random.uniform(0.3, 0.8);
      break;
    case BenchUnknown::intermittent_contact:
      s.unknown_size = s.plant[resistance_ohm] * random.uniform(0.06, 0.3);
      s.unknown_time_s = s.tau_s * random.log_uniform(0.1, 0.6);
      break;
    case BenchUnknown::hidden_fan:
      s.plant[fan_gain] = random.uniform(0.5, 1.5);
      s.plant[fan_on_C] = random.uniform(46.0, 62.0);
      s.plant[fan_off_C] = s.plant[fan_on_C] - random.uniform(3.0, 14.0);
      break;
    case BenchUnknown::loosening:
      s.unknown_size = random.uniform(0.5, 0.8);
      break;
    case BenchUnknown::draughts:
      s.unknown_size = random.uniform(0.5, 1.0);
      break;
    case BenchUnknown::shorted_turns:
      s.plant[short_share] = random.uniform(0.08, 0.25);
      s.plant[short_C] = random.uniform(42.0, 60.0);
      break;
    case BenchUnknown::none:
      break;
  }
}

/// Gives a drawn effect another form than the catalogue's.
inline void draw_form(BenchSetup& s, OtherForm form, Random& random) {
  const BenchContext& c = s.context;
  if (form == OtherForm::third_node) {
    s.plant[soak_J_per_K] = s.plant[heat_capacity] * random.uniform(0.15, 0.5);
    s.plant[soak_W_per_K] = s.plant[conductance] * random.log_uniform(0.5, 3.0);
  }
  if (form == OtherForm::curved_sensor) {
    const double bend = random.sign() * random.uniform(0.1, 0.25);
    s.plant[current_curve_per_A] = bend / c.top_A;
  }
}

inline Scenario<BenchParameters> bench_scenario(const BenchSetup& setup, const BenchRecording& recording,
                                                const std::vector<double>& floors) {
  Scenario<BenchParameters> scenario;
  const bool current = setup.context.has_current && !setup.context.current_is_input;
  scenario.signals = current ? 2 : 1;
  const std::size_t stride = std::max<std::size_t>(1, recording.drive.t_s.size() / 1500);
  BenchDrive drive = recording.drive;
  const BenchOutput truth = recording.truth;
  const bool in_current = setup.context.current_is_input;
  for (auto& u : drive.input) {
    u.hidden_W = u.hidden_ohm = 0.0;
    u.hidden_loss = 1.0;
    if (!in_current) u.measured_current_A = -1.0;
  }
  scenario.residuals = [=](const BenchParameters& p) {
    const BenchOutput y = replay(p, drive, 2.0);
    const auto rows = static_cast<Eigen::Index>((drive.t_s.size() + stride - 1) / stride);
    Eigen::VectorXd r(rows * (current ? 2 : 1));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto k = static_cast<std::size_t>(i) * stride;
      r(i) = (y.motor_C[k] - truth.motor_C[k]) / floors[0];
      if (current) r(rows + i) = (y.current_A[k] - truth.current_A[k]) / floors[1];
    }
    return r;
  };
  return scenario;
}

/// Squared error of a replay per signal, over the rows that hold a measurement.
inline void add_errors(const BenchOutput& y, const BenchRecording& recording, SquaredErrors& errors) {
  errors["motor_C"].add(y.motor_C, recording.log["motor_C"]);
  if (recording.log.has("current_A") && recording.log.has("power_param"))
    errors["current_A"].add(y.current_A, recording.log["current_A"]);
}

/// One case on the bench, drawn until its cause is plain in both recordings; throws when that does not
/// happen.
inline DrawnCase draw_bench_case(const CaseOrder& order, Random& random) {
  int patience = 8;
  for (int attempt = 0; attempt < most_drawings(order, 100); ++attempt) {
    BenchSetup setup = draw_bench(order.effects, order.thesis, random);
    const BenchContext& c = setup.context;
    bool possible = true;
    for (const auto& id : order.effects) {
      const auto& effect = named(bench_effects(), id);
      if (!effect.possible(c)) possible = false;
      else effect.draw(random, c, setup.plant);
    }
    if (!possible) continue;
    draw_form(setup, order.form, random);
    setup.noise_kind = noise_kind(order);
    if (has(order.dirt, Dirt::coarse)) {
      setup.quantum_motor_C = setup.noise_motor_C * random.uniform(3.0, 6.0);
      setup.current_decimals = setup.noise_current_A > 0.0025 ? 2 : 3;
    }
    const auto unknown = static_cast<BenchUnknown>(order.unknown);
    if (unknown == BenchUnknown::intermittent_contact && (!c.has_current || c.current_is_input)) continue;
    draw_unknown(setup, unknown, random);
    const bool thresholds = unknown == BenchUnknown::melting || unknown == BenchUnknown::hidden_fan ||
                            unknown == BenchUnknown::shorted_turns;
    BenchSession train{PowerProfile::any(random),
                       c.length_s,
                       random.uniform(16.0, 30.0),
                       0.0,
                       random.uniform(0.0, 6.28),
                       1,
                       random.bits()};
    if (random.chance(0.2)) {
      train.runs = random.integer(2, 3);
      setup.warm_start = false;
      train.run_gap_K = random.uniform(0.0, 12.0);
    }
    BenchSession heldout = train;
    heldout.kind = PowerProfile::any(random);
    heldout.length_s *= 0.6;
    heldout.runs = 1;
    heldout.unknown_phase = random.uniform(0.0, 6.28);
    heldout.seed = random.bits();
    if (!thresholds) heldout.ambient_C = random.uniform(16.0, 30.0);

    const BenchRecording first = record(setup, train, Random(random.bits()));
    const BenchRecording second = record(setup, heldout, Random(random.bits()));
    SquaredErrors before, perfect;
    if (order.refitted) {
      const std::vector<double> unit = {setup.noise_motor_C, setup.noise_current_A};
      refit(setup.context.model, bench_scenario(setup, first, unit), bench_slack(c));
    }
    add_errors(replay(c.model, drive_from_log(setup, second)), second, before);
    add_errors(replay(second.exact, drive_from_log(setup, second)), second, perfect);
    std::vector<double> floors = {perfect["motor_C"].rms()};
    if (perfect.count("current_A")) floors.push_back(perfect["current_A"].rms());

    DrawnCase drawn;
    if (!order.effects.empty() || unknown != BenchUnknown::none) {
      Inquiry inquiry{order.effects, order.thorough, order.gate};
      if (unknown != BenchUnknown::none || (order.clear && patience > 1)) inquiry.hopeless = 0.9;
      drawn.assessment = assess(bench_scenario(setup, first, floors), bench_scenario(setup, second, floors),
                                c, bench_effects(), bench_slack(c), inquiry);
      if (!drawn.assessment.is_within(order.gate, order.ceiling)) continue;
      if (order.thorough) {
        if (unknown != BenchUnknown::none && !drawn.assessment.beyond_catalogue()) continue;
        if (order.clear && drawn.assessment.confusability() >= 0.9 && --patience > 0) continue;
      }
    }
    // The shrinkage of the population: more held-out recordings of the same kind.
    SquaredErrors all_before = before, all_perfect = perfect;
    for (int i = 0; i < order.replicates; ++i) {
      const BenchRecording again = record(setup, heldout, Random(random.bits()));
      add_errors(replay(c.model, drive_from_log(setup, again)), again, all_before);
      add_errors(replay(again.exact, drive_from_log(setup, again)), again, all_perfect);
    }
    drawn.model = bench_model_json(c);
    drawn.train = first.log;
    drawn.heldout = second.log;
    auto& label = drawn.label;
    label["kind"] = c.thesis() ? "thesis" : "bench";
    label["effects"] = order.effects;
    label["unknown"] =
        unknown == BenchUnknown::none
            ? nlohmann::ordered_json()
            : nlohmann::ordered_json(bench_unknowns()[static_cast<std::size_t>(order.unknown) - 1].second);
    nlohmann::ordered_json where = nlohmann::ordered_json::array(), values = nlohmann::ordered_json::object();
    for (const auto& id : order.effects) {
      const auto& effect = named(bench_effects(), id);
      where.push_back({{"signals", effect.signals}, {"submodel", effect.submodel}});
      for (const auto& f : effect.suspect(c))
        values[id].push_back(setup.plant[static_cast<std::size_t>(f.index)]);
    }
    if (unknown == BenchUnknown::intermittent_contact || unknown == BenchUnknown::shorted_turns)
      where.push_back({{"signals", {"current_A"}}, {"submodel", "electrical"}});
    else if (unknown != BenchUnknown::none)
      where.push_back(
          {{"signals", {"motor_C"}},
           {"submodel", unknown == BenchUnknown::melting ? "thermal.storage"
                        : unknown == BenchUnknown::periodic_heat || unknown == BenchUnknown::random_heat
                            ? "thermal.heating"
                            : "thermal.loss"}});
    label["where"] = where;
    label["parameters"] = values;
    label["excitation"] = {PowerProfile::name(train.kind), PowerProfile::name(heldout.kind)};
    label["interval_s"] = setup.dt_s;
    label["noise"] = {{"current_A", setup.noise_current_A},
                      {"motor_C", setup.noise_motor_C},
                      {"ambient_C", setup.noise_ambient_C}};
    write_gap(label, before, perfect, all_before, all_perfect);
    drawn.finish(order, random);
    return drawn;
  }
  throw std::runtime_error("no drawing of this kind passed the gate");
}

}  // namespace gap_benchmark
