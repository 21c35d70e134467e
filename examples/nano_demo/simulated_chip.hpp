// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "elf_facts.hpp"

namespace nano {

constexpr double cycles_per_us = 16.0;  ///< 16 MHz.

/// An ATmega328P at 16 MHz running a program, cycle by cycle (libsimavr), with its serial port at its real
/// pace.
///
/// The port's own bytes take 10 bits at 117 647 baud (1360 cycles), which is what the core makes of 115200.
/// Received bytes come when the other end says.
class SimulatedChip {
public:
  static constexpr std::uint32_t cycles_per_byte = 1360;  ///< 10 bits of 136 cycles.

  /// @throws std::runtime_error when the program cannot be read
  explicit SimulatedChip(const std::string& elf_path);
  ~SimulatedChip();
  SimulatedChip(SimulatedChip&&) noexcept;
  SimulatedChip& operator=(SimulatedChip&&) noexcept;

  /// Runs to a cycle (a few more, to the end of an instruction). @throws std::runtime_error when the program
  /// crashes or stops
  void run_until(std::uint64_t cycle);
  /// As run_until(), but returns false instead when the program has stopped with interrupts off (its way to
  /// say it is done).
  bool run_until_or_stop(std::uint64_t cycle);
  /// Runs one instruction.
  void run_instruction();

  /// A byte whose stop bit ends at a cycle; bytes must be given in order.
  void receive(std::uint64_t end_cycle, std::uint8_t byte);
  /// The voltage at an analog pin from now on. @param channel  0..7  @param mV  0..5000, of a supply of 5000
  void set_analog(int channel, std::uint32_t mV);
  /// Called when the program hands a byte to the transmitter.
  std::function<void(std::uint64_t cycle, std::uint8_t byte)> on_transmit;
  /// Called when a received byte becomes visible to the program.
  std::function<void(std::uint64_t cycle)> on_received;

  std::uint64_t cycle() const;                     ///< Cycles since reset.
  std::uint8_t data(std::uint16_t address) const;  ///< A byte of the data space: registers, I/O, RAM.
  void set_data(std::uint16_t address,
                std::uint8_t value);  ///< Overwrites a byte of the data space, to start from a rare state.
  /// A byte of the EEPROM, before the program runs or between runs.
  void set_eeprom(std::uint16_t address, std::uint8_t value);
  /// Pulls the reset line for a moment. @param is_power_lost  the RAM forgets as well; the EEPROM does not
  void reset(bool is_power_lost);
  const ElfFacts& elf() const;  ///< The program's size and symbols.
  /// Deepest stack so far: RAM above the variables is painted at reset, and what is no longer painted was
  /// stack.
  std::uint16_t deepest_stack_bytes() const;
  std::uint64_t bytes_overrun() const;  ///< Received bytes that the two-byte hardware buffer had no room for.

private:
  struct Simulation;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace nano
