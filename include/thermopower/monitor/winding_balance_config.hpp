// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file winding_balance_config.hpp
/// What is known of a winding, with bounds.

namespace thermopower {

/// A winding, and how far each constant may be off: V = I R (1 + a (T - T_ref)).
///
/// @snippet monitor_examples.cpp motor monitor
/// How to: @ref heater_with_monitor. Math: @ref explain_monitor.
/// @ingroup monitor
struct WindingBalanceConfig {
  double full_V;            ///< Highest voltage at the winding, above 0.
  double resistance_ohm;    ///< R at the reference temperature, above 0.
  double resistance_error;  ///< A fraction, 0 .. 0.5; a winding's own spread and the current sensor's scale.
  double tempco_per_K;      ///< a, 0 .. 0.02. Copper: 0.00393.
  double reference_C;       ///< T_ref, -50 .. 200.
  double winding_error_K;   ///< What the winding's temperature may be off by, >= 0.
  double offset_V;          ///< What voltage and current sensor may be off by at no load, as voltage, >= 0.
  double noise_V;           ///< Standard deviation of a block's mean voltage, above 0.
};

}  // namespace thermopower
