// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/constexpr_math.hpp"
#include "binary_scale.hpp"

/// @file monitor/detail/evidence.hpp
/// The sequential test of a balance: two cumulative sums of residuals beyond their bounds, one a direction.

namespace thermopower {
namespace detail {

/// Counts of evidence in a nat. The sum of a healthy plant reaches `n` nats in at most one block of exp(n).
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
  /// @param residual   what the balance lacks
  /// @param allowed    how much of that the bounds explain, and what keeps white noise from adding up: for a residual
  ///                   with white noise of standard deviation s, s / 4 more
  /// @param per_count  evidence of a count beyond that: for the same noise evidence_per_nat() / (2 s)
  /// @param limit      where the sums alarm; a block adds at most half of it
  [[gnu::always_inline]] void add(int16_t residual, uint16_t allowed, BinaryScale per_count,
                                  uint8_t limit) noexcept {
    const uint8_t most = static_cast<uint8_t>(limit / 2 + 1);
    more = moved(more, step(static_cast<int32_t>(residual) - allowed, per_count, most), limit);
    less = moved(less, step(-static_cast<int32_t>(residual) - allowed, per_count, most), limit);
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
  static int8_t step(int32_t beyond, BinaryScale per_count, uint8_t most) noexcept {
    const int32_t counts = times(beyond, per_count);
    return static_cast<int8_t>(counts > most ? most
                                             : (counts < -static_cast<int32_t>(most) ? -most : counts));
  }
  static uint8_t moved(uint8_t sum, int8_t step, uint8_t limit) noexcept {
    const int16_t to = static_cast<int16_t>(static_cast<int16_t>(sum) + step);
    return to < 0 ? uint8_t(0) : (to > limit ? limit : static_cast<uint8_t>(to));
  }
};

}  // namespace detail
}  // namespace thermopower
