// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/actuator/curve.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/expression.hpp>

#include <string>
#include <vector>

/// @file curve.hpp
/// Smooth functions of a recorded variable as effects: their parameters, and their value for every scalar.

namespace thermopower::plant {

/// Value of a curve, with its derivatives by the knots and by `x`. Firmware's curve_value() is the same function.
/// @param p  where the first and the last knot lie, then the values at the knots
/// @param x  where it is asked for, in the unit of the first two
template <class Scalar>
Scalar curve_at(const char*, const Scalar* p, const Scalar& x) {
  const double from = value_of(p[0]), per_x = (curve_knot_count - 1) / (value_of(p[1]) - from);
  const thermopower::detail::CurvePlace<double> place((value_of(x) - from) * per_x, curve_knot_count);
  const Scalar* const knot = p + curve_support_count;
  Scalar sum = constant<Scalar>(0.0);
  double slope = 0.0;
  for (int k = 0; k < 4; ++k) {
    const int i = place.first + k - 1;
    if (i < 0 || i >= curve_knot_count) continue;
    sum += knot[i] * place.weight[k];
    slope += value_of(knot[i]) * place.slope[k];
  }
  if (place.inside) sum += (x - value_of(x)) * (slope * per_x);
  return sum;
}

/// The same, written down: a look-up in a table. @param id  of the effect
inline Expression curve_at(const char* id, const Expression* p, const Expression& x) {
  if (x.is_constant()) {
    std::vector<double> values;
    for (int i = 0; i < curve_support_count + curve_knot_count; ++i) values.push_back(p[i].constant_value());
    return curve_at<double>(id, values.data(), x.constant_value());
  }
  WrittenCurve curve{p[0].constant_value(), p[1].constant_value(), {}};
  for (int i = 0; i < curve_knot_count; ++i)
    curve.values.push_back(p[curve_support_count + i].constant_value());
  return x.trace()->curve(id, std::move(curve), x);
}

/// A curve's description, without its id, place, words and needs.
/// @param variable   that it is a function of, as `angle_deg`: its unit ends the names of the first two parameters
/// @param unit       of the values, as their names begin
/// @param spelt      the same as reports spell it
inline EffectInfo curve_info(const char* id, Submodel submodel, const char* equation, const char* prose,
                             const CurveShape& shape, const std::string& variable, const std::string& unit,
                             const std::string& spelt, std::vector<Need> needs, const char* experiment) {
  constexpr double farthest = 1e6;
  const std::string suffix = variable.substr(variable.rfind('_'));
  const std::string unit_of_variable = suffix == "_C"     ? "degC"
                                       : suffix == "_dps" ? "deg/s"
                                                          : suffix.substr(1);
  EffectInfo one;
  one.id = id;
  one.submodel = submodel;
  one.equation = equation;
  one.prose = prose;
  one.parameters = {parameter(0, "from" + suffix)
                        .unit(unit_of_variable)
                        .within(-farthest, farthest)
                        .starts({-1.0})
                        .given_by_data(),
                    parameter(1, "to" + suffix)
                        .unit(unit_of_variable)
                        .within(-farthest, farthest)
                        .starts({1.0})
                        .given_by_data()};
  for (int i = 0; i < curve_knot_count; ++i)
    one.parameters.push_back(parameter(curve_support_count + i, unit + "_" + std::to_string(i + 1))
                                 .unit(spelt)
                                 .within(-farthest, farthest)
                                 .starts({0.0}));
  one.needs = std::move(needs);
  one.experiment = experiment;
  one.costly = true;  // causes with a name come first
  one.curve = shape;
  return one;
}

}  // namespace thermopower::plant
