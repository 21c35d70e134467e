// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>
#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/samples.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap::engine {

/// Whether a loop is closed, and how that is known.
struct LoopEvidence {
  LoopKind kind = LoopKind::unknown;  ///< who makes the effort
  double roughness = 0.0;  ///< noise of the effort over its RMS: a controller passes on that of its sensors
  double repeated = 0.0;   ///< share of the rows whose effort is that of the row before

  /// Whether a controller makes the effort of the motion.
  bool is_closed() const { return kind == LoopKind::closed_recorded || kind == LoopKind::closed_found; }
};

/// Who makes the effort in recordings.
///
/// A target says that a controller does. Without one, effort tells it: one that comes from outside repeats or is smooth, as
/// whoever made it wrote it down. One that a controller makes of measured motion is as rough as that, and one that is measured has
/// noise of its own.
/// @param recordings  prepared ones
inline LoopEvidence loop_of(const Model& model, const std::vector<Inputs>& recordings) {
  LoopEvidence evidence;
  double square = 0.0, noise = 0.0, same = 0.0, rows = 0.0;
  bool targeted = false;
  for (const Inputs& inputs : recordings) {
    if (!inputs.axis()) continue;
    targeted = targeted || inputs.closed_loop || inputs.target_deg.size() > 0 || inputs.target_dps.size() > 0;
    const Eigen::VectorXd& effort = plant::command(inputs, model.axis->voltage_driven());
    if (effort.size() < 2) continue;
    const double n = static_cast<double>(effort.size());
    square += effort.squaredNorm();
    noise += n * std::pow(plant::sample_noise(effort, inputs.runs), 2);
    for (Eigen::Index i = 1; i < effort.size(); ++i) same += effort[i] == effort[i - 1] ? 1.0 : 0.0;
    rows += n;
  }
  if (square > 0.0) {
    evidence.roughness = std::sqrt(noise / square);
    evidence.repeated = same / rows;
    const bool from_outside = evidence.repeated > propose_thresholds.repeats ||
                              evidence.roughness < propose_thresholds.smooth_effort;
    evidence.kind = from_outside ? LoopKind::open : LoopKind::closed_found;
  }
  if (targeted) evidence.kind = LoopKind::closed_recorded;
  return evidence;
}

}  // namespace thermopower::gap::engine
