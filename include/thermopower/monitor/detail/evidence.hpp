// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/constexpr_math.hpp"
#include "binary_scale.hpp"

/// @file monitor/detail/evidence.hpp
/// The sequential test of a balance: two cumulative sums of log-likelihood ratios, one a direction.

namespace thermopower {
namespace detail {

/// Counts of evidence in a nat. The sum of a healthy plant reaches `n` nats in one block of exp(n).
constexpr int evidence_per_nat() { return 8; }

/// Nats at which sums of a balance alarm, so that of all `tests` in one block of `block_s` at most one in
/// `false_alarm_h` hours does so without a cause.
constexpr double evidence_limit_nat(double false_alarm_h, double block_s, double tests) {
  return constexpr_log(false_alarm_h * 3600.0 / block_s * tests);
}
constexpr int evidence_limit(double false_alarm_h, double block_s, double tests) {
  return static_cast<int>(evidence_limit_nat(false_alarm_h, block_s, tests) * evidence_per_nat()) + 1;
}

/// The two sums, and since when they are not both 0.
struct Evidence {
  uint8_t more = 0;   ///< For a residual above what the bounds allow, in eighths of a nat.
  uint8_t less = 0;   ///< For one below.
  uint8_t since = 0;  ///< Blocks since the first evidence; 255: as many or more.

  bool is_none() const noexcept { return more == 0 && less == 0; }

  /// A block's residual.
  /// @param residual   what the balance lacks  @param allowed  how much of that the bounds explain
  /// @param per_count  half of evidence_per_nat() over the residual's standard deviation
  /// @param limit      where the sums alarm; a block adds at most half of it
  [[gnu::always_inline]] void add(int16_t residual, uint16_t allowed, BinaryScale per_count,
                                  uint8_t limit) noexcept {
    const uint16_t size = size_of(residual);
    const uint8_t most = static_cast<uint8_t>(limit / 2 + 1);
    // ln of the likelihood of "half a standard deviation beyond the bounds" over "at the bounds": z / 2 - 1/8.
    const int32_t nats =
        times(static_cast<int32_t>(size) - static_cast<int32_t>(allowed), per_count) - evidence_per_nat() / 8;
    const int8_t step =
        static_cast<int8_t>(nats > most ? most : (nats < -static_cast<int32_t>(most) ? -most : nats));
    // The other direction is that far on the other side of its bound.
    more = moved(more, residual > 0 ? step : static_cast<int8_t>(-most), limit);
    less = moved(less, residual < 0 ? step : static_cast<int8_t>(-most), limit);
    if (is_none()) since = 0;
    else if (since < 255) ++since;
  }

  /// At the limit: the sum of the other direction, which has no more to say, becomes a count of blocks.
  void settle(uint8_t limit, uint8_t blocks) noexcept { (more >= limit ? less : more) = blocks; }
  /// One block less.
  void count_down(uint8_t limit) noexcept {
    uint8_t& blocks = more >= limit ? less : more;
    if (blocks > 0) --blocks;
    if (since < 255) ++since;
  }

private:
  static uint8_t moved(uint8_t sum, int8_t step, uint8_t limit) noexcept {
    const int16_t to = static_cast<int16_t>(static_cast<int16_t>(sum) + step);
    return to < 0 ? uint8_t(0) : (to > limit ? limit : static_cast<uint8_t>(to));
  }
};

}  // namespace detail
}  // namespace thermopower
