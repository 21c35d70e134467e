// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/rig_metrics.hpp>
#include <thermopower/simulation/rig_telemetry.hpp>
#include <thermopower/simulation/scenario.hpp>
#include <thermopower/simulation/thesis_gimbal.hpp>

/// @file rig.hpp
/// A gimbal on the desk: three axes, a board, a supply, and what happens to them.

namespace thermopower::simulation {

/// What may be wrong with how the board sees an axis. The default is a board without faults.
struct AxisFault {
  double seen_gain = 1.0;   ///< The board's own loop and its telemetry see the error times this.
  double sent_gain = 1.0;   ///< Only the telemetry shows the error times this.
  double field_slip = 0.0;  ///< Electrical angle by which the field goes astray per angle of the base: 0 with
                            ///< a frame IMU that tells the rotor's place, the number of pole pairs without.
  double sent_offset_deg = 0.0;  ///< Only the telemetry's target is off by this.
};

/// What one sets up.
///
/// @snippet simulation_examples.cpp rig
/// How to: @ref rig.
struct RigConfig {
  std::array<AxisPlant<double>::Config, 3> axes;  ///< Roll, pitch, yaw.
  double board_cycle_s = 0.0008;  ///< The board computes torque this often, and the mechanics take this step.
  int cycles_per_parse = 10;      ///< The board reads commands this often: every 8 ms.
  int cycles_per_control = 38;    ///< The controller runs this often: 30.4 ms, as the thesis's "about 30 ms".
  double body_limit_C = 60.0;     ///< What the printed bracket bears: time above it is counted.
  Optics optics = Optics::line_scan();  ///< For the blur.
  std::array<AxisFault, 3> faults{};    ///< None.

  /// The gimbal of the thesis.
  static RigConfig thesis() {
    RigConfig config;
    config.axes = {thesis_roll<double>(), thesis_pitch<double>(), thesis_yaw<double>()};
    return config;
  }
};

/// The rig in motion. Everything follows from the configuration, the scenario and the commands: no clock, no
/// randomness.
///
/// @snippet simulation_examples.cpp rig by hand
/// How to: @ref rig.
class Rig {
public:
  /// @param config    copied  @param scenario  copied
  Rig(const RigConfig& config, const Scenario& scenario)
      : config_(config),
        scenario_(scenario),
        battery_(scenario.supply, scenario.charge),
        axes_{axis(0), axis(1), axis(2)} {
    parse();
  }

  /// Time since the start. @return s
  double time_s() const noexcept { return static_cast<double>(cycle_) * config_.board_cycle_s; }

  /// Leaves a command with the board, which reads it when it next parses. @param power, p_gain  0 .. 255, one
  /// per axis
  template <class Bytes>
  void command(const Bytes& power, const Bytes& p_gain) noexcept {
    for (std::size_t i = 0; i < 3; ++i) mailbox_[i] = {power[i], p_gain[i]};
  }

  /// What the board would send now.
  RigTelemetry telemetry() const noexcept {
    RigTelemetry sample;
    for (std::size_t i = 0; i < 3; ++i) {
      const AxisFault& fault = config_.faults[i];
      const double target_deg = scenario_.axes[i].target_deg + fault.sent_offset_deg;
      const double shown_deg =
          target_deg - (target_deg - axes_[i].angle_deg()) * fault.seen_gain * fault.sent_gain;
      sample.imu_units[i] = folded_angle_units(shown_deg);
      sample.target_units[i] = folded_angle_units(target_deg);
      sample.frame_units[i] = folded_angle_units(scenario_.axes[i].base_deg(time_s()));
      sample.power[i] = in_force_[i].power;
    }
    sample.battery_cV = static_cast<std::uint16_t>(battery_.state().supply_V * 100.0 + 0.5);
    sample.current_mA = static_cast<std::uint16_t>(supply_A_ * 1000.0 + 0.5);
    sample.camera_C = sample.frame_C = static_cast<std::int8_t>(std::lround(scenario_.air_C));
    return sample;
  }

  /// One cycle of the board.
  void cycle() noexcept {
    if (cycle_ % static_cast<std::uint64_t>(config_.cycles_per_parse) == 0) parse();
    const double dt_s = config_.board_cycle_s, now_s = time_s();
    for (std::size_t i = 0; i < 3; ++i) {
      AxisPlant<double>& plant = axes_[i];
      const AxisScenario& happens = scenario_.axes[i];
      const double base_deg = base_deg_[i], next_deg = happens.base_deg(now_s + dt_s);
      const BaseMotion<double> base = {base_deg / deg_per_rad, (next_deg - base_deg) / (deg_per_rad * dt_s),
                                       0.0};
      double share = plant.ask(config_.faults[i].seen_gain * error_deg(i), in_force_[i].p_gain, dt_s);
      if (config_.faults[i].field_slip > 0.0)
        share = std::sin(std::asin(share) + config_.faults[i].field_slip * base.angle_rad);
      plant.move(share, happens.torque_Nm(now_s), base, dt_s);
      base_deg_[i] = next_deg;
    }
    ++cycle_;
  }

  /// Where the camera points less where it should, the short way round: the truth, not what the board sees.
  /// @return degrees
  double error_deg(std::size_t index) const noexcept {
    const double error = scenario_.axes[index].target_deg - axes_[index].angle_deg();
    return error - 360.0 * std::nearbyint(error / 360.0);
  }

  const AxisPlant<double>& plant(std::size_t index) const noexcept { return axes_[index]; }  ///< One axis.
  const Battery<double>& battery() const noexcept { return battery_; }                       ///< The supply.
  double axis_energy_J(std::size_t index) const noexcept {
    return energy_J_[index];
  }                                                       ///< Drawn from the supply so far.
  double supply_A() const noexcept { return supply_A_; }  ///< Drawn by all motors.
  std::uint8_t power(std::size_t index) const noexcept {
    return in_force_[index].power;
  }                                                                ///< POWER in force.
  const RigConfig& config() const noexcept { return config_; }     ///< As set up.
  const Scenario& scenario() const noexcept { return scenario_; }  ///< As set up.

private:
  struct Setting {
    std::uint8_t power = 25, p_gain = 20;
  };

  AxisPlant<double> axis(std::size_t index) const {
    const AxisScenario& happens = scenario_.axes[index];
    const double winding_C = std::isnan(happens.winding_C) ? scenario_.air_C : happens.winding_C;
    const double body_C = std::isnan(happens.body_C) ? scenario_.air_C : happens.body_C;
    return AxisPlant<double>(config_.axes[index], {happens.target_deg, winding_C, body_C});
  }

  // Every 8 ms: commands take effect, and what changes slowly is carried on.
  void parse() noexcept {
    const double dt_s = cycle_ == 0 ? 0.0 : config_.board_cycle_s * config_.cycles_per_parse;
    double load_S = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      axes_[i].warm({scenario_.air_C, scenario_.airspeed_mps}, dt_s);
      energy_J_[i] += axes_[i].driven().heat_W * dt_s;
      in_force_[i] = mailbox_[i];
      load_S += axes_[i].load_S(in_force_[i].power);
    }
    const double supply_V = battery_.step(load_S, config_.board_cycle_s * config_.cycles_per_parse).supply_V;
    supply_A_ = supply_V * load_S;
    for (std::size_t i = 0; i < 3; ++i) axes_[i].power(in_force_[i].power, supply_V);
  }

  RigConfig config_;
  Scenario scenario_;
  Battery<double> battery_;
  std::array<AxisPlant<double>, 3> axes_;
  std::array<Setting, 3> mailbox_{}, in_force_{};
  std::array<double, 3> energy_J_{}, base_deg_{};
  double supply_A_ = 0.0;
  std::uint64_t cycle_ = 0;
};

}  // namespace thermopower::simulation
