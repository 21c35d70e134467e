// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/energy_meter.hpp>
#include <thermopower/control/axis_controller.hpp>

#include "../actuator/thesis.hpp"
#include "limiter_inputs.hpp"

// Where the thesis's text, its tables and its program disagree, one test each.
// docs/explain/differences-from-the-thesis.md has the same numbers.

namespace tp = thermopower;
using namespace thesis;
using Small = tp::motors::Bgm2606_90t;
using Large = tp::motors::Bgm5208_200_12;

namespace {
/// Root mean square of model less measurement over every point of Table 4.1 or 4.2, relative to the largest
/// current in it.
template <class Law>
double relative_current_error(const Law& law, const std::string& number) {
  double sum = 0.0, largest_mA = 0.0;
  int count = 0;
  for (const auto& [experiment, rows] : experiments(number)) {
    for (const Row& row : rows) {
      largest_mA = std::max(largest_mA, row.current_mA);
      sum += std::pow(1000.0 * law.current_A(row.volt, row.motor_C) - row.current_mA, 2);
      ++count;
    }
  }
  return std::sqrt(sum / count) / largest_mA;
}
}  // namespace

TEST_CASE("disagreement 1: eq 4.2 prints a plus where program and measurement have a minus") {
  CHECK(Small::AsPrinted::current_law<double>().slope_V2_A_per_K == Near(0.0134e-3));
  CHECK(Small::AsProgrammed::current_law<double>().slope_V2_A_per_K == Near(-0.0134e-3));
  CHECK(relative_current_error(Small::AsProgrammed::current_law<double>(), "4_1") < 0.02);
  CHECK(relative_current_error(Small::AsPrinted::current_law<double>(), "4_1") > 0.1);
}

TEST_CASE("disagreement 2: eq 4.4 prints a plus where program and measurement have a minus") {
  CHECK(Large::AsPrinted::current_law<double>().slope_V2_A_per_K == Near(0.055e-3));
  CHECK(Large::AsProgrammed::current_law<double>().slope_V2_A_per_K == Near(-0.055e-3));
  CHECK(relative_current_error(Large::AsProgrammed::current_law<double>(), "4_2") < 0.02);
  CHECK(relative_current_error(Large::AsPrinted::current_law<double>(), "4_2") > 0.1);
}

TEST_CASE("disagreement 3: eq 4.18 multiplies the voltage, the program multiplies the temperature") {
  const auto printed = Large::AsPrinted::heating_law<double>(),
             programmed = Large::AsProgrammed::heating_law<double>();
  CHECK(printed.apparent_capacity_J_per_K(10.0, 40.0) == Near(60.0 * (0.2435 * 10.0 - 0.4952)));
  CHECK(programmed.apparent_capacity_J_per_K(10.0, 40.0) == Near(60.0 * (0.2435 * 40.0 - 0.4952)));
  // So the program believes the motor three to five times as heavy as it is.
  const double ratio =
      programmed.apparent_capacity_J_per_K(9.97, 30.0) / printed.apparent_capacity_J_per_K(9.97, 30.0);
  CHECK(ratio > 3.0);
  CHECK(ratio < 5.0);
}

TEST_CASE("disagreement 4: k is per minute, not per second") {
  CHECK(Small::cooling_law<double>().cooling_per_s == Near(0.11 / 60.0));
  CHECK(Large::cooling_law<double>().cooling_per_s == Near(0.05 / 60.0));
  // Table 4.3: after a minute 31.3 of 36.8 K are left. At 0.11 per second it would be 0.05 K.
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::RateCooling<double>> as_printed({{1.0}, {0.11}},
                                                                                        61.8);
  as_printed.step({0.0, 0.0, {25.0, 0.0}}, 60.0);
  const Table source = table("4_3");
  CHECK(source.number(1, "T_motor_C") - as_printed.hottest_C() > 30.0);
}

TEST_CASE("disagreement 5: r is degC per minute and watt, not degC per joule") {
  const auto rows = experiments("4_1").at(3);
  const auto law = Small::heating_law<double>();
  CHECK(60.0 * law.rise_K_per_J(9.97, rows[2].motor_C) == Near(rows[2].r).epsilon(0.1));
  CHECK(law.rise_K_per_J(9.97, rows[2].motor_C) < 0.1);
}

TEST_CASE("disagreement 6: Table 4.4 does not follow from Table 4.3") {
  const Table measured = table("4_3"), printed = table("4_4");
  const double expected[] = {0.1619, 0.1567, 0.1356, 0.1252, 0.1180, 0.1128, 0.1095, 0.1057, 0.1020, 0.0981};
  for (size_t i = 1; i <= 10; ++i) {
    const double k = -std::log((measured.number(i, "T_motor_C") - 25.0) / 36.8) / measured.number(i, "t_min");
    CHECK(std::abs(k - expected[i - 1]) < 5.1e-5);
    CHECK(std::abs(k - printed.number(i, "k_printed_per_min")) > 0.06);
  }
}

TEST_CASE("disagreement 7: the 12.9 V row of Table 4.9 holds only with the first point dropped") {
  const auto rows = experiments("4_1").at(5);
  std::vector<double> motor_C, r_inv;
  for (size_t i = 1; i < rows.size(); ++i) {
    motor_C.push_back(rows[i].motor_C);
    r_inv.push_back(rows[i].r_inv);
  }
  const auto every = polynomial_fit(motor_C, r_inv, 1);
  CHECK(std::abs(every[1] - 0.0032) > 0.004);
  CHECK(std::abs(every[0] - 0.2296) > 0.3);
  motor_C.erase(motor_C.begin());
  r_inv.erase(r_inv.begin());
  const auto without_first = polynomial_fit(motor_C, r_inv, 1);
  CHECK(std::abs(without_first[1] - 0.0032) < 1e-4);
  CHECK(std::abs(without_first[0] - 0.2296) < 1e-4);
}

TEST_CASE(
    "disagreement 8: rounding the slope of eq 4.16 to one digit costs 1.4, 2.6 and 4.1 K in three minutes") {
  auto unrounded = Small::AsProgrammed::heating_law<double>();
  unrounded.slope_V1_J_per_K2 = Small::heating_law<double>().slope_V1_J_per_K2;
  const auto cooling = Small::AsProgrammed::cooling_law<double>();
  const auto current = Small::AsProgrammed::current_law<double>();
  for (const auto& [power_param, cost_K] :
       {std::pair(150.0, 1.4), std::pair(200.0, 2.6), std::pair(250.0, 4.1)}) {
    const double rounded_C = heat<Small::AsProgrammed>(power_param, 30.0, 26.0, 3)[3];
    const double unrounded_C = heat(unrounded, cooling, current, power_param, 30.0, 26.0, 3)[3];
    CAPTURE(power_param);
    CHECK(unrounded_C - rounded_C == Near(cost_K).margin(0.15));
  }
}

TEST_CASE("disagreement 9: V_rms I and the power at the supply are different powers") {
  tp::EnergyMeter<tp::AtWinding, double> winding;
  tp::EnergyMeter<tp::AtSupply, double> supply;
  const double current_A = Small::AsProgrammed::current_law<double>().current_A(7.7, 60.0);
  winding.step(7.7, 13.0, current_A, 1.0);
  supply.step(7.7, 13.0, current_A, 1.0);
  CHECK(winding.average_W() == Near(1.088).margin(0.001));
  CHECK(supply.average_W() == Near(1.837).margin(0.001));
}

TEST_CASE(
    "disagreement 10: eq 4.22 allows 0 and is capped at 255, the program has ten levels from 25 to 250") {
  tp::StepPowerLaw<tp::PrintedLevels> printed;
  tp::StepPowerLaw<tp::ProgrammedLevels> programmed;
  CHECK(printed.step(0.05f) == tp::least_power());  // 0 is not valid on the board
  CHECK(programmed.step(0.05f) == 25);
  CHECK(printed.step(2.0f) == 255);
  CHECK(programmed.step(2.0f) == 250);
}

TEST_CASE("disagreement 11: eq 4.27 is linear, the program cuts it to a whole count") {
  const tp::GainConfig roll = {24.0f, 4.0f}, pitch = {180.0f, 105.0f}, yaw = {40.0f, 2.0f};
  CHECK(tp::TruncatedGain::gain(25, roll) == 22);
  CHECK(tp::TruncatedGain::gain(25, pitch) == 172);
  CHECK(tp::TruncatedGain::gain(25, yaw) == 36);
  CHECK(tp::TruncatedGain::gain(250, roll) == 4);
  CHECK(tp::TruncatedGain::gain(250, pitch) == 106);
  CHECK(tp::TruncatedGain::gain(250, yaw) == 2);
  CHECK(tp::RoundedGain::gain(25, pitch) == 173);
  CHECK(tp::RoundedGain::gain(250, yaw) == 3);
}

TEST_CASE(
    "disagreement 12: sixteen bits of microseconds lose what a slow cycle took; here time is an argument") {
  // What program line 141 keeps of a cycle of 70 ms, and of one that crosses the wrap on a machine with
  // 32-bit integers.
  const uint32_t before_us = 1000, after_us = 71000;
  const uint16_t kept =
      static_cast<uint16_t>(static_cast<uint16_t>(after_us) - static_cast<uint16_t>(before_us));
  CHECK(kept == 4464);
  CHECK(static_cast<int32_t>(static_cast<uint16_t>(after_us)) - static_cast<int32_t>(uint16_t(60000)) < 0);
  // Ours heats for as long as the cycle took: one of 70 ms equals seven of 10 ms.
  tp::ThermalModel<tp::HeatCapacityHeating<double>, tp::NewtonCooling<double>> whole({{18.0}, {0.05}}, 25.0),
      parts = whole;
  whole.step({5.0, 10.0, {25.0, 0.0}}, 0.07);
  for (int i = 0; i < 7; ++i) parts.step({5.0, 10.0, {25.0, 0.0}}, 0.01);
  CHECK(whole.hottest_C() == Near(parts.hottest_C()).epsilon(1e-14));
}

TEST_CASE("disagreement 13: at or below one volt the program has neither current nor heating") {
  const double least_V = tp::v_rms_from_power(13.0, 1.0);
  CHECK(least_V == Near(0.814).margin(0.0005));
  CHECK(Small::AsProgrammed::current_law<double>().current_A(least_V, 40.0) == 0.0);
  CHECK(Small::AsProgrammed::heating_law<double>().rise_K_per_J(least_V, 40.0) == 0.0);
  CHECK(Small::AsProgrammed::heating_law<double>().rise_K_per_J(5.76, 40.0) > 0.0);
}

TEST_CASE(
    "disagreement 14: the first cycle starts at air temperature, and its length is whatever the caller "
    "says") {
  using Axis = tp::AxisController<Small::AsProgrammed>;
  Axis axis(Axis::Config::with_gain({24.0f, 4.0f}));
  CHECK(axis.step({0.1f, 13.0f, 27.0f, tp::LimitReason::none}, 0.0f).motor_C == 27.0f);
  CHECK(axis.state().rate_K_per_s == 0.0f);
}

TEST_CASE(
    "disagreement 15: a limiter that moves by one per cycle depends on the loop rate; per second it does "
    "not") {
  const auto seconds_to_half = [](auto limiter, float dt_s) {
    float time_s = 0.0f;
    for (; limiter.ceiling() > 128; time_s += dt_s)
      limiter.step(told::motor_of<decltype(limiter)>(255, 55.0f, 0.5f), dt_s);
    return static_cast<double>(time_s);
  };
  CHECK(seconds_to_half(tp::SafetyLimiter<tp::PerCycle>(), 0.03f) == Near(3.81).margin(0.05));
  CHECK(seconds_to_half(tp::SafetyLimiter<tp::PerCycle>(), 0.01f) == Near(1.27).margin(0.05));
  CHECK(seconds_to_half(tp::SafetyLimiter<tp::PerSecond>(), 0.03f) == Near(3.81).margin(0.05));
  CHECK(seconds_to_half(tp::SafetyLimiter<tp::PerSecond>(), 0.01f) == Near(3.81).margin(0.05));
}

TEST_CASE("disagreement 16: experiment 5 of Table 4.2 was read every minute, not every half") {
  const Table source = table("4_2");
  for (size_t i = 1; i < source.rows(); ++i) {
    if (static_cast<int>(source.number(i, "experiment")) != 5 || source.number(i, "t_min") == 0.0) continue;
    const double gained_K = source.number(i, "T_motor_C") - source.number(i - 1, "T_motor_C");
    CHECK(gained_K / 1.0 == Near(source.number(i, "dTdt_printed_C_per_min")).margin(1e-9));
    CHECK(gained_K / 0.5 != Near(source.number(i, "dTdt_printed_C_per_min")).margin(0.5));
    if (source.number(i, "t_min") == 1.0) CHECK(source.text(i, "t_printed_min") == "0.5");
  }
}
