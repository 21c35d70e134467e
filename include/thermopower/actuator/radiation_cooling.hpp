// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "surroundings.hpp"

/// @file radiation_cooling.hpp
/// Heat radiated to the surroundings. Menu: cooling.hpp.

namespace thermopower {

/// Radiation to surroundings at air temperature (Stefan-Boltzmann), temperatures in kelvin.
/// \f[
/// \mathrm{loss} = \sigma A \varepsilon \, (T^4 - T_\mathrm{air}^4)
/// \f]
///
/// @snippet actuator_examples.cpp cooling
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct RadiationCooling {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number radiating_area_m2;  ///< A, above 0.
  Number emissivity;         ///< eps, 0 .. 1.

  static constexpr bool is_linear() { return false; }   ///< Grows with the fourth power.
  static constexpr bool is_in_watts() { return true; }  ///< Needs a heat capacity to become a rate.
  /// Loss, W.
  Number loss_W(const Number& motor_C, const Surroundings<Number>& around) const noexcept {
    const Number surface = squared_kelvin(motor_C), air = squared_kelvin(around.air_C);
    return strength() * (surface - air) * (surface + air);
  }
  /// Cooling rate, K/s.
  Number rate_K_per_s(const Number& motor_C, const Surroundings<Number>& around,
                      const Number& rise_K_per_J) const noexcept {
    return rise_K_per_J * loss_W(motor_C, around);
  }
  /// d rate / dT, 1/s.
  Number slope_per_s(const Number& motor_C, const Surroundings<Number>&,
                     const Number& rise_K_per_J) const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return rise_K_per_J * strength() * Real(4) * squared_kelvin(motor_C) * (motor_C + Real(273.15));
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.radiating_area_m2, self.emissivity);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(detail::require_positive(radiating_area_m2, ConfigError::radiating_area_m2),
                       detail::require_within(emissivity, Number(0), Number(1), ConfigError::emissivity));
  }

private:
  static Number squared_kelvin(const Number& celsius) noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    const Number kelvin = celsius + Real(273.15);
    return kelvin * kelvin;
  }
  Number strength() const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return radiating_area_m2 * emissivity * Real(5.670374419e-8);  // CODATA 2018
  }
};

}  // namespace thermopower
