// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "heating.hpp"

/// @file actuator/fixed_point/thermal_model.hpp
/// The temperature of an actuator with one node in whole numbers: eq 3.9 by eq 4.21.

namespace thermopower {
namespace fixed_point {

/// What a fixed-point thermal model remembers.
/// @ingroup actuator
struct ThermalState {
  Temperature motor;  ///< Temperature after the last step.
  Rate heating;       ///< r P of the power given to `prepare()`, at the temperature then.
};

namespace detail {

inline Temperature within_range(Temperature value) noexcept {
  constexpr Temperature coldest = temperature_of(coldest_C());
  constexpr Temperature hottest = temperature_of(hottest_C());
  // Whole degrees decide, so that an 8-bit chip compares half of the bytes.
  const int16_t upper = static_cast<int16_t>(value >> 16);
  return upper >= hottest >> 16 ? hottest : (upper < coldest >> 16 ? coldest : value);
}

}  // namespace detail

/// The part of ThermalModel that is the same for every motor, so that axes share its code.
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost.
/// @ingroup actuator
class ThermalCore {
public:
  typedef ThermalState State;  ///< What one logs.

  /// Sets the temperature; nothing heats until `prepare()`. @param motor  a temperature; saturates at -50 and
  /// 180 degC
  void start(Temperature motor) noexcept {
    state_.motor = detail::within_range(motor);
    state_.heating = 0;
  }

  /// Says that the actuator is warmer than was thought. @param difference  above 0
  void warm_by(Temperature difference) noexcept {
    state_.motor = detail::within_range(state_.motor + difference);
  }

  /// Prepares the heating for the next step. @param heating  ThermalModel::heating of the motor
  void heat(Rate heating) noexcept { state_.heating = heating; }

  /// Advances by eq 4.21 with the heating prepared.
  /// @param air             -60 .. 125 degC
  /// @param cooling_factor  ThermalModel::cooling_factor of the motor
  /// @return dT/dt at the start of the step, which eq 4.23 uses
  [[gnu::always_inline]] Rate step(CoarseTemperature air, Ticks ticks, uint16_t cooling_factor) noexcept {
    const int16_t above_air = static_cast<int16_t>(detail::rounded_celsius(state_.motor) - air);
    const Rate rate = state_.heating - detail::product(above_air, cooling_factor);
    state_.motor = detail::within_range(state_.motor + detail::scaled(rate, ticks));
    return rate;
  }

  const State& state() const noexcept { return state_; }               ///< After the last step.
  float motor_C() const noexcept { return celsius_of(state_.motor); }  ///< The temperature, for a log.

private:
  State state_ = {detail::temperature_of(detail::coldest_C()), 0};
};

/// One-node thermal model that takes 16-bit multiplications where thermopower::ThermalModel takes a floating-point
/// library: CurrentModel, heating law, cooling law and step in one. Take it on a chip without a
/// floating-point unit, when the supply is known and the motor's constants need not change at run time;
/// otherwise take thermopower::ThermalModel.
///
/// The heating depends on the power of the last command and on the temperature, and both are known long
/// before the next telemetry comes: `prepare()` computes it while the program would wait, and `step()` only
/// adds.
///
/// Error against thermopower::ThermalModel in double precision, for the thesis motors at 13 V: at most 0.1 K over an hour
/// in closed loop. The temperature is kept to 1.2e-7 K; heat is exchanged with the air at the temperature to
/// the nearest 2^-7 K. The temperature saturates at -50 and 180 degC. Never unstable: the largest k that fits
/// (0.029 per s) times the longest step (16.8 s) is below 1.
/// @tparam Source  the motor: motor.hpp
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost. Menu: @ref policies.
/// @ingroup actuator
template <class Source>
class ThermalModel : public ThermalCore {
  static_assert(
      detail::IsMotor<Source>::value,
      "thermopower: the parameter of fixed_point::ThermalModel must be a motor of constants: fixed_point::ThesisMotor<Motor> or fixed_point::OhmicMotor<Constants>");

public:
  typedef ThermalCore Core;  ///< What models of all motors share.
  /// The supply that the motor's table was made for, V.
  static constexpr double supply_V() { return Source::supply_V(); }
  /// k in 2^-32 per tick: what `Core::step()` needs to know of the motor.
  static constexpr uint16_t cooling_factor = static_cast<uint16_t>(detail::nearest(
      detail::lesser(Source::cooling_per_s() / detail::ticks_per_s() * 4294967296.0, 32767.0)));
  static_assert(cooling_factor >= 300 && cooling_factor < 32767,
                "thermopower: this motor cools too fast or too slowly for a fixed-point model (k within "
                "2.7e-4 .. 0.0298 per second); "
                "take ThermalModel");

  /// Computes the heating for the next step. @param power  power parameter that acts from now on
  void prepare(uint8_t power) noexcept { Core::heat(heating(power, Core::state().motor)); }
  /// The heating of this motor. @param power  power parameter  @param motor  temperature, -50 .. 180 degC
  static Rate heating(uint8_t power, Temperature motor) noexcept {
    return Heating<Source>::rate(power, detail::rounded_celsius(motor));
  }

  /// `Core::step()` of this motor. @param air  -60 .. 125 degC  @return dT/dt at the start of the step
  Rate step(CoarseTemperature air, Ticks ticks) noexcept { return Core::step(air, ticks, cooling_factor); }
};

}  // namespace fixed_point
}  // namespace thermopower
