// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Units that differ between the runs of a recording, of a joint whose friction takes a third of the drive and of a motor whose
// case hides most of its heat; and runs that differ for another reason.
#include "../../catch.hpp"
#include "rough_recordings.hpp"

#include <thermopower/gap/check.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
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

/// What a run of the axis differs by from others.
struct AxisRun {
  unsigned seed = 1;
  double drive = 1.0;     ///< times the usual one
  double friction = 1.0;  ///< times the usual one
};

Recording axis(AxisRun run, bool voltage = false) {
  return test::recorded(test::RubbingAxis{run.seed, run.drive, 0.02 * run.friction, 1000, 0.01, voltage});
}

/// What a run of the bench differs by from others.
struct BenchRun {
  unsigned seed = 1;
  double air_C = 22.0;
  double start_C = 22.0;
  double supply_V = 12.0;
};

Recording bench(BenchRun run) {
  return test::recorded(test::CasedMotor{run.seed, run.air_C, run.start_C, run.supply_V, 900});
}

/// The runs "a", "b", ... as one recording.
Recording joined(const std::string& name, const std::vector<Recording>& runs) {
  Recording whole;
  whole.name = name;
  Eigen::Index rows = 0;
  for (const Recording& one : runs) {
    whole.runs.push_back(
        {rows, rows + one.rows(), std::string(1, static_cast<char>('a' + whole.runs.size()))});
    rows += one.rows();
  }
  const auto put = [&](const auto& of) {
    Eigen::VectorXd values(rows);
    for (std::size_t i = 0; i < runs.size(); ++i)
      values.segment(whole.runs[i].begin, runs[i].rows()) = of(runs[i]);
    return values;
  };
  whole.t_s = put([](const Recording& one) { return one.t_s; });
  for (const Column& column : runs.front().columns)
    whole.set(column.name, put([&](const Recording& one) { return one.column(column.name); }));
  return whole;
}

std::vector<Finding> errors(const Model& model, const std::vector<Recording>& train,
                            const std::vector<Recording>& held = {}) {
  std::vector<Finding> list;
  for (const Finding& one : engine::check(model, train, held, {}, standard_catalogue()).findings)
    if (one.severity == Severity::error) list.push_back(one);
  return list;
}

/// Columns, runs and option of what is found of units, as text.
std::string decision(const std::vector<Finding>& found) {
  std::string text;
  for (const Finding& one : found) {
    if (one.kind != FindingKind::wrong_unit) continue;
    text += (text.empty() ? "" : "; ") + one.column + " of " + one.recording;
    for (const RowRange& rows : one.rows)
      text += " [" + std::to_string(rows.begin) + ", " + std::to_string(rows.end) + ")";
    const std::size_t from = one.mend.find("--column"), to = one.mend.find(" would,");
    if (from != std::string::npos) text += " " + one.mend.substr(from, to - from);
  }
  return text;
}

struct Case {
  std::vector<std::pair<const char*, std::function<double(double)>>> as_recorded;
  const char* column;
  const char* option;
};

/// Whether a mistake is told in the first, a middle and the last of three runs, and in the second one of those held out.
void check_cases(const Model& model, const std::vector<Recording>& sound, const std::vector<Case>& cases) {
  REQUIRE(errors(model, {joined("log", sound)}).empty());
  for (const Case& one : cases)
    for (std::size_t wrong = 0; wrong < sound.size(); ++wrong) {
      INFO(one.option << " of run " << wrong);
      std::vector<Recording> runs = sound;
      for (const auto& [column, f] : one.as_recorded) change(runs[wrong], column, f);
      const auto begin = static_cast<Eigen::Index>(wrong) * sound.front().rows();
      const std::string rows =
          " [" + std::to_string(begin) + ", " + std::to_string(begin + sound.front().rows()) + ") ";
      const std::vector<Finding> found = errors(model, {joined("log", runs)});
      CHECK(decision(found) == std::string(one.column) + " of log" + rows + one.option);
      if (!found.empty())
        CHECK_THAT(
            found.front().message,
            ContainsSubstring(" in run '" + std::string(1, static_cast<char>('a' + wrong)) + "', rows "));
      if (wrong == 1)
        CHECK(decision(errors(model, {joined("log", sound)}, {joined("other", runs)})) ==
              std::string(one.column) + " of other" + rows + one.option);
    }
}

}  // namespace

TEST_CASE("a run of an axis in another unit than the others is named") {
  check_cases(rubbing_model(), {axis({1}), axis({2, 0.7}), axis({3})},
              {{{{"drive_A", times(1e3)}}, "drive_A", "--column drive_A=drive_A:mA"},
               {{{"rate_dps", times(1.0 / deg)}, {"angle_deg", times(1.0 / deg)}},
                "rate_dps",
                "--column rate_dps=rate_dps:rad/s --column angle_deg=angle_deg:rad"},
               {{{"rate_dps", times(1.0 / deg)}}, "rate_dps", "--column rate_dps=rate_dps:rad/s"},
               {{{"rate_dps", times(1.0 / 6.0)}}, "rate_dps", "--column rate_dps=rate_dps:rpm"},
               {{{"angle_deg", times(1.0 / deg)}}, "angle_deg", "--column angle_deg=angle_deg:rad"},
               {{{"t_s", times(1e3)}}, "t_s", "--column t_s=t_s:ms"}});
  check_cases(rubbing_model(true), {axis({1}, true), axis({2}, true), axis({3}, true)},
              {{{{"voltage_V", times(1e3)}}, "voltage_V", "--column voltage_V=voltage_V:mV"}});
  std::vector<Recording> angles;
  for (const unsigned seed : {1U, 2U, 3U}) {
    angles.push_back(axis({seed}));
    angles.back().remove("rate_dps");
  }
  check_cases(rubbing_model(), angles,
              {{{{"angle_deg", times(1.0 / deg)}}, "angle_deg", "--column angle_deg=angle_deg:rad"}});
}

TEST_CASE("a run of a bench in another unit than the others is named") {
  check_cases(cased_model(), {bench({1}), bench({2}), bench({3})},
              {{{{"motor_C", fahrenheit}, {"ambient_C", fahrenheit}},
                "motor_C",
                "--column motor_C=motor_C:degF --column ambient_C=ambient_C:degF"},
               {{{"motor_C", fahrenheit}}, "motor_C", "--column motor_C=motor_C:degF"},
               {{{"motor_C", kelvin}}, "motor_C", "--column motor_C=motor_C:K"},
               {{{"ambient_C", fahrenheit}}, "ambient_C", "--column ambient_C=ambient_C:degF"},
               {{{"current_A", times(1e3)}}, "current_A", "--column current_A=current_A:mA"},
               {{{"supply_V", times(1e3)}}, "supply_V", "--column supply_V=supply_V:mV"},
               {{{"power_param", times(1.0 / 2.55)}}, "power_param", "--column power_param=power_param:%"}});
}

TEST_CASE("most runs, or all of a file, may be those in another unit") {
  std::vector<Recording> runs{axis({1}), axis({2}), axis({3})};
  change(runs[0], "drive_A", times(1e3));
  change(runs[2], "drive_A", times(1e3));
  const std::vector<Finding> most = errors(rubbing_model(), {joined("log", runs)});
  CHECK(decision(most) == "drive_A of log [0, 1000) [2000, 3000) --column drive_A=drive_A:mA");
  CHECK_THAT(most.front().message,
             ContainsSubstring(" in 2 runs: 'a', rows 0 to 999; 'c', rows 2000 to 2999"));
  change(runs[1], "drive_A", times(1e3));
  const std::vector<Finding> all = errors(rubbing_model(), {joined("log", runs)});
  CHECK(decision(all) == "drive_A of log --column drive_A=drive_A:mA");
  const std::vector<Finding> file =
      errors(rubbing_model(), {joined("log", runs), joined("other", {axis({4}), axis({5})})});
  CHECK(decision(file) == "drive_A of log --column drive_A=drive_A:mA");
  CHECK_THAT(file.front().message, ContainsSubstring("this file alone"));
}

TEST_CASE("runs that differ for another reason are in no other unit") {
  for (const double drive : {0.5, 5.0, 60.0})
    CHECK(errors(rubbing_model(), {joined("log", {axis({1}), axis({2, drive}), axis({3})})}).empty());
  // Dry friction holds it, or nothing drives it.
  for (const double drive : {0.0, 0.1, 0.3, 0.36})
    CHECK(errors(rubbing_model(), {joined("log", {axis({1}), axis({2, drive}), axis({3})})}).empty());
  CHECK(errors(rubbing_model(), {joined("log", {axis({1, 1.0, 0.1}), axis({2, 1.0, 2.5})})}).empty());
  for (const double air_C : {-10.0, 45.0, 60.0, 72.0, 85.0})
    CHECK(errors(cased_model(), {joined("log", {bench({1}), bench({2, air_C, air_C}), bench({3})})}).empty());
  for (const double start_C : {45.0, 73.0, 100.0})
    CHECK(
        errors(cased_model(), {joined("log", {bench({1}), bench({2, 22.0, start_C}), bench({3})})}).empty());
  for (const double supply_V : {5.0, 24.0, 36.0})
    for (const bool logged : {true, false}) {
      INFO(supply_V << (logged ? " V" : " V, not logged"));
      std::vector<Recording> runs{bench({1}), bench({2, 22.0, 22.0, supply_V}), bench({3})};
      for (Recording& one : runs)
        if (!logged) one.remove("supply_V");
      CHECK(errors(cased_model(), {joined("log", runs)}).empty());
    }
}
