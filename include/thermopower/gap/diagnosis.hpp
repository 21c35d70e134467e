// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/lacks.hpp>
#include <thermopower/gap/reason.hpp>
#include <thermopower/gap/verdict.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/simulated_signal.hpp>
#include <thermopower/plant/quantity.hpp>
#include <thermopower/plant/signal.hpp>
#include <thermopower/plant/submodel.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap {

/// A closed interval.
struct Interval {
  double low = 0.0;   ///< lower end, in the unit of what it bounds
  double high = 0.0;  ///< upper end, at least `low`
};

/// Part of a recorded variable's range.
struct Regime {
  std::string variable;  ///< a column or a derived one (`rise_K`)
  double from = 0.0;     ///< where the part begins, in the variable's unit
  double to = 0.0;       ///< where it ends, at least `from`
};

/// One run in which a fault shows while others hold.
struct Occurrence {
  std::string recording;         ///< name of the recording
  std::string run;               ///< label of the run, may be empty
  bool held_out = false;         ///< the run is among the held-out data
  std::optional<double> from_s;  ///< stamp from which on it shows, where it does not before
};

/// Where simulation and recording part, found from residuals alone.
struct Location {
  plant::SignalName signal;              ///< in which the two part
  plant::SubmodelName submodel;          ///< which part of the plant is at fault
  double share = 0.0;                    ///< part of that signal's excess residual, 0..1
  std::optional<Regime> regime;          ///< where in which variable it is largest
  std::string evidence;                  ///< one sentence
  std::vector<Occurrence> only_in = {};  ///< the runs it shows in; empty: all of them, throughout
};

/// Whether a place takes anything of its signal's gap away, half a per cent or more. Of places that take nothing away by
/// themselves the one that is named is what the missing follows most.
inline bool takes_gap_away(const Location& place) { return !(place.share < 0.005); }

/// A fitted parameter of an effect.
struct ParameterEstimate {
  std::string name;    ///< as the effect declares it, with the unit as its ending
  double value = 0.0;  ///< maximum-posterior estimate, in `unit`
  Interval ci95;  ///< accounts for autocorrelated residuals; its whole range where the data say nothing of it
  std::string unit;       ///< "1" for a pure number
  bool at_bound = false;  ///< ended on a bound of its range: then it does not explain
  bool told = true;       ///< the data narrow its range
};

/// One effect of the chosen explanation.
struct Cause {
  std::string effect;        ///< id in the catalogue, or `calibration.<id>` for a constant that is off
  double probability = 0.0;  ///< that this effect acts, 0..1
  std::vector<ParameterEstimate> parameters;  ///< what the fit made of its parameters, in their order
};

/// The gap of one signal on held-out data; RMSE of simulation against recording.
struct GapScore {
  plant::SignalName signal;         ///< which
  std::string unit;                 ///< of the scores: degC, A, deg or deg/s
  std::optional<double> horizon_s;  ///< length of a window; none: whole runs
  double before = 0.0;              ///< the model as configured
  double recalibrated = 0.0;        ///< its own constants refitted, no effect added
  double after = 0.0;               ///< with the causes (equal to `before` where there are none)
  double noise_floor = 0.0;         ///< what a perfect model would score
  double by_chance = 1.0;  ///< multiple of the floor that noise which remembers comes to by chance, 1 or more
  double shrunk_by = 0.0;  ///< 1 - after / before
  Interval ci95;           ///< of shrunk_by, by a paired block bootstrap
  Interval beyond_constants = {};  ///< the same of 1 - after / recalibrated
  Interval by_constants = {};      ///< the same of 1 - recalibrated / before
};

/// The curve of a signal by an explanation that was not chosen.
struct RivalCurve {
  std::vector<std::string> effects;  ///< its ids, as in `Diagnosis::ranking`
  Eigen::VectorXd values;            ///< one per row of the series
};

/// Measured and simulated curves of one signal over one held-out run, for pictures.
struct SignalSeries {
  plant::SignalName signal;             ///< which
  std::string unit;                     ///< of the values: degC, A, deg or deg/s
  std::string recording;                ///< name of the recording, all of its runs
  Eigen::VectorXd t_s;                  ///< stamps of the rows as recorded; the vectors below are as long
  Eigen::VectorXd measured;             ///< NaN where missing
  Eigen::VectorXd baseline;             ///< as configured
  Eigen::VectorXd recalibrated;         ///< own constants refitted
  Eigen::VectorXd augmented;            ///< with the causes (the baseline where there are none)
  std::vector<RivalCurve> rivals = {};  ///< the likeliest other explanations, at most three
};

/// The missing physical quantity itself (watts, newton metres, volts) against the variable that orders it.
struct MissingQuantity {
  plant::SignalName signal;      ///< the signal it was inferred from
  plant::QuantityName quantity;  ///< the missing quantity
  std::string unit;              ///< W, N m, V, ...
  std::string variable;          ///< abscissa, such as `rise_K` or `rate_rad_per_s`
  std::string variable_unit;     ///< unit of the abscissa
  Eigen::VectorXd x;             ///< abscissa of the binned samples
  Eigen::VectorXd value;         ///< missing quantity there
  Eigen::VectorXd spread;        ///< its standard error
  Eigen::VectorXd effect_x;      ///< abscissae of the curve `effect`, ascending and evenly spaced
  /// The quantity that the model with the chosen causes supplies at `effect_x`, as a smooth curve; empty without causes.
  Eigen::VectorXd effect;
  double effect_freedom = 0.0;  ///< effective degrees of freedom of that curve: 2 is a straight line
};

/// How alike two explanations look to this recording.
struct Likeness {
  std::vector<std::string> effects;  ///< ids of the other explanation
  double cosine = 0.0;               ///< of the signatures, whitened and freed of the baseline's constants
};

/// The end of the fit of an explanation, as a fleet needs it.
struct FittedCoordinate {
  std::string name;          ///< `calibration.<id>` for the factor on a constant, or `<effect>.<parameter>`
  double at = 0.0;           ///< the value, or its natural logarithm
  bool logarithmic = false;  ///< `at` is a logarithm
  bool at_bound = false;     ///< ended on a bound of its range
};

/// One explanation that was weighed.
struct RankedExplanation {
  std::vector<std::string> effects;  ///< one id, or several acting together; empty: "nothing is missing"
  double probability = 0.0;          ///< 0..1 over all explanations weighed and "none of these"
  double score = 0.0;                ///< reduced chi^2 on training data
  double delta_score = 0.0;          ///< evidence against it relative to the best, >= 0 (twice a log odds)
  double held_out_ratio = 0.0;       ///< held-out score over that of "nothing is missing"; NaN: not looked at
  Lacks lacks = Lacks::nothing;      ///< why it is not named
  std::vector<ParameterEstimate> parameters;  ///< named `<effect>.<parameter>`
  std::vector<Likeness> confusable;           ///< others with a likeness of 0.9 or more
  /// Twice the log of how much likelier it makes the training data than the empty explanation does. Residuals have an
  /// unknown variance, and rows are divided by the length of their correlation. Nothing is charged for parameters.
  double train_gain = 0.0;
  double held_out_gain =
      0.0;  ///< the same of held-out data, parameters from training; NaN: was not looked at
  int hidden_starts =
      0;  ///< hidden states whose start the held-out gain fitted, because nobody measures them
  std::vector<FittedCoordinate> fitted = {};  ///< every constant, then the effects' parameters
  Eigen::MatrixXd covariance;  ///< of `fitted`; 0 by 0 where nobody looked at the fit's curvature
  std::vector<FittedCoordinate> fixed = {};  ///< given by the data, such as the range of a curve
};

/// A constant of the model: as configured, and as the reported explanation has it.
struct ConstantEstimate {
  std::string name;          ///< id as in `calibration.<id>`
  double configured = 0.0;   ///< as the model file has it, first field where several scale together
  double fitted = 0.0;       ///< as the explanation has it; its ratio to `configured` is that of all fields
  Interval ci95;             ///< of `fitted`
  double uncertainty = 0.0;  ///< standard deviation that was stated or assumed, as a share of `configured`
  bool is_place = false;     ///< an angle: it moves by a difference, and `uncertainty` is in rad
  bool determined = true;    ///< the data say more about it than the model file does
  bool on_bound = false;     ///< its fit ended at the end of its range: then the model has another fault
  bool within_known = true;  ///< it moved by no more than two of its uncertainties
};

/// The share of the held-out gap that an explanation leaves: the geometric mean over the signals that have one, 1 if
/// nothing is closed.
struct ShareLeft {
  double of_configured = 1.0;          ///< of what the configured model leaves
  double most = 1.0;                   ///< upper end of its one-sided 95 % interval
  double of_refitted_constants = 1.0;  ///< of what refitted constants leave
};

/// Whether one factor explains several constants (FindingKind::common_factor).
enum class CommonFactor {
  none,  ///< it does not
  may_be_constant,  ///< it does, and a single constant does, too: a factor of the command, as `torque_constant_Nm_per_A` has it
  of_no_constant  ///< it does, and no single constant does: a clock, a supply
};

/// Every number that the verdict relies on.
struct DecisionNumbers {
  double configured = 0.0;  ///< largest multiple of the noise floor, as configured
  double by_chance = 1.0;   ///< the same that noise which remembers comes to by chance
  double refitted = 0.0;    ///< the same with refitted constants
  double left = 0.0;        ///< the same with the likeliest explanation
  double twice_horizon =
      0.0;                   ///< the same as configured, in windows twice as long; 0 where that was not asked
  ShareLeft share;           ///< what the likeliest explanation leaves
  double probability = 0.0;  ///< of the likeliest explanation's class
  double together = 0.0;     ///< of that class and the alternatives
  CommonFactor common_factor = CommonFactor::none;  ///< of several constants
};

/// Correlation of the estimates of the chosen explanation. Near 1 or -1 the training data show little more than one
/// combination of two of them.
struct ParameterCorrelation {
  std::vector<std::string>
      names;  ///< `<effect>.<parameter>`, and `<constant>.scale` of the model's own (`.shift` of a place)
  Eigen::MatrixXd of;  ///< symmetric, 1 on its diagonal; NaN where nothing is known
};

/// The rest of the held-out gap that the named causes leave.
struct Remaining {
  plant::SignalName signal;                     ///< the signal that is furthest above its noise floor
  double share = 0.0;                           ///< of the gap above the noise as configured, 0..1
  double times_floor = 0.0;                     ///< its score over its noise floor
  std::optional<plant::SubmodelName> submodel;  ///< where training data see it; none where they do not
  std::optional<Regime> regime;                 ///< where in which variable it is largest
  std::string looks;                            ///< one sentence: how it varies in time
};

/// How long a stage took. Not part of a report: equal input gives equal reports.
struct StageTiming {
  std::string stage;     ///< in the words of Options::at_stage
  double seconds = 0.0;  ///< wall-clock time
};

/// Everything a diagnosis found.
struct Diagnosis {
  Verdict verdict = Verdict::insufficient;  ///< the conclusion in one word
  std::string reason;                       ///< one sentence in plain words: why this verdict
  Reason why = Reason::too_little_data;     ///< the same as a line of the verdict table
  DecisionNumbers numbers;                  ///< what the verdict was read off
  std::string loop;                         ///< of a joint: `open`, `closed` or `unknown`; else empty
  std::vector<Location> where;              ///< largest share first; empty without a gap
  std::vector<Cause> cause;                 ///< the chosen explanation; empty where none is
  std::vector<std::vector<std::string>> alternatives;  ///< as good on this data, likeliest first; ids of each
  std::vector<GapScore> gap;                           ///< one per judged signal
  std::string next_experiment;                         ///< what to record next to tell more; may be empty
  double none_of_these = 0.0;                          ///< probability of a cause outside the catalogue

  std::vector<std::string> not_judged;      ///< one sentence for each signal or block that lacks a column
  std::vector<Finding> findings;            ///< of the data, recording by recording
  std::vector<RankedExplanation> ranking;   ///< everything weighed, likeliest first
  std::vector<ConstantEstimate> constants;  ///< every constant that a fit may move, whatever the verdict
  ParameterCorrelation correlation;         ///< of the chosen explanation; empty where none is
  std::optional<Remaining> remaining;       ///< of a partial verdict
  std::string recalibration;  ///< one sentence where refitted constants do worse on held-out data; else empty
  /// One per held-out recording: what `gap` was measured on, restarted where that was. Empty where nothing was simulated.
  std::vector<HeldOutPrediction> predictions;
  std::vector<SignalSeries> series;  ///< curves of every judged signal over the held-out recordings
  std::vector<MissingQuantity> missing_quantities;  ///< what the residuals ask for, where that can be said
  Model augmented;                   ///< the model with the causes added and its constants moved along
  Model recalibrated;                ///< the model with its own constants refitted
  std::vector<StageTiming> timings;  ///< in the order in which the stages ran
};

}  // namespace thermopower::gap
