// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/column_list.hpp>

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/csv_table.hpp>

#include "column_proposal.hpp"
#include "html_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>

namespace thermopower::io {
namespace {

using Words = std::vector<std::string>;

// Lower-case words of a header: "Motor Temp [degC]", "motorTemp_degC" and "motor.temp-degC" are alike.
Words words_of(const std::string& header) {
  Words words(1);
  for (std::size_t i = 0; i < header.size(); ++i) {
    const char c = header[i];
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    const bool after_lower = i > 0 && header[i - 1] >= 'a' && header[i - 1] <= 'z';
    if ((upper && after_lower) || !(upper || lower || digit)) words.emplace_back();
    if (upper || lower || digit) words.back() += static_cast<char>(upper ? c - 'A' + 'a' : c);
  }
  words.erase(std::remove(words.begin(), words.end(), std::string()), words.end());
  return words;
}

bool has(const Words& words, std::initializer_list<const char*> any) {
  return std::any_of(any.begin(), any.end(), [&](const char* one) {
    return std::find(words.begin(), words.end(), one) != words.end();
  });
}

std::string name_of(const Words& words) {
  const bool wanted = has(
      words, {"cmd", "command", "commanded", "ref", "reference", "setpoint", "target", "desired", "goal"});
  const bool air = has(words, {"ambient", "air", "env", "room", "outside"});
  if (has(words, {"time", "timestamp", "stamp", "t", "elapsed"})) return "t_s";
  if (has(words, {"airspeed", "wind", "windspeed"})) return "airspeed_mps";
  if (has(words, {"temp", "temperature", "celsius"})) return air ? "ambient_C" : "motor_C";
  if (air && words.size() <= 2) return "ambient_C";
  if (has(words, {"duty", "pwm"})) return "power_param";
  if (has(words, {"current", "amps", "iq", "i"})) return wanted ? "drive_A" : "current_A";
  if (has(words, {"supply", "battery", "vbus", "vbat", "bus"})) return "supply_V";
  if (has(words, {"voltage", "volts", "v"})) return "voltage_V";
  if (has(words, {"rate", "velocity", "vel", "speed", "omega", "gyro", "rpm", "dq", "qd"}))
    return wanted ? "target_dps" : "rate_dps";
  if (has(words, {"angle", "position", "pos", "theta", "encoder", "q"}))
    return wanted ? "target_deg" : "angle_deg";
  if (has(words, {"torque", "effort"})) return "torque_Nm";
  return {};
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// Whether a text stands in another with no letter or digit on either side.
bool stands_in(const std::string& text, const std::string& all) {
  const auto part_of_word = [&](std::size_t at) {
    return at < all.size() && ((all[at] >= 'a' && all[at] <= 'z') || (all[at] >= '0' && all[at] <= '9'));
  };
  for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1))
    if ((at == 0 || !part_of_word(at - 1)) && !part_of_word(at + text.size())) return true;
  return false;
}

// A unit in the header, as in "[rad/s]", "rad_s" or "rads"; the longest that is there.
std::string unit_in(const std::string& header, const std::string& name) {
  std::string found;
  const std::string all = lower(header);
  for (const std::string& unit : units_of(name)) {
    const std::string small = lower(unit);
    const std::size_t slash = small.find('/');
    bool there = stands_in(small, all);
    if (slash != std::string::npos) {
      const std::string above = small.substr(0, slash), below = small.substr(slash + 1);
      there = there || stands_in(above + "_" + below, all) || stands_in(above + below, all);
    }
    if (there && unit.size() > found.size()) found = unit;
  }
  return found;
}

}  // namespace

void propose(ListedColumn& column) {
  const Words words = words_of(column.header);
  if (column.text || units_of(column.header).size() != 0) {
    // Text is no input or output; a name of the format's form is what it says.
    for (const char* known : {"t_s", "power_param", "drive_A", "voltage_V", "target_deg", "target_dps",
                              "torque_Nm", "heat_W", "supply_V", "ambient_C", "airspeed_mps", "neighbour_C",
                              "rate_dps", "current_A", "motor_C", "angle_deg"})
      if (column.header == known && !column.text) {
        column.proposed = known;
        column.why = "its name";
        return;
      }
    if (column.text) return;
  }
  column.proposed = name_of(words);
  if (column.proposed.empty()) return;
  column.why = "its name";
  column.unit = unit_in(column.header, column.proposed);
  if (!column.unit.empty()) {
    column.why += " and the unit in it";
    return;
  }
  const double largest = std::max(std::fabs(column.least), std::fabs(column.greatest));
  if (column.proposed == "power_param" && largest <= 100.0) {
    column.unit = largest <= 1.0 ? "1" : "%";
    column.why += ", and a range up to " + readable(largest);
  }
}

void settle_rivals(std::vector<ListedColumn>& list) {
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t k = 0; k < list.size(); ++k)
      if (i != k && !list[i].proposed.empty() && list[i].proposed == list[k].proposed &&
          list[k].header != list[k].proposed && (list[i].header == list[i].proposed || i < k)) {
        list[k].why = "may be " + list[k].proposed + ", as '" + list[i].header + "' is";
        list[k].proposed.clear();
        list[k].unit.clear();
      }
}

namespace {

std::vector<ListedColumn> listed(CsvTable table) {
  std::vector<ListedColumn> list;
  for (const auto& column : table.columns) {
    ListedColumn one;
    one.header = column.name;
    for (const double value : column.values) {
      if (std::isnan(value)) {
        ++one.missing;
        continue;
      }
      one.least = one.samples == 0 ? value : std::min(one.least, value);
      one.greatest = one.samples == 0 ? value : std::max(one.greatest, value);
      ++one.samples;
    }
    propose(one);
    list.push_back(std::move(one));
  }
  for (const auto& name : table.ignored_text) {
    ListedColumn one;
    one.header = name;
    one.text = true;
    list.push_back(std::move(one));
  }
  settle_rivals(list);
  return list;
}

std::string quoted_for_shell(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '=' || c == ':' || c == '/' || c == '.' || c == '%' || c == '-';
  });
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

}  // namespace

std::vector<ListedColumn> list_columns(const std::string& path) { return listed(read_any_csv(path)); }

std::vector<ListedColumn> list_columns(const std::string& name, const char* bytes, std::size_t size) {
  return listed(parse_any_csv(name, bytes, size));
}

std::string choice_text(const ListedColumn& column) {
  if (column.proposed.empty() || (column.proposed == column.header && column.unit.empty())) return {};
  // A header with a colon in it needs a unit after it, or the colon would begin one.
  std::string as = column.unit;
  if (as.empty() && column.header.find(':') != std::string::npos) as = units_of(column.proposed).front();
  return column.proposed + "=" + column.header + (as.empty() ? "" : ":" + as);
}

std::string list_text(const std::vector<ListedColumn>& columns) {
  std::size_t width = 28;
  for (const auto& one : columns) width = std::max(width, std::min<std::size_t>(one.header.size() + 1, 60));
  const int wide = static_cast<int>(width);
  char row[240];
  std::snprintf(row, sizeof row, "  %-*s%9s%9s%12s%12s  %s\n", wide, "column", "samples", "missing", "least",
                "greatest", "may be");
  std::string out = row, options;
  for (const auto& one : columns) {
    if (one.text) {
      std::snprintf(row, sizeof row, "  %-*.60s  text, left out unless it is called 'run'\n", wide,
                    one.header.c_str());
      out += row;
      continue;
    }
    const std::string unit = one.unit.empty() ? "" : " in " + one.unit;
    const std::string guess = one.proposed.empty() ? (one.why.empty() ? "a covariate" : one.why)
                                                   : one.proposed + unit + " (" + one.why + ")";
    std::snprintf(row, sizeof row, "  %-*.60s%9zu%9zu%12s%12s  ", wide, one.header.c_str(), one.samples,
                  one.missing, one.samples > 0 ? readable(one.least).c_str() : "-",
                  one.samples > 0 ? readable(one.greatest).c_str() : "-");
    out += row + guess + "\n";
    if (const std::string choice = choice_text(one); !choice.empty())
      options += " --column " + quoted_for_shell(choice);
  }
  if (!options.empty()) out += "\nIf that is so:" + options + "\n";
  return out;
}

std::string columns_text(const std::vector<ListedColumn>& columns) {
  std::string out = list_text(columns);
  const bool time = std::any_of(columns.begin(), columns.end(),
                                [](const ListedColumn& one) { return one.proposed == "t_s"; });
  if (!time) out += "\nNo column looks like time: --column t_s=HEADER:UNIT says which one it is.\n";
  return out;
}

std::string column_map_text(const std::vector<ListedColumn>& columns) {
  std::string out =
      "# NAME=HEADER[:UNIT], as --column takes it; what stands behind a '#' is a proposal not taken\n";
  for (const auto& one : columns) {
    const std::string choice = choice_text(one);
    if (!choice.empty()) out += choice + "\n";
    else if (one.proposed.empty() && !one.text) out += "# NAME=" + one.header + "\n";
  }
  return out;
}

}  // namespace thermopower::io
