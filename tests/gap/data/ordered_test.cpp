// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What is found without sorting a whole column is what sorting it finds.
#include "../../catch.hpp"

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/where/missing_quantity.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>
#include <vector>

using namespace thermopower::gap::engine;

namespace {

using Generator = std::mt19937;

/// Values of a column, finer or coarser, of which some may be missing.
std::vector<double> column(std::size_t size, double quantum, double missing_share, Generator& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share;
  std::vector<double> list;
  for (std::size_t i = 0; i < size; ++i) {
    const double value = normal(random);
    list.push_back(share(random) < missing_share ? std::numeric_limits<double>::quiet_NaN()
                   : quantum > 0.0               ? quantum * std::round(value / quantum)
                                                 : value);
  }
  return list;
}

Eigen::VectorXd vector_of(const std::vector<double>& list) {
  return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
}

/// The smallest step that makes up a hundredth of all, where no tenth of them is smaller; by sorting all.
double quantum_by_sorting(const std::vector<double>& values) {
  std::vector<double> steps, known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  double largest = 0.0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    largest = std::max(largest, std::abs(known[i]));
    if (i > 0 && std::abs(known[i] - known[i - 1]) > 1e-9 * largest)
      steps.push_back(std::abs(known[i] - known[i - 1]));
  }
  std::sort(steps.begin(), steps.end());
  const double count = static_cast<double>(steps.size());
  if (steps.size() < 10) return steps.empty() ? 0.0 : steps.front();
  for (std::size_t from = 0; from < steps.size();) {
    const auto to = static_cast<std::size_t>(
        std::upper_bound(steps.begin(), steps.end(), steps[from] * 1.001) - steps.begin());
    if (static_cast<double>(to - from) >= std::max(2.0, 0.01 * count))
      return static_cast<double>(from) <= 0.1 * count ? steps[from] : 0.0;
    from = to;
  }
  return 0.0;
}

}  // namespace

TEST_CASE("a step that repeats is the one that sorting all steps finds") {
  Generator random(2);
  int found = 0, none = 0;
  for (const std::size_t size : {5u, 30u, 400u, 3000u})
    for (const double quantum : {0.0, 1e-3, 0.02, 0.5, 3.0})
      for (const double missing_share : {0.0, 0.1}) {
        const std::vector<double> list = column(size, quantum, missing_share, random);
        const double expected = quantum_by_sorting(list);
        CHECK(repeated_step(vector_of(list)) == expected);
        (expected > 0.0 ? found : none) += 1;
      }
  CHECK(found > 10);
  CHECK(none > 5);
}

TEST_CASE("extremes of a column are those of the sorted one") {
  Generator random(3);
  for (const std::size_t size : {1u, 2u, 3u, 50u, 999u})
    for (const double quantum : {0.0, 0.5, 100.0}) {
      const std::vector<double> list = column(size, quantum, 0.0, random);
      std::map<double, std::ptrdiff_t> counts;
      for (const double value : list) ++counts[value + 0.0];  // -0 is 0
      const auto least = counts.begin();
      const auto most = counts.rbegin();
      const Extreme bottom = extreme_of(list, false), top = extreme_of(list, true);
      CHECK(bottom.value == least->first);
      CHECK(bottom.count == least->second);
      CHECK(top.value == most->first);
      CHECK(top.count == most->second);
      const bool is_alone = counts.size() == 1;
      CHECK(bottom.next == (is_alone ? least->first : std::next(least)->first));
      CHECK(top.next == (is_alone ? most->first : std::next(most)->first));
      CHECK(bottom.beside == counts.at(bottom.next + 0.0));
      CHECK(top.beside == counts.at(top.next + 0.0));
    }
}

TEST_CASE("rows sorted into bins say how much of a value their variable explains") {
  Generator random(4);
  constexpr std::size_t size = 2400;
  const std::vector<double> variable = column(size, 0.0, 0.05, random);
  std::vector<double> value = column(size, 0.0, 0.05, random);
  for (std::size_t i = 0; i < size; ++i) value[i] += std::sin(3.0 * variable[i]);
  constexpr int bins = 12;
  const Eigen::VectorXd ordering = vector_of(variable);
  const Bins rows(ordering, bins);
  for (const std::size_t shift : {std::size_t{0}, std::size_t{1}, std::size_t{700}, size}) {
    // By their ranks: as many rows in each bin, but for where an edge falls.
    std::vector<std::pair<double, double>> pairs;
    std::vector<double> edges;
    for (const double one : variable)
      if (std::isfinite(one)) edges.push_back(one);
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < size; ++i)
      if (std::isfinite(variable[i]) && std::isfinite(value[(i + shift) % size]))
        pairs.push_back({variable[i], value[(i + shift) % size]});
    double mean = 0.0, variance = 0.0, between = 0.0;
    for (const auto& one : pairs) mean += one.second / static_cast<double>(pairs.size());
    for (const auto& one : pairs) variance += (one.second - mean) * (one.second - mean);
    std::map<std::size_t, std::pair<double, double>> sums;
    for (const auto& one : pairs) {
      const auto rank =
          static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), one.first) - edges.begin());
      auto& [sum, count] = sums[bins * rank / edges.size()];
      sum += one.second - mean;
      count += 1.0;
    }
    for (const auto& [bin, one] : sums) between += one.first * one.first / one.second;
    CHECK(rows.correlation_ratio(vector_of(value), static_cast<Eigen::Index>(shift)) ==
          Approx(between / variance).margin(0.01));
  }
  CHECK(
      Bins(Eigen::VectorXd::Constant(50, 1.0), bins).correlation_ratio(Eigen::VectorXd::LinSpaced(50, 0, 1)) <
      1e-12);
}
