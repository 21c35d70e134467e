// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

/// Tells a person at a terminal what takes so long; silent for the first second, and when nobody watches.
class Progress {
public:
  Progress() {
    if (isatty(STDERR_FILENO) != 0) thread_ = std::thread([this] { run(); });
  }
  ~Progress() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      done_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void stage(const char* name) { stage_ = name; }

private:
  void run() {
    const auto begin = std::chrono::steady_clock::now();
    bool shown = false;
    std::unique_lock<std::mutex> lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::milliseconds(250), [this] { return done_; })) {
      const double elapsed_s =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      if (elapsed_s < 1.0) continue;
      std::fprintf(stderr, "\r\033[K%s ... %.0f s", stage_.load(), elapsed_s);
      shown = true;
    }
    if (shown) std::fprintf(stderr, "\r\033[K");
  }

  std::atomic<const char*> stage_{"reading the files"};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};
