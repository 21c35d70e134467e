// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/csv_table.hpp>

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/io/names.hpp>

#include <string>
#include <utility>
#include <vector>

namespace thermopower::io {

/// @brief Columns whose meaning is fixed and which must be numeric; any other numeric column is a covariate.
const std::vector<std::string>& known_columns();

/// @brief A recording and what was noticed while reading it (columns left out, a file that may have been cut
/// off).
struct RecordingFile {
  Recording recording;            ///< what was read
  std::vector<Finding> findings;  ///< notes of the reader; the check of the data makes others
};

/// @brief What a file does not say of itself.
struct ReadOptions {
  std::vector<ColumnChoice> choices = {};  ///< columns that go by another name or unit in the file
  double rows_per_s = 0.0;                 ///< of a CSV file without time; 0: it has one
  std::vector<std::pair<std::string, double>> constants =
      {};  ///< columns that the file lacks and that did not change, such as `ambient_C`
  double torque_constant_Nm_per_A = 0.0;  ///< of the model, for a torque of the drive; 0: unknown
  double nominal_V = 0.0;  ///< of the model, for a duty where no supply is recorded; 0: unknown
};

/// @brief Options with what a model says.
ReadOptions read_options(const gap::Model& model, std::vector<ColumnChoice> choices = {});

/// @brief Reads a recording, whichever kind its first bytes say it is: CSV, MCAP, rosbag2 (`.db3`), a capture of a SimpleBGC board,
/// `klippy.log`, a serial log of Marlin, JSON lines, `candump -l`, or `.npz`.
/// @throws InputError, see read_csv(), read_mcap() and read_sbgc_capture(); a kind that is not read is named, with the lines of Python
/// that convert it
RecordingFile read_recording(const std::string& path, const ReadOptions& options);

/// @brief The same with nothing but columns.
RecordingFile read_recording(const std::string& path, const std::vector<ColumnChoice>& choices = {});

/// @brief The same from a table already in memory.
RecordingFile to_recording(CsvTable table);

}  // namespace thermopower::io
