// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/carried_on.hpp>
#include <thermopower/plant/own_plant.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace thermopower::plant {

namespace detail {

template <class Effect, class Terms, class Scalar, class = void>
struct ActsOn : std::false_type {};
template <class Effect, class Terms, class Scalar>
struct ActsOn<Effect, Terms, Scalar,
              std::void_t<decltype(Effect::act(std::declval<const Scalar*>(), std::declval<Terms&>()))>>
    : std::true_type {};

}  // namespace detail

/// The effects that act in a rollout of a plant of one's own: the plant calls it with the terms of its equations.
///
/// @snippet 12_own_plant/heated_tank.hpp own plant
/// How to: @ref diagnose_a_gap.
template <class Scalar, class... Effects>
class ActingEffects {
public:
  /// Lets every effect that acts, and that has a hook for these terms, change them; in the order of the list.
  template <class Terms>
  void operator()(Terms& terms) const {
    std::size_t i = 0;
    (apply<Effects>(i++, terms), ...);
  }

  /// Makes the `i`-th effect act with these parameters, in its order; none: it does not act.
  void set(std::size_t i, std::vector<Scalar> parameters) { parameters_[i] = std::move(parameters); }

private:
  template <class Effect, class Terms>
  void apply([[maybe_unused]] std::size_t i, [[maybe_unused]] Terms& terms) const {
    if constexpr (detail::ActsOn<Effect, Terms, Scalar>::value)
      if (!parameters_[i].empty()) Effect::act(parameters_[i].data(), terms);
  }

  std::array<std::vector<Scalar>, sizeof...(Effects) + 1> parameters_;
};

namespace detail {

template <class P, class = void>
struct HasPlantInfo : std::false_type {};
template <class P>
struct HasPlantInfo<P, std::enable_if_t<std::is_same_v<decltype(P::info()), PlantInfo>>> : std::true_type {};

template <class P, class Scalar, class = void>
struct HasTerms : std::false_type {};
template <class P, class Scalar>
struct HasTerms<P, Scalar, std::void_t<typename P::template Terms<Scalar>>> : std::true_type {};

template <class P, class Scalar, class Acting, class = void>
struct HasFlow : std::false_type {};
template <class P, class Scalar, class Acting>
struct HasFlow<P, Scalar, Acting,
               std::void_t<decltype(P::flow(std::declval<const Scalar*>(), std::declval<const Scalar*>(),
                                            std::declval<const Scalar*>(), std::declval<const Acting&>(),
                                            std::declval<Scalar*>()))>> : std::true_type {};

template <class P, class Scalar, class Acting, class = void>
struct HasRead : std::false_type {};
template <class P, class Scalar, class Acting>
struct HasRead<P, Scalar, Acting,
               std::void_t<decltype(P::read(std::declval<const Scalar*>(), std::declval<const Scalar*>(),
                                            std::declval<const Scalar*>(), std::declval<const Acting&>(),
                                            std::declval<Scalar*>()))>> : std::true_type {};

template <class E, class = void>
struct HasEffectInfo : std::false_type {};
template <class E>
struct HasEffectInfo<E, std::enable_if_t<std::is_same_v<decltype(E::info()), EffectInfo>>> : std::true_type {
};

template <class P, class E>
constexpr bool effect_fits() {
  if constexpr (HasTerms<P, double>::value)
    return ActsOn<E, typename P::template Terms<double>, double>::value;
  else return false;
}

/// A state-space plant under way.
template <class P, class Scalar, class... Effects>
class StateRollout : public OwnRollout {
public:
  /// @param constants, states  as many as the plant has
  StateRollout(const OwnPlant& plant, std::vector<Scalar> constants, const Directions& directions,
               int starts_from)
      : OwnRollout(plant),
        info_(*plant.info()),
        constants_(std::move(constants)),
        directions_(directions.count),
        starts_from_(starts_from) {}

  /// Makes the `i`-th effect act.
  void set(std::size_t i, std::vector<Scalar> parameters) { effects_.set(i, std::move(parameters)); }

  void roll(const Segment& segment, const Start& start, Readings& out) override {
    const Inputs& inputs = *segment.inputs;
    const int signals = static_cast<int>(info_.signals.size());
    out.reset(segment.begin, segment.end, signals, directions_);
    States state = started(segment, start);
    std::array<Scalar, signal_count> read{};
    std::vector<Scalar> fed(info_.inputs.size());
    for (Eigen::Index row = segment.begin; row < segment.end; ++row) {
      for (std::size_t i = 0; i < fed.size(); ++i) fed[i] = constant<Scalar>(inputs.own_inputs[i][row]);
      P::read(constants_.data(), state.data(), fed.data(), effects_, read.data());
      for (int k = 0; k < signals; ++k) out.put(row, k, read[static_cast<std::size_t>(k)]);
      if (row + 1 < segment.run.end)
        advance(state, fed.data(), inputs.t_s[row + 1] - inputs.t_s[row], deepest);
    }
    for (Scalar& one : state) forget(one, starts_from_);
    carried_.leave(state);
  }

private:
  using States = std::array<Scalar, largest_start>;
  static constexpr int deepest = 12;  ///< an interval is halved so often at most

  States started(const Segment& segment, const Start& start) {
    const std::optional<States>& carried = carried_.into(segment);
    const std::vector<double> measured = plant_.measured_start(segment, {});
    States state;
    state.fill(constant<Scalar>(0.0));
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const int by = info_.states[i].measured_by;
      const bool known = by >= 0 && segment.inputs->judged(static_cast<Signal>(by));
      state[i] = constant<Scalar>(measured[i]);
      if (!known && segment.carries_on && carried) state[i] = (*carried)[i];
      Scalar off = constant<Scalar>(start[static_cast<Eigen::Index>(i)]);
      const int direction = starts_from_ + static_cast<int>(i);
      if (direction >= 0 && direction < directions_) seed(off, direction);
      state[i] += off;
    }
    return state;
  }

  void flow(const States& state, const Scalar* fed, States& rate) const {
    P::flow(constants_.data(), state.data(), fed, effects_, rate.data());
  }

  void moved(const States& from, const States& rate, double h_s, States& to) const {
    for (std::size_t i = 0; i < info_.states.size(); ++i) to[i] = from[i] + rate[i] * h_s;
  }

  /// One step of the classical Runge-Kutta rule, in halves where the rates bend too much over it.
  void advance(States& state, const Scalar* fed, double h_s, int depth) const {
    States k1{}, k2{}, k3{}, k4{}, point = state;  // a rate that the plant leaves out is 0
    flow(state, fed, k1);
    moved(state, k1, 0.5 * h_s, point);
    flow(point, fed, k2);
    moved(state, k2, 0.5 * h_s, point);
    flow(point, fed, k3);
    moved(state, k3, h_s, point);
    flow(point, fed, k4);
    constexpr double bend_of_spread = 1e-4;  // far below what any instrument resolves of a state's range
    bool bends = false;
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const double across = value_of(k1[i]) - value_of(k2[i]) - value_of(k3[i]) + value_of(k4[i]),
                   middle = value_of(k2[i]) - value_of(k3[i]);
      const double bend = h_s * (std::abs(across) + std::abs(middle)) / 6.0;
      bends = bends || !(bend <= bend_of_spread * info_.states[i].spread);
    }
    if (bends && depth > 0) {
      advance(state, fed, 0.5 * h_s, depth - 1);
      advance(state, fed, 0.5 * h_s, depth - 1);
      return;
    }
    for (std::size_t i = 0; i < info_.states.size(); ++i)
      state[i] += (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) * (h_s / 6.0);
  }

  const PlantInfo& info_;
  std::vector<Scalar> constants_;
  ActingEffects<Scalar, Effects...> effects_;
  int directions_, starts_from_;
  CarriedOn<std::optional<States>> carried_;
};

/// A state-space plant of one's own as the engine asks it.
template <class P, class... Effects>
class StatePlant : public OwnPlant {
public:
  StatePlant() : OwnPlant(P::info(), {Effects::info()...}) {}

  std::unique_ptr<Rollout> rollout(const Model& model, const Catalogue&, const ParameterPoint& point,
                                   const Directions& directions, SimulationMode) const override {
    check_effects(model);
    if (directions.count > 0) return made<Dual>(model, point, directions);
    return made<double>(model, point, directions);
  }

  std::vector<WrittenEquation> written(const Model& model, Trace& trace) const override {
    check_effects(model);
    std::vector<Expression> constants, states, inputs;
    std::vector<std::string> arguments;
    const auto given = [&](const std::string& column, std::vector<Expression>& list) {
      std::string name = column.empty() || (column[0] >= '0' && column[0] <= '9') ? "x" + column : column;
      for (char& c : name)  // an identifier, whatever the column is called
        if (!(c >= '0' && c <= '9') && !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z')) c = '_';
      arguments.push_back(name);
      list.push_back(trace.symbol(name));
    };
    for (const PlantConstant& constant : model.own->constants) constants.push_back(constant.value);
    for (const PlantState& state : info_.states) given(state.name, states);
    for (const PlantInput& input : info_.inputs) given(input.name, inputs);
    ActingEffects<Expression, Effects...> effects;
    for (const auto& effect : model.effects) {
      const std::size_t place = place_of(effect.first);
      const std::vector<double> values = parameters_of(model, effects_.entries()[place].info);
      effects.set(place, std::vector<Expression>(values.begin(), values.end()));
    }
    const std::vector<Expression> rates = trace.every_branch([&] {
      std::vector<Expression> result(info_.states.size());
      P::flow(constants.data(), states.data(), inputs.data(), effects, result.data());
      return result;
    });
    const std::vector<Expression> signals = trace.every_branch([&] {
      std::vector<Expression> result(info_.signals.size());
      P::read(constants.data(), states.data(), inputs.data(), effects, result.data());
      return result;
    });
    std::vector<WrittenEquation> list;
    for (std::size_t i = 0; i < rates.size(); ++i)
      list.push_back({info_.states[i].name + "_rate",
                      "Derivative of " + info_.states[i].name + ", " + info_.states[i].unit + "/s.",
                      arguments, rates[i]});
    for (std::size_t i = 0; i < signals.size(); ++i)
      list.push_back({info_.signals[i].name, "What the instrument shows, " + info_.signals[i].unit + ".",
                      arguments, signals[i]});
    return list;
  }

private:
  template <class Scalar>
  std::unique_ptr<Rollout> made(const Model& model, const ParameterPoint& point,
                                const Directions& directions) const {
    const AtPoint<Scalar> at = at_point<Scalar>(model, point, directions);
    auto rollout = std::make_unique<StateRollout<P, Scalar, Effects...>>(*this, at.constants, directions,
                                                                         point.size() - directions.first);
    for (const auto& [place, parameters] : at.effects) rollout->set(place, parameters);
    return rollout;
  }
};

}  // namespace detail

/// A plant of one's own, written once on a template of its scalar, as a model that `gap::diagnose` takes.
///
/// P is a type with
///
///     static plant::PlantInfo info();                      // constants, inputs, states, signals: what they are
///     template <class Scalar> struct Terms { ... };        // of its equations, what effects see and change
///     // d(state)/dt; calls effects(terms) with its Terms before it adds them up
///     template <class Scalar, class Effects>
///     static void flow(const Scalar* constants, const Scalar* states, const Scalar* inputs,
///                      const Effects& effects, Scalar* rates);
///     // what the instruments show
///     template <class Scalar, class Effects>
///     static void read(const Scalar* constants, const Scalar* states, const Scalar* inputs,
///                      const Effects& effects, Scalar* signals);
///
/// constants, states, inputs and signals in the order of `info()`. Scalar is `double`, a Dual in fits, and an
/// Expression where the equations are written down for firmware: use operators, and the functions of `cmath`
/// after a using-declaration. Inputs are held over an interval, which is
/// integrated with the classical Runge-Kutta rule in as many steps as it takes; derivatives are exact (by
/// automatic differentiation). Each of Effects is a type with `static plant::EffectInfo info()` and
/// `template <class Scalar> static void act(const Scalar* p, P::Terms<Scalar>& terms)`. Errors in these are
/// compile-time errors in one sentence.
///
/// @param name  as reports call the model
/// @throws InvalidInput where an info is unusable
template <class P, class... Effects>
Model adapt(std::string name) {
  using Acting = ActingEffects<double, Effects...>;
  using ActingDual = ActingEffects<Dual, Effects...>;
  constexpr bool info = detail::HasPlantInfo<P>::value;
  constexpr bool terms = detail::HasTerms<P, double>::value;
  constexpr bool flows =
      detail::HasFlow<P, double, Acting>::value && detail::HasFlow<P, Dual, ActingDual>::value;
  constexpr bool reads =
      detail::HasRead<P, double, Acting>::value && detail::HasRead<P, Dual, ActingDual>::value;
  constexpr bool effects = (detail::HasEffectInfo<Effects>::value && ... && true);
  constexpr bool fit = (detail::effect_fits<P, Effects>() && ... && true);
  static_assert(info, "thermopower: a plant needs 'static thermopower::plant::PlantInfo info()'");
  static_assert(terms,
                "thermopower: a plant needs 'template <class Scalar> struct Terms', the terms of its "
                "equations that an effect sees and changes");
  static_assert(flows,
                "thermopower: a plant needs 'template <class Scalar, class Effects> static void flow(const "
                "Scalar* constants, const Scalar* states, const Scalar* inputs, const Effects& effects, "
                "Scalar* rates)'");
  static_assert(reads,
                "thermopower: a plant needs 'template <class Scalar, class Effects> static void read(const "
                "Scalar* constants, const Scalar* states, const Scalar* inputs, const Effects& effects, "
                "Scalar* signals)'");
  static_assert(effects, "thermopower: an effect needs 'static thermopower::plant::EffectInfo info()'");
  static_assert(fit,
                "thermopower: an effect of a plant needs 'template <class Scalar> static void act(const "
                "Scalar* p, Plant::Terms<Scalar>& terms)' with the Terms of that plant");
  if constexpr (info && terms && flows && reads && effects && fit)
    return OwnPlant::model(std::make_shared<detail::StatePlant<P, Effects...>>(), std::move(name));
  else return {};
}

}  // namespace thermopower::plant
