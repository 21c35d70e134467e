// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "air_temperature.hpp"
#include "axis_controller.hpp"
#include "../gimbal_controller.hpp"
#include "../position_error.hpp"

/// @file control/fixed_point/gimbal_controller.hpp
/// One `AxisController` per axis, fed by one telemetry message: thermopower::GimbalController without a
/// floating-point library.

namespace thermopower {
namespace fixed_point {

/// The constants of GimbalConfig::standard() that a fixed-point gimbal has; the supply is the motors'. A set
/// of your own has the same.
/// @ingroup control
struct StandardGimbal {
  typedef StandardAir Air;  ///< When a thermometer is believed.
  /// Below this the battery counts as empty or missing. 0 .. 600.
  static constexpr double minimum_supply_V() { return 3.0; }
  /// Silence of the link that is tolerated, 0.01 .. 16 s.
  static constexpr double timeout_s() { return 0.5; }
};

namespace detail {

/// The axes one after the other.
template <uint8_t index, class... Axes>
struct AxisChain {
  template <class Visitor>
  void visit(Visitor&) noexcept {}
};

template <uint8_t index, class First, class... Rest>
struct AxisChain<index, First, Rest...> : AxisChain<index + 1, Rest...> {
  static_assert(
      IsAxis<First>::value,
      "thermopower: every parameter of fixed_point::GimbalController must be a fixed_point::AxisController");
  typedef AxisChain<index + 1, Rest...> Next;
  template <class Visitor>
  void visit(Visitor& visitor) noexcept {
    visitor(index, axis);
    Next::visit(visitor);
  }
  First axis;
};

template <uint8_t index, class First, class... Rest>
const First& axis_at(const AxisChain<index, First, Rest...>& chain) noexcept {
  return chain.axis;
}

}  // namespace detail

/// The controller of a whole gimbal in whole numbers. It decides as thermopower::GimbalController does with the same
/// policies, and obeys the same rules for a link, a sensor and a battery that fail.
///
///     const auto& command = gimbal.step(*telemetry, clock.elapsed(now_us));
///     codec.send(power_and_gain(command), wire);
///     gimbal.prepare();                                      // while the command is on its way
///
/// @tparam Constants  StandardGimbal, or your own
/// @tparam Axes       one AxisController per axis
/// @ingroup control
template <class Constants, class... Axes>
class BasicGimbalController {
  static_assert(
      detail::IsGimbalConstants<Constants>::value,
      "thermopower: the first parameter of fixed_point::BasicGimbalController must be its constants, such as fixed_point::StandardGimbal; take fixed_point::GimbalController for these");

  static_assert(sizeof...(Axes) >= 1 && sizeof...(Axes) < 255,
                "thermopower: a GimbalController needs at least one AxisController");
  static_assert(Constants::minimum_supply_V() >= 0.0 && Constants::minimum_supply_V() <= 600.0,
                "thermopower: minimum_supply_V must be within 0 .. 600 V");
  static_assert(Constants::timeout_s() >= 0.01 && Constants::timeout_s() <= 16.0,
                "thermopower: timeout_s must be within 0.01 .. 16 s for a fixed-point gimbal");

public:
  /// Number of axes.
  static constexpr uint8_t axis_count() { return static_cast<uint8_t>(sizeof...(Axes)); }
  typedef GimbalCommand<sizeof...(Axes)> Command;  ///< What goes back to the board.

  /// Every axis at the least power. A constant: the object is ready before any constructor runs.
  constexpr BasicGimbalController() noexcept
      : command_{{first_power<Axes>()...}, {Axes::first_gain()...}, {first_reason<Axes>()...}},
        error_units_{} {}

  /// One control cycle from a telemetry message.
  /// @param telemetry  offers `target_angle(axis)`, `imu_angle(axis)` in units of 360/16384 degree, `imu_C()`,
  ///                   `frame_imu_C()` and `battery_cV()`, as `sbgc::RealtimeData` does
  /// @param ticks      time since the last step or silent cycle
  template <class Telemetry>
  const Command& step(const Telemetry& telemetry, Ticks ticks) noexcept {
    constexpr uint16_t minimum_cV =
        static_cast<uint16_t>(detail::nearest(Constants::minimum_supply_V() * 100.0));
    for (uint8_t index = 0; index < axis_count(); ++index) {
      const int16_t error = position_error_units(telemetry.target_angle(index), telemetry.imu_angle(index));
      error_units_[index] = static_cast<uint16_t>(error < 0 ? -error : error);
    }
    const bool has_air = air_.step(telemetry.imu_C(), telemetry.frame_imu_C()).source != AirSource::neither;
    telemetry_fault_ = telemetry.battery_cV() < minimum_cV
                           ? LimitReason::supply_low
                           : (has_air ? LimitReason::none : LimitReason::air_implausible);
    silent_ = 0;
    has_telemetry_ = true;
    return decide(telemetry_fault_, ticks);
  }

  /// One cycle in which no telemetry came: what the last one asked for, or its fault, holds until
  /// `timeout_s()`, then the power is the least. @param ticks  time since the last step or silent cycle
  const Command& step_silent(Ticks ticks) noexcept {
    constexpr uint16_t tolerated =
        static_cast<uint16_t>(detail::nearest(Constants::timeout_s() * detail::ticks_per_s()));
    silent_ = ticks > static_cast<uint16_t>(0xFFFFu - silent_) ? static_cast<uint16_t>(0xFFFFu)
                                                               : static_cast<uint16_t>(silent_ + ticks);
    if (!has_telemetry_) return decide(LimitReason::no_telemetry_yet, ticks);
    return decide(silent_ <= tolerated ? telemetry_fault_ : LimitReason::link_silent, ticks);
  }

  /// Computes the heating by the last command. Call it after every step, when the command is on its way.
  void prepare() noexcept {
    PrepareVisitor visitor;
    axes_.visit(visitor);
  }

  const Command& command() const noexcept { return command_; }  ///< The last command.
  /// The air and where it was read.
  const typename AirTemperature<typename Constants::Air>::State& air() const noexcept { return air_.state(); }
  /// The controller of one axis, to log it.
  template <uint8_t index>
  auto axis() const noexcept
      -> decltype(detail::axis_at<index>(*static_cast<const detail::AxisChain<0, Axes...>*>(nullptr))) {
    return detail::axis_at<index>(axes_);
  }

private:
  struct StepVisitor {
    BasicGimbalController& gimbal;
    LimitReason fault;
    Ticks ticks;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      const AxisInputs inputs = {gimbal.error_units_[index], gimbal.air_.state().air, fault};
      const typename Axis::State& decided = controller.step(inputs, ticks);
      gimbal.command_.power[index] = decided.power;
      gimbal.command_.reason[index] = decided.reason;
      gimbal.command_.p_gain[index] = controller.p_gain();
    }
  };
  struct StartVisitor {
    Temperature motor;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.start(motor);
    }
  };
  struct PrepareVisitor {
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.prepare();
    }
  };

  template <class Axis>
  static constexpr uint8_t first_power() {
    return least_power();
  }
  template <class Axis>
  static constexpr LimitReason first_reason() {
    return LimitReason::no_telemetry_yet;
  }

  const Command& decide(LimitReason fault, Ticks ticks) noexcept {
    // Before the first plausible air there is no temperature to limit by; the fault says so.
    if (!has_air_ && air_.state().source != AirSource::neither) {
      // The thesis's assumption, section 4.2: a motor that was just switched on is as warm as the air.
      StartVisitor start = {static_cast<Temperature>(air_.state().air) * 65536};
      axes_.visit(start);
      has_air_ = true;
    }
    StepVisitor visitor = {*this, fault, ticks};
    axes_.visit(visitor);
    return command_;
  }

  AirTemperature<typename Constants::Air> air_;
  detail::AxisChain<0, Axes...> axes_;
  Command command_;
  uint16_t error_units_[sizeof...(Axes)];
  uint16_t silent_ = 0;
  LimitReason telemetry_fault_ = LimitReason::none;
  bool has_telemetry_ = false;
  bool has_air_ = false;
};

/// The controller of a gimbal with the standard rules for its sensors.
/// @ingroup control
template <class... Axes>
using GimbalController = BasicGimbalController<StandardGimbal, Axes...>;

}  // namespace fixed_point
}  // namespace thermopower
