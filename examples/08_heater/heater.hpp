// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// A printer's heater in firmware: PID, the usual checks as policies, and beside them a guard of the thermistor and the monitor.
// C++11, no heap: take it as it is.

#include <thermopower/control/sensor_guard.hpp>
#include <thermopower/monitor/model_monitor.hpp>

namespace heater {

namespace tp = thermopower;

//! [printer heaters]
/// A hotend of 40 W: 13 J/K of block and 2 of element, 3 behind it, a fan. Calibrated to 6 %.
struct Hotend {
  static constexpr tp::MonitorConfig monitor() { return {3.0, 1000.0, true}; }  // blocks, false alarms, cuts
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return {40.0,        // W at full duty and 24 V
            0.06,        // off by 6 %
            15.0, 0.06,  // J/K that follow the thermistor
            3.0,  75.0,  // J/K that follow 75 s later,
            0.15,        //   both off by 15 %
            3.5,  0.15,  // s until heat shows: element and thermistor
            0.10, 0.06,  // W/K to the air,
            0.05, 0.10,  //   and what the full fan adds
            5.0,         // K that the air may be off
            0.07, 0.03,  // K of noise and resolution of the thermistor
            0.2};        // J by which the heat of a second is off at random
  }
  static constexpr float ohm_at_20C() { return 14.4f; }
  static constexpr float tempco_per_K() { return 0.0002f; }
  static constexpr float highest_C() { return 275.0f; }
};

/// A bed of 220 W under glass, its trace of copper.
struct Bed {
  static constexpr tp::MonitorConfig monitor() { return {8.0, 1000.0, true}; }
  static constexpr tp::HeatBalanceConfig heat_balance() {
    return {221.0, 0.05, 850.0, 0.05, 450.0, 75.0, 0.10, 7.75, 0.15,
            1.3,   0.06, 0.8,   0.10, 3.0,   0.05, 0.02, 1.0};
  }
  static constexpr float ohm_at_20C() { return 2.6f; }
  static constexpr float tempco_per_K() { return 0.0039f; }
  static constexpr float highest_C() { return 120.0f; }
};
//! [printer heaters]

/// A check in the manner of Marlin: while heating, so many kelvins in each period; once there, not below the target for longer
/// than a period.
class RunawayCheck {
public:
  struct Config {
    float watch_s, watch_K;        ///< While heating.
    float period_s, hysteresis_K;  ///< Once there.
    static constexpr Config hotend() { return {20.0f, 2.0f, 40.0f, 4.0f}; }
    static constexpr Config bed() { return {60.0f, 2.0f, 20.0f, 2.0f}; }
  };
  explicit RunawayCheck(const Config& config) : config_(config) {}

  /// False once the check has failed.
  bool step(float target_C, float measured_C, float dt_s) {
    if (!(target_C > 0.0f)) is_watching_ = is_there_ = false;
    if (target_C != last_target_C_) {
      is_there_ = false;
      watch_anew(measured_C);
      is_watching_ = target_C > measured_C + config_.watch_K;
    }
    last_target_C_ = target_C;
    timer_s_ += dt_s;
    if (measured_C >= target_C - config_.hysteresis_K) {
      is_there_ = true;
      is_watching_ = false;
      timer_s_ = 0.0f;
    } else if (is_watching_ && measured_C >= goal_C_) {
      watch_anew(measured_C);
    } else if ((is_watching_ && timer_s_ > config_.watch_s) || (is_there_ && timer_s_ > config_.period_s)) {
      has_failed_ = true;
    }
    return !has_failed_;
  }

private:
  void watch_anew(float measured_C) {
    goal_C_ = measured_C + config_.watch_K;
    timer_s_ = 0.0f;
  }
  Config config_;
  float last_target_C_ = 0.0f, goal_C_ = 0.0f, timer_s_ = 0.0f;
  bool is_watching_ = false, is_there_ = false, has_failed_ = false;
};

/// A check in the manner of Klipper: the sum of kelvins below the target, second by second, unless the temperature still rises.
class KelvinSumCheck {
public:
  struct Config {
    float most_Ks, hysteresis_K, gain_K, gain_s;
    static constexpr Config hotend() { return {120.0f, 5.0f, 2.0f, 20.0f}; }
    static constexpr Config bed() { return {120.0f, 5.0f, 2.0f, 60.0f}; }
  };
  explicit KelvinSumCheck(const Config& config) : config_(config) {}

  /// False once the check has failed.
  bool step(float target_C, float measured_C, float dt_s) {
    now_s_ += dt_s;
    const bool is_new = target_C != last_target_C_;
    last_target_C_ = target_C;
    if (measured_C >= target_C - config_.hysteresis_K || !(target_C > 0.0f)) {
      is_approaching_ = false;
      if (measured_C <= target_C + config_.hysteresis_K) sum_Ks_ = 0.0f;
      return !has_failed_;
    }
    sum_Ks_ += (target_C - config_.hysteresis_K - measured_C) * dt_s;
    if (!is_approaching_) {
      if (is_new) approach(measured_C);
      else if (sum_Ks_ >= config_.most_Ks) has_failed_ = true;
    } else if (measured_C >= goal_C_) {
      sum_Ks_ = 0.0f;
      approach(measured_C);
    } else if (now_s_ >= goal_s_) {
      is_approaching_ = false;
    }
    return !has_failed_;
  }

private:
  void approach(float measured_C) {
    is_approaching_ = true;
    goal_C_ = measured_C + config_.gain_K;
    goal_s_ = now_s_ + config_.gain_s;
  }
  Config config_;
  float now_s_ = 0.0f, last_target_C_ = 0.0f, sum_Ks_ = 0.0f, goal_C_ = 0.0f, goal_s_ = 0.0f;
  bool is_approaching_ = false, has_failed_ = false;
};

/// A check in the manner of drives: the reading moves faster than anything heated does.
class RateCheck {
public:
  struct Config {
    float fastest_K_per_s;
    static constexpr Config hotend() { return {12.0f}; }
    static constexpr Config bed() { return {4.0f}; }
  };
  explicit RateCheck(const Config& config) : config_(config) {}
  /// False once the check has failed.
  bool step(float, float measured_C, float dt_s) {
    since_s_ += dt_s;
    if (since_s_ < 1.0f) return !has_failed_;
    const float change_K = measured_C - last_C_;
    if (has_last_ &&
        (change_K > config_.fastest_K_per_s * since_s_ || change_K < -config_.fastest_K_per_s * since_s_))
      has_failed_ = true;
    last_C_ = measured_C;
    has_last_ = true;
    since_s_ = 0.0f;
    return !has_failed_;
  }

private:
  Config config_;
  float last_C_ = 0.0f, since_s_ = 0.0f;
  bool has_last_ = false, has_failed_ = false;
};

/// A PID that does not wind up. Its output is a duty, 0 .. 1.
class Pid {
public:
  struct Config {
    float per_K, per_K_s, s_per_K, filter_s;
    static constexpr Config hotend() { return {0.05f, 0.0015f, 0.15f, 2.0f}; }
    static constexpr Config bed() { return {0.12f, 0.0008f, 0.5f, 6.0f}; }
  };
  explicit Pid(const Config& config) : config_(config) {}

  float step(float target_C, float measured_C, float dt_s) {
    if (!has_last_) smooth_C_ = measured_C;
    has_last_ = true;
    const float share = dt_s < config_.filter_s ? dt_s / config_.filter_s : 1.0f;
    const float change_K = share * (measured_C - smooth_C_);
    smooth_C_ += change_K;
    const float missing_K = target_C - measured_C;
    const float direct = config_.per_K * missing_K - (dt_s > 0.0f ? config_.s_per_K * change_K / dt_s : 0.0f);
    const float wanted = direct + integral_;
    if ((wanted < 1.0f || missing_K < 0.0f) && (wanted > 0.0f || missing_K > 0.0f))
      integral_ += config_.per_K_s * missing_K * dt_s;
    integral_ = integral_ < 0.0f ? 0.0f : (integral_ > 1.0f ? 1.0f : integral_);
    return wanted < 0.0f ? 0.0f : (wanted > 1.0f ? 1.0f : wanted);
  }

private:
  Config config_;
  float integral_ = 0.0f, smooth_C_ = 0.0f;
  bool has_last_ = false;
};

/// Heat at a duty, as the firmware knows it: supply and the element's resistance, as warm as the thermistor.
template <class Plant>
float heat_W(float duty, float supply_V, float measured_C) {
  return duty * supply_V * supply_V /
         (Plant::ohm_at_20C() * (1.0f + Plant::tempco_per_K() * (measured_C - 20.0f)));
}

/// What the thermistor should read by the declared constants alone: no reading corrects it, so none can talk it out of a fault.
template <class Plant>
class Expected {
public:
  /// As warm as the first good reading. @return false before it
  bool start(float measured_C) {
    late_W_ = 0.0f;
    body_C_ = second_C_ = measured_C;
    return is_started_ = true;
  }
  bool is_started() const { return is_started_; }
  float second_C() const { return second_C_; }
  float late_W() const { return late_W_; }

  /// @param heat_W  mean heat since the last step  @return degC, NaN before the start
  float step(float heat_W, float air_C, uint8_t fan, float dt_s) {
    constexpr tp::HeatBalanceConfig body = Plant::heat_balance();
    constexpr float lag_s = float(body.lag_s), second_s = float(body.second_s),
                    second_J_per_K = float(body.second_J_per_K), loss_W_per_K = float(body.loss_W_per_K),
                    fan_W_per_K = float(body.fan_W_per_K / 255.0), per_J = float(1.0 / body.capacity_J_per_K);
    const float share = dt_s / (lag_s + dt_s), second_share = dt_s / (second_s + dt_s);
    if (dt_s > 0.0f) late_W_ += share * (heat_W - late_W_);
    const float warmer_K = second_J_per_K > 0.0f ? second_share * (body_C_ - second_C_) : 0.0f;
    second_C_ += warmer_K;
    const float lost_W = (loss_W_per_K + fan_W_per_K * fan) * (body_C_ - air_C);
    body_C_ += per_J * (dt_s * (late_W_ - lost_W) - second_J_per_K * warmer_K);
    return body_C_;
  }

private:
  float late_W_ = 0.0f, body_C_ = tp::detail::not_a_number(), second_C_ = tp::detail::not_a_number();
  bool is_started_ = false;
};

/// How fast a true reading can fall: as fast as the body cools without any heat and with all that may be lost. A thermistor that comes
/// loose falls faster.
template <class Plant>
class FallCheck {
public:
  /// @param measured_C  a reading that the guard believes, or NaN  @param second_C  of the second mass, as expected
  /// @return false from when readings have been below what is possible for three seconds, and ever after
  bool step(float measured_C, float second_C, float air_C, float dt_s) {
    constexpr tp::HeatBalanceConfig body = Plant::heat_balance();
    constexpr float per_J_per_K = float(1.5 / (body.capacity_J_per_K * (1.0 - body.capacity_error)));
    constexpr float loss_W_per_K =
        float(body.loss_W_per_K * (1.0 + body.loss_error) + body.fan_W_per_K * (1.0 + body.fan_error));
    constexpr float second_W_per_K =
        body.second_J_per_K > 0.0 ? float(body.second_J_per_K / body.second_s) : 0.0f;
    constexpr float full_W = float(body.full_W), air_error_K = float(body.air_error_K),
                    margin_K = float(2.0 + 8.0 * body.noise_K);
    const float second_K = lowest_C_ - second_C, rise_K = lowest_C_ - air_C + air_error_K;
    float lost_W = rise_K > 0.0f ? loss_W_per_K * rise_K : 0.0f;
    if (second_K > 0.0f) lost_W += second_W_per_K * second_K;
    lowest_C_ -= dt_s * per_J_per_K * lost_W;
    // A single reading that is too high must not make the next ones too low.
    const float highest_C = lowest_C_ + dt_s * per_J_per_K * full_W;
    if (!(lowest_C_ > -300.0f)) lowest_C_ = measured_C;
    else if (measured_C > lowest_C_) lowest_C_ = measured_C < highest_C ? measured_C : highest_C;
    if (measured_C < lowest_C_ - margin_K) below_s_ += dt_s;
    else if (measured_C >= lowest_C_ - margin_K) below_s_ = 0.0f;
    has_fallen_ = has_fallen_ || below_s_ > 3.0f;
    return !has_fallen_;
  }
  /// A pause of unknown length.
  void restart() {
    lowest_C_ = tp::detail::not_a_number();
    below_s_ = 0.0f;
  }

private:
  float lowest_C_ = tp::detail::not_a_number(), below_s_ = 0.0f;
  bool has_fallen_ = false;
};

/// Which of the suspects are the likeliest: by nominal constants, how much heat was missing until the alarm, and how much is while the
/// heater cools. A weak heater lacks nothing without power. A larger or smaller loss, a fan and wrong air go on.
template <class Plant>
class Ranking {
public:
  /// @param late_W  heat as it arrives  @param is_begun  there is evidence  @param is_found  the monitor has alarmed
  void step(float late_W, float measured_C, float air_C, uint8_t fan, float dt_s, bool is_begun,
            bool is_found) {
    constexpr tp::HeatBalanceConfig body = Plant::heat_balance();
    constexpr float second_s = float(body.second_s), loss_W_per_K = float(body.loss_W_per_K),
                    fan_W_per_K = float(body.fan_W_per_K / 255.0);
    if (!(measured_C > -300.0f) || !(dt_s > 0.0f)) return;
    if (!(second_C_ > -300.0f)) second_C_ = measured_C;
    if (second_s > 0.0f) second_C_ += dt_s / (second_s + dt_s) * (measured_C - second_C_);
    const float rise_K = measured_C - air_C;
    const bool is_first = is_found && !has_alarmed_;
    has_alarmed_ = is_found;
    if (is_first) {
      until_ = now_;
      found_K_ = rise_K;
    }
    // Sums begin with the evidence, and anew with the alarm. Half cold, what is left says little.
    if (is_first || !(now_.s > 0.0f) || (!is_begun && !is_found)) now_.start(measured_C, second_C_);
    else if (is_found && rise_K < 0.5f * found_K_) return;
    now_.s += dt_s;
    now_.heat_J += dt_s * late_W;
    now_.lost_J += dt_s * (loss_W_per_K + fan_W_per_K * fan) * rise_K;
    now_.last_C = measured_C;
    now_.last_second_C = second_C_;
  }
  /// @param suspects  a sum of `Suspect`  @return those of them that the cooling speaks for; all where it does not tell
  uint8_t likeliest(uint8_t suspects) const {
    const uint8_t of_heat = suspects & uint8_t(static_cast<uint8_t>(tp::Suspect::heater) |
                                               static_cast<uint8_t>(tp::Suspect::thermometer)),
                  of_loss = suspects & static_cast<uint8_t>(~of_heat);
    if (!has_alarmed_ || !(until_.heat_J > 0.0f) || !(until_.lost_J > 0.0f) || of_heat == 0 || of_loss == 0)
      return suspects;
    const float lacked_W = until_.missing_J() / until_.s, lacks_W = now_.missing_J() / now_.s;
    // What is left of the heat, and of what is lost.
    const float heat = now_.heat_J / now_.s * until_.s / until_.heat_J,
                lost = now_.lost_J / now_.s * until_.s / until_.lost_J;
    if (!(lost - heat > 0.3f)) return suspects;
    const float middle_W = 0.5f * lacked_W * (heat + lost);
    return (lacked_W > 0.0f ? lacks_W < middle_W : lacks_W > middle_W) ? of_heat : of_loss;
  }

private:
  /// Sums over a time.
  struct Course {
    float s = 0.0f, heat_J = 0.0f, lost_J = 0.0f, start_C = 0.0f, last_C = 0.0f, start_second_C = 0.0f,
          last_second_C = 0.0f;
    void start(float measured_C, float second_C) {
      *this = Course();
      start_C = measured_C;
      start_second_C = second_C;
    }
    float missing_J() const {
      constexpr tp::HeatBalanceConfig body = Plant::heat_balance();
      return heat_J - lost_J - float(body.capacity_J_per_K) * (last_C - start_C) -
             float(body.second_J_per_K) * (last_second_C - start_second_C);
    }
  };
  Course now_, until_;
  float second_C_ = tp::detail::not_a_number(), found_K_ = 0.0f;
  bool has_alarmed_ = false;
};

/// The guard's bounds follow from the constants': a true reading is colder than expected by no more than heat and loss are off.
template <class Plant>
tp::SensorGuard::Config guard_of() {
  const tp::HeatBalanceConfig body = Plant::heat_balance();
  const double loss_error = body.loss_error > body.fan_error ? body.loss_error : body.fan_error;
  const double colder_K =
      1.2 * (body.heat_error + loss_error) * static_cast<double>(Plant::highest_C()) + body.air_error_K + 5.0;
  const tp::SensorGuard::Config config = {
      2.0f,  // a printer works in a heated room; what is off often reads 0
      Plant::highest_C(),
      static_cast<float>(4.0 * body.full_W / body.capacity_J_per_K + 60.0 * body.noise_K),
      static_cast<float>(0.6 * body.resolution_K),  // one count is a movement
      static_cast<float>(0.25 * colder_K),
      static_cast<float>(colder_K),
      static_cast<float>(Plant::monitor().block_s)};
  return config;
}

//! [heater watch]
/// The thermistor behind a guard, and the heat behind the monitor.
/// @tparam Plant  constants, such as Hotend
template <class Plant>
class Watch {
public:
  /// @param heat_W  mean heat since the last step  @return why to cut; `none` when all is well
  tp::LimitReason step(float heat_W, float measured_C, float air_C, uint8_t fan, float dt_s) {
    constexpr float full_W = float(Plant::heat_balance().full_W);
    // What no heater makes, and no room has, must not stay in the model: one cycle of it would take minutes to cool.
    const bool is_heat = heat_W >= 0.0f && heat_W <= 1.5f * full_W, is_air = air_C > -50.0f && air_C < 100.0f;
    if (is_air) air_C_ = air_C;
    const tp::SensorGuard::Config& range = guard_.config();
    const bool is_paused =
        dt_s > 8.0f;  // too long to know what the heater did meanwhile: the monitor starts anew, too
    if ((is_paused || !expected_.is_started()) && measured_C >= range.lowest_C &&
        measured_C <= range.highest_C)
      expected_.start(measured_C);
    const float passed_s = dt_s > 0.0f && !is_paused ? dt_s : 0.0f;
    const float expected_C = expected_.step(is_heat ? heat_W : full_W, air_C_, fan, passed_s);
    still_s_ = measured_C == last_C_ ? still_s_ + passed_s : 0.0f;
    last_C_ = measured_C;
    reading_ = guard_.step({measured_C, expected_C}, dt_s);
    // The monitor judges good readings only: a bridged one is not measured.
    monitor_.step(tp::MonitorInputs::heater(heat_W, guard_.upper(0.0f), air_C, fan), dt_s);
    ranking_.step(expected_.late_W(), guard_.upper(0.0f), air_C_, fan, passed_s,
                  !monitor_.heat().evidence().is_none(), monitor_.disagreement() != tp::Disagreement::none);
    if (is_paused) fall_.restart();
    has_fallen_ = !fall_.step(guard_.upper(0.0f), expected_.second_C(), air_C_, passed_s);
    const tp::LimitReason found = monitor_.limit(255).reason;
    if (has_fallen_) return tp::LimitReason::sensor_too_fast;
    if (found != tp::LimitReason::none) return found;
    if (!is_heat) return tp::LimitReason::supply_implausible;
    return is_air ? reading_.fault() : tp::LimitReason::air_implausible;
  }
  /// What may be believed of the temperature; a bad reading is bridged for a while.
  tp::GuardedCelsius reading() const { return reading_; }
  /// A sum of `Suspect`: the monitor's, the thermometer where it stood still meanwhile, or what the guard's reason means.
  uint8_t suspects() const {
    const uint8_t sensor = static_cast<uint8_t>(tp::Suspect::thermometer);
    // A reading that stands still while the heat changes, or falls as no body does, is the plainest of all.
    if (has_fallen_ || guard_.state().reason == tp::LimitReason::sensor_stuck) return sensor;
    if (monitor_.disagreement() != tp::Disagreement::none)
      return static_cast<uint8_t>(monitor_.suspects() | (still_s_ > monitor_.record().since_s ? sensor : 0));
    if (reading_.fault() == tp::LimitReason::none) return 0;
    return reading_.fault() != tp::LimitReason::sensor_disagrees
               ? sensor
               : static_cast<uint8_t>(sensor | static_cast<uint8_t>(tp::Suspect::heater) |
                                      static_cast<uint8_t>(tp::Suspect::loss) |
                                      static_cast<uint8_t>(tp::Suspect::fan));
  }
  /// Those of the suspects that the cooling after a cut speaks for; after a quarter of a minute of a hotend, a minute of a bed.
  uint8_t likeliest() const { return ranking_.likeliest(suspects()); }
  const tp::SensorGuard& guard() const { return guard_; }
  const tp::ModelMonitor<Plant>& monitor() const { return monitor_; }

private:
  Expected<Plant> expected_;
  FallCheck<Plant> fall_;
  Ranking<Plant> ranking_;
  tp::SensorGuard guard_ = tp::SensorGuard(guard_of<Plant>());
  tp::GuardedCelsius reading_;
  tp::ModelMonitor<Plant> monitor_;
  bool has_fallen_ = false;
  float air_C_ = 20.0f;                   // the last that can be
  float last_C_ = 0.0f, still_s_ = 0.0f;  // the raw reading, and for how long it has not moved by a count
};
//! [heater watch]

//! [printer heater]
/// A heater with everything that may cut it.
/// @tparam Plant  constants, such as Hotend  @tparam Check  the usual check, such as RunawayCheck
template <class Plant, class Check>
class Heater {
public:
  Heater(const Pid::Config& pid, const typename Check::Config& check) : pid_(pid), check_(check) {}

  /// @param fan  the fan's share, 0 .. 255  @return duty for the next cycle, 0 .. 1
  float step(float target_C, float measured_C, float air_C, float supply_V, uint8_t fan, float dt_s) {
    // The duty of the last cycle made the heat since then; the element is as warm as the thermistor was.
    const float heat = duty_ > 0.0f ? heat_W<Plant>(duty_, supply_V, watch_.reading()) : 0.0f;
    reason_ = watch_.step(heat, measured_C, air_C, fan, dt_s);
    if (reason_ == tp::LimitReason::none && !check_.step(target_C, watch_.reading(), dt_s))
      reason_ = tp::LimitReason::heat_disagrees;
    const bool is_on = reason_ == tp::LimitReason::none && target_C > 0.0f;
    return duty_ = is_on ? pid_.step(target_C, watch_.reading(), dt_s) : 0.0f;
  }
  tp::LimitReason reason() const { return reason_; }    ///< Why it is cut.
  const Watch<Plant>& watch() const { return watch_; }  ///< What it disagrees on, and the suspects.

private:
  Pid pid_;
  Check check_;
  Watch<Plant> watch_;
  float duty_ = 0.0f;
  tp::LimitReason reason_ = tp::LimitReason::none;
};
//! [printer heater]

}  // namespace heater
