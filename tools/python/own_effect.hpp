// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/model.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
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

/// Dry friction that a function adds, which takes effect when it has ended: `terms.add_friction(...)` of it.
template <class Scalar>
class AddedFriction {
public:
  /// As plant::FrictionTerms has it.
  void add(const Scalar& forward, const Scalar& backward, const Scalar& transition, const Scalar& tail) {
    added_.push_back({forward, backward, transition, tail});
  }
  /// Hands on what was added. @param terms  receive it
  void to(plant::FrictionTerms<Scalar>& terms) const {
    for (const auto& [forward, backward, transition, tail] : added_)
      terms.add_friction(forward, backward, transition, tail);
  }

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
  Back(py::object from, const std::string& id) : from_(std::move(from)), id_(id) {}
  template <class Value>
  void given(const char*, const Value&) const {}
  template <class Value>
  void to_change(const char* name, Value& value) const {
    const py::object answer = from_.attr(name);
    try {
      value = answer.cast<Value>();
    } catch (const py::cast_error&) {
      throw plant::InvalidInput("effect '" + id_ + "' left " + std::string(py::str(answer.get_type())) +
                                " in " + name + "; expected " +
                                (std::is_same_v<Value, bool> ? "True or False" : "a number"));
    }
  }

private:
  py::object from_;
  const std::string& id_;
};

/// The functions of an effect, by the place where they act; null where it does not.
struct Acts {
  Shared electrical, air, thermal, thermal_structure, bench_readings;  ///< on a bench
  Shared drive, axis, friction, axis_structure, axis_readings;         ///< on an axis

  /// A name of a place, its function here, and its flag in a set of hooks.
  struct Place {
    const char* name;              ///< as `on` has it
    Shared Acts::*act;             ///< its function
    bool plant::HookSet::*is_set;  ///< that it has one
  };

  /// All places.
  static const std::array<Place, 10>& places() {
    using plant::HookSet;
    static const std::array<Place, 10> all{
        {{"electrical", &Acts::electrical, &HookSet::electrical},
         {"air", &Acts::air, &HookSet::air},
         {"thermal", &Acts::thermal, &HookSet::thermal},
         {"thermal_structure", &Acts::thermal_structure, &HookSet::thermal_structure},
         {"bench_readings", &Acts::bench_readings, &HookSet::bench_readings},
         {"drive", &Acts::drive, &HookSet::drive},
         {"axis", &Acts::axis, &HookSet::axis},
         {"friction", &Acts::friction, &HookSet::friction},
         {"axis_structure", &Acts::axis_structure, &HookSet::axis_structure},
         {"axis_readings", &Acts::axis_readings, &HookSet::axis_readings}}};
    return all;
  }
};

/// The hooks of an effect for plain numbers, or for those with derivatives: calls the function where it acts.
template <class Scalar>
class Hooks : public plant::detail::Hooks<Scalar> {
public:
  /// Called with the Python lock.
  Hooks(plant::EffectInfo info, Acts acts)
      : info_(std::move(info)),
        acts_(std::move(acts)),
        fresh_(shared(py::module_::import("types").attr("SimpleNamespace"))) {}
  void call(const Scalar* p, plant::ElectricalTerms<Scalar>& terms) const final {
    run(p, terms, acts_.electrical);
  }
  void call(const Scalar* p, plant::AirTerms<Scalar>& terms) const final { run(p, terms, acts_.air); }
  void call(const Scalar* p, plant::ThermalTerms<Scalar>& terms) const final { run(p, terms, acts_.thermal); }
  void call(const Scalar* p, plant::ThermalStructure<Scalar>& shape) const final {
    run(p, shape, acts_.thermal_structure);
  }
  void call(const Scalar* p, plant::BenchReadings<Scalar>& terms) const final {
    run(p, terms, acts_.bench_readings);
  }
  void call(const Scalar* p, plant::DriveTerms<Scalar>& terms) const final { run(p, terms, acts_.drive); }
  void call(const Scalar* p, plant::AxisTerms<Scalar>& terms) const final { run(p, terms, acts_.axis); }
  void call(const Scalar* p, plant::FrictionTerms<Scalar>& terms) const final {
    run(p, terms, acts_.friction);
  }
  void call(const Scalar* p, plant::AxisStructure<Scalar>& shape) const final {
    run(p, shape, acts_.axis_structure);
  }
  void call(const Scalar* p, plant::AxisReadings<Scalar>& terms) const final {
    run(p, terms, acts_.axis_readings);
  }

private:
  template <class Terms>
  void run(const Scalar* p, Terms& terms, const Shared& act) const {
    if (!act) return;
    constexpr bool has_states = std::is_same_v<Terms, plant::AxisTerms<Scalar>> ||
                                std::is_same_v<Terms, plant::FrictionTerms<Scalar>>;
    constexpr bool has_friction = std::is_same_v<Terms, plant::FrictionTerms<Scalar>>;
    const py::gil_scoped_acquire lock;
    const py::object members = (*fresh_)(), values = (*fresh_)();
    visit(terms, Out(members));
    for (std::size_t i = 0; i < info_.parameters.size(); ++i)
      values.attr(info_.parameters[i].name.c_str()) = py::cast(p[i]);
    [[maybe_unused]] const auto added = std::make_shared<AddedFriction<Scalar>>();
    if constexpr (has_friction) members.attr("add_friction") = py::cast(added);
    if constexpr (has_states) give_states(terms.own, members);
    (*act)(values, members);
    visit(terms, Back(members, info_.id));
    if constexpr (has_friction) added->to(terms);
    if constexpr (has_states) take_states(members, terms.own);
  }

  // `terms.own` has them by name, each with its value and what moves it.
  void give_states(const plant::OwnState<Scalar>* states, const py::object& members) const {
    if (info_.states.empty()) return;
    const py::object own = (*fresh_)();
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const py::object one = (*fresh_)();
      one.attr("value") = py::cast(states[i].value);
      one.attr("slope") = py::cast(states[i].slope);
      one.attr("per_s") = py::cast(states[i].per_s);
      own.attr(info_.states[i].name.c_str()) = one;
    }
    members.attr("own") = own;
  }
  void take_states(const py::object& members, plant::OwnState<Scalar>* states) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const Back back(members.attr("own").attr(info_.states[i].name.c_str()), info_.id);
      back.to_change("slope", states[i].slope);
      back.to_change("per_s", states[i].per_s);
    }
  }

  plant::EffectInfo info_;
  Acts acts_;
  Shared fresh_;  // an object without attributes
};

/// A Python function does not write its equation down.
class Unwritten : public plant::detail::Hooks<plant::Expression> {
public:
  using Scalar = plant::Expression;
  void call(const Scalar*, plant::ElectricalTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AirTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::ThermalTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::ThermalStructure<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::BenchReadings<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::DriveTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AxisTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::FrictionTerms<Scalar>&) const final { refuse(); }
  void call(const Scalar*, plant::AxisStructure<Scalar>&) const final { refuse(); }
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
  one.standard = given["standard"].cast<std::optional<double>>();
  one.exceeds = given["exceeds"].cast<std::string>();
  one.degenerate_at_bounds = given["degenerate_at_bounds"].cast<bool>();
  one.periods_in_travel = given["periods_in_travel"].cast<double>();
  const auto shares_of = given["starts_as_shares_of"].cast<std::string>();
  const std::pair<const char*, plant::Input> inputs[] = {{"", plant::Input::none},
                                                         {"drive_A", plant::Input::drive_A},
                                                         {"power_param", plant::Input::power_param},
                                                         {"supply_V", plant::Input::supply_V}};
  bool known = false;
  for (const auto& [name, input] : inputs)
    if (shares_of == name) one.starts_relative_to = input, known = true;
  if (!known)
    throw plant::InvalidInput("parameter '" + one.name + "': its starts are shares of '" + shares_of +
                              "', expected drive_A, power_param or supply_V");
  return one;
}

/// What must be there for an effect, by its name in lists of effects.
inline plant::Need need_of(const std::string& name, const std::string& effect) {
  std::string known;
  for (int i = 0; i <= static_cast<int>(plant::Need::closed_loop); ++i) {
    const auto need = static_cast<plant::Need>(i);
    if (name == to_string(need)) return need;
    known += std::string(i == 0 ? "" : ", ") + "'" + to_string(need) + "'";
  }
  throw plant::InvalidInput("effect '" + effect + "' needs '" + name + "', expected one of " + known);
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
  for (const auto& [name, unit] : given["states"].cast<std::vector<std::pair<std::string, std::string>>>())
    info.states.push_back({name, unit});
  for (const auto& need : given["needs"].cast<std::vector<std::string>>())
    info.needs.push_back(need_of(need, info.id));
  info.costly = given["costly"].cast<bool>();
  info.strikes = given["strikes"].cast<bool>();
  return info;
}

/// Adds an effect whose equation is `act(p, terms)` to a catalogue, on one place or on several.
inline void add_effect(plant::Catalogue& catalogue, const py::dict& given) {
  plant::CatalogueEntry entry;
  entry.info = info_of(given);
  plant::HookSet& hooks = entry.hooks;
  Acts acts;
  const auto by_place = given["acts"].cast<std::map<std::string, py::object>>();
  for (const Acts::Place& place : Acts::places()) {
    const auto found = by_place.find(place.name);
    if (found == by_place.end()) continue;
    acts.*(place.act) = shared(found->second);
    hooks.*(place.is_set) = true;
  }
  const auto need = [&](plant::Need one) {
    std::vector<plant::Need>& needs = entry.info.needs;
    if (std::find(needs.begin(), needs.end(), one) == needs.end()) needs.push_back(one);
  };
  if (hooks.any_axis()) need(plant::Need::axis_model);
  if (hooks.electrical) need(plant::Need::current_model);
  else if (hooks.any_bench() && !hooks.bench_readings) need(plant::Need::thermal_model);
  entry.plain = std::make_shared<Hooks<double>>(entry.info, acts);
  entry.dual = std::make_shared<Hooks<plant::Dual>>(entry.info, acts);
  entry.wide = std::make_shared<Hooks<plant::WideDual>>(entry.info, acts);
  entry.traced = std::make_shared<Unwritten>();
  catalogue.add(std::move(entry));
}

}  // namespace thermopower::python
