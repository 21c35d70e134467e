// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <cstdio>

#include "chapter5.hpp"
#include "runs.hpp"

namespace {

using namespace thermopower;
using namespace thermopower::simulation;

// Average powers of one axis: in the thesis's V_rms I, and drawn from the supply.
struct Powers {
  EnergyMeter<AtWinding, double> winding;
  EnergyMeter<AtSupply, double> supply;
};

template <class Controller>
std::array<Powers, 3> measure(const Scenario& scenario, Controller controller) {
  std::array<Powers, 3> axes;
  run_rig(RigConfig::thesis(), scenario, controller, [&](const RigSample& sample) {
    const double dt_s = sample.rig.config().board_cycle_s * sample.rig.config().cycles_per_control;
    const double supply_V = sample.rig.battery().state().supply_V;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& driven = sample.rig.plant(i).driven();
      axes[i].winding.step(driven.v_rms_V, supply_V, supply_V * driven.load_S, dt_s);
      axes[i].supply.step(driven.v_rms_V, supply_V, supply_V * driven.load_S, dt_s);
    }
  });
  return axes;
}

}  // namespace

void chapter5::power_comparison() {
  const Scenario scenario = disturbed();
  const auto constant = measure(scenario, constant_power());
  const auto dynamic = measure(scenario, thesis_gimbal());
  std::printf(
      "\nPower comparison (section 5.3): POWER 89 for ever against the thesis's program, under large "
      "disturbances\n");
  std::printf("  %-6s | %-21s | %-21s | %-32s\n", "", "V_rms I / W", "at the supply / W", "saving / %");
  std::printf("  %-6s | %10s %10s | %10s %10s | %10s %10s %10s\n", "axis", "constant", "dynamic", "constant",
              "dynamic", "as printed", "V_rms I", "supply");
  const char* names[] = {"roll", "pitch", "yaw"};
  for (std::size_t i = 0; i < 3; ++i)
    std::printf("  %-6s | %10.3f %10.3f | %10.3f %10.3f | %10.1f %10.1f %10.1f\n", names[i],
                constant[i].winding.average_W(), dynamic[i].winding.average_W(),
                constant[i].supply.average_W(), dynamic[i].supply.average_W(),
                difference_percent(constant[i].supply.average_W(), dynamic[i].winding.average_W()),
                saving_percent(constant[i].winding, dynamic[i].winding),
                saving_percent(constant[i].supply, dynamic[i].supply));
  std::printf(
      "  'as printed' sets V_rms I of the dynamic run against the supply's power of the constant one, as "
      "section 5.3 does\n"
      "  (22.2 %% roll, 61.1 %% pitch there); only a column that uses one definition for both compares like "
      "with like.\n");
}
