// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/model.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// @file own_effect.hpp
/// Effects whose equation is a Python function: it is called with plain numbers in simulations, and with numbers that
/// carry their derivatives in fits. The Python lock is taken for each call.

namespace thermopower::python {

namespace py = pybind11;

/// A Python object that may be let go by any thread.
using Shared = std::shared_ptr<py::object>;

/// Holds a Python object until the last of its users is gone.
inline Shared shared(py::object object) {
  return Shared(new py::object(std::move(object)), [](py::object* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
}

/// The members of a hook's terms by their names: `given` are read, those `to_change` are read and written back.
template <class Scalar, class Visitor>
void visit(plant::ElectricalTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("rate_dps", terms.rate_dps),
      with.given("winding_C", terms.winding_C);
  with.given("charge_Ah", terms.charge_Ah);
  with.to_change("supply_V", terms.supply_V), with.to_change("source_ohm", terms.source_ohm);
  with.to_change("duty", terms.duty), with.to_change("tempco_per_K", terms.tempco_per_K);
  with.to_change("series_ohm", terms.series_ohm), with.to_change("counter_V", terms.counter_V);
}
template <class Scalar, class Visitor>
void visit(plant::AirTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("measured_ambient_C", terms.measured_ambient_C);
  with.to_change("ambient_C", terms.ambient_C);
}
template <class Scalar, class Visitor>
void visit(plant::ThermalTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("airspeed_mps", terms.airspeed_mps);
  with.given("neighbour_C", terms.neighbour_C), with.given("rate_dps", terms.rate_dps);
  with.given("measured_ambient_C", terms.measured_ambient_C), with.given("ambient_C", terms.ambient_C);
  with.given("winding_C", terms.winding_C), with.given("surface_C", terms.surface_C);
  with.given("current_A", terms.current_A), with.given("supply_V", terms.supply_V);
  with.given("v_rms_V", terms.v_rms_V);
  with.to_change("heat_W", terms.heat_W), with.to_change("conductance_factor", terms.conductance_factor);
  with.to_change("extra_loss_W", terms.extra_loss_W);
}
template <class Scalar, class Visitor>
void visit(plant::BenchReadings<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("measured_ambient_C", terms.measured_ambient_C);
  with.to_change("current_A", terms.current_A), with.to_change("motor_C", terms.motor_C);
}
template <class Scalar, class Visitor>
void visit(plant::DriveTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("motor_C", terms.motor_C);
  with.to_change("drive_A", terms.drive_A);
  with.to_change("torque_constant_Nm_per_A", terms.torque_constant_Nm_per_A);
}
template <class Scalar, class Visitor>
void visit(plant::AxisTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("angle_rad", terms.angle_rad);
  with.given("rate_rad_per_s", terms.rate_rad_per_s), with.given("drive_Nm", terms.drive_Nm);
  with.to_change("load_Nm", terms.load_Nm), with.to_change("delivered_Nm", terms.delivered_Nm);
}
template <class Scalar, class Visitor>
void visit(plant::FrictionTerms<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s), with.given("motor_C", terms.motor_C),
      with.given("angle_rad", terms.angle_rad);
  with.given("rate_rad_per_s", terms.rate_rad_per_s), with.given("drive_Nm", terms.drive_Nm);
  with.given("load_Nm", terms.load_Nm);
  with.to_change("factor", terms.factor), with.to_change("torque_Nm", terms.torque_Nm);
}
template <class Scalar, class Visitor>
void visit(plant::AxisReadings<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s);
  with.to_change("angle_deg", terms.angle_deg), with.to_change("rate_dps", terms.rate_dps);
}

/// Puts members into an object's attributes.
class Out {
public:
  explicit Out(const py::object& to) : to_(to) {}
  template <class Value>
  void given(const char* name, const Value& value) {
    to_.attr(name) = py::cast(value);
  }
  template <class Value>
  void to_change(const char* name, const Value& value) {
    given(name, value);
  }

private:
  const py::object& to_;
};

/// Reads back what may be changed.
class Back {
public:
  Back(const py::object& from, const std::string& id) : from_(from), id_(id) {}
  template <class Value>
  void given(const char*, const Value&) {}
  template <class Value>
  void to_change(const char* name, Value& value) {
    const py::object answer = from_.attr(name);
    try {
      value = answer.cast<Value>();
    } catch (const py::cast_error&) {
      throw plant::InvalidInput("effect '" + id_ + "' left " + std::string(py::str(answer.get_type())) +
                                " in " + name + "; expected a number");
    }
  }

private:
  const py::object& from_;
  const std::string& id_;
};

/// The hooks of an effect for plain numbers, or for those with derivatives: calls the function where it acts.
template <class Scalar>
class Hooks : public plant::detail::Hooks<Scalar> {
public:
  /// Called with the Python lock.
  Hooks(plant::EffectInfo info, plant::HookSet where, Shared act)
      : info_(std::move(info)),
        where_(where),
        act_(std::move(act)),
        fresh_(shared(py::module_::import("types").attr("SimpleNamespace"))) {}
  void call(const Scalar* p, plant::ElectricalTerms<Scalar>& terms) const final {
    run(p, terms, where_.electrical);
  }
  void call(const Scalar* p, plant::AirTerms<Scalar>& terms) const final { run(p, terms, where_.air); }
  void call(const Scalar* p, plant::ThermalTerms<Scalar>& terms) const final {
    run(p, terms, where_.thermal);
  }
  void call(const Scalar* p, plant::BenchReadings<Scalar>& terms) const final {
    run(p, terms, where_.bench_readings);
  }
  void call(const Scalar* p, plant::DriveTerms<Scalar>& terms) const final { run(p, terms, where_.drive); }
  void call(const Scalar* p, plant::AxisTerms<Scalar>& terms) const final { run(p, terms, where_.axis); }
  void call(const Scalar* p, plant::FrictionTerms<Scalar>& terms) const final {
    run(p, terms, where_.friction);
  }
  void call(const Scalar* p, plant::AxisReadings<Scalar>& terms) const final {
    run(p, terms, where_.axis_readings);
  }

private:
  template <class Terms>
  void run(const Scalar* p, Terms& terms, bool acts) const {
    if (!acts) return;
    const py::gil_scoped_acquire lock;
    const py::object members = (*fresh_)(), values = (*fresh_)();
    visit(terms, Out(members));
    for (std::size_t i = 0; i < info_.parameters.size(); ++i)
      values.attr(info_.parameters[i].name.c_str()) = py::cast(p[i]);
    (*act_)(values, members);
    visit(terms, Back(members, info_.id));
  }

  plant::EffectInfo info_;
  plant::HookSet where_;
  Shared act_;
  Shared fresh_;  // an object without attributes
};

/// A Python function does not write its equation down.
class Unwritten : public plant::detail::Hooks<plant::Expression> {
public:
  using Scalar = plant::Expression;
  void call(const Scalar*, plant::ElectricalTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AirTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::ThermalTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::BenchReadings<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::DriveTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AxisTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::FrictionTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AxisReadings<Scalar>&) const final { refuse(); }

private:
  [[noreturn]] static void refuse() { throw plant::NotTraceable("it is written in Python"); }
};

/// An effect's parameter from a Python dict.
inline plant::Parameter parameter_of(const py::dict& given) {
  plant::Parameter one;
  one.name = given["name"].cast<std::string>();
  one.unit = given["unit"].cast<std::string>();
  one.lower = given["lower"].cast<double>();
  one.upper = given["upper"].cast<double>();
  one.starts = given["starts"].cast<std::vector<double>>();
  one.logarithmic = given["logarithmic"].cast<bool>();
  return one;
}

/// What an effect is, from a Python dict; the equation apart.
inline plant::EffectInfo info_of(const py::dict& given) {
  plant::EffectInfo info;
  info.id = given["id"].cast<std::string>();
  info.submodel = plant::SubmodelName(given["submodel"].cast<std::string>());
  info.equation = given["equation"].cast<std::string>();
  info.prose = given["prose"].cast<std::string>();
  info.experiment = given["experiment"].cast<std::string>();
  for (const py::handle one : given["parameters"])
    info.parameters.push_back(parameter_of(py::cast<py::dict>(one)));
  return info;
}

/// Adds an effect whose equation is `act(p, terms)` to a catalogue.
inline void add_effect(plant::Catalogue& catalogue, const py::dict& given) {
  plant::CatalogueEntry entry;
  entry.info = info_of(given);
  const auto on = given["on"].cast<std::string>();
  plant::HookSet& hooks = entry.hooks;
  const std::pair<const char*, bool plant::HookSet::*> places[] = {
      {"electrical", &plant::HookSet::electrical}, {"air", &plant::HookSet::air},
      {"thermal", &plant::HookSet::thermal},       {"bench_readings", &plant::HookSet::bench_readings},
      {"drive", &plant::HookSet::drive},           {"axis", &plant::HookSet::axis},
      {"friction", &plant::HookSet::friction},     {"axis_readings", &plant::HookSet::axis_readings}};
  for (const auto& [name, place] : places) hooks.*place = on == name;
  if (hooks.any_axis()) entry.info.needs = {plant::Need::axis_model};
  else if (hooks.electrical) entry.info.needs = {plant::Need::current_model};
  else if (!hooks.bench_readings) entry.info.needs = {plant::Need::thermal_model};
  const Shared act = shared(given["act"]);
  entry.plain = std::make_shared<Hooks<double>>(entry.info, hooks, act);
  entry.dual = std::make_shared<Hooks<plant::Dual>>(entry.info, hooks, act);
  entry.traced = std::make_shared<Unwritten>();
  catalogue.add(std::move(entry));
}

/// a to a plain power: whole ones by products, so that a may be negative.
inline plant::Dual power_of(const plant::Dual& a, double b) {
  constexpr double most = 8.0;
  if (b != std::floor(b) || std::abs(b) > most) return exp(log(a) * b);
  plant::Dual product(1.0);
  for (double i = 0.0; i < std::abs(b); ++i) product *= a;
  return b < 0.0 ? 1.0 / product : product;
}

/// Numbers that carry their derivatives, as Python sees them. NumPy's functions find theirs by name.
inline void bind_dual(py::module_& module) {
  using plant::Dual;
  py::class_<Dual>(module, "Dual")
      .def(py::init<double>())
      .def_property_readonly("value", &Dual::value)
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
      .def("sqrt", [](const Dual& a) { return sqrt(a); });
  py::implicitly_convertible<double, Dual>();
  py::implicitly_convertible<int, Dual>();
}

}  // namespace thermopower::python
