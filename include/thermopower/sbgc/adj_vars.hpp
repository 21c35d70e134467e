// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>
#include <string.h>

#include "frame.hpp"
#include "ids.hpp"
#include "writer.hpp"

/// @file
/// @brief Adjustable variables: SET_ADJ_VARS_VAL and GET_ADJ_VARS_VAL.

namespace thermopower {
namespace sbgc {

/// @brief One adjustable variable and its value.
///
/// @snippet sbgc_examples.cpp adjustable variables
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct AdjVar {
  uint8_t id;     ///< see variable::Id
  int32_t value;  ///< for the variables listed there 0..255

  /// @brief A variable whose value is a float: its four bytes are sent.
  static AdjVar of_float(uint8_t id, float value) noexcept {
    AdjVar var = {id, 0};
    memcpy(&var.value, &value, sizeof(value));
    return var;
  }
  /// @brief The value of a variable that is a float.
  float as_float() const noexcept {
    float number;
    memcpy(&number, &value, sizeof(number));
    return number;
  }
};

/// @brief Sets adjustable variables in the board's RAM; the board answers Confirm. Board to host: the answer
/// to GetAdjVars.
///
/// Fill `vars`. To read one from a frame, use AdjVarsView, which takes any number.
/// @tparam count number of variables, 1..50.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_SET_ADJ_VARS_VAL.
///
/// @snippet sbgc_examples.cpp adjustable variables
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <uint8_t count>
struct SetAdjVars {
  static_assert(count >= 1 && count <= 50, "thermopower: one SET_ADJ_VARS_VAL carries 1 to 50 variables");

  AdjVar vars[count];  ///< in the order they are sent

  /// @brief SET_ADJ_VARS_VAL.
  static constexpr uint8_t id() noexcept { return command::set_adj_vars_val; }
  /// @brief 1 + 5 bytes for each variable.
  static constexpr uint8_t payload_size() noexcept { return static_cast<uint8_t>(1 + 5 * count); }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(count);
    for (uint8_t i = 0; i < count; ++i) {
      sink.put(vars[i].id);
      put_i32(sink, vars[i].value);
    }
  }
};

/// @brief View of a SET_ADJ_VARS_VAL payload with any number of variables; valid as long as its frame.
///
/// @snippet sbgc_examples.cpp views of variables
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
class AdjVarsView {
public:
  /// @brief Looks at a frame's payload.
  /// @return false, with this object unchanged, unless the frame is SET_ADJ_VARS_VAL and as long as its
  /// number of variables says.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::set_adj_vars_val || frame.size < 1) return false;
    if (frame.size < 1 + 5 * static_cast<int16_t>(frame.payload[0])) return false;
    payload_ = frame.payload;
    return true;
  }

  /// @brief Number of variables, 0..50.
  uint8_t count() const noexcept { return payload_ == nullptr ? uint8_t(0) : payload_[0]; }
  /// @brief Variable at `index` below count(); past the end id 255, value 0.
  AdjVar operator[](uint8_t index) const noexcept {
    if (index >= count()) return AdjVar{255, 0};
    const uint8_t* at = payload_ + 1 + 5 * static_cast<int16_t>(index);
    return AdjVar{at[0], read_i32(at + 1)};
  }
  /// @brief Value of the variable `id`, the last one if it occurs repeatedly, as the board would have it.
  /// @return false, with `value` unchanged, when it does not occur.
  bool find(uint8_t id, int32_t& value) const noexcept {
    for (uint8_t i = count(); i > 0; --i) {
      const AdjVar var = (*this)[static_cast<uint8_t>(i - 1)];
      if (var.id != id) continue;
      value = var.value;
      return true;
    }
    return false;
  }

private:
  const uint8_t* payload_ = nullptr;
};

/// @brief Asks for adjustable variables; the board answers with SET_ADJ_VARS_VAL.
/// @tparam count number of variables, 1..50.
/// Source: SimpleBGC serial protocol specification 2.5, CMD_GET_ADJ_VARS_VAL.
///
/// @snippet sbgc_examples.cpp adjustable variables
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <uint8_t count>
struct GetAdjVars {
  static_assert(count >= 1 && count <= 50, "thermopower: one GET_ADJ_VARS_VAL asks for 1 to 50 variables");

  uint8_t ids[count];  ///< see variable::Id

  /// @brief GET_ADJ_VARS_VAL.
  static constexpr uint8_t id() noexcept { return command::get_adj_vars_val; }
  /// @brief 1 + 1 byte for each variable.
  static constexpr uint8_t payload_size() noexcept { return static_cast<uint8_t>(1 + count); }
  /// @brief Writes the payload.
  template <class Sink>
  void write_payload(Sink& sink) const {
    sink.put(count);
    put_bytes(sink, ids, count);
  }
};

/// @brief View of a GET_ADJ_VARS_VAL payload: the ids asked for; valid as long as its frame.
///
/// @snippet sbgc_examples.cpp views of variables
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct GetAdjVarsView {
  Bytes ids = {nullptr, 0};  ///< see variable::Id

  /// @brief Looks at a frame's payload.
  /// @return false, with this object unchanged, unless the frame is GET_ADJ_VARS_VAL and as long as it says.
  bool read(const Frame& frame) noexcept {
    if (frame.id != command::get_adj_vars_val || frame.size < 1) return false;
    if (frame.size < 1 + static_cast<int16_t>(frame.payload[0])) return false;
    ids = Bytes{frame.payload + 1, frame.payload[0]};
    return true;
  }
};

/// @brief Asks for POWER of roll, pitch and yaw: a CONFIRM says that the board took a command, and this that it has it. Send it after
/// every command to a board whose telemetry reports no POWER; `hear_power()` takes the answer.
/// @ingroup sbgc
inline GetAdjVars<3> ask_power() noexcept {
  return GetAdjVars<3>{{variable::power_roll, variable::power_pitch, variable::power_yaw}};
}

/// @brief The message that carries a gimbal command to the board: POWER roll, pitch, yaw, then P roll, pitch,
/// yaw.
/// @param gimbal any object with `power[3]` and `p_gain[3]` of 0..255, roll, pitch, yaw, such as the command
/// a gimbal controller gives.
/// @ingroup sbgc
template <class Command>
SetAdjVars<6> power_and_gain(const Command& gimbal) noexcept {
  static_assert(thermopower::detail::SbgcHasPowerAndGain<Command>::value,
                "thermopower: power_and_gain() needs a command with power[3] and p_gain[3]");
  SetAdjVars<6> message;
  for (uint8_t axis = 0; axis < 3; ++axis) {
    message.vars[axis] =
        AdjVar{static_cast<uint8_t>(variable::power_roll + axis), static_cast<uint8_t>(gimbal.power[axis])};
    message.vars[axis + 3] =
        AdjVar{static_cast<uint8_t>(variable::p_roll + axis), static_cast<uint8_t>(gimbal.p_gain[axis])};
  }
  return message;
}

}  // namespace sbgc
}  // namespace thermopower
