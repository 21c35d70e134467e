// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <stdint.h>

#include "../detail/probe.hpp"

/// @file
/// @brief Poller: when to ask a board, and when to stop waiting for its answer.

namespace thermopower {
namespace detail {

/// The pace of a conversation: `request_interval_us()` and `answer_timeout_us()`.
template <class Candidate, class = int>
struct SbgcIsPolling {
  static constexpr bool value = false;
};
template <class Candidate>
struct SbgcIsPolling<Candidate, typename Exists<decltype(Candidate::request_interval_us()),
                                                decltype(Candidate::answer_timeout_us())>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

namespace sbgc {

/// @brief The pace of the thesis's program, with a time-out. A set of your own has the same functions.
///
/// @snippet sbgc_examples.cpp poller
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
struct StandardPolling {
  /// @brief From one request to the next, at least. A board answers within 24 ms, its 8 ms between commands
  /// included.
  static constexpr uint32_t request_interval_us() { return 10000; }
  /// @brief An answer that takes longer is not waited for.
  static constexpr uint32_t answer_timeout_us() { return 50000; }
};

/// @brief What is to be done now.
/// @ingroup sbgc
enum class Turn : uint8_t {
  wait,    ///< nothing: an answer is awaited, or it is too early
  ask,     ///< send the request now; from here on its answer is awaited
  missed,  ///< said once when the answer has not come in time
};

/// @brief Keeps a conversation in step: one request at a time, and none before its answer or the time-out.
///
///     switch (poller.turn(now_us)) {
///       case sbgc::Turn::ask: codec.send(sbgc::Request(sbgc::command::realtime_data_4), wire); break;
///       case sbgc::Turn::missed: ...  // no answer came
///       case sbgc::Turn::wait: break;
///     }
///
/// A request whose time is up is asked again. Should answers come late after all, no further request is made
/// until every one of them is there, or none has come for the length of a time-out: answers that come late
/// cost time and never set the pace.
///
/// It knows no wire and no clock. All times are differences, so a clock that wraps at 2^32 (71.6 minutes)
/// does no harm.
/// @tparam Constants StandardPolling, or your own
///
/// @snippet sbgc_examples.cpp poller
/// How to: @ref wire_up_sbgc.
/// @ingroup sbgc
template <class Constants>
class BasicPoller {
  static_assert(
      thermopower::detail::SbgcIsPolling<Constants>::value,
      "thermopower: the parameter of BasicPoller must be its constants, such as sbgc::StandardPolling: a type with constexpr request_interval_us() and answer_timeout_us()");

public:
  /// @brief What is to be done. Call it in every round of the loop.
  /// @param now_us a clock that may wrap around at 2^32, such as Arduino's micros().
  Turn turn(uint32_t now_us) noexcept {
    if (is_answer_new_) mark_us_ = now_us;
    is_answer_new_ = false;
    const uint32_t waited_us = now_us - mark_us_;
    if (is_waiting_) {
      if (waited_us <= Constants::answer_timeout_us()) return Turn::wait;
      is_waiting_ = false;
      if (!is_draining_) return Turn::missed;
      is_draining_ = false;
      outstanding_ = 0;
    }
    if (waited_us <= Constants::request_interval_us()) return Turn::wait;
    mark_us_ = now_us;
    is_waiting_ = true;
    if (outstanding_ < 255) ++outstanding_;
    return Turn::ask;
  }

  /// @brief An answer has come.
  void answered() noexcept {
    if (outstanding_ > 0) --outstanding_;
    // Answers to requests that were given up may follow: they are waited for, as long as one comes.
    is_draining_ = is_waiting_ = is_answer_new_ = outstanding_ > 0;
  }

  /// @brief Is an answer awaited?
  bool is_waiting() const noexcept { return is_waiting_; }

private:
  static_assert(Constants::request_interval_us() < 0x80000000u &&
                    Constants::answer_timeout_us() < 0x80000000u,
                "thermopower: a Poller's times must be below 2^31 microseconds");

  uint32_t mark_us_ = 0;     // of the last request, or of the last answer while draining
  uint8_t outstanding_ = 0;  // requests without an answer so far; stops at 255
  bool is_waiting_ = false;
  bool is_draining_ = false;    // answers to requests that were given up are coming
  bool is_answer_new_ = false;  // one has come since the last turn
};

/// @brief The poller with the standard pace.
/// @ingroup sbgc
typedef BasicPoller<StandardPolling> Poller;

}  // namespace sbgc
}  // namespace thermopower
