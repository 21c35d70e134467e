// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cstdint>

/// A record of the sketches' journal, written from its description: sequence, degC + 60, the complement of their sum, and
/// CRC-16 (polynomial 0x1021, most significant bit first) of both from 0x5448 on, low byte first.
inline std::array<std::uint8_t, 5> journal_record(int sequence, int code) {
  unsigned sum = 0x5448;
  for (const int byte : {sequence, code})
    for (int bit = 7; bit >= 0; --bit) {
      const bool is_set = ((sum >> 15) & 1u) != (static_cast<unsigned>(byte >> bit) & 1u);
      sum = ((sum << 1) ^ (is_set ? 0x1021u : 0u)) & 0xFFFFu;
    }
  return {{static_cast<std::uint8_t>(sequence), static_cast<std::uint8_t>(code),
           static_cast<std::uint8_t>(~(sequence + code)), static_cast<std::uint8_t>(sum & 0xFF),
           static_cast<std::uint8_t>(sum >> 8)}};
}
