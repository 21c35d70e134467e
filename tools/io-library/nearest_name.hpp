// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief The one of some names that a misspelt one is likely meant to be: small and large letters count as the same, and one
/// letter in four may be missing, too many or another. Empty where none is that near.
std::string nearest_name(const std::string& given, const std::vector<std::string>& names);

}  // namespace thermopower::io
