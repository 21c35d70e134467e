// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "crc32.hpp"

#include <array>

namespace thermopower::io {
namespace {

using Table = std::array<std::array<std::uint32_t, 256>, 8>;

// Row k holds what a byte does to the sum k bytes later, so that eight bytes take one step.
Table make_table() {
  Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1) != 0 ? 0xEDB88320u : 0u);
    table[0][byte] = sum;
  }
  for (std::size_t row = 1; row < table.size(); ++row)
    for (std::size_t byte = 0; byte < 256; ++byte)
      table[row][byte] = (table[row - 1][byte] >> 8) ^ table[0][table[row - 1][byte] & 0xff];
  return table;
}

}  // namespace

void Crc32::add(const unsigned char* bytes, std::size_t size) {
  static const Table table = make_table();
  std::uint32_t sum = sum_;
  for (; size >= 8; bytes += 8, size -= 8) {
    sum ^= static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
           static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    sum = table[7][sum & 0xff] ^ table[6][sum >> 8 & 0xff] ^ table[5][sum >> 16 & 0xff] ^
          table[4][sum >> 24] ^ table[3][bytes[4]] ^ table[2][bytes[5]] ^ table[1][bytes[6]] ^
          table[0][bytes[7]];
  }
  for (; size > 0; ++bytes, --size) sum = (sum >> 8) ^ table[0][(sum ^ *bytes) & 0xff];
  sum_ = sum;
}

}  // namespace thermopower::io
