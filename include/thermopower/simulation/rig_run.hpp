// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/control/gimbal_controller.hpp>
#include <thermopower/simulation/rig.hpp>

/// @file rig_run.hpp
/// A controller on the rig, from start to finish.

namespace thermopower::simulation {

/// Constant power with the gain that goes with it: how a gimbal is run without any of this.
///
/// @snippet simulation_examples.cpp rig
/// How to: @ref rig.
struct ConstantPower {
  GimbalCommand<3> command;  ///< Sent in every cycle.

  /// @param power  POWER of each axis  @param p_gain  P of each axis
  ConstantPower(std::array<std::uint8_t, 3> power, std::array<std::uint8_t, 3> p_gain) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      command.power[i] = power[i];
      command.p_gain[i] = p_gain[i];
      command.reason[i] = LimitReason::none;
    }
  }
  /// The same, whatever happens.
  template <class Telemetry>
  const GimbalCommand<3>& step(const Telemetry&, float) noexcept {
    return command;
  }
  /// The same through silence.
  const GimbalCommand<3>& step_silent(float) noexcept { return command; }
};

/// One row of what a run looks like, once per control cycle.
struct RigSample {
  double t_s;                       ///< Since the start.
  const Rig& rig;                   ///< Everything there is.
  const RigTelemetry& telemetry;    ///< What the controller saw.
  const GimbalCommand<3>& command;  ///< What it answered.
};

/// Adds up the figures of a run, cycle by cycle.
///
/// @snippet simulation_examples.cpp rig by hand
/// How to: @ref rig.
class RigMeter {
public:
  /// After every cycle of the board.
  void cycle(const Rig& rig) noexcept {
    const RigConfig& config = rig.config();
    const bool counts = rig.time_s() > rig.scenario().settle_s;
    ++cycles_;
    counted_ += counts ? 1 : 0;
    metrics_.lowest_supply_V = std::fmin(metrics_.lowest_supply_V, rig.battery().state().supply_V);
    for (std::size_t i = 0; i < 3; ++i) {
      AxisMetrics& axis = metrics_.axes[i];
      const auto& temperatures = rig.plant(i).temperatures();
      axis.mean_power += rig.power(i);
      axis.peak_winding_C = std::fmax(axis.peak_winding_C, temperatures.winding_C);
      axis.peak_body_C = std::fmax(axis.peak_body_C, temperatures.body_C);
      if (temperatures.body_C > config.body_limit_C) axis.over_limit_s += config.board_cycle_s;
      if (!counts) continue;
      const double error_deg = rig.error_deg(i);
      const double blur_px = config.optics.blur_of_rate_px(rig.plant(i).rate_deg_per_s());
      axis.error_rms_deg += error_deg * error_deg;
      axis.error_peak_deg = std::fmax(axis.error_peak_deg, std::fabs(error_deg));
      axis.blur_rms_px += blur_px * blur_px;
      if (std::fabs(blur_px) > 0.5) axis.blurred_share += 1.0;
    }
  }

  /// After every command of the controller. @param dt_s  since the one before
  void command(const GimbalCommand<3>& given, double dt_s) noexcept {
    for (std::size_t i = 0; i < 3; ++i)
      if (given.reason[i] != LimitReason::none) metrics_.axes[i].limiting_s += dt_s;
  }

  /// The figures so far.
  RigMetrics figures(const Rig& rig) const noexcept {
    RigMetrics metrics = metrics_;
    const double share = 1.0 / std::fmax(1.0, static_cast<double>(counted_));
    for (std::size_t i = 0; i < 3; ++i) {
      AxisMetrics& axis = metrics.axes[i];
      axis.error_rms_deg = std::sqrt(axis.error_rms_deg * share);
      axis.blur_rms_px = std::sqrt(axis.blur_rms_px * share);
      axis.blurred_share *= share;
      axis.mean_power /= std::fmax(1.0, static_cast<double>(cycles_));
      axis.energy_J = rig.axis_energy_J(i);
      metrics.energy_J += axis.energy_J;
    }
    metrics.time_s = static_cast<double>(counted_) * rig.config().board_cycle_s;
    return metrics;
  }

private:
  RigMetrics metrics_;
  std::uint64_t cycles_ = 0, counted_ = 0;
};

/// Runs a scenario to its end.
/// @param controller  anything with `step(telemetry, dt_s)` that gives a `GimbalCommand<3>`:
/// `GimbalController` as it is
/// @param sink        called with a `RigSample` in every control cycle
template <class Controller, class Sink>
RigMetrics run_rig(const RigConfig& config, const Scenario& scenario, Controller& controller, Sink&& sink) {
  Rig rig(config, scenario);
  RigMeter meter;
  const auto cycles = static_cast<std::uint64_t>(std::llround(scenario.duration_s / config.board_cycle_s));
  const auto per_control = static_cast<std::uint64_t>(config.cycles_per_control);
  const double control_s = config.board_cycle_s * config.cycles_per_control;
  for (std::uint64_t cycle = 0; cycle < cycles; ++cycle) {
    if (cycle % per_control == 0) {
      const RigTelemetry telemetry = rig.telemetry();
      const double since_s = cycle == 0 ? 0.0 : control_s;
      const GimbalCommand<3>& command = controller.step(telemetry, static_cast<float>(since_s));
      rig.command(command.power, command.p_gain);
      meter.command(command, since_s);
      sink(RigSample{rig.time_s(), rig, telemetry, command});
    }
    rig.cycle();
    meter.cycle(rig);
  }
  return meter.figures(rig);
}

/// Runs a scenario to its end without looking at the cycles in between.
template <class Controller>
RigMetrics run_rig(const RigConfig& config, const Scenario& scenario, Controller& controller) {
  return run_rig(config, scenario, controller, [](const RigSample&) {});
}

}  // namespace thermopower::simulation
