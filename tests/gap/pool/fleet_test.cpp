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
    result.verdict = cause.empty() ? thermopower::gap::Verdict::no_gap : thermopower::gap::Verdict::explained;
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
  bad.verdict = thermopower::gap::Verdict::insufficient;
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

TEST_CASE(
    "a unit whose constants alone are off is of the family that lacks nothing, and is held against its spread") {
  Draw draw(3);
  std::vector<LogResult> logs;
  // What a diagnosis leaves of a log whose constants are beyond what the model's author knew of them: the fit that holds
  // them is bad, the one that releases them is as good as any sound log's.
  const auto released = [&](const std::string& unit, double time, const std::vector<double>& truth) {
    LogResult log = draw.log(unit, time, "", truth, 5.0);
    log.verdict = thermopower::gap::Verdict::explained;
    log.chosen_effects = 1;
    log.ranking.front().probability = 0.001;
    log.ranking.front().fit.at[0] += 0.05;  // takes up what is held back
    log.ranking.push_back(
        draw.explanation("calibration.conductance", 0.99, truth, 0.01, std::exp(0.05 * draw.gauss())));
    log.ranking.back().effects = 1;
    return log;
  };
  for (int i = 0; i < 60; ++i)
    logs.push_back(
        draw.log("plain" + std::to_string(i), 0.0, "", {0.03 * draw.gauss(), 0.04 * draw.gauss()}));
  for (int i = 0; i < 20; ++i)
    logs.push_back(
        draw.log("lag" + std::to_string(i), 0.0, "lag", {0.03 * draw.gauss(), 0.04 * draw.gauss(), 3.0}));
  logs.push_back(released("mild", 0.0, {0.0, 0.12}));
  logs.push_back(released("clogged", 0.0, {0.0, 0.5}));
  for (int u = 0; u < 6; ++u) {
    const std::vector<double> truth = {0.03 * draw.gauss(), 0.04 * draw.gauss()};
    for (int k = 0; k < 8; ++k) {
      std::vector<double> now = truth;
      if (u == 0 && k > 3) now[1] += 0.2;
      const std::string name = "followed" + std::to_string(u);
      logs.push_back(u == 0 && k > 3 ? released(name, 30.0 * k, now) : draw.log(name, 30.0 * k, "", now));
    }
  }
  const FleetVerdict verdict = judge_fleet(logs);
  REQUIRE(verdict.families.size() == 2);
  for (const char* name : {"mild", "clogged", "followed0"}) {
    CAPTURE(name);
    CHECK(unit_of(verdict, name).member);
    CHECK(verdict.families[static_cast<std::size_t>(unit_of(verdict, name).family)].cause.empty());
    CHECK(unit_of(verdict, name).misfit < 1.25);
  }
  CHECK(unit_of(verdict, "mild").oddity == Oddity::none);
  CHECK(unit_of(verdict, "clogged").oddity == Oddity::parameter);
  CHECK(unit_of(verdict, "clogged").standing.coordinate == 1);
  CHECK(unit_of(verdict, "followed0").oddity == Oddity::none);
  REQUIRE(unit_of(verdict, "followed0").drifts.size() == 1);
  CHECK(unit_of(verdict, "followed0").drifts[0].coordinate == "calibration.conductance");
  CHECK(unit_of(verdict, "followed0").drifts[0].drift.size == Approx(0.2).margin(0.03));
}

TEST_CASE("what an explanation adds is its name without the constants that it releases") {
  CHECK(structure_of("").empty());
  CHECK(structure_of("calibration.conductance").empty());
  CHECK(structure_of("lag") == "lag");
  CHECK(structure_of("calibration.resistance + lag + mass") == "lag + mass");
  CHECK(structure_of("lag + calibration.resistance") == "lag");
}

TEST_CASE("what a weak effect that all have makes of the constants is in the units' intervals") {
  // A constant whose fits lack an effect are off by the same in every unit: a fit with the effect is right, and less
  // precise by what it has to find out besides.
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  const double off = -0.02, error = 0.006, besides = 0.008, differ = 0.003;
  const auto fleet = [&](std::vector<double>& truth) {
    std::vector<LogResult> logs;
    for (int i = 0; i < 120; ++i) {
      const bool lag = i % 2 == 1;
      const double value = 0.04 * normal(random), own = off + differ * normal(random);
      truth.push_back(value);
      LogResult log;
      log.log = log.unit = "u" + std::to_string(i);
      log.verdict = lag ? thermopower::gap::Verdict::explained : thermopower::gap::Verdict::no_gap;
      log.chosen_effects = lag ? 1 : 0;
      const double first = error * normal(random), second = besides * normal(random);
      for (const char* name : {"", "lag", "offset"}) {
        FittedExplanation one;
        one.name = name;
        const bool right = one.name == (lag ? "lag" : "");
        const bool offset = one.name == "offset";
        one.effects = one.name.empty() ? 0 : 1;
        one.probability = right ? 0.99 : 0.005;
        one.names = {"calibration.resistance"};
        if (!one.name.empty()) one.names.push_back(one.name + ".size");
        one.logarithmic.assign(one.names.size(), true);
        one.at_bound.assign(one.names.size(), false);
        const auto k = static_cast<Eigen::Index>(one.names.size());
        one.fit.at = Eigen::VectorXd::Zero(k);
        one.fit.covariance = 0.01 * Eigen::MatrixXd::Identity(k, k);
        one.fit.at[0] = value + first + (offset ? second : own);
        one.fit.covariance(0, 0) = error * error + (offset ? besides * besides : 0.0);
        if (offset) {
          const double estimate = (own - second) / besides, held = own / besides + normal(random) / 0.65;
          one.train_gain = estimate * estimate;
          one.held_out_gain = 0.43 * (held * held - (held - estimate) * (held - estimate));
        } else {
          one.train_gain = one.held_out_gain = right && lag ? 500.0 : 0.0;
        }
        log.ranking.push_back(one);
      }
      logs.push_back(std::move(log));
    }
    return logs;
  };
  double held = 0.0, count = 0.0, as_fitted = 0.0, mean = 0.0;
  const int fleets = 40;
  for (int i = 0; i < fleets; ++i) {
    std::vector<double> truth;
    const FleetVerdict verdict = judge_fleet(fleet(truth));
    REQUIRE(verdict.weak.front().stands);
    REQUIRE(verdict.weak_shift.count("calibration.resistance") == 1);
    const Shift& shift = verdict.weak_shift.at("calibration.resistance");
    mean += shift.by / fleets;
    for (std::size_t u = 0; u < truth.size(); ++u) {
      const UnitVerdict& unit = verdict.units[u];
      REQUIRE(unit.shrunken);
      const MixedEffects& spread = verdict.families[static_cast<std::size_t>(unit.family)].spread;
      held += std::abs(unit.shrunken->at[0] - truth[u]) < reach95(spread, *unit.shrunken, 0);
      as_fitted += std::abs(unit.shrunken->at[0] - shift.by - truth[u]) < 1.96 * error;
      count += 1.0;
    }
  }
  WARN("true constants within 95 % intervals " << held / count << "; as the logs have them "
                                               << as_fitted / count << "; shift " << mean << " of " << -off);
  CHECK(mean == Approx(-off).margin(0.001));
  CHECK(held / count > 0.93);
  CHECK(held / count < 0.97);
  CHECK(as_fitted / count < 0.3);
}
