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
  double penalty = 0.0;   ///< the part of that which its freedom costs
  double train_deviance = 0.0;     ///< what the training data alone say, no penalty counted
  double held_out_deviance = 0.0;  ///< what the held-out data alone say; 0 until somebody looks
  double against = 0.0;      ///< log odds of the best candidate against it, >= 0; imperfect models considered
  double probability = 0.0;  ///< among the candidates weighed together, 0..1
  bool on_bounds = false;    ///< a cause ended on the bounds of its range, and is none
  bool settled = false;      ///< a fit goes nowhere from where it ended, as long as data and noise stay
  bool idle = false;      ///< another one says the same with less: moved constants alone, or a simpler cause
  bool open = false;      ///< the data leave a parameter of a cause open
  bool doubtful = false;  ///< a cause may as well not be there: the others, or a constant, do what it does
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

/// How well data and priors tell each coordinate of a candidate if all that are before it in an order are free, as inverse
/// variances. Their product is the curvature's determinant, whatever the order.
/// @param order        places of the candidate's coordinates
/// @param counts_as_one  samples that do
/// @return by place; empty where nobody looked at the curvature
inline std::vector<double> precisions(const Candidate& candidate, const std::vector<std::size_t>& order,
                                      double counts_as_one) {
  const Eigen::MatrixXd& information = candidate.fit.information;
  const std::size_t count = order.size();
  if (information.rows() != static_cast<Eigen::Index>(count)) return {};
  assert(counts_as_one > 0.0 && count == candidate.list.size());
  // Cholesky's factor, row by row.
  std::vector<double> precision(count, 0.0);
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(information.rows(), information.cols());
  for (std::size_t i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(i), of = static_cast<Eigen::Index>(order[i]);
    double left = information(of, of);
    for (std::size_t k = 0; k < i; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      if (!(factor(column, column) > 0.0)) continue;
      double product = information(of, static_cast<Eigen::Index>(order[k]));
      for (Eigen::Index j = 0; j < column; ++j) product -= factor(row, j) * factor(column, j);
      factor(row, column) = product / factor(column, column);
      left -= factor(row, column) * factor(row, column);
    }
    // What is left by rounding is nothing.
    constexpr double rounding = 1e-12;
    if (left > rounding * information(of, of)) factor(row, row) = std::sqrt(left);
    precision[order[i]] = factor(row, row) * factor(row, row) / counts_as_one;
  }
  return precision;
}

/// The price of a candidate's free parameters, own states, and starts that nobody measures.
/// @param most           most_price_of_parameter(), which a state and a start cost, too
/// @param counts_as_one  samples that do, for the curvature
inline double cost_of_parameters(const Candidate& candidate, const Model& model, double most,
                                 double counts_as_one) {
  double cost = candidate.hidden_starts * most;
  const std::size_t constants = model.calibrated().size();
  // Constants are free in every explanation; the details of a shape are nobody's price.
  std::vector<std::size_t> order, priced, details;
  for (std::size_t i = 0; i < constants; ++i) order.push_back(i);
  std::size_t at = constants;
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    cost += static_cast<double>(entry->info.states.size()) * most;
    for (const plant::Parameter& parameter : entry->info.parameters)
      (candidate.explanation.counts(parameter) ? priced : details).push_back(at++);
  }
  if (!holds(Rule::parsimony)) return cost;
  order.insert(order.end(), priced.begin(), priced.end());
  order.insert(order.end(), details.begin(), details.end());
  const std::vector<double> precision = precisions(candidate, order, counts_as_one);
  if (precision.empty()) return cost + most * static_cast<double>(priced.size());
  for (const std::size_t place : priced) {
    const Coordinate& one = candidate.list[place];
    const auto row = static_cast<Eigen::Index>(place);
    const double own =
        row < candidate.fit.priors.rows() ? candidate.fit.priors(row, row) / counts_as_one : 0.0;
    cost += price_of_parameter({one.upper - one.lower, own}, precision[place], most);
  }
  return cost;
}

}  // namespace thermopower::gap::engine
