// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "worker_pool.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

namespace {

// After so many a worker is replaced, so that what tasks leave in its memory does not add up. To start one costs a
// large process some milliseconds.
constexpr std::size_t most_tasks_of_one = 100;

// No signal where the other side is gone: false says so.
bool tell(int line, const void* what, std::size_t size) {
  const char* next = static_cast<const char*>(what);
  while (size > 0) {
    const ssize_t n = send(line, next, size, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    next += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

bool hear(int line, void* what, std::size_t size) {
  char* next = static_cast<char*>(what);
  while (size > 0) {
    const ssize_t n = recv(line, next, size, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    next += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

void wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace

WorkerPool::~WorkerPool() {
  for (const Worker& one : workers_) close(one.line);
  for (const Worker& one : workers_)
    if (!one.has_task) wait_for(one.process);
}

std::size_t WorkerPool::busy() const {
  return static_cast<std::size_t>(
      std::count_if(workers_.begin(), workers_.end(), [](const Worker& one) { return one.has_task; }));
}

WorkerPool::Worker WorkerPool::start() const {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "a worker cannot be started");
  std::fflush(nullptr);  // or it would be written twice
  Worker worker;
  worker.process = fork();
  if (worker.process == 0) {
    // Whoever holds an end of another's line would keep it open beyond this process's death.
    for (const Worker& other : workers_) close(other.line);
    close(ends[0]);
    serve(ends[1]);
  }
  const int fault = errno;
  close(ends[1]);
  if (worker.process < 0) {
    close(ends[0]);
    throw std::system_error(fault, std::generic_category(), "a worker cannot be started");
  }
  worker.line = ends[0];
  return worker;
}

// In the worker, which has nothing to say to a terminal. It goes when its line is closed, be it by the death of the
// process at the other end.
void WorkerPool::serve(int line) const {
  std::signal(SIGINT, SIG_DFL);  // of Python, it would only be noted
  const int nothing = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
  if (nothing > STDERR_FILENO) close(nothing);
  std::size_t task = 0;
  try {
    while (hear(line, &task, sizeof task)) {
      const char said = work_(task);
      if (!tell(line, &said, sizeof said)) break;
    }
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

void WorkerPool::dismiss(std::size_t which) {
  close(workers_[which].line);
  wait_for(workers_[which].process);
  workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(which));
}

void WorkerPool::give(std::size_t task) {
  for (;;) {
    auto found =
        std::find_if(workers_.begin(), workers_.end(), [](const Worker& one) { return !one.has_task; });
    if (found == workers_.end()) found = workers_.insert(found, start());
    if (!tell(found->line, &task, sizeof task)) {  // it died with nothing in its hands
      dismiss(static_cast<std::size_t>(found - workers_.begin()));
      continue;
    }
    found->task = task;
    found->has_task = true;
    ++found->given;
    found->began = std::chrono::steady_clock::now();
    return;
  }
}

std::optional<WorkerPool::Answer> WorkerPool::wait(int most_ms) {
  std::vector<pollfd> lines;
  std::vector<std::size_t> whose;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    if (!workers_[i].has_task) continue;
    lines.push_back({workers_[i].line, POLLIN, 0});
    whose.push_back(i);
  }
  const int ready = poll(lines.data(), lines.size(), most_ms);
  if (ready < 0 && errno != EINTR)
    throw std::system_error(errno, std::generic_category(), "workers cannot be waited for");
  if (ready <= 0) return std::nullopt;
  const auto first =
      std::find_if(lines.begin(), lines.end(), [](const pollfd& one) { return one.revents != 0; });
  const std::size_t which = whose[static_cast<std::size_t>(first - lines.begin())];
  Worker& worker = workers_[which];
  Answer answer;
  answer.task = worker.task;
  char said = 0;
  if (hear(worker.line, &said, sizeof said)) answer.said = said;
  worker.has_task = false;
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - worker.began).count();
  if (!answer.said || worker.given >= most_tasks_of_one) dismiss(which);
  return answer;
}
