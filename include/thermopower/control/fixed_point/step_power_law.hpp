// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/units.hpp"
#include "../limit_reason.hpp"
#include "detail/composition.hpp"

/// @file control/fixed_point/step_power_law.hpp
/// How much power a position error is worth, eq 4.22, from the controller's own angle units: no conversion to
/// degrees.
///
/// | law | power | the same in `thermopower` |
/// |---|---|---|
/// | `ProgrammedLevels` | ten levels, 25 .. 250 | `StepPowerLaw<ProgrammedLevels>` |
/// | `HysteresisLevels` | ten levels that noise does not toggle | `StepPowerLaw<HysteresisLevels>` |
///
/// A law of your own has `uint8_t step(uint16_t error_units)`.

namespace thermopower {
namespace fixed_point {

/// The constants of the program: 1 degree is worth full power, levels of 25, a quarter of a level of
/// hysteresis. A set of your own has the same functions.
///
/// @snippet fixed_point_examples.cpp fixed-point constants
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct ThesisLevels {
  /// Error worth full power, 0.5 .. 180 degrees.
  static constexpr double full_power_error_deg() { return 1.0; }
  static constexpr uint8_t power_step() { return 25; }        ///< Power of one level, 1 .. 25.
  static constexpr double hysteresis_deg() { return 0.025; }  ///< Read by `HysteresisLevels` only. >= 0.
};

namespace detail {

/// Level of an error: floor(10 error / full error), at most 10.
template <class Constants>
uint8_t level_of_error(uint16_t error_units) noexcept {
  static_assert(Constants::full_power_error_deg() >= 0.5 && Constants::full_power_error_deg() <= 180.0,
                "thermopower: full_power_error_deg must be within 0.5 .. 180 degrees");
  static_assert(Constants::power_step() >= 1 && Constants::power_step() <= 25,
                "thermopower: power_step must be within 1 .. 25");
  // Level 10 begins at the first whole unit that is not below the full error.
  constexpr uint16_t full_units =
      static_cast<uint16_t>(Constants::full_power_error_deg() * (16384.0 / 360.0) + 0.999);
  constexpr double levels_per_unit = 10.0 * 360.0 / 16384.0 / Constants::full_power_error_deg();
  if (error_units >= full_units) return 10;
  // A small error fits a byte, and its product 16 bits.
  return full_units <= 255
             ? static_cast<uint8_t>(
                   static_cast<uint16_t>(static_cast<uint8_t>(error_units) *
                                         static_cast<uint16_t>(nearest(levels_per_unit * 1024.0))) >>
                   10)
             : static_cast<uint8_t>((static_cast<uint32_t>(error_units) *
                                     static_cast<uint16_t>(nearest(levels_per_unit * 65536.0))) >>
                                    16);
}

}  // namespace detail

/// Ten levels, never none: level = 1 to 10, power = 25 level (program lines 192 to 195).
///
/// With one degree for full power the levels change at exactly the same unit as the law's; with another full
/// error at most one unit (0.022 degree) beside it.
/// @tparam Constants  ThesisLevels, or your own
///
/// @snippet fixed_point_examples.cpp fixed-point parts
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Constants = ThesisLevels>
struct ProgrammedLevels {
  static_assert(
      detail::IsLevels<Constants>::value,
      "thermopower: the parameter of fixed_point::ProgrammedLevels must be its constants, such as fixed_point::ThesisLevels: a type with constexpr full_power_error_deg() and power_step()");

  /// @param error_units  magnitude of the folded error in units of 360/16384 degree, 0 .. 8192
  /// @return power parameter
  uint8_t step(uint16_t error_units) noexcept {
    const uint8_t level = detail::level_of_error<Constants>(error_units);
    return static_cast<uint8_t>(Constants::power_step() * (level < 1 ? 1 : level));
  }
};

/// `ProgrammedLevels` that rise at a level's edge and fall only `hysteresis_deg()` below it.
/// @tparam Constants  ThesisLevels, or your own
///
/// @snippet fixed_point_examples.cpp fixed-point constants
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Constants = ThesisLevels>
class HysteresisLevels {
  static_assert(
      detail::IsLevels<Constants>::value && detail::IsHysteresis<Constants>::value,
      "thermopower: the parameter of fixed_point::HysteresisLevels must be its constants, such as fixed_point::ThesisLevels: a type with constexpr full_power_error_deg(), power_step() and hysteresis_deg()");

public:
  /// @copydoc ProgrammedLevels::step
  uint8_t step(uint16_t error_units) noexcept {
    constexpr uint16_t hysteresis_units =
        static_cast<uint16_t>(detail::nearest(Constants::hysteresis_deg() * (16384.0 / 360.0)));
    const uint8_t up = detail::level_of_error<Constants>(error_units);
    const uint8_t down =
        detail::level_of_error<Constants>(static_cast<uint16_t>(error_units + hysteresis_units));
    if (up > level_) level_ = up;
    if (down < level_) level_ = down < 1 ? uint8_t(1) : down;
    return static_cast<uint8_t>(Constants::power_step() * level_);
  }

private:
  uint8_t level_ = 1;
};

}  // namespace fixed_point
}  // namespace thermopower
