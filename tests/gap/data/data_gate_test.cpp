// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/data/data_gate.hpp>

#include <functional>

using namespace thermopower::gap;

namespace {

std::string codes(const std::vector<Finding>& findings, bool with_notes = false) {
  std::string out;
  for (const auto& one : findings) {
    if (one.severity != Severity::note || with_notes) out += one.code + "(" + one.column + ") ";
  }
  return out;
}

Recording bench() { return test::bench_recording({}, 1200, 1); }
Recording axis() { return test::axis_recording({}, 3000, 1); }

void change(Recording& r, const char* column, const std::function<double(double, Eigen::Index)>& f) {
  Eigen::VectorXd values = r.column(column);
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = f(values[i], i);
  r.set(column, values);
}

}  // namespace

TEST_CASE("sound recordings raise no warning") {
  CHECK(codes(check_data(bench(), test::bench_model())).empty());
  CHECK(codes(check_data(axis(), test::axis_model())).empty());
}

TEST_CASE("stamps that repeat, go back, vary or pause are found") {
  Recording r = bench();
  r.t_s[100] = r.t_s[99];
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("repeated_stamps(t_s)"));
  r = bench();
  for (Eigen::Index i = 600; i < r.rows(); ++i) r.t_s[i] -= 65.536 * 2;
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("decreasing_stamps(t_s)"));
  r = bench();
  for (Eigen::Index i = 600; i < r.rows(); ++i) r.t_s[i] += 500.0;
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("gap_in_stamps(t_s)"));
  r = bench();
  for (Eigen::Index i = 1; i < r.rows(); i += 2) r.t_s[i] += 1.0;
  CHECK_THAT(codes(check_data(r, test::bench_model()), true), ContainsSubstring("irregular_stamps(t_s)"));
}

TEST_CASE("units and signs are found") {
  Recording r = bench();
  change(r, "motor_C", [](double x, Eigen::Index) { return x + 273.15; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("wrong_unit(motor_C)"));
  r = bench();
  change(r, "current_A", [](double x, Eigen::Index) { return 1000.0 * x; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("wrong_unit(current_A)"));
  r = bench();
  change(r, "current_A", [](double x, Eigen::Index) { return -x; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("wrong_sign(current_A)"));
  r = bench();
  change(r, "power_param", [](double x, Eigen::Index) { return x / 255.0; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("wrong_unit(power_param)"));
  r = axis();
  change(r, "rate_dps", [](double x, Eigen::Index) { return x / 57.29577951; });
  const auto findings = check_data(r, test::axis_model());
  CHECK_THAT(codes(findings), ContainsSubstring("wrong_unit(angle_deg)"));
  CHECK_THAT(findings.back().message + findings.front().message, ContainsSubstring("radians"));
  r = axis();
  change(r, "angle_deg", [](double x, Eigen::Index) { return -x; });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("wrong_sign(angle_deg)"));
  r = axis();
  change(r, "drive_A", [](double x, Eigen::Index) { return -x; });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("wrong_sign(drive_A)"));
}

TEST_CASE("wraps, frozen and saturated channels, holes and spikes are found") {
  Recording r = axis();
  change(r, "angle_deg", [](double x, Eigen::Index) {
    return x - 360.0 * std::floor((x + 180.0) / 360.0) - (std::fabs(x) > 1e9 ? 1.0 : 0.0);
  });
  change(r, "angle_deg", [](double x, Eigen::Index i) {
    return i % 700 < 350 ? x : x > 0.0 ? x - 359.0 : x + 359.0;
  });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("wrapped_channel(angle_deg)"));
  r = axis();
  change(r, "rate_dps", [](double x, Eigen::Index) { return std::min(20.0, std::max(-20.0, x)); });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("saturated_channel(rate_dps)"));
  r = axis();
  const double held = r.column("rate_dps")[1000];
  change(r, "rate_dps", [&](double x, Eigen::Index i) { return i >= 1000 && i < 1400 ? held : x; });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("frozen_channel(rate_dps)"));
  r = bench();
  change(r, "current_A", [](double x, Eigen::Index i) { return i == 400 || i == 800 ? x + 50.0 : x; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("outliers(current_A)"));
  r = bench();
  change(r, "motor_C", [](double x, Eigen::Index i) { return i % 3 == 0 ? missing : x; });
  CHECK_THAT(codes(check_data(r, test::bench_model())), ContainsSubstring("missing_samples(motor_C)"));
}

TEST_CASE("a quantum that limits every score is noted") {
  Recording r = bench();
  change(r, "motor_C", [](double x, Eigen::Index) { return std::round(x); });
  CHECK_THAT(codes(check_data(r, test::bench_model()), true), ContainsSubstring("quantum(motor_C)"));
}

TEST_CASE("loggers whose clocks differ are found") {
  Recording r = bench();
  const Eigen::VectorXd current = r.column("current_A");
  change(r, "current_A", [&](double, Eigen::Index i) { return current[std::max<Eigen::Index>(0, i - 5)]; });
  auto findings = check_data(r, test::bench_model());
  CHECK_THAT(codes(findings), ContainsSubstring("clock_shift(current_A)"));
  CHECK_THAT(findings.back().message, ContainsSubstring("follows power_param by 10 s (5 rows)"));
  r = axis();
  const Eigen::VectorXd drive = r.column("drive_A");
  change(r, "drive_A", [&](double, Eigen::Index i) { return drive[std::max<Eigen::Index>(0, i - 4)]; });
  CHECK_THAT(codes(check_data(r, test::axis_model())), ContainsSubstring("clock_shift(drive_A)"));
}
