// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::plant {

/// The further inputs of a plant besides the recorded ones.
enum class SimulationMode {
  /// As a gap is judged. Signals of whole runs start from their first measured value. Those of windows restart from the
  /// measured state at each, with states that nobody measures carried on.
  free_running,
  /// Each submodel on its measured inputs: current from the measured `motor_C`; temperature from the measured
  /// `current_A`. Windows as in free_running.
  measured_inputs,
};

}  // namespace thermopower::plant
