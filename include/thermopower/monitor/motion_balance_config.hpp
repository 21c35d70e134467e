// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file motion_balance_config.hpp
/// What is known of a shaft, with bounds.

namespace thermopower {

/// A shaft, and how far each constant may be off: k_t I = J dw/dt + T_c sign(w) + b w.
///
/// @snippet monitor_examples.cpp motor monitor
/// How to: @ref heater_with_monitor. Math: @ref explain_monitor.
/// @ingroup monitor
struct MotionBalanceConfig {
  double full_A;           ///< Highest current, above 0.
  double full_rad_per_s;   ///< Highest speed, above 0.
  double least_rad_per_s;  ///< Blocks in which the shaft is slower, or turns round, are not judged; above 0.
  double torque_constant_Nm_per_A;  ///< k_t, above 0.
  double torque_error;              ///< A fraction, 0 .. 0.5.
  double inertia_kg_m2;             ///< J, >= 0.
  double inertia_error;             ///< A fraction, 0 .. 0.5.
  double dry_friction_Nm;           ///< T_c, >= 0.
  double damping_Nm_s_per_rad;      ///< b, >= 0.
  double friction_error;            ///< Of both, a fraction, 0 .. 0.5.
  double load_Nm;                   ///< Torque of a load that may act either way, >= 0.
  double noise_Nm;                  ///< Standard deviation of a block's mean torque, above 0.
};

}  // namespace thermopower
