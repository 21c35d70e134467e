// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../../catch.hpp"
#include "../fixture.hpp"
#include "../plants.hpp"

#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/gap/compare/covariance.hpp>
#include <thermopower/gap/fit/judgeable.hpp>
#include <thermopower/gap/report/estimates.hpp>
#include <thermopower/gap/report/parts.hpp>

#include <tuple>
#include <utility>

using namespace engine_fixture;

namespace {

/// Sums of one signal whose blocks have these mean squares.
SignalSums sums_of(const std::vector<double>& mean_squares, std::size_t per_block = 100) {
  std::vector<double> residuals;
  for (double mean : mean_squares)
    for (std::size_t i = 0; i < per_block; ++i) residuals.push_back(std::sqrt(mean));
  SignalSums sums;
  sums.set(3, residuals, 1.0);
  return sums;
}

std::vector<double> blocks(double even, double odd) {
  std::vector<double> list;
  for (std::size_t i = 0; i < SignalSums::block_count; ++i) list.push_back(i % 2 == 0 ? even : odd);
  return list;
}

/// An explanation whose fit ended at 0 in every coordinate, away from all bounds.
/// @param id  of its effect; null: it has none
Candidate at_zero(const Model& model, const char* id) {
  Candidate one;
  if (id != nullptr) one.explanation.effects.push_back(standard_catalogue().find(id));
  one.list = coordinates(model, one.explanation, standard_catalogue());
  one.fit.point = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(one.list.size()));
  one.fit.at_bound.assign(one.list.size(), false);
  return one;
}

/// No cause, dry friction, and another cause, known to 1e-4 of their units; the data are far above the noise without one.
std::vector<Candidate> nothing_friction_and(const Model& model, const char* other) {
  std::vector<Candidate> candidates{at_zero(model, nullptr), at_zero(model, "coulomb_friction"),
                                    at_zero(model, other)};
  for (Candidate& one : candidates) {
    const auto count = static_cast<Eigen::Index>(one.list.size());
    one.fit.information = Eigen::MatrixXd::Identity(count, count) * 1e8;
    one.train = one.held_out = sums_of(blocks(30.0, 30.0));
  }
  return candidates;
}

}  // namespace

TEST_CASE("the jackknife of a mean over blocks is its standard error") {
  Noise noise(5);
  std::vector<double> means;
  for (std::size_t i = 0; i < SignalSums::block_count; ++i) means.push_back(1.0 + noise.uniform());
  const SignalSums sums = sums_of(means);
  double mean = 0.0, square = 0.0;
  const double count = static_cast<double>(means.size());
  for (double one : means) mean += one / count;
  for (double one : means) square += (one - mean) * (one - mean);
  const Jackknifed got =
      block_jackknife(sums, sums, 1, [](const SignalSums& a, const SignalSums&) { return a.mean(3); });
  CHECK(got.value == Approx(mean));
  CHECK(got.standard_error == Approx(std::sqrt(square / (count - 1.0) / count)));
  CHECK(got.blocks == means.size());
}

TEST_CASE("what only some blocks prefer is weighed by how much the blocks differ") {
  const Model model = axis_model();
  const auto candidate = [&](const char* id, double even, double odd) {
    Candidate one;
    if (id != nullptr) one.explanation.effects.push_back(standard_catalogue().find(id));
    one.list = coordinates(model, one.explanation, standard_catalogue());
    one.fit.point = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(one.list.size()));
    one.fit.at_bound.assign(one.list.size(), false);
    one.train = one.held_out = sums_of(blocks(even, odd), 4000);
    return one;
  };
  // Both far above the noise; on the whole the second is 8 % better, in every other block it is worse.
  std::vector<Candidate> all{candidate(nullptr, 9000.0, 9000.0), candidate("imbalance", 100.0, 100.0),
                             candidate("cable_spring", 30.0, 140.0)};
  weigh(all, Weight(), model);
  CHECK(all[2].probability > all[1].probability);
  CHECK(all[1].probability > 0.02);
  // As much better everywhere, it is the one.
  all[2] = candidate("cable_spring", 85.0, 85.0);
  weigh(all, Weight(), model);
  CHECK(all[2].probability > 0.99);
}

TEST_CASE("what is better in every block is better beyond doubt, though a rival runs away in one of them") {
  // At a resonance that it does not have.
  std::vector<double> runs_away(SignalSums::block_count, 30.0);
  runs_away[5] = 1e7;
  const std::vector<double> noise_alone(SignalSums::block_count, 1.0);
  const SignalSums before = sums_of(runs_away), after = sums_of(noise_alone);
  const std::array<double, signal_count> correlation = Weight().correlation;
  const Jackknifed pooled = block_jackknife(before, after, 1, [](const SignalSums& a, const SignalSums& b) {
    return a.samples[3] * std::log(a.mean(3) / b.mean(3));
  });
  CHECK(pooled.value < decision.beyond_doubt * pooled.standard_error);
  BlockByBlock by_block;
  by_block.add(before, after, 1, correlation);
  // By hand: 100 readings a block, in 23 of them log 30 and in one log 1e7.
  CHECK(by_block.value() == Approx(100.0 * (23.0 * std::log(30.0) + std::log(1e7))));
  CHECK(by_block.value() > 5.0 * by_block.standard_error());
  CHECK(by_block.decides());
  const auto decides = [&](const std::vector<double>& worse, const SignalSums& better,
                           bool leaves_noise = false) {
    BlockByBlock one;
    one.add(sums_of(worse), better, 1, correlation);
    return one.decides(leaves_noise);
  };
  // What is better here and worse there is not proven so, nor what is a little better everywhere.
  CHECK_FALSE(decides(blocks(100.0, 100.0), sums_of(blocks(30.0, 140.0))));
  CHECK_FALSE(decides(blocks(2.6, 2.5), after));
  std::vector<double> hardly_above(SignalSums::block_count, 1.4);
  hardly_above[5] = 3.0;
  CHECK_FALSE(decides(hardly_above, after));
  CHECK_FALSE(decides(blocks(1.2, 1.3), after));
  // Blocks in which both are at the noise do not speak.
  std::vector<double> mostly_at_rest(SignalSums::block_count, 1.0);
  mostly_at_rest[5] = 1e7;
  mostly_at_rest[9] = 50.0;
  CHECK(decides(mostly_at_rest, after));
  // A little worse in most blocks and far worse where it runs away: that is its own error where the better one leaves the
  // noise alone, and may be one of both where it does not.
  std::vector<double> seldom_runs_away(SignalSums::block_count, 2.0);
  seldom_runs_away[5] = 1e7;
  CHECK_FALSE(decides(seldom_runs_away, after));
  CHECK(decides(seldom_runs_away, after, true));
  CHECK_FALSE(decides(blocks(100.0, 100.0), sums_of(blocks(30.0, 140.0)), true));
  CHECK_FALSE(decides(blocks(1.2, 1.3), after, true));

  const Model model = axis_model();
  std::vector<Candidate> candidates(2);
  candidates[1].explanation.effects.push_back(standard_catalogue().find("compliance"));
  for (Candidate& one : candidates) {
    one.list = coordinates(model, one.explanation, standard_catalogue());
    one.fit.point = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(one.list.size()));
    one.fit.at_bound.assign(one.list.size(), false);
    one.train = one.held_out = one.explanation.size() > 0 ? after : before;
  }
  weigh(candidates, Weight(), model);
  CHECK(candidates[1].probability > 0.99);
}

TEST_CASE("a cause that makes held-out data worse than constants do is not named, however well it fits") {
  const Model model = axis_model();
  std::vector<Candidate> candidates = nothing_friction_and(model, "cable_spring");
  candidates[2].train = sums_of(blocks(1.0, 1.0));
  candidates[2].held_out = sums_of(blocks(60.0, 60.0));
  weigh(candidates, Weight(), model);
  CHECK(candidates[2].makes_worse);
  CHECK(candidates[2].probability == 0.0);
  candidates[2].held_out = sums_of(blocks(20.0, 20.0));
  weigh(candidates, Weight(), model);
  CHECK_FALSE(candidates[2].makes_worse);
  CHECK(candidates[2].probability > 0.99);
}

TEST_CASE("friction that is alike in both directions is friction, and no rival of it") {
  const Model model = axis_model();
  std::vector<Candidate> candidates = nothing_friction_and(model, "asymmetric_friction");
  const auto constants = static_cast<Eigen::Index>(candidates[0].list.size());
  candidates[1].train = candidates[1].held_out = candidates[2].train = candidates[2].held_out =
      sums_of(blocks(1.0, 1.0));
  candidates[1].fit.point[constants] = 0.02;
  candidates[2].fit.point[constants] = 0.0201;
  candidates[2].fit.point[constants + 1] = 0.0199;
  Weight few;  // so few independent samples that a parameter costs next to nothing
  few.correlation.fill(1000.0);
  few.held_out.fill(1000.0);

  weigh(candidates, few, model);
  CHECK(candidates[2].probability == 0.0);
  CHECK(candidates[1].probability > 0.9);

  // 15 % apart, or not known to be less: then it may be the one or the other.
  candidates[2].fit.point[constants + 1] = 0.017;
  weigh(candidates, few, model);
  CHECK(candidates[2].probability > 0.05);
  candidates[2].fit.point[constants + 1] = 0.0199;
  candidates[2].fit.information *= 1e-4;  // 0.02 N m of uncertainty
  weigh(candidates, few, model);
  CHECK(candidates[2].probability > 0.05);

  // And where friction alone fits worse, they do not say the same.
  candidates[2].fit.information *= 1e4;
  candidates[1].train = candidates[1].held_out = sums_of(blocks(1.2, 1.2));
  weigh(candidates, few, model);
  CHECK(candidates[2].probability > 0.05);

  // Unless they are the same to a hundredth, and friction alone leaves what the noise allows: so small a difference is not what
  // a rest comes from.
  candidates[2].fit.point[constants + 1] = 0.02005;
  candidates[2].fit.information *= 1e2;
  weigh(candidates, few, model);
  CHECK(candidates[2].probability == 0.0);
  candidates[1].train = candidates[1].held_out = sums_of(blocks(1.8, 1.8));
  weigh(candidates, few, model);
  CHECK(candidates[2].probability > 0.05);
}

TEST_CASE(
    "two efficiencies say what a load friction says beside another torque constant, which is known to some error only") {
  Model model = axis_model();
  const auto judged = [&](double moved) {  // by what the torque constant moved beside the load friction alone
    std::vector<Candidate> candidates{at_zero(model, nullptr), at_zero(model, "load_friction"),
                                      at_zero(model, "drive_efficiency")};
    candidates[0].train = candidates[0].held_out = sums_of(blocks(30.0, 30.0));
    for (std::size_t i : {1u, 2u}) {
      candidates[i].train = candidates[i].held_out = sums_of(blocks(1.0, 1.0));
      const auto first = static_cast<Eigen::Index>(candidates[0].list.size());
      candidates[i].fit.point[first] = i == 1 ? 0.13 : 0.81;
      if (i == 2) candidates[i].fit.point[first + 1] = 0.96;
    }
    const std::vector<CalibratedConstant> constants = model.calibrated();
    std::size_t torque_constant = 0;
    while (constants[torque_constant].id != "torque_constant") ++torque_constant;
    // The data tell two things, to a thousandth. Beside a torque constant that is known to some error they tell both of a load's
    // friction, and of two efficiencies each of their products with it.
    const auto k = static_cast<Eigen::Index>(torque_constant);
    const auto first = static_cast<Eigen::Index>(constants.size());
    const double sd = model.uncertainty_of(constants[torque_constant]);
    for (std::size_t i : {1u, 2u}) {
      Eigen::MatrixXd& information = candidates[i].fit.information;
      const auto count = static_cast<Eigen::Index>(candidates[i].list.size());
      information = 1e6 * Eigen::MatrixXd::Identity(count, count);
      if (i == 2) {
        information(k, k) = 2e6;
        for (const Eigen::Index one : {first, first + 1}) information(k, one) = information(one, k) = 1e6;
      }
      information(k, k) += 1.0 / (sd * sd);
    }
    candidates[1].fit.point[static_cast<Eigen::Index>(torque_constant)] = moved;
    weigh(candidates, Weight(), model);
    return std::pair(candidates[1].probability, candidates[2].probability);
  };
  // The one says where the torque constant is, to 5 %, and the other one where an efficiency is, between 0.05 and 1.
  const double odds = 0.95 / (0.05 * std::sqrt(2.0 * 3.14159265));
  const auto [unmoved, beside_unmoved] = judged(0.0);
  CHECK(unmoved / beside_unmoved == Approx(odds).epsilon(1e-3));
  // Moved by four times what is known, it is a further thing that is wrong, besides: by Cauchy's density.
  const auto [moved, beside_moved] = judged(-0.2);
  CHECK(moved / beside_moved == Approx(odds / (1.0 + 16.0) * std::exp(-0.5 * usual_rarity)).epsilon(1e-3));
  // Whoever has measured it gets an answer.
  model.uncertainty["axis.torque_constant_Nm_per_A"] = 0.005;
  CHECK(judged(0.0).first > 0.95);
  CHECK(judged(-0.2).second > 0.95);
}

TEST_CASE("friction that hardly rises near standstill is friction where that leaves what the noise allows") {
  const Model model = axis_model();
  std::vector<Candidate> candidates = nothing_friction_and(model, "stribeck_friction");
  const auto constants = static_cast<Eigen::Index>(candidates[0].list.size());
  candidates[1].fit.point[constants] = candidates[2].fit.point[constants] = 0.02;
  candidates[2].fit.point[constants + 1] = 0.0005;         // the rise
  candidates[2].fit.point[constants + 2] = std::log(0.5);  // its knee, above the transition
  candidates[2].fit.point[constants + 3] = std::log(0.01);
  candidates[1].train = candidates[1].held_out = sums_of(blocks(1.1, 1.1));
  candidates[2].train = candidates[2].held_out = sums_of(blocks(1.0, 1.0));

  weigh(candidates, Weight(), model);
  CHECK(candidates[2].probability == 0.0);
  CHECK(candidates[1].probability > 0.9);

  // A rise that matters, or one that the data do not tell from such a one, or friction that leaves more than noise.
  candidates[2].fit.point[constants + 1] = 0.004;
  weigh(candidates, Weight(), model);
  CHECK(candidates[2].probability > 0.9);
  candidates[2].fit.point[constants + 1] = 0.0005;
  candidates[2].fit.information *= 1e-4;  // 0.02 N m of uncertainty
  weigh(candidates, Weight(), model);
  CHECK(candidates[2].probability > 0.9);
  candidates[2].fit.information *= 1e4;
  candidates[1].train = candidates[1].held_out = sums_of(blocks(1.8, 1.8));
  weigh(candidates, Weight(), model);
  CHECK(candidates[2].probability > 0.9);
}

TEST_CASE("a friction backward that no motion tells is no friction that differs by direction") {
  const Model model = axis_model();
  Candidate one = at_zero(model, "asymmetric_friction");
  const auto count = static_cast<Eigen::Index>(one.list.size());
  const Eigen::Index forward = count - 4, backward = count - 3;
  REQUIRE(one.list[static_cast<std::size_t>(backward)].name == "asymmetric_friction.backward_Nm");
  one.fit.point[forward] = 0.02;
  one.fit.information = Eigen::MatrixXd::Identity(count, count) * 1e8;
  CHECK_FALSE(ends_on_bounds(one, model));
  one.fit.information(backward, backward) = 100.0;  // 0.02 N m change the sum of squares by 0.04
  CHECK(ends_on_bounds(one, model));
}

TEST_CASE("what is damped too much to ring is no part on a spring, and what rings without an end is one") {
  const Model model = axis_model();
  Candidate one = at_zero(model, "compliance");
  const std::size_t damping = one.list.size() - 1;
  REQUIRE(one.list[damping].name == "compliance.damping");
  const auto at = static_cast<Eigen::Index>(damping);
  for (const auto& [damped, is_at_bound] : {std::pair(0.05, false), std::pair(1e-4, true)}) {
    one.fit.point[at] = std::log(damped);
    one.fit.at_bound[damping] = is_at_bound;
    CHECK_FALSE(ends_on_bounds(one, model));
  }
  one.fit.point[at] = std::log(2.0);
  CHECK(ends_on_bounds(one, model));
}

TEST_CASE("a ripple that takes nearly all of the torque away at some angles is none") {
  const Model model = axis_model();
  Candidate one = at_zero(model, "torque_ripple");
  const auto at = static_cast<Eigen::Index>(model.calibrated().size());
  one.fit.point[at + 2] = 6.0;
  for (const auto& [sine, cosine, is_none] :
       {std::tuple(0.5, -0.6, false), {0.6, -0.8, true}, {0.0, 0.95, true}}) {
    one.fit.point[at] = sine;
    one.fit.point[at + 1] = cosine;
    CHECK(ends_on_bounds(one, model) == is_none);
  }
}

TEST_CASE(
    "a cog that is longer than the travel is one where it reaches the noise, but not where it is as long as it may be") {
  const Model model = axis_model();
  Candidate one = at_zero(model, "cogging");
  const auto count = static_cast<Eigen::Index>(model.calibrated().size()) + 2;
  REQUIRE(one.list[static_cast<std::size_t>(count)].name == "cogging.cycles_per_turn");
  Shown shown;
  shown.travel_rad = 2.0;  // a third of a turn
  for (const auto& [cycles, reaches_the_noise, is_none] : {std::tuple(9.0, false, false),
                                                           {3.0, false, true},
                                                           {3.0, true, false},
                                                           {1.6, true, true},
                                                           {1.6, false, true}}) {
    one.fit.point[count] = cycles;
    shown.by_reaching_the_noise = reaches_the_noise;
    CAPTURE(cycles, reaches_the_noise);
    CHECK(ends_on_bounds(one, model, shown) == is_none);
  }
}

TEST_CASE("a loss that grows faster than that of rising air is not rising air's") {
  const Model model = bench_model();
  Candidate one = at_zero(model, "natural_convection");
  const auto at = static_cast<Eigen::Index>(model.calibrated().size());
  one.fit.point[at + 1] = std::log(30.0);
  for (const auto& [exponent, is_none] : {std::pair(0.25, false), {0.4, false}, {0.75, true}}) {
    one.fit.point[at] = exponent;
    CHECK(ends_on_bounds(one, model) == is_none);
  }
}

TEST_CASE("a friction near standstill that vanishes in motion is none, but beside another one") {
  Model model = axis_model();
  const auto ends_so = [&](double in_motion_Nm) {
    Candidate one = at_zero(model, "stribeck_friction");
    const auto at = static_cast<Eigen::Index>(model.calibrated().size());
    one.fit.point[at] = in_motion_Nm;
    one.fit.point[at + 1] = 0.01;  // the rise
    one.fit.point[at + 3] = -2.0;  // the transition, below the knee
    one.fit.point[at + 5] = 2.0;
    return ends_on_bounds(one, model);
  };
  CHECK_FALSE(ends_so(0.004));
  CHECK_FALSE(ends_so(0.001));
  CHECK(ends_so(0.0002));
  CHECK(ends_so(0.0));
  model.effects["coulomb_friction"] = {{"Nm", 0.004}, {"transition_rad_per_s", 0.01}};
  CHECK_FALSE(ends_so(0.0));
}

TEST_CASE("a gear that passes less than a tenth of the torque is none") {
  const Model model = axis_model();
  for (const auto& [id, lossy, blocked] :
       {std::tuple("drive_efficiency", 0.15, 0.06), {"load_friction", 0.85, 0.94}}) {
    CAPTURE(id);
    Candidate one = at_zero(model, id);
    const auto constants = static_cast<Eigen::Index>(model.calibrated().size());
    one.fit.point.tail(one.fit.point.size() - constants).setConstant(0.5);
    one.fit.point[constants] = lossy;
    CHECK_FALSE(ends_on_bounds(one, model));
    one.fit.point[constants] = blocked;
    CHECK(ends_on_bounds(one, model));
  }
}

TEST_CASE("what fits its own data clearly worse is not as good, though it does better on fewer others") {
  const Model model = axis_model();
  std::vector<Candidate> candidates = nothing_friction_and(model, "asymmetric_friction");
  Candidate &simple = candidates[1], &rich = candidates[2];
  rich.train = sums_of(blocks(1.0, 1.0));
  rich.held_out = sums_of(blocks(1.2, 1.2));
  simple.held_out = sums_of(blocks(0.98, 0.98));
  simple.train = sums_of(blocks(1.05, 1.05));
  CHECK(scores_alike(simple, rich));
  simple.train = sums_of(blocks(1.3, 1.3));
  CHECK_FALSE(scores_alike(simple, rich));
}

TEST_CASE("a sink that does not change in a run is no sink, but air of another temperature") {
  const auto lasts = [](double longest_run_s) {
    Shown shown;
    shown.longest_run_s = longest_run_s;
    return shown;
  };
  const Model model = bench_model();
  Candidate one = at_zero(model, "contact_resistance");
  const auto count = static_cast<Eigen::Index>(one.list.size());
  REQUIRE(one.list[static_cast<std::size_t>(count - 3)].name == "contact_resistance.J_per_K");
  one.fit.point[count - 3] = std::log(100.0);
  one.fit.point[count - 2] = std::log(10.0);  // 1000 s
  CHECK_FALSE(ends_on_bounds(one, model));
  CHECK_FALSE(ends_on_bounds(one, model, lasts(1200.0)));
  CHECK(ends_on_bounds(one, model, lasts(800.0)));
  one.fit.point[count - 1] = 0.1;  // half of the heat leaves by the air: 500 s
  CHECK_FALSE(ends_on_bounds(one, model, lasts(800.0)));
}

TEST_CASE("a rise of friction whose knee no motion reaches is not told from a drag") {
  const Model model = axis_model();
  std::vector<Candidate> candidates = nothing_friction_and(model, "stribeck_friction");
  Candidate& one = candidates[2];
  const auto constants = static_cast<Eigen::Index>(candidates[0].list.size());
  one.fit.point[constants] = 0.02;      // what stays in motion
  one.fit.point[constants + 1] = 0.02;  // the rise
  one.fit.point[constants + 2] = std::log(2.0);
  one.fit.point[constants + 3] = std::log(0.01);
  REQUIRE(one.list[static_cast<std::size_t>(constants) + 2].name == "stribeck_friction.knee_rad_per_s");
  Shown shown;
  CHECK_FALSE(ends_on_bounds(one, model, shown));
  shown.fastest_rad_per_s = 5.0;
  CHECK_FALSE(ends_on_bounds(one, model, shown));
  shown.fastest_rad_per_s = 1.5;
  CHECK(ends_on_bounds(one, model, shown));
}

TEST_CASE("how fast an axis went is read from its rate, or from its angle, and not from their noise") {
  Recording r = axis_inputs(4000, 0.01, 3);
  Eigen::VectorXd angle(r.rows()), rate(r.rows());
  Noise noise(4);
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    angle[i] = 100.0 * std::sin(0.02 * static_cast<double>(i)) + 0.05 * noise.normal();
    rate[i] = 200.0 * std::cos(0.02 * static_cast<double>(i)) + 0.5 * noise.normal();
  }
  r.set("angle_deg", angle);
  const double fastest = 200.0 * rad_per_deg;
  CHECK(shown_by({prepare(axis_model(), r)}).fastest_rad_per_s == Approx(fastest).epsilon(0.02));
  r.set("rate_dps", rate);
  CHECK(shown_by({prepare(axis_model(), r)}).fastest_rad_per_s == Approx(fastest).epsilon(0.02));
  CHECK(shown_by({}).fastest_rad_per_s == Shown().fastest_rad_per_s);
}

TEST_CASE("a fit's coordinate is the value or its logarithm, there and back") {
  Coordinate one;
  CHECK(one.value_of(-2.5) == -2.5);
  CHECK(one.coordinate_of(-2.5) == -2.5);
  one.logarithmic = true;
  CHECK(one.value_of(0.0) == 1.0);
  CHECK(one.value_of(std::log(40.0)) == Approx(40.0));
  CHECK(one.coordinate_of(40.0) == std::log(40.0));
}

TEST_CASE("a detail of an effect's shape is neither moved nor counted until it is looked at") {
  const Model model = axis_model();
  Explanation cogging{{standard_catalogue().find("cogging")}, {}};
  CHECK(cogging.parameter_count() == 3);
  CHECK(cogging.can_be_refined());
  std::vector<Coordinate> list = coordinates(model, cogging, standard_catalogue());
  REQUIRE(list.back().name == "cogging.second_cos");
  CHECK(list.back().still);
  CHECK(list.back().lower == list.back().upper);
  const Eigen::VectorXd at = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(list.size()));
  const ParameterPoint point = point_of(model, cogging, list, at);
  CHECK(point.directions() == point.size() - 2);
  CHECK(point.direction(point.size() - 1) == -1);
  CHECK(point.direction(0) == 0);

  cogging.refined = true;
  CHECK(cogging.parameter_count() == 5);
  CHECK_FALSE(cogging.can_be_refined());
  list = coordinates(model, cogging, standard_catalogue());
  CHECK_FALSE(list.back().still);
  CHECK(list.back().lower < list.back().upper);
  CHECK(point_of(model, cogging, list, at).directions() == point.size());
}

namespace {

/// A fit of one parameter, a mean of residuals of variance 1, of which as many as make a block pull together.
Candidate mean_of_blocks(const Eigen::VectorXd& pulls, double samples_of_block) {
  Candidate one;
  one.list.resize(1);
  one.fit.point = Eigen::VectorXd::Zero(1);
  one.fit.information = Eigen::MatrixXd::Constant(1, 1, samples_of_block * static_cast<double>(pulls.size()));
  one.fit.priors = Eigen::MatrixXd::Zero(1, 1);
  one.fit.pulls = pulls.transpose();
  return one;
}

/// How often an interval of a mean of noise holds it. @param remembered  from one block to the next
double coverage_of_means(double remembered, int blocks) {
  constexpr int draws = 2000;
  constexpr double samples_of_block = 100.0;
  test::Noise noise(static_cast<std::uint64_t>(blocks) + 7);
  int held = 0;
  for (int draw = 0; draw < draws; ++draw) {
    Eigen::VectorXd sums(blocks);
    double last = noise();
    for (double& sum : sums) {
      last = remembered * last + std::sqrt(1.0 - remembered * remembered) * noise();
      sum = std::sqrt(samples_of_block) * last;
    }
    const double mean = sums.sum() / (samples_of_block * blocks);
    const Eigen::VectorXd pulls =
        sums.array() - samples_of_block * mean;  // at the minimum they pull against each other
    const Covariance covariance = covariance_of(mean_of_blocks(pulls, samples_of_block), Weight());
    held += std::abs(mean) <= covariance.quantile * std::sqrt(covariance.of(0, 0)) ? 1 : 0;
  }
  return static_cast<double>(held) / draws;
}

}  // namespace

TEST_CASE("an interval of a parameter holds it as often as it says, though noise lasts longer than a block") {
  CHECK(coverage_of_means(0.0, 40) == Approx(0.955).margin(0.02));
  CHECK(coverage_of_means(0.5, 80) == Approx(0.945).margin(0.025));
  CHECK(coverage_of_means(0.8, 200) == Approx(0.945).margin(0.025));
}

TEST_CASE("what only a prior knows stays as uncertain as that, however many samples it counts for") {
  constexpr double sd = 0.05;
  for (const double samples_as_one : {1.0, 40.0}) {
    CAPTURE(samples_as_one);
    Candidate one = mean_of_blocks(Eigen::VectorXd::Zero(40), 1.0);
    one.fit.per_prior = samples_as_one;
    one.fit.priors(0, 0) = one.fit.information(0, 0) = samples_as_one / (sd * sd);
    CHECK(std::sqrt(covariance_of(one, Weight()).of(0, 0)) == Approx(sd));
  }
}

TEST_CASE(
    "what priors know of differences between coordinates is taken off whole, and no variance is negative") {
  // Three knots of a curve: the data tell their sum, a prior that they lie on a line, another how large each is.
  Candidate one = mean_of_blocks(Eigen::VectorXd::Zero(40), 1.0);
  one.list.resize(3);
  one.fit.point = Eigen::VectorXd::Zero(3);
  one.fit.pulls = Eigen::MatrixXd::Zero(3, 40);
  const Eigen::Vector3d bend(1.0, -2.0, 1.0), all = Eigen::Vector3d::Ones();
  one.fit.priors = 50.0 * bend * bend.transpose() + 0.01 * Eigen::Matrix3d::Identity();
  one.fit.information = one.fit.priors + 400.0 * all * all.transpose();
  const Covariance covariance = covariance_of(one, Weight());
  // A slope moves no sum and bends nothing: only the prior of the sizes knows it.
  const Eigen::Vector3d slope = Eigen::Vector3d(-1.0, 0.0, 1.0).normalized();
  CHECK(slope.dot(covariance.of * slope) == Approx(100.0).epsilon(0.01));
  for (Eigen::Index i = 0; i < 3; ++i) CHECK(covariance.of(i, i) > 0.0);
}

TEST_CASE("of a parameter that the data say nothing of, any value in its range is as good") {
  constexpr double information = 1e4;
  for (const double known : {0.0, information}) {
    CAPTURE(known);
    Candidate one = mean_of_blocks(Eigen::VectorXd::Zero(40), 1.0);
    one.list[0].lower = -0.5;
    one.list[0].upper = 1.0;
    one.fit.at_bound = {false};
    one.fit.information(0, 0) = known;
    const ParameterEstimate estimate = estimates(one, Model{}, covariance_of(one, Weight())).front();
    const Interval interval = estimate.ci95;
    CHECK(estimate.told == (known > 0.0));
    if (known > 0.0)
      CHECK(interval.high - interval.low == Approx(2.0 * 1.96 / std::sqrt(information)).epsilon(0.1));
    else CHECK((interval.low == -0.5 && interval.high == 1.0));
  }
}

TEST_CASE(
    "what a simulation makes of the noise of its starts is noise only where it follows the data it was fitted to") {
  Candidate one;
  one.train =
      sums_of(blocks(4.0, 4.0));  // twice the noise, as blows make that hang on the last digit of a start
  CHECK(follows_its_data(one));
  one.train = sums_of(blocks(64.0, 64.0));
  CHECK_FALSE(follows_its_data(one));

  Model loose = axis_model();
  loose.effects["backlash"] = {{"gap_rad", 0.1}, {"far_share", 0.6}, {"contact_Hz", 20.0}, {"damping", 0.02}};
  Recording recording;
  recording.name = "shaken";
  constexpr Eigen::Index rows = 1500;
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * (rows - 1));
  Eigen::VectorXd drive(rows), still = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index i = 0; i < rows; ++i) drive[i] = (i / 20) % 3 == 0 ? 0.4 : -0.2;
  recording.set("drive_A", drive);
  recording.set("angle_deg", still);
  recording.set("rate_dps", still);
  const std::vector<Inputs> inputs{prepare(loose, recording)};
  const std::vector<Segment> segments = cut(inputs, 0.5, plant_of(loose));
  const Errors errors = errors_of(loose, segments, standard_catalogue());
  auto sigma = thermopower::plant::for_each_signal(1.0);
  sigma[static_cast<std::size_t>(Signal::angle_deg)] = 0.02;
  sigma[static_cast<std::size_t>(Signal::rate_dps)] = 0.15;
  const auto rate = static_cast<std::size_t>(Signal::rate_dps);
  const FirstReadings first = FirstReadings::as_they_are;
  const double stiff = floor_of(axis_model(), errors, sigma, segments, standard_catalogue(), first)[rate];
  CHECK(floor_of(loose, errors, sigma, segments, standard_catalogue(), first)[rate] > 3.0 * stiff);
  Diagnosis followed, missed;
  score(followed, axis_model(), segments, inputs, loose, true, {}, {}, standard_catalogue());
  score(missed, axis_model(), segments, inputs, loose, false, {}, {}, standard_catalogue());
  REQUIRE(followed.gap.size() == missed.gap.size());
  for (std::size_t i = 0; i < followed.gap.size(); ++i)
    CHECK(missed.gap[i].noise_floor < followed.gap[i].noise_floor);
}

TEST_CASE("a noise floor that the best simulation is far below is too high") {
  Recording recording;
  recording.name = "at rest";
  constexpr Eigen::Index rows = 400;
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(rows);
  recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * (rows - 1));
  for (const char* column : {"drive_A", "angle_deg", "rate_dps"}) recording.set(column, still);
  const Model model = axis_model();
  const std::vector<Inputs> inputs{prepare(model, recording)};
  const std::vector<Segment> segments = cut(inputs, 0.5, plant_of(model));
  const auto rate = static_cast<std::size_t>(Signal::rate_dps);
  // What was taken for the noise of the sensor is 1 deg/s, and a simulation is off by less.
  const auto sigma = thermopower::plant::for_each_signal(1.0);
  const auto floor_where_off_by = [&](double rms_dps) {
    Errors errors = errors_of(model, segments, standard_catalogue());
    for (double& one : errors.of[rate]) one = rms_dps;
    return floor_of(model, errors, sigma, segments, standard_catalogue(), FirstReadings::as_they_are)[rate];
  };
  CHECK(floor_where_off_by(0.05) == Approx(0.05 * floor_known_to));
  CHECK(floor_where_off_by(50.0) == floor_where_off_by(100.0));
  CHECK(floor_where_off_by(50.0) >= 1.0);
}

TEST_CASE("a beginning that bends, as that of a thermometer that lags, is no first reading that is off") {
  constexpr int draws = 40;
  constexpr double noise_C = 0.05;
  const Model model = test::bench_model();
  const auto begin_off = [&](bool lags, double off_C) {
    int count = 0;
    for (unsigned seed = 1; seed <= draws; ++seed) {
      constexpr Eigen::Index rows = 200;
      test::Noise noise(seed);
      Recording recording;
      recording.name = "beginning";
      recording.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, rows - 1.0);
      Eigen::VectorXd motor(rows);
      double body_C = 24.0, shown_C = 24.0;
      for (Eigen::Index i = 0; i < rows; ++i) {
        motor[i] = (lags ? shown_C : body_C) + noise_C * noise();
        for (int k = 0; k < 10; ++k) {
          body_C += 0.1 * (0.5 - 0.01 * (body_C - 24.0));
          shown_C += 0.1 * (body_C - shown_C) / 8.0;
        }
      }
      motor[0] += off_C;
      recording.set("power_param", Eigen::VectorXd::Constant(rows, 180.0));
      recording.set("ambient_C", Eigen::VectorXd::Constant(rows, 24.0));
      recording.set("motor_C", motor);
      const std::vector<Inputs> inputs{prepare(model, recording)};
      const std::vector<Segment> segments = cut(inputs, 0.0, plant_of(model));
      REQUIRE(segments.size() == 1);
      count += begins_off(plant_of(model), segments.front()) ? 1 : 0;
    }
    return count;
  };
  // A first sample is off by more than 1.2 deviations by chance in one of five.
  CHECK(begin_off(false, 0.0) < draws / 2);
  CHECK(begin_off(true, 0.0) < draws / 2);
  CHECK(begin_off(false, 6.0 * noise_C) > 9 * draws / 10);
}

TEST_CASE("a spring is looked for where rows show the inertia that it hangs on, and nowhere else") {
  Model model = axis_model();
  const std::vector<Inputs> inputs{
      PreparedRecording(model, test::axis_recording({}, 500, 1)).inputs()};  // a row every 10 ms
  const auto is_judged = [&](const char* id) {
    return can_be_judged(*standard_catalogue().find(id), model, inputs);
  };
  CHECK(is_judged("compliance"));
  CHECK(is_judged("backlash"));
  model.axis->viscous_Nms_per_rad = model.axis->inertia_kgm2 / 1e-3;  // it settles in a millisecond
  CHECK_FALSE(is_judged("compliance"));
  CHECK_FALSE(is_judged("backlash"));
  CHECK(is_judged("coulomb_friction"));
  // What the motor's own voltage brakes settles it, too.
  model.axis->viscous_Nms_per_rad = 0.0;
  CHECK(is_judged("compliance"));
  model.axis->resistance_ohm =
      1e-3 * std::pow(model.axis->torque_constant_Nm_per_A, 2.0) / model.axis->inertia_kgm2;
  CHECK_FALSE(is_judged("compliance"));
}
