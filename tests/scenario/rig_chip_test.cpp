// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The rig driven by the firmware itself: the ATmega328P program in a simulated chip against the same
// controller compiled for the PC, from the one header that defines it for both.
#include <rig.hpp>

#include "../../examples/gimbal_controller/gimbal.h"

#include <thermopower/simulation/rig_world.hpp>
#include <thermopower/simulation/scenarios.hpp>

#include <cmath>
#include <cstdlib>

#include "../catch.hpp"

using namespace thermopower;
using namespace thermopower::simulation;

TEST_CASE("The chip's program and the PC's controller get the same out of the rig") {
  for (const Scenario& scenario : {motion(15.0), gusts(15.0), weak_battery(15.0)}) {
    INFO(scenario.name);
    RigWorld world(RigConfig::thesis(), scenario);
    nano::Rig chip(NANO_PROGRAMS "/gimbal_controller.elf", BoardConfig(),
                   [&](double time_s, nano::Rig::Board& board) { return world(time_s, board); });
    chip.run_until(scenario.duration_s);
    const RigMetrics on_chip = world.figures();

    Gimbal gimbal = new_gimbal();
    EmulatedBoard board;
    // The board looks at its input every 8 ms, so a PC that answers at once would be heard one look earlier,
    // and control every 16 ms instead of every 24.
    REQUIRE(!chip.updates().empty());
    ByteLoop loop;
    loop.compute_us = static_cast<double>(chip.updates().front().response_cycles()) / nano::cycles_per_us;
    const RigMetrics on_pc = run_rig_bytes(
        RigConfig::thesis(), scenario, board, gimbal,
        [](double, const sbgc::RealtimeData&, const GimbalCommand<3>&) {}, loop);
    CHECK(chip.unanswered() == 0);
    CHECK(on_chip.energy_J == Approx(on_pc.energy_J).epsilon(0.10));
    CHECK(on_chip.error_rms_deg() == Approx(on_pc.error_rms_deg()).epsilon(0.15).margin(0.01));
    CHECK(on_chip.peak_body_C() == Approx(on_pc.peak_body_C()).margin(0.5));

    // Decision by decision, from what the chip heard: the PC's controller, stepped at the chip's times,
    // answers the same.
    Gimbal same = new_gimbal();
    double last_s = 0.0;
    long agreeing = 0;
    for (const nano::Update& update : chip.updates()) {
      GimbalInputs<3> inputs;
      for (int i = 0; i < 3; ++i)
        inputs.error_deg[i] = sbgc::angle_deg(static_cast<std::int32_t>(update.telemetry.target_angle[i]) -
                                              update.telemetry.imu_angle[i]);
      inputs.camera_C = update.telemetry.imu_C, inputs.frame_C = update.telemetry.frame_imu_C;
      inputs.supply_V = static_cast<float>(update.telemetry.battery_cV) * 0.01f;
      const auto& expected = same.step(inputs, static_cast<float>(update.time_s() - last_s));
      last_s = update.time_s();
      bool agrees = true;
      for (int i = 0; i < 3; ++i)
        agrees = agrees && std::abs(int(expected.power[i]) - int(update.power[i])) <= 1 &&
                 std::abs(int(expected.p_gain[i]) - int(update.p_gain[i])) <= 1;
      agreeing += agrees ? 1 : 0;
    }
    const auto updates = static_cast<double>(chip.updates().size());
    CHECK(updates > 600);
    CHECK(static_cast<double>(agreeing) >= 0.999 * updates);
  }
}
