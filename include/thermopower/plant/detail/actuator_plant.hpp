// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/plant/carried_on.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace thermopower::plant {

namespace detail {

/// A value of a parameter point as the scalar of a rollout.
template <class Scalar>
Scalar seeded(double value, double speed, int index, const Directions& directions) {
  Scalar result = constant<Scalar>(value);
  if (index < 0) return result;
  const int direction = index - directions.first;
  if (direction < 0 || direction >= directions.count) return result;
  Scalar unit = constant<Scalar>(0.0);
  seed(unit, direction);
  result += unit * speed;
  return result;
}

/// A point's factors in the scalar of a rollout.
template <class Scalar>
std::vector<Scalar> factors_of(const ParameterPoint& point, const Directions& directions) {
  std::vector<Scalar> factors;
  for (std::size_t i = 0; i < point.factors.size(); ++i)
    factors.push_back(seeded<Scalar>(point.factors[i], point.speed.empty() ? 1.0 : point.speed[i],
                                     point.direction(static_cast<int>(i)), directions));
  return factors;
}

/// A point's effects in the scalar of a rollout.
template <class Scalar>
std::vector<AddedEffect<Scalar>> effects_of(const ParameterPoint& point, const Directions& directions) {
  std::vector<AddedEffect<Scalar>> added;
  std::size_t at = 0;
  for (const CatalogueEntry* entry : point.effects) {
    AddedEffect<Scalar> one;
    one.entry = entry;
    for (std::size_t i = 0; i < entry->info.parameters.size(); ++i, ++at) {
      const std::size_t index = point.factors.size() + at;
      one.parameters.push_back(seeded<Scalar>(point.parameters[at],
                                              point.speed.empty() ? 1.0 : point.speed[index],
                                              point.direction(static_cast<int>(index)), directions));
    }
    added.push_back(std::move(one));
  }
  return added;
}

/// The actuator under way, in plain numbers or with derivatives.
template <class Scalar>
class ActuatorRollout : public Rollout {
public:
  ActuatorRollout(const Model& model, const Catalogue& catalogue, const ParameterPoint& point,
                  const Directions& directions, SimulationMode mode)
      : instance_(model, factors_of<Scalar>(point, directions), effects_of<Scalar>(point, directions),
                  catalogue),
        starts_from_(point.directions() - directions.first),
        directions_(directions.count),
        isolated_(mode == SimulationMode::measured_inputs),
        carried_(at_rest()) {}

  void roll(const Segment& segment, const Start& start, Readings& out) override {
    out.reset(segment.begin, segment.end, 3, directions_);
    const std::array<Scalar, 2> from{start_scalar(start, 0), start_scalar(start, 1)};
    if (segment.axis) roll_axis(segment, from, out);
    else roll_bench(segment, from, out);
  }

  std::vector<HiddenStart> hidden_starts(const Segment& segment) const override {
    if (segment.axis) return hidden_rate(segment);
    const auto& shape = instance_.thermal_structure;
    if (!segment.inputs->judged(Signal::motor_C)) return {};
    if (!shape.lagged && !shape.two_nodes && !shape.has_further_nodes()) return {};
    HiddenStart hidden;
    hidden.coordinate = 1;
    hidden.shows_in = Signal::motor_C;  // spreads by 5 K, at a noise of 0.1 K
    // A housing lies between the measured node and the air; a winding behind a late thermometer is as far beyond
    // it as it is beyond the air. Sensors of body and air disagree by the margin, and a body is as uneven.
    constexpr double margin_K = 2.0;
    const Inputs& inputs = *segment.inputs;
    if (inputs.ambient_C.size() > 0) {
      const double rise_K = std::abs(inputs.held_motor_C[segment.begin] - inputs.ambient_C[segment.begin]);
      if (std::isfinite(rise_K)) hidden.farthest = rise_K + margin_K;
    }
    return {hidden};
  }

  Start measured_start_sd(const Segment& segment,
                          const std::array<double, signal_count>& sigma) const override {
    const Inputs& inputs = *segment.inputs;
    if (!segment.axis) return Eigen::Vector2d(inputs.judged(Signal::motor_C) ? sigma[1] : 0.0, 0.0);
    const AxisRollout<Scalar> rollout(instance_, inputs);
    const double run_start_s = inputs.t_s[segment.run.begin];
    const AxisState<Scalar> unit = rollout.start(segment.begin, run_start_s, 1.0, 1.0);
    const AxisState<Scalar> zero = rollout.start(segment.begin, run_start_s, 0.0, 0.0);
    const double per_angle = value_of(Scalar(unit.angle_rad - zero.angle_rad)) / rad_per_deg;
    const double per_rate = value_of(Scalar(unit.rate_rad_per_s - zero.rate_rad_per_s)) / rad_per_deg;
    return Eigen::Vector2d(inputs.judged(Signal::angle_deg) ? sigma[2] * per_angle : 0.0,
                           inputs.judged(Signal::rate_dps) ? sigma[3] * per_rate : 0.0);
  }

  bool carries_states() const override {
    return instance_.axis_structure.compliant || instance_.own_states > 0;
  }

private:
  static constexpr Eigen::Index rows_around = 3;  ///< a start, in which the angle tells the rate

  /// The rate at a start of which the angle alone is recorded: between the slopes of the rows around it, which may all be
  /// the same where the encoder is coarse, and then are as far off as one of its steps makes them.
  static std::vector<HiddenStart> hidden_rate(const Segment& segment) {
    const Inputs& inputs = *segment.inputs;
    if (inputs.judged(Signal::rate_dps) || !inputs.judged(Signal::angle_deg) || segment.warm_up) return {};
    const Eigen::VectorXd &angle = inputs.of(Signal::angle_deg), &t_s = inputs.t_s;
    const Eigen::Index first = std::max(segment.run.begin, segment.begin - rows_around),
                       last = std::min(segment.run.end - 1, segment.begin + rows_around);
    double least = 1e300, most = -1e300;
    for (Eigen::Index row = first, known = -1; row <= last; ++row) {
      if (!std::isfinite(angle[row])) continue;
      if (known >= 0) {
        const double slope_dps = (angle[row] - angle[known]) / (t_s[row] - t_s[known]);
        least = std::min(least, slope_dps);
        most = std::max(most, slope_dps);
      }
      known = row;
    }
    if (!(most >= least)) return {};
    HiddenStart hidden;
    hidden.coordinate = 1;
    hidden.shows_in = Signal::angle_deg;
    hidden.noise_per_spread = 1e-3;  // 0.05 deg of noise, and starts that spread by tens of deg/s
    // A reading is off by half a step, so that the slope over these rows is off by one at most.
    hidden.farthest = std::max(most - least, smallest_step_deg(segment) / (t_s[last] - t_s[first]));
    if (!(hidden.farthest > 0.0)) return {};
    return {hidden};
  }

  /// The smallest step between two rows of a segment whose angles differ; 0 where none do.
  static double smallest_step_deg(const Segment& segment) {
    const Eigen::VectorXd& angle = segment.inputs->of(Signal::angle_deg);
    double smallest = 1e300;
    for (Eigen::Index row = segment.begin; row + 1 < segment.end; ++row) {
      const double step = std::abs(angle[row + 1] - angle[row]);
      if (step > 0.0) smallest = std::min(smallest, step);
    }
    return smallest < 1e300 ? smallest : 0.0;
  }

  Scalar start_scalar(const Start& start, int coordinate) const {
    Scalar result = constant<Scalar>(start[coordinate]);
    const int direction = starts_from_ + coordinate;
    if (direction >= 0 && direction < directions_) seed(result, direction);
    return result;
  }

  void roll_bench(const Segment& segment, const std::array<Scalar, 2>& start, Readings& out) {
    const Inputs& inputs = *segment.inputs;
    typename BenchRollout<Scalar>::Feed feed;
    feed.measured_motor = !inputs.judged(Signal::motor_C) || (isolated_ && inputs.held_motor_C.size() > 0);
    feed.measured_current = isolated_ && inputs.held_current_A.size() > 0;
    const BenchRollout<Scalar> rollout(instance_, inputs, feed);
    const Eigen::VectorXd& temperature = inputs.held_motor_C;
    BenchState<Scalar> state =
        rollout.start(segment.begin, temperature.size() > 0 ? temperature[segment.begin] : 25.0);
    state.charge_Ah = constant<Scalar>(segment.run.drawn_Ah);
    state.winding_C += start[0];
    state.surface_C = state.winding_C + start[1];
    state.thermometer_C = state.winding_C;
    if (state.further.any) state.further.soaking_C = state.winding_C + start[1];
    if (state.further.any && !instance_.thermal_structure.soaks && !instance_.thermal_structure.two_nodes)
      state.further.enclosed_C -= start[1];  // air that is warm as far as the body is cooler than it
    // With a lagging thermometer the measured start is its own, and the winding's is the hidden one.
    if (instance_.thermal_structure.lagged) {
      state.winding_C += start[1];
      state.surface_C = state.winding_C;
    }
    rollout.run(segment.begin, segment.end, inputs.t_s[segment.run.begin], state,
                [&](Eigen::Index row, const BenchReadings<Scalar>& read) {
                  out.put(row, 0, read.current_A);
                  out.put(row, 1, read.motor_C);
                  if (inputs.heater_closed) out.put(row, 2, rollout.loop_power());
                });
  }

  /// An axis without twist, whose effects' own states are none.
  static AxisState<Scalar> at_rest() {
    const Scalar still = constant<Scalar>(0.0);
    return {still, still, still, still, {}};
  }

  void roll_axis(const Segment& segment, const std::array<Scalar, 2>& start, Readings& out) {
    // Without a state that nobody measures there is nothing to bring about.
    if (segment.warm_up && !instance_.axis_structure.compliant && instance_.own_states == 0) return;
    const Inputs& inputs = *segment.inputs;
    const AxisRollout<Scalar> rollout(instance_, inputs);
    const AxisState<Scalar>& carried = carried_.into(segment);
    AxisState<Scalar> state = measured_start(rollout, inputs, segment.run, segment.begin);
    state.angle_rad += start[0] * rad_per_deg;
    state.rate_rad_per_s += start[1] * rad_per_deg;
    if (segment.carries_on) {
      state.twist_rad = carried.twist_rad;
      state.twist_rate_rad_per_s = carried.twist_rate_rad_per_s;
      state.own = carried.own;
    }
    rollout.window(segment.run, segment.begin, segment.end, state,
                   [&](Eigen::Index row, const AxisReadings<Scalar>& read) {
                     out.put(row, 0, read.angle_deg);
                     out.put(row, 1, read.rate_dps);
                     if (inputs.effort_is_output) out.put(row, 2, rollout.effort_A());
                   });
    // What is carried on depends on the parameters, and on the starts of other segments, which stay out.
    forget(state.twist_rad, starts_from_);
    forget(state.twist_rate_rad_per_s, starts_from_);
    for (int i = 0; i < state.own.count; ++i) forget(state.own.at[i], starts_from_);
    carried_.leave(state);
  }

  /// The measured state of the axis at a row; an unrecorded rate is the angle's difference between the nearest rows before and
  /// after that have one, an unrecorded angle 0.
  static AxisState<Scalar> measured_start(const AxisRollout<Scalar>& rollout, const Inputs& inputs,
                                          const RunSpan& run, Eigen::Index row) {
    double angle_deg = 0.0, rate_dps = 0.0;
    if (inputs.judged(Signal::angle_deg)) angle_deg = inputs.start_of(Signal::angle_deg, row);
    if (inputs.judged(Signal::rate_dps)) {
      rate_dps = inputs.start_of(Signal::rate_dps, row);
    } else {
      const Eigen::VectorXd& angle = inputs.of(Signal::angle_deg);
      const auto nearest = [&](Eigen::Index step) {
        for (Eigen::Index k = 1, at = row + step; k <= rows_around && at >= run.begin && at < run.end;
             ++k, at += step)
          if (std::isfinite(angle[at])) return at;
        return row;
      };
      const Eigen::Index before = nearest(-1), after = nearest(1);
      if (after > before)
        rate_dps = (angle[after] - angle[before]) / (inputs.t_s[after] - inputs.t_s[before]);
      if (!std::isfinite(rate_dps)) rate_dps = 0.0;
    }
    return rollout.start(row, inputs.t_s[run.begin], angle_deg, rate_dps);
  }

  const Instance<Scalar> instance_;
  int starts_from_;  ///< direction of the first coordinate of a start
  int directions_;
  bool isolated_;
  CarriedOn<AxisState<Scalar>> carried_;
};

}  // namespace detail

THERMOPOWER_GAP_INLINE void ActuatorPlant::cut(const Inputs& inputs, double horizon_s,
                                               std::vector<Segment>& segments) const {
  for (const RunSpan& run : inputs.runs) {
    if (inputs.bench()) {
      Eigen::Index begin = run.begin;
      if (inputs.judged(Signal::motor_C))
        while (begin < run.end && !std::isfinite(inputs.of(Signal::motor_C)[begin])) ++begin;
      if (begin + 1 < run.end) segments.push_back({&inputs, run, begin, run.end, false, false, false});
    }
    if (inputs.axis()) {
      const std::vector<Eigen::Index> starts = window_starts(inputs, run, horizon_s);
      for (std::size_t i = 0; i < starts.size(); ++i) {
        const Eigen::Index end = i + 1 < starts.size() ? starts[i + 1] : run.end;
        const bool warms_up =
            starts.size() > 1 && is_before(inputs, run, starts[i], known_from_s(inputs, run));
        if (starts[i] + 1 < end) segments.push_back({&inputs, run, starts[i], end, true, i > 0, warms_up});
      }
    }
  }
}

THERMOPOWER_GAP_INLINE Start
ActuatorPlant::start_weight(const Segment& segment, const std::array<double, signal_count>& sigma) const {
  if (segment.axis) {
    // The row itself is among the data: the prior only has to keep an unmeasured start bounded.
    const bool angle = segment.inputs->judged(Signal::angle_deg),
               rate = segment.inputs->judged(Signal::rate_dps);
    return Eigen::Vector2d(angle ? 0.01 / sigma[2] : 1e3, rate ? 0.01 / sigma[3] : 1e-4);
  }
  return Eigen::Vector2d(0.01 / sigma[1],
                         0.3);  // a hidden node lies within a few kelvin of the measured one
}

THERMOPOWER_GAP_INLINE std::unique_ptr<Rollout> ActuatorPlant::rollout(const Model& model,
                                                                       const Catalogue& catalogue,
                                                                       const ParameterPoint& point,
                                                                       const Directions& directions,
                                                                       SimulationMode mode) const {
  if (directions.count > dual_width)
    return std::make_unique<detail::ActuatorRollout<WideDual>>(model, catalogue, point, directions, mode);
  if (directions.count > 0)
    return std::make_unique<detail::ActuatorRollout<Dual>>(model, catalogue, point, directions, mode);
  return std::make_unique<detail::ActuatorRollout<double>>(model, catalogue, point, directions, mode);
}

}  // namespace thermopower::plant
