// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/bench_rollout.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/gap/data/inputs.hpp>

#include <Eigen/Dense>

#include <array>
#include <limits>
#include <vector>

namespace thermopower::gap {

/// Rows of one recording that are simulated in one go from a start of their own.
struct Segment {
  const Inputs* inputs = nullptr;  ///< the recording, not owned
  RunSpan run;                     ///< the run they belong to
  Eigen::Index begin = 0;          ///< first row
  Eigen::Index end = 0;            ///< row after the last
  bool axis = false;               ///< moving axis, else motor on the bench
  bool carries_on = false;         ///< states that nobody measures come from the segment before
  bool warm_up = false;            ///< only brings such states about: its samples do not count
};

/// Unknown start of a segment; a fit estimates it along with the parameters. Of an axis: angle in deg, rate
/// in deg/s; on the bench: the measured node in K, then what a hidden one differs from it.
using Start = Eigen::Vector2d;

/// What is minimised: simulation against recordings in units of the noise, with an unknown start for every
/// segment, over the coordinates of an explanation.
struct FitProblem {
  const Model* model = nullptr;                        ///< the baseline, not owned
  const Catalogue* catalogue = nullptr;                ///< that knows the model's own effects, not owned
  std::vector<Segment> segments;                       ///< simulated one after the other
  std::array<double, signal_count> sigma{1, 1, 1, 1};  ///< noise of each signal

  /// Residuals of one segment in units of the noise, with their derivatives.
  struct Residuals {
    Eigen::VectorXd value;          ///< (simulated - measured) / sigma; at most 1e9 in magnitude, never NaN
    Eigen::MatrixXd jacobian;       ///< by coordinate, then by start; empty where not asked for
    std::vector<Signal> signal;     ///< of each row
    std::vector<Eigen::Index> row;  ///< in the recording
  };

  /// Inverse standard deviations of a start around the measured one.
  Start start_weight(const Segment& segment) const {
    if (segment.axis) {
      // The row itself is among the data: the prior only has to keep an unmeasured start bounded.
      const bool angle = segment.inputs->judged(Signal::angle_deg),
                 rate = segment.inputs->judged(Signal::rate_dps);
      return {angle ? 0.01 / sigma[2] : 1e3, rate ? 0.01 / sigma[3] : 1e-4};
    }
    return {0.01 / sigma[1], 0.3};  // a hidden node lies within a few kelvin of the measured one
  }

  /// Simulates all segments and hands each one's residuals to `use(segment index, residuals)`.
  template <class Use>
  void evaluate(const Explanation& explanation, const std::vector<Coordinate>& list,
                const Eigen::VectorXd& at, const std::vector<Start>& starts, bool with_jacobian,
                Use&& use) const {
    const int parameters = static_cast<int>(list.size());
    std::vector<Residuals> all(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i)
      reserve(segments[i], with_jacobian ? parameters + 2 : 0, all[i]);
    if (!with_jacobian) {
      pass<double>(explanation, list, at, starts, 0, 0, all);
    } else {
      // Passes of dual_width directions; the last one carries the starts, too.
      for (int first = 0; first < parameters + 2; first += dual_width)
        pass<Dual>(explanation, list, at, starts, first, std::min(dual_width, parameters + 2 - first), all);
    }
    for (std::size_t i = 0; i < all.size(); ++i) use(i, all[i]);
  }

private:
  static void reserve(const Segment& segment, int columns, Residuals& residuals) {
    const Inputs& inputs = *segment.inputs;
    for (Eigen::Index row = segment.begin; row < segment.end && !segment.warm_up; ++row)
      for (Signal signal : signals(segment))
        if (inputs.judged(signal) && std::isfinite(inputs.of(signal)[row])) {
          residuals.signal.push_back(signal);
          residuals.row.push_back(row);
        }
    const Eigen::Index count = static_cast<Eigen::Index>(residuals.row.size());
    residuals.value.setZero(count);
    if (columns > 0) residuals.jacobian.setZero(count, columns);
  }

  static std::array<Signal, 2> signals(const Segment& segment) {
    if (segment.axis) return {Signal::angle_deg, Signal::rate_dps};
    return {Signal::current_A, Signal::motor_C};
  }

  template <class Scalar>
  void pass(const Explanation& explanation, const std::vector<Coordinate>& list, const Eigen::VectorXd& at,
            const std::vector<Start>& starts, int first, int directions, std::vector<Residuals>& all) const {
    const Point<Scalar> point(*model, explanation, list, at, first, directions);
    const Instance<Scalar> instance(*model, point.factors, point.added, *catalogue);
    const int parameters = static_cast<int>(list.size());
    const Scalar still = constant<Scalar>(0.0);
    AxisState<Scalar> carried{still, still, still, still};
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Segment& segment = segments[i];
      std::array<Scalar, 2> start;
      for (int k = 0; k < 2; ++k) {
        start[static_cast<std::size_t>(k)] = constant<Scalar>(starts[i][k]);
        const int direction = parameters + k - first;
        if (direction >= 0 && direction < directions) seed(start[static_cast<std::size_t>(k)], direction);
      }
      Eigen::Index filled = 0;
      const auto put = [&](Signal signal, Eigen::Index row, const Scalar& simulated) {
        const Inputs& inputs = *segment.inputs;
        if (!inputs.judged(signal) || segment.warm_up) return;
        const double measured = inputs.of(signal)[row];
        if (!std::isfinite(measured)) return;
        const double repeats = inputs.repeats.size() > 0 ? std::sqrt(inputs.repeats[row]) : 1.0;
        const double weight = repeats / sigma[static_cast<std::size_t>(signal)];
        all[i].value[filled] = bounded((value_of(simulated) - measured) * weight);
        if (all[i].jacobian.size() > 0)
          for (int k = 0; k < directions; ++k)
            all[i].jacobian(filled, first + k) = bounded(derivative_of(simulated, k) * weight);
        ++filled;
      };
      if (segment.axis) simulate_axis<Scalar>(instance, segment, start, carried, put);
      // What is carried on depends on the parameters, and on the starts of other segments, which stay out.
      forget(carried.twist_rad, parameters - first);
      forget(carried.twist_rate_rad_per_s, parameters - first);
      if (!segment.axis) simulate_bench<Scalar>(instance, segment, start, put);
    }
  }

  /// A simulation that left the number range counts as very bad, not as undefined.
  static double bounded(double x) {
    constexpr double limit = 1e9;
    return std::isfinite(x) ? std::clamp(x, -limit, limit) : limit;
  }

  template <class Scalar, class Put>
  static void simulate_bench(const Instance<Scalar>& instance, const Segment& segment,
                             const std::array<Scalar, 2>& start, Put&& put) {
    const Inputs& inputs = *segment.inputs;
    typename BenchRollout<Scalar>::Feed feed;
    feed.measured_motor = !inputs.judged(Signal::motor_C);
    const BenchRollout<Scalar> rollout(instance, inputs, feed);
    const Eigen::VectorXd& temperature = inputs.held_motor_C;
    BenchState<Scalar> state =
        rollout.start(segment.begin, temperature.size() > 0 ? temperature[segment.begin] : 25.0);
    state.winding_C += start[0];
    state.surface_C = state.winding_C + start[1];
    state.thermometer_C = state.winding_C;
    // With a lagging thermometer the measured start is its own, and the winding's is the hidden one.
    if (instance.thermal_structure.lagged) {
      state.winding_C += start[1];
      state.surface_C = state.winding_C;
    }
    rollout.run(segment.begin, segment.end, inputs.t_s[segment.run.begin], state,
                [&](Eigen::Index row, const BenchReadings<Scalar>& read) {
                  put(Signal::current_A, row, read.current_A);
                  put(Signal::motor_C, row, read.motor_C);
                });
  }

  template <class Scalar, class Put>
  static void simulate_axis(const Instance<Scalar>& instance, const Segment& segment,
                            const std::array<Scalar, 2>& start, AxisState<Scalar>& carried, Put&& put) {
    const Inputs& inputs = *segment.inputs;
    const AxisRollout<Scalar> rollout(instance, inputs);
    AxisState<Scalar> state = measured_start(rollout, inputs, segment.run, segment.begin);
    state.angle_rad += start[0] * rad_per_deg;
    state.rate_rad_per_s += start[1] * rad_per_deg;
    if (segment.carries_on) {
      state.twist_rad = carried.twist_rad;
      state.twist_rate_rad_per_s = carried.twist_rate_rad_per_s;
    }
    rollout.window(segment.run, segment.begin, segment.end, state,
                   [&](Eigen::Index row, const AxisReadings<Scalar>& read) {
                     put(Signal::angle_deg, row, read.angle_deg);
                     put(Signal::rate_dps, row, read.rate_dps);
                   });
    carried = state;
  }

public:
  /// The measured state of the axis at a row; an unrecorded rate is the angle's difference, an unrecorded
  /// angle 0.
  template <class Scalar>
  static AxisState<Scalar> measured_start(const AxisRollout<Scalar>& rollout, const Inputs& inputs,
                                          const RunSpan& run, Eigen::Index row) {
    double angle_deg = 0.0, rate_dps = 0.0;
    if (inputs.judged(Signal::angle_deg)) angle_deg = inputs.of(Signal::angle_deg)[row];
    if (inputs.judged(Signal::rate_dps)) {
      rate_dps = inputs.of(Signal::rate_dps)[row];
    } else if (run.size() > 1) {
      const Eigen::Index before = std::max(run.begin, row - 1), after = std::min(run.end - 1, row + 1);
      const Eigen::VectorXd& angle = inputs.of(Signal::angle_deg);
      rate_dps = (angle[after] - angle[before]) / (inputs.t_s[after] - inputs.t_s[before]);
      if (!std::isfinite(rate_dps)) rate_dps = 0.0;
    }
    return rollout.start(row, inputs.t_s[run.begin], angle_deg, rate_dps);
  }
};

/// Cuts a recording into segments: the bench by run (from its first measured temperature), the axis by
/// windows. They refer to `inputs`, which must outlive them.
inline void cut(const Inputs& inputs, double horizon_s, std::vector<Segment>& segments) {
  for (const RunSpan& run : inputs.runs) {
    if (inputs.bench()) {
      Eigen::Index begin = run.begin;
      if (inputs.judged(Signal::motor_C))
        while (begin < run.end && !std::isfinite(inputs.of(Signal::motor_C)[begin])) ++begin;
      if (begin + 1 < run.end) segments.push_back({&inputs, run, begin, run.end, false, false});
    }
    if (inputs.axis()) {
      const std::vector<Eigen::Index> starts = window_starts(inputs, run, horizon_s);
      for (std::size_t i = 0; i < starts.size(); ++i) {
        const Eigen::Index end = i + 1 < starts.size() ? starts[i + 1] : run.end;
        if (starts[i] + 1 < end) segments.push_back({&inputs, run, starts[i], end, true, i > 0});
      }
    }
  }
}

/// Cuts all recordings.
inline std::vector<Segment> cut(const std::vector<Inputs>& recordings, double horizon_s) {
  std::vector<Segment> segments;
  for (const Inputs& inputs : recordings) cut(inputs, horizon_s, segments);
  return segments;
}

}  // namespace thermopower::gap
