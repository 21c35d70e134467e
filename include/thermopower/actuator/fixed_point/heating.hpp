// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/reciprocal.hpp"
#include "motor.hpp"
#include "detail/level_table.hpp"

/// @file actuator/fixed_point/heating.hpp
/// Current, power and heating of a motor in one look-up: r P of eq 3.7 from a power parameter and a
/// temperature, in whole numbers.

namespace thermopower {
namespace fixed_point {
namespace detail {

/// A source's constants over the levels, and what they span.
template <class Source>
struct HeatCurves {
  static constexpr double volt(int level) {
    return Source::supply_V() * thermopower::detail::constexpr_pow(level / 255.0, 0.5);
  }
  // Dividing the power by the level leaves (V_rms I) / V_rms^2, which varies 20-fold between level 25 and 255
  // where the power varies 200-fold. Level 0 is never heated; its node only has to be finite.
  static constexpr int driven(int level) { return level < 1 ? 1 : level; }
  static constexpr double power(int level) { return Source::power_W(volt(driven(level))) / driven(level); }
  static constexpr double power_slope(int level) {
    return Source::power_slope_W_per_K(volt(driven(level))) / driven(level);
  }
  static constexpr double capacity(int level) { return Source::capacity_J_per_K(volt(level)); }
  static constexpr double capacity_slope(int level) { return Source::capacity_slope_J_per_K2(volt(level)); }

  // The largest of what must fit into 16 bits: offset, slope (T/256 is what product_q15 makes of 2^-7 K), and
  // their sum.
  static constexpr double span(double offset, double slope) {
    return greater(greater(absolute(offset), absolute(256.0 * slope)),
                   greater(absolute(offset + coldest_C() * slope), absolute(offset + hottest_C() * slope)));
  }
  // From level 16 up. Below, a measured law's slope over the level can grow without end, with a current that
  // is cut to 0 anyway: the slope then saturates.
  static constexpr double widest_power(int node = 16) {
    return node == level_node_count()
               ? 0.0
               : greater(span(power(level_of_node(node)), power_slope(level_of_node(node))),
                         widest_power(node + 1));
  }
  static constexpr double widest_capacity(int node = 0) {
    return node == level_node_count()
               ? 0.0
               : greater(span(capacity(level_of_node(node)), capacity_slope(level_of_node(node))),
                         widest_capacity(node + 1));
  }

  /// The least exponent with which the powers fit. @param fullest  the widest power, scaled with exponent 0
  static constexpr int8_t exponent_for(double fullest, int exponent = -8) {
    return exponent == 8 || fullest <= 32700.0 * power_of_two(exponent) ? static_cast<int8_t>(exponent)
                                                                        : exponent_for(fullest, exponent + 1);
  }
  static constexpr double power_of_two(int exponent) {
    return static_cast<double>(1 << (exponent + 8)) / 256.0;
  }
  /// The highest level that does not heat.
  static constexpr uint8_t idle_level(int level = 0) {
    return static_cast<uint8_t>(
        level < 255 && volt(level + 1) <= Source::minimum_V_rms() ? idle_level(level + 1) : level);
  }
  static constexpr int16_t whole(double value) {
    return static_cast<int16_t>(nearest(lesser(greater(value, -32767.0), 32767.0)));
  }
};

template <class Source>
constexpr auto least_capacity_J_per_K(int) -> decltype(Source::least_capacity_J_per_K()) {
  return Source::least_capacity_J_per_K();
}
template <class Source>
constexpr double least_capacity_J_per_K(long) {
  return 0.0;
}

/// How they are scaled into 16 bits. Constants and not functions, so that each is computed once.
template <class Source>
struct HeatScaling {
  typedef HeatCurves<Source> Curves;

  static constexpr double widest_power = Curves::widest_power();
  static constexpr double capacity_scale = 32700.0 / Curves::widest_capacity();
  // heating_between() computes 2^15 2^exponent level power / capacity.
  static constexpr double power_scale_unit = capacity_scale * rate_per_K_per_s() / 32768.0;
  static constexpr int8_t exponent = Curves::exponent_for(power_scale_unit * widest_power);
  static constexpr double power_scale = power_scale_unit / Curves::power_of_two(exponent);
  static constexpr uint8_t idle_level = Curves::idle_level();
  static constexpr int16_t least_capacity = Curves::whole(least_capacity_J_per_K<Source>(0) * capacity_scale);

  static_assert(
      power_scale * widest_power <= 32767.0,
      "thermopower: this motor heats too fast for a fixed-point model (above 3.8 K/s); take ThermalModel");
  static_assert(power_scale * widest_power >= 2000.0,
                "thermopower: this motor heats too slowly for a fixed-point model; take ThermalModel");

  /// p1 / level, p0 / level, c1, c0: rate = level (first T + second) / (third T + fourth), in scaled units.
  static constexpr LevelNode at(int level) {
    return LevelNode{Curves::whole(Curves::power_slope(level) * power_scale * 256.0),
                     Curves::whole(Curves::power(level) * power_scale),
                     Curves::whole(Curves::capacity_slope(level) * capacity_scale * 256.0),
                     Curves::whole(Curves::capacity(level) * capacity_scale)};
  }
};

/// Not a template: one copy serves every motor. @param exponent  HeatScaling::exponent
/// @param least  HeatScaling::least_capacity
[[gnu::noinline]] inline Rate heating_between(const int16_t* table, uint8_t level, int8_t exponent,
                                              CoarseTemperature motor, int16_t least) noexcept {
  const LevelNode node = between_nodes(table, level_position(level));
  const int16_t power = static_cast<int16_t>(node.second + product_q15(node.first, motor));
  if (power <= 0) return 0;
  const int16_t capacity = static_cast<int16_t>(node.fourth + product_q15(node.third, motor));
  return quotient(static_cast<uint16_t>(power), level, exponent, capacity > least ? capacity : least);
}

}  // namespace detail

/// The heating of a motor, r P, for a model that computes in whole numbers.
///
/// For the 2606 and the 5208 as programmed, at 13 V, against the laws in double precision: within 0.25 % from
/// level 25 up and between 20 and 80 degC; within 0.8 % (of at least 0.001 K/s) over all levels and
/// -50 .. 180 degC, wherever the apparent heat capacity is at least 1/32 of its largest. For the 5208 with
/// its corrected laws, where a current is a small difference of large numbers: within 2.3 % from level 12 up.
/// What the error can make of a temperature that has settled is below 0.1 K between 15 and 100 degC. Where
/// the apparent heat capacity comes nearer to zero (below about 13 degC at the lowest levels of the 2606, 4
/// degC for the 5208 as programmed, level 6 of the corrected one) the laws have a pole: the heating then is
/// bounded by 3.8 K/s, and 0 beyond the pole, as programmed.
/// @tparam Source  motor.hpp
///
/// @snippet actuator_examples.cpp fixed-point motor
/// How to: @ref custom_motor, @ref target_cost. Menu: @ref policies.
/// @ingroup actuator
template <class Source>
struct Heating {
  /// dT/dt by heating. @param level  power parameter  @param motor  temperature, -50 .. 180 degC
  static Rate rate(uint8_t level, CoarseTemperature motor) noexcept {
    typedef detail::HeatScaling<Source> Scaling;
    if (level <= Scaling::idle_level) return 0;
    return detail::heating_between(detail::LevelTable<Scaling>::table(), level, Scaling::exponent, motor,
                                   Scaling::least_capacity);
  }
};

}  // namespace fixed_point
}  // namespace thermopower
