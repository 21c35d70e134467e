// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// A heater's log for the desk: time, duty, air and reading, row by row. C++17.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace recorded {

/// One row: what was true since the row before, and what was read at its end.
struct Row {
  double t_s, duty, air_C,
      measured_C;        ///< The duty holds from this row on, 0 .. 1. NaN where nothing was read.
  double fan, target_C;  ///< 0 .. 1; NaN where the log has no target.
};

/// A log and where it came from.
struct Recording {
  std::string file;
  std::vector<Row> rows;
  bool has_fan = false, has_target = false;
  double hours() const { return rows.empty() ? 0.0 : (rows.back().t_s - rows.front().t_s) / 3600.0; }
};

/// Splits a line at its commas.
inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    while (!cell.empty() && (cell.back() == '\r' || cell.back() == ' ')) cell.pop_back();
    cells.push_back(cell);
  }
  return cells;
}

/// A CSV file with the columns t_s, power_param (0 .. 255), ambient_C and motor_C, as the diagnosis reads it; `fan` or
/// `fan_on` (0 .. 1) and target_C if there are any.
/// @throws std::runtime_error with file, line and column, and what was expected
inline Recording read(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file + ": cannot be read: expected a CSV file");
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = cells_of(line);
  const auto find = [&](const char* name) {
    const auto at = std::find(header.begin(), header.end(), name);
    return at == header.end() ? header.size() : static_cast<std::size_t>(at - header.begin());
  };
  const std::size_t none = header.size();
  const auto need = [&](const char* name) {
    if (find(name) == none)
      throw std::runtime_error(file + ": line 1: no column " + name +
                               ": expected t_s, power_param, ambient_C, motor_C");
    return find(name);
  };
  const std::size_t time = need("t_s"), power = need("power_param"), air = need("ambient_C"),
                    measured = need("motor_C"), fan = find("fan") == none ? find("fan_on") : find("fan"),
                    target = find("target_C");
  Recording recording;
  recording.file = file;
  recording.has_fan = fan != none;
  recording.has_target = target != none;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.empty()) continue;
    const auto value = [&](std::size_t column, double lowest, double highest, const char* expected) {
      if (column >= cells.size() || cells[column].empty()) return std::nan("");
      char* end = nullptr;
      const double read = std::strtod(cells[column].c_str(), &end);
      if (*end != '\0' || !(read >= lowest && read <= highest))
        throw std::runtime_error(file + ": line " + std::to_string(number) + ": " + header[column] + " is '" +
                                 cells[column] + "': expected " + expected);
      return read;
    };
    const Row row = {value(time, -1e12, 1e12, "a time, s"),
                     value(power, 0.0, 255.0, "0 .. 255") / 255.0,
                     value(air, -100.0, 100.0, "-100 .. 100 degC"),
                     value(measured, -1e6, 1e6, "degC"),
                     recording.has_fan ? value(fan, 0.0, 1.0, "0 .. 1") : 0.0,
                     recording.has_target ? value(target, -1e6, 1e6, "degC") : std::nan("")};
    if (!recording.rows.empty() && row.t_s == recording.rows.back().t_s) continue;
    if (!(row.duty >= 0.0) || !(recording.rows.empty() || row.t_s > recording.rows.back().t_s))
      throw std::runtime_error(file + ": line " + std::to_string(number) +
                               ": expected a time after the row before and a power");
    recording.rows.push_back(row);
  }
  if (recording.rows.size() < 100) throw std::runtime_error(file + ": expected at least 100 rows");
  return recording;
}

/// Middle of some numbers. @param values  at least one
inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace recorded
