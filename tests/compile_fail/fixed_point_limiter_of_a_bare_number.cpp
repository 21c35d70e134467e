// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a limiter in whole numbers does not take a bare number for a temperature

#include <thermopower/thermopower.hpp>
namespace fixed = thermopower::fixed_point;

uint8_t granted(fixed::SafetyLimiter<>& limiter, fixed::Temperature thermistor) {
#if defined(MISUSE)
  return limiter.step(255, thermistor, 0, 100).power;
#else
  return limiter.step(255, fixed::GuardedTemperature::unchecked(thermistor), 0, 100).power;
#endif
}
