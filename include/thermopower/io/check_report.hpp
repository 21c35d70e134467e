// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check_data.hpp>
#include <thermopower/io/names.hpp>

#include <string>

namespace thermopower::io {

/// @brief What a person reads of a check: findings first, then what the data can show and determine. Plain text of at
/// most 100 columns.
std::string check_text(const DataReport& report);

/// @brief The same for machines (JSON, format `thermopower-gap-check/1`).
std::string check_json(const DataReport& report);

}  // namespace thermopower::io
