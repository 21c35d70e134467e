// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/probe.hpp"
#include "../surroundings.hpp"

/// @file actuator/detail/composition.hpp
/// Asks whether a type can play a part in an actuator's model.

namespace thermopower {
namespace detail {

/// A current law: `Scalar`, `current_A(v_rms_V, motor_C) const`, `validate() const`.
template <class Candidate, class = int>
struct IsCurrentLaw {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCurrentLaw<Candidate, typename Exists<typename Candidate::Scalar,
                                               decltype(probe<const Candidate>().current_A(
                                                   probe<const typename Candidate::Scalar>(),
                                                   probe<const typename Candidate::Scalar>())),
                                               decltype(probe<const Candidate>().validate())>::Type> {
  static constexpr bool value = true;
};

/// A heating law: `Scalar`, `is_linear()`, `is_heat_capacity()`, `rise_K_per_J(v_rms_V, motor_C) const`.
template <class Candidate, class = int>
struct IsHeatingLaw {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsHeatingLaw<Candidate,
                    typename Exists<decltype(Candidate::is_linear()), decltype(Candidate::is_heat_capacity()),
                                    decltype(probe<const Candidate>().rise_K_per_J(
                                        probe<const typename Candidate::Scalar>(),
                                        probe<const typename Candidate::Scalar>()))>::Type> {
  static constexpr bool value = true;
};

/// A cooling law: `Scalar`, `is_linear()`, `is_in_watts()`, `rate_K_per_s(motor_C, around, rise_K_per_J) const`.
template <class Candidate, class = int>
struct IsCoolingLaw {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCoolingLaw<Candidate,
                    typename Exists<decltype(Candidate::is_linear()), decltype(Candidate::is_in_watts()),
                                    decltype(probe<const Candidate>().rate_K_per_s(
                                        probe<const typename Candidate::Scalar>(),
                                        probe<const Surroundings<typename Candidate::Scalar> >(),
                                        probe<const typename Candidate::Scalar>()))>::Type> {
  static constexpr bool value = true;
};

/// How a time step is made: `needs_linear_laws()`.
template <class Candidate, class = int>
struct IsThermalStep {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsThermalStep<Candidate, typename Exists<decltype(Candidate::needs_linear_laws())>::Type> {
  static constexpr bool value = true;
};

/// A source of a current table: four constexpr functions of a voltage, or of none.
template <class Candidate, class = int>
struct IsCurrentSource {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCurrentSource<
    Candidate,
    typename Exists<decltype(Candidate::intercept_A(1.0)), decltype(Candidate::slope_A_per_K(1.0)),
                    decltype(Candidate::minimum_V_rms()), decltype(Candidate::maximum_V_rms())>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail
}  // namespace thermopower
