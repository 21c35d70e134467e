// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "observer_measurement.hpp"
#include "two_node_thermal_model.hpp"

/// @file temperature_observer.hpp
/// Winding and body temperature with a standard deviation, from the model and from whatever is measured: an
/// extended Kalman filter with two states and scalar updates, small enough for an 8-bit chip.

namespace thermopower {

/// What one tunes in an observer.
struct TemperatureObserverConfig {
  TwoNodeThermalModel<float>::Config thermal;  ///< The model.
  float heat_error;   ///< The computed heat may be wrong by this fraction (1 sigma), for good. Above 0, at
                      ///< most 1.
  float air_error_K;  ///< The air may be off by this (1 sigma). >= 0.
  float gate_sigma;   ///< A measurement further away than this many sigma is not believed. Above 0; 3 to 5.
  float variance_s;  ///< The variances are carried in steps of this, the temperatures in every step. Above 0.

  /// A fifth of the heat, 2 K of air, 4 sigma, once a second.
  static TemperatureObserverConfig standard(const TwoNodeThermalModel<float>::Config& thermal) noexcept {
    const TemperatureObserverConfig config = {thermal, 0.2f, 2.0f, 4.0f, 1.0f};
    return config;
  }
  /// Hands each field to an archive, in the order of a record: config_record.hpp.
  template <class Self, class Archive>
  static void each_field(Self& self, Archive& archive) {
    archive(self.thermal, self.heat_error, self.air_error_K, self.gate_sigma, self.variance_s);
  }
  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept {
    if (is_error(thermal.validate())) return thermal.validate();
    if (is_error(detail::require_positive(heat_error, ConfigError::heat_error)) || heat_error > 1.0f)
      return ConfigError::heat_error;
    return first_error(detail::require_not_negative(air_error_K, ConfigError::air_error_K),
                       first_error(detail::require_positive(gate_sigma, ConfigError::gate_sigma),
                                   detail::require_positive(variance_s, ConfigError::variance_s)));
  }
};

/// Two-node temperature observer.
///
/// The model is stepped with `step()`; a measurement, when there is one, is taken in with `correct_winding()`
/// or `correct_body()`, at any rate. Without measurements the standard deviation grows to what the model's
/// own errors allow and no further. It starts worst case (`start_unknown`): as hot as its limits, and not
/// sure. A measurement that is hotter than expected is believed sooner than one that is colder: a wrong "hot"
/// costs power, a wrong "cold" costs the motor.
class TemperatureObserver {
public:
  typedef TemperatureObserverConfig Config;  ///< What one tunes.

  /// What one logs.
  struct State {
    float winding_C;            ///< Estimate.
    float body_C;               ///< Estimate.
    float winding_variance_K2;  ///< Of the winding's estimate.
    float shared_variance_K2;   ///< Covariance of the two.
    float body_variance_K2;     ///< Of the body's estimate.
    float innovation_K;         ///< Last measurement less expectation.
    uint16_t accepted;          ///< Measurements taken in. Stops at 65535.
    uint16_t rejected;          ///< Measurements outside the gate, or not valid. Stops at 65535.
    uint8_t hot_in_a_row;       ///< Rejected one after the other because they were too hot.
  };

  /// @param hottest_C  where an unknown actuator is assumed to be: its limit  @param air_C  the coolest it
  /// can be
  TemperatureObserver(const Config& config, float hottest_C, float air_C) noexcept : config_(config) {
    const float coupling = config.thermal.coupling_W_per_K,
                conductance = config.thermal.cooling.conductance_W_per_K;
    per_coupling_ = 1.0f / coupling;
    per_conductance_ = 1.0f / conductance;
    // Noise whose standing variance is (heat_error * rise)^2: for a lag of time constant t that is a density
    // of 2 var / t.
    const float heat = 2.0f * config.heat_error * config.heat_error * config.variance_s;
    winding_noise_ = heat * per_coupling_ / config.thermal.winding_heat_capacity_J_per_K;
    body_noise_ = heat * per_conductance_ / config.thermal.body_heat_capacity_J_per_K;
    air_noise_ = 2.0f * config.air_error_K * config.air_error_K * config.variance_s * conductance /
                 config.thermal.body_heat_capacity_J_per_K;
    variance_way_ = transition(config.variance_s);
    way_ = variance_way_;
    way_s_ = config.variance_s;
    start_unknown(hottest_C, air_C);
  }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// Nothing is known: at the limit, and not sure by half of the distance to the air.
  void start_unknown(float hottest_C, float air_C) noexcept {
    const float half_K = 0.5f * detail::magnitude(hottest_C - air_C) + 1.0f;
    // Both nodes were warmed together, so they are strongly correlated: measuring the one tells about the
    // other.
    start(hottest_C, hottest_C, half_K, half_K, 0.95f);
  }
  /// Something is known. @param correlation  of the two errors, 0 .. below 1
  void start(float winding_C, float body_C, float winding_std_K, float body_std_K,
             float correlation) noexcept {
    const State state = {winding_C,
                         body_C,
                         winding_std_K * winding_std_K,
                         correlation * winding_std_K * body_std_K,
                         body_std_K * body_std_K,
                         0.0f,
                         0,
                         0,
                         0};
    state_ = state;
    pending_s_ = 0.0f;
    heat_J2_ = 0.0f;
  }

  /// Carries the estimate over a step of constant heat. @param power_W  in the winding  @param dt_s  >= 0
  const State& step(float power_W, float air_C, float dt_s) noexcept {
    if (!(dt_s >= 0.0f) || !detail::is_finite(dt_s)) return state_;
    if (!(dt_s == way_s_)) {
      way_ = transition(dt_s);
      way_s_ = dt_s;
    }
    const float settled_body_C = air_C + power_W * per_conductance_;
    const float settled_winding_C = settled_body_C + power_W * per_coupling_;
    const float winding = state_.winding_C - settled_winding_C, body = state_.body_C - settled_body_C;
    state_.winding_C =
        state_.winding_C + (way_.from_winding_to_winding * winding + way_.from_body_to_winding * body);
    state_.body_C = state_.body_C + (way_.from_winding_to_body * winding + way_.from_body_to_body * body);
    pending_s_ += dt_s;
    heat_J2_ = power_W * power_W;
    if (pending_s_ >= config_.variance_s) {
      pending_s_ -= config_.variance_s;
      if (pending_s_ > config_.variance_s)
        pending_s_ = config_.variance_s;  // after a long gap: no more than two steps' lag
      carry_variances();
    }
    return state_;
  }

  /// Takes in a temperature of the winding. @return true when it was believed
  bool correct_winding(const MeasuredTemperature& measured) noexcept {
    return measured.is_valid ? correct(measured.value_C, measured.std_K, true) : reject();
  }
  /// Takes in a temperature of the body. @return true when it was believed
  bool correct_body(const MeasuredTemperature& measured) noexcept {
    return measured.is_valid ? correct(measured.value_C, measured.std_K, false) : reject();
  }

  /// Estimate plus some standard deviations, for `CertifiedLimiter::tighten()`. @param sigmas  3 covers 99.9
  /// % of normal errors
  float winding_upper_C(float sigmas) const noexcept {
    return state_.winding_C + sigmas * sqrtf(state_.winding_variance_K2);
  }
  float body_upper_C(float sigmas) const noexcept {
    return state_.body_C + sigmas * sqrtf(state_.body_variance_K2);
  }  ///< @copydoc winding_upper_C
  float winding_std_K() const noexcept { return sqrtf(state_.winding_variance_K2); }  ///< Standard deviation.
  float body_std_K() const noexcept { return sqrtf(state_.body_variance_K2); }        ///< Standard deviation.
  const State& state() const noexcept { return state_; }     ///< After the last call.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  // exp(A dt) - 1: what a step adds. The difference to 1 is kept, because a float near 1 would lose a short
  // step.
  struct Transition {
    float from_winding_to_winding, from_body_to_winding, from_winding_to_body, from_body_to_body;
  };

  Transition transition(float dt_s) const noexcept {
    const float out = config_.thermal.coupling_W_per_K / config_.thermal.winding_heat_capacity_J_per_K;
    const float in = config_.thermal.coupling_W_per_K / config_.thermal.body_heat_capacity_J_per_K;
    const float air =
        config_.thermal.cooling.conductance_W_per_K / config_.thermal.body_heat_capacity_J_per_K;
    const TwoNodeRates<float> rates = two_node_rates(out, in, air);
    const float fast = rates.fast_per_s, slow = rates.slow_per_s;
    const float slow_change = -slow * dt_s * detail::mean_decay(slow * dt_s);
    const float mix = (1.0f + slow_change) * dt_s * detail::mean_decay((fast - slow) * dt_s);
    const Transition way = {slow_change + mix * (slow - out), mix * out, mix * in,
                            slow_change + mix * (slow - in - air)};
    return way;
  }

  void carry_variances() noexcept {
    const Transition& way = variance_way_;
    const float ww = 1.0f + way.from_winding_to_winding, wb = way.from_body_to_winding;
    const float bw = way.from_winding_to_body, bb = 1.0f + way.from_body_to_body;
    const float v = state_.winding_variance_K2, c = state_.shared_variance_K2, u = state_.body_variance_K2;
    const float first = ww * v + wb * c, second = ww * c + wb * u, third = bw * c + bb * u;
    state_.winding_variance_K2 = ww * first + wb * second + winding_noise_ * heat_J2_;
    state_.shared_variance_K2 = bw * first + bb * second;
    state_.body_variance_K2 = bw * (bw * v + bb * c) + bb * third + body_noise_ * heat_J2_ + air_noise_;
  }

  bool correct(float value_C, float std_K, bool is_winding) noexcept {
    const float own = is_winding ? state_.winding_variance_K2 : state_.body_variance_K2;
    const float innovation_K = value_C - (is_winding ? state_.winding_C : state_.body_C);
    const float variance = own + std_K * std_K;
    state_.innovation_K = innovation_K;
    if (!(innovation_K * innovation_K <= config_.gate_sigma * config_.gate_sigma * variance)) {
      if (innovation_K > 0.0f && ++state_.hot_in_a_row >= 5) {
        // Five in a row are no stray: widen until the next one is believed. Colder ones never get this
        // credit.
        state_.hot_in_a_row = 0;
        (is_winding ? state_.winding_variance_K2 : state_.body_variance_K2) += innovation_K * innovation_K;
      }
      return reject();
    }
    state_.hot_in_a_row = 0;
    const float per_variance = 1.0f / variance;
    const float own_gain = own * per_variance, other_gain = state_.shared_variance_K2 * per_variance;
    float& own_C = is_winding ? state_.winding_C : state_.body_C;
    float& other_C = is_winding ? state_.body_C : state_.winding_C;
    float& own_variance = is_winding ? state_.winding_variance_K2 : state_.body_variance_K2;
    float& other_variance = is_winding ? state_.body_variance_K2 : state_.winding_variance_K2;
    own_C += own_gain * innovation_K;
    other_C += other_gain * innovation_K;
    // Joseph's form for the measured node: positive whatever is rounded.
    const float rest = 1.0f - own_gain;
    other_variance = detail::at_least(other_variance - other_gain * state_.shared_variance_K2, 1.0e-6f);
    own_variance = rest * rest * own + own_gain * own_gain * std_K * std_K;
    state_.shared_variance_K2 *= rest;
    if (state_.accepted < 65535u) ++state_.accepted;
    return true;
  }

  bool reject() noexcept {
    if (state_.rejected < 65535u) ++state_.rejected;
    return false;
  }

  Config config_;
  State state_;
  Transition way_, variance_way_;
  float way_s_, pending_s_ = 0.0f, heat_J2_ = 0.0f;
  float per_coupling_, per_conductance_, winding_noise_, body_noise_, air_noise_;
};

}  // namespace thermopower
