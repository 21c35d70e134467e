// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

namespace thermopower::plant {

/// Rows of one recording that are simulated in one go from a start of their own.
struct Segment {
  const Inputs* inputs = nullptr;  ///< the recording, not owned
  RunSpan run;                     ///< the run they belong to
  Eigen::Index begin = 0;          ///< first row
  Eigen::Index end = 0;            ///< row after the last
  bool axis = false;               ///< a window that restarts from the measured state, else a whole run
  bool carries_on = false;         ///< states that nobody measures come from the segment before
  bool warm_up = false;            ///< only brings such states about: its samples do not count
};

/// The largest number of unknowns that a segment's start may have.
inline constexpr int largest_start = 8;

/// Unknown start of a segment, relative to the measured one; a fit estimates it along with the parameters. Of an
/// axis: angle in deg, rate in deg/s; on the bench: the measured node in K, then what a hidden one differs from
/// it; of a plant of one's own: its states, in their units.
using Start = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, largest_start, 1>;

}  // namespace thermopower::plant
