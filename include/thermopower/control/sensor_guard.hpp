// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "../measured_temperature.hpp"
#include "detail/standing_time.hpp"
#include "guarded_celsius.hpp"

/// @file sensor_guard.hpp
/// Stands between a thermometer and everything that believes it.

namespace thermopower {

/// Checks the readings of one thermometer against what it can read and against a model that it does not correct.
///
/// | a reading is refused when | reason |
/// |---|---|
/// | it is not a number, or outside `lowest_C` .. `highest_C` | `sensor_out_of_range` |
/// | it jumps faster than `rate_K_per_s` since the last good one | `sensor_too_fast` |
/// | it stays within `still_K` while the model moves by more than `stuck_K` | `sensor_stuck` |
/// | it and another sensor fit each other's place better than their own | `sensors_exchanged` |
/// | it is colder than the model by more than `disagreement_K` | `sensor_disagrees` |
///
/// A short disturbance costs nothing: for at most `hold_s` the last good reading stands, plus what the model has warmed since. After that
/// there is no temperature, which every limiter answers with the least power and this reason. Bad readings add their time and good ones
/// take away a quarter of theirs, so that spikes in more than a fifth of the time are a fault, too. A reading that is hotter than the model
/// is believed: it costs power, and a cold one costs the motor.
///
/// A sensor that lies within all of these bounds is believed. So a limit wants a margin of `disagreement_K`, less what the model itself is
/// surer of.
///
/// @snippet control_examples.cpp sensor guard
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
class SensorGuard {
public:
  /// What one declares.
  struct Config {
    float lowest_C;      ///< No true reading is below: the coldest air, not the end of the sensor's scale.
    float highest_C;     ///< No true reading is above. Above `lowest_C`.
    float rate_K_per_s;  ///< No true reading moves faster. Above 0.
    float
        still_K;  ///< A reading that moves by no more than this stands still: its resolution and noise. >= 0.
    float stuck_K;  ///< The model moves by more than this only if the reading moves, too. Above `still_K`.
    float disagreement_K;  ///< A true reading is not colder than the model by more than this. Above 0.
    float hold_s;          ///< How long bad readings are bridged. Above 0.

    /// -20 to 150 degC, 5 K/s, still 0.5 K, stuck 5 K, 20 K below the model, 2 s: a thermistor on a housing.
    static Config standard() noexcept {
      const Config config = {-20.0f, 150.0f, 5.0f, 0.5f, 5.0f, 20.0f, 2.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.lowest_C, self.highest_C, self.rate_K_per_s, self.still_K, self.stuck_K,
              self.disagreement_K, self.hold_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (!detail::is_finite(lowest_C) || lowest_C < -273.15f) return ConfigError::minimum_plausible_C;
      if (!detail::is_finite(highest_C) || highest_C <= lowest_C) return ConfigError::maximum_plausible_C;
      if (is_error(detail::require_positive(rate_K_per_s, ConfigError::rate_per_s)))
        return ConfigError::rate_per_s;
      if (is_error(detail::require_not_negative(still_K, ConfigError::change_K)))
        return ConfigError::change_K;
      if (!detail::is_finite(stuck_K) || stuck_K <= still_K) return ConfigError::stuck_K;
      return first_error(detail::require_positive(disagreement_K, ConfigError::maximum_difference_K),
                         detail::require_positive(hold_s, ConfigError::timeout_s));
    }
  };

  /// What one place reads, and what it should read.
  struct Inputs {
    float measured_C;  ///< The reading; NaN: there is none.
    float
        expected_C;  ///< The same place by a model that this sensor does not correct; NaN: there is none, a fault.
  };

  /// What one logs.
  struct State {
    float value_C;  ///< What is believed; NaN: nothing.
    LimitReason
        reason;   ///< What is wrong with the newest reading, or with the sensor; `none` when all is well.
    float bad_s;  ///< Time of bad readings that good ones have not made up for.
  };

  /// Nothing is believed before the first good reading.
  /// @param config  constants; ask `validate()` once
  explicit SensorGuard(const Config& config = Config::standard()) noexcept
      : config_(config), config_error_(config.validate()) {
    state_.value_C = detail::not_a_number();
    state_.reason = LimitReason::sensor_missing;
    state_.bad_s = 0.0f;
  }

  /// First constant out of its range, or ConfigError::none. With any other nothing is believed.
  ConfigError validate() const noexcept { return config_error_; }

  /// One reading. @param dt_s  time since the last one, >= 0
  GuardedCelsius step(const Inputs& own, float dt_s) noexcept {
    const Inputs nobody = {detail::not_a_number(), detail::not_a_number()};
    return step(own, nobody, dt_s);
  }
  /// One reading beside another sensor's, with which it may be exchanged. @param other  another place of the same actuator
  GuardedCelsius step(const Inputs& own, const Inputs& other, float dt_s) noexcept {
    if (is_error(config_error_)) return nothing(LimitReason::config_invalid);
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return nothing(LimitReason::time_invalid);
    if (time_.is_standing(dt_s, config_.hold_s)) return nothing(LimitReason::time_stands_still);
    since_s_ += dt_s;
    const LimitReason found = judge(own, other);
    if (found == LimitReason::none) accept(own, dt_s);
    else refuse(found, own, dt_s);
    return GuardedCelsius(state_.value_C, state_.reason);
  }

  /// The newest reading as an upper bound for `CertifiedLimiter::tighten()`. Nothing while a bad one is bridged.
  /// @param error_K  the most that the true temperature may be above a reading that passes these checks
  GuardedCelsius upper(float error_K) const noexcept {
    return is_fresh_ ? GuardedCelsius(state_.value_C + error_K, LimitReason::sensor_missing)
                     : GuardedCelsius(state_.reason);
  }
  /// The newest reading for a `TemperatureObserver`, not valid while a bad one is bridged.
  /// @param std_K, standing_std_K  as in MeasuredTemperature
  MeasuredTemperature measured(float std_K, float standing_std_K) const noexcept {
    return MeasuredTemperature(state_.value_C, std_K, standing_std_K, is_fresh_);
  }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  GuardedCelsius nothing(LimitReason reason) noexcept {
    state_.value_C = detail::not_a_number();
    state_.reason = reason;
    is_fresh_ = false;
    return GuardedCelsius(reason);
  }

  LimitReason judge(const Inputs& own, const Inputs& other) noexcept {
    // Asked this way round so that NaN is out of every range.
    if (!(own.measured_C >= config_.lowest_C && own.measured_C <= config_.highest_C))
      return LimitReason::sensor_out_of_range;
    if (!detail::is_finite(own.expected_C)) return LimitReason::temperature_not_finite;
    if (is_stuck(own)) return LimitReason::sensor_stuck;
    if (is_started_ &&
        detail::magnitude(own.measured_C - last_C_) > config_.still_K + config_.rate_K_per_s * since_s_)
      return LimitReason::sensor_too_fast;
    if (is_exchanged(own, other)) return LimitReason::sensors_exchanged;
    return own.measured_C < own.expected_C - config_.disagreement_K ? LimitReason::sensor_disagrees
                                                                    : LimitReason::none;
  }

  // What the model went through since the reading last moved. It stays so until the reading moves again.
  bool is_stuck(const Inputs& own) noexcept {
    if (!(detail::magnitude(own.measured_C - anchor_C_) <= config_.still_K)) {
      anchor_C_ = own.measured_C;
      coldest_C_ = warmest_C_ = own.expected_C;
    }
    if (own.expected_C < coldest_C_) coldest_C_ = own.expected_C;
    if (own.expected_C > warmest_C_) warmest_C_ = own.expected_C;
    return warmest_C_ - coldest_C_ > config_.stuck_K;
  }

  // Two readings that fit crosswise, of places that the model has clearly apart.
  bool is_exchanged(const Inputs& own, const Inputs& other) const noexcept {
    const float straight_K = detail::magnitude(own.measured_C - own.expected_C) +
                             detail::magnitude(other.measured_C - other.expected_C);
    const float crosswise_K = detail::magnitude(own.measured_C - other.expected_C) +
                              detail::magnitude(other.measured_C - own.expected_C);
    const float apart_K = detail::magnitude(own.expected_C - other.expected_C);
    return apart_K > config_.stuck_K && crosswise_K + apart_K < straight_K;
  }

  void accept(const Inputs& own, float dt_s) noexcept {
    last_C_ = own.measured_C;
    last_expected_C_ = own.expected_C;
    since_s_ = 0.0f;
    state_.bad_s = detail::at_least(state_.bad_s - 0.25f * dt_s, 0.0f);
    if (!is_started_ || !(state_.bad_s > 0.0f)) is_faulty_ = false;
    is_started_ = true;
    is_fresh_ = !is_faulty_;
    state_.value_C = is_faulty_ ? detail::not_a_number() : own.measured_C;
    if (!is_faulty_) state_.reason = LimitReason::none;
  }

  void refuse(LimitReason found, const Inputs& own, float dt_s) noexcept {
    is_fresh_ = false;
    state_.reason = found;
    state_.bad_s = detail::at_most(state_.bad_s + dt_s, 2.0f * config_.hold_s);
    if (state_.bad_s > config_.hold_s) is_faulty_ = true;
    const float warmed_K = own.expected_C - last_expected_C_;
    // A model that says nothing leaves nothing to stand on.
    state_.value_C = is_faulty_ ? detail::not_a_number() : last_C_ + (warmed_K < 0.0f ? 0.0f : warmed_K);
  }

  Config config_;
  State state_;
  float last_C_ = detail::not_a_number(), last_expected_C_ = detail::not_a_number();  // of the last good one
  float since_s_ = 0.0f;                                                              // and its age
  float anchor_C_ = detail::not_a_number();    // where the reading stands
  float coldest_C_ = 0.0f, warmest_C_ = 0.0f;  // and the model since
  detail::StandingTime time_;
  ConfigError config_error_;
  bool is_started_ = false, is_faulty_ = true, is_fresh_ = false;
};

}  // namespace thermopower
