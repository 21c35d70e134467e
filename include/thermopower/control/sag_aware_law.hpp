// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/composition.hpp"
#include "detail/policy_call.hpp"
#include "step_power_law.hpp"

/// @file sag_aware_law.hpp
/// Keeps V_rms, and with it the torque, what the law meant when the supply sags or is fresh from the charger.

namespace thermopower {

/// Any power law, corrected for the measured supply: V_rms^2 = V^2 POWER / 255, so POWER' = POWER (V_nominal
/// / V)^2.
/// @tparam Law  the law that was tuned at the nominal supply
///
/// The correction is bounded below and above, and the result by 1 .. 255; the limiter comes after it, so more
/// power is never granted than the actuator bears. A supply that is not finite, or 0, is not corrected for.
///
/// @snippet control_examples.cpp sag-aware law
/// How to: @ref custom_actuator. Menu: @ref policies.
template <class Law = StepPowerLaw<>>
class SagAwareLaw {
  static_assert(
      detail::IsPowerLaw<Law>::value,
      "thermopower: the parameter of SagAwareLaw must be a power law: a type with Config and step(error_deg) or "
      "step(error_deg, facts, dt_s)");

public:
  /// What one tunes.
  struct Config {
    typename Law::Config law;  ///< Of the law itself.
    float nominal_supply_V;    ///< The supply at which the law was tuned. Above 0.
    float minimum_supply_V;    ///< Below this the correction grows no further: an empty battery must not be
                               ///< pulled down. Above 0.

    /// The law's standard at 13 V, corrected down to 9 V.
    static Config standard() noexcept {
      const Config config = {Law::Config::standard(), 13.0f, 9.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.law, self.nominal_supply_V, self.minimum_supply_V);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (is_error(law.validate())) return law.validate();
      if (is_error(detail::require_positive(nominal_supply_V, ConfigError::nominal_supply_V)))
        return ConfigError::nominal_supply_V;
      return detail::is_finite(minimum_supply_V) && minimum_supply_V > 0.0f &&
                     minimum_supply_V <= nominal_supply_V
                 ? ConfigError::none
                 : ConfigError::minimum_supply_V;
    }
  };

  /// What one logs.
  struct State {
    uint8_t asked;     ///< What the law asked for.
    float correction;  ///< (V_nominal / V)^2, bounded.
  };

  /// @param config  constants; ask `validate()` once
  explicit SagAwareLaw(const Config& config = Config::standard()) noexcept
      : config_(config), law_(config.law) {
    state_.asked = least_power();
    state_.correction = 1.0f;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param facts  the supply is read; what else the law itself reads
  uint8_t step(float error_deg, const AxisFacts& facts, float dt_s) noexcept {
    state_.asked = detail::demanded_power(law_, error_deg, facts, dt_s, 0);
    if (!(facts.supply_V == supply_V_)) correct(facts.supply_V);
    const float power = static_cast<float>(state_.asked) * state_.correction + 0.5f;
    if (power >= 255.0f) return 255;
    return power < 1.0f ? least_power() : static_cast<uint8_t>(power);
  }

  const Law& law() const noexcept { return law_; }           ///< The law inside.
  const State& state() const noexcept { return state_; }     ///< After the last step.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  void correct(float supply_V) noexcept {
    supply_V_ = supply_V;
    state_.correction = 1.0f;
    if (!detail::is_finite(supply_V) || supply_V <= 0.0f) return;
    const float ratio = config_.nominal_supply_V / detail::at_least(supply_V, config_.minimum_supply_V);
    state_.correction = ratio * ratio;
  }

  Config config_;
  Law law_;
  State state_;
  float supply_V_ = detail::not_a_number();
};

}  // namespace thermopower
