// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/csv_table.hpp>

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/io/names.hpp>

#include <string>
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

/// @brief Reads a recording from a CSV file, an MCAP file or a capture of a SimpleBGC board's serial line, whichever it begins
/// like. @throws InputError, see read_csv(), read_mcap() and read_sbgc_capture()
/// @param choices columns that go by another name or unit in the file
RecordingFile read_recording(const std::string& path, const std::vector<ColumnChoice>& choices = {});

/// @brief The same from a table already in memory.
RecordingFile to_recording(CsvTable table);

}  // namespace thermopower::io
