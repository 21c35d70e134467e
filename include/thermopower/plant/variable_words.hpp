// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>

namespace thermopower::plant {

/// The words for a recorded column or a variable derived from columns.
struct VariableWords {
  const char* name;  ///< of the column, or of the derived variable, as reports identify it
  const char* text;  ///< "motor temperature": to stand in a sentence, "the" before it
  const char* unit;  ///< as reports spell it; empty for a pure number
};

/// The words for a column of our own plants or a variable that their balances are drawn against; null for any other.
inline const VariableWords* words_of(const std::string& name) {
  static constexpr VariableWords known[] = {
      {"t_s", "time", "s"},
      {"power_param", "power (0 to 255)", ""},
      {"drive_A", "drive current", "A"},
      {"voltage_V", "voltage", "V"},
      {"v_rms_V", "RMS voltage", "V"},
      {"target_deg", "target angle", "deg"},
      {"target_dps", "target rate", "deg/s"},
      {"target_C", "target temperature", "degC"},
      {"torque_Nm", "external torque", "N m"},
      {"heat_W", "heat", "W"},
      {"supply_V", "supply voltage", "V"},
      {"ambient_C", "air temperature", "degC"},
      {"airspeed_mps", "air speed", "m/s"},
      {"neighbour_C", "temperature of the neighbour", "degC"},
      {"current_A", "motor current", "A"},
      {"motor_C", "motor temperature", "degC"},
      {"angle_deg", "angle", "deg"},
      {"rate_dps", "angular rate", "deg/s"},
      {"rate_rad_per_s", "angular rate", "rad/s"},
      {"acceleration_rad_per_s2", "angular acceleration", "rad/s2"},
      {"drive_A_per_s", "change of the drive current", "A/s"},
      {"current_A_per_s", "change of the motor current", "A/s"},
      {"servo_A", "current that the servo asks for", "A"},
      {"servo_A_per_s", "change of the current that the servo asks for", "A/s"},
      {"voltage_V_per_s", "change of the voltage", "V/s"},
      {"law_A", "current by the law", "A"},
      {"rise_K", "temperature above the air", "K"},
      {"dT_dt", "rate of heating", "K/s"},
  };
  for (const VariableWords& one : known)
    if (name == one.name) return &one;
  return nullptr;
}

/// "motor temperature" for `motor_C`; the name itself where nobody knows better, as for a column of a user's own.
inline std::string in_words(const std::string& name) {
  const VariableWords* const words = words_of(name);
  return words != nullptr ? words->text : name;
}

/// The same inside a sentence: "the motor temperature"; a name of a user's own goes without the article.
inline std::string the_variable(const std::string& name) {
  const VariableWords* const words = words_of(name);
  return words != nullptr ? std::string("the ") + words->text : name;
}

}  // namespace thermopower::plant
