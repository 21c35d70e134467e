// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Sensors that speak less often than a log has rows: what repeats is told from what is coarse, steady or frozen.
#include "../../catch.hpp"

#include <thermopower/gap/data/slow_sensors.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace thermopower::gap;
using namespace thermopower::gap::engine;

namespace {

constexpr Eigen::Index rows = 2000;
const std::vector<RunSpan> one_run{{0, rows, ""}};

/// A swing with noise, in rows; each reading stands until the next, `rows_apart(i)` rows later.
template <class Apart>
Eigen::VectorXd held(Apart&& rows_apart, double quantum = 0.0) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.1);
  Eigen::VectorXd values(rows);
  double reading = 0.0;
  for (Eigen::Index i = 0, next = 0, count = 0; i < rows; ++i) {
    if (i == next) {
      reading = 20.0 * std::sin(0.02 * static_cast<double>(i)) + noise(random);
      if (quantum > 0.0) reading = std::round(reading / quantum) * quantum;
      next += rows_apart(count++);
    }
    values[i] = reading;
  }
  return values;
}

TEST_CASE("a column that a slower clock updates counts where it is new, and nowhere else") {
  for (const Eigen::Index apart : {2, 3, 10, 33}) {
    CAPTURE(apart);
    const Eigen::VectorXd values = held([&](Eigen::Index) { return apart; });
    const auto found = held_between_updates(values, one_run);
    REQUIRE(found);
    CHECK(found->rows_apart == apart);
    for (Eigen::Index i = 0; i < rows; ++i)
      if ((found->between[static_cast<std::size_t>(i)] != 0) != (i % apart != 0)) FAIL("row " << i);
  }
  // 30 readings a second in 100 rows a second: three rows apart, and four now and then.
  const auto odd = held_between_updates(held([](Eigen::Index i) { return i % 3 == 2 ? 4 : 3; }), one_run);
  REQUIRE(odd);
  CHECK(odd->rows_apart == 3);
}

TEST_CASE("what is new in each row, coarse, steady, or repeated by accident is not taken for a slow sensor") {
  CHECK_FALSE(held_between_updates(held([](Eigen::Index) { return 1; }), one_run));
  CHECK_FALSE(held_between_updates(held([](Eigen::Index) { return 1; }, 2.0), one_run));
  // A coarse reading of something that moves steadily changes by a clock, but by one quantum.
  CHECK_FALSE(held_between_updates(Eigen::VectorXd::LinSpaced(rows, 0.0, 300.0).array().floor(), one_run));
  std::mt19937_64 random(6);
  CHECK_FALSE(held_between_updates(
      held([&](Eigen::Index) { return 1 + static_cast<Eigen::Index>(random() % 20 == 0); }), one_run));
  CHECK_FALSE(held_between_updates(
      held([&](Eigen::Index) { return 1 + static_cast<Eigen::Index>(random() % 9); }), one_run));
  CHECK_FALSE(held_between_updates(Eigen::VectorXd::Constant(rows, 3.0), one_run));
}

/// What a merge of two streams makes of such readings: straight lines between them, at the rows of the faster stream.
Eigen::VectorXd drawn(double rows_apart, double from, double unit) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<double> readings;
  for (double at = from - rows_apart; at < static_cast<double>(rows) + 2.0 * rows_apart; at += rows_apart)
    readings.push_back(20.0 * std::sin(0.02 * at) + noise(random));
  Eigen::VectorXd values(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double at = (static_cast<double>(i) - from) / rows_apart + 1.0;
    const auto before = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(before);
    values[i] = (1.0 - share) * readings[before] + share * readings[before + 1];
    if (unit > 0.0) values[i] = std::round(values[i] / unit) * unit;
  }
  return values;
}

TEST_CASE("straight lines between the readings of a slower sensor are seen, and no other line") {
  const Eigen::VectorXd t_s = Eigen::VectorXd::LinSpaced(rows, 0.0, 0.01 * (rows - 1));
  const auto found_in = [&](const Eigen::VectorXd& values) {
    return straight_between_updates(t_s, values, one_run);
  };
  for (const double unit : {0.0, 1e-4}) {
    CAPTURE(unit);
    for (const int apart : {2, 5, 20}) {
      const auto found = found_in(drawn(apart, 0.0, unit));
      REQUIRE(found);
      CHECK(found->rows_apart == apart);
      Eigen::Index lost = 0;
      for (Eigen::Index i = 1; i + 1 < rows; ++i) {  // at the ends nobody can tell
        const bool masked = found->between[static_cast<std::size_t>(i)] != 0;
        if (!masked && i % apart != 0) FAIL("row " << i);
        lost += masked && i % apart == 0 ? 1 : 0;
      }
      CHECK(lost * apart < rows / 100);  // by chance a reading lies on the line, too
    }
    // Readings between the rows: one row for each.
    const auto found = found_in(drawn(5.3, 1.7, unit));
    REQUIRE(found);
    const auto kept = std::count(found->between.begin(), found->between.end(), 0);
    CHECK(kept == Approx(rows / 5.3).margin(4.0));
  }
  CHECK_FALSE(found_in(drawn(1.0, 0.0, 1e-4)));
  CHECK_FALSE(found_in(drawn(1.0, 0.0, 1.0)));
  CHECK_FALSE(found_in(Eigen::VectorXd::LinSpaced(rows, 0.0, 300.0)));
  CHECK_FALSE(found_in(Eigen::VectorXd::LinSpaced(rows, 0.0, 300.0).array().floor()));
  CHECK_FALSE(found_in(Eigen::VectorXd::Constant(rows, 3.0)));
  // An encoder that is new in each row while the joint moves, and rests in between.
  std::mt19937_64 random(9);
  std::normal_distribution<double> noise(0.0, 1.0);
  Eigen::VectorXd resting = Eigen::VectorXd::Zero(rows);
  for (Eigen::Index i = 0; i < rows; ++i)
    resting[i] = i % 400 < 150 ? 3.0 : std::round((3.0 + noise(random)) / 0.088) * 0.088;
  CHECK_FALSE(found_in(resting));
  // A body warming and cooling without noise, written with four digits.
  Eigen::VectorXd smooth(rows);
  double body_C = 20.0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    body_C += ((i / 100) % 2 == 0 ? 0.02 : 0.0) - 0.001 * (body_C - 20.0);
    smooth[i] = std::round(body_C * 1e4) * 1e-4;
  }
  CHECK_FALSE(found_in(smooth));
}

TEST_CASE("columns are apart where they hardly ever stand in one row") {
  Eigen::VectorXd first = held([](Eigen::Index) { return 1; }), second = first;
  CHECK_FALSE(are_apart(first, second));
  for (Eigen::Index i = 0; i < rows; ++i) (i % 2 == 0 ? first : second)[i] = missing;
  CHECK(are_apart(first, second));
  CHECK_FALSE(are_apart(first, Eigen::VectorXd::Constant(rows, missing)));
}

TEST_CASE(
    "between samples a column goes along the cubic through its neighbours, and nowhere across a pause") {
  Eigen::VectorXd t_s(rows), values(rows);
  const auto cubic = [](double t) { return ((0.3 * t - 1.0) * t + 2.0) * t - 5.0; };
  for (Eigen::Index i = 0; i < rows; ++i) {
    t_s[i] = 0.01 * static_cast<double>(i) + (i % 3 == 1 ? 0.002 : 0.0);  // uneven
    values[i] = i % 4 == 0 && !(i > 800 && i < 900) ? cubic(t_s[i]) : missing;
  }
  const Eigen::VectorXd between = between_samples(t_s, one_run, values);
  for (Eigen::Index i = 8; i + 8 < rows; ++i)
    if (i % 4 != 0 && (i < 790 || i > 910))
      if (!(std::abs(between[i] - cubic(t_s[i])) < 1e-9 * (1.0 + std::abs(cubic(t_s[i]))))) FAIL("row " << i);
  CHECK(std::isnan(between[850]));
  CHECK(std::isnan(between[0]));
  CHECK(std::isnan(between[8]));  // a sample is its own
}

}  // namespace
