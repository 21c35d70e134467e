// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// Whether there is enough to diagnose: data that can be believed, a dozen samples of some signal in either part, and a row that a
/// simulation can start from. Else says in `result` what is lacking.
/// @param horizon_s  over which simulations are judged
inline bool enough_data(Diagnosis& result, const Model& model, const std::vector<Inputs>& train,
                        const std::vector<Inputs>& held_out, double horizon_s) {
  if (const Finding* finding = deciding(result.findings)) {
    result.verdict = Verdict::insufficient;
    result.reason = "the data cannot be believed as they stand: " +
                    (finding->column.empty() ? "'" + finding->recording + "'" : finding->column) + " " +
                    finding->message;
    result.next_experiment = finding->mend;
    return false;
  }
  constexpr double least = 12.0;
  for (const auto* all : {&train, &held_out}) {
    double most = 0.0;
    for (int i = 0; i < signal_count; ++i) {
      double samples = 0.0;
      for (const Inputs& one : *all)
        if (one.judged(static_cast<Signal>(i)))
          samples += static_cast<double>(one.of(static_cast<Signal>(i)).array().isFinite().count());
      most = std::max(most, samples);
    }
    if (most < least) {
      result.verdict = Verdict::insufficient;
      result.reason = most == 0.0
                          ? "no signal of the model can be judged with the columns recorded"
                          : "fewer than 12 samples of every signal: too little data for any statement";
      return false;
    }
  }
  const auto can_start = [&](const std::vector<Inputs>& all) {
    return !cut(all, horizon_s, plant_of(model)).empty();
  };
  if (!can_start(train) || !can_start(held_out)) {
    result.verdict = Verdict::insufficient;
    result.reason =
        "no row has a reading of each signal that the model judges, so that no simulation can start there";
    return false;
  }
  return true;
}

}  // namespace thermopower::gap::engine
