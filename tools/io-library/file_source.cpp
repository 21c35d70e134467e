// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "file_source.hpp"

#include <thermopower/io/input_error.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <thread>

namespace thermopower::io {
namespace {

int leave_open(std::FILE*) { return 0; }

// Opens a pipe that has a name. To open one that nobody writes to would wait for ever.
std::FILE* open_pipe(const std::string& path) {
  constexpr int longest_ms = 2000, step_ms = 20;  // for a writer that is about to begin
  const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  char byte = 0;
  ssize_t got = 0;  // none: nobody writes; less: somebody has not yet
  for (int waited_ms = 0; got == 0 && waited_ms < longest_ms; waited_ms += step_ms) {
    got = read(descriptor, &byte, 1);
    if (got == 0) std::this_thread::sleep_for(std::chrono::milliseconds(step_ms));
  }
  if (got == 0) {
    close(descriptor);
    throw InputError(path + ": is a pipe that nobody writes to");
  }
  fcntl(descriptor, F_SETFL, fcntl(descriptor, F_GETFL) & ~O_NONBLOCK);
  std::FILE* const file = fdopen(descriptor, "rb");
  if (file == nullptr) close(descriptor);
  else if (got > 0) std::ungetc(static_cast<unsigned char>(byte), file);
  return file;
}

}  // namespace

OpenFile open_input(const std::string& path, const std::string& what) {
  if (path == "-") return OpenFile(stdin, &leave_open);
  std::error_code status;
  if (std::filesystem::is_directory(path, status))
    throw InputError(path + ": is a directory; expected " + what);
  OpenFile file(std::filesystem::is_fifo(path, status) ? open_pipe(path) : std::fopen(path.c_str(), "rb"),
                &std::fclose);
  if (!file) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  return file;
}

FileSource::FileSource(const std::string& path)
    : name_(path == "-" ? "standard input" : path), file_(open_input(path, "a file")) {}

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

bool begins_with(const std::string& path, const std::string& bytes) {
  std::error_code status;
  if (path == "-" || !std::filesystem::is_regular_file(path, status)) return false;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  std::string head(bytes.size(), '\0');
  return file && std::fread(&head[0], 1, head.size(), file.get()) == head.size() && head == bytes;
}

}  // namespace thermopower::io
