// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/gap/fit/judgeable.hpp>
#include <thermopower/plant/calibration_id.hpp>

#include <algorithm>
#include <string>
#include <vector>

/// @file single_causes.hpp
/// The explanations that a search begins with.

namespace thermopower::gap::engine {

/// Every single cause that model and recordings allow to be judged: the catalogue's effects, then the constants that may be
/// causes.
/// @param without  ids that are left out
inline std::vector<Explanation> single_causes(const Model& model, const Catalogue& catalogue,
                                              const std::vector<std::string>& without,
                                              const std::vector<Inputs>& recordings) {
  std::vector<Explanation> list;
  const auto removed = [&](const std::string& id) {
    return std::find(without.begin(), without.end(), id) != without.end();
  };
  for (const CatalogueEntry& entry : catalogue.entries())
    if (!removed(entry.info.id) && can_be_judged(entry, model, recordings)) list.push_back({{&entry}, {}});
  const std::vector<CalibratedConstant> constants = model.calibrated();
  for (std::size_t i = 0; i < constants.size(); ++i)
    if (constants[i].may_be_cause && !removed(plant::calibration_id(constants[i].id)) &&
        can_be_judged(constants[i], model, recordings))
      list.push_back({{}, {static_cast<int>(i)}});
  return list;
}

}  // namespace thermopower::gap::engine
