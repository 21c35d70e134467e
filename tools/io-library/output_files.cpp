// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/output_files.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace thermopower::io {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code status;
  const bool lacks_folder = error == ENOENT && !folder.empty() && !std::filesystem::exists(folder, status);
  throw OutputError(path + ": cannot be written: " +
                    (lacks_folder ? "there is no folder " + folder.string() + "; make it first"
                                  : std::string(std::strerror(error))));
}

// `-` is standard output, as it is standard input where a file is read.
bool is_special(const std::string& path) {
  if (path == "-") return true;
  struct stat status {};
  return stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

// A link is followed, so that the file it points at is replaced and not the link.
std::string resolve(const std::string& path) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(path, error);
  return error ? path : real.string();
}

struct Temporary {
  std::string name;
  int descriptor = -1;
};

Temporary open_beside(const std::string& path) {
  Temporary temporary;
  temporary.name = resolve(path) + ".XXXXXX";
  temporary.descriptor = mkstemp(temporary.name.data());
  if (temporary.descriptor < 0) fail(path, errno);
  return temporary;
}

void write_all(int descriptor, const std::string& contents, const std::string& path) {
  std::size_t done = 0;
  while (done < contents.size()) {
    const ssize_t n = write(descriptor, contents.data() + done, contents.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(path, errno);
    done += static_cast<std::size_t>(n);
  }
}

void write_through(const std::string& path, const std::string& contents) {
  if (path == "-") {
    write_all(STDOUT_FILENO, contents, "standard output");
    return;
  }
  const int descriptor = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, errno);
  try {
    write_all(descriptor, contents, path);
  } catch (...) {
    close(descriptor);
    throw;
  }
  if (close(descriptor) != 0) fail(path, errno);
}

// mkstemp makes files private; an output should have the rights any new file gets, or those of the file it
// replaces.
mode_t rights_for(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return status.st_mode & 0777;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

void OutputFiles::expect(const std::string& path) {
  if (path == "-") return;
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail(path, EISDIR);
  if (is_special(path)) {
    if (access(path.c_str(), W_OK) != 0) fail(path, errno);
    return;
  }
  if (access(path.c_str(), F_OK) == 0 && access(path.c_str(), W_OK) != 0) fail(path, errno);
  const Temporary probe = open_beside(path);
  close(probe.descriptor);
  unlink(probe.name.c_str());
}

void OutputFiles::put(const std::string& path, std::string contents) {
  files_.emplace_back(path, std::move(contents));
}

void OutputFiles::commit() {
  std::vector<std::pair<std::string, std::string>> pending;  // temporary, target
  try {
    for (const auto& [path, contents] : files_) {
      if (is_special(path)) continue;
      Temporary temporary = open_beside(path);
      pending.emplace_back(temporary.name, resolve(path));
      try {
        write_all(temporary.descriptor, contents, path);
        if (fchmod(temporary.descriptor, rights_for(path)) != 0 || fsync(temporary.descriptor) != 0)
          fail(path, errno);
      } catch (...) {
        close(temporary.descriptor);
        throw;
      }
      if (close(temporary.descriptor) != 0) fail(path, errno);
    }
    // What cannot be taken back comes before what cannot fail any more.
    for (const auto& [path, contents] : files_)
      if (is_special(path)) write_through(path, contents);
    while (!pending.empty()) {
      if (std::rename(pending.front().first.c_str(), pending.front().second.c_str()) != 0)
        fail(pending.front().second, errno);
      pending.erase(pending.begin());
    }
  } catch (...) {
    for (const auto& [temporary, target] : pending) unlink(temporary.c_str());
    throw;
  }
}

}  // namespace thermopower::io
