// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "table.hpp"

#include <csv.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

namespace thesis {
namespace {

/// The fields of one line, or why it has none.
std::vector<std::string> fields_of(const std::string& line, std::string& error) {
  csv_parser parser;
  csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI);
  const std::unique_ptr<csv_parser, void (*)(csv_parser*)> owner(&parser, csv_free);
  std::vector<std::string> fields;
  const auto add = [](void* field, size_t size, void* out) {
    static_cast<std::vector<std::string>*>(out)->emplace_back(static_cast<const char*>(field), size);
  };
  const bool is_parsed = csv_parse(&parser, line.data(), line.size(), add, nullptr, &fields) == line.size();
  if (!is_parsed || csv_fini(&parser, add, nullptr, &fields) != 0) error = csv_strerror(csv_error(&parser));
  return fields;
}

/// A field for a message: short, and nothing that could disturb a terminal.
std::string shown(const std::string& field) {
  std::string text;
  for (const char c : field.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '?';
  return "'" + text + (field.size() > 40 ? "...'" : "'");
}

}  // namespace

Table Table::read(const std::string& path, const std::vector<std::string>& columns) {
  Table table;
  table.path_ = path;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw TableError(path + ": is a directory; expected a CSV file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw TableError(path + ": cannot be opened; expected a CSV file");

  std::string line;
  for (size_t number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
    if (line.empty()) continue;
    std::string error;
    std::vector<std::string> fields = fields_of(line, error);
    if (!error.empty())
      table.fail(number, "not a CSV row (" + error + "); expected fields separated by commas");
    if (table.header_.empty()) {
      table.header_ = std::move(fields);
      continue;
    }
    if (fields.size() != table.header_.size())
      table.fail(number, std::to_string(fields.size()) + " fields; expected " +
                             std::to_string(table.header_.size()) + " as in the header");
    table.rows_.push_back({number, std::move(fields)});
  }
  if (table.header_.empty()) throw TableError(path + ":1: empty; expected a header row");
  for (const std::string& column : columns)
    if (std::find(table.header_.begin(), table.header_.end(), column) == table.header_.end())
      table.fail(1, "column '" + column + "' is missing; the header has " +
                        std::to_string(table.header_.size()) + " columns, the first is " +
                        shown(table.header_.front()));
  if (table.rows_.empty()) throw TableError(path + ":2: no rows; expected at least one below the header");
  return table;
}

const std::string& Table::text(size_t row, const std::string& column) const {
  return rows_.at(row).fields[index_of(column)];
}

double Table::number(size_t row, const std::string& column) const {
  if (const std::optional<double> value = number_if_any(row, column)) return *value;
  fail(rows_.at(row).line, "column '" + column + "': empty; expected a number");
}

std::optional<double> Table::number_if_any(size_t row, const std::string& column) const {
  const std::string& field = text(row, column);
  if (field.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
    fail(rows_.at(row).line,
         "column '" + column + "': " + shown(field) + "; expected a finite number with a decimal point");
  return value;
}

void Table::refuse(size_t row, const std::string& column, const std::string& why) const {
  fail(rows_.at(row).line, "column '" + column + "': " + shown(text(row, column)) + "; " + why);
}

size_t Table::index_of(const std::string& column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) fail(1, "column '" + column + "' is missing");
  return static_cast<size_t>(found - header_.begin());
}

void Table::fail(size_t line, const std::string& what) const {
  throw TableError(path_ + ":" + std::to_string(line) + ": " + what);
}

}  // namespace thesis
