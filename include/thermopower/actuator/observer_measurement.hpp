// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "../measured_temperature.hpp"

/// @file observer_measurement.hpp
/// A winding as its own thermometer: R(T) = R_ref (1 + a (T - T_ref)), so voltage and current give a
/// temperature.

namespace thermopower {

/// A winding's temperature by its resistance, to look at. An observer does not take it: how sure it is was judged by the reading itself, and
/// noise that makes a reading colder makes it look surer.
struct WindingReading {
  float value_C;         ///< NaN when there is none.
  float std_K;           ///< As in MeasuredTemperature, judged at `value_C`.
  float standing_std_K;  ///< As in MeasuredTemperature, judged at `value_C`.
  bool is_valid;         ///< False: too little voltage or current to say anything, or what no winding gives.
};

/// Winding temperature from V_rms and current. A lost or broken reading is not valid; it never reads as cold.
///
/// @snippet actuator_examples.cpp observer
/// How to: @ref explain_observer.
class WindingResistance {
public:
  /// What one tunes.
  struct Config {
    float resistance_ohm;  ///< At `reference_C`, between the terminals that see V_rms. Above 0.
    float tempco_per_K;    ///< Copper 0.00393. Above 0, at most 0.02.
    float reference_C;     ///< -50 .. 200.
    float minimum_V_rms;  ///< Below this nothing is measured: dead time and back-EMF outweigh the resistance.
                          ///< >= 0.
    float current_std_A;  ///< Noise of the current sensor, another in each reading. Above 0.
    float current_offset_A;  ///< Standing error of the current, 1 sigma. >= 0.
    float
        current_step_A;  ///< Resolution of the current: REALTIME_DATA_4 sends whole milliampere, 0.001. >= 0.
    float
        voltage_std_fraction;  ///< Standing relative error of V_rms and of the resistance together, 1 sigma.
                               ///< >= 0.

    /// Copper, milliampere, 5 mA noise and 5 mA offset, 1 % of the voltage, from 3 V up; the resistance is NaN
    /// until it is set.
    static Config standard() noexcept {
      const Config config = {detail::not_a_number(), 0.00393f, 20.0f, 3.0f, 0.005f, 0.005f, 0.001f, 0.01f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.resistance_ohm, self.tempco_per_K, self.reference_C, self.minimum_V_rms,
              self.current_std_A, self.current_offset_A, self.current_step_A, self.voltage_std_fraction);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (is_error(detail::require_positive(resistance_ohm, ConfigError::resistance_ohm)))
        return ConfigError::resistance_ohm;
      if (is_error(detail::require_positive(tempco_per_K, ConfigError::tempco_per_K)) || tempco_per_K > 0.02f)
        return ConfigError::tempco_per_K;
      if (is_error(detail::require_within(reference_C, -50.0f, 200.0f, ConfigError::reference_C)))
        return ConfigError::reference_C;
      if (is_error(detail::require_not_negative(minimum_V_rms, ConfigError::minimum_V_rms)))
        return ConfigError::minimum_V_rms;
      if (is_error(detail::require_positive(current_std_A, ConfigError::current_std_A)))
        return ConfigError::current_std_A;
      return first_error(
          first_error(detail::require_not_negative(current_offset_A, ConfigError::current_offset_A),
                      detail::require_not_negative(current_step_A, ConfigError::current_step_A)),
          detail::require_not_negative(voltage_std_fraction, ConfigError::voltage_std_fraction));
    }
  };

  /// @param config  constants; ask `validate()` once
  explicit WindingResistance(const Config& config) noexcept : config_(config) {
    per_ohm_ = 1.0f / config.resistance_ohm;
    per_tempco_ = 1.0f / config.tempco_per_K;
    // A value rounded to steps has a variance of step^2 / 12.
    current_std_A_ = sqrtf(config.current_std_A * config.current_std_A +
                           config.current_step_A * config.current_step_A * (1.0f / 12.0f));
    least_A_ = 3.0f * current_std_A_ + 5.0f * config.current_offset_A;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// One reading, to look at. @param v_rms_V  voltage at the winding  @param current_A  current in this winding alone, RMS
  WindingReading measure(float v_rms_V, float current_A) const noexcept {
    return read(v_rms_V, current_A, detail::not_a_number());
  }
  /// One reading for an observer. @param expected_C  how warm the observer takes the winding to be: how sure the reading is must not
  ///                                                 depend on the reading. Not valid when it is NaN
  MeasuredTemperature measure(float v_rms_V, float current_A, float expected_C) const noexcept {
    const WindingReading read = this->read(v_rms_V, current_A, expected_C);
    return MeasuredTemperature(read.value_C, read.std_K, read.standing_std_K,
                               read.is_valid && detail::is_finite(expected_C));
  }

  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  WindingReading read(float v_rms_V, float current_A, float expected_C) const noexcept {
    WindingReading measured = {detail::not_a_number(), detail::not_a_number(), 0.0f, false};
    // Asked this way round so that NaN is not valid. A current under three times its noise could also be a
    // broken wire, and one near its offset makes no temperature whose error is in proportion to it.
    if (!(v_rms_V >= config_.minimum_V_rms && v_rms_V < 1.0e4f) ||
        !(current_A > least_A_ && current_A < 1.0e4f))
      return measured;
    const float volt_per_ohm = v_rms_V * per_ohm_;  // current at the reference
    float ratio = volt_per_ohm / current_A;
    const float value_C = config_.reference_C + (ratio - 1.0f) * per_tempco_;
    if (!(value_C > -60.0f && value_C < 400.0f)) return measured;
    measured.value_C = value_C;
    if (expected_C > -60.0f && expected_C < 400.0f)
      ratio = 1.0f + config_.tempco_per_K * (expected_C - config_.reference_C);
    const float slope_K = ratio * per_tempco_;
    const float slope_K_per_A = slope_K * ratio / volt_per_ohm;
    // A standing error of the voltage, and one of the current, which grows as the current falls: taken together
    // as one, which is never too little.
    const float offset_K = slope_K_per_A * config_.current_offset_A;
    const float voltage_K = slope_K * config_.voltage_std_fraction;
    measured.std_K = slope_K_per_A * current_std_A_;
    measured.standing_std_K = sqrtf(offset_K * offset_K + voltage_K * voltage_K);
    measured.is_valid = measured.std_K > 0.0f;
    return measured;
  }

  Config config_;
  float per_ohm_, per_tempco_, current_std_A_, least_A_;
};

}  // namespace thermopower
