// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// nano_gimbal decides as the original does: its commands on a simulated chip, update by update, against the original's formulas.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

#include <rig.hpp>

#include "../catch.hpp"
#include "nano_original_chip.hpp"

namespace {

using nano::Rig;

/// Five minutes that go everywhere the original's model is defined: air of 16 to 80 degC, every level on every axis, several turns,
/// full demand until the limiter acts and beyond, a cut, and two recoveries. It does not hold a motor at exactly its limit for minutes:
/// whether the estimate is a millikelvin above is then decided by rounding, and the original parts from itself in another precision.
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
  } else if (time_s < 125) {  // full demand: heats until the limiter acts, and on
    error[0] = 5, error[1] = -3 + small, error[2] = 90;
    air_C = 26 + (time_s - 75) / 10;
  } else if (time_s < 190) {  // recovers
    error[0] = 0.3 * small, error[1] = gusts, error[2] = small;
    air_C = 30;
  } else if (time_s < 240) {  // hotter than the limit: cut
    error[0] = 2 * small, error[1] = 0.7 * gusts, error[2] = 4;
    air_C = 40 + 40 * std::min(1.0, (time_s - 190) / 15);
  } else {  // and cool again
    error[0] = 0.3 * small, error[1] = 0.3 * gusts, error[2] = 2 + swing;
    air_C = 16 + 30 * std::exp(-(time_s - 240) / 20);
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
    const original::Decision expected = program.update(update.telemetry, static_cast<std::uint32_t>(update.last_in_cycle / 16));
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
  std::cout << "agreement with the original in " << reference << ": " << agreement.percent() << " % of " << agreement.updates
            << " updates (POWER at most " << agreement.worst_power << " off, P " << agreement.worst_gain << ")\n";
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
      recovering += program.limit_taken(axis) == original::Limit::rises && program.ceiling(axis) < 25 * program.level(axis);
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
}
