// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a fleet concludes from diagnoses that are drawn here, whose truth is known.

#include "../../catch.hpp"

#include <thermopower/gap/pool/fleet.hpp>

#include <random>
#include <string>

using namespace thermopower::gap::pool;

namespace {

/// Draws what a diagnosis would have left of a log.
class Draw {
public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double gauss() { return normal_(random_); }

  /// An explanation with two constants (logarithms) and the parameters of its effects.
  FittedExplanation explanation(const std::string& name, double probability, const std::vector<double>& truth,
                                double error, double misfit) {
    FittedExplanation one;
    one.name = name;
    one.effects = name.empty() ? 0 : 1;
    one.probability = probability;
    one.misfit = misfit;
    one.names = {"calibration.resistance", "calibration.conductance"};
    if (truth.size() > 2) one.names.push_back(name + ".size");
    const auto k = static_cast<Eigen::Index>(one.names.size());
    one.logarithmic.assign(one.names.size(), true);
    one.at_bound.assign(one.names.size(), false);
    one.fit.at.resize(k);
    one.fit.covariance = error * error * Eigen::MatrixXd::Identity(k, k);
    for (Eigen::Index c = 0; c < k; ++c) one.fit.at[c] = truth[static_cast<std::size_t>(c)] + error * gauss();
    return one;
  }

  /// A log of a unit whose cause is `cause` (empty: none).
  LogResult log(const std::string& unit, double time, const std::string& cause,
                const std::vector<double>& truth, double misfit = 1.0) {
    LogResult result;
    result.unit = unit;
    result.log = unit + "_" + std::to_string(time);
    result.time = time;
    result.verdict = cause.empty() ? "no_gap" : "explained";
    result.chosen_effects = cause.empty() ? 0 : 1;
    for (const std::string& name :
         {std::string(), std::string("lag"), std::string("mass"), std::string("other")}) {
      const bool right = name == cause;
      std::vector<double> at = truth;
      if (name.empty()) at.resize(2);
      else if (at.size() < 3) at.push_back(1.0);
      result.ranking.push_back(explanation(name, right ? 0.997 : 0.001, at, 0.01,
                                           right ? misfit * std::exp(0.05 * gauss()) : 5.0 * misfit));
      const double gain = right && !name.empty() ? 500.0 : 0.0, weak = name == "other" ? 2.0 : 0.0;
      const double estimate = weak + gauss(), held = weak + 1.5 * gauss();
      result.ranking.back().train_gain = gain + (name.empty() ? 0.0 : estimate * estimate);
      result.ranking.back().held_out_gain =
          gain + (name.empty() ? 0.0 : 0.43 * (held * held - (held - estimate) * (held - estimate)));
    }
    return result;
  }

private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

const UnitVerdict& unit_of(const FleetVerdict& verdict, const std::string& name) {
  for (const UnitVerdict& one : verdict.units)
    if (one.unit == name) return one;
  throw std::runtime_error(name);
}

}  // namespace

TEST_CASE("a fleet of two families, an odd unit of each kind, a drift, a bad log and a weak common effect") {
  Draw draw(1);
  std::vector<LogResult> logs;
  const auto constants = [&](bool with_size) {
    std::vector<double> truth = {0.03 * draw.gauss(), 0.04 * draw.gauss()};
    if (with_size) truth.push_back(3.0 + 0.1 * draw.gauss());
    return truth;
  };
  for (int i = 0; i < 60; ++i)
    logs.push_back(draw.log("plain" + std::to_string(i), 0.0, "", constants(false)));
  for (int i = 0; i < 40; ++i)
    logs.push_back(draw.log("lag" + std::to_string(i), 0.0, "lag", constants(true)));
  std::vector<double> far = constants(false);
  far[1] -= 0.5;
  logs.push_back(draw.log("clogged", 0.0, "", far));
  logs.push_back(draw.log("strange", 0.0, "lag", constants(true), 9.0));
  logs.push_back(draw.log("massive", 0.0, "mass", constants(true)));
  for (int u = 0; u < 6; ++u) {
    std::vector<double> truth = constants(false);
    for (int k = 0; k < 8; ++k) {
      if (u == 0 && k == 5) truth[0] += 0.12;
      logs.push_back(draw.log("followed" + std::to_string(u), 30.0 * k, "", truth));
    }
  }
  LogResult bad;
  bad.log = "bad.csv";
  bad.verdict = "insufficient";
  bad.reason = "too short";
  logs.push_back(bad);
  const FleetVerdict verdict = judge_fleet(logs);

  REQUIRE(verdict.families.size() == 2);
  CHECK(verdict.families[0].cause.empty());
  CHECK(verdict.families[1].cause == "lag");
  CHECK(verdict.families[1].coordinates.size() == 3);
  CHECK(verdict.families[1].prevalence.units == Approx(41.0).margin(1.0));
  CHECK(verdict.structure_differs);
  CHECK(verdict.parameters_differ);
  const MixedEffects& lag = verdict.families[1].spread;
  CHECK(lag.mean[2] == Approx(3.0).margin(0.06));
  CHECK(std::sqrt(lag.between(2, 2)) == Approx(0.1).margin(0.035));
  CHECK(std::sqrt(lag.between(1, 1)) == Approx(0.04).margin(0.015));
  CHECK(verdict.families[1].differs == std::vector<bool>{true, true, true});

  CHECK(unit_of(verdict, "clogged").oddity == Oddity::parameter);
  CHECK(unit_of(verdict, "clogged").standing.coordinate == 1);
  CHECK(unit_of(verdict, "clogged").standing.standard_deviations < -8.0);
  CHECK(unit_of(verdict, "strange").oddity == Oddity::misfit);
  CHECK(unit_of(verdict, "strange").misfit == Approx(3.0).margin(0.3));
  CHECK_FALSE(unit_of(verdict, "massive").member);
  CHECK(unit_of(verdict, "massive").oddity == Oddity::misfit);
  CHECK(unit_of(verdict, "massive").own_cause == "mass");
  for (const UnitVerdict& one : verdict.units)
    if (one.unit.rfind("plain", 0) == 0 || one.unit.rfind("lag", 0) == 0) {
      CAPTURE(one.unit);
      CHECK(one.oddity == Oddity::none);
      CHECK(one.drifts.empty());
      CHECK(one.member);
    }
  REQUIRE(unit_of(verdict, "followed0").drifts.size() == 1);
  const UnitDrift& drift = unit_of(verdict, "followed0").drifts[0];
  CHECK(drift.coordinate == "calibration.resistance");
  CHECK(drift.drift.kind == DriftKind::change);
  CHECK(drift.drift.size == Approx(0.12).margin(0.02));
  CHECK(drift.drift.since == 120.0);
  CHECK(drift.drift.until == 150.0);
  for (int u = 1; u < 6; ++u) CHECK(unit_of(verdict, "followed" + std::to_string(u)).drifts.empty());

  REQUIRE(verdict.bad_logs.size() == 1);
  CHECK(logs[verdict.bad_logs[0].log].log == "bad.csv");
  REQUIRE_FALSE(verdict.weak.empty());
  CHECK(verdict.weak[0].explanation == "other");
  CHECK(verdict.weak[0].stands);
  for (std::size_t i = 1; i < verdict.weak.size(); ++i) CHECK_FALSE(verdict.weak[i].stands);
}

TEST_CASE("one family without spread is one structure and one set of parameters") {
  Draw draw(2);
  std::vector<LogResult> logs;
  for (int i = 0; i < 30; ++i) logs.push_back(draw.log("u" + std::to_string(i), 0.0, "lag", {0.0, 0.0, 3.0}));
  const FleetVerdict verdict = judge_fleet(logs);
  REQUIRE(verdict.families.size() == 1);
  CHECK_FALSE(verdict.structure_differs);
  CHECK_FALSE(verdict.parameters_differ);
  CHECK(verdict.weak.empty());  // nobody's own diagnosis finds nothing
}

TEST_CASE("nothing, one log, and logs without an estimate are no trouble") {
  CHECK(judge_fleet({}).units.empty());
  Draw draw(3);
  CHECK(judge_fleet({draw.log("a", 0.0, "lag", {0.0, 0.0, 1.0})}).families.empty());
  std::vector<LogResult> logs;
  for (int i = 0; i < 10; ++i) {
    logs.push_back(draw.log("u" + std::to_string(i), 0.0, "lag", {0.0, 0.0, 1.0}));
    for (FittedExplanation& one : logs.back().ranking) one.fit.covariance.resize(0, 0);
  }
  const FleetVerdict verdict = judge_fleet(logs);
  REQUIRE(verdict.families.size() == 1);
  CHECK(verdict.families[0].spread.size() == 0);
  for (const UnitVerdict& one : verdict.units) CHECK(one.oddity == Oddity::none);
}
