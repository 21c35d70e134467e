// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "../detail/constexpr_math.hpp"
#include "../detail/flash.hpp"
#include "detail/composition.hpp"

/// @file tabulated_current.hpp
/// A current law as a table in flash: no `pow` at run time, no RAM, and the table is computed by the
/// compiler.

namespace thermopower {
namespace detail {

/// A motor with the thesis's current law, in numbers that the compiler knows.
template <class Candidate, class = int>
struct HasCurrentLaw {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasCurrentLaw<Candidate,
                     typename Exists<decltype(Candidate::template current_law<double>().base_A),
                                     decltype(Candidate::template current_law<double>().exponent)>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail

/// What TabulatedCurrent tabulates: the thesis's law of a motor. A source of your own has the same four
/// functions, all `constexpr`.
/// @tparam Motor  has a `constexpr current_law<double>()` that is a ThesisCurrent, as the motors in `motors/`
/// do
///
/// @snippet actuator_examples.cpp tabulated current
/// How to: @ref custom_motor.
/// @ingroup actuator
template <class Motor>
struct ThesisCurrentSource {
  static_assert(
      detail::HasCurrentLaw<Motor>::value,
      "thermopower: the parameter of ThesisCurrentSource must be a motor with the thesis's current law, such as motors::Bgm2606_90t: a type with constexpr current_law<double>()");

  /// Current at 0 degC. @return A
  static constexpr double intercept_A(double v_rms_V) {
    return Motor::template current_law<double>().base_A *
           detail::constexpr_pow(v_rms_V, Motor::template current_law<double>().exponent);
  }
  /// Change of the current with temperature. @return A/K
  static constexpr double slope_A_per_K(double v_rms_V) {
    return Motor::template current_law<double>().slope_A_per_K(v_rms_V);
  }
  /// At or below this voltage there is no current. @return V
  static constexpr double minimum_V_rms() { return Motor::template current_law<double>().minimum_V_rms; }
  /// End of the table: four lithium cells, full, less the drop of the leads. @return V
  static constexpr double maximum_V_rms() { return 16.0; }
};

namespace detail {

template <class Source, int node_count, class Positions>
struct CurrentNodes;

// A class template so that the arrays may be defined in a header, and in flash.
template <class Source, int node_count, int... node>
struct CurrentNodes<Source, node_count, Indices<node...> > {
  static constexpr double volt(int index) { return Source::maximum_V_rms() * index / (node_count - 1); }
  static constexpr float intercepts[node_count] thermopower_flash = {
      static_cast<float>(Source::intercept_A(volt(node)))...};
  static constexpr float slopes[node_count] thermopower_flash = {
      static_cast<float>(Source::slope_A_per_K(volt(node)))...};
};
/// @cond
template <class Source, int node_count, int... node>
constexpr float CurrentNodes<Source, node_count, Indices<node...> >::intercepts[node_count];
template <class Source, int node_count, int... node>
constexpr float CurrentNodes<Source, node_count, Indices<node...> >::slopes[node_count];
/// @endcond

}  // namespace detail

/// Current law from a table: I = m(V) T + b(V), with m and b interpolated linearly between equally spaced
/// voltages. Take it when a law's `pow` is too slow for the chip; the models take it as any other law:
///
///     struct FastRoll : motors::Bgm2606_90t {
///       typedef CurrentModel<TabulatedCurrent<ThesisCurrentSource<motors::Bgm2606_90t> > > Current;
///       static Current::Config current() { return Current::Config(); }
///     };
///
/// Error against the law in double precision, 0 .. 16 V and 0 .. 100 degC: at most 0.6 mA for both thesis
/// motors with the default 65 nodes (520 bytes of flash); a linear interpolation, so half the spacing is a
/// quarter of the error. Above `maximum_V_rms()` the current is NaN, which every limiter treats as hot: an
/// extrapolation would be too low.
/// @tparam Source      the law: ThesisCurrentSource, or your own
/// @tparam node_count  entries of the table, 2 .. 255; eight bytes of flash each
///
/// @snippet actuator_examples.cpp tabulated current
/// How to: @ref custom_motor. Menu: @ref policies.
/// @ingroup actuator
template <class Source, int node_count = 65>
struct TabulatedCurrent {
  static_assert(
      detail::IsCurrentSource<Source>::value,
      "thermopower: the first parameter of TabulatedCurrent must be a source: a type with constexpr intercept_A(v), slope_A_per_K(v), minimum_V_rms() and maximum_V_rms(), such as ThesisCurrentSource<Motor>");

  static_assert(node_count >= 2 && node_count <= 255, "thermopower: a current table has 2 to 255 nodes");
  typedef float Scalar;  ///< What it computes in.

  /// Current drawn at a voltage. @return ampere, >= 0; NaN when an input is, and above the table
  float current_A(float v_rms_V, float motor_C) const noexcept {
    typedef detail::CurrentNodes<Source, node_count, typename detail::MakeIndices<node_count>::Type> Nodes;
    // Not a plain 0: a NaN voltage must stay visible.
    if (!(v_rms_V > static_cast<float>(Source::minimum_V_rms()))) return v_rms_V * 0.0f;
    if (!(v_rms_V <= static_cast<float>(Source::maximum_V_rms()))) return detail::not_a_number();
    const float position = v_rms_V * static_cast<float>((node_count - 1) / Source::maximum_V_rms());
    uint8_t node = static_cast<uint8_t>(position);
    if (node > node_count - 2) node = static_cast<uint8_t>(node_count - 2);
    const float share = position - static_cast<float>(node);
    const float slope = between(detail::flash_pointer(Nodes::slopes) + node, share);
    const float intercept = between(detail::flash_pointer(Nodes::intercepts) + node, share);
    return detail::at_least(slope * motor_C + intercept, 0.0f);
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self&, Archive&) {}
  /// The table is checked where it is made; there is nothing to set.
  ConfigError validate() const noexcept { return ConfigError::none; }

private:
  static float between(const float* node, float share) noexcept {
    const float below = detail::read_flash(node), above = detail::read_flash(node + 1);
    return below + share * (above - below);
  }
};

}  // namespace thermopower
