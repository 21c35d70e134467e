// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include "atomic_file.hpp"
#include "header_export.hpp"
#include "report_html.hpp"
#include "report_json.hpp"
#include "summary.hpp"
#include "svg_chart.hpp"

#include <thermopower/gap/recording.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace thermopower::gap;

namespace {

Diagnosis example() {
  Diagnosis d;
  d.verdict = Verdict::ambiguous;
  d.reason = "two explanations fit";
  d.where.push_back({Signal::motor_C, thermopower::plant::Submodel::thermal_loss, 0.83,
                     Regime{"rise_K", 12.0, 40.0}, "given the heat"});
  d.where.push_back(
      {Signal::current_A, thermopower::plant::Submodel::electrical, 0.1, std::nullopt, "given the voltage"});
  d.cause.push_back({"radiation", 0.61, {{"emissive_area_m2", 0.1 + 0.2, {0.25, missing}, "m^2"}}});
  d.alternatives = {{"natural_convection"}, {"ambient_bias", "series_resistance"}};
  d.gap.push_back({Signal::motor_C, "degC", std::nullopt, 4.4, 1.2, 0.14, 0.12, 0.968, {0.96, 0.98}});
  d.gap.push_back({Signal::rate_dps, "deg/s", 0.5, 3.0, 2.0, 0.3, 0.2, 0.9, {0.88, 0.92}});
  d.next_experiment = "heat <hard> & wait";
  d.not_judged = {"angle_deg: not recorded"};
  d.findings.push_back({FindingKind::coarse_quantum, Severity::note, "a.csv", "motor_C", "steps of 0.1"});
  d.ranking.push_back({{"radiation"},
                       0.61,
                       1.0,
                       0.0,
                       0.1,
                       false,
                       false,
                       false,
                       d.cause[0].parameters,
                       {{{"natural_convection"}, 0.97}}});
  d.constants.push_back({"conductance", 0.11, 0.112});
  SignalSeries series;
  series.signal = Signal::motor_C;
  series.unit = "degC";
  const Eigen::Index n = 300000;
  series.t_s = Eigen::VectorXd::LinSpaced(n, 0.0, 3000.0);
  series.measured = series.t_s.array().sin();
  series.measured[123456] = 500.0;
  series.measured[7] = missing;
  series.baseline = series.recalibrated = series.augmented = series.measured;
  d.series.push_back(series);
  return d;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE(
    "the JSON report has the keys of its format, in their order, and numbers that read back bit by bit") {
  const std::string text = files::report_json(example());
  const auto json = nlohmann::ordered_json::parse(text);
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  const std::vector<std::string> first = {"format",       "verdict", "where",          "cause",
                                          "alternatives", "gap",     "next_experiment"};
  CHECK(std::vector<std::string>(keys.begin(), keys.begin() + 7) == first);
  CHECK(json["format"] == "thermopower-gap-report/1");
  CHECK(json["verdict"] == "ambiguous");
  CHECK(json["where"][0]["regime"]["variable"] == "rise_K");
  CHECK(json["where"][1]["regime"].is_null());
  CHECK(json["cause"][0]["parameters"]["emissive_area_m2"]["value"].get<double>() == 0.1 + 0.2);
  CHECK(json["cause"][0]["parameters"]["emissive_area_m2"]["ci95"][1].is_null());
  CHECK(json["alternatives"][1] == std::vector<std::string>{"ambient_bias", "series_resistance"});
  CHECK(json["gap"]["motor_C"]["horizon_s"].is_null());
  CHECK(json["gap"]["rate_dps"]["horizon_s"] == 0.5);
  for (const char* key : {"unit", "before", "recalibrated", "after", "noise_floor", "shrunk_by", "ci95"})
    CHECK(json["gap"]["motor_C"].contains(key));
  CHECK(json["not_judged"][0] == "angle_deg: not recorded");
  CHECK(text == files::report_json(example()));
}

TEST_CASE("a report survives names that are no UTF-8") {
  Diagnosis d = example();
  d.findings[0].recording = "\xff\xfe<b>.csv";
  CHECK_NOTHROW(nlohmann::json::parse(files::report_json(d)));
  const std::string html = files::report_html(d, "\xff<script>", {});
  CHECK_THAT(html,
             !ContainsSubstring("\xff") && !ContainsSubstring("<script") && !ContainsSubstring("<b>.csv"));
}

TEST_CASE("the HTML report is one file without external resource or script, under a megabyte") {
  const std::string html = files::report_html(example(), "motor", {});
  CHECK(html.size() < 1000000);
  for (const char* forbidden : {"http://", "https://", "src=", "<script", "<link", "@import", "url("})
    CHECK_THAT(html, !ContainsSubstring(forbidden));
  for (const char* needed : {"<svg", "prefers-color-scheme:dark", "@media print", "thermal.loss", "radiation",
                             "natural_convection", "steps of 0.1", "heat &lt;hard&gt; &amp; wait",
                             "angle_deg: not recorded", "noise floor", "\u00b0C"}) {
    CAPTURE(needed);
    CHECK_THAT(html, ContainsSubstring(needed));
  }
}

TEST_CASE("a thinned curve keeps its highest peak") {
  files::Chart chart;
  files::Series series{"x", "measured", files::Series::Style::line, {}, {}, {}, {}};
  for (int i = 0; i < 100000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 54321 ? 100.0 : 0.0);
  }
  chart.series.push_back(series);
  const std::string svg = files::to_svg(chart);
  CHECK(svg.size() < 60000);
  const double x = 58.0 + 54321.0 / 99999.0 * (860 - 14 - 58);
  char point[32];
  std::snprintf(point, sizeof point, "%.1f ", x);
  CHECK_THAT(svg, ContainsSubstring(point));
}

TEST_CASE("charts of nothing, of one point and of NaN are pictures all the same") {
  for (const auto& values :
       std::vector<std::vector<double>>{{}, {1.0}, {missing, missing}, {1e300, -1e300}, {5.0, 5.0}}) {
    files::Chart chart;
    chart.series.push_back({"x", "measured", files::Series::Style::line, values, values, {}, {}});
    const std::string svg = files::to_svg(chart);
    CHECK_THAT(svg, ContainsSubstring("</svg>") && !ContainsSubstring("nan") && !ContainsSubstring("inf"));
  }
}

TEST_CASE("the summary says verdict, where, which, what else, how far and what next") {
  const std::string text = files::summary(example());
  for (const char* part : {"AMBIGUOUS", "motor_C, thermal.loss (83 % of the gap)", "rise_K 12.0 to 40.0",
                           "radiation (61 %)", "natural_convection; ambient_bias + series_resistance", "4.40",
                           "0.140", "97 % [96.0, 98.0]", "heat <hard> & wait", "angle_deg: not recorded"}) {
    CAPTURE(part);
    CHECK_THAT(text, ContainsSubstring(part));
  }
}

TEST_CASE("outputs appear together and complete, or not at all") {
  const auto folder = std::filesystem::temp_directory_path() / "thermopower_outputs";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  files::OutputFiles outputs;
  outputs.expect((folder / "a").string());
  CHECK(std::filesystem::is_empty(folder));
  outputs.put((folder / "a").string(), "first");
  outputs.put((folder / "no such folder" / "b").string(), "second");
  CHECK_THROWS_AS(outputs.commit(), files::OutputError);
  CHECK(std::filesystem::is_empty(folder));
  files::OutputFiles fine;
  fine.put((folder / "a").string(), "first");
  fine.put((folder / "b").string(), std::string("second\0", 7));
  fine.commit();
  CHECK(text_of(folder / "a") == "first");
  CHECK(text_of(folder / "b") == std::string("second\0", 7));
  CHECK_THROWS_AS(files::OutputFiles().expect((folder / "no such folder" / "b").string()),
                  files::OutputError);
  CHECK_THROWS_AS(files::OutputFiles().expect(folder.string()), files::OutputError);
  std::filesystem::remove_all(folder);
}

TEST_CASE("a header holds the equation of every effect of the catalogue, and lists what it has none for") {
  Model model;
  model.name = "two\nlines */";
  model.current = OhmicCurrentModel{};
  model.thermal = LumpedThermalModel{};
  model.effects["natural_convection"] = {{"exponent", 0.25}, {"reference_K", 20.0}};
  model.effects["dead_time"] = {{"duty_lost", 0.02}};
  model.effects["my own/effect"] = {{"a b", 2.0}};
  const files::MotorModelHeader header = files::motor_model_header(model, "origin");
  CHECK_THAT(header.text, ContainsSubstring("struct Cooling") && ContainsSubstring("/ 20.0f, 0.25f)"));
  CHECK_THAT(header.text, ContainsSubstring("duty - 0.02f"));
  CHECK_THAT(header.text, ContainsSubstring("static float my_own_effect_a_b() { return 2.0f; }"));
  CHECK_THAT(header.text, ContainsSubstring("// Left out: my own/effect: "));
  REQUIRE(header.left_out.size() == 1);
  CHECK_THAT(header.left_out[0], ContainsSubstring("my own/effect"));
}
