// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/bench_state.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/instance.hpp>

#include <algorithm>

/// @file bench_rates.hpp
/// How fast the nodes of a motor on the bench can change: for the length of a rollout's steps.

namespace thermopower::plant {

/// The rise of the whole motor by a joule; for the polynomial law just above its least voltage.
template <class Scalar>
Scalar storage_K_per_J(const Instance<Scalar>& instance, const BenchState<Scalar>& state) {
  if (instance.lumped) return 1.0 / instance.heat_capacity.heat_capacity_J_per_K;
  return instance.heating_law.rise_K_per_J(instance.heating_law.minimum_V_rms + 1.0, state.winding_C);
}

/// Fastest decay rate of the linear part, 1/s.
template <class Scalar>
double fastest_per_s(const Instance<Scalar>& instance, const BenchState<Scalar>& state) {
  const auto& shape = instance.thermal_structure;
  if (!instance.lumped && !instance.thesis_thermal) return 0.0;
  const double rise_K_per_J = value_of(storage_K_per_J(instance, state));
  const double base = instance.lumped ? value_of(instance.conductance_W_per_K) * rise_K_per_J
                                      : value_of(instance.cooling_per_s);
  double fastest = 2.0 * base;
  if (shape.two_nodes) {
    const double share = value_of(shape.winding_share);
    const double flow = value_of(shape.coupling_W_per_K) * rise_K_per_J;
    fastest = std::max(fastest, flow / share + (flow + 2.0 * base) / (1.0 - share));
  }
  if (shape.soaks) {
    const double rest = value_of(shape.own_share()), coupling = value_of(shape.soaking_W_per_K);
    const double surface = rest * (shape.two_nodes ? 1.0 - value_of(shape.winding_share) : 1.0);
    const double away = coupling + value_of(shape.soaking_loss_W_per_K);
    fastest = fastest / rest + away * value_of(shape.soaking_K_per_J(constant<Scalar>(rise_K_per_J))) +
              coupling * rise_K_per_J / surface;
  }
  if (shape.enclosed)
    fastest +=
        (2.0 * base + value_of(shape.enclosed_W_per_K) * rise_K_per_J) / value_of(shape.enclosed_share);
  return fastest;
}

}  // namespace thermopower::plant
