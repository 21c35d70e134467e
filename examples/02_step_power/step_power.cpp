// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Problem:  how much power is a position error worth?
// Model:    P = 25 level, level = 1 .. 10 = int(10 |e| / e_max): eq 4.22 as the thesis's program has it; and
//           its relatives.
// Notation: e position error in degrees, folded to -180 .. 180; P power parameter 0 .. 255.
#include <thermopower/thermopower.hpp>

#include <stdio.h>

namespace tp = thermopower;

int main() {
  //! [laws]
  tp::StepPowerLaw<tp::ProgrammedLevels> programmed;  // ten levels: the default
  tp::StepPowerLaw<tp::HysteresisLevels> steady;      // ten levels that a noisy error does not toggle
  tp::StepPowerLaw<tp::ContinuousPower> smooth;       // proportional
  //! [laws]

  printf("  target   measured   error   levels   hysteresis   continuous\n");
  const float poses[][2] = {{0.0f, 0.0f},   {0.0f, 0.19f}, {0.0f, 0.21f},     {0.0f, 0.19f},
                            {0.0f, -0.55f}, {10.0f, 8.8f}, {179.7f, -179.8f}, {0.0f, 90.0f}};
  for (const auto& pose : poses) {
    const float error_deg = tp::position_error_deg(pose[0], pose[1]);
    printf("  %6.1f   %8.2f   %5.2f   %6d   %10d   %10d\n", static_cast<double>(pose[0]),
           static_cast<double>(pose[1]), static_cast<double>(error_deg), programmed.step(error_deg),
           steady.step(error_deg), smooth.step(error_deg));
  }
  // Half a degree across 180 is half a degree, not a turn.
  return programmed.step(tp::position_error_deg(179.75f, -179.75f)) == 125 ? 0 : 1;
}
