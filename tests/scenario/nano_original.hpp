// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>
#include <stdint.h>

#include <thermopower/sbgc/realtime_fields.hpp>

/// What the thesis's program decides, worked out from the formulas in its Appendix 1 and written
/// independently of the library: no header of actuator/, control/ or motors/ is used here. It also compiles
/// for the original's chip, where its `double` is a float and its pow is avr-libc's: the results there are
/// the original's to the bit, as far as formulas can tell. Line numbers are the program's.
namespace original {

struct Decision {
  bool is_sent = false;  ///< The program sends nothing while the battery reads 3 V or less.
  uint8_t power[3] = {0, 0, 0};
  uint8_t p_gain[3] = {0, 0, 0};
};

/// Which branch the limiter took (lines 202 to 208), to see that a scenario went everywhere.
enum class Limit { rises, falls, cut };

/// @tparam Real       float, which is what `double` is on the original's chip, or double
/// @tparam wraps_time whether micros() is kept in 16 bits, as the program does
template <class Real, bool wraps_time = true>
class Program {
public:
  Decision update(const thermopower::sbgc::RealtimeFields& telemetry, uint32_t micros) {
    const Real supply_V = telemetry.battery_cV > 300 ? Real(13) : Real(0);
    air_C_ = Real(telemetry.imu_C + telemetry.frame_imu_C) / Real(2);
    if (!is_started_) {
      for (Axis& axis : axes_) axis.motor_C = air_C_;
      last_micros_ = 0;
      is_started_ = true;
    }
    const uint32_t elapsed = micros - last_micros_;
    const Real elapsed_s = Real(wraps_time ? static_cast<uint16_t>(elapsed) : elapsed) / Real(1000000);
    last_micros_ = micros;
    for (int index = 0; index < 3; ++index) warm(axes_[index], constants(index), supply_V, elapsed_s);

    Decision decision;
    if (!(supply_V > 0)) return decision;
    decision.is_sent = true;
    for (int index = 0; index < 3; ++index) {
      Axis& axis = axes_[index];
      axis.error_deg =
          (Real(telemetry.target_angle[index]) - Real(telemetry.imu_angle[index])) / Real(45.5111);
      limit(axis);
      decision.power[index] = axis.power;
      const Constants& motor = constants(index);
      decision.p_gain[index] = static_cast<uint8_t>(motor.gain_low - Real(axis.power) / Real(255) *
                                                                         (motor.gain_low - motor.gain_high));
    }
    return decision;
  }

  Real motor_C(int axis) const { return axes_[axis].motor_C; }
  Limit limit_taken(int axis) const { return axes_[axis].taken; }
  int level(int axis) const { return axes_[axis].level; }
  Real error_deg(int axis) const { return axes_[axis].error_deg; }
  int ceiling(int axis) const { return axes_[axis].ceiling; }

private:
  struct Constants {
    Real cooling_per_min;                   // line 30
    Real slope_V2, slope_V1, slope_V0;      // 32 to 34, mA/K
    Real base, exponent;                    // 35, 36, mA
    Real rise_sV, rise_s, rise_oV, rise_o;  // 38 to 41
    Real gain_low, gain_high;               // 44, 45
  };
  struct Axis {
    Real motor_C = 0;
    Real rate_K_per_s = 0;
    Real error_deg = 0;
    uint8_t power = 150;    // line 124
    uint8_t ceiling = 255;  // line 122
    Limit taken = Limit::rises;
    int level = 1;
  };

  static const Constants& constants(int index) {
    static const Constants small = {Real(0.110),  Real(-0.0134), Real(0.0156),  Real(0.0167),
                                    Real(0.1551), Real(3.4591),  Real(-0.0002), Real(0.0062),
                                    Real(0.0255), Real(-0.105),  Real(24),      Real(4)};
    static const Constants pitch = {Real(0.110),  Real(-0.0134), Real(0.0156),  Real(0.0167),
                                    Real(0.1551), Real(3.4591),  Real(-0.0002), Real(0.0062),
                                    Real(0.0255), Real(-0.105),  Real(180),     Real(105)};
    static const Constants large = {Real(0.05),   Real(-0.055),  Real(0.6311), Real(-2.497),
                                    Real(0.1257), Real(3.4135),  Real(0),      Real(0.2435),
                                    Real(0),      Real(-0.4952), Real(40),     Real(2)};
    return index == 0 ? small : (index == 1 ? pitch : large);
  }

  static Real power(Real base, Real exponent) { return static_cast<Real>(pow(base, exponent)); }

  // Lines 147 to 152 and 227 to 263.
  void warm(Axis& axis, const Constants& motor, Real supply_V, Real elapsed_s) const {
    const Real volt = supply_V * power(Real(axis.power) / Real(255), Real(0.5));
    Real heating_per_min = 0;
    if (volt > 1) {
      const Real slope = motor.slope_V2 * power(volt, Real(2)) + motor.slope_V1 * volt + motor.slope_V0;
      const Real current_mA = axis.motor_C * slope + motor.base * power(volt, motor.exponent);
      const Real positive_mA = current_mA > 0 ? current_mA : Real(0);
      const Real rise = Real(1) / ((motor.rise_sV * volt + motor.rise_s) * axis.motor_C +
                                   (motor.rise_oV * volt + motor.rise_o));
      if (rise > 0) heating_per_min = rise * (positive_mA / Real(1000) * volt);
    }
    const Real cooling_per_min = motor.cooling_per_min * (axis.motor_C - air_C_);
    axis.rate_K_per_s = (heating_per_min - cooling_per_min) / Real(60);
    axis.motor_C = axis.motor_C + axis.rate_K_per_s * elapsed_s;
  }

  // Lines 188 to 210.
  static void limit(Axis& axis) {
    Real error = Real(fabs(axis.error_deg));
    while (error > 180) error = Real(fabs(error - Real(360)));
    axis.level = static_cast<int>(error * Real(10));
    axis.level = axis.level < 1 ? 1 : (axis.level > 10 ? 10 : axis.level);
    axis.power = static_cast<uint8_t>(25 * axis.level);
    const Real safety_C = Real(60) - Real(30) * axis.rate_K_per_s;
    if (axis.motor_C > 60) {
      axis.taken = Limit::cut;
      axis.ceiling = 1;
    } else if (axis.motor_C > safety_C) {
      axis.taken = Limit::falls;
      if (axis.ceiling > 1) --axis.ceiling;
    } else {
      axis.taken = Limit::rises;
      if (axis.ceiling < 255) ++axis.ceiling;
    }
    if (axis.power > axis.ceiling) axis.power = axis.ceiling;
  }

  Axis axes_[3];
  Real air_C_ = 0;
  uint32_t last_micros_ = 0;
  bool is_started_ = false;
};

}  // namespace original
