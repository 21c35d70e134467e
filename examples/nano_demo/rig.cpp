// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "rig.hpp"

#include <algorithm>
#include <cmath>

namespace nano {
namespace {

namespace sbgc = thermopower::sbgc;

// Members of the core's HardwareSerial, counted from the object's start (arduino-core-avr 1.8, 64-byte
// buffers).
constexpr std::uint32_t serial_size = 157;
constexpr std::uint16_t receive_head = 25, receive_tail = 26, transmit_head = 27;
constexpr std::uint8_t buffer_mask = 63;
constexpr std::uint8_t command_frame_bytes = 36;

// Never short of it.
std::uint64_t cycles_of_us(double us) { return static_cast<std::uint64_t>(std::ceil(us * cycles_per_us)); }
double us_of_cycles(std::uint64_t cycle) { return static_cast<double>(cycle) / cycles_per_us; }

}  // namespace

Rig::Rig(const std::string& elf_path, const thermopower::simulation::BoardConfig& board, World world,
         const std::vector<std::uint8_t>& eeprom)
    : chip_(elf_path), board_(board), world_(std::move(world)) {
  for (std::size_t at = 0; at < eeprom.size(); ++at)
    chip_.set_eeprom(static_cast<std::uint16_t>(at), eeprom[at]);
  const auto serial = chip_.elf().symbols.find("Serial");
  if (serial != chip_.elf().symbols.end() && serial->second.size == serial_size)
    serial_address_ = static_cast<std::uint16_t>(serial->second.address & 0xFFFFu);
  chip_.on_transmit = [this](std::uint64_t cycle, std::uint8_t byte) { hear(cycle, byte); };
  chip_.on_received = [this](std::uint64_t cycle) {
    fullest_ = std::max(fullest_, waiting_bytes() + 1);
    if (expected_.empty() || expected_.front().last_in_cycle > cycle) return;
    if (current_) ++unanswered_;
    current_ = expected_.front();
    expected_.erase(expected_.begin());
    is_watching_ = serial_address_ != 0;
  };
}

void Rig::reset_chip(bool is_power_lost) {
  chip_.reset(is_power_lost);
  expected_.clear();
  current_.reset();
  is_watching_ = false;
}

double Rig::time_s() const { return us_of_cycles(chip_.cycle()) * 1e-6; }
std::uint64_t Rig::stray_bytes() const { return ear_.counters().skipped_bytes; }

unsigned Rig::waiting_bytes() const {
  if (serial_address_ == 0) return 0;
  const unsigned head = chip_.data(static_cast<std::uint16_t>(serial_address_ + receive_head));
  const unsigned tail = chip_.data(static_cast<std::uint16_t>(serial_address_ + receive_tail));
  return (head - tail) & buffer_mask;
}

void Rig::hear(std::uint64_t cycle, std::uint8_t byte) {
  // The transmitter holds a byte back while the one before is on the wire.
  const std::uint64_t start_cycle = std::max(cycle, wire_free_cycle_);
  wire_free_cycle_ = start_cycle + SimulatedChip::cycles_per_byte;
  const double end_us = us_of_cycles(wire_free_cycle_);
  board_.receive(byte, end_us);
  if (ear_.pending() == 0) frame_start_cycle_ = cycle;
  for (bool got = ear_.receive(byte, static_cast<std::uint32_t>(end_us)); got; got = ear_.next())
    take_frame(ear_.frame(), frame_start_cycle_, wire_free_cycle_);
}

void Rig::take_frame(const sbgc::Frame& frame, std::uint64_t start_cycle, std::uint64_t end_cycle) {
  if (frame.id == sbgc::command::realtime_data_3 || frame.id == sbgc::command::realtime_data_4) ++requests_;
  sbgc::AdjVarsView vars;
  if (!vars.read(frame)) return;
  Update update;
  for (int axis = 0; axis < 3; ++axis) {
    std::int32_t power = 0, p_gain = 0;
    vars.find(static_cast<std::uint8_t>(sbgc::variable::power_roll + axis), power);
    vars.find(static_cast<std::uint8_t>(sbgc::variable::p_roll + axis), p_gain);
    update.power[axis] = static_cast<std::uint8_t>(power);
    update.p_gain[axis] = static_cast<std::uint8_t>(p_gain);
  }
  if (!current_ || start_cycle < current_->last_in_cycle) {
    UnaskedCommand command;
    command.time_s = us_of_cycles(start_cycle) * 1e-6;
    std::copy(update.power, update.power + 3, command.power);
    std::copy(update.p_gain, update.p_gain + 3, command.p_gain);
    unasked_.push_back(command);
    return;
  }
  std::copy(update.power, update.power + 3, current_->power);
  std::copy(update.p_gain, update.p_gain + 3, current_->p_gain);
  current_->first_out_cycle = start_cycle;
  current_->sent_cycle = end_cycle;
  updates_.push_back(*current_);
  current_.reset();
}

void Rig::deliver(double until_us) {
  thermopower::simulation::LineByte byte;
  while (board_.transmit(until_us, byte)) {
    const std::uint64_t end_cycle = cycles_of_us(byte.end_us);
    chip_.receive(end_cycle, byte.value);
    if (!byte.ends_whole_telemetry) continue;
    Update update;
    update.telemetry = board_.last_telemetry();
    update.last_in_cycle = end_cycle;
    expected_.push_back(update);
  }
}

// From the last byte of an answer to the command's last byte in the transmit buffer, an instruction at a
// time.
void Rig::watch_update() {
  is_watching_ = false;
  const auto head_address = static_cast<std::uint16_t>(serial_address_ + transmit_head);
  const unsigned head_before = chip_.data(head_address);
  const std::uint64_t give_up_cycle = chip_.cycle() + 400000;
  while (chip_.cycle() < give_up_cycle) {
    chip_.run_instruction();
    // The first byte goes straight to the transmitter, past the buffer.
    if (((chip_.data(head_address) - head_before) & buffer_mask) < command_frame_bytes - 1u) continue;
    if (current_) current_->queued_cycle = chip_.cycle();
    return;
  }
}

void Rig::run_until(double time_s) {
  const double until_us = time_s * 1e6;
  while (us_of_cycles(chip_.cycle()) < until_us) {
    // Small portions: what one end sends must not reach the other before its time. The board only speaks when
    // it has parsed.
    const double now_us = us_of_cycles(chip_.cycle());
    const double portion_us = std::min({until_us, board_.next_parse_us(), now_us + 100.0});
    chip_.run_until(cycles_of_us(portion_us));
    if (is_watching_) watch_update();
    if (board_.next_parse_us() <= portion_us) {
      board_.step(portion_us, world_(portion_us * 1e-6, board_));
      deliver(1e300);
    }
  }
}

}  // namespace nano
