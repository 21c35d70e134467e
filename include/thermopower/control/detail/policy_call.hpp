// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>

#include "../axis_facts.hpp"

/// @file control/detail/policy_call.hpp
/// Hands an axis's facts to its policies in the form they ask for. A limiter takes `step(facts, dt_s)`, or
/// `step(inputs, dt_s)`: one whose `Inputs` are a demand, a temperature and a rate gets these; one that needs
/// others has `static Inputs read(const AxisFacts&)`. A limiter that must know how long a fault lasted has
/// `cut_after(reason, demand, dt_s)` beside `cut(reason, demand)`. A power law takes `step(error_deg)` or
/// `step(error_deg, facts, dt_s)`, a gain `step(power)` or `step(power, facts)`.

namespace thermopower {

namespace detail {

template <class Limiter>
[[gnu::always_inline]] inline auto limiter_inputs(const AxisFacts& facts, int) noexcept
    -> decltype(Limiter::read(facts)) {
  return Limiter::read(facts);
}
template <class Limiter>
[[gnu::always_inline]] inline typename Limiter::Inputs limiter_inputs(const AxisFacts& facts, long) noexcept {
  const typename Limiter::Inputs inputs = {facts.demand, facts.motor_C, facts.rate_K_per_s};
  return inputs;
}

template <class Limiter>
[[gnu::always_inline]] inline auto limited_power(Limiter& limiter, const AxisFacts& facts, float dt_s,
                                                 int) noexcept -> decltype(limiter.step(facts, dt_s)) {
  return limiter.step(facts, dt_s);
}
template <class Limiter>
[[gnu::always_inline]] inline LimitedPower limited_power(Limiter& limiter, const AxisFacts& facts, float dt_s,
                                                         long) noexcept {
  return limiter.step(limiter_inputs<Limiter>(facts, 0), dt_s);
}

template <class Limiter>
auto cut_limiter(Limiter& limiter, LimitReason reason, uint8_t demand, float dt_s, int) noexcept
    -> decltype(limiter.cut_after(reason, demand, dt_s)) {
  return limiter.cut_after(reason, demand, dt_s);
}
template <class Limiter>
LimitedPower cut_limiter(Limiter& limiter, LimitReason reason, uint8_t demand, float, long) noexcept {
  return limiter.cut(reason, demand);
}

/// Tells a limiter that keeps account of the power itself what acted besides the power it granted.
template <class Limiter>
auto tell_acted(Limiter& limiter, uint8_t power, int) noexcept -> decltype(limiter.acted(power)) {
  return limiter.acted(power);
}
template <class Limiter>
void tell_acted(Limiter&, uint8_t, long) noexcept {}

/// Silence that a limiter's guarantee covers, s; infinite where it does not say.
template <class Limiter>
auto hold_of(const Limiter& limiter, int) noexcept -> decltype(limiter.hold_s()) {
  return limiter.hold_s();
}
template <class Limiter>
float hold_of(const Limiter&, long) noexcept {
  return static_cast<float>(INFINITY);
}

template <class Law>
[[gnu::always_inline]] inline auto demanded_power(Law& law, float error_deg, const AxisFacts& facts,
                                                  float dt_s, int) noexcept
    -> decltype(law.step(error_deg, facts, dt_s)) {
  return law.step(error_deg, facts, dt_s);
}
template <class Law>
[[gnu::always_inline]] inline uint8_t demanded_power(Law& law, float error_deg, const AxisFacts&, float,
                                                     long) noexcept {
  return law.step(error_deg);
}

template <class Gain>
[[gnu::always_inline]] inline auto gain_for(Gain& gain, uint8_t power, const AxisFacts& facts, int) noexcept
    -> decltype(gain.step(power, facts)) {
  return gain.step(power, facts);
}
template <class Gain>
[[gnu::always_inline]] inline uint8_t gain_for(Gain& gain, uint8_t power, const AxisFacts&, long) noexcept {
  return gain.step(power);
}

/// The gain before anything is known of an axis.
template <class Gain>
[[gnu::always_inline]] inline auto first_gain(Gain& gain, int) noexcept
    -> decltype(gain.step(least_power())) {
  return gain.step(least_power());
}
template <class Gain>
[[gnu::always_inline]] inline uint8_t first_gain(Gain& gain, long) noexcept {
  return gain.step(least_power(), AxisFacts::unknown());
}

/// What a motor draws at a POWER; a model that remembers may take it as the byte it is, and spare the
/// conversion.
template <class Current>
auto drawn_at(Current& current, uint8_t power, float supply_V, float motor_C, int) noexcept
    -> decltype(current.at_count(power, supply_V, motor_C)) {
  return current.at_count(power, supply_V, motor_C);
}
template <class Current>
typename Current::State drawn_at(const Current& current, uint8_t power, float supply_V, float motor_C,
                                 long) noexcept {
  return current.at_power(static_cast<float>(power), supply_V, motor_C);
}

/// Starts a model that nobody told a temperature: its own way, or as warm as the air (the thesis's
/// assumption, section 4.2).
template <class Thermal>
auto start_thermal(Thermal& thermal, float air_C, int) noexcept -> decltype(thermal.start_in(air_C)) {
  return thermal.start_in(air_C);
}
template <class Thermal>
void start_thermal(Thermal& thermal, float air_C, long) noexcept {
  thermal.start(air_C);
}

}  // namespace detail
}  // namespace thermopower
