// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Temperatures as people log them: a power that is switched between the rows or written after its interval, rows ten
// seconds apart, lines drawn between the readings. None of it is a gap, and none hides one.
#include "../catch.hpp"
#include "observe/switched_bench.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace thermopower;
using namespace thermopower::gap;
using Log = test::SwitchedBench::Log;

namespace {

using Change = Recording (*)(Recording);

Recording as_it_is(Recording r) { return r; }

Diagnosis answer_to(const test::SwitchedBench& bench, unsigned seed, Change change) {
  constexpr double lasts_s = 7200.0;
  return diagnose(test::SwitchedBench::model(), {change(bench.recording(lasts_s, seed))},
                  {change(bench.recording(lasts_s, seed + 100))});
}

/// Says so where a sound motor has a gap, or one with a winding has another cause.
void check_sound_and_wound(test::SwitchedBench bench, unsigned seed, Change change = as_it_is) {
  CAPTURE(bench.rows_s);
  CHECK(test::holds(answer_to(bench, seed, change)));
  bench.has_winding = true;
  const Diagnosis wound = answer_to(bench, seed, change);
  CHECK(wound.verdict == Verdict::explained);
  REQUIRE(wound.cause.size() == 1);
  CHECK(wound.cause[0].effect == "second_thermal_mass");
}

/// A motor on a battery that nobody logs: 0.3 ohm, and 2 V lower for each Ah that it has given.
Recording on_a_battery(std::uint64_t seed) {
  constexpr int rows = 2400;
  test::Noise noise(seed);
  Recording r;
  r.name = "on a battery";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows);
  double motor_C = 24.0, given_Ah = 0.0;
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 2.0 * i;
    power[i] = 25.0 * std::floor(5.2 + 5.0 * std::sin(static_cast<double>(seed) + 1.7 * (i / 60)));
    ambient[i] = 23.0;
    const double duty = power[i] / 255.0, ohm = 8.0 * (1.0 + 0.00393 * (motor_C - 25.0));
    const double amps = (12.0 - 2.0 * given_Ah) * std::sqrt(duty) / (ohm + 0.3 * duty);
    current[i] = amps + 0.003 * noise();
    motor[i] = motor_C + 0.1 * noise();
    given_Ah += amps * std::sqrt(duty) * 2.0 / 3600.0;
    for (int k = 0; k < 20; ++k) motor_C += 0.1 * (amps * amps * ohm - 0.15 * (motor_C - 23.0)) / 60.0;
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  return r;
}

TEST_CASE(
    "a battery is not full again where a power was lost, a logger paused, or the held-out part begins") {
  Model model = test::bench_model();
  const auto check_battery = [&](const Diagnosis& found) {
    INFO(found.reason);
    CHECK(found.verdict == Verdict::explained);
    REQUIRE(found.cause.size() == 1);
    CHECK(found.cause.front().effect == "supply_sag");
    CHECK(test::parameter_of(found, "V_per_Ah") == Approx(2.0).epsilon(0.05));
    CHECK(test::parameter_of(found, "internal_ohm") == Approx(0.3).epsilon(0.2));
  };
  Recording lost = on_a_battery(2), paused = on_a_battery(3);
  Eigen::VectorXd power = lost.column("power_param");
  for (const int hole : {700, 1500}) power.segment(hole, 10).setConstant(missing);
  lost.set("power_param", power);
  check_battery(diagnose(model, {on_a_battery(1)}, {lost}));
  // The logger lost rows; the motor did not stop.
  const Recording first = paused.slice(0, 900), second = paused.slice(930, paused.rows());
  Recording with_pause;
  with_pause.name = "paused";
  with_pause.t_s.resize(first.rows() + second.rows());
  with_pause.t_s << first.t_s, second.t_s;
  for (const Column& column : first.columns) {
    Eigen::VectorXd both(with_pause.t_s.size());
    both << column.values, second.column(column.name);
    with_pause.set(column.name, both);
  }
  check_battery(diagnose(model, {on_a_battery(1)}, {with_pause}));
  check_battery(diagnose(model, {on_a_battery(4)}, {}));
}

TEST_CASE("a power that is switched between the rows makes no gap, and hides none") {
  test::SwitchedBench bench;
  for (const double rows_s : {1.0, 5.0, 10.0}) {
    bench.rows_s = rows_s;
    check_sound_and_wound(bench, 11);
  }
}

TEST_CASE("an hour in which switches between the rows are too few to be told names no winding") {
  test::SwitchedBench bench;
  for (const unsigned seed : {1u, 3u, 4u, 5u}) {
    CAPTURE(seed);
    const Diagnosis sound = diagnose(test::SwitchedBench::model(), {bench.recording(3600.0, seed)},
                                     {bench.recording(3600.0, seed + 100)});
    CHECK(sound.cause.empty());
    CHECK(test::holds(sound));
  }
  // A few switches err by this or that much, and for as long as the motor remembers them.
  bench.rows_s = 2.0;
  for (const unsigned seed : {24u, 32u}) {
    CAPTURE(seed);
    const Diagnosis sound = diagnose(test::SwitchedBench::model(), {bench.recording(3600.0, seed)},
                                     {bench.recording(3600.0, seed + 100)});
    CHECK(test::holds(sound));
  }
}

TEST_CASE("a power that is written after its interval makes no gap, and hides none") {
  test::SwitchedBench bench;
  bench.log = Log::afterwards;
  for (const double rows_s : {1.0, 5.0}) {
    bench.rows_s = rows_s;
    check_sound_and_wound(bench, 12);
  }
}

/// A motor that radiates, at another power every three seconds, its current read 8 % and 0.05 A too high; ten rows a second, logged for
/// hours. What the model lacks of the current jumps in each of the averages that a search looks at.
Recording restless(Eigen::Index rows, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&] { return normal(random); };
  Recording r;
  r.name = "restless";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows);
  constexpr double interval_s = 0.1;
  double motor_C = 24.0, level = 200.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (i % 30 == 0) level = 25.0 * static_cast<double>(random() % 11);
    const double air_C = 23.0 + std::sin(1e-4 * static_cast<double>(i));
    ambient[i] = std::round(100.0 * (air_C + 0.05 * noise())) / 100.0;
    const double volts = 12.0 * std::sqrt(level / 255.0), ohm = 8.0 * (1.0 + 0.00393 * (motor_C - 25.0));
    r.t_s[i] = interval_s * static_cast<double>(i);
    power[i] = level;
    current[i] = std::round(1e3 * (1.08 * volts / ohm + 0.05 + 0.003 * noise())) / 1e3;
    motor[i] = std::round(10.0 * (motor_C + 0.1 * noise())) / 10.0;
    const double loss_W =
        0.15 * (motor_C - air_C) + 8e-10 * (std::pow(motor_C + 273.15, 4.0) - std::pow(air_C + 273.15, 4.0));
    motor_C += interval_s * (volts * volts / ohm - loss_W) / 60.0;
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  return r;
}

TEST_CASE("an error of the current that jumps with a restless power is no noise of it") {
  Model model;
  model.name = "restless";
  model.supply = SupplyModel{12.0};
  model.current = OhmicCurrentModel{8.0, 0.00393, 25.0};
  model.thermal = LumpedThermalModel{60.0, 0.15};
  const Diagnosis diagnosis = diagnose(model, {restless(70000, 5)}, {restless(30000, 6)});
  CHECK(diagnosis.verdict == Verdict::explained);
  REQUIRE_FALSE(diagnosis.cause.empty());
  const auto offset = std::find_if(diagnosis.cause.begin(), diagnosis.cause.end(),
                                   [](const Cause& one) { return one.effect == "current_sensor_offset"; });
  REQUIRE(offset != diagnosis.cause.end());
  CHECK(offset->parameters.front().value == Approx(0.05).epsilon(0.02));
}

constexpr double late = 0.4;  // of an interval

/// Puts each temperature into a row of its own, when it was read.
Recording in_rows_of_their_own(Recording r) {
  Recording result;
  result.name = r.name;
  const Eigen::Index rows = r.rows();
  result.t_s.resize(2 * rows - 1);
  for (Eigen::Index i = 0; i + 1 < rows; ++i) {
    result.t_s[2 * i] = r.t_s[i];
    result.t_s[2 * i + 1] = (1.0 - late) * r.t_s[i] + late * r.t_s[i + 1];
  }
  result.t_s[2 * rows - 2] = r.t_s[rows - 1];
  for (const Column& column : r.columns) {
    Eigen::VectorXd values = Eigen::VectorXd::Constant(2 * rows - 1, plant::missing);
    const Eigen::Index later = column.name == "motor_C" ? 1 : 0;
    for (Eigen::Index i = 0; i + 1 < rows; ++i) values[2 * i + later] = column.values[i];
    result.set(column.name, values);
  }
  return result;
}

/// Keeps every fifth temperature, and draws straight lines between those.
Recording with_lines_drawn(Recording r) {
  constexpr Eigen::Index apart = 5;
  Eigen::VectorXd motor = r.column("motor_C");
  for (Eigen::Index i = 0; i + apart < r.rows(); i += apart)
    for (Eigen::Index k = 1; k < apart; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(apart);
      motor[i + k] = (1.0 - share) * motor[i] + share * motor[i + apart];
    }
  r.set("motor_C", motor);
  return r;
}

TEST_CASE("rows of their own for each stream, and lines drawn between readings, make no gap and hide none") {
  for (const Change change : {in_rows_of_their_own, with_lines_drawn}) {
    CAPTURE(change == in_rows_of_their_own);
    test::SwitchedBench bench;
    bench.log = Log::at_rows;
    if (change == in_rows_of_their_own) bench.read_late = late;
    check_sound_and_wound(bench, 13, change);
  }
}

}  // namespace

TEST_CASE(
    "noise that remembers twenty readings is no gap in a few hundred of them, and hides no clear cause") {
  // As likely as not such noise comes to a quarter more or less than itself in a recording.
  const auto recorded = [](const test::BenchFault& fault, int rows, std::uint64_t seed) {
    constexpr double memory = 0.95;
    Recording r = test::bench_recording(fault, rows, seed);
    test::Noise noise(1000 * seed + static_cast<std::uint64_t>(rows));
    for (const auto& [column, sd] : {std::pair<const char*, double>{"current_A", 0.01}, {"motor_C", 0.3}}) {
      Eigen::VectorXd values = r.column(column);
      double last = noise();
      for (double& one : values) {
        last = memory * last + std::sqrt(1.0 - memory * memory) * noise();
        one += sd * last;
      }
      r.set(column, values);
    }
    return r;
  };
  const auto answer = [&](const test::BenchFault& fault, std::uint64_t seed) {
    return diagnose(test::bench_model(), {recorded(fault, 300, seed)}, {recorded(fault, 225, seed)});
  };
  int gaps = 0, named = 0;
  constexpr int draws = 80;
  for (std::uint64_t seed = 1; seed <= draws; ++seed) gaps += test::holds(answer({}, seed)) ? 0 : 1;
  CHECK(gaps <= 0.05 * draws);  // one in twenty: the level at which an interval is wrong
  constexpr int causes = 10;
  test::BenchFault offset;
  offset.sensor_offset_A = 0.05;
  for (std::uint64_t seed = 1; seed <= causes; ++seed) {
    const Diagnosis found = answer(offset, seed);
    named += found.cause.size() == 1 && found.cause.front().effect == "current_sensor_offset" ? 1 : 0;
  }
  CHECK(named >= 9);
}

TEST_CASE("a first reading that is off makes no gap, and hides none") {
  const double off_K = GENERATE(0.4, 0.8, -0.8, 3.0);
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto answer = [&](const test::BenchFault& fault, double conductance) {
      Recording held_out = test::bench_recording(fault, 300, seed + 100);
      Eigen::VectorXd motor_C = *held_out.find("motor_C");
      motor_C[0] += off_K;
      held_out.set("motor_C", motor_C);
      Model model = test::bench_model();
      std::get<LumpedThermalModel>(model.thermal).conductance_W_per_K *= conductance;
      return diagnose(model, {test::bench_recording(fault, 900, seed)}, {held_out});
    };
    CAPTURE(off_K, seed);
    CHECK(test::holds(answer({}, 1.0)));
    CHECK(test::holds(answer({}, 1.04)));
    test::BenchFault offset;
    offset.sensor_offset_A = 0.05;
    const Diagnosis biased = answer(offset, 1.0);
    CHECK(biased.verdict == Verdict::explained);
    CHECK(test::causes_of(biased) == std::vector<std::string>{"current_sensor_offset"});
    test::BenchFault loss;
    loss.extra_loss_W_per_K2 = 1e-3;
    CHECK(answer(loss, 1.0).verdict != Verdict::no_gap);
  }
}
