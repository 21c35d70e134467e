// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap::engine {

/// The thresholds of the decision, each with its unit and its reason.
struct DecisionThresholds {
  // Evidence
  /// Twice a log odds, for every effect beyond the first: effects are rare, one in twenty of those looked for.
  double rarity = 6.0;
  /// Share of the score. What is as near to the best as this on every held-out signal is given the best one's
  /// fit: with many rows less is still significant, but tells of small errors that every model has.
  double alike_held_out = 0.005;
  /// The same over training and held-out data together, where starts are fitted and less is noise.
  double alike_overall = 0.02;
  /// Share of the score, for an explanation with fewer parameters, where the best one is far above the noise: a
  /// model that is wrong by several times the noise proves nothing by its last twentieth.
  double alike_far_from_noise = 0.05;
  /// Share of the larger one by which two parameters may differ, two standard errors included, that are equal as far as it
  /// matters: frictions of two directions are seldom known to a tenth beforehand.
  double equal = 0.1;
  /// Standard errors by which a richer explanation must fit better than a simpler one not to stay behind it.
  double beyond_doubt = 2.0;
  /// Probability, as a share of the likeliest one's, from which a rival is an alternative. With a single rival below
  /// a tenth the best one is right nine times in ten, and its probability says so.
  double alternative = 0.1;

  /// Probability, as a share of that of all explanations left, from which a cause is named beside a rest.
  double likelier_than_all = 0.6;

  // Verdict
  /// Multiple of the noise floor up to which a held-out signal counts as near it, as printed in the table.
  double near_floor = 1.5;
  /// Readings of the training data for every parameter of a cause and every constant that moved beside it. The rule of
  /// thumb of regression is 10 to 20; with fewer an explanation can be bent to anything, and the next recording differs.
  double readings_per_parameter = 15.0;
  /// Multiple of the noise floor below which nothing is missing.
  double no_gap = 1.25;
  /// Share of the score by which a cause must shrink the held-out gap, beyond what re-calibration does, to be
  /// named beside a rest.
  double material = 0.15;
  /// The same for the lower end of its interval.
  double proven = 0.05;
  /// Standard errors from the shrinkage to the lower end of its interval: one-sided, 95 %.
  double standard_errors = 1.64;
  /// Share of the score by which a held-out signal may grow with a cause that is named.
  double may_grow = 0.05;
  /// Probability above which a rest is taken to hide that the cause is another one, per share that is left.
  double doubt_by_rest = 0.5;
  /// Probability that one of hundreds of pairs passes for a single cause that the catalogue lacks.
  double pair_for_unknown = 0.15;
  /// Multiple of the noise above which causes that cost much to simulate are looked for.
  double room_for_costly = 1.1;
  /// Share of the error as judged below which a cheap cause must bring a signal for the costly ones not to be tried.
  double lowered_without_costly = 0.8;
  /// Multiple of the noise above which a second cause is looked for.
  double room_for_second = 1.4;
  /// Share of what one cause leaves that a second one must take away.
  double second_takes = 0.5;
  /// Share of the blocks of held-out data in which the second cause must help.
  double second_holds = 0.75;
};

/// The values in force.
inline constexpr DecisionThresholds decision{};

}  // namespace thermopower::gap::engine
