// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "bounds.hpp"

/// @file control/certified/chain.hpp
/// Sound upper bounds for a chain of any number of thermal nodes, and the largest power that keeps each below a limit of
/// its own: winding, stator, housing, bracket.
///
/// Bound k is kept on the mean of nodes 1 to k, weighted by heat capacity: in an actuator that is heated at one end no
/// node is hotter than that mean, and its heat balance contains one coupling only, of which the least value is the
/// dangerous one. Symbols and numbers in brackets are those of docs/explain/certified-limiter.md.

namespace thermopower {

/// What is declared about one node of a chain.
/// @ingroup control
struct CertifiedChainNode {
  Bounds heat_capacity_J_per_K;  ///< C
  float
      least_coupling_W_per_K;  ///< Its coupling to the next node, or to the air from the last one, is never below
                               ///< this. Above 0.
  float maximum_C;             ///< Limit of this node. 0 .. 250 degC.

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.heat_capacity_J_per_K, self.least_coupling_W_per_K, self.maximum_C);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(
        heat_capacity_J_per_K.validate(ConfigError::heat_capacity_J_per_K),
        first_error(detail::require_positive(least_coupling_W_per_K, ConfigError::coupling_W_per_K),
                    detail::require_within(maximum_C, 0.0f, 250.0f, ConfigError::maximum_C)));
  }
};

/// A chain of nodes with bounds instead of constants, heated in the first, cooled at the last:
///
/// \f[
/// C_k \, \dot T_k = K_{k-1} \, (T_{k-1} - T_k) - K_k \, (T_k - T_{k+1}), \qquad K_0 \, (T_0 - T_1) = P, \quad T_{n+1} = T_\mathrm{air}
/// \f]
///
/// The K, the air, the supply and the resistance may change at any time within their bounds; the C are constant but
/// unknown. Any node may lose heat to the air besides: only what the last one loses is counted on. A measurement
/// (`tighten()`) is not used: it would have to be one of every node.
/// @tparam node_count  2 .. 8
///
/// @snippet control_examples.cpp certified chain
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
template <uint8_t node_count>
class CertifiedChain {
  static_assert(node_count >= 2 && node_count <= 8,
                "thermopower: CertifiedChain takes 2 .. 8 nodes; one is CertifiedOneNode");

public:
  /// What is declared.
  struct Config {
    CertifiedChainNode nodes[node_count];  ///< From the heated one to the one in the air.

    /// Nothing suits every actuator: NaN, which `validate()` refuses by name until it is set.
    static Config standard() noexcept {
      const float unset = detail::not_a_number();
      Config config;
      for (uint8_t k = 0; k < node_count; ++k) {
        const CertifiedChainNode node = {{unset, unset}, unset, unset};
        config.nodes[k] = node;
      }
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      for (uint8_t k = 0; k < node_count; ++k) archive(self.nodes[k]);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      ConfigError error = ConfigError::none;
      for (uint8_t k = 0; k < node_count; ++k) error = first_error(error, nodes[k].validate());
      return error;
    }
    float hottest_C() const noexcept { return nodes[0].maximum_C; }  ///< Limit of the heated node.
  };

  /// Lengths of a step, in the form the network needs them.
  struct Travel {
    CertifiedTravel nodes[node_count];  ///< of each mean towards its neighbours
    bool is_late;  ///< Longer than a hold: outside the contract, but still carried soundly.
  };

  /// Constants once; every bound starts as hot as the safe set allows.
  CertifiedChain(const Config& config, const CertifiedUse& use) noexcept
      : fixed_(config, use), coldest_(detail::celsius_units(use.heat.coldest_C)), hold_s_(use.hold_s) {
    for (uint8_t k = 0; k < node_count; ++k) {
      relief_[k].set(use.heat, config.nodes[0].maximum_C, detail::celsius_from(fixed_.box[k]));
      bounds_[k].set(fixed_.box[k]);
    }
    set_air(use.highest_air_C);
    take_warm_winding(detail::whole_fraction());
  }

  /// A bound that cannot be met: see CertifiedTwoNode.
  static ConfigError feasible(const Config& config, const CertifiedUse& use) noexcept {
    const Fixed fixed(config, use);
    if (!fixed.is_in_range) return ConfigError::heat_when_cold_W;
    return fixed.is_box_safe() ? ConfigError::none : ConfigError::highest_air_C;
  }
  /// How long a count may act, as declared.
  float hold_s() const noexcept { return hold_s_; }

  /// Sets the bounds to what is known. @param winding_C  never below the truth of any node but the last
  /// @param body_C  never below the truth of the last; NaN starts at the limits
  void start(float winding_C, float body_C) noexcept {
    take_highest_heat();  // it was taken for other bounds
    if (!detail::is_finite(winding_C) || !detail::is_finite(body_C)) {
      for (uint8_t k = 0; k < node_count; ++k) bounds_[k].set(fixed_.box[k]);
      return;
    }
    const detail::KelvinUnits body = detail::celsius_units(body_C) + 1;
    detail::KelvinUnits hot = detail::celsius_units(winding_C) + 1;
    if (hot < body) hot = body;
    for (uint8_t k = 0; k + 1 < node_count; ++k) bounds_[k].set(hot);
    bounds_[node_count - 1].set(body + detail::part_up(hot - body, fixed_.share[node_count - 1]));
  }

  /// Prepares a step length.
  void prepare(float dt_s, Travel& travel) const noexcept {
    for (uint8_t k = 0; k < node_count; ++k)
      travel.nodes[k] = CertifiedTravel::over(fixed_.fastest_per_s[k], fixed_.slowest_per_s[k], dt_s);
    travel.is_late = dt_s > hold_s_;
  }
  /// Carries the bounds over a step during which at most `count` acted. (33) to (35)
  void advance(uint8_t count, const Travel& step, const CertifiedMeasurement&) noexcept {
    carry(count, step);
  }
  /// Carries bounds that were set at any instant of the step over the rest of it, however long that is.
  void advance_from_start(uint8_t count, const Travel& step) noexcept {
    detail::UpperBound before[node_count];
    for (uint8_t k = 0; k < node_count; ++k) before[k] = bounds_[k];
    carry(count, step);
    for (uint8_t k = 0; k < node_count; ++k) bounds_[k].raise(before[k]);
  }
  /// Carries the bounds over an unknown time of at most one hold.
  void advance_unknown(uint8_t count) noexcept {
    Travel hold;
    prepare(hold_s_, hold);
    advance_from_start(count, hold);
  }

  /// Takes note of the air from now on. @param air_C  never below the truth; below the coldest it counts as that
  void set_air(float air_C) noexcept {
    air_ = detail::celsius_units(air_C) + 1;
    if (air_ <= coldest_) air_ = coldest_ + 1;
  }
  /// Takes note of the supply until the next step; heat falls as the winding warms, and is taken where each bound will
  /// be lowest within the next hold. @param supply_squared  (supply / highest supply)^2, never below the truth
  void take_warm_winding(detail::UnitFraction supply_squared) noexcept {
    raise_by_air();  // before the heat is taken: it may lower a bound, and a colder winding draws more
    settle_heat_ = 0;
    for (uint8_t k = 0; k < node_count; ++k) {
      const detail::KelvinUnits now = bounds_[k].below();
      const detail::KelvinUnits next = k + 1 < node_count ? bounds_[k + 1].below() : coldest_;
      const detail::KelvinUnits fall = now > next ? detail::part_up(now - next, fixed_.hold[k]) : 0;
      const detail::UnitFraction relief = relief_[k].at(now - fall - coldest_);
      heat_[k] = supply_squared == detail::whole_fraction()
                     ? relief
                     : static_cast<detail::UnitFraction>(detail::part_up(relief, supply_squared));
      if (heat_[k] > settle_heat_) settle_heat_ = heat_[k];
    }
    tested_ = 0;
  }

  /// The largest count that is bearable for the horizon, and safe for ever after the next hold; 0, the least power, as long as any bound is
  /// outside of the safe set. (36)
  CertifiedCount largest() noexcept {
    CertifiedCount largest = {254, CertifiedNode::none, 0};
    limiting_ = node_count;
    Ahead ahead = {air_, 0};
    for (uint8_t k = node_count; k-- > 0;) {
      const uint8_t before = largest.count;
      fit_hold(largest, k);
      fit_horizon(largest, k, ahead);
      if (largest.count < before) limiting_ = fixed_.cause[k];
    }
    if (limiting_ < node_count) largest.node = limiting_ == 0 ? CertifiedNode::winding : CertifiedNode::body;
    tested_ = largest.count;
    return largest;
  }
  /// The largest count that is bearable for ever in this air.
  uint8_t sustainable() const noexcept {
    uint8_t count = 254;
    for (uint8_t k = 0; k < node_count; ++k) {
      const detail::KelvinUnits each = settle(k);
      const uint8_t fitting = detail::count_within(fixed_.box[k] - air_ - each, each, count);
      if (fitting < count) count = fitting;
    }
    return count;
  }

  /// True when every bound is inside the set that the least power never leaves. It stays true once it is, within the
  /// contract.
  bool is_certified() const noexcept {
    for (uint8_t k = 0; k < node_count; ++k)
      if (bounds_[k].below() > fixed_.box[k]) return false;
    return true;
  }
  /// True when no bound is above what it would be at this count for ever.
  bool is_below(uint8_t count, const CertifiedCount&) const noexcept {
    for (uint8_t k = 0; k < node_count; ++k)
      if (bounds_[k].below() > settled(k, count)) return false;
    return true;
  }

  /// Upper bound of a node, and of every one behind it. @param node  0 .. `node_count` - 1
  float node_C(uint8_t node) const noexcept { return detail::celsius_from(bounds_[node].above()); }
  float winding_C() const noexcept { return node_C(0); }            ///< Upper bound of the heated node.
  float body_C() const noexcept { return node_C(node_count - 1); }  ///< Upper bound of the last node.
  /// The node whose limit set the last answer of `largest()`; `node_count` when none did.
  uint8_t limiting_node() const noexcept { return limiting_; }

  /// Time until a node reaches its limit at a constant count, at the soonest; infinite when none does. 0 when one is
  /// there.
  float seconds_to_limit(uint8_t count) const noexcept {
    const detail::KelvinUnits over = excess(count);
    float soonest_s = static_cast<float>(INFINITY);
    for (uint8_t k = 0; k < node_count; ++k) {
      const detail::KelvinUnits end = settled(k, count) + over, now = bounds_[k].above(),
                                limit = fixed_.box[k];
      if (now >= limit) return 0.0f;
      if (end <= limit) continue;
      const float seconds =
          logf(detail::celsius_from(end - now) / detail::celsius_from(end - limit)) / fixed_.fastest_per_s[k];
      if (seconds < soonest_s) soonest_s = seconds;
    }
    return soonest_s;
  }

private:
  // What follows from the declaration alone.
  struct Fixed {
    Fixed(const Config& config, const CertifiedUse& use) noexcept {
      const float count_W = use.heat.heat_when_cold_W * (detail::whole_margin() / 255.0f);
      float lowest_J = 0.0f, highest_J = 0.0f, apart_K[node_count], onwards[node_count], back[node_count];
      float wide_K[node_count];  // `apart_K` of a little more than the least power, so that rounding has room
      for (uint8_t k = 0; k < node_count; ++k) {
        const Bounds& capacity = config.nodes[k].heat_capacity_J_per_K;
        // mu / (1 - mu) at most (31); a mean of one node has nothing behind it.
        back[k] = highest_J / capacity.lowest;
        share[k] = k == 0 ? static_cast<detail::UnitFraction>(0)
                          : detail::fraction_up(highest_J / (highest_J + capacity.lowest));
        lowest_J += capacity.lowest;
        highest_J += capacity.highest;
        // 1 / (1 - mu) of the next mean at least (31); behind the last one is the air.
        onwards[k] =
            k + 1 < node_count ? 1.0f + lowest_J / config.nodes[k + 1].heat_capacity_J_per_K.highest : 1.0f;
        const float coupling = config.nodes[k].least_coupling_W_per_K, weight = onwards[k] + back[k];
        fastest_per_s[k] = coupling * weight / lowest_J;
        slowest_per_s[k] = coupling * weight / highest_J;
        const float back_share = back[k] / weight;
        back_up[k] = detail::fraction_up(back_share);
        back_down[k] = detail::fraction_down(back_share);
        towards[k] = detail::kelvin_per_count_up(count_W / (coupling * weight));
        gain[k] = detail::kelvin_per_count_up(count_W * use.hold_s / lowest_J);
        hold[k] = detail::fraction_up(CertifiedTravel::above(fastest_per_s[k] * use.hold_s));
        horizon[k] = detail::fraction_up(
            1.0f - detail::Numeric<float>::exponential(-fastest_per_s[k] * use.horizon_s));
        apart_K[k] = (count_W / coupling + back[k] * (k == 0 ? 0.0f : apart_K[k - 1])) / onwards[k];
        wide_K[k] = (count_W * (1.0f + 1.0f / 64.0f) / coupling + rounding_K() * weight +
                     back[k] * (k == 0 ? 0.0f : wide_K[k - 1])) /
                    onwards[k];
      }
      // Where each mean settles at one count, above the air.
      float over_air_K = 0.0f;
      for (uint8_t k = node_count; k-- > 0;) {
        over_air_K += apart_K[k];
        rise[k] = detail::kelvin_per_count_up(over_air_K);
      }
      is_in_range = 255.0f * detail::celsius_from(rise[0]) < detail::highest_rise_K();
      highest_air = detail::celsius_units(use.highest_air_C) + 2;
      choose_box(config, onwards, back, wide_K);
    }

    // Eight units: more than a mean's way is rounded by.
    static constexpr float rounding_K() { return 8.0f / detail::units_per_K(); }

    // The largest box that least power never leaves, from the last node to the first (32). Whether it is one is
    // asked of whole numbers, by `is_box_safe()`.
    void choose_box(const Config& config, const float* onwards, const float* back, float* wide_K) noexcept {
      // Above what the least power settles at, in the hottest air; a node is never hotter than those before it.
      const float air_C = detail::celsius_from(highest_air);
      for (uint8_t k = node_count - 1; k-- > 0;) wide_K[k] += wide_K[k + 1];
      float room_K[node_count], least_K = 1e9f;
      for (uint8_t k = 0; k < node_count; ++k) {
        const float own_K = config.nodes[k].maximum_C - 0.0005f - air_C - wide_K[k];
        cause[k] = own_K < least_K || k == 0 ? k : cause[k - 1];
        least_K = own_K < least_K ? own_K : least_K;
        room_K[k] = least_K;
      }
      float next_K = 0.0f;
      for (uint8_t k = node_count; k-- > 1;) {
        // A little less than what the condition allows.
        const float most_K = room_K[k] + 0.999f * (onwards[k] / back[k]) * (room_K[k] - next_K);
        next_K = room_K[k];
        if (room_K[k - 1] > most_K) {
          room_K[k - 1] = most_K;
          cause[k - 1] = cause[k];
        }
      }
      for (uint8_t k = 0; k < node_count; ++k) box[k] = detail::celsius_units(air_C + wide_K[k] + room_K[k]);
    }

    // (32): at the least power no bound at its end of the box rises, and raising bounds by the air never leaves it.
    bool is_box_safe() const noexcept {
      for (uint8_t k = 0; k < node_count; ++k) {
        const detail::KelvinUnits after = k + 1 < node_count ? box[k + 1] : highest_air;
        const detail::KelvinUnits before = k > 0 ? box[k - 1] : after;
        if (box[k] < after) return false;
        if (end(k, before, after) + towards[k] > box[k]) return false;
        if (k > 0 && highest_air + detail::part_up(before - highest_air, share[k]) > box[k]) return false;
      }
      return true;
    }
    // Where a mean goes between its neighbours, without heat; not below the truth.
    detail::KelvinUnits end(uint8_t k, detail::KelvinUnits before, detail::KelvinUnits after) const noexcept {
      const detail::KelvinUnits distance = before - after;
      return after + detail::part_up(distance, distance > 0 ? back_up[k] : back_down[k]);
    }

    float fastest_per_s[node_count], slowest_per_s[node_count];
    detail::KelvinUnits towards[node_count];  // where a count's heat moves the end of a mean's way
    detail::KelvinUnits gain[node_count];     // the most that a count warms a mean by in a hold
    detail::KelvinUnits rise[node_count];     // where a mean settles at a count, above the air
    detail::KelvinUnits box[node_count];      // the safe set
    detail::KelvinUnits highest_air;
    detail::UnitFraction share[node_count];  // mu, at most
    detail::UnitFraction back_up[node_count], back_down[node_count], hold[node_count], horizon[node_count];
    uint8_t cause[node_count];  // the node whose limit set that end of the box
    bool is_in_range;
  };

  detail::KelvinUnits settle(uint8_t k) const noexcept {
    return detail::part_up(fixed_.rise[k], settle_heat_);
  }
  detail::KelvinUnits settled(uint8_t k, uint8_t count) const noexcept {
    return air_ + detail::times(settle(k), static_cast<uint8_t>(count + 1));
  }
  // The most by which any bound is above where it would settle, and what rounding makes of that.
  detail::KelvinUnits excess(uint8_t count) const noexcept {
    detail::KelvinUnits over = 0;
    for (uint8_t k = 0; k < node_count; ++k) {
      const detail::KelvinUnits own = bounds_[k].above() - settled(k, count);
      if (own > over) over = own;
    }
    return over + detail::times(3 + (fixed_.rise[0] >> 16), static_cast<uint8_t>(count + 1));
  }
  // (33): a mean cannot gain more than all of the heat, nor pass a profile that would stay as it is.
  detail::KelvinUnits most(uint8_t k, uint8_t count, detail::KelvinUnits over, bool is_short) const noexcept {
    const detail::KelvinUnits profile = settled(k, count) + over;
    if (!is_short) return profile;
    const detail::KelvinUnits gained =
        bounds_[k].above() + detail::times(gained_per_count(k), static_cast<uint8_t>(count + 1));
    return gained < profile ? gained : profile;
  }

  // (34): the end of a mean's way, its neighbours at the most they can be.
  detail::KelvinUnits end_of(uint8_t k, uint8_t count, const detail::KelvinUnits* most) const noexcept {
    const detail::KelvinUnits after = k + 1 < node_count ? most[k + 1] : air_;
    const detail::KelvinUnits before = k > 0 ? most[k - 1] : after;
    return fixed_.end(k, before, after) +
           detail::times(detail::part_up(fixed_.towards[k], heat_[k]), static_cast<uint8_t>(count + 1));
  }

  // What the count must leave of one mean for one hold: what the proof rests on. Its neighbours are at the most that a hold of the count
  // makes of them, so that all of it is linear in the count. (36)
  void fit_hold(CertifiedCount& largest, uint8_t k) const noexcept {
    const detail::KelvinUnits box = fixed_.box[k], now = bounds_[k].above(), left = box - now;
    // Outside: the least power, until all are inside.
    largest.keep(box - bounds_[k].below(), CertifiedNode::body);
    // A fraction that stands for a whole lacks 2^-16 of the way.
    const detail::KelvinUnits still = still_end(k);
    const detail::KelvinUnits held = detail::part_up(end_per_count(k), fixed_.hold[k]);
    const detail::KelvinUnits kept = left - (left >> 16) - 2 - held;
    largest.fit(kept + detail::part_down(now - still, fixed_.hold[k]), held, CertifiedNode::body);
  }
  // Where a mean is after the horizon: a temperature, and what each count adds to it.
  struct Ahead {
    detail::KelvinUnits still, per_count;
  };
  // The same for the horizon, each mean on its way to the one behind it. How authority falls; not needed for safety.
  void fit_horizon(CertifiedCount& largest, uint8_t k, Ahead& ahead) const noexcept {
    const detail::KelvinUnits now = bounds_[k].above();
    const detail::KelvinUnits apart = settle(k) - (k + 1 < node_count ? settle(k + 1) : 0);
    ahead.still = now - detail::part_down(now - ahead.still, fixed_.horizon[k]);
    ahead.per_count = detail::part_up(ahead.per_count + apart, fixed_.horizon[k]);
    largest.fit(fixed_.box[k] - ahead.still - ahead.per_count, ahead.per_count, CertifiedNode::body);
  }
  // Where a mean goes while its neighbours stay where they are, without heat.
  detail::KelvinUnits still_end(uint8_t k) const noexcept {
    const detail::KelvinUnits after = k + 1 < node_count ? bounds_[k + 1].above() : air_;
    const detail::KelvinUnits before = k > 0 ? bounds_[k - 1].above() : after;
    return fixed_.end(k, before, after);
  }
  // What a count adds to that: its own heat, and what the neighbours gain in a hold.
  detail::KelvinUnits end_per_count(uint8_t k) const noexcept {
    const detail::KelvinUnits after = k + 1 < node_count ? gained_per_count(k + 1) : 0;
    const detail::KelvinUnits before = k > 0 ? gained_per_count(k - 1) : after;
    return fixed_.end(k, before, after) + detail::part_up(fixed_.towards[k], heat_[k]);
  }
  detail::KelvinUnits gained_per_count(uint8_t k) const noexcept {
    return detail::part_up(fixed_.gain[k], heat_[k]);
  }

  // A node is taken for no colder than the air (13), and a mean for no hotter than the one before it.
  void raise_by_air() noexcept {
    bounds_[0].raise(air_);
    for (uint8_t k = 1; k < node_count; ++k) {
      bounds_[k].raise(air_ + detail::part_up(bounds_[k - 1].above() - air_, fixed_.share[k]));
      if (bounds_[k].below() > bounds_[k - 1].above()) bounds_[k].set(bounds_[k - 1].above());
    }
  }

  void take_highest_heat() noexcept {
    settle_heat_ = detail::whole_fraction();
    for (uint8_t k = 0; k < node_count; ++k) heat_[k] = detail::whole_fraction();
    tested_ = 0;
  }

  void carry(uint8_t count, const Travel& step) noexcept {
    // The winding may have cooled, and drawn more, than one hold allows for.
    if (step.is_late) take_highest_heat();
    raise_by_air();
    const bool is_kept = !step.is_late && count <= tested_ && is_certified();
    const detail::KelvinUnits over = excess(count);
    detail::KelvinUnits most[node_count];
    for (uint8_t k = 0; k < node_count; ++k) {
      most[k] = this->most(k, count, over, !step.is_late);
      // (35): the plan has shown that none of them passes the box under a larger count.
      if (is_kept && most[k] > fixed_.box[k]) most[k] = fixed_.box[k];
    }
    for (uint8_t k = 0; k < node_count; ++k) {
      const detail::KelvinUnits distance = end_of(k, count, most) - bounds_[k].below();
      bounds_[k].advance(distance, distance > 0 ? step.nodes[k].heating : step.nodes[k].cooling);
      if (is_kept && bounds_[k].below() > fixed_.box[k]) bounds_[k].set(fixed_.box[k]);
    }
  }

  Fixed fixed_;
  CertifiedRelief relief_[node_count];
  detail::UpperBound bounds_[node_count];
  detail::UnitFraction heat_[node_count];  // of the highest heat, in the balance of each mean
  detail::UnitFraction settle_heat_ = detail::whole_fraction();
  detail::KelvinUnits coldest_, air_ = 0;
  float hold_s_;
  uint8_t tested_ = 0;  // the plan's answer: no bound leaves the box at this count or a smaller one
  uint8_t limiting_ = node_count;  // which node said so
};

}  // namespace thermopower
