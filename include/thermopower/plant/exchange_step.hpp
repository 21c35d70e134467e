// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/two_node_rates.hpp>
#include <thermopower/plant/dual.hpp>

#include <cmath>

namespace thermopower::plant {

/// Heat that two nodes, a winding and the surface around it, exchange with each other, and the surface with
/// the air: the stiff and linear part of their equations, solved exactly.
///
/// d/dt (winding, surface) = J (winding, surface) + the rest. The functions phi_1(z) = (e^z - 1) / z and
/// phi_2(z) = (phi_1(z) - 1) / z of the matrix h J carry a slope, and the change of the rest, over a step of
/// any length (Cox and Matthews 2002, the method ETD2RK; Hochbruck and Ostermann 2010, eq. 2.39).
///
/// @snippet plant_examples.cpp exchange step
/// How to: @ref gap_method.
template <class Scalar>
class ExchangeStep {
public:
  /// Two temperatures, or their slopes.
  struct Pair {
    Scalar winding;  ///< K or K/s
    Scalar surface;  ///< K or K/s
  };

  /// @param winding_per_s  exchange, relative to the winding's heat capacity, > 0
  /// @param surface_per_s  exchange, relative to the surface's, > 0
  /// @param loss_per_s     loss to the air, relative to the surface's, >= 0
  ExchangeStep(const Scalar& winding_per_s, const Scalar& surface_per_s, const Scalar& loss_per_s)
      : ww_(-winding_per_s), ws_(winding_per_s), sw_(surface_per_s), ss_(-surface_per_s - loss_per_s) {
    const TwoNodeRates<Scalar> rates = two_node_rates(winding_per_s, surface_per_s, loss_per_s);
    fast_per_s_ = -rates.fast_per_s;
    slow_per_s_ = -rates.slow_per_s;
  }

  /// Sets the length of the step, > 0.
  void set_length(double h_s) {
    h_s_ = h_s;
    const Scalar fast = fast_per_s_ * h_s, slow = slow_per_s_ * h_s;
    const Scalar first_fast = phi_1(fast), first_slow = phi_1(slow);
    first_ = through(first_fast, first_slow);
    second_ = through(phi_2(fast, first_fast), phi_2(slow, first_slow));
  }

  /// How far the nodes move in the step when they set out with `slope`: h phi_1(h J) slope.
  Pair moved(const Pair& slope) const { return applied(first_, slope); }

  /// The addition by a change of the rest from the step's start to its end: h phi_2(h J) change.
  Pair corrected(const Pair& change) const { return applied(second_, change); }

  /// J applied to a pair.
  Pair exchanged(const Pair& x) const {
    return {ww_ * x.winding + ws_ * x.surface, sw_ * x.winding + ss_ * x.surface};
  }

private:
  /// A function of J as identity * one + J * jacobian, times h.
  struct Function {
    Scalar one, jacobian;
  };

  static Scalar phi_1(const Scalar& z) {
    using std::exp;
    if (std::abs(value_of(z)) > 0.05) return (exp(z) - 1.0) / z;
    return 1.0 + z * (0.5 + z * (1.0 / 6.0 + z * (1.0 / 24.0 + z * (1.0 / 120.0))));
  }

  static Scalar phi_2(const Scalar& z, const Scalar& first) {
    if (std::abs(value_of(z)) > 0.05) return (first - 1.0) / z;
    return 0.5 + z * (1.0 / 6.0 + z * (1.0 / 24.0 + z * (1.0 / 120.0 + z * (1.0 / 720.0))));
  }

  /// The function that takes these values at the two eigenvalues.
  Function through(const Scalar& at_fast, const Scalar& at_slow) const {
    const Scalar jacobian = (at_slow - at_fast) / (slow_per_s_ - fast_per_s_);
    return {(at_fast - jacobian * fast_per_s_) * h_s_, jacobian * h_s_};
  }

  Pair applied(const Function& f, const Pair& x) const {
    const Pair turned = exchanged(x);
    return {f.one * x.winding + f.jacobian * turned.winding, f.one * x.surface + f.jacobian * turned.surface};
  }

  Scalar ww_, ws_, sw_, ss_, fast_per_s_, slow_per_s_;
  double h_s_ = 0.0;
  Function first_{}, second_{};
};

}  // namespace thermopower::plant
