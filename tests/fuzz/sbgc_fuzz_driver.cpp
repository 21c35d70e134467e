// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Runs a fuzz target on random inputs, for builds without libFuzzer: sbgc_fuzz [seconds] [seed]

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 10.0;
  const unsigned long seed = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1;
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  std::vector<std::vector<std::uint8_t>> corpus;
  for (const auto& entry : std::filesystem::directory_iterator(THERMOPOWER_CORPUS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    LLVMFuzzerTestOneInput(corpus.back().data(), corpus.back().size());
  }
  if (corpus.empty()) {
    std::fprintf(stderr, "there is nothing in " THERMOPOWER_CORPUS "\n");
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  unsigned long runs = 0;
  // A fixed number of inputs at least, so that a slow machine checks something too.
  while (runs < 200 ||
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
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
    LLVMFuzzerTestOneInput(input.data(), input.size());
    ++runs;
  }
  std::printf("%lu inputs and %lu of the corpus, seed %lu: all claims hold\n", runs,
              static_cast<unsigned long>(corpus.size()), seed);
  return 0;
}
