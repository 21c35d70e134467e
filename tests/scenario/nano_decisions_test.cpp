// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// nano_gimbal decides as the original does: its commands on a simulated chip, update by update, against the
// original's formulas.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <recorded_telemetry.hpp>
#include <rig.hpp>
#include <set>
#include <thermopower/thermopower.hpp>
#include <vector>

#include "../catch.hpp"
#include "nano_original_chip.hpp"

namespace {

using nano::Rig;
namespace tp = thermopower;
namespace fixed = thermopower::fixed_point;

/// Five minutes that go everywhere the original's model is defined: air of 16 to 80 degC, every level on
/// every axis, several turns, full demand until the limiter acts and beyond, a cut, and two recoveries.
Rig::Truth script(double time_s, Rig::Board&) {
  Rig::Truth truth;
  const double small = 0.4 * std::sin(2.1 * time_s) + 0.3 * std::sin(5.3 * time_s + 1);
  const double gusts = 1.1 * std::sin(0.9 * time_s) * std::sin(0.13 * time_s) + 0.2 * std::sin(11 * time_s);
  const double swing = 200 * std::sin(0.21 * time_s);
  double air_C = 26;
  double error[3] = {0, 0, 0};
  if (time_s < 5) {
    // at rest
  } else if (time_s < 35) {
    error[0] = small, error[1] = gusts, error[2] = gusts - small;
  } else if (time_s < 75) {  // across 180 degrees, and further than a turn
    error[0] = swing, error[1] = -swing + small, error[2] = 3 * swing;
  } else if (time_s < 145) {  // full demand: heats until the limiter acts, and on
    error[0] = 5, error[1] = -3 + small, error[2] = 90;
    air_C = 26 + (time_s - 75) / 10;
  } else if (time_s < 190) {  // recovers
    error[0] = 0.3 * small, error[1] = gusts, error[2] = small;
    air_C = 30;
  } else if (time_s < 230) {  // hotter than the limit: cut
    error[0] = 2 * small, error[1] = 4, error[2] = gusts;
    air_C = 40 + 40 * std::min(1.0, (time_s - 190) / 15);
  } else {  // and cool again
    error[0] = 1.2 * small, error[1] = 1.5 * gusts, error[2] = 2 + swing;
    air_C = 16 + 30 * std::exp(-(time_s - 230) / 20);
  }
  for (int axis = 0; axis < 3; ++axis) {
    truth.target_deg[axis] = 20 * axis;
    truth.angle_deg[axis] = truth.target_deg[axis] - error[axis];
  }
  truth.camera_air_C = air_C;
  truth.frame_air_C = air_C + 2;
  return truth;
}

struct Agreement {
  long updates = 0, agreeing = 0;
  int worst_power = 0, worst_gain = 0;
  double percent() const { return 100.0 * static_cast<double>(agreeing) / static_cast<double>(updates); }
};

template <class Program, class Visit>
Agreement compare(const std::vector<nano::Update>& updates, Program& program, Visit visit) {
  Agreement agreement;
  for (const nano::Update& update : updates) {
    // Both read their clocks when the answer is complete.
    const original::Decision expected =
        program.update(update.telemetry, static_cast<std::uint32_t>(update.last_in_cycle / 16));
    REQUIRE(expected.is_sent);
    bool agrees = true;
    for (int axis = 0; axis < 3; ++axis) {
      const int power = std::abs(int(expected.power[axis]) - int(update.power[axis]));
      const int gain = std::abs(int(expected.p_gain[axis]) - int(update.p_gain[axis]));
      agreement.worst_power = std::max(agreement.worst_power, power);
      agreement.worst_gain = std::max(agreement.worst_gain, gain);
      agrees = agrees && power <= 2 && gain <= 1;
    }
    ++agreement.updates;
    agreement.agreeing += agrees;
    visit(program);
  }
  return agreement;
}

void report(const char* reference, const Agreement& agreement) {
  std::cout << "agreement with the original in " << reference << ": " << agreement.percent() << " % of "
            << agreement.updates << " updates (POWER at most " << agreement.worst_power << " off, P "
            << agreement.worst_gain << ")\n";
}

}  // namespace

TEST_CASE("nano_gimbal decides as the original in every regime") {
  Rig rig(NANO_PROGRAMS "/nano_gimbal.elf", {}, script);
  rig.run_until(300);
  REQUIRE(rig.updates().size() > 10000);
  CHECK(rig.unanswered() == 0);

  original::Program<float> as_float;
  std::set<std::pair<int, int>> levels;
  std::set<std::pair<int, original::Limit>> limits;
  long beyond_half_turn = 0, beyond_turn = 0, recovering = 0;
  const Agreement in_float = compare(rig.updates(), as_float, [&](const original::Program<float>& program) {
    for (int axis = 0; axis < 3; ++axis) {
      levels.insert({axis, program.level(axis)});
      limits.insert({axis, program.limit_taken(axis)});
      beyond_half_turn += std::fabs(program.error_deg(axis)) > 180;
      beyond_turn += std::fabs(program.error_deg(axis)) > 360;
      recovering += program.limit_taken(axis) == original::Limit::rises &&
                    program.ceiling(axis) < 25 * program.level(axis);
    }
  });
  original::Program<double> as_double;
  const Agreement in_double = compare(rig.updates(), as_double, [](const auto&) {});
  OriginalOnItsChip on_its_chip(NANO_PROGRAMS "/nano_original_chip.elf");
  const Agreement in_place = compare(rig.updates(), on_its_chip, [](const auto&) {});

  report("its chip's own arithmetic", in_place);
  report("single precision", in_float);
  report("double precision", in_double);
  CHECK(in_place.percent() >= 99.0);
  CHECK(in_float.percent() >= 99.0);
  CHECK(in_double.percent() >= 99.0);

  // The scenario is worth nothing if it does not go where decisions are made.
  CHECK(levels.size() == 30);
  CHECK(beyond_half_turn > 1000);
  CHECK(beyond_turn > 100);
  CHECK(recovering > 1000);
  CHECK(limits.count({0, original::Limit::falls}) == 1);
  CHECK(limits.count({1, original::Limit::falls}) == 1);
  CHECK(limits.count({1, original::Limit::cut}) == 1);

  // What it costs: between the last byte of an answer and the first of the command, and in the chip.
  std::vector<std::uint64_t> response;
  for (const nano::Update& update : rig.updates()) response.push_back(update.response_cycles());
  std::sort(response.begin(), response.end());
  const unsigned ram = rig.chip().elf().static_ram_bytes + rig.chip().deepest_stack_bytes();
  std::cout << "last byte in to first byte out: median " << response[response.size() / 2] << " cycles, worst "
            << response.back() << "; flash " << rig.chip().elf().flash_bytes << " B, RAM and deepest stack "
            << ram << " B\n";
  CHECK(response[response.size() / 2] <= 4800);
  CHECK(response.back() <= 5500);
  CHECK(rig.chip().elf().flash_bytes <= 11500);
  CHECK(ram <= 860);
}

namespace {

typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm2606_90t::AsProgrammed>> Small;
typedef fixed::ThermalModel<fixed::ThesisMotor<tp::motors::Bgm5208_200_12::AsProgrammed>> Large;
typedef fixed::SafetyLimiter<fixed::ThesisLimit, fixed::PerCycle> Limiter;
typedef fixed::BasicGimbalController<
    fixed::ProgrammedGimbal,
    fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<24, 4>>,
    fixed::AxisController<Small, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<180, 105>>,
    fixed::AxisController<Large, fixed::ProgrammedLevels<>, Limiter, fixed::TruncatedGain<40, 2>>>
    Gimbal;

/// nano_gimbal's arithmetic on this computer: the same to the bit (tests/on_target/vectors_fixed.cpp).
class OnThisComputer {
public:
  original::Decision update(const tp::sbgc::RealtimeFields& fields, std::uint32_t micros) {
    const nano::RecordedTelemetry telemetry = {fields};
    const Gimbal::Command& command = gimbal_.step(telemetry, clock_.elapsed(micros));
    gimbal_.prepare();
    original::Decision decision;
    decision.is_sent = true;
    std::copy(command.power, command.power + 3, decision.power);
    std::copy(command.p_gain, command.p_gain + 3, decision.p_gain);
    return decision;
  }

private:
  Gimbal gimbal_;
  fixed::Clock clock_;
};

bool agree(const original::Decision& left, const original::Decision& right) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(int(left.power[axis]) - int(right.power[axis])) > 2 ||
        std::abs(int(left.p_gain[axis]) - int(right.p_gain[axis])) > 1)
      return false;
  return true;
}

}  // namespace

// A motor under full demand climbs to its limit and is held there by the limiter, whose estimate then lies
// within millikelvins of 60 degC. Whether it is above, and the power cut, is decided by the last digits: the
// original in double precision parts from itself there.
TEST_CASE(
    "held at the limit for minutes, nano_gimbal decides as the original as well as the original does in "
    "another precision") {
  long updates = 0, ours = 0, original_itself = 0;
  for (const double air_C : {16, 23, 30, 34, 38, 42, 46, 50, 54})
    for (const double drift_K : {0.0, 2.0, 5.0}) {
      OnThisComputer fixed;
      original::Program<float> as_float;
      original::Program<double> as_double;
      long count = 0, fixed_agrees = 0, double_agrees = 0;
      for (double time_s = 0.05; time_s < 300; time_s += 0.032) {
        tp::sbgc::RealtimeFields telemetry;
        telemetry.imu_angle[0] = 228;
        telemetry.imu_angle[1] = static_cast<std::int16_t>(std::lround(-137 + 18 * std::sin(2.1 * time_s)));
        telemetry.imu_angle[2] = 4096;
        telemetry.imu_C = static_cast<std::int8_t>(std::lround(air_C + drift_K * std::sin(time_s / 40)));
        telemetry.frame_imu_C = static_cast<std::int8_t>(telemetry.imu_C + 2);
        telemetry.battery_cV = 1260;
        const auto micros = static_cast<std::uint32_t>(time_s * 1e6);
        const original::Decision reference = as_float.update(telemetry, micros);
        fixed_agrees += agree(fixed.update(telemetry, micros), reference);
        double_agrees += agree(as_double.update(telemetry, micros), reference);
        ++count;
      }
      updates += count, ours += fixed_agrees, original_itself += double_agrees;
      std::cout << "full demand, air " << air_C << " +- " << drift_K << " degC: nano_gimbal agrees in "
                << 100.0 * double(fixed_agrees) / double(count) << " %, the original in double precision in "
                << 100.0 * double(double_agrees) / double(count) << " %\n";
    }
  std::cout << "all: " << 100.0 * double(ours) / double(updates) << " %, "
            << 100.0 * double(original_itself) / double(updates) << " %\n";
  CHECK(100 * ours >= 99 * updates);
  CHECK(updates - ours <= 2 * (updates - original_itself));
}
