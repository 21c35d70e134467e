// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// simavr_run <program.elf>: runs a program for the ATmega328P. What it writes to the serial port goes to the
// standard output; when it sleeps with interrupts off it is done, and GPIOR0 is the exit status. 3 when it
// crashes or runs longer than ten simulated minutes.
#include <cstdio>
#include <exception>
#include <iostream>
#include <simulated_chip.hpp>

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "usage: simavr_run <program.elf>\n";
    return 2;
  }
  constexpr std::uint16_t gpior0 = 0x3E;
  constexpr std::uint64_t longest = 600ull * 16000000ull;
  try {
    nano::SimulatedChip chip(arguments[1]);
    chip.on_transmit = [](std::uint64_t, std::uint8_t byte) { std::putchar(byte); };
    if (!chip.run_until_or_stop(longest)) return chip.data(gpior0);
    std::cerr << arguments[1] << ": still running after ten simulated minutes\n";
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return 3;
}
