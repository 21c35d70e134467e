// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/step_power_law.hpp>

#include "near.hpp"

#include <limits>
#include <random>

namespace tp = thermopower;

TEST_CASE("the programmed levels are the original's, error by error") {
  tp::StepPowerLaw<tp::ProgrammedLevels> law;
  for (float error_deg = -3.0f; error_deg <= 3.0f; error_deg += 0.0007f) {
    const float e = std::fabs(error_deg);
    int level = static_cast<int>(e * 10.0f / 1.0f);  // program lines 188 to 195
    if (level < 1) level = 1;
    if (level > 10) level = 10;
    CAPTURE(error_deg);
    REQUIRE(law.step(error_deg) == 25 * level);
  }
}

TEST_CASE("the programmed levels step at tenths of the full error, from 25 to 250") {
  tp::StepPowerLaw<> law;
  CHECK(law.step(0.0f) == 25);
  CHECK(law.step(0.199f) == 25);
  CHECK(law.step(0.201f) == 50);
  CHECK(law.step(0.95f) == 225);
  CHECK(law.step(1.0f) == 250);
  CHECK(law.step(-1.0f) == 250);
  CHECK(law.step(180.0f) == 250);
}

TEST_CASE("eq 4.22 as printed asks for nothing at small errors and is capped at 255") {
  tp::StepPowerLaw<tp::PrintedLevels> law;
  CHECK(law.step(0.05f) == tp::least_power());
  CHECK(law.step(0.11f) == 25);
  CHECK(law.step(1.0f) == 250);
  CHECK(law.step(1.15f) == 255);
  CHECK(law.step(180.0f) == 255);
}

TEST_CASE("with hysteresis a noisy error at a level's edge moves the power once") {
  tp::StepPowerLaw<tp::HysteresisLevels> held;
  tp::StepPowerLaw<> plain;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> noise(-0.01f, 0.01f);
  int held_moves = 0, plain_moves = 0, last_held = held.step(0.5f), last_plain = plain.step(0.5f);
  for (int i = 0; i < 1000; ++i) {
    const float error_deg = 0.5f + noise(random);
    const int now_held = held.step(error_deg), now_plain = plain.step(error_deg);
    held_moves += now_held != last_held;
    plain_moves += now_plain != last_plain;
    last_held = now_held;
    last_plain = now_plain;
  }
  CHECK(held_moves == 0);
  CHECK(plain_moves > 300);
}

TEST_CASE("hysteresis rises at the edge and falls only its width below") {
  tp::StepPowerLaw<tp::HysteresisLevels> law;
  CHECK(law.step(0.29f) == 50);
  CHECK(law.step(0.301f) == 75);
  CHECK(law.step(0.28f) == 75);
  CHECK(law.step(0.274f) == 50);
  CHECK(law.step(0.0f) == 25);
  CHECK(law.step(5.0f) == 250);
  CHECK(law.state().level == 10);
}

TEST_CASE("without a width, hysteresis is the programmed rule") {
  const tp::StepPowerConfig config = {1.0f, 25, 0.0f};
  tp::StepPowerLaw<tp::HysteresisLevels> held(config);
  tp::StepPowerLaw<> plain(config);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> error(-1.5f, 1.5f);
  for (int i = 0; i < 5000; ++i) {
    const float error_deg = error(random);
    REQUIRE(held.step(error_deg) == plain.step(error_deg));
  }
}

TEST_CASE("the continuous rule is proportional between one level and ten") {
  tp::StepPowerLaw<tp::ContinuousPower> law;
  for (float error_deg = 0.0f; error_deg < 2.0f; error_deg += 0.001f) {
    const double expected = std::min(250.0, std::max(25.0, 250.0 * static_cast<double>(error_deg)));
    CAPTURE(error_deg);
    REQUIRE(std::abs(law.step(error_deg) - expected) <= 0.5001);
  }
}

TEMPLATE_TEST_CASE("a larger error never asks for less power, and both signs ask for the same", "[law]",
                   tp::ProgrammedLevels, tp::PrintedLevels, tp::HysteresisLevels, tp::ContinuousPower) {
  tp::StepPowerLaw<TestType> law, mirrored;
  int last = 0;
  for (float error_deg = 0.0f; error_deg < 200.0f; error_deg += error_deg < 2.0f ? 0.001f : 0.5f) {
    const int power = law.step(error_deg);
    CAPTURE(error_deg);
    REQUIRE(power >= last);
    REQUIRE(power >= tp::least_power());
    REQUIRE(mirrored.step(-error_deg) == power);
    last = power;
  }
}

TEMPLATE_TEST_CASE("an error that is no number asks for the least power", "[bad input]", tp::ProgrammedLevels,
                   tp::PrintedLevels, tp::HysteresisLevels, tp::ContinuousPower) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    tp::StepPowerLaw<TestType> law;
    law.step(3.0f);
    CHECK(law.step(bad) == tp::least_power());
  }
}

TEMPLATE_TEST_CASE("a refused configuration asks for no more than the first level", "[bad input]",
                   tp::ProgrammedLevels, tp::PrintedLevels, tp::HysteresisLevels, tp::ContinuousPower) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, -1.0f, -std::numeric_limits<float>::infinity()}) {
    tp::StepPowerLaw<TestType> law(tp::StepPowerConfig{bad, 25, 0.025f});
    CHECK(law.validate() == tp::ConfigError::full_power_error_deg);
    CHECK(law.step(0.5f) <= 25);
  }
}

TEST_CASE("a wrong constant of the power law is refused by name") {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const auto error = [](float full, int step, float hysteresis) {
    return tp::StepPowerConfig{full, static_cast<uint8_t>(step), hysteresis}.validate();
  };
  CHECK(tp::StepPowerConfig::standard().validate() == tp::ConfigError::none);
  for (const float bad : {nan, infinity, -infinity, 0.0f, -1.0f})
    CHECK(error(bad, 25, 0.0f) == tp::ConfigError::full_power_error_deg);
  for (const int bad : {0, 26, 255}) CHECK(error(1.0f, bad, 0.0f) == tp::ConfigError::power_step);
  for (const float bad : {nan, infinity, -1.0f})
    CHECK(error(1.0f, 25, bad) == tp::ConfigError::hysteresis_deg);
  CHECK(error(nan, 0, nan) == tp::ConfigError::full_power_error_deg);
  CHECK(error(1.0f, 0, nan) == tp::ConfigError::power_step);
}
