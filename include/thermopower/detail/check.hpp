// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../config_error.hpp"
#include "numeric.hpp"

/// @file check.hpp
/// The range checks behind every `validate()`. A NaN fails each of them.

namespace thermopower {
namespace detail {

template <class Number>
ConfigError require_positive(Number value, ConfigError field) noexcept {
  return is_finite(value) && value > Number(0) ? ConfigError::none : field;
}

template <class Number>
ConfigError require_not_negative(Number value, ConfigError field) noexcept {
  return is_finite(value) && value >= Number(0) ? ConfigError::none : field;
}

template <class Number>
ConfigError require_finite(Number value, ConfigError field) noexcept {
  return is_finite(value) ? ConfigError::none : field;
}

template <class Number>
ConfigError require_within(Number value, Number from, Number to, ConfigError field) noexcept {
  return is_finite(value) && value >= from && value <= to ? ConfigError::none : field;
}

}  // namespace detail
}  // namespace thermopower
