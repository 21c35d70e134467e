// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/numeric.hpp"
#include "detail/probe.hpp"

/// @file step_time.hpp
/// How short a step of the loop can be at all.

namespace thermopower {

/// What a motor's `step_time()` declares of the loop that drives it. Nothing in the firmware has a clock of its own, so a time in a
/// wrong unit is believed where nobody says what is possible: milliseconds told as hundredths of a second hide nine tenths of the heat.
///
/// @snippet control_examples.cpp step time
/// How to: @ref first_axis, @ref faults_and_reasons.
/// @ingroup actuator
struct StepTime {
  /// No step is shorter, s; above 0. A time above 0 that is told shorter is a fault. Half of the loop's usual period finds a
  /// time that is told at less than half.
  float shortest_s;
};

namespace detail {

/// A time that can be, or NaN. Time that stands still is another matter: StandingTime.
template <class Motor, class = int>
struct PossibleTime {
  static float of(float dt_s) noexcept { return dt_s; }
};
template <class Motor>
struct PossibleTime<Motor, typename Exists<decltype(Motor::step_time().shortest_s)>::Type> {
  static float of(float dt_s) noexcept {
    return dt_s == 0.0f || dt_s >= Motor::step_time().shortest_s ? dt_s : not_a_number();
  }
};

}  // namespace detail
}  // namespace thermopower
