// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

/// One row of a manifest: a log, and how it is diagnosed.
struct ManifestLog {
  std::map<std::string, std::string> cells;  ///< by column: `log`, `model`, `unit`, `heldout`, `map`, `time`
  std::size_t line = 0;                      ///< in the manifest
  std::string id;                            ///< of its files, from what is diagnosed and how
  double time_days = std::numeric_limits<double>::quiet_NaN();  ///< of `time`; NaN where there is none

  /// A cell; empty where the manifest has no such column.
  const std::string& cell(const std::string& name) const;
};

/// Reads the table of logs. A log's `id` depends on all of its row, on the contents of its model and mapping, and on the
/// options; the same log twice is an error.
/// @throws io::InputError with file, line and column
std::vector<ManifestLog> read_manifest(const std::string& path, const std::vector<std::string>& options);

/// Days since 1970-01-01 of a date (`2026-03-01`, `2026-03-01T13:45`, with seconds or without) or a number of days; NaN
/// for what is neither.
double days_of(const std::string& text);
