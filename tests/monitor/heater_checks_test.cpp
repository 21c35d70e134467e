// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The usual checks of printers, as the example has them, against what their firmware documents.

#include "../../examples/08_heater/heater.hpp"
#include "../../examples/08_heater/printer_plant.hpp"

#include "../catch.hpp"

#include <algorithm>
#include <cmath>

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

namespace {
/// A hotend in a hold, of whose inputs some are wrong from a time on.
struct Hold {
  heater::Heater<heater::Hotend, RunawayCheck> firmware{heater::Pid::Config::hotend(),
                                                        RunawayCheck::Config::hotend()};
  printer::Heater real{printer::hotend(), 22.0, 3};
  float duty = 0.0f;
  double hottest_C = 0.0;
  void pass(double seconds, float supply_V = 24.0f, float air_C = 22.0f, float told_s = 0.1f) {
    for (double now_s = 0.0; now_s < seconds; now_s += 0.1) {
      real.pass(static_cast<double>(duty), 0.0, 22.0, 24.0, 0.1);
      hottest_C = std::max(hottest_C, real.block_C());
      duty = firmware.step(200.0f, static_cast<float>(real.reading_C()), air_C, supply_V, 0, told_s);
    }
  }
};
const float nan_ = thermopower::detail::not_a_number();
}  // namespace

TEST_CASE("one wrong reading of supply, air or clock costs a heater a moment, and no more") {
  const float right_V = 24.0f, right_C = 22.0f, right_s = 0.1f;
  struct Wrong {
    float supply_V, air_C, dt_s;
  };
  for (const Wrong& wrong :
       {Wrong{655.0f, right_C, right_s}, Wrong{1e30f, right_C, right_s}, Wrong{nan_, right_C, right_s},
        Wrong{0.0f, right_C, right_s}, Wrong{-24.0f, right_C, right_s}, Wrong{right_V, nan_, right_s},
        Wrong{right_V, -273.0f, right_s}, Wrong{right_V, 1e30f, right_s}, Wrong{right_V, right_C, nan_},
        Wrong{right_V, right_C, -1.0f}, Wrong{right_V, right_C, 0.0f}, Wrong{right_V, right_C, 1e30f},
        Wrong{right_V, right_C, 600.0f}}) {
    CAPTURE(wrong.supply_V, wrong.air_C, wrong.dt_s);
    Hold hold;
    hold.pass(600.0);
    REQUIRE(hold.firmware.reason() == thermopower::LimitReason::none);
    hold.pass(0.05, wrong.supply_V, wrong.air_C, wrong.dt_s);
    hold.pass(1.0);
    CHECK(hold.firmware.reason() == thermopower::LimitReason::none);
    hold.pass(600.0);
    CHECK(hold.firmware.reason() == thermopower::LimitReason::none);
    CHECK(std::fabs(hold.real.block_C() - 200.0) < 3.0);
  }
}

TEST_CASE("a heater whose supply, air or clock stays wrong is off, with a reason") {
  struct Wrong {
    float supply_V, air_C, dt_s;
    bool is_named_at_once;
  };
  for (const Wrong& wrong :
       {Wrong{655.0f, 22.0f, 0.1f, true}, Wrong{nan_, 22.0f, 0.1f, true}, Wrong{0.0f, 22.0f, 0.1f, false},
        Wrong{24.0f, nan_, 0.1f, true}, Wrong{24.0f, -273.0f, 0.1f, true}, Wrong{24.0f, 22.0f, nan_, true},
        Wrong{24.0f, 22.0f, -0.1f, true}, Wrong{24.0f, 22.0f, 0.0f, false}}) {
    CAPTURE(wrong.supply_V, wrong.air_C, wrong.dt_s);
    Hold hold;
    hold.pass(600.0);
    hold.pass(wrong.is_named_at_once ? 0.05 : 60.0, wrong.supply_V, wrong.air_C, wrong.dt_s);
    CHECK(thermopower::is_fault(hold.firmware.reason()));
    CHECK(hold.hottest_C < 215.0);
  }
}

TEST_CASE(
    "a heater whose clock is wrong by two or by ten does not get hot, and says why; in a hold it stays at its target") {
  for (const double scale : {0.1, 0.5, 2.0, 10.0}) {
    CAPTURE(scale);
    Hold heat_up;
    bool is_named = false;
    for (int second = 0; second < 600; ++second) {
      heat_up.pass(1.0, 24.0f, 22.0f, static_cast<float>(0.1 * scale));
      is_named = is_named || thermopower::is_fault(heat_up.firmware.reason());
    }
    CHECK(is_named);
    CHECK(heat_up.hottest_C < 150.0);
    Hold hold;
    hold.pass(600.0);
    hold.pass(600.0, 24.0f, 22.0f, static_cast<float>(0.1 * scale));
    CHECK(hold.hottest_C < 215.0);
  }
}
