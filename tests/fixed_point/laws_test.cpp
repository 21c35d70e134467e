// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Power law, gain, limiter and air in whole numbers against their floating-point siblings: exhaustively,
// where the inputs can be counted.
#include <cmath>
#include <cstdlib>
#include <thermopower/control/air_temperature.hpp>
#include <thermopower/control/fixed_point/air_temperature.hpp>
#include <thermopower/control/fixed_point/gain_scheduler.hpp>
#include <thermopower/control/fixed_point/step_power_law.hpp>
#include <thermopower/control/fixed_point/safety_limiter.hpp>
#include <thermopower/control/gain_scheduler.hpp>
#include <thermopower/control/position_error.hpp>
#include <thermopower/control/safety_limiter.hpp>
#include <thermopower/control/step_power_law.hpp>

#include "../catch.hpp"

using namespace thermopower;

namespace {

struct WideLevels : fixed_point::ThesisLevels {
  static constexpr double full_power_error_deg() { return 37.0; }
};
struct FiveDegrees : fixed_point::ThesisLevels {
  static constexpr double full_power_error_deg() { return 5.0; }
};

template <class Constants>
int worst_unit_of_level_edges() {
  fixed_point::ProgrammedLevels<Constants> law;
  int worst = 0;
  for (int level = 2; level <= 10; ++level) {
    const double edge_units = level * Constants::full_power_error_deg() / 10.0 * 16384.0 / 360.0;
    int first = 0;
    while (law.step(static_cast<std::uint16_t>(first)) < 25 * level) ++first;
    worst = std::max(worst, std::abs(first - static_cast<int>(std::ceil(edge_units - 1e-9))));
  }
  return worst;
}

template <std::uint8_t low, std::uint8_t high>
void check_gain() {
  for (int power = 0; power < 256; ++power) {
    CAPTURE(int(low), int(high), power);
    const int numerator = 255 * low - power * (low - high);
    CHECK(fixed_point::TruncatedGain<low, high>::gain(static_cast<std::uint8_t>(power)) == numerator / 255);
    CHECK(fixed_point::RoundedGain<low, high>::gain(static_cast<std::uint8_t>(power)) ==
          (2 * numerator + 255) / 510);
    const GainScheduler<RoundedGain> rounded(GainConfig{float(low), float(high)});
    CHECK(fixed_point::RoundedGain<low, high>::gain(static_cast<std::uint8_t>(power)) ==
          rounded.step(static_cast<std::uint8_t>(power)));
    // In floating point a gain that is a whole number may come out a rounding below it, and is then cut to
    // the number below.
    const GainScheduler<TruncatedGain> truncated(GainConfig{float(low), float(high)});
    const int difference = fixed_point::TruncatedGain<low, high>::gain(static_cast<std::uint8_t>(power)) -
                           truncated.step(static_cast<std::uint8_t>(power));
    CHECK((difference == 0 || (difference == 1 && numerator % 255 == 0)));
  }
}

}  // namespace

TEST_CASE("with the program's constants every error gives the program's power") {
  fixed_point::ProgrammedLevels<> law;
  StepPowerLaw<ProgrammedLevels> real;
  for (int units = 0; units <= 8192; ++units) {
    CAPTURE(units);
    CHECK(law.step(static_cast<std::uint16_t>(units)) ==
          real.step(deg_from_units(static_cast<std::int16_t>(units))));
    // The program's own conversion, 45.5111 units to a degree.
    const int level = static_cast<int>(10.0 * units / 45.5111);
    CHECK(law.step(static_cast<std::uint16_t>(units)) == 25 * (level < 1 ? 1 : std::min(level, 10)));
  }
}

TEST_CASE("with other constants a level's edge is at most one unit beside the law's") {
  CHECK(worst_unit_of_level_edges<fixed_point::ThesisLevels>() == 0);
  CHECK(worst_unit_of_level_edges<FiveDegrees>() <= 1);
  CHECK(worst_unit_of_level_edges<WideLevels>() <= 1);
}

TEST_CASE("hysteresis holds a level on the way down as the floating-point rule does, to a unit") {
  fixed_point::HysteresisLevels<> law;
  StepPowerLaw<HysteresisLevels> real;
  int different = 0;
  for (const int end : {60, 3, 40, 20, 30, 0}) {
    static int units = 0;
    for (; units != end; units += units < end ? 1 : -1)
      different += law.step(static_cast<std::uint16_t>(units)) !=
                   real.step(deg_from_units(static_cast<std::int16_t>(units)));
  }
  CHECK(different <= 10);
}

TEST_CASE("gains are exact for all 256 levels") {
  check_gain<24, 4>();
  check_gain<180, 105>();
  check_gain<40, 2>();
  check_gain<0, 255>();
  check_gain<255, 0>();
  check_gain<7, 7>();
  check_gain<255, 255>();
  CHECK(fixed_point::TruncatedGain<24, 4>::gain(25) == 22);
  CHECK(fixed_point::TruncatedGain<180, 105>::gain(25) == 172);
  CHECK(fixed_point::TruncatedGain<40, 2>::gain(25) == 36);
  CHECK(fixed_point::TruncatedGain<24, 4>::gain(250) == 4);
  CHECK(fixed_point::TruncatedGain<180, 105>::gain(250) == 106);
  CHECK(fixed_point::TruncatedGain<40, 2>::gain(250) == 2);
}

namespace {
struct Indoors : fixed_point::StandardAir {
  static constexpr std::int8_t declared_C() { return 30; }
};

template <class Constants>
void check_air(const AirTemperature::Config& config) {
  for (int camera = -128; camera < 128; ++camera)
    for (int frame = -128; frame < 128; ++frame) {
      AirTemperature real(config);
      fixed_point::AirTemperature<Constants> whole;
      const auto expected = real.step(static_cast<float>(camera), static_cast<float>(frame));
      const auto got = whole.step(static_cast<std::int8_t>(camera), static_cast<std::int8_t>(frame));
      const bool is_same =
          got.source == expected.source &&
          (got.source == AirSource::neither || static_cast<float>(got.air) / 128.0f == expected.air_C);
      if (!is_same) FAIL("camera " << camera << ", frame " << frame);
    }
}
}  // namespace

TEST_CASE("both thermometers, every pair of readings: the same air from the same source") {
  check_air<fixed_point::StandardAir>(AirTemperature::Config::standard());
  check_air<Indoors>(AirTemperature::Config::declared(30.0f));
  check_air<fixed_point::BelievedAir>(AirTemperature::Config::believing());
}

TEST_CASE("the limiter decides as the floating-point one, but within 0.001 K of its edges") {
  long decisions = 0, different = 0;
  std::uint32_t random = 7;
  const auto next = [&](double from, double to) {
    random = random * 1664525u + 1013904223u;
    return from + (to - from) * random / 4294967296.0;
  };
  fixed_point::SafetyLimiter<fixed_point::ThesisLimit, fixed_point::PerCycle> whole;
  SafetyLimiter<PerCycle> real;
  for (long count = 0; count < 200000; ++count) {
    const fixed_point::Temperature motor = fixed_point::detail::temperature_of(next(30, 62));
    const double rate_K_per_s = next(-0.05, count % 2 == 0 ? 1.0 : 0.05);
    const fixed_point::Rate rate =
        static_cast<fixed_point::Rate>(rate_K_per_s * fixed_point::detail::rate_per_K_per_s());
    const double distance_K =
        60.0 - 30.0 * rate_K_per_s - static_cast<double>(fixed_point::celsius_of(motor));
    if (std::fabs(distance_K) < 0.001 ||
        std::fabs(60.0 - static_cast<double>(fixed_point::celsius_of(motor))) < 0.001)
      continue;
    const auto demand = static_cast<std::uint8_t>(next(1, 255));
    const LimitedPower got = whole.step(demand, fixed_point::GuardedTemperature::unchecked(motor), rate, 129);
    const LimitedPower expected = real.step(
        {demand, GuardedCelsius::unchecked(fixed_point::celsius_of(motor)), static_cast<float>(rate_K_per_s)},
        0.033f);
    ++decisions;
    different += got.power != expected.power || got.reason != expected.reason;
  }
  CHECK(decisions > 190000);
  CHECK(different == 0);
}

TEST_CASE("the ceiling in counts per second does not depend on the loop rate") {
  for (const int ticks : {1, 39, 129, 3906}) {
    fixed_point::PerSecond<> ceiling;
    int steps = 0;
    while (ceiling.ceiling() > 55) ceiling.lower(static_cast<fixed_point::Ticks>(ticks)), ++steps;
    CHECK(steps * ticks / 3906.25 == Approx(200 * 0.03).margin(0.03 + ticks / 3906.25));
    while (ceiling.ceiling() < 255) ceiling.raise(static_cast<fixed_point::Ticks>(ticks));
    ceiling.lower(65535);
    CHECK(ceiling.ceiling() == least_power());
  }
}

TEST_CASE("the power is never above the demand, and a cut leaves the least") {
  fixed_point::SafetyLimiter<> limiter;
  for (int demand = 0; demand < 256; ++demand) {
    CHECK(
        limiter.step(static_cast<std::uint8_t>(demand), fixed_point::GuardedTemperature::unchecked(0), 0, 100)
            .power <= demand);
    CHECK(limiter
              .step(static_cast<std::uint8_t>(demand),
                    fixed_point::GuardedTemperature::unchecked(fixed_point::detail::temperature_of(61)), 0,
                    100)
              .power == std::min(demand, 1));
    CHECK(limiter.cut(LimitReason::link_silent, static_cast<std::uint8_t>(demand)).power ==
          std::min(demand, 1));
  }
}
