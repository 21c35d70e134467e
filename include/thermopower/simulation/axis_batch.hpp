// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

#include <thermopower/simulation/axis_case.hpp>
#include <thermopower/simulation/lanes.hpp>

/// @file axis_batch.hpp
/// Thousands of axes at once: what a single axis does, on lanes and threads.

namespace thermopower::simulation {

namespace detail {

/// Calls `assign(to_field, from_field)` for every number of a case.
template <class To, class From, class Assign>
void for_each_number(AxisCase<To>& to, const AxisCase<From>& from, Assign&& assign) {
  auto& m = to.config.mechanics;
  const auto& n = from.config.mechanics;
  assign(m.inertia_kg_m2, n.inertia_kg_m2), assign(m.imbalance_Nm, n.imbalance_Nm),
      assign(m.hanging_rad, n.hanging_rad);
  assign(m.friction.coulomb_Nm, n.friction.coulomb_Nm),
      assign(m.friction.breakaway_Nm, n.friction.breakaway_Nm);
  assign(m.friction.stribeck_rad_per_s, n.friction.stribeck_rad_per_s);
  assign(m.friction.creep_rad_per_s, n.friction.creep_rad_per_s);
  assign(m.friction.viscous_Nm_s_per_rad, n.friction.viscous_Nm_s_per_rad);
  assign(m.cable_Nm_per_rad, n.cable_Nm_per_rad), assign(m.cable_rest_rad, n.cable_rest_rad);
  assign(m.cogging_Nm, n.cogging_Nm), assign(m.cogging_per_turn, n.cogging_per_turn);
  auto& d = to.config.drive;
  const auto& e = from.config.drive;
  assign(d.winding.resistance_ohm, e.winding.resistance_ohm),
      assign(d.winding.tempco_per_K, e.winding.tempco_per_K);
  assign(d.winding.reference_C, e.winding.reference_C), assign(d.exponent, e.exponent);
  assign(d.torque_Nm_per_A, e.torque_Nm_per_A), assign(d.magnet_tempco_per_K, e.magnet_tempco_per_K);
  auto& b = to.config.body;
  const auto& c = from.config.body;
  assign(b.winding_heat_capacity_J_per_K, c.winding_heat_capacity_J_per_K);
  assign(b.body_heat_capacity_J_per_K, c.body_heat_capacity_J_per_K),
      assign(b.coupling_W_per_K, c.coupling_W_per_K);
  assign(b.convection.conductance_W_per_K, c.convection.conductance_W_per_K);
  assign(b.convection.exponent, c.convection.exponent),
      assign(b.convection.reference_K, c.convection.reference_K);
  assign(b.stream_W_per_K, c.stream_W_per_K), assign(b.stream_exponent, c.stream_exponent);
  assign(b.radiation.radiating_area_m2, c.radiation.radiating_area_m2);
  assign(b.radiation.emissivity, c.radiation.emissivity);
  auto& p = to.config.pid;
  const auto& q = from.config.pid;
  assign(p.share_per_deg, q.share_per_deg), assign(p.share_per_deg_s, q.share_per_deg_s);
  assign(p.share_per_deg_per_s, q.share_per_deg_per_s);
  assign(to.start.angle_deg, from.start.angle_deg), assign(to.start.winding_C, from.start.winding_C);
  assign(to.start.body_C, from.start.body_C), assign(to.power, from.power), assign(to.p_gain, from.p_gain);
  assign(to.supply_V, from.supply_V), assign(to.around.air_C, from.around.air_C);
  assign(to.around.airspeed_mps, from.around.airspeed_mps);
  assign(to.sway_deg, from.sway_deg), assign(to.sway_Hz, from.sway_Hz),
      assign(to.sway_turns, from.sway_turns);
  assign(to.wind_Nm, from.wind_Nm), assign(to.wind_Hz, from.wind_Hz), assign(to.wind_turns, from.wind_turns);
}

}  // namespace detail

/// Simulates any number of cases, `lane_count` at a time on every thread. Cases do not see each other, and
/// the outcome does not depend on the number of threads. A number that is NaN spoils its own case only.
/// @tparam Real        float or double
/// @tparam lane_count  a multiple of the vector width; four registers' worth (32 doubles or 64 floats with
///                     AVX-512) hide how long each result takes
/// @param threads      above 0
/// @return one outcome per case, in their order
template <class Real, int lane_count>
std::vector<AxisOutcome<Real>> run_batch(const std::vector<AxisCase<Real>>& cases, double duration_s,
                                         unsigned threads = 1, const AxisClock& clock = {}) {
  using Number = Lanes<Real, lane_count>;
  std::vector<AxisOutcome<Real>> outcomes(cases.size());
  const std::size_t width = static_cast<std::size_t>(lane_count);
  const std::size_t block_count = (cases.size() + width - 1) / width;
  std::atomic<std::size_t> next_block{0};
  const auto work = [&] {
    for (std::size_t block = next_block++; block < block_count; block = next_block++) {
      AxisCase<Number> packed;
      for (std::size_t lane = 0; lane < width; ++lane) {
        // The last block is filled up with its last case.
        const AxisCase<Real>& one = cases[std::min(block * width + lane, cases.size() - 1)];
        detail::for_each_number(
            packed, one, [lane](Number& to, Real from) { to[static_cast<Eigen::Index>(lane)] = from; });
      }
      const AxisOutcome<Number> came = run_case(packed, duration_s, clock);
      for (std::size_t lane = 0; lane < width && block * width + lane < cases.size(); ++lane) {
        const auto at = static_cast<Eigen::Index>(lane);
        outcomes[block * width + lane] = {came.error_rms_deg[at], came.error_peak_deg[at], came.energy_J[at],
                                          came.winding_C[at], came.body_C[at]};
      }
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  return outcomes;
}

}  // namespace thermopower::simulation
