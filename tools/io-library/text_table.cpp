// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/text_table.hpp>

#include <thermopower/io/input_error.hpp>

#include <csv.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>
#include <utility>

namespace thermopower::io {
namespace {

class TableParser {
public:
  explicit TableParser(const std::string& path) : path_(path) {
    if (csv_init(&csv_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  ~TableParser() { csv_free(&csv_); }
  TableParser(const TableParser&) = delete;
  TableParser& operator=(const TableParser&) = delete;

  /// One line with its end; a cell in quotes may go on in the next one.
  void line(const std::string& text) {
    ++line_;
    if (!in_row_ && (text.empty() || text[0] == '#' || text[0] == '\n' || text[0] == '\r')) return;
    if (!in_row_) first_ = line_;
    in_row_ = true;
    const std::size_t done =
        csv_parse(&csv_, text.data(), text.size(), &TableParser::on_field, &TableParser::on_row, this);
    if (error_) std::rethrow_exception(error_);
    if (done != text.size())
      fail(line_, "a quote within a cell; expected quotes around the whole cell, and doubled ones inside");
  }

  TextTable finish() {
    const int fault = csv_fini(&csv_, &TableParser::on_field, &TableParser::on_row, this);
    if (error_) std::rethrow_exception(error_);
    if (fault != 0) fail(first_, "a quote that is never closed; expected a closing '\"'");
    return std::move(table_);
  }

private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(path_ + ":" + std::to_string(line) + ": " + what);
  }

  void take_row() {
    in_row_ = false;
    if (table_.header.empty()) {
      table_.header_line = first_;
      table_.header = std::exchange(cells_, {});
      return;
    }
    if (cells_.size() != table_.header.size())
      fail(first_, std::to_string(cells_.size()) + " cells; expected " +
                       std::to_string(table_.header.size()) + " as in the header row");
    table_.rows.push_back({first_, std::exchange(cells_, {})});
  }

  // No exception may pass through the C library.
  static void on_field(void* text, std::size_t size, void* self) {
    TableParser& parser = *static_cast<TableParser*>(self);
    if (parser.error_) return;
    try {
      parser.cells_.emplace_back(static_cast<const char*>(text), size);
    } catch (...) {
      parser.error_ = std::current_exception();
    }
  }
  static void on_row(int, void* self) {
    TableParser& parser = *static_cast<TableParser*>(self);
    if (parser.error_ || !parser.in_row_) return;
    try {
      parser.take_row();
    } catch (...) {
      parser.error_ = std::current_exception();
    }
  }

  const std::string& path_;
  csv_parser csv_{};
  TextTable table_;
  std::vector<std::string> cells_;
  std::exception_ptr error_;
  std::size_t line_ = 0, first_ = 0;
  bool in_row_ = false;
};

}  // namespace

TextTable read_text_table(const std::string& path) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    throw InputError(path + ": is a directory; expected a table (CSV)");
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw InputError(path + ": cannot be read: " + std::strerror(errno) + "; expected a table (CSV)");
  TableParser parser(path);
  bool first = true;
  for (std::string line; std::getline(file, line); first = false) {
    if (first && line.compare(0, 3, "\xef\xbb\xbf") == 0) line.erase(0, 3);
    if (!file.eof()) line += '\n';
    parser.line(line);
  }
  return parser.finish();
}

void append_csv_cell(std::string& out, const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  out += '"';
}

}  // namespace thermopower::io
