// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/check.hpp"

/// @file supply_range.hpp
/// Between which voltages a supply can be at all.

namespace thermopower {

/// The declared range of a supply. A reading outside of it is no supply: an open ADC pin, a broken divider, a damaged message. The most
/// heat that there can be is then that of the highest voltage.
///
/// @snippet control_examples.cpp supply range
/// How to: @ref first_axis, @ref faults_and_reasons.
/// @ingroup actuator
struct SupplyRange {
  float lowest_V;   ///< The supply is never below this while the actuator is driven. Above 0.
  float highest_V;  ///< The supply is never above this: a full battery. Above `lowest_V`, finite.

  /// No range suits every supply: NaN, which `validate()` refuses by name until it is set.
  static SupplyRange unset() noexcept {
    const SupplyRange range = {detail::not_a_number(), detail::not_a_number()};
    return range;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.lowest_V, self.highest_V);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_positive(lowest_V, ConfigError::lowest_supply_V)))
      return ConfigError::lowest_supply_V;
    return detail::is_finite(highest_V) && highest_V > lowest_V ? ConfigError::none
                                                                : ConfigError::highest_supply_V;
  }
};

namespace detail {

/// The range that a motor declares itself; unset where it declares none.
template <class Motor>
auto declared_supply(int) noexcept -> decltype(Motor::supply()) {
  return Motor::supply();
}
template <class Motor>
SupplyRange declared_supply(long) noexcept {
  return SupplyRange::unset();
}

}  // namespace detail
}  // namespace thermopower
