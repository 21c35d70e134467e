// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "temperature_observer.hpp"

/// @file observer_thermal.hpp
/// A temperature observer in the place of an axis's thermal model.

namespace thermopower {

/// Lets an `AxisController` estimate its temperature with a `TemperatureObserver`: name it as `Thermal` in
/// your motor. It steps at a fifth of the cost of `TwoNodeThermalModel` when the step length does not change,
/// and it starts worst case instead of as warm as the air. Measurements go in through
/// `axis.thermal().observer()`.
///
/// @snippet actuator_examples.cpp observed thermal
/// How to: @ref explain_observer.
class ObservedThermal {
public:
  typedef float Scalar;  ///< As the other thermal models have it.

  /// What one tunes.
  struct Config {
    TemperatureObserverConfig observer;  ///< Model and noise.
    float maximum_C;  ///< Where an unknown actuator is assumed to be: its limit. 0 .. 200 degC.
    uint8_t every;    ///< Step the observer in every n-th step only, with the mean heat. At least 1.
    uint8_t phase;    ///< In which of them, below `every`: give each axis its own, and they take turns.

    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.observer, self.maximum_C, self.every, self.phase);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept {
      if (every < 1 || phase >= every) return ConfigError::every;
      return first_error(observer.validate(),
                         detail::require_within(maximum_C, 0.0f, 200.0f, ConfigError::maximum_C));
    }
  };

  typedef TwoNodeThermalModel<float>::Inputs Inputs;  ///< Heat and air.

  /// What one logs.
  struct State {
    float winding_C;             ///< Estimate.
    float body_C;                ///< Estimate.
    float winding_rate_K_per_s;  ///< dT_w/dt at the start of the last step.
  };

  /// @param motor_C  temperature to start from; NaN: at the limit, and not sure
  ObservedThermal(const Config& config, float motor_C) noexcept
      : observer_(config.observer, config.maximum_C, 0.0f),
        maximum_C_(config.maximum_C),
        per_capacity_(1.0f / config.observer.thermal.winding_heat_capacity_J_per_K),
        per_turn_(1.0f / static_cast<float>(config.every < 1 ? 1 : config.every)),
        every_(config.every),
        turn_(config.phase) {
    start(motor_C);
  }

  /// Sets both nodes to a temperature that is known to 2 K. NaN: at the limit, and not sure.
  void start(float motor_C) noexcept {
    if (detail::is_finite(motor_C)) observer_.start(motor_C, motor_C, 2.0f, 2.0f, 0.5f);
    else observer_.start_unknown(maximum_C_, 0.0f);
    winding_rate_K_per_s_ = 0.0f;
  }
  /// What an axis calls when nobody told it a temperature: worst case. @param air_C  the coolest it can be
  void start_in(float air_C) noexcept {
    observer_.start_unknown(maximum_C_, air_C);
    winding_rate_K_per_s_ = 0.0f;
  }

  /// Advances by `dt_s` seconds (>= 0). Heat or air that is NaN makes the temperatures NaN, which every
  /// limiter treats as hot.
  State step(const Inputs& inputs, float dt_s) noexcept {
    float power_W = inputs.power_W;
    if (every_ > 1) {
      // Steps of equal length add up their powers alone; the time is counted.
      if (!detail::is_same(dt_s, each_s_)) {
        fold();
        each_s_ = dt_s;
      }
      sum_W_ += power_W;
      ++count_;
      if (++turn_ < every_) return state();
      turn_ = 0;
      if (count_ == every_) {
        power_W = sum_W_ * per_turn_;
        dt_s = each_s_ * static_cast<float>(every_);
      } else {
        fold();
        dt_s = pending_s_;
        if (dt_s > 0.0f) power_W = pending_J_ / dt_s;
      }
      pending_s_ = pending_J_ = sum_W_ = 0.0f;
      count_ = 0;
    }
    const TemperatureObserver::State& state = observer_.state();
    const float coupling_W_per_K = observer_.config().thermal.coupling_W_per_K;
    const float across_W = coupling_W_per_K * (state.winding_C - state.body_C);
    winding_rate_K_per_s_ = (power_W - across_W) * per_capacity_;
    observer_.step(power_W, inputs.around.air_C, dt_s);
    return this->state();
  }

  TemperatureObserver& observer() noexcept { return observer_; }              ///< To take in measurements.
  const TemperatureObserver& observer() const noexcept { return observer_; }  ///< Estimates, and how sure.
  /// After the last step, and with every measurement since.
  State state() const noexcept {
    const State state = {observer_.state().winding_C, observer_.state().body_C, winding_rate_K_per_s_};
    return state;
  }
  /// The node that decides.
  float hottest_C() const noexcept {
    return detail::at_least(observer_.state().winding_C, observer_.state().body_C);
  }
  float hottest_rate_K_per_s() const noexcept { return winding_rate_K_per_s_; }  ///< dT_w/dt.

private:
  void fold() noexcept {
    if (count_ == 0) return;
    pending_s_ += each_s_ * static_cast<float>(count_);
    pending_J_ += each_s_ * sum_W_;
    sum_W_ = 0.0f;
    count_ = 0;
  }

  TemperatureObserver observer_;
  float maximum_C_, per_capacity_, per_turn_;
  float winding_rate_K_per_s_ = 0.0f;
  float each_s_ = 0.0f, sum_W_ = 0.0f;         // steps of one length
  float pending_s_ = 0.0f, pending_J_ = 0.0f;  // and of other lengths before them
  uint8_t every_, turn_, count_ = 0;
};

}  // namespace thermopower
