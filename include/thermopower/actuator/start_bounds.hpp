// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "stored_state.hpp"
#include "while_off.hpp"

/// @file start_bounds.hpp
/// How hot an actuator can be at most when power comes back: bounds, not estimates. The estimates are in
/// power_up.hpp.
///
/// The bounds rest on the record's own bounds, on what the journal promises about the time after it, and on
/// the actuator's constants, each within bounds of its own. They hold for a body that only its winding heats.

namespace thermopower {

/// Temperatures that nothing exceeds: what CertifiedLimiter starts from.
struct StartBounds {
  float winding_upper_C;  ///< No true winding is hotter.
  float body_upper_C;     ///< No true body is hotter.
};

/// Age of a record by a clock that goes on without power. @param clock_s  now; `StoredState::no_clock()` when
/// there is none
/// @return s, rounded down; NaN when it cannot be known, also when the clock was set back
inline float record_age_s(const StoredState& stored, uint32_t clock_s) noexcept {
  if (stored.clock_s == StoredState::no_clock() || clock_s == StoredState::no_clock() ||
      clock_s < stored.clock_s)
    return detail::not_a_number();
  // Whole seconds, both cut: the true difference can be a second less.
  return clock_s == stored.clock_s ? 0.0f : static_cast<float>(clock_s - stored.clock_s - 1u);
}

/// What is known when power comes back.
struct StartFacts {
  bool has_stored;        ///< A whole record was found.
  StoredState stored;     ///< That record.
  RecordPromise promise;  ///< What it leaves open: `StateJournal::promise()`; for a record that survived a
                          ///< reset, how long it may have gone on being driven since: `{s, 0, s}`.
  float age_s;            ///< Age of the record: `record_age_s()`. NaN or negative: not known.
  AirCelsius<float>
      air_upper_C;  ///< The air was never warmer than this since the record; NaN, or left out: not known.
  DrivenWhileOff
      is_driven_while_off;  ///< The actuator may go on being driven while this controller is off: a board
                            ///< with a supply of its own that keeps its last command. Has to be given.
};

/// Bounds of the actuator that the start bounds are computed with; heat capacities, conductances and coupling
/// as in TwoNodeThermalModel. Take a body as large as you like for an actuator of one node.
///
/// @snippet actuator_examples.cpp start bounds
/// How to: @ref explain_observer.
struct StartAssumptions {
  float largest_heat_W;             ///< Most that the winding is ever heated with. >= 0.
  float least_winding_J_per_K;      ///< Above 0.
  float most_winding_J_per_K;       ///< Not below the least.
  float least_body_J_per_K;         ///< Above 0.
  float most_body_J_per_K;          ///< Not below the least.
  float least_coupling_W_per_K;     ///< Above 0.
  float least_conductance_W_per_K;  ///< Above 0.
  float most_conductance_W_per_K;   ///< Not below the least.
  float hottest_winding_C;          ///< The protection never let the winding pass this.
  float hottest_body_C;             ///< The protection never let the body pass this.

  /// The constants of a `TwoNodeThermalModel`, each known to a fraction. @param fraction  0.2 for +-20 %
  template <class ThermalConfig>
  static StartAssumptions around(const ThermalConfig& thermal, float fraction, float largest_heat_W,
                                 float hottest_winding_C, float hottest_body_C) noexcept {
    const float least = 1.0f - fraction, most = 1.0f + fraction;
    const StartAssumptions assumptions = {largest_heat_W,
                                          thermal.winding_heat_capacity_J_per_K * least,
                                          thermal.winding_heat_capacity_J_per_K * most,
                                          thermal.body_heat_capacity_J_per_K * least,
                                          thermal.body_heat_capacity_J_per_K * most,
                                          thermal.coupling_W_per_K * least,
                                          thermal.cooling.conductance_W_per_K * least,
                                          thermal.cooling.conductance_W_per_K * most,
                                          hottest_winding_C,
                                          hottest_body_C};
    return assumptions;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(detail::require_not_negative(largest_heat_W, ConfigError::heat_when_cold_W)))
      return ConfigError::heat_when_cold_W;
    if (!is_range(least_winding_J_per_K, most_winding_J_per_K))
      return ConfigError::winding_heat_capacity_J_per_K;
    if (!is_range(least_body_J_per_K, most_body_J_per_K)) return ConfigError::body_heat_capacity_J_per_K;
    if (is_error(detail::require_positive(least_coupling_W_per_K, ConfigError::coupling_W_per_K)))
      return ConfigError::coupling_W_per_K;
    if (!is_range(least_conductance_W_per_K, most_conductance_W_per_K))
      return ConfigError::conductance_W_per_K;
    return first_error(
        detail::require_within(hottest_winding_C, 0.0f, 250.0f, ConfigError::maximum_winding_C),
        detail::require_within(hottest_body_C, 0.0f, 250.0f, ConfigError::maximum_body_C));
  }

  /// Upper bounds after some time of the largest heat. @param air_upper_C  NaN: not known, which counts as no cooling
  /// at all  @param time_s  >= 0, may be infinite
  StartBounds heated(const StartBounds& from, float air_upper_C, float time_s) const noexcept {
    const float winding_C = from.winding_upper_C, body_C = from.body_upper_C;
    // All heat there was, and what a hotter winding brings along, may end up in the body; but heat alone
    // takes it no further than where it settles.
    const float brought_K =
        most_winding_J_per_K * detail::at_least(winding_C - body_C, 0.0f) / least_body_J_per_K;
    const float settled_C =
        detail::at_least(air_upper_C + largest_heat_W / least_conductance_W_per_K, body_C);
    const float warmed_C = body_C + largest_heat_W * time_s / least_body_J_per_K;
    // NaN, where the air is not known, is no bound.
    const float body_upper_C = (settled_C < warmed_C ? settled_C : warmed_C) + brought_K;
    // The winding gains on the hottest of its neighbours by its heat alone, and settles above the body.
    const float adiabatic_C =
        detail::at_least(winding_C, body_C) + largest_heat_W * time_s / least_winding_J_per_K;
    const float above_body_C =
        detail::at_least(body_upper_C + largest_heat_W / least_coupling_W_per_K, winding_C);
    const StartBounds bounds = {adiabatic_C < above_body_C ? adiabatic_C : above_body_C, body_upper_C};
    return bounds;
  }

  /// Upper bounds after some time without heat. @param time_s  >= 0
  StartBounds cooled(const StartBounds& from, float air_upper_C, float time_s) const noexcept {
    const float hottest_K =
        detail::at_least(detail::at_least(from.winding_upper_C, from.body_upper_C) - air_upper_C, 0.0f);
    // The slowest mode is not slower than the sum of all lags; in it the winding is hotter than the body by
    // no more than this factor (Rayleigh: its rate is at most the conductance over all heat capacity).
    const float slowest_s = most_winding_J_per_K / least_coupling_W_per_K +
                            (most_winding_J_per_K + most_body_J_per_K) / least_conductance_W_per_K;
    const float behind = 1.0f - most_conductance_W_per_K * most_winding_J_per_K /
                                    ((most_winding_J_per_K + least_body_J_per_K) * least_coupling_W_per_K);
    const float left_K = hottest_K * detail::Numeric<float>::exponential(-time_s / slowest_s);
    const float winding_K = behind > 0.0f ? left_K / behind : hottest_K;
    const StartBounds bounds = {air_upper_C + (winding_K < hottest_K ? winding_K : hottest_K),
                                air_upper_C + (behind > 0.0f ? left_K : hottest_K)};
    return bounds;
  }

  /// By how much an actuator can warm after its last record, for PowerUpFacts. Infinite where neither age nor air of
  /// an actuator that is driven on is known.
  float unrecorded_K(const StartFacts& facts) const noexcept {
    if (!facts.has_stored) return 0.0f;
    const StartBounds recorded = {facts.stored.winding_upper_C, facts.stored.body_upper_C};
    const StartBounds later = at_power_off(facts, recorded);
    return detail::at_least(later.winding_upper_C - recorded.winding_upper_C,
                            later.body_upper_C - recorded.body_upper_C);
  }

  /// The bounds to start from. No record: at the limits, or where the largest heat settles if the actuator is
  /// driven while the controller is off. Air that is not known: at the limits.
  StartBounds start(const StartFacts& facts) const noexcept {
    const StartBounds limits = {hottest_winding_C, hottest_body_C};
    const float air_upper_C = facts.air_upper_C;
    if (!facts.has_stored || !detail::is_finite(air_upper_C)) {
      const float settled_C = air_upper_C + largest_heat_W / least_conductance_W_per_K;
      const StartBounds driven = {
          detail::at_least(limits.winding_upper_C, settled_C + largest_heat_W / least_coupling_W_per_K),
          detail::at_least(limits.body_upper_C, settled_C)};
      return facts.is_driven_while_off && detail::is_finite(settled_C) ? driven : limits;
    }
    const StartBounds recorded = {facts.stored.winding_upper_C, facts.stored.body_upper_C};
    StartBounds bounds = at_power_off(facts, recorded);
    const bool is_age_known = facts.age_s >= 0.0f && detail::is_finite(facts.age_s);
    if (!facts.is_driven_while_off && is_age_known && facts.age_s > facts.promise.longest_s)
      bounds = cooled(bounds, air_upper_C, facts.age_s - facts.promise.longest_s);
    bounds.winding_upper_C = detail::at_least(bounds.winding_upper_C, air_upper_C);
    bounds.body_upper_C = detail::at_least(bounds.body_upper_C, air_upper_C);
    return bounds;
  }

private:
  static bool is_range(float least, float most) noexcept {
    return least > 0.0f && least <= most && detail::is_finite(most);
  }

  // Where it may have been when power went, or where it may be now if it is driven on.
  StartBounds at_power_off(const StartFacts& facts, const StartBounds& recorded) const noexcept {
    const bool is_age_known = facts.age_s >= 0.0f && detail::is_finite(facts.age_s);
    if (facts.is_driven_while_off)
      return heated(recorded, facts.air_upper_C,
                    is_age_known ? facts.age_s + 2.0f : static_cast<float>(INFINITY));
    float time_s = facts.promise.interval_s;
    if (is_age_known && facts.age_s + 2.0f < time_s) time_s = facts.age_s + 2.0f;
    StartBounds bounds = heated(recorded, facts.air_upper_C, time_s);
    // (The true age is up to two seconds above the age that is certain: both clocks were cut to whole ones.)
    // The protection was at work; what was hotter than its limits already was not getting hotter still.
    bounds.winding_upper_C =
        at_most(bounds.winding_upper_C, detail::at_least(hottest_winding_C, recorded.winding_upper_C));
    bounds.body_upper_C =
        at_most(bounds.body_upper_C, detail::at_least(hottest_body_C, recorded.body_upper_C));
    bounds.winding_upper_C =
        detail::at_least(bounds.winding_upper_C, recorded.winding_upper_C + facts.promise.change_K);
    bounds.body_upper_C =
        detail::at_least(bounds.body_upper_C, recorded.body_upper_C + facts.promise.change_K);
    return bounds;
  }
  static float at_most(float value, float bound) noexcept { return value < bound ? value : bound; }
};

}  // namespace thermopower
