// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/servo_loop.hpp>

#include <algorithm>
#include <cmath>
#include <variant>

/// @file heater_loop.hpp
/// The loop that drives a body's heater: from a target and a reading of the thermometer to a duty, sampled.

namespace thermopower::plant {

/// Sum of gains at which a printer's heater is on all the time: their configurations count the duty in 255 parts.
inline constexpr double full_heater_power = 255.0;

/// @brief The loop of a heater under way: reads the thermometer once a period, and holds its duty until the next time.
///
/// With an automatic-differentiation scalar the duty of a PID carries its derivative. That of a two-point loop only jumps:
/// sample() returns how far the instant of the jump moves with the reading, for a correction of what was heated since.
///
/// @snippet plant_examples.cpp heater loop
/// How to: @ref printer_heater.
template <class Scalar>
class HeaterLoop {
public:
  /// @param law  not std::monostate
  explicit HeaterLoop(const HeaterLaw& law) : law_(law) {}

  /// Time between samples, s.
  double period_s() const {
    return std::visit([](const auto& law) { return period_of(law); }, law_);
  }

  /// Whether its duty jumps.
  bool jumps() const { return std::holds_alternative<BangBangHeater>(law_); }

  /// Sets out at a reading, as if the loop had held it for long.
  /// @param held_duty  the duty that holds it: what a PID has integrated
  /// @param now_s      since the start of the run, at which the first sample is due
  void start(const Scalar& read_C, double target_C, double held_duty, double now_s = 0.0) {
    next_ = first_sample(now_s, period_s());
    before_C_ = read_C;
    slope_K_per_s_ = constant<Scalar>(0.0);
    const double held = target_C > 0.0 ? full_heater_power * std::clamp(held_duty, 0.0, 1.0) : 0.0;
    const auto* klipper = std::get_if<KlipperPidHeater>(&law_);
    const auto* marlin = std::get_if<MarlinPidHeater>(&law_);
    const double ki = klipper != nullptr ? klipper->ki_per_K_s : marlin != nullptr ? marlin->ki_per_K_s : 0.0;
    integral_Ks_ = constant<Scalar>(ki > 0.0 ? held / ki : 0.0);
    heats_ = value_of(read_C) < target_C;
    duty_ = constant<Scalar>(held / full_heater_power);
  }

  /// Takes a reading and sets the duty until the next one. A target of 0 or less is off.
  /// @return in s: how much later the duty would have jumped, by the derivatives of the reading; of value 0
  Scalar sample(const Scalar& read_C, double target_C) {
    moved_s_ = constant<Scalar>(0.0);
    std::visit([&](const auto& law) { answer(law, read_C, target_C); }, law_);
    if (!(target_C > 0.0)) duty_ = constant<Scalar>(0.0);
    before_C_ = read_C;
    return moved_s_;
  }

  /// Takes the sample that is due at an instant of the run. @param take  reads and samples: `take(now_s)`
  template <class Take>
  void arrive(double now_s, Take&& take) {
    if (samples_until(now_s, period_s()) <= next_) return;
    ++next_;
    take(now_s);
  }

  /// Goes through an interval of the run, the samples at its end left out.
  /// @param take     reads and samples: `take(now_s)`
  /// @param advance  moves the body under duty(): `advance(now_s, length_s)`
  template <class Take, class Advance>
  void interval(double from_s, double to_s, Take&& take, Advance&& advance) {
    for (const long end = first_sample(to_s, period_s()); next_ < end;) {
      const double at_s = static_cast<double>(next_++) * period_s();
      if (at_s > from_s) advance(from_s, at_s - from_s);
      from_s = std::max(from_s, at_s);
      take(from_s);
    }
    if (to_s > from_s) advance(from_s, to_s - from_s);
  }

  /// The duty in force, 0..1.
  const Scalar& duty() const { return duty_; }

private:
  static double period_of(const std::monostate&) { return 1.0; }
  template <class Law>
  static double period_of(const Law& law) {
    return law.period_s;
  }

  void answer(const std::monostate&, const Scalar&, double) {}

  /// Klipper's: the slope is smoothed over a time; the integral stands still while the sum is out of the limits.
  void answer(const KlipperPidHeater& pid, const Scalar& read_C, double target_C) {
    const Scalar error_K = target_C - read_C;
    const double smooth_s = std::max(pid.smooth_time_s, pid.period_s);
    slope_K_per_s_ = (slope_K_per_s_ * (smooth_s - pid.period_s) + (read_C - before_C_)) / smooth_s;
    const Scalar integral_Ks = integrated(pid, error_K);
    const Scalar sum =
        pid.kp_per_K * error_K + pid.ki_per_K_s * integral_Ks - pid.kd_s_per_K * slope_K_per_s_;
    duty_ = limited(sum, pid.max_power);
    const bool is_limited = value_of(sum) < 0.0 || value_of(sum) > full_heater_power * pid.max_power;
    if (!is_limited) integral_Ks_ = integral_Ks;
  }

  /// Marlin's: far below the target all power and far above it none; in the range between a PID that begins anew each time, its
  /// slope a moving average.
  void answer(const MarlinPidHeater& pid, const Scalar& read_C, double target_C) {
    const Scalar error_K = target_C - read_C;
    if (std::abs(value_of(error_K)) > pid.functional_range_K) {
      duty_ = constant<Scalar>(value_of(error_K) > 0.0 ? pid.max_power : 0.0);
      integral_Ks_ = slope_K_per_s_ = constant<Scalar>(0.0);
      return;
    }
    constexpr double newest = 0.05;  // share of the newest slope in the average: Marlin's 1 - PID_K1
    slope_K_per_s_ += newest * ((read_C - before_C_) / pid.period_s - slope_K_per_s_);
    integral_Ks_ = integrated(pid, error_K);
    duty_ = limited(pid.kp_per_K * error_K + pid.ki_per_K_s * integral_Ks_ - pid.kd_s_per_K * slope_K_per_s_,
                    pid.max_power);
  }

  /// Two points: on below the band around the target, off above it.
  void answer(const BangBangHeater& two, const Scalar& read_C, double target_C) {
    const double from_target_K = value_of(read_C) - target_C;
    const bool switches = heats_ ? from_target_K >= two.max_delta_K : from_target_K <= -two.max_delta_K;
    if (switches) {
      heats_ = !heats_;
      const double K_per_s = (value_of(read_C) - value_of(before_C_)) / two.period_s;
      constexpr double still_K_per_s = 1e-3;  // so slow a reading says nothing of when it crossed
      if (std::abs(K_per_s) > still_K_per_s) moved_s_ = (value_of(read_C) - read_C) / K_per_s;
    }
    duty_ = constant<Scalar>(heats_ ? two.max_power : 0.0);
  }

  /// The integral with one more error: never negative, nor more than all power asks for.
  template <class Pid>
  Scalar integrated(const Pid& pid, const Scalar& error_K) const {
    const double most_Ks = pid.ki_per_K_s > 0.0 ? full_heater_power * pid.max_power / pid.ki_per_K_s : 0.0;
    const Scalar sum_Ks = integral_Ks_ + error_K * pid.period_s;
    if (value_of(sum_Ks) <= 0.0) return constant<Scalar>(0.0);
    return value_of(sum_Ks) >= most_Ks ? constant<Scalar>(most_Ks) : sum_Ks;
  }

  static Scalar limited(const Scalar& sum, double max_power) {
    if (value_of(sum) <= 0.0) return constant<Scalar>(0.0);
    if (value_of(sum) >= full_heater_power * max_power) return constant<Scalar>(max_power);
    return sum / full_heater_power;
  }

  HeaterLaw law_;
  Scalar before_C_ = constant<Scalar>(0.0), slope_K_per_s_ = constant<Scalar>(0.0),
         integral_Ks_ = constant<Scalar>(0.0), duty_ = constant<Scalar>(0.0),
         moved_s_ = constant<Scalar>(0.0);
  bool heats_ = false;
  long next_ = 0;  ///< number of the next sample since the start of the run
};

/// The duty that holds a body at a temperature by a model's constants, 0..1; 0 where its laws are not those of a resistance and a
/// lump. It tells a loop's memory where a run begins under way.
inline double holding_duty(const Model& model, double supply_V, double body_C, double air_C) {
  const auto* winding = std::get_if<OhmicCurrentModel>(&model.current);
  const auto* body = std::get_if<LumpedThermalModel>(&model.thermal);
  if (winding == nullptr || body == nullptr) return 0.0;
  const OhmicCurrent<double> law{winding->resistance_ohm, winding->tempco_per_K, winding->reference_C};
  const double full_W = supply_V * supply_V / law.resistance_at(body_C);
  const double duty = body->conductance_W_per_K * (body_C - air_C) / full_W;
  return std::isfinite(duty) ? std::clamp(duty, 0.0, 1.0) : 0.0;
}

}  // namespace thermopower::plant
