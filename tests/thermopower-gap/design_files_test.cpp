// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "input_error_of.hpp"

#include <thermopower/io/design_files.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <string>

namespace design = thermopower::design;
namespace gap = thermopower::gap;
namespace io = thermopower::io;

namespace {

const char* const good = R"({
  "format": "thermopower-limits/1",
  "duration_s": 20,
  "row_s": 0.01,
  "vary": {"drive_A": {"from": -1, "to": 1, "slope_per_s": 50}, "motor_C": {"from": 22, "to": 60, "once": true}},
  "hold": {"supply_V": 12},
  "start": {"angle_deg": 5},
  "angle_deg": [-90, 80],
  "rate_dps": 300,
  "temperature_C": 70
})";

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const auto at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), with);
}

std::string problem(const std::string& text) {
  return test::input_error_of([&] { io::parse_limits("limits.json", text); });
}

gap::Model axis() {
  gap::Model model;
  model.name = "axis";
  model.axis = gap::RigidAxisModel{1e-3, 1e-3, 0.1};
  return model;
}

gap::Diagnosis diagnosis() {
  gap::Diagnosis one;
  one.verdict = gap::Verdict::ambiguous;
  gap::RankedExplanation curve;
  curve.effects = {"unknown.load(angle_deg)"};
  curve.probability = 0.25;
  curve.held_out_ratio = 0.125;
  curve.fitted = {{"calibration.inertia", 0.0625, true, false}, {"calibration.viscous", -0.5, true, true}};
  curve.covariance = Eigen::MatrixXd(2, 2);
  curve.covariance << 0.25, -0.125, -0.125, 0.5;
  curve.fixed = {{"unknown.load(angle_deg).from_deg", -40.0, false, false}};
  one.ranking = {curve};
  gap::GapScore score;
  score.signal = gap::Signal::rate_dps;
  score.horizon_s = 0.25;
  score.noise_floor = 0.375;
  one.gap = {score};
  return one;
}

}  // namespace

TEST_CASE("Limits are read as they are written") {
  const design::Limits limits = io::parse_limits("limits.json", good);
  CHECK(limits.duration_s == 20.0);
  REQUIRE(limits.vary.size() == 2);
  CHECK(limits.vary[0].slope_per_s == 50.0);
  CHECK(limits.vary[1].once);
  CHECK(limits.angle_deg.low == -90.0);
  CHECK(limits.angle_deg.high == 80.0);
  CHECK(limits.rate_dps.low == -300.0);
  CHECK(!limits.current_A.any());
  CHECK(limits.temperature_C.high == 70.0);
}

TEST_CASE("A wrong file of limits is refused with file, field and what was expected") {
  CHECK_THAT(problem("{"), ContainsSubstring("limits.json: not JSON"));
  CHECK_THAT(problem("[]"), ContainsSubstring("expected an object"));
  CHECK_THAT(problem("{}"), ContainsSubstring("/format: is missing"));
  CHECK_THAT(problem(replaced(good, "limits/1", "limits/9")),
             ContainsSubstring("/format: is \"thermopower-limits/9\""));
  CHECK_THAT(problem(replaced(good, "\"duration_s\": 20", "\"duration_s\": \"long\"")),
             ContainsSubstring("/duration_s: is \"long\"; expected a number (line 3)"));
  CHECK_THAT(problem(replaced(good, "\"duration_s\": 20", "\"duration_s\": -2")),
             ContainsSubstring("duration_s is -2; expected"));
  CHECK_THAT(problem(replaced(good, "\"duration_s\"", "\"durations\"")),
             ContainsSubstring("/durations: unknown key; expected one of"));
  CHECK_THAT(problem(replaced(good, "\"from\": -1, ", "")),
             ContainsSubstring("/vary/drive_A/from: is missing; expected a number (line 5)"));
  CHECK_THAT(problem(replaced(good, "\"drive_A\"", "\"drive_mA\"")),
             ContainsSubstring("vary.drive_mA is not an input"));
  CHECK_THAT(problem(replaced(good, "true", "1")),
             ContainsSubstring("/vary/motor_C/once: is 1; expected true or false"));
  CHECK_THAT(problem(replaced(good, "[-90, 80]", "[-90]")),
             ContainsSubstring("/angle_deg: is [-90]; expected two numbers"));
  CHECK_THAT(problem(replaced(good, "300", "-300")),
             ContainsSubstring("/rate_dps: is -300; expected a number above 0"));
}

TEST_CASE("A report gives back the model and the explanations that were written into it") {
  const gap::Diagnosis written = diagnosis();
  const auto read = io::parse_report("r.json", io::report_json(written, axis()), gap::standard_catalogue());
  CHECK(io::to_json(read.model) == io::to_json(axis()));
  CHECK(read.verdict == written.verdict);
  CHECK(read.horizon_s == 0.25);
  REQUIRE(read.watched.size() == 1);
  CHECK(read.watched[0].signal == gap::Signal::rate_dps);
  CHECK(read.watched[0].noise == 0.375);
  REQUIRE(read.ranking.size() == 1);
  const auto &one = read.ranking[0], &other = written.ranking[0];
  CHECK(one.effects == other.effects);
  CHECK(one.probability == other.probability);
  CHECK(one.held_out_ratio == other.held_out_ratio);
  CHECK(one.covariance == other.covariance);
  REQUIRE(one.fitted.size() == 2);
  CHECK(one.fitted[1].name == "calibration.viscous");
  CHECK(one.fitted[1].at == -0.5);
  CHECK(one.fitted[1].at_bound);
  REQUIRE(one.fixed.size() == 1);
  CHECK(one.fixed[0].at == -40.0);
}

TEST_CASE("What is no report, or an old one, is refused with what to do") {
  const auto refused = [](const std::string& text) {
    return test::input_error_of([&] { io::parse_report("r.json", text, gap::standard_catalogue()); });
  };
  CHECK_THAT(refused("{\"format\": \"thermopower-model/1\"}"),
             ContainsSubstring("expected \"thermopower-gap-report/1\""));
  CHECK_THAT(refused(io::report_json(diagnosis())), ContainsSubstring("/model: is missing"));
  CHECK_THAT(refused(io::report_json(diagnosis())), ContainsSubstring("run diagnose --report again"));
}

TEST_CASE("The header of a schedule holds the schedule to half of its unit") {
  design::Limits limits = io::parse_limits("limits.json", good);
  design::Design design;
  design.schedule.t_s = Eigen::Vector3d(0.0, 0.01, 0.02);
  design.schedule.set("drive_A", Eigen::Vector3d(-0.5, 0.25, 0.0));
  design.schedule.set("motor_C", Eigen::Vector3d(40.0, 40.0, 40.0));
  const std::string header = io::schedule_header(design, limits);
  CHECK_THAT(header, ContainsSubstring("schedule_rows = 3, schedule_inputs = 1"));
  CHECK_THAT(header, ContainsSubstring("{-32767}, {16384}, {0}"));
  CHECK_THAT(header, ContainsSubstring("motor_C = 40"));
  CHECK(io::schedule_csv(design) == "t_s,drive_A,motor_C\n0,-0.5,40\n0.01,0.25,40\n0.02,0,40\n");
}
