// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/invalid_input.hpp>
#include <thermopower/plant/terms.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace thermopower::plant {

/// Which hooks an effect has; the engine calls no others.
///
/// @snippet plant_examples.cpp catalogue
/// How to: @ref diagnose_a_gap.
struct HookSet {
  bool electrical = false;         ///< overload of `act` for ElectricalTerms
  bool air = false;                ///< for AirTerms
  bool thermal = false;            ///< for ThermalTerms
  bool thermal_structure = false;  ///< for ThermalStructure
  bool bench_readings = false;     ///< for BenchReadings
  bool drive = false;              ///< for DriveTerms
  bool axis = false;               ///< for AxisTerms
  bool friction = false;           ///< for FrictionTerms
  bool axis_structure = false;     ///< for AxisStructure
  bool axis_readings = false;      ///< for AxisReadings

  /// Whether it can show in a recording of a motor on a bench.
  bool any_bench() const { return electrical || air || thermal || thermal_structure || bench_readings; }
  /// Whether it can show in a recording of a moving axis.
  bool any_axis() const { return drive || axis || friction || axis_structure || axis_readings; }
};

namespace detail {

/// The hooks for one scalar, type-erased; `p` points to the effect's parameters.
template <class Scalar>
class Hooks {
public:
  virtual ~Hooks() = default;
  virtual void call(const Scalar*, ElectricalTerms<Scalar>&) const {}
  virtual void call(const Scalar*, AirTerms<Scalar>&) const {}
  virtual void call(const Scalar*, ThermalTerms<Scalar>&) const {}
  virtual void call(const Scalar*, ThermalStructure<Scalar>&) const {}
  virtual void call(const Scalar*, BenchReadings<Scalar>&) const {}
  virtual void call(const Scalar*, DriveTerms<Scalar>&) const {}
  virtual void call(const Scalar*, AxisTerms<Scalar>&) const {}
  virtual void call(const Scalar*, FrictionTerms<Scalar>&) const {}
  virtual void call(const Scalar*, AxisStructure<Scalar>&) const {}
  virtual void call(const Scalar*, AxisReadings<Scalar>&) const {}
};

template <class Effect, class Terms, class = void>
struct HasHook : std::false_type {};
template <class Effect, template <class> class Terms, class Scalar>
struct HasHook<
    Effect, Terms<Scalar>,
    std::void_t<decltype(Effect::act(std::declval<const Scalar*>(), std::declval<Terms<Scalar>&>()))>>
    : std::true_type {};

template <class Effect, class = void>
struct HasInfo : std::false_type {};
template <class Effect>
struct HasInfo<Effect, std::enable_if_t<std::is_same_v<decltype(Effect::info()), EffectInfo>>>
    : std::true_type {};

/// Whether an effect has a hook for any of the terms.
template <class Effect>
inline constexpr bool has_any_hook =
    HasHook<Effect, ElectricalTerms<double>>::value || HasHook<Effect, AirTerms<double>>::value ||
    HasHook<Effect, ThermalTerms<double>>::value || HasHook<Effect, ThermalStructure<double>>::value ||
    HasHook<Effect, BenchReadings<double>>::value || HasHook<Effect, DriveTerms<double>>::value ||
    HasHook<Effect, AxisTerms<double>>::value || HasHook<Effect, FrictionTerms<double>>::value ||
    HasHook<Effect, AxisStructure<double>>::value || HasHook<Effect, AxisReadings<double>>::value;

/// Forwards each type-erased hook to `Effect::act` where the effect has that overload.
template <class Effect, class Scalar>
class HooksOf : public Hooks<Scalar> {
public:
  void call(const Scalar* p, ElectricalTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AirTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, ThermalTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, ThermalStructure<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, BenchReadings<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, DriveTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, FrictionTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisStructure<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisReadings<Scalar>& terms) const final { forward(p, terms); }

private:
  template <class Terms>
  static void forward(const Scalar* p, Terms& terms) {
    if constexpr (HasHook<Effect, Terms>::value) Effect::act(p, terms);
  }
};

/// The hooks of an effect for one scalar: they have no state, one object serves every catalogue.
template <class Effect, class Scalar>
std::shared_ptr<const Hooks<Scalar>> hooks_of() {
  static const HooksOf<Effect, Scalar> hooks;
  const Hooks<Scalar>* const one = &hooks;
  return {std::shared_ptr<const void>(), one};  // owned by nobody
}

/// Which hooks an effect has.
template <class Effect>
HookSet hook_set_of() {
  HookSet hooks;
  hooks.electrical = HasHook<Effect, ElectricalTerms<double>>::value;
  hooks.air = HasHook<Effect, AirTerms<double>>::value;
  hooks.thermal = HasHook<Effect, ThermalTerms<double>>::value;
  hooks.thermal_structure = HasHook<Effect, ThermalStructure<double>>::value;
  hooks.bench_readings = HasHook<Effect, BenchReadings<double>>::value;
  hooks.drive = HasHook<Effect, DriveTerms<double>>::value;
  hooks.axis = HasHook<Effect, AxisTerms<double>>::value;
  hooks.friction = HasHook<Effect, FrictionTerms<double>>::value;
  hooks.axis_structure = HasHook<Effect, AxisStructure<double>>::value;
  hooks.axis_readings = HasHook<Effect, AxisReadings<double>>::value;
  return hooks;
}

}  // namespace detail

/// An effect of the catalogue: what it is, and its hooks for both scalars.
///
/// @snippet plant_examples.cpp catalogue
/// How to: @ref diagnose_a_gap.
struct CatalogueEntry {
  EffectInfo info;                                          ///< id, prose, parameters, needs
  HookSet hooks;                                            ///< where it acts
  std::shared_ptr<const detail::Hooks<double>> plain;       ///< its hooks for simulations
  std::shared_ptr<const detail::Hooks<Dual>> dual;          ///< and for fits, with derivatives
  std::shared_ptr<const detail::Hooks<Expression>> traced;  ///< and for writing its equation down

  /// The hooks for a scalar.
  template <class Scalar>
  const detail::Hooks<Scalar>& of() const {
    if constexpr (std::is_same_v<Scalar, double>) return *plain;
    else if constexpr (std::is_same_v<Scalar, Expression>) return *traced;
    else return *dual;
  }
};

/// The effects that a diagnosis knows.
///
/// An effect is a type with `static EffectInfo info()` and one or several static templates
/// `template <class Scalar> static void act(const Scalar* p, XTerms<Scalar>& terms)`, where XTerms is one of
/// terms.hpp and `p` its parameters in the order of `info().parameters`. It is simulated, fitted (derivatives
/// by automatic differentiation), compared and exported because it exists: `catalogue.add<MyEffect>()`.
///
/// @snippet plant_examples.cpp catalogue
/// How to: @ref diagnose_a_gap.
class Catalogue {
public:
  /// Adds an effect; a type that is none is a compile-time error in one sentence. @throws InvalidInput where its info is unusable or its id is taken.
  template <class Effect>
  Catalogue& add() {
    static_assert(detail::HasInfo<Effect>::value,
                  "thermopower: an effect needs 'static thermopower::plant::EffectInfo info()'");
    static_assert(
        detail::has_any_hook<Effect>,
        "thermopower: an effect needs a hook 'template <class Scalar> static void act(const Scalar* p, "
        "XTerms<Scalar>& terms)' where XTerms is one of plant/terms.hpp");
    if constexpr (detail::HasInfo<Effect>::value && detail::has_any_hook<Effect>)
      add({Effect::info(), detail::hook_set_of<Effect>(), detail::hooks_of<Effect, double>(),
           detail::hooks_of<Effect, Dual>(), detail::hooks_of<Effect, Expression>()});
    return *this;
  }

  /// Adds an effect whose hooks are objects, for equations that are no C++ types: all three kinds of them, for every term
  /// that the set of hooks names. @throws InvalidInput where its info is unusable, its id is taken, or hooks are missing
  Catalogue& add(CatalogueEntry entry) {
    check(entry.info, entry.hooks);
    if (!(entry.hooks.any_bench() || entry.hooks.any_axis()) || !entry.plain || !entry.dual || !entry.traced)
      throw InvalidInput("effect '" + entry.info.id +
                         "' has no hooks: expected one of each kind, and where they act");
    infos_.push_back(entry.info);
    entries_.push_back(std::move(entry));
    return *this;
  }

  /// Adds an effect whose equation a plant of one's own holds itself.
  /// @throws InvalidInput where its info is unusable or its id is taken
  Catalogue& declare(const EffectInfo& info) {
    check(info, HookSet());
    CatalogueEntry entry;
    entry.info = info;
    infos_.push_back(entry.info);
    entries_.push_back(std::move(entry));
    return *this;
  }

  /// What there is, in the order added.
  const std::vector<EffectInfo>& list() const { return infos_; }

  /// The effects with their hooks, in the order added.
  const std::vector<CatalogueEntry>& entries() const { return entries_; }

  /// The effect of that id, or nullptr.
  const CatalogueEntry* find(std::string_view id) const {
    for (const CatalogueEntry& entry : entries_)
      if (entry.info.id == id) return &entry;
    return nullptr;
  }

private:
  void check(const EffectInfo& info, const HookSet& hooks) const {
    const std::string effect = "effect '" + info.id + "'";
    if (info.id.empty()) throw InvalidInput("an effect has no id");
    if (find(info.id) != nullptr) throw InvalidInput(effect + " is in the catalogue already");
    if (is_calibration(info.id))
      throw InvalidInput(effect + ": ids that start with calibration. belong to the engine");
    for (const Need need : info.needs) {
      const bool bench_only = need == Need::thermal_model || need == Need::current_model ||
                              need == Need::ohmic_without_tempco || need == Need::supply_not_logged ||
                              need == Need::current_A || need == Need::power_param ||
                              need == Need::two_nodes || need == Need::thesis_thermal ||
                              need == Need::airspeed_mps || need == Need::neighbour_C;
      const bool axis_only = need == Need::axis_model || need == Need::angle_deg || need == Need::open_loop ||
                             need == Need::closed_loop;
      if ((bench_only && !hooks.any_bench()) || (axis_only && !hooks.any_axis()))
        throw InvalidInput(effect + ": needs '" + to_string(need) +
                           "', which none of its hooks has to do with");
    }
    if (!info.states.empty() && !hooks.axis && !hooks.friction)
      throw InvalidInput(effect + ": has states, but no hook on AxisTerms or FrictionTerms that moves them");
    if (static_cast<int>(info.states.size()) > most_own_states)
      throw InvalidInput(effect + ": has more than " + std::to_string(most_own_states) + " states");
    int place = 0;
    for (const Parameter& parameter : info.parameters) check(parameter, place++, effect, hooks);
    if (info.where_equal) check(*info.where_equal, info);
  }

  static void check(const WhereEqual& equal, const EffectInfo& info) {
    const auto is_place = [&](int i) { return i >= 0 && i < static_cast<int>(info.parameters.size()); };
    const std::string where = "effect '" + info.id + "', what it is where two of its parameters are equal: ";
    if (!is_place(equal.one) || !is_place(equal.other) || equal.one == equal.other)
      throw InvalidInput(where + "expected two places of the list of parameters (from 0)");
    const Parameter &one = info.parameters[static_cast<std::size_t>(equal.one)],
                    &other = info.parameters[static_cast<std::size_t>(equal.other)];
    if (one.unit != other.unit || one.logarithmic || other.logarithmic)
      throw InvalidInput(where + "'" + one.name + "' and '" + other.name +
                         "' need the same unit, and neither may be logarithmic");
    if (equal.cause.empty() || equal.cause == info.id)
      throw InvalidInput(where + "expected the id of another cause");
  }

  static void check(const Parameter& parameter, int place, const std::string& effect, const HookSet& hooks) {
    const std::string where = effect + ", parameter '" + parameter.name + "': ";
    if (parameter.name.empty()) throw InvalidInput(effect + ": a parameter has no name");
    if (parameter.index >= 0 && parameter.index != place)
      throw InvalidInput(where + "the effect reads it as number " + std::to_string(parameter.index) +
                         ", but it is number " + std::to_string(place) + " of the list (from 0)");
    if (!(parameter.lower < parameter.upper)) throw InvalidInput(where + "lower must be below upper");
    if (parameter.logarithmic && !(parameter.lower > 0.0))
      throw InvalidInput(where + "a logarithmic parameter needs a lower bound above 0");
    if (parameter.starts.empty()) throw InvalidInput(where + "expected at least one start");
    for (double start : parameter.starts)
      if (!(start >= parameter.lower && start <= parameter.upper))
        throw InvalidInput(where + "a start lies outside the bounds");
    if (parameter.standard &&
        !(*parameter.standard >= parameter.lower && *parameter.standard <= parameter.upper))
      throw InvalidInput(where + "its standard value lies outside the bounds");
    if ((parameter.starts_relative_to == Input::drive_A && !hooks.any_axis()) ||
        ((parameter.starts_relative_to == Input::power_param ||
          parameter.starts_relative_to == Input::supply_V) &&
         !hooks.any_bench()))
      throw InvalidInput(where + "its starts are shares of an input that none of the effect's hooks has");
  }

  std::vector<EffectInfo> infos_;
  std::vector<CatalogueEntry> entries_;
};

}  // namespace thermopower::plant
