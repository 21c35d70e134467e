// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/io/names.hpp>

#include <string>

namespace thermopower::io {

/// @brief The report for machines ("thermopower-gap-report/1", @ref gap_files).
///
/// Keys in a fixed order, numbers that read back bit by bit, NaN and infinities as null, no time stamp and no
/// duration: the same diagnosis gives the same bytes.
std::string report_json(const Diagnosis& diagnosis);

/// @brief The findings as a JSON list, as reports have it under `findings`.
std::string findings_json(const std::vector<Finding>& findings);

}  // namespace thermopower::io
