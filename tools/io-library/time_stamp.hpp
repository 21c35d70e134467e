// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace thermopower::io {

/// @brief A date with its time, or a time of day.
struct TimeStamp {
  std::int64_t ns = 0;    ///< since 1970 in UTC (a date without a zone counts as UTC), or since midnight
  bool has_date = false;  ///< a date stands before the time
};

/// @brief Reads a date and time (`2026-01-02T03:04:05.678Z`, `2026-01-02 03:04:05,678+01:00`, `2026/01/02 03:04`, `02.01.2026 03:04:05`), a
/// date, or a time of day (`03:04:05.678`). Month before day is not read: nobody can tell.
/// @return nothing where the text is none of these
std::optional<TimeStamp> parse_time_stamp(const char* text, std::size_t size);

}  // namespace thermopower::io
