// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "arithmetic.hpp"

/// @file control/certified/bounds.hpp
/// What must be declared about an actuator before a limiter can vouch for it: bounds, not values.
///
/// Most bounds have one end only, because a comparison argument shows which end is the dangerous one
/// (docs/explain/certified-limiter.md). Only heat capacities need both: a small one warms fast, a large one
/// cools slowly.

namespace thermopower {

/// A constant that is not known exactly. `lowest` <= true value <= `highest`.
///
/// @snippet control_examples.cpp certified two nodes
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter.
/// @ingroup control
struct Bounds {
  float lowest;   ///< Above 0.
  float highest;  ///< Not below `lowest`, finite.

  /// A value and a tolerance. @param fraction  0.2 for +-20 %; 0 .. below 1
  static Bounds around(float value, float fraction) noexcept {
    const Bounds bounds = {value * (1.0f - fraction), value * (1.0f + fraction)};
    return bounds;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.lowest, self.highest);
  }
  /// `field` unless 0 < lowest <= highest < infinity.
  ConfigError validate(ConfigError field) const noexcept {
    return first_error(detail::require_positive(lowest, field),
                       detail::is_finite(highest) && highest >= lowest ? ConfigError::none : field);
  }
};

/// The most heat that can arise in the winding at full POWER (255) and the highest supply: at two winding
/// temperatures, because a warm winding takes less. In between, the heat may be no more than that of a
/// resistance that rises in a straight line.
///
/// @snippet control_examples.cpp certified two nodes
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter.
/// @ingroup control
struct HeatBounds {
  float highest_supply_V;  ///< The supply is never above this. Above 0.
  float supply_error;  ///< The measured supply may be wrong by this fraction until the next step, >= 0. 1 or
                       ///< more: it is not used.
  float coldest_C;     ///< The winding is never colder: the coldest air. -60 .. 100 degC.
  float heat_when_cold_W;  ///< Highest heat at `coldest_C`. Above 0.
  float heat_when_hot_W;   ///< Highest heat at the winding's limit. Above 0, not above `heat_when_cold_W`.
  float
      lowest_supply_V;  ///< A reading below this is no supply, and counts as the highest. 0: no reading is used.

  /// For a winding that follows Ohm's law.
  /// @param highest_supply_V  V
  /// @param supply_error      see the field
  /// @param resistance_ohm    lowest and highest at `reference_C`; only the lowest counts
  /// @param tempco_per_K      relative rise per kelvin of the winding, lowest and highest (copper: 0.0038 ..
  /// 0.0040)
  /// @param reference_C       where the resistance was measured
  /// @param coldest_C         see the field
  /// @param hottest_C         the winding's limit
  /// @param lowest_supply_V   see the field
  static HeatBounds ohmic(float highest_supply_V, float supply_error, const Bounds& resistance_ohm,
                          const Bounds& tempco_per_K, float reference_C, float coldest_C, float hottest_C,
                          float lowest_supply_V = 0.0f) noexcept {
    const float at_reference_W = highest_supply_V * highest_supply_V / resistance_ohm.lowest;
    const HeatBounds heat = {highest_supply_V,
                             supply_error,
                             coldest_C,
                             at_reference_W / resistance_ratio(tempco_per_K, coldest_C - reference_C),
                             at_reference_W / resistance_ratio(tempco_per_K, hottest_C - reference_C),
                             lowest_supply_V};
    return heat;
  }

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.highest_supply_V, self.supply_error, self.coldest_C, self.heat_when_cold_W,
            self.heat_when_hot_W, self.lowest_supply_V);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_positive(highest_supply_V, ConfigError::highest_supply_V)))
      return ConfigError::highest_supply_V;
    if (is_error(detail::require_not_negative(supply_error, ConfigError::supply_error)))
      return ConfigError::supply_error;
    if (is_error(detail::require_within(coldest_C, -60.0f, 100.0f, ConfigError::coldest_C)))
      return ConfigError::coldest_C;
    if (is_error(detail::require_positive(heat_when_cold_W, ConfigError::heat_when_cold_W)))
      return ConfigError::heat_when_cold_W;
    if (is_error(detail::require_positive(heat_when_hot_W, ConfigError::heat_when_hot_W)) ||
        heat_when_hot_W > heat_when_cold_W)
      return ConfigError::heat_when_hot_W;
    // Asked this way round so that NaN is refused.
    return lowest_supply_V >= 0.0f && lowest_supply_V < highest_supply_V ? ConfigError::none
                                                                         : ConfigError::lowest_supply_V;
  }

private:
  // The lowest there can be: below the reference the larger coefficient takes more away.
  static float resistance_ratio(const Bounds& tempco_per_K, float difference_K) noexcept {
    return 1.0f + (difference_K < 0.0f ? tempco_per_K.highest : tempco_per_K.lowest) * difference_K;
  }
};

/// What a certified network is told about its surroundings and its use.
/// @ingroup control
struct CertifiedUse {
  HeatBounds heat;      ///< What full POWER does.
  float highest_air_C;  ///< The air is never warmer than this. Not below `heat.coldest_C`.
  float
      hold_s;  ///< A ceiling acts for at most this long before the next plan can lower it: the longest cycle, and
               ///< the longest delay between a command and its effect. Above 0, at most 10.
  float horizon_s;  ///< How long a power must be bearable to be granted: how gently authority falls. At least
                    ///< `hold_s`.
  uint8_t every;    ///< Plan in every n-th step only, at least 1; `hold_s` must cover that many steps.
  uint8_t phase;    ///< In which of them, below `every`: give each axis its own, and they take turns.

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.heat, self.highest_air_C, self.hold_s, self.horizon_s, self.every, self.phase);
  }
};

/// Temperatures measured at one instant since the last plan. Kept in 1/64 K, rounded up: two bytes each in every
/// limiter instead of four.
///
/// @snippet control_examples.cpp certified parts
/// How to: @ref explain_certified_limiter.
/// @ingroup control
class CertifiedMeasurement {
public:
  /// Nothing measured.
  CertifiedMeasurement() noexcept : winding_(none()), body_(none()) {}
  /// @param winding_C, body_C  never below the truth at that instant. NaN where nothing was measured; what is below
  ///                           -100 or above 500 degC is no measurement
  CertifiedMeasurement(float winding_C, float body_C) noexcept : winding_(up(winding_C)), body_(up(body_C)) {}

  /// Whether there is one.
  bool is_any() const noexcept { return winding_ != none() || body_ != none(); }
  /// The lower of the winding's and what is known without it. @param known  a bound throughout the step
  detail::KelvinUnits winding(detail::KelvinUnits known) const noexcept { return lower(winding_, known); }
  /// The same for the body.
  detail::KelvinUnits body(detail::KelvinUnits known) const noexcept { return lower(body_, known); }

private:
  static constexpr int16_t none() { return 32767; }
  static int16_t up(float measured_C) noexcept {
    // A power of two multiplies without rounding.
    if (!(measured_C >= -100.0f && measured_C <= 500.0f)) return none();
    return static_cast<int16_t>(static_cast<int16_t>(measured_C * 64.0f) + 1);
  }
  static detail::KelvinUnits lower(int16_t measured, detail::KelvinUnits known) noexcept {
    if (measured == none()) return known;
    const detail::KelvinUnits units = measured * 4096L;
    return units < known ? units : known;
  }

  int16_t winding_, body_;
};

/// Carries a step's length through the network's two time constants: the part of the way to its final value
/// that a node goes.
///
/// @snippet control_examples.cpp certified parts
/// How to: @ref explain_certified_limiter.
/// @ingroup control
struct CertifiedTravel {
  detail::FineFraction heating;  ///< Not below 1 - exp(-fastest rate * dt).
  detail::FineFraction cooling;  ///< Not above 1 - exp(-slowest rate * dt).

  /// @param fastest_per_s  rate with the smallest heat capacity  @param slowest_per_s  with the largest
  static CertifiedTravel over(float fastest_per_s, float slowest_per_s, float dt_s) noexcept {
    const float slow = slowest_per_s * dt_s;
    const float below = slow < 1.0f ? slow * (1.0f - 0.5f * slow) : 0.5f;
    const CertifiedTravel travel = {detail::fine_up(above(fastest_per_s * dt_s)), detail::fine_down(below)};
    return travel;
  }
  /// The same. @param slowest  the rate with the largest heat capacity as a part of the fastest, not above the truth
  static CertifiedTravel over_part(float fastest_per_s, detail::UnitFraction slowest, float dt_s) noexcept {
    return over(fastest_per_s, fastest_per_s * (static_cast<float>(slowest) * (1.0f / 65536.0f)), dt_s);
  }
  /// Goes no farther than a hold does, for a step that is no longer: what was planned with the coarse fraction of
  /// a hold then covers the step to the last unit. A hold of many time constants ends at 1 - 2^-16 instead of one;
  /// `whole_margin()` in the heat makes up for it, and the rest of a way is downwards.
  void end_at(detail::UnitFraction hold) noexcept {
    const detail::FineFraction whole_hold = static_cast<detail::FineFraction>(hold) << 16;
    if (heating > whole_hold) heating = whole_hold;
  }
  /// Not below 1 - exp(-x). Taylor's series ends above it after an odd term, and below it after an even one,
  /// for every x >= 0.
  static float above(float x) noexcept {
    return x < 1.0f ? x * (1.0f - x * (0.5f - x * (1.0f / 6.0f))) : 1.0f;
  }
};

/// The same in whole numbers, for steps within a hold: a step length that was never seen before costs an 8-bit chip a quarter of what
/// it costs in floats. The polynomials are those of CertifiedTravel, each rounding to the safe side.
///
/// @snippet control_examples.cpp certified parts
/// How to: @ref explain_certified_limiter.
/// @ingroup control
class CertifiedPace {
public:
  /// @param way  the fastest rate times the hold; from one up nothing is known here, and `is_known()` is false
  void set(float way) noexcept {
    shift_ = 0;
    float mantissa = way * 65536.0f;
    if (!(mantissa > 0.0f && mantissa < 65000.0f)) {
      shift_ = unknown();
      return;
    }
    while (mantissa < 32000.0f && shift_ < 30) {
      mantissa += mantissa;
      ++shift_;
    }
    mantissa_ = static_cast<uint16_t>(mantissa * (1.0f + detail::float_margin()) + 1.0f);
  }
  /// Whether the hold is shorter than the time constant.
  bool is_known() const noexcept { return shift_ != unknown(); }

  /// @param part     the step's length in 2^-16 of a hold, not below the truth, and above it by no more than three; at most 65535
  /// @param slowest  the slowest rate as a part of the fastest, not above the truth
  CertifiedTravel over(uint16_t part, detail::UnitFraction slowest) const noexcept {
    const uint32_t fast = shifted(detail::product(mantissa_, part)) + 1u;
    // Both factors less what they were rounded up by.
    const uint32_t low =
        shifted(detail::product(static_cast<uint16_t>(mantissa_ - 2u),
                                part > 3 ? static_cast<uint16_t>(part - 3u) : static_cast<uint16_t>(0)));
    const uint32_t slow = detail::product(static_cast<uint16_t>(low >> 16), slowest) +
                          (detail::product(static_cast<uint16_t>(low), slowest) >> 16);
    const CertifiedTravel travel = {above(fast), below(slow)};
    return travel;
  }

private:
  static constexpr uint8_t unknown() { return 255; }
  // Bytes first: an 8-bit chip shifts bit by bit.
  uint32_t shifted(uint32_t product) const noexcept {
    return shift_ < 8 ? product >> shift_ : (product >> 8) >> (shift_ - 8);
  }
  // x - x^2/2 + x^3/6, not below it.
  static detail::FineFraction above(uint32_t x) noexcept {
    const uint16_t floor = static_cast<uint16_t>(x >> 16);
    if (floor >= 65534u) return 0xffffffffUL;
    const uint16_t ceiling = static_cast<uint16_t>(floor + 1u);
    const uint32_t square = detail::product(floor, floor), most = square + floor + ceiling;
    // Up to 1/64 a sixth of x is less than 1/256.
    const uint32_t cubed =
        floor < 1024u
            ? (most >> 8) + 1u
            : detail::product(
                  static_cast<uint16_t>(
                      (detail::product(static_cast<uint16_t>((most >> 16) + 1u), ceiling) >> 16) + 1u),
                  10923u);
    return x - (square >> 1) + cubed;
  }
  // x - x^2/2, not above it.
  static detail::FineFraction below(uint32_t x) noexcept {
    const uint16_t ceiling = static_cast<uint16_t>((x >> 16) + 1u);
    const uint32_t half_square = (detail::product(ceiling, ceiling) >> 1) + 1u;
    return x > half_square ? x - half_square : 0u;
  }

  uint16_t mantissa_ = 0;
  uint8_t shift_ = 255;
};

/// How much less heat a warm winding takes: a chord over 1/R(T), which is convex, so the chord lies above it.
///
/// @snippet control_examples.cpp certified parts
/// How to: @ref explain_certified_limiter.
/// @ingroup control
class CertifiedRelief {
public:
  /// @param hot_C  where `heat_when_hot_W` holds  @param end_C  where the chord is to be exact; above it the
  /// relief stays
  void set(const HeatBounds& heat, float hot_C, float end_C) noexcept {
    const float resistance =
        heat.heat_when_cold_W / heat.heat_when_hot_W - 1.0f;  // relative rise from coldest to hot
    const float at_end = resistance * (end_C - heat.coldest_C) / (hot_C - heat.coldest_C);
    const float per_K = at_end / (1.0f + at_end) / (end_C - heat.coldest_C);
    const int32_t fine =
        detail::rounded_down(per_K * 8388608.0f);  // 2^-23 per kelvin: up to 0.78 % per kelvin
    per_K_ = static_cast<uint16_t>(fine < 0xffffL ? fine : 0xffffL);
    // In 1/256 K, rounded down: above it the relief stays, and less relief is more heat.
    const detail::KelvinUnits end = detail::celsius_units(end_C - heat.coldest_C) >> 10;
    end_ = static_cast<uint16_t>(end < 0 ? 0 : (end < 255L * 256L ? end : 255L * 256L));
  }
  /// Heat at a winding temperature as a fraction of the heat at the coldest, not below the truth. @param
  /// over_coldest  difference
  detail::UnitFraction at(detail::KelvinUnits over_coldest) const noexcept {
    if (over_coldest <= 0) return detail::whole_fraction();
    // In 1/256 K: shifted by 10 in parts, because an 8-bit chip shifts bit by bit. From 256 K on it is beyond the end.
    const uint8_t top = static_cast<uint8_t>(static_cast<uint32_t>(over_coldest) >> 24);
    const uint16_t middle = static_cast<uint16_t>(static_cast<uint32_t>(over_coldest) >> 8);
    const uint16_t over = static_cast<uint16_t>((middle >> 2) | static_cast<uint16_t>(top << 14));
    const uint16_t coarse = top < 4 && over < end_ ? over : end_;
    // Below one half of 2^32, because the relief is less than the whole; so doubled instead of shifted by 15.
    const uint32_t half_relief = detail::product(coarse, per_K_);
    const uint16_t relief = static_cast<uint16_t>((half_relief + half_relief) >> 16);
    return static_cast<detail::UnitFraction>(detail::whole_fraction() - relief);
  }

private:
  uint16_t per_K_ = 0, end_ = 0;
};

/// What holds a power back.
/// @ingroup control
enum class CertifiedNode : uint8_t {
  none = 0,     ///< Nothing: full power is bearable.
  winding = 1,  ///< The winding's limit.
  body = 2      ///< The body's limit, or the only node's.
};

/// The largest power that a network can bear, in counts of heat above the least, and which node says so.
///
/// @snippet control_examples.cpp certified parts
/// How to: @ref explain_certified_limiter.
/// @ingroup control
struct CertifiedCount {
  uint8_t count;              ///< 0 .. 254.
  CertifiedNode node;         ///< `none` at 254.
  detail::KelvinUnits apart;  ///< What the winding has to hand on beyond the least power's; 0 with one node.

  /// Leaves nothing where there is no room. @param room  of what must be inside already
  void keep(int32_t room, CertifiedNode which) noexcept {
    if (room >= 0) return;
    count = 0;
    node = which;
  }
  /// Lowers the count to how often `size` goes into `room`.
  void fit(int32_t room, int32_t size, CertifiedNode which) noexcept {
    const uint8_t fitting = detail::count_within(room, size, count);
    if (fitting < count) {
      count = fitting;
      node = which;
    }
  }
};

}  // namespace thermopower
