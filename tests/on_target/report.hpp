// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>
#include <string.h>

/// What a platform offers: see platform_avr.cpp, platform_cortex_m.cpp, platform_pc.cpp.
namespace platform {
void start();
void put(char character);
[[noreturn]] void stop(int status);
}  // namespace platform

namespace on_target {

/// Prints results in a form that compares by line on every machine: no printf, which some of them lack.
///
///     # name          a section
///     i -17           an integer: identical everywhere
///     f 41f00000 38d1b717   a number's bits, and those of how far it may be from another machine's
class Report {
public:
  void section(const char* name) {
    put("# ");
    put(name);
    platform::put('\n');
  }

  void integer(int32_t value) {
    put("i ");
    uint32_t rest = static_cast<uint32_t>(value);
    if (value < 0) {
      platform::put('-');
      rest = 0u - rest;
    }
    char digits[10];
    uint8_t count = 0;
    do {
      digits[count++] = static_cast<char>('0' + rest % 10u);
      rest /= 10u;
    } while (rest != 0);
    while (count > 0) platform::put(digits[--count]);
    platform::put('\n');
  }

  void real(float value, float bound) {
    put("f ");
    hex(value);
    platform::put(' ');
    hex(bound);
    platform::put('\n');
  }

private:
  static void put(const char* text) {
    for (; *text != '\0'; ++text) platform::put(*text);
  }
  static void hex(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (uint8_t digit = 0; digit < 8; ++digit) {
      const uint8_t nibble = static_cast<uint8_t>(bits >> 28);
      platform::put(static_cast<char>(nibble < 10 ? '0' + nibble : 'a' + nibble - 10));
      bits <<= 4;
    }
  }
};

}  // namespace on_target
