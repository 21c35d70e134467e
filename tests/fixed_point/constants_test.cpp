// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What the compiler makes tables of, evaluated at run time as well: motors, their curves over POWER, units.

#include <cmath>
#include <thermopower/actuator/fixed_point/thermal_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/control/fixed_point/air_temperature.hpp>
#include <thermopower/control/fixed_point/gimbal_controller.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>

#include "../catch.hpp"
#include "robot.hpp"

using namespace thermopower;

namespace {

/// dT/dt by heating as a source of the fixed-point models states it: (p1 T + p0) / (c1 T + c0).
template <class Source>
double heating_K_per_s(double volt, double motor_C) {
  return (Source::power_slope_W_per_K(volt) * motor_C + Source::power_W(volt)) /
         (Source::capacity_slope_J_per_K2(volt) * motor_C + Source::capacity_J_per_K(volt));
}

}  // namespace

TEST_CASE("an ohmic motor's constants are Ohm's law on a heat capacity") {
  typedef fixed_point::OhmicMotor<Robot> Source;
  const OhmicCurrent<double> law = {1.2, 0.00393, 25.0};
  for (double volt = 1.0; volt <= Source::supply_V(); volt += 1.0)
    for (const double motor_C : {-20.0, 25.0, 120.0})
      CHECK(heating_K_per_s<Source>(volt, motor_C) == Approx(volt * law.current_A(volt, motor_C) / 180.0));
  CHECK(Source::cooling_per_s() == Approx(0.9 / 180.0));
  CHECK(Source::minimum_V_rms() == 0.0);  // any voltage heats
}

TEST_CASE("a thesis motor's constants are its three laws, above one volt") {
  typedef motors::Bgm2606_90t Motor;
  typedef fixed_point::ThesisMotor<Motor> Source;
  CHECK(Source::supply_V() == 13.0);
  CHECK(Source::minimum_V_rms() == 1.0);
  CHECK(Source::cooling_per_s() == Approx(0.11 / 60.0));
  CHECK(Source::least_capacity_J_per_K() == Motor::heating_law<double>().least_capacity_J_per_K);
  const ThesisCurrent<double> current = Motor::current_law<double>();
  const ThesisHeating<double> heating = Motor::heating_law<double>();
  for (double volt = 4.0; volt <= 13.0; volt += 1.0)
    for (const double motor_C : {25.0, 60.0})
      CHECK(heating_K_per_s<Source>(volt, motor_C) ==
            Approx(heating.rise_K_per_J(volt, motor_C) * volt * current.current_A(volt, motor_C)));
}

TEMPLATE_TEST_CASE("each node of a heating table is the motor's constants there, to the last of 16 bits", "",
                   fixed_point::OhmicMotor<Robot>, fixed_point::ThesisMotor<motors::Bgm2606_90t>) {
  typedef fixed_point::detail::HeatScaling<TestType> Scaling;
  typedef fixed_point::detail::HeatCurves<TestType> Curves;
  double widest = 0.0;
  for (int node = 0; node < fixed_point::detail::level_node_count(); ++node) {
    const int level = fixed_point::detail::level_of_node(node);
    if (level < 16) continue;  // below, a slope may saturate
    const fixed_point::detail::LevelNode at = Scaling::at(level);
    const double volt = TestType::supply_V() * std::sqrt(level / 255.0);
    CHECK(Curves::volt(level) == Approx(volt));
    const double power = Scaling::power_scale / level, capacity = Scaling::capacity_scale;
    CHECK(std::abs(at.first - TestType::power_slope_W_per_K(volt) * power * 256.0) <= 0.51);
    CHECK(std::abs(at.second - TestType::power_W(volt) * power) <= 0.51);
    CHECK(std::abs(at.third - TestType::capacity_slope_J_per_K2(volt) * capacity * 256.0) <= 0.51);
    CHECK(std::abs(at.fourth - TestType::capacity_J_per_K(volt) * capacity) <= 0.51);
    // Between the coldest and the hottest there is, power and capacity fit into 16 bits, and use most of them.
    for (const double motor_C : {fixed_point::detail::coldest_C(), fixed_point::detail::hottest_C()}) {
      const double held = (TestType::power_slope_W_per_K(volt) * motor_C + TestType::power_W(volt)) * power;
      CHECK(std::abs(held) <= 32767.0);
      widest = std::max(widest, std::abs(held));
    }
  }
  CHECK(Curves::widest_power() * Scaling::power_scale >= widest);
  CHECK(Curves::widest_capacity() * Scaling::capacity_scale == Approx(32700.0));
  CHECK(Curves::exponent_for(32700.0) == 0);
  CHECK(Curves::exponent_for(2.0 * 32700.0) == 1);
  CHECK(Curves::exponent_for(1.0) == -8);
  CHECK(Curves::power_of_two(-8) == 1.0 / 256.0);
}

TEST_CASE("a level that leaves a thesis motor at a volt or less does not heat it, the next one does") {
  typedef fixed_point::detail::HeatCurves<fixed_point::ThesisMotor<motors::Bgm2606_90t>> Curves;
  // V = 13 sqrt(level / 255) is 1 V at 255 / 169 = 1.5.
  CHECK(Curves::idle_level() == 1);
  CHECK(fixed_point::detail::HeatCurves<fixed_point::OhmicMotor<Robot>>::idle_level() == 0);
  typedef fixed_point::Heating<fixed_point::ThesisMotor<motors::Bgm2606_90t>> Heating;
  CHECK(Heating::rate(1, 40 * 128) == 0);
}

TEST_CASE("a source says how small its capacity may be; one that does not, has no such bound") {
  typedef fixed_point::ThesisMotor<motors::Bgm2606_90t> Thesis;
  CHECK(fixed_point::detail::least_capacity_J_per_K<Thesis>(0) == Thesis::least_capacity_J_per_K());
  CHECK(fixed_point::detail::least_capacity_J_per_K<fixed_point::OhmicMotor<Robot>>(0) == 0.0);
}

TEST_CASE("the reciprocals of the division are those of their divisors, to a thousandth") {
  typedef fixed_point::detail::ReciprocalTable<detail::MakeIndices<33>::Type> Table;
  for (int i = 0; i < 33; ++i) {
    const double divisor = Table::divisor(i);
    CHECK(Table::value(divisor) == Approx(2147483648.0 / divisor).epsilon(1e-3));
  }
  for (int divisor = 32768; divisor < 65536; divisor += 7)
    CHECK(fixed_point::detail::reciprocal(static_cast<uint16_t>(divisor)) ==
          Approx(2147483648.0 / divisor).epsilon(0.00018).margin(1.0));
}

TEST_CASE("units: back from a temperature, a rate and a clock") {
  CHECK(fixed_point::celsius_of(fixed_point::detail::temperature_of(-12.5)) == -12.5f);
  const double per_K = fixed_point::detail::rate_per_K_per_s();
  CHECK(fixed_point::K_per_s_of(static_cast<fixed_point::Rate>(1.5 * per_K)) == Approx(1.5));
  // The hottest and the coldest there are, and the fastest heating, are inside their types.
  CHECK(256.0 > fixed_point::detail::hottest_C() - fixed_point::detail::coldest_C());
  CHECK(fixed_point::K_per_s_of(fixed_point::detail::most_heating()) == Approx(3.8).epsilon(0.01));
  CHECK(fixed_point::detail::lesser(-1.0, 2.0) == -1.0);
  CHECK(fixed_point::detail::greater(-1.0, 2.0) == 2.0);
  CHECK(fixed_point::detail::absolute(-3.0) == 3.0);
  CHECK(fixed_point::detail::absolute(3.0) == 3.0);

  fixed_point::Clock clock;
  clock.elapsed(1000000u);
  CHECK(clock.waiting_us(1000000u) < 256u);  // what is less than a tick is kept
  const uint32_t kept_us = clock.waiting_us(1000000u);
  CHECK(clock.elapsed(1000256u) == 1);
  CHECK(clock.waiting_us(1000300u) == kept_us + 44u);
}

TEST_CASE("the programmed air falls at once, a believed one in 0.2 K a second, and both as they say") {
  fixed_point::AirTemperature<fixed_point::ProgrammedAir> at_once;
  fixed_point::AirTemperature<fixed_point::BelievedAir> slow;
  const fixed_point::Ticks second = 3906;
  // A thermometer is one once its reading has moved.
  for (const int reading_C : {29, 30}) {
    at_once.step(static_cast<int8_t>(reading_C), static_cast<int8_t>(reading_C), second);
    slow.step(static_cast<int8_t>(reading_C), static_cast<int8_t>(reading_C), second);
  }
  at_once.step(20, 20, second);
  slow.step(20, 20, second);
  CHECK(at_once.state().air == 20 * 128);
  CHECK(fixed_point::ProgrammedAir::fall_per_s() == 0.0);
  CHECK(static_cast<double>(30 * 128 - slow.state().air) / 128.0 ==
        Approx(fixed_point::StandardAir::fall_per_s()).margin(1.0 / 128.0));
}

TEST_CASE("the standard constants of whole numbers are those of the floating-point controllers") {
  const SafetyLimiter<>::Config limiter = SafetyLimiter<>::Config::standard();
  CHECK(fixed_point::ThesisLimit::maximum_C() == Approx(limiter.maximum_C));
  CHECK(fixed_point::ThesisLimit::safety_time_s() == Approx(limiter.safety_time_s));
  CHECK(fixed_point::ThesisLimit::rate_per_s() == Approx(limiter.rate_per_s));
  CHECK(fixed_point::ThesisLevels::hysteresis_deg() == Approx(StepPowerConfig::standard().hysteresis_deg));
  CHECK(fixed_point::StandardGimbal::minimum_supply_V() == Approx(GimbalConfig::standard().minimum_supply_V));
  CHECK(fixed_point::StandardAir::fall_per_s() == Approx(AirTemperature::Config::standard().fall_per_s));
  CHECK(fixed_point::StandardAir::declared_C() == Approx(AirTemperature::Config::standard().declared_C));
}
