// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of HottestJournal says what happens to the actuators

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Memory {
  uint8_t read(size_t) { return 0; }
  void write(size_t, uint8_t) {}
  bool is_ready() { return true; }
};
Memory memory;

#if defined(MISUSE)
tp::HottestJournal<Memory, tp::StandardJournal> journal(memory);
#else
tp::HottestJournal<Memory, tp::DrivenOn<110>, tp::StandardJournal> journal(memory);
#endif
