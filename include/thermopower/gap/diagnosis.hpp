// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap {

/// What a diagnosis concludes.
enum class Verdict {
  no_gap,        ///< the simulation, its constants within their slack, scores what noise allows
  explained,     ///< the causes bring held-out data near the noise floor, and nothing else does
  ambiguous,     ///< several explanations do, and this recording cannot tell them apart
  unexplained,   ///< there is a gap, and no effect (or small set of them) of the catalogue closes it
  insufficient,  ///< too little data for any statement
};

/// The verdict as the report spells it.
inline const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::no_gap:
      return "no_gap";
    case Verdict::explained:
      return "explained";
    case Verdict::ambiguous:
      return "ambiguous";
    case Verdict::unexplained:
      return "unexplained";
    case Verdict::insufficient:
      return "insufficient";
  }
  return "insufficient";
}

/// A closed interval.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Part of a recorded variable's range.
struct Regime {
  std::string variable;  ///< a column or a derived one (`rise_K`)
  double from = 0.0;
  double to = 0.0;
};

/// Where simulation and recording part, found from residuals alone.
struct Location {
  std::string signal;    ///< `motor_C`, `current_A`, `angle_deg` or `rate_dps`
  std::string submodel;  ///< `electrical`, `thermal.loss`, `mechanical.friction`, `sensing.angle`, ...
  double share = 0.0;    ///< part of that signal's excess residual, 0..1
  std::optional<Regime> regime;  ///< where in which variable it is largest
  std::string evidence;          ///< one sentence
};

/// A fitted parameter of an effect.
struct ParameterEstimate {
  std::string name;
  double value = 0.0;
  Interval ci95;          ///< accounts for autocorrelated residuals
  std::string unit;       ///< "1" for a pure number
  bool at_bound = false;  ///< ended on a bound of its range: then it is no explanation
};

/// One effect of the chosen explanation.
struct Cause {
  std::string effect;
  double probability = 0.0;  ///< that this effect acts, 0..1
  std::vector<ParameterEstimate> parameters;
};

/// The gap of one signal on held-out data; RMSE of simulation against recording.
struct GapScore {
  std::string signal;
  std::string unit;
  std::optional<double> horizon_s;  ///< length of a window; none: whole runs
  double before = 0.0;              ///< the model as configured
  double recalibrated = 0.0;        ///< its own constants refitted without a limit, no effect added
  double after = 0.0;               ///< with the causes (equal to `before` where there are none)
  double noise_floor = 0.0;         ///< what a perfect model would score
  double shrunk_by = 0.0;           ///< 1 - after / before
  Interval ci95;                    ///< of shrunk_by, by a paired block bootstrap
};

/// Severity of a data-gate finding.
enum class Severity { note, warning, error };

/// Something about the data itself, found before any physics.
struct Finding {
  std::string code;  ///< stable id such as `irregular_stamps`, `frozen_channel`, `clock_shift`
  Severity severity = Severity::note;
  std::string recording;
  std::string column;  ///< may be empty
  std::string message;
};

/// Measured and simulated curves of one signal over one held-out run, for pictures.
struct SignalSeries {
  std::string signal;
  std::string unit;
  std::string recording;
  Eigen::VectorXd t_s;
  Eigen::VectorXd measured;      ///< NaN where missing
  Eigen::VectorXd baseline;      ///< as configured
  Eigen::VectorXd recalibrated;  ///< own constants refitted
  Eigen::VectorXd augmented;     ///< with the causes (the baseline where there are none)
};

/// The missing physical quantity itself (watts, newton metres, volts) against the variable that orders it.
struct MissingQuantity {
  std::string signal;    ///< the signal it was inferred from
  std::string quantity;  ///< `missing heat`, `missing torque`, `missing voltage`, ...
  std::string unit;      ///< W, N m, V, ...
  std::string variable;  ///< abscissa, such as `rise_K` or `rate_rad_per_s`
  std::string variable_unit;
  Eigen::VectorXd x;       ///< abscissa of the binned samples
  Eigen::VectorXd value;   ///< missing quantity there
  Eigen::VectorXd spread;  ///< its standard error
  Eigen::VectorXd effect;  ///< what the chosen causes supply there; empty where there are none
};

/// How alike two explanations look to this recording.
struct Likeness {
  std::vector<std::string> effects;
  double cosine = 0.0;  ///< of the signatures, whitened and freed of the baseline's constants
};

/// One explanation that was weighed.
struct RankedExplanation {
  std::vector<std::string> effects;  ///< one id, or several acting together; empty: "nothing is missing"
  double probability = 0.0;          ///< 0..1 over all explanations weighed and "none of these"
  double score = 0.0;                ///< reduced chi^2 on training data
  double delta_score = 0.0;          ///< evidence against it relative to the best, >= 0 (twice a log odds)
  double held_out_ratio = 0.0;       ///< held-out score over the re-calibrated baseline's, < 1 is better
  bool absorbed = false;             ///< re-calibration imitates it: this recording cannot show it
  bool at_bound = false;             ///< a parameter ended on its bound
  bool refused = false;              ///< makes held-out data worse
  std::vector<ParameterEstimate> parameters;  ///< named `<effect>.<parameter>`
  std::vector<Likeness> confusable;           ///< others with a likeness of 0.9 or more
};

/// A constant of the baseline as configured and as the explanation moved it (within its slack).
struct MovedConstant {
  std::string name;  ///< id as in `calibration.<id>`
  double configured = 0.0;
  double fitted = 0.0;
};

/// How long a stage took. Not part of a report: equal input gives equal reports.
struct StageTiming {
  std::string stage;
  double seconds = 0.0;
};

/// Everything a diagnosis found.
struct Diagnosis {
  Verdict verdict = Verdict::insufficient;
  std::string reason;  ///< one sentence in plain words: why this verdict
  std::vector<Location> where;
  std::vector<Cause> cause;
  std::vector<std::vector<std::string>> alternatives;
  std::vector<GapScore> gap;
  std::string next_experiment;
  double none_of_these = 0.0;  ///< probability that the cause is outside the catalogue

  std::vector<std::string> not_judged;  ///< one sentence for each signal or block that lacks a column
  std::vector<Finding> findings;        ///< data gate
  std::vector<RankedExplanation> ranking;
  std::vector<MovedConstant> constants;
  std::vector<SignalSeries> series;
  std::vector<MissingQuantity> missing_quantities;
  Model augmented;     ///< the model with the causes added and its constants moved within their slack
  Model recalibrated;  ///< the model with its own constants refitted without a limit
  std::vector<StageTiming> timings;
};

}  // namespace thermopower::gap
