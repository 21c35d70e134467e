// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::plant {

/// What a plant is given besides the recorded inputs.
enum class SimulationMode {
  /// As a gap is judged: signals that run over whole runs do so from their first measured value; those that run
  /// in windows restart from the measured state at each, states that nobody measures carried on.
  free_running,
  /// Each submodel on its measured inputs: current from the measured `motor_C`; temperature from the measured
  /// `current_A`. What runs in windows as in free_running.
  measured_inputs,
};

}  // namespace thermopower::plant
