// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Runs a fuzz target on random inputs, for builds without libFuzzer: sbgc_fuzz [seconds] [seed]

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "fuzz_loop.hpp"

int main(int argc, char** argv) {
  FuzzLoop loop(argc, argv);
  std::mt19937& random = loop.random();
  std::vector<std::vector<std::uint8_t>> corpus;
  loop.try_corpus(corpus);
  return loop.run(200, [&] {
    std::vector<std::uint8_t> input(random() % 600);
    const bool narrow = random() % 2 == 0;  // few values: many starts, short frames, coincidences
    static const std::uint8_t likely[] = {0, 1, 2, 3, 4, 5, 7, 8, 9, 25, 0x24, 0x3E};
    for (std::uint8_t& byte : input)
      byte = narrow ? likely[random() % sizeof(likely)] : static_cast<std::uint8_t>(random());
    if (random() % 3 == 0) {  // one of the corpus, with something else in its middle
      const std::vector<std::uint8_t>& known = corpus[random() % corpus.size()];
      input.resize(input.size() % 20);
      input.insert(input.end(), known.begin(), known.end());
      std::rotate(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(random() % (input.size() + 1)),
                  input.end());
    }
    return input;
  });
}
