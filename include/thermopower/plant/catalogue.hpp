// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/effect.hpp>
#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/inline.hpp>
#include <thermopower/plant/invalid_input.hpp>
#include <thermopower/plant/terms.hpp>

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

/// An effect of the catalogue: what it is, and its hooks for all scalars.
///
/// @snippet plant_examples.cpp catalogue
/// How to: @ref diagnose_a_gap.
struct CatalogueEntry {
  EffectInfo info;                                          ///< id, prose, parameters, needs
  HookSet hooks;                                            ///< where it acts
  std::shared_ptr<const detail::Hooks<double>> plain;       ///< its hooks for simulations
  std::shared_ptr<const detail::Hooks<Dual>> dual;          ///< and for fits, with derivatives
  std::shared_ptr<const detail::Hooks<WideDual>> wide;      ///< in more directions
  std::shared_ptr<const detail::Hooks<Expression>> traced;  ///< and for writing its equation down

  /// The hooks for a scalar.
  template <class Scalar>
  const detail::Hooks<Scalar>& of() const {
    if constexpr (std::is_same_v<Scalar, double>) return *plain;
    else if constexpr (std::is_same_v<Scalar, Expression>) return *traced;
    else if constexpr (std::is_same_v<Scalar, WideDual>) return *wide;
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
  /// Adds an effect. Another type is a compile-time error in one sentence. @throws InvalidInput where its info is unusable
  /// or its id is taken.
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
           detail::hooks_of<Effect, Dual>(), detail::hooks_of<Effect, WideDual>(),
           detail::hooks_of<Effect, Expression>()});
    return *this;
  }

  /// Adds an effect whose hooks are objects, for equations that are no C++ types: all kinds of them, for every term
  /// that the set of hooks names. @throws InvalidInput where its info is unusable, its id is taken, or hooks are missing
  Catalogue& add(CatalogueEntry entry);

  /// Adds an effect whose equation a plant of one's own holds itself.
  /// @throws InvalidInput where its info is unusable or its id is taken
  Catalogue& declare(const EffectInfo& info);

  /// Gives a curve its range and the size that its values are relative to; 0 takes them away. @throws InvalidInput where the
  /// catalogue has no curve of that id, or from is not below to
  /// @param from  where its first knot lies
  /// @param to    where its last knot lies
  /// @param size  of what its values are relative to (CurveShape)
  Catalogue& support(std::string_view id, double from, double to, double size);

  /// The effects, in the order added.
  const std::vector<EffectInfo>& list() const { return infos_; }

  /// The effects with their hooks, in the order added.
  const std::vector<CatalogueEntry>& entries() const { return entries_; }

  /// The effect of that id, or nullptr.
  const CatalogueEntry* find(std::string_view id) const;

private:
  void check(const EffectInfo& info, const HookSet& hooks) const;

  std::vector<EffectInfo> infos_;
  std::vector<CatalogueEntry> entries_;
};

}  // namespace thermopower::plant

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/catalogue.hpp>
#endif
