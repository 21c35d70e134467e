// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief Which column of a file is meant by a name of the format, and how its numbers become the format's unit:
/// value = (number - offset) * factor, and then what `needs` says.
struct ColumnChoice {
  /// Further factors of the numbers.
  enum class Needs {
    nothing,          ///< the factor is all
    torque_constant,  ///< a torque of the drive: divided by the model's torque constant it is a current
    supply,           ///< a share of the supply: times its voltage it is the motor's
  };
  std::string name;    ///< of the format, such as `motor_C`; any other name is a covariate
  std::string header;  ///< in the file's header row
  double factor =
      1.0;  ///< of the format's unit per unit of the file, negative where the sign is turned round
  double offset = 0.0;    ///< in the file's unit
  std::string unit = {};  ///< as it was given; empty: the unit of the file's row of units, else the format's
  int sign_bit = 0;       ///< of a register that holds sign and magnitude; 0: a number with a sign of its own
  Needs needs = Needs::nothing;  ///< what else makes the format's unit of it
};

/// @brief A number of the file in the format's unit, but for what `choice.needs` says.
double value_of(const ColumnChoice& choice, double number);

/// @brief Reads `NAME=HEADER[:UNIT]`, such as `motor_C=temp:degF`, `t_s=stamp:ms`, `power_param=duty:1` or
/// `drive_A=current:-mA`. A header that holds a colon needs a unit after it.
///
/// A minus before the unit turns the sign round. `rpm/7` and `A*0.01` divide and multiply: a gear, pole pairs, the size of a count.
/// `angle_deg=pos:4096` are 4096 counts a turn, `rate_dps=speed:4096/s` the same per second; `,sign15` says that bit 15 of a
/// register is its sign. `drive_A=effort:Nm` is the drive's own torque, divided by the model's torque constant;
/// `voltage_V=duty:1` is a signed share of the supply.
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
/// A covariate may have any name that is not nearly a name of the format: a typing mistake would take that column away
/// silently.
/// @param choice  as it was given
/// @param others  names that a plant of one's own reads besides
std::string unknown_name(const ColumnChoice& choice, const std::vector<std::string>& others = {});

/// @brief The units that a name knows, its own first; empty for a name without a unit.
std::vector<std::string> units_of(const std::string& name);

}  // namespace thermopower::io
