// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>

#include <pybind11/pybind11.h>

#include <cmath>

#include "arithmetic.hpp"

/// @file dual_numbers.hpp
/// Numbers that carry their derivatives, for functions in Python.

namespace thermopower::python {

/// A function of x by its value and its derivative there.
template <class Dual>
Dual of(const Dual& x, double value, double derivative) {
  return (x - x.value()) * derivative + value;
}

/// Numbers that carry their derivatives, as Python sees them.
template <class Dual>
void bind_dual(py::module_& module, const char* name) {
  py::class_<Dual> number(module, name);
  bind_arithmetic(number);
  number.def_property_readonly("value", &Dual::value)
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
          "__rpow__", [](const Dual& a, double b) { return exp(a * std::log(b)); }, py::is_operator())
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
}

}  // namespace thermopower::python
