// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// Inputs of limiters in tests, whose temperatures are numbers that the test has thought of.

#include <thermopower/thermopower.hpp>

namespace told {

inline thermopower::GuardedCelsius degrees(float temperature_C) {
  return thermopower::GuardedCelsius::unchecked(temperature_C);
}

/// Of a SafetyLimiter.
inline thermopower::SafetyLimiter<>::Inputs motor(uint8_t demand, float motor_C, float rate_K_per_s) {
  return {demand, degrees(motor_C), rate_K_per_s};
}
/// The same under any rule.
template <class Limiter>
typename Limiter::Inputs motor_of(uint8_t demand, float motor_C, float rate_K_per_s) {
  return {demand, degrees(motor_C), rate_K_per_s};
}
/// Of a NodeLimiter.
inline thermopower::NodeLimiter::Inputs parts(uint8_t demand, float winding_C, float body_C, float air_C) {
  return {demand, degrees(winding_C), degrees(body_C), air_C};
}

}  // namespace told
