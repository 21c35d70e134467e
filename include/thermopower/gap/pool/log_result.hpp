// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/mixed_effects.hpp>
#include <thermopower/gap/verdict.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap::pool {

/// Whether a cause or a coordinate is a constant of the model itself, and no effect. The pool knows no plant: so reports call them.
inline bool is_constant(const std::string& id) { return id.rfind("calibration.", 0) == 0; }

/// The ids in an explanation's name, which has " + " between them.
inline std::vector<std::string> ids_in(const std::string& name) {
  constexpr char between[] = " + ";
  std::vector<std::string> ids;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t end = std::min(name.find(between, at), name.size());
    ids.push_back(name.substr(at, end - at));
    at = end + sizeof between - 1;
  }
  return ids;
}

/// The part that an explanation adds to the model: its name without the constants that it releases. Constants are
/// coordinates of every explanation, and how they spread is what a fleet knows: a unit whose constants alone are off lacks
/// nothing.
/// @param name  of the explanation; empty: nothing is missing
inline std::string structure_of(const std::string& name) {
  std::string structure;
  for (const std::string& id : ids_in(name))
    if (!is_constant(id)) structure += (structure.empty() ? "" : " + ") + id;
  return structure;
}

/// Where the fit of one explanation to one log ended; as a report's `ranking` has it.
///
/// @snippet plant_examples.cpp fleet
/// How to: @ref diagnose_a_fleet.
struct FittedExplanation {
  std::string name;          ///< ids of its effects, " + " between them; empty: nothing is missing
  std::size_t effects = 0;   ///< how many those are
  double probability = 0.0;  ///< as the report has it
  double misfit = 1.0;       ///< reduced chi^2 of the training data
  double train_gain =
      0.0;  ///< twice the log likelihood ratio of the training data against the empty explanation
  double held_out_gain =
      std::numeric_limits<double>::quiet_NaN();  ///< the same of held-out data; NaN: not looked at
  int hidden_starts = 0;           ///< that the held-out gain fitted: then it is not a prediction alone
  bool on_bounds = false;          ///< it ended on the bounds of its range, and is none
  std::vector<std::string> names;  ///< of the coordinates: constants first, then the effects' parameters
  std::vector<bool> logarithmic;   ///< whether a coordinate is the logarithm of its value
  std::vector<bool> at_bound;      ///< whether it ended on a bound
  Estimate fit;                    ///< its covariance is 0 by 0 where nobody looked at the curvature

  /// Its estimate in some coordinates; none where it lacks one, or has no numbers.
  std::optional<Estimate> estimate_of(const std::vector<std::string>& coordinates) const {
    if (!is_usable()) return std::nullopt;
    std::vector<Eigen::Index> places;
    for (const std::string& one : coordinates) {
      places.push_back(std::find(names.begin(), names.end(), one) - names.begin());
      if (places.back() == fit.at.size()) return std::nullopt;
    }
    return Estimate{fit.at(places), fit.covariance(places, places)};
  }

  /// Whether somebody looked at the curvature of its fit, and all is finite.
  bool is_usable() const {
    return fit.covariance.rows() == fit.at.size() && fit.at.size() > 0 && fit.at.allFinite() &&
           fit.covariance.allFinite();
  }

  /// How many coordinates are its effects' own.
  int own_parameters() const {
    // A constant that was released is one, too.
    const std::vector<std::string> ids = ids_in(name);
    return static_cast<int>(std::count_if(ids.begin(), ids.end(), is_constant) +
                            std::count_if(names.begin(), names.end(), std::not_fn(is_constant)));
  }
};

/// The result of one log's diagnosis for the fleet.
///
/// @snippet plant_examples.cpp fleet
/// How to: @ref diagnose_a_fleet.
struct LogResult {
  std::string log;   ///< its name
  std::string unit;  ///< the actuator that was recorded; empty: the log's own
  double time = std::numeric_limits<double>::quiet_NaN();  ///< when, in days; NaN: nobody says
  std::optional<Verdict> verdict;                          ///< of its diagnosis; none: there is no report
  std::string reason;                                      ///< of the verdict, or why there is no report
  std::size_t chosen_effects = 0;                          ///< how many causes it names
  std::vector<FittedExplanation> ranking;                  ///< everything weighed

  /// The explanation of a name, or none.
  const FittedExplanation* find(const std::string& name) const {
    for (const FittedExplanation& one : ranking)
      if (one.name == name) return &one;
    return nullptr;
  }

  /// The likeliest explanation of a structure (structure_of()), or none: constants are released in it where this log
  /// asks for that. Among equals the one that is listed first.
  const FittedExplanation* likeliest(const std::string& structure) const {
    // An explanation with more effects than the named cause counts as doing no more than it.
    const FittedExplanation* best = find(structure);
    const std::size_t most = std::max(chosen_effects, best == nullptr ? 0 : best->effects);
    for (const FittedExplanation& one : ranking)
      if (one.effects <= most && structure_of(one.name) == structure &&
          (best == nullptr || one.probability > best->probability))
        best = &one;
    return best;
  }
};

}  // namespace thermopower::gap::pool
