// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A dead band of the drive; beyond it the command counts from its edge.
///
/// @snippet effects_examples.cpp DriveDeadband
/// How to: @ref diagnose_a_gap, @ref laws.
struct DriveDeadband {
  /// Its parameters, in this order.
  enum Parameters {
    band_A  ///< command up to which nothing happens, A
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    EffectInfo info = {"drive_deadband",
                       Submodel::mechanical_drive,
                       "drive = sign(u) max(0, |u| - A)",
                       "Small commands do nothing.",
                       {parameter(band_A, "A")
                            .unit("A")
                            .within(0.0, 1e3)
                            .starts_as_shares_of(Input::drive_A, {0.02, 0.1, 0.3})},
                       {Need::axis_model},
                       "small commands in both directions"};
    // Hardly any drive swallows a tenth of its range, and every joint has dry friction, which looks alike in motion one way.
    info.rarity = 12.0;
    return info;
  }

  /// Takes a fixed amount off the command.
  template <class Scalar>
  static void act(const Scalar* p, DriveTerms<Scalar>& terms) {
    const auto command = value_of(terms.drive_A);
    if (command > value_of(p[band_A])) terms.drive_A -= p[band_A];
    else if (command < -value_of(p[band_A])) terms.drive_A += p[band_A];
    else terms.drive_A = constant<Scalar>(0.0);
  }
};

}  // namespace thermopower::plant
