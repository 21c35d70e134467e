// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstdint>
#include <cstring>
#include <simulated_chip.hpp>
#include <string>
#include <vector>

#include "nano_original.hpp"

/// The original's arithmetic as the original's chip does it: nano_original_chip.cpp in the simulator, asked
/// update by update.
class OriginalOnItsChip {
public:
  explicit OriginalOnItsChip(const std::string& elf_path) : chip_(elf_path) {
    chip_.on_transmit = [this](std::uint64_t, std::uint8_t byte) { answer_.push_back(byte); };
    chip_.run_until(10000);
  }

  original::Decision update(const thermopower::sbgc::RealtimeFields& telemetry, std::uint32_t micros) {
    std::vector<std::uint8_t> question;
    const auto put_u16 = [&](unsigned value) {
      question.push_back(static_cast<std::uint8_t>(value & 0xFFu));
      question.push_back(static_cast<std::uint8_t>(value >> 8 & 0xFFu));
    };
    for (const std::int16_t angle : telemetry.imu_angle) put_u16(static_cast<std::uint16_t>(angle));
    for (const std::int16_t angle : telemetry.target_angle) put_u16(static_cast<std::uint16_t>(angle));
    put_u16(telemetry.battery_cV);
    question.push_back(static_cast<std::uint8_t>(telemetry.imu_C));
    question.push_back(static_cast<std::uint8_t>(telemetry.frame_imu_C));
    put_u16(micros & 0xFFFFu);
    put_u16(micros >> 16);

    answer_.clear();
    std::uint64_t end_cycle = chip_.cycle() + nano::SimulatedChip::cycles_per_byte;
    for (const std::uint8_t byte : question)
      chip_.receive(end_cycle += nano::SimulatedChip::cycles_per_byte + 30, byte);
    while (answer_.size() < 1 + 3 * 6) chip_.run_until(chip_.cycle() + 500);

    original::Decision decision;
    decision.is_sent = answer_[0] != 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint8_t* at = answer_.data() + 1 + 6 * axis;
      decision.power[axis] = at[0];
      decision.p_gain[axis] = at[1];
      std::memcpy(&motor_C_[axis], at + 2, sizeof(float));
    }
    return decision;
  }

  float motor_C(int axis) const { return motor_C_[axis]; }

private:
  nano::SimulatedChip chip_;
  std::vector<std::uint8_t> answer_;
  float motor_C_[3] = {0, 0, 0};
};
