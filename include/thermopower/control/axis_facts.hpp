// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "limit_reason.hpp"

/// @file axis_facts.hpp
/// What an axis tells its policies.

namespace thermopower {

/// What an axis knows when it asks its policies.
struct AxisFacts {
  uint8_t demand;      ///< Power parameter asked for.
  float motor_C;       ///< Estimated temperature of the hottest node.
  float body_C;        ///< Estimated temperature of the coolest node that the thermal model has.
  float rate_K_per_s;  ///< dT/dt of the hottest node.
  float air_C;         ///< Air temperature; NaN when it is not known.
  float supply_V;      ///< Supply; NaN when it is not known.
  float error_deg;     ///< Folded position error; NaN when it is not known.
};

}  // namespace thermopower
