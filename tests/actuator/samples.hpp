// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/thermal_model.hpp>

#include <cmath>
#include <tuple>

// One plausible set of constants per law, and every composition of them: the law suites run over this list.
namespace samples {

namespace tp = thermopower;

template <class Law>
struct Sample;

template <class Number>
struct Sample<tp::HeatCapacityHeating<Number>> {
  static tp::HeatCapacityHeating<Number> law() { return {Number(18)}; }
};
template <class Number>
struct Sample<tp::ThesisHeating<Number>> {
  static tp::ThesisHeating<Number> law() {
    return tp::ThesisHeating<Number>::per_minute(Number(-0.00024249), Number(0.00620096), Number(0.02545869),
                                                 Number(-0.10495822), Number(1));
  }
};
template <class Number>
struct Sample<tp::RateCooling<Number>> {
  static tp::RateCooling<Number> law() { return tp::RateCooling<Number>::per_minute(Number(0.11)); }
};
template <class Number>
struct Sample<tp::NewtonCooling<Number>> {
  static tp::NewtonCooling<Number> law() { return {Number(0.05)}; }
};
template <class Number>
struct Sample<tp::NaturalConvection<Number>> {
  static tp::NaturalConvection<Number> law() { return {Number(0.04), Number(0.25), Number(20)}; }
};
template <class Number>
struct Sample<tp::RadiationCooling<Number>> {
  static tp::RadiationCooling<Number> law() { return {Number(0.006), Number(0.9)}; }
};
template <class Number>
struct Sample<tp::ForcedAirflow<Number>> {
  static tp::ForcedAirflow<Number> law() { return {Number(0.03), Number(0.8), Number(0.6)}; }
};
template <class First, class Second>
struct Sample<tp::SumOfCooling<First, Second>> {
  static tp::SumOfCooling<First, Second> law() { return {Sample<First>::law(), Sample<Second>::law()}; }
};

template <class HeatingLaw, class CoolingLaw, class StepRule>
struct Composition {
  using Heating = HeatingLaw;
  using Cooling = CoolingLaw;
  using Step = StepRule;
  using Number = typename Heating::Scalar;
  using Model = tp::ThermalModel<Heating, Cooling, Step>;

  static constexpr bool is_euler = std::is_same<Step, tp::EulerStep>::value;
  static constexpr bool is_linear = Heating::is_linear() && Cooling::is_linear();

  static typename Model::Config config() { return {Sample<Heating>::law(), Sample<Cooling>::law()}; }
  static Model model(Number motor_C) { return Model(config(), motor_C); }
  static typename Model::Inputs inputs(Number power_W, Number air_C = Number(25)) {
    return {power_W, Number(10), {air_C, Number(2)}};
  }
  /// dT/dt by the laws alone, without the stepping under test.
  static Number rate(Number motor_C, const typename Model::Inputs& inputs) {
    const auto laws = config();
    const Number rise = laws.heating.rise_K_per_J(inputs.v_rms_V, motor_C);
    return rise * inputs.power_W - laws.cooling.rate_K_per_s(motor_C, inputs.around, rise);
  }
  /// Temperature after `time_s` by fourth-order Runge-Kutta with steps so small that its error is nothing.
  static Number reference(Number motor_C, const typename Model::Inputs& inputs, Number time_s,
                          int steps = 4000) {
    const Number dt = time_s / Number(steps);
    for (int i = 0; i < steps; ++i) {
      const Number a = rate(motor_C, inputs), b = rate(motor_C + dt / 2 * a, inputs),
                   c = rate(motor_C + dt / 2 * b, inputs), d = rate(motor_C + dt * c, inputs);
      motor_C += dt / 6 * (a + 2 * b + 2 * c + d);
    }
    return motor_C;
  }
};

using Watts = tp::HeatCapacityHeating<double>;
using Convection = tp::NaturalConvection<double>;
using Radiation = tp::RadiationCooling<double>;
using Airflow = tp::ForcedAirflow<double>;
using Newton = tp::NewtonCooling<double>;
using Rate = tp::RateCooling<double>;
using Thesis = tp::ThesisHeating<double>;
using Sum = tp::SumOfCooling<Convection, Radiation>;
using SumOfThree = tp::SumOfCooling<Newton, tp::SumOfCooling<Airflow, Newton>>;

using Linear =
    std::tuple<Composition<Watts, Newton, tp::ExactStep>, Composition<Watts, Airflow, tp::ExactStep>,
               Composition<Watts, Rate, tp::ExactStep>, Composition<Watts, SumOfThree, tp::ExactStep>>;
using Bent =
    std::tuple<Composition<Watts, Convection, tp::LinearizedStep>,
               Composition<Watts, Radiation, tp::LinearizedStep>, Composition<Watts, Sum, tp::LinearizedStep>,
               Composition<Thesis, Rate, tp::LinearizedStep>>;
using Straight =
    std::tuple<Composition<Watts, Newton, tp::LinearizedStep>,
               Composition<Watts, Airflow, tp::LinearizedStep>, Composition<Watts, Rate, tp::LinearizedStep>,
               Composition<Watts, SumOfThree, tp::LinearizedStep>>;
using Eulers =
    std::tuple<Composition<Watts, Newton, tp::EulerStep>, Composition<Watts, Airflow, tp::EulerStep>,
               Composition<Watts, Rate, tp::EulerStep>, Composition<Watts, Convection, tp::EulerStep>,
               Composition<Watts, Radiation, tp::EulerStep>, Composition<Watts, Sum, tp::EulerStep>,
               Composition<Watts, SumOfThree, tp::EulerStep>, Composition<Thesis, Rate, tp::EulerStep>>;
using Unconditional = decltype(std::tuple_cat(Linear(), Bent(), Straight()));
using Every = decltype(std::tuple_cat(Unconditional(), Eulers()));

}  // namespace samples
