// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Some of the campaign's runs; the target run_monitor_campaign makes ten thousand hours of each kind.

#include "monitor_campaign.hpp"

#include "../catch.hpp"

TEST_CASE("no plant inside its bounds raises an alarm") {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    CHECK(campaign::run_hotend(seed, 1800.0).monitor_s < 0.0);
    CHECK(campaign::run_bed(seed, 1800.0).monitor_s < 0.0);
    CHECK(campaign::run_motor(seed, 1800.0).monitor_s < 0.0);
  }
}

TEST_CASE("what a heater can do wrong is found in most plants, with the cause among the suspects") {
  for (const printer::Fault fault : {printer::Fault::thermistor_loose, printer::Fault::thermistor_stuck,
                                     printer::Fault::fan_lost, printer::Fault::heater_stays_on}) {
    int found = 0, right = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
      const campaign::Found run = campaign::run_hotend(seed, 3600.0, fault, 1200.0, true);
      CHECK_FALSE(run.is_early);
      if (run.monitor_s < 0.0) continue;
      ++found;
      right += (run.suspects & campaign::truth(fault)) != 0 ? 1 : 0;
    }
    INFO(printer::name(fault));
    CHECK(found == 10);
    CHECK(right == found);
  }
}

TEST_CASE("of two motors of which one fails, the winding's and the shaft's faults are told apart") {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    const campaign::Found shorted =
        campaign::run_motor(seed, 3600.0, campaign::MotorFault::winding_shorted, 1200.0);
    CHECK(shorted.monitor_s >= 0.0);
    CHECK(shorted.suspects == campaign::truth(campaign::MotorFault::winding_shorted));
    const campaign::Found braked =
        campaign::run_motor(seed, 3600.0, campaign::MotorFault::friction_grown, 1200.0);
    CHECK(braked.monitor_s >= 0.0);
    CHECK(braked.suspects == campaign::truth(campaign::MotorFault::friction_grown));
  }
}
