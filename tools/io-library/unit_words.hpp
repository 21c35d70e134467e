// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

namespace thermopower::io {

/// What a unit measures.
enum class Dimension {
  none,
  time,
  temperature,
  current,
  voltage,
  torque,
  angle,
  rate,
  power,
  share,
  speed,
  other
};

/// @brief A unit as people write it.
struct UnitWord {
  Dimension dimension = Dimension::none;  ///< none: the text is no unit
  std::string unit = {};  ///< as `--column` takes it; empty: a unit that no column of the format has
  std::string name = {};  ///< of unit_in_header(): what stands before the unit, else the whole header
};

/// @brief Reads a unit: `[A]`, `(degF)`, `°C`, `U/min`, `rad_s`, `N*m`. Brackets around it do not matter.
/// @return a word of no dimension where the text is no unit
UnitWord unit_word(const std::string& text);

/// @brief The unit at the end of a header, as in `Motor Temp (degF)`, `vel_rad_s`, `I [mA]`, `PWM %` or `supply_V`.
UnitWord unit_in_header(const std::string& header);

/// @brief A header without accents and signs beyond ASCII: `Gehäuse` is `Gehaeuse`, `°` is `deg`.
std::string plain_header(const std::string& header);

}  // namespace thermopower::io
