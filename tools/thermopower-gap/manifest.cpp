// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "manifest.hpp"
#include "text_file.hpp"

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/text_table.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace fs = std::filesystem;
namespace io = thermopower::io;

namespace {

std::string hash_of(const std::string& text) {  // FNV-1a
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  char out[17];
  std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(hash));
  return out;
}

// Letters and digits of the log's name, and what tells it from every other task: another model, or the same one
// changed, is another task.
std::string id_of(const ManifestLog& log, const std::string& rest, std::map<std::string, std::string>& files,
                  const fs::path& home) {
  std::string key, name;
  for (const auto& [column, value] : log.cells) key += column + '\0' + value + '\0';
  key += rest;
  for (const char* column : {"model", "map"}) {
    const std::string& file = log.cell(column);
    if (file.empty()) continue;
    const auto [known, is_new] = files.emplace(file, std::string());
    if (is_new) known->second = hash_of(read_text(home / file));
    key += known->second + '\0';
  }
  for (const char c : fs::path(log.cell("log")).stem().string()) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    if (name.size() < 60) name += plain ? c : '_';
  }
  return name + "-" + hash_of(key).substr(0, 10);
}

}  // namespace

const std::string& ManifestLog::cell(const std::string& name) const {
  static const std::string none;
  const auto found = cells.find(name);
  return found == cells.end() ? none : found->second;
}

double days_of(const std::string& text) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(number)) return number;
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0;
  double second = 0.0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2d%n", &year, &month, &day, &used) != 3) return missing;
  if (static_cast<std::size_t>(used) < text.size()) {
    int clock = 0, more = 0;
    const char* const rest = text.c_str() + used;
    if ((rest[0] != 'T' && rest[0] != ' ') || std::sscanf(rest + 1, "%2d:%2d%n", &hour, &minute, &clock) != 2)
      return missing;
    used += 1 + clock;
    if (text[static_cast<std::size_t>(used)] == ':') {
      if (std::sscanf(text.c_str() + used + 1, "%lf%n", &second, &more) != 1) return missing;
      used += 1 + more;
    }
    if (text.compare(static_cast<std::size_t>(used), std::string::npos, "Z") == 0) ++used;
    if (static_cast<std::size_t>(used) != text.size()) return missing;
  }
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  const int days_of_month = month == 2                                              ? (leap ? 29 : 28)
                            : month == 4 || month == 6 || month == 9 || month == 11 ? 30
                                                                                    : 31;
  if (month < 1 || month > 12 || day < 1 || day > days_of_month || hour > 23 || minute > 59 ||
      !(second < 61.0))
    return missing;
  // Howard Hinnant's count of days: years that begin in March, eras of 400 years.
  year -= month <= 2 ? 1 : 0;
  const int era = year / 400, of_era = year - era * 400;
  const int of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const int days = era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
  return days + (hour * 60.0 + minute + second / 60.0) / 1440.0;
}

std::vector<ManifestLog> read_manifest(const std::string& path, const std::vector<std::string>& options) {
  const io::TextTable table = io::read_text_table(path);
  if (table.rows.empty())
    throw io::InputError(path + ": no log in it; expected a header row with 'log' and 'model', and rows");
  const std::string header = path + ":" + std::to_string(table.header_line) + ": ";
  for (const std::string& name : table.header)
    if (name != "log" && name != "model" && name != "unit" && name != "heldout" && name != "map" &&
        name != "time")
      throw io::InputError(header + "column " + io::excerpt(name) +
                           "; expected log, model, unit, heldout, map or time");
  for (const char* needed : {"log", "model"})
    if (std::count(table.header.begin(), table.header.end(), needed) != 1)
      throw io::InputError(header + "expected one column '" + needed + "' in the header row");
  std::string rest;
  for (const std::string& option : options) rest += option + '\0';
  std::vector<ManifestLog> logs;
  std::map<std::string, std::size_t> lines;
  std::map<std::string, std::string> files;
  for (const io::TextTable::Row& row : table.rows) {
    const std::string where = path + ":" + std::to_string(row.line) + ": ";
    ManifestLog log;
    log.line = row.line;
    for (std::size_t i = 0; i < row.cells.size(); ++i) log.cells[table.header[i]] = row.cells[i];
    for (const char* needed : {"log", "model"})
      if (log.cell(needed).empty())
        throw io::InputError(where + "column '" + needed + "': empty; expected a path");
    if (!log.cell("time").empty()) {
      log.time_days = days_of(log.cell("time"));
      if (!std::isfinite(log.time_days))
        throw io::InputError(where + "column 'time': " + io::excerpt(log.cell("time")) +
                             "; expected a date such as 2026-03-01 or 2026-03-01T13:45, or a number of days");
    }
    log.id = id_of(log, rest, files, fs::path(path).parent_path());
    const auto [other, is_new] = lines.emplace(log.id, row.line);
    if (!is_new) throw io::InputError(where + "the same log as in line " + std::to_string(other->second));
    logs.push_back(std::move(log));
  }
  return logs;
}
