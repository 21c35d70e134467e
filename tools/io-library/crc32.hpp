// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <cstdint>

namespace thermopower::io {

/// @brief The check sum of ZIP, PNG and MCAP (polynomial 0xEDB88320, reflected), bytes as they come.
class Crc32 {
public:
  /// Takes further bytes into the sum.
  void add(const unsigned char* bytes, std::size_t size);
  /// The sum of all bytes so far.
  std::uint32_t value() const { return ~sum_; }

private:
  std::uint32_t sum_ = 0xffffffffu;
};

}  // namespace thermopower::io
