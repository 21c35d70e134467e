// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::io {

/// @brief An output cannot be written: no such directory, no permission, disk full. Exit status 3.
class OutputError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// @brief The output files of one run of a program: all appear complete, or none does.
///
/// Each file is written under a temporary name in its own directory. All are renamed once every one is complete on disk.
/// Until then an older file of that name stays as it was. Special files (a pipe, /dev/stdout) are written straight through,
/// and `-` is standard output.
///
/// @snippet 10_own_effect/own_effect.cpp writing files
/// How to: @ref diagnose_a_gap, @ref gap_files.
class OutputFiles {
public:
  /// @brief Announces a file and finds out at once whether it can be written, so that a long computation is
  /// not lost at its end.
  /// @throws OutputError when its directory is missing or not writable, or the path names a directory
  void expect(const std::string& path);

  /// @brief Sets the contents of a file. Nothing is written before commit().
  void put(const std::string& path, std::string contents);

  /// @brief Writes every file under a temporary name, special files straight through, then renames them all.
  /// @throws OutputError; then no file has changed and no temporary file is left
  void commit();

private:
  std::vector<std::pair<std::string, std::string>> files_;
};

}  // namespace thermopower::io
