// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench_plant.hpp"
#include "effect.hpp"

namespace gap_benchmark {

/// What an effect's size is chosen against.
struct BenchContext {
  BenchParameters model = bench_defaults();  ///< what model.json says
  BenchParameters plant = bench_defaults();  ///< the same motor as it is, before the effect
  double nominal_V = 12.0, top_A = 1.0, top_W = 10.0, length_s = 3000.0;
  bool has_current = true, has_airspeed = false, has_neighbour = false, has_rate = false, has_supply = false;
  bool knows_tempco = true;       ///< false: the model has no temperature coefficient at all
  bool current_is_input = false;  ///< no power_param: heat comes from the measured current
  bool thesis() const { return model[thesis_law] > 0.0; }
};

using BenchEffect = Effect<BenchContext, BenchParameters>;

inline const std::vector<BenchEffect>& bench_effects() {
  using Context = BenchContext;
  using Values = BenchParameters;
  const auto always = [](const Context&) { return true; };
  const auto ohmic = [](const Context& c) { return !c.thesis() && c.has_current && !c.current_is_input; };
  const auto sensed = [](const Context& c) { return c.has_current && !c.current_is_input; };
  const auto lumped = [](const Context& c) { return !c.thesis(); };
  static const std::vector<BenchEffect> effects = {
      {"second_thermal_mass",
       "thermal.storage",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[winding_share] = r.uniform(0.08, 0.42);
         p[coupling_W_per_K] = p[conductance] * r.log_uniform(2.0, 14.0);
       },
       [](const Context& c) {
         const double g = c.model[conductance];
         return std::vector<Free>{{winding_share, 0.04, 0.7, {0.1, 0.35}},
                                  {coupling_W_per_K, 1.2 * g, 30.0 * g, {6.0 * g}},
                                  {housing_start_K, -25.0, 10.0, {0.0}}};
       },
       {}},
      {"enclosure",
       "thermal.loss",
       {"motor_C"},
       [](const Context& c) { return !c.thesis(); },
       [](Random& r, const Context&, Values& p) {
         p[box_W_per_K] = p[conductance] * r.log_uniform(0.7, 4.0);
         // Its time constant lies between a tenth of the motor's and twice that.
         p[box_J_per_K] = p[heat_capacity] / p[conductance] * p[box_W_per_K] * r.log_uniform(0.1, 2.0);
       },
       [](const Context& c) {
         const double g = c.model[conductance], capacity = c.model[heat_capacity];
         return std::vector<Free>{
             {box_W_per_K, 0.3 * g, 10.0 * g, {1.0 * g, 3.0 * g}},
             {box_J_per_K, 0.03 * capacity, 10.0 * capacity, {0.3 * capacity, 2.0 * capacity}},
             {box_start_K, -5.0, 40.0, {0.0}}};
       },
       {}},
      {"contact_resistance",
       "thermal.loss",
       {"motor_C"},
       lumped,
       [](Random& r, const Context&, Values& p) {
         p[contact_K_per_W] = 1.0 / (p[conductance] * r.log_uniform(0.4, 3.0));
         p[sink_W_per_K] = p[conductance] * r.log_uniform(0.4, 3.0);
         // Its time constant lies between a third of the motor's and twice that.
         const double through = 1.0 / p[contact_K_per_W] + p[sink_W_per_K];
         p[sink_J_per_K] = p[heat_capacity] / p[conductance] * through * r.log_uniform(0.3, 2.0);
       },
       [](const Context& c) {
         const double g = c.model[conductance], capacity = c.model[heat_capacity];
         return std::vector<Free>{
             {contact_K_per_W, 0.1 / g, 10.0 / g, {0.5 / g, 2.0 / g}},
             {sink_W_per_K, 0.1 * g, 10.0 * g, {1.0 * g}},
             {sink_J_per_K, 0.05 * capacity, 30.0 * capacity, {1.0 * capacity, 5.0 * capacity}},
             {sink_start_K, -40.0, 10.0, {0.0}}};
       },
       {}},
      {"radiation",
       "thermal.loss",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[radiation_W_per_K4] = p[conductance] * r.uniform(0.15, 0.7) / (4.0 * std::pow(318.0, 3));
       },
       [](const Context& c) {
         const double unit = c.model[conductance] / (4.0 * std::pow(318.0, 3));
         return std::vector<Free>{{radiation_W_per_K4, 0.0, 2.0 * unit, {0.3 * unit}}};
       },
       {}},
      {"natural_convection",
       "thermal.loss",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[convection_exponent] = r.uniform(0.19, 0.34);
         p[convection_reference_K] = r.log_uniform(8.0, 45.0);
       },
       [](const Context&) {
         return std::vector<Free>{{convection_exponent, 0.15, 0.45, {0.25}},
                                  {convection_reference_K, 2.0, 120.0, {12.0, 40.0}}};
       },
       {}},
      {"forced_airflow",
       "thermal.loss",
       {"motor_C"},
       [](const Context& c) { return c.has_airspeed; },
       [](Random& r, const Context&, Values& p) {
         p[airflow_gain] = r.log_uniform(0.06, 0.5);
         p[airflow_exponent] = r.uniform(0.5, 0.9);
       },
       [](const Context&) {
         return std::vector<Free>{{airflow_gain, 0.0, 2.0, {0.1}}, {airflow_exponent, 0.3, 1.2, {0.7}}};
       },
       {}},
      {"ambient_bias",
       "thermal.loss",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) { p[air_bias_K] = r.sign() * r.uniform(1.5, 8.0); },
       [](const Context&) {
         return std::vector<Free>{{air_bias_K, -15.0, 15.0, {1.0}}};
       },
       {}},
      {"neighbour_heating",
       "thermal.heating",
       {"motor_C"},
       [](const Context& c) { return c.has_neighbour; },
       [](Random& r, const Context&, Values& p) {
         p[neighbour_W_per_K] = p[conductance] * r.log_uniform(0.04, 0.3);
       },
       [](const Context& c) {
         return std::vector<Free>{
             {neighbour_W_per_K, 0.0, c.model[conductance], {0.1 * c.model[conductance]}}};
       },
       {}},
      {"motion_heating",
       "thermal.heating",
       {"motor_C"},
       [](const Context& c) { return c.has_rate; },
       [](Random& r, const Context& c, Values& p) {
         p[motion_W_per_dps2] = c.top_W * r.log_uniform(0.06, 0.4) / (200.0 * 200.0);
       },
       [](const Context& c) {
         return std::vector<Free>{{motion_W_per_dps2, 0.0, c.top_W * 3e-5, {c.top_W * 3e-6}}};
       },
       {}},
      // C dT/dt = P + W - loss: the electronics' heat is there whatever the motor does.
      {"idle_heat",
       "thermal.heating",
       {"motor_C"},
       lumped,
       [](Random& r, const Context&, Values& p) { p[idle_W] = p[conductance] * r.uniform(1.5, 10.0); },
       [](const Context& c) {
         return std::vector<Free>{{idle_W, 0.0, 20.0 * c.model[conductance], {2.0 * c.model[conductance]}}};
       },
       {}},
      {"iron_loss",
       "thermal.heating",
       {"motor_C"},
       [](const Context& c) { return c.has_rate; },
       [](Random& r, const Context& c, Values& p) {
         const double watts = c.top_W * r.log_uniform(0.08, 0.5), share = r.uniform(0.5, 1.0);
         p[hysteresis_W_per_dps] = watts * share / 200.0;
         p[eddy_W_per_dps2] = watts * (1.0 - share) / (200.0 * 200.0);
       },
       [](const Context& c) {
         return std::vector<Free>{{hysteresis_W_per_dps, 0.0, c.top_W * 6e-3, {c.top_W * 6e-4}},
                                  {eddy_W_per_dps2, 0.0, c.top_W * 3e-5, {c.top_W * 1e-6}}};
       },
       {"motion_heating"}},
      {"thermometer_lag",
       "sensing.temperature",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) { p[sensor_lag_s] = r.log_uniform(8.0, 90.0); },
       [](const Context&) {
         return std::vector<Free>{{sensor_lag_s, 1.0, 240.0, {10.0, 50.0}},
                                  {winding_start_K, -10.0, 25.0, {0.0}}};
       },
       {}},
      {"thermometer_gain",
       "sensing.temperature",
       {"motor_C"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[sensor_gain] = r.chance(0.7) ? r.uniform(0.72, 0.92) : r.uniform(1.08, 1.2);
       },
       [](const Context&) {
         return std::vector<Free>{{sensor_gain, 0.5, 1.6, {0.9}}};
       },
       {}},
      {"supply_power_heating",
       "thermal.heating",
       {"motor_C"},
       [](const Context& c) { return c.thesis(); },
       [](Random&, const Context&, Values& p) { p[supply_heating] = 1.0; },
       [](const Context&) {
         return std::vector<Free>{{supply_heating, 1.0, 1.0001, {1.0}}};
       },
       {}},
      {"calibration.heat_capacity",
       "thermal.storage",
       {"motor_C"},
       lumped,
       [](Random& r, const Context&, Values& p) {
         p[heat_capacity] *= std::exp(r.sign() * r.uniform(0.1, 0.45));
       },
       [](const Context& c) {
         const double x = c.model[heat_capacity];
         return std::vector<Free>{{heat_capacity, 0.4 * x, 2.5 * x, {x}}};
       },
       {}},
      {"calibration.conductance",
       "thermal.loss",
       {"motor_C"},
       lumped,
       [](Random& r, const Context&, Values& p) {
         p[conductance] *= std::exp(r.sign() * r.uniform(0.1, 0.45));
       },
       [](const Context& c) {
         const double x = c.model[conductance];
         return std::vector<Free>{{conductance, 0.4 * x, 2.5 * x, {x}}};
       },
       {}},
      {"supply_sag",
       "electrical",
       {"current_A"},
       [](const Context& c) { return !c.has_supply && c.has_current && !c.thesis() && !c.current_is_input; },
       [](Random& r, const Context& c, Values& p) {
         p[internal_ohm] = p[resistance_ohm] * r.log_uniform(0.03, 0.15);
         p[volt_per_Ah] = c.nominal_V * r.uniform(0.02, 0.1) / (0.35 * c.top_A * c.length_s / 3600.0);
       },
       [](const Context& c) {
         const double r = c.model[resistance_ohm], v = c.nominal_V / (0.35 * c.top_A * c.length_s / 3600.0);
         return std::vector<Free>{{internal_ohm, 0.0, 0.5 * r, {0.08 * r}},
                                  {volt_per_Ah, 0.0, 0.5 * v, {0.05 * v}}};
       },
       {}},
      {"series_resistance",
       "electrical",
       {"current_A"},
       ohmic,
       [](Random& r, const Context&, Values& p) {
         p[series_ohm] = p[resistance_ohm] * r.log_uniform(0.07, 0.35);
       },
       [](const Context& c) {
         const double x = c.model[resistance_ohm];
         return std::vector<Free>{{series_ohm, 0.0, x, {0.1 * x}}};
       },
       {}},
      {"dead_time",
       "electrical",
       {"current_A"},
       ohmic,
       [](Random& r, const Context&, Values& p) { p[dead_duty] = r.log_uniform(0.008, 0.06); },
       [](const Context&) {
         return std::vector<Free>{{dead_duty, 0.0, 0.15, {0.02}}};
       },
       {}},
      {"back_emf",
       "electrical",
       {"current_A"},
       [](const Context& c) { return c.has_rate && c.has_current && !c.thesis() && !c.current_is_input; },
       [](Random& r, const Context& c, Values& p) {
         p[emf_V_per_dps] = c.nominal_V * r.uniform(0.03, 0.2) / 200.0;
       },
       [](const Context& c) {
         return std::vector<Free>{{emf_V_per_dps, 0.0, c.nominal_V * 2.5e-3, {c.nominal_V * 4e-4}}};
       },
       {}},
      {"current_sensor_offset",
       "sensing.current",
       {"current_A"},
       sensed,
       [](Random& r, const Context& c, Values& p) {
         p[current_offset_A] = r.sign() * c.top_A * r.log_uniform(0.01, 0.06);
       },
       [](const Context& c) {
         return std::vector<Free>{{current_offset_A, -0.3 * c.top_A, 0.3 * c.top_A, {0.01 * c.top_A}}};
       },
       {}},
      {"current_sensor_gain",
       "sensing.current",
       {"current_A"},
       sensed,
       [](Random& r, const Context&, Values& p) {
         p[current_gain] = std::exp(r.sign() * r.uniform(0.08, 0.28));
       },
       [](const Context&) {
         return std::vector<Free>{{current_gain, 0.5, 2.0, {1.0}}};
       },
       {}},
      {"winding_tempco",
       "electrical",
       {"current_A"},
       [](const Context& c) {
         return !c.knows_tempco && !c.thesis() && c.has_current && !c.current_is_input;
       },
       [](Random& r, const Context&, Values& p) { p[tempco_per_K] = r.uniform(0.0037, 0.0041); },
       [](const Context&) {
         return std::vector<Free>{{tempco_per_K, 0.0, 0.01, {0.003}}};
       },
       {}},
      {"calibration.resistance",
       "electrical",
       {"current_A"},
       ohmic,
       [](Random& r, const Context&, Values& p) {
         p[resistance_ohm] *= std::exp(r.sign() * r.uniform(0.1, 0.35));
       },
       [](const Context& c) {
         const double x = c.model[resistance_ohm];
         return std::vector<Free>{{resistance_ohm, 0.4 * x, 2.5 * x, {x}}};
       },
       {}},
  };
  return effects;
}

/// The baseline's own constants with the slack that anybody's explanation may use.
inline std::vector<Free> bench_slack(const BenchContext& c, double slack = 0.04) {
  std::vector<int> constants = {resistance_ohm, tempco_per_K, heat_capacity, conductance};
  if (c.thesis())
    constants = {slope_V2,      slope_V1,      slope_V0,       base_mA,       cooling_per_min,
                 rinv_slope_V1, rinv_slope_V0, rinv_offset_V1, rinv_offset_V0};
  std::vector<Free> free;
  for (const int index : constants) {
    const double value = c.model[static_cast<std::size_t>(index)];
    if (value == 0.0) continue;
    const double a = value * (1.0 - slack), b = value * (1.0 + slack);
    free.push_back({index, std::min(a, b), std::max(a, b), {value}});
  }
  return free;
}

/// Causes that no catalogue of INTERFACE lists. Disturbances that depend on time alone are drawn per
/// recording.
enum class BenchUnknown {
  none,
  periodic_heat,
  random_heat,
  melting,
  intermittent_contact,
  hidden_fan,
  loosening,
  draughts,
  shorted_turns
};

inline const std::vector<std::pair<BenchUnknown, std::string>>& bench_unknowns() {
  static const std::vector<std::pair<BenchUnknown, std::string>> list = {
      {BenchUnknown::periodic_heat, "periodic heat load that no column shows"},
      {BenchUnknown::random_heat, "a heater nearby that somebody switches, not logged"},
      {BenchUnknown::melting, "phase change: a melting plateau"},
      {BenchUnknown::intermittent_contact, "intermittent contact: the resistance jumps"},
      {BenchUnknown::hidden_fan, "a fan with a thermostat, not logged"},
      {BenchUnknown::loosening, "the mount loosens in mid recording: the loss drops at once"},
      {BenchUnknown::draughts, "draughts: the loss wanders"},
      {BenchUnknown::shorted_turns, "turns short out above a temperature"},
  };
  return list;
}

}  // namespace gap_benchmark
