// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/data/experiment.hpp>
#include <thermopower/gap/detail/unit_check.hpp>
#include <thermopower/plant/inline.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

THERMOPOWER_GAP_INLINE CheckedRecordings check(const Model& model, const std::vector<Recording>& train,
                                               const std::vector<Recording>& held_out,
                                               const CheckOptions& options, const Catalogue& catalogue) {
  CheckedRecordings result;
  std::vector<Finding> others;
  const auto take = [&](const std::vector<Recording>& recordings, std::vector<PreparedRecording>& to) {
    for (const Recording& one : recordings) {
      to.emplace_back(model, one, options.as_recorded);
      const std::vector<Finding>& own = to.back().findings();
      others.insert(others.end(), own.begin(), own.end());
      for (Finding& finding : check_units(model, one, to.back(), catalogue))
        others.push_back(std::move(finding));
    }
  };
  take(train, result.train);
  take(held_out, result.held_out);
  for (Finding& finding : check_experiment(result.train, result.held_out, options.horizon_s))
    others.push_back(std::move(finding));
  // A horizon or a rest that does not fit says nothing of its own where the unit of a column is wrong.
  const auto rank = [](const Finding& one) {
    const bool unit = one.kind == FindingKind::wrong_unit || one.kind == FindingKind::wrong_sign ||
                      one.kind == FindingKind::swapped_columns;
    return one.severity != Severity::error ? 2 : unit ? 0 : 1;
  };
  std::stable_sort(others.begin(), others.end(),
                   [&](const Finding& a, const Finding& b) { return rank(a) < rank(b); });
  result.findings = std::move(others);
  return result;
}

}  // namespace thermopower::gap::engine
