// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace thermopower::gap::engine {

/// Threads that one piece of work is spread over at most: beyond, starting them costs more than they do.
inline constexpr std::size_t most_threads = 1024;

/// Runs `work(i)` for i in [0, count) on some threads, this one among them. Each i writes only to its own place, so that
/// the result does not depend on the number of threads. Where the system grants fewer threads, fewer do the work.
///
/// An exception ends the work as soon as the calls under way have ended, and is thrown here. It is that of the smallest i
/// that threw, whatever the number of threads.
inline void in_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t i)>& work) {
  if (threads <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::size_t failed_at = count;
  std::exception_ptr failure;
  const auto take_part = [&]() noexcept {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        // Every smaller i has been begun by now: it may still throw, and then counts instead.
        next = count;
        const std::lock_guard<std::mutex> lock(mutex);
        if (i < failed_at) failed_at = i, failure = std::current_exception();
      }
  };
  std::vector<std::thread> pool;
  const std::size_t helpers = std::min({static_cast<std::size_t>(threads), count, most_threads}) - 1;
  pool.reserve(helpers);
  try {
    while (pool.size() < helpers) pool.emplace_back(take_part);
  } catch (const std::system_error&) {
    // No more threads to be had: those that are here do it.
  }
  take_part();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace thermopower::gap::engine
