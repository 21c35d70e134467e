// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "mcap_records.hpp"

#include <cstdio>
#include <memory>
#include <string>

namespace thermopower::io {

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
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// Bytes in memory as a source.
ByteSource memory_source(const char* bytes, std::size_t size);

/// The first byte of a file (`-`: of standard input, where it stays to be read); -1 where there is none.
int first_byte_of(const std::string& path);

}  // namespace thermopower::io
