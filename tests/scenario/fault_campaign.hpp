// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

// Four minutes of an axis at hard work in which everything around it fails, as often as one likes: a controller as
// firmware has it (certified limiter, guarded thermistors, journal, memory that survives a reset), and a board, a motor,
// thermometers and a supply that share no code with it. Telemetry and commands pass whole or not at all; the bytes themselves are
// damaged in tests/sbgc and in the runs on the simulated chip.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>
#include <thermopower/thermopower.hpp>
#include <vector>

namespace campaign {

namespace tp = thermopower;

enum Fault : int {
  chip_reset,
  power_loss,
  board_reset,
  board_refuses,
  board_deaf,
  link_silent,
  link_dead,
  thermometer_frozen,
  thermometer_biased,
  thermometer_absurd,
  thermometers_absurd,
  supply_absurd,
  supply_missing,
  supply_beyond,
  thermometers_drift,
  thermometers_stuck,
  thermistor_torn,
  thermistor_stuck,
  thermistor_drifts,
  thermistors_exchanged,
  time_stands,
  clock_wraps,
  board_late,
  stray_confirm,
  reset_series,
  fault_count
};
inline const char* name(int fault) {
  static const char* const names[fault_count] = {"chip reset",
                                                 "loss of power, some in a record",
                                                 "board reset",
                                                 "board refuses",
                                                 "board is deaf",
                                                 "telemetry silent",
                                                 "link dead",
                                                 "thermometer frozen",
                                                 "thermometer off by up to 10 K",
                                                 "one thermometer absurd",
                                                 "both thermometers absurd",
                                                 "supply reads 655 V",
                                                 "supply reads 0 V",
                                                 "supply reads 1e30 V",
                                                 "both thermometers drift by 1 K/min to 1 K/s",
                                                 "both thermometers stuck",
                                                 "thermistor torn",
                                                 "thermistor stuck",
                                                 "thermistor drifts",
                                                 "thermistors exchanged",
                                                 "time step reads 0",
                                                 "clock of 16 or 32 bits wraps",
                                                 "board obeys up to 5 messages late",
                                                 "board deaf, CONFIRM of another command",
                                                 "twenty resets in four seconds"};
  return names[fault];
}

constexpr double winding_limit_C = 110.0, body_limit_C = 60.0, run_s = 240.0, horizon_s = 30.0;
constexpr float full_W = 13.5f * 13.5f / 7.2f;  // highest supply, lowest resistance at 20 degC

inline tp::TwoNodeThermalModel<float>::Config nominal() { return {2.0f, 12.0f, 1.0f, {0.3f}}; }

struct AxisMotor {
  typedef tp::CurrentModel<tp::OhmicCurrent<float>> Current;
  typedef tp::TwoNodeThermalModel<float> Thermal;
  static Current::Config current() { return {8.0f, 0.0039f, 20.0f}; }
  static tp::SupplyRange supply() { return {8.0f, 13.6f}; }
  static Thermal::Config thermal() { return nominal(); }
};
typedef tp::CertifiedLimiter<tp::CertifiedTwoNode, tp::LinearHeat> Limiter;
typedef tp::AxisController<AxisMotor, tp::StepPowerLaw<>, Limiter, tp::GainScheduler<>> Axis;
typedef tp::BasicGimbalController<tp::MeasuredSupply, Axis> Gimbal;

inline Limiter::Config limiter() {
  Limiter::Config config = Limiter::Config::standard();
  config.network = tp::CertifiedTwoNodeConfig::around(nominal(), 0.1f, static_cast<float>(winding_limit_C),
                                                      static_cast<float>(body_limit_C));
  config.use.heat = tp::HeatBounds::ohmic(13.5f, 1.0f, {7.2f, 8.8f}, {0.0039f, 0.00395f}, 20.0f, 0.0f,
                                          static_cast<float>(winding_limit_C));
  config.use.highest_air_C = 35.0f;
  config.use.hold_s = 0.1f;
  config.use.horizon_s = static_cast<float>(horizon_s);
  config.air_error_K = 6.0f;
  return config;
}
inline tp::StartAssumptions assumptions() {
  return tp::StartAssumptions::around(nominal(), 0.1f, full_W / 0.92f, static_cast<float>(winding_limit_C),
                                      static_cast<float>(body_limit_C));
}
/// @param is_believing  thermometers of the air are believed within the limiter's `air_error_K`
inline Gimbal new_gimbal(bool is_believing) {
  Axis::Config axis = Axis::Config::with_gain({24.0f, 4.0f});
  axis.limiter = limiter();
  tp::GimbalConfig config = tp::GimbalConfig::believing();
  if (!is_believing) config.air.declared_C = axis.limiter.use.highest_air_C;
  return Gimbal(config, axis);
}
// What a guard lets through is no colder than the model by more than this; and the model, with constants a tenth off and
// a supply that is one tenth wrong at most, is no colder than the truth by more than the other.
constexpr float disagreement_K = 4.0f, model_error_K = 12.0f;
inline tp::SensorGuard new_guard(float rate_K_per_s) {
  return tp::SensorGuard(
      tp::SensorGuard::Config{0.0f, 150.0f, rate_K_per_s, 0.5f, 5.0f, disagreement_K, 2.0f});
}

/// The motor as it is.
struct Motor {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, air_W_per_K, ohm, winding_C, body_C;
  void pass(double volt, int power, double air_C, double seconds) {
    const double heat_W = volt * volt * power / 255.0 / (ohm * (1.0 + 0.0039 * (winding_C - 20.0)));
    while (seconds > 0.0) {
      const double dt_s = std::min(seconds, 0.03);
      const double across_W = coupling_W_per_K * (winding_C - body_C);
      winding_C += dt_s * (heat_W - across_W) / winding_J_per_K;
      body_C += dt_s * (across_W - air_W_per_K * (body_C - air_C)) / body_J_per_K;
      seconds -= dt_s;
    }
  }
};

struct Eeprom {
  std::array<std::uint8_t, 512> bytes;
  int writes_left = -1;  // power goes after so many
  Eeprom() { bytes.fill(0xff); }
  std::uint8_t read(std::size_t at) const { return bytes[at]; }
  void write(std::size_t at, std::uint8_t value) {
    if (writes_left == 0) return;
    if (writes_left > 0) --writes_left;
    bytes[at] = value;
  }
};

/// What the board sends.
struct Telemetry {
  double error = 0;
  int camera = 0, frame = 0, reported = 0;
  double supply_V = 0;
  float error_deg(std::uint8_t) const { return static_cast<float>(error); }
  std::int8_t imu_C() const { return static_cast<std::int8_t>(camera); }
  std::int8_t frame_imu_C() const { return static_cast<std::int8_t>(frame); }
  float battery_V() const { return static_cast<float>(supply_V); }
  std::uint8_t motor_power(std::uint8_t) const { return static_cast<std::uint8_t>(reported); }
};

/// The program on the chip, through resets.
struct Firmware {
  Eeprom eeprom;
  tp::Retained<tp::StoredState> retained;
  bool is_believing;
  Gimbal gimbal;
  tp::SensorGuard of_winding = new_guard(20.0f), of_body = new_guard(5.0f);
  tp::StateJournal<Eeprom> journal{eeprom, tp::StateJournal<Eeprom>::Config::standard()};
  double open_s = 0.0;  // before the first step

  explicit Firmware(bool believes) : is_believing(believes), gimbal(new_gimbal(believes)) {
    std::memset(&retained, 0x5b, sizeof retained);
  }

  /// What the thermistors read, told to the limiter as far as their guards let it through. @param is_raw  a program without guards
  void measure(float winding_C, float body_C, float dt_s, bool is_raw) {
    auto& axis = gimbal.axis<0>();
    if (is_raw) {
      axis.limiter().tighten(tp::GuardedCelsius::unchecked(winding_C + 1.0f),
                             tp::GuardedCelsius::unchecked(body_C + 1.0f));
      return;
    }
    const tp::SensorGuard::Inputs winding = {winding_C, axis.thermal().state().winding_C},
                                  body = {body_C, axis.thermal().state().body_C};
    of_winding.step(winding, body, dt_s);
    of_body.step(body, winding, dt_s);
    axis.limiter().tighten(of_winding.upper(disagreement_K + model_error_K),
                           of_body.upper(disagreement_K + model_error_K));
  }

  static constexpr float longest_reset_s = 2.0f;

  /// @param known_C  how warm it is; NaN: as the store says  @param is_believed  whatever the board did meanwhile
  void boot(bool is_power_lost, double known_C, bool is_believed) {
    eeprom.writes_left = -1;
    if (is_power_lost) retained.forget();
    gimbal = new_gimbal(is_believing);
    of_winding = new_guard(20.0f), of_body = new_guard(5.0f);
    new (&journal) tp::StateJournal<Eeprom>(eeprom, tp::StateJournal<Eeprom>::Config::standard());
    tp::StoredState found = {}, newest = {};
    const bool is_retained = retained.recall(found);
    const bool is_recorded = journal.load(newest);
    tp::StartFacts facts = {false, tp::StoredState(), tp::RecordPromise(), 0.0f, {}, false};
    facts.has_stored = is_retained || is_recorded;
    facts.stored = is_retained ? found : newest;
    facts.promise =
        is_retained ? tp::RecordPromise{longest_reset_s, 0.0f, longest_reset_s} : journal.promise();
    facts.age_s = tp::detail::not_a_number();
    facts.air_upper_C = 35.0f;
    tp::StartBounds bounds = assumptions().start(facts);
    if (!std::isnan(known_C)) bounds.winding_upper_C = bounds.body_upper_C = static_cast<float>(known_C);
    gimbal.axis<0>().limiter().start(bounds);
    gimbal.axis<0>().start(bounds.winding_upper_C);
    if (!is_believed) gimbal.assume_driven();
    if (is_retained) journal.resume(retained.since_s);
    else journal.write_now(state());
  }
  tp::StoredState state() {
    const float winding_C = gimbal.axis<0>().limiter().winding_upper_C();
    const float body_C = gimbal.axis<0>().limiter().body_upper_C();
    return {winding_C, body_C, winding_C, body_C, 0.0f, 1.0f, tp::StoredState::no_clock(), 0};
  }
  void keep(double dt_s) {
    journal.step(state(), static_cast<float>(dt_s));
    retained.keep(state(), journal.since_s());
  }
};

/// What came of many runs.
struct Tally {
  long runs = 0, faults[fault_count] = {}, named[fault_count] = {}, nameable[fault_count] = {};
  long as_factor[fault_count] =
      {};                        ///< Not named, and explained by the factor that PowerInForce has learned.
  long colder = 0;               ///< Runs in which a bound was below the truth.
  long over = 0;                 ///< Runs over a limit in which no board held another power for the horizon.
  long uncontrolled = 0;         ///< Runs in which one did.
  double hottest_over_K = -1e9;  ///< Of the former: most above a limit.
  double slowest_clear_s[fault_count] = {};  ///< From a fault's end to the last word of any fault.
  double slowest_back_s[fault_count] = {};   ///< From a fault's end to all that is bearable for ever.
  double slowest_back_uncontrolled_s = 0;    ///< The same where a board held another power for the horizon.
  long back = 0, not_back = 0;               ///< Within two minutes.
  long undecided = 0;                        ///< The run ended first.

  void add(const Tally& other) {
    runs += other.runs, colder += other.colder, over += other.over, uncontrolled += other.uncontrolled;
    back += other.back, not_back += other.not_back, undecided += other.undecided;
    for (int i = 0; i < fault_count; ++i) {
      faults[i] += other.faults[i], named[i] += other.named[i], nameable[i] += other.nameable[i];
      as_factor[i] += other.as_factor[i];
      slowest_back_s[i] = std::max(slowest_back_s[i], other.slowest_back_s[i]);
      slowest_clear_s[i] = std::max(slowest_clear_s[i], other.slowest_clear_s[i]);
    }
    hottest_over_K = std::max(hottest_over_K, other.hottest_over_K);
    slowest_back_uncontrolled_s = std::max(slowest_back_uncontrolled_s, other.slowest_back_uncontrolled_s);
  }
};

/// One run. Faults come one after the other, with pauses in which all is well.
/// @param forgets  the program starts as warm as the air, as one without a memory would
/// @param is_raw   the program believes its thermistors, as one without guards would
inline void run(std::uint32_t seed, Tally& tally, bool forgets = false, bool is_raw = false) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 5) / 134217728.0);
  };
  const auto once_in = [&](int many) { return random() % static_cast<unsigned>(many) == 0; };

  // Every second motor is as bad as any in the bounds.
  const bool is_worst = once_in(2);
  const auto within = [&](double value) { return value * (is_worst ? 0.9 : uniform(0.9, 1.1)); };
  const double first_air_C = uniform(5.0, 31.0), air_drift_C_per_s = uniform(-0.015, 0.015);
  double air_C = first_air_C;
  Motor motor = {
      within(2.0), within(12.0), within(1.0), within(0.3), is_worst ? 7.2 : uniform(7.2, 8.8), 0, 0};
  motor.winding_C = motor.body_C = air_C + uniform(0.0, 25.0);
  const double volt = is_worst ? 13.5 : uniform(11.0, 13.5);
  const bool reports = !once_in(2);  // or confirms
  const int restart_power = static_cast<int>(uniform(1.0, 255.0));

  const bool is_believing = once_in(2), has_thermistors = is_raw || once_in(2);
  Firmware chip(is_believing);
  // Every fourth starts with an empty store, as hot as its limits; the others know how warm they are.
  chip.boot(true, once_in(4) ? std::nan("") : motor.body_C, false);
  int force = restart_power, fault = -1, last_fault = 0;
  double now_s = 0.0, fault_ends_s = 0.0, next_fault_s = uniform(5.0, 40.0), fault_began_s = 0.0;
  double down_until_s = 0.0, board_down_until_s = 0.0, disobeyed_s = 0.0, differs_s = 0.0, ended_s = -1.0,
         last_ended_s = 0.0, demand_until_s = 0.0;
  double error = 5.0, bias_K = 0.0, drift_K_per_s = 0.0, stuck_winding_C = 0.0, stuck_body_C = 0.0;
  int late = 0, resets_left = 0;
  std::vector<int> on_the_way;
  int frozen = 0, absurd = 0;
  bool is_down = false, is_cold = false, is_over = false, is_uncontrolled = false, is_first = true,
       is_named = false, has_wrapped = false;
  bool lost_power = false, was_uncontrolled_fault = false;
  double over_K = -1e9, last_step_s = 0.0;
  std::uint8_t sent = 1;
  double resets_due_s = 0.0;

  while (now_s < run_s) {
    const double dt_s = uniform(0.020, 0.030);
    // What acts.
    const bool has_power = !(is_down && lost_power);
    motor.pass(volt, has_power ? force : 0, air_C, dt_s);
    now_s += dt_s;
    air_C = first_air_C + air_drift_C_per_s * now_s;
    const bool is_other = has_power && (is_down || force > sent);
    disobeyed_s = is_other ? disobeyed_s + dt_s : 0.0;
    if (disobeyed_s > horizon_s) is_uncontrolled = was_uncontrolled_fault = true;
    const double above_K = std::max(motor.winding_C - winding_limit_C, motor.body_C - body_limit_C);
    over_K = std::max(over_K, above_K);
    is_over = is_over || above_K > 0.0;

    // What fails.
    const bool is_overdue = ended_s >= 0.0 && now_s > ended_s + 120.0;
    if (fault < 0 && now_s >= next_fault_s && (ended_s < 0.0 || is_overdue)) {
      tally.not_back += is_overdue ? 1 : 0;
      do fault = static_cast<int>(random() % fault_count);
      while ((is_believing && (fault == thermometers_drift || fault == thermometers_stuck)) ||
             (!has_thermistors && fault >= thermistor_torn && fault <= thermistors_exchanged) ||
             (reports && fault == stray_confirm));
      ++tally.faults[fault];
      fault_began_s = now_s;
      fault_ends_s = now_s + uniform(1.5, 25.0);
      if ((fault == board_refuses || fault == board_deaf) && once_in(4))
        fault_ends_s = now_s + uniform(25.0, 60.0);
      bias_K = uniform(-10.0, 10.0);
      drift_K_per_s = std::exp(uniform(std::log(1.0 / 60.0), 0.0));
      stuck_winding_C = motor.winding_C, stuck_body_C = motor.body_C;
      late = 1 + static_cast<int>(random() % 5);
      on_the_way.clear();
      frozen = static_cast<int>(air_C);
      const int absurdities[] = {127, 90, -128, -60};
      absurd = absurdities[random() % 4];
      is_named = was_uncontrolled_fault = false;
      ended_s = -1.0;
      if (fault == chip_reset) down_until_s = now_s + uniform(0.05, 1.9);
      if (fault == reset_series) {
        resets_left = 20;
        down_until_s = now_s + 0.1;
        is_down = true, lost_power = false;
        fault_ends_s = now_s + 4.0;
      }
      if (fault == clock_wraps) fault_ends_s = now_s + 0.001;
      if (fault == power_loss) {
        down_until_s = fault_ends_s;
        if (once_in(2)) {  // in the middle of a record
          chip.eeprom.writes_left = static_cast<int>(random() % 22);
          chip.journal.write_now(chip.state());
        }
        chip.eeprom.writes_left = 0;
      }
      if (fault == chip_reset || fault == power_loss) is_down = true, lost_power = fault == power_loss;
      if (fault == board_reset) board_down_until_s = now_s + uniform(0.3, 3.0), force = restart_power;
      if (fault == chip_reset) fault_ends_s = down_until_s;
      if (fault == board_reset) fault_ends_s = board_down_until_s;
    }
    if (fault >= 0 && now_s >= fault_ends_s) {
      last_fault = fault;
      fault = -1;
      ended_s = last_ended_s = now_s;
      next_fault_s = now_s + uniform(2.0, 60.0);
    }
    if (is_down) {
      if (now_s < down_until_s) continue;
      if (lost_power) force = restart_power;
      chip.boot(lost_power, forgets ? air_C : std::nan(""), forgets);
      is_down = false;
      is_first = !forgets;
      last_step_s = now_s;
      if (resets_left > 0) --resets_left;
      resets_due_s = now_s + 0.1;
    }
    if (resets_left > 0 && now_s >= resets_due_s) {
      is_down = true;
      down_until_s = now_s + 0.1;
      continue;
    }

    // What the board says, and what the chip makes of it.
    if (now_s >= demand_until_s) {
      demand_until_s = now_s + uniform(2.0, 60.0);
      error = once_in(3) ? uniform(0.0, 1.0) : 5.0;
    }
    Telemetry telemetry;
    telemetry.error = error;
    telemetry.camera = telemetry.frame = static_cast<int>(std::floor(air_C));
    if (fault == thermometer_frozen) telemetry.camera = frozen;
    if (fault == thermometer_biased) telemetry.camera = static_cast<int>(air_C + bias_K);
    if (fault == thermometer_absurd) telemetry.frame = absurd;
    if (fault == thermometers_absurd) telemetry.camera = telemetry.frame = absurd;
    if (fault == thermometers_stuck) telemetry.camera = telemetry.frame = frozen;
    if (fault == thermometers_drift)
      telemetry.camera = telemetry.frame =
          static_cast<int>(std::floor(std::max(-39.0, air_C - drift_K_per_s * (now_s - fault_began_s))));
    telemetry.supply_V = fault == supply_absurd
                             ? 655.35
                             : (fault == supply_missing ? 0.0 : (fault == supply_beyond ? 1e30 : volt));
    telemetry.reported = reports ? force : 0;
    const bool is_board_up = now_s >= board_down_until_s;
    const bool is_heard = is_board_up && fault != link_silent && fault != link_dead;
    float step_s = static_cast<float>(now_s - last_step_s) + (is_first ? Firmware::longest_reset_s : 0.0f);
    if (fault == time_stands) step_s = 0.0f;
    const bool is_wrapped = fault == clock_wraps && !has_wrapped;
    if (is_wrapped) step_s -= once_in(2) ? 65.536f : 4294.967296f;
    has_wrapped = fault == clock_wraps;
    if (has_thermistors) {
      double winding_C = motor.winding_C, body_C = motor.body_C;
      const double drifted_K = drift_K_per_s * (now_s - fault_began_s);
      if (fault == thermistor_torn) winding_C = body_C = bias_K > 0.0 ? -88.6 : 300.0;
      if (fault == thermistor_stuck) winding_C = stuck_winding_C, body_C = stuck_body_C;
      if (fault == thermistor_drifts) winding_C -= drifted_K, body_C -= drifted_K;
      if (fault == thermistors_exchanged) std::swap(winding_C, body_C);
      chip.measure(static_cast<float>(winding_C), static_cast<float>(body_C), step_s, is_raw);
    }
    last_step_s = now_s;
    is_first = false;
    const Gimbal::Command& command =
        is_heard ? chip.gimbal.step(telemetry, step_s) : chip.gimbal.step_silent(step_s);
    chip.keep(dt_s);
    sent = command.power[0];
    const bool is_taken = is_board_up && fault != board_refuses && fault != board_deaf &&
                          fault != link_dead && fault != stray_confirm;
    if (is_taken) on_the_way.push_back(sent);
    const std::size_t waiting = fault == board_late ? static_cast<std::size_t>(late) : 0;
    bool is_new = false;
    while (on_the_way.size() > waiting) {
      force = on_the_way.front();
      on_the_way.erase(on_the_way.begin());
      is_new = true;
    }
    // Who reports no power confirms, or refuses; a deaf board does neither.
    if (!reports && is_heard && ((is_taken && is_new) || fault == stray_confirm)) {
      thermopower::sbgc::Confirm confirm;
      confirm.confirmed_id = fault == stray_confirm ? thermopower::sbgc::command::control
                                                    : thermopower::sbgc::command::set_adj_vars_val;
      chip.gimbal.confirmed(confirm);
    }
    if (is_heard && fault == board_refuses) chip.gimbal.refused();

    // What must hold.
    const Limiter& limiter = chip.gimbal.axis<0>().limiter();
    is_cold = is_cold || motor.winding_C > static_cast<double>(limiter.winding_upper_C()) + 1e-3 ||
              motor.body_C > static_cast<double>(limiter.body_upper_C()) + 1e-3;
    const tp::LimitReason reason = command.reason[0];
    // Two counts of difference are a board's own way of counting, and two hundredths pass for its scale.
    differs_s = fault >= 0 && std::abs(force - int(sent)) > 2 + 0.02 * 255 ? differs_s + dt_s : 0.0;
    if (is_wrapped) {
      ++tally.nameable[fault];
      tally.named[fault] += reason == tp::LimitReason::time_invalid ? 1 : 0;
    }
    if (fault >= 0 && now_s > fault_began_s + 1.0) {
      const bool is_ignored = fault == board_refuses || fault == board_deaf || fault == stray_confirm;
      const bool is_it =
          (is_ignored && reason == tp::LimitReason::not_obeyed) ||
          ((fault == link_silent || fault == link_dead) && reason == tp::LimitReason::link_silent) ||
          (fault == thermometers_absurd && reason == tp::LimitReason::air_implausible) ||
          (fault == supply_absurd && reason == tp::LimitReason::supply_implausible) ||
          (fault == supply_missing && reason == tp::LimitReason::supply_low) ||
          (fault == supply_beyond && reason == tp::LimitReason::supply_implausible) ||
          (fault == time_stands && reason == tp::LimitReason::time_stands_still) ||
          (fault == thermistor_torn && chip.of_body.state().reason == tp::LimitReason::sensor_out_of_range) ||
          (fault == thermometer_absurd && chip.gimbal.state().air_source == tp::AirSource::camera);
      // A board that is told what it does anyway disobeys nothing.
      const bool is_nameable = fault == link_silent || fault == link_dead || fault == thermometers_absurd ||
                               fault == supply_absurd || fault == supply_missing || fault == supply_beyond ||
                               fault == time_stands || fault == thermistor_torn ||
                               fault == thermometer_absurd || (is_ignored && differs_s > 1.0);
      if (is_nameable && !is_named) {
        ++tally.nameable[fault];
        is_named = true;  // asked once
        // A factor that was learned and explains the report is what the estimate is heated by.
        const double low = static_cast<double>(chip.gimbal.force().scale_low(0)) * sent - 2.0,
                     high = static_cast<double>(chip.gimbal.force().scale_high(0)) * sent + 2.0;
        const bool is_factor = is_ignored && reports && low > sent && force >= low && force <= high;
        if (is_it) ++tally.named[fault];
        else if (is_factor) ++tally.as_factor[fault];
      }
    }
    if (fault < 0 && tp::is_fault(reason) && now_s > last_ended_s)
      tally.slowest_clear_s[last_fault] = std::max(tally.slowest_clear_s[last_fault], now_s - last_ended_s);
    if (ended_s >= 0.0 && fault < 0) {
      const Limiter::State state = limiter.state();
      const int bearable = std::min<int>(state.sustainable, 250);
      const int wanted = chip.gimbal.axis<0>().state().demand;
      // At a limit the bound nears the level of the last bearable count without end: that count is not waited for.
      if (!tp::is_fault(reason) && sent >= std::min(wanted, bearable - 1)) {
        double& slowest =
            was_uncontrolled_fault ? tally.slowest_back_uncontrolled_s : tally.slowest_back_s[last_fault];
        slowest = std::max(slowest, now_s - ended_s);
        ended_s = -1.0;
        ++tally.back;
      }
    }
  }
  tally.undecided += ended_s >= 0.0 && fault < 0 ? 1 : 0;
  ++tally.runs;
  tally.colder += is_cold ? 1 : 0;
  tally.uncontrolled += is_uncontrolled ? 1 : 0;
  if (is_uncontrolled) return;
  tally.over += is_over ? 1 : 0;
  tally.hottest_over_K = std::max(tally.hottest_over_K, over_K);
}

}  // namespace campaign
