// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "forced_airflow.hpp"
#include "natural_convection.hpp"
#include "newton_cooling.hpp"
#include "radiation_cooling.hpp"
#include "sum_of_cooling.hpp"

/// @file cooling.hpp
/// Cooling laws: how fast a node that is warmer than its surroundings loses temperature.
///
/// | law | loss | when to take it |
/// |---|---|---|
/// | `RateCooling` | k (T - T_air), k in 1/s | the thesis's eq 3.8: only a cooling curve is known |
/// | `NewtonCooling` | G (T - T_air), G in W/K | the default: a conductance to the air |
/// | `NaturalConvection` | G (T - T_air)^(1+n), either sign | still air around a warm body, n about 0.25 |
/// | `RadiationCooling` | sigma A eps (T^4 - T_air^4) | hot surfaces, thin air, vacuum |
/// | `ForcedAirflow` | G (1 + g v^n) (T - T_air) | a fan, a propeller's downwash, forward flight |
/// | `SumOfCooling` | the sum of two | two paths in parallel, e.g. convection and radiation |
///
/// A law of your own has `Scalar`, `is_linear()` (true when the rate is proportional to T - T_air),
/// `is_in_watts()` (true when it is a loss that r turns into a rate), and, each per second and given r in K/J
/// from the heating law: `rate_K_per_s(motor_C, around, rise_K_per_J)`, `slope_per_s(...)` (its derivative by
/// motor_C), and `validate()`.
