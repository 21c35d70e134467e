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

TEST_CASE("a minute of cooling tells a fault of the heat from one of the loss") {
  using thermopower::Suspect;
  const auto set = [](std::initializer_list<Suspect> all) {
    std::uint8_t sum = 0;
    for (const Suspect one : all) sum = static_cast<std::uint8_t>(sum | static_cast<std::uint8_t>(one));
    return sum;
  };
  // A thermometer that reads a constant share looks like a weak heater for ever.
  const std::uint8_t of_heat = set({Suspect::heater, Suspect::thermometer}),
                     of_loss = set({Suspect::loss, Suspect::fan, Suspect::air});
  for (const printer::Fault fault : {printer::Fault::heater_weak, printer::Fault::fan_lost}) {
    int found = 0, right = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed)
      for (const bool is_bed : {false, true}) {
        const campaign::Found run = is_bed ? campaign::run_bed(seed, 3600.0, fault, 1200.0, true)
                                           : campaign::run_hotend(seed, 3600.0, fault, 1200.0, true);
        if (run.monitor_s < 0.0 || run.monitor_s > 2300.0) continue;
        ++found;
        const std::uint8_t other = fault == printer::Fault::heater_weak ? of_loss : of_heat;
        right += (run.likeliest & campaign::truth(fault)) != 0 && (run.likeliest & other) == 0 ? 1 : 0;
      }
    INFO(printer::name(fault));
    CHECK(found > 12);
    CHECK(right >= found - 1);  // one in fifty is at an edge of its bounds that looks like the other
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
