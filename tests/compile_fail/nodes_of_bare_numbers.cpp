// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a limiter does not take a bare number for a temperature

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

uint8_t granted(tp::NodeLimiter& limiter, const tp::TwoNodeThermalModel<>& model, float thermistor_C) {
#if defined(MISUSE)
  (void)model;
  return limiter.step({255, thermistor_C, thermistor_C, 25.0f}, 0.01f).power;
#else
  (void)thermistor_C;
  return limiter
      .step({255, tp::GuardedCelsius::hottest_of(model), tp::GuardedCelsius::body_of(model), 25.0f}, 0.01f)
      .power;
#endif
}
