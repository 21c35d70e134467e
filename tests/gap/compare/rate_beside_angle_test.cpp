// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What a rate and the angle beside it say of each other's noise: whatever a model lacks moves both alike.
#include "../../catch.hpp"
#include "../observe/coloured_noise.hpp"

#include <thermopower/gap/compare/noise_of_errors.hpp>
#include <thermopower/gap/compare/rate_beside_angle.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;
using test::normal;
using test::Random;

namespace {

constexpr int windows = 80, rows_of_window = 50, rows = windows * rows_of_window;
constexpr double dt_s = 0.01;

/// Noise of a memory from one row to the next, in every row. @param sd  its standard deviation
std::vector<double> noise_of(double sd, double memory, Random& random) {
  return test::coloured(rows, memory, random, sd);
}

std::vector<double> no_noise() { return std::vector<double>(rows, 0.0); }

/// Motion that a model lacks, angle and rate, in the rows of one window.
struct Lacking {
  std::vector<double> angle, rate;
};

/// Swings to and fro, at another frequency in each window.
Lacking swing(double amplitude_deg, Random& random) {
  Lacking one;
  const double pulse = 4.0 + 8.0 * std::abs(normal(random));  // rad/s
  for (int k = 0; k < rows_of_window; ++k) {
    one.angle.push_back(amplitude_deg * std::sin(pulse * dt_s * k));
    one.rate.push_back(amplitude_deg * pulse * std::cos(pulse * dt_s * k));
  }
  return one;
}

/// Is struck at any time, some sixty times a second, and slows down in between: a rate that looks like noise that remembers.
Lacking struck(double blow_dps, Random& random) {
  constexpr int within = 20;  // steps per row
  constexpr double h_s = dt_s / within, slows_s = 0.05, blows_per_s = 60.0;
  Lacking one;
  double angle = 0.0, rate = 0.0;
  for (int k = 0; k < rows_of_window; ++k) {
    one.angle.push_back(angle);
    one.rate.push_back(rate);
    for (int i = 0; i < within; ++i) {
      const double uniform = (static_cast<double>(random()) + 0.5) / 4294967296.0;
      if (uniform < blows_per_s * h_s) rate += blow_dps * normal(random);
      angle += h_s * rate;
      rate -= h_s / slows_s * rate;
    }
  }
  return one;
}

/// Errors of a simulation over windows of 50 rows at 100 Hz: a motion that it lacks and the noise of both sensors.
struct WindowedErrors {
  Inputs inputs;
  std::vector<Segment> segments;
  Errors errors;

  WindowedErrors(const std::function<Lacking()>& lacking, const std::vector<double>& rate_noise,
                 const std::vector<double>& angle_noise, int count = windows) {
    inputs.t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, dt_s * (rows - 1));
    for (const Signal signal : {Signal::angle_deg, Signal::rate_dps})
      inputs.measured[static_cast<std::size_t>(signal)] = Eigen::VectorXd::Zero(rows);
    for (int w = 0; w < count; ++w) {
      const Lacking motion = lacking();
      for (int k = 0; k < rows_of_window; ++k) {
        const int row = w * rows_of_window + k;
        const auto at = static_cast<std::size_t>(row), within = static_cast<std::size_t>(k);
        take(Signal::angle_deg, w, row, motion.angle[within] + angle_noise[at]);
        take(Signal::rate_dps, w, row, motion.rate[within] + rate_noise[at]);
      }
      Segment segment;
      segment.inputs = &inputs;
      segment.begin = w * rows_of_window;
      segment.end = segment.begin + rows_of_window;
      segments.push_back(segment);
    }
  }

  void take(Signal signal, int window, int row, double error) {
    const auto at = static_cast<std::size_t>(signal);
    errors.of[at].push_back(error);
    errors.segment[at].push_back(window);
    errors.row[at].push_back(row);
  }

  /// The noise that is found in a signal, with and without the other one beside it.
  struct Found {
    double beside, alone;
  };
  Found found(Signal signal) const {
    const auto at = static_cast<std::size_t>(signal);
    const std::vector<bool> gaps = errors.gaps(signal);
    const auto most = RateBesideAngle(errors, segments).most_noise().of(signal);
    return {noise_sd(errors.of[at], gaps, 0.0, {}, {}, most), noise_sd(errors.of[at], gaps)};
  }
};

Lacking nothing() {
  return {std::vector<double>(rows_of_window, 0.0), std::vector<double>(rows_of_window, 0.0)};
}

}  // namespace

TEST_CASE("an angle tells the noise of the rate beside it that lasts, whatever motion a model lacks") {
  constexpr double sd = 0.8;
  std::vector<double> of_lasting, of_white, of_none;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    const auto lasting = [&](const std::vector<double>& noise) {
      const WindowedErrors one([&] { return swing(3.0, random); }, noise, noise_of(0.01, 0.0, random));
      REQUIRE(one.errors.rms(Signal::rate_dps) > 10.0 * sd);
      const auto told = RateBesideAngle(one.errors, one.segments).lasting_noise();
      REQUIRE(told);
      return *told;
    };
    of_lasting.push_back(lasting(noise_of(sd, 0.95, random)));
    of_white.push_back(lasting(noise_of(sd, 0.0, random)));
    of_none.push_back(lasting(no_noise()));
  }
  CHECK(median_of(of_lasting) == Approx(sd).epsilon(0.2));
  CHECK(quantile_of(of_lasting, 0.0) > 0.6 * sd);
  CHECK(quantile_of(of_white, 1.0) < 0.25 * sd);
  CHECK(quantile_of(of_none, 1.0) < 0.25 * sd);
  Random random(1);
  const WindowedErrors few([&] { return swing(3.0, random); }, no_noise(), no_noise(), 2);
  CHECK_FALSE(RateBesideAngle(few.errors, few.segments).lasting_noise());
}

TEST_CASE("blows that a model lacks are no noise, for rate and angle show them alike") {
  constexpr double rate_sd = 0.8, angle_sd = 0.05;
  std::vector<double> rate_alone, rate_beside, angle_alone, angle_beside;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    const WindowedErrors one([&] { return struck(20.0, random); }, noise_of(rate_sd, 0.0, random),
                             noise_of(angle_sd, 0.0, random));
    REQUIRE(one.errors.rms(Signal::rate_dps) > 20.0 * rate_sd);
    const auto rate = one.found(Signal::rate_dps), angle = one.found(Signal::angle_deg);
    rate_alone.push_back(rate.alone / rate_sd);
    rate_beside.push_back(rate.beside / rate_sd);
    angle_alone.push_back(angle.alone / angle_sd);
    angle_beside.push_back(angle.beside / angle_sd);
  }
  CHECK(median_of(rate_alone) > 10.0);  // a blow between two rows looks like noise that remembers
  CHECK(median_of(angle_alone) > 3.0);
  // When it was between them nobody knows.
  CHECK(median_of(rate_beside) < 4.0);
  CHECK(median_of(angle_beside) < 4.0);
  CHECK(quantile_of(rate_beside, 0.0) > 0.8);
  CHECK(quantile_of(angle_beside, 0.0) > 0.8);
}

TEST_CASE("noise that remembers stays what it is beside another signal") {
  const double memory = GENERATE(0.0, 0.7, 0.9, 0.95);
  constexpr double rate_sd = 0.8, angle_sd = 0.05;
  std::vector<double> rate, angle;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    const WindowedErrors one(nothing, noise_of(rate_sd, memory, random), noise_of(angle_sd, memory, random));
    rate.push_back(one.found(Signal::rate_dps).beside / one.found(Signal::rate_dps).alone);
    angle.push_back(one.found(Signal::angle_deg).beside / one.found(Signal::angle_deg).alone);
  }
  for (std::vector<double>* one : {&rate, &angle}) {
    CHECK(median_of(*one) == Approx(1.0).margin(0.02));
    CHECK(quantile_of(*one, 0.0) > 0.85);
  }
}

TEST_CASE("a rate that was made from the angle, or an angle from the rate, tells nothing of their noise") {
  const double memory = GENERATE(0.0, 0.9);
  enum class Made { rate, rate_by_a_filter, angle };
  const Made made = GENERATE(Made::rate, Made::rate_by_a_filter, Made::angle);
  int told = 0;
  for (unsigned seed = 1; seed <= 21; ++seed) {
    Random random(seed);
    std::vector<double> angle = noise_of(0.05, memory, random), rate = noise_of(0.8, memory, random);
    if (made == Made::angle)
      for (std::size_t i = 1; i < angle.size(); ++i)
        angle[i] = angle[i - 1] + 0.5 * (rate[i - 1] + rate[i]) * dt_s;
    else if (made == Made::rate)
      for (std::size_t i = 1; i < angle.size(); ++i) rate[i] = (angle[i] - angle[i - 1]) / dt_s;
    else  // the slope of a parabola through nine readings (Savitzky and Golay 1964)
      for (std::size_t i = 4; i + 4 < angle.size(); ++i) {
        rate[i] = 0.0;
        for (int k = 1; k <= 4; ++k)
          rate[i] += k * (angle[i + static_cast<std::size_t>(k)] - angle[i - static_cast<std::size_t>(k)]) /
                     (60.0 * dt_s);
      }
    const WindowedErrors one(nothing, rate, angle);
    told += one.found(Signal::rate_dps).beside != one.found(Signal::rate_dps).alone ||
                    one.found(Signal::angle_deg).beside != one.found(Signal::angle_deg).alone
                ? 1
                : 0;
  }
  CHECK(told == 0);
}

TEST_CASE("signals of a plant of one's own are no angle and no rate, wherever they are counted") {
  Random random(1);
  WindowedErrors one([&] { return struck(20.0, random); }, noise_of(0.8, 0.95, random),
                     noise_of(0.05, 0.0, random));
  REQUIRE(RateBesideAngle(one.errors, one.segments).lasting_noise());
  REQUIRE(one.found(Signal::rate_dps).beside < one.found(Signal::rate_dps).alone);
  one.inputs.own = true;
  CHECK_FALSE(RateBesideAngle(one.errors, one.segments).lasting_noise());
  CHECK(one.found(Signal::rate_dps).beside == one.found(Signal::rate_dps).alone);
  CHECK(one.found(Signal::angle_deg).beside == one.found(Signal::angle_deg).alone);
}
