// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

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

}  // namespace thermopower::gap
