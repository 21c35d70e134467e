// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// measure <name> <level> <source> ... -- <compiler> <flags...>: compiles each source once, at its level (such as -O2), and prints
// what it took.
// Processor seconds, not those on the wall: another program on the machine does not change them much.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <string>
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

struct Task {
  std::string name;
  std::string level;
  std::string source;
};

Cost cost_of(const std::vector<std::string>& compiler, const Task& task) {
  std::vector<std::string> words = compiler;
  for (const std::string& word :
       {task.level, std::string("-c"), task.source, std::string("-o"), std::string("/dev/null")})
    words.push_back(word);
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
  std::vector<Task> tasks;
  int at = 1;
  for (; at + 2 < count && std::strcmp(words[at], "--") != 0; at += 3)
    tasks.push_back({words[at], words[at + 1], words[at + 2]});
  const std::vector<std::string> compiler(words + (at < count ? at + 1 : at), words + count);
  if (tasks.empty() || compiler.empty()) {
    std::fputs("usage: measure <name> <level> <source> ... -- <compiler> <flags...>\n", stderr);
    return 2;
  }
  std::printf("| translation unit | level | s | MB |\n| --- | --- | --- | --- |\n");
  bool all = true;
  for (const Task& task : tasks) {
    const Cost cost = cost_of(compiler, task);
    std::printf("| %s | %s | %.1f | %.0f |\n", task.name.c_str(), task.level.c_str(), cost.seconds,
                cost.megabytes);
    std::fflush(stdout);
    all = all && cost.compiled;
  }
  return all ? 0 : 1;
}
