// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "../catch.hpp"

#include <thermopower/io/sentences.hpp>
#include <thermopower/io/output_files.hpp>
#include "chart.hpp"
#include "html_text.hpp"
#include <thermopower/io/header_export.hpp>
#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>
#include "residual_statistics.hpp"
#include <thermopower/io/summary.hpp>

#include <thermopower/gap/where/localisation.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include "../gap/plants.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <sstream>

using namespace thermopower::gap;
namespace io = thermopower::io;

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
  d.gap.push_back({Signal::motor_C, "degC", std::nullopt, 4.4, 1.2, 0.14, 0.12, 1.0, 0.968, {0.96, 0.98}});
  d.gap.push_back({Signal::rate_dps, "deg/s", 0.5, 3.0, 2.0, 0.3, 0.2, 1.0, 0.9, {0.88, 0.92}});
  d.next_experiment = "heat <hard> & wait";
  d.not_judged = {"angle_deg: not recorded"};
  d.findings.push_back({FindingKind::coarse_quantum, Severity::note, "a.csv", "motor_C", "steps of 0.1"});
  d.ranking.push_back({{"radiation"},
                       0.61,
                       1.0,
                       0.0,
                       0.1,
                       Lacks::nothing,
                       d.cause[0].parameters,
                       {{{"natural_convection"}, 0.97}},
                       0.0,
                       0.0,
                       0,
                       {},
                       {}});
  d.constants.push_back({"conductance", 0.11, 0.112, {0.1, 0.12}});
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

// Four runs that all begin at 0, with errors of 1 to 4 K as configured.
std::pair<Diagnosis, std::vector<Recording>> four_runs() {
  Diagnosis d = example();
  Recording recording;
  recording.name = "logs/drive.csv";
  const Eigen::Index rows = 400;
  recording.t_s.resize(rows);
  Eigen::VectorXd power(rows), supply(rows), measured(rows), error(rows);
  const char* const names[] = {"left", "right", "up", "down"};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = static_cast<double>(i % 100);
    recording.t_s[i] = t;
    power[i] = t < 50 ? 200.0 : 0.0;
    supply[i] = 12.0 - 0.01 * t;
    measured[i] = 30.0 + 0.2 * t;
    error[i] = 1.0 + static_cast<double>(i / 100);
  }
  for (int k = 0; k < 4; ++k) recording.runs.push_back({100 * k, 100 * (k + 1), names[k]});
  recording.set("power_param", power);
  recording.set("supply_V", supply);
  recording.set("ambient_C", Eigen::VectorXd::Constant(rows, 20.0));
  recording.set("motor_C", measured);
  d.series.clear();
  d.series.push_back({Signal::motor_C, "degC", recording.name, recording.t_s, measured, measured + error,
                      measured + 0.5 * error, measured});
  d.series[0].rivals.push_back({{"natural_convection"}, measured + 0.25 * error});
  d.ranking.push_back(
      {{"natural_convection"}, 0.3, 1.0, 2.0, 0.2, Lacks::nothing, {}, {}, 0.0, 0.0, 0, {}, {}});
  d.gap.resize(1);
  d.correlation.names = {"conductance.scale", "radiation.emissive_area_m2", "heat_capacity.scale"};
  d.correlation.of.resize(3, 3);
  d.correlation.of << 1.0, -0.97, missing, -0.97, 1.0, 0.25, missing, 0.25, 1.0;
  return {d, {recording}};
}

std::size_t occurrences_of(const std::string& what, const std::string& text) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

// The corners of the first path of that class: "M x y", then "l dx dy dx dy ...".
std::vector<std::pair<long, long>> points_of(const std::string& html, const std::string& role) {
  const std::string head = "<path class=\"" + role + "\" d=\"";
  const std::size_t svg = html.find("class=\"plot\"");
  const std::size_t begin = html.find(head, svg) + head.size();
  std::string text = html.substr(begin, html.find('"', begin) - begin);
  std::vector<std::pair<long, long>> points;
  long x = 0, y = 0, dx = 0, dy = 0;
  for (char& one : text)
    if (one == 'l') one = ' ';
  std::istringstream pieces(text);
  std::string piece;
  while (std::getline(pieces, piece, 'M')) {
    if (piece.empty()) continue;
    std::istringstream in(piece);
    in >> x >> y;
    points.emplace_back(x, y);
    while (in >> dx >> dy) points.emplace_back(x += dx, y += dy);
  }
  return points;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE(
    "the JSON report has the keys of its format, in their order, and numbers that read back bit by bit") {
  const std::string text = io::report_json(example());
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
  CHECK(text == io::report_json(example()));
}

TEST_CASE(
    "where the interval of the shrinkage reaches below 0, the page says what the proof rests on instead") {
  Diagnosis d = example();
  REQUIRE_FALSE(d.cause.empty());
  const char* const sentence = "The interval reaches below 0";
  for (GapScore& gap : d.gap) gap.ci95 = {0.1, 0.4};
  CHECK_THAT(io::report_html(d, "motor", {}), !ContainsSubstring(sentence));
  for (GapScore& gap : d.gap) gap.ci95 = {-0.1, 0.4};
  CHECK_THAT(io::report_html(d, "motor", {}), ContainsSubstring(sentence));
}

TEST_CASE("a report survives names that are no UTF-8") {
  Diagnosis d = example();
  d.findings[0].recording = "\xff\xfe<b>.csv";
  // Units come from files, too: of a plant of one's own.
  for (GapScore& gap : d.gap) gap.unit = "\xff<i>m</i>";
  for (Cause& cause : d.cause)
    for (ParameterEstimate& parameter : cause.parameters) parameter.unit = "<i>s</i>";
  CHECK_NOTHROW(nlohmann::json::parse(io::report_json(d)));
  const std::string html = io::report_html(d, "\xff<script>alert(1)</script>", {});
  CHECK_THAT(html, !ContainsSubstring("\xff") && !ContainsSubstring("<script>alert") &&
                       !ContainsSubstring("<b>.csv") && !ContainsSubstring("<i>"));
}

TEST_CASE(
    "what is no UTF-8 is replaced, byte by byte, and what is stays: the ends of each range of RFC 3629") {
  for (const char* good : {"\x7f", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
                           "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    CHECK(io::escaped(good) == good);
  const std::string replaced = "\xef\xbf\xbd";
  // Longer than need be, halves of pairs, beyond the last, cut off, alone.
  for (const char* bad :
       {"\xc0\xaf", "\xc1\xbf", "\xe0\x9f\xbf", "\xe0\x80\x8b", "\xed\xa0\x80", "\xed\xbf\xbf",
        "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xe2\x82", "\x80", "\xff"}) {
    std::string expected;
    for (const char* byte = bad; *byte != '\0'; ++byte) expected += replaced;
    CHECK(io::escaped(bad) == expected);
  }
}

TEST_CASE("the HTML report is one file that asks for nothing, small besides its curves") {
  const std::string html = io::report_html(example(), "motor", {});
  CHECK(html.size() < 1000000);
  for (const char* forbidden : {"http://", "https://", "src=", "<link", "@import", "url(", "fetch(",
                                "XMLHttpRequest", "import(", "localStorage", "eval("})
    CHECK_THAT(html, !ContainsSubstring(forbidden));
  CHECK(occurrences_of("<script", html) == 1);
  for (const char* needed :
       {"<svg", "prefers-color-scheme:dark", "@media print", "thermal.<wbr>loss", "radiation",
        "natural_<wbr>convection", "steps of 0.1", "heat &lt;hard&gt; &amp; wait", "angle_deg: not recorded",
        "noise floor", "\u00b0C"}) {
    CAPTURE(needed);
    CHECK_THAT(html, ContainsSubstring(needed));
  }
  Diagnosis bare = example();
  bare.series.clear();
  CHECK(io::report_html(bare, "motor", {}).size() < 100000);
}

TEST_CASE("the page tells findings first, with what mends them, and where a fault shows") {
  Diagnosis d = example();
  d.findings.push_back({FindingKind::spiked_samples,
                        Severity::warning,
                        "dir/b.csv",
                        "motor_C",
                        "4 samples stand apart",
                        "shield the <cable>",
                        FindingAction::masked,
                        {{3, 5}, {9, 11}}});
  d.findings.push_back(d.findings.back());
  d.findings.back().recording = "dir/c.csv";
  d.where[0].only_in = {{"dir/b.csv", "second", true, 127.0}, {"dir/c.csv", "", false, std::nullopt}};
  d.remaining = Remaining{Signal::motor_C, 0.4, 7.5, std::nullopt, std::nullopt, "errors stay alike for 3 s"};
  const std::string html = io::report_html(d, "motor", {});
  const std::size_t finding = html.find("4 samples stand apart");
  REQUIRE(finding != std::string::npos);
  CHECK(finding < html.find("class=\"facts\""));
  CHECK(html.find("4 samples stand apart", finding + 1) == std::string::npos);  // once for both recordings
  CHECK_THAT(html, ContainsSubstring("dir/<wbr>b.<wbr>csv, dir/<wbr>c.<wbr>csv") &&
                       ContainsSubstring("Counted as missing: 4 rows") &&
                       ContainsSubstring("shield the &lt;cable&gt;") && ContainsSubstring("What remains") &&
                       ContainsSubstring("7.50 times its noise floor"));
  CHECK_THAT(html,
             ContainsSubstring("Only in b.<wbr>csv, run second (held out), from 127\u00a0s on; c.<wbr>csv"));
  CHECK(finding < html.find("steps of 0.1"));  // notes can wait
}

TEST_CASE("runs are told apart by their names, with what drove them, also where their stamps overlap") {
  const auto [d, held_out] = four_runs();
  const std::string html = io::report_html(d, "motor", {}, held_out);
  for (const char* title :
       {"drive.<wbr>csv, run left", "drive.<wbr>csv, run right", "drive.<wbr>csv, run up"})
    CHECK_THAT(html, ContainsSubstring(std::string("<h3>") + title + "</h3>"));
  CHECK_THAT(html, ContainsSubstring("input: power (0 to 255)") && ContainsSubstring("supply voltage / V"));
  CHECK_THAT(html, !ContainsSubstring("air temperature"));  // stands still
  // Each run has an error of its own: 1, 2, 3 and 4 K, then nothing.
  for (const char* row : {">1.00 \u2192 0<", ">2.00 \u2192 0<", ">3.00 \u2192 0<", ">4.00 \u2192 0<"})
    CHECK_THAT(html, ContainsSubstring(row));
  // Without the recordings a run begins where stamps fall.
  CHECK_THAT(io::report_html(d, "motor", {}), ContainsSubstring("drive.<wbr>csv, run 3"));
}

TEST_CASE("whatever a balance of the library's plants may be drawn against has words and a unit") {
  const auto check = [](const std::string& name) {
    CAPTURE(name);
    CHECK(io::variable_text(name).in_words);
    CHECK_FALSE(io::variable_text(name).unit.empty());
  };
  int variables = 0;
  const std::vector<Recording> recordings[] = {{test::bench_recording({}, 400, 3)},
                                               {test::axis_recording({}, 400, 3)}};
  const Model models[] = {test::bench_model(), test::axis_model()};
  for (int i = 0; i < 2; ++i) {
    const engine::RecordedBalances balances(models[i], recordings[i], standard_catalogue());
    REQUIRE_FALSE(balances.sources().empty());
    for (const auto& source : balances.sources())
      for (const auto& one :
           source.make(thermopower::plant::ReadingOffsets(thermopower::plant::actuator_signal_count, 0.0))
               .variables) {
        check(one.name);
        ++variables;
      }
  }
  CHECK(variables > 12);
  // What an axis is commanded by, and its change.
  for (const char* name :
       {"drive_A", "servo_A", "voltage_V", "drive_A_per_s", "servo_A_per_s", "voltage_V_per_s"})
    check(name);
}

TEST_CASE(
    "the missing quantity is drawn as points with their intervals, and the effect as a line of its own places") {
  Diagnosis d = four_runs().first;
  MissingQuantity q;
  q.signal = Signal::motor_C;
  q.quantity = thermopower::plant::QuantityName("missing heat");
  q.unit = "W";
  q.variable = "motor_C";
  q.variable_unit = "degC";
  q.x = Eigen::VectorXd::LinSpaced(5, 20.0, 60.0);
  q.value = Eigen::VectorXd::LinSpaced(5, 0.0, 4.0);
  q.spread = Eigen::VectorXd::Constant(5, 0.5);
  q.effect_x = Eigen::VectorXd::LinSpaced(201, 20.0, 60.0);
  q.effect = (q.effect_x.array() - 20.0).square() / 400.0;
  q.effect_freedom = 3.14;
  d.missing_quantities = {q};
  const std::string html = io::report_html(d, "motor", {});
  const std::string picture = html.substr(html.find("<h2>The missing quantity</h2>"));
  CHECK_THAT(picture,
             ContainsSubstring("missing heat / W") && ContainsSubstring("motor temperature / \u00b0C"));
  CHECK_THAT(picture, ContainsSubstring("The curve is a smoothing spline with 3.1 degrees of freedom."));
  CHECK(occurrences_of(
            "h0", picture.substr(picture.find("dots missing", picture.find("class=\"plot\"")), 400)) >= 5);
  // From 20 to 60 degC and 2 % more on both ends over the width; 0 to 4 W and the intervals of 0.98 W, and 6 % more on both ends, over the height.
  const auto line = points_of(picture, "curve effect");
  REQUIRE(line.size() == 201);
  const double top = 4.98 + 0.06 * 5.96, height = 5.96 * 1.12;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double share = static_cast<double>(i) / 200.0, watts = 4.0 * share * share;
    CHECK(static_cast<double>(line[i].first) == Approx(100000.0 * (0.02 + share) / 1.04).margin(1.0));
    CHECK(static_cast<double>(line[i].second) == Approx(10000.0 * (top - watts) / height).margin(1.0));
  }
  // Without a cause there is nothing to draw through the points.
  d.missing_quantities[0].effect_x.resize(0);
  d.missing_quantities[0].effect.resize(0);
  const std::string alone = io::report_html(d, "motor", {});
  CHECK_THAT(alone, ContainsSubstring("<h2>The missing quantity</h2>") &&
                        !ContainsSubstring("smoothing spline") &&
                        !ContainsSubstring("class=\"curve effect\""));
}

TEST_CASE("a thinned curve keeps its highest peak, in its place") {
  io::Chart chart;
  io::Series series{"x", "measured", io::Series::Style::line, {}, {}, {}, {}};
  for (int i = 0; i < 100000; ++i) {
    series.x.push_back(i);
    series.y.push_back(i == 54321 ? 100.0 : 0.0);
  }
  chart.series.push_back(series);
  const std::string html = io::to_html(chart);
  CHECK(html.size() < 60000);
  // 0 to 100 and 6 % more on both ends: the peak is 6/112 below the top, 54321/99999 from the left.
  long least = 1000000, at = 0;
  for (const auto& [x, y] : points_of(html, "curve measured")) {
    if (y < least) at = x;
    least = std::min(least, y);
  }
  CHECK(least == 536);
  CHECK(at == 54322);
}

TEST_CASE("a curve that is shown in part keeps its detail there") {
  io::Chart chart;
  io::Series series{"x", "measured", io::Series::Style::line, {}, {}, {}, {}};
  for (int i = 0; i < 100000; ++i) {
    series.x.push_back(0.01 * i);
    series.y.push_back(std::sin(2.0 * i));
  }
  chart.series.push_back(series);
  chart.view = {500.0, 501.0};
  std::size_t inside = 0;
  const auto points = points_of(io::to_html(chart), "curve measured");
  for (const auto& [x, y] : points) inside += x >= 50000 && x <= 50100 ? 1 : 0;
  CHECK(inside >= 100);
  CHECK(points.size() < 3000);
}

TEST_CASE("errors' histogram and correlation are what they are of known errors") {
  io::RunErrors of;
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  double alike = 0.0;
  std::vector<double> white;
  for (int i = 0; i < 60000; ++i) {
    alike = 0.9 * alike + std::sqrt(1.0 - 0.81) * normal(random);
    of.errors.push_back(alike);
    of.t_s.push_back(0.5 * i);
    white.push_back(normal(random));
  }
  of.runs.push_back({0, 60000, {}});
  const io::Curve correlation = io::autocorrelation(of);
  REQUIRE(correlation.x.size() > 20);
  CHECK(correlation.y[0] == Approx(1.0));
  for (std::size_t i = 1; i < correlation.x.size(); ++i)
    CHECK(correlation.y[i] == Approx(std::pow(0.9, correlation.x[i] / 0.5)).margin(0.06));
  of.errors = white;
  const io::Curve none = io::autocorrelation(of);
  for (std::size_t i = 1; i < none.y.size(); ++i) CHECK(std::fabs(none.y[i]) < 0.03);

  const io::Curve counted = io::histogram(white, 4.0), expected = io::normal_histogram(4.0, 1.0);
  double all = 0.0;
  for (std::size_t i = 0; i < counted.x.size(); ++i) {
    CHECK(counted.y[i] == Approx(expected.y[i]).margin(0.01));
    all += counted.y[i];
  }
  CHECK(all == Approx(1.0));
  CHECK(io::histogram({0.0, 100.0, missing}, 4.0).y.back() == 0.5);
  // Two runs are no neighbours: alternating runs of +1 and -1 correlate in themselves and not with each other.
  io::RunErrors two;
  for (int run = 0; run < 2; ++run)
    for (int i = 0; i < 30; ++i) {
      two.errors.push_back(run == 0 ? 1.0 : -1.0);
      two.t_s.push_back(i);
    }
  two.runs = {{0, 30, "a"}, {30, 60, "b"}};
  for (const double y : io::autocorrelation(two).y) CHECK(y == Approx(1.0));
}

TEST_CASE("a spectrum holds the errors' mean square, shows a tone at its frequency, and white noise flat") {
  io::RunErrors of;
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 0.3);
  const double step_s = 0.02;
  for (int i = 0; i < 20000; ++i) {
    of.errors.push_back(normal(random) + 5.0);  // an offset is no part of it
    of.t_s.push_back(step_s * i);
  }
  of.runs.push_back({0, 20000, {}});
  const io::Curve noise = io::spectrum(of), floor = io::white_spectrum(of, 0.3);
  REQUIRE(noise.x.size() > 40);
  // Up to half the sampling rate, but for less than a twelfth of an octave and a line.
  CHECK(noise.x.back() <= 0.5 / step_s);
  CHECK(noise.x.back() > 0.5 / step_s * std::exp2(-1.0 / 12.0) - 1.0 / (1024 * step_s));
  for (std::size_t i = 0; i + 1 < noise.x.size(); ++i) CHECK(noise.y[i] == Approx(floor.y[i]).epsilon(0.35));
  CHECK(floor.y[0] * floor.y[0] * 0.5 / step_s == Approx(0.09));  // over all frequencies: the variance

  io::RunErrors tone = of;
  for (int i = 0; i < 20000; ++i) {
    tone.errors[static_cast<std::size_t>(i)] = std::sin(2.0 * 3.14159265358979 * 3.0 * step_s * i);
    if (i % 500 == 7) tone.errors[static_cast<std::size_t>(i)] = missing;
  }
  const io::Curve peak = io::spectrum(tone);
  const auto top = std::max_element(peak.y.begin(), peak.y.end()) - peak.y.begin();
  CHECK(peak.x[static_cast<std::size_t>(top)] == Approx(3.0).epsilon(0.06));
  // Far from the tone there is next to nothing of it.
  CHECK(peak.y[1] < 0.03 * peak.y[static_cast<std::size_t>(top)]);

  of.errors.resize(12);
  of.t_s.resize(12);
  of.runs = {{0, 12, {}}};
  CHECK(io::spectrum(of).x.empty());
}

TEST_CASE("the spectrum's square over all frequencies is the mean square, for errors of any colour") {
  io::RunErrors of;
  std::mt19937 random(12);
  std::normal_distribution<double> normal(0.0, 1.0);
  double alike = 0.0, square = 0.0;
  for (int i = 0; i < 40000; ++i) {
    alike = 0.6 * alike + normal(random);
    of.errors.push_back(alike);
    of.t_s.push_back(0.1 * i);
    square += alike * alike;
  }
  of.runs.push_back({0, 40000, {}});
  const io::Curve curve = io::spectrum(of);
  double integral = curve.y[0] * curve.y[0] * curve.x[0];
  for (std::size_t i = 1; i < curve.x.size(); ++i)
    integral +=
        0.5 * (curve.y[i] * curve.y[i] + curve.y[i - 1] * curve.y[i - 1]) * (curve.x[i] - curve.x[i - 1]);
  CHECK(integral == Approx(square / 40000.0).epsilon(0.06));
}

TEST_CASE("an axis of decades says powers of ten, and leaves out what has no logarithm") {
  io::Chart chart;
  chart.logarithmic = true;
  chart.series.push_back({"x",
                          "measured",
                          io::Series::Style::line,
                          {0.01, 1.0, 100.0, 1000.0},
                          {1.0, 10.0, 0.0, 1000.0},
                          {},
                          {}});
  const std::string html = io::to_html(chart);
  for (const char* tick : {">0.01<", ">0.1<", ">10<", ">1e+03<"}) CHECK_THAT(html, ContainsSubstring(tick));
  const auto points = points_of(html, "curve measured");
  REQUIRE(points.size() == 3);
  CHECK(points[1].first == 40000);  // two of five decades
}

TEST_CASE("the page shows what estimates have in common, and each explanation that was drawn") {
  auto [d, held_out] = four_runs();
  const std::string html = io::report_html(d, "motor", {}, held_out);
  // The effect's parameter first, then the constant that hangs together with it most.
  const std::size_t table = html.find("class=\"together\"");
  REQUIRE(table != std::string::npos);
  CHECK_THAT(html.substr(table), ContainsSubstring("1\u2002radiation.") && ContainsSubstring("\u22120.97") &&
                                     ContainsSubstring("0.25") && !ContainsSubstring("nan"));
  CHECK(html.find("1\u2002radiation") < html.find("2\u2002conductance"));
  // Its ratios compare with "nothing is missing", whose own is 1, and not with the model as configured.
  CHECK_THAT(html,
             ContainsSubstring(
                 "<th>takes away<small>of the held-out error that refitted constants leave</small></th>"));
  CHECK_THAT(html, ContainsSubstring("class=\"key switch\" data-role=\"augmented\"") &&
                       ContainsSubstring("class=\"key switch\" data-role=\"rival1\"") &&
                       ContainsSubstring("html:not(.js) .curve.rival1"));
  const auto json = nlohmann::ordered_json::parse(io::report_json(d));
  CHECK(json["correlation"]["names"].size() == 3);
  CHECK(json["correlation"]["of"][1][0] == -0.97);
  CHECK(json["correlation"]["of"][0][2].is_null());
  // For gap_page_in_browser: as many parameters as there can be in one table, and what is left has a spectrum.
  d.correlation.names.clear();
  for (const char* const name : {"conductance", "heat_capacity", "resistance", "coupling",
                                 "body_heat_capacity", "radiation.emissive_area_m2",
                                 "second_thermal_mass.coupling_W_per_K", "thermometer_lag.time_constant_s"})
    d.correlation.names.push_back(std::string(name) + (d.correlation.names.size() < 5 ? ".scale" : ""));
  d.correlation.of = Eigen::MatrixXd::Constant(8, 8, -0.97);
  const Eigen::VectorXd exact = d.series[0].augmented;
  for (Eigen::Index i = 0; i < exact.size(); ++i) d.series[0].augmented[i] += i % 2 == 0 ? 0.1 : -0.1;
  std::ofstream(THERMOPOWER_PAGE) << io::report_html(d, "motor", {}, held_out);
  d.correlation = {};
  d.series[0].rivals.clear();
  CHECK_THAT(io::report_html(d, "motor", {}, held_out),
             !ContainsSubstring("<table class=\"together\"") && !ContainsSubstring("data-role=\"rival1\""));
}

TEST_CASE("charts of nothing, of one point and of NaN are pictures all the same") {
  for (const auto& values :
       std::vector<std::vector<double>>{{}, {1.0}, {missing, missing}, {1e300, -1e300}, {5.0, 5.0}}) {
    io::Chart chart;
    chart.series.push_back({"x", "measured", io::Series::Style::line, values, values, {}, {}});
    const std::string svg = io::to_html(chart);
    CHECK_THAT(svg, ContainsSubstring("</svg>") && !ContainsSubstring("nan") && !ContainsSubstring("inf"));
  }
}

TEST_CASE("the summary says verdict, where, which, what else, how far and what next") {
  const std::string text = std::regex_replace(io::summary(example()), std::regex("\n +"), " ");  // unwrapped
  for (const char* part : {"AMBIGUOUS", "motor temperature, thermal.loss (83 % of the gap)",
                           "temperature above the air 12.0 to 40.0 K", "radiation (61 %)",
                           "natural_convection; ambient_bias + series_resistance", "4.40", "0.140",
                           "97 % [96, 98]", "heat <hard> & wait", "angle_deg: not recorded"}) {
    CAPTURE(part);
    CHECK_THAT(text, ContainsSubstring(part));
  }
}

TEST_CASE("a place that takes none of the gap away says so instead of 0 %") {
  Diagnosis d = example();
  d.where.front().share = 0.004;
  CHECK_THAT(io::summary(d),
             ContainsSubstring("motor temperature, thermal.loss (no one place takes the gap away)"));
  CHECK_THAT(io::report_html(d, "motor", {}), ContainsSubstring("where no one place takes its gap away"));
  d.where.front().share = 0.006;
  CHECK_THAT(io::summary(d), ContainsSubstring("motor temperature, thermal.loss (1 % of the gap)"));
  CHECK_THAT(io::report_html(d, "motor", {}), !ContainsSubstring("no one place"));
}

TEST_CASE(
    "summary and page say of a parameter that the data do not tell it, and give no interval that is all of its range") {
  Diagnosis d = example();
  d.cause[0].parameters = {{"emissive_area_m2", 0.3, {0.25, 0.35}, "m^2"}, {"shape", 0.7, {0.0, 1.0}, "1"}};
  d.cause[0].parameters[1].told = false;
  d.ranking[0].parameters = d.cause[0].parameters;
  const std::string summary = std::regex_replace(io::summary(d), std::regex("\n +"), " "),
                    page = io::report_html(d, "motor", {});
  CHECK_THAT(summary, ContainsSubstring("0.300 m^2 [0.250, 0.350]"));
  for (const std::string& text : {summary, page}) {
    CHECK_THAT(text, ContainsSubstring("not told by these data"));
    CHECK_THAT(text, !ContainsSubstring("[0, 1.00]"));
  }
}

TEST_CASE("a curve has words: what is unknown, and what it follows") {
  CHECK(io::effect_in_words("unknown.friction(rate_dps)") ==
        "an unknown friction that follows the angular rate");
  CHECK(io::effect_in_words("unknown.loss(rise_K)") ==
        "an unknown loss that follows the temperature above the air");
  CHECK(io::effect_in_words("unknown.flow(level_m)") ==
        "an unknown flow that follows level_m");  // of a user's own
  CHECK(io::effect_in_words("unknown.") == "unknown.");
}

TEST_CASE("the summary gives a curve by its two ends") {
  Diagnosis d = example();
  d.cause[0].effect = "unknown.load(angle_deg)";
  d.cause[0].parameters = {{"Nm_1", -0.26, {-0.32, -0.2}, "N m"},
                           {"Nm_2", -0.33, {-0.4, -0.3}, "N m"},
                           {"Nm_3", -0.62, {-0.7, -0.5}, "N m"}};
  CHECK_THAT(
      std::regex_replace(io::summary(d), std::regex("\n +"), " "),
      ContainsSubstring(
          "unknown.load(angle_deg) (61 %): -0.260 N m [-0.320, -0.200] at the low end of the range seen, "
          "-0.620 N m [-0.700, -0.500] at the high end") &&
          !ContainsSubstring("-0.330"));
}

TEST_CASE("the summary says that a parameter ended on a bound, as its interval tells nothing there") {
  Diagnosis d = example();
  CHECK_THAT(io::summary(d), !ContainsSubstring("on its bound"));
  d.cause.front().parameters.front().at_bound = true;
  CHECK_THAT(std::regex_replace(io::summary(d), std::regex("\n +"), " "),
             ContainsSubstring("], on its bound"));
}

TEST_CASE("outputs appear together and complete, or not at all") {
  const auto folder = std::filesystem::temp_directory_path() / "thermopower_outputs";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  io::OutputFiles outputs;
  outputs.expect((folder / "a").string());
  CHECK(std::filesystem::is_empty(folder));
  outputs.put((folder / "a").string(), "first");
  outputs.put((folder / "no such folder" / "b").string(), "second");
  CHECK_THROWS_AS(outputs.commit(), io::OutputError);
  CHECK(std::filesystem::is_empty(folder));
  io::OutputFiles fine;
  fine.put((folder / "a").string(), "first");
  fine.put((folder / "b").string(), std::string("second\0", 7));
  fine.commit();
  CHECK(text_of(folder / "a") == "first");
  CHECK(text_of(folder / "b") == std::string("second\0", 7));
  CHECK_THROWS_AS(io::OutputFiles().expect((folder / "no such folder" / "b").string()), io::OutputError);
  CHECK_THROWS_AS(io::OutputFiles().expect(folder.string()), io::OutputError);
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
  const io::MotorModelHeader header = io::motor_model_header(model, "origin");
  CHECK_THAT(header.text, ContainsSubstring("struct Cooling") && ContainsSubstring("/ 20.0f, 0.25f)"));
  CHECK_THAT(header.text, ContainsSubstring("duty - 0.02f"));
  CHECK_THAT(header.text, ContainsSubstring("static float my_own_effect_a_b() { return 2.0f; }"));
  CHECK_THAT(header.text, ContainsSubstring("// Left out: my own/effect: "));
  REQUIRE(header.left_out.size() == 1);
  CHECK_THAT(header.left_out[0], ContainsSubstring("my own/effect"));
}
