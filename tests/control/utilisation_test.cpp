// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <cmath>
#include <random>
#include <thermopower/control/utilisation.hpp>

#include "../catch.hpp"

using namespace thermopower;

namespace {

Utilisation::Config config() {
  Utilisation::Config config = Utilisation::Config::standard();
  config.maximum_winding_C = 110.0f;
  config.maximum_body_C = 60.0f;
  return config;
}

}  // namespace

TEST_CASE("utilisation is 0 at the air and 100 at the limit, of the node that is nearer to its own") {
  Utilisation utilisation(config());
  REQUIRE(utilisation.validate() == ConfigError::none);
  CHECK(utilisation.step(25.0f, 25.0f, 25.0f).percent == Approx(0.0f));
  CHECK(utilisation.state().level == UtilisationLevel::normal);
  CHECK(utilisation.step(110.0f, 40.0f, 25.0f).percent == Approx(100.0f));
  CHECK(utilisation.state().is_winding);
  CHECK(utilisation.step(70.0f, 60.0f, 25.0f).percent == Approx(100.0f));
  CHECK_FALSE(utilisation.state().is_winding);
  // In warmer air the same temperatures are more of what is left.
  CHECK(utilisation.step(50.0f, 42.5f, 25.0f).percent == Approx(50.0f));
  CHECK(utilisation.step(50.0f, 42.5f, 40.0f).percent == Approx(14.2857f));
  CHECK(utilisation.step(20.0f, 20.0f, 25.0f).percent < 0.0f);  // colder than the air
  CHECK(utilisation.state().level == UtilisationLevel::normal);
}

TEST_CASE("a level begins at its threshold, ends below it, and noise toggles none") {
  Utilisation utilisation(config());
  const auto level_at = [&](double percent) {
    return utilisation.step(static_cast<float>(25.0 + 0.85 * percent), 25.0f, 25.0f).level;
  };
  CHECK(level_at(84.9) == UtilisationLevel::normal);
  CHECK(level_at(85.1) == UtilisationLevel::warning);
  CHECK(level_at(82.1) == UtilisationLevel::warning);
  CHECK(level_at(81.9) == UtilisationLevel::normal);
  CHECK(level_at(100.1) == UtilisationLevel::error);
  CHECK(level_at(97.1) == UtilisationLevel::error);
  CHECK(level_at(96.9) == UtilisationLevel::warning);
  CHECK(level_at(50.0) == UtilisationLevel::normal);

  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1.4, 1.4);
  for (const double threshold : {85.0, 100.0}) {
    int changes = 0;
    UtilisationLevel before = level_at(threshold);
    for (int i = 0; i < 10000; ++i) {
      const UtilisationLevel now = level_at(threshold + noise(random));
      changes += now != before ? 1 : 0;
      before = now;
    }
    CHECK(changes <= 1);
  }
}

TEST_CASE("what is not known is an error, and so is air in which nothing is left") {
  Utilisation utilisation(config());
  CHECK(utilisation.state().level == UtilisationLevel::error);  // before the first step
  const float nan = detail::not_a_number(), infinite = static_cast<float>(INFINITY);
  CHECK(utilisation.step(25.0f, 25.0f, 25.0f).level == UtilisationLevel::normal);
  for (const float bad : {nan, infinite, -infinite}) {
    CHECK(utilisation.step(bad, 25.0f, 25.0f).level == UtilisationLevel::error);
    CHECK(utilisation.step(25.0f, bad, 25.0f).level == UtilisationLevel::error);
    CHECK(utilisation.step(25.0f, 25.0f, bad).level == UtilisationLevel::error);
    CHECK(utilisation.step(25.0f, 25.0f, 25.0f).level == UtilisationLevel::normal);
  }
  CHECK(utilisation.step(30.0f, 30.0f, 60.0f).level == UtilisationLevel::error);
  CHECK(std::isfinite(utilisation.state().percent));

  Utilisation::Config wrong = config();
  wrong.error_percent = 80.0f;
  CHECK(wrong.validate() == ConfigError::error_percent);
  CHECK(Utilisation(wrong).step(25.0f, 25.0f, 25.0f).level == UtilisationLevel::error);
  wrong = config();
  wrong.warning_percent = nan;
  CHECK(wrong.validate() == ConfigError::warning_percent);
  wrong = config();
  wrong.hysteresis_percent = -1.0f;
  CHECK(wrong.validate() == ConfigError::hysteresis_percent);
  CHECK(Utilisation::Config::standard().validate() == ConfigError::maximum_winding_C);
}
