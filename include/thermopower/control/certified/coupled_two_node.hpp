// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "two_node.hpp"

/// @file control/certified/coupled_two_node.hpp
/// The bounds of CertifiedTwoNode, with less waste: heat and cooling of the mean are taken at one temperature of the
/// winding instead of each at its own worst, and the winding certainly leads the body while power flows, if it is known
/// how closely the two are coupled at most. Symbols and numbers in brackets are those of
/// docs/explain/certified-limiter.md.

namespace thermopower {

/// What is declared about an actuator with a winding and a body whose coupling may be known from both sides.
///
/// @snippet control_examples.cpp certified coupled
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter.
/// @ingroup control
struct CertifiedCoupledTwoNodeConfig {
  CertifiedTwoNodeConfig two_node;  ///< Everything but the next.
  float
      highest_coupling_W_per_K;  ///< K is never above this. Not below `two_node.least_coupling_W_per_K`, finite.

  /// Nothing suits every motor: NaN, which `validate()` refuses by name until it is set.
  static CertifiedCoupledTwoNodeConfig standard() noexcept {
    const CertifiedCoupledTwoNodeConfig config = {CertifiedTwoNodeConfig::standard(), detail::not_a_number()};
    return config;
  }
  /// The constants of a `TwoNodeThermalModel`, each known to a fraction. @param fraction  0.2 for +-20 %
  template <class ThermalConfig>
  static CertifiedCoupledTwoNodeConfig around(const ThermalConfig& thermal, float fraction,
                                              float maximum_winding_C, float maximum_body_C) noexcept {
    const CertifiedCoupledTwoNodeConfig config = {
        CertifiedTwoNodeConfig::around(thermal, fraction, maximum_winding_C, maximum_body_C),
        thermal.coupling_W_per_K * (1.0f + fraction)};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.two_node, self.highest_coupling_W_per_K);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    // Asked this way round so that NaN is refused.
    return first_error(two_node.validate(), highest_coupling_W_per_K >= two_node.least_coupling_W_per_K
                                                ? ConfigError::none
                                                : ConfigError::coupling_W_per_K);
  }
  float hottest_C() const noexcept { return two_node.hottest_C(); }  ///< Limit of the heated node.
};

/// `CertifiedTwoNode` that grants more for the same declaration, and more again for a highest coupling. It costs 53 bytes
/// of RAM more and, where the heat is taken anew, divisions. It carries a lower bound, too: of the winding's lead over
/// the mean. A measurement (`tighten()`) sets that to nothing, because a motor that is colder than thought may have had
/// no power.
///
/// @snippet control_examples.cpp certified coupled
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
class CertifiedCoupledTwoNode : public CertifiedTwoNode {
public:
  typedef CertifiedCoupledTwoNodeConfig Config;  ///< What is declared.

  /// Lengths of a step, in the form the network needs them.
  struct Travel : CertifiedTwoNode::Travel {
    CertifiedTravel lead;  ///< Falling goes as `heating`, rising as `cooling`: a lower bound errs the
                           ///< other way.
    detail::FineFraction mean_rise;  ///< of a mean that warms (41)
  };

  /// Constants once; both bounds start at the limits, and the lead at nothing.
  CertifiedCoupledTwoNode(const Config& config, const CertifiedUse& use) noexcept
      : CertifiedTwoNode(config.two_node, use) {
    const Bounds& winding = config.two_node.winding_heat_capacity_J_per_K;
    const Bounds& body = config.two_node.body_heat_capacity_J_per_K;
    const float body_share = body.lowest / (winding.highest + body.lowest);  // 1 - mu, smallest
    const float rate = config.highest_coupling_W_per_K / body_share;
    if (detail::is_finite(rate)) {
      falling_per_s_ = rate / winding.lowest;
      rising_per_s_ = rate / winding.highest;
      lead_per_count_ = detail::rounded_down(use.heat.heat_when_cold_W * (1.0f / 255.0f) * body_share *
                                             (detail::units_per_K() / rate));
    }
    hold_lead_ = detail::fraction_up(CertifiedTravel::above(falling_per_s_ * use.hold_s));
    hold_mean_ = detail::fraction_up(mean_rise(use.hold_s));
    ohm_.set(use.heat, config.two_node.maximum_winding_C);
    taken_supply_ = 0;  // the base took the heat by its own reckoning
    take_warm_winding(detail::whole_fraction());
  }

  /// A bound that cannot be met: see CertifiedTwoNode. Besides, a body that settles within a hold is refused.
  static ConfigError feasible(const Config& config, const CertifiedUse& use) noexcept {
    const Bounds& winding = config.two_node.winding_heat_capacity_J_per_K;
    const Bounds& body = config.two_node.body_heat_capacity_J_per_K;
    const float body_share = body.lowest / (winding.highest + body.lowest);
    const float settled_s =
        body_share * (winding.lowest + body.lowest) / config.two_node.least_conductance_W_per_K;
    if (!(use.hold_s < 0.9f * settled_s)) return ConfigError::hold_s;
    return CertifiedTwoNode::feasible(config.two_node, use);
  }

  /// Sets the bounds to what is known. See CertifiedTwoNode.
  void start(float winding_C, float body_C) noexcept {
    CertifiedTwoNode::start(winding_C, body_C);
    forget_lead();
  }

  /// Prepares a step length; only a length that changed costs anything.
  void prepare(float dt_s, Travel& travel) const noexcept {
    CertifiedTwoNode::prepare(dt_s, travel);
    travel.lead = CertifiedTravel::over(falling_per_s_, rising_per_s_, dt_s);
    // Not farther than what was planned: CertifiedTravel::end_at().
    const detail::FineFraction whole_hold = static_cast<detail::FineFraction>(hold_mean_) << 16;
    const detail::FineFraction rise = detail::fine_up(mean_rise(dt_s));
    travel.mean_rise = rise < whole_hold ? rise : whole_hold;
  }

  /// Carries the bounds over a step during which at most `count` acted. (17) to (20), (38), (40), (41)
  /// @param measured  known of one instant of the step, whichever it was. (30)
  void advance(uint8_t count, const Travel& step, const CertifiedMeasurement& measured) noexcept {
    if (step.is_late) {  // the winding may lead by nothing by now
      CertifiedTwoNode::advance(count, step, measured);
      forget_lead();
      return;
    }
    const Hull passed = carry(count, step);
    // A unit for what a part of the way that cannot be a whole leaves.
    const detail::KelvinUnits distance = settled_lead(count, passed.winding) - lead_.above() - 1;
    lead_.advance(distance, distance > 0 ? step.lead.cooling : step.lead.heating);
    if (!measured.is_any()) return;
    take_in(count, step, measured, passed);
    forget_lead();
  }

  /// Carries bounds that were set at any instant of the step over the rest of it, however long that is. Of the lead nothing is known.
  void advance_from_start(uint8_t count, const Travel& step) noexcept {
    const detail::UpperBound winding = winding_, mean = mean_;
    if (step.is_late) CertifiedTwoNode::advance(count, step, CertifiedMeasurement());
    else carry(count, step);
    winding_.raise(winding);
    mean_.raise(mean);
    forget_lead();
  }
  /// Carries the bounds over an unknown time of at most one hold.
  void advance_unknown(uint8_t count) noexcept {
    const detail::UpperBound winding = winding_, mean = mean_;
    Travel hold;
    prepare(hold_s(), hold);
    carry(count, hold);
    winding_.raise(winding);
    mean_.raise(mean);
    lead_.set(lead_after_hold(lead_.below()));
  }

  /// Takes note of the air from now on. See CertifiedTwoNode. Air that is warmer than before may have warmed the body.
  void set_air(float air_C) noexcept {
    const detail::KelvinUnits before = base_;
    CertifiedTwoNode::set_air(air_C);
    const detail::KelvinUnits warmer = base_ - before;
    if (warmer > 0) lead_.set(lead_.below() > warmer ? lead_.below() - warmer : 0);
  }

  /// Takes note of the supply until the next step. See CertifiedTwoNode. Heat is taken where the winding is least warm
  /// beside the mean, and where it is warmest. (39)
  void take_warm_winding(detail::UnitFraction supply_squared) noexcept {
    const detail::KelvinUnits lead = lead_.below() > 0 ? lead_.below() : 0;
    const Room room = this->room();
    const detail::KelvinUnits apart = room.winding - room.mean;
    if (lead > taken_lead_ - lead_slack_units() && lead < taken_lead_ + lead_slack_units() &&
        lead_now_ <= apart && is_heat_taken(supply_squared))
      return;
    taken_lead_ = lead;
    // Not more than what the bounds are apart: beyond that no winding is, and the mean would rise without power.
    // Of two holds: a cut whose time is not known may follow a step that is known.
    const detail::KelvinUnits least =
        lead_after_hold(lead_after_hold(lead > lead_slack_units() ? lead - lead_slack_units() : 0));
    take_at(least < apart ? least : apart, supply_squared);
  }

  /// The largest count that is bearable for the horizon, and safe for ever after the next hold. (21) to (24), (42)
  CertifiedCount largest() const noexcept {
    const Room room = this->room();
    CertifiedCount largest = {254, CertifiedNode::none, room.apart};
    const detail::KelvinUnits rise = across_now_ + soak_now_;
    const detail::KelvinUnits spare_warmest = room.mean - room.weighted,
                              spare_coolest = room.mean - detail::part_up(room.mean + lead_now_, weight_);
    // Outside of the safe set: the least power, until both are inside.
    largest.keep(room.winding_left + rounding_units(), CertifiedNode::winding);
    largest.keep(room.mean_left + rounding_units(), CertifiedNode::body);
    // Horizon: how authority falls. Not needed for safety.
    const detail::KelvinUnits lost_warmest =
        detail::part_down(room.mean - detail::part_up(room.mean + gap_, weight_), horizon_body_);
    const detail::KelvinUnits lost_coolest = detail::part_down(spare_coolest, horizon_body_);
    fit_horizon(largest, room, lost_warmest, to_air_hot_ + detail::part_up(rise, weight_));
    fit_horizon(largest, room, lost_coolest, to_air_now_);
    // One hold: what the proof rests on.
    const EndSizes size = end_sizes();
    largest.fit(room.winding_left + detail::part_down(room.apart, hold_winding_), size.held_winding,
                CertifiedNode::winding);
    largest.fit(room.winding_left + room.apart, size.jump, CertifiedNode::winding);
    largest.fit(room.mean_left + detail::part_down(spare_warmest, hold_mean_), size.held_warmest,
                CertifiedNode::body);
    largest.fit(room.mean_left + detail::part_down(spare_coolest, hold_mean_), size.held_coolest,
                CertifiedNode::body);
    largest.fit(room.mean_left + spare_warmest, size.fed, CertifiedNode::body);
    return largest;
  }

  /// The largest count that is bearable for ever in this air: with no more lead than it would leave. (28)
  uint8_t sustainable() const noexcept {
    uint8_t count = 254;
    for (uint8_t again = 0; again < 8; ++again) {
      const uint8_t less = after(count).bearable();
      if (less >= count) return count;
      count = less;
    }
    return after(0).bearable();
  }
  /// Time until a node reaches its limit at a constant count; infinite when none does. 0 when one is there.
  float seconds_to_limit(uint8_t count) const noexcept { return after(count).seconds_at(count); }

  /// Lower bound of what the winding is hotter by than the mean of winding and body, kelvin.
  float lead_K() const noexcept { return lead_.below() > 0 ? detail::celsius_from(lead_.below()) : 0.0f; }

private:
  // Heat of a winding whose resistance rises in a straight line, as a fraction of the heat at the coldest: from above
  // and from below. A chord would lose what the lead gains.
  class Ohm {
  public:
    void set(const HeatBounds& heat, float hot_C) noexcept {
      const float span_K = hot_C - heat.coldest_C;
      const float per_K = (heat.heat_when_cold_W / heat.heat_when_hot_W - 1.0f) / span_K;
      const int32_t fine =
          detail::rounded_down(per_K * 4194304.0f);  // 2^-22 per kelvin: up to 1.5 % per kelvin
      per_K_ = static_cast<uint16_t>(fine < 0xfff0L ? fine : 0xfff0L);
      is_exact_ = fine < 0xfff0L && span_K < 255.0f;
      const int32_t end = detail::rounded_down(span_K * 256.0f);
      end_ = static_cast<uint16_t>(end < 255L * 256L ? end : 255L * 256L);
    }
    detail::UnitFraction above(detail::KelvinUnits over_coldest) const noexcept {
      if (over_coldest <= 0) return detail::whole_fraction();
      const uint32_t over = static_cast<uint32_t>(over_coldest) >> 10;  // 1/256 K
      const uint16_t coarse = over < end_ ? static_cast<uint16_t>(over) : end_;
      const uint32_t heat = 0xffffffffu / (65536u + (detail::product(coarse, per_K_) >> 14)) + 1u;
      return heat < 0xffffu ? static_cast<detail::UnitFraction>(heat) : detail::whole_fraction();
    }
    detail::UnitFraction below(detail::KelvinUnits over_coldest) const noexcept {
      if (!is_exact_) return 0;
      // A unit and more above in each: rounded_down() took up to two of a small number, and 2^-17 of a large one.
      const uint32_t over = over_coldest > 0 ? static_cast<uint32_t>(over_coldest) >> 10 : 0u;
      const uint16_t coarse = static_cast<uint16_t>((over < end_ ? static_cast<uint16_t>(over) : end_) + 3u);
      return static_cast<detail::UnitFraction>(
          0xffffffffu / (65536u + (detail::product(coarse, static_cast<uint16_t>(per_K_ + 3u)) >> 14) + 1u));
    }

  private:
    uint16_t per_K_ = 0, end_ = 0;
    bool is_exact_ = false;
  };

  // Not below (1 - exp(-(1 - mu) x)) / (1 - mu), where x is the time in parts of what the body takes (41).
  float mean_rise(float dt_s) const noexcept {
    const float x = fastest_body_per_s_ * dt_s, body_share = 1.0f - share();
    return x < 1.0f ? x * (1.0f - body_share * x * (0.5f - body_share * x * (1.0f / 6.0f))) : 1.0f;
  }

  // As in CertifiedTwoNode, but for the mean's way.
  Hull carry(uint8_t count, const Travel& step) noexcept {
    mean_.raise(base_ + least_mean_);
    mean_.raise(base_ + detail::part_up(winding_.above() - base_, weight_));
    const detail::KelvinUnits soaked = mean_.above() + gap_ + detail::times(soak_now_, count);
    winding_.raise(soaked);
    const detail::KelvinUnits before = winding_.above();
    const detail::KelvinUnits winding_distance =
        soaked + detail::times(across_now_, count) - winding_.below();
    winding_.advance(winding_distance, winding_distance > 0 ? step.winding.heating : step.winding.cooling);
    const detail::KelvinUnits hottest = winding_.above() > before ? winding_.above() : before;
    const detail::KelvinUnits floor = base_ + detail::part_up(hottest - base_, weight_);
    mean_.raise(floor);
    const detail::KelvinUnits mean_start = mean_.above();
    const detail::KelvinUnits led = mean_start + lead_now_, coolest = led < hottest ? led : hottest;
    // (40): the winding at its warmest, and at its coolest.
    const detail::KelvinUnits warmest_distance = floor + detail::times(to_air_hot_, count) - mean_.below();
    const detail::KelvinUnits coolest_distance =
        base_ + detail::part_up(coolest - base_, weight_) + detail::times(to_air_now_, count) - mean_.below();
    const detail::KelvinUnits distance =
        warmest_distance > coolest_distance ? warmest_distance : coolest_distance;
    mean_.advance(distance, distance > 0 ? step.mean_rise : step.body.cooling);
    const Hull passed = {hottest, mean_.above() > mean_start ? mean_.above() : mean_start};
    return passed;
  }

  // Kelvin per count in the conditions of largest() that hold for one hold.
  struct EndSizes {
    detail::KelvinUnits held_winding, jump, held_warmest, held_coolest, fed;
  };
  EndSizes end_sizes() const noexcept {
    EndSizes size;
    size.held_winding = detail::part_up(across_now_ + soak_now_, hold_winding_);
    size.jump = soak_now_ + detail::part_up(across_now_, hold_winding_);
    const detail::KelvinUnits fed = detail::part_up(size.jump, weight_);
    size.held_warmest = detail::part_up(fed + to_air_hot_, hold_mean_);
    size.held_coolest = detail::part_up(to_air_now_, hold_mean_);
    size.fed = fed + detail::part_up(to_air_now_, hold_mean_);
    return size;
  }
  void fit_horizon(CertifiedCount& largest, const Room& room, detail::KelvinUnits lost,
                   detail::KelvinUnits settled) const noexcept {
    const detail::KelvinUnits slow = detail::part_up(settled, horizon_body_);
    largest.fit(room.mean_left + lost, slow, CertifiedNode::body);
    largest.fit(room.winding_left + detail::part_down(room.apart + lost, horizon_winding_),
                detail::part_up(slow + across_now_ + soak_now_, horizon_winding_), CertifiedNode::winding);
  }
  // As CertifiedTwoNode::sustainable(), with the winding at its warmest and at its coolest.
  uint8_t bearable() const noexcept {
    const detail::KelvinUnits mean = mean_limit_ - base_, winding = winding_limit_ - base_;
    const detail::KelvinUnits rise = across_now_ + soak_now_, lead = detail::part_up(lead_now_, weight_);
    const detail::KelvinUnits settled = to_air_hot_ + detail::part_up(rise, weight_);
    const detail::KelvinUnits of_winding = winding - detail::part_up(winding, weight_) - gap_;
    CertifiedCount count = {254, CertifiedNode::none, 0};
    count.fit(mean - detail::part_up(mean + gap_, weight_), settled, CertifiedNode::body);
    count.fit(of_winding, settled + rise, CertifiedNode::winding);
    count.fit(mean - detail::part_up(mean, weight_) - lead, to_air_now_, CertifiedNode::body);
    count.fit(of_winding - lead, to_air_now_ + rise, CertifiedNode::winding);
    return count.count;
  }
  // As CertifiedTwoNode::seconds_to_limit(), to the higher of two ends.
  float seconds_at(uint8_t count) const noexcept {
    const Room room = this->room();
    const float apart = detail::celsius_from(gap_ + detail::times(across_now_ + soak_now_, count));
    const float warmest = detail::celsius_from(detail::times(to_air_hot_, count)) + share() * apart;
    const float coolest =
        detail::celsius_from(detail::times(to_air_now_, count)) + share() * detail::celsius_from(lead_now_);
    const float settled = (warmest > coolest ? warmest : coolest) / (1.0f - share());
    const float mean = detail::celsius_from(room.mean), winding = detail::celsius_from(room.winding);
    const float winding_limit = detail::celsius_from(room.winding + room.winding_left);
    const float seconds[3] = {
        crossing_s(mean, settled, detail::celsius_from(room.mean + room.mean_left), fastest_body_per_s_),
        crossing_s(winding, mean + apart, winding_limit, fastest_winding_per_s_),
        crossing_s(mean, settled, winding_limit - apart, fastest_body_per_s_)};
    const float either = seconds[0] < seconds[1] ? seconds[0] : seconds[1];
    return either < seconds[2] ? either : seconds[2];
  }

  // Not above the lead that a count keeps in the end, of a winding that is never hotter than this (38).
  detail::KelvinUnits settled_lead(uint8_t count, detail::KelvinUnits winding) const noexcept {
    const detail::UnitFraction heat =
        static_cast<detail::UnitFraction>(detail::part_down(ohm_.below(winding - coldest_), taken_supply_));
    // The least power, too, which the counts leave out.
    const detail::KelvinUnits one = detail::part_down(lead_per_count_, heat);
    return detail::times(one, count) + one;
  }
  detail::KelvinUnits lead_after_hold(detail::KelvinUnits lead) const noexcept {
    if (lead <= 0 || hold_lead_ == detail::whole_fraction()) return 0;
    return lead - detail::part_up(lead, hold_lead_);
  }
  static constexpr detail::KelvinUnits lead_slack_units() { return 16384; }  // a sixteenth of a kelvin
  void forget_lead() noexcept {
    lead_.set(0);
    lead_now_ = 0;
    take(detail::whole_fraction(), detail::whole_fraction());
    to_air_hot_ = to_air_now_;
    taken_supply_ = 0;  // to be taken anew
  }
  void take_at(detail::KelvinUnits lead, detail::UnitFraction supply_squared) noexcept {
    const Hull coldest = coldest_in_hold(supply_squared);
    const detail::UnitFraction coolest = supply(ohm_.above(coldest.mean + lead), supply_squared);
    const detail::UnitFraction warmest = supply(ohm_.above(coldest.winding), supply_squared);
    take(warmest, coolest);
    lead_now_ = lead;
    // The warmest is not cooler than the coolest, whatever both fall by within a hold.
    to_air_hot_ = detail::part_up(to_air_, warmest < coolest ? warmest : coolest);
  }
  // The network as it will be when a count has acted for long: with no more lead than that keeps.
  CertifiedCoupledTwoNode after(uint8_t count) const noexcept {
    CertifiedCoupledTwoNode then = *this;
    const detail::KelvinUnits kept = settled_lead(count, winding_limit_);
    if (taken_supply_ != 0 && kept < lead_now_) then.take_at(kept > 0 ? kept : 0, taken_supply_);
    return then;
  }

  float falling_per_s_ = 0.0f, rising_per_s_ = 0.0f;
  detail::KelvinUnits lead_per_count_ = 0;
  detail::KelvinUnits taken_lead_ = 0;  // for which the heat was taken
  detail::KelvinUnits lead_now_ = 0,
                      to_air_hot_ = 0;  // until the next step: the least lead, and heat at the most
  detail::UnitFraction hold_lead_, hold_mean_;
  Ohm ohm_;
  detail::UpperBound lead_;  // a lower one here: its changes are added without any rounding
};

}  // namespace thermopower
