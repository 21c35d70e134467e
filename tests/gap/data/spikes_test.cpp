// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Which samples of a motion are spikes, with the truth known: a motion that is written down here, white noise on it, and
// samples far off at places that are written down, too.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/observe/prepared_recording.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

constexpr Eigen::Index rows = 4000;
constexpr double pi = 3.14159265358979323846;

/// Angle and rate of a motion at a time in s.
struct Motion {
  std::function<double(double)> deg, dps;
};

/// Two swings, of which the faster one has a second difference of 20 times the noise at 20 Hz.
Motion swings() {
  constexpr double slow = 2.0 * pi * 0.43, fast = 2.0 * pi * 1.1;
  return {
      [=](double t) { return 40.0 * std::sin(slow * t) + 12.0 * std::sin(fast * t + 0.7); },
      [=](double t) { return 40.0 * slow * std::cos(slow * t) + 12.0 * fast * std::cos(fast * t + 0.7); }};
}

/// A swing that gets faster by a share per second, up to 12 rows each at 50 Hz
Motion faster_and_faster() {
  constexpr double first_Hz = 0.2, last_Hz = 4.2, lasts_s = 80.0;
  const double growth_per_s = std::log(last_Hz / first_Hz) / lasts_s;
  return {[=](double t) {
            const double Hz = first_Hz * std::exp(growth_per_s * t);
            return 10.0 * std::sin(2.0 * pi * (Hz - first_Hz) / growth_per_s);
          },
          [](double) { return 0.0; }};
}

/// A torque that is reversed at random, or not, every four rows of 20 Hz: a rate of straight lines between corners.
Motion pushed_there_and_back() {
  constexpr double dt = 0.05, per_row_dps = 12.0;
  std::vector<double> dps(rows + 1, 0.0), deg(rows + 1, 0.0);
  std::uint32_t state = 20261126;
  double torque = 1.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows); ++i) {
    if (i % 4 == 0 && ((state = state * 1664525u + 1013904223u) >> 31) != 0) torque = -torque;
    if (std::abs(dps[i]) > 200.0 && i % 4 == 0) torque = dps[i] > 0.0 ? -1.0 : 1.0;
    dps[i + 1] = dps[i] + per_row_dps * torque;
    deg[i + 1] = deg[i] + 0.5 * (dps[i] + dps[i + 1]) * dt;
  }
  const auto at = [](const std::vector<double>& values, double t) {
    return values[static_cast<std::size_t>(std::lround(t / dt))];
  };
  return {[=](double t) { return at(deg, t); }, [=](double t) { return at(dps, t); }};
}

Recording record(const Motion& motion, double interval_s, double noise_deg, double noise_dps,
                 bool with_rate) {
  test::Noise noise(7);
  Recording r;
  r.name = "motion";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = interval_s * static_cast<double>(i);
    r.t_s[i] = t;
    drive[i] = 0.1 * std::sin(0.7 * t);
    angle[i] = std::round((motion.deg(t) + noise_deg * noise()) * 1e4) / 1e4;
    rate[i] = std::round((motion.dps(t) + noise_dps * noise()) * 1e3) / 1e3;
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  if (with_rate) r.set("rate_dps", rate);
  return r;
}

/// Moves a sample in a hundred by 9 to 25 noise scales. @return which
std::set<Eigen::Index> spoil(Recording& r, const char* column, double noise, Eigen::Index first) {
  std::set<Eigen::Index> bad;
  Eigen::VectorXd values = r.column(column);
  for (Eigen::Index i = first, k = 0; i + 20 < rows; i += 71 + 13 * (k % 5), ++k) {
    values[i] += (k % 2 == 0 ? 1.0 : -1.0) * (9.0 + static_cast<double>(k * 7 % 17)) * noise;
    bad.insert(i);
  }
  r.set(column, values);
  return bad;
}

std::set<Eigen::Index> masked(const Recording& r, const char* column) {
  const PreparedRecording prepared(test::axis_model(), r);
  std::set<Eigen::Index> out;
  for (Eigen::Index i = 0; i < rows; ++i) out.insert(i);
  const Eigen::VectorXd& values = prepared.recording().column(column);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) out.erase(prepared.source_rows()[static_cast<std::size_t>(i)]);
  return out;
}

/// At least nine in ten of the bad samples are masked, and less than one in a thousand of the others.
void nine_in_ten(const std::set<Eigen::Index>& bad, const std::set<Eigen::Index>& out) {
  const auto seen = static_cast<std::size_t>(
      std::count_if(bad.begin(), bad.end(), [&](Eigen::Index row) { return out.count(row) != 0; }));
  CHECK(10 * seen >= 9 * bad.size());
  CHECK(1000 * (out.size() - seen) <= static_cast<std::size_t>(rows));
}

/// Moves two samples beside each other, every 97 rows. @param by  of a row: how far it is moved, and the next one
std::set<Eigen::Index> spoil_pairs(Recording& r, const char* column,
                                   const std::function<std::pair<double, double>(Eigen::Index)>& by) {
  std::set<Eigen::Index> bad;
  Eigen::VectorXd values = r.column(column);
  for (Eigen::Index i = 50; i + 50 < rows; i += 97) {
    const auto [first, second] = by(i);
    values[i] += first;
    values[i + 1] += second;
    bad.insert({i, i + 1});
  }
  r.set(column, values);
  return bad;
}

}  // namespace

TEST_CASE("spikes of an angle are masked though its motion bends by more than they are high") {
  Recording r = record(swings(), 0.05, 0.1, 0.0, false);
  const std::set<Eigen::Index> bad = spoil(r, "angle_deg", 0.1, 31);
  nine_in_ten(bad, masked(r, "angle_deg"));
}

TEST_CASE("spikes of a rate are masked though it bends") {
  Recording r = record(swings(), 0.02, 0.05, 0.6, true);
  const std::set<Eigen::Index> bad = spoil(r, "rate_dps", 0.6, 45);
  nine_in_ten(bad, masked(r, "rate_dps"));
}

TEST_CASE("two equal spikes beside each other on a slow motion are masked") {
  Recording r = record(swings(), 0.002, 0.1, 0.0, false);
  const std::set<Eigen::Index> bad =
      spoil_pairs(r, "angle_deg", [](Eigen::Index) { return std::make_pair(1.7, 1.7); });
  nine_in_ten(bad, masked(r, "angle_deg"));
}

TEST_CASE("corners, fast swings and lost rows are no spikes") {
  Recording corners = record(pushed_there_and_back(), 0.05, 0.03, 0.3, true);
  CHECK(masked(corners, "angle_deg").size() <= 4);
  CHECK(masked(corners, "rate_dps").size() <= 4);
  const Recording swing = record(faster_and_faster(), 0.02, 0.04, 0.0, false);
  CHECK(masked(swing, "angle_deg").size() <= 4);
  Recording lossy = swing;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < rows; ++i)
    if (i % 37 != 5 && i % 53 != 17) kept.push_back(i);
  const auto thinned = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXd result(static_cast<Eigen::Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) result[static_cast<Eigen::Index>(i)] = values[kept[i]];
    return result;
  };
  lossy.t_s = thinned(swing.t_s);
  for (const char* column : {"drive_A", "angle_deg"}) lossy.set(column, thinned(swing.column(column)));
  const PreparedRecording prepared(test::axis_model(), lossy);
  for (const Finding& one : prepared.findings()) {
    CAPTURE(one.message);
    if (one.kind == FindingKind::spiked_samples) CHECK(one.row_count() <= 4);
  }
}

TEST_CASE("an angle in steps of an encoder, logged with few digits, has no spikes") {
  Recording r = record(swings(), 0.01, 0.0, 0.0, false);
  Eigen::VectorXd angle = r.column("angle_deg");
  for (double& deg : angle)
    deg = std::round(std::round(deg / (360.0 / 8192.0)) * (360.0 / 8192.0) * 1e3) / 1e3;
  r.set("angle_deg", angle);
  CHECK(masked(r, "angle_deg").size() <= 4);
}

TEST_CASE("a sample that equals the one before it by chance repeats no frame") {
  Recording r = record(swings(), 0.01, 0.0, 0.0, false);
  Eigen::VectorXd angle = r.column("angle_deg");
  test::Noise noise(5);
  // Noise of some hundred digits on an axis that hardly moves.
  for (double& deg : angle) deg = std::round((0.02 * deg + 0.03 * noise()) * 1e4) / 1e4;
  r.set("angle_deg", angle);
  REQUIRE(std::adjacent_find(angle.begin(), angle.end()) != angle.end());
  const PreparedRecording prepared(test::axis_model(), r);
  for (const Finding& one : prepared.findings()) CHECK(one.kind != FindingKind::repeated_frames);

  SECTION("but a hundred of them do") {
    std::set<Eigen::Index> bad;
    for (Eigen::Index i = 30; i + 30 < rows; i += 38) {
      angle[i] = angle[i - 1];
      bad.insert(i);
    }
    REQUIRE(bad.size() > 100);
    r.set("angle_deg", angle);
    nine_in_ten(bad, masked(r, "angle_deg"));
  }
}

TEST_CASE("a rate that returns to its largest value for a row at a time is not at the end of a range") {
  // Differences of an encoder through a filter, at a steady speed: the same few values over and over, and the largest of them
  // once in a beat. The other way it goes faster.
  Recording r = record(swings(), 0.005, 0.0, 0.0, true);
  Eigen::VectorXd angle(rows), rate(rows);
  constexpr double step_deg = 360.0 / 8192.0, interval_s = 0.005;
  double at_deg = 0.0, before_deg = 0.0, filtered_dps = 0.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double dps = i % 2000 < 1000   ? 84.4
                       : i % 2000 < 1400 ? 0.0
                                         : -190.0 + 0.013 * static_cast<double>(i % 2000);
    at_deg += dps * interval_s;
    const double read_deg = step_deg * std::floor(at_deg / step_deg);
    filtered_dps += 0.35 * ((read_deg - before_deg) / interval_s - filtered_dps);
    before_deg = read_deg;
    angle[i] = std::round(read_deg * 1e3) / 1e3;
    rate[i] = std::round(filtered_dps * 1e2) / 1e2;
  }
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  const double largest = rate.maxCoeff();
  REQUIRE(std::count(rate.begin(), rate.end(), largest) >= 5);
  const PreparedRecording prepared(test::axis_model(), r);
  for (const Finding& one : prepared.findings()) CHECK(one.kind != FindingKind::clipped_samples);
}

TEST_CASE("a first reading is far off where those after it do not go back to it") {
  test::Noise noise(5);
  const auto far = [&](double tau_rows, double rise, double off_sds, double sd) {
    constexpr int samples_in_run = 60;
    Eigen::VectorXd column(samples_in_run);
    for (int i = 0; i < samples_in_run; ++i)
      column[i] = 20.0 + rise * std::exp(-i / tau_rows) + sd * noise() + (i == 0 ? off_sds * sd : 0.0);
    const OrderedSamples samples(column, nullptr, {0, samples_in_run, "r0"});
    return first_reading_off(samples, sd, MaskThresholds().first_sds) > 0.0;
  };
  int seen = 0, false_alarms = 0;
  constexpr int draws = 2000;
  for (int k = 0; k < draws; ++k) {
    const double tau_rows = 20.0 + 0.1 * k, rise = (k % 2 == 0 ? 1.0 : -1.0) * (k % 7);
    seen += far(tau_rows, rise, k % 3 == 0 ? -8.0 : 8.0, 0.1) ? 1 : 0;
    false_alarms += far(tau_rows, rise, 0.0, 0.1) ? 1 : 0;
  }
  CHECK(seen > 0.95 * draws);
  CHECK(false_alarms <= draws / 500);
  // A body that cools within a few rows begins far from where it ends, and so does what the next row reads.
  for (const double tau_rows : {1.0, 2.0, 3.0, 5.0, 10.0})
    for (const double rise : {-20.0, 20.0}) CHECK_FALSE(far(tau_rows, rise, 0.0, 0.01));
}

TEST_CASE("the crest of a temperature that overshoots before it is held jumps nowhere") {
  constexpr Eigen::Index count = 400;
  test::Noise noise(3);
  Recording r;
  r.name = "chamber";
  r.t_s = Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1));
  Eigen::VectorXd held(count), power(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = static_cast<double>(i);
    held[i] =
        25.0 - std::exp(-t / 8.0) * (3.0 * std::cos(t / 2.5) - 2.0 * std::sin(t / 2.5)) + 0.004 * noise();
    power[i] = i < 10 ? 200.0 : 60.0;
  }
  r.set("motor_C", held);
  r.set("power_param", power);
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(prepared.recording().rows() == count);
  CHECK(prepared.recording().column("motor_C").allFinite());
}
