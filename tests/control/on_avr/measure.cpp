// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// measure <mean> <longest> <ram> <name>[@<longest>] <elf> [<name>[@<longest>] <elf> ...]: runs each program on a simulated ATmega328P
// and prints, as a Markdown table, how many cycles its marked work takes, how much flash and RAM it needs beyond the
// first program, which is empty, and how deep the stack goes. Fails when a work exceeds its own longest, when the last program's work
// exceeds one of the two budgets in cycles or the one of bytes, when a stack meets the data below it, and when a program writes to GPIOR1 that what it
// measures was not done. The first two axes alone may look cheap: a stack that overwrote the third did.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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
  unsigned refused = 0;
  bool is_done = false;
};

// The stack pointer is written in two halves; it can be trusted where it is used.
bool is_stack_used(const avr_t* avr) {
  const unsigned code = avr->flash[avr->pc] | static_cast<unsigned>(avr->flash[avr->pc + 1]) << 8;
  const bool is_push = (code & 0xfe0f) == 0x920f;
  const bool is_call = (code & 0xfe0e) == 0x940e || (code & 0xf000) == 0xd000 || code == 0x9509;
  return is_push || is_call;
}
unsigned stack_pointer(const avr_t* avr) {
  return avr->data[0x5d] | static_cast<unsigned>(avr->data[0x5e]) << 8;
}

void on_refusal(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* parameter) {
  avr->data[address] = value;
  static_cast<Marks*>(parameter)->refused += value;
}

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
  unsigned flash, ram, stack, refused;
  bool is_stack_free;
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
  avr_register_io_write(avr, 0x3e, on_mark, &marks);     // GPIOR0
  avr_register_io_write(avr, 0x4a, on_refusal, &marks);  // GPIOR1
  unsigned deepest = avr->ramend;
  while (!marks.is_done && avr->cycle < 4000000000ULL) {
    // What an instruction pushes lies at the pointer and, of a call, below.
    if (is_stack_used(avr) && stack_pointer(avr) > 0x100) deepest = std::min(deepest, stack_pointer(avr) - 2);
    const int state = avr_run(avr);
    if (state == cpu_Crashed || (state == cpu_Done && !marks.is_done)) return false;
  }
  if (marks.count == 0) return false;
  cost.mean = marks.sum / marks.count;
  cost.longest = marks.longest;
  cost.flash = firmware.flashsize;
  cost.ram = firmware.datasize + firmware.bsssize;
  cost.stack = avr->ramend - deepest;
  cost.is_stack_free = deepest >= 0x100 + cost.ram;
  cost.refused = marks.refused;
  return true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count < 8 || argument_count % 2 != 0) {
    std::fprintf(stderr, "usage: measure <mean> <longest> <ram> <name> <elf> [<name> <elf> ...]\n");
    return 2;
  }
  const unsigned long long mean = std::strtoull(arguments[1], nullptr, 10);
  const unsigned long long longest = std::strtoull(arguments[2], nullptr, 10);
  const unsigned long long ram = std::strtoull(arguments[3], nullptr, 10);
  std::printf(
      "| step of | cycles, mean | cycles, longest | flash, bytes | RAM, bytes | stack, bytes |\n"
      "|---|---|---|---|---|---|\n");
  Cost empty = {}, cost = {};
  bool is_good = true;
  for (int i = 4; i < argument_count; i += 2) {
    if (!run(arguments[i + 1], cost)) {
      std::fprintf(stderr, "%s: did not run\n", arguments[i + 1]);
      return 1;
    }
    if (!cost.is_stack_free) {
      std::fprintf(stderr, "%s: the stack overwrites its data\n", arguments[i]);
      is_good = false;
    }
    if (cost.refused != 0) {
      std::fprintf(stderr, "%s: %u steps were refused\n", arguments[i], cost.refused);
      is_good = false;
    }
    if (i == 4) {
      empty = cost;
      continue;
    }
    cost.mean -= empty.mean;
    cost.longest -= empty.mean;
    const char* const budget = std::strchr(arguments[i], '@');
    const int name_size = static_cast<int>(budget != nullptr ? static_cast<std::size_t>(budget - arguments[i])
                                                             : std::strlen(arguments[i]));
    if (budget != nullptr && cost.longest >= std::strtoull(budget + 1, nullptr, 10)) {
      std::fprintf(stderr, "%.*s: %llu cycles, to be under %s\n", name_size, arguments[i], cost.longest,
                   budget + 1);
      is_good = false;
    }
    std::printf("| %.*s | %llu | %llu | %u | %u | %u |\n", name_size, arguments[i], cost.mean, cost.longest,
                cost.flash - empty.flash, cost.ram - empty.ram, cost.stack);
  }
  std::printf(
      "\nThe last one takes %.1f %% of a 10 ms cycle at 16 MHz on average, %.1f %% at most, and %u bytes of RAM; "
      "allowed: %llu and %llu cycles, %llu bytes.\n",
      static_cast<double>(cost.mean) / 1600.0, static_cast<double>(cost.longest) / 1600.0,
      cost.ram - empty.ram, mean, longest, ram);
  return is_good && cost.mean <= mean && cost.longest <= longest && cost.ram - empty.ram <= ram ? 0 : 1;
}
