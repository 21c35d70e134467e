// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/simulation_mode.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thermopower::gap {

namespace detail {

/// Moves the node that no instrument shows: the housing, or the winding behind a lagging thermometer.
template <class Scalar>
void shift_hidden(BenchState<Scalar>& state, const Instance<Scalar>& instance, double by_K) {
  state.surface_C += by_K;
  if (instance.thermal_structure.lagged) state.winding_C += by_K;
}

/// Where a hidden node starts relative to the measured one. Nobody measures it, so it is what fits the run's
/// measured temperatures best (linear least squares, a few kelvin expected); 0 for a model without hidden
/// node.
template <class Scalar>
double hidden_start_K(const BenchRollout<Scalar>& rollout, const Segment& segment,
                      const Instance<Scalar>& instance, const BenchState<Scalar>& start) {
  if (!instance.thermal_structure.lagged && !instance.thermal_structure.two_nodes) return 0.0;
  const Eigen::VectorXd& measured = segment.inputs->of(Signal::motor_C);
  const double run_start_s = segment.inputs->t_s[segment.run.begin];
  std::vector<double> at_0;
  BenchState<Scalar> state = start;
  rollout.run(
      segment.begin, segment.end, run_start_s, state,
      [&](Eigen::Index, const BenchReadings<Scalar>& read) { at_0.push_back(value_of(read.motor_C)); });
  state = start;
  shift_hidden(state, instance, 1.0);
  double product = 0.0, square = 4e-4;  // a prior of 5 K at a noise of 0.1 K
  std::size_t index = 0;
  rollout.run(segment.begin, segment.end, run_start_s, state,
              [&](Eigen::Index row, const BenchReadings<Scalar>& read) {
                const double effect = value_of(read.motor_C) - at_0[index],
                             left = measured[row] - at_0[index];
                ++index;
                if (!std::isfinite(left) || !std::isfinite(effect)) return;
                product += effect * left;
                square += effect * effect;
              });
  return std::clamp(product / square, -100.0, 100.0);
}

/// Simulates segments from their measured starts and hands every reading to `put(segment index, signal, row,
/// value)`.
template <class Scalar, class Put>
void simulate_segments(const Instance<Scalar>& instance, const std::vector<Segment>& segments,
                       SimulationMode mode, Put&& put) {
  const Scalar still = constant<Scalar>(0.0);
  AxisState<Scalar> carried{still, still, still, still};
  for (std::size_t index = 0; index < segments.size(); ++index) {
    const Segment& segment = segments[index];
    const Inputs& inputs = *segment.inputs;
    if (segment.axis) {
      const AxisRollout<Scalar> rollout(instance, inputs);
      AxisState<Scalar> state = FitProblem::measured_start(rollout, inputs, segment.run, segment.begin);
      if (segment.carries_on) {
        state.twist_rad = carried.twist_rad;
        state.twist_rate_rad_per_s = carried.twist_rate_rad_per_s;
      }
      rollout.window(segment.run, segment.begin, segment.end, state,
                     [&](Eigen::Index row, const AxisReadings<Scalar>& read) {
                       put(index, Signal::angle_deg, row, read.angle_deg);
                       put(index, Signal::rate_dps, row, read.rate_dps);
                     });
      carried = state;
    } else {
      const bool isolated = mode == SimulationMode::measured_inputs;
      typename BenchRollout<Scalar>::Feed feed;
      feed.measured_motor = !inputs.judged(Signal::motor_C) || (isolated && inputs.held_motor_C.size() > 0);
      feed.measured_current = isolated && inputs.held_current_A.size() > 0;
      const BenchRollout<Scalar> rollout(instance, inputs, feed);
      BenchState<Scalar> state = rollout.start(
          segment.begin, inputs.held_motor_C.size() > 0 ? inputs.held_motor_C[segment.begin] : 25.0);
      if (inputs.judged(Signal::motor_C))
        shift_hidden(state, instance, hidden_start_K(rollout, segment, instance, state));
      rollout.run(segment.begin, segment.end, inputs.t_s[segment.run.begin], state,
                  [&](Eigen::Index row, const BenchReadings<Scalar>& read) {
                    put(index, Signal::current_A, row, read.current_A);
                    put(index, Signal::motor_C, row, read.motor_C);
                  });
    }
  }
}

}  // namespace detail

}  // namespace thermopower::gap
