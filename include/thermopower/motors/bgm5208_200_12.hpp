// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../actuator/current_model.hpp"
#include "../actuator/thermal_model.hpp"
#include "../actuator/thesis_current.hpp"
#include "../supply_range.hpp"

/// @file bgm5208_200_12.hpp
/// iPower BGM5208-200-12 gimbal motor (yaw axis of the thesis), on a printed PLA bracket, in still laboratory
/// air.

namespace thermopower {
namespace motors {

/// The motor with the corrected laws: the printed tables fitted again, and the heating coefficient of eq 4.18
/// a function of the voltage, as the text has it. Use this one. Valid for V_rms 5.8 .. 12.9 V, motor 25 .. 65
/// degC (Table 4.2); cooling from Table 4.6.
///
/// As a motor type for `AxisController` it names its models (`Current`, `Thermal`) and gives their constants.
///
/// @snippet actuator_examples.cpp motors
/// How to: @ref custom_motor, @ref first_axis.
/// @ingroup motors
struct Bgm5208_200_12 {
  typedef CurrentModel<ThesisCurrent<float>> Current;                                      ///< Current law.
  typedef ThermalModel<ThesisHeating<float>, RateCooling<float>, LinearizedStep> Thermal;  ///< Thermal model.

  /// Eq 4.4 and 4.5 as the regression of Table 4.2 gives them (the text prints the first sign wrong).
  template <class Number = float>
  static constexpr ThesisCurrent<Number> current_law() noexcept {
    return ThesisCurrent<Number>::from_milliampere(Number(-0.054978), Number(0.631148), Number(-2.497093),
                                                   Number(0.125709), Number(3.413451), Number(1));
  }
  /// Eq 4.18 as the text has it, 1/r = 0.2435 V_rms - 0.4952, unrounded (regression of Table 4.10).
  /// Not below 2 J/K, a quarter of the least that was measured: the law holds in the cold, too.
  template <class Number = float>
  static constexpr ThesisHeating<Number> heating_law() noexcept {
    return ThesisHeating<Number>::per_minute(Number(0), Number(0), Number(0.243455), Number(-0.495180),
                                             Number(1), Number(2));
  }
  /// k = 0.05 per minute, eq 4.11 (which prints it per second).
  template <class Number = float>
  static constexpr RateCooling<Number> cooling_law() noexcept {
    return RateCooling<Number>::per_minute(Number(0.05));
  }

  /// Constants for `Current`.
  static Current::Config current() noexcept { return current_law<float>(); }
  /// Three cells that are nearly empty to six that are full.
  static SupplyRange supply() noexcept {
    const SupplyRange range = {3.0f, 26.0f};
    return range;
  }
  /// Constants for `Thermal`.
  static Thermal::Config thermal() noexcept {
    Thermal::Config config = {heating_law<float>(), cooling_law<float>()};
    return config;
  }

  /// The motor as the thesis's program computes it: 0.2435 of eq 4.18 multiplies the temperature instead of
  /// the voltage, so the motor seems 3 to 5 times as heavy as it is and the estimate is 6 to 12 K too cold
  /// after five minutes (Table 5.2). For reproducing the original only.
  struct AsProgrammed {
    typedef CurrentModel<ThesisCurrent<float>> Current;                                 ///< Current law.
    typedef ThermalModel<ThesisHeating<float>, RateCooling<float>, EulerStep> Thermal;  ///< Thermal model.

    /// Program lines 32 to 36.
    template <class Number = float>
    static constexpr ThesisCurrent<Number> current_law() noexcept {
      return ThesisCurrent<Number>::from_milliampere(Number(-0.055), Number(0.6311), Number(-2.497),
                                                     Number(0.1257), Number(3.4135), Number(1));
    }
    /// Program lines 38 to 41: 0.2435 stands in the slope against temperature.
    template <class Number = float>
    static constexpr ThesisHeating<Number> heating_law() noexcept {
      return ThesisHeating<Number>::per_minute(Number(0), Number(0.2435), Number(0), Number(-0.4952),
                                               Number(1));
    }
    /// Program line 30.
    template <class Number = float>
    static constexpr RateCooling<Number> cooling_law() noexcept {
      return RateCooling<Number>::per_minute(Number(0.05));
    }

    /// Constants for `Current`.
    static Current::Config current() noexcept { return current_law<float>(); }
    /// Three cells that are nearly empty to six that are full.
    static SupplyRange supply() noexcept {
      const SupplyRange range = {3.0f, 26.0f};
      return range;
    }
    /// Constants for `Thermal`.
    static Thermal::Config thermal() noexcept {
      Thermal::Config config = {heating_law<float>(), cooling_law<float>()};
      return config;
    }
  };

  /// The motor as the text prints it: eq 4.4 with its wrong sign, eq 4.18 with the voltage. Here to be
  /// compared, not to be used.
  struct AsPrinted : AsProgrammed {
    /// Eq 4.4 and 4.5, sign as printed.
    template <class Number = float>
    static constexpr ThesisCurrent<Number> current_law() noexcept {
      return ThesisCurrent<Number>::from_milliampere(Number(0.055), Number(0.6311), Number(-2.497),
                                                     Number(0.1257), Number(3.4135), Number(1));
    }
    /// Eq 4.18 as printed.
    template <class Number = float>
    static constexpr ThesisHeating<Number> heating_law() noexcept {
      return ThesisHeating<Number>::per_minute(Number(0), Number(0), Number(0.2435), Number(-0.4952),
                                               Number(1));
    }
    /// Constants for `Current`.
    static Current::Config current() noexcept { return current_law<float>(); }
    /// Three cells that are nearly empty to six that are full.
    static SupplyRange supply() noexcept {
      const SupplyRange range = {3.0f, 26.0f};
      return range;
    }
    /// Constants for `Thermal`.
    static Thermal::Config thermal() noexcept {
      Thermal::Config config = {heating_law<float>(), RateCooling<float>::per_minute(0.05f)};
      return config;
    }
  };
};

}  // namespace motors
}  // namespace thermopower
