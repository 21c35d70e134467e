// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the first parameter of HottestJournal must be a memory

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Memory {
  uint8_t read(size_t) { return 0; }
  void write(size_t, uint8_t) {}
  bool is_ready() { return true; }
};

#if defined(MISUSE)
int memory;
tp::HottestJournal<int, tp::OffTogether> journal(memory);
#else
Memory memory;
tp::HottestJournal<Memory, tp::OffTogether> journal(memory);
#endif
