// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The statistics of a fleet, held against fleets drawn here: how often they are wrong must be what they say.

#include "../../catch.hpp"

#include <thermopower/gap/pool/causes.hpp>
#include <thermopower/gap/pool/drift.hpp>
#include <thermopower/gap/pool/odd_units.hpp>

#include <Eigen/Cholesky>

#include <random>

using namespace thermopower::gap::pool;

namespace {

/// A fleet with known values: units ~ N(mean, between), estimates ~ N(unit, V), V different from unit to unit.
struct Drawn {
  std::vector<Eigen::VectorXd> truth;
  std::vector<Estimate> units;
};

Drawn draw(std::mt19937_64& random, std::size_t count, const Eigen::VectorXd& mean,
           const Eigen::MatrixXd& between, double error) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Index k = mean.size();
  const auto gauss = [&] {
    Eigen::VectorXd z(k);
    for (Eigen::Index i = 0; i < k; ++i) z[i] = normal(random);
    return z;
  };
  const Eigen::MatrixXd root = between.llt().matrixL();
  Drawn drawn;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::MatrixXd mixing(k, k);
    for (Eigen::Index a = 0; a < k; ++a)
      for (Eigen::Index b = 0; b < k; ++b) mixing(a, b) = normal(random);
    const double size = error * std::exp(0.7 * uniform(random));
    const Eigen::MatrixXd covariance =
        size * size *
        (mixing * mixing.transpose() / static_cast<double>(k) + 0.2 * Eigen::MatrixXd::Identity(k, k));
    drawn.truth.push_back(mean + root * gauss());
    drawn.units.push_back(
        {drawn.truth.back() + Eigen::MatrixXd(covariance.llt().matrixL()) * gauss(), covariance});
  }
  return drawn;
}

Eigen::MatrixXd some_spread(Eigen::Index k, double size) {
  Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(k, k);
  for (Eigen::Index a = 0; a < k; ++a)
    for (Eigen::Index b = 0; b < k; ++b)
      if (a != b) spread(a, b) = 0.4;
  return size * size * spread;
}

}  // namespace

TEST_CASE("distributions agree with printed tables") {
  // Abramowitz & Stegun, tables 26.8 to 26.10.
  CHECK(f_tail(4.10, 2.0, 10.0) == Approx(0.05).epsilon(0.01));
  CHECK(f_tail(5.64, 4.0, 10.0) == Approx(0.0125).epsilon(0.05));
  CHECK(t_quantile(0.05, 5.0) == Approx(2.571).epsilon(1e-3));
  CHECK(t_quantile(0.01, 30.0) == Approx(2.750).epsilon(1e-3));
  CHECK(t_quantile(0.05, 1e6) == Approx(1.95996).epsilon(1e-4));
  CHECK(chi2_tail(3.841, 1.0) == Approx(0.05).epsilon(1e-3));
  CHECK(chi2_tail(18.307, 10.0) == Approx(0.05).epsilon(1e-3));
  CHECK(regularised_beta(2.0, 3.0, 0.4) == Approx(0.5248).epsilon(1e-6));
  CHECK(normal_tail(1.959964) == Approx(0.05).epsilon(1e-5));
}

TEST_CASE("mean and spread of units come back, and the intervals hold what they say") {
  std::mt19937_64 random(1);
  const Eigen::Index k = 3;
  Eigen::VectorXd mean(k);
  mean << 1.0, -2.0, 0.5;
  struct Setting {
    std::size_t units;
    double between, error;
  };
  for (const Setting& setting : {Setting{40, 0.1, 0.05}, {40, 0.1, 0.3}, {12, 0.1, 0.1}}) {
    const Eigen::MatrixXd between = some_spread(k, setting.between);
    const int fleets = 300;
    double mean_held = 0.0, unit_held = 0.0, unit_count = 0.0, next_held = 0.0, trace = 0.0, shrunken = 0.0,
           raw = 0.0;
    for (int fleet = 0; fleet < fleets; ++fleet) {
      const Drawn drawn = draw(random, setting.units, mean, between, setting.error);
      const Drawn next = draw(random, 5, mean, between, setting.error);
      const MixedEffects fit = fit_mixed_effects(drawn.units);
      trace += fit.between.trace() / fleets;
      for (Eigen::Index c = 0; c < k; ++c)
        mean_held += std::abs(fit.mean[c] - mean[c]) <
                             t_quantile(0.05, fit.degrees[c]) * std::sqrt(fit.mean_covariance(c, c))
                         ? 1.0 / (3.0 * fleets)
                         : 0.0;
      for (std::size_t i = 0; i < drawn.units.size(); ++i) {
        const Estimate one = shrink(fit, drawn.units[i]);
        shrunken += (one.at - drawn.truth[i]).squaredNorm();
        raw += (drawn.units[i].at - drawn.truth[i]).squaredNorm();
        for (Eigen::Index c = 0; c < k; ++c) {
          unit_held += std::abs(one.at[c] - drawn.truth[i][c]) < reach95(fit, one, c) ? 1.0 : 0.0;
          unit_count += 1.0;
        }
      }
      for (const Eigen::VectorXd& truth : next.truth) {
        const Range range = prediction_range(fit, 0, 0.9);
        next_held += truth[0] > range.low && truth[0] < range.high ? 1.0 / (5.0 * fleets) : 0.0;
      }
    }
    CAPTURE(setting.units, setting.between, setting.error, mean_held, unit_held / unit_count, next_held);
    WARN(setting.units << " units, spread " << setting.between << ", error " << setting.error
                       << ": mean held " << mean_held << ", units held " << unit_held / unit_count
                       << ", next unit in 90 % range " << next_held << ", trace " << trace / between.trace()
                       << ", shrunken/raw " << shrunken / raw);
    CHECK(mean_held > 0.93);
    CHECK(mean_held < 0.98);
    CHECK(unit_held / unit_count > 0.93);
    CHECK(unit_held / unit_count < 0.985);
    CHECK(next_held > 0.86);
    CHECK(next_held < 0.97);
    CHECK(trace / between.trace() == Approx(1.0).margin(0.2));
    CHECK(shrunken < raw);
  }
}

TEST_CASE(
    "a sound fleet has an odd unit in at most one fleet of a hundred, whatever its size and its errors") {
  std::mt19937_64 random(2);
  for (const double error : {0.02, 0.1, 0.4})
    for (const std::size_t units : {10u, 25u, 80u})
      for (const Eigen::Index k : {1, 4}) {
        const Eigen::MatrixXd between = some_spread(k, 0.1);
        const int fleets = units > 50 ? 200 : 400;
        int wrong = 0;
        for (int fleet = 0; fleet < fleets; ++fleet) {
          const OddUnits found =
              find_odd_units(draw(random, units, Eigen::VectorXd::Zero(k), between, error).units);
          for (const Standing& one : found.units)
            if (one.odd) {
              ++wrong;
              break;
            }
        }
        CAPTURE(error, units, k, wrong, fleets);
        WARN("error " << error << ", " << units << " units, " << k << " coordinates: " << wrong << " of "
                      << fleets << " sound fleets have an odd unit");
        // One in a hundred, and three standard deviations of the count.
        CHECK(wrong <= 0.01 * fleets + 3.0 * std::sqrt(0.01 * fleets));
      }
}

TEST_CASE(
    "odd units are found where a fifth of the fleet is odd to one side, and the others' spread stays theirs") {
  std::mt19937_64 random(3);
  const Eigen::Index k = 3;
  const Eigen::MatrixXd between = some_spread(k, 0.1);
  int found = 0, all = 0, wrong = 0;
  double trace = 0.0;
  const int fleets = 100;
  for (int fleet = 0; fleet < fleets; ++fleet) {
    Drawn drawn = draw(random, 50, Eigen::VectorXd::Zero(k), between, 0.05);
    for (std::size_t i = 0; i < 10; ++i) drawn.units[i].at[static_cast<Eigen::Index>(i % 2)] += 1.0;
    const OddUnits odd = find_odd_units(drawn.units);
    for (std::size_t i = 0; i < drawn.units.size(); ++i) {
      found += i < 10 && odd.units[i].odd;
      all += i < 10;
      wrong += i >= 10 && odd.units[i].odd;
      if (i < 10 && odd.units[i].odd) CHECK(odd.units[i].coordinate == static_cast<Eigen::Index>(i % 2));
    }
    trace += odd.sound.between.trace() / fleets;
  }
  CAPTURE(found, all, wrong, trace / between.trace());
  CHECK(found > 0.95 * all);
  CHECK(wrong <= 0.01 * fleets + 3.0 * std::sqrt(0.01 * fleets));
  CHECK(trace / between.trace() == Approx(1.0).margin(0.15));
}

TEST_CASE("few units, equal units and one unit are no trouble") {
  const Estimate one{Eigen::VectorXd::Ones(2), 0.01 * Eigen::MatrixXd::Identity(2, 2)};
  CHECK(find_odd_units({}).units.empty());
  CHECK_FALSE(find_odd_units({one}).units[0].odd);
  const OddUnits equal = find_odd_units(std::vector<Estimate>(20, one));
  for (const Standing& unit : equal.units) CHECK_FALSE(unit.odd);
  CHECK(equal.sound.mean[0] == Approx(1.0));
  const Estimate certain{Eigen::VectorXd::Ones(2), Eigen::MatrixXd::Zero(2, 2)};
  for (const Standing& unit : find_odd_units(std::vector<Estimate>(20, certain)).units) CHECK_FALSE(unit.odd);
}

TEST_CASE("drift: no more false alarms than said, and a change is found with its moment") {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const std::size_t units = 40, logs = 6;
  int wrong = 0, found = 0, held = 0, slopes = 0, changes = 0;
  const int fleets = 1000;
  for (int fleet = 0; fleet < fleets; ++fleet) {
    std::vector<TimeSeries> series(units);
    const bool drifts = fleet % 2 == 1;
    for (std::size_t u = 0; u < units; ++u)
      for (std::size_t j = 0; j < logs; ++j) {
        const double variance = 1e-4 * std::exp(normal(random));
        double at =
            0.3 * static_cast<double>(u) + 0.015 * normal(random) + std::sqrt(variance) * normal(random);
        if (drifts && u == 0 && j >= 3) at += 0.2;
        if (drifts && u == 1) at += 0.06 * static_cast<double>(j);
        series[u].time.push_back(30.0 * static_cast<double>(j));
        series[u].at.push_back(at);
        series[u].variance.push_back(variance);
      }
    const LogScatter scatter = log_scatter(series);
    std::vector<double> p;
    std::vector<Drift> drift;
    for (const TimeSeries& one : series) {
      drift.push_back(find_drift(one, scatter));
      p.push_back(drift.back().p);
    }
    const std::vector<bool> stands = holm(p, 0.01);
    bool any = false;
    for (std::size_t u = drifts ? 2 : 0; u < units; ++u) any = any || stands[u];
    wrong += any;
    if (!drifts) continue;
    found += stands[0] + stands[1];
    changes += drift[0].kind == DriftKind::change;
    slopes += drift[1].kind == DriftKind::slope;
    held += drift[0].since <= 60.0 && drift[0].until >= 90.0;
  }
  WARN(wrong << " of " << fleets << " fleets have a false drift; found " << found << " of " << fleets
             << ", moment held " << held << ", changes " << changes << ", slopes " << slopes << " of "
             << fleets / 2);
  CHECK(wrong <= 0.01 * fleets + 3.0 * std::sqrt(0.01 * fleets));
  CHECK(found > 0.9 * fleets);
  CHECK(held > 0.93 * fleets / 2);
  CHECK(changes > 0.9 * fleets / 2);
  CHECK(slopes > 0.9 * fleets / 2);
}

TEST_CASE("shares of causes come back, and what is common settles what one unit cannot tell") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform;
  std::vector<Probabilities> units;
  for (int i = 0; i < 200; ++i) {
    if (i < 120) units.push_back({{"a", 0.9}, {"b", 0.1}});
    else if (i < 160) units.push_back({{"a", 0.5}, {"c", 0.5}});
    else units.push_back({{"d", 0.7 + 0.3 * uniform(random)}, {"b", 0.2}});
  }
  const CommonCauses found = common_causes(units);
  REQUIRE(found.common.size() == 4);
  CHECK(found.common[0].explanation == "a");
  CHECK(found.common[0].share == Approx(0.8).margin(0.01));
  CHECK(found.common[0].share90.low < 0.8);
  CHECK(found.common[0].share90.high > 0.8);
  CHECK(found.common[1].explanation == "d");
  CHECK(found.common[1].share == Approx(0.2).margin(0.01));
  CHECK(found.units[130].at("a") > 0.99);
  CHECK(common_causes({}).common.empty());
}

TEST_CASE("an effect that no unit shows is named by all, and nothing is named where nothing is") {
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  // A unit with signal-to-noise z: its training data gain (z + e)^2, and its held-out data of 3/7 of the information
  // what an estimate with that error gains there.
  const auto fleet = [&](double true_z, double like_z) {
    std::vector<std::map<std::string, Gain>> units(100);
    for (auto& unit : units)
      for (const char* name : {"weak", "alike", "u", "v", "w"}) {
        const double z = name == std::string("weak") ? true_z : name == std::string("alike") ? like_z : 0.0;
        const double estimate = z + normal(random), share = 3.0 / 7.0,
                     held = z + normal(random) / std::sqrt(share);
        unit[name] = {estimate * estimate, share * (held * held - (held - estimate) * (held - estimate)), 1};
      }
    return units;
  };
  int named = 0, first = 0, wrong = 0, beside = 0;
  const int fleets = 500;
  for (int i = 0; i < fleets; ++i) {
    const std::vector<WeakEffect> found = weak_effects(fleet(2.2, 1.2));
    named += found.front().stands;
    first += found.front().stands && found.front().explanation == "weak";
    beside += !found.front().not_told_from.empty();
    wrong += weak_effects(fleet(0.0, 0.0)).front().stands;
  }
  WARN("weak effect of 2.2 standard errors a unit: named in "
       << named << " of " << fleets << " fleets, first in " << first << ", not alone in " << beside
       << "; named where there is none: " << wrong);
  CHECK(named > 0.9 * fleets);
  CHECK(first > 0.95 * named);
  CHECK(wrong <= 0.01 * fleets + 3.0 * std::sqrt(0.01 * fleets));
}
