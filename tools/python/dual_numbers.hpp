// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <pybind11/pybind11.h>

#include <cmath>

/// @file dual_numbers.hpp
/// Numbers that carry their derivatives, for functions in Python.

namespace thermopower::python {

namespace py = pybind11;

/// a to a plain power: whole ones by products, so that a may be negative.
template <class Dual>
Dual power_of(const Dual& a, double b) {
  constexpr double most = 8.0;
  if (b != std::floor(b) || std::abs(b) > most) return exp(log(a) * b);
  Dual product(1.0);
  for (double i = 0.0; i < std::abs(b); ++i) product *= a;
  return b < 0.0 ? 1.0 / product : product;
}

/// A function of x by its value and its derivative there.
template <class Dual>
Dual of(const Dual& x, double value, double derivative) {
  return (x - x.value()) * derivative + value;
}

/// Numbers that carry their derivatives, as Python sees them. NumPy's functions find theirs by name.
template <class Dual>
void bind_dual(py::module_& module, const char* name) {
  py::class_<Dual>(module, name)
      .def(py::init<double>())
      .def_property_readonly("value", &Dual::value)
      .def_property_readonly("slope", [](const Dual& a) { return a.slope(0); })
      .def_static("variable",
                  [](double value) {
                    Dual x(value);
                    x.seed(0);
                    return x;
                  })
      .def("__float__",
           [](const Dual&) -> double {
             throw py::type_error(
                 "an effect's function made a plain number of one that carries its derivatives; use NumPy's "
                 "functions and abs(), not those of math");
           })
      .def(
          "__add__", [](const Dual& a, const Dual& b) { return a + b; }, py::is_operator())
      .def(
          "__add__", [](const Dual& a, double b) { return a + b; }, py::is_operator())
      .def(
          "__radd__", [](const Dual& a, double b) { return a + b; }, py::is_operator())
      .def(
          "__sub__", [](const Dual& a, const Dual& b) { return a - b; }, py::is_operator())
      .def(
          "__sub__", [](const Dual& a, double b) { return a - b; }, py::is_operator())
      .def(
          "__rsub__", [](const Dual& a, double b) { return b - a; }, py::is_operator())
      .def(
          "__mul__", [](const Dual& a, const Dual& b) { return a * b; }, py::is_operator())
      .def(
          "__mul__", [](const Dual& a, double b) { return a * b; }, py::is_operator())
      .def(
          "__rmul__", [](const Dual& a, double b) { return a * b; }, py::is_operator())
      .def(
          "__truediv__", [](const Dual& a, const Dual& b) { return a / b; }, py::is_operator())
      .def(
          "__truediv__", [](const Dual& a, double b) { return a / b; }, py::is_operator())
      .def(
          "__rtruediv__", [](const Dual& a, double b) { return b / a; }, py::is_operator())
      .def(
          "__pow__", [](const Dual& a, double b) { return power_of(a, b); }, py::is_operator())
      .def(
          "__pow__", [](const Dual& a, const Dual& b) { return exp(log(a) * b); }, py::is_operator())
      .def(
          "__rpow__", [](const Dual& a, double b) { return exp(a * std::log(b)); }, py::is_operator())
      .def("__neg__", [](const Dual& a) { return -a; })
      .def("__pos__", [](const Dual& a) { return a; })
      .def("__abs__", [](const Dual& a) { return abs(a); })
      .def(
          "__lt__", [](const Dual& a, const Dual& b) { return a < b; }, py::is_operator())
      .def(
          "__gt__", [](const Dual& a, const Dual& b) { return a > b; }, py::is_operator())
      .def(
          "__le__", [](const Dual& a, const Dual& b) { return a <= b; }, py::is_operator())
      .def(
          "__ge__", [](const Dual& a, const Dual& b) { return a >= b; }, py::is_operator())
      .def("exp", [](const Dual& a) { return exp(a); })
      .def("log", [](const Dual& a) { return log(a); })
      .def("sin", [](const Dual& a) { return sin(a); })
      .def("cos", [](const Dual& a) { return cos(a); })
      .def("tanh", [](const Dual& a) { return tanh(a); })
      .def("sqrt", [](const Dual& a) { return sqrt(a); })
      .def("square", [](const Dual& a) { return a * a; })
      .def("expm1", [](const Dual& a) { return of(a, std::expm1(a.value()), std::exp(a.value())); })
      .def("log1p", [](const Dual& a) { return of(a, std::log1p(a.value()), 1.0 / (1.0 + a.value())); })
      .def("tan",
           [](const Dual& a) {
             const double tangent = std::tan(a.value());
             return of(a, tangent, 1.0 + tangent * tangent);
           })
      .def("sinh", [](const Dual& a) { return of(a, std::sinh(a.value()), std::cosh(a.value())); })
      .def("cosh", [](const Dual& a) { return of(a, std::cosh(a.value()), std::sinh(a.value())); })
      .def("arcsin",
           [](const Dual& a) {
             return of(a, std::asin(a.value()), 1.0 / std::sqrt(1.0 - a.value() * a.value()));
           })
      .def("arccos",
           [](const Dual& a) {
             return of(a, std::acos(a.value()), -1.0 / std::sqrt(1.0 - a.value() * a.value()));
           })
      .def("arctan",
           [](const Dual& a) { return of(a, std::atan(a.value()), 1.0 / (1.0 + a.value() * a.value())); });
  py::implicitly_convertible<double, Dual>();
  py::implicitly_convertible<int, Dual>();
}

}  // namespace thermopower::python
