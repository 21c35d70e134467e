// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// After any sequence of resets and outages no motor is hotter than the bounds it is started with. The motors
// and the outages share no code with the library: two heat capacities stepped by Euler, and a list of what
// can happen to a power switch.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <thermopower/actuator/power_up.hpp>
#include <thermopower/thermopower.hpp>
#include <vector>

#include "../catch.hpp"

namespace {

using namespace thermopower;

/// A motor as it is, not as the library thinks it is.
struct TrueMotor {
  double winding_J_per_K, body_J_per_K, coupling_W_per_K, conductance_W_per_K, full_heat_W;
  double winding_C, body_C;

  void spend(double seconds, double heat_W, double air_C) {
    const double longest_s = 0.1 * winding_J_per_K / coupling_W_per_K;
    while (seconds > 0.0) {
      const double dt_s = std::min(seconds, longest_s);
      const double across_W = coupling_W_per_K * (winding_C - body_C);
      winding_C += dt_s * (heat_W - across_W) / winding_J_per_K;
      body_C += dt_s * (across_W - conductance_W_per_K * (body_C - air_C)) / body_J_per_K;
      seconds -= dt_s;
    }
  }
};

struct Eeprom {
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(512, 0xff);
  long writes = 0;
  int writes_left = -1;  ///< Power goes after so many; -1: it stays.
  std::uint8_t read(std::size_t at) const { return bytes[at]; }
  void write(std::size_t at, std::uint8_t value) {
    if (writes_left == 0) return;
    if (writes_left > 0) --writes_left;
    bytes[at] = value;
    ++writes;
  }
};

typedef CertifiedLimiter<CertifiedTwoNode, LinearHeat> Limiter;
typedef StateJournal<Eeprom> Journal;

constexpr double winding_limit_C = 110.0, body_limit_C = 60.0, highest_air_C = 30.0, step_s = 0.1;

/// What the firmware knows: nominal constants, each to 15 %.
TwoNodeThermalModel<float>::Config nominal() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
constexpr float tolerance = 0.15f, full_heat_W = 25.0f;

Limiter::Config limiter_config() {
  Limiter::Config config = Limiter::Config::standard();
  config.network = CertifiedTwoNodeConfig::around(nominal(), tolerance, static_cast<float>(winding_limit_C),
                                                  static_cast<float>(body_limit_C));
  config.use.heat = {13.0f, 1.0f, -20.0f, full_heat_W, full_heat_W, 0.0f};
  config.use.highest_air_C = static_cast<float>(highest_air_C);
  config.use.hold_s = 0.2f;
  return config;
}
StartAssumptions assumptions() {
  return StartAssumptions::around(nominal(), tolerance, full_heat_W, static_cast<float>(winding_limit_C),
                                  static_cast<float>(body_limit_C));
}

/// What a reset or an outage leaves to the firmware.
struct Chip {
  Eeprom eeprom;
  Retained<StoredState> retained;
  bool has_clock = false;
  bool is_driven_while_off = false;

  Chip() { std::memset(&retained, 0x5b, sizeof retained); }
};

struct Outcome {
  long starts = 0, colder = 0, over = 0;
  double closest_K = 1e9;  ///< Least distance of a bound above the truth at a start.
  double widest_K = 0;     ///< And the largest.
  double hottest_winding_C = -300, hottest_body_C = -300;
};

/// One session: starts, runs at a demand for a while, and ends. @return the power that acted last
double run(Chip& chip, TrueMotor& motor, double& clock_s, double seconds, bool is_reset, double demand,
           bool is_planned, double air_C, Outcome& outcome) {
  StartFacts facts = {false, StoredState(), RecordPromise(), 0.0f, {}, false};
  Journal journal(chip.eeprom, Journal::Config::standard());
  const std::uint32_t now = chip.has_clock ? static_cast<std::uint32_t>(clock_s) : StoredState::no_clock();
  StoredState found = {};
  const bool is_retained = is_reset && chip.retained.recall(found);
  if (!is_retained) chip.retained.forget();
  StoredState newest = {};
  const bool is_recorded = journal.load(newest);
  facts.has_stored = is_retained || is_recorded;
  facts.stored = is_retained ? found : newest;
  // A reset takes two seconds at most, in which the drive goes on.
  facts.promise = is_retained ? RecordPromise{2.0f, 0.0f, 2.0f} : journal.promise();
  facts.age_s = facts.has_stored && !is_retained ? record_age_s(facts.stored, now) : detail::not_a_number();
  if (is_retained) facts.age_s = 0.0f;
  facts.air_upper_C = static_cast<float>(highest_air_C);
  facts.is_driven_while_off = chip.is_driven_while_off && !is_retained;
  const StartBounds bounds = assumptions().start(facts);

  ++outcome.starts;
  const double margin_K = std::min(static_cast<double>(bounds.winding_upper_C) - motor.winding_C,
                                   static_cast<double>(bounds.body_upper_C) - motor.body_C);
  outcome.colder += margin_K < 0.0;
  outcome.closest_K = std::min(outcome.closest_K, margin_K);
  outcome.widest_K = std::max(outcome.widest_K, margin_K);

  Limiter limiter(limiter_config());
  limiter.start(bounds);
  StoredState state = {bounds.winding_upper_C,
                       bounds.body_upper_C,
                       bounds.winding_upper_C,
                       bounds.body_upper_C,
                       0.0f,
                       1.0f,
                       now,
                       0};
  if (is_retained) journal.resume(chip.retained.since_s);
  else journal.write_now(state);
  double power = 1.0;
  for (double t = 0.0; t < seconds && chip.eeprom.writes_left != 0; t += step_s) {
    const LimitedPower granted =
        limiter.step({static_cast<std::uint8_t>(demand), detail::not_a_number(), static_cast<float>(air_C)},
                     t > 0.0 ? static_cast<float>(step_s) : 0.0f);
    power = granted.power;
    motor.spend(step_s, motor.full_heat_W * power / 255.0, air_C);
    clock_s += step_s;
    outcome.hottest_winding_C = std::max(outcome.hottest_winding_C, motor.winding_C);
    outcome.hottest_body_C = std::max(outcome.hottest_body_C, motor.body_C);
    outcome.over += motor.winding_C > winding_limit_C || motor.body_C > body_limit_C;
    state.winding_upper_C = state.winding_C = limiter.winding_upper_C();
    state.body_upper_C = state.body_C = limiter.body_upper_C();
    if (chip.has_clock) state.clock_s = static_cast<std::uint32_t>(clock_s);
    chip.retained.keep(state, journal.since_s());
    journal.step(state, static_cast<float>(step_s));
  }
  if (is_planned) journal.write_now(state);
  return power;
}

TrueMotor random_motor(std::mt19937& random, double air_C) {
  std::uniform_real_distribution<double> off(1.0 - double(tolerance), 1.0 + double(tolerance));
  const double start_C = std::uniform_real_distribution<double>(air_C, 55.0)(random);
  return {8.0 * off(random),
          80.0 * off(random),
          1.0 * off(random),
          0.2 * off(random),
          double(full_heat_W) * std::uniform_real_distribution<double>(0.7, 1.0)(random),
          start_C,
          start_C};
}

}  // namespace

TEST_CASE("after any sequence of resets and outages no start is colder than the truth") {
  std::mt19937 random(11);
  Outcome all;
  long motors = 0;
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (; motors < 2500; ++motors) {
    const double air_C = uniform(0.0, highest_air_C);
    TrueMotor motor = random_motor(random, air_C);
    Chip chip;
    chip.has_clock = random() % 2 == 0;
    double clock_s = uniform(0.0, 1e6);
    bool is_reset = false;
    // One motor in five lives through sessions that are all shorter than the journal's interval.
    const bool is_restless = random() % 5 == 0;
    double budget_s = 1500.0;
    while (budget_s > 0.0) {
      const double seconds = is_restless ? uniform(20.0, 59.0) : std::exp(uniform(0.0, std::log(1200.0)));
      const double demand = random() % 3 == 0 ? uniform(1.0, 255.0) : 255.0;
      const bool is_planned = random() % 4 == 0;
      // Power may go between any two bytes of any record; the session ends there.
      chip.eeprom.writes_left = random() % 4 == 0 ? static_cast<int>(random() % 60) : -1;
      run(chip, motor, clock_s, seconds, is_reset, demand, is_planned, air_C, all);
      const bool is_torn = chip.eeprom.writes_left == 0;
      chip.eeprom.writes_left = -1;
      budget_s -= seconds;
      is_reset = !is_torn && random() % 3 == 0;
      const double off_s =
          is_reset ? 0.07 : (is_restless ? uniform(0.05, 3.0) : std::exp(uniform(-3.0, 9.0)));
      motor.spend(off_s, 0.0, air_C);
      clock_s += off_s;
    }
  }
  std::printf(
      "%ld motors, %ld starts: bounds %.2f to %.1f K above the truth; hottest winding %.2f, body %.2f degC\n",
      motors, all.starts, all.closest_K, all.widest_K, all.hottest_winding_C, all.hottest_body_C);
  CHECK(all.starts > 10000);
  CHECK(all.colder == 0);
  CHECK(all.over == 0);
  CHECK(all.hottest_body_C > body_limit_C - 12.0);  // the limiter was needed
}

TEST_CASE("hours at one temperature and a short outage: the motor is not believed to have cooled for hours") {
  TrueMotor motor = {8.0, 80.0, 1.0, 0.2, 25.0, 25.0, 25.0};
  Chip chip;
  chip.has_clock = true;
  double clock_s = 1e6;
  Outcome outcome;
  run(chip, motor, clock_s, 4.0 * 3600.0, false, 255.0, false, 25.0, outcome);
  const double off_s = 5.0;
  motor.spend(off_s, 0.0, 25.0);
  clock_s += off_s;
  Journal journal(chip.eeprom, Journal::Config::standard());
  PowerUpFacts facts = {};
  REQUIRE((facts.has_stored = journal.load(facts.stored)));
  facts.air_C = 25.0f;
  facts.off_s =
      PowerUpFacts::off_s_from(facts.stored, static_cast<std::uint32_t>(clock_s), journal.promise());
  facts.hottest_winding_C = static_cast<float>(winding_limit_C);
  facts.hottest_body_C = static_cast<float>(body_limit_C);
  CHECK(facts.off_s == 0.0f);
  CHECK(static_cast<double>(AsCooled::start(facts, nominal()).body_C) > motor.body_C);
  run(chip, motor, clock_s, 1.0, false, 1.0, false, 25.0, outcome);
  CHECK(outcome.colder == 0);
}

TEST_CASE("a motor whose controller restarts every 20 to 59 s stays below its limits") {
  for (const bool is_reset : {false, true}) {
    std::mt19937 random(3);
    TrueMotor motor = {7.0, 70.0, 0.9, 0.18, 25.0, 30.0, 30.0};
    Chip chip;
    double clock_s = 0.0;
    Outcome outcome;
    for (int session = 0; session < 200; ++session) {
      run(chip, motor, clock_s, std::uniform_real_distribution<double>(20.0, 59.0)(random),
          is_reset && session > 0, 255.0, false, 30.0, outcome);
      motor.spend(0.5, 0.0, 30.0);
    }
    INFO((is_reset ? "resets" : "losses of power"));
    CHECK(outcome.colder == 0);
    CHECK(outcome.over == 0);
    CHECK(outcome.hottest_body_C < body_limit_C);
    CHECK(outcome.hottest_winding_C < winding_limit_C);
  }
}

TEST_CASE("estimates after an outage are as sure as they say: few are colder than the truth by two sigma") {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  long starts = 0, cooled_colder = 0, stored_colder = 0;
  for (; starts < 4000; ++starts) {
    // The model is right here; what is not known is when the power went.
    TrueMotor motor = {8.0, 80.0, 1.0, 0.2, 25.0, 0.0, 0.0};
    motor.body_C = uniform(25.0, 55.0);
    motor.winding_C = motor.body_C + uniform(0.0, 8.0);
    Eeprom eeprom;
    Journal journal(eeprom, Journal::Config::standard());
    double clock_s = 1000.0;
    const double on_s = std::exp(uniform(0.0, std::log(7200.0)));
    double heat_W = 0.0;
    for (double t = 0.0; t < on_s; t += 1.0) {
      if (random() % 200 == 0 || t < 0.5) heat_W = uniform(0.0, 10.0);
      const auto at = [&](double truth_C) { return static_cast<float>(truth_C + normal(random)); };
      const StoredState now = {at(motor.winding_C),
                               at(motor.body_C),
                               110.0f,
                               60.0f,
                               static_cast<float>(heat_W),
                               1.0f,
                               static_cast<std::uint32_t>(clock_s),
                               0};
      t < 0.5 ? journal.write_now(now) : journal.step(now, 1.0f);
      motor.spend(1.0, heat_W, 25.0);
      clock_s += 1.0;
    }
    const double off_s = std::exp(uniform(0.0, std::log(7200.0)));
    motor.spend(off_s, 0.0, 25.0);
    clock_s += off_s;

    Journal after(eeprom, Journal::Config::standard());
    StartFacts facts = {false, StoredState(), RecordPromise(), 0.0f, {}, false};
    REQUIRE((facts.has_stored = after.load(facts.stored)));
    facts.promise = after.promise();
    facts.age_s = record_age_s(facts.stored, static_cast<std::uint32_t>(clock_s));
    facts.air_upper_C = 25.0f;
    facts.stored.winding_upper_C = facts.stored.winding_C;
    facts.stored.body_upper_C = facts.stored.body_C;
    PowerUpFacts known = {};
    known.has_stored = true;
    known.stored = facts.stored;
    known.air_C = 25.0f;
    known.off_s =
        PowerUpFacts::off_s_from(facts.stored, static_cast<std::uint32_t>(clock_s), after.promise());
    const StartAssumptions warmest = StartAssumptions::around(nominal(), 0.0f, 10.0f, 110.0f, 60.0f);
    known.unrecorded_K = warmest.unrecorded_K(facts);
    const auto is_colder = [&](const PowerUpTemperatures& start) {
      const double two_sigma_K = 2.0 * static_cast<double>(start.std_K);
      return static_cast<double>(start.winding_C) + two_sigma_K < motor.winding_C ||
             static_cast<double>(start.body_C) + two_sigma_K < motor.body_C;
    };
    cooled_colder += is_colder(AsCooled::start(known, nominal()));
    stored_colder += is_colder(AsStored::start(known, nominal()));
  }
  std::printf("colder than the truth by more than two sigma: AsCooled %ld, AsStored %ld of %ld\n",
              cooled_colder, stored_colder, starts);
  CHECK(cooled_colder * 40 < starts);
  CHECK(stored_colder * 40 < starts);
}
