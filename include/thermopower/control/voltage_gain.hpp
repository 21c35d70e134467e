// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "axis_facts.hpp"
#include "detail/composition.hpp"

/// @file voltage_gain.hpp
/// The proportional gain from the torque that is really there: the drive's voltage, winding resistance and torque
/// constant.
///
/// | drive | its voltage | when to take it |
/// |---|---|---|
/// | `SwitchedDrive` | V_supply sqrt(POWER / 255), eq 3.11 | the V_rms of a switched supply drives the winding; the default, as `VoltageGain` |
/// | `SineDrive` | V_supply POWER / 255 | POWER scales a sine's amplitude: the thesis motors, whose measured current rises with POWER^0.93 to 0.95 |

namespace thermopower {

/// V_rms of a switched supply, eq 3.11.
///
/// @snippet control_examples.cpp voltage gain
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct SwitchedDrive {
  /// Voltage against voltage of two powers. @param power_ratio  POWER against POWER, above 0
  static float voltage_ratio(float power_ratio) noexcept { return sqrtf(power_ratio); }
};

/// A sine whose amplitude POWER scales. The currents of Tables 4.1 and 4.2 rise with POWER^0.93 and POWER^0.95: 3 to 5 %
/// from this at half the power, where `SwitchedDrive` is 35 % away.
///
/// @snippet control_examples.cpp voltage gain
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct SineDrive {
  /// Voltage against voltage of two powers. @param power_ratio  POWER against POWER, above 0
  static float voltage_ratio(float power_ratio) noexcept { return power_ratio; }
};

/// Keeps gain times torque authority constant. Authority is torque per count of the inner loop: k(T) V_w /
/// R(T), with the drive's voltage V_w, R rising and k falling with temperature. So, against the point where
/// the gain was tuned:
///
/// \f[
/// P = P^* \, \frac{V_w(\mathrm{POWER}^*)}{V_w(\mathrm{POWER})} \; \frac{V^*}{V} \; \frac{R(T)}{R(T^*)} \; \frac{k(T^*)}{k(T)}
/// \f]
///
/// Eq 4.27 draws a straight line between two tuned powers instead, at one supply and temperature. Take this
/// one when the supply sags or the motor gets warm. Without facts (`step(power)`) the supply and temperature
/// of the tuning are assumed.
/// @tparam Drive  one of the drives above, or one of your own with `static float voltage_ratio(float)`
///
/// @snippet control_examples.cpp voltage gain
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Drive>
class BasicVoltageGain {
  static_assert(detail::IsDrive<Drive>::value,
                "thermopower: the parameter of BasicVoltageGain must be a drive: a type with static "
                "voltage_ratio(power_ratio), such as SwitchedDrive or SineDrive");

public:
  /// What one tunes.
  struct Config {
    float gain_low_power;    ///< The gain at the tuning point, 0 to 255: `tuned_power`, `nominal_supply_V`,
                             ///< `reference_C`.
    uint8_t tuned_power;     ///< POWER at which it was tuned, 1 .. 255.
    float nominal_supply_V;  ///< Supply at which it was tuned. Above 0.
    float reference_C;       ///< Motor temperature at which it was tuned. -50 .. 200.
    float tempco_per_K;      ///< Of the winding's resistance; copper 0.00393. 0 .. 0.02.
    float magnet_tempco_per_K;  ///< Loss of torque constant per kelvin, positive; neodymium 0.0011, ferrite
                                ///< 0.002. 0 .. 0.01.
    uint8_t highest_gain;       ///< Not above this, however little power there is.

    /// Copper and neodymium, tuned at POWER 100, 13 V, 25 degC; the gain itself is NaN until it is set.
    static Config standard() noexcept {
      const Config config = {detail::not_a_number(), 100, 13.0f, 25.0f, 0.00393f, 0.0011f, 255};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.gain_low_power, self.tuned_power, self.nominal_supply_V, self.reference_C,
              self.tempco_per_K, self.magnet_tempco_per_K, self.highest_gain);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (is_error(detail::require_within(gain_low_power, 0.0f, 255.0f, ConfigError::gain_low_power)))
        return ConfigError::gain_low_power;
      if (tuned_power < least_power()) return ConfigError::least_power;
      if (is_error(detail::require_positive(nominal_supply_V, ConfigError::nominal_supply_V)))
        return ConfigError::nominal_supply_V;
      if (is_error(detail::require_within(reference_C, -50.0f, 200.0f, ConfigError::reference_C)))
        return ConfigError::reference_C;
      return first_error(
          detail::require_within(tempco_per_K, 0.0f, 0.02f, ConfigError::tempco_per_K),
          detail::require_within(magnet_tempco_per_K, 0.0f, 0.01f, ConfigError::magnet_tempco_per_K));
    }
  };

  /// @param config  constants; ask `validate()` once
  explicit BasicVoltageGain(const Config& config = Config::standard()) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param power  granted power parameter  @return P, 0 .. `highest_gain`
  uint8_t step(uint8_t power) const noexcept {
    return gain(power, config_.nominal_supply_V, config_.reference_C, config_.reference_C);
  }
  /// @param facts  supply, winding and body temperature are read. A supply or temperature that is not finite
  /// counts as the tuning's.
  uint8_t step(uint8_t power, const AxisFacts& facts) noexcept {
    // Most cycles ask the same again; a square root and two divisions are dear on a small chip.
    if (has_asked_ && power == power_ && facts.supply_V == supply_V_ && is_near(facts.motor_C, winding_C_) &&
        is_near(facts.body_C, body_C_))
      return gain_;
    has_asked_ = true;
    power_ = power;
    supply_V_ = facts.supply_V;
    winding_C_ = facts.motor_C;
    body_C_ = facts.body_C;
    gain_ = gain(power, supply_V_, winding_C_, body_C_);
    return gain_;
  }

  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  static bool is_near(float now_C, float then_C) noexcept { return detail::magnitude(now_C - then_C) < 0.5f; }

  float over_reference_K(float temperature_C) const noexcept {
    if (!(temperature_C > -100.0f && temperature_C < 400.0f)) return 0.0f;
    return temperature_C - config_.reference_C;
  }

  uint8_t gain(uint8_t power, float measured_V, float winding_C, float body_C) const noexcept {
    const float supply_V =
        detail::is_finite(measured_V) && measured_V > 0.0f ? measured_V : config_.nominal_supply_V;
    const float resistance = 1.0f + config_.tempco_per_K * over_reference_K(winding_C);
    // A magnet does not lose everything: the straight line ends at a tenth.
    const float torque =
        detail::at_least(1.0f - config_.magnet_tempco_per_K * over_reference_K(body_C), 0.1f);
    const float ratio = static_cast<float>(config_.tuned_power) /
                        static_cast<float>(power < least_power() ? least_power() : power);
    const float gain = config_.gain_low_power * Drive::voltage_ratio(ratio) * config_.nominal_supply_V *
                           resistance / (supply_V * torque) +
                       0.5f;
    if (!(gain > 0.0f)) return 0;
    return gain >= static_cast<float>(config_.highest_gain) ? config_.highest_gain
                                                            : static_cast<uint8_t>(gain);
  }

  Config config_;
  float supply_V_ = 0.0f, winding_C_ = 0.0f, body_C_ = 0.0f;
  uint8_t power_ = 0, gain_ = 0;
  bool has_asked_ = false;
};

/// The gain behind a switched supply.
/// @ingroup control
typedef BasicVoltageGain<SwitchedDrive> VoltageGain;

}  // namespace thermopower
