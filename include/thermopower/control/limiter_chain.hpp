// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>

#include "../detail/check.hpp"
#include "detail/composition.hpp"
#include "detail/policy_call.hpp"

/// @file limiter_chain.hpp
/// Several limiters over one actuator: the strictest wins, and says why.

namespace thermopower {

/// The configurations of a chain's limiters, one after the other.
/// @ingroup control
template <class... Limiters>
struct LimiterChainConfig {
  /// Nothing to set.
  static LimiterChainConfig standard() noexcept { return LimiterChainConfig(); }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self&, Archive&) {}
  /// Nothing can be wrong.
  ConfigError validate() const noexcept { return ConfigError::none; }
};

/// @copydoc LimiterChainConfig
template <class Last>
struct LimiterChainConfig<Last> {
  static_assert(
      detail::IsLimiter<Last>::value,
      "thermopower: every parameter of LimiterChain must be a limiter: a type with Config, step, cut and ceiling");

  typename Last::Config first;  ///< Of the last limiter.

  /// The limiter's standard.
  static LimiterChainConfig standard() noexcept {
    const LimiterChainConfig config = {Last::Config::standard()};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.first);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return first.validate(); }
};

/// @copydoc LimiterChainConfig
template <class First, class Second, class... Rest>
struct LimiterChainConfig<First, Second, Rest...> {
  static_assert(
      detail::IsLimiter<First>::value,
      "thermopower: every parameter of LimiterChain must be a limiter: a type with Config, step, cut and ceiling");

  typename First::Config first;              ///< Of the first limiter.
  LimiterChainConfig<Second, Rest...> rest;  ///< Of those after it: `rest.first` is the second's.

  /// Every limiter's standard.
  static LimiterChainConfig standard() noexcept {
    const LimiterChainConfig config = {First::Config::standard(),
                                       LimiterChainConfig<Second, Rest...>::standard()};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.first, self.rest);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return first_error(first.validate(), rest.validate()); }
};

namespace detail {

template <class Last>
LimiterChainConfig<> rest_of(const LimiterChainConfig<Last>&) noexcept {
  return LimiterChainConfig<>();
}
template <class First, class Second, class... Rest>
const LimiterChainConfig<Second, Rest...>& rest_of(
    const LimiterChainConfig<First, Second, Rest...>& config) noexcept {
  return config.rest;
}

/// The limiters one after the other; a tuple that C++11 without a standard library can have.
template <uint8_t index, class... Limiters>
struct LimiterLinks {
  explicit LimiterLinks(const LimiterChainConfig<>&) noexcept {}
  LimitedPower step(const AxisFacts&, LimitedPower granted, float) noexcept { return granted; }
  void cut(LimitReason, uint8_t, float) noexcept {}
  void cut(LimitReason, uint8_t) noexcept {}
  void acted(uint8_t) noexcept {}
  float hold_s() const noexcept { return static_cast<float>(INFINITY); }
  uint8_t ceiling() const noexcept { return 255; }
};

template <uint8_t index, class First, class... Rest>
struct LimiterLinks<index, First, Rest...> : LimiterLinks<index + 1, Rest...> {
  static_assert(
      IsLimiter<First>::value,
      "thermopower: every parameter of LimiterChain must be a limiter: a type with Config, step, cut and "
      "ceiling");
  typedef LimiterLinks<index + 1, Rest...> Next;
  explicit LimiterLinks(const LimiterChainConfig<First, Rest...>& config) noexcept
      : Next(rest_of(config)), limiter(config.first) {}

  LimitedPower step(AxisFacts facts, LimitedPower granted, float dt_s) noexcept {
    facts.demand = granted.power;
    const LimitedPower own = limited_power(limiter, facts, dt_s, 0);
    // At the least power nothing is left to take, but a fault is still the better reason.
    if (own.power < granted.power || (is_fault(own.reason) && !is_fault(granted.reason))) {
      granted.reason = own.reason;
      if (own.power < granted.power) granted.power = own.power;
    }
    return Next::step(facts, granted, dt_s);
  }
  void cut(LimitReason reason, uint8_t demand, float dt_s) noexcept {
    cut_limiter(limiter, reason, demand, dt_s, 0);
    Next::cut(reason, demand, dt_s);
  }
  void cut(LimitReason reason, uint8_t demand) noexcept {
    limiter.cut(reason, demand);
    Next::cut(reason, demand);
  }
  void acted(uint8_t power) noexcept {
    tell_acted(limiter, power, 0);
    Next::acted(power);
  }
  float hold_s() const noexcept {
    const float own = hold_of(limiter, 0), others = Next::hold_s();
    return own < others ? own : others;
  }
  uint8_t ceiling() const noexcept {
    const uint8_t own = limiter.ceiling(), others = Next::ceiling();
    return own < others ? own : others;
  }
  First limiter;
};

template <uint8_t index, class First, class... Rest>
First& limiter_at(LimiterLinks<index, First, Rest...>& links) noexcept {
  return links.limiter;
}
template <uint8_t index, class First, class... Rest>
const First& limiter_at(const LimiterLinks<index, First, Rest...>& links) noexcept {
  return links.limiter;
}

}  // namespace detail

/// Several limiters in the place of one.
/// @tparam Limiters  one or more, in the order in which they are asked
///
///     typedef LimiterChain<NodeLimiter, CertifiedLimiter<>> Limiter;
///
/// Each limiter is asked with what those before it left of the demand, so the power granted is the least that any
/// of them grants, and the reason is that limiter's; of two that grant the same the first is named, but a fault
/// always before a limit. What counts as too hot for one of them (NaN, a time that runs backwards) cuts the whole
/// chain. Put a limiter that keeps account of the power it granted, `CertifiedLimiter`, last: only the last one
/// knows what acted; before others it counts more heat than there was, which is safe and wastes a little.
///
/// @snippet control_examples.cpp limiter chain
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
template <class... Limiters>
class LimiterChain {
  static_assert(sizeof...(Limiters) >= 1 && sizeof...(Limiters) < 255,
                "thermopower: a LimiterChain needs at least one limiter");

public:
  typedef LimiterChainConfig<Limiters...> Config;  ///< What one tunes.

  /// @param config  constants; ask `validate()` once
  explicit LimiterChain(const Config& config = Config::standard()) noexcept
      : links_(config), config_error_(config.validate()) {}

  /// First constant out of its range, or ConfigError::none. Anything but none keeps the power at its least.
  ConfigError validate() const noexcept { return config_error_; }

  /// @param facts  what the axis knows  @param dt_s  time since the last step, >= 0
  LimitedPower step(const AxisFacts& facts, float dt_s) noexcept {
    if (is_error(config_error_)) return cut(LimitReason::config_invalid, facts.demand);
    const LimitedPower all = {facts.demand, LimitReason::none};
    return links_.step(facts, all, dt_s);
  }

  /// Least power, or the demand if that is less, for a reason found elsewhere, a known time after the last step.
  LimitedPower cut_after(LimitReason reason, uint8_t demand, float dt_s) noexcept {
    links_.cut(reason, demand, dt_s);
    return least(reason, demand);
  }
  /// The same when the time is not known.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    links_.cut(reason, demand);
    return least(reason, demand);
  }

  /// Tells every limiter that keeps account of the power that a larger one than was granted may have acted since
  /// the last step; call it before `step()`.
  void acted(uint8_t power) noexcept { links_.acted(power); }
  /// How long a power may act before the next plan: the shortest time that any limiter vouches for, s; infinite
  /// where none says.
  float hold_s() const noexcept { return links_.hold_s(); }

  /// Highest power granted now: the lowest ceiling of all.
  uint8_t ceiling() const noexcept { return links_.ceiling(); }

  /// One of the limiters, to tell it what was measured or to log its state. @tparam index  0 .. number - 1
  template <uint8_t index>
  auto limiter() noexcept
      -> decltype(detail::limiter_at<index>(*static_cast<detail::LimiterLinks<0, Limiters...>*>(nullptr))) {
    return detail::limiter_at<index>(links_);
  }
  /// @overload
  template <uint8_t index>
  auto limiter() const noexcept -> decltype(detail::limiter_at<index>(
      *static_cast<const detail::LimiterLinks<0, Limiters...>*>(nullptr))) {
    return detail::limiter_at<index>(links_);
  }

private:
  static LimitedPower least(LimitReason reason, uint8_t demand) noexcept {
    const LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }

  detail::LimiterLinks<0, Limiters...> links_;
  ConfigError config_error_;
};

}  // namespace thermopower
