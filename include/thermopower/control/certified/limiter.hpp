// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "chain.hpp"
#include "coupled_two_node.hpp"
#include "one_node.hpp"
#include "two_node.hpp"
#include "../../air_celsius.hpp"
#include "../detail/composition.hpp"
#include "../detail/policy_call.hpp"

/// @file control/certified/limiter.hpp
/// A limiter that is right by proof: no node passes its limit, whatever the actuator's true constants inside
/// the declared bounds.
///
/// | network | when to take it |
/// |---|---|
/// | `CertifiedTwoNode` | the winding is much faster than the housing, or both have limits of their own |
/// | `CertifiedCoupledTwoNode` | the same, on a chip with RAM to spare: more power for the same bounds, and more again where a highest coupling is known |
/// | `CertifiedOneNode` | only one time constant is known |
/// | `CertifiedChain<n>` | 2 to 8 nodes in a row, each with a limit of its own: winding, stator, housing, bracket |
///
/// | heat | POWER p gives at most | when to take it |
/// |---|---|---|
/// | `LinearHeat` | p/255 of the heat at full POWER | Ohm's law: V_rms^2 is proportional to POWER |
/// | `SquareHeat` | (p/255)^2 of it | a current that rises with V_rms^3 or more: the thesis motors |
///
/// The proof, and what happens outside the bounds: docs/explain/certified-limiter.md.

namespace thermopower {

/// Heat in proportion to POWER.
///
/// @snippet control_examples.cpp certified one node
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
struct LinearHeat {
  /// Counts of 1/255 of the full heat. @param power  1 .. 255
  static uint8_t count(uint8_t power) noexcept { return power; }
  /// The largest POWER that gives no more than this. @param count  1 .. 255
  static uint8_t power(uint8_t count) noexcept { return count; }
};

/// Heat that rises at least with the square of POWER.
///
/// @snippet control_examples.cpp certified one node
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
struct SquareHeat {
  /// @copydoc LinearHeat::count
  static uint8_t count(uint8_t power) noexcept {
    const uint16_t square = static_cast<uint16_t>(static_cast<uint16_t>(power) * power);
    return static_cast<uint8_t>((square + 254u) / 255u);
  }
  /// @copydoc LinearHeat::power
  static uint8_t power(uint8_t count) noexcept {
    uint8_t power = 0;
    for (uint8_t step = 128; step != 0; step = static_cast<uint8_t>(step >> 1)) {
      const uint8_t next = static_cast<uint8_t>(power + step);
      if (static_cast<uint16_t>(static_cast<uint16_t>(next) * next) <= count * 255u) power = next;
    }
    return power;
  }
};

/// Grants the largest power with which no node exceeds its limit, whatever the true constants within the
/// bounds.
/// @tparam Network  `CertifiedTwoNode`, `CertifiedCoupledTwoNode`, `CertifiedOneNode` or `CertifiedChain<n>`
/// @tparam Heat     `LinearHeat` or `SquareHeat`
///
/// Guarantees, for every actuator, air and supply within the bounds and every demand, when each plan comes at
/// most `hold_s` after the last, from any start inside the safe set (`State::is_certified`): no limit is
/// exceeded, ever. Also: the result does not depend on the loop rate; at a constant demand above the ceiling,
/// in constant air, the power settles and stays (no dithering); a fault gives the least power and forgets
/// nothing.
///
/// @snippet control_examples.cpp certified two nodes
/// How to: @ref choose_a_limiter, @ref explain_certified_limiter. Menu: @ref policies.
/// @ingroup control
template <class Network = CertifiedTwoNode, class Heat = LinearHeat>
class CertifiedLimiter {
  static_assert(
      detail::IsCertifiedNetwork<Network>::value,
      "thermopower: the first parameter of CertifiedLimiter must be a network: CertifiedTwoNode, CertifiedOneNode or CertifiedChain");

  static_assert(
      detail::IsHeatCount<Heat>::value,
      "thermopower: the second parameter of CertifiedLimiter must be LinearHeat or SquareHeat, or a type with static count(power) and power(count)");

public:
  /// What is declared, and how gently authority falls.
  struct Config {
    typename Network::Config network;  ///< Bounds and limits of the actuator.
    CertifiedUse use;                  ///< Bounds of its surroundings.
    float air_error_K;  ///< The air may be warmer than measured by this until the next plan, >= 0.

    /// No bounds suit every actuator: `validate()` refuses these by name until they are set. Hold 0.1 s,
    /// horizon 30 s, air +-5 K.
    static Config standard() noexcept {
      const float unset = detail::not_a_number();
      const Config config = {Network::Config::standard(),
                             {{unset, 1.0f, unset, unset, unset, 0.0f}, unset, 0.1f, 30.0f, 1, 0},
                             5.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.network, self.use, self.air_error_K);
    }
    /// First constant out of its range, or ConfigError::none. `highest_air_C` is also refused when the
    /// actuator would be too hot in that air at the least power: no limiter could help.
    ConfigError validate() const noexcept {
      return is_error(validate_fields()) ? validate_fields() : Network::feasible(network, use);
    }
    /// The same, but for whether the bounds can be met together.
    ConfigError validate_fields() const noexcept {
      if (is_error(first_error(network.validate(), use.heat.validate())))
        return first_error(network.validate(), use.heat.validate());
      if (is_error(detail::require_within(use.heat.coldest_C, -60.0f, network.hottest_C() - 1.0f,
                                          ConfigError::coldest_C)))
        return ConfigError::coldest_C;
      if (is_error(detail::require_within(use.highest_air_C, use.heat.coldest_C, 200.0f,
                                          ConfigError::highest_air_C)))
        return ConfigError::highest_air_C;
      if (is_error(detail::require_positive(use.hold_s, ConfigError::hold_s)) || use.hold_s > 10.0f)
        return ConfigError::hold_s;
      if (!detail::is_finite(use.horizon_s) || use.horizon_s < use.hold_s) return ConfigError::horizon_s;
      if (use.every < 1 || use.phase >= use.every) return ConfigError::every;
      if (is_error(detail::require_not_negative(air_error_K, ConfigError::air_error_K)))
        return ConfigError::air_error_K;
      return ConfigError::none;
    }
  };

  /// What the limiter decides on.
  struct Inputs {
    uint8_t demand;           ///< Power parameter asked for.
    float supply_V;           ///< Measured supply; outside of its declared range it counts as the highest.
    AirCelsius<float> air_C;  ///< Measured air; NaN, or left out, counts as the highest.
  };

  /// What one logs.
  struct State {
    float winding_upper_C;   ///< No true winding is hotter.
    float body_upper_C;      ///< No true body is hotter, nor will be if power is cut now.
    uint8_t ceiling;         ///< Largest power that would be granted.
    uint8_t sustainable;     ///< Largest power that is bearable for ever in this air.
    CertifiedNode node;      ///< Which limit sets the ceiling.
    float headroom_W;        ///< Heat that could be added to the power granted.
    float seconds_to_limit;  ///< At the power granted, in the worst case; infinite when no limit is ever
                             ///< reached.
    bool
        is_certified;  ///< The last plan came in time, and the bounds are where the least power keeps them below
    ///< the limits for ever. False after a start that was too hot already, and at a late plan;
    ///< the guarantee begins when this turns true.
    uint16_t late_steps;  ///< Times longer than `hold_s` from plan to plan: the guarantee did not cover them.
                          ///< Stops at 65535.
  };

  /// Starts at the limits; say what is known better with `start()`.
  /// @param config  constants; ask `validate()` once
  explicit CertifiedLimiter(const Config& config = Config::standard()) noexcept
      : network_(config.network, config.use),
        highest_air_C_(config.use.highest_air_C),
        air_error_K_(config.air_error_K),
        per_supply_V_(config.use.heat.supply_error < 1.0f
                          ? (65536.0f * (1.0f + detail::float_margin())) *
                                (1.0f + config.use.heat.supply_error) / config.use.heat.highest_supply_V
                          : detail::not_a_number()),
        count_W_(config.use.heat.heat_when_hot_W * (1.0f / 255.0f)),
        least_squared_(least_squared(config.use.heat)),
        config_error_(config.validate()),
        every_(config.use.every),
        turn_(config.use.phase),
        is_limiting_(false),
        is_start_new_(false) {
    network_.prepare(0.0f, travel_);
  }

  /// First constant out of its range, or ConfigError::none. Anything but none keeps the power at its least.
  ConfigError validate() const noexcept { return config_error_; }

  /// Says how warm the actuator is, when that is known better than "at its limits".
  /// @param winding_C, body_C  never below the truth. NaN: at the limits. Below the air counts as the air.
  /// Call it before or after a step, the result is the same: the time that the next step is told may lie before or after this instant.
  void start(float winding_C, float body_C) noexcept {
    network_.start(winding_C, body_C);
    measured_ = CertifiedMeasurement();
    forget_time();
    is_start_new_ = true;
  }
  /// The same, with the air measured now: as in a step it may be warmer by `air_error_K`, until the first plan.
  /// Without it the air counts as its highest until then, and a cold actuator as warm as that would have made it.
  /// @param air_C  measured air; NaN: its highest
  void start(float winding_C, float body_C, float air_C) noexcept {
    start(winding_C, body_C);
    observe_air(air_C);
  }
  /// Says how hot the actuator can be at most after a loss of power or a reset.
  /// @param bounds  has `winding_upper_C` and `body_upper_C`, such as StartBounds
  template <class Bounds>
  void start(const Bounds& bounds) noexcept {
    start(bounds.winding_upper_C, bounds.body_upper_C);
  }
  /// Lowers the bounds to what was measured at one instant since the last step: call it before the step or after
  /// the one before, the result is the same. The next plan takes it for measured at the worst instant of the time
  /// that it covers. Of several calls the last counts, because two readings of different instants prove nothing
  /// together; a fault whose time is not known (`cut()`) forgets it.
  /// @param winding_upper_C, body_upper_C  never below the truth: the reading plus its largest error; with an
  ///                                       observer's estimate plus k sigmas the guarantee holds as often as that
  ///                                       is above the truth: `SensorGuard::upper()`,
  ///                                       `GuardedCelsius::winding_upper_of()`. `GuardedCelsius()` where nothing was
  ///                                       measured
  void tighten(const GuardedCelsius& winding_upper_C, const GuardedCelsius& body_upper_C) noexcept {
    measured_ = CertifiedMeasurement(winding_upper_C, body_upper_C);
  }

  /// Says that a larger power than the one granted may have acted since the last step; call it before `step()`.
  void acted(uint8_t power) noexcept {
    const uint8_t count =
        static_cast<uint8_t>(Heat::count(power < least_power() ? least_power() : power) - 1);
    if (count > acted_) acted_ = count;
  }
  /// An axis need not look whether time stands still: `step()` does.
  static constexpr bool notices_standing_time() { return true; }
  /// How long a power may act before the next plan, as declared.
  float hold_s() const noexcept { return network_.hold_s(); }

  /// @param dt_s  time since the last step, during which the power granted then acted, >= 0
  LimitedPower step(const Inputs& inputs, float dt_s) noexcept {
    if (is_error(config_error_)) return cut(LimitReason::config_invalid, inputs.demand);
    // Asked by bits, which are cheap on a small chip.
    const bool is_time_told = detail::is_finite_positive(dt_s);
    if (!is_time_told && !(dt_s == 0.0f)) return cut(LimitReason::time_invalid, inputs.demand);
    if (is_time_told) stood_ = 0;
    else if (stands_still()) {
      const LimitedPower least = cut(LimitReason::time_stands_still, inputs.demand);
      stood_ = 255;  // until a time is told
      return least;
    }
    const uint8_t wanted =
        static_cast<uint8_t>(Heat::count(inputs.demand < least_power() ? least_power() : inputs.demand) - 1);
    if (is_time_told) pass(dt_s);
    if (acting_ > acted_) acted_ = acting_;
    // A step that is late by itself leaves nothing to wait for, nor does a ceiling that was granted for other bounds.
    bool is_turn =
        detail::magnitude_bits(dt_s) > detail::magnitude_bits(hold_s()) || (is_start_new_ && ceiling_ > 0);
    if (++turn_ >= every_) {
      turn_ = 0;
      is_turn = true;
    }
    if (is_turn) plan(inputs, wanted);
    is_limiting_ = wanted > ceiling_;
    acting_ = is_limiting_ ? ceiling_ : wanted;

    LimitedPower granted = {inputs.demand, LimitReason::none};
    if (is_limiting_) {
      granted.power = ceiling();
      granted.reason = node_ == CertifiedNode::winding ? LimitReason::winding_limit : LimitReason::body_limit;
    }
    return granted;
  }

  /// Least power for a reason found elsewhere, a known time after the last step.
  LimitedPower cut_after(LimitReason reason, uint8_t demand, float dt_s) noexcept {
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return cut(reason, demand);
    if (!is_error(config_error_)) {
      if (dt_s > 0.0f) pass(dt_s);
      if (acting_ > acted_) acted_ = acting_;
      advance();
    }
    return least(reason, demand);
  }
  /// The same when the time is not known: the largest power since the last plan is assumed to have acted until `hold_s` after it, and
  /// nothing to have cooled.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    if (!is_error(config_error_)) {
      measured_ = CertifiedMeasurement();
      // What is known already to be more than a hold is late by itself; what is less is a part of the hold.
      if (pending() > hold_s()) advance();
      network_.advance_unknown(acting_ > acted_ ? acting_ : acted_);
      is_start_new_ = false;
      stood_ = 0;  // a hold is counted, whatever the time was
      forget_time();
    }
    return least(reason, demand);
  }
  /// What it needs of an axis.
  static Inputs read(const AxisFacts& facts) noexcept {
    const Inputs inputs = {facts.demand, facts.supply_V, facts.air_C};
    return inputs;
  }

  /// Highest power granted now, 1 .. 255.
  uint8_t ceiling() const noexcept { return Heat::power(static_cast<uint8_t>(ceiling_ + 1)); }

  /// What one logs, computed when asked for.
  State state() const noexcept {
    if (is_error(config_error_)) {
      const float unknown = detail::not_a_number();
      const State refused = {unknown, unknown, least_power(), least_power(), CertifiedNode::none, 0.0f, 0.0f,
                             false,   0};
      return refused;
    }
    const State state = {network_.winding_C(),
                         network_.body_C(),
                         ceiling(),
                         Heat::power(static_cast<uint8_t>(network_.sustainable() + 1)),
                         node_,
                         static_cast<float>(ceiling_ - acting_) * count_W_,
                         network_.seconds_to_limit(acting_),
                         is_certified(),
                         late_steps_};
    return state;
  }
  bool is_certified() const noexcept {
    return !travel_.is_late && network_.is_certified();
  }                                                                        ///< As in State, without the rest.
  float winding_upper_C() const noexcept { return network_.winding_C(); }  ///< As in State, without the rest.
  float body_upper_C() const noexcept { return network_.body_C(); }        ///< As in State, without the rest.
  const Network& network() const noexcept { return network_; }             ///< The bounds themselves.

private:
  // Steps that are told no time are taken to be as long as the last that was told one; of none before them, the second is too many.
  bool stands_still() noexcept {
    if (stood_ < 255) ++stood_;
    return stood_ > 1 && (!(each_s_ > 0.0f) || each_s_ * static_cast<float>(stood_) > hold_s());
  }
  // Between plans only the time and the largest count that acted are kept; of steps of one length only their
  // number, which is never above `turn_`, and that is below `every_`: it fits.
  void pass(float dt_s) noexcept {
    if (!detail::is_same(dt_s, each_s_)) {
      travelled_ = 0;
      pending_s_ = pending();
      each_s_ = dt_s;
      steps_ = 0;
    }
    ++steps_;
  }
  float pending() const noexcept {
    if (steps_ == 0) return pending_s_;
    // Nearly always one step and nothing before it.
    const float steps_s = steps_ == 1 ? each_s_ : each_s_ * static_cast<float>(steps_);
    return detail::is_same(pending_s_, 0.0f) ? steps_s : pending_s_ + steps_s;
  }

  void advance() noexcept {
    // The same number of steps of the same length as last time: the travel is known.
    if (!is_travel_known()) {
      const float passed_s = pending();
      travelled_ = detail::is_same(pending_s_, 0.0f) ? steps_ : 0;
      network_.prepare(passed_s, travel_);
    }
    if (travel_.is_late && late_steps_ < 65535u) ++late_steps_;
    if (is_start_new_) network_.advance_from_start(acted_, travel_);
    else network_.advance(acted_, travel_, measured_);
    is_start_new_ = false;
    measured_ = CertifiedMeasurement();
    forget_time();
  }
  void forget_time() noexcept {
    pending_s_ = 0.0f;
    steps_ = 0;
    acted_ = 0;
  }
  // Whoever advances has passed a step at least.
  bool is_travel_known() const noexcept { return steps_ == travelled_; }

  void plan(const Inputs& inputs, uint8_t wanted) noexcept {
    advance();
    observe(inputs.air_C, inputs.supply_V);
    CertifiedCount largest = network_.largest();
    // A ratchet instead of a dead band: while the demand is held back, the ceiling rises to what can be kept
    // for ever, or not at all.
    if (is_limiting_ && wanted > ceiling_ && largest.count > ceiling_) {
      const uint8_t sustainable = network_.sustainable();
      const bool may_rise =
          sustainable > ceiling_ && sustainable <= largest.count && network_.is_below(sustainable, largest);
      largest.count = may_rise ? sustainable : ceiling_;
      if (largest.node == CertifiedNode::none) largest.node = node_;
    }
    ceiling_ = largest.count;
    node_ = largest.node;
  }

  // Air that is the same as at the last plan is seen by its bits. A supply never is: no two readings are alike.
  void observe_air(float air_C) noexcept {
    if (detail::is_same(air_C, read_air_C_)) return;
    read_air_C_ = air_C;
    const float warmest_C = air_C + air_error_K_;
    network_.set_air(warmest_C < highest_air_C_ ? warmest_C : highest_air_C_);
  }
  void observe(float air_C, float supply_V) noexcept {
    observe_air(air_C);
    const float ratio = supply_V * per_supply_V_;  // in 2^-16
    // The square is not below the truth; what it is below is no supply. In whole numbers, because a supply moves in every step.
    detail::UnitFraction squared = detail::whole_fraction();
    if (detail::is_from_zero_to(ratio, 65534.0f)) {
      const uint16_t above = static_cast<uint16_t>(static_cast<uint16_t>(ratio) + 1u);
      squared = static_cast<detail::UnitFraction>((detail::product(above, above) >> 16) + 1u);
    }
    network_.take_warm_winding(squared < least_squared_ ? detail::whole_fraction() : squared);
  }

  // Of a supply that no reading may tell, the whole: none is below it.
  static detail::UnitFraction least_squared(const HeatBounds& heat) noexcept {
    const float ratio = heat.lowest_supply_V / heat.highest_supply_V;
    return ratio > 0.0f ? detail::fraction_down(ratio * ratio) : detail::whole_fraction();
  }

  LimitedPower least(LimitReason reason, uint8_t demand) noexcept {
    observe(detail::not_a_number(), detail::not_a_number());
    acting_ = 0;
    ceiling_ = 0;
    turn_ = static_cast<uint8_t>(every_ - 1);  // plan at once when the fault is over
    node_ = CertifiedNode::none;
    is_limiting_ = false;
    const LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }

  Network network_;
  typename Network::Travel travel_;
  float highest_air_C_, air_error_K_, per_supply_V_, count_W_;
  float read_air_C_ = detail::not_a_number();
  detail::UnitFraction least_squared_;
  uint16_t late_steps_ = 0;
  float each_s_ = 0.0f, pending_s_ = 0.0f;  // `steps_` of the one, after the other
  uint8_t steps_ = 0;
  uint8_t stood_ = 0;      // steps in a row that were told no time
  uint8_t travelled_ = 0;  // steps of this length that `travel_` is for; 0: for others
  uint8_t acting_ = 0;     // count that acts since the last step
  uint8_t acted_ = 0;      // largest count that acted since the last plan
  uint8_t ceiling_ = 0;
  ConfigError config_error_;
  uint8_t every_, turn_;
  CertifiedNode node_ = CertifiedNode::none;
  CertifiedMeasurement measured_;            // since the last plan
  bool is_limiting_ : 1, is_start_new_ : 1;  // the latter: nothing was carried since
};

}  // namespace thermopower
