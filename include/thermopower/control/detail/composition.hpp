// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../../detail/probe.hpp"
#include "../axis_facts.hpp"

/// @file control/detail/composition.hpp
/// Asks whether a type can play a part in a controller.

namespace thermopower {
namespace detail {

/// A motor type names its two models.
template <class Candidate, class = int>
struct IsMotor {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsMotor<Candidate, typename Exists<typename Candidate::Current, typename Candidate::Thermal>::Type> {
  static constexpr bool value = true;
};

/// Has `step(error_deg, facts, dt_s)`, so that where the axis stands and what it got last are worth finding out.
template <class Candidate, class = int>
struct TakesFacts {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesFacts<Candidate, typename Exists<decltype(probe<Candidate>().step(0.0f, probe<const AxisFacts>(),
                                                                              0.0f))>::Type> {
  static constexpr bool value = true;
};

/// Has `step(number)`.
template <class Candidate, class = int>
struct TakesNumber {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesNumber<Candidate, typename Exists<decltype(probe<Candidate>().step(uint8_t(1)))>::Type> {
  static constexpr bool value = true;
};

template <class Number>
struct RealNumberAs {};
template <>
struct RealNumberAs<float> {
  typedef int Type;
};
template <>
struct RealNumberAs<double> {
  typedef int Type;
};
/// Becomes a `float` or a `double` and nothing else, so that what takes a count does not take it.
struct RealNumber {
  template <class Number, class = typename RealNumberAs<Number>::Type>
  operator Number() const noexcept;
};

/// Has `step(error_deg)` with a number that may be broken: a gain or a count is none.
template <class Candidate, class = int>
struct TakesError {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesError<Candidate,
                  typename Exists<decltype(probe<Candidate>().step(probe<const RealNumber>()))>::Type> {
  static constexpr bool value = true;
};

/// Has `step(power, facts)`.
template <class Candidate, class = int>
struct TakesPowerAndFacts {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesPowerAndFacts<Candidate, typename Exists<decltype(probe<Candidate>().step(
                                         uint8_t(1), probe<const AxisFacts>()))>::Type> {
  static constexpr bool value = true;
};

/// Has `step(inputs, dt_s)` with `Inputs` of its own.
template <class Candidate, class = int>
struct TakesInputs {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesInputs<Candidate, typename Exists<decltype(probe<Candidate>().step(
                                  probe<const typename Candidate::Inputs>(), 0.0f))>::Type> {
  static constexpr bool value = true;
};

/// Has `step(facts, dt_s)`.
template <class Candidate, class = int>
struct TakesFactsAlone {
  static constexpr bool value = false;
};
template <class Candidate>
struct TakesFactsAlone<
    Candidate, typename Exists<decltype(probe<Candidate>().step(probe<const AxisFacts>(), 0.0f))>::Type> {
  static constexpr bool value = true;
};

/// Has a `Config` that can be validated.
template <class Candidate, class = int>
struct HasConfig {
  static constexpr bool value = false;
};
template <class Candidate>
struct HasConfig<Candidate,
                 typename Exists<decltype(probe<const typename Candidate::Config>().validate())>::Type> {
  static constexpr bool value = true;
};

/// Can be cut, and has a ceiling.
template <class Candidate, class = int>
struct CanBeCut {
  static constexpr bool value = false;
};
template <class Candidate>
struct CanBeCut<Candidate,
                typename Exists<decltype(probe<const Candidate>().ceiling()),
                                decltype(probe<Candidate>().cut(LimitReason::none, uint8_t(1)))>::Type> {
  static constexpr bool value = true;
};

/// A power law turns an error into a power, with the axis's facts or without.
template <class Candidate>
struct IsPowerLaw {
  static constexpr bool value =
      HasConfig<Candidate>::value && (TakesError<Candidate>::value || TakesFacts<Candidate>::value);
};

/// A limiter takes inputs with a demand, or an axis's facts, and can be cut.
template <class Candidate>
struct IsLimiter {
  static constexpr bool value = HasConfig<Candidate>::value && CanBeCut<Candidate>::value &&
                                (TakesInputs<Candidate>::value || TakesFactsAlone<Candidate>::value);
};

/// A gain turns a power into a gain, with the axis's facts or without. What takes a broken number takes an error: a law.
template <class Candidate>
struct IsGain {
  static constexpr bool value =
      HasConfig<Candidate>::value && (TakesPowerAndFacts<Candidate>::value ||
                                      (TakesNumber<Candidate>::value && !TakesError<Candidate>::value));
};

/// A drive of BasicVoltageGain: `voltage_ratio(power_ratio)`.
template <class Candidate, class = int>
struct IsDrive {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsDrive<Candidate, typename Exists<decltype(Candidate::voltage_ratio(0.5f) + 0.0f)>::Type> {
  static constexpr bool value = true;
};

/// A rule of StepPowerLaw: `power(magnitude_deg, config, state)`.
template <class Candidate, class = int>
struct IsPowerRule {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsPowerRule<Candidate,
                   typename Exists<decltype(Candidate::power(0.0f, probe<const typename Candidate::Config>(),
                                                             probe<typename Candidate::State>()))>::Type> {
  static constexpr bool value = true;
};

/// A rule of SafetyLimiter: a ceiling that can be cut.
template <class Candidate, class = int>
struct IsCeilingRule {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCeilingRule<Candidate, typename Exists<decltype(Candidate::cut(probe<typename Candidate::State>())),
                                                decltype(Candidate::ceiling(
                                                    probe<const typename Candidate::State>()))>::Type> {
  static constexpr bool value = true;
};

/// A rule of GainScheduler: `gain(power, config)`.
template <class Candidate, class = int>
struct IsGainRule {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsGainRule<Candidate, typename Exists<decltype(Candidate::gain(
                                 uint8_t(1), probe<const typename Candidate::Config>()))>::Type> {
  static constexpr bool value = true;
};

/// A supply of a gimbal: `supply_V(nominal_V, measured_V)`.
template <class Candidate, class = int>
struct IsSupply {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsSupply<Candidate, typename Exists<decltype(Candidate::supply_V(0.0f, 0.0f) + 0.0f)>::Type> {
  static constexpr bool value = true;
};

/// A controller of one axis takes inputs with a fault and says what it decided.
template <class Candidate, class = int>
struct IsAxis {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsAxis<Candidate,
              typename Exists<typename Candidate::Config, decltype(probe<typename Candidate::Inputs>().fault),
                              decltype(probe<typename Candidate::State>().p_gain)>::Type> {
  static constexpr bool value = true;
};

/// A network of a certified limiter: what it is told and how it travels.
template <class Candidate, class = int>
struct IsCertifiedNetwork {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsCertifiedNetwork<Candidate,
                          typename Exists<typename Candidate::Config, typename Candidate::Travel,
                                          decltype(probe<const Candidate>().sustainable())>::Type> {
  static constexpr bool value = true;
};

/// How much heat a POWER is: `count(power)` and `power(count)`.
template <class Candidate, class = int>
struct IsHeatCount {
  static constexpr bool value = false;
};
template <class Candidate>
struct IsHeatCount<Candidate, typename Exists<decltype(Candidate::count(uint8_t(1))),
                                              decltype(Candidate::power(uint8_t(1)))>::Type> {
  static constexpr bool value = true;
};

}  // namespace detail
}  // namespace thermopower
