// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"
#include "../detail/probe.hpp"

/// @file energy_meter.hpp
/// Energy and average power, eq 4.24 to 4.26. What is integrated is part of the type: the thesis compares
/// V_rms I in one run with the power at the supply in another, and the published savings depend on it.

namespace thermopower {

/// Power in the winding: V_rms I (eq 4.13).
///
/// @snippet actuator_examples.cpp energy
/// How to: @ref units_and_temperatures.
/// @ingroup actuator
struct AtWinding {
  /// @return W
  template <class Number>
  static Number power_W(const Number& v_rms_V, const Number&, const Number& current_A) noexcept {
    return v_rms_V * current_A;
  }
};

/// Power drawn from the supply: V_supply I, where the measured current is the supply's own (section 5.3).
///
/// @snippet actuator_examples.cpp energy
/// How to: @ref units_and_temperatures.
/// @ingroup actuator
struct AtSupply {
  /// @return W
  template <class Number>
  static Number power_W(const Number&, const Number& supply_V, const Number& current_A) noexcept {
    return supply_V * current_A;
  }
};

namespace detail {
/// Where power is measured.
template <class Candidate, class Number, class = int>
struct IsMeterPlace {
  static constexpr bool value = false;
};
template <class Candidate, class Number>
struct IsMeterPlace<Candidate, Number,
                    typename Exists<decltype(Candidate::power_W(probe<const Number>(), probe<const Number>(),
                                                                probe<const Number>()))>::Type> {
  static constexpr bool value = true;
};
}  // namespace detail

/// Sums P dt (eq 4.24) and divides by the time (eq 4.25).
/// @tparam Where  `AtWinding` or `AtSupply`. Numbers of the two are not comparable.
///
/// @snippet actuator_examples.cpp energy
/// How to: @ref units_and_temperatures.
/// @ingroup actuator
template <class Where, class Number = float>
class EnergyMeter {
  static_assert(
      detail::IsModelNumber<Number>::value,
      "thermopower: the Number of EnergyMeter must be float, double or a class that stands for one");
  static_assert(
      detail::IsMeterPlace<Where, Number>::value,
      "thermopower: the first parameter of EnergyMeter must be where the power is measured: AtWinding or "
      "AtSupply");

public:
  /// What one logs.
  struct State {
    Number energy_J;      ///< Since start().
    Number time_s;        ///< Since start().
    Number last_power_W;  ///< Of the last step.
  };

  /// Nothing measured yet.
  EnergyMeter() noexcept { start(); }

  /// Forgets everything.
  void start() noexcept {
    energy_J_ = Sum();
    time_s_ = Sum();
    last_power_W_ = Number(0);
  }

  /// Adds one interval during which the inputs were constant. A NaN or Inf in what is integrated, or a
  /// negative time, is counted in `rejected()` and not added: one bad sample must not lose an hour's sum.
  void step(Number v_rms_V, Number supply_V, Number current_A, Number dt_s) noexcept {
    const Number power_W = Where::power_W(v_rms_V, supply_V, current_A);
    const Number energy_J = power_W * dt_s;
    if (!detail::is_finite(power_W) || !detail::is_finite(energy_J) || !(dt_s >= Number(0))) {
      ++rejected_;
      return;
    }
    last_power_W_ = power_W;
    energy_J_.add(energy_J);
    time_s_.add(dt_s);
  }

  /// Sums so far.
  State state() const noexcept {
    State state = {energy_J_.total, time_s_.total, last_power_W_};
    return state;
  }
  /// Average power, eq 4.25; 0 before the first step. @return W
  Number average_W() const noexcept {
    return time_s_.total > Number(0) ? energy_J_.total / time_s_.total : Number(0);
  }
  /// Samples that were not finite, or whose time ran backwards.
  uint32_t rejected() const noexcept { return rejected_; }

private:
  // Compensated (Kahan): in single precision an hour of 10 ms steps would otherwise lose every small
  // addition.
  struct Sum {
    Number total = Number(0);
    Number lost = Number(0);
    void add(Number value) noexcept {
      const Number corrected = value - lost;
      const Number next = total + corrected;
      lost = (next - total) - corrected;
      total = next;
    }
  };

  Sum energy_J_, time_s_;
  Number last_power_W_;
  uint32_t rejected_ = 0;
};

/// Saving of the second average power against the first, eq 4.26. Of two meters, take `saving_percent`: it
/// compares like with like.
/// @return percent; NaN when the first is 0
/// @ingroup actuator
template <class Number>
Number difference_percent(Number first, Number second) noexcept {
  if (!(first < Number(0)) && !(first > Number(0))) return static_cast<Number>(NAN);
  return Number(100) * (first - second) / first;
}

namespace detail {
template <class Left, class Right>
struct IsSamePlace {
  static constexpr bool value = false;
};
template <class Where>
struct IsSamePlace<Where, Where> {
  static constexpr bool value = true;
};
}  // namespace detail

/// Saving of the second meter's average power against the first's, eq 4.26. Meters of different places do not
/// compile.
/// @return percent; NaN when the first average is 0
/// @ingroup actuator
template <class First, class Second, class Number>
Number saving_percent(const EnergyMeter<First, Number>& first,
                      const EnergyMeter<Second, Number>& second) noexcept {
  static_assert(detail::IsSamePlace<First, Second>::value,
                "thermopower: a saving compares like with like: two meters AtWinding or two AtSupply");
  return difference_percent(first.average_W(), second.average_W());
}

}  // namespace thermopower
