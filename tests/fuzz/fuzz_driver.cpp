// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Runs a fuzz target on its corpus and on mutations of it, for builds without libFuzzer: <target> [seconds]
// [seed]

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// Well-formed inputs to start from, and pieces that such inputs are made of.
std::vector<std::string> fuzz_seeds();
std::vector<std::string> fuzz_pieces();

int main(int count, char** values) {
  const double seconds = count > 1 ? std::atof(values[1]) : 10.0;
  std::mt19937 random(count > 2 ? static_cast<unsigned>(std::strtoul(values[2], nullptr, 10)) : 1u);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random()) % std::max<std::size_t>(n, 1);
  };
  // What is in the corpus first, as it is; each of it then is a seed.
  std::vector<std::string> seeds = fuzz_seeds();
  const std::vector<std::string> pieces = fuzz_pieces();
  std::size_t from_corpus = 0;
  for (const auto& entry : std::filesystem::directory_iterator(THERMOPOWER_CORPUS)) {
    std::ifstream file(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    seeds.push_back(text.str());
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(seeds.back().data()), seeds.back().size());
    ++from_corpus;
  }
  if (from_corpus == 0) {
    std::fprintf(stderr, "there is nothing in " THERMOPOWER_CORPUS "\n");
    return 1;
  }
  const auto start = std::chrono::steady_clock::now();
  unsigned long runs = 0;
  // A fixed number of inputs at least, so that a slow machine checks something too.
  while (runs < 500 ||
         std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds) {
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
          if (at < input.size()) input[at] = static_cast<char>(random());
          break;
        case 3:
          input.resize(at);
          break;
        default:
          input.insert(at, input.substr(below(input.size()), below(40)));
          break;
      }
    }
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    ++runs;
  }
  std::printf("%lu inputs, and %lu of the corpus: all claims hold\n", runs,
              static_cast<unsigned long>(from_corpus));
  return 0;
}
