// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/desktop.hpp>

/// The two conditions of section 5.2.
namespace chapter5 {

/// The gimbal is moved rapidly, "for instance gusting wind".
inline thermopower::simulation::Scenario moving(double duration_s = 60.0) {
  thermopower::simulation::Scenario scenario = thermopower::simulation::motion(duration_s, 51);
  scenario.name = "moving";
  return scenario;
}

/// "A series of sudden and large disturbances to the gimbal itself, such as a wind load or impact."
inline thermopower::simulation::Scenario disturbed(double duration_s = 60.0) {
  thermopower::simulation::Scenario scenario = thermopower::simulation::rest(duration_s);
  scenario.name = "large disturbances";
  const double peak_Nm[3] = {0.012, 0.03, 0.06};
  for (std::size_t i = 0; i < 3; ++i)
    for (int push = 0; 8.0 + 5.0 * push < duration_s - 4.0; ++push)
      scenario.axes[i].pushes.push_back(
          {8.0 + 5.0 * push + static_cast<double>(i), 0.15 + 0.05 * (push % 4),
           (push % 2 == 0 ? 1.0 : -1.0) * peak_Nm[i] * (0.5 + 0.25 * (push % 3))});
  return scenario;
}

/// Moving, then disturbed, then at rest: figure 5.16.
inline thermopower::simulation::Scenario moving_then_disturbed() {
  thermopower::simulation::Scenario scenario = moving(90.0);
  for (auto& axis : scenario.axes)
    for (auto& wave : axis.base) wave.to_s = 40.0;
  const thermopower::simulation::Scenario pushed = disturbed(44.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (auto push : pushed.axes[i].pushes) {
      push.at_s += 34.0;
      scenario.axes[i].pushes.push_back(push);
    }
  scenario.name = "moving, disturbed, at rest";
  return scenario;
}

}  // namespace chapter5
