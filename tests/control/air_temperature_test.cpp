// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/air_temperature.hpp>

#include "near.hpp"

#include <limits>

namespace tp = thermopower;
using tp::AirSource;

namespace {
const float none = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
}

TEST_CASE("two thermometers that agree are averaged, eq 4.20") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  CHECK(air.step(27.0f, 24.0f).air_C == 25.5f);
  CHECK(air.state().source == AirSource::both);
  CHECK(air.step(-5.0f, -8.0f).air_C == -6.5f);
  CHECK(air.step(30.0f, 15.0f).source == AirSource::both);
}

TEST_CASE("when one thermometer is missing or lies, the other one counts") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  for (const float bad : {none, infinite, -infinite, -41.0f, 86.0f, 1e30f}) {
    CHECK(air.step(bad, 24.0f).air_C == 24.0f);
    CHECK(air.state().source == AirSource::frame);
    CHECK(air.step(27.0f, bad).air_C == 27.0f);
    CHECK(air.state().source == AirSource::camera);
  }
}

TEST_CASE("when neither is plausible there is no air temperature") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  CHECK(air.state().source == AirSource::neither);
  CHECK(std::isnan(air.state().air_C));
  air.step(25.0f, 25.0f);
  for (const float bad : {none, infinite, -infinite, 120.0f}) {
    CHECK(std::isnan(air.step(bad, bad).air_C));
    CHECK(air.state().source == AirSource::neither);
  }
}

TEST_CASE("of two that disagree the warmer one counts") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  CHECK(air.step(40.0f, 20.0f).air_C == 40.0f);
  CHECK(air.state().source == AirSource::warmer);
  CHECK(air.step(20.0f, 40.0f).air_C == 40.0f);
}

TEST_CASE("a frame IMU that is not fitted reads 0 degC and is not averaged, in a warm room or a cool one") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  for (const float camera_C : {30.0f, 16.0f, 14.0f, 5.0f, 1.0f}) {
    CHECK(air.step(camera_C, 0.0f).air_C == camera_C);
    CHECK(air.state().source == AirSource::camera);
  }
  CHECK(air.step(-8.0f, 0.0f).air_C == -8.0f);
  // One that has read something else is fitted; a sudden 0 from it is a fault, and the warmer one counts.
  air.step(20.0f, 18.0f);
  CHECK(air.step(20.0f, 0.0f).air_C == 20.0f);
  CHECK(air.state().source == AirSource::warmer);
}

TEST_CASE("thermometers that have only ever read 0 are not awake") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  for (int answers = 0; answers < 3; ++answers) CHECK(std::isnan(air.step(0.0f, 0.0f).air_C));
  CHECK(air.step(24.0f, 0.0f).air_C == 24.0f);
  CHECK(air.step(1.0f, 0.0f).air_C == 1.0f);
  CHECK(air.step(0.0f, 0.0f).air_C == 0.0f);  // winter, and it has shown that it moves
}

TEST_CASE("a fall is believed as fast as air falls, a rise at once") {
  tp::AirTemperature air(tp::AirTemperature::Config::believing());
  CHECK(air.step(30.0f, 30.0f, 0.03f).air_C == 30.0f);
  CHECK(air.step(5.0f, 5.0f, 1.0f).air_C == Approx(29.8f));
  for (int i = 0; i < 130; ++i) air.step(5.0f, 5.0f, 1.0f);
  CHECK(air.state().air_C == 5.0f);
  CHECK(air.step(30.0f, 30.0f, 0.03f).air_C == 30.0f);
}

TEST_CASE("a wrong constant of the air temperature is refused by name") {
  using tp::ConfigError;
  const auto error = [](float from_C, float to_C, float apart_K) {
    return tp::AirTemperature::Config{from_C, to_C, apart_K, 0.2f, -40.0f}.validate();
  };
  CHECK(error(-40.0f, 85.0f, 15.0f) == ConfigError::none);
  for (const float bad : {none, infinite, -infinite}) {
    CHECK(error(bad, 85.0f, 15.0f) == ConfigError::minimum_plausible_C);
    CHECK(error(-40.0f, bad, 15.0f) == ConfigError::maximum_plausible_C);
    CHECK(error(-40.0f, 85.0f, bad) == ConfigError::maximum_difference_K);
  }
  CHECK(error(-40.0f, -40.0f, 15.0f) == ConfigError::maximum_plausible_C);
  CHECK(error(-40.0f, 85.0f, 0.0f) == ConfigError::maximum_difference_K);
  CHECK(tp::AirTemperature(tp::AirTemperature::Config{none, none, none, none, none}).validate() ==
        ConfigError::minimum_plausible_C);
}
