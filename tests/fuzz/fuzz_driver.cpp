// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Runs a fuzz target on its corpus and on mutations of it, for builds without libFuzzer: <target> [seconds]
// [seed]

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "fuzz_loop.hpp"

/// Well-formed inputs to start from, and pieces that such inputs are made of.
std::vector<std::string> fuzz_seeds();
std::vector<std::string> fuzz_pieces();

int main(int count, char** values) {
  FuzzLoop loop(count, values);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(loop.random()()) % std::max<std::size_t>(n, 1);
  };
  // What is in the corpus is a seed as well.
  std::vector<std::string> seeds = fuzz_seeds();
  loop.try_corpus(seeds);
  const std::vector<std::string> pieces = fuzz_pieces();
  return loop.run(500, [&] {
    std::string input = seeds[below(seeds.size())];
    for (std::size_t changes = below(6); changes > 0; --changes) {
      const std::size_t at = below(input.size() + 1);
      switch (below(5)) {
        case 0:
          input.insert(at, pieces[below(pieces.size())]);
          break;
        case 1:
          input.erase(at, below(12));
          break;
        case 2:
          if (at < input.size()) input[at] = static_cast<char>(loop.random()());
          break;
        case 3:
          input.resize(at);
          break;
        default:
          input.insert(at, input.substr(below(input.size()), below(40)));
          break;
      }
    }
    return input;
  });
}
