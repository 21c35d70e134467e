// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/data/robust.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

/// @file shown.hpp
/// The range in which recordings can show a cause: how far an axis went, how fast, and for how long.

namespace thermopower::gap::engine {

/// The range that recordings can show; unlimited if nothing is known.
struct Shown {
  double travel_rad = 1e300;           ///< range of the angle
  double longest_run_s = 1e300;        ///< length of the longest run
  double fastest_rad_per_s = 1e300;    ///< of the motion
  bool by_reaching_the_noise = false;  ///< whether the candidate in question leaves only noise
};

/// Range of the angle in rad; without an angle any.
inline double travel_rad(const std::vector<Inputs>& inputs) {
  double low = 1e300, high = -1e300;
  for (const Inputs& one : inputs)
    if (one.judged(Signal::angle_deg))
      for (double angle : one.of(Signal::angle_deg))
        if (std::isfinite(angle)) low = std::min(low, angle), high = std::max(high, angle);
  return high > low ? (high - low) * rad_per_deg : Shown().travel_rad;
}

/// Seconds of the longest run of several recordings.
inline double longest_run_s(const std::vector<Inputs>& inputs) {
  double longest_s = 0.0;
  for (const Inputs& one : inputs)
    for (const RunSpan& run : one.runs)
      if (run.size() > 0) longest_s = std::max(longest_s, one.t_s[run.end - 1] - one.t_s[run.begin]);
  return longest_s;
}

/// The rate that all but one in two hundred rows stay below, in rad/s. It comes from slopes of the angle if no rate is
/// judged, and is unlimited if neither is.
inline double fastest_rad_per_s(const std::vector<Inputs>& inputs) {
  constexpr double nearly_all = 0.995;
  constexpr Eigen::Index over_rows = 8;  // noise of single readings is not motion
  std::vector<double> rates_dps;
  for (const Inputs& one : inputs) {
    const bool by_rate = one.judged(Signal::rate_dps);
    if (!by_rate && !one.judged(Signal::angle_deg)) continue;
    const Eigen::VectorXd& read = one.of(by_rate ? Signal::rate_dps : Signal::angle_deg);
    for (const RunSpan& run : one.runs)
      for (Eigen::Index i = run.begin; i + (by_rate ? 0 : over_rows) < run.end; ++i) {
        const double dps =
            by_rate ? read[i] : (read[i + over_rows] - read[i]) / (one.t_s[i + over_rows] - one.t_s[i]);
        if (std::isfinite(dps)) rates_dps.push_back(std::abs(dps));
      }
  }
  return rates_dps.empty() ? Shown().fastest_rad_per_s : quantile_of(rates_dps, nearly_all) * rad_per_deg;
}

/// The range that recordings can show.
inline Shown shown_by(const std::vector<Inputs>& inputs) {
  return {travel_rad(inputs), longest_run_s(inputs), fastest_rad_per_s(inputs), false};
}

}  // namespace thermopower::gap::engine
