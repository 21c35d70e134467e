// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <random>

#include <thermopower/simulation/emulated_board_truth.hpp>

/// @file emulated_board_line.hpp
/// The sending half of an emulated board's serial line: each byte at its time, and damage where it is asked
/// for.

namespace thermopower::simulation {

/// A byte on its way to the other end.
struct LineByte {
  double end_us;              ///< When its stop bit ends.
  std::uint8_t value;         ///< As it arrives.
  bool ends_whole_telemetry;  ///< Last byte of a telemetry frame all of whose bytes arrive as they were sent.
};

/// Bytes in a row, one after the other, at the line's pace.
///
/// @snippet simulation_examples.cpp board line
/// How to: @ref rig.
class BoardLine {
public:
  /// @param byte_us  time of one byte on the wire, above 0
  /// @param seed     of the random damage; the same seed gives the same damage
  BoardLine(double byte_us, std::uint64_t seed) : byte_us_(byte_us), random_(seed) {}

  /// Queues one frame. @param earliest_us  its first byte starts now or when the line is free, whichever is
  /// later
  void send(const std::uint8_t* bytes, std::size_t size, double earliest_us, bool is_telemetry,
            const BoardFaults& faults) {
    bool is_whole = is_telemetry && !faults.is_silent;
    for (std::size_t at = 0; at < size; ++at) {
      free_us_ = (earliest_us > free_us_ ? earliest_us : free_us_) + byte_us_;
      std::uint8_t value = bytes[at];
      const bool is_lost = faults.is_silent || happens(faults.lost_byte_rate);
      if (happens(faults.changed_byte_rate))
        value = static_cast<std::uint8_t>(value ^ (1u << (random_() % 8u)));
      is_whole = is_whole && !is_lost && value == bytes[at];
      if (!is_lost) bytes_.push_back({free_us_, value, is_whole && at + 1 == size});
      if (happens(faults.noise_byte_rate)) {
        free_us_ += byte_us_;
        bytes_.push_back({free_us_, static_cast<std::uint8_t>(random_() % 256u), false});
        is_whole = is_whole && at + 1 == size;
      }
    }
  }

  /// Takes the next byte that is complete by a time. @return false when there is none
  bool take(double until_us, LineByte& byte) {
    if (bytes_.empty() || bytes_.front().end_us > until_us) return false;
    byte = bytes_.front();
    bytes_.pop_front();
    return true;
  }

  /// When everything queued will have been sent.
  double free_us() const { return free_us_; }
  /// Bytes that are still to be sent at a time.
  double backlog_bytes(double now_us) const {
    return free_us_ > now_us ? (free_us_ - now_us) / byte_us_ : 0.0;
  }

private:
  bool happens(double probability) {
    if (!(probability > 0)) return false;
    return static_cast<double>(random_() >> 11) * 0x1p-53 < probability;
  }

  double byte_us_;
  double free_us_ = 0;
  std::mt19937_64 random_;
  std::deque<LineByte> bytes_;
};

}  // namespace thermopower::simulation
