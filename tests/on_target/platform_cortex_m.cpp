// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Any Cortex-M in qemu: vector table, start-up, and semihosting calls for text and exit status.
#include "report.hpp"

extern "C" {
extern uint32_t stack_top, data_load, data_begin, data_end, bss_begin, bss_end;
extern void (*init_array_begin[])();
extern void (*init_array_end[])();
int main();
void reset();
void fault();
}

namespace {

// Arm's semihosting interface: operation in r0, its argument in r1.
uint32_t semihosting(uint32_t operation, const void* argument) {
  register uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

constexpr uint32_t sys_open = 0x01, sys_write = 0x05, sys_exit_extended = 0x20, application_exit = 0x20026;

uint32_t console;
char line[64];
uint32_t used;

void flush() {
  const uint32_t arguments[3] = {console, reinterpret_cast<uint32_t>(line), used};
  semihosting(sys_write, arguments);
  used = 0;
}

}  // namespace

namespace platform {
void start() {
  const uint32_t arguments[3] = {reinterpret_cast<uint32_t>(":tt"), 4 /* write */, 3};
  console = semihosting(sys_open, arguments);
}
void put(char character) {
  line[used++] = character;
  if (used == sizeof line || character == '\n') flush();
}
void stop(int status) {
  if (used != 0) flush();
  const uint32_t arguments[2] = {application_exit, static_cast<uint32_t>(status)};
  semihosting(sys_exit_extended, arguments);
  for (;;) {
  }
}
}  // namespace platform

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
    fault};

void reset() {
#if defined(__ARM_FP)
  *reinterpret_cast<volatile uint32_t*>(0xE000ED88u) |=
      0xFu << 20;  // CPACR: the floating-point unit is off after reset
  asm volatile("dsb\n isb");
#endif
  memcpy(
      &data_begin, &data_load,
      static_cast<size_t>(reinterpret_cast<uint8_t*>(&data_end) - reinterpret_cast<uint8_t*>(&data_begin)));
  memset(&bss_begin, 0,
         static_cast<size_t>(reinterpret_cast<uint8_t*>(&bss_end) - reinterpret_cast<uint8_t*>(&bss_begin)));
  for (void (**function)() = init_array_begin; function != init_array_end; ++function) (*function)();
  main();
  platform::stop(1);
}

void fault() { platform::stop(2); }
