// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <cmath>
#include <cstdio>
#include <vector>

#include "chapter5.hpp"
#include "runs.hpp"
#include "small_multiples.hpp"

namespace {

using namespace thermopower;
using namespace thermopower::simulation;
using figures::Mark;
using figures::Palette;

struct Trace {
  std::vector<double> t_s, error_deg[3], power[3];
  RigMetrics figures;
};

Trace run(const Scenario& scenario) {
  Trace trace;
  ThesisGimbal gimbal = thesis_gimbal();
  trace.figures = run_rig(RigConfig::thesis(), scenario, gimbal, [&](const RigSample& sample) {
    trace.t_s.push_back(sample.t_s);
    for (std::uint8_t i = 0; i < 3; ++i) {
      trace.error_deg[i].push_back(static_cast<double>(wrap_deg(sample.telemetry.error_deg(i))));
      trace.power[i].push_back(sample.command.power[i]);
    }
  });
  return trace;
}

// As the thesis draws them: the error scaled so that full power's error reaches 250, and cropped there.
figures::Panel panel(const char* title, const Trace& trace, std::size_t axis, double from_s, double to_s) {
  std::vector<double> t_s, scaled, power;
  for (std::size_t i = 0; i < trace.t_s.size(); ++i) {
    if (trace.t_s[i] < from_s || trace.t_s[i] > to_s) continue;
    t_s.push_back(trace.t_s[i]);
    scaled.push_back(std::fmin(std::fabs(trace.error_deg[axis][i]) * 250.0, 255.0));
    power.push_back(trace.power[axis][i]);
  }
  figures::Panel panel = {title, "time / s", "POWER; error x 250 per deg", {}, 0.0, 260.0, 0.0, 0.0, 0.0};
  panel.series = {{"position error, scaled and cropped", Palette::constant, Mark::line, t_s, scaled},
                  {"POWER", Palette::power, Mark::line, t_s, power}};
  return panel;
}

}  // namespace

void chapter5::responses(const std::string& directory) {
  const Trace move = run(moving()), push = run(disturbed()), yaw = run(moving_then_disturbed());
  std::printf("\nResponses under the thesis's program (figures 5.12 to 5.16)\n");
  std::printf("  %-36s %12s %12s %12s\n", "figure", "rms / deg", "peak / deg", "mean POWER");
  const auto line = [](const char* name, const AxisMetrics& axis) {
    std::printf("  %-36s %12.3f %12.2f %12.0f\n", name, axis.error_rms_deg, axis.error_peak_deg,
                axis.mean_power);
  };
  line("5.12  roll, moving", move.figures.axes[0]);
  line("5.13  pitch, moving", move.figures.axes[1]);
  line("5.14  roll, large disturbances", push.figures.axes[0]);
  line("5.15  pitch, large disturbances", push.figures.axes[1]);
  line("5.16  yaw, moving, disturbed, at rest", yaw.figures.axes[2]);
  figures::write_small_multiples(
      directory + "/figures_5_12_to_5_16.svg", "Responses of the axes (figures 5.12 to 5.16)",
      {panel("5.12  roll, moving", move, 0, 20, 32), panel("5.13  pitch, moving", move, 1, 20, 32),
       panel("5.14  roll, large disturbances", push, 0, 5, 40),
       panel("5.15  pitch, large disturbances", push, 1, 5, 40),
       panel("5.16  yaw on a healthy board", yaw, 2, 0, 90)},
      3);
}
