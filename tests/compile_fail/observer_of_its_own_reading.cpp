// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: an observer takes the winding's voltage and current

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

bool correct(tp::TemperatureObserver& observer, const tp::WindingResistance& winding) {
#if defined(MISUSE)
  return observer.correct_winding(winding.measure(6.0f, 0.9f));
#else
  return observer.correct_winding(winding, 6.0f, 0.9f);
#endif
}
