// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What the check does to the data, with the truth known: dirt is put into clean recordings at ten places, and each
// sample that was spoilt must be out of the way, and hardly any other.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <utility>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using engine::PreparedRecording;

namespace {

constexpr int places = 10;

Recording bench() { return test::bench_recording({}, 1500, 1); }
Recording axis() { return test::axis_recording({}, 3000, 1); }

/// Where dirt goes: ten rows, evenly spread but for an odd step, away from the ends.
Eigen::Index place(const Recording& r, int k) { return 60 + k * (r.rows() - 150) / places + 7 * k % 11; }

void change(Recording& r, const char* column, const std::function<double(double, Eigen::Index)>& f) {
  Eigen::VectorXd values = r.column(column);
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = f(values[i], i);
  r.set(column, values);
}

/// Rows of a column that are missing, or left out, after the check.
std::set<Eigen::Index> taken(const Recording& recorded, const PreparedRecording& prepared,
                             const char* column) {
  std::set<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < recorded.rows(); ++i) rows.insert(i);
  const Eigen::VectorXd& values = prepared.recording().column(column);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) rows.erase(prepared.source_rows()[static_cast<std::size_t>(i)]);
  return rows;
}

/// How many rows of one set another lacks.
std::size_t lacked_by(const std::set<Eigen::Index>& other, const std::set<Eigen::Index>& rows) {
  return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [&](Eigen::Index row) { return other.count(row) == 0; }));
}

/// Lets a row repeat the frame before it, and notes it.
void repeat_frame(Eigen::VectorXd& angle, Eigen::VectorXd& rate, Eigen::Index row,
                  std::set<Eigen::Index>& bad) {
  angle[row] = angle[row - 1];
  rate[row] = rate[row - 1];
  bad.insert(row);
}

bool found(const PreparedRecording& prepared, FindingKind kind, const std::string& column,
           FindingAction action) {
  return std::any_of(prepared.findings().begin(), prepared.findings().end(), [&](const Finding& one) {
    return one.kind == kind && one.column == column && one.action == action;
  });
}

/// Spoils a recording at ten places and looks at what is left.
/// @param length  rows that are spoilt at each place
/// @param spoil   what becomes of the value at a row; the row counts from the first spoilt one
void spoilt_at_ten_places(const char* what, const Model& model, Recording r, const char* column, int length,
                          FindingKind kind, const std::function<double(double, Eigen::Index)>& spoil) {
  CAPTURE(what);
  std::set<Eigen::Index> bad;
  Eigen::VectorXd values = r.column(column);
  for (int k = 0; k < places; ++k)
    for (int i = 0; i < length; ++i) {
      const Eigen::Index row = place(r, k) + i;
      values[row] = spoil(values[row], i);
      bad.insert(row);
    }
  r.set(column, values);
  const PreparedRecording prepared(model, r);
  CHECK(found(prepared, kind, column, FindingAction::masked));
  const std::set<Eigen::Index> out = taken(r, prepared, column);
  CHECK(lacked_by(out, bad) == 0);
  CHECK(static_cast<double>(lacked_by(bad, out)) <= 0.002 * static_cast<double>(r.rows()));
}

/// Ends the range of a column's sensor at a limit. @return how many samples were beyond
std::size_t cut_off_above(Recording& r, const char* column, double limit) {
  std::size_t beyond = 0;
  change(r, column, [&](double x, Eigen::Index) {
    beyond += x > limit ? 1 : 0;
    return std::min(x, limit);
  });
  return beyond;
}

}  // namespace

TEST_CASE("a current that somebody sets, and that stays where it was set, is not frozen") {
  Recording r = bench();
  Eigen::VectorXd set(r.t_s.size());
  for (Eigen::Index row = 0; row < set.size(); ++row)
    set[row] = 0.5 + 0.45 * std::sin(2.3 * static_cast<double>(row / 97));
  Recording without_power;
  without_power.name = r.name;
  without_power.t_s = r.t_s;
  for (const char* column : {"ambient_C", "motor_C"}) without_power.set(column, r.column(column));
  without_power.set("current_A", set);
  const PreparedRecording prepared(test::bench_model(), without_power);
  CHECK_FALSE(found(prepared, FindingKind::frozen_samples, "current_A", FindingAction::masked));
}

TEST_CASE("less than a thousandth of clean samples is taken for dirt") {
  Eigen::Index samples = 0;
  std::size_t lost = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const bool moving : {false, true}) {
      const Recording r = moving ? test::axis_recording({0.02, 0.0, 1.0, 0}, 2000, seed)
                                 : test::bench_recording({}, 1500, seed);
      const PreparedRecording prepared(moving ? test::axis_model() : test::bench_model(), r);
      for (const char* column : {"motor_C", "current_A", "angle_deg", "rate_dps"}) {
        if (!r.has(column)) continue;
        samples += r.rows();
        lost += taken(r, prepared, column).size();
      }
      CHECK(prepared.recording().runs.size() == 1);
      for (const Finding& one : prepared.findings()) CHECK(one.severity == Severity::note);
    }
  }
  CHECK(static_cast<double>(lost) < 0.001 * static_cast<double>(samples));
}

TEST_CASE("each kind of bad sample is masked where it is, and nothing else is") {
  const Model motor = test::bench_model(), moving = test::axis_model();
  spoilt_at_ten_places("a spike of the thermometer", motor, bench(), "motor_C", 1,
                       FindingKind::spiked_samples, [](double x, Eigen::Index) { return x + 4.0; });
  spoilt_at_ten_places("85.0 degC, what a DS18B20 says before it has measured", motor, bench(), "motor_C", 3,
                       FindingKind::glitched_samples, [](double, Eigen::Index) { return 85.0; });
  spoilt_at_ten_places("a thermometer that is not there", motor, bench(), "motor_C", 4,
                       FindingKind::impossible_samples, [](double, Eigen::Index) { return -127.0; });
  spoilt_at_ten_places("a spike of the rate", moving, axis(), "rate_dps", 1, FindingKind::spiked_samples,
                       [](double x, Eigen::Index) { return x + 60.0; });
  spoilt_at_ten_places("a spike of the angle", moving, axis(), "angle_deg", 1, FindingKind::spiked_samples,
                       [](double x, Eigen::Index) { return x - 25.0; });
  spoilt_at_ten_places("a rate whose 16-bit word wraps", moving, axis(), "rate_dps", 4,
                       FindingKind::glitched_samples,
                       [](double x, Eigen::Index) { return x - 65536.0 * 0.061; });
}

TEST_CASE("a current that reads 0 while it flows is masked, and one that does not flow is not") {
  Recording r = bench();
  std::set<Eigen::Index> bad;
  const Eigen::VectorXd& power = r.column("power_param");
  Eigen::VectorXd current = r.column("current_A");
  for (int k = 0; k < places; ++k)
    for (Eigen::Index row = place(r, k); row < place(r, k) + 2; ++row) {
      if (power[row] == 0.0) continue;
      current[row] = 0.0;
      bad.insert(row);
    }
  r.set("current_A", current);
  REQUIRE(bad.size() > 8);
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(taken(r, prepared, "current_A") == bad);
  CHECK(found(prepared, FindingKind::glitched_samples, "current_A", FindingAction::masked));
}

TEST_CASE("an output that stands still while its noise should show is masked from its second sample on") {
  Recording r = axis();
  const Eigen::Index from = 1000, to = 1400;
  const double held = r.column("rate_dps")[from];
  change(r, "rate_dps", [&](double x, Eigen::Index i) { return i >= from && i < to ? held : x; });
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::frozen_samples, "rate_dps", FindingAction::masked));
  const std::set<Eigen::Index> out = taken(r, prepared, "rate_dps");
  CHECK(out.size() >= static_cast<std::size_t>(to - from - 1));
  CHECK(out.size() < static_cast<std::size_t>(to - from + 5));
}

TEST_CASE("a rate cut off at the end of its range is masked there") {
  Recording r = axis();
  const double limit = 0.7 * r.column("rate_dps").cwiseAbs().maxCoeff();
  std::size_t cut = 0;
  change(r, "rate_dps", [&](double x, Eigen::Index) {
    cut += std::abs(x) > limit ? 1 : 0;
    return std::clamp(x, -limit, limit);
  });
  REQUIRE(cut > 50);
  REQUIRE(cut < 1000);
  const PreparedRecording prepared(test::axis_model(), r);
  const std::size_t out = taken(r, prepared, "rate_dps").size();
  CHECK(found(prepared, FindingKind::clipped_samples, "rate_dps", FindingAction::masked));
  CHECK(static_cast<double>(out) > 0.99 * static_cast<double>(cut));
  CHECK(static_cast<double>(out) < 1.1 * static_cast<double>(cut) + 3.0);
}

TEST_CASE(
    "a coarse thermometer cut off between two of its steps is masked there, and one that stands on a step is not") {
  Recording r = bench();
  const double quantum = 0.0625;
  change(r, "motor_C", [&](double x, Eigen::Index) { return quantum * std::round(x / quantum); });
  const Eigen::VectorXd whole = r.column("motor_C");
  const double steps = std::floor((whole.minCoeff() + 0.8 * (whole.maxCoeff() - whole.minCoeff())) / quantum);
  for (const bool between : {true, false}) {
    const double limit = quantum * (steps + (between ? 0.6 : 0.0));
    std::size_t cut = 0;
    change(r, "motor_C", [&](double, Eigen::Index i) {
      cut += whole[i] > limit ? 1 : 0;
      return std::min(whole[i], limit);
    });
    REQUIRE(cut > 100);
    const PreparedRecording prepared(test::bench_model(), r);
    CHECK(found(prepared, FindingKind::clipped_samples, "motor_C", FindingAction::masked) == between);
    if (between) CHECK(taken(r, prepared, "motor_C").size() == cut);
  }
}

TEST_CASE("a rate in coarse steps is cut off where the angle sees it go faster") {
  Recording r = axis();
  const double most = r.column("rate_dps").cwiseAbs().maxCoeff(), quantum = most / 60.0,
               limit = quantum * std::round(0.7 * most / quantum);
  std::size_t cut = 0;
  change(r, "rate_dps", [&](double x, Eigen::Index) {
    const double coarse = quantum * std::round(x / quantum);
    cut += std::abs(coarse) > limit ? 1 : 0;
    return std::clamp(coarse, -limit, limit);
  });
  REQUIRE(cut > 50);
  // An angle so coarse that it hardly moves from row to row tells it over a stretch.
  const double step_deg = GENERATE(0.0, 1.0);
  if (step_deg > 0.0)
    change(r, "angle_deg", [&](double x, Eigen::Index) { return step_deg * std::round(x / step_deg); });
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::clipped_samples, "rate_dps", FindingAction::masked));
  CHECK(taken(r, prepared, "rate_dps").size() >= cut);
}

TEST_CASE(
    "an angle that is held at its largest value while a coarse rate is off by one step is at rest there") {
  // A servo goes to its target and stays; its rate comes in steps, and reads one of them at standstill.
  const double rate_step = 1.4, angle_step = 0.09;
  Recording r = axis();
  double angle_deg = -20.0;
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double dps = i < r.rows() / 3 ? 12.0 : 0.0;
    if (i > 0) angle_deg += dps * (r.t_s[i] - r.t_s[i - 1]);
    angle[i] = angle_step * std::round(angle_deg / angle_step);
    rate[i] = rate_step * std::round(dps / rate_step) + (dps > 0.0 ? 0.0 : rate_step);
  }
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK_FALSE(found(prepared, FindingKind::clipped_samples, "angle_deg", FindingAction::masked));
}

TEST_CASE(
    "an axis that stands at its least angle until its first step is at rest, however unevenly it then runs") {
  // A motor at rest is stepped to 1600 deg/s; its encoder has no noise, and the rows of the log come unevenly.
  Recording r = axis();
  test::Noise noise(5);
  Eigen::VectorXd angle(r.rows()), rate(r.rows()), t_s(r.rows());
  const double begin_s = 0.1, rise_s = 0.05, top_dps = 1600.0, encoder_deg = 0.02;
  double at_s = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i, at_s += 0.0055 + 0.0005 * noise()) {
    const double since_s = std::max(0.0, at_s - begin_s), risen = std::exp(-since_s / rise_s);
    t_s[i] = at_s;
    rate[i] = top_dps * (1.0 - risen);
    angle[i] = 330.0 + encoder_deg * std::round(top_dps * (since_s - rise_s * (1.0 - risen)) / encoder_deg);
  }
  r.t_s = t_s;
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK_FALSE(found(prepared, FindingKind::clipped_samples, "angle_deg", FindingAction::masked));
}

TEST_CASE(
    "a noisy angle that stands still at its largest value is cut off there, though the axis rests out of range") {
  Recording r = axis();
  test::Noise noise(11);
  const double limit = 24.0;
  double angle_deg = -20.0;
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  std::set<Eigen::Index> beyond;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double dps = i < 1250 ? 4.0 : i < 2300 ? 0.0 : -4.0;  // out, a rest, and back
    if (i > 0) angle_deg += dps * (r.t_s[i] - r.t_s[i - 1]);
    const double seen = angle_deg + 0.05 * noise();
    if (seen >= limit) beyond.insert(i);
    angle[i] = std::min(1e-4 * std::round(1e4 * seen), limit);
    rate[i] = dps + 0.2 * noise();
  }
  REQUIRE(beyond.size() > 100);
  REQUIRE(beyond.size() < static_cast<std::size_t>(r.rows()) / 2);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::clipped_samples, "angle_deg", FindingAction::masked));
  const std::set<Eigen::Index> out = taken(r, prepared, "angle_deg");
  CHECK(std::includes(out.begin(), out.end(), beyond.begin(), beyond.end()));
}

TEST_CASE(
    "a noisy current that stands at its end is cut off there, under one power too, from its first sample on") {
  // A winding that warms draws less and less; the first third of it is beyond the sensor.
  Recording r = bench();
  const double rows = static_cast<double>(r.rows()), limit = 0.45;
  test::Noise noise(4);
  Eigen::VectorXd current(r.rows());
  std::set<Eigen::Index> beyond;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double whole = 0.5 - 0.15 * static_cast<double>(i) / rows + 0.003 * noise();
    if (whole >= limit) beyond.insert(i);
    current[i] = std::min(whole, limit);
  }
  REQUIRE(beyond.size() > 400);
  r.set("current_A", current);
  r.set("power_param", Eigen::VectorXd::Constant(r.rows(), 200.0));
  const PreparedRecording prepared(test::bench_model(), r);
  const std::set<Eigen::Index> out = taken(r, prepared, "current_A");
  CHECK(std::includes(out.begin(), out.end(), beyond.begin(), beyond.end()));
  CHECK(out.size() < beyond.size() + 10);
}

TEST_CASE("a fine thermometer that stands at its end for most of a recording is cut off there, not at rest") {
  Recording r = bench();
  test::Noise noise(5);
  Eigen::VectorXd whole = r.column("motor_C");
  for (double& one : whole) one = 0.001 * std::round(1000.0 * (one + 0.1 * noise()));
  std::vector<double> sorted(whole.begin(), whole.end());
  std::sort(sorted.begin(), sorted.end());
  const double limit = sorted[sorted.size() / 3];
  r.set("motor_C", whole.cwiseMin(limit));
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(found(prepared, FindingKind::clipped_samples, "motor_C", FindingAction::masked));
}

TEST_CASE("a coarse rate that stands while its angle goes elsewhere is frozen") {
  Recording r = axis();
  const double quantum = 20.0;
  const Eigen::Index from = 1000, length = 120;
  change(r, "rate_dps", [&](double x, Eigen::Index) { return quantum * std::round(x / quantum); });
  const Eigen::VectorXd whole = r.column("rate_dps");
  Eigen::Index at = from;
  while (std::abs(whole[at]) < 5.0 * quantum) ++at;
  change(r, "rate_dps", [&](double x, Eigen::Index i) { return i >= at && i < at + length ? whole[at] : x; });
  const PreparedRecording prepared(test::axis_model(), r);
  const std::set<Eigen::Index> out = taken(r, prepared, "rate_dps");
  CHECK(found(prepared, FindingKind::frozen_samples, "rate_dps", FindingAction::masked));
  CHECK(out.size() >= static_cast<std::size_t>(length - 1));
  CHECK(out.size() < static_cast<std::size_t>(length + 40));  // so coarse that it stands elsewhere, too
}

TEST_CASE(
    "an angle that stood through a motion, or there and back, and most of the rest is frozen until it catches up") {
  Recording r = axis();
  const double step = 0.09;
  test::Noise noise(6);
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  double angle_deg = -20.0;
  const bool stands = GENERATE(true, false);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double dps = i % 1000 < 150 ? (i / 1000 % 2 == 0 ? 20.0 : -20.0) : 0.0;
    if (i > 0) angle_deg += dps * (r.t_s[i] - r.t_s[i - 1]);
    angle[i] = step * std::round(angle_deg / step);
    rate[i] = dps + 0.1 * noise();
  }
  const Eigen::Index until = GENERATE(1600, 2100);  // back where it was
  if (stands)
    for (Eigen::Index i = 1050; i < until; ++i) angle[i] = angle[1050];
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::frozen_samples, "angle_deg", FindingAction::masked) == stands);
  if (stands) CHECK(taken(r, prepared, "angle_deg").size() >= 549);
}

TEST_CASE("a coarse thermometer that stands longer than where it rests, and then catches up, is frozen") {
  // A motor that warms, rests and cools, read in steps of twice the noise; the logger may pause before it catches up.
  Recording r = bench();
  const double quantum = 0.1;
  test::Noise noise(8);
  const bool stands = GENERATE(true, false), pauses = GENERATE(true, false);
  Eigen::VectorXd values(r.rows());
  const auto truth = [&](Eigen::Index i) {
    const double k = static_cast<double>(i % 500);
    return k < 200 ? 30.0 + 0.1 * k : 30.0 + 20.0 * std::exp(-(k - 200.0) / 40.0);
  };
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    values[i] = quantum * std::round((truth(i) + 0.05 * noise()) / quantum);
  const Eigen::Index from = 660, length = 34;
  if (stands)
    for (Eigen::Index i = from; i < from + length; ++i) values[i] = values[from];
  r.set("motor_C", values);
  if (pauses)
    for (Eigen::Index i = from + length - 4; i < r.rows(); ++i) r.t_s[i] += 40.0;
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(found(prepared, FindingKind::frozen_samples, "motor_C", FindingAction::masked) == stands);
}

TEST_CASE("a current that heats is unknown where its sensor's range ended") {
  Recording r = bench();
  r.remove("power_param");
  const Eigen::VectorXd whole = r.column("current_A");
  const double limit = 0.7 * whole.maxCoeff() + 1e-5;
  const std::size_t cut = cut_off_above(r, "current_A", limit);
  REQUIRE(cut > 100);
  const PreparedRecording prepared(test::bench_model(), r);
  REQUIRE(found(prepared, FindingKind::clipped_samples, "current_A", FindingAction::masked));
  CHECK(static_cast<double>(prepared.recording().rows()) <
        static_cast<double>(r.rows()) - 0.9 * static_cast<double>(cut));
}

TEST_CASE("stamps that stray around a clock are the clock's again, where the readings were taken by it") {
  const Recording by_the_clock = axis();
  const double period_s = by_the_clock.t_s[1] - by_the_clock.t_s[0];
  test::Noise noise(11);
  Eigen::VectorXd strayed = by_the_clock.t_s;
  for (double& t_s : strayed) t_s += 0.06 * period_s * std::clamp(noise(), -2.5, 2.5);
  Recording r = by_the_clock;
  r.t_s = strayed;
  const bool lossy = GENERATE(false, true);  // a lost row leaves a tick out
  if (lossy) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < r.rows(); ++i)
      if (i % 97 != 50) kept.push_back(i);
    Recording fewer = r;
    fewer.t_s = r.t_s(kept);
    for (Column& column : fewer.columns) column.values = Eigen::VectorXd(column.values(kept));
    r = fewer;
  }
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::jittering_stamps, "t_s", FindingAction::none));
  double worst = 0.0;
  for (Eigen::Index i = 0; i < prepared.recording().rows(); ++i) {
    const double ticks = (prepared.recording().t_s[i] - by_the_clock.t_s[0]) / period_s;
    worst = std::max(worst, std::abs(ticks - std::round(ticks)));
  }
  CHECK(worst < 0.02);
  const PreparedRecording untouched(test::axis_model(), r, true);
  CHECK(untouched.recording().t_s == r.t_s);
}

TEST_CASE("stamps that stray because the readings were taken then are believed") {
  Recording r = axis();
  const double period_s = r.t_s[1] - r.t_s[0];
  test::Noise noise(12);
  // The readings at other instants than the grid's: between two of the simulated rows, in a straight line.
  const Recording on_the_grid = r;
  Recording late = r;
  for (Eigen::Index i = 1; i + 1 < r.rows(); ++i) {
    const double part = 0.1 + 0.05 * std::clamp(noise(), -2.0, 2.0);
    late.t_s[i] += part * period_s;
    for (Column& column : late.columns)
      if (column.name != "drive_A") {
        const Eigen::VectorXd& whole = on_the_grid.column(column.name);
        column.values[i] = whole[i] + part * (whole[i + 1] - whole[i]);
      }
  }
  const PreparedRecording prepared(test::axis_model(), late);
  CHECK_FALSE(found(prepared, FindingKind::jittering_stamps, "t_s", FindingAction::none));
  CHECK(prepared.recording().t_s == late.t_s);
}

TEST_CASE("frames that repeat the one before them are masked, one or many in a row") {
  Recording r = axis();
  const Eigen::Index repeats = GENERATE(2, 6, 10);
  // Nobody judges it, and it stays the same at one row in three.
  Eigen::VectorXd motor_C(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) motor_C[i] = 51.5 + 0.1 * static_cast<double>((2 * i / 3) % 2);
  r.set("motor_C", motor_C);
  std::set<Eigen::Index> bad;
  for (int k = 0; k < places; ++k) {
    const Eigen::Index row = place(r, k);
    for (const char* column : {"angle_deg", "rate_dps"}) {
      Eigen::VectorXd values = r.column(column);
      for (Eigen::Index i = 0; i < repeats; ++i) values[row + i] = values[row - 1];
      r.set(column, values);
    }
    for (Eigen::Index i = 0; i < repeats; ++i) bad.insert(row + i);
  }
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::repeated_frames, "", FindingAction::masked));
  CHECK(taken(r, prepared, "rate_dps") == bad);
}

TEST_CASE(
    "frames repeated while an axis comes to rest, where its coarse angle stands from then on, are masked") {
  Recording r = test::axis_recording({}, 3000, 4);
  test::Noise noise(11);
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  std::set<Eigen::Index> bad;
  double at_deg = 0.0, dps = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    // A second each: up to 200 deg/s, down by 11 a row, and from 35 on to rest.
    const Eigen::Index row = i % 100;
    dps = row < 20 ? 10.0 * static_cast<double>(row) : dps > 35.0 ? dps - 11.0 : 0.77 * dps;
    const double moves_dps = i / 100 % 2 == 0 ? dps : -dps;
    at_deg += 0.01 * moves_dps;
    rate[i] = std::round((moves_dps + 0.2 * noise()) * 1e3) / 1e3;
    angle[i] = std::round((at_deg + 0.03 * noise()) / 0.0879) * 0.0879;
    if (i % 500 >= 339 && i % 500 < 342) {
      repeat_frame(angle, rate, i, bad);
    }
  }
  Eigen::VectorXd t_s(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) t_s[i] = 0.01 * static_cast<double>(i);
  r.t_s = t_s;
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "rate_dps");
  for (const Eigen::Index row : bad) {
    CAPTURE(row);
    CHECK(out.count(row) == 1);
  }
  CHECK(out.size() <= bad.size() + 3);
}

TEST_CASE("spikes a few rows apart do not hide each other") {
  const Eigen::Index apart = GENERATE(2, 3, 4);
  Recording r = axis();
  std::set<Eigen::Index> bad;
  for (int k = 0; k < places; ++k) bad.insert({place(r, k), place(r, k) + apart});
  change(r, "angle_deg", [&](double x, Eigen::Index i) { return bad.count(i) != 0 ? x - 25.0 : x; });
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "angle_deg");
  for (const Eigen::Index row : bad) CHECK(out.count(row) == 1);
  CHECK(out.size() <= bad.size() + 2);
}

namespace {

/// The row where a rate passes 0 for the n-th time, away from the ends.
Eigen::Index turn_of(const Eigen::VectorXd& rate, int n) {
  for (Eigen::Index i = 100; i + 150 < rate.size(); ++i)
    if (rate[i - 1] * rate[i] <= 0.0 && std::abs(rate[i + 20]) > 20.0 && n-- == 0) return i;
  return 0;
}

}  // namespace

TEST_CASE(
    "an angle in coarse steps that stood where it turned, and catches up with its rate, was a sensor's that had stopped") {
  Recording r = axis();
  const double step = 0.0879;
  change(r, "angle_deg", [&](double x, Eigen::Index) { return step * std::round(x / step); });
  const Eigen::Index turn = turn_of(r.column("rate_dps"), 3);
  REQUIRE(turn > 0);
  // It goes on for longer than it came: what is left is a small part of the way.
  Eigen::VectorXd angle = r.column("angle_deg");
  std::set<Eigen::Index> bad;
  for (Eigen::Index i = turn - 12; i < turn + 22; ++i) {
    angle[i] = angle[turn - 13];
    bad.insert(i);
  }
  r.set("angle_deg", angle);
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "angle_deg");
  CHECK(std::includes(out.begin(), out.end(), bad.begin(), bad.end()));
  CHECK(out.size() <= bad.size() + 3);
}

TEST_CASE("a rate of exactly 0 whose angle goes on is a sensor's that has stopped, and a rest is one") {
  Recording r = axis();
  const Eigen::Index turn = turn_of(r.column("rate_dps"), 3);
  REQUIRE(turn > 0);
  Eigen::VectorXd rate = r.column("rate_dps"), angle = r.column("angle_deg");
  std::set<Eigen::Index> bad;
  for (Eigen::Index i = turn; i < turn + 40; ++i) {
    rate[i] = 0.0;
    if (i > turn) bad.insert(i);
  }
  r.set("rate_dps", rate);
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "rate_dps");
  CHECK(std::includes(out.begin(), out.end(), bad.begin(), bad.end()));
  CHECK(out.size() <= bad.size() + 3);
  // The same rate above an angle that rests with it, and jumps with what pushes it on.
  const double moved = angle[turn + 40] - angle[turn];
  test::Noise noise(9);
  for (Eigen::Index i = turn + 1; i < angle.size(); ++i)
    angle[i] = i < turn + 40 ? angle[turn] + 0.02 * noise() : angle[i] - moved;
  r.set("angle_deg", angle);
  CHECK(taken(r, PreparedRecording(test::axis_model(), r), "rate_dps").size() <= 3);
}

TEST_CASE(
    "a thermometer of 1 degC that flickers at a threshold, and stands once it has left it, has not stopped") {
  Recording r = axis();
  test::Noise noise(3);
  Eigen::VectorXd motor(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    motor[i] =
        std::round(36.45 + 0.5 * static_cast<double>(i) / static_cast<double>(r.rows()) + 0.08 * noise());
  r.set("motor_C", motor);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK_FALSE(found(prepared, FindingKind::frozen_samples, "motor_C", FindingAction::masked));
}

TEST_CASE("three spikes of unlike height within five rows do not hide each other") {
  // As two neighbours and one before them, the farthest last: seen from one side the second lies halfway to the third.
  const double heights[] = {164.0, 226.0, 305.0};
  Recording r = axis();
  std::set<Eigen::Index> bad;
  for (int k = 0; k < places; ++k) bad.insert({place(r, k), place(r, k) + 3, place(r, k) + 4});
  int next = 0;
  change(r, "angle_deg",
         [&](double x, Eigen::Index i) { return bad.count(i) != 0 ? x + heights[next++ % 3] : x; });
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "angle_deg");
  for (const Eigen::Index row : bad) CHECK(out.count(row) == 1);
  CHECK(out.size() <= bad.size() + places);  // what is right in the midst of three may go with them
}

TEST_CASE("a run that begins with a push keeps its first row: it says where it starts") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Recording r = test::axis_recording({}, 2000, seed);
    test::Noise noise(seed);
    Eigen::VectorXd angle(r.rows()), rate(r.rows());
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      const double since_s = r.t_s[i % 200], gone = std::exp(-since_s / 0.05);
      const double pushes = static_cast<double>(i / 200);
      angle[i] = 8.0 * (pushes + 1.0 - gone * (1.0 + since_s / 0.05)) + 0.04 * noise();
      rate[i] = 3200.0 * since_s * gone + 0.1 * noise();
    }
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    const PreparedRecording prepared(test::axis_model(), r);
    for (const char* column : {"angle_deg", "rate_dps"}) CHECK(taken(r, prepared, column).count(0) == 0);
  }
}

TEST_CASE(
    "a run that begins at rest keeps its first row where the rate jumps at once and the angle is too coarse to tell") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Recording r = test::axis_recording({}, 2000, seed);
    for (Eigen::Index i = 0; i < r.rows(); ++i) r.t_s[i] = 0.01 * static_cast<double>(i);
    test::Noise noise(seed);
    Eigen::VectorXd angle(r.rows()), rate(r.rows());
    // A light part on a spring of 17 Hz carries a heavier one; each 200 rows a loop drives them out of rest.
    double rad[2] = {0.0, 0.0}, rad_per_s[2] = {0.0, 0.0};
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      if (i % 200 == 0) rad[1] = rad[0], rad_per_s[0] = rad_per_s[1] = 0.0;
      angle[i] = rad[0] * 57.29577951308232 + 0.02 * noise();
      rate[i] = rad_per_s[0] * 57.29577951308232 + 0.06 * noise();
      for (int k = 0; k < 100; ++k) {
        const double h = 1e-4, pushed = 45.0 * (1.0 - rad_per_s[0] / 0.75);
        const double spring = 6600.0 * (rad[1] - rad[0]) + 12.0 * (rad_per_s[1] - rad_per_s[0]);
        rad_per_s[0] += h * (pushed + spring);
        rad_per_s[1] -= h * 0.7 * spring;
        for (int j = 0; j < 2; ++j) rad[j] += h * rad_per_s[j];
      }
    }
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    const PreparedRecording prepared(test::axis_model(), r);
    for (const char* column : {"angle_deg", "rate_dps"}) CHECK(taken(r, prepared, column).count(0) == 0);
  }
}

TEST_CASE("a rate that reads rest in the first row of a run that is in motion is masked") {
  Recording r = axis();
  Eigen::Index moving = 0;
  while (std::abs(r.column("rate_dps")[moving]) < 30.0) ++moving;
  r = r.slice(moving, r.rows());
  change(r, "rate_dps", [](double x, Eigen::Index i) { return i == 0 ? 0.0 : x; });
  CHECK(taken(r, PreparedRecording(test::axis_model(), r), "rate_dps").count(0) == 1);
}

TEST_CASE(
    "a push into a spring keeps the rows of its first swing, which bends more sharply than all after it") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Recording r = test::axis_recording({}, 2000, seed);
    test::Noise noise(seed);
    Eigen::VectorXd angle(r.rows()), rate(r.rows());
    double angle_rad = 0.0, rate_rad_per_s = 0.0;
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      angle[i] = angle_rad * 57.29577951308232 + 0.008 * noise();
      rate[i] = rate_rad_per_s * 57.29577951308232 + 0.06 * noise();
      // 4 Hz, damped by 0.8; pushed for 0.05 s, and slowly to and fro ever after.
      for (int k = 0; k < 100; ++k) {
        const double h = 1e-4, t = r.t_s[i] + k * h;
        const double push = 120.0 * std::exp(-t / 0.05) + 312.5 * std::sin(1.1 * t);
        rate_rad_per_s += h * (push - 40.0 * rate_rad_per_s - 625.0 * angle_rad);
        angle_rad += h * rate_rad_per_s;
      }
    }
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    const PreparedRecording prepared(test::axis_model(), r);
    const std::set<Eigen::Index> out = taken(r, prepared, "rate_dps");
    CHECK(out.lower_bound(0) == out.lower_bound(10));
  }
}

TEST_CASE(
    "a frame whose sensors say nothing is lost in every column, also where 0 looks right in one of them") {
  Recording r = axis();
  std::set<Eigen::Index> bad;
  for (Eigen::Index i = 50; i + 50 < r.rows(); i += 61) bad.insert(i);
  // Where the axis turns round and where it passes 0, one of the two zeros is nothing special.
  const Eigen::VectorXd rate = r.column("rate_dps"), angle = r.column("angle_deg");
  for (Eigen::Index i = 60; i + 60 < r.rows() && bad.size() < 60; ++i)
    if ((std::abs(rate[i]) < 1.0 && std::abs(angle[i]) > 5.0) ||
        (std::abs(angle[i]) < 0.1 && std::abs(rate[i]) > 20.0))
      if (bad.lower_bound(i - 20) == bad.upper_bound(i + 20)) bad.insert(i);
  for (const char* column : {"angle_deg", "rate_dps"})
    change(r, column, [&](double x, Eigen::Index i) { return bad.count(i) != 0 ? 0.0 : x; });
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::glitched_samples, "", FindingAction::masked));
  CHECK(taken(r, prepared, "angle_deg") == bad);
  CHECK(taken(r, prepared, "rate_dps") == bad);
}

TEST_CASE("an axis that rests at 0 has lost no frame") {
  Recording r = axis();
  for (const char* column : {"angle_deg", "rate_dps"})
    change(r, column, [](double x, Eigen::Index i) { return i < 400 ? 0.0 : i % 301 == 0 ? 0.0 : x; });
  const std::set<Eigen::Index> out = taken(r, PreparedRecording(test::axis_model(), r), "angle_deg");
  CHECK(out.lower_bound(400) == out.begin());
  CHECK(out.size() == 8);
}

TEST_CASE(
    "a repeated frame catches up at once, also where a coarse column stands still by itself now and then") {
  Recording r = axis();
  change(r, "angle_deg", [](double x, Eigen::Index) { return 0.1 * std::round(10.0 * x); });
  change(r, "rate_dps", [](double x, Eigen::Index) { return std::round(x); });
  const PreparedRecording sound(test::axis_model(), r);
  REQUIRE(taken(r, sound, "rate_dps").empty());
  std::set<Eigen::Index> bad;
  const Eigen::VectorXd rate = r.column("rate_dps");
  for (int k = 0; k < places; ++k) {
    // Where the axis moves: a frame that repeats a rest is none.
    Eigen::Index row = place(r, k);
    while (std::abs(rate[row]) < 20.0 || std::abs(rate[row + 4]) < 20.0) ++row;
    for (const char* column : {"angle_deg", "rate_dps"})
      change(r, column, [&, before = r.column(column)[row - 1]](double x, Eigen::Index i) {
        return i >= row && i < row + 4 ? before : x;
      });
    for (Eigen::Index i = 0; i < 4; ++i) bad.insert(row + i);
  }
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(taken(r, prepared, "rate_dps") == bad);
  CHECK(taken(r, prepared, "angle_deg") == bad);
}

TEST_CASE("a frame repeated in motion is found in a log that rests nearly always") {
  const bool flickers = GENERATE(false, true);
  const Recording moving = axis();
  const Eigen::Index rows = moving.rows(), all = 5 * rows;
  Recording r;
  r.name = "rests after some motion";
  r.t_s.resize(all);
  const double interval_s = moving.t_s[1] - moving.t_s[0];
  for (Eigen::Index i = 0; i < all; ++i) r.t_s[i] = interval_s * static_cast<double>(i);
  std::uint32_t state = 20261124;
  const auto coin = [&] { return ((state = state * 1664525u + 1013904223u) >> 30) % 2 == 0; };
  for (const Column& column : moving.columns) {
    // At rest a sensor reads the same, or one of two last digits at random.
    const bool is_rate = column.name == "rate_dps", is_angle = column.name == "angle_deg";
    const double quantum = is_rate ? 1.0 : is_angle ? 0.1 : 0.0;
    Eigen::VectorXd values(all);
    for (Eigen::Index i = 0; i < all; ++i) {
      const double whole = i < rows ? column.values[i] : is_angle ? column.values[rows - 1] : 0.0;
      const double flicker = i < rows || !flickers || coin() ? 0.0 : quantum;
      values[i] = quantum > 0.0 ? quantum * std::round(whole / quantum) + flicker : whole;
    }
    r.set(column.name, values);
  }
  const PreparedRecording sound(test::axis_model(), r);
  REQUIRE(taken(r, sound, "rate_dps").empty());
  std::set<Eigen::Index> bad;
  const Eigen::VectorXd rate = r.column("rate_dps");
  for (int k = 0; k < places; ++k) {
    Eigen::Index row = place(moving, k);
    while (std::abs(rate[row]) < 20.0 || std::abs(rate[row + 4]) < 20.0) ++row;
    for (const char* column : {"angle_deg", "rate_dps"})
      change(r, column, [&, before = r.column(column)[row - 1]](double x, Eigen::Index i) {
        return i >= row && i < row + 4 ? before : x;
      });
    for (Eigen::Index i = 0; i < 4; ++i) bad.insert(row + i);
  }
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(taken(r, prepared, "rate_dps") == bad);
  CHECK(taken(r, prepared, "angle_deg") == bad);
}

TEST_CASE(
    "frames repeated for long are masked wherever the axis moves, also where the frame reads nearly rest") {
  const bool rate_first = GENERATE(false, true);
  Recording r = test::axis_recording({}, 6000, 4);
  test::Noise noise(11);
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  std::set<Eigen::Index> bad;
  constexpr Eigen::Index repeats = 15, apart = 97;  // more than what is looked at as single frames
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const double t_s = 0.01 * static_cast<double>(i);
    angle[i] = 40.0 * std::sin(2.0 * t_s) + 9.0 * std::sin(7.1 * t_s) + 0.02 * noise();
    rate[i] = 80.0 * std::cos(2.0 * t_s) + 63.9 * std::cos(7.1 * t_s) + 0.15 * noise();
    if (i < apart || i % apart >= repeats) continue;
    repeat_frame(angle, rate, i, bad);
  }
  int nearly_at_rest = 0;
  for (Eigen::Index i = apart; i < r.rows(); i += apart) nearly_at_rest += std::abs(rate[i]) < 8.0 ? 1 : 0;
  REQUIRE(nearly_at_rest >= 4);
  r.remove("angle_deg");
  r.remove("rate_dps");
  if (rate_first) r.set("rate_dps", rate);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  for (const char* column : {"angle_deg", "rate_dps"}) {
    CAPTURE(column);
    const std::set<Eigen::Index> out = taken(r, prepared, column);
    CHECK(lacked_by(out, bad) == 0);
    CHECK(1000 * lacked_by(bad, out) <
          static_cast<std::size_t>(r.rows()));  // one beside a stretch now and then
  }
}

TEST_CASE(
    "frames repeated where an axis starts from rest are seen by a fine angle, not where that stands at rest, too") {
  const bool is_fine = GENERATE(true, false), repeats = GENERATE(true, false);
  CAPTURE(is_fine, repeats);
  Recording r = test::axis_recording({}, 6000, 4);
  test::Noise noise(5);
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  std::set<Eigen::Index> bad;
  double at_deg = 0.0, dps = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    // Every 300 rows: rests for 150, speeds up by 6 deg/s a row for 75, and slows down.
    const Eigen::Index row = i % 300;
    dps = row < 150 ? 0.0 : 6.0 * static_cast<double>(std::min(row - 149, 300 - row));
    const double moves_dps = i / 300 % 2 == 0 ? dps : -dps;
    at_deg += 0.01 * moves_dps;
    rate[i] = 0.1 * std::round((moves_dps + 0.04 * noise()) / 0.1);
    const double read_deg = is_fine || dps > 0.0 ? at_deg + 0.01 * noise() : at_deg;
    angle[i] = std::round(read_deg * 1e4) / 1e4;
    if (row == 148) rate[i] = 0.0;
    if (row < 149 || row > 151 || !repeats) continue;
    repeat_frame(angle, rate, i, bad);
  }
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::repeated_frames, "", FindingAction::masked) == (is_fine && repeats));
  if (is_fine) CHECK(taken(r, prepared, "rate_dps") == bad);
}

TEST_CASE("what sticks and breaks away repeats no frame") {
  // It stands for 5 rows of 60, and goes by 4.4 deg in the others.
  Recording r;
  r.name = "stick and slip";
  const Eigen::Index rows = 3000;
  r.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * static_cast<double>(rows - 1));
  Eigen::VectorXd angle(rows), rate(rows), drive(rows);
  std::uint32_t state = 20261124;
  const auto digit = [&] {
    return static_cast<double>((state = state * 1664525u + 1013904223u) >> 28) - 7.5;
  };
  double at = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const bool sticks = i % 60 < 5;
    if (!sticks) at += 0.08 * ((i / 400) % 2 == 0 ? 1.0 : -1.0);
    const double turned = 0.001 * std::round(1000.0 * at);
    angle[i] = sticks && i > 0 && i % 60 > 0 ? angle[i - 1] : turned + (sticks ? 0.0 : 0.001 * digit());
    rate[i] = sticks ? 0.0 : ((i / 400) % 2 == 0 ? 8.0 : -8.0) + 0.05 * digit();
    drive[i] = 0.1 * std::sin(0.02 * static_cast<double>(i));
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK_FALSE(found(prepared, FindingKind::repeated_frames, "", FindingAction::masked));
}

/// The windows of an axis that are simulated and not judged, and all of them.
std::pair<std::vector<Segment>, std::vector<Segment>> windows_of(const Recording& r, double horizon_s = 1.0) {
  static std::vector<std::unique_ptr<PreparedRecording>> kept;  // windows refer to it
  kept.push_back(std::make_unique<PreparedRecording>(test::axis_model(), r));
  std::vector<Segment> all, not_judged;
  ActuatorPlant().cut(kept.back()->inputs(), horizon_s, all);
  for (const Segment& one : all)
    if (one.warm_up) not_judged.push_back(one);
  return {not_judged, all};
}

TEST_CASE("what was under way before its first row is judged a second later, what begins at rest at once") {
  const Recording whole = axis();  // rows 0.01 s apart
  CHECK(windows_of(whole).first.empty());

  const auto [late, all] = windows_of(whole.slice(700, 2000));
  REQUIRE(late.size() == 1);
  CHECK(late[0].begin == 0);
  CHECK(late[0].end == 100);
  CHECK(all[1].begin == 100);
  CHECK(all[1].carries_on);
  CHECK(windows_of(whole.slice(700, 2000), 0.3).first.size() == 4);
  // Of what is shorter than four a quarter is left out, but half a second, and of what is shorter than one the half.
  CHECK(windows_of(whole.slice(700, 1001), 0.75).first.at(0).end == 75);
  CHECK(windows_of(whole.slice(700, 820)).first.at(0).end == 50);
  CHECK(windows_of(whole.slice(700, 740)).first.at(0).end == 20);

  // Where the command is lost nobody knows what arrives after it; where rows are lost, what happened in them.
  Recording holes = whole;
  change(holes, "drive_A", [](double x, Eigen::Index i) { return i / 3 % 100 == 50 ? missing : x; });
  const std::vector<RunSpan> pieces = PreparedRecording(test::axis_model(), holes).recording().spans();
  CHECK(pieces.size() > 5);  // but for the holes between two commands that are the same
  CHECK(windows_of(holes).first.size() == pieces.size() - 1);
  Recording paused = whole;
  for (Eigen::Index i = 1000; i < paused.rows(); ++i) paused.t_s[i] += 3.0;
  CHECK(windows_of(paused).first.size() == 1);
}

TEST_CASE("a coarse thermometer that stands still is nothing to talk about") {
  Recording r = bench();
  change(r, "motor_C", [](double x, Eigen::Index) { return std::round(x); });
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(taken(r, prepared, "motor_C").empty());
  for (const Finding& one : prepared.findings()) {
    CHECK(one.severity == Severity::note);
    CHECK(one.kind == FindingKind::coarse_quantum);
  }
}

TEST_CASE("a tenth of bad rows does not move the thresholds") {
  Recording r = axis();
  std::set<Eigen::Index> bad;
  test::Noise noise(5);
  change(r, "rate_dps", [&](double x, Eigen::Index i) {
    if (i % 10 != 3) return x;
    bad.insert(i);
    return x + (noise() > 0.0 ? 50.0 : -50.0);
  });
  const PreparedRecording prepared(test::axis_model(), r);
  const std::set<Eigen::Index> out = taken(r, prepared, "rate_dps");
  std::size_t missed = 0;
  for (const Eigen::Index row : bad) missed += out.count(row) == 0 ? 1 : 0;
  CHECK(missed == 0);
  CHECK(out.size() <= bad.size() + 6);
}

TEST_CASE("lost rows cut the run, but not where the command stood still") {
  Recording r = axis();
  std::vector<bool> keep(static_cast<std::size_t>(r.rows()), true);
  for (int k = 0; k < places; ++k)
    for (Eigen::Index i = 0; i < 12; ++i) keep[static_cast<std::size_t>(place(r, k) + i)] = false;
  Recording holes;
  holes.name = r.name;
  const auto kept = [&](const Eigen::VectorXd& values) {
    std::vector<double> list;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (keep[static_cast<std::size_t>(i)]) list.push_back(values[i]);
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  holes.t_s = kept(r.t_s);
  for (const Column& column : r.columns) holes.set(column.name, kept(column.values));
  const PreparedRecording prepared(test::axis_model(), holes);
  CHECK(found(prepared, FindingKind::gap_in_stamps, "t_s", FindingAction::segmented));
  CHECK(prepared.recording().runs.size() >= 8);
  CHECK(prepared.recording().runs.size() <= places + 1);
  holes.set("drive_A", Eigen::VectorXd::Constant(holes.rows(), 0.1));
  CHECK(PreparedRecording(test::axis_model(), holes).recording().runs.size() == 1);
  CHECK(PreparedRecording(test::axis_model(), holes, true).recording().rows() == holes.rows());
}

TEST_CASE("one lost row cuts the run where its command moves, though the stamps jitter by a tenth") {
  const Recording whole = axis();
  std::minstd_rand random(7);
  std::vector<Eigen::Index> kept;
  std::set<Eigen::Index> after_lost;  // rows that are kept, counted as kept
  for (Eigen::Index i = 0; i < whole.rows(); ++i) {
    if (i > 20 && i % 97 == 0) after_lost.insert(static_cast<Eigen::Index>(kept.size()));
    else kept.push_back(i);
  }
  Recording r;
  r.name = whole.name;
  const double period_s = whole.t_s[1] - whole.t_s[0];
  const auto rows = static_cast<Eigen::Index>(kept.size());
  r.t_s.resize(rows);
  Eigen::VectorXd drive_A(rows), angle_deg(rows), rate_dps(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Eigen::Index from = kept[static_cast<std::size_t>(i)];
    double jitter = -6.0;  // a sum of twelve evenly distributed: nearly normal
    for (int k = 0; k < 12; ++k) jitter += static_cast<double>(random()) / 2147483647.0;
    r.t_s[i] = whole.t_s[from] + 0.1 * period_s * std::clamp(jitter, -3.0, 3.0);
    drive_A[i] = 0.3 * std::sin(2.0 * r.t_s[i]) + 0.2 * std::sin(31.0 * r.t_s[i]);
    angle_deg[i] = whole.column("angle_deg")[from];
    rate_dps[i] = whole.column("rate_dps")[from];
  }
  r.set("drive_A", drive_A);
  r.set("angle_deg", angle_deg);
  r.set("rate_dps", rate_dps);
  const PreparedRecording prepared(test::axis_model(), r);
  REQUIRE(found(prepared, FindingKind::gap_in_stamps, "t_s", FindingAction::segmented));
  std::set<Eigen::Index> begins;
  for (const RunSpan& run : prepared.recording().runs)
    if (run.begin > 0) begins.insert(prepared.source_rows()[static_cast<std::size_t>(run.begin)]);
  std::size_t right = 0;
  for (const Eigen::Index row : begins) right += after_lost.count(row);
  CHECK(right >= after_lost.size() * 8 /
                     10);  // where the command moved between two rows by more than a fiftieth of its range
  CHECK(begins.size() == right);
}

TEST_CASE("an input that is missing between values that differ is not made up") {
  Recording r = axis();
  change(r, "drive_A", [&](double x, Eigen::Index i) { return i >= 500 && i < 515 ? missing : x; });
  const PreparedRecording prepared(test::axis_model(), r);
  CHECK(found(prepared, FindingKind::unknown_input, "drive_A", FindingAction::segmented));
  REQUIRE(prepared.recording().runs.size() == 2);
  CHECK(prepared.recording().runs[0].end == 500);
  CHECK(prepared.recording().rows() == r.rows() - 15);
  CHECK(prepared.recording().column("drive_A").array().isFinite().all());
  // A power that was 150 before and after was 150 in between.
  Recording motor = bench();
  Eigen::Index steady = 80;
  while (motor.column("power_param")[steady - 1] != motor.column("power_param")[steady + 3]) ++steady;
  const double level = motor.column("power_param")[steady - 1];
  change(motor, "power_param",
         [&](double x, Eigen::Index i) { return i >= steady && i < steady + 3 ? missing : x; });
  const PreparedRecording bridged(test::bench_model(), motor);
  CHECK(bridged.recording().runs.size() == 1);
  CHECK(bridged.recording().column("power_param")[steady + 1] == level);
  // One that was off before and a little on after was switched on nobody knows when: a little is little of the range, but the
  // current goes with its root.
  change(motor, "power_param", [&](double x, Eigen::Index i) {
    return i < steady ? 0.0 : i == steady + 3 ? 2.0 : x;
  });
  CHECK(found(PreparedRecording(test::bench_model(), motor), FindingKind::unknown_input, "power_param",
              FindingAction::segmented));
}

TEST_CASE("as recorded, the check says what it saw and does nothing") {
  Recording r = bench();
  change(r, "motor_C", [](double x, Eigen::Index i) { return i % 100 == 50 ? 85.0 : x; });
  const PreparedRecording prepared(test::bench_model(), r, true);
  CHECK_FALSE(prepared.findings().empty());
  for (const Finding& one : prepared.findings()) CHECK(one.action == FindingAction::none);
  CHECK(taken(r, prepared, "motor_C").empty());
}

TEST_CASE("rows of a part count in the whole recording") {
  Recording r = bench();
  change(r, "motor_C", [](double x, Eigen::Index i) { return i == 1200 ? x + 30.0 : x; });
  const PreparedRecording prepared(test::bench_model(), r.slice(1000, 1500));
  REQUIRE(found(prepared, FindingKind::spiked_samples, "motor_C", FindingAction::masked));
  for (const Finding& one : prepared.findings())
    if (one.kind == FindingKind::spiked_samples) {
      REQUIRE(one.rows.size() == 1);
      CHECK(one.rows[0].begin == 1200);
      CHECK(one.row_count() == 1);
    }
}

TEST_CASE("a column that is removed was never recorded, and one that is not there cannot be removed") {
  Recording r = bench();
  const std::size_t columns = r.columns.size();
  REQUIRE(r.has("motor_C"));
  CHECK(r.remove("motor_C"));
  CHECK(r.columns.size() == columns - 1);
  CHECK(r.find("motor_C") == nullptr);
  CHECK_FALSE(r.is_empty("motor_C"));
  CHECK(r.has("current_A"));
  CHECK_FALSE(r.remove("motor_C"));
  CHECK_FALSE(r.remove("motor"));
  CHECK(r.columns.size() == columns - 1);
}

TEST_CASE("swings that were held, let go and logged on end begin runs of their own") {
  // A pendulum of 0.012 kg m^2 and 0.55 N m, let go at six angles for four seconds each, in rows of 10 ms without labels.
  Model model;
  model.axis = RigidAxisModel{0.012, 0.02, 0.3};
  model.effects["imbalance"] = {{"Nm", 0.55}, {"phase_rad", 0.0}};
  const double let_go_deg[] = {70.0, -40.0, 95.0, 25.0, -80.0, 50.0};
  constexpr int swing_rows = 400, rows = 6 * swing_rows;
  test::Noise noise(11);
  Recording r;
  r.name = "swings";
  r.t_s.resize(rows);
  Eigen::VectorXd drive = Eigen::VectorXd::Zero(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0;
  for (int i = 0; i < rows; ++i) {
    r.t_s[i] = 0.01 * i;
    if (i % swing_rows == 0) theta = let_go_deg[i / swing_rows] / 57.29577951308232, omega = 0.0;
    angle[i] = theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.2 * noise();
    for (int k = 0; k < 100; ++k) {
      omega += 1e-4 * (-0.02 * omega - 0.55 * std::sin(theta)) / 0.012;
      theta += 1e-4 * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const PreparedRecording swings(model, r);
  const std::vector<RunSpan> runs = swings.recording().spans();
  REQUIRE(runs.size() == 6);
  for (std::size_t i = 0; i < runs.size(); ++i)
    CHECK(runs[i].begin == static_cast<Eigen::Index>(i) * swing_rows);
  for (const RunSpan& run : runs) CHECK_FALSE(run.goes_on);  // each is let go from rest
  // One swing, and a sensor that reads another angle for a while, are one run.
  Recording one = r;
  for (int i = 0; i < rows; ++i) angle[i] = 30.0 * std::sin(0.02 * i) + 0.02 * noise();
  one.set("angle_deg", angle);
  CHECK(PreparedRecording(model, one).recording().spans().size() == 1);
  for (int i = 900; i < 920; ++i) angle[i] = -170.0;
  one.set("angle_deg", angle);
  CHECK(PreparedRecording(model, one).recording().spans().size() == 1);
  // So are one whose angle stops for a while, though its rate goes on, and one whose frames are repeated.
  for (const bool rate_stops : {false, true}) {
    for (int i = 0; i < rows; ++i) {
      angle[i] = 60.0 * std::sin(0.04 * i) + 0.02 * noise();
      rate[i] = 240.0 * std::cos(0.04 * i) + 0.2 * noise();
    }
    for (int i = 1401; i < 1412; ++i) {
      angle[i] = angle[1400];
      if (rate_stops) rate[i] = rate[1400];
    }
    one.set("angle_deg", angle);
    one.set("rate_dps", rate);
    const PreparedRecording stopped(model, one);
    CHECK(stopped.recording().spans().size() == 1);
    for (const Finding& finding : stopped.findings()) CHECK(finding.kind != FindingKind::position_reset);
  }
  // And one whose frames are repeated while the axis turns round, wherever that begins.
  for (int from = 1300; from < 1460; from += 7) {
    CAPTURE(from);
    for (int i = 0; i < rows; ++i) {
      angle[i] = 60.0 * std::sin(0.04 * i) + 5.0 * std::sin(0.17 * i) + 0.02 * noise();
      rate[i] = 240.0 * std::cos(0.04 * i) + 85.0 * std::cos(0.17 * i) + 0.2 * noise();
    }
    for (int i = from + 1; i < from + 20; ++i) angle[i] = angle[from], rate[i] = rate[from];
    one.set("angle_deg", angle);
    one.set("rate_dps", rate);
    CHECK(PreparedRecording(model, one).recording().spans().size() == 1);
  }
  // And one that goes on where the axis turns round, with a reading astray now and then while it stands.
  for (int i = 0; i < rows; ++i) {
    angle[i] = 60.0 * std::sin(0.04 * i) + 0.02 * noise();
    rate[i] = 240.0 * std::cos(0.04 * i) + 0.2 * noise();
  }
  for (int i = 1401; i < 1610; ++i) angle[i] = i == 1450 || i == 1530 ? 150.0 : angle[1400];
  one.set("angle_deg", angle);
  one.set("rate_dps", rate);
  const PreparedRecording turned(model, one);
  CHECK(turned.recording().spans().size() == 1);
  const std::set<Eigen::Index> out = taken(one, turned, "angle_deg");
  for (Eigen::Index i = 1401; i < 1610; ++i) {
    CAPTURE(i);
    CHECK(out.count(i) == 1);
  }
}

TEST_CASE("one sample is spoken of as one") {
  CHECK(said_of_one("lie far from all around them") == "lies far from all around it");
  CHECK(said_of_one("are no temperature of a motor") == "is no temperature of a motor");
  CHECK(said_of_one("repeat the value before them where noise or motion would show") ==
        "repeats the value before it where noise or motion would show");
  CHECK(said_of_one("of every output repeat the row before them") ==
        "of every output repeats the row before it");
  CHECK(said_of_one("are missing between values that differ; their rows are not judged") ==
        "is missing between values that differ; its row is not judged");
  Recording r = bench();
  Eigen::VectorXd motor = r.column("motor_C");
  motor[700] += 60.0;
  r.set("motor_C", motor);
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(std::any_of(prepared.findings().begin(), prepared.findings().end(), [](const Finding& one) {
    return one.message.rfind("1 sample lies far from all around it, first in row 700", 0) == 0;
  }));
}

TEST_CASE("a recording that repeats itself is not told to leave an option away") {
  const Recording once = bench();
  Recording twice = once;
  twice.t_s.resize(2 * once.rows());
  twice.t_s << once.t_s, (once.t_s.array() + once.t_s[once.rows() - 1] + 2.0).matrix();
  for (Column& column : twice.columns) {
    const Eigen::VectorXd values = column.values;
    column.values.resize(2 * once.rows());
    column.values << values, values;
  }
  const auto mend = [](const Recording& train, const Recording& held_out) {
    for (const Finding& one :
         engine::check(test::bench_model(), {train}, {held_out}, {}, standard_catalogue()).findings)
      if (one.kind == FindingKind::held_out_in_training) return one.mend;
    return std::string("nothing");
  };
  CHECK_THAT(mend(twice.slice(0, once.rows()), twice.slice(once.rows(), twice.rows())),
             ContainsSubstring("hold out another recording with --heldout"));
  CHECK_THAT(mend(once, once), ContainsSubstring("leave --heldout away"));
}
