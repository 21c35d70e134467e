// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <stdint.h>

#include "../detail/check.hpp"
#include "axis_facts.hpp"

/// @file control/sensor_limiter.hpp
/// No power without a measurement of the motor, unless somebody has waived it by name.

namespace thermopower {

/// Grants the demand while the motor is being measured. A model alone is as right as its constants; a drive that
/// relies on a sensor must notice when it is gone. Put it into a `LimiterChain` before the limiter that knows the
/// temperature, and tell it of every measurement that was believed:
///
///     if (observer.correct_winding(winding, v_rms_V, current_A)) axis.limiter().limiter<0>().measured();
///
///
/// @snippet control_examples.cpp sensor limiter
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
class SensorLimiter {
public:
  /// What one tunes.
  struct Config {
    uint8_t is_waived;  ///< 0: a sensor is required. 1: `waived()`, the model alone is trusted.
    float timeout_s;    ///< Longest time between two measurements; also until the first. Above 0.

    /// Required, every ten seconds.
    static Config standard() noexcept {
      const Config config = {0, 10.0f};
      return config;
    }
    /// The model alone, and somebody has said so.
    static Config waived() noexcept {
      const Config config = {1, 10.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.is_waived, self.timeout_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (is_waived > 1) return ConfigError::is_waived;
      return detail::require_positive(timeout_s, ConfigError::timeout_s);
    }
  };

  /// What the limiter decides on.
  struct Inputs {
    uint8_t demand;  ///< Power parameter asked for.
  };

  /// Nothing was measured yet: the least power until something is.
  /// @param config  constants; ask `validate()` once
  explicit SensorLimiter(const Config& config = Config::standard()) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none. Anything but none keeps the power at its least.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// A measurement of the motor was believed.
  void measured() noexcept { unmeasured_s_ = 0.0f; }

  /// @param dt_s  time since the last step, >= 0
  LimitedPower step(const Inputs& inputs, float dt_s) noexcept {
    if (is_error(validate())) return cut(LimitReason::config_invalid, inputs.demand);
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return cut(LimitReason::time_invalid, inputs.demand);
    if (is_present()) unmeasured_s_ += dt_s;
    if (config_.is_waived == 0 && !is_present()) return cut(LimitReason::sensor_missing, inputs.demand);
    const LimitedPower granted = {inputs.demand, LimitReason::none};
    return granted;
  }
  /// Least power, or the demand if that is less, for a reason found elsewhere.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    const LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }
  /// What it needs of an axis.
  static Inputs read(const AxisFacts& facts) noexcept {
    const Inputs inputs = {facts.demand};
    return inputs;
  }
  /// Highest power granted now.
  uint8_t ceiling() const noexcept { return config_.is_waived == 1 || is_present() ? 255 : least_power(); }

  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  // Asked this way round so that what is not known is not present.
  bool is_present() const noexcept { return unmeasured_s_ <= config_.timeout_s; }

  Config config_;
  float unmeasured_s_ = 3.0e38f;  // for ever
};

}  // namespace thermopower
