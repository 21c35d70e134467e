// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// chip_check <elf>: runs a program on a simulated ATmega328P until it writes 3 to GPIOR0, and returns what it
// wrote to GPIOR1.

#include <cstdint>
#include <cstdio>

extern "C" {
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace {

void on_mark(avr_t* avr, avr_io_addr_t address, std::uint8_t value, void* parameter) {
  avr->data[address] = value;
  if (value == 3) *static_cast<bool*>(parameter) = true;
}

}  // namespace

int main(int argument_count, char** arguments) {
  elf_firmware_t firmware = {};
  avr_t* avr = avr_make_mcu_by_name("atmega328p");
  if (argument_count != 2 || avr == nullptr || elf_read_firmware(arguments[1], &firmware) != 0) {
    std::fprintf(stderr, "usage: chip_check <elf>\n");
    return 200;
  }
  avr_init(avr);
  firmware.frequency = 16000000;
  avr_load_firmware(avr, &firmware);
  bool is_done = false;
  avr_register_io_write(avr, 0x3e, on_mark, &is_done);  // GPIOR0
  while (!is_done && avr->cycle < 2000000000ULL) {
    const int state = avr_run(avr);
    if (!is_done && (state == cpu_Crashed || state == cpu_Done)) break;
  }
  if (!is_done) {
    std::fprintf(stderr, "%s: did not end\n", arguments[1]);
    return 201;
  }
  const int found = avr->data[0x4a];  // GPIOR1
  std::printf("%s: %d\n", arguments[1], found);
  return found;
}
