// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/expression.hpp>

#include <pybind11/pybind11.h>

#include <cmath>

/// @file arithmetic.hpp
/// What numbers can do in Python that are more than a value.

namespace thermopower::python {

namespace py = pybind11;

/// a to a power, by its logarithm where the number knows no other way.
template <class Number, class Power>
Number raised(const Number& a, const Power& b) {
  return exp(log(a) * b);
}
/// The same of plain numbers.
inline double raised(double a, double b) { return std::pow(a, b); }
/// The same of a number that is traced.
inline plant::Expression raised(const plant::Expression& a, const plant::Expression& b) { return pow(a, b); }

/// a to a plain power: whole ones by products, so that a may be negative.
template <class Number>
Number power_of(const Number& a, double b) {
  constexpr double most = 8.0;
  if (b != std::floor(b) || std::abs(b) > most) return raised(a, b);
  Number product(1.0);
  for (double i = 0.0; i < std::abs(b); ++i) product *= a;
  return b < 0.0 ? 1.0 / product : product;
}

/// Arithmetic, comparisons and NumPy's functions, which find theirs by name.
template <class Number>
void bind_arithmetic(py::class_<Number>& one) {
  one.def(py::init<double>())
      .def(
          "__add__", [](const Number& a, const Number& b) { return a + b; }, py::is_operator())
      .def(
          "__add__", [](const Number& a, double b) { return a + b; }, py::is_operator())
      .def(
          "__radd__", [](const Number& a, double b) { return a + b; }, py::is_operator())
      .def(
          "__sub__", [](const Number& a, const Number& b) { return a - b; }, py::is_operator())
      .def(
          "__sub__", [](const Number& a, double b) { return a - b; }, py::is_operator())
      .def(
          "__rsub__", [](const Number& a, double b) { return b - a; }, py::is_operator())
      .def(
          "__mul__", [](const Number& a, const Number& b) { return a * b; }, py::is_operator())
      .def(
          "__mul__", [](const Number& a, double b) { return a * b; }, py::is_operator())
      .def(
          "__rmul__", [](const Number& a, double b) { return a * b; }, py::is_operator())
      .def(
          "__truediv__", [](const Number& a, const Number& b) { return a / b; }, py::is_operator())
      .def(
          "__truediv__", [](const Number& a, double b) { return a / b; }, py::is_operator())
      .def(
          "__rtruediv__", [](const Number& a, double b) { return b / a; }, py::is_operator())
      .def(
          "__pow__", [](const Number& a, double b) { return power_of(a, b); }, py::is_operator())
      .def(
          "__pow__", [](const Number& a, const Number& b) { return raised(a, b); }, py::is_operator())
      .def("__neg__", [](const Number& a) { return -a; })
      .def("__pos__", [](const Number& a) { return a; })
      .def("__abs__", [](const Number& a) { return abs(a); })
      .def(
          "__lt__", [](const Number& a, const Number& b) { return a < b; }, py::is_operator())
      .def(
          "__gt__", [](const Number& a, const Number& b) { return a > b; }, py::is_operator())
      .def(
          "__le__", [](const Number& a, const Number& b) { return a <= b; }, py::is_operator())
      .def(
          "__ge__", [](const Number& a, const Number& b) { return a >= b; }, py::is_operator())
      .def("exp", [](const Number& a) { return exp(a); })
      .def("log", [](const Number& a) { return log(a); })
      .def("sin", [](const Number& a) { return sin(a); })
      .def("cos", [](const Number& a) { return cos(a); })
      .def("tanh", [](const Number& a) { return tanh(a); })
      .def("sqrt", [](const Number& a) { return sqrt(a); })
      .def("square", [](const Number& a) { return a * a; });
  py::implicitly_convertible<double, Number>();
  py::implicitly_convertible<int, Number>();
}

}  // namespace thermopower::python
