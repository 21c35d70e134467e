// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// An hour of closed loop: the fixed-point model beside the laws in double precision, under the same commands.
#include <cmath>
#include <cstdio>
#include <thermopower/actuator/fixed_point/thermal_model.hpp>
#include <thermopower/control/fixed_point/axis_controller.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include "../catch.hpp"

using namespace thermopower;

namespace {

/// The axes of nano_gimbal.
template <class Motor>
using Programmed =
    fixed_point::AxisController<fixed_point::ThermalModel<fixed_point::ThesisMotor<Motor> >,
                                fixed_point::ProgrammedLevels<>,
                                fixed_point::SafetyLimiter<fixed_point::ThesisLimit, fixed_point::PerCycle>,
                                fixed_point::TruncatedGain<24, 4> >;
/// The axes of bare_metal_avr.
template <class Motor>
using Corrected = fixed_point::AxisController<fixed_point::ThermalModel<fixed_point::ThesisMotor<Motor> >,
                                              fixed_point::HysteresisLevels<>, fixed_point::SafetyLimiter<>,
                                              fixed_point::RoundedGain<24, 4> >;

template <class Axis, class Motor>
double worst_error_K(double demand_units, double air_C, double swing_K) {
  Axis axis;
  const auto current = Motor::template current_law<double>();
  const auto heating = Motor::template heating_law<double>();
  const double cooling_per_s = Motor::template cooling_law<double>().cooling_per_s;
  double exact_C = std::round(air_C);
  axis.start(fixed_point::detail::temperature_of(exact_C));
  double worst_K = 0, hottest_C = exact_C;
  double time_s = 0;
  for (long count = 0; time_s < 3600; ++count) {
    axis.prepare();
    const double volt = v_rms_from_power<double>(13.0, axis.state().power);
    const double heat = heating.rise_K_per_J(volt, exact_C) * volt * current.current_A(volt, exact_C);
    const auto ticks = static_cast<fixed_point::Ticks>(129 + (count * 7919) % 31 - 15);
    const double elapsed_s = ticks / fixed_point::detail::ticks_per_s();
    // Thermometers give whole degrees, their mean halves.
    const double air = std::round(2 * (air_C + swing_K * std::sin(time_s / 300))) / 2;
    exact_C += (heat - cooling_per_s * (exact_C - air)) * elapsed_s;
    const double wave = demand_units * (0.7 + 0.6 * std::sin(time_s / 17) * std::sin(time_s / 211));
    axis.step({static_cast<std::uint16_t>(wave < 0 ? 0 : wave),
               static_cast<fixed_point::CoarseTemperature>(air * 128), LimitReason::none},
              ticks);
    time_s += elapsed_s;
    worst_K = std::max(worst_K, std::fabs(static_cast<double>(axis.thermal().motor_C()) - exact_C));
    hottest_C = std::max(hottest_C, exact_C);
  }
  std::printf("  demand %.0f, air %.0f degC: hottest %.2f degC, error at most %.4f K\n", demand_units, air_C,
              hottest_C, worst_K);
  return worst_K;
}

template <class Axis, class Motor>
void check_motor() {
  double hottest_error_K = 0;
  for (const double demand : {5.0, 12.0, 25.0, 46.0, 200.0})
    for (const double air_C : {16.0, 25.0, 38.0, 50.0})
      hottest_error_K = std::max(hottest_error_K, worst_error_K<Axis, Motor>(demand, air_C, 3.0));
  CHECK(hottest_error_K < 0.1);
}
template <template <class> class Axis, class Motor>
void check_axes() {
  check_motor<Axis<Motor>, Motor>();
}

}  // namespace

TEST_CASE("an hour of closed loop stays within 0.1 K of the laws in double precision") {
  SECTION("2606 as programmed") { check_axes<Programmed, motors::Bgm2606_90t::AsProgrammed>(); }
  SECTION("5208 as programmed") { check_axes<Programmed, motors::Bgm5208_200_12::AsProgrammed>(); }
  SECTION("2606") { check_axes<Corrected, motors::Bgm2606_90t>(); }
  SECTION("5208") { check_axes<Corrected, motors::Bgm5208_200_12>(); }
}

TEST_CASE("the temperature saturates instead of wrapping, however long and hot the step") {
  fixed_point::ThermalModel<fixed_point::ThesisMotor<motors::Bgm2606_90t::AsProgrammed> > model;
  for (const double start_C : {-300.0, -50.0, 20.0, 180.0, 250.0}) {
    model.start(fixed_point::detail::temperature_of(start_C));
    for (int count = 0; count < 200; ++count) {
      model.prepare(255);
      model.step(125 * 128, 65535);
      CHECK(model.motor_C() >= -50.0f);
      CHECK(model.motor_C() <= 180.0f);
    }
    CHECK(model.motor_C() > 120.0f);
    for (int count = 0; count < 200; ++count) {
      model.prepare(0);
      model.step(-60 * 128, 65535);
      CHECK(model.motor_C() >= -50.0f);
    }
    CHECK(model.motor_C() == -50.0f);
  }
}

TEST_CASE("a clock in microseconds loses no time and survives its wrap") {
  fixed_point::Clock clock;
  std::uint32_t now_us = 0xFFFF0000u;
  clock.start(now_us);
  std::uint64_t ticks = 0, elapsed_us = 0;
  for (int count = 0; count < 10000; ++count) {
    const std::uint32_t step_us = 29000u + static_cast<std::uint32_t>(count % 977);
    now_us += step_us, elapsed_us += step_us;
    ticks += clock.elapsed(now_us);
  }
  CHECK(ticks == elapsed_us / 256);
  CHECK(clock.elapsed(now_us + 60000000u) == 65535);
}
