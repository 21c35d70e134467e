// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "bounds.hpp"

/// @file control/certified/one_node.hpp
/// A sound upper bound of the temperature of an actuator that is equally warm everywhere, and the largest
/// power that keeps it below its limit. Symbols and numbers in brackets are those of
/// docs/explain/certified-limiter.md.

namespace thermopower {

/// One node with bounds instead of constants: C dT/dt = P - G (T - T_air). G, the air, the supply and the
/// resistance may change at any time within their bounds, and so may C.
///
/// @snippet control_examples.cpp certified one node
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
class CertifiedOneNode {
public:
  /// What is declared.
  struct Config {
    Bounds heat_capacity_J_per_K;     ///< C
    float least_conductance_W_per_K;  ///< G is never below this. Above 0.
    float maximum_C;                  ///< The limit. 0 .. 200 degC.

    /// Nothing suits every motor: NaN, which `validate()` refuses by name until it is set.
    static Config standard() noexcept {
      const float unset = detail::not_a_number();
      const Config config = {{unset, unset}, unset, unset};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.heat_capacity_J_per_K, self.least_conductance_W_per_K, self.maximum_C);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      return first_error(
          heat_capacity_J_per_K.validate(ConfigError::heat_capacity_J_per_K),
          first_error(detail::require_positive(least_conductance_W_per_K, ConfigError::conductance_W_per_K),
                      detail::require_within(maximum_C, 0.0f, 200.0f, ConfigError::maximum_C)));
    }
    float hottest_C() const noexcept { return maximum_C; }  ///< Limit of the heated node.
  };

  /// Length of a step, in the form the network needs it.
  struct Travel {
    CertifiedTravel body;  ///< towards the air
    bool is_late;          ///< Longer than a hold: outside the contract, but still carried soundly.
  };

  /// Constants once; the bound starts at the limit (hot), the safe guess for an actuator that this limiter
  /// has guarded before.
  CertifiedOneNode(const Config& config, const CertifiedUse& use) noexcept {
    const float count_W = use.heat.heat_when_cold_W * (detail::whole_margin() / 255.0f);
    fastest_per_s_ = config.least_conductance_W_per_K / config.heat_capacity_J_per_K.lowest;
    slowest_ =
        detail::fraction_down(config.heat_capacity_J_per_K.lowest / config.heat_capacity_J_per_K.highest);
    to_air_ = detail::kelvin_per_count_up(count_W / config.least_conductance_W_per_K);
    hold_s_ = use.hold_s;
    hold_ = detail::fraction_up(CertifiedTravel::above(fastest_per_s_ * use.hold_s));
    horizon_ =
        detail::fraction_down(1.0f - detail::Numeric<float>::exponential(-fastest_per_s_ * use.horizon_s));
    coldest_ = detail::celsius_units(use.heat.coldest_C);
    limit_ = detail::celsius_units(config.maximum_C - 0.0005f);
    relief_.set(use.heat, config.maximum_C, config.maximum_C);
    node_.set(limit_);
    set_air(use.highest_air_C);
    take_warm_winding(detail::whole_fraction());
  }

  /// A bound that cannot be met: see CertifiedTwoNode.
  static ConfigError feasible(const Config& config, const CertifiedUse& use) noexcept {
    const float count_W = use.heat.heat_when_cold_W * (detail::whole_margin() / 255.0f);
    const float to_air_K =
        detail::celsius_from(detail::kelvin_per_count_up(count_W / config.least_conductance_W_per_K));
    if (!(255.0f * to_air_K < detail::highest_rise_K())) return ConfigError::heat_when_cold_W;
    return config.maximum_C > use.highest_air_C + to_air_K + 0.01f ? ConfigError::none
                                                                   : ConfigError::highest_air_C;
  }
  /// How long a count may act, as declared.
  float hold_s() const noexcept { return hold_s_; }

  /// Sets the bound to what is known. @param winding_C, body_C  the hotter counts; NaN starts at the limit
  void start(float winding_C, float body_C) noexcept {
    to_air_now_ = to_air_;  // it was taken for another bound
    if (!detail::is_finite(winding_C) || !detail::is_finite(body_C)) {
      node_.set(limit_);
      return;
    }
    node_.set(detail::celsius_units(winding_C > body_C ? winding_C : body_C) + 1);
  }
  /// Prepares a step length.
  void prepare(float dt_s, Travel& travel) const noexcept {
    travel.body = CertifiedTravel::over_part(fastest_per_s_, slowest_, dt_s);
    travel.is_late = dt_s > hold_s_;
    if (!travel.is_late) travel.body.end_at(hold_);
  }
  /// Carries the bound over a step during which at most `count` acted.
  /// @param measured  known of one instant of the step, whichever it was; the winding's counts
  void advance(uint8_t count, const Travel& step, const CertifiedMeasurement& measured) noexcept {
    if (step.is_late)
      to_air_now_ = to_air_;  // the winding may have cooled, and drawn more, than one hold allows for
    const detail::KelvinUnits passed = carry(count, step);
    if (!measured.is_any()) return;
    const detail::UpperBound node = node_;
    node_.set(measured.winding(passed));
    to_air_now_ = to_air_;  // colder than the bound for which the heat was taken
    const detail::KelvinUnits since = carry(count, step);
    if (since < node.above()) node_.set(since);
    else node_ = node;
  }
  /// Carries a bound that was set at any instant of the step over the rest of it, however long that is.
  void advance_from_start(uint8_t count, const Travel& step) noexcept {
    const detail::UpperBound before = node_;
    advance(count, step, CertifiedMeasurement());
    node_.raise(before);
  }
  /// Carries the bound over an unknown time of at most one hold.
  void advance_unknown(uint8_t count) noexcept {
    node_.raise(base_);
    const detail::KelvinUnits distance = base_ + detail::times(to_air_now_, count) - node_.below();
    if (!(distance > 0)) return;
    Travel hold;
    prepare(hold_s_, hold);
    node_.advance(distance, hold.body.heating);
  }
  /// Takes note of the air from now on. See CertifiedTwoNode.
  void set_air(float air_C) noexcept {
    detail::KelvinUnits air = detail::celsius_units(air_C) + 1;
    if (air <= coldest_) air = coldest_ + 1;
    base_ = air + to_air_;
  }
  /// Takes note of the supply until the next step. See CertifiedTwoNode.
  void take_warm_winding(detail::UnitFraction supply_squared) noexcept {
    const detail::KelvinUnits above = room();
    const detail::UnitFraction relief = relief_.at(base_ + above - detail::part_up(above, hold_) - coldest_);
    to_air_now_ = detail::part_up(
        to_air_, supply_squared == detail::whole_fraction()
                     ? relief
                     : static_cast<detail::UnitFraction>(detail::part_up(relief, supply_squared)));
  }

  /// The largest count that is bearable for the horizon, and safe for ever after the next hold.
  CertifiedCount largest() const noexcept {
    CertifiedCount largest = {254, CertifiedNode::none, 0};
    const detail::KelvinUnits above = room(), left = limit_ - base_ - above;
    // Outside of the safe set: the least power, until it is inside.
    largest.keep(left + rounding_units(), CertifiedNode::body);
    largest.fit(left + detail::part_down(above, horizon_), detail::part_up(to_air_now_, horizon_),
                CertifiedNode::body);
    largest.fit(left + detail::part_down(above, hold_), detail::part_up(to_air_now_, hold_),
                CertifiedNode::body);
    return largest;
  }
  /// The largest count that is bearable for ever in this air.
  uint8_t sustainable() const noexcept { return detail::count_within(limit_ - base_, to_air_now_, 254); }

  /// True when the bound is inside the set that the least power never leaves. It stays true once it is,
  /// within the contract.
  bool is_certified() const noexcept { return limit_ - base_ - room() >= -rounding_units(); }
  /// Always true: there is no second node that could hand on heat.
  bool is_below(uint8_t, const CertifiedCount&) const noexcept { return true; }

  float winding_C() const noexcept {
    return detail::celsius_from(node_.above());
  }                                                      ///< Upper bound of the node.
  float body_C() const noexcept { return winding_C(); }  ///< The same node.

  /// Time until the limit is reached at a constant count; infinite when it never is. 0 when it is reached.
  float seconds_to_limit(uint8_t count) const noexcept {
    const float above_K = detail::celsius_from(room()), limit_K = detail::celsius_from(limit_ - base_);
    const float settled_K = detail::celsius_from(detail::times(to_air_now_, count));
    if (above_K >= limit_K) return 0.0f;
    if (settled_K <= limit_K) return static_cast<float>(INFINITY);
    return static_cast<float>(logf((settled_K - above_K) / (settled_K - limit_K))) / fastest_per_s_;
  }

private:
  // The limit is kept half a millikelvin low; what roundings may add to the bound is a hundredth of that.
  static constexpr detail::KelvinUnits rounding_units() { return 64; }
  // Returns the highest that the bound was at any instant of the step.
  detail::KelvinUnits carry(uint8_t count, const Travel& step) noexcept {
    node_.raise(base_);
    const detail::KelvinUnits before = node_.above();
    const detail::KelvinUnits distance = base_ + detail::times(to_air_now_, count) - node_.below();
    node_.advance(distance, distance > 0 ? step.body.heating : step.body.cooling);
    return node_.above() > before ? node_.above() : before;
  }
  detail::KelvinUnits room() const noexcept { return node_.above() > base_ ? node_.above() - base_ : 0; }

  float fastest_per_s_, hold_s_;
  detail::KelvinUnits to_air_, to_air_now_, coldest_, limit_;
  detail::UnitFraction slowest_, horizon_, hold_;
  CertifiedRelief relief_;
  detail::UpperBound node_;
  detail::KelvinUnits base_ = 0;
};

}  // namespace thermopower
