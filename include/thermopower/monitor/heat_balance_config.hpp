// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/constexpr_math.hpp"

/// @file heat_balance_config.hpp
/// What is known of a heated body, with bounds.

namespace thermopower {

/// A heated body as its thermometer sees it, and how far each constant may be off. All of it is known to the
/// compiler, so that an object holds nothing but its state.
///
/// \f[ P_\tau = C \, \dot T + C_2 \, \dot T_2 + (G + G_f f) \, (T - T_\mathrm{air}), \qquad
///     \tau_2 \, \dot T_2 = T - T_2, \qquad \tau \, \dot P_\tau = P - P_\tau \f]
///
/// Every network of two nodes has this form, whichever of them is measured: `measured_body()` and `measured_winding()` convert.
///
/// @snippet monitor_examples.cpp heater monitor
/// How to: @ref heater_with_monitor. Math: @ref explain_monitor.
/// @ingroup monitor
struct HeatBalanceConfig {
  double full_W;            ///< Highest heat, W, above 0.
  double heat_error;        ///< What the heat may be off by, a fraction within 0 .. 0.5.
  double capacity_J_per_K;  ///< C: of what follows the thermometer at once, above 0.
  double capacity_error;    ///< A fraction, 0 .. 0.5.
  double second_J_per_K;    ///< C_2: of what follows slowly; 0: there is no such mass.
  double second_s;          ///< tau_2, above 0 where there is a second mass.
  double second_error;      ///< What both may be off by, a fraction, 0 .. 0.5.
  double lag_s;  ///< tau: how late heat reaches the thermometer, >= 0. The thermometer's own lag adds to it.
  double lag_error;     ///< A fraction, 0 .. 0.5.
  double loss_W_per_K;  ///< G, above 0.
  double loss_error;    ///< A fraction, 0 .. 0.5.
  double fan_W_per_K;   ///< G_f, what a full fan adds; 0: there is no fan.
  double fan_error;     ///< A fraction, 0 .. 0.5.
  double air_error_K;   ///< What the air may be off by, >= 0.
  double noise_K;       ///< Standard deviation of the thermometer, its resolution included; above 0.
  double
      resolution_K;  ///< The thermometer's smallest step; a reading that never steps is stuck where this is below the noise.
  /// Standard deviation of what the heat of one second is off at random, J; grows with the root of the time. Small where
  /// the firmware knows its own duty; large in a log that shows a duty once a second that changes more often.
  double heat_noise_J;

  /// The same with every bound replaced.
  /// @param error  a fraction for heat, capacities, lag and losses
  constexpr HeatBalanceConfig within(double error) const noexcept {
    return HeatBalanceConfig{
        full_W,  error,        capacity_J_per_K, error, second_J_per_K, second_s, error,
        lag_s,   error,        loss_W_per_K,     error, fan_W_per_K,    error,    air_error_K,
        noise_K, resolution_K, heat_noise_J};
  }

  /// Of two nodes, the heated one unmeasured: a motor with a thermometer on its housing.
  /// @param error  of every constant, a fraction
  static constexpr HeatBalanceConfig measured_body(double full_W, double winding_J_per_K, double body_J_per_K,
                                                   double coupling_W_per_K, double loss_W_per_K, double error,
                                                   double noise_K) {
    return HeatBalanceConfig{full_W,
                             0.0,
                             body_J_per_K,
                             0.0,
                             winding_J_per_K,
                             winding_J_per_K / coupling_W_per_K,
                             0.0,
                             winding_J_per_K / coupling_W_per_K,
                             0.0,
                             loss_W_per_K,
                             0.0,
                             0.0,
                             0.0,
                             1.0,
                             noise_K,
                             noise_K,
                             0.0}
        .within(error);
  }
  /// Of two nodes, the heated one measured: a winding whose resistance is its thermometer, a heated plate under glass.
  /// @param error  of every constant, a fraction
  static constexpr HeatBalanceConfig measured_winding(double full_W, double winding_J_per_K,
                                                      double body_J_per_K, double coupling_W_per_K,
                                                      double loss_W_per_K, double error, double noise_K) {
    return HeatBalanceConfig{
        full_W,
        0.0,
        winding_J_per_K,
        0.0,
        body_J_per_K * detail::squared(coupling_W_per_K / (coupling_W_per_K + loss_W_per_K)),
        body_J_per_K / (coupling_W_per_K + loss_W_per_K),
        0.0,
        0.0,
        0.0,
        coupling_W_per_K * loss_W_per_K / (coupling_W_per_K + loss_W_per_K),
        0.0,
        0.0,
        0.0,
        1.0,
        noise_K,
        noise_K,
        0.0}
        .within(error);
  }
};

}  // namespace thermopower
