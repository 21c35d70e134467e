// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief Which column of a file is meant by a name of the format, and how its numbers become the format's unit:
/// value = (number - offset) * factor.
struct ColumnChoice {
  std::string name;    ///< of the format, such as `motor_C`; any other name is a covariate
  std::string header;  ///< in the file's header row
  double factor =
      1.0;  ///< of the format's unit per unit of the file, negative where the sign is turned round
  double offset = 0.0;  ///< in the file's unit
};

/// @brief Reads `NAME=HEADER[:UNIT]`, such as `motor_C=temp:degF`, `t_s=stamp:ms`, `power_param=duty:1` or
/// `drive_A=current:-mA` (a minus turns the sign round). A header that holds a colon needs a unit after it.
/// @throws InputError that says what is wrong and which units the name knows
ColumnChoice parse_column_choice(const std::string& text);

/// @brief Reads a mapping file: a line `NAME=HEADER[:UNIT]` for each column, blanks around `=` allowed; blank lines and lines
/// that begin with `#` are skipped.
/// @throws InputError with file, line and what was expected; a name or a header that is there twice is an error, too
std::vector<ColumnChoice> read_column_map(const std::string& path);

/// @brief The same on a text in memory; `name` stands in messages where a path would.
std::vector<ColumnChoice> parse_column_map(const std::string& name, const std::string& text);

/// @brief Says what is wrong with a name that is none of the format's; empty where it can only be meant for a covariate.
///
/// A covariate may be called anything, but for what is nearly a name of the format, and a column that already has such a name is
/// none: a typing mistake would take it away without a word.
/// @param choice  as it was given
/// @param others  names that a plant of one's own reads besides
std::string unknown_name(const ColumnChoice& choice, const std::vector<std::string>& others = {});

/// @brief The units that a name knows, its own first; empty for a name without a unit.
std::vector<std::string> units_of(const std::string& name);

}  // namespace thermopower::io
