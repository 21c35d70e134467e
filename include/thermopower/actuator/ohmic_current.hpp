// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"

/// @file ohmic_current.hpp
/// A winding that follows Ohm's law with a resistance that rises with temperature.

namespace thermopower {

/// Current law: Ohm's, with a resistance that rises with temperature.
/// \f[
/// I = \frac{V_\mathrm{rms}}{R(T)}, \qquad R(T) = R_\mathrm{ref} \, (1 + a \, (T - T_\mathrm{ref}))
/// \f]
/// Take it when the winding's resistance is known or can be measured; it is physical at any voltage and
/// temperature.
/// @tparam Number  float in firmware; double, lanes of numbers or an automatic-differentiation scalar on the
/// desk
///
/// @snippet actuator_examples.cpp current
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Number = float>
struct OhmicCurrent {
  typedef typename detail::ModelNumber<Number>::Type Scalar;  ///< What it computes in.

  Number resistance_ohm;  ///< At `reference_C`, between the terminals that see V_rms. Above 0.
  Number tempco_per_K;    ///< Relative rise per kelvin: copper 0.00393. 0 .. 0.02.
  Number reference_C;     ///< Temperature at which `resistance_ohm` was measured. -50 .. 200.

  /// Winding resistance at a temperature, at least a tenth of `resistance_ohm`: far below any real winding
  /// the straight line would reach zero, and a current without bound. @return ohm
  Number resistance_at(const Number& winding_C) const noexcept {
    typedef detail::Numeric<Number> Math;
    typedef typename Math::Real Real;
    const Number relative = Real(1) + tempco_per_K * (winding_C - reference_C);
    return resistance_ohm * detail::at_least(relative, Math::constant(Real(0.1)));
  }

  /// Current drawn at a voltage. @return ampere
  Number current_A(const Number& v_rms_V, const Number& winding_C) const noexcept {
    return v_rms_V / resistance_at(winding_C);
  }

  /// Its reciprocal, for who needs a current at many voltages and one temperature. @return siemens
  Number conductance_S(const Number& winding_C) const noexcept {
    typedef typename detail::Numeric<Number>::Real Real;
    return Real(1) / resistance_at(winding_C);
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.resistance_ohm, self.tempco_per_K, self.reference_C);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        detail::require_positive(resistance_ohm, ConfigError::resistance_ohm),
        first_error(detail::require_within(tempco_per_K, Number(0), Number(0.02), ConfigError::tempco_per_K),
                    detail::require_within(reference_C, Number(-50), Number(200), ConfigError::reference_C)));
  }
};

}  // namespace thermopower
