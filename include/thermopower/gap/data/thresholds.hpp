// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace thermopower::gap::engine {

/// Thresholds of the data stage: which samples are not believed, and where a run is cut. Noise scales are those of
/// white_scale(), quanta those of quantum_of(). Held by tests/gap/data, and judged on the dirty recordings of
/// docs/reference/gap-benchmark.md.
struct DataThresholds {
  // Samples far from all around them.
  double spike_scales = 6.5;  ///< noise scales off the samples around: one in 1e10 of white Gaussian noise
  double spike_bends =
      3.0;              ///< times the usual second difference around: where a signal bends, more is needed
  double quanta = 4.0;  ///< quanta that a spike, or a jump, is larger than: flicker is one or two
  double as_far = 0.6;  ///< of the farthest sample nearby: what lies less far was drawn along by that one
  double confirmed = 0.35;   ///< of a jump: rate and angle that agree to this share confirm each other
  double falls_to = 0.8;     ///< of it, that the next one has at most: beside another spike nothing decays
  double decays_to = 0.3;    ///< of a peak, that the sample beside it still has at least,
  double goes_on = 0.12;     ///< and the one after that: a peak that decays, or stays,
  double peak_scales = 5.0;  ///< in noise scales, too

  // Stretches of samples.
  double jump_scales = 12.0;  ///< noise scales of a jump that begins or ends a stretch of bad samples
  double jump_steps = 6.0;    ///< times the 75th percentile of all steps that such a jump is, too
  double same_jump = 0.25;    ///< of a jump away, that the samples there, and the jump back, may differ by
  double far_outside = 1.5;   ///< ranges (5th to 95th percentile) off, of a column that may jump
  Eigen::Index longest_burst = 20;  ///< rows of a stretch that jumps away and back
  Eigen::Index longest_stuck =
      400;  ///< the same, where it reads one value: 85.0 degC of a sensor that says nothing
  Eigen::Index least_frozen = 6;     ///< rows of one value that may be a sensor that has stopped
  Eigen::Index longest_repeat = 12;  ///< frames in a row that a logger writes again
  double log_chance = 20.7;          ///< -ln(1e-9): how improbable a stretch of one value is
  double wide_steps =
      0.01;  ///< share of a temperature's moves beyond one quantum from which its noise shows at rest
  double hardly_equal = 0.2;       ///< share of equal neighbours below which a value hardly repeats by chance
  double mostly_equal = 0.5;       ///< the same above which a column is set rather than measured
  double clip_ratio = 8.0;         ///< times as many samples at the end of a range as at the value next to it
  Eigen::Index least_clipped = 5;  ///< samples there
  double low_C = -60.0;            ///< no motor is colder
  double high_C = 500.0;           ///< no insulation stands more

  // Stamps and holes.
  double regular_gap = 1.6;       ///< usual intervals from which on a row is missing
  double irregular_gap = 2.5;     ///< of the longest usual interval, where stamps jitter
  double beyond_jitter = 5.0;     ///< robust scales of the intervals by which one is longer that misses a row
  double same_command = 0.02;     ///< of the command's range: it stood still between two such values
  Eigen::Index bridged_rows = 5;  ///< missing rows of air or supply that are bridged
  Eigen::Index held_rows = 20;    ///< missing rows over which a command may have stood still
  double slow_body = 0.002;  ///< of a body's time constant: a pause as short hides a thousandth of its rise
  Eigen::Index least_rows = 4;  ///< of a piece between two cuts
  double reset_speeds = 10.0;   ///< times the speed of the rows around, of an axis that was put elsewhere
  double reset_noise = 30.0;    ///< noise scales, and quanta, that it jumps by
};

/// Of every stage of the check that looks at samples.
inline constexpr DataThresholds data_limits{};

}  // namespace thermopower::gap::engine
