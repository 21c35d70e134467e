// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Units, signs and exchanged columns of recordings that the simulation does not follow whatever their units: a joint whose
// friction takes half of the drive, and a motor whose case hides most of its heat.
#include "../../catch.hpp"
#include "rough_recordings.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/gap/units/clock_shift.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using test::cased_model;
using test::change;
using test::deg;
using test::fahrenheit;
using test::kelvin;
using test::rubbing_model;
using test::times;

namespace {

/// Friction of half its largest torque, every 5 ms.
Recording axis(unsigned seed = 1) {
  Recording r = test::recorded(test::RubbingAxis{seed});
  r.name = "axis " + std::to_string(seed);
  return r;
}

Recording bench(unsigned seed = 1) {
  Recording r = test::recorded(test::CasedMotor{seed});
  r.name = "bench " + std::to_string(seed);
  return r;
}

Recording exchanged(Recording r, const char* a, const char* b) {
  const Eigen::VectorXd kept = r.column(a);
  r.set(a, r.column(b));
  r.set(b, kept);
  return r;
}

/// What is said, but stops nothing.
std::vector<Finding> warnings(const Model& model, const Recording& r) {
  std::vector<Finding> list;
  for (const Finding& one : engine::check(model, {r}, {}, {}, standard_catalogue()).findings)
    if (one.severity == Severity::warning) list.push_back(one);
  return list;
}

std::vector<Finding> errors(const Model& model, const std::vector<Recording>& train,
                            const std::vector<Recording>& held = {}) {
  std::vector<Finding> list;
  for (const Finding& one : engine::check(model, train, held, {}, standard_catalogue()).findings)
    if (one.severity == Severity::error) list.push_back(one);
  return list;
}

/// Whether the first finding is the only one about units, and mends as it says.
std::string decision(const Model& model, const Recording& r) {
  std::string text;
  for (const Finding& one : errors(model, {r})) {
    if (one.kind != FindingKind::wrong_unit && one.kind != FindingKind::wrong_sign &&
        one.kind != FindingKind::swapped_columns && one.kind != FindingKind::impossible_samples)
      continue;
    text +=
        (text.empty() ? "" : "; ") + std::string(to_string(one.kind)) + "(" + one.column + ") " + one.mend;
  }
  return text;
}

struct Case {
  std::vector<std::pair<const char*, std::function<double(double)>>> as_recorded;
  const char* answer;
};

void check_cases(const Model& model, const Recording& sound, const std::vector<Case>& cases) {
  for (const Case& one : cases) {
    Recording r = sound;
    for (const auto& [column, f] : one.as_recorded) change(r, column, f);
    INFO(one.answer);
    CHECK(decision(model, r) == one.answer);
  }
}

}  // namespace

TEST_CASE("a large gap is no wrong unit") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    CHECK(errors(rubbing_model(), {axis(seed)}).empty());
    CHECK(errors(cased_model(), {bench(seed)}).empty());
  }
  // Nor are constants that are off by two, either way.
  for (const double factor : {0.5, 2.0}) {
    Model model = rubbing_model();
    model.axis->inertia_kgm2 *= factor;
    CHECK(errors(model, {axis()}).empty());
    model = cased_model();
    std::get<LumpedThermalModel>(model.thermal).heat_capacity_J_per_K *= factor;
    CHECK(errors(model, {bench()}).empty());
  }
  // A drive that passes a fifth of its command is near a sixth, but a rate in turns per minute would not be its angle's.
  Recording limited = axis();
  change(limited, "drive_A", times(5.0));
  CHECK(decision(rubbing_model(), limited).find("rpm") == std::string::npos);
}

TEST_CASE("a clock in another unit makes a body warm and cool by one factor; two factors are no clock") {
  Model model = cased_model();
  LumpedThermalModel& body = std::get<LumpedThermalModel>(model.thermal);
  body.heat_capacity_J_per_K *= 20.0;
  body.conductance_W_per_K /= 5.0;
  for (const Finding& one : errors(model, {bench()})) CHECK(one.column != "t_s");
}

TEST_CASE("a column that was lost for some seconds hides no unit of it, and makes none") {
  const char* const lost = GENERATE("angle_deg", "rate_dps");
  const auto with_a_hole = [&](Recording r) {
    Eigen::VectorXd column = r.column(lost);
    const Eigen::Index rows = column.size();
    column.segment(rows / 3, rows / 10).setConstant(missing);
    r.set(lost, column);
    return r;
  };
  INFO(lost);
  CHECK(decision(rubbing_model(), with_a_hole(axis())).empty());
  Recording limited = axis();
  change(limited, "drive_A", times(5.0));
  CHECK(decision(rubbing_model(), with_a_hole(limited)).find("rpm") == std::string::npos);
  Recording turning = axis();
  change(turning, "rate_dps", times(1.0 / 6.0));
  CHECK(decision(rubbing_model(), with_a_hole(turning)) ==
        "wrong_unit(rate_dps) --column rate_dps=rate_dps:rpm");
}

TEST_CASE("each unit of an axis is told where friction takes half of the drive") {
  const char* const drive = "drive_A";
  const char* const angle = "angle_deg";
  const char* const rate = "rate_dps";
  check_cases(rubbing_model(), axis(),
              {{{{drive, times(1e3)}}, "wrong_unit(drive_A) --column drive_A=drive_A:mA"},
               {{{drive, times(1e6)}}, "wrong_unit(drive_A) --column drive_A=drive_A:uA"},
               {{{drive, times(-1.0)}}, "wrong_sign(drive_A) --column drive_A=drive_A:-A"},
               {{{rate, times(1.0 / deg)}}, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rad/s"},
               {{{rate, times(1.0 / 6.0)}}, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rpm"},
               {{{rate, times(1.0 / 360.0)}}, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rev/s"},
               {{{rate, times(-1.0)}}, "wrong_sign(rate_dps) --column rate_dps=rate_dps:-deg/s"},
               {{{angle, times(-1.0)}}, "wrong_sign(angle_deg) --column angle_deg=angle_deg:-deg"},
               {{{angle, times(1.0 / deg)}, {rate, times(1.0 / deg)}},
                "wrong_unit(rate_dps) --column rate_dps=rate_dps:rad/s --column angle_deg=angle_deg:rad"},
               {{{angle, times(1.0 / 360.0)}, {rate, times(1.0 / 360.0)}},
                "wrong_unit(rate_dps) --column rate_dps=rate_dps:rev/s --column angle_deg=angle_deg:rev"},
               {{{angle, times(1.0 / deg)}, {rate, times(1.0 / 6.0)}},
                "wrong_unit(rate_dps) --column rate_dps=rate_dps:rpm --column angle_deg=angle_deg:rad"},
               {{{"t_s", times(1e3)}}, "wrong_unit(t_s) --column t_s=t_s:ms"},
               {{{"t_s", times(1e6)}}, "wrong_unit(t_s) --column t_s=t_s:us"},
               {{{"t_s", times(1e9)}}, "wrong_unit(t_s) --column t_s=t_s:ns"},
               {{{"t_s", times(1.0 / 60.0)}}, "wrong_unit(t_s) --column t_s=t_s:min"},
               {{{"t_s", times(1.0 / 3600.0)}}, "wrong_unit(t_s) --column t_s=t_s:h"}});
}

TEST_CASE("an axis with an angle alone, and one with a rate alone") {
  Recording alone = axis();
  alone.remove("rate_dps");
  CHECK(decision(rubbing_model(), alone).empty());
  check_cases(
      rubbing_model(), alone,
      {{{{"angle_deg", times(1.0 / deg)}}, "wrong_unit(angle_deg) --column angle_deg=angle_deg:rad"},
       {{{"angle_deg", times(1.0 / 360.0)}}, "wrong_unit(angle_deg) --column angle_deg=angle_deg:rev"},
       {{{"drive_A", times(1e3)}}, "wrong_unit(drive_A) --column drive_A=drive_A:mA"},
       {{{"t_s", times(1e3)}}, "wrong_unit(t_s) --column t_s=t_s:ms"}});
  alone = axis();
  alone.remove("angle_deg");
  CHECK(decision(rubbing_model(), alone).empty());
  check_cases(rubbing_model(), alone,
              {{{{"rate_dps", times(1.0 / deg)}}, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rad/s"},
               {{{"rate_dps", times(1.0 / 6.0)}}, "wrong_unit(rate_dps) --column rate_dps=rate_dps:rpm"},
               {{{"drive_A", times(1e3)}}, "wrong_unit(drive_A) --column drive_A=drive_A:mA"},
               {{{"t_s", times(1e3)}}, "wrong_unit(t_s) --column t_s=t_s:ms"}});
}

TEST_CASE(
    "an angle that is off by a factor beside a rate that is right is a cause, and hides no other mistake") {
  for (const double factor : {1.0 / deg, 1.0 / 360.0, 18.0, 0.4}) {
    Recording r = axis();
    change(r, "angle_deg", times(factor));
    CHECK(decision(rubbing_model(), r).empty());
    change(r, "drive_A", times(1e3));
    CHECK(decision(rubbing_model(), r) == "wrong_unit(drive_A) --column drive_A=drive_A:mA");
  }
}

TEST_CASE("a factor of the drive that is not a unit is said with the model's constants, and stops nothing") {
  Recording r = axis();
  change(r, "drive_A", times(100.0));
  CHECK(errors(rubbing_model(), {r}).empty());
  const std::vector<Finding> all = warnings(rubbing_model(), r);
  REQUIRE(all.size() == 1);
  CHECK_THAT(all.front().message, ContainsSubstring("inertia_kgm2") || ContainsSubstring("one factor"));
  CHECK(all.front().mend.find("--column") == std::string::npos);
}

TEST_CASE("exchanged columns of an axis are told by slopes") {
  CHECK(decision(rubbing_model(), exchanged(axis(), "angle_deg", "rate_dps")) ==
        "swapped_columns(angle_deg) --column angle_deg=rate_dps --column rate_dps=angle_deg");
  CHECK(decision(rubbing_model(), exchanged(axis(), "drive_A", "angle_deg")) ==
        "swapped_columns(drive_A) --column drive_A=angle_deg --column angle_deg=drive_A");
  CHECK(decision(rubbing_model(), exchanged(axis(), "drive_A", "rate_dps")) ==
        "swapped_columns(drive_A) --column drive_A=rate_dps --column rate_dps=drive_A");
}

TEST_CASE("each unit of a bench is told where its case hides heat") {
  check_cases(
      cased_model(), bench(),
      {{{{"current_A", times(1e3)}}, "wrong_unit(current_A) --column current_A=current_A:mA"},
       {{{"current_A", times(1e6)}}, "wrong_unit(current_A) --column current_A=current_A:uA"},
       {{{"current_A", times(-1.0)}}, "wrong_sign(current_A) --column current_A=current_A:-A"},
       {{{"supply_V", times(1e3)}}, "wrong_unit(supply_V) --column supply_V=supply_V:mV"},
       {{{"supply_V", times(-1.0)}}, "wrong_sign(supply_V) --column supply_V=supply_V:-V"},
       {{{"power_param", times(1.0 / 2.55)}}, "wrong_unit(power_param) --column power_param=power_param:%"},
       {{{"power_param", times(1.0 / 255.0)}}, "wrong_unit(power_param) --column power_param=power_param:1"},
       {{{"motor_C", fahrenheit}}, "wrong_unit(motor_C) --column motor_C=motor_C:degF"},
       {{{"motor_C", kelvin}}, "wrong_unit(motor_C) --column motor_C=motor_C:K"},
       {{{"motor_C", times(10.0)}}, "wrong_unit(motor_C) --column motor_C=motor_C:ddegC"},
       {{{"motor_C", times(1e3)}}, "wrong_unit(motor_C) --column motor_C=motor_C:mdegC"},
       {{{"ambient_C", fahrenheit}}, "wrong_unit(ambient_C) --column ambient_C=ambient_C:degF"},
       {{{"ambient_C", kelvin}}, "wrong_unit(ambient_C) --column ambient_C=ambient_C:K"},
       {{{"motor_C", fahrenheit}, {"ambient_C", fahrenheit}},
        "wrong_unit(motor_C) --column motor_C=motor_C:degF --column ambient_C=ambient_C:degF"},
       {{{"t_s", times(1e3)}}, "wrong_unit(t_s) --column t_s=t_s:ms"},
       {{{"t_s", times(1e6)}}, "wrong_unit(t_s) --column t_s=t_s:us"},
       {{{"t_s", times(1e9)}}, "wrong_unit(t_s) --column t_s=t_s:ns"},
       {{{"t_s", times(1.0 / 60.0)}}, "wrong_unit(t_s) --column t_s=t_s:min"},
       {{{"t_s", times(1.0 / 3600.0)}}, "wrong_unit(t_s) --column t_s=t_s:h"}});
}

TEST_CASE("exchanged columns of a bench are told by the current") {
  const auto told = [](const char* a, const char* b) {
    // A power is no smaller than 0: the noise of a current without any goes with it.
    Recording r = bench();
    change(r, "current_A", [](double x) { return std::abs(x); });
    return decision(cased_model(), exchanged(r, a, b));
  };
  const auto expected = [](const std::string& a, const std::string& b) {
    return "swapped_columns(" + a + ") --column " + a + "=" + b + " --column " + b + "=" + a;
  };
  CHECK(told("power_param", "current_A") == expected("power_param", "current_A"));
  CHECK(told("power_param", "motor_C") == expected("power_param", "motor_C"));
  CHECK(told("current_A", "motor_C") == expected("current_A", "motor_C"));
  CHECK(told("current_A", "supply_V") == expected("current_A", "supply_V"));
  CHECK(told("motor_C", "supply_V") == expected("motor_C", "supply_V"));
}

TEST_CASE("a heat capacity that is off by a thousand is no unit of time that no logger has") {
  // Every 2 s as milliseconds would be 500 rows a second, and as microseconds more.
  Model model = cased_model();
  auto& body = std::get<LumpedThermalModel>(model.thermal);
  body.heat_capacity_J_per_K /= 1e3;
  CHECK(errors(model, {bench()}).empty());
  const std::vector<Finding> all = warnings(model, bench());
  REQUIRE_FALSE(all.empty());
  CHECK_THAT(all.front().message, ContainsSubstring("heat_capacity_J_per_K"));
  CHECK(all.front().mend.find("--column") == std::string::npos);
}

TEST_CASE("tenths of a degree are told from kelvin by the air, and without it by whole numbers") {
  // A motor that has been driven all along: 408 is 41 degC, and no 135.
  Recording hot = bench();
  change(hot, "motor_C", [](double x) { return std::round(10.0 * (40.8 + 0.1 * (x - 23.0))); });
  CHECK(decision(cased_model(), hot) == "wrong_unit(motor_C) --column motor_C=motor_C:ddegC");
  Recording whole = bench();
  change(whole, "motor_C", [](double x) { return std::round(kelvin(x)); });
  CHECK(decision(cased_model(), whole) == "wrong_unit(motor_C) --column motor_C=motor_C:K");
  // A joint's simulation does not use the temperature: nothing is stopped.
  Recording joint = axis();
  joint.set("motor_C", Eigen::VectorXd::Constant(joint.rows(), 286.0));
  CHECK(errors(rubbing_model(), {joint}).empty());
  REQUIRE_FALSE(warnings(rubbing_model(), joint).empty());
  CHECK(warnings(rubbing_model(), joint).front().mend == "--column motor_C=motor_C:ddegC");
  joint.set("motor_C", Eigen::VectorXd::Constant(joint.rows(), kelvin(28.6)));
  REQUIRE_FALSE(warnings(rubbing_model(), joint).empty());
  CHECK(warnings(rubbing_model(), joint).front().mend == "--column motor_C=motor_C:K");
}

TEST_CASE("a temperature that none can be decides, as after a mend that was none") {
  Recording r = bench();
  change(r, "motor_C", [](double x) { return x - 273.15; });
  const std::vector<Finding> all = errors(cased_model(), {r});
  REQUIRE_FALSE(all.empty());
  CHECK(all.front().kind == FindingKind::impossible_samples);
  CHECK(all.front().column == "motor_C");
}

TEST_CASE("recordings that are given together tell which one is in another unit") {
  Recording wrong = bench(2);
  change(wrong, "ambient_C", fahrenheit);
  for (const bool held : {false, true}) {
    const std::vector<Finding> all =
        held ? errors(cased_model(), {bench(1)}, {wrong}) : errors(cased_model(), {wrong}, {bench(1)});
    REQUIRE_FALSE(all.empty());
    CHECK(all.front().recording == "bench 2");
    CHECK(all.front().mend == "--column ambient_C=ambient_C:degF");
    CHECK_THAT(all.front().message, ContainsSubstring("this file alone"));
  }
  // Rows that tell nothing of heat: the air of the others does.
  Recording idle = bench(3).slice(0, 40);
  change(idle, "power_param", times(0.0));
  change(idle, "motor_C", [](double) { return 22.0; });
  idle.remove("current_A");
  for (const char* column : {"motor_C", "ambient_C"}) change(idle, column, fahrenheit);
  const std::vector<Finding> all = errors(cased_model(), {bench(1), idle});
  REQUIRE_FALSE(all.empty());
  CHECK(all.front().recording == "bench 3");
  CHECK_THAT(all.front().mend, ContainsSubstring("ambient_C=ambient_C:degF"));
}
