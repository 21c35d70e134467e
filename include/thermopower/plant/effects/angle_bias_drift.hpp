// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/terms.hpp>

namespace thermopower::plant {

/// A drift of the angle in proportion to time.
///
/// @snippet effects_examples.cpp AngleBiasDrift
/// How to: @ref diagnose_a_gap, @ref laws.
struct AngleBiasDrift {
  /// Its parameters, in this order.
  enum Parameters {
    deg_per_s  ///< drift of the reading, deg/s
  };

  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {"angle_bias_drift",
            Submodel::sensing_angle,
            "reading = angle + drift t",
            "The angle sensor drifts away while nothing moves.",
            {parameter(deg_per_s, "deg_per_s").unit("deg/s").within(-1e3, 1e3).starts({0.0})},
            {Need::axis_model, Need::angle_deg},
            "a long recording with standstill at its end"};
  }

  /// Adds a drift.
  template <class Scalar>
  static void act(const Scalar* p, AxisReadings<Scalar>& read) {
    read.angle_deg += p[deg_per_s] * read.t_s;
  }
};

}  // namespace thermopower::plant
