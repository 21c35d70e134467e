// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace thermopower::gap {

/// The content of a recording for one judged signal.
struct SignalReport {
  std::string signal;        ///< `motor_C`, ...
  std::string unit;          ///< of the numbers below
  Eigen::Index samples = 0;  ///< that are believed
  double range = 0.0;        ///< 5th to 95th percentile
  double noise = 0.0;        ///< standard deviation of the sensor from row to row; no model takes part
  double misfit = 0.0;       ///< root mean square of simulated minus measured, as configured
};

/// How well a recording determines one of the model's constants.
struct ConstantReport {
  std::string constant;   ///< id as in `calibration.<id>`
  double alone = 0.0;     ///< standard deviation as a share of its value, if all others were known
  double together = 0.0;  ///< the same with all of them unknown
  bool is_place = false;  ///< an angle at which something is: both are in rad
};

/// Constants that a recording determines only together.
struct Combination {
  std::vector<std::string> constants;  ///< ids; a minus before those that must move the other way
  double sd = 0.0;                     ///< by what share of their values they can move together unnoticed
};

/// Whether a recording can show an effect.
struct EffectReport {
  std::string effect;  ///< id
  /// Root mean square of what an effect of usual size changes and moved constants cannot imitate. In noise units of the
  /// signal that shows it best.
  double visible = 0.0;
  bool absorbed = false;           ///< moved constants imitate it almost entirely
  std::vector<std::string> alike;  ///< other effects that look the same here (cosine above 0.95)
};

/// The worth of data before anything is fitted.
struct DataReport {
  std::vector<Finding> findings;           ///< those that decide first
  std::string too_little;                  ///< what a diagnosis lacks to say anything; empty: nothing
  std::string next_experiment;             ///< what would mend that; empty where nothing lacks
  std::vector<std::string> not_judged;     ///< one sentence for each signal that lacks a column
  std::vector<SignalReport> signals;       ///< of the training recordings
  std::vector<ConstantReport> constants;   ///< of the blocks that are judged
  std::vector<Combination> only_together;  ///< weakest first
  std::vector<EffectReport> effects;       ///< that the columns allow, the most visible first
  std::vector<std::string>
      need_columns;  ///< effects that nothing can show for want of a column: `id: column, ...`
};

/// Looks at the data of a diagnosis: their faults, what these columns and this excitation can show, and which constants
/// they determine. Nothing is fitted; see `thermopower-gap check`.
/// @throws InvalidInput where the model, a recording or an option is invalid
DataReport check_data(const Model& model, const std::vector<Recording>& train,
                      const std::vector<Recording>& held_out = {}, const Options& options = {},
                      const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::gap

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/gap/detail/check_data.hpp>
#endif
