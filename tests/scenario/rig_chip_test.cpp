// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The rig driven by the firmware itself: the ATmega328P program in a simulated chip against the same
// controller compiled for the PC, from the one header that defines it for both.
#include <rig.hpp>

#include "../../examples/gimbal_controller/gimbal.h"

#include <thermopower/simulation/rig_world.hpp>
#include <thermopower/simulation/scenarios.hpp>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "../catch.hpp"
#include "journal_record.hpp"

using namespace thermopower;
using namespace thermopower::simulation;

namespace {

// What the journal's newest record says: the hottest motor was at this, in whole degC.
constexpr int recorded_C = 40;
// What a program takes from it: the record is due anew after a change of 1 K, and any power may have acted for 8 s.
constexpr float started_C = recorded_C + 1.0f;
constexpr double open_s = 8.0;

// The journal's memory after its first record.
std::vector<std::uint8_t> journal_memory() {
  const auto record = journal_record(1, recorded_C + 60);
  return {record.begin(), record.end()};
}

Gimbal restored_gimbal() {
  Gimbal gimbal = new_gimbal();
  start(gimbal, started_C);
  gimbal.assume_driven();
  return gimbal;
}

}  // namespace

TEST_CASE("The chip's program and the PC's controller get the same out of the rig") {
  for (const Scenario& scenario : {motion(15.0), gusts(15.0), weak_battery(15.0)}) {
    INFO(scenario.name);
    RigWorld world(RigConfig::thesis(), scenario);
    nano::Rig chip(
        NANO_PROGRAMS "/gimbal_controller.elf", BoardConfig(),
        [&](double time_s, nano::Rig::Board& board) { return world(time_s, board); }, journal_memory());
    chip.run_until(scenario.duration_s);
    const RigMetrics on_chip = world.figures();

    Gimbal gimbal = restored_gimbal();
    EmulatedBoard board;
    // The board looks at its input every 8 ms, so a PC that answers at once would be heard one look earlier,
    // and control every 16 ms instead of every 24.
    REQUIRE(!chip.updates().empty());
    ByteLoop loop;
    loop.compute_us = static_cast<double>(chip.updates().front().response_cycles()) / nano::cycles_per_us;
    loop.open_us = open_s * 1e6;
    // The chip reads its memory first. One look of the board earlier or later, and friction sticks elsewhere: the
    // same controller then spends a fifth more or less energy in these seconds.
    loop.start_us = 10000.0;
    const RigMetrics on_pc = run_rig_bytes(
        RigConfig::thesis(), scenario, board, gimbal,
        [](double, const sbgc::RealtimeData&, const GimbalCommand<3>&) {}, loop);
    CHECK(chip.unanswered() == 0);
    CHECK(on_chip.energy_J == Approx(on_pc.energy_J).epsilon(0.01));
    CHECK(on_chip.error_rms_deg() == Approx(on_pc.error_rms_deg()).epsilon(0.02));
    CHECK(on_chip.peak_body_C() == Approx(on_pc.peak_body_C()).margin(0.1));

    // Decision by decision, from what the chip heard: the PC's controller, stepped with the chip's telemetry
    // at the chip's times, answers the same.
    Gimbal same = restored_gimbal();
    SbgcCodec<> codec;
    double last_s = -open_s;
    long agreeing = 0;
    for (const nano::Update& update : chip.updates()) {
      std::uint8_t bytes[160];
      const std::size_t size = codec.encode(update.telemetry, bytes, sizeof bytes);
      for (std::size_t at = 0; at < size; ++at) codec.receive(bytes[at], 0);
      const sbgc::RealtimeData* telemetry = codec.realtime_data();
      REQUIRE(telemetry != nullptr);
      const auto& expected = same.step(*telemetry, static_cast<float>(update.time_s() - last_s));
      last_s = update.time_s();
      bool agrees = true;
      for (int i = 0; i < 3; ++i)
        agrees = agrees && std::abs(int(expected.power[i]) - int(update.power[i])) <= 1 &&
                 std::abs(int(expected.p_gain[i]) - int(update.p_gain[i])) <= 1;
      agreeing += agrees ? 1 : 0;
    }
    const auto updates = static_cast<long>(chip.updates().size());
    CHECK(updates > 600);
    CHECK(agreeing == updates);
  }
}
