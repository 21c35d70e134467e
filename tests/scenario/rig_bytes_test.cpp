// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The controllers that firmware runs, on the rig: called directly, and through an emulated board that speaks
// the protocol in bytes.
#include <thermopower/simulation/rig_policies.hpp>
#include <thermopower/simulation/rig_world.hpp>
#include <thermopower/simulation/scenarios.hpp>

#include <cmath>

#include "../catch.hpp"

using namespace thermopower;
using namespace thermopower::simulation;

namespace {

const auto ignore = [](double, const sbgc::RealtimeData&, const GimbalCommand<3>&) {};

RigConfig at_the_pace_of_bytes() {
  // Through bytes an update takes 32 ms: request, wait for the board's next look, 11 ms of answer, command.
  RigConfig config = RigConfig::thesis();
  config.cycles_per_control = 40;
  return config;
}

}  // namespace

TEST_CASE("From the same telemetry the controller decides the same, through bytes or called directly") {
  ThesisGimbal remote = thesis_gimbal(), direct = thesis_gimbal();
  EmulatedBoard board;
  double last_s = 0.0;
  long updates = 0;
  run_rig_bytes(RigConfig::thesis(), gusts(40.0), board, remote,
                [&](double t_s, const sbgc::RealtimeData& telemetry, const GimbalCommand<3>& command) {
                  GimbalInputs<3> inputs;
                  for (std::uint8_t i = 0; i < 3; ++i) inputs.error_deg[i] = telemetry.error_deg(i);
                  inputs.camera_C = telemetry.imu_C(), inputs.frame_C = telemetry.frame_imu_C();
                  inputs.supply_V = telemetry.battery_V();
                  const auto& expected =
                      direct.step(inputs, static_cast<float>((t_s * 1e6 - last_s * 1e6) * 1e-6));
                  last_s = t_s;
                  ++updates;
                  for (int i = 0; i < 3; ++i) {
                    REQUIRE(command.power[i] == expected.power[i]);
                    REQUIRE(command.p_gain[i] == expected.p_gain[i]);
                    REQUIRE(command.reason[i] == expected.reason[i]);
                  }
                });
  CHECK(updates > 1000);
  CHECK(board.received().skipped_bytes == 0);
}

TEST_CASE("In closed loop, bytes cost no more than their delay") {
  // An answer is 20 ms old when the command that it caused is obeyed; constant power does not care, the
  // stepped law hunts a little otherwise.
  for (const Scenario& scenario : {rest(40.0), motion(40.0), gusts(40.0), weak_battery(40.0)}) {
    INFO(scenario.name);
    ConstantPower same = constant_power(), sent_same = constant_power();
    ThesisGimbal direct = thesis_gimbal(), remote = thesis_gimbal();
    EmulatedBoard first, second;
    const RigMetrics constant = run_rig(at_the_pace_of_bytes(), scenario, same);
    const RigMetrics sent_constant = run_rig_bytes(RigConfig::thesis(), scenario, first, sent_same, ignore);
    CHECK(sent_constant.energy_J == Approx(constant.energy_J).epsilon(0.005));
    CHECK(sent_constant.error_rms_deg() == Approx(constant.error_rms_deg()).epsilon(0.02).margin(0.002));
    const RigMetrics called = run_rig(at_the_pace_of_bytes(), scenario, direct);
    const RigMetrics sent = run_rig_bytes(RigConfig::thesis(), scenario, second, remote, ignore);
    CHECK(sent.energy_J == Approx(called.energy_J).epsilon(0.15));
    CHECK(sent.error_rms_deg() == Approx(called.error_rms_deg()).epsilon(0.15).margin(0.01));
  }
}

TEST_CASE("Noise on the line costs updates, and nothing else") {
  const Scenario scenario = gusts(40.0);
  ThesisGimbal clean_gimbal = thesis_gimbal(), noisy_gimbal = thesis_gimbal();
  EmulatedBoard clean, noisy;
  noisy.faults.lost_byte_rate = 2e-4;
  noisy.faults.changed_byte_rate = 2e-4;
  const RigMetrics without = run_rig_bytes(RigConfig::thesis(), scenario, clean, clean_gimbal, ignore);
  const RigMetrics with = run_rig_bytes(RigConfig::thesis(), scenario, noisy, noisy_gimbal, ignore);
  CHECK(with.energy_J == Approx(without.energy_J).epsilon(0.25));
  CHECK(with.error_rms_deg() < 1.5 * without.error_rms_deg());
}

TEST_CASE("A board that falls silent leaves the motors with the least power") {
  Scenario scenario = gusts(10.0);
  ThesisGimbal gimbal = thesis_gimbal();
  EmulatedBoard board;
  bool was_cut = false;
  run_rig_bytes(RigConfig::thesis(), scenario, board, gimbal,
                [&](double t_s, const sbgc::RealtimeData&, const GimbalCommand<3>&) {
                  if (t_s > 5.0) board.faults.is_silent = true;
                });
  was_cut =
      board.power(0) == least_power() && board.power(1) == least_power() && board.power(2) == least_power();
  CHECK(was_cut);
}
