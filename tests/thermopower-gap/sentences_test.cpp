// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// No sentence of a report contradicts its tables: every number on the screen and on the page is held against
// report.json, over a couple of dozen diagnoses of all kinds. The audit shares no code with what writes reports.

#include "../catch.hpp"

#include "page_audit.hpp"
#include "screen_audit.hpp"
#include "table_audit.hpp"

#include <thermopower/gap/diagnose.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include "../gap/plants.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <set>

using namespace thermopower::gap;
namespace io = thermopower::io;

namespace {

using printed::Json;
using printed::Written;

std::vector<std::string> complaints_of(const Written& written) {
  const printed::TableAudit table(written);
  const printed::ScreenAudit screen(written);
  const printed::PageAudit page(written);
  std::vector<std::string> all = table.complaints();
  for (const auto& one : screen.complaints()) all.push_back("screen: " + one);
  for (const auto& one : page.complaints()) all.push_back("page: " + one);
  return all;
}

double longest_s(const std::vector<Recording>& recordings) {
  double longest = 0.0;
  for (const Recording& one : recordings)
    for (const auto& run : one.spans())
      if (run.end > run.begin) longest = std::max(longest, one.t_s[run.end - 1] - one.t_s[run.begin]);
  return longest;
}

/// One diagnosis to be made.
struct Case {
  std::string name;
  Model model;
  std::vector<Recording> train, held_out;
  Options options = {};
};

Written written(const Case& one) {
  const Diagnosis d = diagnose(one.model, one.train, one.held_out, one.options);
  Written result;
  result.report = Json::parse(io::report_json(d));
  result.screen = io::summary(d);
  result.page = io::report_html(d, one.model.name, standard_catalogue().list(), one.held_out);
  result.longest_run_s = std::max(longest_s(one.train), longest_s(one.held_out));
  result.one_held_out = one.held_out.size() == 1;
  return result;
}

Recording named(Recording r, const std::string& name) {
  r.name = name;
  return r;
}

Case bench(const std::string& name, const test::BenchFault& fault, std::uint64_t seed, int rows = 450) {
  return {name,
          test::bench_model(),
          {named(test::bench_recording(fault, rows, seed), "logs/train.csv")},
          {named(test::bench_recording(fault, rows / 2, seed + 1), "logs/heldout.csv")}};
}

Case axis(const std::string& name, const test::AxisFault& fault, std::uint64_t seed, int rows = 700) {
  return {name,
          test::axis_model(),
          {named(test::axis_recording(fault, rows, seed), "logs/train.csv")},
          {named(test::axis_recording(fault, rows / 2, seed + 1), "logs/heldout.csv")}};
}

/// The same log, as dirty as logs are: spikes, lost samples, lost rows, a stuck sensor.
Recording dirty(Recording r, const std::string& column) {
  Eigen::VectorXd values = r.column(column);
  const double size = 40.0 * (values.maxCoeff() - values.minCoeff());
  for (const int row : {40, 41, 90, 200}) values[row] += row % 2 == 0 ? size : -size;
  for (int row = 120; row < 130; ++row) values[row] = std::numeric_limits<double>::quiet_NaN();
  for (int row = 150; row < 190; ++row) values[row] = values[149];
  r.set(column, values);
  return r;
}

Recording scaled(Recording r, const std::string& column, double by) {
  r.set(column, by * r.column(column));
  return r;
}

Recording without(Recording r, const std::string& column) {
  r.remove(column);
  return r;
}

/// Everything that may be said, of a motor and of an axis.
std::vector<Case> cases() {
  std::vector<Case> all;
  test::BenchFault loss, offset, gain, leads, lag, both, scale;
  loss.extra_loss_W_per_K2 = both.extra_loss_W_per_K2 = 2e-3;
  offset.sensor_offset_A = both.sensor_offset_A = 0.06;
  gain.sensor_gain = 1.15;
  leads.series_ohm = 0.9;
  lag.lag_s = 25.0;
  scale.motor_scale = 1.25;
  all.push_back(bench("no gap", {}, 3));
  all.push_back(bench("a loss", loss, 5));
  all.push_back(bench("an offset", offset, 7));
  all.push_back(bench("a gain", gain, 9));
  all.push_back(bench("leads", leads, 11));
  all.push_back(bench("a slow thermometer", lag, 13));
  all.push_back(bench("two at once", both, 15));
  all.push_back(bench("constants that are off", scale, 17));
  all.push_back(bench("a loss, and few rows", loss, 19, 90));
  all.push_back(bench("hardly a row", loss, 19, 20));
  Case unknown = bench("a loss that nobody knows", loss, 21);
  unknown.options.without = {"radiation", "natural_convection", "second_thermal_mass", "thermometer_gain",
                             "enclosure"};
  all.push_back(unknown);
  Case blind = bench("no ammeter", loss, 23);
  blind.train[0].remove("current_A"), blind.held_out[0].remove("current_A");
  all.push_back(blind);
  Case spiked = bench("dirty", loss, 25);
  spiked.train[0] = dirty(spiked.train[0], "motor_C"),
  spiked.held_out[0] = dirty(spiked.held_out[0], "current_A");
  all.push_back(spiked);
  Case milli = bench("milliamperes", offset, 27);
  milli.train[0] = scaled(milli.train[0], "current_A", 1e3);
  milli.held_out[0] = scaled(milli.held_out[0], "current_A", 1e3);
  all.push_back(milli);
  Case several = bench("several recordings", offset, 29);
  several.train.push_back(named(test::bench_recording({}, 400, 31), "logs/sound.csv"));
  several.held_out.push_back(
      named(without(test::bench_recording(offset, 300, 33), "current_A"), "logs/no_ammeter.csv"));
  all.push_back(several);

  test::AxisFault friction, spring, scale_of_angle, pair;
  friction.coulomb_Nm = pair.coulomb_Nm = 0.006;
  spring.spring_Nm_per_rad = pair.spring_Nm_per_rad = 0.05;
  scale_of_angle.angle_gain = 1.5;
  all.push_back(axis("no gap of an axis", {}, 41));
  all.push_back(axis("friction", friction, 43));
  all.push_back(axis("a spring", spring, 45));
  all.push_back(axis("an angle of another scale", scale_of_angle, 47));
  all.push_back(axis("friction and a spring", pair, 51));
  Case half = axis("friction and a spring that nobody knows", pair, 53);
  half.options.without = {"cable_spring",    "imbalance", "cogging",
                          "constant_torque", "backlash",  "compliance"};
  all.push_back(half);
  Case strange = axis("friction that nobody knows", friction, 55);
  strange.options.without = {
      "coulomb_friction",           "asymmetric_friction",     "stribeck_friction",     "load_friction",
      "presliding_friction",        "drive_deadband",          "warm_friction",         "backlash",
      "asymmetric_viscous",         "torque_saturation",       "friction_film",         "quadratic_drag",
      "unknown.friction(rate_dps)", "unknown.load(angle_deg)", "unknown.drive(drive_A)"};
  all.push_back(strange);
  Case idle = axis("never driven", {}, 57);
  idle.train[0] = scaled(idle.train[0], "drive_A", 0.0),
  idle.held_out[0] = scaled(idle.held_out[0], "drive_A", 0.0);
  all.push_back(idle);
  Case rough = axis("a dirty axis", friction, 59);
  rough.train[0] = dirty(rough.train[0], "rate_dps"),
  rough.held_out[0] = dirty(rough.held_out[0], "angle_deg");
  all.push_back(rough);
  return all;
}

/// A case and what was said of it.
struct Report {
  std::string name;
  Written written;
};

/// Of every case, diagnosed once.
const std::vector<Report>& reports() {
  static const std::vector<Report> all = [] {
    std::vector<Report> list;
    for (const Case& one : cases()) list.push_back({one.name, written(one)});
    return list;
  }();
  return all;
}

/// A number in a text.
struct Place {
  std::size_t from, to;
};

/// Numbers that people read: none inside tags, entities and names.
std::vector<Place> numbers_in(const std::string& text) {
  std::vector<Place> places;
  bool tag = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '<') tag = true;
    if (text[i] == '>') tag = false;
    const auto digit = [&](std::size_t k) { return k < text.size() && text[k] >= '0' && text[k] <= '9'; };
    const bool in_name =
        i > 0 && (std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0 || text[i - 1] == '_' ||
                  text[i - 1] == '.' || text[i - 1] == '^' || text[i - 1] == '/');
    if (tag || !digit(i) || in_name) continue;
    std::size_t end = i;
    while (digit(end) || (end < text.size() && text[end] == '.' && digit(end + 1))) ++end;
    places.push_back({i, end});
    i = end - 1;
  }
  return places;
}

/// The text with another first digit of a number.
std::string with_another_number(std::string text, const Place& place) {
  text[place.from] = text[place.from] == '9' ? '4' : static_cast<char>(text[place.from] + 1);
  return text;
}

std::string around(const std::string& text, const Place& place) {
  const std::size_t from = place.from > 120 ? place.from - 120 : 0;
  return text.substr(from, place.to + 60 - from);
}

std::string without_pictures(const std::string& page) {
  std::string text = page;
  for (const char* part : {"svg", "script", "style"})
    for (std::size_t at = 0; (at = text.find(std::string("<") + part, at)) != std::string::npos;) {
      const std::string end = std::string("</") + part + ">";
      text.erase(at, text.find(end, at) + end.size() - at);
    }
  return text;
}

/// Whether a place of a page is about no table: pictures, runs one by one, degrees of freedom, what a kind of number is.
bool is_of_no_table(const std::string& page, std::size_t at) {
  const std::size_t heading = page.rfind("<h2>", at), before = page.rfind("<h2>", page.find("<footer>"));
  const std::string title = heading == std::string::npos ? "" : page.substr(heading + 4, 12);
  if (title.rfind("Measured", 0) == 0 || title.rfind("What is left", 0) == 0 ||
      title.rfind("The missing", 0) == 0)
    return true;
  if (before != std::string::npos && at > page.find("<footer>")) return true;
  for (const char* known : {"Above 0.95", "Near 1 or \u22121"}) {
    const std::size_t from = page.rfind(known, at);
    if (from != std::string::npos && at - from < std::string(known).size()) return true;
  }
  return false;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

TEST_CASE("no sentence on the screen or on the page contradicts the report's tables") {
  std::set<std::string> verdicts;
  for (const Report& one : reports()) {
    verdicts.insert(one.written.report["verdict"].get<std::string>());
    for (const std::string& complaint : complaints_of(one.written)) {
      CAPTURE(one.name, one.written.screen);
      FAIL_CHECK(complaint);
    }
  }
  CHECK(verdicts ==
        std::set<std::string>{"no_gap", "explained", "partial", "ambiguous", "unexplained", "insufficient"});
}

TEST_CASE("a number that is changed on the screen or on the page is found out") {
  std::size_t changed = 0;
  for (const Report& one : reports()) {
    if (one.name != "a loss that nobody knows" && one.name != "friction and a spring" &&
        one.name != "several recordings")
      continue;
    CAPTURE(one.name);
    for (const Place& place : numbers_in(one.written.screen)) {
      Written wrong = one.written;
      wrong.screen = with_another_number(wrong.screen, place);
      CAPTURE(around(wrong.screen, place));
      CHECK_FALSE(printed::ScreenAudit(wrong).complaints().empty());
      ++changed;
    }
    Written plain = one.written;
    plain.page = without_pictures(plain.page);
    REQUIRE(printed::PageAudit(plain).complaints().empty());
    for (const Place& place : numbers_in(plain.page)) {
      if (is_of_no_table(plain.page, place.from)) continue;
      Written wrong = plain;
      wrong.page = with_another_number(wrong.page, place);
      CAPTURE(around(wrong.page, place));
      CHECK_FALSE(printed::PageAudit(wrong).complaints().empty());
      ++changed;
    }
  }
  CHECK(changed > 200);
}

TEST_CASE("a word that is changed is found out, too") {
  const auto report = [](const std::string& verdict) {
    for (const Report& one : reports())
      if (one.written.report["verdict"] == verdict) return one.written;
    return Written();
  };
  const auto is_found = [](const Written& wrong) { return !complaints_of(wrong).empty(); };
  Written wrong = report("partial");
  wrong.report["reason"] = "the named cause brings held-out data near the noise, and nothing else does";
  CHECK(is_found(wrong));
  wrong = report("explained");
  wrong.report["gap"].begin().value()["noise_floor"] = 1e-6;
  CHECK(is_found(wrong));
  wrong = report("explained");
  wrong.screen = printed::replaced(wrong.screen, "EXPLAINED", "NO GAP");
  CHECK(is_found(wrong));
  wrong = report("explained");
  wrong.report["not_judged"].push_back(
      "the motor temperature is not judged: the recording has no column motor_C");
  wrong.report["not_judged"].push_back("the angle is not judged: the recording has no column angle_deg");
  CHECK_FALSE(printed::TableAudit(wrong).complaints().empty());
  wrong = report("unexplained");
  wrong.report["where"].push_back(wrong.report["where"][0]);  // the same place twice
  CHECK_FALSE(printed::TableAudit(wrong).complaints().empty());
  wrong = report("partial");
  wrong.longest_run_s = 1e-3;
  CHECK_FALSE(printed::TableAudit(wrong).complaints().empty());
  wrong = report("partial");
  wrong.report["gap"].begin().value()["recalibrated"] = 1e9;
  CHECK_FALSE(printed::TableAudit(wrong).complaints().empty());
}

// For reports at large: THERMOPOWER_REPORTS=folder gap_sentences "reports in*", each in a folder of its own with
// report.json, screen.txt and report.html.
TEST_CASE("reports in the folder that THERMOPOWER_REPORTS names agree with themselves", "[.]") {
  const char* const folder = std::getenv("THERMOPOWER_REPORTS");
  REQUIRE(folder != nullptr);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (!std::filesystem::exists(entry.path() / "report.json")) continue;
    Written report;
    report.report = Json::parse(text_of(entry.path() / "report.json"));
    report.screen = text_of(entry.path() / "screen.txt");
    report.page = text_of(entry.path() / "report.html");
    report.longest_run_s = std::numeric_limits<double>::infinity();
    for (const std::string& complaint : complaints_of(report)) {
      CAPTURE(entry.path().string());
      FAIL_CHECK(complaint);
    }
  }
}
