// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a limiter does not take a bare number for a temperature

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

void tell(tp::CertifiedLimiter<>& limiter, const tp::SensorGuard& guard, float thermistor_C) {
#if defined(MISUSE)
  (void)guard;
  limiter.tighten(thermistor_C, thermistor_C);
#else
  (void)thermistor_C;
  limiter.tighten(tp::GuardedCelsius(), guard.upper(3.0f));
#endif
}
