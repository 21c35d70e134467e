// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/design/prediction.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::design {

/// How much of a limit an experiment uses.
struct LimitUse {
  std::string limit;   ///< field of Limits
  double share = 0.0;  ///< of the way from the start to the limit: 1 is at the limit, more is beyond
};

/// A distance as a share of the distance that is allowed. Nothing allowed is used by anything.
inline double beyond(double distance, double allowed) {
  if (!(distance > 0.0)) return 0.0;
  return allowed > 0.0 ? distance / allowed : 1e9;
}

/// How much of its limits an explanation's motion uses: the limit that is used most. A simulation that leaves the range of numbers
/// is beyond any limit.
inline LimitUse use_of(const Motion& motion, const Limits& limits) {
  const std::pair<Signal, std::pair<const char*, const Bounds*>> bounds[] = {
      {Signal::angle_deg, {"angle_deg", &limits.angle_deg}},
      {Signal::rate_dps, {"rate_dps", &limits.rate_dps}},
      {Signal::current_A, {"current_A", &limits.current_A}},
      {Signal::motor_C, {"temperature_C", &limits.temperature_C}}};
  LimitUse most;
  for (const auto& [signal, named] : bounds) {
    const Eigen::VectorXd& values = motion[static_cast<std::size_t>(signal)];
    const Bounds& range = *named.second;
    if (values.size() == 0 || !range.any()) continue;
    assert(range.low <= range.high);
    double share = 0.0;
    const double first = std::clamp(signal == Signal::current_A ? 0.0 : values[0], range.low, range.high);
    for (const double value : values) {
      if (!std::isfinite(value)) share = 1e9;
      else if (value > first) share = std::max(share, beyond(value - first, range.high - first));
      else share = std::max(share, beyond(first - value, first - range.low));
    }
    if (share > most.share) most = {named.first, share};
  }
  return most;
}

/// The same of a schedule's own columns: what is commanded is known without a simulation.
inline LimitUse use_of_commands(const Recording& schedule, const Limits& limits) {
  LimitUse most;
  const Eigen::VectorXd* drive = schedule.find("drive_A");
  if (drive == nullptr) drive = schedule.find("current_A");
  if (drive != nullptr && limits.current_A.any()) {
    const double share = std::max(beyond(std::max(drive->maxCoeff(), 0.0), limits.current_A.high),
                                  beyond(std::max(-drive->minCoeff(), 0.0), -limits.current_A.low));
    if (share > most.share) most = {"current_A", share};
  }
  return most;
}

}  // namespace thermopower::design
