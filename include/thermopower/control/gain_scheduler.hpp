// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/check.hpp"
#include "../detail/flash.hpp"
#include "detail/composition.hpp"

/// @file control/gain_scheduler.hpp
/// The proportional gain that keeps an axis's response the same when its power changes, eq 4.27.
///
/// | rule | gain | when to take it |
/// |---|---|---|
/// | `RoundedGain` | eq 4.27 to the nearest count | the default |
/// | `TruncatedGain` | eq 4.27 as programmed, cut to a whole count | the original program |
/// | `TableGain<Table>` | from a table in flash | the gain is not linear, or has been tuned per level |
///
/// `NoGain` takes the scheduler's place for an actuator that has no gain, `VoltageGain` where the supply sags or the
/// motor gets warm.
///
/// A rule of your own has `Config` with `validate()`, and `static uint8_t gain(power, config)`.

namespace thermopower {

/// What one tunes: the gains found at the two ends (section 4.2, auto-tuned).
/// @ingroup control
struct GainConfig {
  float gain_low_power;   ///< P at power 0, 0 .. 255.
  float gain_high_power;  ///< P at power 255, 0 .. 255.

  /// There is no gain that suits every rig: these are NaN, which `validate()` refuses by name until they are
  /// set.
  static GainConfig standard() noexcept {
    GainConfig config = {detail::not_a_number(), detail::not_a_number()};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.gain_low_power, self.gain_high_power);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(detail::require_within(gain_low_power, 0.0f, 255.0f, ConfigError::gain_low_power),
                       detail::require_within(gain_high_power, 0.0f, 255.0f, ConfigError::gain_high_power));
  }
};

namespace detail {
/// A table of gains: `size()` and `gains()`.
template <class Candidate, class = int>
struct IsGainTable {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsGainTable<Candidate,
                   typename Exists<decltype(Candidate::size()), decltype(*Candidate::gains())>::Type> {
  static constexpr bool value = true;
};
/// Eq 4.27, plus `rounding`, as a whole count; 0 where the gains are not numbers.
inline uint8_t scheduled_gain(uint8_t power, const GainConfig& config, float rounding) noexcept {
  const float gain = config.gain_low_power -
                     static_cast<float>(power) / 255.0f * (config.gain_low_power - config.gain_high_power) +
                     rounding;
  if (!(gain > 0.0f)) return 0;
  return static_cast<uint8_t>(gain >= 255.0f ? 255.0f : gain);
}
}  // namespace detail

/// Eq 4.27, cut to a whole count as the program does: 22 / 172 / 36 at power 25 for roll / pitch / yaw.
///
/// @snippet control_examples.cpp gain scheduler
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct TruncatedGain {
  typedef GainConfig Config;  ///< What one tunes.
  /// @return P, 0 .. 255
  static uint8_t gain(uint8_t power, const Config& config) noexcept {
    return detail::scheduled_gain(power, config, 0.0f);
  }
};

/// Eq 4.27 to the nearest count.
///
/// @snippet control_examples.cpp gain scheduler
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
struct RoundedGain {
  typedef GainConfig Config;  ///< What one tunes.
  /// @return P, 0 .. 255
  static uint8_t gain(uint8_t power, const Config& config) noexcept {
    return detail::scheduled_gain(power, config, 0.5f);
  }
};

/// Gains at equally spaced powers, linearly interpolated. `Table` has `static constexpr uint8_t size()` (2 ..
/// 255) and `static const uint8_t* gains()`, the address of that many bytes declared with
/// `thermopower_flash`; the first is for power 0, the last for power 255.
///
/// @snippet control_examples.cpp gain table
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Table>
struct TableGain {
  static_assert(
      detail::IsGainTable<Table>::value,
      "thermopower: the parameter of TableGain must be a table: a type with static size() and gains(), in flash");
  /// The table is the configuration.
  struct Config {
    static Config standard() noexcept { return Config(); }  ///< Nothing to set.
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self&, Archive&) {}
    /// Sizes are checked at compile time.
    ConfigError validate() const noexcept { return ConfigError::none; }
  };
  static_assert(Table::size() >= 2,
                "thermopower: a gain table needs at least two entries, for power 0 and power 255");

  /// @return P, 0 .. 255
  static uint8_t gain(uint8_t power, const Config&) noexcept {
    const uint16_t position = static_cast<uint16_t>(static_cast<uint16_t>(power) * (Table::size() - 1u));
    const uint8_t index = by_255(position);
    const uint8_t fraction = static_cast<uint8_t>(position - index * 255u);
    const uint8_t below = detail::read_flash(Table::gains() + index);
    if (fraction == 0) return below;
    const uint8_t above = detail::read_flash(Table::gains() + index + 1);
    if (above >= below)
      return static_cast<uint8_t>(below + part(static_cast<uint8_t>(above - below), fraction));
    return static_cast<uint8_t>(below - part(static_cast<uint8_t>(below - above), fraction));
  }

private:
  // value / 255, without the division that an 8-bit chip has not: exact below 65535.
  static uint8_t by_255(uint16_t value) noexcept {
    return static_cast<uint8_t>(static_cast<uint16_t>(value + 1u + (value >> 8)) >> 8);
  }
  // change * fraction / 255 to the nearest.
  static uint8_t part(uint8_t change, uint8_t fraction) noexcept {
    return by_255(static_cast<uint16_t>(static_cast<uint16_t>(change) * fraction + 127u));
  }
};

/// The proportional gain for a power.
/// @tparam Rule  one of the rules above
///
/// @snippet control_examples.cpp gain scheduler
/// How to: @ref first_axis, @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
template <class Rule = RoundedGain>
class GainScheduler {
  static_assert(
      detail::IsGainRule<Rule>::value,
      "thermopower: the parameter of GainScheduler must be a rule: a type with Config and static gain(power, "
      "config), such as RoundedGain; NoGain and VoltageGain are gains, not rules: take them in its place");

public:
  typedef typename Rule::Config Config;  ///< What one tunes.

  /// @param config  constants; ask `validate()` once
  explicit GainScheduler(const Config& config = Config::standard()) noexcept : config_(config) {}

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }
  /// @param power  granted power parameter  @return P, 0 .. 255
  uint8_t step(uint8_t power) const noexcept { return Rule::gain(power, config_); }

  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  Config config_;
};

/// For actuators without a gain: always 0, which the caller ignores. It stands in the place of a `GainScheduler`.
///
/// @snippet control_examples.cpp no gain
/// How to: @ref custom_actuator. Menu: @ref policies.
/// @ingroup control
class NoGain {
public:
  /// Nothing to tune.
  struct Config {
    static Config standard() noexcept { return Config(); }  ///< Nothing to set.
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self&, Archive&) {}
    ConfigError validate() const noexcept { return ConfigError::none; }  ///< Nothing can be wrong.
  };
  /// @param config  nothing
  explicit NoGain(const Config& config = Config::standard()) noexcept { static_cast<void>(config); }
  ConfigError validate() const noexcept { return ConfigError::none; }  ///< Nothing can be wrong.
  uint8_t step(uint8_t) const noexcept { return 0; }                   ///< @return 0
};

}  // namespace thermopower
