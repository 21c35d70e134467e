// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Processes that do one task after the other, and what a death among them costs.

#include "../catch.hpp"

#include <worker_pool.hpp>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

namespace {

constexpr int a_minute_ms = 60000;

/// Has tasks done, and says what came of each; -1 where its worker died.
std::map<std::size_t, int> done(WorkerPool& pool, std::size_t count) {
  std::map<std::size_t, int> said;
  for (std::size_t next = 0; next < count || pool.busy() > 0;) {
    if (next < count && pool.has_room()) {
      pool.give(next++);
      continue;
    }
    const auto answer = pool.wait(a_minute_ms);
    REQUIRE(answer);
    REQUIRE(said.count(answer->task) == 0);
    said[answer->task] = answer->said ? static_cast<unsigned char>(*answer->said) : -1;
  }
  return said;
}

/// The process that a task runs in, in a byte that differs between neighbours.
char of_process() { return static_cast<char>(getpid() % 256); }

}  // namespace

TEST_CASE("Every task is done once, by any number of workers") {
  for (const std::size_t most : {1u, 2u, 5u}) {
    WorkerPool pool(most, [](std::size_t task) { return static_cast<char>(task % 251); });
    const auto said = done(pool, 500);
    REQUIRE(said.size() == 500);
    for (const auto& [task, byte] : said) CHECK(byte == static_cast<int>(task % 251));
  }
}

TEST_CASE("A worker takes several tasks, and is replaced after a hundred") {
  WorkerPool pool(1, [](std::size_t) { return of_process(); });
  const auto said = done(pool, 250);
  std::set<int> processes;
  for (const auto& [task, byte] : said) {
    CHECK(byte == said.at(task / 100 * 100));
    processes.insert(byte);
  }
  CHECK(processes.size() == 3);
}

TEST_CASE("A worker that dies costs the task in its hands, and no other") {
  for (const std::size_t most : {1u, 3u}) {
    WorkerPool pool(most, [](std::size_t task) -> char {
      if (task % 10 == 3) std::abort();
      if (task % 10 == 5) kill(getpid(), SIGKILL);
      if (task % 10 == 7) throw std::runtime_error("not to be");
      return 'd';
    });
    for (const auto& [task, byte] : done(pool, 60))
      CHECK(byte == (task % 10 == 3 || task % 10 == 5 || task % 10 == 7 ? -1 : 'd'));
  }
}

TEST_CASE("A worker that died between two tasks costs none") {
  int told[2];
  REQUIRE(pipe(told) == 0);
  WorkerPool pool(1, [&told](std::size_t) {
    const pid_t self = getpid();
    return write(told[1], &self, sizeof self) == sizeof self ? 'd' : 'x';
  });
  std::set<pid_t> processes;
  for (std::size_t task = 0; task < 3; ++task) {
    pool.give(task);
    const auto answer = pool.wait(a_minute_ms);
    REQUIRE(answer);
    CHECK(answer->said == 'd');
    pid_t worker = 0;
    REQUIRE(read(told[0], &worker, sizeof worker) == sizeof worker);
    processes.insert(worker);
    kill(worker, SIGKILL);
    siginfo_t how;
    REQUIRE(waitid(P_PID, static_cast<id_t>(worker), &how, WEXITED | WNOWAIT) == 0);
  }
  CHECK(processes.size() == 3);
  close(told[0]);
  close(told[1]);
}

TEST_CASE("A pool that goes waits for no task, and every worker ends") {
  int lines[2][2], alive[2];
  REQUIRE(pipe(lines[0]) == 0);
  REQUIRE(pipe(lines[1]) == 0);
  REQUIRE(pipe(alive) == 0);
  char byte = 'd';
  {
    WorkerPool pool(2, [&lines, &alive](std::size_t task) {
      char said = 'x';
      close(alive[0]);
      return read(lines[task][0], &said, 1) == 1 ? said : 'x';
    });
    pool.give(0);
    pool.give(1);
    CHECK_FALSE(pool.has_room());
    CHECK_FALSE(pool.wait(1));
    REQUIRE(write(lines[0][1], &byte, 1) == 1);
    const auto answer = pool.wait(a_minute_ms);
    REQUIRE(answer);
    CHECK(answer->task == 0);
  }  // were the idle worker's line in the other's hands, this would take until the other is done
  REQUIRE(write(lines[1][1], &byte, 1) == 1);
  close(alive[1]);
  CHECK(read(alive[0], &byte, 1) == 0);  // nobody is left who could write
  for (const int end : {lines[0][0], lines[0][1], lines[1][0], lines[1][1], alive[0]}) close(end);
}
