// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What the engine does to be fast must not change what it finds: long steps, shortened recordings, and a weighing
// that does not count rows.
#include "../../catch.hpp"
#include "../fixture.hpp"

#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/fit/segment_choice.hpp>
#include <thermopower/gap/fit/thinning.hpp>

using namespace engine_fixture;

namespace {

Model two_nodes(double coupling_W_per_K) {
  Model model = bench_model();
  model.effects["second_thermal_mass"] = {{"winding_share", 0.2}, {"coupling", coupling_W_per_K}};
  return model;
}

/// Power that changes every `hold_s`, logged every `dt_s`.
Recording switching(double dt_s, double hold_s, double lasts_s) {
  const auto rows = static_cast<Eigen::Index>(lasts_s / dt_s) + 1;
  Recording recording;
  recording.name = "switching";
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, lasts_s);
  Eigen::VectorXd power(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto block = static_cast<std::uint64_t>(recording.t_s[row] / hold_s + 1e-9);
    power[row] = 50.0 * static_cast<double>(block * 7 % 6);
  }
  recording.set("power_param", power);
  recording.set("ambient_C", Eigen::VectorXd::Constant(rows, 24.0));
  recording.set("motor_C", Eigen::VectorXd::Constant(rows, 25.0));
  recording.set("current_A", Eigen::VectorXd::Zero(rows));
  return recording;
}

/// Temperatures of a simulation every `every_s`.
std::vector<double> temperatures(const Model& model, const Recording& recording, double every_s) {
  const Inputs inputs = prepare(model, recording);
  const Instance<double> instance(model, {}, {}, standard_catalogue());
  const BenchRollout<double> rollout(instance, inputs);
  BenchState<double> state = rollout.start(0, 25.0);
  std::vector<double> result;
  double next_s = 0.0;
  rollout.run(0, inputs.rows(), 0.0, state, [&](Eigen::Index row, const BenchReadings<double>& read) {
    if (inputs.t_s[row] + 1e-6 < next_s) return;
    result.push_back(read.motor_C);
    next_s += every_s;
  });
  return result;
}

double furthest(const std::vector<double>& a, const std::vector<double>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Fit of one effect to recordings, shortened to `rows` rows or whole.
Candidate fitted(const Model& model, const std::string& id, const Inputs& inputs) {
  FitProblem problem;
  problem.model = &model;
  problem.catalogue = &standard_catalogue();
  problem.plant().cut(inputs, 0.5, problem.segments);
  problem.sigma = {0.002, 0.05, 0.02, 0.15};
  return Attribution(problem).fit({{standard_catalogue().find(id)}, {}}, {});
}

}  // namespace

TEST_CASE("a long interval of two nodes is as many short ones, however closely they are coupled") {
  for (const double coupling_W_per_K : {0.3, 3.0, 30.0, 900.0}) {
    CAPTURE(coupling_W_per_K);
    const Model model = two_nodes(coupling_W_per_K);
    const std::vector<double> fine = temperatures(model, switching(0.005, 120.0, 1200.0), 60.0);
    CHECK(furthest(temperatures(model, switching(60.0, 120.0, 1200.0), 60.0), fine) < 0.02);
    CHECK(furthest(temperatures(model, switching(4.0, 120.0, 1200.0), 60.0), fine) < 0.02);
  }
}

TEST_CASE("the exchange of two nodes alone is exact for any step") {
  // Two nodes of 0.4 and 0.1 1/s and no air: the sum weighted by capacity stays, the difference decays.
  ExchangeStep<double> step(0.4, 0.1, 0.0);
  step.set_length(3.0);
  const ExchangeStep<double>::Pair slope = step.exchanged({10.0, 0.0}), moved = step.moved(slope);
  const double left_K = 10.0 * std::exp(-0.5 * 3.0), common_K = 10.0 * 0.1 / 0.5;
  CHECK(10.0 + moved.winding == Approx(common_K + left_K * 0.8));
  CHECK(moved.surface == Approx(common_K - left_K * 0.2));
  // A change of the rest that grows in proportion to time, 1 K/s in all, on both nodes alike: h / 2 of it.
  CHECK(step.corrected({1.0, 1.0}).winding == Approx(1.5));
}

TEST_CASE("a shortened recording finds the effect that the whole one holds") {
  struct Case {
    const char* id;
    const char* parameter;
    double value;
  };
  const Case cases[] = {{"back_emf", "V_s_per_rad", 0.3},
                        {"motion_heating", "W_s2_per_rad2", 0.2},
                        {"radiation", "emissive_area_m2", 0.02},
                        {"series_resistance", "ohm", 0.5}};
  for (const Case& one : cases) {
    CAPTURE(one.id);
    const Model model = bench_model();
    Model truth = model;
    truth.effects[one.id] = {{one.parameter, one.value}};
    Recording recording = bench_inputs(20000, 0.5, 3, false);
    Noise noise(9);
    Eigen::VectorXd rate(recording.rows());
    for (double& now : rate) now = 300.0 * noise.uniform() * noise.uniform();  // another one in every row
    recording.set("rate_dps", rate);
    measure(recording, truth, 17);
    const Inputs whole = prepare(model, recording);
    const Inputs thin = thinned_bench(whole, 1500, model, standard_catalogue());
    CHECK(thin.rows() < 6000);
    const Candidate fit = fitted(model, one.id, thin);
    CHECK(fit.fit.point[fit.fit.point.size() - 1] == Approx(one.value).epsilon(0.01));
  }
}

TEST_CASE("shortening keeps the mean error of the simulation under test, block by block") {
  const Model model = bench_model();
  Model truth = model;
  truth.effects["radiation"] = {{"emissive_area_m2", 0.02}};
  Recording recording = bench_inputs(8000, 1.0, 5, false);
  measure(recording, truth, 6);
  const Inputs whole = prepare(model, recording);
  const Inputs thin = thinned_bench(whole, 600, model, standard_catalogue());
  REQUIRE(thin.rows() < 4000);
  const auto mean_error = [&](const Inputs& inputs) {
    FitProblem problem;
    problem.model = &model;
    problem.catalogue = &standard_catalogue();
    problem.plant().cut(inputs, 0.5, problem.segments);
    const std::vector<Coordinate> list = coordinates(model, {}, standard_catalogue());
    double sum = 0.0, count = 0.0;
    problem.evaluate({}, list, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(list.size())),
                     problem.measured_starts(), false, [&](std::size_t, const FitProblem::Residuals& one) {
                       for (Eigen::Index i = 0; i < one.value.size(); ++i) {
                         const auto at = static_cast<std::size_t>(i);
                         if (one.signal[at] != Signal::motor_C) continue;
                         const double repeats = inputs.repeats.size() > 0 ? inputs.repeats[one.row[at]] : 1.0;
                         sum += one.value[i] * std::sqrt(repeats);
                         count += repeats;
                       }
                     });
    return sum / count;
  };
  CHECK(mean_error(thin) == Approx(mean_error(whole)).epsilon(0.002));
}

TEST_CASE("of many runs a quick look takes some, spread over all and at least six") {
  Inputs inputs;
  std::vector<Segment> segments;
  for (Eigen::Index run = 0; run < 40; ++run)
    segments.push_back({&inputs, {100 * run, 100 * run + 100, ""}, 100 * run, 100 * run + 100, false, false});
  const std::vector<Segment> kept = thinned_runs(segments, 1000);
  CHECK(kept.size() >= 8);
  CHECK(kept.size() <= 12);
  int even = 0;
  for (const Segment& segment : kept) even += segment.begin / 100 % 2 == 0;
  CHECK(even >= 3);
  CHECK(even <= 8);
  CHECK(kept.front().begin < 1000);
  CHECK(kept.back().begin >= 3000);
  CHECK(thinned_runs(segments, 100).size() >= 6);
  CHECK(thinned_runs(segments, 4000).size() == 40);
}

TEST_CASE("what scores alike where it matters is told apart by its number of parameters, not by its rows") {
  const Model model = axis_model();
  const auto candidate = [&](const char* id, double train, double held_out) {
    Candidate one;
    if (id != nullptr) one.explanation.effects.push_back(standard_catalogue().find(id));
    one.list = coordinates(model, one.explanation, standard_catalogue());
    one.fit.point = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(one.list.size()));
    for (std::size_t i = 0; i < one.list.size(); ++i)
      one.fit.point[static_cast<Eigen::Index>(i)] = one.list[i].start;
    one.fit.at_bound.assign(one.list.size(), false);
    one.train.samples[3] = one.held_out.samples[3] = 1e5;
    one.train.squares[3] = 1e5 * train * train;
    one.held_out.squares[3] = 1e5 * held_out * held_out;
    return one;
  };
  const auto weighed = [&](double coulomb_held_out) {
    std::vector<Candidate> all{candidate(nullptr, 20.0, 20.0),
                               candidate("coulomb_friction", 1.012, coulomb_held_out),
                               candidate("stribeck_friction", 1.0, 1.0)};
    weigh(all, Weight(), model);
    return all;
  };
  CHECK(weighed(1.003)[1].probability > 0.99);  // 0.3 % worse on held-out data: the simpler one
  CHECK(weighed(1.030)[2].probability > 0.99);  // 3 %: the one that fits
}
