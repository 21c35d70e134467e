// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/signal.hpp>

#include <Eigen/Core>

#include <vector>

namespace thermopower::gap {

/// One simulated signal, a value per row of the recording; NaN where it could not be simulated.
struct SimulatedSignal {
  plant::SignalName signal;  ///< which
  Eigen::VectorXd values;    ///< in the signal's unit: A, degC, deg or deg/s
};

/// The simulation of one held-out recording, at its rows as they were given; NaN at rows that the check left out.
struct HeldOutPrediction {
  std::vector<SimulatedSignal> baseline;   ///< by the model as configured
  std::vector<SimulatedSignal> augmented;  ///< by the model with the causes
};

}  // namespace thermopower::gap
