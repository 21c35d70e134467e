// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>
#if defined(__AVR__)
#include <avr/io.h>
#endif

/// What a call costs. On AVR the chip's own timer at the chip's clock: exact cycles of one call. On Cortex-M
/// in qemu, which has no cycles, instructions: with `-icount shift=0` an instruction takes a nanosecond of
/// the simulated clock, which the system timer counts in units of 62.5 (16 MHz) or 40 (25 MHz), so that many
/// calls are averaged.
namespace counter {

typedef void (*Operation)();

const uint16_t corners = 64;  ///< Rounds with the ends of every range.
const uint16_t rounds = 61;   ///< Ordinary rounds.

#if defined(__AVR__)
const uint32_t resolution = 0;
const uint16_t searches = 60000;  ///< Rounds of a search for the worst case.
inline void start() {
  TCCR1A = 0;
  TCCR1B = 1 << CS10;
  TCCR2A = 0;
  TCCR2B = 7 << CS20;  // a 1024th
}
/// Exact up to 260 000 cycles: the slow timer counts the turns of the fast one.
[[gnu::noinline]] inline uint32_t once(Operation operation, Operation set_up) {
  set_up();
  TCNT2 = 0;
  TCNT1 = 0;
  operation();
  const uint16_t count = TCNT1;
  const uint32_t about = static_cast<uint32_t>(TCNT2) * 1024u + 32768u;
  return count + ((about - count) & 0xFFFF0000u);
}
#else
const uint32_t calls = 64;
const uint32_t resolution = 2;
const uint16_t searches = 2000;  ///< Each is many calls here.
#if defined(__ARM_FP)
const uint32_t halves = 80;      // MPS2: 25 MHz
#else
const uint32_t halves = 125;  // micro:bit: 16 MHz
#endif

inline volatile uint32_t& register_at(uint32_t address) {
  return *reinterpret_cast<volatile uint32_t*>(address);
}
inline void start() {
  register_at(0xE000E014u) = 0xFFFFFFu;  // SysTick reload
  register_at(0xE000E018u) = 0;
  register_at(0xE000E010u) = 5;  // processor clock, no interrupt
}
inline uint32_t ticks(Operation operation, Operation set_up) {
  const uint32_t before = register_at(0xE000E018u);
  for (uint32_t call = 0; call < calls; ++call) {
    set_up();
    operation();
  }
  return (before - register_at(0xE000E018u)) & 0xFFFFFFu;
}
inline void nothing() {}
/// The set-up takes part in every call, and is then taken off.
[[gnu::noinline]] inline uint32_t once(Operation operation, Operation set_up) {
  const uint32_t both = ticks(operation, set_up), one = ticks(nothing, set_up);
  return (both > one ? both - one : 0u) * halves / 2u / calls;
}
#endif

}  // namespace counter
