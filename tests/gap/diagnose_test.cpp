// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "fixture.hpp"
#include "plants.hpp"

#include <thermopower/gap/diagnose.hpp>

#include <algorithm>
#include <atomic>
#include <utility>

using namespace engine_fixture;

namespace {

Trial trial_of(const std::string& id) {
  for (const Trial& trial : trials())
    if (trial.id == id) return trial;
  FAIL("no trial of " << id);
  return {};
}

Diagnosis diagnose_trial(const std::string& id, const Options& options = {}) {
  const Trial trial = trial_of(id);
  return diagnose(baseline_of(trial), {recorded(trial, 31)}, {recorded(trial, 41)}, options);
}

/// Everything of a diagnosis that a report shows, as text with every digit.
std::string digits(const Diagnosis& diagnosis) {
  std::string text = to_string(diagnosis.verdict);
  const auto number = [&](double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, " %.17g", value);
    text += buffer;
  };
  for (const GapScore& gap : diagnosis.gap)
    for (double value :
         {gap.before, gap.recalibrated, gap.after, gap.noise_floor, gap.ci95.low, gap.ci95.high})
      number(value);
  for (const RankedExplanation& one : diagnosis.ranking) {
    for (const std::string& id : one.effects) text += " " + id;
    number(one.probability);
    number(one.delta_score);
    for (const ParameterEstimate& parameter : one.parameters)
      number(parameter.value), number(parameter.ci95.low);
  }
  return text;
}

}  // namespace

TEST_CASE("a simulation that matches has no gap, also with constants off by less than is known of them") {
  for (const double off : {1.0, 0.97, 1.035}) {
    Model truth = bench_model();
    Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
    measure(train, truth, 5);
    measure(held_out, truth, 6);
    Model model = truth;
    model.set("heat_capacity_J_per_K", 60.0 * off);
    model.set("resistance_ohm", 6.0 / off);
    const Diagnosis diagnosis = diagnose(model, {train}, {held_out});
    INFO(off << ": " << diagnosis.reason);
    CHECK(test::holds(diagnosis));
  }
}

TEST_CASE("what happens in a few seconds of a long recording is found") {
  Model truth = axis_model();
  truth.effects["torque_saturation"] = {{"A", 0.5}};
  const auto record = [&](std::uint64_t seed, double from_s) {
    Recording recording = axis_inputs(12000, 0.01, seed);
    Eigen::VectorXd drive = recording.column("drive_A");
    for (Eigen::Index row = 0; row < drive.size(); ++row) {
      const bool hard = recording.t_s[row] > from_s && recording.t_s[row] < from_s + 12.0;
      drive[row] *= hard ? 3.0 : 0.8;  // the limit is reached there alone
    }
    recording.set("drive_A", drive);
    measure(recording, truth, seed + 1);
    return recording;
  };
  Options options;
  options.effects_at_once = 1;
  const Diagnosis diagnosis = diagnose(axis_model(), {record(3, 103.0)}, {record(7, 46.0)}, options);
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause.front().effect == "torque_saturation");
  CHECK(diagnosis.cause.front().parameters.front().value == Approx(0.5).epsilon(0.01));
}

TEST_CASE("the missing effect is named, and held-out data shrinks to the noise") {
  for (const char* id : {"second_thermal_mass", "series_resistance", "coulomb_friction", "imbalance"}) {
    const Diagnosis diagnosis = diagnose_trial(id);
    INFO(id << ": " << diagnosis.reason);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause[0].effect == id);
    for (const GapScore& gap : diagnosis.gap) {
      CHECK(gap.after < 1.3 * gap.noise_floor);
      CHECK(gap.ci95.low <= gap.shrunk_by);
      CHECK(gap.shrunk_by <= gap.ci95.high);
    }
  }
}

TEST_CASE("a command that is lost here and there hides neither a delay nor a spring") {
  // A spring swings on for longer than a command is under way.
  for (const auto& [id, every] :
       {std::pair<const char*, Eigen::Index>("actuation_delay", 131), {"compliance", 677}}) {
    const Trial trial = trial_of(id);
    const auto with_holes = [&, step = every](std::uint64_t seed) {
      Recording r = recorded(trial, seed);
      Eigen::VectorXd drive = r.column("drive_A");
      for (Eigen::Index row = 90; row + 90 < r.rows(); row += step)
        drive.segment(row, 5).setConstant(missing);
      r.set("drive_A", drive);
      return r;
    };
    const Diagnosis diagnosis = diagnose(baseline_of(trial), {with_holes(31)}, {with_holes(41)});
    INFO(id << ": " << diagnosis.reason);
    CHECK(diagnosis.verdict == Verdict::explained);
    REQUIRE(diagnosis.cause.size() == 1);
    CHECK(diagnosis.cause[0].effect == id);
    for (const auto& [name, value] : trial.parameters) {
      const auto& found = diagnosis.cause[0].parameters;
      const auto one =
          std::find_if(found.begin(), found.end(),
                       [&, wanted = name](const ParameterEstimate& p) { return p.name == wanted; });
      REQUIRE(one != found.end());
      CHECK(one->value == Approx(value).epsilon(0.1));
    }
  }
}

TEST_CASE("a constant that is off by more than is known of it is a cause of its own") {
  Model truth = bench_model();
  Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  Model model = truth;
  model.set("heat_capacity_J_per_K", 50.0);
  const Diagnosis diagnosis = diagnose(model, {train}, {held_out});
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause[0].effect == "calibration.heat_capacity");
  CHECK(diagnosis.augmented.get("heat_capacity_J_per_K") == Approx(60.0).epsilon(0.02));
}

TEST_CASE("constants that were fitted with the wrong structure move back, and the missing effect is named") {
  Model truth = bench_model();
  truth.effects["second_thermal_mass"] = {{"winding_share", 0.3}, {"coupling", 1.0}};
  Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  Model model = bench_model();
  model.set("heat_capacity_J_per_K", 60.0 * 0.6);  // what one node makes of the fast part of the steps
  const Diagnosis diagnosis = diagnose(model, {train}, {held_out});
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause[0].effect == "second_thermal_mass");
  CHECK(diagnosis.augmented.get("heat_capacity_J_per_K") == Approx(60.0).epsilon(0.05));
  REQUIRE(test::moved(diagnosis).size() == 1);
  CHECK(test::moved(diagnosis)[0].name == "heat_capacity");
}

TEST_CASE("how well a constant is known decides whether it is the cause") {
  Model truth = bench_model();
  Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  Model model = truth;
  model.set("heat_capacity_J_per_K", 50.0);
  model.uncertainty["thermal.heat_capacity_J_per_K"] = 0.2;
  CHECK(test::holds(diagnose(model, {train}, {held_out})));
}

TEST_CASE("a parameter of an effect that the model has is freed like a constant") {
  Model truth = axis_model();
  truth.effects["imbalance"] = {{"Nm", 0.006}, {"phase_rad", 0.5}};
  Recording train = axis_inputs(1500, 0.01, 3), held_out = axis_inputs(1000, 0.01, 4);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  Model model = truth;
  model.effects["imbalance"]["Nm"] = 0.0045;
  const Diagnosis diagnosis = diagnose(model, {train}, {held_out});
  INFO(diagnosis.reason);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause[0].effect == "calibration.imbalance.Nm");
  CHECK(diagnosis.augmented.get("effects.imbalance.Nm") == Approx(0.006).epsilon(0.02));
}

TEST_CASE("a cause that leaves a rest is named with what remains, and not called an explanation of all") {
  Model truth = axis_model();
  truth.effects["coulomb_friction"] = {{"Nm", 0.01}};
  Recording train = axis_inputs(1500, 0.01, 3), held_out = axis_inputs(1000, 0.01, 4);
  for (Recording* recording : {&train, &held_out}) {
    // It is shaken with a fifth of the friction; no column shows it.
    const Eigen::VectorXd drive = recording->column("drive_A");
    Eigen::VectorXd touched = drive;
    for (Eigen::Index row = 0; row < touched.size(); ++row)
      touched[row] += 0.02 * std::sin(recording->t_s[row] * 7.3);
    recording->set("drive_A", touched);
    measure(*recording, truth, recording == &train ? 5u : 6u);
    recording->set("drive_A", drive);
  }
  Options options;
  options.effects_at_once = 1;
  const Diagnosis diagnosis = diagnose(axis_model(), {train}, {held_out}, options);
  INFO(diagnosis.reason);
  // Forward and backward friction may differ or not: what remains hides it.
  CHECK((diagnosis.verdict == Verdict::partial || diagnosis.verdict == Verdict::ambiguous));
  CHECK(diagnosis.next_experiment.find("None needed") == std::string::npos);
  REQUIRE(diagnosis.cause.size() == 1);
  CHECK(diagnosis.cause[0].effect == "coulomb_friction");
  REQUIRE(diagnosis.remaining);
  CHECK(diagnosis.remaining->times_floor > 1.5);
  CHECK(diagnosis.remaining->share > 0.0);
  CHECK(diagnosis.remaining->share < 0.5);
  CHECK(diagnosis.augmented.effects.count("coulomb_friction") == 1);
}

TEST_CASE("two effects at once are both named") {
  Model truth = axis_model();
  truth.effects["coulomb_friction"] = {{"Nm", 0.008}};
  truth.effects["imbalance"] = {{"Nm", 0.006}, {"phase_rad", 0.5}};
  Recording train = axis_inputs(1500, 0.01, 3), held_out = axis_inputs(1000, 0.01, 4);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  const Diagnosis diagnosis = diagnose(axis_model(), {train}, {held_out});
  CHECK(test::causes_of(diagnosis) == std::vector<std::string>{"coulomb_friction", "imbalance"});
}

TEST_CASE("a gap that no effect explains is called unexplained") {
  Model truth = bench_model();
  Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
  measure(train, truth, 5);
  measure(held_out, truth, 6);
  for (Recording* recording : {&train, &held_out}) {
    Eigen::VectorXd motor_C = recording->column("motor_C");
    // A heater nearby that nobody logged: 3 K, switched with a period that no input has.
    for (Eigen::Index row = 0; row < motor_C.size(); ++row)
      motor_C[row] += 3.0 * std::sin(recording->t_s[row] / 41.0) * std::sin(recording->t_s[row] / 173.0);
    recording->set("motor_C", motor_C);
  }
  const Diagnosis diagnosis = diagnose(bench_model(), {train}, {held_out});
  CHECK(diagnosis.verdict == Verdict::unexplained);
  CHECK(diagnosis.cause.empty());
}

TEST_CASE("without the right effect in the catalogue no neighbour is named with confidence") {
  Options options;
  options.without = {"imbalance"};
  const Diagnosis diagnosis = diagnose_trial("imbalance", options);
  CHECK(diagnosis.verdict != Verdict::explained);
}

TEST_CASE("the result is the same digit for digit on one thread and on two") {
  Options two;
  two.threads = 2;
  CHECK(digits(diagnose_trial("forced_airflow")) == digits(diagnose_trial("forced_airflow", two)));
}

TEST_CASE("too little data is said to be too little") {
  Recording few = bench_inputs(8, 2.0, 3, true);
  measure(few, bench_model(), 5);
  CHECK(diagnose(bench_model(), {few}, {few}).verdict == Verdict::insufficient);
}

TEST_CASE("a part that lacks its columns is not judged, and the diagnosis says so") {
  const auto blind = [](std::uint64_t seed) {
    Recording recording = bench_inputs(300, 2.0, seed, true);
    measure(recording, bench_model(), seed + 2);
    recording.remove("current_A");
    return recording;
  };
  const Diagnosis diagnosis = diagnose(bench_model(), {blind(3)}, {blind(4)});
  REQUIRE(diagnosis.gap.size() == 1);
  CHECK(diagnosis.gap[0].signal == Signal::motor_C);
  REQUIRE(diagnosis.not_judged.size() == 1);
  CHECK_THAT(diagnosis.not_judged[0], ContainsSubstring("current_A"));
}

namespace {

/// A user's effect: the supply's ripple heats the motor with a constant power.
struct StandbyHeat {
  enum Parameters { heat_W };
  static EffectInfo info() {
    return {"standby_heat",
            Submodel::thermal_heating,
            "P += W",
            "A constant heat while nothing is driven.",
            {parameter(heat_W, "W").unit("W").within(0.0, 10.0).starts({0.0})},
            {Need::thermal_model, Need::motor_C},
            "a long rest"};
  }
  template <class Scalar>
  static void act(const Scalar* p, ThermalTerms<Scalar>& terms) {
    terms.heat_W += p[heat_W];
  }
};

}  // namespace

TEST_CASE("a user's own effect is found without any change to the engine") {
  Catalogue mine = standard_catalogue();
  mine.add<StandbyHeat>();
  CHECK_THROWS_AS(mine.add<StandbyHeat>(), InvalidInput);
  CHECK(standard_catalogue().find("standby_heat") == nullptr);
  Model truth = bench_model();
  truth.effects["standby_heat"] = {{"W", 1.5}};
  Recording train = bench_inputs(600, 2.0, 3, true), held_out = bench_inputs(400, 2.0, 4, true);
  measure(train, truth, 5, mine);
  measure(held_out, truth, 6, mine);
  // A constant heat looks like a constant error of the air temperature, so it need not come first.
  const Diagnosis diagnosis = diagnose(bench_model(), {train}, {held_out}, {}, mine);
  bool named = false;
  for (const Cause& cause : diagnosis.cause) named = named || cause.effect == "standby_heat";
  for (const std::vector<std::string>& set : diagnosis.alternatives)
    for (const std::string& id : set) named = named || id == "standby_heat";
  CHECK(named);
}

TEST_CASE("a diagnosis that is told to stop ends by saying so") {
  std::atomic<bool> stop{true};
  Options options;
  options.stop = &stop;
  for (const unsigned threads : {1u, 2u}) {
    options.threads = threads;
    CHECK_THROWS_AS(diagnose_trial(trials().front().id, options), Stopped);
  }
  stop = false;
  CHECK_NOTHROW(diagnose_trial(trials().front().id, options));
}
