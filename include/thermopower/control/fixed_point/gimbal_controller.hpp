// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "air_temperature.hpp"
#include "axis_controller.hpp"
#include "../gimbal_controller.hpp"
#include "../position_error.hpp"
#include "../power_in_force.hpp"

/// @file control/fixed_point/gimbal_controller.hpp
/// One `AxisController` per axis, fed by one telemetry message: thermopower::GimbalController without a
/// floating-point library.

namespace thermopower {
namespace fixed_point {

/// The constants of GimbalConfig::standard() that a fixed-point gimbal has; the supply is the motors'. A set
/// of your own has the same.
///
/// @snippet fixed_point_examples.cpp fixed-point gimbal
/// How to: @ref wire_up_sbgc, @ref target_cost.
/// @ingroup control
struct StandardGimbal {
  typedef StandardAir Air;  ///< When a thermometer is believed.
  /// Below this the battery counts as empty or missing. 0 .. 600.
  static constexpr double minimum_supply_V() { return 3.0; }
  /// By how much of the supply that the motors' tables were made for a measurement may exceed it, 0 .. 0.4; above that it
  /// is another battery.
  static constexpr double supply_margin() { return 0.1; }
  /// Silence of the link that is tolerated, 0.01 .. 16 s.
  static constexpr double timeout_s() { return 0.5; }
};
/// The same with thermometers that are believed: GimbalConfig::believing().
///
/// @snippet fixed_point_examples.cpp fixed-point gimbal
/// How to: @ref wire_up_sbgc, @ref target_cost.
/// @ingroup control
struct BelievingGimbal : StandardGimbal {
  typedef BelievedAir Air;  ///< When a thermometer is believed.
};
/// The same for the thesis's program, which believes its thermometers, and a fall of the air at once.
///
/// @snippet fixed_point_examples.cpp fixed-point gimbal
/// How to: @ref wire_up_sbgc, @ref target_cost.
/// @ingroup control
struct ProgrammedGimbal : StandardGimbal {
  typedef ProgrammedAir Air;  ///< When a thermometer is believed.
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

/// The lowest supply that a motor's table was made for, V.
template <class Axis>
constexpr double least_supply_V() {
  return Axis::supply_V();
}
template <class First, class Second, class... Rest>
constexpr double least_supply_V() {
  return First::supply_V() < least_supply_V<Second, Rest...>() ? First::supply_V()
                                                               : least_supply_V<Second, Rest...>();
}

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
///
/// @snippet fixed_point_examples.cpp fixed-point gimbal
/// How to: @ref wire_up_sbgc, @ref target_cost.
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
  static_assert(Constants::supply_margin() >= 0.0 && Constants::supply_margin() <= 0.4,
                "thermopower: supply_margin must be within 0 .. 0.4");
  static_assert(Constants::timeout_s() >= 0.01 && Constants::timeout_s() <= 16.0,
                "thermopower: timeout_s must be within 0.01 .. 16 s for a fixed-point gimbal");

public:
  /// Number of axes.
  static constexpr uint8_t axis_count() { return static_cast<uint8_t>(sizeof...(Axes)); }
  typedef GimbalCommand<sizeof...(Axes)> Command;  ///< What goes back to the board.

  /// Every axis at the least power. A constant: the object is ready before any constructor runs.
  constexpr BasicGimbalController() noexcept
      : command_{{first_power<Axes>()...}, {Axes::first_gain()...}, {first_reason<Axes>()...}},
        error_units_{},
        foreseen_{} {}

  /// One control cycle from a telemetry message.
  /// @param telemetry  offers `target_angle(axis)`, `imu_angle(axis)` in units of 360/16384 degree, `imu_C()`,
  ///                   `frame_imu_C()` and `battery_cV()`, as `sbgc::RealtimeData` does
  /// @param ticks      time since the last step or silent cycle; no time at all in most of the messages is a fault
  template <class Telemetry>
  const Command& step(const Telemetry& telemetry, Ticks ticks) noexcept {
    constexpr uint16_t minimum_cV =
        static_cast<uint16_t>(detail::nearest(Constants::minimum_supply_V() * 100.0));
    for (uint8_t index = 0; index < axis_count(); ++index) {
      const int16_t error = position_error_units(telemetry.target_angle(index), telemetry.imu_angle(index));
      error_units_[index] = static_cast<uint16_t>(error < 0 ? -error : error);
    }
    const uint16_t supply_cV = telemetry.battery_cV();
    measure(supply_cV);
    const bool has_air = follow_air(telemetry.imu_C(), telemetry.frame_imu_C(), ticks);
    uint8_t acted[axis_count()];
    for (uint8_t index = 0; index < axis_count(); ++index) {
      const uint8_t reported = thermopower::detail::reported_power(telemetry, index, 0);
      acted[index] = unless(foreseen_[index], force_.heard(index, reported, command_.power[index]));
    }
    // Before the first air there was no estimate to be heated.
    if (has_telemetry_ || is_restored_) heat(acted, most_in_time());
    disobeyed_ = force_.decided() ? static_cast<uint16_t>(0) : saturating_sum(disobeyed_, ticks);
    if (supply_cV < minimum_cV) telemetry_fault_ = LimitReason::supply_low;
    else if (supply_cV > highest_cV()) telemetry_fault_ = LimitReason::supply_above_nominal;
    else if (thermopower::detail::is_board_overheated(telemetry, 0))
      telemetry_fault_ = LimitReason::board_overheated;
    else if (!has_air) telemetry_fault_ = LimitReason::air_implausible;
    else if (is_standing(ticks)) telemetry_fault_ = LimitReason::time_stands_still;
    else telemetry_fault_ = disobeyed_ > tolerated() ? LimitReason::not_obeyed : LimitReason::none;
    silent_ = 0;
    has_telemetry_ = true;
    return decide(telemetry_fault_, ticks);
  }

  /// One cycle in which no telemetry came: what the last one asked for, or its fault, holds until
  /// `timeout_s()`, then the power is the least. @param ticks  time since the last step or silent cycle
  const Command& step_silent(Ticks ticks) noexcept {
    silent_ = saturating_sum(silent_, ticks);
    const bool is_lost = silent_ > tolerated();
    uint8_t acted[axis_count()];
    for (uint8_t index = 0; index < axis_count(); ++index) {
      if (is_lost) force_.lost(index);
      acted[index] = unless(foreseen_[index], force_.unheard(index, command_.power[index]));
    }
    // Nobody waits for an answer.
    heat(acted, axis_count());
    if (!has_telemetry_) return decide(LimitReason::no_telemetry_yet, ticks);
    return decide(silent_ <= tolerated() ? telemetry_fault_ : LimitReason::link_silent, ticks);
  }

  /// The board has confirmed a command. Needed of a board whose telemetry does not report the power in force.
  /// @param confirm  says by `is_of_power()` whether the command was one that sets POWER, as sbgc::Confirm does; any
  /// other changes nothing
  template <class Confirm>
  void confirmed(const Confirm& confirm) noexcept {
    static_assert(
        thermopower::detail::IsConfirm<Confirm>::value,
        "thermopower: confirmed() needs the board's answer, with is_of_power(), such as sbgc::Confirm");
    force_.confirmed(confirm);
  }
  /// The board was asked for its POWER and has answered: PowerInForce::read_back().
  void read_back(uint8_t index, uint8_t power) noexcept { force_.read_back(index, power); }
  /// Your program has set a variable of the board by a command of its own: PowerInForce::other_sent().
  void other_sent() noexcept { force_.other_sent(); }
  /// The board has answered with an error: the power it was told may not be in force.
  void refused() noexcept { force_.refused(); }
  /// What was learned of the board: how late it obeys, and by what factor.
  const PowerInForce<sizeof...(Axes)>& force() const noexcept { return force_; }

  /// Starts from temperatures that are known, after a restart of this controller beside a board that may have
  /// gone on: any power may be in force until the board says another. Before the first step.
  /// @param hottest  no axis is hotter
  /// @param air      the warmest there can be: until it is read, nothing cools below that
  /// @param largest  no larger POWER is in force, unless the board says so: what RetainedHottest recalled
  void restore(CoarseTemperature hottest, CoarseTemperature air, uint8_t largest = 255) noexcept {
    NotBelowVisitor visitor = {hottest};
    axes_.visit(visitor);
    air_.assume(air);
    is_restored_ = true;
    for (uint8_t index = 0; index < axis_count(); ++index) force_.lost(index, largest);
    prepare();
  }
  /// Was it restored?
  bool is_restored() const noexcept { return is_restored_; }
  /// The temperature of the hottest axis, rounded up to a whole degC.
  int16_t hottest_C() noexcept { return static_cast<int16_t>((hottest() >> 7) + 1); }
  /// The same, not rounded to a degree.
  CoarseTemperature hottest() noexcept {
    HottestVisitor visitor = {-128 * 128};
    axes_.visit(visitor);
    return visitor.hottest;
  }
  /// The largest POWER of all axes that may be in force.
  uint8_t largest_power() const noexcept {
    uint8_t largest = 0;
    for (uint8_t index = 0; index < axis_count(); ++index) {
      const uint8_t power = force_.expected(index, command_.power[index]);
      if (power > largest) largest = power;
    }
    return largest;
  }

  /// Computes the heating by the last command, or by what else may be in force. Call it after every step, when
  /// the command is on its way.
  void prepare() noexcept {
    PrepareVisitor visitor = {*this};
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
      const bool is_within = decided.power <= gimbal.highest_power_;
      gimbal.command_.power[index] = is_within ? decided.power : gimbal.highest_power_;
      gimbal.command_.reason[index] = is_within ? decided.reason : LimitReason::supply_headroom;
      gimbal.command_.p_gain[index] = controller.p_gain();
    }
  };
  struct ActedVisitor {
    const BasicGimbalController& gimbal;
    const uint8_t* acted;
    uint8_t in_time;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      if (acted[index] == 0) return;
      if (in_time == 0) {
        controller.heated_most();
        return;
      }
      --in_time;
      controller.prepare(gimbal.as_nominal(acted[index]));
    }
  };
  struct WarmVisitor {
    CoarseTemperature difference;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.warm_by(difference);
    }
  };
  struct NotBelowVisitor {
    CoarseTemperature air;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.not_below(air);
    }
  };
  struct HottestVisitor {
    CoarseTemperature hottest;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      const CoarseTemperature upper = controller.upper();
      if (upper > hottest) hottest = upper;
    }
  };
  struct PrepareVisitor {
    BasicGimbalController& gimbal;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      gimbal.foreseen_[index] = gimbal.force_.expected(index, gimbal.command_.power[index]);
      controller.prepare(gimbal.as_nominal(gimbal.foreseen_[index]));
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

  // How many axes may turn out to have been heated by more than was prepared for, and be computed anew before
  // the command goes out. Another one in the same cycle is heated by the most there is, at most 3.8 K/s, for
  // that cycle alone: never less than it was, and the time of a step has a bound.
  static constexpr uint8_t most_in_time() { return 2; }

  static constexpr double nominal_V() { return detail::least_supply_V<Axes...>(); }
  static constexpr uint16_t nominal_cV() {
    return static_cast<uint16_t>(detail::nearest(nominal_V() * 100.0));
  }
  static constexpr uint16_t highest_cV() {
    return static_cast<uint16_t>(
        detail::nearest(detail::lesser(nominal_V() * (1.0 + Constants::supply_margin()) * 100.0, 65535.0)));
  }

  // Above the nominal supply a POWER drives as a larger one would at the nominal: by the square of both, in 1/128. No
  // more is granted than the tables know.
  void measure(uint16_t supply_cV) noexcept {
    if (supply_cV <= nominal_cV()) {
      strength_ = 128;
      highest_power_ = 255;
      return;
    }
    const uint16_t above_cV =
        static_cast<uint16_t>((supply_cV < highest_cV() ? supply_cV : highest_cV()) - nominal_cV());
    // (1 + x)^2 <= 1 + (2 + margin) x
    constexpr uint32_t factor = static_cast<uint32_t>(
        detail::nearest((2.0 + Constants::supply_margin()) * 128.0 * 65536.0 / (nominal_V() * 100.0)));
    strength_ = static_cast<uint8_t>(129u + static_cast<uint16_t>(above_cV * factor >> 16));
    highest_power_ = static_cast<uint8_t>(32640u / strength_ - 1u);
  }
  uint8_t as_nominal(uint8_t power) const noexcept {
    if (strength_ == 128) return power;
    const uint16_t scaled = static_cast<uint16_t>(
        (static_cast<uint16_t>(static_cast<uint16_t>(power) * strength_) >> 7) + (power != 0 ? 1 : 0));
    return scaled < 255 ? static_cast<uint8_t>(scaled) : static_cast<uint8_t>(255);
  }

  // What `prepare()` foresaw needs nothing more.
  static uint8_t unless(uint8_t expected, uint8_t acted) noexcept {
    return acted == expected ? static_cast<uint8_t>(0) : acted;
  }

  // Once for all callers: what it takes is a copy for each motor.
  [[gnu::noinline]] void heat(const uint8_t* acted, uint8_t in_time) noexcept {
    ActedVisitor visitor = {*this, acted, in_time};
    axes_.visit(visitor);
  }

  static constexpr uint16_t tolerated() {
    return static_cast<uint16_t>(detail::nearest(Constants::timeout_s() * detail::ticks_per_s()));
  }
  static uint16_t saturating_sum(uint16_t sum, Ticks ticks) noexcept {
    const uint16_t room = static_cast<uint16_t>(0xFFFFu - sum);
    return ticks > room ? static_cast<uint16_t>(0xFFFFu) : static_cast<uint16_t>(sum + ticks);
  }

  // An air that jumps up by more than 5 K in the first 16 s was read wrongly at the start, when the motors were
  // taken to be as warm as it; a program that believes every fall believes that first reading, too. @return is there a plausible reading?
  bool follow_air(int8_t camera_C, int8_t frame_C, Ticks ticks) noexcept {
    const CoarseTemperature before = air_.state().air;
    if (air_.step(camera_C, frame_C, ticks).source == AirSource::neither) return false;
    if (known_air_ == 0) {
      // The thesis's assumption, section 4.2: a motor that was just switched on is as warm as the air.
      NotBelowVisitor visitor = {air_.state().air};
      axes_.visit(visitor);
      known_air_ = 1;
    } else if (Constants::Air::fall_per_s() > 0.0 && known_air_ != 0xFFFFu) {
      const CoarseTemperature rise = static_cast<CoarseTemperature>(air_.state().air - before);
      if (rise > 5 * 128) {
        WarmVisitor visitor = {rise};
        axes_.visit(visitor);
      }
      known_air_ = saturating_sum(known_air_, ticks);
    }
    return true;
  }

  // A message takes more than a tick on the wire: one since which no time passed comes from a burst, or the clock stands still. That is
  // a fault when it does so in most of them.
  bool is_standing(Ticks ticks) noexcept {
    if (ticks != 0 || silent_ != 0) stood_ = stood_ != 0 ? static_cast<uint8_t>(stood_ - 1) : stood_;
    else if (stood_ < 2 * most_stood()) ++stood_;
    return stood_ >= most_stood();
  }
  static constexpr uint8_t most_stood() { return 16; }

  const Command& decide(LimitReason fault, Ticks ticks) noexcept {
    StepVisitor visitor = {*this, fault, ticks};
    axes_.visit(visitor);
    return command_;
  }

  AirTemperature<typename Constants::Air> air_;
  detail::AxisChain<0, Axes...> axes_;
  Command command_;
  uint16_t error_units_[sizeof...(Axes)];
  uint8_t foreseen_[sizeof...(Axes)];  // what `prepare()` computed the heating for
  PowerInForce<sizeof...(Axes)> force_;
  uint16_t silent_ = 0;
  uint16_t disobeyed_ = 0;       // how long the board has had another power in force than it was told
  uint16_t known_air_ = 0;       // ticks since the first plausible air, at least 1 then
  uint8_t stood_ = 0;            // messages since which no time passed, less those since which it did
  uint8_t strength_ = 128;       // of a POWER, by the supply above the nominal, in 1/128
  uint8_t highest_power_ = 255;  // that the tables know at that supply
  LimitReason telemetry_fault_ = LimitReason::none;
  bool has_telemetry_ = false;
  bool is_restored_ = false;
};

/// The controller of a gimbal with the standard rules for its sensors.
/// @ingroup control
template <class... Axes>
using GimbalController = BasicGimbalController<StandardGimbal, Axes...>;

}  // namespace fixed_point
}  // namespace thermopower
