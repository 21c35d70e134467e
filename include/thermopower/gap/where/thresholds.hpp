// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

namespace thermopower::gap::engine {

/// Thresholds of the localisation. Sums of squares are in units of what the sensor's noise alone leaves (the
/// floor), unless it says otherwise. They were chosen on recordings drawn by `gap_benchmark_generate`, whose
/// table's rows "signal and submodel right" and "no gap, and none found" they serve.
/// Held by tests/gap/where/localisation_test.cpp, and judged on seed 20270221 in docs/reference/gap-benchmark.md.
struct LocalisationThresholds {
  // When there is something to place.
  double slack = 0.04;           ///< how far constants may be off without that being a gap, as a fraction
  Eigen::Index least_rows = 30;  ///< rows; fewer cannot be cross-validated on eight stretches
  double nothing_seen =
      1.15;  ///< a fit of the constants alone that leaves no more on all rows needs no freedom,
  double nothing_unseen =
      4.0;                ///< if it leaves no more than this on unseen stretches, which bind it more loosely
  double gap_seen = 1.5;  ///< a gap leaves more than this on all rows: noise is estimated to some 20 %
  double gap_unseen = 2.0;  ///< and more than this on unseen stretches

  // Which freedom is chosen.
  double no_help = 0.9;         ///< share of what the constants leave that a freedom must get below to be one
  double as_good = 0.35;        ///< more than the best by this share of it, and
  double as_good_floor = 0.15;  ///< by this much more, is as good: the fewer directions are taken
  double needs_a_second = 2.0;  ///< one freedom that leaves more may be joined by a second,
  double second_gain = 0.6;     ///< which must take this share of what the first leaves
  double second_share = 0.004;  ///< and this share of all there was

  // When it is said.
  double explained = 0.3;  ///< share of the excess that the chosen freedoms must explain to be named
  double large = 15.0;     ///< an unexplained gap that leaves less on unseen stretches is not placed
  double instrument_explained =
      0.5;                 ///< share from which an instrument's fault corrects what depends on its reading
  double per_block = 0.5;  ///< price of a freedom, as a share, where alternatives of a balance compete
  double picture = 0.15;   ///< share below which no further picture is drawn

  // How much is looked at.
  Eigen::Index rows = 8000;  ///< of an algebraic or filtered balance, after averaging: enough for any freedom
  Eigen::Index narrow_functions = 5000;  ///< test functions of the narrowest width
  Eigen::Index wide_functions = 1500;    ///< of every further width
  Eigen::Index picture_samples = 4000;   ///< of a missing quantity
  Eigen::Index picture_least = 60;       ///< samples that a picture must keep when noise asks for wider ones
  int picture_first = 4;                 ///< rows: the narrowest half width tried for it
  double picture_noise = 0.04;           ///< noise of a sample of it, as a share of the held flow's RMS
  int picture_bins = 28;                 ///< bins of a picture
  int regime_bins = 10;                  ///< bins among which the regime is found
  double regime_half = 0.5;              ///< of the largest bin: its neighbours above it belong to the regime
  Eigen::Index most_starts = 6;          ///< runs whose starts are freed one by one
};

/// The thresholds of every localisation.
inline constexpr LocalisationThresholds where_limits;

}  // namespace thermopower::gap::engine
