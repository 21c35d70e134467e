// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/recording_file.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A log of another program as a CSV table, with the names that its program gives the numbers.
struct LogText {
  std::string csv;                 ///< header row and data rows
  std::vector<std::size_t> lines;  ///< line of the log that each line of `csv` was made from
  std::vector<std::string>
      notes;  ///< what else the log says, for a person, such as the gains of a controller
};

/// What a log is.
enum class LogKind {
  csv,         ///< a table, or nothing that is known
  klippy,      ///< `klippy.log` of Klipper
  marlin,      ///< serial log of Marlin, Prusa or a host program: `T:210.0 /210.0 @:64`
  json_lines,  ///< a JSON object in each line
  candump,     ///< frames of a CAN bus, as `candump -l` writes them
  sqlite_bag,  ///< a recording of ROS 2 in SQLite (`.db3`)
  numpy,       ///< arrays of numpy (`.npz`)
};

/// @brief What a file is, from its first bytes; a file that no reader here can read is named, with the lines of Python that convert it.
/// @throws InputError for such a file
LogKind kind_of_log(const std::string& path);

/// @brief The same on the first bytes of a file.
LogKind kind_of_log(const std::string& name, const char* bytes, std::size_t size);

/// @brief Makes a table of `klippy.log`: `<heater>.temp`, `.target` and `.pwm` from the lines `Stats`; the heaters' settings are notes.
LogText klippy_as_csv(const std::string& name, const std::string& text);

/// @brief Makes a table of the temperature reports of Marlin: `T`, `T_target`, `@` and so on; `time` where each line has a stamp.
LogText marlin_as_csv(const std::string& name, const std::string& text);

/// @brief Makes a table of JSON objects, one a line: `a.b[0]` is element 0 of member b of member a.
LogText json_lines_as_csv(const std::string& name, const std::string& text);

/// @brief Makes a table of the arrays of a `.npz` file that have one length: `x`, and `x[0]`, `x[1]` of a matrix.
LogText numpy_as_csv(const std::string& name, const std::string& bytes);

/// @brief Reads frames of a CAN bus. A choice's header says where a number stands: `141#A1.i16@4` is the signed 16-bit number at
/// byte 4 of the frames of identifier 141 that begin with A1; `i16be` is the other byte order; `u8 i8 u16 i16 u32 i32 f32`.
RecordingFile candump_as_recording(const std::string& name, const std::string& text,
                                   const std::vector<ColumnChoice>& choices);

/// @brief The fields of a CAN bus that change, as headers for `--column`, and in `about` which frames there are.
std::vector<ListedColumn> list_candump(const std::string& name, const std::string& text, std::string& about);

/// @brief All bytes of a file, `-` for standard input. @throws InputError
std::string all_bytes_of(const std::string& path);

/// @brief A row of a CSV file, quoted where it must be.
std::string csv_row(const std::vector<std::string>& cells);

/// @brief The shortest text that reads back as this number; empty for NaN.
std::string csv_number(double value);

}  // namespace thermopower::io
