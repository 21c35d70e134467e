// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/invalid_input.hpp>
#include <thermopower/plant/terms.hpp>

#include <pybind11/pybind11.h>

#include <array>
#include <cassert>
#include <cstddef>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// @file effect_members.hpp
/// What a function in Python finds at the place where it acts, by name.

namespace thermopower::python {

namespace py = pybind11;

/// Dry friction that a function adds, which takes effect when it has ended: `terms.add_friction(...)` of it.
template <class Scalar>
class AddedFriction {
public:
  /// As plant::FrictionTerms has it.
  void add(const Scalar& forward, const Scalar& backward, const Scalar& transition, const Scalar& tail) {
    added_.push_back({forward, backward, transition, tail});
  }
  /// What was added, in order: forward, backward, transition, tail.
  const std::vector<std::array<Scalar, 4>>& added() const { return added_; }

private:
  std::vector<std::array<Scalar, 4>> added_;
};

/// Binds it as something that can be called.
template <class Scalar>
void bind_added_friction(py::module_& module, const char* name) {
  using Added = AddedFriction<Scalar>;
  py::class_<Added, std::shared_ptr<Added>>(module, name)
      .def("__call__", &Added::add, py::arg("forward_Nm"), py::arg("backward_Nm"),
           py::arg("transition_rad_per_s"), py::arg("tail") = Scalar(0.0));
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
void visit(plant::ThermalStructure<Scalar>& shape, Visitor&& with) {
  with.to_change("two_nodes", shape.two_nodes), with.to_change("winding_share", shape.winding_share);
  with.to_change("coupling_W_per_K", shape.coupling_W_per_K);
  with.to_change("lagged", shape.lagged), with.to_change("thermometer_lag_s", shape.thermometer_lag_s);
  with.to_change("soaks", shape.soaks), with.to_change("soaking_share", shape.soaking_share);
  with.to_change("soaking_W_per_K", shape.soaking_W_per_K);
  with.to_change("soaking_loss_W_per_K", shape.soaking_loss_W_per_K);
  with.to_change("soaking_added", shape.soaking_added);
  with.to_change("soaking_J_per_K", shape.soaking_J_per_K);
  with.to_change("enclosed", shape.enclosed), with.to_change("enclosed_share", shape.enclosed_share);
  with.to_change("enclosed_W_per_K", shape.enclosed_W_per_K);
  with.to_change("heating_exchanged", shape.heating_exchanged);
}
template <class Scalar, class Visitor>
void visit(plant::AxisStructure<Scalar>& shape, Visitor&& with) {
  with.to_change("delayed", shape.delayed), with.to_change("delay_s", shape.delay_s);
  with.to_change("target_delayed", shape.target_delayed),
      with.to_change("target_delay_s", shape.target_delay_s);
  with.to_change("compliant", shape.compliant), with.to_change("far_share", shape.far_share);
  with.to_change("spring_rad_per_s", shape.spring_rad_per_s);
  with.to_change("spring_damping", shape.spring_damping);
  with.to_change("gapped", shape.gapped), with.to_change("gap_rad", shape.gap_rad);
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
  with.given("load_Nm", terms.load_Nm), with.given("transmitted_Nm", terms.transmitted_Nm());
  with.given("forward_Nm", terms.forward_Nm), with.given("backward_Nm", terms.backward_Nm);
  with.to_change("factor", terms.factor), with.to_change("torque_Nm", terms.torque_Nm);
}
template <class Scalar, class Visitor>
void visit(plant::AxisReadings<Scalar>& terms, Visitor&& with) {
  with.given("t_s", terms.t_s);
  with.to_change("angle_deg", terms.angle_deg), with.to_change("rate_dps", terms.rate_dps);
}

/// Whether an effect may have states of its own at a place.
template <class Terms>
inline constexpr bool has_states = false;
template <class Scalar>
inline constexpr bool has_states<plant::AxisTerms<Scalar>> = true;
template <class Scalar>
inline constexpr bool has_states<plant::FrictionTerms<Scalar>> = true;

/// Whether it may add dry friction there.
template <class Terms>
inline constexpr bool has_friction = false;
template <class Scalar>
inline constexpr bool has_friction<plant::FrictionTerms<Scalar>> = true;

/// A Python object that may be let go by any thread.
using Shared = std::shared_ptr<py::object>;

/// Holds a Python object until the last of its users is gone.
inline Shared shared(py::object object) {
  return Shared(new py::object(std::move(object)), [](py::object* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
}

/// A value as Python sees it: what was recorded is a plain number, or a traced one.
template <class Value>
py::object object_of(const Value& value) {
  if constexpr (std::is_same_v<Value, plant::GivenExpression>)
    return py::cast(static_cast<const plant::Expression&>(value));
  else return py::cast(value);
}

/// What a function in Python left.
template <class Number>
struct Left {
  std::vector<std::pair<const char*, py::object>> changed;  ///< members, then slope and per_s of each state
  std::vector<std::array<Number, 4>> friction;  ///< that it added: forward, backward, transition, tail
};

/// The names at one place: parameters of the effect, members of the terms, states, and whether it may add dry friction.
class EffectMembers {
public:
  /// Called with the Python lock. @param terms  of that place; their values do not matter
  template <class Terms>
  EffectMembers(const plant::EffectInfo& info, Terms& terms)
      : id_(info.id),
        adds_friction_(has_friction<Terms>),
        fresh_(shared(py::module_::import("types").attr("SimpleNamespace"))) {
    for (const plant::Parameter& one : info.parameters) parameters_.push_back(one.name);
    visit(terms, Names{members_});
    if (has_states<Terms>)
      for (const auto& one : info.states) states_.push_back(one.name);
  }

  /// How many values call() takes: parameters, then members, then value, slope and per_s of each state.
  std::size_t inputs() const { return parameters_.size() + members_.size() + 3 * states_.size(); }

  /// Calls a function with all inputs. Called with the Python lock.
  template <class Number>
  Left<Number> call(const py::object& act, const std::vector<py::object>& given) const {
    assert(given.size() == inputs());
    const py::object &fresh = *fresh_, values = fresh(), terms = fresh();
    std::size_t at = 0;
    for (const std::string& name : parameters_) values.attr(name.c_str()) = given[at++];
    for (const auto& [name, changes] : members_) terms.attr(name) = given[at++];
    if (!states_.empty()) terms.attr("own") = fresh();
    for (const std::string& name : states_) {
      const py::object one = fresh();
      for (const char* part : {"value", "slope", "per_s"}) one.attr(part) = given[at++];
      terms.attr("own").attr(name.c_str()) = one;
    }
    const auto added = std::make_shared<AddedFriction<Number>>();
    if (adds_friction_) terms.attr("add_friction") = py::cast(added);
    act(values, terms);
    Left<Number> left;
    for (const auto& [name, changes] : members_)
      if (changes) left.changed.emplace_back(name, terms.attr(name));
    for (const std::string& name : states_)
      for (const char* part : {"slope", "per_s"})
        left.changed.emplace_back(part, terms.attr("own").attr(name.c_str()).attr(part));
    left.friction = added->added();
    return left;
  }

  /// A value that a function left. @throws plant::InvalidInput where it is of another kind
  template <class Value>
  Value left_as(const std::pair<const char*, py::object>& one) const {
    const auto& [name, object] = one;
    try {
      if constexpr (!std::is_same_v<Value, double> && !std::is_same_v<Value, bool>) {
        if (py::isinstance<Value>(object)) return object.template cast<Value>();
        return Value(object.template cast<double>());
      } else {
        return object.template cast<Value>();
      }
    } catch (const py::cast_error&) {
      throw plant::InvalidInput("effect '" + id_ + "' left " + std::string(py::str(object.get_type())) +
                                " in " + name + "; expected " +
                                (std::is_same_v<Value, bool> ? "True or False" : "a number"));
    }
  }

  /// Calls a function with numbers for all inputs.
  /// @return all that it left, four numbers for each friction
  template <class Number>
  std::vector<Number> answer(const py::object& act, const std::vector<Number>& given) const {
    std::vector<py::object> objects;
    for (const Number& one : given) objects.push_back(py::cast(one));
    const Left<Number> left = call<Number>(act, objects);
    std::vector<Number> numbers;
    for (const auto& one : left.changed) numbers.push_back(left_as<Number>(one));
    for (const std::array<Number, 4>& one : left.friction)
      numbers.insert(numbers.end(), one.begin(), one.end());
    return numbers;
  }

private:
  /// Members by name, and whether they may be changed.
  using Members = std::vector<std::pair<const char*, bool>>;

  struct Names {
    Members& names;
    template <class Value>
    void given(const char* name, const Value&) const {
      names.emplace_back(name, false);
    }
    template <class Value>
    void to_change(const char* name, const Value&) const {
      names.emplace_back(name, true);
    }
  };

  std::string id_;
  std::vector<std::string> parameters_, states_;
  Members members_;
  bool adds_friction_ = false;
  Shared fresh_;  // an object without attributes
};

}  // namespace thermopower::python
