// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/column_choice.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/plant/radians.hpp>

#include "nearest_name.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace thermopower::io {
namespace {

struct Unit {
  const char* text;
  double factor;
  double offset;
};

struct Quantity {
  const char* ending;  // of the names that have it
  std::vector<Unit> units;
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
        {"rev/s", 360.0, 0.0}}},
      {"_mps", {{"m/s", 1.0, 0.0}, {"km/h", 1.0 / 3.6, 0.0}}},
      {"_deg",
       {{"deg", 1.0, 0.0},
        {"rad", plant::deg_per_rad, 0.0},
        {"mrad", 1e-3 * plant::deg_per_rad, 0.0},
        {"rev", 360.0, 0.0}}},
      {"_Nm", {{"Nm", 1.0, 0.0}, {"mNm", 1e-3, 0.0}, {"Ncm", 1e-2, 0.0}}},
      {"_A", {{"A", 1.0, 0.0}, {"mA", 1e-3, 0.0}, {"uA", 1e-6, 0.0}}},
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

namespace {

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
  choice.header.resize(colon);
  if (choice.header.empty()) fail("the header is empty; expected NAME=HEADER:UNIT");
  const bool turned = !unit.empty() && unit[0] == '-';
  if (turned) unit.erase(0, 1);
  const Quantity* quantity = quantity_of(choice.name);
  if (turned && quantity != nullptr && quantity->one_sided != nullptr)
    fail("a unit with a minus turns the sign round, and " + std::string(quantity->one_sided) +
         "; expected the unit without it");
  std::string known;
  for (const auto& one : quantity != nullptr ? quantity->units : std::vector<Unit>()) {
    if (unit == one.text) {
      choice.factor = turned ? -one.factor : one.factor;
      choice.offset = one.offset;
      return choice;
    }
    known += (known.empty() ? "" : ", ") + std::string(one.text);
  }
  fail(excerpt(unit) + " is no unit of " + choice.name +
       (known.empty() ? "; a name without a unit takes none" : "; expected one of " + known));
  return choice;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? std::string() : text.substr(begin, end + 1 - begin);
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
  return excerpt(choice.name) + " is no name of the format" +
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
      if (other.name == choice.name) throw InputError(where + excerpt(choice.name) + " is there twice");
      if (other.header == choice.header)
        throw InputError(where + excerpt(choice.header) +
                         " is there twice; expected one name for each column");
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
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw InputError(path + ": cannot be read; expected a mapping file");
  return parse_column_map(path, text.str());
}

}  // namespace thermopower::io
