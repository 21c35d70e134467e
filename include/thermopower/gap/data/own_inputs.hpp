// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/plant_info.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <cmath>

namespace thermopower::gap::engine {

/// Takes from a recording what a plant of one's own needs, by the names of its columns.
/// @param held  fills holes of a column over the runs: `held(values, runs)`
template <class Held>
Inputs prepare_own(const plant::PlantInfo& info, const Recording& recording, const Held& held) {
  Inputs inputs;
  inputs.own = true;
  inputs.name = recording.name;
  inputs.t_s = recording.t_s;
  inputs.runs = recording.spans();
  bool complete = true;
  for (const plant::PlantInput& input : info.inputs) {
    if (recording.has(input.name)) {
      inputs.own_inputs.push_back(held(recording.column(input.name), inputs.runs));
    } else {
      if (!input.otherwise) {
        complete = false;
        inputs.not_judged.push_back({"", "nothing is judged: the recording has no column " + input.name});
      }
      inputs.own_inputs.push_back(Eigen::VectorXd::Constant(recording.rows(), input.otherwise.value_or(0.0)));
    }
  }
  for (std::size_t i = 0; i < info.signals.size(); ++i) {
    const std::string& name = info.signals[i].name;
    if (!recording.has(name))
      inputs.not_judged.push_back(
          {name, plant::the_variable(name) + " is not judged: the recording has no column " + name});
    else if (complete) inputs.measured[i] = recording.column(name);
  }
  return inputs;
}

}  // namespace thermopower::gap::engine
