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
/// The ceiling is 255 while every part is `derating_K` or more below its limit, and falls in a straight line
/// to the least power at the limit: without a threshold, without a jump, without memory. At constant demand
/// the actuator settles inside the band, on one power. Take it when parts have limits of their own and no
/// bounds can be declared; with bounds, `CertifiedLimiter` needs no band. A temperature that is NaN or
/// infinite counts as too hot.
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
    float derating_K;       ///< Width of the band below each limit. Above 0.

    /// Bracket 60, body 80, magnets 80, winding 120 degC; a band of 8 K. The bracket is taken as warm as the
    /// body.
    static Config standard() noexcept {
      const Config config = {{{60.0f, 1.0f}, {80.0f, 1.0f}, {80.0f, 0.1f}, {120.0f, 1.0f}}, 8.0f};
      return config;
    }
    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.node, self.derating_K);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      for (uint8_t i = 0; i < count; ++i)
        if (is_error(node[i].validate())) return node[i].validate();
      return detail::require_positive(derating_K, ConfigError::derating_K);
    }
  };

  /// What the limiter decides on.
  struct Inputs {
    uint8_t demand;           ///< Power parameter asked for.
    float winding_C;          ///< Estimated.
    float body_C;             ///< Estimated; the winding's where a model has one node.
    AirCelsius<float> air_C;  ///< Left out: NaN, which counts as as warm as the body.
  };

  /// What one logs.
  struct State {
    float node_C[count];  ///< Temperature of each part.
    float margin_K;       ///< Least distance to a limit; negative above it.
    Node node;            ///< The part with that distance, when it is inside its band.
    uint8_t ceiling;      ///< Highest power granted.
  };

  /// Grants the least power until the first step.
  /// @param config  constants; ask `validate()` once
  explicit NodeLimiter(const Config& config = Config::standard()) noexcept : config_(config) {
    for (uint8_t i = 0; i < count; ++i) state_.node_C[i] = detail::not_a_number();
    state_.margin_K = detail::not_a_number();
    state_.node = none;
    state_.ceiling = least_power();
    slope_ = 254.0f / config.derating_K;
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// What it needs of an axis.
  static Inputs read(const AxisFacts& facts) noexcept {
    const Inputs inputs = {facts.demand, facts.motor_C, facts.body_C, facts.air_C};
    return inputs;
  }

  /// The time does not matter: the rule has no memory.
  LimitedPower step(const Inputs& inputs, float = 0.0f) noexcept {
    if (is_error(config_.validate())) return cut(LimitReason::config_invalid, inputs.demand);
    if (!is_possible(inputs.winding_C) || !is_possible(inputs.body_C))
      return cut(LimitReason::temperature_not_finite, inputs.demand);
    const float told_C = inputs.air_C, air_C = is_possible(told_C) ? told_C : inputs.body_C;
    state_.margin_K = 1.0e9f;
    for (uint8_t i = 0; i < count; ++i) {
      const bool is_outside = i <= body;
      const float from_C = is_outside ? air_C : inputs.body_C,
                  to_C = is_outside ? inputs.body_C : inputs.winding_C;
      state_.node_C[i] = from_C + config_.node[i].fraction * (to_C - from_C);
      const float margin_K = config_.node[i].maximum_C - state_.node_C[i];
      if (margin_K < state_.margin_K) {
        state_.margin_K = margin_K;
        state_.node = static_cast<Node>(i);
      }
    }
    if (state_.margin_K >= config_.derating_K) state_.node = none;
    const float above_least = state_.margin_K * slope_;
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
    return granted;
  }

  /// Least power, or the demand if that is less, for a reason found elsewhere.
  LimitedPower cut(LimitReason reason, uint8_t demand = 255) noexcept {
    state_.ceiling = least_power();
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

  Config config_;
  State state_;
  float slope_;
};

}  // namespace thermopower
