// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

/// @file control/detail/composition.hpp
/// Asks whether a type can play a part in a controller, so that a wrong composition is refused in a sentence
/// and not in a page.

namespace thermopower {
namespace detail {

/// A motor type names its two models.
template <class Candidate>
struct IsMotor {
  template <class Type>
  static char test(typename Type::Current*, typename Type::Thermal*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Candidate>(nullptr, nullptr)) == 1;
};

/// A power law turns an error into a power.
template <class Candidate>
struct IsPowerLaw {
  template <class Type>
  static char test(typename Type::Config*, decltype(static_cast<Type*>(nullptr)->step(0.0f))*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Candidate>(nullptr, nullptr)) == 1;
};

/// A limiter takes inputs with a demand and can be cut.
template <class Candidate>
struct IsLimiter {
  template <class Type>
  static char test(typename Type::Inputs*, decltype(static_cast<Type*>(nullptr)->ceiling())*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Candidate>(nullptr, nullptr)) == 1;
};

/// A gain rule turns a power into a gain and remembers nothing.
template <class Candidate>
struct IsGain {
  template <class Type>
  static char test(typename Type::Config*, decltype(static_cast<const Type*>(nullptr)->step(uint8_t(1)))*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Candidate>(nullptr, nullptr)) == 1;
};

/// A controller of one axis takes inputs with a fault and says what it decided.
template <class Candidate>
struct IsAxis {
  template <class Type>
  static char test(typename Type::Config*, decltype(static_cast<typename Type::Inputs*>(nullptr)->fault)*,
                   decltype(static_cast<typename Type::State*>(nullptr)->p_gain)*);
  template <class Type>
  static long test(...);
  static constexpr bool value = sizeof(test<Candidate>(nullptr, nullptr, nullptr)) == 1;
};

}  // namespace detail
}  // namespace thermopower
