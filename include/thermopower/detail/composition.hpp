// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once


/// @file composition.hpp
/// Asks whether a type can play a part in a controller, so that a wrong composition is refused in a sentence and not in a page.

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

}  // namespace detail
}  // namespace thermopower
