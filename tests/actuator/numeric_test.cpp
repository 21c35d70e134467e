// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/duty.hpp>
#include <thermopower/detail/check.hpp>

#include "near.hpp"

#include <cmath>
#include <limits>

namespace tp = thermopower;

TEMPLATE_TEST_CASE("the mean of a decay is right to rounding from a billionth to a thousand time constants",
                   "", float, double) {
  const double rounding = static_cast<double>(std::numeric_limits<TestType>::epsilon());
  for (double exponent = -12.0; exponent <= 3.0; exponent += 0.001) {
    const TestType x = static_cast<TestType>(std::pow(10.0, exponent));
    const long double exact = -std::expm1(-static_cast<long double>(x)) / static_cast<long double>(x);
    const double relative =
        static_cast<double>(static_cast<long double>(tp::detail::mean_decay(x)) / exact - 1.0L);
    CAPTURE(x);
    REQUIRE(std::abs(relative) < 4.0 * rounding);
  }
  CHECK(tp::detail::mean_decay(TestType(0)) == TestType(1));
  CHECK(tp::detail::mean_decay(std::numeric_limits<TestType>::infinity()) == TestType(0));
  CHECK(std::isnan(tp::detail::mean_decay(std::numeric_limits<TestType>::quiet_NaN())));
}

TEMPLATE_TEST_CASE("finite numbers are told from the others by their bits", "", float, double) {
  using Limits = std::numeric_limits<TestType>;
  for (const TestType x :
       {TestType(0), TestType(-1), Limits::min(), Limits::denorm_min(), Limits::max(), Limits::lowest()})
    CHECK(tp::detail::is_finite(x));
  for (const TestType x :
       {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN()})
    CHECK_FALSE(tp::detail::is_finite(x));
}

TEMPLATE_TEST_CASE("bounds let a NaN through", "", float, double) {
  const TestType nan = std::numeric_limits<TestType>::quiet_NaN();
  CHECK(std::isnan(tp::detail::at_least(nan, TestType(1))));
  CHECK(std::isnan(tp::detail::at_most(nan, TestType(1))));
  CHECK(tp::detail::at_least(TestType(2), TestType(1)) == TestType(2));
  CHECK(tp::detail::at_least(TestType(0), TestType(1)) == TestType(1));
  CHECK(tp::detail::at_most(TestType(2), TestType(1)) == TestType(1));
  CHECK(tp::detail::at_most(TestType(0), TestType(1)) == TestType(0));
}

TEST_CASE("a range check refuses NaN, infinity and what lies outside, and nothing else") {
  const auto field = tp::ConfigError::supply_V;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    CHECK(tp::detail::require_positive(bad, field) == field);
    CHECK(tp::detail::require_not_negative(bad, field) == field);
    CHECK(tp::detail::require_finite(bad, field) == field);
    CHECK(tp::detail::require_within(bad, -1e30f, 1e30f, field) == field);
  }
  CHECK(tp::detail::require_positive(0.0f, field) == field);
  CHECK(tp::detail::require_positive(1e-30f, field) == tp::ConfigError::none);
  CHECK(tp::detail::require_not_negative(0.0f, field) == tp::ConfigError::none);
  CHECK(tp::detail::require_not_negative(-1e-30f, field) == field);
  CHECK(tp::detail::require_within(1.0f, 1.0f, 2.0f, field) == tp::ConfigError::none);
  CHECK(tp::detail::require_within(2.0f, 1.0f, 2.0f, field) == tp::ConfigError::none);
  CHECK(tp::detail::require_within(2.1f, 1.0f, 2.0f, field) == field);
}

TEMPLATE_TEST_CASE("V_rms is the supply times the root of the duty, eq 3.10 and 3.11", "", float, double) {
  CHECK(tp::duty_from_power(TestType(255)) == Near(1.0));
  CHECK(tp::v_rms_from_duty(TestType(13), TestType(0.25)) == Near(6.5));
  CHECK(tp::v_rms_from_power(TestType(13), TestType(0)) == TestType(0));
  CHECK(tp::v_rms_from_power(TestType(13), TestType(255)) == Near(13.0));
  // The least power of the original: 0.814 V, below the volt at which its current law begins.
  CHECK(tp::v_rms_from_power(TestType(13), TestType(1)) == Near(0.81409).epsilon(1e-5));
  CHECK(std::isnan(tp::v_rms_from_power(TestType(13), TestType(-1))));
}
