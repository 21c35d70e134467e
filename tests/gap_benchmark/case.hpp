// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "assess.hpp"
#include "recording.hpp"

namespace gap_benchmark {

/// What is asked of the generator for one case.
struct CaseOrder {
  bool axis = false, thesis = false;
  std::vector<std::string> effects;
  int unknown = 0;       ///< number of the cause outside the catalogue, 0 for none
  bool thorough = true;  ///< look for the best wrong cause, too
  bool clear = false;    ///< draw again, a few times, when a wrong cause passes for the true one
  double gate = 3.0;     ///< least RMS of the cause over the floor, in train and in held-out
  int replicates = 12;   ///< further held-out recordings for the shrinkage of the population
};

struct DrawnCase {
  nlohmann::ordered_json model, label;
  Recording train, heldout;
  Assessment assessment;
};

struct SquaredError {
  double sum = 0.0;
  std::size_t count = 0;

  void add(const std::vector<double>& simulated, const std::vector<double>& measured) {
    for (std::size_t k = 0; k < measured.size(); ++k)
      if (!std::isnan(measured[k])) add(simulated[k] - measured[k]);
  }
  void add(double error) {
    sum += error * error;
    ++count;
  }
  double rms() const { return count ? std::sqrt(sum / static_cast<double>(count)) : 0.0; }
};

using SquaredErrors = std::map<std::string, SquaredError>;

/// `floor` is what the true model scores on this very recording; `shrunk_population` is what it would achieve
/// over many held-out recordings of the same kind, which is what a confidence interval has to cover.
inline void write_gap(nlohmann::ordered_json& label, SquaredErrors& before, SquaredErrors& perfect,
                      SquaredErrors& all_before, SquaredErrors& all_perfect) {
  for (const auto& entry : before) {
    const std::string& signal = entry.first;
    label["gap"][signal] = {
        {"before", entry.second.rms()},
        {"floor", perfect[signal].rms()},
        {"shrunk_sample", 1.0 - perfect[signal].rms() / entry.second.rms()},
        {"shrunk_population", 1.0 - all_perfect[signal].rms() / all_before[signal].rms()}};
  }
}

}  // namespace gap_benchmark
