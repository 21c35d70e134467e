// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/expression.hpp>
#include <thermopower/plant/plant.hpp>
#include <thermopower/plant/plant_info.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// An equation of a plant of one's own, written down with numbers for its constants.
struct WrittenEquation {
  std::string name;                    ///< an identifier
  std::string comment;                 ///< one sentence: what it gives, and its unit
  std::vector<std::string> arguments;  ///< identifiers of what it is given
  Expression value;                    ///< of the trace it was written with, in symbols of these names
};

/// The common part of all plants of your own: states of which some are measured, and signals.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref diagnose_a_gap.
class OwnPlant : public Plant {
public:
  /// @throws InvalidInput where the info or an effect's is unusable
  OwnPlant(PlantInfo info, const std::vector<EffectInfo>& effects) : info_(std::move(info)) {
    info_.validate();
    for (std::size_t i = 0; i < info_.signals.size(); ++i) signals_.push_back(static_cast<Signal>(i));
    for (const EffectInfo& effect : effects) effects_.declare(effect);
  }

  const PlantInfo* info() const override { return &info_; }
  const Catalogue* effects() const override { return &effects_; }
  const std::vector<Signal>& signals(const Segment&) const override { return signals_; }
  int start_size(const Segment&) const override { return static_cast<int>(info_.states.size()); }

  void cut(const Inputs& inputs, double horizon_s, std::vector<Segment>& segments) const override {
    const bool windows = info_.windowed && horizon_s > 0.0 && std::isfinite(horizon_s);
    for (const RunSpan& run : inputs.runs) {
      Eigen::Index begin = run.begin;
      while (begin < run.end && !measured_at(inputs, begin)) ++begin;
      for (bool first = true; begin + 1 < run.end; first = false) {
        Eigen::Index end = run.end;
        if (windows) {
          end = begin + 1;
          const double until_s = inputs.t_s[begin] + horizon_s;
          const double rounding_s = stamp_rounding_s(until_s, inputs.t_s[run.begin]);
          while (end < run.end && (inputs.t_s[end] < until_s - rounding_s || !measured_at(inputs, end)))
            ++end;
        }
        if (begin + 1 < end) segments.push_back({&inputs, run, begin, end, windows, !first, false});
        begin = end;
      }
    }
  }

  Start start_weight(const Segment& segment, const std::array<double, signal_count>& sigma) const override {
    Start weight(start_size(segment));
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const PlantState& state = info_.states[i];
      // The row itself is among the data where it is judged: the prior only has to keep the start bounded.
      weight[static_cast<Eigen::Index>(i)] = judged(*segment.inputs, state)
                                                 ? 0.01 / sigma[static_cast<std::size_t>(state.measured_by)]
                                                 : 1.0 / state.spread;
    }
    return weight;
  }

  /// The starts of a segment that nobody measures.
  std::vector<HiddenStart> hidden_starts(const Segment& segment) const {
    std::vector<HiddenStart> list;
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const PlantState& state = info_.states[i];
      if (judged(*segment.inputs, state) || segment.carries_on) continue;
      HiddenStart hidden;
      hidden.coordinate = static_cast<int>(i);
      hidden.shows_in = static_cast<Signal>(state.shows_in);
      hidden.trial = 0.1 * state.spread;
      hidden.noise_per_spread = 0.002;  // relative to the trial: a fiftieth of the spread
      hidden.farthest = 20.0 * state.spread;
      list.push_back(hidden);
    }
    return list;
  }

  /// Standard deviation of a start that is taken from measured values.
  Start measured_start_sd(const Segment& segment, const std::array<double, signal_count>& sigma) const {
    Start sd = Start::Zero(start_size(segment));
    for (std::size_t i = 0; i < info_.states.size(); ++i)
      if (judged(*segment.inputs, info_.states[i]))
        sd[static_cast<Eigen::Index>(i)] = sigma[static_cast<std::size_t>(info_.states[i].measured_by)];
    return sd;
  }

  /// Where a segment starts as far as it is measured; `carried` of the states that are not, where it carries on.
  std::vector<double> measured_start(const Segment& segment, const std::vector<double>& carried) const {
    std::vector<double> start;
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      const PlantState& state = info_.states[i];
      if (judged(*segment.inputs, state))
        start.push_back(segment.inputs->of(static_cast<Signal>(state.measured_by))[segment.begin]);
      else start.push_back(segment.carries_on && i < carried.size() ? carried[i] : state.initial);
    }
    return start;
  }

  /// Its equations with a model's constants and effects, written with `trace`; none where it has none to show.
  /// @throws NotTraceable where one cannot be written down
  virtual std::vector<WrittenEquation> written(const Model&, Trace&) const { return {}; }

  /// The model of this plant as its author gives it.
  static Model model(std::shared_ptr<const OwnPlant> plant, std::string name) {
    Model result;
    result.name = std::move(name);
    const PlantInfo& info = *plant->info();
    result.own = PlantModel{info.type, plant, info.constants};
    return result;
  }

protected:
  /// A model's constants times a point's factors, and how each moves with its factor.
  struct Constants {
    std::vector<double> value;       ///< in the constant's unit
    std::vector<double> per_factor;  ///< derivative of each by its factor
    std::vector<int> index;          ///< of the factor in the point; -1: none
  };
  /// The constants of a model at a point.
  static Constants constants_of(const Model& model, const ParameterPoint& point) {
    Constants result;
    int next = 0;
    for (const PlantConstant& constant : model.own->constants) {
      const bool calibrated = constant.may_be_cause && constant.value != 0.0;
      const bool moves = calibrated && static_cast<std::size_t>(next) < point.factors.size();
      result.index.push_back(moves ? next : -1);
      result.per_factor.push_back(constant.value);
      result.value.push_back(moves ? constant.value * point.factors[static_cast<std::size_t>(next)]
                                   : constant.value);
      if (calibrated) ++next;
    }
    return result;
  }

  /// Constants and parameters of effects at a point, each varying with its direction.
  template <class Scalar>
  struct AtPoint {
    std::vector<Scalar> constants;  ///< in the order of the info
    /// Parameters of the effects that act, each by its place among the plant's effects.
    std::vector<std::pair<std::size_t, std::vector<Scalar>>> effects;
  };
  /// A model at a point, as a rollout in these directions takes it.
  template <class Scalar>
  AtPoint<Scalar> at_point(const Model& model, const ParameterPoint& point,
                           const Directions& directions) const {
    const auto moving = [&](double value, double speed, int index) {
      Scalar result = constant<Scalar>(value);
      if (index < directions.first || index >= directions.first + directions.count) return result;
      Scalar unit = constant<Scalar>(0.0);
      seed(unit, index - directions.first);
      result += unit * speed;
      return result;
    };
    const auto speed = [&](std::size_t index) { return point.speed.empty() ? 1.0 : point.speed[index]; };
    const Constants given = constants_of(model, point);
    AtPoint<Scalar> result;
    for (std::size_t i = 0; i < given.value.size(); ++i) {
      const int index = given.index[i];
      result.constants.push_back(moving(
          given.value[i], index < 0 ? 0.0 : given.per_factor[i] * speed(static_cast<std::size_t>(index)),
          index < 0 ? -1 : index));
    }
    for (const auto& effect : model.effects) {
      const std::size_t place = place_of(effect.first);
      const std::vector<double> values = parameters_of(model, effects_.entries()[place].info);
      result.effects.emplace_back(place, std::vector<Scalar>(values.begin(), values.end()));
    }
    std::size_t at = 0;
    for (const CatalogueEntry* entry : point.effects) {
      std::vector<Scalar> parameters;
      for (std::size_t i = 0; i < entry->info.parameters.size(); ++i, ++at) {
        const std::size_t index = point.factors.size() + at;
        parameters.push_back(moving(point.parameters[at], speed(index), static_cast<int>(index)));
      }
      result.effects.emplace_back(place_of(entry->info.id), std::move(parameters));
    }
    return result;
  }

  /// Place of an effect among the plant's. @throws InvalidInput where it has none of that id
  std::size_t place_of(const std::string& id) const {
    for (std::size_t i = 0; i < effects_.entries().size(); ++i)
      if (effects_.entries()[i].info.id == id) return i;
    throw InvalidInput("plant '" + info_.type + "' has no effect '" + id + "'");
  }

  /// Parameters of an effect of the model in the effect's order.
  static std::vector<double> parameters_of(const Model& model, const EffectInfo& info) {
    const EffectParameters& given = model.effects.at(info.id);
    std::vector<double> values;
    for (const Parameter& parameter : info.parameters) {
      const auto found = given.find(parameter.name);
      if (found == given.end() && !parameter.standard)
        throw InvalidInput("model '" + model.name + "', effect '" + info.id + "': parameter '" +
                           parameter.name + "' is missing");
      values.push_back(found == given.end() ? *parameter.standard : found->second);
    }
    return values;
  }

  /// @throws InvalidInput for an effect of the model that this plant does not have
  void check_effects(const Model& model) const {
    for (const auto& effect : model.effects)
      if (effects_.find(effect.first) == nullptr)
        throw InvalidInput("model '" + model.name + "': plant '" + info_.type + "' has no effect '" +
                           effect.first + "'");
  }

  PlantInfo info_;     ///< as its author gave it
  Catalogue effects_;  ///< its own

private:
  static bool judged(const Inputs& inputs, const PlantState& state) {
    return state.measured_by >= 0 && inputs.judged(static_cast<Signal>(state.measured_by));
  }

  bool measured_at(const Inputs& inputs, Eigen::Index row) const {
    for (const PlantState& state : info_.states)
      if (judged(inputs, state) && !std::isfinite(inputs.of(static_cast<Signal>(state.measured_by))[row]))
        return false;
    return true;
  }

  std::vector<Signal> signals_;
};

namespace detail {

/// A plant of one's own under way, however its equations are given: its starts.
class OwnRollout : public Rollout {
public:
  std::vector<HiddenStart> hidden_starts(const Segment& segment) const override {
    return plant_.hidden_starts(segment);
  }
  Start measured_start_sd(const Segment& segment,
                          const std::array<double, signal_count>& sigma) const override {
    return plant_.measured_start_sd(segment, sigma);
  }

protected:
  /// @param plant  whose it is; must outlive it
  explicit OwnRollout(const OwnPlant& plant) : plant_(plant) {}

  const OwnPlant& plant_;  ///< whose it is
};

}  // namespace detail

}  // namespace thermopower::plant
