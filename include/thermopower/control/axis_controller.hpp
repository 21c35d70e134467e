// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "../detail/check.hpp"
#include "../step_time.hpp"
#include "../supply_range.hpp"
#include "detail/composition.hpp"
#include "detail/policy_call.hpp"
#include "detail/standing_time.hpp"
#include "gain_scheduler.hpp"
#include "position_error.hpp"
#include "safety_limiter.hpp"
#include "step_power_law.hpp"

/// @file control/axis_controller.hpp
/// One axis: from a position error to a power that the motor can bear, and the gain that goes with it.

namespace thermopower {

/// Temperature estimate, power law, limiter and gain of one axis, in the order of the original program:
/// the power of the last step heats the model, the error asks for a power, the limiter grants it, the gain
/// follows.
///
/// @tparam Motor     names `Current` and `Thermal` and gives their constants, and may declare its `supply()` and `air()`: `motors/`, or
/// a struct of your own. It may also declare the shortest `step_time()` of its loop
/// @tparam PowerLaw  how much power an error is worth: control/step_power_law.hpp
/// @tparam Limiter   how the temperature is kept below its limit: control/safety_limiter.hpp
/// @tparam Gain      how the P gain follows the power: control/gain_scheduler.hpp
///
/// Until the first valid step, on every fault, and for ever when `validate()` finds an error, the power is
/// the least there is. The temperature is estimated through a fault with the last valid air, and with the
/// highest supply where the reading is outside of the declared range: the motor stays warm even if its sensor is gone.
/// A time that stands still, step after step for longer than the limiter vouches for (`hold_s`, or a tenth of a second), is a fault.
///
/// @snippet control_examples.cpp axis
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Motor, class PowerLaw = StepPowerLaw<>, class Limiter = SafetyLimiter<>,
          class Gain = GainScheduler<>>
class AxisController {
  static_assert(detail::IsMotor<Motor>::value,
                "thermopower: the first parameter of AxisController must be a motor: a type that names "
                "Current and Thermal");
  static_assert(detail::IsPowerLaw<PowerLaw>::value,
                "thermopower: the second parameter of AxisController must be a power law: a type with Config "
                "and step(error_deg) or step(error_deg, facts, dt_s)");
  static_assert(detail::IsLimiter<Limiter>::value,
                "thermopower: the third parameter of AxisController must be a limiter: a type with Config, "
                "step, cut and ceiling");
  static_assert(detail::IsGain<Gain>::value,
                "thermopower: the fourth parameter of AxisController must be a gain: a type with Config and "
                "step(power), such as GainScheduler or NoGain");

public:
  typedef typename Motor::Current Current;  ///< Current model.
  typedef typename Motor::Thermal Thermal;  ///< Thermal model.

  /// What one tunes.
  struct Config {
    typename Current::Config current;     ///< From the motor.
    typename Thermal::Config thermal;     ///< From the motor.
    typename PowerLaw::Config power_law;  ///< What an error is worth.
    typename Limiter::Config limiter;     ///< Limit temperature.
    typename Gain::Config gain;           ///< Must be set where the gain rule has one.
    SupplyRange
        supply;  ///< Of the motor, or must be set: a reading outside of it is a fault, and its highest heats.

    /// The motor's constants and every policy's standard.
    static Config standard() noexcept {
      Config config = {Motor::current(),
                       Motor::thermal(),
                       PowerLaw::Config::standard(),
                       Limiter::Config::standard(),
                       Gain::Config::standard(),
                       detail::declared_supply<Motor>(0)};
      return config;
    }
    /// `standard()` with the axis's gains, of a motor that declares its supply.
    static Config with_gain(const typename Gain::Config& gain) noexcept {
      Config config = standard();
      config.gain = gain;
      return config;
    }
    /// `standard()` with the axis's gains and supply.
    static Config with_gain(const typename Gain::Config& gain, const SupplyRange& supply) noexcept {
      Config config = with_gain(gain);
      config.supply = supply;
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.current, self.thermal, self.power_law, self.limiter, self.gain, self.supply);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      ConfigError error = current.validate();
      if (!is_error(error)) error = thermal.validate();
      if (!is_error(error)) error = power_law.validate();
      if (!is_error(error)) error = limiter.validate();
      if (!is_error(error)) error = gain.validate();
      return is_error(error) ? error : supply.validate();
    }
  };

  /// What the axis decides on.
  struct Inputs {
    float error_deg;  ///< Position error, any number of turns up to a million degrees.
    float
        supply_V;  ///< Amplitude of the switched supply, inside its declared range. A constant must be the highest there can be.
    AxisAirCelsius
        air_C;  ///< Air temperature, -100 .. 200 degC; left out: NaN, a fault. Of a motor without `air()` a reading is believed.
    LimitReason fault;  ///< A fault found by the caller (silent link, low supply), or `LimitReason::none`.
  };

  /// What one logs: every intermediate of the last step.
  struct State {
    float error_deg;     ///< Folded to -180 .. 180.
    float v_rms_V;       ///< At the power of the step before.
    float current_A;     ///< At the power of the step before.
    float power_W;       ///< V_rms I at the power of the step before.
    float motor_C;       ///< Estimated temperature of the hottest node; NaN before the first valid air
                         ///< temperature.
    float rate_K_per_s;  ///< dT/dt of that node.
    uint8_t demand;      ///< Power asked for.
    uint8_t ceiling;     ///< Highest power the limiter grants.
    uint8_t power;       ///< Power granted: send this as POWER.
    uint8_t p_gain;      ///< Send this as P.
    LimitReason reason;  ///< Why `power` is below `demand`.
  };

  /// @param config  constants; ask `validate()` once
  explicit AxisController(const Config& config = Config::standard()) noexcept
      : current_(config.current),
        thermal_(config.thermal, detail::not_a_number()),
        power_law_(config.power_law),
        limiter_(config.limiter),
        gain_(config.gain),
        supply_(config.supply),
        last_supply_V_(config.supply.highest_V),
        config_error_(config.validate()) {
    const State state = {0.0f,
                         0.0f,
                         0.0f,
                         0.0f,
                         detail::not_a_number(),
                         0.0f,
                         least_power(),
                         limiter_.ceiling(),
                         least_power(),
                         detail::first_gain(gain_, 0),
                         LimitReason::no_telemetry_yet};
    state_ = state;
  }

  /// What `Config::validate()` found when the controller was made. Anything but none keeps the power at its
  /// least.
  ConfigError validate() const noexcept { return config_error_; }

  /// Sets the temperature, when something better than "as warm as the air" is known. A program that may be reset while the motor is hot
  /// must call it with what a memory kept (RetainedHottest, a journal); only a CertifiedLimiter takes an unknown start for hot.
  /// @param motor_C  finite; NaN: as warm as the air
  void start(float motor_C) noexcept {
    thermal_.start(motor_C);
    state_.motor_C = motor_C;
    is_started_ = detail::is_finite(motor_C);
  }

  /// Says that a larger power than the one granted may have acted since the last step: that one heats in the
  /// next step. @param power  largest power that may have been in force
  void heated_by(uint8_t power) noexcept { acted_power_ = power; }
  /// Says that the actuator is warmer than was thought. @param difference_K  above 0
  void warm_by(float difference_K) noexcept {
    if (is_started_) start(state_.motor_C + difference_K);
  }

  /// Says that an actuator whose temperature was set is not colder than this.
  void not_below(float air_C) noexcept {
    if (is_started_ && state_.motor_C < air_C) start(air_C);
  }

  /// One control cycle. @param dt_s  time since the last one, >= 0, from two readings of one clock. An invalid one, and one that is
  /// shorter than the motor's `step_time()` declares, is a fault, and the motor warms as long as in the step before. Where the motor
  /// declares none, a time that is told too short is believed
  const State& step(const Inputs& inputs, float dt_s) noexcept {
    return decide(inputs, detail::not_a_number(), detail::PossibleTime<Motor>::of(dt_s));
  }
  /// The same for a law that asks where the axis stands, such as AdaptiveHoldingLaw.
  /// @param pose_deg  in degrees of the law's choice; NaN when it is not known
  const State& step(const Inputs& inputs, float pose_deg, float dt_s) noexcept {
    return decide(inputs, pose_deg, detail::PossibleTime<Motor>::of(dt_s));
  }
  /// Whether the power law asks where the axis stands.
  static constexpr bool takes_pose() { return detail::TakesFacts<PowerLaw>::value; }
  /// Whether the motor declares its air.
  static constexpr bool declares_air() noexcept { return detail::DeclaresAir<Motor>::value; }
  /// The air that the motor declares; -100 .. 200 degC where it declares none.
  static AirRange air_range() noexcept { return detail::declared_air<Motor>(0); }

  const State& state() const noexcept { return state_; }  ///< After the last step.
  Limiter& limiter() noexcept { return limiter_; }  ///< To tell a limiter what was measured; its own state.
  const Limiter& limiter() const noexcept { return limiter_; }       ///< Its own state.
  const PowerLaw& power_law() const noexcept { return power_law_; }  ///< Its own state.
  Thermal& thermal() noexcept { return thermal_; }              ///< To tell an observer what was measured.
  const Thermal& thermal() const noexcept { return thermal_; }  ///< Every temperature of the model.

private:
  [[gnu::always_inline]] const State& decide(const Inputs& inputs, float pose_deg, float dt_s) noexcept {
    // What has not changed since the last step is known to be good: comparing bits is cheap on a small chip,
    // comparing floats is not.
    const float air_C = counted_air_C(inputs.air_C);
    const bool is_air_new = !detail::is_same(air_C, last_air_C_);
    const bool is_supply_new = !detail::is_same(inputs.supply_V, last_supply_V_);
    const bool is_air_bad = is_air_new ? !is_plausible_air(air_C) : !detail::is_finite(air_C);
    const bool is_supply_bad =
        is_supply_new && !detail::is_within(inputs.supply_V, supply_.lowest_V, supply_.highest_V);
    if (is_air_new && !is_air_bad) last_air_C_ = air_C;
    else if (is_air_bad && declares_air()) last_air_C_ = detail::declared_air<Motor>(0).highest_C;
    // What cannot be may hide the most there is.
    if (is_supply_new) last_supply_V_ = is_supply_bad ? supply_.highest_V : inputs.supply_V;
    const bool is_time_positive = detail::is_finite_positive(dt_s);
    state_.error_deg = wrap_deg(inputs.error_deg);
    LimitReason fault = inputs.fault;
    if (is_error(config_error_)) fault = LimitReason::config_invalid;
    else if (!is_fault(fault)) fault = find_fault(inputs.supply_V, is_supply_bad, is_air_bad, dt_s);
    if (acted_power_ > state_.power) detail::tell_acted(limiter_, acted_power_, 0);
    else acted_power_ = state_.power;
    estimate_temperature(is_time_positive ? dt_s : lost_s(dt_s));
    acted_power_ = 0;

    // The model's own, taken a moment ago.
    AxisFacts facts = {least_power(),
                       GuardedCelsius::unchecked(state_.motor_C),
                       GuardedCelsius::body_of(thermal_),
                       state_.rate_K_per_s,
                       last_air_C_,
                       last_supply_V_,
                       state_.error_deg,
                       pose_deg,
                       state_.reason};
    state_.demand = detail::demanded_power(power_law_, state_.error_deg, facts, dt_s, 0);
    facts.demand = state_.demand;
    const LimitedPower granted = is_fault(fault)
                                     ? detail::cut_limiter(limiter_, fault, state_.demand, dt_s, 0)
                                     : detail::limited_power(limiter_, facts, dt_s, 0);
    state_.ceiling = limiter_.ceiling();
    state_.power = granted.power;
    state_.reason = granted.reason;
    state_.p_gain = detail::gain_for(gain_, granted.power, facts, 0);
    return state_;
  }

  LimitReason find_fault(float supply_V, bool is_supply_bad, bool is_air_bad, float dt_s) noexcept {
    if (!detail::is_finite_positive(dt_s) && !(dt_s == 0.0f)) return LimitReason::time_invalid;
    if (clock_.is_standing(limiter_, dt_s)) return LimitReason::time_stands_still;
    if (!detail::is_finite(state_.error_deg)) return LimitReason::error_not_finite;
    if (is_supply_bad) {
      if (!detail::is_finite(supply_V)) return LimitReason::supply_not_finite;
      return supply_V < supply_.lowest_V ? LimitReason::supply_low : LimitReason::supply_implausible;
    }
    return is_air_bad ? LimitReason::air_implausible : LimitReason::none;
  }

  // The power acts, though its time is not told. A step of no valid time is taken to last as long as the last one that had one; where
  // time stands still only while that warms, as the next step may be told the time of both.
  float lost_s(float dt_s) const noexcept {
    return dt_s == 0.0f && !(state_.rate_K_per_s > 0.0f) ? 0.0f : clock_.step_s();
  }

  // A reading inside the declared range says no more than that its thermometer lives.
  static float counted_air_C(const AxisAirCelsius& told_C) noexcept {
    const bool is_declared =
        declares_air() && !told_C.is_bound() && detail::declared_air<Motor>(0).holds(told_C);
    return is_declared ? detail::declared_air<Motor>(0).highest_C : static_cast<float>(told_C);
  }
  // As declared, or wider than any sensor's range, which is AirTemperature's business: only what no air can be.
  static bool is_plausible_air(float air_C) noexcept {
    if (declares_air()) return detail::declared_air<Motor>(0).holds(air_C);
    const uint32_t bits = detail::magnitude_bits(air_C);
    return bits <= detail::magnitude_bits(100.0f) || (bits <= detail::magnitude_bits(200.0f) && air_C > 0.0f);
  }

  void estimate_temperature(float dt_s) noexcept {
    if (!detail::is_finite(last_air_C_)) return;
    if (!is_started_) detail::start_thermal(thermal_, last_air_C_, 0);
    is_started_ = true;
    const typename Current::State& drawn =
        detail::drawn_at(current_, acted_power_, last_supply_V_, thermal_.hottest_C(), 0);
    const typename Thermal::Inputs heat = {drawn.winding_power_W, drawn.v_rms_V, {last_air_C_, 0.0f}};
    thermal_.step(heat, dt_s);
    state_.v_rms_V = drawn.v_rms_V;
    state_.current_A = drawn.current_A;
    state_.power_W = drawn.winding_power_W;
    state_.motor_C = thermal_.hottest_C();
    state_.rate_K_per_s = thermal_.hottest_rate_K_per_s();
  }

  Current current_;
  Thermal thermal_;
  PowerLaw power_law_;
  Limiter limiter_;
  Gain gain_;
  State state_;
  SupplyRange supply_;
  float last_air_C_ = detail::not_a_number();
  float last_supply_V_;
  bool is_started_ = false;
  uint8_t acted_power_ = 0;  // what heated_by() said
  ConfigError config_error_;
  detail::AxisClock<Limiter> clock_;
};

}  // namespace thermopower
