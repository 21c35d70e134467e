// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Attacks on what feeds a limiter: sensors that lie slowly, clocks in a wrong unit, another battery, resets, frozen telemetry. The motor is
// integrated here, in explicit steps of a winding and a housing in the air, and shares no code with the library.

#include "../catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <thermopower/thermopower.hpp>

using namespace thermopower;

namespace {

const float nan_ = std::numeric_limits<float>::quiet_NaN();
constexpr double winding_limit_C = 110.0, body_limit_C = 60.0, step_s = 0.01, true_air_C = 25.0;

/// The motor as it is: 4 ohm of copper at 20 degC.
struct Truth {
  double winding_C = true_air_C, body_C = true_air_C;
  double over_K = -1e9, hottest_winding_C = true_air_C;
  void pass(double volt, double power, double air_C, double seconds) {
    const double heat_W = volt * volt * power / 255.0 / (4.0 * (1.0 + 0.0039 * (winding_C - 20.0)));
    const double across_W = 1.0 * (winding_C - body_C);
    winding_C += seconds * (heat_W - across_W) / 8.0;
    body_C += seconds * (across_W - 0.2 * (body_C - air_C)) / 80.0;
    over_K = std::max({over_K, winding_C - winding_limit_C, body_C - body_limit_C});
    hottest_winding_C = std::max(hottest_winding_C, winding_C);
  }
};

TwoNodeThermalModel<float>::Config bodies() { return {8.0f, 80.0f, 1.0f, {0.2f}}; }
struct Motor {
  typedef CurrentModel<OhmicCurrent<>> Current;
  typedef TwoNodeThermalModel<float> Thermal;
  static Current::Config current() { return {4.0f, 0.0039f, 20.0f}; }
  static SupplyRange supply() { return {9.0f, 12.6f}; }  // three cells
  static AirRange air() { return {0.0f, 40.0f}; }
  static Thermal::Config thermal() { return bodies(); }
};
/// The same motor, of which nobody says in which air it stands.
struct Undeclared {
  typedef Motor::Current Current;
  typedef Motor::Thermal Thermal;
  static Current::Config current() { return Motor::current(); }
  static SupplyRange supply() { return Motor::supply(); }
  static Thermal::Config thermal() { return Motor::thermal(); }
};

/// The same in a loop of 10 ms.
template <class Driven>
struct InALoop : Driven {
  static StepTime step_time() { return {0.005f}; }
};

typedef CertifiedLimiter<CertifiedTwoNode> Proven;
typedef AxisController<Motor> Plain;
typedef AxisController<Motor, StepPowerLaw<>, NodeLimiter> Nodes;
typedef AxisController<Motor, StepPowerLaw<>, Proven> Certified;
typedef AxisController<Undeclared> Bare;

Proven::Config proven() {
  Proven::Config config = Proven::Config::standard();
  config.network = CertifiedTwoNodeConfig::around(bodies(), 0.05f, static_cast<float>(winding_limit_C),
                                                  static_cast<float>(body_limit_C));
  config.use.heat = HeatBounds::ohmic(12.6f, 0.0f, {3.9f, 4.1f}, {0.0039f, 0.0039f}, 20.0f, 0.0f,
                                      static_cast<float>(winding_limit_C));
  config.use.highest_air_C = 40.0f;
  config.air_error_K = 0.0f;
  return config;
}
void set_limits(SafetyLimiter<>::Config& config) { config.maximum_C = static_cast<float>(body_limit_C); }
void set_limits(NodeLimiter::Config& config) {
  config.node[NodeLimiter::bracket].maximum_C = config.node[NodeLimiter::body].maximum_C =
      config.node[NodeLimiter::magnets].maximum_C = static_cast<float>(body_limit_C);
  config.node[NodeLimiter::winding].maximum_C = static_cast<float>(winding_limit_C);
}
void set_limits(Proven::Config& config) { config = proven(); }
template <class Axis>
Axis new_axis() {
  typename Axis::Config config = Axis::Config::with_gain({24.0f, 4.0f});
  set_limits(config.limiter);
  const Axis axis(config);
  REQUIRE(axis.validate() == ConfigError::none);
  return axis;
}

/// What the axis is told in a step, and the supply that there is.
struct Told {
  float error_deg = 5.0f, supply_V = 12.6f, air_C = static_cast<float>(true_air_C);
  float dt_s = static_cast<float>(step_s);
  double true_V = 12.6;
};
struct Outcome {
  double over_K, hottest_winding_C, mean_power;
  LimitReason last;
};
/// An hour at full demand. @param tell  changes what is told at a time, and may make the axis anew
template <class Axis, class Tell>
Outcome hour(Tell tell) {
  Axis axis = new_axis<Axis>();
  Truth motor;
  double sum = 0.0;
  long count = 0;
  int power = 1;
  for (double now_s = 0.0; now_s < 3600.0; now_s += step_s, ++count) {
    Told told;
    tell(now_s, told, axis);
    motor.pass(told.true_V, power, true_air_C, step_s);
    power = axis.step({told.error_deg, told.supply_V, told.air_C, LimitReason::none}, told.dt_s).power;
    sum += power;
  }
  return {motor.over_K, motor.hottest_winding_C, sum / static_cast<double>(count), axis.state().reason};
}

long tick(double now_s) { return std::lround(now_s / step_s); }

/// Whether the motor stays inside its limits under each limiter that was told the motor's own constants.
template <class Tell>
void check_inside(const char* name, Tell tell) {
  INFO(name);
  CHECK(hour<Plain>(tell).over_K < 0.5);
  CHECK(hour<Nodes>(tell).over_K < 0.5);
  CHECK(hour<Certified>(tell).over_K < 0.0);
}

}  // namespace

TEST_CASE("steps without a valid time heat the estimate as long as the step before") {
  check_inside("every second one runs backwards", [](double now_s, Told& told, auto&) {
    if (tick(now_s) % 2 == 1) told.dt_s = -told.dt_s;
  });
  check_inside("two of three are no number", [](double now_s, Told& told, auto&) {
    if (tick(now_s) % 3 != 0) told.dt_s = nan_;
  });
  check_inside("one in three jumps back by a second", [](double now_s, Told& told, auto&) {
    if (tick(now_s) % 3 == 0) told.dt_s = -1.0f;
  });
  check_inside("the clock stands for longer than is tolerated, again and again",
               [](double now_s, Told& told, auto&) {
                 if (tick(now_s) % 13 != 0) told.dt_s = 0.0f;
               });
}

TEST_CASE("time that stands still in some of the steps hides no heat, and in most of them it is a fault") {
  for (const int zeros : {1, 2, 4, 9, 10, 11, 30}) {
    const auto stands = [zeros](double now_s, Told& told, auto&) {
      if (tick(now_s) % (zeros + 1) != 0) told.dt_s = 0.0f;
    };
    const std::string name = std::to_string(zeros) + " of " + std::to_string(zeros + 1);
    check_inside(name.c_str(), stands);
    // At the end of the hour it is in a step of time as well as in one of none.
    if (zeros > 1) CHECK(hour<Plain>(stands).last == LimitReason::time_stands_still);
  }
  for (const double share : {0.3, 0.5, 0.7, 0.9}) {
    std::mt19937 random(1);
    std::bernoulli_distribution stands(share);
    check_inside(("at random, " + std::to_string(share)).c_str(), [&](double, Told& told, auto&) {
      if (stands(random)) told.dt_s = 0.0f;
    });
  }
  // The worst clock there is.
  check_inside("as long as the power is on", [&](double, Told& told, auto& axis) {
    if (axis.state().power > 20) told.dt_s = 0.0f;
  });
}

TEST_CASE(
    "a clock of whole milliseconds is no fault in a loop of twice its rate, and leaves it most of its power") {
  const auto power = [](long every_us, bool is_exact) {
    Plain axis = new_axis<Plain>();
    Truth motor;
    double sum = 0.0;
    long last_ms = 0, steps = 0, faults = 0;
    for (long now_us = 0; now_us < 600000000; now_us += every_us, ++steps) {
      motor.pass(12.6, axis.state().power, true_air_C, 1e-6 * static_cast<double>(every_us));
      const long now_ms = now_us / 1000;
      const float dt_s =
          is_exact ? 1e-6f * static_cast<float>(every_us) : static_cast<float>(now_ms - last_ms) * 1e-3f;
      last_ms = now_ms;
      const auto& now = axis.step({5.0f, 12.6f, static_cast<float>(true_air_C), LimitReason::none}, dt_s);
      sum += now.power;
      if (now_us > 1000000) faults += is_fault(now.reason) ? 1 : 0;  // at first no time was told yet
    }
    CHECK(motor.over_K < 0.5);
    CHECK(faults == 0);
    return sum / static_cast<double>(steps);
  };
  for (const long every_us : {500, 700, 1000, 1300}) {
    CAPTURE(every_us);
    CHECK(power(every_us, false) > 0.75 * power(every_us, true));
  }
}

TEST_CASE("clocks that wrap, round or run fast keep the limits") {
  check_inside("a hundred milliseconds told for ten",
               [](double, Told& told, auto&) { told.dt_s = 10.0f * static_cast<float>(step_s); });
  std::uint32_t last_us = 0;
  check_inside("micros() wraps, subtracted as unsigned", [&](double now_s, Told& told, auto&) {
    const auto now_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(now_s * 1e6) + 4000000000ull);
    if (now_s > 0.0) told.dt_s = static_cast<float>(now_us - last_us) * 1e-6f;
    last_us = now_us;
  });
  float last_s = 0.0f;
  check_inside("micros() wraps, subtracted as float seconds", [&](double now_s, Told& told, auto&) {
    const auto now_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(now_s * 1e6) + 4000000000ull);
    const float seconds = static_cast<float>(now_us) * 1e-6f;
    if (now_s > 0.0) told.dt_s = seconds - last_s;
    last_s = seconds;
  });
}

TEST_CASE("a battery of another number of cells that is read does not drive") {
  for (const double volt : {16.8, 8.4}) {
    const auto battery = [volt](double, Told& told, auto&) {
      told.true_V = volt;
      told.supply_V = static_cast<float>(volt);
    };
    check_inside("four cells or two for three", battery);
    const LimitReason reason = volt > 12.6 ? LimitReason::supply_implausible : LimitReason::supply_low;
    CHECK(hour<Plain>(battery).last == reason);
    CHECK(hour<Nodes>(battery).last == reason);
    CHECK(hour<Certified>(battery).last == reason);
  }
}

TEST_CASE("a field that is no number in some of the steps keeps the limits") {
  for (const int every : {2, 50})
    for (const int field : {0, 1, 2, 3})
      check_inside("error, supply, air or time", [=](double now_s, Told& told, auto&) {
        float* const fields[] = {&told.error_deg, &told.supply_V, &told.air_C, &told.dt_s};
        if (tick(now_s) % every == 0) *fields[field] = nan_;
      });
}

TEST_CASE("readings that lie slowly keep the limits of an axis whose ranges are declared") {
  check_inside("air falls by a kelvin a minute, inside its range", [](double now_s, Told& told, auto&) {
    told.air_C = static_cast<float>(std::max(1.0, true_air_C - now_s / 60.0));
  });
  check_inside("air falls out of its range", [](double now_s, Told& told, auto&) {
    told.air_C = static_cast<float>(true_air_C - now_s / 20.0);
  });
  const auto sagging = [](double now_s, Told& told, auto&) {
    told.supply_V = static_cast<float>(std::max(9.0, 12.6 - now_s / 300.0));
  };
  CHECK(hour<Certified>(sagging).over_K < 0.0);
  // An estimate takes the reading: its rise is short by (highest / lowest)^2 at most.
  CHECK(hour<Plain>(sagging).over_K < (body_limit_C - 40.0) * (12.6 * 12.6 / (9.0 * 9.0) - 1.0) + 0.5);
}

TEST_CASE("resets while the motor is hot") {
  const auto forget = [](double now_s, Told&, auto& axis) {
    if (tick(now_s) % 2000 == 1999) axis = new_axis<typename std::decay<decltype(axis)>::type>();
  };
  const auto remember = [](double now_s, Told&, auto& axis) {
    if (tick(now_s) % 2000 != 1999) return;
    const auto kept = axis.thermal().state();
    axis = new_axis<typename std::decay<decltype(axis)>::type>();
    axis.start(kept.winding_C);  // both nodes
  };
  // A bound that nobody sets is the limit.
  CHECK(hour<Certified>(forget).over_K < 0.0);
  CHECK(hour<Plain>(remember).over_K < 0.5);
  CHECK(hour<Nodes>(remember).over_K < 0.5);
  // An estimate that nobody sets is the air, as AxisController::start() says: a program that resets needs a memory.
  CHECK(hour<Plain>(forget).over_K > 0.0);
}

TEST_CASE("a time that is told ten times too short is a fault where the motor declares its shortest step") {
  const auto tenth = [](double, Told& told, auto&) { told.dt_s = 0.1f * static_cast<float>(step_s); };
  const auto now_and_then = [](double now_s, Told& told, auto&) {
    if (tick(now_s) % 3 != 0) told.dt_s = 0.1f * static_cast<float>(step_s);
  };
  const auto from_then_on = [](double now_s, Told& told, auto&) {
    if (now_s > 600.0) told.dt_s = 0.1f * static_cast<float>(step_s);
  };
  const auto check = [](const Outcome& outcome, double most_over_K) {
    CHECK(outcome.over_K < most_over_K);
    CHECK(outcome.last == LimitReason::time_invalid);
  };
  check(hour<AxisController<InALoop<Undeclared>>>(tenth), 0.0);
  check(hour<AxisController<InALoop<Motor>>>(tenth), 0.0);
  check(hour<AxisController<InALoop<Motor>, StepPowerLaw<>, NodeLimiter>>(tenth), 0.0);
  check(hour<AxisController<InALoop<Motor>, StepPowerLaw<>, Proven>>(tenth), 0.0);
  check(hour<AxisController<InALoop<Motor>>>(from_then_on), 0.5);
  check(hour<AxisController<InALoop<Motor>, StepPowerLaw<>, NodeLimiter>>(from_then_on), 0.5);
  check(hour<AxisController<InALoop<Motor>, StepPowerLaw<>, Proven>>(from_then_on), 0.0);
  CHECK(hour<AxisController<InALoop<Motor>>>(now_and_then).over_K < 0.5);
  CHECK(hour<AxisController<InALoop<Motor>, StepPowerLaw<>, Proven>>(now_and_then).over_K < 0.0);
}

TEST_CASE(
    "a declared shortest step costs a loop that keeps it nothing, and a clock that stands still in some steps neither") {
  const auto right = [](double, Told&, auto&) {};
  CHECK(hour<AxisController<InALoop<Motor>>>(right).mean_power == hour<Plain>(right).mean_power);
  const auto slow_clock = [](double now_s, Told& told, auto&) {
    told.dt_s = tick(now_s) % 3 == 0 ? 0.0f : 1.5f * static_cast<float>(step_s);
  };
  CHECK(!is_fault(hour<AxisController<InALoop<Motor>>>(slow_clock).last));
}

TEST_CASE("the errors that no firmware can see pass the limit as the page says") {
  const auto short_time = [](double, Told& told, auto&) { told.dt_s = 0.1f * static_cast<float>(step_s); };
  CHECK(hour<Bare>(short_time).over_K > 0.0);
  const auto drifting = [](double now_s, Told& told, auto&) {
    told.air_C = static_cast<float>(std::max(1.0, true_air_C - now_s / 60.0));
  };
  CHECK(hour<Bare>(drifting).over_K > 0.0);
  const auto constant = [](double, Told& told, auto&) { told.true_V = 16.8; };
  CHECK(hour<Bare>(constant).over_K > 0.0);
}

namespace {

/// A thermistor on the housing behind its guard, and one on the winding, before a NodeLimiter; the model beside them is right.
template <class Read>
double worst_behind_guards(Read read) {
  SensorGuard of_winding(SensorGuard::Config{0.0f, 150.0f, 60.0f, 0.5f, 5.0f, 6.0f, 2.0f}),
      of_body(SensorGuard::Config{0.0f, 150.0f, 5.0f, 0.5f, 5.0f, 6.0f, 2.0f});
  NodeLimiter::Config config = NodeLimiter::Config::standard();
  set_limits(config);
  NodeLimiter limiter(config);
  Truth motor, model;
  int power = 1;
  for (double now_s = 0.0; now_s < 7200.0; now_s += 0.05) {
    motor.pass(12.6, power, true_air_C, 0.05);
    model.pass(12.6, power, true_air_C, 0.05);
    double winding_C = motor.winding_C, body_C = motor.body_C;
    read(now_s, winding_C, body_C);
    const SensorGuard::Inputs winding = {static_cast<float>(winding_C), static_cast<float>(model.winding_C)},
                              body = {static_cast<float>(body_C), static_cast<float>(model.body_C)};
    const GuardedCelsius winding_read = of_winding.step(winding, body, 0.05f),
                         body_read = of_body.step(body, winding, 0.05f);
    power = limiter.step({255, winding_read, body_read, 25.0f}, 0.05f).power;
  }
  return motor.over_K;
}

}  // namespace

TEST_CASE(
    "thermistors that lie slowly bring a part over its limit by no more than the declared disagreement") {
  const double disagreement_K = 6.0;
  CHECK(worst_behind_guards([](double, double&, double&) {}) < 0.5);
  CHECK(worst_behind_guards([](double now_s, double& winding_C, double& body_C) {
          winding_C -= now_s / 60.0, body_C -= now_s / 60.0;
        }) < disagreement_K + 0.5);
  CHECK(worst_behind_guards([](double now_s, double&, double& body_C) { body_C -= now_s / 600.0; }) <
        disagreement_K + 0.5);
  CHECK(worst_behind_guards([](double now_s, double& winding_C, double& body_C) {
          if (now_s > 600.0) std::swap(winding_C, body_C);
        }) < disagreement_K + 0.5);
  // A wrong table of the thermistor: what is above the air reads four fifths.
  CHECK(worst_behind_guards([](double, double& winding_C, double& body_C) {
          winding_C = true_air_C + 0.8 * (winding_C - true_air_C);
          body_C = true_air_C + 0.8 * (body_C - true_air_C);
        }) < disagreement_K + 0.5);
  CHECK(worst_behind_guards([](double now_s, double& winding_C, double& body_C) {
          if (std::fmod(now_s, 1.0) < 0.5) winding_C = static_cast<double>(nan_);
          else body_C = static_cast<double>(nan_);
        }) < 0.5);
}

namespace {

struct Message {
  double power;
  float error_deg(std::uint8_t) const { return 5.0f; }
  std::int8_t imu_C() const { return 25; }
  std::int8_t frame_imu_C() const { return 25; }
  float battery_V() const { return 12.6f; }
  std::uint8_t motor_power(std::uint8_t) const { return static_cast<std::uint8_t>(std::lround(power)); }
};

/// Half an hour of a board that takes a command late and by a factor. @param frozen_after_s  its telemetry says the same from then on
template <class Axis>
Outcome board(double late_s, double factor, double frozen_after_s) {
  typename Axis::Config axis = Axis::Config::with_gain({24.0f, 4.0f});
  set_limits(axis.limiter);
  GimbalConfig config = GimbalConfig::standard();
  config.air.declared_C = Motor::air().highest_C;
  BasicGimbalController<MeasuredSupply, Axis> gimbal(config, axis);
  REQUIRE_FALSE(is_error(gimbal.validate().field));
  Truth motor;
  std::deque<double> line(1 + static_cast<std::size_t>(std::lround(late_s / step_s)), 1.0);
  Message message = {1.0};
  double sum = 0.0;
  long count = 0;
  LimitReason last = LimitReason::none;
  for (double now_s = 0.0; now_s < 1800.0; now_s += step_s, ++count) {
    const double force = std::max(1.0, line.front() * factor);
    motor.pass(12.6, force, true_air_C, step_s);
    if (now_s < frozen_after_s) message.power = force;
    const auto& command = gimbal.step(message, static_cast<float>(step_s));
    sbgc::Confirm confirm;
    confirm.confirmed_id = sbgc::command::set_adj_vars_val;
    gimbal.confirmed(confirm);
    line.push_back(command.power[0]);
    line.pop_front();
    sum += command.power[0];
    last = command.reason[0];
  }
  return {motor.over_K, motor.hottest_winding_C, sum / static_cast<double>(count), last};
}
template <class Axis>
void check_boards() {
  const double never = 1e9;
  const double inside_K = 0.5;
  CHECK(board<Axis>(0.03, 1.0, never).over_K < inside_K);
  CHECK(board<Axis>(0.03, 0.8, never).over_K < inside_K);
  CHECK(board<Axis>(0.03, 1.25, never).over_K < inside_K);
  CHECK(board<Axis>(0.03, 0.8, never).mean_power > 10.0);
  for (const double frozen_after_s : {0.5, 3.0, 60.0, 600.0}) {
    const Outcome frozen = board<Axis>(0.0, 1.0, frozen_after_s);
    INFO("frozen after " << frozen_after_s << " s");
    CHECK(frozen.over_K < inside_K);
  }
}

}  // namespace

TEST_CASE("boards that are late, off by a factor, or whose telemetry stands while CONFIRM goes on") {
  check_boards<Plain>();
  check_boards<Nodes>();
  check_boards<Certified>();
}
