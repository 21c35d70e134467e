// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>
#include <thermopower/plant/model.hpp>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "effect_members.hpp"
#include "traced_effect.hpp"

/// @file own_effect.hpp
/// Effects whose equation is a Python function. It is traced where it can be (traced_effect.hpp), and then computed without Python.
/// Elsewhere it is called with plain numbers in simulations, and with numbers that carry their derivatives in fits; the Python lock is
/// taken for each call.

namespace thermopower::python {

/// A Python object that may be let go by any thread.
using Shared = std::shared_ptr<py::object>;

/// Holds a Python object until the last of its users is gone.
inline Shared shared(py::object object) {
  return Shared(new py::object(std::move(object)), [](py::object* last) {
    const py::gil_scoped_acquire lock;
    delete last;
  });
}

/// Puts members into an object's attributes.
class Out {
public:
  explicit Out(const py::object& to) : to_(to) {}
  template <class Value>
  void given(const char* name, const Value& value) {
    to_.attr(name) = py::cast(value);
  }
  void given(const char* name, const plant::GivenExpression& value) {
    to_.attr(name) = py::cast(static_cast<const plant::Expression&>(value));
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
      if constexpr (std::is_same_v<Value, bool>) value = answer.cast<bool>();
      else value = number_of<Value>(answer);
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

/// Appends the values of members to a list.
template <class Scalar>
struct Taken {
  std::vector<Scalar>& list;  ///< where they go
  template <class Value>
  void given(const char*, const Value& value) const {
    list.push_back(Scalar(value));
  }
  template <class Value>
  void to_change(const char*, const Value& value) const {
    list.push_back(Scalar(value));
  }
};

/// Sets the members that may be changed from a list.
template <class Scalar>
struct Answered {
  const std::vector<Scalar>& list;  ///< what they become
  std::size_t& at;                  ///< place of the next one
  template <class Value>
  void given(const char*, const Value&) const {}
  template <class Value>
  void to_change(const char*, Value& value) const {
    value = list[at++];
  }
};

/// A function at its place.
struct Act {
  Shared function;                               ///< null: the effect does not act there
  std::shared_ptr<const TracedFunction> traced;  ///< what it computes; null: it is called each time
};

/// The functions of an effect, by the place where they act.
struct Acts {
  Act electrical, air, thermal, thermal_structure, bench_readings;  ///< on a bench
  Act drive, axis, friction, axis_structure, axis_readings;         ///< on an axis

  /// A name of a place, its function here, and its flag in a set of hooks.
  struct Place {
    const char* name;              ///< as `on` has it
    Act Acts::*act;                ///< its function
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
  static constexpr bool has_states =
      std::is_same_v<Terms, plant::AxisTerms<Scalar>> || std::is_same_v<Terms, plant::FrictionTerms<Scalar>>;
  template <class Terms>
  static constexpr bool has_friction = std::is_same_v<Terms, plant::FrictionTerms<Scalar>>;
  template <class Terms>
  static constexpr bool is_structure = std::is_same_v<Terms, plant::ThermalStructure<Scalar>> ||
                                       std::is_same_v<Terms, plant::AxisStructure<Scalar>>;

  template <class Terms>
  void run(const Scalar* p, Terms& terms, const Act& act) const {
    if constexpr (!is_structure<Terms>)
      if (act.traced) return compute(p, terms, *act.traced);
    if (!act.function) return;
    const py::gil_scoped_acquire lock;
    const py::object members = (*fresh_)(), values = (*fresh_)();
    visit(terms, Out(members));
    for (std::size_t i = 0; i < info_.parameters.size(); ++i)
      values.attr(info_.parameters[i].name.c_str()) = py::cast(p[i]);
    [[maybe_unused]] const auto added = std::make_shared<AddedFriction<Scalar>>();
    if constexpr (has_friction<Terms>) members.attr("add_friction") = py::cast(added);
    if constexpr (has_states<Terms>) give_states(terms.own, members);
    (*act.function)(values, members);
    visit(terms, Back(members, info_.id));
    if constexpr (has_friction<Terms>) added->to(terms);
    if constexpr (has_states<Terms>) take_states(members, terms.own);
  }

  /// The same without Python. Its numbers are those of EffectMembers::call().
  template <class Terms>
  void compute(const Scalar* p, Terms& terms, const TracedFunction& traced) const {
    thread_local std::vector<Scalar> given, answer;
    given.assign(p, p + info_.parameters.size());
    visit(terms, Taken<Scalar>{given});
    if constexpr (has_states<Terms>)
      for (std::size_t i = 0; i < info_.states.size(); ++i)
        for (const Scalar& one : {terms.own[i].value, terms.own[i].slope, terms.own[i].per_s})
          given.push_back(one);
    traced.compute(given, answer);
    std::size_t at = 0;
    visit(terms, Answered<Scalar>{answer, at});
    if constexpr (has_states<Terms>)
      for (std::size_t i = 0; i < info_.states.size(); ++i)
        terms.own[i].slope = answer[at++], terms.own[i].per_s = answer[at++];
    if constexpr (has_friction<Terms>)
      for (; at < answer.size(); at += 4)
        terms.add_friction(answer[at], answer[at + 1], answer[at + 2], answer[at + 3]);
    assert(at == answer.size());
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

/// A Python function that cannot be traced does not write its equation down.
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

/// Traces the functions of an effect where that can be done. What shapes a model is called once a simulation, and is not traced.
/// @return whether each of the others was
inline bool trace(const plant::EffectInfo& info, Acts& acts) {
  using Number = plant::Expression;
  bool all = true;
  const auto follow = [&](Act& act, auto&& terms, bool has_states = false, bool has_friction = false) {
    if (!act.function) return;
    act.traced = TracedFunction::of(*act.function, EffectMembers(info, terms, has_states, has_friction));
    all = all && act.traced != nullptr;
  };
  const Number none;
  const plant::GivenExpression given;
  follow(acts.electrical, plant::ElectricalTerms<Number>());
  follow(acts.air, plant::AirTerms<Number>());
  follow(acts.thermal, plant::ThermalTerms<Number>());
  follow(acts.bench_readings, plant::BenchReadings<Number>());
  follow(acts.drive, plant::DriveTerms<Number>());
  follow(acts.axis, plant::AxisTerms<Number>{given, none, none, none, none, none}, true);
  follow(acts.friction, plant::FrictionTerms<Number>(given, given, none, none, none, none), true, true);
  follow(acts.axis_readings, plant::AxisReadings<Number>());
  return all;
}

/// The functions of an effect by place, from a Python dict. @param hooks  where they act
inline Acts acts_of(const py::dict& given, plant::HookSet& hooks) {
  Acts acts;
  const auto by_place = given["acts"].cast<std::map<std::string, py::object>>();
  for (const Acts::Place& place : Acts::places()) {
    const auto found = by_place.find(place.name);
    if (found == by_place.end()) continue;
    (acts.*(place.act)).function = shared(found->second);
    hooks.*(place.is_set) = true;
  }
  return acts;
}

/// Whether the functions of an effect are computed without Python, but for what shapes the model.
inline bool is_traced(const py::dict& given) {
  plant::HookSet hooks;
  Acts acts = acts_of(given, hooks);
  return trace(info_of(given), acts);
}

/// Adds an effect whose equation is `act(p, terms)` to a catalogue, on one place or on several.
inline void add_effect(plant::Catalogue& catalogue, const py::dict& given) {
  plant::CatalogueEntry entry;
  entry.info = info_of(given);
  plant::HookSet& hooks = entry.hooks;
  Acts acts = acts_of(given, hooks);
  const bool is_written = trace(entry.info, acts);
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
  if (is_written) entry.traced = std::make_shared<Hooks<plant::Expression>>(entry.info, acts);
  else entry.traced = std::make_shared<Unwritten>();
  catalogue.add(std::move(entry));
}

}  // namespace thermopower::python
