// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "guarded_celsius.hpp"

/// @file air_witness.hpp
/// Whether an actuator's own temperature confirms what thermometers say of the air.

namespace thermopower {

/// Compares an actuator's measured temperature with a model of it that stands in the air *as read*. An air that is warmer than read by
/// d warms the actuator by d after a while, whatever its power. So an actuator that is as warm as its model says bounds d:
/// \f[ d \le \texttt{margin\_K} = 2 \, \texttt{model\_K} + \texttt{drift\_K\_per\_s} \cdot \texttt{delay\_s} \f]
/// One `model_K` is what may be seen, the other one what the model itself may be too warm by; the product is what a drift has gained
/// before the actuator shows it. It holds where cooling is linear, or stronger than that.
///
/// A thermometer that is wrong from the start is shown by the actuator only after its transient. So the witness vouches after five
/// `delay_s` of agreement, when less than 1 % of such an error hides. A single disagreement takes that back and is named.
///
/// @snippet control_examples.cpp air witness
/// How to: @ref faults_and_reasons. Menu: @ref policies.
/// @ingroup control
class AirWitness {
public:
  /// What one declares.
  struct Config {
    float model_K;  ///< Measured and model differ by no more than this where the air is as read. Above 0.
    float drift_K_per_s;  ///< The air and what is read of it part no faster. >= 0.
    float
        delay_s;  ///< Sum of the time constants between the air and where the actuator is measured. Above 0.

    /// 3 K, 1 K/min; six minutes: a motor of 18 J/K with 50 mW/K.
    static Config standard() noexcept {
      const Config config = {3.0f, 1.0f / 60.0f, 360.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.model_K, self.drift_K_per_s, self.delay_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      return first_error(detail::require_positive(model_K, ConfigError::maximum_difference_K),
                         detail::require_not_negative(drift_K_per_s, ConfigError::rate_per_s),
                         detail::require_positive(delay_s, ConfigError::timeout_s));
    }
  };

  /// What one logs.
  struct State {
    float agreed_s;      ///< For how long measured and model have agreed; stops at five `delay_s`.
    float difference_K;  ///< Measured minus model; NaN when nothing was measured.
    LimitReason reason;  ///< `sensor_disagrees`, or why nothing was measured; `none` when all is well.
  };

  /// Vouches for nothing yet. @param config  constants; ask `validate()` once
  explicit AirWitness(const Config& config = Config::standard()) noexcept
      : config_(config), config_error_(config.validate()) {
    state_.agreed_s = 0.0f;
    state_.difference_K = detail::not_a_number();
    state_.reason = LimitReason::sensor_missing;
  }

  /// First constant out of its range, or ConfigError::none. With any other it vouches for nothing.
  ConfigError validate() const noexcept { return config_error_; }

  /// @param measured    the actuator's temperature as SensorGuard let it through
  /// @param expected_C  the same place by a model that stands in AirTemperature::State::read_C and that nothing corrects
  /// @param dt_s        time since the last step, >= 0
  const State& step(const GuardedCelsius& measured, float expected_C, float dt_s) noexcept {
    const float measured_C = measured;
    state_.difference_K = measured_C - expected_C;
    if (is_error(config_error_)) return refuse(LimitReason::config_invalid);
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return refuse(LimitReason::time_invalid);
    if (is_fault(measured.fault())) return refuse(measured.fault());
    // Asked this way round so that a model without a number disagrees.
    if (!(detail::magnitude(state_.difference_K) <= config_.model_K))
      return refuse(LimitReason::sensor_disagrees);
    state_.reason = LimitReason::none;
    state_.agreed_s = detail::at_most(state_.agreed_s + dt_s, settled_s());
    return state_;
  }

  /// Whether the air is no warmer than read by `margin_K()`.
  bool is_vouching() const noexcept { return !is_error(config_error_) && state_.agreed_s >= settled_s(); }
  /// The most that the air may be warmer than read while this vouches for it, K.
  float margin_K() const noexcept { return 2.0f * config_.model_K + config_.drift_K_per_s * config_.delay_s; }

  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  float settled_s() const noexcept { return 5.0f * config_.delay_s; }
  const State& refuse(LimitReason reason) noexcept {
    state_.agreed_s = 0.0f;
    state_.reason = reason;
    return state_;
  }

  Config config_;
  State state_;
  ConfigError config_error_;
};

}  // namespace thermopower
