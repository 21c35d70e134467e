// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/friction_transition.hpp>
#include <thermopower/plant/terms.hpp>

#include <cmath>

namespace thermopower::plant {

/// Share of the knee below which a rate counts as that: a power of 0 has no derivative.
inline constexpr double stribeck_still = 1e-9;

/// The share of the rise that is left at a rate: exp(-x^n).
/// @param x         rate over the knee, >= 0; at least `stribeck_still` counts
/// @param exponent  n, > 0
template <class Scalar>
Scalar stribeck_share(const Scalar& x, const Scalar& exponent) {
  using std::exp;
  using std::log;
  return exp(-exp(exponent * log(at_least(x, stribeck_still))));
}

/// The same, its derivatives worked out in plain numbers: an axis with such a friction asks for them at every step.
template <int width>
DualOf<width> stribeck_share(const DualOf<width>& x, const DualOf<width>& exponent) {
  const bool moves = x.value() > stribeck_still;
  const double at = moves ? x.value() : stribeck_still, of_rate = std::log(at);
  const double power = std::exp(exponent.value() * of_rate), share = std::exp(-power);
  const double by_power = -share * power;
  return DualOf<width>::composed(share, x, moves ? by_power * exponent.value() / at : 0.0, exponent,
                                 by_power * of_rate);
}

/// Dry friction with a Stribeck rise near standstill.
///
/// @snippet effects_examples.cpp StribeckFriction
/// How to: @ref diagnose_a_gap, @ref laws.
struct StribeckFriction {
  /// Its parameters, in this order.
  enum Parameters {
    size_Nm,         ///< torque against fast motion, N m
    rise_Nm,         ///< how much larger it is near standstill, N m
    knee_rad_per_s,  ///< rate at which the rise has fallen to 1/e, rad/s
    transition,      ///< rate within which it turns over, see friction_transition()
    tail,            ///< how slowly it becomes full beyond, see friction_tail()
    exponent         ///< power of the rate by which the rise falls
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo one = {"stribeck_friction",
                      Submodel::mechanical_friction,
                      "torque -= (Nm + rise exp(-|w / knee|^n)) film(w / transition, tail)",
                      "Dry friction that is larger near standstill than in motion.",
                      {parameter(size_Nm, "Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       parameter(rise_Nm, "rise_Nm").unit("N m").within(0.0, 1e3).starts({0.0}),
                       parameter(knee_rad_per_s, "knee_rad_per_s")
                           .unit("rad/s")
                           .within(0.005, 100.0)
                           .logarithmic()
                           .exceeds("transition_rad_per_s")
                           .within_the_motion()
                           .starts({0.1, 0.5, 2.0}),
                       friction_transition(transition), friction_tail(tail),
                       parameter(exponent, "exponent")
                           .unit("1")
                           .within(0.7, 6.0)
                           .standard(2.0)
                           .starts({2.0})
                           .degenerate_at_bounds()},
                      {Need::axis_model},
                      "very slow motion through standstill in both directions"};
    one.where_small = WhereSmall{rise_Nm, size_Nm, "coulomb_friction"};
    one.is_itself_alone = stays_in_motion;
    one.in_a_joint = in_a_joint;
    return one;
  }

  /// Whether a twentieth of the friction at standstill is left in motion at least. One that vanishes, with a viscous friction that
  /// has doubled beside it, is the bend of a drag that grows faster than the rate.
  static bool stays_in_motion(const double* p) {
    constexpr double least = 0.05;
    return p[size_Nm] >= least * (p[size_Nm] + p[rise_Nm]);
  }

  /// As simulators of bodies have it.
  static void in_a_joint(const double* p, JointDescription& joint) {
    joint.add_friction(p[size_Nm], transition, p[transition]);
    joint.remarks.push_back({{rise_Nm, knee_rad_per_s, exponent}, "the rise near standstill is left out"});
  }

  /// Adds dry friction with a rise near standstill.
  template <class Scalar>
  static void act(const Scalar* p, FrictionTerms<Scalar>& terms) {
    const Scalar ratio = magnitude(Scalar(terms.rate_rad_per_s / p[knee_rad_per_s]));
    const Scalar friction_Nm = p[size_Nm] + p[rise_Nm] * stribeck_share(ratio, p[exponent]);
    terms.add_friction(friction_Nm, friction_Nm, p[transition], p[tail]);
  }
};

}  // namespace thermopower::plant
