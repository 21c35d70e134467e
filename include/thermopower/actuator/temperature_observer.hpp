// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "observer_measurement.hpp"
#include "two_node_thermal_model.hpp"

/// @file temperature_observer.hpp
/// Winding and body temperature with a standard deviation, from the model and from whatever is measured: an
/// extended Kalman filter with two states and scalar updates, small enough for an 8-bit chip.
///
/// Most errors here are standing ones: heat that is a fifth too high stays so, and a voltage that reads 1 % low
/// reads low in every sample. Averaging a thousand samples takes no such error away, so the filter carries for
/// each of them how much of it is in the estimate (a Schmidt-Kalman filter: the errors are considered, not
/// estimated).

namespace thermopower {

/// What one tunes in an observer.
struct TemperatureObserverConfig {
  TwoNodeThermalModel<float>::Config thermal;  ///< The model.
  float heat_error;   ///< The computed heat may be wrong by this fraction (1 sigma), for good. Above 0, at
                      ///< most 1.
  float air_error_K;  ///< The air may be off by this (1 sigma), for good. >= 0.
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
/// own errors allow and no further; with measurements it does not fall below what their standing errors leave.
/// It starts worst case (`start_unknown`): as hot as its limits, and not
/// sure. A measurement that is hotter than expected is believed sooner than one that is colder: a wrong "hot"
/// costs power, a wrong "cold" costs the motor.
///
/// @snippet actuator_examples.cpp observer
/// How to: @ref explain_observer.
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
    per_coupling_ = 1.0f / config.thermal.coupling_W_per_K;
    per_conductance_ = 1.0f / config.thermal.cooling.conductance_W_per_K;
    heat_error_per_s_ = config.heat_error / config.variance_s;
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
    for (uint8_t cause = 0; cause < cause_count; ++cause)
      standing_[cause].winding_K = standing_[cause].body_K = 0.0f;
    causes_ = body_sensor;
    // Half a carry ahead: between two of them the variances are early as long as they are late.
    pending_s_ = 0.5f * config_.variance_s;
    pending_J_ = 0.0f;
    stage_ = 0;
  }

  /// Carries the estimate over a step of constant heat. @param power_W  in the winding  @param dt_s  >= 0, any gap
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
    pending_J_ += power_W * dt_s;
    if (pending_s_ >= config_.variance_s) carry_variances(dt_s);
    return state_;
  }

  /// Takes in a temperature of the winding. @return true when it was believed
  bool correct_winding(const MeasuredTemperature& measured) noexcept {
    return measured.is_valid ? correct(measured, true) : reject();
  }
  /// A reading whose uncertainty was judged by the reading itself is refused, in a sentence.
  template <class Reading>
  bool correct_winding(const Reading&) noexcept {
    static_assert(
        sizeof(Reading) == 0,
        "thermopower: an observer takes the winding's voltage and current: correct_winding(winding, "
        "v_rms_V, current_A); winding.measure(v_rms_V, current_A) is too sure of noise that looks cold");
    return false;
  }
  /// Takes in voltage and current of the winding. @return true when they were believed
  /// @param winding    what makes a temperature of them  @param v_rms_V, current_A  as its `measure()` takes them
  bool correct_winding(const WindingResistance& winding, float v_rms_V, float current_A) noexcept {
    return correct_winding(winding.measure(v_rms_V, current_A, state_.winding_C));
  }
  /// Takes in a temperature of the body. @return true when it was believed
  bool correct_body(const MeasuredTemperature& measured) noexcept {
    return measured.is_valid ? correct(measured, false) : reject();
  }

  /// True for a few steps in every `variance_s`, while the variances are being carried. A measurement may come
  /// at any time; one that comes now pays for what is left of that, and a chip with little time asks first.
  bool is_carrying() const noexcept { return stage_ != 0; }

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
    const float to_air =
        config_.thermal.cooling.conductance_W_per_K / config_.thermal.body_heat_capacity_J_per_K;
    const TwoNodeRates<float> rates = two_node_rates(out, in, to_air);
    const float fast = rates.fast_per_s, slow = rates.slow_per_s;
    const float slow_change = -slow * dt_s * detail::mean_decay(slow * dt_s);
    const float mix = (1.0f + slow_change) * dt_s * detail::mean_decay((fast - slow) * dt_s);
    const Transition way = {slow_change + mix * (slow - out), mix * out, mix * in,
                            slow_change + mix * (slow - in - to_air)};
    return way;
  }

  // Standing errors of one standard deviation each, independent of each other.
  enum Cause : uint8_t { heat = 0, air = 1, winding_sensor = 2, body_sensor = 3, cause_count = 4 };
  // A number of the winding and one of the body.
  struct Pair {
    float of_winding, of_body;
  };
  // How much of one is in each estimate: the covariance of estimate and cause.
  struct Standing {
    float winding_K, body_K;
  };

  // Temperatures move in seconds: of short steps each does a fourth of the work.
  void carry_variances(float dt_s) noexcept {
    if (dt_s > config_.variance_s) {
      carry_gap();
      return;
    }
    const bool is_long_step = dt_s * 10.0f > config_.variance_s;
    do {
      carry_stage();
    } while (is_long_step && pending_s_ >= config_.variance_s);
  }
  // A long step at once, by the exact way over all that is pending but half a carry: right for every length, and a long
  // gap takes no more time than a short one.
  void carry_gap() noexcept {
    while (is_carrying()) carry_stage();
    const float left_s = 0.5f * config_.variance_s, heat_W = pending_J_ / pending_s_;
    const Transition way = transition(pending_s_ - left_s);
    pending_s_ = left_s;
    pending_J_ = heat_W * left_s;
    const Pair to_winding = {1.0f + way.from_winding_to_winding, way.from_body_to_winding};
    const Pair to_body = {way.from_winding_to_body, 1.0f + way.from_body_to_body};
    const float winding_K2 = product(to_winding, to_winding), shared_K2 = product(to_winding, to_body);
    state_.body_variance_K2 = product(to_body, to_body);
    state_.winding_variance_K2 = winding_K2;
    state_.shared_variance_K2 = shared_K2;
    for (uint8_t cause = 0; cause < causes_; ++cause) {
      const Pair before = {standing_[cause].winding_K, standing_[cause].body_K};
      standing_[cause].winding_K = sum_of(to_winding, before);
      standing_[cause].body_K = sum_of(to_body, before);
    }
    add_air(way);
    add_heat(way, config_.heat_error * heat_W);
  }
  [[gnu::noinline]] static float sum_of(const Pair& row, const Pair& of) noexcept {
    return row.of_winding * of.of_winding + row.of_body * of.of_body;
  }
  // One row, the covariances, another row.
  [[gnu::noinline]] float product(const Pair& row, const Pair& other) const noexcept {
    const Pair between = {sum_of(other, {state_.winding_variance_K2, state_.shared_variance_K2}),
                          sum_of(other, {state_.shared_variance_K2, state_.body_variance_K2})};
    return sum_of(row, between);
  }
  // x becomes F x + (what the causes add), one row of F after the other: each stage alone is a linear map of
  // estimates and causes, so that a covariance stays one.
  void carry_stage() noexcept {
    const uint8_t stage = stage_;
    stage_ = static_cast<uint8_t>(stage < 3 ? stage + 1 : 0);
    if (stage == 0) carry_winding();
    else if (stage == 1) carry_body();
    else if (stage == 2) add_air(variance_way_);
    else add_pending_heat();
  }
  void carry_winding() noexcept {
    const float own = 1.0f + variance_way_.from_winding_to_winding,
                other = variance_way_.from_body_to_winding;
    const float v = state_.winding_variance_K2, c = state_.shared_variance_K2, u = state_.body_variance_K2;
    state_.shared_variance_K2 = own * c + other * u;
    state_.winding_variance_K2 = own * (own * v + other * c) + other * state_.shared_variance_K2;
    for (uint8_t cause = 0; cause < causes_; ++cause)
      standing_[cause].winding_K = own * standing_[cause].winding_K + other * standing_[cause].body_K;
  }
  void carry_body() noexcept {
    // From the winding as it is carried already.
    const float other = variance_way_.from_winding_to_body / (1.0f + variance_way_.from_winding_to_winding);
    const float own = 1.0f + variance_way_.from_body_to_body - other * variance_way_.from_body_to_winding;
    const float v = state_.winding_variance_K2, c = state_.shared_variance_K2, u = state_.body_variance_K2;
    state_.shared_variance_K2 = own * c + other * v;
    state_.body_variance_K2 = own * (own * u + other * c) + other * state_.shared_variance_K2;
    for (uint8_t cause = 0; cause < causes_; ++cause)
      standing_[cause].body_K = own * standing_[cause].body_K + other * standing_[cause].winding_K;
  }
  // What a step leaves of a settled rise: in the air's, both nodes take part alike.
  void add_air(const Transition& way) noexcept {
    add(air, -config_.air_error_K * (way.from_winding_to_winding + way.from_body_to_winding),
        -config_.air_error_K * (way.from_winding_to_body + way.from_body_to_body));
  }
  void add_pending_heat() noexcept {
    // All the energy since the last time, whether that was a step more or less than a carry ago: none is lost,
    // and no division is needed. Only of a long step a part is left for the next carry.
    float energy_J = pending_J_, rest_J = 0.0f;
    const float rest_s = pending_s_ - config_.variance_s;
    if (rest_s >= config_.variance_s) {
      energy_J *= config_.variance_s / pending_s_;
      rest_J = pending_J_ - energy_J;
    }
    pending_s_ = rest_s;
    pending_J_ = rest_J;
    add_heat(variance_way_, energy_J * heat_error_per_s_);
  }
  void add_heat(const Transition& way, float heat_W) noexcept {
    const float body_K = heat_W * per_conductance_, winding_K = body_K + heat_W * per_coupling_;
    add(heat, -(way.from_winding_to_winding * winding_K + way.from_body_to_winding * body_K),
        -(way.from_winding_to_body * winding_K + way.from_body_to_body * body_K));
  }
  void add(Cause cause, float winding_K, float body_K) noexcept {
    Standing& standing = standing_[cause];
    const float before_winding_K = standing.winding_K, before_body_K = standing.body_K;
    standing.winding_K += winding_K;
    standing.body_K += body_K;
    state_.winding_variance_K2 += winding_K * (before_winding_K + standing.winding_K);
    state_.shared_variance_K2 += winding_K * standing.body_K + before_winding_K * body_K;
    state_.body_variance_K2 += body_K * (before_body_K + standing.body_K);
  }

  bool correct(const MeasuredTemperature& measured, bool is_winding) noexcept {
    while (is_carrying()) carry_stage();
    const Cause sensor = is_winding ? winding_sensor : body_sensor;
    if (!is_winding) causes_ = cause_count;
    float& own_C = is_winding ? state_.winding_C : state_.body_C;
    float& other_C = is_winding ? state_.body_C : state_.winding_C;
    float& own_variance = is_winding ? state_.winding_variance_K2 : state_.body_variance_K2;
    float& other_variance = is_winding ? state_.body_variance_K2 : state_.winding_variance_K2;
    const float own_K = is_winding ? standing_[sensor].winding_K : standing_[sensor].body_K;
    const float other_K = is_winding ? standing_[sensor].body_K : standing_[sensor].winding_K;

    // A standing error that is in the estimate already is in the measurement again: `standing_[]` is the
    // estimate's error, so the innovation has the sum of both.
    const float standing_K = measured.standing_std_K;
    const float innovation_K = measured.value_C - own_C;
    const float noise = measured.std_K * measured.std_K;
    const float shared = own_K * standing_K;
    const float own_share = own_variance + shared;
    const float square = standing_K * standing_K;
    const float variance = own_share + shared + square + noise;
    state_.innovation_K = innovation_K;
    if (!(innovation_K * innovation_K <= config_.gate_sigma * config_.gate_sigma * variance)) {
      if (innovation_K > 0.0f && ++state_.hot_in_a_row >= 5) {
        // Five in a row are no stray: widen until the next one is believed. Colder ones never get this
        // credit.
        state_.hot_in_a_row = 0;
        own_variance += innovation_K * innovation_K;
      }
      return reject();
    }
    state_.hot_in_a_row = 0;
    const float per_variance = 1.0f / variance;
    const float other_share = state_.shared_variance_K2 + other_K * standing_K;
    const float own_gain = own_share * per_variance, other_gain = other_share * per_variance;
    own_C += own_gain * innovation_K;
    other_C += other_gain * innovation_K;
    // own - own_share^2 / variance, of positive parts alone: what stands in an estimate is part of its variance.
    const float random_part = detail::at_least(own_variance - own_K * own_K, 0.0f);
    own_variance = detail::at_least((own_variance * noise + square * random_part) * per_variance, 1.0e-6f);
    other_variance = detail::at_least(other_variance - other_gain * other_share, 1.0e-6f);
    state_.shared_variance_K2 -= own_gain * other_share;
    const float winding_gain = is_winding ? own_gain : other_gain;
    const float body_gain = is_winding ? other_gain : own_gain;
    for (uint8_t cause = 0; cause < causes_; ++cause) {
      Standing& standing = standing_[cause];
      float seen_K = is_winding ? standing.winding_K : standing.body_K;
      if (cause == sensor) seen_K += standing_K;
      standing.winding_K -= winding_gain * seen_K;
      standing.body_K -= body_gain * seen_K;
    }
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
  Standing standing_[cause_count];
  float way_s_, pending_s_ = 0.0f, pending_J_ = 0.0f;
  float per_coupling_, per_conductance_;
  float heat_error_per_s_;        // over the length of a carry
  uint8_t causes_ = body_sensor;  // a body's sensor costs nothing until there is one
  uint8_t stage_ = 0;
};

}  // namespace thermopower
