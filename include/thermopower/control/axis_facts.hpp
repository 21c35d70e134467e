// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "../detail/numeric.hpp"
#include "guarded_celsius.hpp"
#include "limit_reason.hpp"

/// @file axis_facts.hpp
/// What an axis tells its policies.

namespace thermopower {

/// What an axis knows when it asks its policies. A power law may take `step(error_deg, facts, dt_s)` instead of
/// `step(error_deg)`, a gain `step(power, facts)` instead of `step(power)`, and a limiter `step(facts, dt_s)`
/// instead of `step(inputs, dt_s)`. NaN stands for what is not known.
///
/// @snippet control_examples.cpp axis facts
/// How to: @ref custom_actuator.
/// @ingroup control
struct AxisFacts {
  uint8_t demand;           ///< Power parameter asked for; the least power while the law is being asked.
  GuardedCelsius motor_C;   ///< Temperature of the hottest node; reads as a float.
  GuardedCelsius body_C;    ///< Temperature of the coolest node that the thermal model has; reads as a float.
  float rate_K_per_s;       ///< dT/dt of the hottest node.
  AirCelsius<float> air_C;  ///< Air temperature; left out: NaN, not known.
  float supply_V;           ///< Supply.
  float error_deg;          ///< Folded position error.
  float pose_deg;           ///< Where the axis stands, in degrees of the caller's choice.
  LimitReason last_reason;  ///< Why the last power was below what the law asked for.

  /// An axis of which nothing is known: the least power, NaN, no reason. Set what you know.
  static AxisFacts unknown() noexcept {
    const float unknown = detail::not_a_number();
    const GuardedCelsius nobody_knows;
    const AxisFacts facts = {least_power(), nobody_knows, nobody_knows, unknown,          unknown,
                             unknown,       unknown,      unknown,      LimitReason::none};
    return facts;
  }
};

}  // namespace thermopower
