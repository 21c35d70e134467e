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

TEST_CASE(
    "a reading that is no number, or none that a thermistor gives, is bridged for a block and then switches the heater off") {
  for (const float wrong_C : {thermopower::detail::not_a_number(), -88.6f, 0.0f, 276.0f, 1e30f}) {
    CAPTURE(wrong_C);
    heater::Heater<heater::Hotend, RunawayCheck> heater(heater::Pid::Config::hotend(),
                                                        RunawayCheck::Config::hotend());
    CHECK(heater.step(200.0f, 20.0f, 20.0f, 24.0f, 0, 0.1f) == 1.0f);
    CHECK(heater.step(200.0f, wrong_C, 20.0f, 24.0f, 0, 0.1f) == 1.0f);
    CHECK(heater.step(200.0f, 20.0f, 20.0f, 24.0f, 0, 0.1f) == 1.0f);
    for (int i = 0; i < 32; ++i) heater.step(200.0f, wrong_C, 20.0f, 24.0f, 0, 0.1f);
    CHECK(heater.step(200.0f, wrong_C, 20.0f, 24.0f, 0, 0.1f) == 0.0f);
    CHECK(heater.reason() == thermopower::LimitReason::sensor_out_of_range);
    CHECK(heater.watch().suspects() == static_cast<uint8_t>(thermopower::Suspect::thermometer));
  }
}

TEST_CASE("before the first good reading the heater is off, and no later for it") {
  heater::Heater<heater::Bed, RunawayCheck> heater(heater::Pid::Config::bed(), RunawayCheck::Config::bed());
  for (int i = 0; i < 600; ++i) CHECK(heater.step(60.0f, 0.0f, 20.0f, 24.0f, 0, 0.1f) == 0.0f);
  CHECK(thermopower::is_fault(heater.reason()));
  float duty = 0.0f;
  for (int i = 0; i < 400; ++i) duty = heater.step(60.0f, 20.0f, 20.0f, 24.0f, 0, 0.1f);
  CHECK(duty == 1.0f);
}
