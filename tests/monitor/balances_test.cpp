// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Each balance by itself, against bodies that these tests integrate.

#include <thermopower/monitor/model_monitor.hpp>

#include "../catch.hpp"

#include <cmath>
#include <limits>
#include <random>

using namespace thermopower;

namespace {

/// One mass: 100 W, 200 J/K, 0.5 W/K, all to 10 %.
struct Plate {
  static constexpr MonitorConfig monitor() { return {10.0, 1000.0, true}; }
  static constexpr HeatBalanceConfig heat_balance() {
    return {100.0, 0.1, 200.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.1, 0.0, 0.0, 1.0, 0.05, 0.01, 0.0};
  }
};
struct TellingPlate : Plate {
  static constexpr MonitorConfig monitor() { return {10.0, 1000.0, false}; }
};
/// The same to 4 %, with a quiet thermometer.
struct KnownPlate {
  static constexpr MonitorConfig monitor() { return {10.0, 1000.0, true}; }
  static constexpr HeatBalanceConfig heat_balance() {
    return {100.0, 0.04, 200.0, 0.04, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.04, 0.0, 0.0, 1.0, 0.02, 0.01, 0.0};
  }
};
/// A bed under glass: 220 W, 427 J/K, 686 J/K that follow 135 s later.
struct UnderGlass {
  static constexpr MonitorConfig monitor() { return {10.0, 1000.0, true}; }
  static constexpr HeatBalanceConfig heat_balance() {
    return {220.0, 0.04, 427.0, 0.05, 686.0, 135.0, 0.1, 0.2, 0.1, 1.3, 0.05, 0.0, 0.0, 3.0, 0.05, 0.05, 1.0};
  }
};
/// 30 W into 10 J/K, 1 W/K to 80 J/K, 0.3 W/K to the air: as its housing shows it.
struct Housing {
  static constexpr MonitorConfig monitor() { return {5.0, 1000.0, true}; }
  static constexpr HeatBalanceConfig heat_balance() {
    return HeatBalanceConfig::measured_body(30.0, 10.0, 80.0, 1.0, 0.3, 0.03, 0.02);
  }
};
/// The same as its winding's resistance shows it.
struct Winding {
  static constexpr MonitorConfig monitor() { return {5.0, 1000.0, true}; }
  static constexpr HeatBalanceConfig heat_balance() {
    return HeatBalanceConfig::measured_winding(30.0, 10.0, 80.0, 1.0, 0.3, 0.03, 0.02);
  }
};
struct Copper {
  static constexpr MonitorConfig monitor() { return {5.0, 1000.0, true}; }
  static constexpr WindingBalanceConfig winding_balance() {
    return {24.0, 2.0, 0.05, 0.00393, 25.0, 5.0, 0.1, 0.05};
  }
};
struct Shaft {
  static constexpr MonitorConfig monitor() { return {5.0, 1000.0, true}; }
  static constexpr MotionBalanceConfig motion_balance() {
    return {5.0, 300.0, 5.0, 0.05, 0.05, 1e-4, 0.05, 0.01, 5e-5, 0.2, 0.0, 0.002};
  }
};

/// A plate as it is.
struct RealPlate {
  double heat = 1.0, capacity_J_per_K = 200.0, loss_W_per_K = 0.5, air_C = 20.0, plate_C = 20.0;
  void pass(double told_W, double dt_s) {
    plate_C += dt_s * (heat * told_W - loss_W_per_K * (plate_C - air_C)) / capacity_J_per_K;
  }
};

/// Steps until a balance disagrees. @return seconds, or below 0
template <class Monitor>
double alarm_s(Monitor& monitor, RealPlate& real, double told_W, double run_s, double dt_s = 0.1,
               double noise_K = 0.04) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  for (double now_s = 0.0; now_s < run_s; now_s += dt_s) {
    for (int part = 0; part < 10; ++part) real.pass(told_W, dt_s / 10.0);
    monitor.step(MonitorInputs::heater(static_cast<float>(told_W),
                                       static_cast<float>(real.plate_C + noise_K * gauss(random)), 20.0f),
                 static_cast<float>(dt_s));
    if (monitor.disagreement() != Disagreement::none) return now_s;
  }
  return -1.0;
}

}  // namespace

TEST_CASE("every corner of the bounds is healthy") {
  for (int corner = 0; corner < 16; ++corner) {
    CAPTURE(corner);
    ModelMonitor<Plate> monitor;
    RealPlate real;
    real.heat = (corner & 1) != 0 ? 1.1 : 0.9;
    real.capacity_J_per_K *= (corner & 2) != 0 ? 1.1 : 0.9;
    real.loss_W_per_K *= (corner & 4) != 0 ? 1.1 : 0.9;
    real.air_C += (corner & 8) != 0 ? 1.0 : -1.0;
    for (const double heat_W : {80.0, 20.0, 0.0, 100.0}) CHECK(alarm_s(monitor, real, heat_W, 900.0) < 0.0);
  }
}

TEST_CASE("beyond the bounds each constant is found, on its side, and is among the suspects") {
  struct Case {
    double heat, loss, air_K;
    Disagreement side;
    Suspect cause;
  };
  const Case cases[] = {{0.6, 1.0, 0.0, Disagreement::heat_missing, Suspect::heater},
                        {1.5, 1.0, 0.0, Disagreement::heat_unexplained, Suspect::heater},
                        {1.0, 1.9, 0.0, Disagreement::heat_missing, Suspect::loss},
                        {1.0, 0.3, 0.0, Disagreement::heat_unexplained, Suspect::loss},
                        {1.0, 1.0, 25.0, Disagreement::heat_unexplained, Suspect::air},
                        {1.0, 1.0, -25.0, Disagreement::heat_missing, Suspect::air}};
  for (const Case& one : cases) {
    CAPTURE(one.heat, one.loss, one.air_K);
    ModelMonitor<Plate> monitor;
    RealPlate real;
    CHECK(alarm_s(monitor, real, 30.0, 1500.0) < 0.0);
    real.heat = one.heat;
    real.loss_W_per_K *= one.loss;
    real.air_C += one.air_K;
    CHECK(alarm_s(monitor, real, 30.0, 1500.0) > 0.0);
    CHECK(monitor.disagreement() == one.side);
    CHECK(is_suspect(monitor.suspects(), one.cause));
    CHECK(monitor.record().since_s >= 20);
    CHECK(monitor.reason() != LimitReason::none);
  }
}

TEST_CASE("cut, a weak heater and a larger loss are told apart as the plate cools") {
  for (const bool is_weak : {true, false}) {
    ModelMonitor<KnownPlate> monitor;
    RealPlate real;
    CHECK(alarm_s(monitor, real, 60.0, 3000.0, 0.1, 0.015) < 0.0);
    if (is_weak) real.heat = 0.5;
    else real.loss_W_per_K = 1.0;
    REQUIRE(alarm_s(monitor, real, 60.0, 3000.0, 0.1, 0.015) > 0.0);
    for (int i = 0; i < 3000; ++i) {
      real.pass(0.0, 0.1);
      monitor.step(MonitorInputs::heater(0.0f, static_cast<float>(real.plate_C), 20.0f), 0.1f);
    }
    CAPTURE(is_weak);
    CHECK(is_suspect(monitor.suspects(), Suspect::heater) == is_weak);
    CHECK(is_suspect(monitor.suspects(), Suspect::loss) == !is_weak);
  }
}

TEST_CASE("a heater that stays on is named alone, and a reading that stands still is the thermometer") {
  ModelMonitor<Plate> on, stuck;
  RealPlate real;
  CHECK(alarm_s(on, real, 20.0, 600.0) < 0.0);
  for (int i = 0; i < 1200 && on.disagreement() == Disagreement::none; ++i) {
    real.pass(100.0, 0.1);
    on.step(MonitorInputs::heater(10.0f, static_cast<float>(real.plate_C), 20.0f), 0.1f);
  }
  CHECK(on.suspects() == static_cast<uint8_t>(Suspect::heater));
  RealPlate held;
  CHECK(alarm_s(stuck, held, 40.0, 2000.0) < 0.0);
  for (int i = 0; i < 1200; ++i) stuck.step(MonitorInputs::heater(0.0f, 90.0f, 20.0f), 0.1f);
  CHECK(stuck.suspects() == static_cast<uint8_t>(Suspect::thermometer));
  CHECK(stuck.reason() == LimitReason::thermometer_disagrees);
}

TEST_CASE("the loop's rate does not matter, up to four steps a block") {
  for (const double dt_s : {0.01, 0.1, 0.3, 1.0, 2.5}) {
    CAPTURE(dt_s);
    ModelMonitor<Plate> monitor;
    RealPlate real;
    CHECK(alarm_s(monitor, real, 60.0, 1200.0, dt_s) < 0.0);
    real.heat = 0.6;
    const double found_s = alarm_s(monitor, real, 60.0, 1200.0, dt_s);
    CHECK(found_s > 10.0);
    CHECK(found_s < 60.0);
  }
}

TEST_CASE("a fast loop keeps the time: steps far below a tick are carried on") {
  for (const double dt_s : {0.0003, 0.0005, 0.0019, 0.0077}) {
    CAPTURE(dt_s);
    ModelMonitor<Plate> monitor;
    RealPlate real;
    real.heat = 1.1;  // at the edge of the bounds, where lost time would show at once
    real.capacity_J_per_K *= 1.1;
    CHECK(alarm_s(monitor, real, 100.0, 100.0, dt_s) < 0.0);
    CHECK(monitor.is_watching_heat());
    real.heat = 0.6;
    CHECK(alarm_s(monitor, real, 60.0, 200.0, dt_s) > 0.0);
  }
}

TEST_CASE("two nodes are one balance, whichever of them is measured") {
  for (const bool is_winding : {false, true}) {
    CAPTURE(is_winding);
    ModelMonitor<Housing> housing;
    ModelMonitor<Winding> winding;
    double winding_C = 20.0, body_C = 20.0;
    const auto run = [&](double told_W, double real_W, double run_s) {
      for (double now_s = 0.0; now_s < run_s; now_s += 0.05) {
        const double across_W = 1.0 * (winding_C - body_C);
        winding_C += 0.05 * (real_W - across_W) / 10.0;
        body_C += 0.05 * (across_W - 0.3 * (body_C - 20.0)) / 80.0;
        housing.step(MonitorInputs::heater(static_cast<float>(told_W), static_cast<float>(body_C), 20.0f),
                     0.05f);
        winding.step(MonitorInputs::heater(static_cast<float>(told_W), static_cast<float>(winding_C), 20.0f),
                     0.05f);
      }
      return is_winding ? winding.disagreement() : housing.disagreement();
    };
    for (const double heat_W : {30.0, 5.0, 20.0, 0.0})
      CHECK(run(heat_W, heat_W, 240.0) == Disagreement::none);
    CHECK(run(20.0, 14.0, 240.0) == Disagreement::heat_missing);
  }
}

TEST_CASE("a monitor that starts on a warm body waits until it knows where the second mass is") {
  double winding_C = 20.0, body_C = 20.0;
  for (int restart = 0; restart < 6; ++restart) {  // each in the middle of another heating
    ModelMonitor<Winding> monitor;
    bool has_watched = false;
    for (int i = 0; i < 8000; ++i) {
      const double heat_W = restart % 2 == 0 ? 30.0 : (i < 400 ? 0.0 : 10.0), across_W = winding_C - body_C;
      winding_C += 0.05 * (heat_W - across_W) / 10.0;
      body_C += 0.05 * (across_W - 0.3 * (body_C - 20.0)) / 80.0;
      if (restart == 0 && i < 400) continue;
      monitor.step(MonitorInputs::heater(static_cast<float>(heat_W), static_cast<float>(winding_C), 20.0f),
                   0.05f);
      has_watched = has_watched || monitor.is_watching_heat();
    }
    CAPTURE(restart);
    CHECK(monitor.disagreement() == Disagreement::none);
    CHECK(has_watched);
  }
}

TEST_CASE("a second mass may be anywhere between the air and the reading when the monitor starts") {
  for (const double second_start_C : {20.0, 40.0, 60.0}) {
    ModelMonitor<UnderGlass> monitor;
    double plate_C = 60.0, second_C = second_start_C;
    bool has_watched = false;
    for (int i = 0; i < 30000; ++i) {
      const double heat_W = plate_C < 60.0 ? 220.0 : 0.0;  // a thermostat
      const double into_W = 686.0 / 135.0 * (plate_C - second_C);
      plate_C += 0.05 * (heat_W - into_W - 1.3 * (plate_C - 20.0)) / 427.0;
      second_C += 0.05 * into_W / 686.0;
      monitor.step(MonitorInputs::heater(static_cast<float>(heat_W), static_cast<float>(plate_C), 20.0f),
                   0.05f);
      has_watched = has_watched || monitor.is_watching_heat();
    }
    CAPTURE(second_start_C);
    CHECK(monitor.disagreement() == Disagreement::none);
    CHECK(has_watched);
  }
}

TEST_CASE("a small loss of heat is found as soon as it exceeds what two readings can be wrong by") {
  // Steady at 60 K with 4 W of air, 4 % of heat and of loss allowed. A block may hide that, and four counts of rounding.
  for (const double missing : {0.25, 0.35, 0.5}) {
    CAPTURE(missing);
    ModelMonitor<KnownPlate> monitor;
    RealPlate real;
    REQUIRE(alarm_s(monitor, real, 60.0, 3000.0, 0.1, 0.02) < 0.0);
    real.heat = 1.0 - missing;
    const double told_W = 30.0 / real.heat, excess_W = (told_W - 30.0) - 0.04 * (told_W + 30.0) - 0.5 - 0.1;
    // A loop that holds 60 K above the air.
    real.plate_C = 80.0;
    monitor.restart();
    // Noise of two readings, as heat, times the root of what the limit is in nats, twice; two blocks to begin and end with.
    const double limit_J =
        2.0 * std::sqrt(ModelMonitor<KnownPlate>::limit_nat()) * std::sqrt(2.0) * 200.0 * 0.02;
    const double found_s = alarm_s(monitor, real, told_W, 3000.0, 0.1, 0.02);
    CHECK(found_s > 0.0);
    CHECK(found_s < limit_J / excess_W + 5.0 * 10.0);
  }
}

TEST_CASE("what is no number judges nothing, and a pause of unknown length starts anew") {
  const float nan = detail::not_a_number(), infinite = std::numeric_limits<float>::infinity();
  for (const float wrong : {nan, infinite, -infinite, 1e30f, -1e30f, 501.0f}) {
    ModelMonitor<Plate> monitor;
    for (int i = 0; i < 3000; ++i) monitor.step(MonitorInputs::heater(100.0f, wrong, 20.0f), 0.1f);
    for (int i = 0; i < 3000; ++i) monitor.step(MonitorInputs::heater(wrong, 20.0f, 20.0f), 0.1f);
    for (int i = 0; i < 3000; ++i) monitor.step(MonitorInputs::heater(50.0f, 20.0f, wrong), 0.1f);
    CHECK(monitor.disagreement() == Disagreement::none);
  }
  ModelMonitor<Plate> monitor;
  RealPlate real;
  real.heat = 0.5;
  for (int i = 0; i < 1000; ++i) {  // never a whole block between two pauses
    for (int j = 0; j < 90; ++j) {
      real.pass(80.0, 0.1);
      monitor.step(MonitorInputs::heater(80.0f, static_cast<float>(real.plate_C), 20.0f), 0.1f);
    }
    for (const float wrong_s : {nan, -1.0f, 9.0f, infinite})
      monitor.step(MonitorInputs::heater(80.0f, static_cast<float>(real.plate_C), 20.0f), wrong_s);
  }
  CHECK(monitor.disagreement() == Disagreement::none);
  CHECK_FALSE(monitor.is_watching_heat());
}

TEST_CASE("one spike of any size is not a fault") {
  ModelMonitor<Plate> monitor;
  RealPlate real;
  for (int i = 0; i < 20000; ++i) {
    real.pass(40.0, 0.1);
    const float spike_K = i % 700 == 99 ? 60.0f : 0.0f;  // some of them at the end of a block
    monitor.step(MonitorInputs::heater(40.0f, static_cast<float>(real.plate_C) + spike_K, 20.0f), 0.1f);
  }
  CHECK(monitor.disagreement() == Disagreement::none);
}

TEST_CASE("a disagreement stays until it is acknowledged, and cuts only where it is told to") {
  ModelMonitor<Plate> cutting;
  ModelMonitor<TellingPlate> telling;
  RealPlate real, same;
  real.heat = same.heat = 0.3;
  CHECK(alarm_s(cutting, real, 60.0, 600.0) > 0.0);
  CHECK(alarm_s(telling, same, 60.0, 600.0) > 0.0);
  CHECK(cutting.limit(200).power == least_power());
  CHECK(is_fault(cutting.limit(200).reason));
  CHECK(cutting.limit(0).power == 0);
  CHECK(telling.limit(200).power == 200);
  CHECK(telling.limit(200).reason == LimitReason::none);
  CHECK(telling.reason() != LimitReason::none);
  const uint8_t suspects = cutting.suspects();
  cutting.restart();
  cutting.step(MonitorInputs::heater(0.0f, 20.0f, 20.0f), detail::not_a_number());
  CHECK(cutting.limit(200).power == least_power());
  CHECK(cutting.suspects() == suspects);
  cutting.acknowledge();
  CHECK(cutting.limit(200).power == 200);
  CHECK(cutting.record().suspects == 0);
}

TEST_CASE("a winding: fifteen percent less or more than copper explains, at any temperature and sign") {
  for (const double share : {0.85, 0.96, 1.0, 1.04, 1.15}) {
    ModelMonitor<Copper> monitor;
    for (int i = 0; i < 3000; ++i) {
      const double winding_C = 25.0 + 0.03 * i, current_A = (i / 500) % 2 == 0 ? 5.0 : -5.0;
      const double volt = share * 2.0 * (1.0 + 0.00393 * (winding_C - 25.0)) * current_A;
      monitor.step(MonitorInputs::motor(0.0f, 0.0f, 0.0f, static_cast<float>(volt),
                                        static_cast<float>(current_A), static_cast<float>(winding_C), 0.0f),
                   0.1f);
    }
    CAPTURE(share);
    CHECK(monitor.disagreement() == (share < 0.9   ? Disagreement::resistance_low
                                     : share > 1.1 ? Disagreement::resistance_high
                                                   : Disagreement::none));
  }
}

TEST_CASE(
    "a shaft: friction beyond its bounds, whether it turns steadily or gains speed; not while it turns round") {
  for (const double friction : {0.3, 0.85, 1.0, 1.15, 2.0}) {
    ModelMonitor<Shaft> monitor, shuttling;
    for (int i = 0; i < 6000; ++i) {
      const double rate = -(60.0 + 100.0 * std::sin(0.002 * i) * std::sin(0.002 * i));
      const double acceleration = -100.0 * 2.0 * std::sin(0.002 * i) * std::cos(0.002 * i) * 0.02;
      const double current_A = (1e-4 * acceleration + friction * (-0.01 + 5e-5 * rate)) / 0.05;
      monitor.step(MonitorInputs::motor(0.0f, 0.0f, 0.0f, 0.0f, static_cast<float>(current_A), 0.0f,
                                        static_cast<float>(rate)),
                   0.1f);
      shuttling.step(
          MonitorInputs::motor(0.0f, 0.0f, 0.0f, 0.0f, 5.0f, 0.0f, (i / 20) % 2 == 0 ? 50.0f : -50.0f), 0.1f);
    }
    CAPTURE(friction);
    CHECK(monitor.disagreement() == (friction < 0.5   ? Disagreement::drag_low
                                     : friction > 1.5 ? Disagreement::drag_high
                                                      : Disagreement::none));
    CHECK(shuttling.disagreement() == Disagreement::none);
  }
}

TEST_CASE("the limit is the logarithm of the blocks and tests in the stated time") {
  // ln(1000 h * 3600 s/h / 10 s * 2 directions)
  CHECK(ModelMonitor<Plate>::limit_nat() == Approx(std::log(720000.0)).epsilon(1e-9));
}

TEST_CASE("noise at the very edge of the bounds alarms no more often than stated") {
  // The test itself, with residuals that are white: e^6 = 403 blocks between false alarms at least.
  const uint8_t limit = static_cast<uint8_t>(6 * detail::evidence_per_nat());
  const detail::BinaryScale per_count = detail::binary_scale(0.5 * detail::evidence_per_nat() / 100.0);
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  long blocks = 0, alarms = 0;
  for (; blocks < 400000; ++blocks) {
    static detail::Evidence evidence;
    evidence.add(detail::saturated(static_cast<int32_t>(std::lround(1000.0 + 100.0 * gauss(random)))), 1025,
                 per_count, limit);
    if (evidence.more < limit) continue;
    ++alarms;
    evidence = detail::Evidence();
  }
  CHECK(alarms > 0);
  CHECK(alarms < blocks / 403);
}

TEST_CASE("noise of readings at the very edge of the bounds alarms no more often than stated") {
  // Residuals that are differences of readings: the sum of many is two readings. 2 sqrt(6) of their deviation alarms.
  const uint8_t limit = static_cast<uint8_t>(6 * detail::evidence_per_nat());
  const detail::BinaryScale per_count =
      detail::binary_scale(0.5 * detail::evidence_per_nat() / (std::sqrt(2.0) * 100.0 / std::sqrt(6.0)));
  std::mt19937 random(2);
  std::normal_distribution<double> gauss;
  detail::Evidence evidence;
  long blocks = 0, alarms = 0;
  double before = gauss(random);
  for (; blocks < 400000; ++blocks) {
    const double now = gauss(random);
    evidence.add(detail::saturated(static_cast<int32_t>(std::lround(1000.0 + 100.0 * (now - before)))), 1000,
                 per_count, limit);
    before = now;
    if (evidence.more < limit) continue;
    ++alarms;
    evidence = detail::Evidence();
  }
  CHECK(alarms < blocks / 403);
}
