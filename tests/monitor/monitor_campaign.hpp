// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// Hours of heaters and motors whose constants lie within the declared bounds, every second one in a corner of them: does the
// monitor alarm? And with a fault: does it, when, what does it say, and what do the usual checks say of the same run? The plants
// share no code with the library.

#include "../../examples/08_heater/heater.hpp"
#include "../../examples/08_heater/printer_plant.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace campaign {

namespace tp = thermopower;

/// Numbers that a run draws.
class Draw {
public:
  explicit Draw(std::uint32_t seed) : random_(seed), is_corner_(random_() % 2 == 0) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 5) / 134217728.0;
  }
  bool once_in(int many) { return random_() % static_cast<unsigned>(many) == 0; }
  /// 1 within a fraction; in a corner of the bounds one of the ends.
  double within(double error) {
    return is_corner_ ? (once_in(2) ? 1.0 - error : 1.0 + error) : between(1.0 - error, 1.0 + error);
  }
  std::mt19937& random() { return random_; }

private:
  std::mt19937 random_;
  bool is_corner_;
};

/// One run with a fault, as each check saw it: seconds from the fault on, below 0 for never.
struct Found {
  double monitor_s = -1.0, usual_s[3] = {-1.0, -1.0, -1.0};
  bool is_early = false;  ///< The monitor alarmed before the fault.
  bool is_usual_early[3] = {false, false,
                            false};  ///< So did a usual check: what it says later counts for nothing.
  std::uint8_t suspects = 0;
  std::uint8_t likeliest = 0;  ///< Of a heater that is cut: a minute after the alarm.
};

/// Notes the first alarm.
inline void note(double& time_s, bool& is_early, bool is_alarm, double after_s) {
  if (!is_alarm || time_s >= 0.0 || is_early) return;
  if (after_s < 0.0) is_early = true;
  else time_s = after_s;
}

/// A heater within the bounds of its constants.
inline printer::Plant drawn_heater(const printer::Plant& nominal, const tp::HeatBalanceConfig& bounds,
                                   Draw& draw) {
  printer::Plant plant = nominal;
  plant.ohm_at_20C /= draw.within(bounds.heat_error);
  const double capacity = draw.within(bounds.capacity_error), second = draw.within(bounds.second_error);
  plant.element_J_per_K *= capacity;
  plant.block_J_per_K *= capacity;
  plant.second_J_per_K *= second;
  plant.second_W_per_K *= second / draw.within(bounds.second_error);
  const double lag = draw.within(bounds.lag_error);
  plant.element_W_per_K *= capacity / lag;
  plant.thermometer_s *= lag;
  plant.loss_W_per_K *= draw.within(bounds.loss_error);
  plant.fan_W_per_K *= draw.within(bounds.fan_error);
  return plant;
}

/// An hour of a heater: what a printer does in no order at all.
/// @param fault_s  when it fails; above `run_s` never
/// @param is_cutting  the monitor cuts the power, and names the cause while the heater cools
template <class Constants>
Found run_heater(const printer::Plant& nominal, const heater::Pid::Config& gains,
                 const heater::RunawayCheck& runaway_check, const heater::KelvinSumCheck& sum_check,
                 const heater::RateCheck& rate_check, double highest_C, std::uint32_t seed, double run_s,
                 printer::Fault fault = printer::Fault::none, double fault_s = 1e9, bool is_cutting = false) {
  Draw draw(seed);
  const tp::HeatBalanceConfig bounds = Constants::heat_balance();
  const printer::Plant plant = drawn_heater(nominal, bounds, draw);
  const double told_air_C = draw.between(10.0, 30.0), drift_K = draw.between(-1.0, 1.0) * bounds.air_error_K,
               drift_s = draw.between(300.0, 3600.0), dt_s = 0.1;
  printer::Heater real(plant, told_air_C, static_cast<std::uint32_t>(draw.random()()));
  heater::Pid pid(gains);
  heater::RunawayCheck runaway = runaway_check;
  heater::KelvinSumCheck sum = sum_check;
  heater::RateCheck rate = rate_check;
  heater::Watch<Constants> watch;
  Found found;
  double target_C = 0.0, target_until_s = 20.0, fan = 0.0, fan_until_s = 0.0, supply = 1.0;
  float duty = 0.0f;
  bool has_failed = false;
  for (double now_s = 0.0; now_s < run_s; now_s += dt_s) {
    if (now_s >= target_until_s) {
      // With a fault it stays on, so that the checks have something to see.
      target_C = fault == printer::Fault::none && draw.once_in(4) ? 0.0 : draw.between(0.5, 1.0) * highest_C;
      target_until_s = now_s + draw.between(60.0, 900.0);
    }
    if (now_s >= fan_until_s) {
      fan = draw.once_in(2) ? 1.0 : std::round(draw.between(0.0, 1.0) * 255.0) / 255.0;
      fan_until_s = now_s + draw.between(5.0, 300.0);
    }
    if (now_s >= fault_s && !has_failed) {
      has_failed = true;
      real.fail(fault);
    }
    if (draw.once_in(100)) supply = draw.between(0.97, 1.03);
    const double air_C = told_air_C + drift_K * std::sin(now_s / drift_s), volt = plant.supply_V * supply;
    real.pass(static_cast<double>(duty), fan, air_C, volt, dt_s);
    const float measured_C = static_cast<float>(real.reading_C());
    const float heat_W =
        duty > 0.0f ? heater::heat_W<Constants>(duty, static_cast<float>(volt), watch.reading()) : 0.0f;
    const bool is_found = watch.step(heat_W, measured_C, static_cast<float>(told_air_C),
                                     static_cast<std::uint8_t>(fan * 255.0 + 0.5),
                                     static_cast<float>(dt_s)) != tp::LimitReason::none;
    if (is_found && found.monitor_s < 0.0) found.suspects = watch.suspects();
    const double after_s = now_s - fault_s;
    note(found.monitor_s, found.is_early, is_found, after_s);
    const float goal_C = static_cast<float>(target_C), step_s = static_cast<float>(dt_s);
    note(found.usual_s[0], found.is_usual_early[0], !runaway.step(goal_C, measured_C, step_s), after_s);
    note(found.usual_s[1], found.is_usual_early[1], !sum.step(goal_C, measured_C, step_s), after_s);
    note(found.usual_s[2], found.is_usual_early[2], !rate.step(goal_C, measured_C, step_s), after_s);
    if (found.monitor_s >= 0.0 && after_s < found.monitor_s + 60.0) found.likeliest = watch.likeliest();
    const bool is_cut = is_cutting && found.monitor_s >= 0.0;
    duty = target_C > 0.0 && !is_cut ? pid.step(goal_C, measured_C, step_s) : 0.0f;
  }
  // A guard may believe again what the monitor does not.
  if (watch.suspects() != 0) found.suspects = watch.suspects();
  return found;
}
inline Found run_hotend(std::uint32_t seed, double run_s, printer::Fault fault = printer::Fault::none,
                        double fault_s = 1e9, bool is_cutting = false) {
  return run_heater<heater::Hotend>(printer::hotend(), heater::Pid::Config::hotend(),
                                    heater::RunawayCheck(heater::RunawayCheck::Config::hotend()),
                                    heater::KelvinSumCheck(heater::KelvinSumCheck::Config::hotend()),
                                    heater::RateCheck(heater::RateCheck::Config::hotend()), 250.0, seed,
                                    run_s, fault, fault_s, is_cutting);
}
inline Found run_bed(std::uint32_t seed, double run_s, printer::Fault fault = printer::Fault::none,
                     double fault_s = 1e9, bool is_cutting = false) {
  return run_heater<heater::Bed>(
      printer::bed(), heater::Pid::Config::bed(), heater::RunawayCheck(heater::RunawayCheck::Config::bed()),
      heater::KelvinSumCheck(heater::KelvinSumCheck::Config::bed()),
      heater::RateCheck(heater::RateCheck::Config::bed()), 100.0, seed, run_s, fault, fault_s, is_cutting);
}

/// A motor with a thermometer on its housing, known current and voltage, and a speed.
struct MotorConstants {
  static constexpr double winding_J_per_K() { return 20.0; }
  static constexpr double body_J_per_K() { return 150.0; }
  static constexpr double coupling_W_per_K() { return 1.2; }
  static constexpr double loss_W_per_K() { return 0.45; }
  static constexpr double ohm() { return 2.0; }
  static constexpr tp::MonitorConfig monitor() { return {8.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return tp::HeatBalanceConfig::measured_body(60.0, winding_J_per_K(), body_J_per_K(), coupling_W_per_K(),
                                                loss_W_per_K(), 0.1, 0.1);
  }
  static constexpr tp::WindingBalanceConfig winding_balance() {
    return {14.0, ohm(), 0.05, 0.00393, 25.0, 25.0, 0.05, 0.05};
  }
  static constexpr tp::MotionBalanceConfig motion_balance() {
    return {5.0, 300.0, 5.0, 0.05, 0.05, 5e-5, 0.05, 0.006, 2e-5, 0.3, 0.01, 0.002};
  }
};

enum class MotorFault {
  none,
  loss_small,
  thermometer_loose,
  thermometer_stuck,
  winding_shorted,
  friction_grown
};
inline const char* name(MotorFault fault) {
  static const char* const names[] = {"none",
                                      "cooling gone by 60 %",
                                      "thermometer loose",
                                      "thermometer stuck",
                                      "winding shorted by 25 %",
                                      "friction grown fourfold"};
  return names[static_cast<int>(fault)];
}
/// The causes that are right; the others of the set are its class.
inline std::uint8_t truth(MotorFault fault) {
  switch (fault) {
    case MotorFault::none:
      return 0;
    case MotorFault::loss_small:
      return static_cast<std::uint8_t>(tp::Suspect::loss);
    case MotorFault::thermometer_loose:
    case MotorFault::thermometer_stuck:
      return static_cast<std::uint8_t>(tp::Suspect::thermometer);
    case MotorFault::winding_shorted:
      return static_cast<std::uint8_t>(tp::Suspect::winding);
    case MotorFault::friction_grown:
      return static_cast<std::uint8_t>(tp::Suspect::friction);
  }
  return 0;
}
inline std::uint8_t truth(printer::Fault fault) {
  switch (fault) {
    case printer::Fault::none:
      return 0;
    case printer::Fault::thermistor_loose:
    case printer::Fault::thermistor_stuck:
      return static_cast<std::uint8_t>(tp::Suspect::thermometer);
    case printer::Fault::heater_weak:
    case printer::Fault::heater_stays_on:
      return static_cast<std::uint8_t>(tp::Suspect::heater);
    case printer::Fault::fan_lost:
      return static_cast<std::uint8_t>(tp::Suspect::fan);
    case printer::Fault::room_warmer:
      return static_cast<std::uint8_t>(tp::Suspect::air);
  }
  return 0;
}

/// An hour of a motor: held against loads, and moved to and fro. The usual checks are those of drives: the housing's trip at
/// 90 degC, the current's square over time, and the rate of change of a reading.
inline Found run_motor(std::uint32_t seed, double run_s, MotorFault fault = MotorFault::none,
                       double fault_s = 1e9, bool is_cutting = false) {
  typedef MotorConstants Constants;
  Draw draw(seed);
  const double heat = draw.within(0.05);  // of the resistance, which voltage and heat share
  const double winding_J_per_K = Constants::winding_J_per_K() * draw.within(0.1),
               body_J_per_K = Constants::body_J_per_K() * draw.within(0.1),
               coupling_W_per_K = Constants::coupling_W_per_K() * draw.within(0.1),
               inertia = 5e-5 * draw.within(0.05), dry_Nm = 0.006 * draw.within(0.3),
               damping = 2e-5 * draw.within(0.3), torque_constant = 0.05 * draw.within(0.05),
               told_air_C = draw.between(10.0, 35.0), air_K = draw.between(-1.0, 1.0), dt_s = 0.05;
  double loss_W_per_K = Constants::loss_W_per_K() * draw.within(0.1);
  std::normal_distribution<double> gauss;
  double winding_C = told_air_C, body_C = told_air_C, sensor_C = told_air_C, model_winding_C = told_air_C;
  double hold_A = 0.0, wanted_rate = 0.0, rate = 0.0, load_Nm = 0.0, until_s = 0.0, square_A2s = 0.0,
         last_C = told_air_C, last_s = 0.0, reading_C = told_air_C;
  bool is_holding = true;
  tp::ModelMonitor<Constants> monitor;
  Found found;
  for (double now_s = 0.0; now_s < run_s; now_s += dt_s) {
    const bool is_bad = now_s >= fault_s;
    if (now_s >= until_s) {
      is_holding = draw.once_in(2);
      hold_A = draw.between(-3.5, 3.5);
      wanted_rate = draw.between(-280.0, 280.0);
      load_Nm = draw.between(-0.01, 0.01);
      until_s = now_s + draw.between(10.0, 180.0);
    }
    const bool is_cut = is_cutting && found.monitor_s >= 0.0;
    if (is_cut) is_holding = true;
    const double acceleration =
        is_holding ? 0.0 : std::max(-20.0, std::min(20.0, (wanted_rate - rate) / 0.5));
    rate = is_holding ? 0.0 : rate + acceleration * dt_s;
    const double friction_Nm = (is_bad && fault == MotorFault::friction_grown ? 4.0 : 1.0) *
                               ((rate > 0.0 ? dry_Nm : (rate < 0.0 ? -dry_Nm : 0.0)) + damping * rate);
    const double current_A = is_cut ? 0.0
                             : is_holding
                                 ? hold_A
                                 : (inertia * acceleration + friction_Nm + load_Nm) / torque_constant;
    const double strength = is_bad && fault == MotorFault::winding_shorted ? 0.75 : 1.0;
    const double ohm = strength * Constants::ohm() * heat * (1.0 + 0.00393 * (winding_C - 25.0));
    const double heat_W = current_A * current_A * ohm;
    const double loss = loss_W_per_K * (is_bad && fault == MotorFault::loss_small ? 0.4 : 1.0);
    const double across_W = coupling_W_per_K * (winding_C - body_C);
    winding_C += dt_s * (heat_W - across_W) / winding_J_per_K;
    body_C += dt_s * (across_W - loss * (body_C - told_air_C - air_K)) / body_J_per_K;
    const bool is_loose = is_bad && fault == MotorFault::thermometer_loose;
    const double seen_C = is_loose ? 0.5 * (body_C + told_air_C) : body_C;
    sensor_C += dt_s * (seen_C - sensor_C) / (is_loose ? 20.0 : 0.5);
    if (!(is_bad && fault == MotorFault::thermometer_stuck))
      reading_C = std::round((sensor_C + 0.1 * gauss(draw.random())) / 0.05) * 0.05;

    // What the firmware knows: the nominal motor's heat, and its winding above the measured housing.
    const double told_W =
        current_A * current_A * Constants::ohm() * (1.0 + 0.00393 * (model_winding_C - 25.0));
    model_winding_C += dt_s * (told_W - Constants::coupling_W_per_K() * (model_winding_C - reading_C)) /
                       Constants::winding_J_per_K();
    const tp::Disagreement disagreement = monitor.step(
        tp::MonitorInputs::motor(
            static_cast<float>(told_W), static_cast<float>(reading_C), static_cast<float>(told_air_C),
            static_cast<float>(current_A * ohm + 0.1 * gauss(draw.random())), static_cast<float>(current_A),
            static_cast<float>(model_winding_C), static_cast<float>(rate)),
        static_cast<float>(dt_s));
    const double after_s = now_s - fault_s;
    note(found.monitor_s, found.is_early, disagreement != tp::Disagreement::none, after_s);
    note(found.usual_s[0], found.is_usual_early[0], reading_C > 90.0, after_s);
    square_A2s = std::max(0.0, square_A2s + dt_s * (current_A * current_A - 3.0 * 3.0));
    note(found.usual_s[1], found.is_usual_early[1], square_A2s > 3.0 * 3.0 * 120.0, after_s);
    if (now_s - last_s >= 1.0) {
      note(found.usual_s[2], found.is_usual_early[2], std::fabs(reading_C - last_C) > 3.0, after_s);
      last_C = reading_C;
      last_s = now_s;
    }
  }
  found.suspects = monitor.suspects();
  return found;
}

}  // namespace campaign
