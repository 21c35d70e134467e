// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// Who makes the effort.
enum class LoopKind {
  unknown,          ///< too little data, or no effort recorded
  open,             ///< effort comes from outside, and knows nothing of the motion
  closed_recorded,  ///< a target is recorded: a controller makes the effort of it and of the motion
  closed_found  ///< no target is recorded, and the effort is as rough as what a controller makes of measured motion
};

/// Whether a controller makes the effort of the motion.
inline bool is_closed(LoopKind kind) {
  return kind == LoopKind::closed_recorded || kind == LoopKind::closed_found;
}

/// As reports print it.
inline const char* to_string(LoopKind kind) {
  return is_closed(kind) ? "closed" : kind == LoopKind::open ? "open" : "unknown";
}

/// Who makes the effort in recordings.
///
/// A target says that a controller does. Without one, effort tells it: one that comes from outside repeats or is smooth, as
/// whoever made it wrote it down. One that a controller makes of measured motion is as rough as that, and one that is measured has
/// noise of its own.
/// Each recording is asked for itself, and most of the rows decide: a ramp is smooth, and a staircase repeats.
/// @param recordings  prepared ones
inline LoopKind loop_of(const Model& model, const std::vector<Inputs>& recordings) {
  Eigen::Index from_outside = 0, all = 0;
  for (const Inputs& inputs : recordings) {
    if (!inputs.axis()) continue;
    if (inputs.closed_loop || inputs.target_deg.size() > 0 || inputs.target_dps.size() > 0)
      return LoopKind::closed_recorded;
    const Eigen::VectorXd& effort = plant::command(inputs, model.axis->voltage_driven());
    const Eigen::Index rows = effort.size();
    if (rows < 2 || !(effort.squaredNorm() > 0.0)) continue;
    Eigen::Index same = 0;
    for (Eigen::Index i = 1; i < rows; ++i) same += effort[i] == effort[i - 1] ? 1 : 0;
    const bool repeats = static_cast<double>(same) > propose_thresholds.repeats * static_cast<double>(rows);
    const double rms = std::sqrt(effort.squaredNorm() / static_cast<double>(rows)),
                 noise = plant::sample_noise(effort, inputs.runs);
    if (repeats || noise < propose_thresholds.smooth_effort * rms) from_outside += rows;
    all += rows;
  }
  if (all == 0) return LoopKind::unknown;
  return 2 * from_outside > all ? LoopKind::open : LoopKind::closed_found;
}

}  // namespace thermopower::gap::engine
