// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/plant/plant.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap {

/// One coordinate of a fit.
struct Coordinate {
  std::string name;                     ///< `calibration.<id>` or `<effect>.<parameter>`
  std::string unit;                     ///< of the value; "1" for the factor on a constant
  double lower = 0.0;                   ///< bound, in the fit's coordinate
  double upper = 0.0;                   ///< bound, in the fit's coordinate
  double start = 0.0;                   ///< where a fit begins, in the fit's coordinate
  double prior_sd = 0.0;                ///< of a Gaussian around 0; 0: none
  bool logarithmic = false;             ///< value = exp(coordinate)
  std::optional<double> standard = {};  ///< where to begin anew should a fit end on the lower bound
};

/// A set of causes: effects of the catalogue that act, and constants that are off by more than their slack.
struct Explanation {
  std::vector<const CatalogueEntry*> effects;  ///< not owned: the catalogue must outlive it
  std::vector<int> released;                   ///< indices into Model::calibrated()

  /// How many causes it has.
  std::size_t size() const { return effects.size() + released.size(); }

  /// The ids of its causes.
  std::vector<std::string> ids(const Model& model) const {
    std::vector<std::string> list;
    for (const CatalogueEntry* entry : effects) list.push_back(entry->info.id);
    const std::vector<CalibratedConstant> constants = model.calibrated();
    for (int index : released) list.push_back("calibration." + constants[static_cast<std::size_t>(index)].id);
    return list;
  }

  /// Whether every cause of `other` is one of its own.
  bool includes(const Explanation& other) const {
    const auto within = [](const auto& all, const auto& few) {
      for (const auto& one : few)
        if (std::find(all.begin(), all.end(), one) == all.end()) return false;
      return true;
    };
    return within(effects, other.effects) && within(released, other.released);
  }

  /// Both sets of causes together.
  Explanation with(const Explanation& other) const {
    Explanation both = *this;
    for (const CatalogueEntry* entry : other.effects)
      if (std::find(both.effects.begin(), both.effects.end(), entry) == both.effects.end())
        both.effects.push_back(entry);
    for (int index : other.released)
      if (std::find(both.released.begin(), both.released.end(), index) == both.released.end())
        both.released.push_back(index);
    return both;
  }

  /// Number of parameters of its own, the constants' slack not counted.
  int parameter_count() const {
    std::size_t count = released.size();
    for (const CatalogueEntry* entry : effects) count += entry->info.parameters.size();
    return static_cast<int>(count);
  }
};

/// How far constants may move.
struct Slack {
  double fraction = 0.04;       ///< of a constant that is not a cause
  double released_factor = 10;  ///< of a constant that is one
};

/// The coordinates of an explanation: first one per constant (logarithm of its factor), then its effects'
/// parameters.
inline std::vector<Coordinate> coordinates(const Model& model, const Explanation& explanation,
                                           const Slack& slack) {
  std::vector<Coordinate> list;
  int index = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const bool free = std::find(explanation.released.begin(), explanation.released.end(), index) !=
                      explanation.released.end();
    const double within = constant.has_slack ? -std::log1p(-slack.fraction) : 0.0;
    const double reach = free ? std::log(slack.released_factor) : within;
    // The prior only keeps combinations that no recording can tell (a common factor of all torques) in place.
    list.push_back(
        {"calibration." + constant.id, "1", -reach, reach, 0.0, free ? 0.0 : std::max(reach, 1e-9), true});
    ++index;
  }
  for (const CatalogueEntry* entry : explanation.effects)
    for (const Parameter& parameter : entry->info.parameters) {
      const auto to = [&](double value) { return parameter.logarithmic ? std::log(value) : value; };
      list.push_back({entry->info.id + "." + parameter.name,
                      parameter.unit,
                      to(parameter.lower),
                      to(parameter.upper),
                      to(parameter.starts.front()),
                      0.0,
                      parameter.logarithmic,
                      {}});
      if (parameter.standard) list.back().standard = to(*parameter.standard);
    }
  return list;
}

/// A point of a fit as a plant takes it.
inline ParameterPoint point_of(const Model& model, const Explanation& explanation,
                               const std::vector<Coordinate>& coordinates, const Eigen::VectorXd& at) {
  ParameterPoint point;
  const std::size_t constants = model.calibrated().size();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double coordinate = at[static_cast<Eigen::Index>(i)];
    const double value = coordinates[i].logarithmic ? std::exp(coordinate) : coordinate;
    (i < constants ? point.factors : point.parameters).push_back(value);
    point.speed.push_back(coordinates[i].logarithmic ? value : 1.0);
  }
  point.effects = explanation.effects;
  return point;
}

/// The model with an explanation's causes in it and its constants moved.
inline Model augmented(const Model& model, const Explanation& explanation,
                       const std::vector<Coordinate>& coordinates, const Eigen::VectorXd& at) {
  Model result = model;
  int index = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    for (const std::string& field : constant.fields) {
      const std::string name = constant.block + "." + field;
      result.set(name, result.get(name) * std::exp(at[index]));
    }
    ++index;
  }
  for (const CatalogueEntry* entry : explanation.effects)
    for (const Parameter& parameter : entry->info.parameters) {
      const bool logarithmic = coordinates[static_cast<std::size_t>(index)].logarithmic;
      result.effects[entry->info.id][parameter.name] = logarithmic ? std::exp(at[index]) : at[index];
      ++index;
    }
  return result;
}

}  // namespace thermopower::gap
