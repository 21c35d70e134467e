// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: a gain table needs at least two entries, for power 0 and power 255

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Table {
#if defined(MISUSE)
  static constexpr uint8_t size() { return 1; }
#else
  static constexpr uint8_t size() { return 2; }
#endif
  static const uint8_t* gains();
};
uint8_t gain(uint8_t power) { return tp::GainScheduler<tp::TableGain<Table> >().step(power); }
