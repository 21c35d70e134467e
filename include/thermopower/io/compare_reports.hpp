// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/names.hpp>

#include <string>

namespace thermopower::io {

/// @brief A report for machines and where it came from.
struct NamedReport {
  std::string name;  ///< as errors and the comparison call it
  std::string text;  ///< what report_json() wrote
};

/// @brief In what two reports differ: verdicts, causes, parameters and constants whose values are further apart than their
/// uncertainties say, and errors before and after. Plain text of at most 100 columns.
/// @throws InputError where a text is no report, with its name and what was expected
std::string comparison(const NamedReport& a, const NamedReport& b);

}  // namespace thermopower::io
