// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

/// Processes that do one task after the other. A process that dies costs the task in its hands, which is told, and the
/// next task finds a fresh process. This process must have no other threads.
class WorkerPool {
public:
  /// Does a task in a worker, and says in a byte what came of it. It must not throw: then its worker dies.
  using Work = std::function<char(std::size_t task)>;

  /// What became of a task.
  struct Answer {
    std::size_t task = 0;      ///< as it was given
    std::optional<char> said;  ///< what the work said; none: its worker died
    double seconds = 0.0;      ///< from the task being given to this
  };

  /// @param most  workers at a time, >= 1; each is started when a task needs it
  /// @param work  what they do. They see memory as it is when they are started
  WorkerPool(std::size_t most, Work work) : most_(most), work_(std::move(work)) {}

  /// Dismisses the workers: who has a task in hand ends it first, and is not waited for.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Tasks in hand.
  std::size_t busy() const;

  /// Whether a worker is free, or may be started.
  bool has_room() const { return busy() < most_; }

  /// Gives a task to a free worker. Only where there is room.
  /// @throws std::system_error where no process can be started
  void give(std::size_t task);

  /// Waits for the next answer; none where the time is over. @param most_ms  -1: as long as it takes
  std::optional<Answer> wait(int most_ms);

private:
  struct Worker {
    pid_t process = 0;
    int line = -1;  // to it and from it
    bool has_task = false;
    std::size_t task = 0, given = 0;
    std::chrono::steady_clock::time_point began;
  };

  Worker start() const;
  [[noreturn]] void serve(int line) const;
  void dismiss(std::size_t which);

  std::size_t most_;
  Work work_;
  std::vector<Worker> workers_;
};
