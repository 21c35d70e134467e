// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "fixed_gain.hpp"
#include "fixed_power_law.hpp"
#include "fixed_safety_limiter.hpp"

/// @file fixed_axis_controller.hpp
/// One axis in whole numbers: AxisController for chips without a floating-point unit.

namespace thermopower {

/// Temperature estimate, power law, limiter and gain of one axis, in the order of AxisController, which says what each does. Constants are
/// types, so the object is its state: ten to fourteen bytes.
///
/// @tparam Thermal   FixedThermalModel of a motor, or a model with `start`, `prepare`, `step`, `state`
/// @tparam PowerLaw  how much power an error is worth: fixed_power_law.hpp
/// @tparam Limiter   how the temperature is kept below its limit: fixed_safety_limiter.hpp
/// @tparam Gain      how the P gain follows the power: fixed_gain.hpp
/// @ingroup control
template <class Thermal, class PowerLaw = FixedLevels<>, class Limiter = FixedSafetyLimiter<>, class Gain = FixedNoGain>
class FixedAxisController {
 public:
  /// What the axis decides on.
  struct Inputs {
    uint16_t error_units;  ///< Magnitude of the folded error in units of 360/16384 degree, 0 .. 8192.
    FixedCelsius air;      ///< Air temperature, -60 .. 125 degC.
    LimitReason fault;     ///< A fault found by the caller, or `LimitReason::none`.
  };

  /// What one logs.
  struct State {
    FixedRate rate;      ///< dT/dt at the start of the last step.
    uint8_t power;       ///< Power granted: send this as POWER.
    LimitReason reason;  ///< Why `power` is below the demand.
  };

  /// Sets the temperature, at the beginning or when something better than the estimate is known. @param motor  saturates at -50 and 180
  /// degC
  void start(FixedTemperature motor) noexcept { thermal_.start(motor); }

  /// One control cycle; `prepare()` must have been called since the last one. @param ticks  time since then
  const State& step(const Inputs& inputs, FixedTicks ticks) noexcept {
    state_.rate = thermal_.step(inputs.air, ticks);
    const uint8_t demand = power_law_.step(inputs.error_units);
    const LimitedPower granted = is_fault(inputs.fault)
                                     ? limiter_.cut(inputs.fault, demand)
                                     : limiter_.step(demand, thermal_.state().motor, state_.rate, ticks);
    state_.power = granted.power;
    state_.reason = granted.reason;
    return state_;
  }

  /// A cycle before anything is known about the temperature: the power is the least. @param fault  why
  const State& hold(LimitReason fault) noexcept {
    const LimitedPower least = limiter_.cut(fault);
    state_.power = least.power;
    state_.reason = least.reason;
    return state_;
  }

  /// Computes the heating by the power granted last. Call it when the command is on its way: nobody waits for it there.
  void prepare() noexcept { thermal_.prepare(state_.power); }

  /// Send this as P.
  uint8_t p_gain() const noexcept { return Gain::gain(state_.power); }

  const State& state() const noexcept { return state_; }        ///< After the last step.
  const Thermal& thermal() const noexcept { return thermal_; }  ///< The temperature.
  uint8_t ceiling() const noexcept { return limiter_.ceiling(); }  ///< Highest power granted now.

 private:
  Thermal thermal_;
  PowerLaw power_law_;
  Limiter limiter_;
  State state_ = {0, least_power(), LimitReason::no_telemetry_yet};
};

}  // namespace thermopower
