// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace thesis {

/// A table cannot be read. The text names file, line and column, and says what was expected.
class TableError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One table of the thesis as a CSV file: a header row, comma separated, no line breaks inside fields.
class Table {
public:
  /// Reads a file and checks that every row has as many fields as the header, and that `columns` are among
  /// them.
  /// @throws TableError
  static Table read(const std::string& path, const std::vector<std::string>& columns);

  size_t rows() const { return rows_.size(); }  ///< Without the header.
  /// The field as it stands. @throws TableError when there is no such column
  const std::string& text(size_t row, const std::string& column) const;
  /// The field as a number. @throws TableError when it is empty, no number, or not finite
  double number(size_t row, const std::string& column) const;
  /// The field as a number, or nothing when it is empty.
  std::optional<double> number_if_any(size_t row, const std::string& column) const;
  /// Refuses a field for a reason of the caller's: what is wrong, and what was expected. @throws TableError
  /// always
  [[noreturn]] void refuse(size_t row, const std::string& column, const std::string& why) const;

private:
  struct Row {
    size_t line;
    std::vector<std::string> fields;
  };
  size_t index_of(const std::string& column) const;
  [[noreturn]] void fail(size_t line, const std::string& what) const;

  std::string path_;
  std::vector<std::string> header_;
  std::vector<Row> rows_;
};

}  // namespace thesis
