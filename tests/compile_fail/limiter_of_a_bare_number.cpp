// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a limiter does not take a bare number for a temperature

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

float thermistor_C();
uint8_t granted(tp::SafetyLimiter<>& limiter, tp::SensorGuard& guard, float expected_C) {
#if defined(MISUSE)
  (void)guard, (void)expected_C;
  return limiter.step({255, thermistor_C(), 0.0f}, 0.01f).power;
#else
  return limiter.step({255, guard.step({thermistor_C(), expected_C}, 0.01f), 0.0f}, 0.01f).power;
#endif
}
