// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/io/csv_table.hpp>
#include <thermopower/io/names.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace thermopower::io {

/// @brief A column of a stream.
struct StreamColumn {
  std::string name;            ///< of the format
  std::vector<double> values;  ///< one per time; NaN where missing
};

/// @brief Samples that came together: the messages of one topic, or the frames of one kind.
struct Stream {
  std::string name;                   ///< for messages
  std::vector<std::int64_t> time_ns;  ///< of each sample, on a clock that all streams share; in any order
  std::vector<StreamColumn> columns;  ///< what is in them
};

/// @brief Joins streams on one time base: a row at each time at which any of them has a sample, what is measured only in the
/// rows of its own samples, all else held from sample to sample. Rows before the first sample of anything that is held are left
/// out. Time is counted from the first row that is kept.
/// @param file  for messages
/// @param findings  what was noticed on the way
/// @return a table without rows where the streams never overlap
CsvTable join_streams(const std::string& file, std::vector<Stream> streams, std::vector<Finding>& findings);

/// @brief Whether a column has samples (what is measured) and is not held (what drives).
bool is_measured(const std::string& column);

}  // namespace thermopower::io
