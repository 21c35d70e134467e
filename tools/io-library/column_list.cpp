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
  const bool air = has(words, {"ambient", "amb", "air", "env", "room", "outside"});
  // "T_amb", "Tamb", "Twinding": a temperature, and no time.
  const bool body = has(words, {"motor", "mot", "winding", "coil", "case", "housing", "stator"});
  if (has(words, {"tamb", "tair", "tenv", "troom"}) || (air && has(words, {"t"}))) return "ambient_C";
  if (has(words, {"tmotor", "tmot", "twinding", "tcoil", "tcase"}) || (body && has(words, {"t"})))
    return "motor_C";
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
    if (unit == "%") there = there || stands_in("pct", all) || stands_in("percent", all);
    if (slash != std::string::npos) {
      const std::string above = small.substr(0, slash), below = small.substr(slash + 1);
      there = there || stands_in(above + "_" + below, all) || stands_in(above + below, all);
    }
    if (there && unit.size() > found.size()) found = unit;
  }
  return found;
}

// The unit of time in which a column's stamps are those of a log: of a day at most, or counted from 1970.
std::string unit_of_time(const ListedColumn& column) {
  constexpr double longest_s = 86400.0, since_1970_s = 1e9;
  struct Unit {
    const char* text;
    double per_s;
  };
  constexpr Unit units[] = {{"s", 1.0}, {"ms", 1e3}, {"us", 1e6}, {"ns", 1e9}};
  const double range = column.greatest - column.least;
  for (const Unit& unit : units) {
    const bool dates =
        column.least >= since_1970_s * unit.per_s && column.least < 1e2 * since_1970_s * unit.per_s;
    const bool counts = column.least < since_1970_s && range <= longest_s * unit.per_s;
    if (dates || counts) return unit.text;
  }
  return "s";
}

// What the numbers of a column say of its unit, where its name does not; a column with the format's own name is only contradicted.
void ask_the_range(ListedColumn& column, bool is_own_name) {
  const double largest = std::max(std::fabs(column.least), std::fabs(column.greatest));
  const auto tell = [&](const char* unit, const std::string& range) {
    column.unit = unit;
    column.why += ", and a range " + range;
  };
  const auto ends_with = [&](const std::string& end) {
    return column.proposed.size() > end.size() &&
           column.proposed.compare(column.proposed.size() - end.size(), end.size(), end) == 0;
  };
  constexpr double coldest_K = 200.0, many_A = 100.0, many_V = 1000.0, full_power = 255.0;
  if (column.samples == 0 && largest == 0.0) return;
  if (column.proposed == "t_s") {
    const std::string unit = unit_of_time(column);
    if (unit != "s") tell(unit.c_str(), "of " + readable(column.greatest - column.least));
  } else if (column.proposed == "power_param") {
    if (largest > full_power) {
      column.proposed.clear();
      column.why = "may be power_param, but goes up to " + readable(largest) + ", beyond 255";
    } else if (largest <= 1.0 && (!is_own_name || largest > 0.0)) {
      tell("1", "up to " + readable(largest));
    } else if (largest <= 100.0 && !is_own_name) {
      tell("%", "up to " + readable(largest));
    }
  } else if (ends_with("_C") && column.least > coldest_K) {
    tell("K", "from " + readable(column.least));
  } else if (ends_with("_A") && largest > many_A) {
    tell("mA", "up to " + readable(largest));
  } else if (ends_with("_V") && largest > many_V) {
    tell("mV", "up to " + readable(largest));
  }
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
        ask_the_range(column, true);
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
  ask_the_range(column, false);
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
