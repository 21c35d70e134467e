// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "mcap_records.hpp"

#include <cstdio>
#include <memory>
#include <string>

namespace thermopower::io {

/// An open file, closed with it.
typedef std::unique_ptr<std::FILE, int (*)(std::FILE*)> OpenFile;

/// @brief A file, or standard input, as a source of bytes.
class FileSource {
public:
  /// @param path  `-` for standard input
  /// @throws InputError where it cannot be opened
  explicit FileSource(const std::string& path);
  /// For messages.
  const std::string& name() const { return name_; }
  /// Reads on. @throws InputError where the file cannot be read
  ByteSource function();

private:
  std::string name_;
  OpenFile file_;
};

/// Opens a file for reading, `-` for standard input. A pipe is waited for as long as somebody has it open for writing, and no
/// longer than a second or two where nobody has.
/// @param what  was expected, as in "a CSV file"
/// @throws InputError where it is a directory, cannot be opened, or is a pipe that nobody writes to
OpenFile open_input(const std::string& path, const std::string& what);

/// Bytes in memory as a source.
ByteSource memory_source(const char* bytes, std::size_t size);

/// The first byte of a file (`-`: of standard input, where it stays to be read); -1 where there is none.
int first_byte_of(const std::string& path);

/// Whether a plain file begins with these bytes; a pipe or standard input is not asked.
bool begins_with(const std::string& path, const std::string& bytes);

}  // namespace thermopower::io
