// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file monitor/detail/turn_sums.hpp
/// Sums of a block that the balances of winding and motion use in turns.

namespace thermopower {
namespace detail {

struct TurnSums {
  int32_t first_sum = 0, second_sum = 0;
  int16_t at_first = 0;  // 0: no sample yet; no_count(): the block will not be judged
  int16_t at_last = 0;
  void clear() noexcept { *this = TurnSums(); }
};
/// Where nobody sums.
struct NoSums {
  void clear() noexcept {}
};
template <bool has_sums>
struct TurnSumsOf {
  typedef TurnSums Type;
};
template <>
struct TurnSumsOf<false> {
  typedef NoSums Type;
};

}  // namespace detail
}  // namespace thermopower
