// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "file_source.hpp"

#include <thermopower/io/input_error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace thermopower::io {
namespace {

int leave_open(std::FILE*) { return 0; }

}  // namespace

FileSource::FileSource(const std::string& path)
    : name_(path == "-" ? "standard input" : path),
      file_(path == "-" ? stdin : std::fopen(path.c_str(), "rb"), path == "-" ? &leave_open : &std::fclose) {
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    throw InputError(path + ": is a directory; expected a file");
  if (!file_) throw InputError(path + ": cannot be read: " + std::strerror(errno));
}

ByteSource FileSource::function() {
  return [this](unsigned char* to, std::size_t size) {
    const std::size_t got = std::fread(to, 1, size, file_.get());
    if (got < size && std::ferror(file_.get()) != 0)
      throw InputError(name_ + ": cannot be read: " + std::strerror(errno));
    return got;
  };
}

ByteSource memory_source(const char* bytes, std::size_t size) {
  return [bytes, size](unsigned char* to, std::size_t count) mutable {
    const std::size_t got = std::min(count, size);
    std::copy_n(bytes, got, reinterpret_cast<char*>(to));
    bytes += got;
    size -= got;
    return got;
  };
}

int first_byte_of(const std::string& path) {
  std::error_code status;
  // What is no plain file gives a byte once.
  if (path != "-" && !std::filesystem::is_regular_file(path, status)) return -1;
  std::FILE* const file = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
  if (file == nullptr) return -1;
  const int byte = std::getc(file);
  if (path == "-" && byte != EOF) std::ungetc(byte, file);
  if (path != "-") std::fclose(file);
  return byte == EOF ? -1 : byte;
}

}  // namespace thermopower::io
