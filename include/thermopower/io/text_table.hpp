// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A CSV file whose cells are words, such as a list of logs.
struct TextTable {
  /// One row.
  struct Row {
    std::size_t line = 0;            ///< in the file at which it begins, from 1
    std::vector<std::string> cells;  ///< as many as the header has
  };
  std::size_t header_line = 0;      ///< in the file
  std::vector<std::string> header;  ///< names of the columns; empty where the file has no row at all
  std::vector<Row> rows;            ///< what follows on it
};

/// @brief Reads a table of words as RFC 4180 describes it: commas, optional quotes, LF or CRLF, optional UTF-8 byte-order
/// mark. Blank lines and lines that begin with `#` are skipped.
/// @throws InputError with file and line: unreadable, a quote that is never closed or stands within a cell, a row with
/// another number of cells than the header
TextTable read_text_table(const std::string& path);

/// @brief Appends a cell as RFC 4180 wants it: with a separator, a quote or a line break in it, it is quoted.
void append_csv_cell(std::string& out, const std::string& text);

}  // namespace thermopower::io
