// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

namespace thermopower::gap::engine {

/// The thresholds of the decision, each with its unit and its reason. They were chosen on recordings of
/// `gap_benchmark_generate` with seeds of their own, and docs/reference/gap-benchmark.md judges them on seed 20270221; held by
/// tests/gap/decide_test.cpp.
struct DecisionThresholds {
  // Evidence
  /// Twice a log odds, for every effect beyond the first: effects are rare, one in twenty of those looked for.
  double rarity = 6.0;
  /// Share of the score. What is as near to the best as this on every held-out signal is given the best one's
  /// fit: with many rows less is still significant, but tells of small errors that every model has.
  double alike_held_out = 0.005;
  /// The same over training and held-out data together, where starts are fitted and less is noise.
  double alike_overall = 0.02;
  /// The same over training data alone: what fits these clearly worse is another thing, however well it does on fewer others.
  double alike_in_training = 0.06;
  /// Share of the score, for an explanation with fewer parameters, where the best one is far above the noise: a
  /// model that is wrong by several times the noise proves nothing by its last twentieth.
  double alike_far_from_noise = 0.05;
  /// Share of the larger one by which two parameters may differ, two standard errors included, that are equal as far as it
  /// matters: frictions of two directions are seldom known to a tenth beforehand.
  double equal = 0.1;
  /// The same, below which it cannot be what one fits better by than the other.
  double the_same = 0.01;
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
  /// Twice a log odds by which constants alone may cost more than constants beside a cause: chi-square of one, 95 %.
  double dear_constants = 3.84;
  /// Readings of the training data for every parameter of a cause and every constant that moved beside it. The rule of
  /// thumb of regression is 10 to 20; with fewer an explanation can be bent to anything, and the next recording differs.
  double readings_per_parameter = 15.0;
  /// Readings of some signal of the training data, without which no cause is named: twice as many as one parameter wants, for
  /// constants are fitted beside it.
  double least_readings = 30.0;
  /// Multiple of the noise floor below which nothing is missing.
  double no_gap = 1.25;
  /// The same on every row held out, as the table is printed: many rows know their floor better than a search does.
  double no_gap_in_full = 1.2;
  /// Multiple of the noise floor up to which what noise that remembers comes to by chance, in a few hundred samples, is none.
  double most_by_chance = 2.0;
  /// Multiple of the noise, over the windows of a fit, from which no constants are looked for that bring everything to it.
  double far_from_noise = 8.0;
  /// Share of the score by which a cause must shrink the held-out gap, beyond what re-calibration does, to be
  /// named beside a rest.
  double material = 0.15;
  /// The same for the lower end of its interval.
  double proven = 0.05;
  /// Standard errors from the shrinkage to the lower end of its interval: one-sided, 95 %.
  double standard_errors = 1.64;
  /// Share of the score by which a held-out signal may grow with a cause that is named.
  double may_grow = 0.05;
  /// Excess of a mean square over the noise, in units of its variance, below which there is no gap to leave a share of.
  double some_gap = 0.1;
  /// Probability that the cause is outside of the catalogue, where nothing inside is believed.
  double unknown = 0.98;
  /// Log odds of an unknown cause for each multiple of the floor that an explanation ends above `near_floor`,
  double doubt_above_floor = 4.0;
  /// but at most those for the share of the gap that it leaves,
  double doubt_by_share = 30.0;
  /// beyond this one, which the floor's own error may be.
  double share_of_error = 0.15;
  /// Share of the training residuals that an explanation must leave to have been absorbed by the constants.
  double absorbed = 0.99;
  /// Cosine of what two explanations do to the residuals, from which they are said to be confusable.
  double confusable = 0.9;
  /// Factor of the held-out error from which refitted constants are said to make it worse.
  double worse = 1.05;
  /// Multiple of the noise above which long windows may do harm: a small error sends the axis into the next dip of a load.
  double far_for_long_windows = 3.0;
  /// Share of it that short windows must get below to be believed instead.
  double short_windows_lower = 0.7;
  /// Multiple of the noise in the windows that are fitted, their starts with them, above which a simulation does not follow
  /// its data: noise alone makes 1, and blows of teeth that hang on the last digit of a start came to 2.2.
  double follows = 3.0;
  /// Multiple of the noise in the windows that are fitted, above which others tell no more.
  double far_for_more_windows = 3.0;
  /// Mean square, in units of the noise's, above which sets of causes are looked for.
  double room_for_sets = 1.8;
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
  /// The same where the first cause comes so near with constants far off: what is no gap by itself.
  double room_beside_dear_constants = 1.25;
  /// Share of what one cause leaves that a second one must take away.
  double second_takes = 0.5;
  /// Share of the blocks of held-out data in which the second cause must help.
  double second_holds = 0.75;
  /// Share of the gap that a cause may leave whose parameters the data do not agree about: a stand-in for another one takes
  /// what it can get wherever it looks a little like it, and that is another size in each part of a recording.
  double may_leave = 0.6;
  /// Factor beside which a constant stands for something else where causes leave a rest and constants alone do little. Leaving a
  /// cause out of the simulation bends a fit of its constants by up to 2 or so, which the cause then undoes; a factor beyond
  /// that is another device.
  double bent_by = 2.5;
  /// The same of an inertia beside causes that keep no state, as a spring's far side is one: each acceleration tells it, and what a
  /// joint loses hardly bends it. Of 20 that moved beside named causes in three draws of the benchmark (seeds 20270227 to 20270229)
  /// the 18 right ones moved theirs by 1.6 at most, the two wrong ones by 2.3 and 2.8.
  double bent_inertia_by = 2.0;
  /// Share of the gap up to which a cause may take such a constant along: a viscous friction that was fitted without the dry one
  /// is three to thirty times too large, and goes back with it. What takes four fifths is no stand-in: of 136 draws of unknown
  /// causes (the benchmark's, seed 20270220) those that bent a constant left 0.31 and more.
  double may_leave_bent = 0.2;
  /// The same, up to which one cause may leave a course of its own in time, and two its square: a further effect, smaller by an
  /// order, has one, too.
  double may_leave_a_course = 0.2;
  /// Share of what is above the noise beside a part of a set that the whole set may leave to need no other witness.
  double speaks_for_itself = 0.2;
  /// Share of the gap that a cause may leave in the place that it should mend: plain laws of friction leave 3 to 15 % of
  /// what a joint with a bristle, another exponent or a gear does, and this is twice as much.
  double may_leave_in_place = 0.3;
  /// Share of a signal's excess from which a place of a joint counts as blamed: beside a rest a cause acts in one that is. Of 23
  /// that left a rest in three draws of the benchmark (seeds 20270227 to 20270229) and on the rigs of a stranger, the 13 that were
  /// right did, and five of the ten that were wrong did not.
  double blamed = 0.1;
  /// Factor by which one of several causes alone is further from the rows than none of them, from which, where each alone is
  /// further, they are a difference of large numbers. Causes in fact do some of what is seen each; that they happen to cancel
  /// to a third is rare.
  double opposites = 3.0;
  /// Standard deviation of a parameter, by how much the data's blocks differ, as a share of its value: up to it they agree.
  double size_known = 0.5;
  /// Share of the mean square of what follows nothing recorded up to which it is over once an instrument's cause is in the
  /// model. Beside a fan or a load that no column shows, instruments that are sound left four fifths of it and more; a
  /// thermometer that did lag, a tenth and less. Of other causes nothing may be left: a bias of the air alone takes most of a
  /// periodic load away.
  double course_left = 0.3;
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
  /// Mean square of what is left so far, in units of the noise, above which every second of these windows tells what is
  /// worth a fit: four times the noise is seen in a few samples.
  double plain_above = 16.0;
  double out_of_reach =
      25.0;  ///< times the mean square that the best leaves there: no half of a set of causes
  Eigen::Index judged_rows = 20000;   ///< held out, on which explanations are weighed
  Eigen::Index windows_together = 4;  ///< neighbours that are kept: what remembers needs some time
  double fitted_window_s = 2.0;  ///< of an axis, at least: long windows tell more than those of the score
  double tried_window_s = 0.5;   ///< of the first look, at most
  /// Share of the windows of the score that shorter ones have, in which a load that holds an axis is looked for.
  double shorter_than_the_score = 0.4;
};

/// The values in force.
inline constexpr SearchThresholds search_extent{};

}  // namespace thermopower::gap::engine
