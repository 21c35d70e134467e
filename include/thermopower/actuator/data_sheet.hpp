// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file data_sheet.hpp
/// From the numbers of a motor's data sheet to constants with bounds.

namespace thermopower {

/// A constant and its bounds.
///
/// @snippet actuator_examples.cpp data sheet
/// How to: @ref custom_motor.
/// @ingroup actuator
struct ConstantRange {
  double lowest;   ///< It is never below this.
  double nominal;  ///< What a model takes.
  double highest;  ///< It is never above this.

  /// A nominal value with factors to both sides. @param below, above  such as 0.9 and 1.1
  static constexpr ConstantRange of(double nominal, double below, double above) {
    return ConstantRange{nominal * below, nominal, nominal * above};
  }
  /// Farthest bound as a fraction of the nominal value.
  constexpr double error() const {
    return highest - nominal > nominal - lowest ? (highest - nominal) / nominal
                                                : (nominal - lowest) / nominal;
  }
};

/// What a data sheet says of a motor, at 25 degC; 0 for what it does not say. Everything follows at compile time.
///
/// Three groups of numbers are needed, and `is_enough()` says whether they are there:
///
/// | group | from |
/// |---|---|
/// | resistance | `resistance_ohm`, or `stall_Nm` with `nominal_V` and `torque_constant_Nm_per_A` |
/// | thermal resistance | `winding_K_per_W` and `housing_K_per_W`, or `continuous_A` |
/// | heat capacity | `motor_s`, and `winding_s` if it is known |
///
/// So a continuous current, a resistance and a time constant are enough. What is guessed gets wider bounds.
///
/// @snippet actuator_examples.cpp data sheet
/// How to: @ref custom_motor.
/// @ingroup actuator
struct MotorDataSheet {
  double resistance_ohm;            ///< Between the terminals, at 25 degC.
  double torque_constant_Nm_per_A;  ///< k_t.
  double stall_Nm;                  ///< Stall torque, cold, at the nominal voltage.
  double nominal_V;                 ///< Nominal voltage.
  double continuous_A;  ///< Largest continuous current, winding at its highest temperature, air at 25 degC.
  double highest_winding_C;  ///< Highest temperature of the winding; 0: 125 degC.
  double winding_K_per_W;    ///< Thermal resistance from the winding to the housing.
  double
      housing_K_per_W;  ///< Thermal resistance from the housing to the air, as the sheet has it: hung freely.
  double winding_s;     ///< Thermal time constant of the winding.
  double motor_s;       ///< Thermal time constant of the motor.

  /// True when every group is there.
  constexpr bool is_enough() const { return has_resistance() && has_thermal_resistance() && motor_s > 0.0; }

  /// Resistance at 25 degC, ohm: 10 % as catalogues promise; 15 % where it follows from the stall torque.
  constexpr ConstantRange resistance() const {
    return resistance_ohm > 0.0
               ? ConstantRange::of(resistance_ohm, 0.9, 1.1)
               : ConstantRange::of(nominal_V * torque_constant_Nm_per_A / stall_Nm, 0.85, 1.15);
  }
  /// Conductance from the winding to the housing, W/K: 20 %; from the continuous current alone within a factor of three.
  constexpr ConstantRange coupling() const {
    return winding_K_per_W > 0.0 ? ConstantRange::of(1.0 / winding_K_per_W, 0.8, 1.25)
                                 : ConstantRange::of(1.0 / (guessed_share() * total_K_per_W()), 0.4, 3.0);
  }
  /// Conductance from the housing to the air, W/K: a mount takes heat away, up to as much again; a box keeps a quarter in.
  constexpr ConstantRange conductance() const {
    return housing_K_per_W > 0.0
               ? ConstantRange::of(1.0 / housing_K_per_W, 0.75, 2.0)
               : ConstantRange::of(1.0 / ((1.0 - guessed_share()) * total_K_per_W()), 0.6, 3.0);
  }
  /// Heat capacity of the winding, J/K: time constant times conductance, and 10 % for the time constant; without it a tenth
  /// of the body's, within a factor of four.
  constexpr ConstantRange winding_heat_capacity() const {
    return winding_s > 0.0
               ? ConstantRange{winding_s * coupling().lowest * 0.9, winding_s * coupling().nominal,
                               winding_s * coupling().highest * 1.1}
               : ConstantRange::of(0.1 * body_heat_capacity().nominal, 0.25, 4.0);
  }
  /// Heat capacity of the body, J/K: the motor's time constant times the conductance of its housing as it was rated, 30 %;
  /// from the continuous current alone within a factor of two.
  constexpr ConstantRange body_heat_capacity() const {
    return housing_K_per_W > 0.0 ? ConstantRange::of(motor_s * conductance().nominal, 0.7, 1.4)
                                 : ConstantRange::of(motor_s * conductance().nominal, 0.5, 2.0);
  }
  /// Largest current that is safe for ever in air of a temperature, with every constant at its worst, A squared.
  /// @param air_C  below the winding's highest temperature
  constexpr double safe_square_A2(double air_C) const {
    return (hottest_C() - air_C) /
           ((1.0 / coupling().lowest + 1.0 / conductance().lowest) * resistance().highest * hot_ratio());
  }
  /// Thermal resistance from the winding to the air, K/W: of the sheet, or what the continuous current allows.
  constexpr double total_K_per_W() const {
    return winding_K_per_W > 0.0 && housing_K_per_W > 0.0
               ? winding_K_per_W + housing_K_per_W
               : (hottest_C() - 25.0) / (continuous_A * continuous_A * resistance().nominal * hot_ratio());
  }
  /// How far the sheet disagrees with itself: the thermal resistance of the continuous current over the one it states, less 1;
  /// 0 where only one of them is stated. Beyond a third, ask what the continuous current was rated for.
  constexpr double disagreement() const {
    return continuous_A > 0.0 && winding_K_per_W > 0.0 && housing_K_per_W > 0.0
               ? (hottest_C() - 25.0) / (continuous_A * continuous_A * resistance().nominal * hot_ratio()) /
                         (winding_K_per_W + housing_K_per_W) -
                     1.0
               : 0.0;
  }
  /// The temperature of the winding that counts as its highest, degC.
  constexpr double hottest_C() const { return highest_winding_C > 0.0 ? highest_winding_C : 125.0; }

private:
  constexpr bool has_resistance() const {
    return resistance_ohm > 0.0 || (stall_Nm > 0.0 && nominal_V > 0.0 && torque_constant_Nm_per_A > 0.0);
  }
  constexpr bool has_thermal_resistance() const {
    return (winding_K_per_W > 0.0 && housing_K_per_W > 0.0) || continuous_A > 0.0;
  }
  // Of copper.
  constexpr double hot_ratio() const { return 1.0 + 0.00393 * (hottest_C() - 25.0); }
  // Winding to housing takes a quarter of the whole: between a tenth and a half in catalogues of small motors.
  static constexpr double guessed_share() { return 0.25; }
};

}  // namespace thermopower
