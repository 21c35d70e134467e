// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../actuator/current_model.hpp"
#include "../actuator/thermal_model.hpp"
#include "../actuator/thesis_current.hpp"
#include "../supply_range.hpp"

/// @file bgm2606_90t.hpp
/// iPower BGM2606-90T gimbal motor (roll and pitch axes of the thesis), on a printed PLA bracket, in still
/// laboratory air.

namespace thermopower {
namespace motors {

/// The motor with the corrected laws: the printed tables fitted again, without rounding the coefficients. Use
/// this one. Valid for V_rms 5.8 .. 12.9 V, motor 25 .. 75 degC (Table 4.1); cooling from Table 4.3.
///
/// As a motor type for `AxisController` it names its models (`Current`, `Thermal`) and gives their constants.
///
/// @snippet actuator_examples.cpp motors
/// How to: @ref custom_motor, @ref first_axis.
/// @ingroup motors
struct Bgm2606_90t {
  typedef CurrentModel<ThesisCurrent<float>> Current;                                      ///< Current law.
  typedef ThermalModel<ThesisHeating<float>, RateCooling<float>, LinearizedStep> Thermal;  ///< Thermal model.

  /// Eq 4.2 and 4.3 as the regression of Table 4.1 gives them (the text prints the first sign wrong).
  template <class Number = float>
  static constexpr ThesisCurrent<Number> current_law() noexcept {
    return ThesisCurrent<Number>::from_milliampere(Number(-0.013445), Number(0.015576), Number(0.016839),
                                                   Number(0.155098), Number(3.459071), Number(1));
  }
  /// Eq 4.16 and 4.17 as the regression of Table 4.9 gives them (the printed slope -0.0002 has one digit; the
  /// rounding costs 1.4 to 4.1 K after three minutes of heating).
  /// Not below 2 J/K, a quarter of the least that was measured: the law holds in the cold, too.
  template <class Number = float>
  static constexpr ThesisHeating<Number> heating_law() noexcept {
    return ThesisHeating<Number>::per_minute(Number(-0.00024249), Number(0.00620096), Number(0.02545869),
                                             Number(-0.10495822), Number(1), Number(2));
  }
  /// k = 0.11 per minute, eq 4.9 (which prints it per second).
  template <class Number = float>
  static constexpr RateCooling<Number> cooling_law() noexcept {
    return RateCooling<Number>::per_minute(Number(0.11));
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

  /// The motor as the thesis's program computes it: rounded constants, eq 4.21 (Euler). For reproducing the
  /// original.
  struct AsProgrammed {
    typedef CurrentModel<ThesisCurrent<float>> Current;                                 ///< Current law.
    typedef ThermalModel<ThesisHeating<float>, RateCooling<float>, EulerStep> Thermal;  ///< Thermal model.

    /// Program lines 32 to 36.
    template <class Number = float>
    static constexpr ThesisCurrent<Number> current_law() noexcept {
      return ThesisCurrent<Number>::from_milliampere(Number(-0.0134), Number(0.0156), Number(0.0167),
                                                     Number(0.1551), Number(3.4591), Number(1));
    }
    /// Program lines 38 to 41.
    template <class Number = float>
    static constexpr ThesisHeating<Number> heating_law() noexcept {
      return ThesisHeating<Number>::per_minute(Number(-0.0002), Number(0.0062), Number(0.0255),
                                               Number(-0.105), Number(1));
    }
    /// Program line 30.
    template <class Number = float>
    static constexpr RateCooling<Number> cooling_law() noexcept {
      return RateCooling<Number>::per_minute(Number(0.11));
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

  /// The motor as the text prints it. Its current law has the wrong sign in eq 4.2 and is here to be
  /// compared, not to be used.
  struct AsPrinted : AsProgrammed {
    /// Eq 4.2 and 4.3, sign as printed.
    template <class Number = float>
    static constexpr ThesisCurrent<Number> current_law() noexcept {
      return ThesisCurrent<Number>::from_milliampere(Number(0.0134), Number(0.0156), Number(0.0167),
                                                     Number(0.1551), Number(3.4591), Number(1));
    }
    /// Constants for `Current`.
    static Current::Config current() noexcept { return current_law<float>(); }
  };
};

}  // namespace motors
}  // namespace thermopower
