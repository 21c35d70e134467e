// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

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

/// Runs a fuzz target without libFuzzer: on its corpus, then on what a driver makes, for as long as the command line says:
/// <target> [seconds] [seed]
class FuzzLoop {
public:
  FuzzLoop(int count, char** values)
      : seconds_(count > 1 ? std::atof(values[1]) : 10.0),
        seed_(count > 2 ? std::strtoul(values[2], nullptr, 10) : 1),
        random_(static_cast<std::mt19937::result_type>(seed_)) {}

  /// What inputs are drawn from.
  std::mt19937& random() { return random_; }

  /// Runs the target on each file of the corpus as it is, and adds it to `inputs`, bytes or characters.
  template <class Input>
  void try_corpus(std::vector<Input>& inputs) {
    for (const auto& entry : std::filesystem::directory_iterator(THERMOPOWER_CORPUS)) {
      std::ifstream file(entry.path(), std::ios::binary);
      inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
      run_on(inputs.back());
      ++from_corpus_;
    }
  }

  /// Runs the target on one input of `make()` after another until the time is over. @return what main() returns
  /// @param least  inputs at least, so that a slow machine checks something too
  template <class Make>
  int run(unsigned long least, Make&& make) {
    if (from_corpus_ == 0) {
      std::fprintf(stderr, "there is nothing in " THERMOPOWER_CORPUS "\n");
      return 1;
    }
    const auto start = std::chrono::steady_clock::now();
    unsigned long runs = 0;
    for (; runs < least ||
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds_;
         ++runs)
      run_on(make());
    std::printf("%lu inputs and %lu of the corpus, seed %lu: all claims hold\n", runs, from_corpus_, seed_);
    return 0;
  }

private:
  template <class Input>
  static void run_on(const Input& input) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  }

  double seconds_;
  unsigned long seed_, from_corpus_ = 0;
  std::mt19937 random_;
};
