// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/probe.hpp"

/// @file while_off.hpp
/// What happens to the actuators while their controller has no power. Nobody but you knows, and a wrong answer starts them
/// tens of kelvins too cold: it has to be given, and a program without it does not compile.

namespace thermopower {

/// One switch for controller and actuators: nothing is heated while the controller has no power.
///
/// @snippet actuator_examples.cpp hottest journal
/// How to: @ref explain_observer.
struct OffTogether {
  /// No bound is needed.
  static constexpr int16_t settled_C() { return -60; }
};

/// The actuators may be driven on: their board has a supply of its own and keeps its last command.
/// @tparam settled  degC; where the largest power that the board can hold settles in the warmest air, 0 .. 194
///
/// @snippet actuator_examples.cpp hottest journal
/// How to: @ref explain_observer.
template <int16_t settled>
struct DrivenOn {
  static_assert(settled >= 0 && settled <= 194,
                "thermopower: DrivenOn needs a temperature within 0 .. 194 degC");
  /// No actuator is hotter after any time.
  static constexpr int16_t settled_C() { return settled; }
};

/// The same answer for StartFacts, at run time. It has no value of its own: facts without it do not compile.
struct DrivenWhileOff {
  /// @param is_driven  the actuator may go on being driven while this controller is off
  constexpr DrivenWhileOff(bool is_driven) noexcept : is_driven_(is_driven) {}
  constexpr operator bool() const noexcept { return is_driven_; }  ///< May it?

private:
  bool is_driven_;
};

namespace detail {

/// An answer to what happens while the controller has no power.
template <class Candidate, class = int>
struct IsWhileOff {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsWhileOff<Candidate, typename Exists<decltype(Candidate::settled_C() + 0)>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail
}  // namespace thermopower
