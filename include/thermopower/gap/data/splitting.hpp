// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace thermopower::gap {

/// Takes the last part of a recording away as held-out data.
///
/// Whole excitation segments are held out: the last runs where there are several, else the rows from the change of
/// excitation (a step of `power_param`, or of a heater's `target_C`) that is nearest to the wanted fraction, looked
/// for within a tenth of the rows; never interleaved samples.
inline std::pair<Recording, Recording> split(const Recording& recording, double held_out_fraction) {
  const Eigen::Index rows = recording.rows();
  const Eigen::Index wanted =
      static_cast<Eigen::Index>((1.0 - held_out_fraction) * static_cast<double>(rows));
  Eigen::Index at = wanted;
  const Eigen::Index reach = rows / 10;
  for (const RunSpan& run : recording.spans())
    if (run.begin > 0 && std::abs(run.begin - wanted) <= 2 * reach &&
        std::abs(run.begin - wanted) < std::abs(at - wanted) + (at == wanted ? 2 * reach : 0))
      at = run.begin;
  const Eigen::VectorXd* excitation = recording.find("power_param");
  if (excitation == nullptr) excitation = recording.find("target_C");
  const auto steps_at = [&](Eigen::Index row) {
    if (row <= 0 || row >= rows) return false;
    const double step = (*excitation)[row] - (*excitation)[row - 1];
    return std::isfinite(step) && step != 0.0;
  };
  for (Eigen::Index offset = 0; at == wanted && excitation != nullptr && offset <= reach; ++offset)
    for (const Eigen::Index row : {wanted + offset, wanted - offset})
      if (steps_at(row)) return {recording.slice(0, row), recording.slice(row, rows)};
  return {recording.slice(0, at), recording.slice(at, rows)};
}

}  // namespace thermopower::gap
