// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "engine.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/simulate.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <utility>

namespace thermopower::gap::files {

Diagnosis run_diagnosis(const Model& model, const std::vector<Recording>& train,
                        const std::vector<Recording>& held_out, const Options& options) {
  return diagnose(model, train, held_out, options, standard_catalogue());
}

DataReport run_check(const Model& model, const std::vector<Recording>& train,
                     const std::vector<Recording>& held_out, const Options& options) {
  return check_data(model, train, held_out, options, standard_catalogue());
}

std::vector<SimulatedColumn> run_simulation(const Model& model, const Recording& recording,
                                            double horizon_s) {
  SimulationOptions options;
  options.horizon_s = horizon_s;
  std::vector<SimulatedColumn> list;
  for (auto& one : simulate(model, recording, options, standard_catalogue()))
    list.push_back({to_string(one.signal), std::move(one.values)});
  return list;
}

}  // namespace thermopower::gap::files
