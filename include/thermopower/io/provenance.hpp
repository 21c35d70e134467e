// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/io/names.hpp>

#include <string>
#include <vector>

namespace thermopower::io {

/// @brief What a report was made of, for whoever finds it in a year.
struct Provenance {
  std::string model;                    ///< path of the model file; empty: not told
  std::vector<std::string> recordings;  ///< paths of the recordings to find and fit on
  std::vector<std::string> held_out;    ///< paths of those to judge on; empty: a part of each recording
  std::vector<std::string> options;     ///< as typed, one each, such as `--horizon 0.2`
  std::string date;                     ///< such as `2026-03-01`; empty: not told
};

/// @brief Whether there is anything to tell.
inline bool is_told(const Provenance& made_of) {
  return !made_of.model.empty() || !made_of.recordings.empty() || !made_of.date.empty();
}

/// @brief Today as Provenance tells it (UTC), or the day of the environment's SOURCE_DATE_EPOCH.
std::string today();

/// @brief The version of the library: "0.1.0".
std::string version_text();

/// @brief A path as others may see it: of an absolute one the file's name.
std::string path_for_others(const std::string& path);

/// @brief The same as one line: model, recordings, options, version and date. Of many files the first ones are named. Empty where
/// nothing is told.
std::string provenance_line(const Provenance& made_of);

}  // namespace thermopower::io
