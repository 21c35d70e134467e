// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/control/safety_limiter.hpp>

#include "limiter_inputs.hpp"
#include "near.hpp"

#include <limits>
#include <random>

namespace tp = thermopower;
using tp::LimitReason;

namespace {
const float nan_ = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
}

TEST_CASE("per cycle, the ceiling is the thesis's, decision by decision") {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> temperature(40.0f, 61.5f), rate(-0.2f, 0.6f);
  std::uniform_int_distribution<int> demand(1, 10);
  tp::SafetyLimiter<tp::PerCycle> limiter;
  int ceiling = 255;
  for (int i = 0; i < 200000; ++i) {
    // Long stretches at one operating point, so that the ceiling travels its whole range.
    static float motor_C, rate_K_per_s;
    if (i % 97 == 0) {
      motor_C = temperature(random);
      rate_K_per_s = rate(random);
    }
    const int asked = 25 * demand(random);
    if (motor_C > 60.0f)  // program lines 200 to 210
      ceiling = 1;
    else if (motor_C > 60.0f - 30.0f * rate_K_per_s) ceiling -= ceiling > 1;
    else ceiling += ceiling < 255;
    const auto granted = limiter.step(
        told::motor_of<decltype(limiter)>(static_cast<uint8_t>(asked), motor_C, rate_K_per_s), 0.03f);
    REQUIRE(limiter.ceiling() == ceiling);
    REQUIRE(granted.power == std::min(asked, ceiling));
    REQUIRE((granted.reason == LimitReason::none) == (asked <= ceiling && motor_C <= 60.0f));
  }
}

TEST_CASE("the limiter says why") {
  tp::SafetyLimiter<tp::PerCycle> limiter;
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(250, 30.0f, 0.1f), 0.03f).reason == LimitReason::none);
  for (int i = 0; i < 20; ++i) limiter.step(told::motor_of<decltype(limiter)>(250, 59.0f, 0.5f), 0.03f);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(250, 59.0f, 0.5f), 0.03f).reason ==
        LimitReason::safety_temperature);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(100, 59.0f, 0.5f), 0.03f).reason == LimitReason::none);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(250, 59.0f, -0.1f), 0.03f).reason ==
        LimitReason::recovering);
  const auto hot = limiter.step(told::motor_of<decltype(limiter)>(250, 60.01f, -0.1f), 0.03f);
  CHECK(hot.reason == LimitReason::over_temperature);
  CHECK(hot.power == tp::least_power());
  CHECK_FALSE(tp::is_fault(hot.reason));
  CHECK(tp::is_fault(LimitReason::temperature_not_finite));
}

TEST_CASE("at the limit and at the safety temperature itself the actuator is still safe, as programmed") {
  tp::SafetyLimiter<tp::PerCycle> limiter;
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(250, 60.0f, 0.0f), 0.03f).reason == LimitReason::none);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(250, 45.0f, 0.5f), 0.03f).reason == LimitReason::none);
  CHECK(limiter.ceiling() == 255);
}

TEMPLATE_TEST_CASE("a hotter history never gets more power", "[law]", tp::PerCycle, tp::PerSecond) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> temperature(30.0f, 62.0f), warmer(0.0f, 4.0f), rate(-0.3f, 0.6f),
      step_s(0.0f, 0.2f);
  std::uniform_int_distribution<int> demand(1, 255);
  for (int history = 0; history < 300; ++history) {
    tp::SafetyLimiter<TestType> cool, hot;
    float motor_C = 40.0f, extra_K = 0.0f, rate_K_per_s = 0.0f;
    for (int i = 0; i < 500; ++i) {
      if (i % 25 == 0) {
        motor_C = temperature(random);
        extra_K = warmer(random);
        rate_K_per_s = rate(random);
      }
      const uint8_t asked = static_cast<uint8_t>(demand(random));
      const float dt_s = step_s(random);
      const auto less = hot.step(told::motor_of<decltype(hot)>(asked, motor_C + extra_K, rate_K_per_s), dt_s);
      const auto more = cool.step(told::motor_of<decltype(cool)>(asked, motor_C, rate_K_per_s), dt_s);
      REQUIRE(hot.ceiling() <= cool.ceiling());
      REQUIRE(less.power <= more.power);
      REQUIRE(more.power <= asked);
      REQUIRE((more.reason != LimitReason::none || more.power == asked));
    }
  }
}

TEMPLATE_TEST_CASE("a faster rise never gets more power", "[law]", tp::PerCycle, tp::PerSecond) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> temperature(30.0f, 62.0f), rate(-0.3f, 0.6f), more_rate(0.0f, 0.2f);
  for (int history = 0; history < 300; ++history) {
    tp::SafetyLimiter<TestType> slow, fast;
    for (int i = 0; i < 300; ++i) {
      const float motor_C = temperature(random), rate_K_per_s = rate(random);
      slow.step(told::motor_of<decltype(slow)>(255, motor_C, rate_K_per_s), 0.03f);
      fast.step(told::motor_of<decltype(fast)>(255, motor_C, rate_K_per_s + more_rate(random)), 0.03f);
      REQUIRE(fast.ceiling() <= slow.ceiling());
    }
  }
}

TEST_CASE("per second, the ceiling does not depend on the loop rate; per cycle it does") {
  const auto ceiling_after = [](auto limiter, float dt_s) {
    const int steps = static_cast<int>(3.0f / dt_s + 0.5f);
    for (int i = 0; i < steps; ++i) limiter.step(told::motor_of<decltype(limiter)>(255, 55.0f, 0.5f), dt_s);
    return static_cast<int>(limiter.ceiling());
  };
  const int expected = 255 - 100;  // 33.3 counts per second for three seconds
  for (const float dt_s : {0.001f, 0.005f, 0.01f, 0.03f, 0.1f, 0.5f, 3.0f}) {
    CAPTURE(dt_s);
    CHECK(std::abs(ceiling_after(tp::SafetyLimiter<tp::PerSecond>(), dt_s) - expected) <= 1);
  }
  CHECK(ceiling_after(tp::SafetyLimiter<tp::PerCycle>(), 0.03f) == expected);
  CHECK(ceiling_after(tp::SafetyLimiter<tp::PerCycle>(), 0.01f) == 1);
}

TEST_CASE("at the thesis's 30 ms both rules decide the same, to one count") {
  tp::SafetyLimiter<tp::PerCycle> cycle;
  tp::SafetyLimiter<tp::PerSecond> second;
  std::mt19937 random(4);
  std::uniform_real_distribution<float> temperature(40.0f, 60.0f);
  float motor_C = 50.0f;
  for (int i = 0; i < 20000; ++i) {
    if (i % 131 == 0) motor_C = temperature(random);
    cycle.step(told::motor_of<decltype(cycle)>(255, motor_C, 0.3f), 0.03f);
    second.step(told::motor_of<decltype(second)>(255, motor_C, 0.3f), 0.03f);
    // The fraction that a whole count hides shows at the ends of the range only.
    REQUIRE(std::abs(cycle.ceiling() - second.ceiling()) <= 1);
  }
}

TEMPLATE_TEST_CASE("what is no temperature, rate or time cuts the power and says so", "[bad input]",
                   tp::PerCycle, tp::PerSecond) {
  for (const float bad : {nan_, infinite, -infinite, -300.0f}) {
    tp::SafetyLimiter<TestType> limiter;
    const auto granted = limiter.step(told::motor_of<decltype(limiter)>(200, bad, 0.0f), 0.03f);
    CHECK(granted.power == tp::least_power());
    CHECK(granted.reason == LimitReason::temperature_not_finite);
    CHECK(limiter.ceiling() == tp::least_power());
  }
  for (const float bad : {nan_, infinite, -infinite}) {
    tp::SafetyLimiter<TestType> limiter;
    CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, 30.0f, bad), 0.03f).power == tp::least_power());
    CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, 30.0f, bad), 0.03f).reason ==
          LimitReason::temperature_not_finite);
  }
  for (const float bad : {nan_, infinite, -infinite, -0.01f}) {
    tp::SafetyLimiter<TestType> limiter;
    CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, 30.0f, 0.0f), bad).power == tp::least_power());
    CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, 30.0f, 0.0f), bad).reason ==
          LimitReason::time_invalid);
  }
}

TEMPLATE_TEST_CASE("after a cut the power returns gradually", "", tp::PerCycle, tp::PerSecond) {
  tp::SafetyLimiter<TestType> limiter;
  limiter.cut(LimitReason::link_silent);
  int last = tp::least_power(), cycles = 0;
  for (; limiter.ceiling() < 250; ++cycles) {
    const auto granted = limiter.step(told::motor_of<decltype(limiter)>(250, 30.0f, 0.0f), 0.03f);
    REQUIRE(granted.power - last <= 2);
    REQUIRE(granted.power >= last);
    if (granted.power < 250) REQUIRE(granted.reason == LimitReason::recovering);
    last = granted.power;
  }
  CHECK(cycles > 240);
  CHECK(cycles < 260);
}

TEMPLATE_TEST_CASE("nobody gets more than was asked for, not even the least power", "", tp::PerCycle,
                   tp::PerSecond) {
  tp::SafetyLimiter<TestType> limiter;
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(0, 30.0f, 0.0f), 0.03f).power == 0);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(0, 30.0f, 0.0f), 0.03f).reason == LimitReason::none);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(0, 90.0f, 0.0f), 0.03f).power == 0);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(0, nan_, 0.0f), 0.03f).power == 0);
  CHECK(limiter.cut(LimitReason::supply_low, 0).power == 0);
}

TEST_CASE("a step as long as a day neither overflows the ceiling nor lets it out of its range") {
  tp::SafetyLimiter<> limiter;
  limiter.step(told::motor_of<decltype(limiter)>(255, 55.0f, 0.5f), 86400.0f);
  CHECK(limiter.ceiling() == 1);
  limiter.step(told::motor_of<decltype(limiter)>(255, 30.0f, 0.0f), 3e38f);
  CHECK(limiter.ceiling() == 255);
  limiter.step(told::motor_of<decltype(limiter)>(255, 55.0f, 0.5f), 3e38f);
  CHECK(limiter.ceiling() == 1);
}

TEST_CASE("a wrong constant of the limiter is refused by name") {
  using tp::ConfigError;
  const auto error = [](float maximum_C, float safety_time_s, float rate_per_s) {
    return tp::SafetyLimiter<>(tp::SafetyLimiterConfig{maximum_C, safety_time_s, rate_per_s}).validate();
  };
  CHECK(error(60.0f, 30.0f, 33.0f) == ConfigError::none);
  for (const float bad : {nan_, infinite, -infinite, -1.0f, 201.0f})
    CHECK(error(bad, 30.0f, 33.0f) == ConfigError::maximum_C);
  for (const float bad : {nan_, infinite, -1.0f, 0.0f}) {
    CHECK(error(60.0f, bad, 33.0f) == ConfigError::safety_time_s);
    CHECK(error(60.0f, 30.0f, bad) == ConfigError::rate_per_s);
  }
}

TEMPLATE_TEST_CASE("each bound is where the description puts it", "", tp::PerCycle, tp::PerSecond) {
  tp::SafetyLimiter<TestType> limiter;
  // No time has passed: nothing moves, and it is no fault.
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, 30.0f, 0.0f), 0.0f).reason == LimitReason::none);
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, -273.15f, 0.0f), 0.03f).reason ==
        LimitReason::none);  // absolute zero
  CHECK(limiter.step(told::motor_of<decltype(limiter)>(200, -273.2f, 0.0f), 0.03f).reason ==
        LimitReason::temperature_not_finite);
  // A cut that nobody asked for any power for leaves the least.
  tp::SafetyLimiter<TestType> unasked;
  CHECK(unasked.cut(LimitReason::link_silent).power == tp::least_power());
  CHECK(unasked.cut(LimitReason::link_silent).reason == LimitReason::link_silent);
  CHECK(unasked.cut(LimitReason::link_silent, 1).power == 1);
  CHECK(unasked.cut(LimitReason::link_silent, 2).power == tp::least_power());
}

TEST_CASE("the standard is the thesis's: 60 degC, 30 s, one count in 30 ms") {
  const tp::SafetyLimiterConfig config = tp::SafetyLimiterConfig::standard();
  CHECK(config.maximum_C == 60.0f);
  CHECK(config.safety_time_s == 30.0f);
  CHECK(std::abs(config.rate_per_s * 0.03f - 1.0f) < 1e-6f);
  tp::SafetyLimiter<> limiter;
  CHECK(limiter.config().maximum_C == 60.0f);
  CHECK(limiter.state().ceiling == 255.0f);
  limiter.step(told::motor_of<decltype(limiter)>(255, 55.0f, 0.5f), 0.015f);  // half a count
  CHECK(std::abs(limiter.state().ceiling - 254.5f) < 1e-4f);
}

TEST_CASE("the ends of a constant's range belong to it") {
  using tp::ConfigError;
  const auto error = [](float maximum_C) {
    return tp::SafetyLimiterConfig{maximum_C, 30.0f, 33.0f}.validate();
  };
  CHECK(error(0.0f) == ConfigError::none);
  CHECK(error(200.0f) == ConfigError::none);
  CHECK(error(-0.001f) == ConfigError::maximum_C);
  CHECK(error(200.001f) == ConfigError::maximum_C);
}

TEST_CASE("the numbers of the reasons are stable, for logs, and from 64 up they are faults") {
  const struct {
    LimitReason reason;
    int number;
  } known[] = {{LimitReason::none, 0},
               {LimitReason::safety_temperature, 1},
               {LimitReason::over_temperature, 2},
               {LimitReason::recovering, 3},
               {LimitReason::winding_limit, 4},
               {LimitReason::body_limit, 5},
               {LimitReason::node_limit, 6},
               {LimitReason::no_telemetry_yet, 64},
               {LimitReason::link_silent, 65},
               {LimitReason::error_not_finite, 66},
               {LimitReason::air_implausible, 67},
               {LimitReason::supply_low, 68},
               {LimitReason::supply_not_finite, 69},
               {LimitReason::temperature_not_finite, 70},
               {LimitReason::time_invalid, 71},
               {LimitReason::config_invalid, 72},
               {LimitReason::not_obeyed, 73},
               {LimitReason::supply_implausible, 74},
               {LimitReason::sensor_missing, 75}};
  for (const auto& one : known) {
    CHECK(static_cast<int>(one.reason) == one.number);
    CHECK(tp::is_fault(one.reason) == (one.number >= 64));
  }
  CHECK_FALSE(tp::is_fault(static_cast<LimitReason>(63)));
  CHECK(static_cast<int>(tp::least_power()) == 1);
}
