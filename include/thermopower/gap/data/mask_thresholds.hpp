// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <cstddef>

namespace thermopower::gap::engine {

/// Thresholds of the masks. In white Gaussian noise of 1e6 samples none is passed; see tests/gap/data.
/// Held by tests/gap/data/check_test.cpp.
struct MaskThresholds {
  double spike_scales = 6.5;  ///< noise scales between a sample and the median of five around it
  double spike_bends = 3.0;   ///< of the second differences around it: where a signal bends, more is needed
  double first_sds = 4.0;     ///< standard deviations of the first reading of a run off those after it
  std::size_t bends_around = 5;  ///< second differences before and after
  double worth_a_look =
      4.0;  ///< noise scales off the motion of four neighbours from which a sample is looked at
  double often_off = 0.75;          ///< share of the samples that lie nearer to it than often
  double than_often = 4.0;          ///< times farther off than often: steps and corners are no spikes
  double motion_scales = 6.0;       ///< noise scales between a sample and the motion of its neighbours
  double motion_scales_here = 5.0;  ///< the same, of the noise around
  std::size_t noise_around = 14;    ///< samples before and after that tell the noise around
  double rests_like_noise =
      1.5;                 ///< noise scales that are left of the neighbours at most where there is no corner
  double on_a_line = 3.0;  ///< noise scales off what neighbours on one side go on to: a corner
  double corner = 0.35;    ///< the same, of how far a sample lies
  double sharp_corner = 0.2;         ///< the same, where no more than noise is left of the neighbours
  double with_lost_rows = 1.5;       ///< times as long as usual that the neighbours may last
  std::size_t drawn_along = 3;       ///< rows before and after a spike that seem to lie far because of it
  double as_far = 0.6;               ///< of the farthest among them: what is a spike of its own
  double confirmed = 0.35;           ///< of how far a sample lies: what a rate and its angle may differ by
  double confirmed_at_end = 0.5;     ///< the same at an end of a run, where a rate may begin with a jump
  double jump_scales = 12.0;         ///< noise scales of a step that may begin a stretch elsewhere
  double jump_steps = 6.0;           ///< of the 75th percentile of the steps
  double quanta = 4.0;               ///< quanta that any of them must be, too
  double on_a_slope = 0.5;           ///< of a step, that the one before it has, too: then neither is a jump
  double came_back = 0.25;           ///< of the jump: what lies nearer to where it came from has come back
  double stayed_away = 0.5;          ///< of the jump: what lies farther is still away
  Eigen::Index longest_burst = 20;   ///< rows of a stretch elsewhere
  Eigen::Index longest_stuck = 400;  ///< rows, where all of them have the same value
  double rarely_equal = 0.5;         ///< share of equal neighbours below which the noise shows at every row
  double nearly_always_equal =
      0.9;  ///< share of equal neighbours from which a column that may jump is set, not measured
  double hardly_equal = 0.2;  ///< share of equal neighbours below which a value hardly repeats by chance
  double wide_steps =
      0.01;  ///< of the steps of a temperature, beyond one quantum, from which its noise is as large
  double log_chance = 20.7;        ///< -ln(1e-9): how improbable a frozen stretch must be
  Eigen::Index least_frozen = 6;   ///< rows of the shortest frozen stretch
  double clip_ratio = 8.0;         ///< times as many samples at the extreme as at the value next to it
  Eigen::Index least_clipped = 5;  ///< samples at the extreme
  double stays_clipped =
      0.1;               ///< of the samples at the end of a range, at least: follow on another one there
  double outside = 1.5;  ///< ranges (5th to 95th percentile) beyond the level a burst of a moving axis lies
};

/// The facts about a column that masks need.
struct ColumnTraits {
  bool cannot_jump = false;   ///< a temperature: what jumps away and back was never there
  bool zero_is_rest = false;  ///< an exact 0 is what a good sensor reads at rest
  bool begins_with_a_step =
      false;  ///< each run begins where what drives the column stepped (the power of a current)
  const Eigen::VectorXd* at_rest =
      nullptr;  ///< a column that is 0 while this one may stand still (the rate of an angle)
  const Eigen::VectorXd* integral = nullptr;  ///< a column that moves on by this one (the angle of a rate)
  const Eigen::VectorXd* t_s = nullptr;       ///< stamps, where `integral` or `at_rest` is given
};

}  // namespace thermopower::gap::engine
