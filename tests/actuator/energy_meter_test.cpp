// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/energy_meter.hpp>

#include "near.hpp"

#include <limits>

namespace tp = thermopower;

TEST_CASE("what is integrated is part of the meter's type") {
  tp::EnergyMeter<tp::AtWinding, double> winding;
  tp::EnergyMeter<tp::AtSupply, double> supply;
  winding.step(7.7, 13.0, 0.141, 10.0);
  supply.step(7.7, 13.0, 0.141, 10.0);
  CHECK(winding.state().energy_J == Near(7.7 * 0.141 * 10.0));
  CHECK(supply.state().energy_J == Near(13.0 * 0.141 * 10.0));
  CHECK(winding.state().last_power_W == Near(1.0857));
  CHECK(supply.average_W() == Near(1.833));
}

TEST_CASE("energy is the sum of P dt and the average is energy over time, eq 4.24 and 4.25") {
  tp::EnergyMeter<tp::AtWinding, double> meter;
  CHECK(meter.average_W() == 0.0);
  meter.step(10.0, 0.0, 0.2, 3.0);
  meter.step(5.0, 0.0, 0.1, 1.0);
  CHECK(meter.state().energy_J == Near(6.5));
  CHECK(meter.state().time_s == Near(4.0));
  CHECK(meter.average_W() == Near(1.625));
  meter.start();
  CHECK(meter.state().energy_J == 0.0);
  CHECK(meter.average_W() == 0.0);
}

TEST_CASE("an hour of 10 ms steps keeps its digits in single precision") {
  tp::EnergyMeter<tp::AtWinding, float> meter;
  double exact_J = 0.0, exact_s = 0.0;
  float plain_J = 0.0f;
  for (int i = 0; i < 360000; ++i) {
    const float current_A = 0.05f + 0.04f * std::sin(static_cast<float>(i) * 0.001f);
    meter.step(8.0f, 13.0f, current_A, 0.01f);
    const float power_W = 8.0f * current_A;
    exact_J += static_cast<double>(power_W) * static_cast<double>(0.01f);
    exact_s += static_cast<double>(0.01f);
    plain_J += power_W * 0.01f;
  }
  CHECK(meter.state().energy_J == Near(exact_J).epsilon(2e-7));
  CHECK(meter.state().time_s == Near(exact_s).epsilon(2e-7));
  // Why the meter compensates: the plain sum is wrong in the fourth digit.
  CHECK(std::abs(static_cast<double>(plain_J) / exact_J - 1.0) > 2e-5);
}

TEST_CASE("a bad sample is counted and costs nothing of the sum") {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  tp::EnergyMeter<tp::AtWinding, float> meter;
  meter.step(8.0f, 13.0f, 0.1f, 1.0f);
  uint32_t rejected = 0;
  for (const float bad : {nan, infinity, -infinity}) {
    meter.step(bad, 13.0f, 0.1f, 1.0f);
    meter.step(8.0f, 13.0f, bad, 1.0f);
    meter.step(8.0f, 13.0f, 0.1f, bad);
    rejected += 3;
    CHECK(meter.rejected() == rejected);
  }
  meter.step(8.0f, 13.0f, 0.1f, -1.0f);
  meter.step(1e30f, 13.0f, 1e8f, 1e8f);
  meter.step(1e30f, 13.0f, 1.0f, 1e10f);
  CHECK(meter.rejected() == rejected + 3);
  CHECK(meter.state().energy_J == Near(0.8));
  CHECK(meter.state().time_s == Near(1.0));
  // The supply's voltage is not what a meter at the winding integrates.
  meter.step(8.0f, nan, 0.1f, 1.0f);
  CHECK(meter.state().energy_J == Near(1.6));
}

TEST_CASE("a saving compares two averages of the same kind, eq 4.26") {
  CHECK(tp::difference_percent(1.8, 1.4) == Near(22.2222));
  CHECK(tp::difference_percent(1.0, 1.29) == Near(-29.0));
  CHECK(std::isnan(tp::difference_percent(0.0, 1.0)));
  tp::EnergyMeter<tp::AtSupply, double> fixed, dynamic;
  fixed.step(7.7, 13.0, 0.2, 60.0);
  dynamic.step(4.0, 13.0, 0.1, 600.0);
  CHECK(tp::saving_percent(fixed, dynamic) == Near(50.0));
  CHECK(std::isnan(tp::saving_percent(tp::EnergyMeter<tp::AtSupply, double>(), dynamic)));
}
