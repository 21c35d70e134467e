// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/column_choice.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/plant/radians.hpp>

#include "nearest_name.hpp"
#include "plain_letters.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace thermopower::io {
namespace {

using Needs = ColumnChoice::Needs;

struct SpelledUnit {
  const char* text;
  double factor;
  double offset;
  Needs needs = Needs::nothing;
};

struct Quantity {
  const char* ending;  // of the names that have it
  std::vector<SpelledUnit> units;
  const char* one_sided = nullptr;  // why its sign cannot be turned round
};

constexpr double ice_K = 273.15, ice_F = 32.0;

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> list = {
      {"t_s",
       {{"s", 1.0, 0.0},
        {"ms", 1e-3, 0.0},
        {"us", 1e-6, 0.0},
        {"ns", 1e-9, 0.0},
        {"min", 60.0, 0.0},
        {"h", 3600.0, 0.0}},
       "time goes on one way"},
      {"power_param",
       {{"255", 1.0, 0.0},
        {"%", 2.55, 0.0},
        {"1", 255.0, 0.0},
        {"1023", 255.0 / 1023.0, 0.0},
        {"4095", 255.0 / 4095.0, 0.0},
        {"65535", 255.0 / 65535.0, 0.0}},
       "a power is not below 0"},
      {"_dps",
       {{"deg/s", 1.0, 0.0},
        {"dps", 1.0, 0.0},
        {"rad/s", plant::deg_per_rad, 0.0},
        {"rpm", 6.0, 0.0},
        {"mrad/s", 1e-3 * plant::deg_per_rad, 0.0},
        {"rev/s", 360.0, 0.0}}},
      {"_mps", {{"m/s", 1.0, 0.0}, {"km/h", 1.0 / 3.6, 0.0}}},
      {"_deg",
       {{"deg", 1.0, 0.0},
        {"rad", plant::deg_per_rad, 0.0},
        {"mrad", 1e-3 * plant::deg_per_rad, 0.0},
        {"rev", 360.0, 0.0}}},
      {"_Nm", {{"Nm", 1.0, 0.0}, {"mNm", 1e-3, 0.0}, {"Ncm", 1e-2, 0.0}}},
      {"drive_A",
       {{"A", 1.0, 0.0},
        {"mA", 1e-3, 0.0},
        {"uA", 1e-6, 0.0},
        {"Nm", 1.0, 0.0, Needs::torque_constant},
        {"mNm", 1e-3, 0.0, Needs::torque_constant}}},
      {"current_A",
       {{"A", 1.0, 0.0},
        {"mA", 1e-3, 0.0},
        {"uA", 1e-6, 0.0},
        {"Nm", 1.0, 0.0, Needs::torque_constant},
        {"mNm", 1e-3, 0.0, Needs::torque_constant}}},
      {"_A", {{"A", 1.0, 0.0}, {"mA", 1e-3, 0.0}, {"uA", 1e-6, 0.0}}},
      {"voltage_V",
       {{"V", 1.0, 0.0},
        {"mV", 1e-3, 0.0},
        {"1", 1.0, 0.0, Needs::supply},
        {"%", 1e-2, 0.0, Needs::supply},
        {"255", 1.0 / 255.0, 0.0, Needs::supply}}},
      {"_V", {{"V", 1.0, 0.0}, {"mV", 1e-3, 0.0}}},
      {"_W", {{"W", 1.0, 0.0}, {"mW", 1e-3, 0.0}, {"kW", 1e3, 0.0}}},
      {"_C",
       {{"degC", 1.0, 0.0},
        {"C", 1.0, 0.0},
        {"degF", 5.0 / 9.0, ice_F},
        {"F", 5.0 / 9.0, ice_F},
        {"K", 1.0, ice_K},
        {"ddegC", 0.1, 0.0},
        {"mdegC", 1e-3, 0.0}},
       "a temperature has no sign to turn round"},
  };
  return list;
}

const Quantity* quantity_of(const std::string& name) {
  for (const auto& one : quantities()) {
    const std::string ending = one.ending;
    if (name.size() >= ending.size() && name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
      return &one;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> units_of(const std::string& name) {
  std::vector<std::string> list;
  if (const Quantity* quantity = quantity_of(name))
    for (const auto& unit : quantity->units) list.emplace_back(unit.text);
  return list;
}

double value_of(const ColumnChoice& choice, double number) {
  if (choice.sign_bit > 0) {
    const double sign = std::ldexp(1.0, choice.sign_bit);
    if (number >= sign && number < 2.0 * sign) number = sign - number;
  }
  return (number - choice.offset) * choice.factor;
}

namespace {

// A number above 0, all of a text.
bool read_number(const std::string& text, double& value) {
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && last == end && std::isfinite(value) && value > 0.0;
}

// Counts: whole numbers of which so many are a turn, or full power.
bool read_counts(const std::string& name, const std::string& unit, double& factor) {
  constexpr double fewest = 2.0, most = 4294967296.0;
  const Quantity* const quantity = quantity_of(name);
  if (quantity == nullptr) return false;
  const std::string ending = quantity->ending;
  std::string counts = unit;
  if (ending == "_dps") {
    if (counts.size() < 3 || counts.compare(counts.size() - 2, 2, "/s") != 0) return false;
    counts.resize(counts.size() - 2);
  } else if (ending != "_deg" && ending != "power_param") {
    return false;
  }
  double number = 0.0;
  if (!read_number(counts, number) || number < fewest || number > most || number != std::floor(number))
    return false;
  factor = (ending == "power_param" ? 255.0 : 360.0) / number;
  return true;
}

// A unit by itself, or one that is multiplied or divided by a number.
bool take_unit(const std::string& unit, ColumnChoice& choice) {
  const Quantity* const quantity = quantity_of(choice.name);
  if (quantity == nullptr) return false;
  for (const SpelledUnit& one : quantity->units)
    if (unit == one.text) {
      choice.factor = one.factor;
      choice.offset = one.offset;
      choice.needs = one.needs;
      return true;
    }
  if (read_counts(choice.name, unit, choice.factor)) return true;
  const std::size_t at = unit.find_last_of("*/");
  double number = 0.0;
  if (at == std::string::npos || at == 0 || !read_number(unit.substr(at + 1), number)) return false;
  if (!take_unit(unit.substr(0, at), choice)) return false;
  const double factor = unit[at] == '*' ? number : 1.0 / number;
  choice.factor *= factor;
  choice.offset /= factor;
  return true;
}

ColumnChoice parse_choice(const std::string& where, const std::string& text) {
  const auto fail = [&](const std::string& what) { throw InputError(where + excerpt(text) + ": " + what); };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    fail("expected NAME=HEADER or NAME=HEADER:UNIT, such as motor_C=temp:degF");
  ColumnChoice choice;
  choice.name = text.substr(0, equals);
  choice.header = text.substr(equals + 1);
  const std::size_t colon = choice.header.rfind(':');
  if (colon == std::string::npos) return choice;
  std::string unit = choice.header.substr(colon + 1);
  choice.unit = unit;
  choice.header.resize(colon);
  if (choice.header.empty()) fail("the header is empty; expected NAME=HEADER:UNIT");
  const bool turned = !unit.empty() && unit[0] == '-';
  if (turned) unit.erase(0, 1);
  const Quantity* quantity = quantity_of(choice.name);
  if (turned && quantity != nullptr && quantity->one_sided != nullptr)
    fail("a unit with a minus turns the sign round, and " + std::string(quantity->one_sided) +
         "; expected the unit without it");
  if (const std::size_t comma = unit.find(','); comma != std::string::npos) {
    const std::string encoding = unit.substr(comma + 1);
    double bit = 0.0;
    if (encoding.compare(0, 4, "sign") != 0 || !read_number(encoding.substr(4), bit) ||
        bit != std::floor(bit) || bit > 31.0)
      fail(
          excerpt(encoding) +
          " is not a way to hold a number; expected sign15 or another bit up to sign31, which is the sign of a "
          "register with sign and magnitude");
    choice.sign_bit = static_cast<int>(bit);
    unit.resize(comma);
  }
  if (take_unit(unit, choice)) {
    if (turned) choice.factor = -choice.factor;
    return choice;
  }
  std::string known;
  for (const auto& one : quantity != nullptr ? quantity->units : std::vector<SpelledUnit>())
    known += (known.empty() ? "" : ", ") + std::string(one.text);
  const std::string ending = quantity != nullptr ? quantity->ending : "";
  if (ending == "_deg") known += ", or how many counts a turn has, such as 4096";
  if (ending == "_dps") known += ", or counts a turn per second, such as 4096/s";
  if (ending == "power_param") known += ", or what full power is";
  if (!known.empty())
    known +=
        ", each also behind a factor above 0, such as " + std::string(quantity->units.front().text) + "*0.01";
  fail(excerpt(unit) + " is not a unit of " + choice.name +
       (known.empty() ? "; a name without a unit takes none" : "; expected one of " + known));
  return choice;
}

}  // namespace

ColumnChoice parse_column_choice(const std::string& text) { return parse_choice("--column ", text); }

std::string unknown_name(const ColumnChoice& choice, const std::vector<std::string>& others) {
  std::vector<std::string> known = known_columns();
  known.insert(known.begin() + 1, "run");
  known.insert(known.end(), others.begin(), others.end());
  const auto is_known = [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  if (is_known(choice.name)) return {};
  const std::string nearest = nearest_name(choice.name, known);
  if (nearest.empty() && !is_known(choice.header)) return {};
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  return excerpt(choice.name) + " is not a name of the format" +
         (nearest.empty() ? ", and " + choice.header + " would be lost under it."
                          : "; did you mean " + nearest + "?") +
         " Expected one of " + list +
         "; a covariate may be called anything else, where its column has none of these names";
}

std::vector<ColumnChoice> parse_column_map(const std::string& name, const std::string& text) {
  std::vector<ColumnChoice> choices;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = name + ":" + std::to_string(++number) + ": ";
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos) {
      const std::size_t colon = line.rfind(':');
      const bool with_unit = colon != std::string::npos && colon > equals;
      const std::string header =
          trimmed(line.substr(equals + 1, with_unit ? colon - equals - 1 : std::string::npos));
      line = trimmed(line.substr(0, equals)) + "=" + header +
             (with_unit ? ":" + trimmed(line.substr(colon + 1)) : std::string());
    }
    const ColumnChoice choice = parse_choice(where, line);
    for (const ColumnChoice& other : choices) {
      if (other.name == choice.name) throw InputError(where + excerpt(choice.name) + " appears twice");
      if (other.header == choice.header)
        throw InputError(where + excerpt(choice.header) +
                         " appears twice; expected one name for each column");
    }
    choices.push_back(choice);
  }
  if (choices.empty())
    throw InputError(name + ": no line says what a column is; expected NAME=HEADER[:UNIT]");
  return choices;
}

std::vector<ColumnChoice> read_column_map(const std::string& path) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    throw InputError(path + ": is a directory; expected a mapping file");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(path + ": cannot be read: " + std::strerror(errno) + "; expected a mapping file");
  std::ostringstream text;
  text << file.rdbuf();
  return parse_column_map(path, text.str());
}

}  // namespace thermopower::io
