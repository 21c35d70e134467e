// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/fitter.hpp>
#include <thermopower/gap/fit/signal_sums.hpp>
#include <thermopower/gap/rule.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// An explanation with its fit and what speaks for it.
struct Candidate {
  Explanation explanation;       ///< the causes it consists of
  std::vector<Coordinate> list;  ///< of the fit: every constant, then the effects' parameters
  FitResult fit;                 ///< on training data, in the coordinates of `list`
  SignalSums train;              ///< residuals of the fit where it was fitted
  SignalSums held_out;    ///< as a gap is judged, in units of the noise floor; empty until somebody looks
  int hidden_starts = 0;  ///< starts that the held-out score fitted, because nobody measures them
  double deviance = 0.0;  ///< twice the negative log evidence, without the shared constant
  double train_deviance = 0.0;     ///< what the training data alone say, no penalty counted
  double held_out_deviance = 0.0;  ///< what the held-out data alone say; 0 until somebody looks
  double against = 0.0;      ///< log odds of the best candidate against it, >= 0; imperfect models considered
  double probability = 0.0;  ///< among the candidates weighed together, 0..1
  bool on_bounds = false;    ///< a cause ended on the bounds of its range, and is none
  bool settled = false;      ///< a fit goes nowhere from where it ended, as long as data and noise stay
  bool idle = false;      ///< another one says the same with less: moved constants alone, or a simpler cause
  bool doubtful = false;  ///< a cause of a set may as well not be there: the others do what it does
  bool makes_worse = false;  ///< its causes make held-out data worse than refitted constants do

  /// Where the fit ended with the coordinate at this place of `list`: its value, in its unit.
  double value(std::size_t place) const {
    assert(place < list.size() && fit.point.size() == static_cast<Eigen::Index>(list.size()));
    return list[place].value_of(fit.point[static_cast<Eigen::Index>(place)]);
  }

  /// Place in `list` of a parameter of one of its effects; the list's size where it has none of that name.
  std::size_t place_of(const CatalogueEntry& entry, const std::string& parameter) const {
    const std::string name = entry.info.id + "." + parameter;
    const auto is_it = [&](const Coordinate& one) { return one.name == name; };
    return static_cast<std::size_t>(std::find_if(list.begin(), list.end(), is_it) - list.begin());
  }
};

/// Indices into Model::calibrated() of the constants that a fit moved by more than is known of them.
inline std::vector<int> moved_constants(const Candidate& candidate, const Model& model) {
  constexpr double rounding = 1e-9;  // of the bound that the empty explanation stays within
  std::vector<int> moved;
  int index = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    if (std::abs(candidate.fit.point[index]) >
        known_constants.within * model.uncertainty_of(constant) * (1.0 + rounding))
      moved.push_back(index);
    ++index;
  }
  return moved;
}

/// The price of a candidate's moved constants, a released one included: twice a log odds.
inline double price_of_constants(const Candidate& candidate, const Model& model) {
  assert(candidate.fit.point.size() >= static_cast<Eigen::Index>(model.calibrated().size()));
  double price = 0.0;
  Eigen::Index at = 0;
  for (const CalibratedConstant& constant : model.calibrated())
    price += Prior{model.uncertainty_of(constant)}.price(candidate.fit.point[at++]);
  return price;
}

/// The price of a parameter where explanations are compared, twice a log odds: price_of_parameter(), or price_beside_constant() if a
/// constant of the model does the same (Parameter::told_by_constant), and the data tell both together only.
/// @param coordinate  the parameter's
inline double cost_of_parameter(const plant::Parameter& parameter, const Coordinate& coordinate,
                                const Model& model, double log_samples) {
  if (!holds(Rule::parsimony)) return 0.0;
  if (parameter.told_by_constant.empty()) return log_samples;
  for (const CalibratedConstant& constant : model.calibrated())
    if (constant.id == parameter.told_by_constant)
      return price_beside_constant(coordinate.upper - coordinate.lower, Prior{model.uncertainty_of(constant)},
                                   log_samples);
  return log_samples;
}

/// The price of a candidate's free parameters, own states, and starts that nobody measures.
inline double cost_of_parameters(const Candidate& candidate, const Model& model, double log_samples) {
  double cost = candidate.hidden_starts * log_samples;
  std::size_t at = model.calibrated().size();
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    cost += static_cast<double>(entry->info.states.size()) * log_samples;
    for (const plant::Parameter& parameter : entry->info.parameters) {
      const Coordinate& coordinate = candidate.list[at++];
      if (candidate.explanation.counts(parameter))
        cost += cost_of_parameter(parameter, coordinate, model, log_samples);
    }
  }
  return cost;
}

}  // namespace thermopower::gap::engine
