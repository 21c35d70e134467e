// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

namespace thermopower::gap::engine {

/// How the program is told of a unit.
inline std::string column_option(const std::string& column, const std::string& unit) {
  return "--column " + column + "=" + column + ":" + unit;
}

/// How the program is told that two columns are exchanged.
inline std::string exchange_option(const std::string& a, const std::string& b) {
  return "--column " + a + "=" + b + " --column " + b + "=" + a;
}

}  // namespace thermopower::gap::engine
