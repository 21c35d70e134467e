// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "air_temperature.hpp"
#include "axis_controller.hpp"
#include "detail/gimbal_axes.hpp"
#include "power_in_force.hpp"

/// @file control/gimbal_controller.hpp
/// One `AxisController` per axis, each with its own motor, fed by one telemetry message.

namespace thermopower {

/// What goes back to the board: one entry per axis, in the order of the axes.
/// @ingroup control
template <uint8_t axis_count>
struct GimbalCommand {
  static_assert(axis_count > 0, "thermopower: a gimbal has at least one axis");

  uint8_t power[axis_count];       ///< POWER
  uint8_t p_gain[axis_count];      ///< P
  LimitReason reason[axis_count];  ///< Why `power` is below what the error asks for.
};

/// The first wrong field of a gimbal's configuration.
/// @ingroup control
struct GimbalConfigError {
  uint8_t axis;       ///< 0 .. number of axes - 1; the number of axes when the field is the gimbal's own.
  ConfigError field;  ///< `ConfigError::none` when all is well.
};

/// The supply the motors are assumed to run on: the thesis found the board's own measurement too inaccurate to compute
/// with. A measurement above it heats the estimate all the same, and one above it by more than the margin is another
/// battery than the one configured: `LimitReason::supply_above_nominal`.
///
/// @snippet control_examples.cpp gimbal
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct NominalSupply {
  /// @return the larger of both; the nominal one when nothing is measured. V
  static float supply_V(float nominal_V, float measured_V) noexcept {
    return measured_V > nominal_V ? measured_V : nominal_V;
  }
  /// By how much of the nominal supply a measurement may exceed it.
  static constexpr float margin() { return 0.1f; }
};

/// The supply as the board measures it: take it when the measurement has been checked, or the battery sags.
///
/// @snippet control_examples.cpp gimbal
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct MeasuredSupply {
  /// @return V
  static float supply_V(float, float measured_V) noexcept { return measured_V; }
};

/// What one tunes on the gimbal as a whole.
///
/// @snippet control_examples.cpp gimbal
/// How to: @ref wire_up_sbgc.
/// @ingroup control
struct GimbalConfig {
  float supply_V;          ///< Nominal supply, above 0. The thesis: 13.
  float minimum_supply_V;  ///< Below this the battery counts as empty or missing. The program: 3.
  float timeout_s;         ///< Silence of the link that is tolerated, above 0.
  AirTemperature::Config
      air;  ///< When a thermometer is believed. Where a motor declares a colder air, that one counts for its axis.
  float maximum_supply_V;  ///< Above this a reading is no supply. Above `supply_V`.

  /// 13 V, 3 V, half a second, 60 V; the air as warm as 45 degC.
  static GimbalConfig standard() noexcept {
    GimbalConfig config = {13.0f, 3.0f, 0.5f, AirTemperature::Config::standard(), 60.0f};
    return config;
  }
  /// The same with thermometers that are believed: AirTemperature::Config::believing().
  static GimbalConfig believing() noexcept {
    GimbalConfig config = standard();
    config.air = AirTemperature::Config::believing();
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.supply_V, self.minimum_supply_V, self.timeout_s, self.air, self.maximum_supply_V);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_positive(supply_V, ConfigError::supply_V))) return ConfigError::supply_V;
    if (is_error(detail::require_not_negative(minimum_supply_V, ConfigError::minimum_supply_V)) ||
        minimum_supply_V >= supply_V)
      return ConfigError::minimum_supply_V;
    if (!detail::is_finite(maximum_supply_V) || maximum_supply_V <= supply_V)
      return ConfigError::maximum_supply_V;
    return first_error(detail::require_positive(timeout_s, ConfigError::timeout_s), air.validate());
  }
};

/// What the gimbal decides on, where it does not come as a telemetry message.
/// @ingroup control
template <uint8_t axis_count>
struct GimbalInputs {
  static_assert(axis_count > 0, "thermopower: a gimbal has at least one axis");

  float error_deg[axis_count];  ///< Position errors, any number of turns.
  float camera_C;               ///< Thermometer of the camera's IMU.
  float frame_C;                ///< Thermometer of the frame's IMU; NaN when there is none.
  float supply_V;               ///< Measured supply.
};

/// The controller of a whole gimbal.
/// @tparam Supply  `NominalSupply` or `MeasuredSupply`
/// @tparam Axes    one AxisController per axis
///
/// @snippet control_examples.cpp gimbal
/// How to: @ref wire_up_sbgc.
/// @ingroup control
template <class Supply, class... Axes>
class BasicGimbalController : detail::GimbalPoses<sizeof...(Axes), detail::AnyTakesPose<Axes...>::value> {
  static_assert(
      detail::IsSupply<Supply>::value,
      "thermopower: the first parameter of BasicGimbalController must be NominalSupply or MeasuredSupply, or a type with static supply_V(nominal_V, measured_V)");

public:
  /// Number of axes.
  static constexpr uint8_t axis_count() { return static_cast<uint8_t>(sizeof...(Axes)); }
  static_assert(sizeof...(Axes) >= 1 && sizeof...(Axes) < 255,
                "thermopower: a GimbalController needs at least one AxisController");

  typedef GimbalConfig Config;                     ///< What one tunes on the gimbal as a whole.
  typedef GimbalCommand<sizeof...(Axes)> Command;  ///< What goes back to the board.
  typedef GimbalInputs<sizeof...(Axes)> Inputs;    ///< What the gimbal decides on.

  /// What one logs; each axis has its own state.
  struct State {
    Command command;       ///< The last command.
    float air_C;           ///< The air is no warmer; NaN when no thermometer is plausible.
    AirSource air_source;  ///< Which thermometers are read.
    float silent_s;        ///< Time since the last telemetry.
  };

  /// Every axis and the gimbal with their standard configuration.
  BasicGimbalController() noexcept { begin(); }
  /// @param config  of the gimbal  @param axes  of each axis, in order
  explicit BasicGimbalController(const Config& config, const typename Axes::Config&... axes) noexcept
      : config_(config), air_(config.air), axes_(axes...) {
    begin();
  }

  /// The first wrong field found when the controller was made. Anything but none keeps the power of every
  /// axis at its least.
  GimbalConfigError validate() const noexcept { return config_error_; }

  /// One control cycle from a telemetry message.
  /// @param telemetry  offers `error_deg(axis)`, `imu_C()`, `frame_imu_C()` and `battery_V()`, as
  /// `sbgc::RealtimeData` does; a law that asks where its axis stands is told `imu_angle_deg(axis)` where there is one
  /// @param dt_s       time since the last step, >= 0
  template <class Telemetry>
  const Command& step(const Telemetry& telemetry, float dt_s) noexcept {
    Inputs inputs;
    for (uint8_t index = 0; index < axis_count(); ++index)
      inputs.error_deg[index] = telemetry.error_deg(index);
    inputs.camera_C = static_cast<float>(telemetry.imu_C());
    inputs.frame_C = static_cast<float>(telemetry.frame_imu_C());
    inputs.supply_V = telemetry.battery_V();
    HeardVisitor<Telemetry> visitor = {*this, telemetry};
    axes_.visit(visitor);
    count_disobeyed(force_.decided(), dt_s);
    this->read_poses(telemetry);
    is_board_overheated_ = detail::is_board_overheated(telemetry, 0);
    return decide(inputs, dt_s);
  }

  /// One control cycle; no law is told where its axis stands. What was sent is taken for what is in force, but for what `confirmed()` and
  /// `refused()` say. @param dt_s  time since the last step, >= 0
  const Command& step(const Inputs& inputs, float dt_s) noexcept {
    this->clear_poses();
    const NothingReported nothing = {};
    HeardVisitor<NothingReported> visitor = {*this, nothing};
    axes_.visit(visitor);
    count_disobeyed(force_.decided(), dt_s);
    is_board_overheated_ = false;
    return decide(inputs, dt_s);
  }

  /// One cycle in which no telemetry came. The temperatures go on; what the last telemetry asked for, or its
  /// fault, holds until `timeout_s`, then the power is the least; an axis whose limiter vouches for a shorter
  /// time without a plan (`hold_s`) has no longer than that. @param dt_s  time since the last step or silent
  /// cycle, >= 0
  const Command& step_silent(float dt_s) noexcept {
    // Asked this way round so that a NaN time counts as silence, and a negative one buys no more of it.
    if (!(dt_s < 0.0f)) state_.silent_s += dt_s;
    const bool is_tolerated = state_.silent_s <= config_.timeout_s;
    if (!is_tolerated) force_.lost();
    UnheardVisitor visitor = {*this};
    axes_.visit(visitor);
    if (!has_telemetry_) return step_axes(LimitReason::no_telemetry_yet, dt_s);
    return step_axes(is_tolerated ? telemetry_fault_ : LimitReason::link_silent, dt_s);
  }

  /// The board has confirmed a command. Needed of a board whose telemetry does not report the power in force.
  /// @param confirm  says by `is_of_power()` whether the command was one that sets POWER, as sbgc::Confirm does; any
  /// other changes nothing
  template <class Confirm>
  void confirmed(const Confirm& confirm) noexcept {
    static_assert(
        detail::IsConfirm<Confirm>::value,
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
  /// Any power may be in force until the board says another: after a restart of this controller beside a board
  /// that went on.
  /// @param largest  no larger POWER is in force, unless the board says so: what RetainedHottest recalled
  void assume_driven(uint8_t largest = 255) noexcept {
    for (uint8_t index = 0; index < axis_count(); ++index) force_.lost(index, largest);
  }

  const State& state() const noexcept { return state_; }  ///< After the last step.

  /// The controller of one axis, to log its state or set its temperature.
  template <uint8_t index>
  auto axis() noexcept
      -> decltype(detail::axis_at<index>(*static_cast<detail::AxisChain<0, Axes...>*>(nullptr))) {
    return detail::axis_at<index>(axes_);
  }
  /// @overload
  template <uint8_t index>
  auto axis() const noexcept
      -> decltype(detail::axis_at<index>(*static_cast<const detail::AxisChain<0, Axes...>*>(nullptr))) {
    return detail::axis_at<index>(axes_);
  }

private:
  struct NothingReported {};
  template <class Telemetry>
  struct HeardVisitor {
    BasicGimbalController& gimbal;
    const Telemetry& telemetry;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      controller.heated_by(gimbal.force_.heard(index, detail::reported_power(telemetry, index, 0),
                                               gimbal.state_.command.power[index]));
    }
  };
  struct UnheardVisitor {
    BasicGimbalController& gimbal;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      controller.heated_by(gimbal.force_.unheard(index, gimbal.state_.command.power[index]));
    }
  };
  struct WarmVisitor {
    float difference_K;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.warm_by(difference_K);
    }
  };
  struct NotBelowVisitor {
    const BasicGimbalController& gimbal;
    template <class Axis>
    void operator()(uint8_t, Axis& controller) noexcept {
      controller.not_below(gimbal.template air_of<Axis>());
    }
  };
  struct StepVisitor {
    BasicGimbalController& gimbal;
    LimitReason fault;
    float dt_s;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      const bool is_overdue = gimbal.state_.silent_s > detail::hold_of(controller.limiter(), 0);
      const LimitReason found = is_overdue && !is_fault(fault) ? LimitReason::link_silent : fault;
      const typename Axis::Inputs inputs = {gimbal.last_.error_deg[index],
                                            Supply::supply_V(gimbal.config_.supply_V, gimbal.last_.supply_V),
                                            gimbal.template air_of<Axis>(), found};
      gimbal.store(index, gimbal.step_axis(controller, inputs, index, dt_s));
    }
  };

  struct BeginVisitor {
    BasicGimbalController& gimbal;
    template <class Axis>
    void operator()(uint8_t index, Axis& controller) noexcept {
      if (!is_error(gimbal.config_error_.field) && is_error(controller.validate())) {
        gimbal.config_error_.axis = index;
        gimbal.config_error_.field = controller.validate();
      }
      gimbal.store(index, controller.state());
    }
  };

  template <class AxisState>
  void store(uint8_t index, const AxisState& decided) noexcept {
    state_.command.power[index] = decided.power;
    state_.command.p_gain[index] = decided.p_gain;
    state_.command.reason[index] = decided.reason;
  }

  void begin() noexcept {
    config_error_.axis = axis_count();
    config_error_.field = config_.validate();
    for (uint8_t index = 0; index < axis_count(); ++index) last_.error_deg[index] = detail::not_a_number();
    last_.camera_C = last_.frame_C = last_.supply_V = detail::not_a_number();
    this->clear_poses();
    state_.air_C = detail::not_a_number();
    state_.air_source = AirSource::neither;
    state_.silent_s = 0.0f;
    BeginVisitor visitor = {*this};
    axes_.visit(visitor);
  }

  const Command& decide(const Inputs& inputs, float dt_s) noexcept {
    follow_air(inputs, dt_s);
    state_.silent_s = 0.0f;
    last_ = inputs;
    has_telemetry_ = true;
    telemetry_fault_ = LimitReason::none;
    if (!detail::is_finite(inputs.supply_V)) telemetry_fault_ = LimitReason::supply_not_finite;
    else if (inputs.supply_V < config_.minimum_supply_V) telemetry_fault_ = LimitReason::supply_low;
    else if (inputs.supply_V > config_.maximum_supply_V) telemetry_fault_ = LimitReason::supply_implausible;
    // A reading that cannot be must not heat the estimate: one cycle of it would take an hour to cool. Nor must one of
    // no supply cool it: a board that is told the least power may have another in force. Each axis takes the highest
    // supply that it declares.
    if (is_fault(telemetry_fault_)) last_.supply_V = detail::not_a_number();
    else if (inputs.supply_V > detail::highest_nominal_V<Supply>(config_.supply_V, 0))
      telemetry_fault_ = LimitReason::supply_above_nominal;
    else if (is_board_overheated_) telemetry_fault_ = LimitReason::board_overheated;
    else if (disobeyed_s_ > config_.timeout_s) telemetry_fault_ = LimitReason::not_obeyed;
    return step_axes(telemetry_fault_, dt_s);
  }

  void count_disobeyed(bool is_obeyed, float dt_s) noexcept {
    disobeyed_s_ = is_obeyed ? 0.0f : (dt_s > 0.0f ? disobeyed_s_ + dt_s : disobeyed_s_);
  }

  // Of two declarations of the air the colder one counts.
  template <class Axis>
  AxisAirCelsius air_of() const noexcept {
    return Axis::declares_air() ? air_.state().bound_within(Axis::air_range())
                                : AxisAirCelsius::bound(air_.state().air_C);
  }

  // An air that jumps up soon after the start was read wrongly at the start, when the motors were taken to be
  // as warm as it.
  void follow_air(const Inputs& inputs, float dt_s) noexcept {
    const float before_C = air_.state().air_C;
    air_.step(inputs.camera_C, inputs.frame_C, dt_s);
    const float rise_K = air_.state().air_C - before_C;
    if (is_air_unknown_ && detail::is_finite(air_.state().air_C)) {
      NotBelowVisitor visitor = {*this};
      axes_.visit(visitor);
      is_air_unknown_ = false;
    }
    if (!detail::is_finite(before_C) || !(known_air_s_ < settling_s())) return;
    if (dt_s > 0.0f) known_air_s_ += dt_s;
    if (!(rise_K > jump_K())) return;
    WarmVisitor visitor = {rise_K};
    axes_.visit(visitor);
  }
  // Air itself does not warm by this from one message to the next; a thermometer that comes to its senses does.
  static constexpr float jump_K() { return 5.0f; }
  // How long after the first reading such a jump still says that the first was wrong.
  static constexpr float settling_s() { return 16.0f; }

  const Command& step_axes(LimitReason fault, float dt_s) noexcept {
    state_.air_C = air_.state().air_C;
    state_.air_source = air_.state().source;
    if (is_error(config_error_.field)) fault = LimitReason::config_invalid;
    StepVisitor visitor = {*this, fault, dt_s};
    axes_.visit(visitor);
    return state_.command;
  }

  Config config_ = Config::standard();
  AirTemperature air_{config_.air};
  PowerInForce<sizeof...(Axes)> force_;
  detail::AxisChain<0, Axes...> axes_;
  Inputs last_;
  State state_;
  GimbalConfigError config_error_;
  LimitReason telemetry_fault_ = LimitReason::none;
  float disobeyed_s_ = 0.0f;  // how long the board has had another power in force than it was told
  float known_air_s_ = 0.0f;  // since the first plausible air; stops at settling_s()
  bool has_telemetry_ = false;
  bool is_air_unknown_ = true;
  bool is_board_overheated_ = false;
};

/// The controller of a gimbal whose motors run on a known, stiff supply, as the thesis assumes.
/// @ingroup control
template <class... Axes>
using GimbalController = BasicGimbalController<NominalSupply, Axes...>;

}  // namespace thermopower
