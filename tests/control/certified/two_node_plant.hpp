// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <thermopower/control/certified/limiter.hpp>

/// @file two_node_plant.hpp
/// The actuators that the certified limiter is tried on: exact two-node networks in double precision, drawn
/// inside (or outside) declared bounds, with parameters that an adversary may change at every step.

namespace certified_test {

/// True constants during one step.
struct Truth {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, conductance_W_per_K;
  double supply_V, resistance_ohm, tempco_per_K, reference_C, air_C;

  /// Heat at a power parameter and a winding temperature.
  double heat_W(double power, double winding_C) const {
    return supply_V * supply_V * power / 255.0 /
           (resistance_ohm * (1.0 + tempco_per_K * (winding_C - reference_C)));
  }
};

/// Temperatures of the two nodes, carried exactly over a step of constant heat.
struct Plant {
  double winding_C, body_C;

  void step(const Truth& truth, double heat_W, double dt_s) {
    const double a = truth.coupling_W_per_K / truth.winding_J_per_K,
                 b = truth.coupling_W_per_K / truth.body_J_per_K;
    const double g = truth.conductance_W_per_K / truth.body_J_per_K;
    const double half = 0.5 * (a + b + g), gap = std::sqrt(half * half - a * g);
    const double fast = half + gap, slow = a * g / fast;
    const double settled_body = truth.air_C + heat_W / truth.conductance_W_per_K;
    const double settled_winding = settled_body + heat_W / truth.coupling_W_per_K;
    const double w = winding_C - settled_winding, u = body_C - settled_body;
    const double es = std::exp(-slow * dt_s), mix = (es - std::exp(-fast * dt_s)) / (fast - slow);
    winding_C = settled_winding + es * w + mix * ((slow - a) * w + a * u);
    body_C = settled_body + es * u + mix * (b * w + (slow - b - g) * u);
  }
};

/// What is declared about an actuator, with the ends that the limiter is not told.
struct Declared {
  thermopower::CertifiedLimiter<>::Config config;
  thermopower::Bounds resistance_ohm, tempco_per_K;
  float reference_C, lowest_air_C, lowest_supply_V;
};

typedef std::mt19937_64 Random;

inline double uniform(Random& random, double from, double to) {
  return from + (to - from) * (static_cast<double>(random() >> 11) * (1.0 / 9007199254740992.0));
}
inline double log_uniform(Random& random, double from, double to) {
  return from * std::pow(to / from, uniform(random, 0.0, 1.0));
}
inline bool chance(Random& random, double probability) { return uniform(random, 0.0, 1.0) < probability; }

/// Bounds of an actuator that a limiter accepts: from a coin-sized motor to one of several kilograms.
inline Declared draw_bounds(Random& random) {
  for (;;) {
    const double hold = log_uniform(random, 0.005, 2.0);
    const double winding_tau = hold * log_uniform(random, 5.0, 300.0);
    const double body_tau = winding_tau * log_uniform(random, 3.0, 100.0);
    const double winding_J = log_uniform(random, 0.5, 500.0);
    const double coupling = winding_J / winding_tau;
    const double conductance = coupling * log_uniform(random, 0.02, 1.5);
    const double body_J = conductance * body_tau;
    const double spread = uniform(random, 0.0, 0.35);
    const double limit_body = uniform(random, 45.0, 110.0),
                 limit_winding = limit_body + uniform(random, -5.0, 90.0);
    const double air = uniform(random, 15.0, 0.8 * std::min(limit_body, limit_winding));
    const double coldest = air - uniform(random, 0.0, 60.0);
    const double full_W = conductance * (limit_body - air) * log_uniform(random, 0.7, 30.0);
    const double supply = uniform(random, 5.0, 50.0);

    Declared declared;
    declared.reference_C = static_cast<float>(uniform(random, 0.0, 40.0));
    declared.resistance_ohm = thermopower::Bounds::around(static_cast<float>(supply * supply / full_W),
                                                          0.3f * static_cast<float>(spread));
    declared.tempco_per_K = {0.0035f, 0.0043f};
    declared.lowest_supply_V = static_cast<float>(supply * uniform(random, 0.6, 1.0));
    declared.lowest_air_C = static_cast<float>(coldest);
    const bool measures_supply = chance(random, 0.5);
    declared.config.network = {
        thermopower::Bounds::around(static_cast<float>(winding_J), static_cast<float>(spread)),
        thermopower::Bounds::around(static_cast<float>(body_J), static_cast<float>(spread)),
        static_cast<float>(coupling * (1.0 - spread)),
        static_cast<float>(conductance * (1.0 - spread)),
        static_cast<float>(limit_winding),
        static_cast<float>(limit_body)};
    declared.config.use.heat =
        thermopower::HeatBounds::ohmic(static_cast<float>(supply), measures_supply ? 0.02f : 1.0f,
                                       declared.resistance_ohm, declared.tempco_per_K, declared.reference_C,
                                       static_cast<float>(coldest), static_cast<float>(limit_winding));
    declared.config.use.highest_air_C = static_cast<float>(air);
    declared.config.use.hold_s = static_cast<float>(hold);
    declared.config.use.every = chance(random, 0.5) ? 1 : static_cast<std::uint8_t>(1 + random() % 5);
    declared.config.use.phase = static_cast<std::uint8_t>(random() % declared.config.use.every);
    declared.config.use.horizon_s = static_cast<float>(hold * log_uniform(random, 1.0, 1000.0));
    declared.config.air_error_K = static_cast<float>(uniform(random, 0.0, 10.0));
    if (!thermopower::is_error(declared.config.validate())) return declared;
  }
}

/// An actuator inside its bounds. Coupling and conductance have no declared upper end, so they go far up.
/// @param danger  probability that a parameter sits at the end that the limiter must fear
inline Truth draw_truth(Random& random, const Declared& declared, double danger) {
  const auto worst_or = [&](double worst, double other) {
    return chance(random, danger) ? worst : uniform(random, std::min(worst, other), std::max(worst, other));
  };
  const auto either_end = [&](const thermopower::Bounds& bounds) {
    const bool low = chance(random, 0.5);
    return worst_or(static_cast<double>(low ? bounds.lowest : bounds.highest),
                    static_cast<double>(low ? bounds.highest : bounds.lowest));
  };
  const auto above = [&](float least) {
    return static_cast<double>(least) * (chance(random, danger) ? 1.0 : log_uniform(random, 1.0, 20.0));
  };
  const thermopower::CertifiedTwoNode::Config& network = declared.config.network;
  const thermopower::CertifiedUse& use = declared.config.use;
  Truth truth;
  truth.winding_J_per_K = either_end(network.winding_heat_capacity_J_per_K);
  truth.body_J_per_K = either_end(network.body_heat_capacity_J_per_K);
  truth.coupling_W_per_K = above(network.least_coupling_W_per_K);
  truth.conductance_W_per_K = above(network.least_conductance_W_per_K);
  truth.resistance_ohm = worst_or(static_cast<double>(declared.resistance_ohm.lowest),
                                  static_cast<double>(declared.resistance_ohm.highest));
  truth.tempco_per_K = either_end(declared.tempco_per_K);
  truth.reference_C = static_cast<double>(declared.reference_C);
  truth.supply_V =
      worst_or(static_cast<double>(use.heat.highest_supply_V), static_cast<double>(declared.lowest_supply_V));
  truth.air_C = worst_or(static_cast<double>(use.highest_air_C), static_cast<double>(declared.lowest_air_C));
  return truth;
}

/// Changes what may change (not the heat capacities): the worst an adversary can do is to change it at every
/// step.
inline void shake(Random& random, const Declared& declared, double danger, Truth& truth) {
  const double winding = truth.winding_J_per_K, body = truth.body_J_per_K;
  truth = draw_truth(random, declared, danger);
  truth.winding_J_per_K = winding;
  truth.body_J_per_K = body;
}

/// Demands that try to get past a limiter.
struct Adversary {
  enum Kind { always, bang_bang, random_levels, patient, kinds };
  Kind kind;
  int period;

  std::uint8_t demand(Random& random, int step) const {
    switch (kind) {
      case always:
        return 255;
      case bang_bang:
        return (step / period) % 2 == 0 ? 255 : 0;
      case patient:
        return step % (8 * period) < 7 * period ? 0 : 255;  // lets it cool, then asks for everything
      default:
        return static_cast<std::uint8_t>(random() & 0xff);
    }
  }
};

/// What a run came to.
struct Excess {
  double winding_K = -1e9, body_K = -1e9;  ///< Highest temperature above its limit.
  double over_bound_K = -1e9;              ///< Highest temperature above the limiter's own upper bound.
  int limited = 0;                         ///< Steps that were held back.
  bool lost_certificate = false;           ///< The limiter's bounds left its safe set.
};

/// One run of a limiter on one actuator.
/// @param truth       parameters at the start
/// @param shaken_from  probability that a parameter is at its dangerous end when all of them change, every
/// few steps; negative: never
inline Excess run(Random& random, const Declared& declared, Truth truth, double shaken_from, int steps) {
  thermopower::CertifiedLimiter<> limiter(declared.config);
  const double limit_winding = static_cast<double>(declared.config.network.maximum_winding_C);
  const double limit_body = static_cast<double>(declared.config.network.maximum_body_C);
  Plant plant;
  const double air = static_cast<double>(declared.config.use.highest_air_C);
  // As hot as it may be, as cold as it may be, or in between; half of the time the limiter knows it exactly.
  const double heat = chance(random, 0.3) ? 1.0 : uniform(random, 0.0, 1.0);
  plant.body_C = std::min(truth.air_C, air) + heat * 0.9 * (std::min(limit_body, limit_winding) - air);
  plant.winding_C =
      plant.body_C + (chance(random, 0.5) ? 0.0 : uniform(random, 0.0, 0.3) * (limit_winding - plant.body_C));
  const double start_mean = plant.winding_C - plant.body_C;
  if (start_mean > 0 && plant.body_C + start_mean > limit_body) plant.winding_C = plant.body_C;
  // Half of the limiters are told the air, too, as wrong as it may be measured.
  const auto start = [&] {
    const float winding_C = static_cast<float>(plant.winding_C) + 1e-4f,
                body_C = static_cast<float>(plant.body_C) + 1e-4f;
    if (steps % 2 == 0) limiter.start(winding_C, body_C);
    else
      limiter.start(winding_C, body_C, static_cast<float>(truth.air_C) + 1e-4f - declared.config.air_error_K);
  };
  start();
  if (!limiter
           .is_certified()) {  // hotter than the least power can make good: there is nothing to promise yet
    plant.winding_C = plant.body_C = std::min(truth.air_C, air);
    start();
  }

  const Adversary adversary = {static_cast<Adversary::Kind>(random() % Adversary::kinds),
                               1 + static_cast<int>(log_uniform(random, 1.0, 100.0))};
  const bool has_jitter = chance(random, 0.5);
  // A hair less than its share, so that the float sum of several steps does not pass the hold.
  const double hold = static_cast<double>(declared.config.use.hold_s) / declared.config.use.every *
                      (declared.config.use.every > 1 ? 0.999999 : 1.0);
  const bool reads_air = chance(random, 0.7);
  const int every = 1 + static_cast<int>(random() % 8);
  // What was read at a plan must hold until the next one, so air and supply change at plans.
  const int turns = declared.config.use.every;
  const auto is_plan = [&](int step) { return (step + 1 + declared.config.use.phase) % turns == 0; };
  Excess excess;
  double dt = hold;
  for (int step = 0; step < steps; ++step) {
    if (shaken_from >= 0.0 && step % every == 0 && is_plan(step)) shake(random, declared, shaken_from, truth);
    const double error_K = static_cast<double>(declared.config.air_error_K);
    const double supply_error = static_cast<double>(declared.config.use.heat.supply_error);
    const double read_air = truth.air_C + uniform(random, -1.0, 1.0) * error_K;
    const double read_supply =
        supply_error < 1.0 ? truth.supply_V / (1.0 + uniform(random, -0.98, 1.0) * supply_error) : 0.0;
    const thermopower::CertifiedLimiter<>::Inputs inputs = {
        adversary.demand(random, step), static_cast<float>(read_supply),
        reads_air ? static_cast<float>(read_air) : thermopower::detail::not_a_number()};
    const thermopower::LimitedPower granted = limiter.step(inputs, step == 0 ? 0.0f : static_cast<float>(dt));
    if (granted.reason != thermopower::LimitReason::none) ++excess.limited;
    if (!limiter.is_certified()) excess.lost_certificate = true;
    if (step > 0 && is_plan(step)) {  // in between the bounds rest
      excess.over_bound_K =
          std::max({excess.over_bound_K, plant.winding_C - static_cast<double>(limiter.winding_upper_C()),
                    plant.body_C - static_cast<double>(limiter.body_upper_C())});
    }
    dt = static_cast<double>(static_cast<float>(has_jitter ? uniform(random, 0.05, 1.0) * hold : hold));
    // Two parts, each with the heat of its start: at least what a warming winding takes, and a look at the
    // middle.
    for (int part = 0; part < 2; ++part) {
      plant.step(truth, truth.heat_W(granted.power, plant.winding_C), 0.5 * dt);
      excess.winding_K = std::max(excess.winding_K, plant.winding_C - limit_winding);
      excess.body_K = std::max(excess.body_K, plant.body_C - limit_body);
    }
  }
  return excess;
}

}  // namespace certified_test
