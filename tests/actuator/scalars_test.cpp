// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/actuator/current_model.hpp>
#include <thermopower/actuator/ohmic_current.hpp>
#include <thermopower/actuator/two_node_thermal_model.hpp>
#include <thermopower/motors/bgm2606_90t.hpp>
#include <thermopower/simulation/lanes.hpp>

#include <unsupported/Eigen/AutoDiff>

#include "near.hpp"
#include "samples.hpp"

#include <functional>
#include <limits>

namespace tp = thermopower;

// One model, four scalars: what a firmware steps in float, a simulation steps in lanes and a fit
// differentiates.

namespace {

template <class Number>
using Laws =
    std::tuple<tp::ThermalModel<tp::HeatCapacityHeating<Number>, tp::NewtonCooling<Number>, tp::ExactStep>,
               tp::ThermalModel<tp::HeatCapacityHeating<Number>, tp::ForcedAirflow<Number>, tp::ExactStep>,
               tp::ThermalModel<tp::HeatCapacityHeating<Number>,
                                tp::SumOfCooling<tp::NaturalConvection<Number>, tp::RadiationCooling<Number>>,
                                tp::LinearizedStep>,
               tp::ThermalModel<tp::ThesisHeating<Number>, tp::RateCooling<Number>, tp::LinearizedStep>,
               tp::ThermalModel<tp::ThesisHeating<Number>, tp::RateCooling<Number>, tp::EulerStep>>;

template <class Number>
Number number(double value) {
  return tp::detail::Numeric<Number>::constant(
      static_cast<typename tp::detail::Numeric<Number>::Real>(value));
}

/// Sets the constants of each composition from plain numbers.
template <class Number>
tp::HeatCapacityHeating<Number> heating(const tp::HeatCapacityHeating<Number>*, double scale) {
  return {number<Number>(18.0 * scale)};
}
template <class Number>
tp::ThesisHeating<Number> heating(const tp::ThesisHeating<Number>*, double scale) {
  return tp::ThesisHeating<Number>::per_minute(number<Number>(-0.00024249),
                                               number<Number>(0.00620096 * scale), number<Number>(0.02545869),
                                               number<Number>(-0.10495822), number<Number>(1.0));
}
template <class Number>
tp::NewtonCooling<Number> cooling(const tp::NewtonCooling<Number>*) {
  return {number<Number>(0.05)};
}
template <class Number>
tp::RateCooling<Number> cooling(const tp::RateCooling<Number>*) {
  return {number<Number>(0.11 / 60.0)};
}
template <class Number>
tp::ForcedAirflow<Number> cooling(const tp::ForcedAirflow<Number>*) {
  return {number<Number>(0.03), number<Number>(0.8), number<Number>(0.6)};
}
template <class Number>
tp::SumOfCooling<tp::NaturalConvection<Number>, tp::RadiationCooling<Number>> cooling(
    const tp::SumOfCooling<tp::NaturalConvection<Number>, tp::RadiationCooling<Number>>*) {
  return {{number<Number>(0.04), number<Number>(0.25), number<Number>(20.0)},
          {number<Number>(0.006), number<Number>(0.9)}};
}

/// Five minutes of a motor with the thesis's current, on any scalar; start and supply differ per call.
template <class Model>
typename Model::Scalar temperature_after(double capacity_scale, double start_C,
                                         const typename Model::Scalar& supply_V) {
  using Number = typename Model::Scalar;
  const typename Model::Config config = {
      heating(static_cast<decltype(Model::Config::heating)*>(nullptr), capacity_scale),
      cooling(static_cast<decltype(Model::Config::cooling)*>(nullptr))};
  const tp::CurrentModel<tp::ThesisCurrent<Number>> current(tp::ThesisCurrent<Number>::from_milliampere(
      number<Number>(-0.013445), number<Number>(0.015576), number<Number>(0.016839), number<Number>(0.155098),
      number<Number>(3.459071), number<Number>(1.0)));
  Model model(config, number<Number>(start_C));
  for (int i = 0; i < 300; ++i) {
    const auto drawn = current.at_power(number<Number>(i < 200 ? 120.0 : 25.0), supply_V, model.hottest_C());
    model.step({drawn.winding_power_W, drawn.v_rms_V, {number<Number>(22.0), number<Number>(1.5)}},
               number<Number>(1.0));
  }
  return model.hottest_C();
}

template <size_t index>
void compare_scalars() {
  using Double = std::tuple_element_t<index, Laws<double>>;
  using Float = std::tuple_element_t<index, Laws<float>>;
  using Eight = tp::Lanes<double, 8>;
  using Batch = std::tuple_element_t<index, Laws<Eight>>;
  using Four = std::tuple_element_t<index, Laws<tp::Lanes<float, 4>>>;
  using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  using Differential = std::tuple_element_t<index, Laws<Dual>>;

  const double plain = temperature_after<Double>(1.0, 30.0, 13.0);
  CAPTURE(index, plain);
  REQUIRE(plain > 31.0);
  CHECK(static_cast<double>(temperature_after<Float>(1.0, 30.0, 13.0f)) == Near(plain).epsilon(3e-5));

  // Every lane on its own supply, equal to the plain model's answer to the last digits.
  Eight supply_V;
  supply_V << 6.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0;
  const Eight lanes = temperature_after<Batch>(1.0, 30.0, supply_V);
  for (int lane = 0; lane < 8; ++lane)
    CHECK(lanes[lane] == Near(temperature_after<Double>(1.0, 30.0, supply_V[lane])).epsilon(1e-12));
  const tp::Lanes<float, 4> four = temperature_after<Four>(1.0, 30.0, tp::Lanes<float, 4>::Constant(13.0f));
  CHECK(static_cast<double>(four[2]) == Near(plain).epsilon(3e-5));

  // A NaN stays in its lane.
  supply_V[3] = std::numeric_limits<double>::quiet_NaN();
  const Eight broken = temperature_after<Batch>(1.0, 30.0, supply_V);
  CHECK(std::isnan(broken[3]));
  CHECK(broken[2] == lanes[2]);
  CHECK(broken[4] == lanes[4]);

  // d temperature / d supply, by differentiation and by a difference quotient.
  const Dual slope = temperature_after<Differential>(1.0, 30.0, Dual(13.0, 2, 0));
  const double h = 1e-5;
  const double quotient =
      (temperature_after<Double>(1.0, 30.0, 13.0 + h) - temperature_after<Double>(1.0, 30.0, 13.0 - h)) /
      (2 * h);
  CHECK(slope.value() == Near(plain).epsilon(1e-13));
  CHECK(slope.derivatives()[0] == Near(quotient).epsilon(1e-6));
  CHECK(slope.derivatives()[1] == 0.0);
}

}  // namespace

TEST_CASE("heat capacity with Newton's cooling gives the same on every scalar") { compare_scalars<0>(); }
TEST_CASE("heat capacity with airflow gives the same on every scalar") { compare_scalars<1>(); }
TEST_CASE("heat capacity with convection and radiation gives the same on every scalar") {
  compare_scalars<2>();
}
TEST_CASE("the thesis's laws, linearized, give the same on every scalar") { compare_scalars<3>(); }
TEST_CASE("the thesis's laws, by Euler, give the same on every scalar") { compare_scalars<4>(); }

namespace {
/// Winding after a minute, as a function of the five constants, on any scalar.
template <class Number>
Number two_nodes(const Number (&constant)[4]) {
  tp::TwoNodeThermalModel<Number> model({constant[0], constant[1], constant[2], {constant[3]}},
                                        number<Number>(25.0));
  for (int i = 0; i < 60; ++i)
    model.step({number<Number>(i < 40 ? 4.0 : 0.5),
                number<Number>(0.0),
                {number<Number>(22.0), number<Number>(0.0)}},
               number<Number>(1.0));
  return model.state().winding_C;
}
}  // namespace

TEST_CASE("two nodes are differentiable in every constant") {
  using Dual = Eigen::AutoDiffScalar<Eigen::Vector4d>;
  const double at[4] = {2.0, 16.0, 0.4, 0.06};
  const Dual seeded[4] = {Dual(at[0], 4, 0), Dual(at[1], 4, 1), Dual(at[2], 4, 2), Dual(at[3], 4, 3)};
  const Dual result = two_nodes(seeded);
  for (int i = 0; i < 4; ++i) {
    double up[4] = {at[0], at[1], at[2], at[3]}, down[4] = {at[0], at[1], at[2], at[3]};
    const double h = 1e-5 * at[i];
    up[i] += h;
    down[i] -= h;
    CAPTURE(i);
    CHECK(result.derivatives()[i] == Near((two_nodes(up) - two_nodes(down)) / (2.0 * h)).epsilon(1e-6));
  }
  using Eight = tp::Lanes<double, 8>;
  const Eight lanes[4] = {Eight::Constant(2.0), Eight::Constant(16.0), Eight::Constant(0.4),
                          Eight::Constant(0.06)};
  CHECK(two_nodes(lanes)[5] == Near(result.value()).epsilon(1e-13));
}

TEST_CASE("a motor at rest has finite derivatives: no infinity from the roots and powers at zero") {
  using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  const auto finite = [](const Dual& x) { return std::isfinite(x.value()) && x.derivatives().allFinite(); };
  const tp::Surroundings<Dual> still = {Dual(25.0, 2, 0), Dual(0.0)};
  const Dual motor_C(25.0, 2, 1), rise(0.05);
  const tp::NaturalConvection<Dual> convection = {Dual(0.04), Dual(0.25), Dual(20.0)};
  const tp::ForcedAirflow<Dual> airflow = {Dual(0.03), Dual(0.8), Dual(0.6)};
  CHECK(finite(convection.rate_K_per_s(motor_C, still, rise)));
  CHECK(finite(airflow.rate_K_per_s(motor_C, still, rise)));
  const tp::ThesisCurrent<Dual> law = tp::ThesisCurrent<Dual>::from_milliampere(
      Dual(-0.0134), Dual(0.0156), Dual(0.0167), Dual(0.1551), Dual(3.4591), Dual(1.0));
  CHECK(finite(law.current_A(Dual(0.0, 2, 0), motor_C)));
}

TEST_CASE("a power of lanes is that of the numbers in them, at zero, infinity and NaN, too") {
  const auto same = [](auto real, double digits) {
    using Real = decltype(real);
    using Lanes = tp::Lanes<Real, 8>;
    const Real infinity = std::numeric_limits<Real>::infinity(), nan = std::numeric_limits<Real>::quiet_NaN();
    Lanes base, exponent;
    base << Real(0), Real(2), nan, infinity, Real(1e-30), Real(-1), Real(40), Real(1);
    exponent << Real(0.6), Real(0.5), Real(0.5), Real(0.6), Real(0.6), Real(0.5), Real(0.25), Real(3);
    const Lanes lanes = tp::detail::Numeric<Lanes>::power(base, exponent);
    for (Eigen::Index i = 0; i < 8; ++i) {
      const Real plain = tp::detail::Numeric<Real>::power(base[i], exponent[i]);
      CAPTURE(base[i], exponent[i], lanes[i], plain);
      if (std::isnan(plain)) CHECK(std::isnan(lanes[i]));
      else if (std::isinf(plain)) CHECK(lanes[i] == plain);
      else if (!(plain > Real(0)))
        CHECK((lanes[i] >= Real(0) && lanes[i] < std::numeric_limits<Real>::min()));
      else CHECK(std::fabs(static_cast<double>(lanes[i] / plain) - 1.0) < digits);
    }
  };
  same(1.0f, 2e-6);
  same(1.0, 4e-15);
}
