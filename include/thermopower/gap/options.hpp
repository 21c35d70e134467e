// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace thermopower::gap {

/// Thrown by a diagnosis that was told to stop (Options::stop).
class Stopped : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Is told when a stage of a diagnosis begins, in words for who waits: "weighing causes". The words live as long as the program.
using StageListener = std::function<void(const char*)>;

/// Options of a diagnosis.
struct Options {
  double horizon_s = 0.5;            ///< length of the axis' windows in s, > 0
  double tolerance = 0.05;           ///< smallest relative shrinkage of the score that counts, 0..0.5
  double held_out_fraction = 0.3;    ///< held out where no recording is given for it, 0.05..0.9
  int effects_at_once = 3;           ///< the largest set of effects weighed together, 1..3
  std::vector<std::string> without;  ///< ids removed from the catalogue
  bool as_recorded = false;          ///< the check reports faults of the data, but masks and cuts nothing
  unsigned threads = 1;  ///< 1 or more, of which at most 1024 are used; the result does not depend on it
  unsigned seed = 1;     ///< of the bootstrap; equal seeds give equal reports
  /// Where another thread sets it, the diagnosis soon ends by throwing Stopped. None: nobody may.
  const std::atomic<bool>* stop = nullptr;
  StageListener at_stage;  ///< is told of each stage; none: nobody is

  /// @throws InvalidInput naming the first option that is out of its range
  void validate() const {
    const auto text = [](double value) {
      char digits[32];
      std::snprintf(digits, sizeof digits, "%g", value);
      return std::string(digits);
    };
    const auto within = [&text](double value, double low, double high, const char* name) {
      if (!(value >= low && value <= high))
        throw InvalidInput("option " + std::string(name) + " is " + text(value) + ", expected " + text(low) +
                           " to " + text(high));
    };
    within(horizon_s, 1e-6, 1e9, "horizon_s");
    within(tolerance, 0.0, 0.5, "tolerance");
    within(held_out_fraction, 0.05, 0.9, "held_out_fraction");
    within(effects_at_once, 1, 3, "effects_at_once");
    within(threads, 1, 1e9, "threads");
  }
};

}  // namespace thermopower::gap
