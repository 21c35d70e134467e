// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "../catch.hpp"
#include "fixture.hpp"

#include <thermopower/gap/decide/verdict.hpp>

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

}  // namespace

TEST_CASE("the price of a constant grows like a square near what is known and like a logarithm far away") {
  const Prior prior{0.05};
  CHECK(prior.cost(0.0) == 0.0);
  CHECK(prior.cost(0.005) == Approx(1.5 * 0.01).epsilon(0.01));
  const double far = prior.cost(10.0) - prior.cost(5.0);
  CHECK(far == Approx(3.0 * std::log(4.0)).epsilon(0.001));
  // Its weight has the gradient of half the cost.
  for (double at : {0.01, 0.1, 0.7}) {
    const double step = 1e-6, slope = (prior.cost(at + step) - prior.cost(at - step)) / (2.0 * step);
    CHECK(prior.weight(at) * at == Approx(0.5 * slope).epsilon(1e-6));
  }
  CHECK(Prior{}.cost(3.0) == 0.0);
  // What decides between explanations prefers one constant that is far off to two that are half as far off.
  CHECK(prior.price(std::log(1.2)) < 2.0 * prior.price(0.5 * std::log(1.2)));
  CHECK(prior.price(std::log(1.1)) > 2.0 * prior.price(0.5 * std::log(1.1)));
}

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

TEST_CASE("a cause that is better here and worse there proves nothing, however many rows there are") {
  Candidate steady, changing;
  const SignalSums before = sums_of(blocks(100.0, 100.0), 4000);
  steady.held_out = sums_of(blocks(49.0, 50.0), 4000);
  changing.held_out = sums_of(blocks(2.0, 160.0), 4000);
  CHECK(is_proven(steady, before, Weight()));
  CHECK_FALSE(is_proven(changing, before, Weight()));
}

TEST_CASE("a cause that makes a signal worse is not proven by the other one") {
  Candidate one;
  SignalSums before = sums_of(blocks(100.0, 100.0));
  one.held_out = sums_of(blocks(4.0, 4.0));
  CHECK(is_proven(one, before, Weight()));
  const std::vector<double> worse(2400, 3.3), bad(2400, 3.0);
  before.set(2, bad, 1.0);
  one.held_out.set(2, worse, 1.0);
  CHECK_FALSE(is_proven(one, before, Weight()));
}

TEST_CASE("what only some blocks prefer is weighed by how much the blocks differ") {
  const Model model = axis_model();
  const auto candidate = [&](const char* id, double even, double odd) {
    Candidate one;
    if (id != nullptr) one.explanation.effects.push_back(standard_catalogue().find(id));
    one.list = coordinates(model, one.explanation, standard_catalogue());
    one.fit.at = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(one.list.size()));
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
