// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// examples/bare_metal_avr on a simulated chip, at the end of an emulated board's line: no core, no interrupt,
// and it loses nothing.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <recorded_telemetry.hpp>
#include <rig.hpp>
#include <thermopower/thermopower.hpp>

#include "../catch.hpp"

namespace {

namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;
using nano::Rig;

const char* const program = NANO_PROGRAMS "/bare_metal_avr.elf";

Rig::Truth moving(double time_s, Rig::Board&) {
  Rig::Truth truth;
  truth.angle_deg[0] = -1.5 * std::sin(0.7 * time_s);
  truth.angle_deg[1] = 0.32;
  truth.angle_deg[2] = 200 * std::sin(0.4 * time_s);
  truth.camera_air_C = truth.frame_air_C = 26;
  return truth;
}

template <class Motor, std::uint8_t low, std::uint8_t high>
using Axis = fixed::AxisController<fixed::ThermalModel<fixed::ThesisMotor<Motor>>, fixed::HysteresisLevels<>,
                                   fixed::SafetyLimiter<>, fixed::RoundedGain<low, high>>;
typedef fixed::GimbalController<Axis<tp::motors::Bgm2606_90t, 24, 4>, Axis<tp::motors::Bgm2606_90t, 180, 105>,
                                Axis<tp::motors::Bgm5208_200_12, 40, 2>>
    Gimbal;

}  // namespace

TEST_CASE("the bare-metal program polls, decides as its controller does here, and loses no byte") {
  Rig rig(program, {}, moving);
  rig.run_until(5);
  REQUIRE(rig.updates().size() > 250);
  CHECK(rig.unanswered() == 0);
  CHECK(rig.stray_bytes() == 0);
  CHECK(rig.requests() - rig.updates().size() <= 1);
  CHECK(rig.chip().bytes_overrun() == 0);
  CHECK(rig.board().counters().shortest_request_gap_us >= 10000);

  Gimbal gimbal;
  fixed::Clock clock;
  long agreeing = 0;
  std::uint64_t slowest = 0;
  for (const nano::Update& update : rig.updates()) {
    const nano::RecordedTelemetry telemetry = {update.telemetry};
    const auto& expected =
        gimbal.step(telemetry, clock.elapsed(static_cast<std::uint32_t>(update.last_in_cycle / 16)));
    gimbal.prepare();
    agreeing += std::equal(expected.power, expected.power + 3, update.power) &&
                std::equal(expected.p_gain, expected.p_gain + 3, update.p_gain);
    slowest = std::max(slowest, update.response_cycles());
  }
  CHECK(100 * agreeing >= 99 * static_cast<long>(rig.updates().size()));
  CHECK(slowest <= 4800);
  CHECK(rig.chip().elf().flash_bytes <= 8600);
  CHECK(rig.chip().elf().static_ram_bytes + rig.chip().deepest_stack_bytes() <= 640);
}

TEST_CASE("its motors get the least power before the first answer and half a second after the last") {
  Rig rig(program, {}, moving);
  const auto is_least = [&] {
    return rig.board().power(0) == 1 && rig.board().power(1) == 1 && rig.board().power(2) == 1;
  };
  rig.board().faults.is_silent = true;
  rig.run_until(0.5);
  CHECK(is_least());
  rig.board().faults.is_silent = false;
  rig.run_until(2);
  CHECK_FALSE(is_least());
  rig.board().faults.is_silent = true;
  rig.run_until(2.4);
  CHECK_FALSE(is_least());
  rig.run_until(2.8);
  CHECK(is_least());
}
