// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include <thermopower/gap/fit/in_parallel.hpp>

#include <stdexcept>
#include <string>
#include <vector>

using thermopower::gap::engine::in_parallel;

TEST_CASE("every piece of work is done once, by any number of threads") {
  for (unsigned threads : {0u, 1u, 2u, 7u, 200u}) {
    std::vector<int> done(1000, 0);
    in_parallel(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    CAPTURE(threads);
    CHECK(done == std::vector<int>(1000, 1));
  }
  in_parallel(0, 8, [](std::size_t) { FAIL("there is nothing to do"); });
}

TEST_CASE("what a piece of work throws reaches the caller: the first of them, by any number of threads") {
  for (unsigned threads : {1u, 2u, 7u, 200u}) {
    for (int round = 0; round < 20; ++round) {
      std::string caught;
      try {
        in_parallel(500, threads, [](std::size_t i) {
          if (i % 100 == 37) throw std::runtime_error(std::to_string(i));
        });
      } catch (const std::runtime_error& error) {
        caught = error.what();
      }
      CAPTURE(threads, round);
      CHECK(caught == "37");
    }
  }
}

TEST_CASE("work that throws everywhere ends, and leaves no thread behind") {
  for (unsigned threads : {1u, 3u, 64u})
    CHECK_THROWS_AS(in_parallel(10000, threads, [](std::size_t) { throw 1; }), int);
}
