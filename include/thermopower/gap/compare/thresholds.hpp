// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

namespace thermopower::gap::engine {

/// The thresholds of the decision, each with its unit and its reason. They were chosen on recordings of
/// `gap_benchmark_generate` with other seeds than the one of docs/reference/gap-benchmark.md. tests/gap/compare/evidence_test.cpp
/// holds them.
struct DecisionThresholds {
  // Evidence
  /// Share of the score. A candidate as near to the best as this on every held-out signal is given the best one's fit. With
  /// many rows a smaller difference is still significant, but tells of small errors that every model has.
  double alike_held_out = 0.005;
  /// The same over training and held-out data together, where starts are fitted and less is noise.
  double alike_overall = 0.02;
  /// The same over training data alone: what fits these clearly worse is another thing, however well it does on fewer others.
  double alike_in_training = 0.06;
  /// Share of the score, for an explanation with fewer parameters, if the best one is far above the noise. A model that is
  /// wrong by several times the noise proves nothing by its last twentieth.
  double alike_far_from_noise = 0.05;
  /// Share of the larger one by which two parameters may differ, two standard errors included, to count as equal. Frictions
  /// of two directions are seldom known to a tenth beforehand.
  double equal = 0.1;
  /// The same, below which it cannot be what one fits better by than the other.
  double the_same = 0.01;
  /// Standard errors by which a richer explanation must fit better than a simpler one not to stay behind it.
  double beyond_doubt = 2.0;
  /// Probability, as a share of the likeliest one's, from which a rival is an alternative. With a single rival below
  /// a tenth the best one is right nine times in ten, and its probability says so.
  double alternative = 0.1;

  /// Twice a log odds from which a set is said to miss a cause that it lacks: odds of 20 000.
  double missed_from = 20.0;

  // Verdict
  /// Multiple of the noise floor up to which a held-out signal counts as near it, as printed in the table.
  double near_floor = 1.5;
  /// Twice a log odds by which constants alone may cost more than constants beside a cause: chi-square of one, 95 %.
  double dear_constants = 3.84;
  /// Multiple of the noise floor below which nothing is missing.
  double no_gap = 1.25;
  /// Excess of a mean square over the noise, in units of its variance, below which there is no gap to leave a share of.
  double some_gap = 0.1;
  /// Share of the training residuals that an explanation must leave to have been absorbed by the constants.
  double absorbed = 0.99;
  /// Cosine of what two explanations do to the residuals, from which they are said to be confusable.
  double confusable = 0.9;
  /// Factor of the held-out error from which refitted constants are said to make it worse.
  double worse = 1.05;
  /// Multiple of the noise above which long windows may do harm: a small error sends the axis into the next dip of a load.
  double far_for_long_windows = 3.0;
  /// Share of what the answer of long windows leaves, that the one of short windows must get below to be believed instead.
  double short_windows_lower = 0.7;
  /// Multiple of the noise in the fitted windows, with fitted starts, above which a simulation does not follow its data.
  /// Noise alone makes 1. Blows of teeth that depend on the last digit of a start came to 2.2.
  double follows = 3.0;
  /// Mean square, in units of the noise's, above which sets of causes are looked for.
  double room_for_sets = 1.8;
  /// Multiple of the noise above which causes that cost much to simulate are looked for.
  double room_for_costly = 1.1;
  /// Share of the error as judged below which a cheap cause must bring a signal for the costly ones not to be tried.
  double lowered_without_costly = 0.8;
  /// Multiple of the noise above which a second cause is looked for.
  double room_for_second = 1.4;
  /// The same if the first cause comes so near only with constants far off: below it there is no gap.
  double room_beside_dear_constants = 1.25;
  /// Share of what one cause leaves that a second one must take away.
  double second_takes = 0.5;
};

/// The values in force.
inline constexpr DecisionThresholds decision{};

/// How much a search looks at: enough for what the benchmark names (seed 20270221), and few enough for 100 000 rows in some
/// seconds (`gap_speed`). Held by tests/gap/fit/shortened_test.cpp and tests/gap/fit/segment_choice_test.cpp.
struct SearchThresholds {
  Eigen::Index fitted_bench_rows = 2500;  ///< that explanations are fitted to in the end
  Eigen::Index fitted_axis_rows = 4000;   ///< the same of an axis
  Eigen::Index fitted_recorded_rows =
      8000;  ///< the same of a fast one's rows as recorded, where their averages will not do
  Eigen::Index tried_bench_rows = 900;     ///< of the first look
  Eigen::Index tried_axis_rows = 1600;     ///< the same of an axis
  Eigen::Index shortest_axis_rows = 2000;  ///< of the first look in windows that are shorter still
  Eigen::Index glimpsed_axis_rows = 500;   ///< of those, in which sets are looked for that are worth a look
  /// Mean square of the best residuals so far, in units of the noise, above which every second of these windows is enough.
  /// Four times the noise is seen in a few samples.
  double plain_above = 16.0;
  double out_of_reach =
      25.0;  ///< times the mean square that the best leaves there: no half of a set of causes
  Eigen::Index judged_rows = 20000;   ///< held out, on which explanations are weighed
  Eigen::Index windows_together = 4;  ///< neighbours that are kept: what remembers needs some time
  double fitted_window_s = 2.0;  ///< of an axis, at least: long windows tell more than those of the score
  double tried_window_s = 0.5;   ///< of the first look, at most
};

/// The values in force.
inline constexpr SearchThresholds search_extent{};

}  // namespace thermopower::gap::engine
