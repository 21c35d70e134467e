// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The usual checks of printers, as the example has them, against what their firmware documents.

#include "../../examples/08_heater/heater.hpp"

#include "../catch.hpp"

using heater::KelvinSumCheck;
using heater::RunawayCheck;

TEST_CASE("runaway: four kelvins below the target for forty seconds fail, thirty-nine do not") {
  RunawayCheck check(RunawayCheck::Config::hotend());
  CHECK(check.step(200.0f, 199.0f, 1.0f));
  for (int second = 0; second < 39; ++second) CHECK(check.step(200.0f, 195.0f, 1.0f));
  CHECK(check.step(200.0f, 199.0f, 1.0f));
  for (int second = 0; second < 40; ++second) CHECK(check.step(200.0f, 195.0f, 1.0f));
  CHECK_FALSE(check.step(200.0f, 195.0f, 1.0f));
  CHECK_FALSE(check.step(200.0f, 200.0f, 1.0f));  // and stays failed
}

TEST_CASE("runaway: while heating, two kelvins in twenty seconds are enough") {
  RunawayCheck slow(RunawayCheck::Config::hotend()), dead(RunawayCheck::Config::hotend());
  bool is_dead_alive = true;
  for (int second = 0; second < 300; ++second) {
    CHECK(slow.step(200.0f, 20.0f + 0.11f * static_cast<float>(second), 1.0f));
    is_dead_alive = dead.step(200.0f, 20.0f, 1.0f);
    if (second == 19) CHECK(is_dead_alive);
  }
  CHECK_FALSE(is_dead_alive);
}

TEST_CASE("the sum of kelvins: 120 below the hysteresis fail, unless the temperature rises") {
  KelvinSumCheck check(KelvinSumCheck::Config::hotend());
  CHECK(check.step(200.0f, 199.0f, 1.0f));
  for (int second = 0; second < 11; ++second) CHECK(check.step(200.0f, 185.0f, 1.0f));  // 10 K each
  CHECK_FALSE(check.step(200.0f, 185.0f, 1.0f));

  KelvinSumCheck heating(KelvinSumCheck::Config::hotend());
  for (int second = 0; second < 300; ++second)
    CHECK(heating.step(200.0f, 20.0f + 0.5f * static_cast<float>(second), 1.0f));
}

TEST_CASE("a reading that is no number, or beyond the highest, switches the heater off") {
  heater::Heater<heater::Hotend, RunawayCheck> heater(heater::Pid::Config::hotend(),
                                                      RunawayCheck::Config::hotend());
  CHECK(heater.step(200.0f, 20.0f, 20.0f, 24.0f, 0, 0.1f) == 1.0f);
  for (const float wrong_C : {thermopower::detail::not_a_number(), -88.6f, 276.0f, 1e30f}) {
    CHECK(heater.step(200.0f, wrong_C, 20.0f, 24.0f, 0, 0.1f) == 0.0f);
    CHECK(thermopower::is_fault(heater.reason()));
  }
}
