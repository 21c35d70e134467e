// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// nano_gimbal decides as the original does: its commands on a simulated chip, update by update, against the original's formulas.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

#include <rig.hpp>

#include "../catch.hpp"
#include "nano_original.hpp"

namespace {

using nano::Rig;

/// Thirteen minutes that go everywhere the original's model is defined: air of 16 to 64 degC, every level on every axis, several
/// turns, minutes of full demand, a cut and two recoveries.
Rig::Truth script(double time_s, Rig::Board&) {
  Rig::Truth truth;
  const double small = 0.4 * std::sin(2.1 * time_s) + 0.3 * std::sin(5.3 * time_s + 1);
  const double gusts = 1.1 * std::sin(0.9 * time_s) * std::sin(0.13 * time_s) + 0.2 * std::sin(11 * time_s);
  const double swing = 200 * std::sin(0.11 * time_s);
  double air_C = 26;
  double error[3] = {0, 0, 0};
  if (time_s < 10) {
    // at rest
  } else if (time_s < 60) {
    error[0] = small, error[1] = gusts, error[2] = gusts - small;
  } else if (time_s < 120) {  // across 180 degrees, and further than a turn
    error[0] = swing, error[1] = -swing + small, error[2] = 3 * swing;
  } else if (time_s < 300) {  // full demand: heats until the limiter acts, and on
    error[0] = 5, error[1] = -3 + small, error[2] = 90;
    air_C = 26 + (time_s - 120) / 20;
  } else if (time_s < 360) {  // recovers
    error[0] = 0.3 * small, error[1] = gusts, error[2] = small;
    air_C = 30;
  } else if (time_s < 450) {  // hotter than the limit: cut
    error[0] = 2 * small, error[1] = 4, error[2] = gusts;
    air_C = 40 + 24 * std::min(1.0, (time_s - 360) / 60);
  } else if (time_s < 600) {  // and cool again
    error[0] = 2, error[1] = gusts, error[2] = 1.5;
    air_C = 16 + 30 * std::exp(-(time_s - 450) / 40);
  } else {
    error[0] = 1.2 * small, error[1] = 1.5 * gusts, error[2] = 2 + swing;
    air_C = 16 + 0.2 * (time_s - 600);
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
    const auto micros = static_cast<std::uint32_t>(update.first_out_cycle / 16);
    const original::Decision expected = program.update(update.telemetry, micros);
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

}  // namespace

TEST_CASE("nano_gimbal decides as the original in every regime") {
  Rig rig(NANO_PROGRAMS "/nano_gimbal.elf", {}, script);
  rig.run_until(780);
  REQUIRE(rig.updates().size() > 20000);
  CHECK(rig.unanswered() == 0);

  original::Program<float> on_its_chip;
  std::set<std::pair<int, int>> levels;
  std::set<std::pair<int, original::Limit>> limits;
  long beyond_half_turn = 0, beyond_turn = 0, recovering = 0;
  const Agreement as_float = compare(rig.updates(), on_its_chip, [&](const original::Program<float>& program) {
    for (int axis = 0; axis < 3; ++axis) {
      levels.insert({axis, program.level(axis)});
      limits.insert({axis, program.limit_taken(axis)});
      beyond_half_turn += std::fabs(program.error_deg(axis)) > 180;
      beyond_turn += std::fabs(program.error_deg(axis)) > 360;
      recovering += program.limit_taken(axis) == original::Limit::rises && program.ceiling(axis) < 25 * program.level(axis);
    }
  });
  original::Program<double> exact;
  const Agreement as_double = compare(rig.updates(), exact, [](const auto&) {});

  std::cout << as_float.updates << " updates; agreement with the original in its chip's precision " << as_float.percent()
            << " % (POWER at most " << as_float.worst_power << " off, P " << as_float.worst_gain << "), in double precision "
            << as_double.percent() << " % (" << as_double.worst_power << ", " << as_double.worst_gain << ")\n";
  CHECK(as_float.percent() >= 99.0);
  CHECK(as_double.percent() >= 99.0);

  // The scenario is worth nothing if it does not go where decisions are made.
  CHECK(levels.size() == 30);
  CHECK(beyond_half_turn > 1000);
  CHECK(beyond_turn > 100);
  CHECK(recovering > 1000);
  CHECK(limits.count({0, original::Limit::falls}) == 1);
  CHECK(limits.count({1, original::Limit::falls}) == 1);
  CHECK(limits.count({0, original::Limit::cut}) + limits.count({1, original::Limit::cut}) == 2);
}
