// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/column_choice.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A CSV file in memory, column by column, before anybody gives the columns a meaning.
struct CsvTable {
  /// A column of numbers. Missing samples (an empty cell, or `nan` in any case) are NaN; every other value is
  /// finite.
  struct Column {
    std::string name;            ///< as in the header row
    std::vector<double> values;  ///< one per data row
  };

  std::string file;             ///< path, for messages
  std::vector<Column> columns;  ///< in the order of the file, without text columns
  std::vector<std::string>
      run_labels;  ///< distinct consecutive values of the `run` column; one empty label without the column
  std::vector<std::size_t> run_begin;  ///< first row of each run; a change of the label starts a run
  std::vector<std::string>
      ignored_text;  ///< names of columns that hold text and are not `run`: read, checked, and left out
  std::vector<std::size_t> line_of_run;  ///< line in the file at which each run starts (1 is the header row)
  std::size_t rows = 0;                  ///< data rows
  /// A place in the file at which something was mended.
  struct Place {
    std::size_t row = 0;   ///< of the table, that follows on it
    std::size_t line = 0;  ///< in the file
  };
  std::vector<Place> repeated;  ///< rows that were the row before them once more, cell for cell: left out
  std::vector<Place> restarts;  ///< rows whose time fell back to where the run began: a new run starts there
  std::vector<std::string>
      units;  ///< of each of `columns`, where a row of units stands below the header; else empty
  std::vector<std::string>
      stamps;  ///< of a table read by read_any_csv(): columns of dates or times of day, in s since the first
  bool ends_with_line_break =
      true;  ///< false: the last row has all its fields, but a cut in its last one would be invisible
};

/// @brief What a CSV file itself does not say.
struct CsvReading {
  double rows_per_s =
      0.0;  ///< makes the time of a file that has none, from 0 at the first row of each run on; 0: it has one
  std::vector<std::size_t> lines =
      {};  ///< of a table made from a log: in which line of the log row i + 1 began, header first
};

/// @brief Reads a CSV file as RFC 4180 describes it: a header row, optional quotes, LF or CRLF, optional UTF-8
/// byte-order mark. Columns are separated by commas, semicolons or tabs, as in the header row. With the latter two, all
/// numbers may have a decimal comma. Lines that begin with `#` are comments; the last one above the first row is the header
/// row where the first row holds numbers only.
///
/// Strict, because a number that was read wrongly is worse than a file that was refused. Checked on the way:
/// header names present and distinct; as many fields in each row as in the header; numbers complete, finite
/// and in decimal notation; `t_s` present, never missing, strictly increasing inside a run, but for two faults that can mean one
/// thing only: a row that is the one before it once more is left out (CsvTable::repeated), and where time falls back to where
/// the run began, as after a restart of what logs, a new run starts (CsvTable::restarts);
/// `power_param` inside 0..255. Columns whose first non-missing value is no number are text: `run` is the
/// label of independent runs, any other is ignored and listed in CsvTable::ignored_text. A column of
/// INTERFACE columns (numeric by definition) may not hold text.
///
/// Three habits of programs are understood. A first row that holds units only is a row of units (CsvTable::units): a column
/// whose choice says no unit is in that one. `t_s` may hold dates or times of day (ISO 8601, and as Python, pandas and
/// spreadsheets write them); it becomes seconds since the first. A first column without a name, as pandas writes its index,
/// is called `index` and left out unless it is chosen. A column without a name and without a cell is left out.
///
/// Blank lines are skipped. Numbers are parsed with std::from_chars, so that no locale can change their
/// meaning.
///
/// @param path file to read, `-` for standard input; a directory or an unreadable file is an error, too
/// @param numeric names of columns that must be numbers
/// @param choices columns that go by another name or unit in the file; a column of the file whose own name is
/// taken by another one is left out
/// @throws InputError with file, line, column and what was expected
CsvTable read_csv(const std::string& path, const std::vector<std::string>& numeric,
                  const std::vector<ColumnChoice>& choices = {}, const CsvReading& how = {});

/// @brief The same on bytes in memory; `name` stands in messages where a path would.
CsvTable parse_csv(const std::string& name, const char* bytes, std::size_t size,
                   const std::vector<std::string>& numeric, const std::vector<ColumnChoice>& choices = {},
                   const CsvReading& how = {});

/// @brief Reads any table of numbers: as read_csv(), but no column is required, none has a meaning, and rows may be in
/// any order.
CsvTable read_any_csv(const std::string& path);

/// @brief The same on bytes in memory.
CsvTable parse_any_csv(const std::string& name, const char* bytes, std::size_t size);

}  // namespace thermopower::io
