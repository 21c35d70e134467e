// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/carried_on.hpp>
#include <thermopower/plant/own_plant.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// One call of a simulator: from which state, with which numbers, over which rows.
///
/// @snippet 13_black_box/black_box.cpp black box
/// How to: @ref diagnose_a_gap.
struct SimulatorCall {
  std::vector<double> constants;             ///< in the order of the plant's info
  std::vector<double> start;                 ///< states at the first row, in the order of the info
  Eigen::VectorXd t_s;                       ///< time of each row since the first one, in s; the first is 0
  Eigen::MatrixXd inputs;                    ///< rows x inputs, each held from its row to the next one
  std::vector<std::vector<double>> effects;  ///< parameters of each effect; empty: it does not act

  /// Parameter of an effect; `otherwise` where it does not act.
  double effect(std::size_t which, std::size_t parameter, double otherwise) const {
    return which < effects.size() && !effects[which].empty() ? effects[which][parameter] : otherwise;
  }
};

/// The answer of a simulator.
struct SimulatorAnswer {
  Eigen::MatrixXd signals;  ///< rows x signals; NaN where it failed
  std::vector<double> end;  ///< states at the last row; may stay empty where every state is measured
};

/// A simulator behind a function call. It must answer equal calls equally, and may be called by several threads
/// at once.
using Simulator = std::function<SimulatorAnswer(const SimulatorCall&)>;

namespace detail {

/// A derivative from differences, and how far it can be trusted.
struct Difference {
  Eigen::MatrixXd slope;  ///< rows x signals
  double doubt = 0.0;     ///< norm of its estimated error relative to its own
};

/// Derivative of `values(x)` at x by two central differences, at h and h/2, extrapolated to h = 0 (Richardson).
/// The difference of the two is taken as the error: three times it where the values are smooth, and about what
/// the simulator's own noise leaves of the extrapolation where they are not. Near a bound that x may not pass, one-sided differences of second order
/// take the place of the central ones.
/// @param at_x        values(x)
/// @param lower, upper  x stays within
template <class Values>
Difference difference(const Values& values, const Eigen::MatrixXd& at_x, double x, double h, double lower,
                      double upper) {
  const bool down = x - h >= lower, up = x + h <= upper;
  const auto slope = [&](double step) -> Eigen::MatrixXd {
    if (down && up) return (values(x + step) - values(x - step)) / (2.0 * step);
    const double s = up ? step : -step;
    return (4.0 * values(x + 0.5 * s) - values(x + s) - 3.0 * at_x) / s;
  };
  const Eigen::MatrixXd whole = slope(h), half = slope(0.5 * h);
  Difference result;
  result.slope = half + (half - whole) / 3.0;
  const double size = result.slope.norm();
  result.doubt = size > 0.0 ? (half - whole).norm() / size : 0.0;
  if (!std::isfinite(result.doubt)) result.doubt = 1e300;
  return result;
}

/// The derivative with the step that is least in doubt: a thousandth of the scale where that is sound, else
/// larger steps (a simulator whose own steps or rounding make it rough) or smaller ones (one that bends).
template <class Values>
Eigen::MatrixXd sound_difference(const Values& values, const Eigen::MatrixXd& at_x, double x, double scale,
                                 double lower, double upper) {
  constexpr double sound = 0.01;  // a hundredth of the derivative: Gauss-Newton steps notice no less
  Difference best;
  best.doubt = 1e301;
  for (const double relative : {1e-3, 3e-2, 1e-5}) {
    Difference one = difference(values, at_x, x, relative * scale, lower, upper);
    if (one.doubt < best.doubt) best = std::move(one);
    if (best.doubt < sound) break;
  }
  return best.slope;
}

/// A simulator under way.
class FunctionRollout : public OwnRollout {
public:
  /// One number that a direction moves.
  struct Moved {
    enum class Kind {
      constant,                            ///< a constant of the plant
      effect,                              ///< a parameter of an effect
      start                                ///< the first value of a state
    } kind = Kind::constant;               ///< what it is
    std::size_t which = 0;                 ///< constant, effect or state
    std::size_t part = 0;                  ///< parameter of the effect
    double speed = 1.0;                    ///< of the number by the direction
    double scale = 1.0;                    ///< what it is typically as large as
    double lower = -1e300, upper = 1e300;  ///< it stays within
  };

  FunctionRollout(const OwnPlant& plant, Simulator simulator, SimulatorCall at, std::vector<Moved> moved)
      : OwnRollout(plant), simulator_(std::move(simulator)), at_(std::move(at)), moved_(std::move(moved)) {}

  void roll(const Segment& segment, const Start& start, Readings& out) override {
    const Inputs& inputs = *segment.inputs;
    const PlantInfo& info = *plant_.info();
    const Eigen::Index rows = segment.end - segment.begin;
    const int signals = static_cast<int>(info.signals.size());
    SimulatorCall call = at_;
    // The row after the last is where the next segment goes on.
    const Eigen::Index asked = std::min(segment.end + 1, segment.run.end) - segment.begin;
    call.t_s = inputs.t_s.segment(segment.begin, asked).array() - inputs.t_s[segment.begin];
    call.inputs.resize(asked, static_cast<Eigen::Index>(info.inputs.size()));
    for (Eigen::Index i = 0; i < call.inputs.cols(); ++i)
      call.inputs.col(i) = inputs.own_inputs[static_cast<std::size_t>(i)].segment(segment.begin, asked);
    call.start = plant_.measured_start(segment, carried_.into(segment));
    for (std::size_t i = 0; i < call.start.size(); ++i) call.start[i] += start[static_cast<Eigen::Index>(i)];
    out.reset(segment.begin, segment.end, signals, static_cast<int>(moved_.size()));
    const SimulatorAnswer answer = simulator_(call);
    if (answer.signals.rows() != asked || answer.signals.cols() != signals)
      throw InvalidInput("plant '" + info.type + "': its simulator answered " +
                         std::to_string(answer.signals.rows()) + " rows of " +
                         std::to_string(answer.signals.cols()) + " signals, expected " +
                         std::to_string(asked) + " rows of " + std::to_string(signals));
    for (Eigen::Index row = 0; row < rows; ++row)
      for (int k = 0; k < signals; ++k) out.put(segment.begin + row, k, answer.signals(row, k));
    for (std::size_t d = 0; d < moved_.size(); ++d) {
      const Moved& one = moved_[d];
      double* number = one.kind == Moved::Kind::constant ? &call.constants[one.which]
                       : one.kind == Moved::Kind::effect ? &call.effects[one.which][one.part]
                                                         : &call.start[one.which];
      const double x = *number;
      const auto values = [&](double moved_to) -> Eigen::MatrixXd {
        *number = moved_to;
        Eigen::MatrixXd result = simulator_(call).signals;
        *number = x;
        return result;
      };
      const Eigen::MatrixXd slope =
          sound_difference(values, answer.signals, x, one.scale, one.lower, one.upper);
      for (Eigen::Index row = 0; row < rows; ++row)
        for (int k = 0; k < signals; ++k)
          out.put_slope(segment.begin + row, k, static_cast<int>(d), slope(row, k) * one.speed);
    }
    carried_.leave(answer.end);
  }

private:
  Simulator simulator_;
  SimulatorCall at_;
  std::vector<Moved> moved_;
  CarriedOn<std::vector<double>> carried_;
};

/// A simulator behind a function call as the engine asks it.
class FunctionPlant : public OwnPlant {
public:
  FunctionPlant(PlantInfo info, const std::vector<EffectInfo>& effects, Simulator simulator)
      : OwnPlant(std::move(info), effects), simulator_(std::move(simulator)) {}

  int directions_at_once() const override { return 1 << 20; }

  std::unique_ptr<Rollout> rollout(const Model& model, const Catalogue&, const ParameterPoint& point,
                                   const Directions& directions, SimulationMode) const override {
    check_effects(model);
    const Constants constants = constants_of(model, point);
    SimulatorCall at;
    at.constants = constants.value;
    at.effects.resize(effects_.entries().size());
    std::vector<FunctionRollout::Moved> all(static_cast<std::size_t>(point.size()));
    const auto speed = [&](std::size_t index) { return point.speed.empty() ? 1.0 : point.speed[index]; };
    for (std::size_t i = 0; i < constants.value.size(); ++i) {
      if (constants.index[i] < 0) continue;
      const auto index = static_cast<std::size_t>(constants.index[i]);
      all[index].which = i;
      all[index].speed = constants.per_factor[i] * speed(index);
      all[index].scale = std::abs(constants.value[i]);
    }
    for (std::size_t i = 0; i < effects_.entries().size(); ++i)
      if (model.effects.count(effects_.entries()[i].info.id) > 0)
        at.effects[i] = parameters_of(model, effects_.entries()[i].info);
    std::size_t next = 0;
    for (const CatalogueEntry* entry : point.effects)
      for (std::size_t i = 0; i < effects_.entries().size(); ++i) {
        const EffectInfo& info = effects_.entries()[i].info;
        if (info.id != entry->info.id) continue;
        at.effects[i].clear();
        for (std::size_t part = 0; part < info.parameters.size(); ++part, ++next) {
          const Parameter& parameter = info.parameters[part];
          at.effects[i].push_back(point.parameters[next]);
          FunctionRollout::Moved& one = all[point.factors.size() + next];
          one.kind = FunctionRollout::Moved::Kind::effect;
          one.which = i;
          one.part = part;
          one.speed = speed(point.factors.size() + next);
          one.lower = parameter.lower;
          one.upper = parameter.upper;
          one.scale = scale_of(parameter, point.parameters[next]);
        }
      }
    for (std::size_t i = 0; i < info_.states.size(); ++i) {
      FunctionRollout::Moved one;
      one.kind = FunctionRollout::Moved::Kind::start;
      one.which = i;
      one.scale = info_.states[i].spread;
      all.push_back(one);
    }
    const auto from = std::min(all.size(), static_cast<std::size_t>(directions.first));
    const auto count = std::min(all.size() - from, static_cast<std::size_t>(directions.count));
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(from);
    return std::make_unique<FunctionRollout>(
        *this, simulator_, std::move(at),
        std::vector<FunctionRollout::Moved>(first, first + static_cast<std::ptrdiff_t>(count)));
  }

private:
  /// The typical size of a parameter: itself, or the smallest start of a fit if it is small.
  static double scale_of(const Parameter& parameter, double value) {
    double typical = 0.0;
    for (double start : parameter.starts)
      if (start != 0.0 && (typical == 0.0 || std::abs(start) < typical)) typical = std::abs(start);
    if (typical == 0.0)
      typical = 1e-3 * std::min(std::abs(parameter.upper), std::abs(parameter.upper - parameter.lower));
    return std::max(std::abs(value), typical);
  }

  Simulator simulator_;
};

}  // namespace detail

/// A simulator behind a function call as a model that `gap::diagnose` takes.
///
/// It needs no derivatives: they are taken from differences, with steps that suit each number's scale, checked
/// against a second step, and changed where the two do not agree. That takes four calls or more for every number
/// and step of a fit: a simulator should answer within milliseconds.
///
/// @param name       as reports call the model
/// @param info       what it is made of; `start` and `end` of a call follow its states
/// @param effects    that the simulator can switch on: SimulatorCall::effects in this order
/// @param simulator  is asked for every simulation
/// @throws InvalidInput where an info is unusable
inline Model adapt_function(std::string name, PlantInfo info, const std::vector<EffectInfo>& effects,
                            Simulator simulator) {
  if (!simulator) throw InvalidInput("plant '" + info.type + "' has no simulator: expected a function");
  return OwnPlant::model(
      std::make_shared<detail::FunctionPlant>(std::move(info), effects, std::move(simulator)),
      std::move(name));
}

}  // namespace thermopower::plant
