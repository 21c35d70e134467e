// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The noise of a residual, whatever its colour and tails, with and without the error of a wrong model beside it.
#include "../../catch.hpp"
#include "coloured_noise.hpp"

#include <thermopower/gap/observe/noise.hpp>
#include <thermopower/gap/compare/noise_of_errors.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using test::coloured;
using test::normal;
using test::Random;

namespace {

/// Student's t with three degrees of freedom, scaled to a standard deviation of 1.
double heavy_tailed(Random& random) {
  const double a = normal(random), b = normal(random), c = normal(random);
  return normal(random) / std::sqrt((a * a + b * b + c * c) / 3.0) / std::sqrt(3.0);
}

/// Median of the estimate over the truth in 21 draws.
double ratio(int count, int run, double truth, double quantum,
             const std::function<std::vector<double>(Random&)>& draw) {
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    const std::vector<double> x = draw(random);
    std::vector<bool> gaps(static_cast<std::size_t>(count), false);
    for (int i = run; i < count; i += run) gaps[static_cast<std::size_t>(i)] = true;
    ratios.push_back(noise_sd(x, gaps, quantum) / truth);
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[10];
}

}  // namespace

TEST_CASE("the noise is right within a fifth for white, coloured and heavy-tailed residuals") {
  const struct { int count, run; } lengths[] = {{500, 500}, {2000, 2000}, {4000, 100}, {10000, 500}};
  for (const auto& one : lengths) {
    CAPTURE(one.count, one.run);
    const auto of = [&](const std::function<std::vector<double>(Random&)>& draw) {
      return ratio(one.count, one.run, 1.0, 0.0, draw);
    };
    const auto each = [&](const std::function<double(Random&)>& value) {
      return [&, value](Random& random) {
        std::vector<double> x;
        for (int i = 0; i < one.count; ++i) x.push_back(value(random));
        return x;
      };
    };
    CHECK(of(each(normal)) == Approx(1.0).epsilon(0.05));
    CHECK(of(each(heavy_tailed)) == Approx(1.0).epsilon(0.2));
    CHECK(of([&](Random& random) { return coloured(one.count, 0.8, random); }) == Approx(1.0).epsilon(0.2));
    CHECK(of([&](Random& random) { return coloured(one.count, 0.95, random); }) == Approx(1.0).epsilon(0.2));
  }
}

TEST_CASE("the error of a wrong model is no noise") {
  constexpr int count = 4000;
  const auto with = [&](double memory, const std::function<double(int)>& error) {
    return ratio(count, 200, 1.0, 0.0, [&](Random& random) {
      std::vector<double> x = coloured(count, memory, random);
      for (int i = 0; i < count; ++i) x[static_cast<std::size_t>(i)] += error(i);
      return x;
    });
  };
  CHECK(with(0.0, [](int i) { return 5.0 * std::sin(0.05 * i); }) == Approx(1.0).epsilon(0.2));
  CHECK(with(0.0, [](int i) { return 8.0 * std::exp(-(i % 200) / 60.0); }) == Approx(1.0).epsilon(0.2));
  CHECK(with(0.95, [](int i) { return 5.0 * std::sin(0.02 * i); }) == Approx(1.0).epsilon(0.25));
}

TEST_CASE("what remembers longer than noise can is none, and what remembers as long is noise") {
  Random random(7);
  const std::vector<double> x = coloured(4000, 0.9, random);
  const std::vector<bool> gaps(x.size(), false);
  MostNoise short_memory, long_memory;
  short_memory.longest_memory = 0.5;
  long_memory.longest_memory = 0.92;
  CHECK(noise_sd(x, gaps, 0.0, {}, {}, long_memory) == Approx(1.0).epsilon(0.2));
  // What is new in each sample is noise at most: sqrt(1 - 0.9^2).
  CHECK(noise_sd(x, gaps, 0.0, {}, {}, short_memory) < 0.5);
}

TEST_CASE("noise of a thermometer is forgotten within a quarter of its body's time constant") {
  constexpr auto motor_C = static_cast<std::size_t>(Signal::motor_C);
  Inputs inputs;
  inputs.t_s = Eigen::VectorXd::LinSpaced(11, 0.0, 100.0);
  Segment segment;
  segment.inputs = &inputs;
  Errors errors;
  for (Eigen::Index row = 0; row < 11; ++row) {
    errors.row[motor_C].push_back(row);
    errors.segment[motor_C].push_back(0);
  }
  errors.time_constant_s = 40.0;
  CHECK(memory_beside_body(errors, {segment}) == Approx(std::exp(-1.0)));
  CHECK(most_noise_of(Signal::motor_C, errors, {segment}, {}).longest_memory == Approx(std::exp(-1.0)));
  CHECK(most_noise_of(Signal::current_A, errors, {segment}, {}).longest_memory == 1.0);
  errors.time_constant_s = std::numeric_limits<double>::infinity();  // no body is simulated
  CHECK(most_noise_of(Signal::motor_C, errors, {segment}, {}).longest_memory == 1.0);
}

TEST_CASE("runs may differ in their noise, and readings in coarse steps have the noise of rounding, too") {
  constexpr int count = 4000;
  CHECK(ratio(count, 500, std::sqrt(13.0), 0.0, [&](Random& random) {
          std::vector<double> x;
          for (int i = 0; i < count; ++i) x.push_back(normal(random) * (i < count / 2 ? 1.0 : 5.0));
          return x;
        }) == Approx(1.0).epsilon(0.1));
  // A thermometer of 0.5 K steps with a noise of 0.14 K.
  CHECK(ratio(count, count, std::hypot(0.14, 0.5 / std::sqrt(12.0)), 0.5, [&](Random& random) {
          std::vector<double> x;
          for (int i = 0; i < count; ++i) {
            const double truth = 20.0 + 5.0 * std::sin(0.003 * i);
            x.push_back(0.5 * std::round((truth + 0.14 * normal(random)) / 0.5) - truth);
          }
          return x;
        }) == Approx(1.0).epsilon(0.2));
  // A thermometer whose noise is a third of its steps, read so often that it flickers for minutes and then stands still for some.
  constexpr int often = 12000;
  CHECK(ratio(often, often, std::hypot(0.03, 0.1 / std::sqrt(12.0)), 0.1, [&](Random& random) {
          std::vector<double> x;
          for (int i = 0; i < often; ++i) {
            const double truth = 50.0 + std::sin(0.0004 * i);
            x.push_back(0.1 * std::round((truth + 0.03 * heavy_tailed(random)) / 0.1) - truth);
          }
          return x;
        }) == Approx(1.0).epsilon(0.2));
}

TEST_CASE(
    "noise that remembers is known at the levels of a sweep, where the error of a model jumps with the level and not") {
  // 2.0: the error of a model that follows the level, which is another one in most rows.
  const double jump = GENERATE(0.0, 2.0);
  std::vector<double> ratios;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    constexpr int count = 3000;
    std::vector<double> x = coloured(count, 0.95, random), levels;
    for (int i = 0; i < count; ++i) {
      const int step = static_cast<int>(random() % 8);
      levels.push_back(jump > 0.0 ? 0.125 * step : 0.5 + 0.5 * std::sin(0.2 * i));
      x[static_cast<std::size_t>(i)] += jump * (levels.back() - 0.5);
    }
    ratios.push_back(noise_sd(x, std::vector<bool>(count, false), 0.0, levels));
  }
  std::sort(ratios.begin(), ratios.end());
  CHECK(ratios[10] == Approx(1.0).epsilon(0.2));
}

TEST_CASE("noise alone is seldom larger than it may be by chance, and white noise with an error is") {
  const auto beyond = [](int count, double memory, const std::function<double(int)>& error) {
    int larger = 0;
    for (unsigned seed = 1; seed <= 100; ++seed) {
      Random random(seed);
      std::vector<double> x = coloured(count, memory, random);
      double squares = 0.0;
      for (int i = 0; i < count; ++i) {
        double& one = x[static_cast<std::size_t>(i)];
        one += error(i);
        squares += one * one;
      }
      const NoiseEstimate noise = noise_of_sequence(x, std::vector<bool>(x.size(), false));
      larger += std::sqrt(squares / count) > std::max(1.2 * noise.sd, noise.by_chance) ? 1 : 0;
    }
    return larger;
  };
  const auto none = [](int) { return 0.0; };
  const int count = GENERATE(250, 1000, 4000);
  CHECK(beyond(count, 0.0, none) == 0);
  CHECK(beyond(count, 0.8, none) <= 2);
  CHECK(beyond(count, 0.95, none) <= 2);
  // A few hundred samples do not tell it from noise that remembers.
  if (count >= 1000) CHECK(beyond(count, 0.0, [&](int i) { return 2.0 * std::sin(25.0 * i / count); }) >= 90);
}

TEST_CASE("a step that happens to repeat among smaller ones is no quantum") {
  // A wide motion logged to 0.01: none of its many steps repeats often, but one of them.
  Eigen::VectorXd values(2000);
  double at = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    at +=
        i % 40 == 0 ? 1.02 : 0.01 * std::round(200.0 * std::sin(0.7 * std::pow(static_cast<double>(i), 1.3)));
    values[i] = at;
  }
  CHECK(quantum_of(values) < 0.02);
}

TEST_CASE("a few odd samples do not hide a quantum") {
  Eigen::VectorXd values(1000);
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = 0.1 * std::round(10.0 * (20.0 + 3.0 * std::sin(0.05 * static_cast<double>(i))));
  CHECK(quantum_of(values) == Approx(0.1).epsilon(1e-6));
  values[500] = 22.2345;
  CHECK(quantum_of(values) == Approx(0.1).epsilon(1e-6));
}

TEST_CASE("a coarse reading that a logger averages keeps its quantum") {
  // 33 to 34 degC in steps of 0.1, read 97 times for each row; the rows in which it steps are means of two levels.
  Eigen::VectorXd values(1200);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    double sum = 0.0;
    for (int k = 0; k < 97; ++k) {
      const double at = static_cast<double>(i) + k / 97.0;
      sum += 0.1 * std::round(10.0 * (33.5 + 0.5 * std::sin(0.005 * at)));
    }
    values[i] = std::round(1e8 * sum / 97.0) / 1e8;
  }
  CHECK(quantum_of(values) == Approx(0.1).epsilon(1e-3));
  // Values of a sensor without steps, held for five rows each, have no quantum.
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = 33.5 + 0.5 * std::sin(0.7 * std::pow(static_cast<double>(i / 5), 1.3));
  CHECK(quantum_of(values) == 0.0);
}

TEST_CASE(
    "an error that ramps and jumps back at blows is no noise where the measured motion is smooth between them") {
  // A load with free play: the simulated rate knows nothing of the blows, each of which reverses what was gained since the last.
  constexpr double noise = 0.05, ramp = 5.0;
  // Third differences of white noise are sqrt(20) times as large; twice that of noise that remembers 0.97 is 15 times.
  constexpr double most = 15.0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    std::vector<double> errors, measured;
    double rate = 0.0, step = ramp;
    int left = 0;
    for (int i = 0; i < 3000; ++i) {
      if (left-- == 0) {
        rate = -rate + ramp * normal(random);
        step = rate > 0.0 ? -ramp : ramp;
        left = 5 + static_cast<int>(random() % 10);
      }
      rate += step;
      const double simulated = 100.0 * std::sin(0.01 * i);
      measured.push_back(rate + simulated + noise * normal(random));
      errors.push_back(simulated - measured.back());
    }
    const std::vector<bool> gaps(errors.size(), false);
    CAPTURE(seed);
    REQUIRE(rms_of(errors) > 100.0 * noise);
    const double found = noise_sd(errors, gaps, 0.0, {}, measured);
    CHECK(found > 0.5 * noise);
    CHECK(found < most * noise);
  }
}
