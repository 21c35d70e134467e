// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../fixed_point/coarse_air.hpp"
#include "detail/composition.hpp"
#include "gain_scheduler.hpp"
#include "step_power_law.hpp"
#include "safety_limiter.hpp"

/// @file control/fixed_point/axis_controller.hpp
/// One axis in whole numbers: thermopower::AxisController for chips without a floating-point unit.

namespace thermopower {
namespace fixed_point {

/// What an axis decides on.
/// @ingroup control
struct AxisInputs {
  uint16_t error_units;  ///< Magnitude of the folded error in units of 360/16384 degree, 0 .. 8192.
  CoarseAir air;         ///< Air temperature, -60 .. 125 degC; left out: the warmest.
  LimitReason fault;     ///< A fault found by the caller, or `LimitReason::none`.
};

namespace detail {

/// An axis but for its motor's constants and its gain: axes that differ in nothing else share its code.
template <class Core, class PowerLaw, class Limiter>
class SharedAxis {
public:
  // Numbers and not a struct: this compiler keeps them in registers.
  [[gnu::noinline]] void step(uint16_t error_units, CoarseTemperature air, LimitReason fault, Ticks ticks,
                              uint16_t cooling_factor) noexcept {
    const uint8_t demand = power_law.step(error_units);
    const Rate rate = thermal.step(air, ticks, cooling_factor);
    granted = is_fault(fault) ? limiter.cut(fault, demand)
                              : limiter.step(demand, GuardedTemperature::of(thermal), rate, ticks);
  }

  // As above: one copy for all axes.
  [[gnu::noinline]] void start(Temperature motor) noexcept { thermal.start(motor); }
  [[gnu::noinline]] void warm_by(CoarseTemperature difference) noexcept {
    thermal.warm_by(static_cast<Temperature>(difference) * 65536);
  }
  [[gnu::noinline]] void not_below(CoarseTemperature air) noexcept {
    const CoarseTemperature motor = static_cast<CoarseTemperature>(thermal.state().motor >> 16);
    if (motor < air) warm_by(static_cast<CoarseTemperature>(air - motor));
  }

  Core thermal;
  PowerLaw power_law;
  Limiter limiter;
  LimitedPower granted = {least_power(), LimitReason::no_telemetry_yet};
};

}  // namespace detail

/// Temperature estimate, power law, limiter and gain of one axis, in the order of thermopower::AxisController, which says
/// what each does. Constants are types, so the object is its state: twelve bytes with the thesis's policies.
///
/// @tparam Thermal   ThermalModel of a motor. A model of your own names its `Core`, which has `start()`,
///                   `step()`, `heat()` and `state()` as ThermalCore, and has `cooling_factor`, which it
///                   is stepped with, and a static `heating(power, motor)`
/// @tparam PowerLaw  how much power an error is worth: control/fixed_point/step_power_law.hpp
/// @tparam Limiter   how the temperature is kept below its limit: control/fixed_point/safety_limiter.hpp
/// @tparam Gain      how the P gain follows the power: control/fixed_point/gain_scheduler.hpp
///
/// @snippet fixed_point_examples.cpp fixed-point axis
/// How to: @ref first_axis, @ref target_cost. Menu: @ref policies.
/// @ingroup control
template <class Thermal, class PowerLaw = ProgrammedLevels<>, class Limiter = SafetyLimiter<>,
          class Gain = NoGain>
class AxisController {
  static_assert(
      detail::IsThermalModel<Thermal>::value,
      "thermopower: the first parameter of fixed_point::AxisController must be a fixed_point::ThermalModel of a motor");

  static_assert(
      detail::IsPowerLaw<PowerLaw>::value,
      "thermopower: the second parameter of fixed_point::AxisController must be a power law: a type with step(error_units)");

  static_assert(
      detail::IsLimiter<Limiter>::value,
      "thermopower: the third parameter of fixed_point::AxisController must be a limiter: a type with step(demand, motor, rate, ticks), cut and ceiling");

  static_assert(
      detail::IsGain<Gain>::value,
      "thermopower: the fourth parameter of fixed_point::AxisController must be a gain: a type with static gain(power), such as fixed_point::RoundedGain<24, 4>");

public:
  typedef AxisInputs Inputs;   ///< What the axis decides on.
  typedef LimitedPower State;  ///< The power granted, to be sent as POWER, and why it is below the demand.

  /// Sets the temperature, at the beginning or when something better than the estimate is known. Until then
  /// the motor is as cold as can be and every step needs a fault. @param motor  saturates at -50 and 180 degC
  void start(Temperature motor) noexcept { axis_.start(motor); }

  /// Says that a power larger than any that can be told in time may have acted since the last step: the next
  /// one heats by the most there is. Call it before `step()`.
  void heated_most() noexcept { axis_.thermal.heat(detail::most_heating()); }
  /// Says that the actuator is warmer than was thought. @param difference  above 0
  void warm_by(CoarseTemperature difference) noexcept { axis_.warm_by(difference); }
  /// Says that the actuator is not colder than this.
  void not_below(CoarseTemperature air) noexcept { axis_.not_below(air); }
  /// The temperature, rounded up.
  CoarseTemperature upper() const noexcept {
    return static_cast<CoarseTemperature>((axis_.thermal.state().motor >> 16) + 1);
  }

  /// One control cycle; `prepare()` must have been called since the last one. @param ticks  time since then
  const State& step(const Inputs& inputs, Ticks ticks) noexcept {
    axis_.step(inputs.error_units, inputs.air, inputs.fault, ticks, Thermal::cooling_factor);
    return axis_.granted;
  }

  /// Computes the heating by the power granted last. Call it when the command is on its way: nobody waits for
  /// it there.
  void prepare() noexcept { prepare(axis_.granted.power); }
  /// The same for another power that may be in force. @param power  the largest that may be
  [[gnu::noinline]] void prepare(uint8_t power) noexcept {
    axis_.thermal.heat(Thermal::heating(power, axis_.thermal.state().motor));
  }

  /// Send this as P.
  uint8_t p_gain() const noexcept { return Gain::gain(axis_.granted.power); }
  /// The supply that the motor's table was made for, V; 600 where its model does not say.
  static constexpr double supply_V() { return detail::supply_of<Thermal>(0); }
  /// P at the least power.
  static constexpr uint8_t first_gain() { return Gain::gain(least_power()); }

  const State& state() const noexcept { return axis_.granted; }                     ///< After the last step.
  const typename Thermal::Core& thermal() const noexcept { return axis_.thermal; }  ///< The temperature.
  uint8_t ceiling() const noexcept { return axis_.limiter.ceiling(); }  ///< Highest power granted now.

private:
  detail::SharedAxis<typename Thermal::Core, PowerLaw, Limiter> axis_;
};

}  // namespace fixed_point
}  // namespace thermopower
