// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// measure <name> <source> <name> <source> ... -- <compiler> <flags...>: compiles each source once and prints what it took.
// Processor seconds, not those on the wall: another program on the machine does not change them much.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace {

struct Cost {
  double seconds = 0.0;
  double megabytes = 0.0;
  bool compiled = false;
};

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

Cost cost_of(const std::vector<std::string>& compiler, const std::string& source) {
  std::vector<std::string> words = compiler;
  for (const char* word : {"-c", source.c_str(), "-o", "/dev/null"}) words.push_back(word);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    execvp(arguments[0], arguments.data());
    std::perror(arguments[0]);
    _exit(127);
  }
  int status = 0;
  rusage used{};
  // The compiler proper is a child of the driver; what a child has waited for counts as its own.
  if (child < 0 || wait4(child, &status, 0, &used) != child) return {};
  return {seconds_of(used.ru_utime) + seconds_of(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024.0,
          WIFEXITED(status) && WEXITSTATUS(status) == 0};
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::pair<std::string, std::string>> sources;
  int at = 1;
  for (; at + 1 < count && std::strcmp(words[at], "--") != 0; at += 2)
    sources.emplace_back(words[at], words[at + 1]);
  const std::vector<std::string> compiler(words + (at < count ? at + 1 : at), words + count);
  if (sources.empty() || compiler.empty()) {
    std::fputs("usage: measure <name> <source> ... -- <compiler> <flags...>\n", stderr);
    return 2;
  }
  std::printf("| translation unit | s | MB |\n| --- | --- | --- |\n");
  bool all = true;
  for (const auto& [name, source] : sources) {
    const Cost cost = cost_of(compiler, source);
    std::printf("| %s | %.1f | %.0f |\n", name.c_str(), cost.seconds, cost.megabytes);
    std::fflush(stdout);
    all = all && cost.compiled;
  }
  return all ? 0 : 1;
}
