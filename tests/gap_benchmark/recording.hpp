// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace gap_benchmark {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// One column of a log: NaN is a missing cell.
struct Column {
  std::string name;
  int decimals = 3;
  std::vector<double> values;
};

/// A log as a recorder would write it.
struct Recording {
  std::vector<Column> columns;
  std::vector<std::string> run;  ///< one label per row, or empty when the log has no such column

  const std::vector<double>& operator[](const std::string& name) const {
    for (const auto& column : columns)
      if (column.name == name) return column.values;
    throw std::out_of_range("no column " + name);
  }

  bool has(const std::string& name) const {
    for (const auto& column : columns)
      if (column.name == name) return true;
    return false;
  }

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }

  void write(const std::string& path) const {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (!file) throw std::runtime_error("cannot write " + path);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      std::fprintf(file, "%s%s", j ? "," : "", columns[j].name.c_str());
      if (j == 0 && !run.empty()) std::fprintf(file, ",run");
    }
    std::fputc('\n', file);
    for (std::size_t i = 0; i < rows(); ++i) {
      for (std::size_t j = 0; j < columns.size(); ++j) {
        if (j) std::fputc(',', file);
        write_number(file, columns[j].values[i], columns[j].decimals);
        if (j == 0 && !run.empty()) std::fprintf(file, ",%s", run[i].c_str());
      }
      std::fputc('\n', file);
    }
    const bool bad = std::ferror(file) != 0;
    if (std::fclose(file) != 0 || bad) throw std::runtime_error("cannot write " + path);
  }

private:
  static void write_number(std::FILE* file, double value, int decimals) {
    if (std::isnan(value)) return;
    char text[64];
    int length = std::snprintf(text, sizeof text, "%.*f", decimals, value);
    if (decimals > 0) {
      while (text[length - 1] == '0') --length;
      if (text[length - 1] == '.') --length;
    }
    std::fwrite(text, 1, static_cast<std::size_t>(length), file);
  }
};

/// Rounds to a quantum; a quantum of zero leaves the value alone.
inline double quantise(double value, double quantum) {
  return quantum > 0.0 ? quantum * std::round(value / quantum) : value;
}

/// Fills missing cells with the last known value, as a model that replays the log has to.
inline std::vector<double> held(std::vector<double> values) {
  double last = missing;
  for (const double value : values)
    if (!std::isnan(value)) {
      last = value;
      break;
    }
  for (auto& value : values) {
    if (std::isnan(value)) value = last;
    last = value;
  }
  return values;
}

}  // namespace gap_benchmark
