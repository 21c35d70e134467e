// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/constexpr_math.hpp"
#include "../../detail/probe.hpp"

/// @file actuator/fixed_point/motor.hpp
/// Motors as the fixed-point models take them: constants as types, so that the compiler makes tables of them
/// and an object holds nothing but its state.
///
/// | motor | what it is | when to take it |
/// |---|---|---|
/// | `ThesisMotor<Motor, Supply>` | a motor of `motors/` with its laws | the thesis motors, in any form |
/// | `OhmicMotor<Constants>` | a resistance on a heat capacity | everything else |
///
/// A source of your own has the functions of `ThesisMotor`, all `constexpr`. Its heat is (p1 T + p0) /
/// (c1 T + c0): a power that is linear in the temperature, over an apparent heat capacity that is. Both may
/// depend on the voltage in any way.
/// @ingroup actuator

namespace thermopower {
namespace fixed_point {
namespace detail {

/// A motor as the fixed-point models take it.
template <class Candidate, class = int>
struct IsMotor {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsMotor<Candidate,
               typename thermopower::detail::Exists<
                   decltype(Candidate::supply_V()), decltype(Candidate::power_W(1.0)),
                   decltype(Candidate::capacity_J_per_K(1.0)), decltype(Candidate::cooling_per_s())>::Type> {
  static constexpr bool value = true;
};

/// A motor with the thesis's laws.
template <class Candidate, class = int>
struct HasThesisLaws {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasThesisLaws<Candidate, typename thermopower::detail::Exists<
                                    decltype(Candidate::template current_law<double>()),
                                    decltype(Candidate::template heating_law<double>()),
                                    decltype(Candidate::template cooling_law<double>())>::Type> {
  static constexpr bool value = true;
};

/// A supply: `supply_V()`.
template <class Candidate, class = int>
struct IsSupply {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsSupply<Candidate, typename thermopower::detail::Exists<decltype(Candidate::supply_V())>::Type> {
  static constexpr bool value = true;
};

/// Constants of a winding on one heat capacity.
template <class Candidate, class = int>
struct IsOhmicConstants {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsOhmicConstants<
    Candidate,
    typename thermopower::detail::Exists<
        decltype(Candidate::supply_V()), decltype(Candidate::resistance_ohm()),
        decltype(Candidate::reference_C()), decltype(Candidate::tempco_per_K()),
        decltype(Candidate::heat_capacity_J_per_K()), decltype(Candidate::conductance_W_per_K())>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

/// The thesis's supply, 13 V. A supply of your own is such a struct.
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost. Menu: @ref policies.
/// @ingroup actuator
struct ThirteenVolts {
  static constexpr double supply_V() { return 13.0; }  ///< V, above 0.
};

/// A motor with the thesis's laws, for the fixed-point models.
/// @tparam Motor   has `constexpr` `current_law<double>()`, `heating_law<double>()`, `cooling_law<double>()`,
/// as the motors in `motors/`
/// @tparam Supply  has `static constexpr double supply_V()`
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost. Menu: @ref policies.
/// @ingroup actuator
template <class Motor, class Supply = ThirteenVolts>
struct ThesisMotor {
  static_assert(
      detail::HasThesisLaws<Motor>::value,
      "thermopower: the first parameter of fixed_point::ThesisMotor must be a motor with the thesis's laws, such as motors::Bgm2606_90t: a type with constexpr current_law<double>(), heating_law<double>() and cooling_law<double>()");
  static_assert(
      detail::IsSupply<Supply>::value,
      "thermopower: the second parameter of fixed_point::ThesisMotor must be a supply, such as fixed_point::ThirteenVolts: a type with constexpr supply_V()");

  /// Amplitude of the switched supply, V.
  static constexpr double supply_V() { return Supply::supply_V(); }
  /// At or below this voltage there is no heating, V.
  static constexpr double minimum_V_rms() {
    return Motor::template current_law<double>().minimum_V_rms >
                   Motor::template heating_law<double>().minimum_V_rms
               ? Motor::template current_law<double>().minimum_V_rms
               : Motor::template heating_law<double>().minimum_V_rms;
  }
  /// p0: V_rms I extrapolated to 0 degC, W.
  static constexpr double power_W(double v_rms_V) {
    return v_rms_V * Motor::template current_law<double>().base_A *
           thermopower::detail::constexpr_pow(v_rms_V, Motor::template current_law<double>().exponent);
  }
  /// p1: how V_rms I changes with temperature, W/K.
  static constexpr double power_slope_W_per_K(double v_rms_V) {
    return v_rms_V * Motor::template current_law<double>().slope_A_per_K(v_rms_V);
  }
  /// c0: apparent heat capacity at 0 degC, J/K.
  static constexpr double capacity_J_per_K(double v_rms_V) {
    return Motor::template heating_law<double>().offset_V1_J_per_K * v_rms_V +
           Motor::template heating_law<double>().offset_V0_J_per_K;
  }
  /// c1: how it changes with temperature, J/K^2.
  static constexpr double capacity_slope_J_per_K2(double v_rms_V) {
    return Motor::template heating_law<double>().slope_V1_J_per_K2 * v_rms_V +
           Motor::template heating_law<double>().slope_V0_J_per_K2;
  }
  /// The capacity is not taken below this, J/K; a source without this function has no such bound.
  static constexpr double least_capacity_J_per_K() {
    return Motor::template heating_law<double>().least_capacity_J_per_K;
  }
  /// k, 1/s.
  static constexpr double cooling_per_s() { return Motor::template cooling_law<double>().cooling_per_s; }
};

/// A winding whose resistance rises with temperature, on one heat capacity with one conductance to the air:
/// OhmicCurrent, HeatCapacityHeating and NewtonCooling.
/// @tparam Constants  `static constexpr double` functions `supply_V()`, `resistance_ohm()` at
/// `reference_C()`, `tempco_per_K()` (copper:
///                    0.00393), `heat_capacity_J_per_K()`, `conductance_W_per_K()`; all as in those laws
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost. Menu: @ref policies.
/// @ingroup actuator
template <class Constants>
struct OhmicMotor {
  static_assert(
      detail::IsOhmicConstants<Constants>::value,
      "thermopower: the parameter of fixed_point::OhmicMotor must be its constants: a type with constexpr supply_V(), resistance_ohm(), reference_C(), tempco_per_K(), heat_capacity_J_per_K() and conductance_W_per_K()");

  /// Amplitude of the switched supply, V.
  static constexpr double supply_V() { return Constants::supply_V(); }
  static constexpr double minimum_V_rms() { return 0.0; }  ///< Every voltage heats.
  /// p0: V^2 / R at the reference, W. What the warm winding draws less is in the denominator, c1.
  static constexpr double power_W(double v_rms_V) { return v_rms_V * v_rms_V / Constants::resistance_ohm(); }
  static constexpr double power_slope_W_per_K(double) { return 0.0; }  ///< p1, W/K.
  /// c0, J/K.
  static constexpr double capacity_J_per_K(double) {
    return Constants::heat_capacity_J_per_K() * (1.0 - Constants::tempco_per_K() * Constants::reference_C());
  }
  /// c1, J/K^2.
  static constexpr double capacity_slope_J_per_K2(double) {
    return Constants::heat_capacity_J_per_K() * Constants::tempco_per_K();
  }
  /// k, 1/s.
  static constexpr double cooling_per_s() {
    return Constants::conductance_W_per_K() / Constants::heat_capacity_J_per_K();
  }
};

}  // namespace fixed_point
}  // namespace thermopower
