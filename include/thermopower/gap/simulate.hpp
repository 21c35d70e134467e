// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/gap/simulated_signal.hpp>
#include <thermopower/plant/simulation_mode.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace thermopower::gap {

/// How to simulate.
struct SimulationOptions {
  SimulationMode mode = SimulationMode::free_running;  ///< which signals are fed in
  double horizon_s = 0.5;                              ///< axis only; 0 or infinite: whole runs
};

/// Simulates every signal that the model has a law for and the recording has the inputs for.
/// Effects named in the model act, with the catalogue's equations. At a row where a window restarts the
/// values are the measured ones.
/// @throws InvalidInput for an invalid recording, or an effect or parameter that the catalogue does not know
std::vector<SimulatedSignal> simulate(const Model& model, const Recording& recording,
                                      const SimulationOptions& options = {},
                                      const Catalogue& catalogue = standard_catalogue());

/// The same as a gap is measured. An axis restarts from the motion that the check of a diagnosis believes, and where the
/// check cuts the recording. At rows that the check leaves out, and of signals that it does not judge, it is simulate()
/// from the recording as it is.
/// @throws InvalidInput  like simulate()
std::vector<SimulatedSignal> simulate_as_believed(const Model& model, const Recording& recording,
                                                  double horizon_s,
                                                  const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::gap

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/gap/detail/simulate.hpp>
#endif
