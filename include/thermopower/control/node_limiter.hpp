// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../air_celsius.hpp"
#include "../detail/check.hpp"
#include "axis_facts.hpp"

/// @file node_limiter.hpp
/// A limit for every part of an actuator that has one: a printed bracket softens at 60 degC, magnets weaken
/// at 80, enamel ends at 120.

namespace thermopower {

/// A part that lies between two temperatures that are known: T = from + fraction (to - from).
struct NodeLimit {
  float maximum_C;  ///< Limit, 0 .. 250 degC.
  float fraction;   ///< Place between the two, 0 to 1; above 1 beyond the second (a hot spot in the winding),
                    ///< at most 2.

  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.maximum_C, self.fraction);
  }
  /// `maximum_C` or `offset_fraction` out of range, or ConfigError::none.
  ConfigError validate() const noexcept {
    return first_error(detail::require_within(maximum_C, 0.0f, 250.0f, ConfigError::maximum_C),
                       detail::require_within(fraction, 0.0f, 2.0f, ConfigError::offset_fraction));
  }
};

/// Limits each part of an actuator to its own temperature.
///
/// The ceiling is 255 while every part is a band or more below its limit, and falls in a straight line to the least power at the
/// limit: without a threshold and without a jump. The band is `derating_K`, or twice what a step at full power warms a part by, whichever
/// is wider: so no step takes more than half of what is left, and at constant demand the actuator settles inside the band, on one power, at
/// any loop rate. How fast full power warms a part is declared (`fastest_K_per_s`), and raised where a part is seen to warm faster.
///
/// Take it when parts have limits of their own and no bounds can be declared; with bounds, `CertifiedLimiter` needs no band. A
/// temperature that is NaN or infinite counts as too hot, and so does one for which SensorGuard gives a reason.
///
/// @snippet control_examples.cpp node limiter
/// How to: @ref choose_a_limiter. Menu: @ref policies.
/// @ingroup control
class NodeLimiter {
public:
  /// Which part.
  enum Node : uint8_t {
    bracket = 0,  ///< between air (0) and body (1)
    body = 1,     ///< the body itself; its fraction is between air and body, 1
    magnets = 2,  ///< between body (0) and winding (1)
    winding = 3,  ///< the winding; above 1 its hottest spot
    count = 4,    ///< parts in all
    none = 255    ///< no part is near its limit
  };

  /// What one tunes.
  struct Config {
    NodeLimit node[count];  ///< In the order of `Node`.
    float derating_K;       ///< Least width of the band below each limit. Above 0.
    float fastest_K_per_s;  ///< What full power warms a part by at most. Above 0.

    /// Bracket 60, body 80, magnets 80, winding 120 degC; a band of 8 K; 25 K/s. The bracket is taken as warm as the
    /// body.
    static Config standard() noexcept {
      const Config config = {{{60.0f, 1.0f}, {80.0f, 1.0f}, {80.0f, 0.1f}, {120.0f, 1.0f}}, 8.0f, 25.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.node, self.derating_K, self.fastest_K_per_s);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      for (uint8_t i = 0; i < count; ++i)
        if (is_error(node[i].validate())) return node[i].validate();
      return first_error(detail::require_positive(derating_K, ConfigError::derating_K),
                         detail::require_positive(fastest_K_per_s, ConfigError::rate_per_s));
    }
  };

  /// What the limiter decides on.
  struct Inputs {
    uint8_t demand;            ///< Power parameter asked for.
    GuardedCelsius winding_C;  ///< A model's, or one that SensorGuard let through.
    GuardedCelsius body_C;     ///< The same; the winding's where a model has one node.
    AirCelsius<float> air_C;   ///< Left out: NaN, which counts as as warm as the body.
  };

  /// What one logs.
  struct State {
    float node_C[count];  ///< Temperature of each part.
    float margin_K;       ///< Least distance to a limit; negative above it.
    Node node;            ///< The part with that distance, when it is inside its band.
    float band_K;         ///< Width of the band in this step.
    uint8_t ceiling;      ///< Highest power granted.
  };

  /// Grants the least power until the first step.
  /// @param config  constants; ask `validate()` once
  explicit NodeLimiter(const Config& config = Config::standard()) noexcept
      : config_(config), config_error_(config.validate()), fastest_K_per_s_(config.fastest_K_per_s) {
    for (uint8_t i = 0; i < count; ++i) state_.node_C[i] = detail::not_a_number();
    state_.margin_K = detail::not_a_number();
    state_.node = none;
    state_.band_K = config.derating_K;
    state_.ceiling = least_power();
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_error_; }

  /// What it needs of an axis.
  static Inputs read(const AxisFacts& facts) noexcept {
    const Inputs inputs = {facts.demand, facts.motor_C, facts.body_C, facts.air_C};
    return inputs;
  }

  /// @param dt_s  time since the last step, >= 0; the next one is taken to be as long
  LimitedPower step(const Inputs& inputs, float dt_s) noexcept {
    if (is_error(config_error_)) return cut(LimitReason::config_invalid, inputs.demand);
    if (!detail::is_finite(dt_s) || dt_s < 0.0f) return cut(LimitReason::time_invalid, inputs.demand);
    const LimitReason fault =
        is_fault(inputs.winding_C.fault()) ? inputs.winding_C.fault() : inputs.body_C.fault();
    if (is_fault(fault)) return cut(fault, inputs.demand);
    if (!is_possible(inputs.winding_C) || !is_possible(inputs.body_C))
      return cut(LimitReason::temperature_not_finite, inputs.demand);
    const float body_C = inputs.body_C, winding_C = inputs.winding_C, told_C = inputs.air_C,
                air_C = is_possible(told_C) ? told_C : body_C;
    state_.margin_K = 1.0e9f;
    float rise_K = 0.0f;
    for (uint8_t i = 0; i < count; ++i) {
      const bool is_outside = i <= body;
      const float from_C = is_outside ? air_C : body_C, to_C = is_outside ? body_C : winding_C;
      const float node_C = from_C + config_.node[i].fraction * (to_C - from_C);
      // False before the first step, when there is nothing to compare with.
      if (node_C - state_.node_C[i] > rise_K) rise_K = node_C - state_.node_C[i];
      state_.node_C[i] = node_C;
      const float margin_K = config_.node[i].maximum_C - state_.node_C[i];
      if (margin_K < state_.margin_K) {
        state_.margin_K = margin_K;
        state_.node = static_cast<Node>(i);
      }
    }
    widen(rise_K, dt_s);
    if (state_.margin_K >= state_.band_K) state_.node = none;
    const float above_least = state_.margin_K * 254.0f / state_.band_K;
    state_.ceiling =
        above_least >= 254.0f
            ? 255
            : static_cast<uint8_t>(above_least > 0.0f ? least_power() + static_cast<uint8_t>(above_least)
                                                      : least_power());
    LimitedPower granted = {inputs.demand, LimitReason::none};
    if (inputs.demand > state_.ceiling) {
      granted.power = state_.ceiling;
      granted.reason = state_.margin_K < 0.0f ? LimitReason::over_temperature : LimitReason::node_limit;
    }
    acting_ = granted.power;
    return granted;
  }

  /// Least power, or the demand if that is less, for a reason found elsewhere.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    state_.ceiling = acting_ = least_power();
    const LimitedPower least = {demand < least_power() ? demand : least_power(), reason};
    return least;
  }

  uint8_t ceiling() const noexcept { return state_.ceiling; }  ///< Highest power granted now.
  const State& state() const noexcept { return state_; }       ///< After the last step.
  const Config& config() const noexcept { return config_; }    ///< The constants.

private:
  static bool is_possible(float temperature_C) noexcept {
    return temperature_C > -273.15f && temperature_C < 1.0e4f;
  }

  // What was seen in the last step, at full power. Of a small power too little is seen to multiply it up.
  void widen(float rise_K, float dt_s) noexcept {
    const float counts = acting_ > 32 ? static_cast<float>(acting_) : 32.0f;
    const float full_K = rise_K * (255.0f / counts);
    if (full_K > fastest_K_per_s_ * dt_s && dt_s > 0.0f) fastest_K_per_s_ = full_K / dt_s;
    state_.band_K = detail::at_least(2.0f * fastest_K_per_s_ * dt_s, config_.derating_K);
  }

  Config config_;
  State state_;
  ConfigError config_error_;
  float fastest_K_per_s_;
  uint8_t acting_ = least_power();
};

}  // namespace thermopower
