// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "detail/composition.hpp"
#include "detail/policy_call.hpp"
#include "gain_scheduler.hpp"

/// @file eased_gain.hpp
/// Brings an axis that was thrown far off its target back without a swing.

namespace thermopower {

/// Any gain, eased for errors that no tracking makes.
/// @tparam Gain  the gain for small errors: `GainScheduler<...>` or `VoltageGain`
///
/// A stiff gain times a large error asks for the whole torque until the camera flies through its target:
/// damping then has nothing left to act with. Beyond `ease_from_deg` the gain falls in proportion, so that
/// gain times error grows no further, but not below `far_gain`, with which the axis comes back as fast as its
/// damping allows. Within `ease_from_deg` nothing changes. An error that is not finite changes nothing.
///
/// @snippet control_examples.cpp eased gain
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Gain = GainScheduler<> >
class EasedGain {
  static_assert(
      detail::IsGain<Gain>::value,
      "thermopower: the parameter of EasedGain must be a gain: a type with Config and step(power), such as "
      "GainScheduler");

public:
  /// What one tunes.
  struct Config {
    typename Gain::Config gain;  ///< Of the gain itself.
    float ease_from_deg;         ///< Above 0, and well above what tracking leaves.
    uint8_t far_gain;            ///< Not eased below this, 0 .. 255.

    /// The gain's standard, eased beyond 1.5 degrees, not below 3.
    static Config standard() noexcept {
      const Config config = {Gain::Config::standard(), 1.5f, 3};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.gain, self.ease_from_deg, self.far_gain);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      return first_error(gain.validate(),
                         detail::require_positive(ease_from_deg, ConfigError::ease_from_deg));
    }
  };

  /// @param config  constants; ask `validate()` once
  explicit EasedGain(const Config& config = Config::standard()) noexcept
      : config_(config), gain_(config.gain) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// @param power  granted power parameter
  /// @param facts  the error is read (NaN: as if on target), and what the gain itself reads  @return P, 0 .. 255
  uint8_t step(uint8_t power, const AxisFacts& facts) noexcept {
    const uint8_t near = detail::gain_for(gain_, power, facts, 0);
    const float error_deg = detail::magnitude(facts.error_deg);
    if (near <= config_.far_gain || !(error_deg > config_.ease_from_deg) || !detail::is_finite(error_deg))
      return near;
    const float share = config_.ease_from_deg / error_deg;
    const uint8_t eased = static_cast<uint8_t>(static_cast<float>(near) * share + 0.5f);
    return eased > config_.far_gain ? eased : config_.far_gain;
  }

  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  Config config_;
  Gain gain_;
};

}  // namespace thermopower
