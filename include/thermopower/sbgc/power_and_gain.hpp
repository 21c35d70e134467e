// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "detail/requirements.hpp"
#include "ids.hpp"

/// @file
/// @brief A gimbal command as the bytes of SET_ADJ_VARS_VAL, without a copy.

namespace thermopower {
namespace sbgc {

/// @brief A view of a gimbal command that is sent as power_and_gain() sends it: the same bytes, without the
/// 30-byte table in between. Take it where stack and time are short.
/// @tparam Command any type with `power[3]` and `p_gain[3]` of 0..255, roll, pitch, yaw. It must outlive the
/// view.
///
/// @snippet sbgc_examples.cpp power and gain
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <class Command>
class PowerAndGain {
  static_assert(thermopower::detail::SbgcHasPowerAndGain<Command>::value,
                "thermopower: PowerAndGain needs a command with power[3] and p_gain[3]");

public:
  /// @param gimbal the command
  explicit PowerAndGain(const Command& gimbal) noexcept : gimbal_(gimbal) {}

  /// @brief SET_ADJ_VARS_VAL.
  static constexpr uint8_t id() noexcept { return command::set_adj_vars_val; }
  /// @brief Six variables of five bytes, and their number.
  static constexpr uint8_t payload_size() noexcept { return 31; }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(6);
    for (uint8_t index = 0; index < 6; ++index) {
      const bool is_power = index < 3;
      const uint8_t axis = static_cast<uint8_t>(is_power ? index : index - 3);
      sink.put(static_cast<uint8_t>((is_power ? variable::power_roll : variable::p_roll) + axis));
      sink.put(is_power ? gimbal_.power[axis] : gimbal_.p_gain[axis]);
      for (uint8_t high = 0; high < 3; ++high) sink.put(0);
    }
  }

private:
  const Command& gimbal_;
};

}  // namespace sbgc
}  // namespace thermopower
