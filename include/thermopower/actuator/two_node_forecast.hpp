// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <math.h>

#include "two_node_rates.hpp"
#include "two_node_thermal_model.hpp"

/// @file two_node_forecast.hpp
/// What a winding and a body will come to at a constant heat: how long until a limit, how long until full power is
/// bearable again.

namespace thermopower {

/// Two nodes from now on, in closed form: each temperature is where it settles plus two decaying exponentials, so
/// that it turns at most once, and the time of a limit is found between two instants that enclose it.
///
/// Costs some tens of exponentials a question: ask once a second, not in every cycle. In firmware each of them is
/// float; the times are exact to a thousandth of themselves, or a hundredth of a second.
///
/// @snippet actuator_examples.cpp forecast
/// How to: @ref choose_a_limiter.
/// @ingroup actuator
class TwoNodeForecast {
public:
  typedef TwoNodeThermalModel<float>::Config Config;  ///< The network.

  /// Where both stand.
  struct State {
    float winding_C;          ///< Now.
    float body_C;             ///< Now.
    AirCelsius<float> air_C;  ///< Now and from now on; left out: NaN, and so is the forecast.
  };

  /// What neither may pass; infinite where there is no limit.
  struct Limits {
    float winding_C;  ///< Of the winding.
    float body_C;     ///< Of the body.
  };

  /// @param config  constants of the network, valid  @param state  where it stands  @param heat_W  in the winding,
  /// from now on
  TwoNodeForecast(const Config& config, const State& state, float heat_W) noexcept {
    const float out = config.coupling_W_per_K / config.winding_heat_capacity_J_per_K;
    const float in = config.coupling_W_per_K / config.body_heat_capacity_J_per_K;
    const float to_air = config.cooling.conductance_W_per_K / config.body_heat_capacity_J_per_K;
    const TwoNodeRates<float> rates = two_node_rates(out, in, to_air);
    fast_per_s_ = rates.fast_per_s;
    slow_per_s_ = rates.slow_per_s;
    body_.settled_C = state.air_C + heat_W / config.cooling.conductance_W_per_K;
    winding_.settled_C = body_.settled_C + heat_W / config.coupling_W_per_K;
    winding_.set(state.winding_C,
                 out * (state.body_C - state.winding_C) + heat_W / config.winding_heat_capacity_J_per_K,
                 rates);
    body_.set(state.body_C, in * (state.winding_C - state.body_C) - to_air * (state.body_C - state.air_C),
              rates);
  }

  float winding_C(float seconds) const noexcept { return at(winding_, seconds); }  ///< After a time, >= 0.
  float body_C(float seconds) const noexcept { return at(body_, seconds); }        ///< After a time, >= 0.

  /// Until the first node reaches its limit.
  /// @param limits  of both
  /// @return s; 0 when one is there, infinite when none ever is, NaN when anything given was NaN
  float seconds_to(const Limits& limits) const noexcept {
    const float winding_s = seconds_to(winding_, limits.winding_C);
    const float body_s = seconds_to(body_, limits.body_C);
    return winding_s != winding_s || winding_s < body_s ? winding_s : body_s;
  }

  /// Until another heat could act for a while without either limit being passed: when full power is back.
  /// @param config     as given to the constructor  @param air_C  as given there
  /// @param full_W     the heat that is to be bearable  @param horizon_s  and for how long, > 0
  /// @param limits     of both
  /// @return s; 0 when it is bearable now, infinite when cooling at the present heat never makes it so
  float seconds_until(const Config& config, float air_C, float full_W, float horizon_s,
                      const Limits& limits) const noexcept {
    const auto is_bearable = [&](float after_s) -> bool {
      const State then = {winding_C(after_s), body_C(after_s), air_C};
      return TwoNodeForecast(config, then, full_W).seconds_to(limits) >= horizon_s;
    };
    if (is_bearable(0.0f)) return 0.0f;
    const float longest_s = 20.0f / slow_per_s_;
    float early_s = 0.0f, late_s = 0.01f / fast_per_s_;
    while (!is_bearable(late_s)) {
      if (!(late_s < longest_s)) return static_cast<float>(INFINITY);
      early_s = late_s;
      late_s *= 1.5f;
    }
    while (late_s - early_s > 0.01f + 0.001f * late_s) {
      const float middle_s = 0.5f * (early_s + late_s);
      (is_bearable(middle_s) ? late_s : early_s) = middle_s;
    }
    return late_s;
  }

private:
  // settled + fast exp(-fast t) + slow exp(-slow t)
  struct Node {
    float settled_C, fast_K, slow_K;
    void set(float now_C, float rate_K_per_s, const TwoNodeRates<float>& rates) noexcept {
      const float away_K = now_C - settled_C;
      fast_K = -(rate_K_per_s + rates.slow_per_s * away_K) / (rates.fast_per_s - rates.slow_per_s);
      slow_K = away_K - fast_K;
    }
  };

  float at(const Node& node, float seconds) const noexcept {
    return node.settled_C + node.fast_K * static_cast<float>(expf(-fast_per_s_ * seconds)) +
           node.slow_K * static_cast<float>(expf(-slow_per_s_ * seconds));
  }

  float seconds_to(const Node& node, float limit_C) const noexcept {
    if (!(at(node, 0.0f) < limit_C)) return at(node, 0.0f) >= limit_C ? 0.0f : detail::not_a_number();
    // It turns where both exponentials change as fast; before and after it only rises, or only falls.
    float early_s = 0.0f, late_s = 20.0f / slow_per_s_;
    const float ratio = -(node.fast_K * fast_per_s_) / (node.slow_K * slow_per_s_);
    const float turn_s = ratio > 0.0f ? static_cast<float>(logf(ratio)) / (fast_per_s_ - slow_per_s_) : 0.0f;
    if (turn_s > 0.0f && turn_s < late_s) {
      if (at(node, turn_s) >= limit_C) late_s = turn_s;
      else early_s = turn_s;
    }
    if (!(at(node, late_s) >= limit_C)) return static_cast<float>(INFINITY);
    while (late_s - early_s > 0.01f + 0.001f * late_s) {
      const float middle_s = 0.5f * (early_s + late_s);
      (at(node, middle_s) >= limit_C ? late_s : early_s) = middle_s;
    }
    return late_s;
  }

  Node winding_, body_;
  float fast_per_s_, slow_per_s_;
};

}  // namespace thermopower
