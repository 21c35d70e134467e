// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Heating in whole numbers against the laws in double precision: every level, every 1/16 K of the whole
// range.
#include <cmath>
#include <cstdio>
#include <thermopower/actuator/fixed_point/thermal_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include "../catch.hpp"
#include "robot.hpp"

using namespace thermopower;

namespace {

struct Error {
  double relative = 0;  // of heating above 0.001 K/s
  double settled_K =
      0;  // what the error would make of the temperature if it lasted, where the laws' heating lasts at all
  int level = 0;
  double motor_C = 0;
};

constexpr double capacity_share =
    1.0 / 32.0;  // of the largest apparent heat capacity: nearer to the pole nothing is promised

/// The laws in double precision; the apparent heat capacity in units of its largest.
template <class Motor>
struct Laws {
  static double heating_K_per_s(int level, double motor_C) {
    const double volt = v_rms_from_power<double>(13.0, level);
    const double current_A = Motor::template current_law<double>().current_A(volt, motor_C);
    return Motor::template heating_law<double>().rise_K_per_J(volt, motor_C) * volt * current_A;
  }
  static double capacity(int level, double motor_C) {
    return Motor::template heating_law<double>().apparent_capacity_J_per_K(
        v_rms_from_power<double>(13.0, level), motor_C);
  }
  static double cooling_per_s() { return Motor::template cooling_law<double>().cooling_per_s; }
  typedef fixed_point::ThesisMotor<Motor> Source;
};

struct RobotLaws {
  static double heating_K_per_s(int level, double motor_C) {
    const OhmicCurrent<double> law = {1.2, 0.00393, 25.0};
    const double volt = v_rms_from_power<double>(24.0, level);
    return volt * law.current_A(volt, motor_C) / 180.0;
  }
  static double capacity(int, double motor_C) { return 180.0 * (1.0 + 0.00393 * (motor_C - 25.0)); }
  static double cooling_per_s() { return 0.9 / 180.0; }
  typedef fixed_point::OhmicMotor<Robot> Source;
};

template <class Motor>
Error error_of(int least_level, double coldest_C, double hottest_C, int stride = 8) {
  double largest = 0;
  for (int level = 0; level < 256; ++level)
    for (double motor_C = -50; motor_C <= 180; motor_C += 10)
      largest = std::max(largest, Motor::capacity(level, motor_C));
  Error worst;
  for (int level = least_level; level < 256; ++level) {
    for (int step = static_cast<int>(coldest_C * 128); step <= static_cast<int>(hottest_C * 128);
         step += stride) {
      const double motor_C = step / 128.0;
      if (Motor::capacity(level, motor_C) < capacity_share * largest) continue;
      const double exact = Motor::heating_K_per_s(level, motor_C);
      if (exact > 3.8) continue;
      const double got =
          static_cast<double>(fixed_point::Heating<typename Motor::Source>::rate(
              static_cast<std::uint8_t>(level), static_cast<fixed_point::CoarseTemperature>(step))) /
          fixed_point::detail::rate_per_K_per_s();
      const double error = std::fabs(got - exact);
      const double relative = error / std::max(exact, 0.001);
      if (relative > worst.relative) worst.relative = relative, worst.level = level, worst.motor_C = motor_C;
      if (exact <= Motor::cooling_per_s() * (motor_C + 10.0))
        worst.settled_K = std::max(worst.settled_K, error / Motor::cooling_per_s());
    }
  }
  std::printf("  from level %d, %g .. %g degC: %.3f %% (level %d, %.2f degC); settled %.4f K\n", least_level,
              coldest_C, hottest_C, 100 * worst.relative, worst.level, worst.motor_C, worst.settled_K);
  return worst;
}

}  // namespace

TEST_CASE(
    "the heating of the thesis motors is within 0.8 % over all levels and temperatures, and 0.25 % where a "
    "motor works") {
  const auto small = error_of<Laws<motors::Bgm2606_90t::AsProgrammed> >(0, -50, 180, 1);
  CHECK(small.relative < 0.008);
  CHECK(error_of<Laws<motors::Bgm2606_90t::AsProgrammed> >(25, 20, 80).relative < 0.0025);
  const auto large = error_of<Laws<motors::Bgm5208_200_12::AsProgrammed> >(0, -50, 180, 1);
  CHECK(large.relative < 0.008);
  CHECK(error_of<Laws<motors::Bgm2606_90t> >(0, -50, 180).relative < 0.008);
  CHECK(error_of<Laws<motors::Bgm2606_90t> >(25, 20, 80).relative < 0.0025);
}

TEST_CASE(
    "the 5208 with its corrected laws is within 2.3 % from level 12 up, and what that settles to within 0.03 "
    "K") {
  // Its current is a small difference of large numbers, and its heat capacity ends at level 6.
  const auto error = error_of<Laws<motors::Bgm5208_200_12> >(12, -50, 180);
  CHECK(error.relative < 0.023);
  CHECK(error.settled_K < 0.03);
}

TEST_CASE(
    "an error in the heating never settles to more than 0.1 K where the motor's temperature can settle") {
  // Where heating is at most what cooling takes away in air of -10 degC; above, the temperature only passes
  // through.
  CHECK(error_of<Laws<motors::Bgm2606_90t::AsProgrammed> >(0, 15, 100).settled_K < 0.1);
  CHECK(error_of<Laws<motors::Bgm5208_200_12::AsProgrammed> >(0, 15, 100).settled_K < 0.1);
  CHECK(error_of<Laws<motors::Bgm2606_90t> >(0, 15, 100).settled_K < 0.1);
  CHECK(error_of<Laws<motors::Bgm5208_200_12> >(0, 15, 100).settled_K < 0.1);
}

TEST_CASE("a motor of resistance and heat capacity is within 0.1 %") {
  CHECK(error_of<RobotLaws>(1, -50, 180).relative < 0.001);
}

TEST_CASE("level tables hit their nodes and stay between them") {
  for (int level = 0; level < 256; ++level) {
    const fixed_point::detail::LevelPosition position =
        fixed_point::detail::level_position(static_cast<std::uint8_t>(level));
    const int below = fixed_point::detail::level_of_node(position.node),
              above = fixed_point::detail::level_of_node(position.node + 1);
    CHECK(below <= level);
    CHECK(level < above);
    CHECK(position.share * (above - below) == 256 * (level - below));
    CHECK((level < 16 || 8 * (above - below) <= level));
  }
}
