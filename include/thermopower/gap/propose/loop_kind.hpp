// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>
#include <thermopower/plant/axis_at_rows.hpp>
#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// Whether a loop is closed, and how that is known.
struct LoopEvidence {
  LoopKind kind = LoopKind::unknown;  ///< who makes the effort
  double followed_share =
      0.0;  ///< of what the effort's own past does not tell of it, the share that past motion does

  /// Whether a controller makes the effort of the motion.
  bool is_closed() const { return kind == LoopKind::closed_recorded || kind == LoopKind::closed_found; }
};

/// Whether effort follows motion in recordings.
inline LoopEvidence loop_of(const Model& model, const Catalogue& catalogue,
                            const std::vector<Inputs>& recordings) {
  (void)model, (void)catalogue;
  LoopEvidence evidence;
  for (const Inputs& inputs : recordings)
    if (inputs.axis() && (inputs.closed_loop || inputs.target_deg.size() > 0 || inputs.target_dps.size() > 0))
      evidence.kind = LoopKind::closed_recorded;
  return evidence;
}

}  // namespace thermopower::gap::engine
