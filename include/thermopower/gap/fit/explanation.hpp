// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/statistical_model.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/plant/plant.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// One coordinate of a fit.
struct Coordinate {
  std::string name;          ///< `calibration.<id>` or `<effect>.<parameter>`
  std::string unit;          ///< of the value; "1" for the factor on a constant, its own for a place
  double lower = 0.0;        ///< bound, in the fit's coordinate
  double upper = 0.0;        ///< bound, in the fit's coordinate
  double start = 0.0;        ///< where a fit begins, in the fit's coordinate
  Prior prior = {};          ///< around 0: the knowledge of a constant
  bool logarithmic = false;  ///< value = exp(coordinate)
  std::optional<double> standard = {};  ///< where to begin anew should a fit end on the lower bound
  bool still = false;                   ///< it stays at its start: a detail that is not looked at
  bool two_families = false;            ///< below its standard it is of another shape than above

  /// The value, in `unit`, where the fit's coordinate is `at`.
  double value_of(double at) const { return logarithmic ? std::exp(at) : at; }
  /// The fit's coordinate of a value in `unit`; that of a logarithmic one must be above 0.
  double coordinate_of(double value) const { return logarithmic ? std::log(value) : value; }
};

/// A set of causes: effects of the catalogue that act, and constants that are off by more than is known of them.
struct Explanation {
  std::vector<const CatalogueEntry*> effects;  ///< not owned: the catalogue must outlive it
  std::vector<int> released;                   ///< indices into Model::calibrated()
  bool refined = false;                        ///< details of its effects' shapes are free, too

  /// How many causes it has.
  std::size_t size() const { return effects.size() + released.size(); }

  /// The ids of its causes.
  std::vector<std::string> ids(const Model& model) const {
    std::vector<std::string> list;
    for (const CatalogueEntry* entry : effects) list.push_back(entry->info.id);
    const std::vector<CalibratedConstant> constants = model.calibrated();
    for (int index : released)
      list.push_back(plant::calibration_id(constants[static_cast<std::size_t>(index)].id));
    return list;
  }

  /// Whether an effect is one of its causes.
  bool has(const CatalogueEntry& effect) const { return is_in(effects, &effect); }
  /// Whether a constant is one. @param constant  index into Model::calibrated()
  bool releases(int constant) const { return is_in(released, constant); }

  /// Whether every cause of `other` is one of its own.
  bool includes(const Explanation& other) const {
    return std::all_of(other.effects.begin(), other.effects.end(),
                       [&](const CatalogueEntry* one) { return has(*one); }) &&
           std::all_of(other.released.begin(), other.released.end(), [&](int one) { return releases(one); });
  }

  /// Both sets of causes together.
  Explanation with(const Explanation& other) const {
    Explanation both = *this;
    both.refined = refined || other.refined;
    for (const CatalogueEntry* one : other.effects)
      if (!has(*one)) both.effects.push_back(one);
    for (const int one : other.released)
      if (!releases(one)) both.released.push_back(one);
    return both;
  }

  /// Whether a parameter of one of its effects counts as free: details of a shape do once they are looked at.
  bool counts(const Parameter& parameter) const {
    return (refined || !parameter.refines) && !parameter.given_by_data;
  }

  /// Number of parameters of its own, the other constants not counted.
  int parameter_count() const {
    std::size_t count = released.size();
    for (const CatalogueEntry* entry : effects)
      for (const Parameter& parameter : entry->info.parameters) count += counts(parameter);
    return static_cast<int>(count);
  }

  /// Twice the log odds against its effects before any data.
  double rarity() const {
    double sum = 0.0;
    for (const CatalogueEntry* entry : effects) sum += entry->info.rarity;
    return sum;
  }

  /// Whether one of its effects is a curve.
  bool has_curve() const {
    return std::any_of(effects.begin(), effects.end(),
                       [](const CatalogueEntry* one) { return one->info.curve.has_value(); });
  }

  /// Whether it is one curve and nothing else.
  bool is_a_curve() const { return effects.size() == 1 && has_curve(); }

  /// Whether sides meet and part in one of its effects (EffectInfo::strikes).
  bool strikes() const {
    return std::any_of(effects.begin(), effects.end(),
                       [](const CatalogueEntry* entry) { return entry->info.strikes; });
  }

  /// Whether its effects have details that are not free.
  bool can_be_refined() const {
    return !refined && std::any_of(effects.begin(), effects.end(), [](const CatalogueEntry* entry) {
      const auto& all = entry->info.parameters;
      return std::any_of(all.begin(), all.end(), [](const Parameter& one) { return one.refines; });
    });
  }

private:
  template <class Cause>
  static bool is_in(const std::vector<Cause>& all, const Cause& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  }
};

/// Narrows the bounds of a constant that is a parameter of one of the model's own effects to that effect's.
inline void stay_within_effect(const Model& model, const Catalogue& catalogue,
                               const CalibratedConstant& constant, Coordinate& coordinate) {
  const std::string id = constant.effect();
  const CatalogueEntry* entry = id.empty() ? nullptr : catalogue.find(id);
  if (entry == nullptr) return;
  for (const Parameter& parameter : entry->info.parameters) {
    if (parameter.name != constant.fields.front()) continue;
    const double value = model.get(constant.block + "." + parameter.name);
    // The coordinates at which the constant is on a bound; where it never is, that side stays as it is.
    const auto at = [&](double bound, double otherwise) {
      if (constant.is_place) return bound - value;
      return bound / value > 0.0 ? std::log(bound / value) : otherwise;
    };
    const double at_lower = at(parameter.lower, coordinate.lower),
                 at_upper = at(parameter.upper, coordinate.upper);
    if (constant.is_place || value > 0.0) {
      coordinate.lower = std::max(coordinate.lower, std::min(at_lower, 0.0));
      coordinate.upper = std::min(coordinate.upper, std::max(at_upper, 0.0));
    } else if (value < 0.0) {
      coordinate.upper = std::min(coordinate.upper, std::max(at_lower, 0.0));
    }
  }
}

/// How far a constant may be moved, in its coordinate: further away it is a wrong unit, or stands for something else.
inline double farthest(const CalibratedConstant& constant) {
  return constant.is_place ? known_constants.farthest_place_rad : std::log(known_constants.farthest_factor);
}

/// Whether a constant may nearly vanish. A viscous friction that was fitted without the dry one has absorbed it, and may be
/// next to nothing beside it.
inline bool may_vanish(const CalibratedConstant& constant) { return constant.id == "viscous"; }

/// How far a constant may be moved down, as farthest() has it.
inline double farthest_down(const CalibratedConstant& constant) {
  constexpr double to_next_to_nothing = 2.0;  // a hundredth
  return may_vanish(constant) ? to_next_to_nothing * farthest(constant) : farthest(constant);
}

/// The coordinates of an explanation: first one per constant (logarithm of its factor, or the addition to a place), then
/// its effects' parameters. A constant that is a cause has no prior. The others have that of the model file. In the empty
/// explanation they also stay within it: further away, the constant is the cause.
/// @param catalogue  knows the bounds of the model's own effects
inline std::vector<Coordinate> coordinates(const Model& model, const Explanation& explanation,
                                           const Catalogue& catalogue) {
  std::vector<Coordinate> list;
  int index = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    const bool free = explanation.releases(index);
    const double sd = model.uncertainty_of(constant);
    const double slack = constant.has_slack ? known_constants.within * sd : 0.0,
                 down = explanation.size() > 0 ? farthest_down(constant) : slack,
                 up = explanation.size() > 0 ? farthest(constant) : slack;
    Coordinate& one = list.emplace_back();
    one.name = plant::calibration_id(constant.id);
    one.unit = constant.is_place ? "rad" : "1";
    one.lower = -down;
    one.upper = up;
    one.logarithmic = !constant.is_place;
    if (!free) one.prior.sd = sd;
    if (!free && !constant.has_slack) one.lower = one.upper = 0.0;
    stay_within_effect(model, catalogue, constant, one);
    ++index;
  }
  for (const CatalogueEntry* entry : explanation.effects)
    for (const Parameter& parameter : entry->info.parameters) {
      Coordinate& one = list.emplace_back();
      one.name = entry->info.id + "." + parameter.name;
      one.unit = parameter.unit;
      one.logarithmic = parameter.logarithmic;
      one.lower = one.coordinate_of(parameter.lower);
      one.upper = one.coordinate_of(parameter.upper);
      one.start = one.coordinate_of(parameter.starts.front());
      const bool is_detail = parameter.refines && !explanation.refined && !model.own;
      one.still = parameter.given_by_data || is_detail;
      const double standard = one.coordinate_of(parameter.standard.value_or(parameter.starts.front()));
      if (is_detail && !parameter.given_by_data) one.start = standard;
      if (one.still) one.lower = one.upper = one.start;
      else if (parameter.standard) one.standard = standard;
      one.two_families = parameter.two_families && !one.still;
      assert(one.lower <= one.upper && one.start >= one.lower && one.start <= one.upper);
    }
  return list;
}

/// Priors of combinations of an explanation's coordinates: the values of a curve are about as large as their reference, and
/// the curve is smooth.
inline std::vector<CombinedPrior> combined_priors(const Explanation& explanation,
                                                  const std::vector<Coordinate>& list) {
  std::vector<CombinedPrior> priors;
  std::size_t of_effects = 0;
  for (const CatalogueEntry* entry : explanation.effects) of_effects += entry->info.parameters.size();
  assert(of_effects <= list.size());
  Eigen::Index at = static_cast<Eigen::Index>(list.size() - of_effects);
  for (const CatalogueEntry* entry : explanation.effects) {
    if (const auto& curve = entry->info.curve) {
      const Eigen::Index first = at + plant::curve_support_count;
      for (Eigen::Index i = 0; i < plant::curve_knot_count; ++i) {
        priors.push_back({{{first + i, 1.0}}, {known_constants.curve_value * curve->size}});
        if (i > 0 && i + 1 < plant::curve_knot_count)
          priors.push_back({{{first + i - 1, 1.0}, {first + i, -2.0}, {first + i + 1, 1.0}},
                            {known_constants.curve_bend * curve->size}});
      }
    }
    at += static_cast<Eigen::Index>(entry->info.parameters.size());
  }
  return priors;
}

/// A point of a fit as a plant takes it.
inline ParameterPoint point_of(const Model& model, const Explanation& explanation,
                               const std::vector<Coordinate>& coordinates, const Eigen::VectorXd& at) {
  assert(at.size() == static_cast<Eigen::Index>(coordinates.size()));
  ParameterPoint point;
  const std::size_t constants = model.calibrated().size();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double value = coordinates[i].value_of(at[static_cast<Eigen::Index>(i)]);
    (i < constants ? point.factors : point.parameters).push_back(value);
    point.speed.push_back(coordinates[i].logarithmic ? value : 1.0);
  }
  if (std::any_of(coordinates.begin(), coordinates.end(), [](const Coordinate& one) { return one.still; }))
    for (const Coordinate& one : coordinates) point.still.push_back(one.still);
  point.effects = explanation.effects;
  return point;
}

/// The model with an explanation's causes in it and its constants moved.
inline Model augmented(const Model& model, const Explanation& explanation,
                       const std::vector<Coordinate>& coordinates, const Eigen::VectorXd& at) {
  assert(at.size() == static_cast<Eigen::Index>(coordinates.size()));
  Model result = model;
  int index = 0;
  for (const CalibratedConstant& constant : model.calibrated()) {
    for (const std::string& field : constant.fields) {
      const std::string name = constant.block + "." + field;
      result.set(name, constant.moved(result.get(name),
                                      coordinates[static_cast<std::size_t>(index)].value_of(at[index])));
    }
    ++index;
  }
  for (const CatalogueEntry* entry : explanation.effects) {
    EffectParameters& parameters = result.effects[entry->info.id];  // a law may have none
    for (const Parameter& parameter : entry->info.parameters) {
      parameters[parameter.name] = coordinates[static_cast<std::size_t>(index)].value_of(at[index]);
      ++index;
    }
  }
  return result;
}

/// Single explanations, and every two of their constants: two that are off need not be reached from one that is.
inline std::vector<Explanation> with_pairs_of_constants(std::vector<Explanation> list) {
  std::vector<int> constants;
  for (const Explanation& one : list)
    if (one.effects.empty()) constants.push_back(one.released.front());
  for (std::size_t i = 0; i < constants.size(); ++i)
    for (std::size_t k = i + 1; k < constants.size(); ++k) list.push_back({{}, {constants[i], constants[k]}});
  return list;
}

}  // namespace thermopower::gap::engine
