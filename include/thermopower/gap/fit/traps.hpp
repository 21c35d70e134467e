// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/candidate.hpp>
#include <thermopower/gap/fit/fitter.hpp>

#include <algorithm>
#include <utility>
#include <vector>

/// @file traps.hpp
/// Places where a fit ends without an answer, and ways out of them.

namespace thermopower::gap::engine {

/// A friction without a transition has no derivative by it. A fit that came to that bound is blind there, and begins once
/// more from the standard value. Nor does the way to that bound always lead downhill: a fit that ended shortly before it
/// begins once more there. A shape that ended at its far bound may have run there from a start on the wrong side. Then all
/// parameters with a standard begin once more from it. Two families of shapes meet at the standard one, and a fit that
/// stopped shortly below it looks at the other side. A hopeless fit stays where it is.
inline void free_from_trap(Fitter& fitter, Candidate& candidate, const FitOptions& options) {
  if (candidate.fit.cost > options.hopeless) return;
  Eigen::VectorXd again = candidate.fit.point;
  bool trapped = false, far = false;
  for (std::size_t i = 0; i < candidate.list.size(); ++i) {
    const Coordinate& one = candidate.list[i];
    const auto at = static_cast<Eigen::Index>(i);
    if (!one.standard) continue;
    if (!one.logarithmic && again[at] >= one.upper) far = trapped = true;
    const bool other_side = one.two_families && again[at] < *one.standard && again[at] > 0.5 * one.lower;
    if (other_side) {
      again[at] = 2.0 * *one.standard - again[at];
      trapped = true;
    }
    if (!one.logarithmic || !(*one.standard > one.lower) || again[at] > *one.standard) continue;
    again[at] = again[at] > one.lower + 1e-9 ? one.lower : *one.standard;
    trapped = true;
  }
  if (!trapped) return;
  for (std::size_t i = 0; far && i < candidate.list.size(); ++i)
    if (candidate.list[i].standard) again[static_cast<Eigen::Index>(i)] = *candidate.list[i].standard;
  FitOptions better = options;  // soon, by as much as tells that it was a trap
  better.hopeful = 3;
  better.hopeless = 0.99 * candidate.fit.cost;
  FitResult freed = fitter.minimise(again, better, &candidate.fit.starts);
  if (freed.cost < candidate.fit.cost) candidate.fit = std::move(freed);
}

/// Where a fit of a parameter that has to exceed another one (Parameter::exceeds) ended below it: places above it to begin from.
/// At the first one the other parameter is as small as it may be. At the second one the shapes have their standard values,
/// and a small part beside something else (EffectInfo::where_small) is halved. Inside, a film takes most of a rise away,
/// and the rise has grown to make up for that. Empty where nothing ended so.
inline std::vector<Eigen::VectorXd> places_outside(const Candidate& candidate) {
  Eigen::VectorXd outside = candidate.fit.point, smaller_too = outside;
  bool is_inside = false;
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    const std::vector<Parameter>& parameters = entry->info.parameters;
    const auto place = [&](const std::string& name) { return candidate.place_of(*entry, name); };
    for (const Parameter& parameter : parameters) {
      if (parameter.exceeds.empty()) continue;
      const std::size_t other = place(parameter.exceeds);
      if (other >= candidate.list.size() || candidate.value(place(parameter.name)) > candidate.value(other))
        continue;
      is_inside = true;
      for (const Parameter& shape : parameters) {
        const std::size_t at = place(shape.name);
        if (candidate.list[at].standard)
          smaller_too[static_cast<Eigen::Index>(at)] = *candidate.list[at].standard;
      }
      if (const auto& grown = entry->info.where_small) {
        const auto at = [&](int i) {
          return static_cast<Eigen::Index>(place(parameters[static_cast<std::size_t>(i)].name));
        };
        smaller_too[at(grown->small)] = 0.5 * outside[at(grown->beside)];
      }
      for (Eigen::VectorXd* one : {&outside, &smaller_too})
        (*one)[static_cast<Eigen::Index>(other)] = candidate.list[other].lower;
    }
  }
  if (!is_inside) return {};
  return {outside, smaller_too};
}

/// A fit that ended inside (places_outside()) can often do the same from outside. It begins once more there, and stays
/// unless it is clearly worse. A hopeless fit stays where it is.
inline void lead_outside(Fitter& fitter, Candidate& candidate, const FitOptions& options) {
  if (candidate.fit.cost > options.hopeless) return;
  constexpr double clearly_worse = 1.02;  // of the cost
  FitOptions better = options;
  better.hopeless = clearly_worse * candidate.fit.cost;
  better.hopeful = 14;  // the way leads through worse places
  for (const Eigen::VectorXd& from : places_outside(candidate)) {
    FitResult out = fitter.minimise(from, better, &candidate.fit.starts);
    if (out.cost >= better.hopeless) continue;
    candidate.fit = std::move(out);
    return;
  }
}

/// The end of a fit of a cause that strikes (EffectInfo::strikes), and the places beside it. Each place moves one parameter
/// of such a cause by some hundredths to some tenths. Empty where no cause does.
inline std::vector<Eigen::VectorXd> places_beside(const Candidate& candidate) {
  std::vector<Eigen::VectorXd> places;
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    if (!entry->info.strikes) continue;
    if (places.empty()) places.push_back(candidate.fit.point);
    for (const Parameter& parameter : entry->info.parameters) {
      const std::size_t i = candidate.place_of(*entry, parameter.name);
      const Coordinate& one = candidate.list[i];
      const auto at = static_cast<Eigen::Index>(i);
      for (const double share : {0.02, 0.05, 0.1, 0.2, 0.4})
        for (const double by : {-share, share}) {
          Eigen::VectorXd place = candidate.fit.point;
          place[at] =
              std::clamp(one.logarithmic ? place[at] + by : place[at] * (1.0 + by), one.lower, one.upper);
          places.push_back(std::move(place));
        }
    }
  }
  return places;
}

/// Out of what free_from_trap() and lead_outside() know.
inline void free_from_traps(Fitter& fitter, Candidate& candidate, const FitOptions& options) {
  free_from_trap(fitter, candidate, options);
  lead_outside(fitter, candidate, options);
}

}  // namespace thermopower::gap::engine
