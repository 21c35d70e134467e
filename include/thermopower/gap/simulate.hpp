// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/catalogue.hpp>
#include <thermopower/gap/standard_catalogue.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <string>
#include <vector>

namespace thermopower::gap {

/// What the model is given besides the recorded inputs.
enum class SimulationMode {
  /// As a gap is judged: temperature and current run freely over whole runs from the first measured
  /// temperature; the axis runs in windows of `horizon_s`, each restarted from the measured state, states
  /// that nobody measures carried on.
  free_running,
  /// Each submodel on its measured inputs: current from the measured `motor_C`; temperature from the measured
  /// `current_A`. The axis as in free_running.
  measured_inputs,
};

/// How to simulate.
struct SimulationOptions {
  SimulationMode mode = SimulationMode::free_running;
  double horizon_s = 0.5;  ///< axis only; 0 or infinite: whole runs
};

/// One simulated signal, a value per row of the recording; NaN where it could not be simulated.
struct SimulatedSignal {
  std::string signal;  ///< `current_A`, `motor_C`, `angle_deg` or `rate_dps`
  Eigen::VectorXd values;
};

/// Simulates every signal that the model has a law for and the recording has the inputs for.
/// Effects named in the model act, with the catalogue's equations.
/// @throws InvalidInput for an effect or parameter that the catalogue does not know.
std::vector<SimulatedSignal> simulate(const Model& model, const Recording& recording,
                                      const SimulationOptions& options = {},
                                      const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::gap
