// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// On the chip: the products that are written out for AVR against the same in the language itself. GPIOR1
// tells which one differs (1, 2, 3), or 0; GPIOR0 says 3 when all is done.

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include <thermopower/control/certified/arithmetic.hpp>

using namespace thermopower;

namespace {

uint32_t seed = 1;

uint16_t random_word() {
  seed = seed * 1664525UL + 1013904223UL;
  return static_cast<uint16_t>(seed >> 16);
}

// Every magnitude comes: some numbers fill all bits, some only a few.
int32_t random_value() {
  const int32_t value = static_cast<int32_t>((static_cast<uint32_t>(random_word()) << 16) | random_word());
  return value >> (random_word() & 31u);
}

const uint16_t edges[] = {0, 1, 2, 127, 128, 255, 256, 257, 32767, 32768, 65279, 65280, 65534, 65535};
const uint8_t edge_count = sizeof edges / sizeof edges[0];

uint8_t differing(int32_t value, uint16_t left, uint16_t right) {
  if (detail::part_down(value, left) != detail::portable::part_down(value, left)) return 1;
  if (detail::product(left, right) != detail::portable::product(left, right)) return 2;
  const int32_t small = value >> 8;  // 255 times it must fit
  if (detail::times(small, static_cast<uint8_t>(right)) !=
      detail::portable::times(small, static_cast<uint8_t>(right)))
    return 3;
  return 0;
}

uint8_t check_all() {
  for (uint8_t i = 0; i < edge_count; ++i)
    for (uint8_t j = 0; j < edge_count; ++j)
      for (uint8_t k = 0; k < edge_count; ++k) {
        const int32_t value = static_cast<int32_t>((static_cast<uint32_t>(edges[i]) << 16) | edges[j]);
        const uint8_t found = differing(value, edges[k], edges[i]);
        if (found != 0) return found;
      }
  for (uint16_t i = 0; i < 50000; ++i) {
    const uint8_t found = differing(random_value(), random_word(), random_word());
    if (found != 0) return found;
  }
  return 0;
}

}  // namespace

int main() {
  GPIOR1 = check_all();
  GPIOR0 = 3;
  cli();
  for (;;) sleep_mode();
}
