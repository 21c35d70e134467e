// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Units, signs, exchanged columns, clocks, and experiments that cannot tell anything.
#include "../../catch.hpp"

#include "../plants.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/units/clock_shift.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <functional>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

/// Rows of a column moved to later rows by `shift` (to earlier ones where negative), ends repeated.
Eigen::VectorXd shifted(const Eigen::VectorXd& values, Eigen::Index shift) {
  Eigen::VectorXd result(values.size());
  for (Eigen::Index i = 0; i < values.size(); ++i)
    result[i] = values[std::clamp<Eigen::Index>(i - shift, 0, values.size() - 1)];
  return result;
}

Recording bench() { return test::bench_recording({}, 1200, 1); }
Recording axis() { return test::axis_recording({}, 3000, 1); }

void change(Recording& r, const char* column, const std::function<double(double)>& f) {
  Eigen::VectorXd values = r.column(column);
  for (double& value : values) value = f(value);
  r.set(column, values);
}

std::vector<Finding> findings(const Model& model, const Recording& r) {
  return engine::check(model, {r}, {}, {}, standard_catalogue()).findings;
}

/// The first finding as `kind(column) mend`; empty where none decides.
std::string decision(const Model& model, const Recording& r) {
  const std::vector<Finding> all = findings(model, r);
  const Finding* one = deciding(all);
  return one == nullptr ? "" : std::string(to_string(one->kind)) + "(" + one->column + ") " + one->mend;
}

std::string said(const Model& model, const Recording& r) {
  std::string text;
  for (const Finding& one : findings(model, r))
    text += std::string(to_string(one.kind)) + "(" + one.column + ") " + one.message + "; ";
  return text;
}

}  // namespace

TEST_CASE("sound recordings are believed, and those of other plants than the model's") {
  CHECK(decision(test::bench_model(), bench()).empty());
  CHECK(decision(test::axis_model(), axis()).empty());
  CHECK(decision(test::bench_model(), test::bench_recording({0.01, 0.05, 1.3, 1.5, 20.0, 1.4}, 1200, 3))
            .empty());
  CHECK(decision(test::axis_model(), test::axis_recording({0.03, 0.02, 1.0, 3}, 3000, 4)).empty());
  CHECK(decision(test::axis_model(), test::axis_recording({0.0, 0.0, 18.0, 0}, 3000, 4))
            .empty());  // a stiff spring: only the rate trembles
  CHECK(decision(test::axis_model(), test::axis_recording({0.0, 0.0, 0.0, 18.0}, 3000, 4))
            .empty());  // angle_scale
}

TEST_CASE("a wrong unit decides, with the option that mends it") {
  struct Case {
    const char* column;
    std::function<double(double)> as_recorded;
    const char* answer;
  };
  const Case motor[] = {
      {"motor_C", [](double x) { return x * 1.8 + 32.0; },
       "wrong_unit(motor_C) --column motor_C=motor_C:degF"},
      {"motor_C", [](double x) { return x + 273.15; }, "wrong_unit(motor_C) --column motor_C=motor_C:K"},
      {"ambient_C", [](double x) { return x * 1.8 + 32.0; },
       "wrong_unit(ambient_C) --column ambient_C=ambient_C:degF"},
      {"ambient_C", [](double x) { return x + 273.15; },
       "wrong_unit(ambient_C) --column ambient_C=ambient_C:K"},
      {"power_param", [](double x) { return x / 255.0; },
       "wrong_unit(power_param) --column power_param=power_param:1"},
      {"power_param", [](double x) { return x / 2.55; },
       "wrong_unit(power_param) --column power_param=power_param:%"},
      {"current_A", [](double x) { return 1000.0 * x; },
       "wrong_unit(current_A) --column current_A=current_A:mA"},
      {"current_A", [](double x) { return -x; }, "wrong_sign(current_A) --column current_A=current_A:-A"},
      {"supply_V", [](double x) { return 1000.0 * x; },
       "wrong_unit(supply_V) --column supply_V=supply_V:mV"}};
  for (const Case& one : motor) {
    Recording r = bench();
    change(r, one.column, one.as_recorded);
    CHECK(decision(test::bench_model(), r) == one.answer);
  }
  const Case moving[] = {
      {"drive_A", [](double x) { return 1000.0 * x; }, "wrong_unit(drive_A) --column drive_A=drive_A:mA"},
      {"drive_A", [](double x) { return -x; }, "wrong_sign(drive_A) --column drive_A=drive_A:-A"},
      {"rate_dps", [](double x) { return x / 6.0; }, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rpm"},
      {"rate_dps", [](double x) { return x / 57.29578; },
       "wrong_unit(rate_dps) --column rate_dps=rate_dps:rad/s"},
      {"rate_dps", [](double x) { return -x; }, "wrong_sign(rate_dps) --column rate_dps=rate_dps:-deg/s"},
      {"angle_deg", [](double x) { return -x; }, "wrong_sign(angle_deg) --column angle_deg=angle_deg:-deg"}};
  for (const Case& one : moving) {
    Recording r = axis();
    change(r, one.column, one.as_recorded);
    CHECK(decision(test::axis_model(), r) == one.answer);
  }
}

TEST_CASE("a drive that pushes against a stop is in amperes, and in milliamperes where it is") {
  // An arm of 1.9 kg m^2 and 22 N m under a stiff position servo whose target swings by 60 degrees; padded stops let it go to
  // 35. A simulation without stops is thrown off by what pushes against them, and follows best where nothing drives it.
  Model model;
  model.axis = RigidAxisModel{1.9, 6.0, 14.0};
  model.effects["imbalance"] = {{"Nm", 22.0}, {"phase_rad", 0.0}};
  constexpr int rows = 3000;
  const auto arm = [&](double stop_rad) {
    Recording r;
    r.name = "arm";
    r.t_s.resize(rows);
    Eigen::VectorXd drive(rows), angle(rows), rate(rows);
    double theta = 0.0, omega = 0.0;
    for (int i = 0; i < rows; ++i) {
      r.t_s[i] = 0.004 * i;
      angle[i] = theta * 57.29577951308232;
      rate[i] = omega * 57.29577951308232;
      const double target = 60.0 * std::sin(3.1416 * r.t_s[i]);
      drive[i] = std::clamp(0.9 * (target - angle[i]) - 0.1 * rate[i], -9.0, 9.0);
      for (int k = 0; k < 80; ++k) {
        constexpr double h = 5e-5;
        const double past = std::abs(theta) - stop_rad, side = theta > 0.0 ? 1.0 : -1.0;
        const double pad = past > 0.0 ? side * 900.0 * past + 5.0 * omega : 0.0;
        omega += h * (14.0 * drive[i] - 6.0 * omega - 22.0 * std::sin(theta) - pad) / 1.9;
        theta += h * omega;
      }
    }
    r.set("drive_A", drive);
    r.set("angle_deg", angle);
    r.set("rate_dps", rate);
    return r;
  };
  CHECK(decision(model, arm(0.61)).empty());
  Recording written = arm(10.0);
  change(written, "drive_A", [](double x) { return 1000.0 * x; });
  CHECK(decision(model, written) == "wrong_unit(drive_A) --column drive_A=drive_A:mA");
}

TEST_CASE("several columns in the same wrong unit are mended together") {
  Recording r = bench();
  for (const char* column : {"motor_C", "ambient_C"})
    change(r, column, [](double x) { return x * 1.8 + 32.0; });
  CHECK(decision(test::bench_model(), r) ==
        "wrong_unit(motor_C) --column motor_C=motor_C:degF --column ambient_C=ambient_C:degF");
  r = axis();
  for (const char* column : {"angle_deg", "rate_dps"})
    change(r, column, [](double x) { return x / 57.29578; });
  CHECK(decision(test::axis_model(), r) ==
        "wrong_unit(rate_dps) --column rate_dps=rate_dps:rad/s --column angle_deg=angle_deg:rad");
}

TEST_CASE("stamps in other units decide") {
  const struct {
    double factor;
    const char* unit;
  } cases[] = {{1e3, "ms"}, {1e6, "us"}, {1.0 / 60.0, "min"}};
  for (const auto& one : cases) {
    Recording motor = bench(), moving = axis();
    motor.t_s *= one.factor;
    moving.t_s *= one.factor;
    const std::string answer = std::string("wrong_unit(t_s) --column t_s=t_s:") + one.unit;
    CHECK(decision(test::bench_model(), motor) == answer);
    CHECK(decision(test::axis_model(), moving) == answer);
  }
}

TEST_CASE("a temperature that something holds is no clock's fault") {
  // A motor embedded in wax that melts at 50 degC: in milliseconds the simulation would stand still, as the wax does.
  Recording r = bench();
  Eigen::VectorXd motor_C = r.column("motor_C");
  for (Eigen::Index i = 0; i < motor_C.size(); ++i) {
    const double row = static_cast<double>(i);
    motor_C[i] = 50.0 + 0.3 * std::sin(0.013 * row) + 0.05 * std::sin(2.1 * row * row);
  }
  r.set("motor_C", motor_C);
  CHECK(decision(test::bench_model(), r).empty());
}

TEST_CASE("a part in which the power is 0 or 1 is no duty where the other part goes further") {
  const auto units = [](const std::vector<Recording>& train, const std::vector<Recording>& held) {
    std::string text;
    for (const Finding& one :
         engine::check(test::bench_model(), train, held, {}, standard_catalogue()).findings)
      if (one.kind == FindingKind::wrong_unit) text += one.column + " ";
    return text;
  };
  // Rows without power, but for a few with the least there is: 12 V sqrt(1/255) on 8 ohm.
  const Recording whole = bench();
  Recording idle = whole.slice(225, 300);
  Eigen::VectorXd power = idle.column("power_param"), current = idle.column("current_A");
  REQUIRE(power.cwiseAbs().maxCoeff() == 0.0);
  power.head(20).setOnes();
  current.head(20).array() += 0.094;
  idle.set("power_param", power);
  idle.set("current_A", current);
  CHECK(units({whole}, {idle}).empty());
  CHECK(units({idle}, {whole}).empty());
  CHECK(units({idle}, {idle}) == "power_param power_param ");
}

TEST_CASE("a thermometer that never changes decides, where the motor must have warmed") {
  Recording r = bench();
  change(r, "motor_C", [](double) { return 25.0; });
  CHECK(decision(test::bench_model(), r) ==
        "frozen_samples(motor_C) look at what reads the sensor, or leave the column out");
  // In steps of two degrees, and with hardly any power, it may stand still.
  r = bench();
  change(r, "motor_C", [](double x) { return 2.0 * std::round(0.5 * x); });
  CHECK(decision(test::bench_model(), r).empty());
  r = bench();
  const double air = r.column("ambient_C")[0];
  change(r, "ambient_C", [&](double) { return air; });
  change(r, "motor_C", [&](double) { return air; });
  change(r, "power_param", [](double x) { return x > 100.0 ? 2.0 : 0.0; });
  CHECK(decision(test::bench_model(), r).find("frozen_samples") == std::string::npos);
}

TEST_CASE("exchanged columns decide") {
  Recording r = axis();
  const Eigen::VectorXd angle = r.column("angle_deg");
  r.set("angle_deg", r.column("rate_dps"));
  r.set("rate_dps", angle);
  CHECK(decision(test::axis_model(), r) ==
        "swapped_columns(angle_deg) --column angle_deg=rate_dps --column rate_dps=angle_deg");
  r = bench();
  const Eigen::VectorXd motor = r.column("motor_C");
  r.set("motor_C", r.column("ambient_C"));
  r.set("ambient_C", motor);
  CHECK(decision(test::bench_model(), r) ==
        "swapped_columns(motor_C) --column motor_C=ambient_C --column ambient_C=motor_C");
}

TEST_CASE("loggers whose clocks differ are told, but do not decide") {
  Recording r = bench();
  r.set("current_A", shifted(r.column("current_A"), 5));
  CHECK_THAT(said(test::bench_model(), r),
             ContainsSubstring("clock_shift(current_A) follows power_param by 10 s (5 rows)"));
  CHECK(decision(test::bench_model(), r).empty());
  // In a loop the command follows the motion, and no clock is at fault.
  r = axis();
  r.set("drive_A", shifted(r.column("drive_A"), 4));
  CHECK_THAT(said(test::axis_model(), r), !ContainsSubstring("clock_shift"));
}

TEST_CASE("an experiment that can tell nothing decides") {
  const auto kinds = [](const Model& model, const std::vector<Recording>& train,
                        const std::vector<Recording>& held, double horizon_s = 0.5) {
    std::string text;
    for (const Finding& one :
         engine::check(model, train, held, {horizon_s, false}, standard_catalogue()).findings)
      if (one.severity == Severity::error) text += std::string(to_string(one.kind)) + " ";
    return text;
  };
  const Recording train = axis(), held = test::axis_recording({}, 2000, 7);
  CHECK(kinds(test::axis_model(), {train}, {held}).empty());
  CHECK(kinds(test::axis_model(), {train}, {held}, 0.005) == "sampled_too_slowly ");
  CHECK(kinds(test::axis_model(), {train}, {train}) == "held_out_in_training ");
  CHECK(kinds(test::axis_model(), {train}, {train.slice(1000, 2000)}) == "held_out_in_training ");
  CHECK(kinds(test::axis_model(), {train, train}, {held}) == "recording_given_twice ");
  Recording still = held;
  test::Noise noise(3);
  still.set("drive_A", Eigen::VectorXd::Zero(still.rows()));
  change(still, "rate_dps", [&](double) { return 0.15 * noise(); });
  change(still, "angle_deg", [&](double) { return 0.02 * noise(); });
  CHECK(kinds(test::axis_model(), {train}, {still}) == "held_out_not_excited ");
  CHECK(kinds(test::axis_model(), {still}, {held}) == "never_driven ");
}

TEST_CASE("a body that nothing drives is data where it cools or a neighbour warms it, and else is not") {
  const auto is_said = [](const Recording& train) {
    for (const Finding& one :
         engine::check(test::bench_model(), {train}, {bench()}, {0.5, false}, standard_catalogue()).findings)
      if (one.kind == FindingKind::never_driven) return true;
    return false;
  };
  Recording off = bench();
  off.set("power_param", Eigen::VectorXd::Zero(off.rows()));
  off.remove("current_A");
  const Eigen::ArrayXd away = Eigen::ArrayXd::LinSpaced(off.rows(), 0.0, 5.0);
  Recording cooling = off, warmed = off, alone = off;
  cooling.set("motor_C", 25.0 + 30.0 * (-away).exp());
  warmed.set("motor_C", 25.0 + 12.0 * (1.0 - (-away).exp()));
  alone = warmed;
  warmed.set("neighbour_C", 25.0 + 25.0 * (1.0 - (-2.0 * away).exp()));
  CHECK_FALSE(is_said(cooling));
  CHECK_FALSE(is_said(warmed));
  CHECK(is_said(alone));

  // Nor has what is held out to be driven: a body that cools by a part of what it warmed by says enough.
  const auto is_excited = [](const Recording& held_out) {
    for (const Finding& one :
         engine::check(test::bench_model(), {bench()}, {held_out}, {0.5, false}, standard_catalogue())
             .findings)
      if (one.kind == FindingKind::held_out_not_excited) return false;
    return true;
  };
  Recording little = off, still = off;
  little.set("motor_C", 25.0 + 4.0 * (-away).exp());
  still.set("motor_C", 25.0 + 0.01 * (-away).exp());
  CHECK(is_excited(little));
  CHECK_FALSE(is_excited(still));
}

TEST_CASE("an empty column is said to be empty") {
  Recording r = bench();
  r.set("airspeed_mps", Eigen::VectorXd::Constant(r.rows(), missing));
  CHECK_THAT(said(test::bench_model(), r), ContainsSubstring("empty_column(airspeed_mps)"));
  r.set("ambient_C", Eigen::VectorXd::Constant(r.rows(), missing));
  const engine::PreparedRecording prepared(test::bench_model(), r);
  REQUIRE_FALSE(prepared.inputs().not_judged.empty());
  CHECK(prepared.inputs().not_judged.front().sentence ==
        "the motor temperature is not judged: column ambient_C has no sample");
}
