// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/duty.hpp>
#include <thermopower/actuator/ohmic_current.hpp>

/// @file gimbal_drive.hpp
/// From POWER to torque: a brushless motor that a gimbal board drives like a stepper.

namespace thermopower::simulation {

/// A brushless gimbal motor on a sine drive. POWER sets the amplitude of the field, whether torque is needed
/// or not; the board turns the field ahead of the rotor to get torque, up to the amplitude `Kt I`. So the
/// motor heats alike at rest and at work, which is what makes POWER worth controlling.
///
///     winding voltage  V_w = V_supply (V_rms / V_supply)^(2 n)      V_rms by eq 3.11
///     current          I = V_w / R(T_winding)
///     torque           at most Kt (1 + a_m (T_magnet - 25 degC)) I
///     supply           V_supply I_supply = I^2 R: all of it becomes heat
///
/// n = 1/2 would be eq 3.11 as it stands. The currents of Tables 4.1 and 4.2 rise faster: n = 0.93 and 0.95
/// fit them (a drive that scales the sine's amplitude would have n = 1). Counter-voltage is left out: at 100
/// deg/s it is a hundredth of the supply.
///
/// @snippet simulation_examples.cpp parts of an axis
/// How to: @ref rig.
template <class Number>
struct GimbalDrive {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  OhmicCurrent<Number> winding;  ///< R(T).
  Number exponent;               ///< n, 0.5 .. 1.
  Number torque_Nm_per_A;        ///< Kt at 25 degC, above 0.
  Number magnet_tempco_per_K;    ///< a_m, -0.005 .. 0: NdFeB -0.0012.

  /// What the drive does at one power.
  struct State {
    Number v_rms_V;       ///< Eq 3.11.
    Number load_S;        ///< Conductance seen by the supply: I_supply = V_supply load_S.
    Number heat_W;        ///< In the winding, and drawn from the supply.
    Number available_Nm;  ///< Amplitude of the torque.
  };

  /// Conductance that the drive puts across the supply: independent of the supply's voltage. @param
  /// power_param  0 .. 255
  Number load_at(const Number& power_param, const Number& winding_C) const noexcept {
    const Number share = amplitude(power_param);
    return share * share / winding.resistance_at(winding_C);
  }

  /// @param power_param  0 .. 255
  /// @param supply_V     at the board's terminals, >= 0
  State at(const Number& power_param, const Number& supply_V, const Number& winding_C,
           const Number& magnet_C) const noexcept {
    const Number share = amplitude(power_param);
    const Number current_A = winding.current_A(Number(supply_V * share), winding_C);
    State state;
    state.v_rms_V = v_rms_from_power<Number>(supply_V, power_param);
    state.load_S = share * share / winding.resistance_at(winding_C);
    state.heat_W = current_A * supply_V * share;
    state.available_Nm =
        torque_Nm_per_A * (Real(1) + magnet_tempco_per_K * (magnet_C - Real(25))) * current_A;
    return state;
  }

private:
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  // V_w / V_supply. Kept off 0, where a power through exponent and logarithm has no value.
  Number amplitude(const Number& power_param) const noexcept {
    const Number duty = duty_from_power<Number>(power_param);
    const Number driven = thermopower::detail::at_least(duty, Math::constant(Real(1e-9)));
    return Math::choose_if_greater(duty, Math::constant(Real(0)), Math::power(driven, exponent),
                                   Number(duty * Real(0)));
  }
};

}  // namespace thermopower::simulation
