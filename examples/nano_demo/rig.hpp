// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <thermopower/simulation/emulated_board.hpp>
#include <vector>

#include "simulated_chip.hpp"

namespace nano {

/// One telemetry answer and what the chip made of it.
struct Update {
  thermopower::sbgc::RealtimeFields telemetry;  ///< As the chip received it.
  std::uint64_t last_in_cycle = 0;              ///< Its last byte was received.
  std::uint64_t first_out_cycle = 0;  ///< The first byte of the chip's command was handed to the transmitter.
  std::uint64_t queued_cycle = 0;     ///< The whole command was handed over; 0 when that could not be seen.
  std::uint64_t sent_cycle = 0;       ///< The command's last byte has left: the board may obey.
  std::uint8_t power[3] = {0, 0, 0};  ///< POWER commanded.
  std::uint8_t p_gain[3] = {0, 0, 0};  ///< P commanded.

  double time_s() const { return static_cast<double>(first_out_cycle) / (1e6 * cycles_per_us); }
  std::uint64_t response_cycles() const { return first_out_cycle - last_in_cycle; }
};

/// A command that answers no telemetry: what the chip sends when it hears nothing.
struct UnaskedCommand {
  double time_s = 0;
  std::uint8_t power[3] = {0, 0, 0};
  std::uint8_t p_gain[3] = {0, 0, 0};
};

/// A chip and an emulated board at two ends of a serial line, and a world that both act upon.
class Rig {
public:
  typedef thermopower::simulation::EmulatedBoard Board;
  typedef thermopower::simulation::BoardTruth Truth;

  /// Advances the world to a time and says what is to be measured there. Called before each look of the board
  /// at its input.
  typedef std::function<Truth(double time_s, Board& board)> World;

  /// @param eeprom  its first bytes; the rest is erased
  /// @throws std::runtime_error when the program cannot be loaded
  Rig(const std::string& elf_path, const thermopower::simulation::BoardConfig& board, World world,
      const std::vector<std::uint8_t>& eeprom = {});
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  /// Runs to a time since the chip's reset. @throws std::runtime_error when the program crashes
  void run_until(double time_s);

  /// Resets the chip in the middle of whatever it does; the board goes on. @param is_power_lost  see
  /// SimulatedChip::reset()
  void reset_chip(bool is_power_lost);

  double time_s() const;                   ///< Since the start.
  Board& board() { return board_; }        ///< To make faults, or to count.
  SimulatedChip& chip() { return chip_; }  ///< To look into.
  const std::vector<Update>& updates() const { return updates_; }
  const std::vector<UnaskedCommand>& unasked() const { return unasked_; }
  std::uint64_t requests() const { return requests_; }  ///< Telemetry requests the chip has sent.
  /// Whole telemetry frames the chip sent no command for.
  std::uint64_t unanswered() const { return unanswered_; }
  /// Whole telemetry not answered yet.
  std::uint64_t under_way() const { return expected_.size() + (current_ ? 1u : 0u); }
  std::uint64_t stray_bytes() const;  ///< Bytes sent by the chip that belong to no frame.
  /// Bytes waiting in the core's 64-byte buffer (63 fit).
  unsigned fullest_receive_buffer() const { return fullest_; }
  /// Is the core's Serial object where it is expected?
  bool sees_core_buffers() const { return serial_address_ != 0; }

private:
  void hear(std::uint64_t cycle, std::uint8_t byte);
  void take_frame(const thermopower::sbgc::Frame& frame, std::uint64_t start_cycle, std::uint64_t end_cycle);
  void deliver(double until_us);
  void watch_update();
  unsigned waiting_bytes() const;

  SimulatedChip chip_;
  Board board_;
  World world_;
  thermopower::SbgcCodec<255, thermopower::sbgc::ProtocolAuto> ear_;
  std::uint16_t serial_address_ = 0;
  std::uint64_t wire_free_cycle_ = 0;
  std::uint64_t frame_start_cycle_ = 0;
  std::uint64_t bytes_heard_in_frame_ = 0;
  std::vector<Update> expected_;   // whole telemetry on the wire whose command has not come yet
  std::optional<Update> current_;  // telemetry fully received, command awaited
  std::vector<Update> updates_;
  std::vector<UnaskedCommand> unasked_;
  std::uint64_t requests_ = 0, unanswered_ = 0;
  unsigned fullest_ = 0;
  bool is_watching_ = false;
};

}  // namespace nano
