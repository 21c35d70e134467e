// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// What the program needs of its board: board_qemu.cpp is one with a simulated motor, yours has an encoder, a
/// thermometer and a bridge.
namespace board {

/// What is measured at the beginning of a control cycle.
struct Measured {
  uint16_t error_units;  ///< Magnitude of the position error in units of 360/16384 degree.
  int8_t air_C;
  bool is_valid;  ///< Whether the thermometer answered.
};

constexpr uint16_t control_ticks = 40;  ///< From one control interrupt to the next: 10.24 ms.
#if defined(__ARM_FP)
constexpr uint32_t clocks_per_control = 256000;  ///< Of a processor at 25 MHz.
#else
constexpr uint32_t clocks_per_control = 163840;  ///< Of a processor at 16 MHz.
#endif

void start();                           ///< Starts the control interrupt, which calls `control()`.
Measured measure();                     ///< Reads the sensors.
void set_power(uint8_t power);          ///< 0 .. 255: V_rms = 24 V sqrt(power / 255).
uint32_t clocks();                      ///< A counter of processor clocks within a control cycle.
uint32_t clocks_since(uint32_t began);  ///< Clocks from then to now, within the cycle.
void sleep_until_interrupt();           ///< Until any interrupt.
int32_t true_winding_C();               ///< What no real board knows.
void print(const char* line);
void print_value(const char* name, uint32_t value);
void print_row(uint32_t second, uint32_t power, int32_t estimate_C, int32_t winding_C);
[[noreturn]] void stop(int status);

/// No interrupt comes while one of these lives.
class InterruptsHeldBack {
public:
  InterruptsHeldBack() { asm volatile("cpsid i" ::: "memory"); }
  ~InterruptsHeldBack() { asm volatile("cpsie i" ::: "memory"); }
  InterruptsHeldBack(const InterruptsHeldBack&) = delete;
  InterruptsHeldBack& operator=(const InterruptsHeldBack&) = delete;
};

}  // namespace board

/// The program's control cycle.
void control();
