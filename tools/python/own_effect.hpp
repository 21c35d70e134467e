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

/// Hands on all members. @param Put  gets a value
template <class Put>
struct EachInput {
  Put& put;  ///< gets them in order
  template <class Value>
  void given(const char*, const Value& value) const {
    put(value);
  }
  template <class Value>
  void to_change(const char*, const Value& value) const {
    put(value);
  }
};

/// Hands on the members that may be changed.
template <class Set>
struct EachChange {
  Set& set;  ///< gets them in order
  template <class Value>
  void given(const char*, const Value&) const {}
  template <class Value>
  void to_change(const char*, Value& value) const {
    set(value);
  }
};

/// A function at its place.
struct Act {
  Shared function;                               ///< null: the effect does not act there
  std::shared_ptr<const EffectMembers> members;  ///< what it finds there
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
  Hooks(plant::EffectInfo info, Acts acts) : info_(std::move(info)), acts_(std::move(acts)) {}
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
  static constexpr bool is_structure = std::is_same_v<Terms, plant::ThermalStructure<Scalar>> ||
                                       std::is_same_v<Terms, plant::AxisStructure<Scalar>>;

  /// Hands on what a function gets, in the order of EffectMembers.
  template <class Terms, class Put>
  void for_each_input(const Scalar* p, Terms& terms, Put&& put) const {
    for (std::size_t i = 0; i < info_.parameters.size(); ++i) put(p[i]);
    visit(terms, EachInput<Put>{put});
    if constexpr (has_states<Terms>)
      for (std::size_t i = 0; i < info_.states.size(); ++i)
        put(terms.own[i].value), put(terms.own[i].slope), put(terms.own[i].per_s);
  }

  /// Hands on what a function may change, in that order.
  template <class Terms, class Set>
  void for_each_change(Terms& terms, Set&& set) const {
    visit(terms, EachChange<Set>{set});
    if constexpr (has_states<Terms>)
      for (std::size_t i = 0; i < info_.states.size(); ++i) set(terms.own[i].slope), set(terms.own[i].per_s);
  }

  template <class Terms>
  void run(const Scalar* p, Terms& terms, const Act& act) const {
    if (!act.function) return;
    if constexpr (!is_structure<Terms>)
      if (act.traced) return compute(p, terms, *act.traced);
    const py::gil_scoped_acquire lock;
    std::vector<py::object> given;
    for_each_input(p, terms, [&](const auto& one) { given.push_back(object_of(one)); });
    const Left<Scalar> left = act.members->template call<Scalar>(*act.function, given);
    std::size_t at = 0;
    for_each_change(terms, [&](auto& one) {
      one = act.members->template left_as<std::decay_t<decltype(one)>>(left.changed[at++]);
    });
    if constexpr (has_friction<Terms>)
      for (const std::array<Scalar, 4>& one : left.friction)
        terms.add_friction(one[0], one[1], one[2], one[3]);
  }

  /// The same without Python.
  template <class Terms>
  void compute(const Scalar* p, Terms& terms, const TracedFunction& traced) const {
    thread_local std::vector<Scalar> given, answer;
    given.clear();
    for_each_input(p, terms, [](const auto& one) { given.push_back(Scalar(one)); });
    traced.compute(given, answer);
    std::size_t at = 0;
    for_each_change(terms, [&](Scalar& one) { one = answer[at++]; });
    if constexpr (has_friction<Terms>)
      for (; at < answer.size(); at += 4)
        terms.add_friction(answer[at], answer[at + 1], answer[at + 2], answer[at + 3]);
    assert(at == answer.size());
  }

  plant::EffectInfo info_;
  Acts acts_;
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

/// Says what the functions of an effect find, and traces them where that can be done. What shapes a model is called once a simulation,
/// and is not traced.
/// @return whether each of the others was
inline bool trace(const plant::EffectInfo& info, Acts& acts) {
  using Number = plant::Expression;
  bool all = true;
  const auto find = [&](Act& act, auto&& terms) {
    if (act.function) act.members = std::make_shared<const EffectMembers>(info, terms);
    return act.function != nullptr;
  };
  const auto follow = [&](Act& act, auto&& terms) {
    if (!find(act, terms)) return;
    act.traced = TracedFunction::of(*act.function, *act.members);
    all = all && act.traced != nullptr;
  };
  const Number none;
  const plant::GivenExpression given;
  find(acts.thermal_structure, plant::ThermalStructure<Number>());
  find(acts.axis_structure, plant::AxisStructure<Number>());
  follow(acts.electrical, plant::ElectricalTerms<Number>());
  follow(acts.air, plant::AirTerms<Number>());
  follow(acts.thermal, plant::ThermalTerms<Number>());
  follow(acts.bench_readings, plant::BenchReadings<Number>());
  follow(acts.drive, plant::DriveTerms<Number>());
  follow(acts.axis, plant::AxisTerms<Number>{given, none, none, none, none, none});
  follow(acts.friction, plant::FrictionTerms<Number>(given, given, none, none, none, none));
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
