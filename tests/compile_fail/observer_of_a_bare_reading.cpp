// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: MeasuredTemperature

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

bool correct(tp::TemperatureObserver& observer, const tp::SensorGuard& guard, float thermistor_C) {
#if defined(MISUSE)
  (void)guard;
  return observer.correct_body({thermistor_C, 1.0f, 1.0f, true});
#else
  (void)thermistor_C;
  return observer.correct_body(guard.measured(1.0f, 1.0f));
#endif
}
