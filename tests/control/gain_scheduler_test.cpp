// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/gain_scheduler.hpp>

#include "near.hpp"

#include <limits>

namespace tp = thermopower;

namespace {
const tp::GainConfig roll = {24.0f, 4.0f}, pitch = {180.0f, 105.0f}, yaw = {40.0f, 2.0f};
}

TEST_CASE("truncated as programmed, the gains are 22, 172 and 36 at power 25 and 4, 106 and 2 at 250") {
  typedef tp::GainScheduler<tp::TruncatedGain> Programmed;
  CHECK(Programmed(roll).step(25) == 22);
  CHECK(Programmed(pitch).step(25) == 172);
  CHECK(Programmed(yaw).step(25) == 36);
  CHECK(Programmed(roll).step(250) == 4);
  CHECK(Programmed(pitch).step(250) == 106);
  CHECK(Programmed(yaw).step(250) == 2);
}

TEST_CASE("eq 4.27 holds at every power: to the nearest count, or cut") {
  for (const tp::GainConfig& config :
       {roll, pitch, yaw, tp::GainConfig{0.0f, 255.0f}, tp::GainConfig{255.0f, 0.0f}}) {
    const tp::GainScheduler<> rounded(config);
    const tp::GainScheduler<tp::TruncatedGain> cut(config);
    for (int power = 0; power <= 255; ++power) {
      const double low = static_cast<double>(config.gain_low_power),
                   high = static_cast<double>(config.gain_high_power);
      const double exact = low - power / 255.0 * (low - high);
      CAPTURE(power, exact);
      REQUIRE(std::abs(rounded.step(static_cast<uint8_t>(power)) - exact) <= 0.5001);
      REQUIRE(cut.step(static_cast<uint8_t>(power)) <= exact + 1e-4);
      REQUIRE(cut.step(static_cast<uint8_t>(power)) > exact - 1.0001);
    }
  }
}

namespace {
struct SevenGains {
  static constexpr uint8_t size() { return 7; }
  static const uint8_t* gains() {
    static const uint8_t table[] = {255, 200, 130, 131, 131, 20, 0};
    return table;
  }
};
struct TwoGains {
  static constexpr uint8_t size() { return 2; }
  static const uint8_t* gains() {
    static const uint8_t table[] = {40, 2};
    return table;
  }
};
struct ManyGains {
  static constexpr uint8_t size() { return 255; }
  static const uint8_t* gains() {
    static uint8_t table[255];
    for (int i = 0; i < 255; ++i) table[i] = static_cast<uint8_t>((i * 71) % 256);
    return table;
  }
};
}  // namespace

TEMPLATE_TEST_CASE("a gain table is interpolated to the nearest count", "", SevenGains, TwoGains, ManyGains) {
  const tp::GainScheduler<tp::TableGain<TestType>> gain;
  CHECK(gain.validate() == tp::ConfigError::none);
  for (int power = 0; power <= 255; ++power) {
    const double position = power / 255.0 * (TestType::size() - 1);
    const int index = std::min(static_cast<int>(position), TestType::size() - 2);
    const double exact = TestType::gains()[index] +
                         (position - index) * (TestType::gains()[index + 1] - TestType::gains()[index]);
    CAPTURE(power, exact);
    REQUIRE(std::abs(gain.step(static_cast<uint8_t>(power)) - exact) <= 0.5001);
  }
}

TEST_CASE("an actuator without a gain gets none") {
  CHECK(tp::NoGain().step(200) == 0);
  CHECK(tp::NoGain().validate() == tp::ConfigError::none);
}

TEST_CASE("a gain that was not set, or is no gain, is refused by name, and is 0 until it is mended") {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  CHECK(tp::GainScheduler<>().validate() == tp::ConfigError::gain_low_power);
  CHECK(tp::GainScheduler<>().step(100) == 0);
  for (const float bad : {nan, infinity, -infinity, -1.0f, 256.0f}) {
    CHECK(tp::GainConfig{bad, 4.0f}.validate() == tp::ConfigError::gain_low_power);
    CHECK(tp::GainConfig{4.0f, bad}.validate() == tp::ConfigError::gain_high_power);
  }
  CHECK(roll.validate() == tp::ConfigError::none);
}
