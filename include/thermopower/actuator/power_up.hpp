// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "start_bounds.hpp"
#include "stored_state.hpp"
#include "two_node_thermal_model.hpp"

/// @file power_up.hpp
/// How warm an actuator is when power comes back. Protection relays know four answers; which is right depends
/// on what happened to the actuator while its controller was off.
///
/// | rule | while the controller was off, the actuator | a relay manual calls it |
/// |---|---|---|
/// | `AsNewLoad` | drew what it draws now | option 1: the current after power-on counts |
/// | `AsOldLoad` | went on drawing what it drew | option 2: the current stayed as it was |
/// | `AsStored` | neither warmed nor cooled | option 3: no change of the thermal image |
/// | `AsPreset` | is as warm as a setting says | option 4: reset to the set value |
/// | `AsCooled` | was off, and cooled | (a relay cannot know this; a controller on the same switch can) |
/// | `AsHottest` | may have been anything | worst case: at its limits |
///
/// Numbered as in ABB's REF601/REJ601/REM601 application manual (1MDU07212-YN), "Behavior of thermal image
/// during power down". Under every rule: a record that is missing or damaged counts as `AsHottest`; a time
/// off that is not known counts as `AsStored`; and nothing is ever colder than the air. "As warm as the air"
/// is not among the rules.
///
/// What the actuator did between its last record and the loss of power is not known either. The estimates are
/// raised by half of what it may have warmed by in that time, and are that much less sure; only the time
/// that it was certainly off has cooled it. Bounds instead of estimates: start_bounds.hpp.

namespace thermopower {

/// What is known at power-up.
///
/// @snippet actuator_examples.cpp power-up
/// How to: @ref explain_observer. Menu: @ref policies.
struct PowerUpFacts {
  bool has_stored;          ///< A whole record was found.
  StoredState stored;       ///< That record.
  float off_s;              ///< How long the power was certainly off; NaN or negative: not known.
  AirCelsius<float> air_C;  ///< Air temperature; NaN, or left out: not known, which counts as `AsHottest`.
  float heat_now_W;         ///< Read by `AsNewLoad`.
  float preset_C;           ///< Read by `AsPreset`.
  float hottest_winding_C;  ///< Limit of the winding; what `AsHottest` starts from.
  float hottest_body_C;     ///< Limit of the body; what `AsHottest` starts from.
  float
      unrecorded_K;  ///< It may have warmed by this after the record: `StartAssumptions::unrecorded_K()`. >= 0;
                     ///< NaN or infinite: not known, which counts as `AsHottest`.

  /// The time that was certainly spent without power, from a clock that went on: the age of the record less
  /// the time that the controller may have run without leaving another one.
  /// @param clock_s  `StoredState::no_clock()` when there is none
  /// @param promise  `StateJournal::promise()`
  /// @return s; NaN when it cannot be known, also when the clock was set back
  static float off_s_from(const StoredState& stored, uint32_t clock_s,
                          const RecordPromise& promise) noexcept {
    const float age_s = record_age_s(stored, clock_s);
    return detail::is_finite(age_s) ? detail::at_least(age_s - promise.longest_s, 0.0f) : age_s;
  }
};

/// Temperatures to start from.
struct PowerUpTemperatures {
  float winding_C;  ///< Never below the air where that is known.
  float body_C;     ///< Never below the air where that is known.
  float std_K;  ///< How sure they are: the record's own uncertainty, or half the distance from air to limit.
  bool rests_on_record;  ///< False: worst case or preset.
};

namespace detail {
inline PowerUpTemperatures hottest(const PowerUpFacts& facts) noexcept {
  const float told_C = facts.air_C, air_C = is_finite(told_C) ? told_C : 0.0f;
  const PowerUpTemperatures at = {facts.hottest_winding_C, facts.hottest_body_C,
                                  0.5f * magnitude(facts.hottest_winding_C - air_C), false};
  return at;
}
inline PowerUpTemperatures not_below_air(PowerUpTemperatures at, float air_C) noexcept {
  at.winding_C = at_least(at.winding_C, air_C);
  at.body_C = at_least(at.body_C, air_C);
  return at;
}
// Carries the record over the time off, exactly, in one step.
inline PowerUpTemperatures carried(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config& thermal, float heat_W) noexcept {
  if (!facts.has_stored || !is_finite(facts.air_C) || !is_finite(heat_W)) return hottest(facts);
  if (!is_finite(facts.unrecorded_K)) return hottest(facts);
  const float half_K = 0.5f * (facts.unrecorded_K > 0.0f ? facts.unrecorded_K : 0.0f);
  PowerUpTemperatures at = {facts.stored.winding_C + half_K, facts.stored.body_C + half_K,
                            sqrtf(facts.stored.std_K * facts.stored.std_K + half_K * half_K), true};
  if (facts.off_s >= 0.0f && is_finite(facts.off_s)) {
    TwoNodeThermalModel<float> model(thermal, at.body_C);
    model.start(at.winding_C, at.body_C);
    const TwoNodeThermalModel<float>::Inputs inputs = {heat_W, 0.0f, {facts.air_C, 0.0f}};
    model.step(inputs, facts.off_s);
    at.winding_C = model.state().winding_C;
    at.body_C = model.state().body_C;
  }
  return not_below_air(at, facts.air_C);
}
}  // namespace detail

/// Drew what it draws now. Take it when the actuator has a supply of its own and its load does not change.
///
/// @snippet actuator_examples.cpp power-up rules
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsNewLoad {
  /// Carries the record over the time off with `heat_now_W` in the winding.
  static PowerUpTemperatures start(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config& thermal) noexcept {
    return detail::carried(facts, thermal, facts.heat_now_W);
  }
};
/// Went on drawing what it drew. Take it when a controller was reset and the drive went on.
///
/// @snippet actuator_examples.cpp power-up rules
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsOldLoad {
  /// Carries the record over the time off with the heat that was stored with it.
  static PowerUpTemperatures start(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config& thermal) noexcept {
    return detail::carried(facts, thermal, facts.stored.heat_W);
  }
};
/// Neither warmed nor cooled. Take it when the time off is short or not known.
///
/// @snippet actuator_examples.cpp power-up rules
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsStored {
  /// The record as it is, however long ago it was written.
  static PowerUpTemperatures start(PowerUpFacts facts,
                                   const TwoNodeThermalModel<float>::Config& thermal) noexcept {
    facts.off_s = detail::not_a_number();
    return detail::carried(facts, thermal, 0.0f);
  }
};
/// As warm as a setting says, whatever was stored.
///
/// @snippet actuator_examples.cpp power-up rules
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsPreset {
  /// `preset_C` in winding and body.
  static PowerUpTemperatures start(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config&) noexcept {
    if (!detail::is_finite(facts.preset_C) || !detail::is_finite(facts.air_C)) return detail::hottest(facts);
    const PowerUpTemperatures at = {facts.preset_C, facts.preset_C, detail::hottest(facts).std_K, false};
    return detail::not_below_air(at, facts.air_C);
  }
};
/// Was off, and cooled. Take it when controller and actuator share a switch and a clock goes on.
///
/// @snippet actuator_examples.cpp power-up
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsCooled {
  /// Carries the record over the time off without heat.
  static PowerUpTemperatures start(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config& thermal) noexcept {
    return detail::carried(facts, thermal, 0.0f);
  }
};
/// May have been anything: at its limits. Take it when nothing was stored, until a resistance was measured.
///
/// @snippet actuator_examples.cpp power-up rules
/// How to: @ref explain_observer. Menu: @ref policies.
struct AsHottest {
  /// Winding and body at their limits.
  static PowerUpTemperatures start(const PowerUpFacts& facts,
                                   const TwoNodeThermalModel<float>::Config&) noexcept {
    return detail::hottest(facts);
  }
};

}  // namespace thermopower
