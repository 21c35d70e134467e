// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Sound recordings that look odd, and are believed.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/check_data.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>

using namespace thermopower::gap;
using engine::PreparedRecording;

namespace {

/// Whether every sample of a column is kept, and the recording is one run.
void is_believed(const Model& model, const Recording& r, const char* column) {
  const PreparedRecording prepared(model, r);
  CAPTURE(column);
  CHECK(prepared.recording().column(column).array().isFinite().all());
  CHECK(prepared.recording().runs.size() == 1);
}

/// The same of a bench in air of 24 degC.
void is_believed_of_bench(Recording& r, const Eigen::VectorXd& power, const Eigen::VectorXd& motor_C,
                          const char* column) {
  r.set("motor_C", motor_C);
  r.set("power_param", power);
  r.set("ambient_C", Eigen::VectorXd::Constant(r.rows(), 24.0));
  is_believed(test::bench_model(), r, column);
}

Recording of_rows(Eigen::Index rows, double interval_s) {
  Recording r;
  r.name = "sound";
  r.t_s.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) r.t_s[i] = interval_s * static_cast<double>(i);
  return r;
}

double stepped(double value, double step) { return step * std::round(value / step); }

}  // namespace

TEST_CASE(
    "a joint that friction holds at its target is no frozen sensor, whatever its encoder lacks of noise") {
  // A joint goes from target to target in a tenth of a second each, and rests for half a second.
  Recording r = of_rows(2000, 0.01);
  Eigen::VectorXd angle(r.rows()), drive(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const auto move = i / 60, row = i % 60;
    const double from = 30.0 * std::sin(1.3 * static_cast<double>(move)),
                 to = 30.0 * std::sin(1.3 * static_cast<double>(move + 1));
    const double part = std::min(1.0, static_cast<double>(row) / 10.0);
    angle[i] = stepped(from + (to - from) * part * part * (3.0 - 2.0 * part), 360.0 / 4096.0);
    drive[i] = 0.02 * (to - angle[i]);
  }
  r.set("angle_deg", angle);
  r.set("drive_A", drive);
  is_believed(test::axis_model(), r, "angle_deg");
}

TEST_CASE("a joint that breaks away within a row, again and again, has neither spikes nor stops") {
  Recording r = of_rows(1500, 0.02);
  test::Noise noise(3);
  Eigen::VectorXd angle(r.rows()), rate(r.rows()), drive(r.rows());
  double at = 0.0, speed = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    if (i % 50 == 30) speed = 400.0;  // it sticks, and then leaps and slows down
    at += 0.02 * speed;
    angle[i] = stepped(at, 0.088);
    rate[i] = speed + 0.4 * noise();
    drive[i] = 0.01 * static_cast<double>(i % 50);
    speed = speed > 5.0 ? 0.45 * speed : 0.0;
  }
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  r.set("drive_A", drive);
  is_believed(test::axis_model(), r, "angle_deg");
  is_believed(test::axis_model(), r, "rate_dps");
  r.remove("angle_deg");
  is_believed(test::axis_model(), r, "rate_dps");
}

TEST_CASE("a reading that flickers by a quantum has no spikes") {
  Recording r = of_rows(1000, 1.0);
  test::Noise noise(8);
  Eigen::VectorXd motor(r.rows()), power(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    power[i] = i < 400 ? 180.0 : 60.0;
    const double warm = i < 400 ? 40.0 - 15.0 * std::exp(-static_cast<double>(i) / 400.0)
                                : 30.0 + 4.5 * std::exp(-static_cast<double>(i - 400) / 400.0);
    motor[i] = stepped(warm + 0.12 * noise(), 0.5);
  }
  is_believed_of_bench(r, power, motor, "motor_C");
}

TEST_CASE("a temperature in steps of 0.1 K, read ten times a second, has not stopped") {
  Recording r = of_rows(6000, 0.1);
  Eigen::VectorXd motor(r.rows()), power(r.rows());
  double warm = 24.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    power[i] = i / 1500 % 2 == 0 ? 150.0 : 0.0;
    warm += 0.1 * (power[i] / 255.0 * 18.0 - 0.15 * (warm - 24.0)) / 60.0;
    motor[i] = stepped(warm, 0.1);
  }
  is_believed_of_bench(r, power, motor, "motor_C");
}

TEST_CASE("the peak of a current that starts to flow is no spike") {
  Recording r = of_rows(1500, 0.1);
  test::Noise noise(5);
  Eigen::VectorXd current(r.rows()), power(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const bool on = i % 100 < 60;
    power[i] = on ? 200.0 : 0.0;
    current[i] = (on ? 1.3 + 4.0 * std::exp(-static_cast<double>(i % 100) / 1.2) : 0.0) + 0.004 * noise();
  }
  r.set("current_A", current);
  is_believed_of_bench(r, power, Eigen::VectorXd::Constant(r.rows(), 30.0), "current_A");
}

TEST_CASE("a joint that rests at the end of its way, where its target is, is not cut off there") {
  Recording r = of_rows(2000, 0.01);
  Eigen::VectorXd angle(r.rows()), target(r.rows()), drive(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const bool up = i / 200 % 2 == 1;
    target[i] = up ? 90.0 : 0.0;
    const double part = std::exp(-static_cast<double>(i % 200) / 12.0);
    const double exact = i < 200 ? 0.0 : up ? 90.0 * (1.0 - part) : 90.0 * part;
    angle[i] = stepped(exact, 0.088);
    drive[i] = 0.03 * (target[i] - angle[i]);
  }
  r.set("angle_deg", angle);
  r.set("target_deg", target);
  r.set("drive_A", drive);
  is_believed(test::axis_model(), r, "angle_deg");
}

TEST_CASE("one lost row a second cuts no run of a body that takes half an hour, and many seconds do") {
  Recording r = test::bench_recording({}, 1500, 2);
  Model slow = test::bench_model();
  slow.thermal = LumpedThermalModel{270.0, 0.15};
  for (const char* column : {"current_A"}) r.remove(column);
  const auto without = [&](Eigen::Index from, Eigen::Index to) {
    Recording part = r;
    for (Eigen::Index i = from; i < r.rows(); ++i) part.t_s[i] += 0.5 * (r.t_s[to] - r.t_s[from]);
    part.t_s *= 0.5;  // a row a second
    return PreparedRecording(slow, part).recording().runs.size();
  };
  CHECK(without(675, 677) == 1);  // the power steps in row 675
  CHECK(without(675, 775) == 2);
}

TEST_CASE("holes of a column that the baseline ignores cut no run") {
  Recording r = test::bench_recording({}, 1500, 2);
  Eigen::VectorXd other(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    other[i] = i % 200 > 150 ? missing : 40.0 + 20.0 * std::sin(0.05 * static_cast<double>(i));
  r.set("neighbour_C", other);
  const PreparedRecording prepared(test::bench_model(), r);
  CHECK(prepared.recording().rows() == r.rows());
  CHECK(prepared.recording().runs.size() == 1);
  Model reads_it = test::bench_model();
  reads_it.effects["neighbour_heating"] = {{"coupling_W_per_K", 0.02}};
  CHECK(PreparedRecording(reads_it, r).recording().rows() < r.rows());
}

TEST_CASE("a sensor's noise does not depend on the model") {
  Recording r = test::axis_recording({}, 3000, 4);
  const DataReport sound = check_data(test::axis_model(), {r});
  Model wrong = test::axis_model();
  wrong.axis->inertia_kgm2 *= 6.0;
  const DataReport off = check_data(wrong, {r});
  REQUIRE(sound.signals.size() == 2);
  REQUIRE(off.signals.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(sound.signals[i].signal);
    const double truth = sound.signals[i].signal == "angle_deg" ? 0.02 : 0.15;  // as axis_recording() adds it
    CHECK(off.signals[i].misfit > 3.0 * sound.signals[i].misfit);
    CHECK(off.signals[i].noise == sound.signals[i].noise);
    CHECK(sound.signals[i].noise == Approx(truth).epsilon(0.15));
  }
}
