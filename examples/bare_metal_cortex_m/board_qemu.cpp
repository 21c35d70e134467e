// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A Cortex-M in qemu: vector table, start-up, the system timer, text by semihosting, and a joint that warms
// as copper does.
#include <stddef.h>
#include <string.h>

#include "board.hpp"

extern "C" {
extern uint32_t stack_top, data_load, data_begin, data_end, bss_begin, bss_end;
extern void (*init_array_begin[])();
extern void (*init_array_end[])();
int main();
void reset();
void fault();
void system_timer();
}

namespace {

volatile uint32_t& register_at(uint32_t address) { return *reinterpret_cast<volatile uint32_t*>(address); }
constexpr uint32_t timer_control = 0xE000E010u, timer_reload = 0xE000E014u, timer_value = 0xE000E018u;

// Arm's semihosting interface: operation in r0, its argument in r1.
uint32_t semihosting(uint32_t operation, const void* argument) {
  register uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
constexpr uint32_t sys_write0 = 0x04, sys_exit_extended = 0x20, application_exit = 0x20026;

// The world: a winding of 2 ohm at 25 degC on 180 J/K, in air of 31 degC, and a minute's heavy work.
struct Joint {
  float winding_C;
  uint32_t cycles;
  uint8_t power;
} joint = {31.0f, 0, 1};

void live() {
  const float watt = 24.0f * 24.0f * static_cast<float>(joint.power) / 255.0f /
                     (2.0f * (1.0f + 0.00393f * (joint.winding_C - 25.0f)));
  joint.winding_C += (watt - 0.9f * (joint.winding_C - 31.0f)) / 180.0f *
                     (static_cast<float>(board::control_ticks) * 256e-6f);
  ++joint.cycles;
}

// Writes a number right-aligned before `end`; returns where it begins.
char* write_number(char* end, uint32_t value, uint32_t width) {
  char* at = end;
  do *--at = static_cast<char>('0' + value % 10u);
  while ((value /= 10u) != 0);
  while (at > end - width) *--at = ' ';
  return at;
}

}  // namespace

namespace board {

void start() {
  register_at(timer_reload) = clocks_per_control - 1;
  register_at(timer_value) = 0;
  register_at(timer_control) = 7;  // processor clock, interrupt, on
}
Measured measure() {
  const bool is_working = joint.cycles < 60u * 3906u / control_ticks;
  const Measured measured = {static_cast<uint16_t>(is_working ? 250 : 40), 31, true};
  return measured;
}
void set_power(uint8_t power) { joint.power = power; }
uint32_t clocks() { return register_at(timer_value); }
uint32_t clocks_since(uint32_t began) {
  const uint32_t now = register_at(timer_value);  // it counts down
  return began >= now ? began - now : began + clocks_per_control - now;
}
void sleep_until_interrupt() { asm volatile("wfi"); }
int32_t true_winding_C() {
  const InterruptsHeldBack now;
  return static_cast<int32_t>(joint.winding_C);
}
void print(const char* line) {
  semihosting(sys_write0, line);
  semihosting(sys_write0, "\n");
}
void print_value(const char* name, uint32_t value) {
  char text[12] = {0};
  semihosting(sys_write0, name);
  print(write_number(text + sizeof text - 1, value, 7));
}
void print_row(uint32_t second, uint32_t power, int32_t estimate_C, int32_t winding_C) {
  char text[36] = {0};
  char* at = write_number(text + sizeof text - 1, static_cast<uint32_t>(winding_C), 14);
  at = write_number(at, static_cast<uint32_t>(estimate_C), 10);
  at = write_number(at, power, 7);
  print(write_number(at, second, 4));
}
void stop(int status) {
  const uint32_t arguments[2] = {application_exit, static_cast<uint32_t>(status)};
  semihosting(sys_exit_extended, arguments);
  for (;;) {
  }
}

}  // namespace board

__attribute__((section(".vectors"), used)) void (*const vectors[16])() = {
    reinterpret_cast<void (*)()>(&stack_top),
    reset,
    fault,
    fault,
    fault,
    fault,
    fault,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    fault,
    fault,
    nullptr,
    fault,
    system_timer};

void reset() {
#if defined(__ARM_FP)
  register_at(0xE000ED88u) |= 0xFu << 20;  // CPACR: the floating-point unit is off after reset
  asm volatile("dsb\n isb");
#endif
  memcpy(
      &data_begin, &data_load,
      static_cast<size_t>(reinterpret_cast<uint8_t*>(&data_end) - reinterpret_cast<uint8_t*>(&data_begin)));
  memset(&bss_begin, 0,
         static_cast<size_t>(reinterpret_cast<uint8_t*>(&bss_end) - reinterpret_cast<uint8_t*>(&bss_begin)));
  for (void (**function)() = init_array_begin; function != init_array_end; ++function) (*function)();
  main();
  board::stop(1);
}

void fault() { board::stop(2); }

void system_timer() {
  live();
  control();
}
