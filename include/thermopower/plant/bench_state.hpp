// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

namespace thermopower::plant {

/// Nodes of the bench besides winding and surface. Copies nothing where there are none.
template <class Scalar>
struct FurtherNodes {
  bool any = false;   ///< they are in use, and set
  Scalar soaking_C;   ///< node behind the surface
  Scalar enclosed_C;  ///< air around the body

  FurtherNodes() {}  // NOLINT: what is not in use stays unset
  /// Copies what is set.
  FurtherNodes(const FurtherNodes& other) { *this = other; }
  /// Copies what is set.
  FurtherNodes& operator=(const FurtherNodes& other) {
    any = other.any;
    if (any) soaking_C = other.soaking_C, enclosed_C = other.enclosed_C;
    return *this;
  }
};

/// Everything that the motor on the bench remembers.
template <class Scalar>
struct BenchState {
  Scalar winding_C;      ///< node that the heat enters
  Scalar surface_C;      ///< node that the air cools; follows the winding where there is one node
  Scalar thermometer_C;  ///< what a lagging thermometer has come to; follows the winding without lag
  Scalar charge_Ah;      ///< drawn since the start of the run, discharges the battery
  FurtherNodes<Scalar> further = {};  ///< where the body's structure has more of them
};

/// How fast what a motor on the bench remembers changes.
template <class Scalar>
struct BenchSlope {
  Scalar winding;                     ///< K/s
  Scalar surface;                     ///< K/s
  Scalar charge;                      ///< Ah/s
  FurtherNodes<Scalar> further = {};  ///< K/s
};

/// The mean of the four slopes of a step of the classical Runge-Kutta rule.
template <class Scalar>
BenchSlope<Scalar> runge_kutta_mean(const BenchSlope<Scalar>& k1, const BenchSlope<Scalar>& k2,
                                    const BenchSlope<Scalar>& k3, const BenchSlope<Scalar>& k4) {
  const auto mean = [](const Scalar& a, const Scalar& b, const Scalar& c, const Scalar& d) {
    return Scalar((a + 2.0 * (b + c) + d) * (1.0 / 6.0));
  };
  BenchSlope<Scalar> all{mean(k1.winding, k2.winding, k3.winding, k4.winding),
                         mean(k1.surface, k2.surface, k3.surface, k4.surface),
                         mean(k1.charge, k2.charge, k3.charge, k4.charge),
                         {}};
  all.further.any = k1.further.any;
  if (all.further.any) {
    all.further.soaking_C =
        mean(k1.further.soaking_C, k2.further.soaking_C, k3.further.soaking_C, k4.further.soaking_C);
    all.further.enclosed_C =
        mean(k1.further.enclosed_C, k2.further.enclosed_C, k3.further.enclosed_C, k4.further.enclosed_C);
  }
  return all;
}

/// A state that moved at a slope for `h_s`; the thermometer stays where it was.
/// @param h_s  a plain number, or one that varies
template <class Scalar, class Length>
BenchState<Scalar> moved(const BenchState<Scalar>& from, const BenchSlope<Scalar>& rate, const Length& h_s) {
  BenchState<Scalar> to{from.winding_C + rate.winding * h_s, from.surface_C + rate.surface * h_s,
                        from.thermometer_C, from.charge_Ah + rate.charge * h_s};
  if (rate.further.any) {
    to.further.any = true;
    to.further.soaking_C = from.further.soaking_C + rate.further.soaking_C * h_s;
    to.further.enclosed_C = from.further.enclosed_C + rate.further.enclosed_C * h_s;
  }
  return to;
}

}  // namespace thermopower::plant
