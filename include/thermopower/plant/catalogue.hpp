// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
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
struct HookSet {
  bool electrical = false;         ///< overload of `act` for ElectricalTerms
  bool thermal = false;            ///< for ThermalTerms
  bool thermal_structure = false;  ///< for ThermalStructure
  bool bench_readings = false;     ///< for BenchReadings
  bool drive = false;              ///< for DriveTerms
  bool axis = false;               ///< for AxisTerms
  bool axis_structure = false;     ///< for AxisStructure
  bool axis_readings = false;      ///< for AxisReadings

  /// Whether it can show in a recording of a motor on a bench.
  bool any_bench() const { return electrical || thermal || thermal_structure || bench_readings; }
  /// Whether it can show in a recording of a moving axis.
  bool any_axis() const { return drive || axis || axis_structure || axis_readings; }
};

namespace detail {

/// The hooks for one scalar, type-erased; `p` points to the effect's parameters.
template <class Scalar>
class Hooks {
public:
  virtual ~Hooks() = default;
  virtual void call(const Scalar*, ElectricalTerms<Scalar>&) const {}
  virtual void call(const Scalar*, ThermalTerms<Scalar>&) const {}
  virtual void call(const Scalar*, ThermalStructure<Scalar>&) const {}
  virtual void call(const Scalar*, BenchReadings<Scalar>&) const {}
  virtual void call(const Scalar*, DriveTerms<Scalar>&) const {}
  virtual void call(const Scalar*, AxisTerms<Scalar>&) const {}
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

/// Forwards each type-erased hook to `Effect::act` where the effect has that overload.
template <class Effect, class Scalar>
class HooksOf : public Hooks<Scalar> {
public:
  void call(const Scalar* p, ElectricalTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, ThermalTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, ThermalStructure<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, BenchReadings<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, DriveTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisTerms<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisStructure<Scalar>& terms) const final { forward(p, terms); }
  void call(const Scalar* p, AxisReadings<Scalar>& terms) const final { forward(p, terms); }

private:
  template <class Terms>
  static void forward(const Scalar* p, Terms& terms) {
    if constexpr (HasHook<Effect, Terms>::value) Effect::act(p, terms);
  }
};

}  // namespace detail

/// An effect of the catalogue: what it is, and its hooks for both scalars.
struct CatalogueEntry {
  EffectInfo info;                                     ///< id, prose, parameters, needs
  HookSet hooks;                                       ///< where it acts
  std::shared_ptr<const detail::Hooks<double>> plain;  ///< its hooks for simulations
  std::shared_ptr<const detail::Hooks<Dual>> dual;     ///< and for fits, with derivatives

  /// The hooks for a scalar.
  template <class Scalar>
  const detail::Hooks<Scalar>& of() const {
    if constexpr (std::is_same_v<Scalar, double>) return *plain;
    else return *dual;
  }
};

/// The effects that a diagnosis knows.
///
/// An effect is a type with `static EffectInfo info()` and one or several static templates
/// `template <class Scalar> static void act(const Scalar* p, XTerms<Scalar>& terms)`, where XTerms is one of
/// terms.hpp and `p` its parameters in the order of `info().parameters`. It is simulated, fitted (derivatives
/// by automatic differentiation), compared and exported because it exists: `catalogue.add<MyEffect>()`.
class Catalogue {
public:
  /// Adds an effect. @throws InvalidInput where its info is unusable or its id is taken.
  template <class Effect>
  Catalogue& add() {
    CatalogueEntry entry;
    entry.info = Effect::info();
    check(entry.info);
    entry.hooks.electrical = detail::HasHook<Effect, ElectricalTerms<double>>::value;
    entry.hooks.thermal = detail::HasHook<Effect, ThermalTerms<double>>::value;
    entry.hooks.thermal_structure = detail::HasHook<Effect, ThermalStructure<double>>::value;
    entry.hooks.bench_readings = detail::HasHook<Effect, BenchReadings<double>>::value;
    entry.hooks.drive = detail::HasHook<Effect, DriveTerms<double>>::value;
    entry.hooks.axis = detail::HasHook<Effect, AxisTerms<double>>::value;
    entry.hooks.axis_structure = detail::HasHook<Effect, AxisStructure<double>>::value;
    entry.hooks.axis_readings = detail::HasHook<Effect, AxisReadings<double>>::value;
    entry.plain = std::make_shared<detail::HooksOf<Effect, double>>();
    entry.dual = std::make_shared<detail::HooksOf<Effect, Dual>>();
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
  void check(const EffectInfo& info) const {
    if (info.id.empty()) throw InvalidInput("an effect has no id");
    if (find(info.id) != nullptr) throw InvalidInput("effect '" + info.id + "' is in the catalogue already");
    if (info.id.rfind("calibration.", 0) == 0)
      throw InvalidInput("effect '" + info.id + "': ids that start with calibration. belong to the engine");
    for (const Parameter& parameter : info.parameters) {
      const std::string where = "effect '" + info.id + "', parameter '" + parameter.name + "': ";
      if (!(parameter.lower < parameter.upper)) throw InvalidInput(where + "lower must be below upper");
      if (parameter.logarithmic && !(parameter.lower > 0.0))
        throw InvalidInput(where + "a logarithmic parameter needs a lower bound above 0");
      if (parameter.starts.empty()) throw InvalidInput(where + "expected at least one start");
      for (double start : parameter.starts)
        if (!(start >= parameter.lower && start <= parameter.upper))
          throw InvalidInput(where + "a start lies outside the bounds");
    }
  }

  std::vector<EffectInfo> infos_;
  std::vector<CatalogueEntry> entries_;
};

}  // namespace thermopower::plant
