// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// measure <budget> <name> <elf> [<name> <elf> ...]: runs each program on a simulated ATmega328P and prints,
// as a Markdown table, how many cycles its marked work takes and how much flash and RAM it needs beyond the
// first program, which is empty. Fails when the last program's work ever exceeds the budget.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

extern "C" {
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace {

struct Marks {
  avr_cycle_count_t begun = 0;
  unsigned long long sum = 0, longest = 0;
  unsigned count = 0, calls = 0;
  bool is_done = false;
};

void on_mark(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* parameter) {
  Marks& marks = *static_cast<Marks*>(parameter);
  avr->data[address] = value;
  if (value == 1) marks.begun = avr->cycle;
  if (value == 2) {
    const unsigned long long taken = avr->cycle - marks.begun;
    // The first calls fit themselves to the loop's time step, once.
    if (++marks.calls <= 64) return;
    marks.sum += taken;
    marks.longest = std::max(marks.longest, taken);
    ++marks.count;
  }
  if (value == 3) marks.is_done = true;
}

struct Cost {
  unsigned long long mean, longest;
  unsigned flash, ram;
};

bool run(const char* path, Cost& cost) {
  elf_firmware_t firmware = {};
  if (elf_read_firmware(path, &firmware) != 0) return false;
  avr_t* avr = avr_make_mcu_by_name("atmega328p");
  if (avr == nullptr) return false;
  avr_init(avr);
  firmware.frequency = 16000000;
  avr_load_firmware(avr, &firmware);
  Marks marks;
  avr_register_io_write(avr, 0x3e, on_mark, &marks);  // GPIOR0
  while (!marks.is_done && avr->cycle < 4000000000ULL) {
    const int state = avr_run(avr);
    if (state == cpu_Crashed || (state == cpu_Done && !marks.is_done)) return false;
  }
  if (marks.count == 0) return false;
  cost.mean = marks.sum / marks.count;
  cost.longest = marks.longest;
  cost.flash = firmware.flashsize;
  cost.ram = firmware.datasize + firmware.bsssize;
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 6 || argument_count % 2 != 0) {
    std::fprintf(stderr, "usage: measure <budget> <name> <elf> [<name> <elf> ...]\n");
    return 2;
  }
  const unsigned long long budget = std::strtoull(arguments[1], nullptr, 10);
  std::printf(
      "| step of | cycles, mean | cycles, longest | flash, bytes | RAM, bytes |\n|---|---|---|---|---|\n");
  Cost empty = {}, cost = {};
  for (int i = 2; i < argument_count; i += 2) {
    if (!run(arguments[i + 1], cost)) {
      std::fprintf(stderr, "%s: did not run\n", arguments[i + 1]);
      return 1;
    }
    if (i == 2) {
      empty = cost;
      continue;
    }
    cost.mean -= empty.mean;
    cost.longest -= empty.mean;
    std::printf("| %s | %llu | %llu | %u | %u |\n", arguments[i], cost.mean, cost.longest,
                cost.flash - empty.flash, cost.ram - empty.ram);
  }
  std::printf(
      "\nThe last one takes %.1f %% of a 10 ms cycle at 16 MHz on average, %.1f %% at most; allowed: %llu "
      "cycles.\n",
      static_cast<double>(cost.mean) / 1600.0, static_cast<double>(cost.longest) / 1600.0, budget);
  return cost.longest <= budget ? 0 : 1;
}
