// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
// expect: the second parameter of RecordRing must be a record

#include <thermopower/thermopower.hpp>
namespace tp = thermopower;

struct Memory {
  uint8_t read(size_t) { return 0; }
  void write(size_t, uint8_t) {}
  bool is_ready() { return true; }
};

#if defined(MISUSE)
Memory memory;
tp::RecordRing<Memory, int> ring(memory, 0, 2);
#else
Memory memory;
tp::RecordRing<Memory, tp::StoredState> ring(memory, 0, 2);
#endif
