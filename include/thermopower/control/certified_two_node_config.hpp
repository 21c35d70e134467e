// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "certified_bounds.hpp"

/// @file certified_two_node_config.hpp
/// What is declared about an actuator with a winding and a body, before a limiter vouches for it.

namespace thermopower {

/// What is declared about an actuator with a winding and a body.
struct CertifiedTwoNodeConfig {
  Bounds winding_heat_capacity_J_per_K;  ///< C_w
  Bounds body_heat_capacity_J_per_K;     ///< C_b
  float least_coupling_W_per_K;          ///< K is never below this. Above 0.
  float least_conductance_W_per_K;       ///< G is never below this. Above 0.
  float maximum_winding_C;               ///< Limit of the winding. 0 .. 250 degC.
  float maximum_body_C;                  ///< Limit of the body. 0 .. 250 degC.

  /// Nothing suits every motor: NaN, which `validate()` refuses by name until it is set.
  static CertifiedTwoNodeConfig standard() noexcept {
    const float unset = detail::not_a_number();
    const CertifiedTwoNodeConfig config = {{unset, unset}, {unset, unset}, unset, unset, unset, unset};
    return config;
  }
  /// The constants of a `TwoNodeThermalModel`, each known to a fraction. @param fraction  0.2 for +-20 %
  template <class ThermalConfig>
  static CertifiedTwoNodeConfig around(const ThermalConfig& thermal, float fraction, float maximum_winding_C,
                                       float maximum_body_C) noexcept {
    const CertifiedTwoNodeConfig config = {Bounds::around(thermal.winding_heat_capacity_J_per_K, fraction),
                                           Bounds::around(thermal.body_heat_capacity_J_per_K, fraction),
                                           thermal.coupling_W_per_K * (1.0f - fraction),
                                           thermal.cooling.conductance_W_per_K * (1.0f - fraction),
                                           maximum_winding_C,
                                           maximum_body_C};
    return config;
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        first_error(winding_heat_capacity_J_per_K.validate(ConfigError::winding_heat_capacity_J_per_K),
                    body_heat_capacity_J_per_K.validate(ConfigError::body_heat_capacity_J_per_K)),
        first_error(
            first_error(
                detail::require_positive(least_coupling_W_per_K, ConfigError::coupling_W_per_K),
                detail::require_positive(least_conductance_W_per_K, ConfigError::conductance_W_per_K)),
            first_error(
                detail::require_within(maximum_winding_C, 0.0f, 250.0f, ConfigError::maximum_winding_C),
                detail::require_within(maximum_body_C, 0.0f, 250.0f, ConfigError::maximum_body_C))));
  }
  float hottest_C() const noexcept { return maximum_winding_C; }  ///< Limit of the heated node.
};

}  // namespace thermopower
