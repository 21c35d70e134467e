// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "bounds.hpp"

/// @file control/certified/two_node.hpp
/// A sound upper bound of a winding's and a body's temperature, and the largest power that keeps both below
/// their limits.
///
/// The second bound is kept on the mean of winding and body, weighted by heat capacity: what both would
/// become if the heat stored in the winding went into the body at once. The body can never be warmer than
/// that, however well it is coupled, so a limit on the mean covers the peak that the body reaches after a
/// cut; and its heat balance does not contain the coupling at all. Symbols and numbers in brackets are those
/// of docs/explain/certified-limiter.md.

namespace thermopower {

/// What is declared about an actuator with a winding and a body.
///
/// @snippet control_examples.cpp certified bounds
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter.
/// @ingroup control
struct CertifiedTwoNodeConfig {
  Bounds winding_heat_capacity_J_per_K;  ///< C_w
  Bounds body_heat_capacity_J_per_K;     ///< C_b
  float least_coupling_W_per_K;          ///< K is never below this. Above 0.
  float least_conductance_W_per_K;       ///< G is never below this. Above 0.
  float maximum_winding_C;               ///< Limit of the winding. 0 .. 250 degC.
  float maximum_body_C;                  ///< Limit of the body. 0 .. 250 degC.

  /// Nothing suits every motor: NaN, which `validate()` refuses by name until it is set.
  static CertifiedTwoNodeConfig standard() noexcept {
    const float unset = detail::not_a_number();
    const CertifiedTwoNodeConfig config = {{unset, unset}, {unset, unset}, unset, unset, unset, unset};
    return config;
  }
  /// The constants of a `TwoNodeThermalModel`, each known to a fraction. @param fraction  0.2 for +-20 %
  template <class ThermalConfig>
  static CertifiedTwoNodeConfig around(const ThermalConfig& thermal, float fraction, float maximum_winding_C,
                                       float maximum_body_C) noexcept {
    const CertifiedTwoNodeConfig config = {Bounds::around(thermal.winding_heat_capacity_J_per_K, fraction),
                                           Bounds::around(thermal.body_heat_capacity_J_per_K, fraction),
                                           thermal.coupling_W_per_K * (1.0f - fraction),
                                           thermal.cooling.conductance_W_per_K * (1.0f - fraction),
                                           maximum_winding_C,
                                           maximum_body_C};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.winding_heat_capacity_J_per_K, self.body_heat_capacity_J_per_K, self.least_coupling_W_per_K,
            self.least_conductance_W_per_K, self.maximum_winding_C, self.maximum_body_C);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        first_error(winding_heat_capacity_J_per_K.validate(ConfigError::winding_heat_capacity_J_per_K),
                    body_heat_capacity_J_per_K.validate(ConfigError::body_heat_capacity_J_per_K)),
        first_error(
            first_error(
                detail::require_positive(least_coupling_W_per_K, ConfigError::coupling_W_per_K),
                detail::require_positive(least_conductance_W_per_K, ConfigError::conductance_W_per_K)),
            first_error(
                detail::require_within(maximum_winding_C, 0.0f, 250.0f, ConfigError::maximum_winding_C),
                detail::require_within(maximum_body_C, 0.0f, 250.0f, ConfigError::maximum_body_C))));
  }
  float hottest_C() const noexcept { return maximum_winding_C; }  ///< Limit of the heated node.
};

/// Two nodes with bounds instead of constants:
///
/// \f[
/// C_w \, \dot T_w = P - K \, (T_w - T_b), \qquad C_b \, \dot T_b = K \, (T_w - T_b) - G \, (T_b - T_\mathrm{air})
/// \f]
///
/// K, G, the air, the supply and the resistance may change at any time within their bounds; C_w and C_b are
/// constant but unknown.
///
/// @snippet control_examples.cpp certified two nodes
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
class CertifiedTwoNode {
public:
  typedef CertifiedTwoNodeConfig Config;  ///< What is declared.

  /// Lengths of a step, in the form the network needs them.
  struct Travel {
    CertifiedTravel winding;  ///< towards the body
    CertifiedTravel body;     ///< towards the air
    bool is_late;             ///< Longer than a hold: outside the contract, but still carried soundly.
  };

  /// Constants once; both bounds start at the limits (hot), the safe guess for an actuator that this limiter
  /// has guarded before.
  CertifiedTwoNode(const Config& config, const CertifiedUse& use) noexcept {
    const Derived derived(config, use);
    const Bounds& winding = config.winding_heat_capacity_J_per_K;
    const Bounds& body = config.body_heat_capacity_J_per_K;
    fastest_winding_per_s_ = derived.winding_rate / winding.lowest;
    fastest_body_per_s_ = derived.body_rate / (winding.lowest + body.lowest);
    slowest_winding_ = detail::fraction_down(winding.lowest / winding.highest);
    slowest_body_ = detail::fraction_down((winding.lowest + body.lowest) / (winding.highest + body.highest));

    across_ = derived.across;
    soak_ = derived.soak;
    to_air_ = derived.to_air;
    gap_ = derived.gap;
    base_over_air_ = derived.base_over_air;
    weight_ = derived.weight;
    least_mean_ = derived.least_mean;

    hold_s_ = use.hold_s;
    per_hold_s_ = 65536.0f * (1.0f + detail::float_margin()) / use.hold_s;
    winding_pace_.set(fastest_winding_per_s_ * use.hold_s);
    body_pace_.set(fastest_body_per_s_ * use.hold_s);
    hold_winding_ = detail::fraction_up(part_of_hold(fastest_winding_per_s_));
    hold_body_ = detail::fraction_up(part_of_hold(fastest_body_per_s_));
    horizon_winding_ = detail::fraction_down(
        1.0f - detail::Numeric<float>::exponential(-fastest_winding_per_s_ * use.horizon_s));
    horizon_body_ = detail::fraction_down(
        1.0f - detail::Numeric<float>::exponential(-fastest_body_per_s_ * use.horizon_s));

    coldest_ = detail::celsius_units(use.heat.coldest_C);
    mean_limit_ = derived.mean_limit;
    winding_limit_ = derived.winding_limit;
    // A chord for each bound, so that each is exact at its own limit.
    winding_relief_.set(use.heat, config.maximum_winding_C, config.maximum_winding_C);
    mean_relief_.set(use.heat, config.maximum_winding_C, detail::celsius_from(mean_limit_));
    winding_.set(winding_limit_);
    mean_.set(mean_limit_);
    set_air(use.highest_air_C);
    take_warm_winding(detail::whole_fraction());
  }

  /// A bound that cannot be met: in the hottest air even the least power is too much, or full power is out of
  /// the arithmetic's range.
  static ConfigError feasible(const Config& config, const CertifiedUse& use) noexcept {
    return Derived(config, use).feasible;
  }
  /// How long a count may act, as declared.
  float hold_s() const noexcept { return hold_s_; }

  /// Sets the bounds to what is known. @param winding_C, body_C  never below the truth; NaN or above the
  /// limit starts at the limit
  void start(float winding_C, float body_C) noexcept {
    take(detail::whole_fraction(), detail::whole_fraction());  // it was taken for other bounds
    taken_supply_ = 0;
    const float hot = body_C > winding_C ? body_C : winding_C;
    winding_.set(detail::is_finite(hot) ? detail::celsius_units(hot) + 1 : winding_limit_);
    if (!detail::is_finite(body_C) || !detail::is_finite(winding_C)) {
      mean_.set(mean_limit_);
      return;
    }
    const detail::KelvinUnits body = detail::celsius_units(body_C) + 1;
    mean_.set(body + detail::part_up(winding_.above() - body, weight_));
  }

  /// Prepares a step length; only a length that changed costs anything.
  /// @param travel  written in place: a copy costs an 8-bit chip a hundred cycles
  void prepare(float dt_s, Travel& travel) const noexcept {
    const float part = dt_s * per_hold_s_;
    // Of positive numbers the bits order as the numbers do.
    travel.is_late = detail::magnitude_bits(dt_s) > detail::magnitude_bits(hold_s_);
    if (winding_pace_.is_known() && body_pace_.is_known() && detail::is_from_zero_to(part, 65534.0f)) {
      // In 2^-16 of a hold, upwards, by less than three.
      const uint16_t whole = static_cast<uint16_t>(static_cast<uint16_t>(part) + 1u);
      travel.winding = winding_pace_.over(whole, slowest_winding_);
      travel.body = body_pace_.over(whole, slowest_body_);
    } else {
      travel.winding = CertifiedTravel::over_part(fastest_winding_per_s_, slowest_winding_, dt_s);
      travel.body = CertifiedTravel::over_part(fastest_body_per_s_, slowest_body_, dt_s);
    }
    if (!travel.is_late) {
      travel.winding.end_at(hold_winding_);
      travel.body.end_at(hold_body_);
    }
  }

  /// Carries both bounds over a step during which at most `count` acted. (17) to (20)
  /// @param measured  known of one instant of the step, whichever it was. (30)
  void advance(uint8_t count, const Travel& step, const CertifiedMeasurement& measured) noexcept {
    const Hull passed = carry(count, step);
    if (measured.is_any()) take_in(count, step, measured, passed);
  }

  /// Carries bounds that were set at any instant of the step over the rest of it, however long that is.
  void advance_from_start(uint8_t count, const Travel& step) noexcept {
    const detail::UpperBound winding = winding_, mean = mean_;
    carry(count, step);
    winding_.raise(winding);
    mean_.raise(mean);
  }
  /// Carries both bounds over an unknown time of at most one hold.
  void advance_unknown(uint8_t count) noexcept {
    Travel hold;
    prepare(hold_s_, hold);
    advance_from_start(count, hold);
  }

  /// Takes note of the air from now on. @param air_C  never below the truth; below the coldest it counts as that
  void set_air(float air_C) noexcept {
    detail::KelvinUnits air = detail::celsius_units(air_C) + 1;
    if (air <= coldest_) air = coldest_ + 1;
    base_ = air + base_over_air_;
  }
  /// Takes note of the supply until the next step; heat falls as the winding warms. Taken where each bound will
  /// be lowest within the next hold, less a little, so that it need not be taken anew before a bound has moved by
  /// about as much.
  /// @param supply_squared  (supply / highest supply)^2, never below the truth
  void take_warm_winding(detail::UnitFraction supply_squared) noexcept {
    if (is_heat_taken(supply_squared)) return;
    const Hull coldest = coldest_in_hold(supply_squared);
    take(supply(winding_relief_.at(coldest.winding), supply_squared),
         supply(mean_relief_.at(coldest.mean), supply_squared));
  }

  /// The largest count that is bearable for the horizon, and safe for ever after the next hold. (21) to (27)
  CertifiedCount largest() const noexcept {
    const Sizes size = sizes();
    const Room room = this->room();
    CertifiedCount largest = {254, CertifiedNode::none, room.apart};
    // Outside of the safe set: the least power, until both are inside.
    largest.keep(room.winding_left + rounding_units(), CertifiedNode::winding);
    largest.keep(room.mean_left + rounding_units(), CertifiedNode::body);
    // Horizon: how authority falls. Not needed for safety.
    const detail::KelvinUnits lost =
        detail::part_down(room.mean - detail::part_up(room.mean + gap_, weight_), horizon_body_);
    largest.fit(room.mean_left + lost, size.slow, CertifiedNode::body);
    largest.fit(room.winding_left + detail::part_down(room.apart + lost, horizon_winding_), size.slow_winding,
                CertifiedNode::winding);
    // One hold: what the proof rests on.
    largest.fit(room.winding_left + detail::part_down(room.apart, hold_winding_), size.held_winding,
                CertifiedNode::winding);
    largest.fit(room.winding_left + room.apart, size.jump, CertifiedNode::winding);
    const detail::KelvinUnits spare = room.mean - room.weighted;
    largest.fit(room.mean_left + detail::part_down(spare, hold_body_), size.held_body, CertifiedNode::body);
    largest.fit(room.mean_left + spare, size.fed, CertifiedNode::body);
    return largest;
  }

  /// The largest count that is bearable for ever in this air. (28)
  uint8_t sustainable() const noexcept {
    const detail::KelvinUnits mean = mean_limit_ - base_, winding = winding_limit_ - base_;
    CertifiedCount count = {254, CertifiedNode::none, 0};
    count.fit(mean - detail::part_up(mean + gap_, weight_), settled(), CertifiedNode::body);
    count.fit(winding - detail::part_up(winding, weight_) - gap_, settled() + across_now_ + soak_now_,
              CertifiedNode::winding);
    return count.count;
  }

  /// True when both bounds are inside the set that the least power never leaves. It stays true once it is,
  /// within the contract.
  bool is_certified() const noexcept {
    const Room room = this->room();
    return room.winding_left >= -rounding_units() && room.mean_left >= -rounding_units();
  }
  /// True when the winding had no more heat to hand on, at the last plan, than it would have at this count
  /// for ever.
  bool is_below(uint8_t count, const CertifiedCount& plan) const noexcept {
    return plan.apart <= detail::times(across_now_ + soak_now_, count);
  }

  /// Upper bound of the winding.
  float winding_C() const noexcept { return detail::celsius_from(winding_.above()); }
  /// Upper bound of the body, now and after a cut.
  float body_C() const noexcept { return detail::celsius_from(base_ + room().mean); }

  /// Time until a node reaches its limit at a constant count; infinite when none does. 0 when one is there.
  float seconds_to_limit(uint8_t count) const noexcept {
    const Room room = this->room();
    const detail::KelvinUnits rise = across_now_ + soak_now_;
    const float apart = detail::celsius_from(gap_ + detail::times(rise, count));
    const float settled = detail::celsius_from(detail::times(to_air_now_, count)) + share() * apart;
    const float mean_s = crossing_s(detail::celsius_from(room.mean), settled / (1.0f - share()),
                                    detail::celsius_from(room.mean + room.mean_left), fastest_body_per_s_);
    const float winding_s =
        crossing_s(detail::celsius_from(room.winding), detail::celsius_from(room.mean) + apart,
                   detail::celsius_from(room.winding + room.winding_left), fastest_winding_per_s_);
    // The winding may also be carried to its limit by a body that warms slowly under it.
    const float carried_s =
        crossing_s(detail::celsius_from(room.mean), settled / (1.0f - share()),
                   detail::celsius_from(room.winding + room.winding_left) - apart, fastest_body_per_s_);
    const float winding_first_s = winding_s < carried_s ? winding_s : carried_s;
    return mean_s < winding_first_s ? mean_s : winding_first_s;
  }

private:
  friend class CertifiedCoupledTwoNode;  // carries the same bounds, with less heat

  // What follows from the declaration alone.
  struct Derived {
    Derived(const Config& config, const CertifiedUse& use) noexcept {
      const Bounds& winding = config.winding_heat_capacity_J_per_K;
      const Bounds& body = config.body_heat_capacity_J_per_K;
      const float winding_share = body.highest / (winding.lowest + body.highest);  // 1 - mu, largest
      const float body_share = body.lowest / (winding.highest + body.lowest);      // 1 - mu, smallest
      weight = detail::fraction_up(1.0f - body_share);
      winding_rate = config.least_coupling_W_per_K / winding_share;
      body_rate = config.least_conductance_W_per_K / body_share;
      const float count_W = use.heat.heat_when_cold_W * (detail::whole_margin() / 255.0f);
      across = detail::kelvin_per_count_up(count_W / winding_rate);
      soak = detail::kelvin_per_count_up(count_W * use.hold_s / (winding.lowest + body.lowest));
      to_air = detail::kelvin_per_count_up(count_W / body_rate);
      gap = across + soak;
      const float share = static_cast<float>(weight) * (1.0f / 65536.0f);
      least_mean = detail::kelvin_up(
          detail::at_most(detail::celsius_from(gap) * share / (1.0f - share) + 0.00002f, 1000.0f));
      base_over_air = detail::kelvin_per_count_up(count_W / config.least_conductance_W_per_K);
      const float rise_K = 255.0f * count_W *
                           (1.0f / config.least_conductance_W_per_K + 1.0f / config.least_coupling_W_per_K +
                            use.hold_s / body.lowest);
      set_limits(config, detail::celsius_units(use.highest_air_C) + 2 + base_over_air);
      feasible = rise_K < detail::highest_rise_K() ? feasible : ConfigError::heat_when_cold_W;
    }
    // In the whole numbers of the step, so that its roundings cannot leave the set either: what the raises by (13)
    // make of a bound inside stays inside, with `spare` for roundings. tests/proofs starts from these conditions.
    void set_limits(const Config& config, detail::KelvinUnits base) noexcept {
      const float rounding_K = 0.0005f;
      const detail::KelvinUnits spare = 2 * rounding_units();
      const detail::KelvinUnits hottest = detail::celsius_units(config.maximum_winding_C - rounding_K);
      mean_limit = detail::celsius_units(config.maximum_body_C - rounding_K);
      if (mean_limit > hottest - gap - 2) mean_limit = hottest - gap - 2;
      winding_limit = hottest;
      // (14): hotter, and the heat stored in the winding alone could carry the body over its limit.
      const float above_K = detail::celsius_from(mean_limit - base - spare);
      const float carried_K = above_K * (0.999999f * 65536.0f) / static_cast<float>(weight);
      if (carried_K < detail::celsius_from(hottest - base))
        winding_limit = base + static_cast<detail::KelvinUnits>(carried_K * detail::units_per_K());
      const bool is_kept = detail::part_up(least_mean + gap, weight) <= least_mean &&
                           base + least_mean + spare <= mean_limit && mean_limit + gap + 2 <= winding_limit &&
                           detail::part_up(winding_limit - base, weight) <= mean_limit - base - spare;
      feasible = is_kept ? ConfigError::none : ConfigError::highest_air_C;
    }
    float winding_rate, body_rate;             // W/K between winding and mean, and between mean and air
    detail::UnitFraction weight;               // mu, largest
    detail::KelvinUnits across, soak, to_air;  // kelvin per count
    detail::KelvinUnits gap;                   // (12): what the least power keeps between the two
    detail::KelvinUnits least_mean;            // the lowest mean that (13) leaves, above the base
    detail::KelvinUnits base_over_air, mean_limit, winding_limit;
    ConfigError feasible;
  };

  // The highest that each bound was at any instant of a step.
  struct Hull {
    detail::KelvinUnits winding, mean;
  };

  Hull carry(uint8_t count, const Travel& step) noexcept {
    mean_.raise(base_ + least_mean_);
    // A body that is colder than the air warms without any power: (6) holds from the raised start only.
    mean_.raise(base_ + detail::part_up(winding_.above() - base_, weight_));
    const detail::KelvinUnits soaked =
        step.is_late ? soaked_late(count) : mean_.above() + gap_ + detail::times(soak_now_, count);
    winding_.raise(soaked);
    const detail::KelvinUnits before = winding_.above();
    const detail::KelvinUnits winding_distance =
        soaked + detail::times(across_now_, count) - winding_.below();
    winding_.advance(winding_distance, winding_distance > 0 ? step.winding.heating : step.winding.cooling);
    const detail::KelvinUnits hottest = winding_.above() > before ? winding_.above() : before;
    const detail::KelvinUnits floor = base_ + detail::part_up(hottest - base_, weight_);
    mean_.raise(floor);
    const detail::KelvinUnits mean_start = mean_.above();
    const detail::KelvinUnits mean_distance = floor + detail::times(to_air_now_, count) - mean_.below();
    mean_.advance(mean_distance, mean_distance > 0 ? step.body.heating : step.body.cooling);
    const Hull passed = {hottest, mean_.above() > mean_start ? mean_.above() : mean_start};
    return passed;
  }

  // The same step from a reading of any instant of it (30), and the lower of both.
  void take_in(uint8_t count, const Travel& step, const CertifiedMeasurement& measured,
               const Hull& passed) noexcept {
    const detail::UpperBound winding = winding_, mean = mean_;
    const detail::KelvinUnits seen_winding = measured.winding(passed.winding);
    const detail::KelvinUnits seen_body = measured.body(passed.mean);
    const detail::KelvinUnits seen_mean =
        seen_winding > seen_body ? seen_body + detail::part_up(seen_winding - seen_body, weight_) : seen_body;
    winding_.set(seen_winding);
    mean_.set(seen_mean < passed.mean ? seen_mean : passed.mean);
    // Colder than the bounds for which the heat was taken, so the heat is the highest there is.
    take(detail::whole_fraction(), detail::whole_fraction());
    taken_supply_ = 0;
    const Hull since = carry(count, step);
    if (since.winding < winding.above()) winding_.set(since.winding);
    else winding_ = winding;
    if (since.mean < mean.above()) mean_.set(since.mean);
    else mean_ = mean;
  }

  // All of it above the base: the temperature that the least power would reach in the hottest air (11).
  struct Room {
    detail::KelvinUnits winding, mean, weighted, apart, winding_left, mean_left;
  };

  // Kelvin per count in the conditions of largest(). Taken anew in every plan: 28 bytes of each axis are dearer.
  struct Sizes {
    detail::KelvinUnits slow, slow_winding, held_winding, jump, held_body, fed;
  };

  detail::KelvinUnits settled() const noexcept {
    return to_air_now_ + detail::part_up(across_now_ + soak_now_, weight_);
  }
  Sizes sizes() const noexcept {
    Sizes size;
    const detail::KelvinUnits rise = across_now_ + soak_now_;
    size.slow = detail::part_up(settled(), horizon_body_);
    size.slow_winding = detail::part_up(size.slow + rise, horizon_winding_);
    size.held_winding = detail::part_up(rise, hold_winding_);
    size.jump = soak_now_ + detail::part_up(across_now_, hold_winding_);
    const detail::KelvinUnits fed = detail::part_up(size.jump, weight_);
    size.held_body = detail::part_up(fed + to_air_now_, hold_body_);
    size.fed = fed + detail::part_up(to_air_now_, hold_body_);
    return size;
  }

  Room room() const noexcept {
    Room room;
    room.mean = mean_.above() - base_;
    if (room.mean < least_mean_) room.mean = least_mean_;
    room.winding = winding_.above() - base_;
    if (room.winding < room.mean + gap_) room.winding = room.mean + gap_;
    room.weighted = detail::part_up(room.winding, weight_);
    if (room.mean < room.weighted) room.mean = room.weighted;
    room.apart = room.winding - room.mean - gap_;
    if (room.apart < 0) room.apart = 0;
    room.winding_left = winding_limit_ - base_ - room.winding;
    room.mean_left = mean_limit_ - base_ - room.mean;
    return room;
  }

  // The limits are kept half a millikelvin low; what roundings may add to a bound is a hundredth of that.
  static constexpr detail::KelvinUnits rounding_units() { return 64; }

  static float crossing_s(float from_K, float to_K, float limit_K, float rate_per_s) noexcept {
    if (from_K >= limit_K) return 0.0f;
    if (to_K <= limit_K) return static_cast<float>(INFINITY);
    return static_cast<float>(logf((to_K - from_K) / (to_K - limit_K))) / rate_per_s;
  }

  float share() const noexcept { return static_cast<float>(weight_) * (1.0f / 65536.0f); }
  float part_of_hold(float rate_per_s) const noexcept { return CertifiedTravel::above(rate_per_s * hold_s_); }

  // What the mean cannot pass however long the count acts: the box below it is invariant (29).
  detail::KelvinUnits soaked_late(uint8_t count) noexcept {
    take(detail::whole_fraction(), detail::whole_fraction());
    taken_supply_ = 0;  // to be taken anew
    const float apart_K = detail::celsius_from(gap_ + detail::times(across_now_ + soak_now_, count));
    const float to_air_K = detail::celsius_from(detail::times(to_air_now_, count));
    const detail::KelvinUnits settled =
        base_ + detail::kelvin_up((to_air_K + share() * apart_K) / (1.0f - share()));
    const detail::KelvinUnits fed =
        base_ + detail::part_up(winding_.above() - base_, weight_) + detail::times(to_air_now_, count);
    detail::KelvinUnits mean = mean_.above() > settled ? mean_.above() : settled;
    if (fed > mean) mean = fed;
    return mean + gap_ + detail::times(soak_now_, count);
  }

  // A supply that falls by less than 1/512 of its square may go on counting as it did: noise costs no work.
  bool is_heat_taken(detail::UnitFraction supply_squared) const noexcept {
    return supply_squared <= taken_supply_ && taken_supply_ - supply_squared < 128 &&
           is_in_slack(winding_.below(), taken_winding_) && is_in_slack(mean_.below(), taken_mean_);
  }
  // For what bounds and supply the heat is taken, and how far above the coldest air each may have fallen within a hold,
  // also when it has first moved by the slack, and the air by anything.
  Hull coldest_in_hold(detail::UnitFraction supply_squared) noexcept {
    const detail::KelvinUnits winding = winding_.below(), mean = mean_.below();
    taken_supply_ = supply_squared;
    taken_winding_ = sixteenths(winding);
    taken_mean_ = sixteenths(mean);
    const detail::KelvinUnits apart = (winding > mean ? winding - mean : 0) + 2 * slack_units();
    const detail::KelvinUnits fall = detail::part_up(apart, hold_winding_);
    const detail::KelvinUnits over = detail::part_up(mean - coldest_ + slack_units(), hold_body_);
    const Hull coldest = {winding - fall - slack_units() - coldest_, mean - over - slack_units() - coldest_};
    return coldest;
  }

  static constexpr detail::KelvinUnits slack_units() { return 65536; }  // a quarter of a kelvin
  // The lowest 16 bits of a bound in 1/16 K tell it from every other: where the heat is taken, bounds lie between the
  // coldest air and 4000 degC, and 2^16 of these are 4096 K.
  static uint16_t sixteenths(detail::KelvinUnits bound) noexcept {
    // Shifted by 14, with whole bytes for the most: an 8-bit chip shifts bit by bit.
    return static_cast<uint16_t>((static_cast<uint32_t>(bound) << 2) >> 16);
  }
  // Three of these apart, rounded down both, is less than the slack.
  static bool is_in_slack(detail::KelvinUnits bound, uint16_t taken) noexcept {
    return static_cast<uint16_t>(sixteenths(bound) - taken + 3u) <= 6u;
  }
  static detail::UnitFraction supply(detail::UnitFraction relief,
                                     detail::UnitFraction supply_squared) noexcept {
    return supply_squared == detail::whole_fraction()
               ? relief
               : static_cast<detail::UnitFraction>(detail::part_up(relief, supply_squared));
  }
  void take(detail::UnitFraction winding, detail::UnitFraction body) noexcept {
    across_now_ = detail::part_up(across_, winding);
    soak_now_ = detail::part_up(soak_, body);
    to_air_now_ = detail::part_up(to_air_, body);
  }

  float fastest_winding_per_s_, fastest_body_per_s_, hold_s_, per_hold_s_;
  CertifiedPace winding_pace_, body_pace_;
  detail::UnitFraction slowest_winding_, slowest_body_;     // as parts of the fastest
  detail::KelvinUnits across_, soak_, to_air_;              // kelvin per count, winding at its coldest
  detail::KelvinUnits across_now_, soak_now_, to_air_now_;  // the same until the next step
  detail::KelvinUnits gap_, least_mean_, base_over_air_, coldest_, winding_limit_, mean_limit_;
  detail::UnitFraction weight_, hold_winding_, hold_body_, horizon_winding_, horizon_body_;
  CertifiedRelief winding_relief_, mean_relief_;
  uint16_t taken_winding_ = 0, taken_mean_ = 0;  // for which bounds the heat was taken: `sixteenths()`
  detail::UnitFraction taken_supply_ = 0;  // and for which supply; 0: to be taken anew, no supply is so low
  detail::UpperBound winding_, mean_;
  detail::KelvinUnits base_ = 0;
};

}  // namespace thermopower
