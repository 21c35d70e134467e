// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/tabulated_current.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/motors/bgm5208_200_12.hpp>

#include "near.hpp"

#include <limits>

namespace tp = thermopower;

namespace {
/// Largest error in ampere over 0 .. 16 V and 0 .. 100 degC.
template <class Motor, int node_count>
double worst_A() {
  const tp::TabulatedCurrent<tp::ThesisCurrentSource<Motor>, node_count> table;
  const auto law = Motor::template current_law<double>();
  double worst = 0.0;
  for (int i = 0; i <= 16000; ++i) {
    const float volt = static_cast<float>(i) * 0.001f;
    for (const float motor_C : {0.0f, 25.0f, 60.0f, 100.0f}) {
      const double error = static_cast<double>(table.current_A(volt, motor_C)) -
                           law.current_A(static_cast<double>(volt), static_cast<double>(motor_C));
      worst = std::max(worst, std::abs(error));
    }
  }
  return worst;
}
}  // namespace

TEST_CASE("the compiler's logarithm, exponential and power are right to a double's digits") {
  for (double x = 1e-6; x < 1e6; x *= 1.1) {
    CHECK(tp::detail::constexpr_log(x) == Near(std::log(x)).epsilon(1e-14).margin(1e-15));
    CHECK(tp::detail::constexpr_pow(x, 3.4591) == Near(std::pow(x, 3.4591)).epsilon(1e-12));
    CHECK(tp::detail::constexpr_pow(x, 0.25) == Near(std::pow(x, 0.25)).epsilon(1e-13));
  }
  for (double x = -20.0; x < 20.0; x += 0.013)
    CHECK(tp::detail::constexpr_exp(x) == Near(std::exp(x)).epsilon(1e-13));
  static_assert(
      tp::detail::constexpr_pow(2.0, 10.0) > 1023.9999 && tp::detail::constexpr_pow(2.0, 10.0) < 1024.0001,
      "at compile time");
  CHECK(tp::detail::constexpr_pow(0.0, 3.0) == 0.0);
}

TEMPLATE_TEST_CASE("a tabulated current is within 0.6 mA of the law, everywhere", "", tp::motors::Bgm2606_90t,
                   tp::motors::Bgm2606_90t::AsProgrammed, tp::motors::Bgm5208_200_12,
                   tp::motors::Bgm5208_200_12::AsProgrammed) {
  CHECK(worst_A<TestType, 65>() < 0.6e-3);
}

TEST_CASE("half the spacing is a quarter of the error") {
  const double coarse = worst_A<tp::motors::Bgm2606_90t, 33>(), fine = worst_A<tp::motors::Bgm2606_90t, 65>();
  CHECK(coarse / fine == Near(4.0).epsilon(0.1));
}

TEST_CASE("a tabulated current begins and ends where the law does") {
  const tp::TabulatedCurrent<tp::ThesisCurrentSource<tp::motors::Bgm2606_90t> > table;
  CHECK(table.current_A(0.0f, 40.0f) == 0.0f);
  CHECK(table.current_A(1.0f, 40.0f) == 0.0f);
  CHECK(table.current_A(-3.0f, 40.0f) == 0.0f);
  CHECK(table.current_A(16.0f, 40.0f) > table.current_A(15.9f, 40.0f));
  CHECK(table.validate() == tp::ConfigError::none);
}

TEST_CASE(
    "no voltage reads beside the table: NaN stays NaN, and above the table the current is NaN, which counts "
    "as hot") {
  const tp::TabulatedCurrent<tp::ThesisCurrentSource<tp::motors::Bgm2606_90t> > table;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float volt : {nan, infinity, 16.001f, 1e30f}) CHECK(std::isnan(table.current_A(volt, 40.0f)));
  CHECK(std::isnan(table.current_A(8.0f, nan)));
  CHECK(std::isnan(table.current_A(-infinity, 40.0f)));
}

TEST_CASE("a tabulated current takes the place of the law in a motor") {
  typedef tp::TabulatedCurrent<tp::ThesisCurrentSource<tp::motors::Bgm5208_200_12> > Table;
  const tp::CurrentModel<Table> fast((Table()));
  const tp::CurrentModel<tp::ThesisCurrent<float> > exact(tp::motors::Bgm5208_200_12::current());
  for (int power = 0; power <= 255; ++power) {
    const auto quick = fast.at_power(static_cast<float>(power), 13.0f, 45.0f);
    const auto slow = exact.at_power(static_cast<float>(power), 13.0f, 45.0f);
    CHECK(quick.v_rms_V == slow.v_rms_V);
    CHECK(std::abs(quick.current_A - slow.current_A) < 6e-4f);
  }
}
