// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/gap/fit/segment_simulation.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/options.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Residuals in units of the noise, one after another, indexed by Signal.
typedef std::array<std::vector<double>, signal_count> ResidualsBySignal;

/// The function to minimise: simulation against recordings in units of the noise, over the coordinates of an explanation
/// and an unknown start for every segment.
struct FitProblem {
  const Model* model = nullptr;          ///< the baseline, not owned
  const Catalogue* catalogue = nullptr;  ///< that knows the model's own effects, not owned
  std::vector<Segment> segments;         ///< simulated one after the other
  std::shared_ptr<const std::vector<Inputs>>
      data;  ///< what the segments are parts of, where the problem keeps it
  std::array<double, signal_count> sigma = plant::for_each_signal(1.0);  ///< noise of each signal
  double correlation = 1.0;                 ///< samples that count as one, 1 or more
  const std::atomic<bool>* stop = nullptr;  ///< as in Options

  /// Residuals of one segment in units of the noise, with their derivatives.
  struct Residuals {
    Eigen::VectorXd value;          ///< (simulated - measured) / sigma; at most 1e9 in magnitude, never NaN
    Eigen::MatrixXd jacobian;       ///< by coordinate, then by start; empty where not asked for
    std::vector<Signal> signal;     ///< of each row
    std::vector<Eigen::Index> row;  ///< in the recording
  };

  /// The equations.
  const Plant& plant() const { return plant_of(*model); }

  /// Inverse standard deviations of a start around the measured one.
  Start start_weight(const Segment& segment) const { return plant().start_weight(segment, sigma); }

  /// A start at the measured one for every segment.
  std::vector<Start> measured_starts() const {
    std::vector<Start> starts;
    for (const Segment& segment : segments) starts.push_back(Start::Zero(plant().start_size(segment)));
    return starts;
  }

  /// Simulates all segments and hands each one's residuals to `use(segment index, residuals)`.
  void evaluate(const Explanation& explanation, const std::vector<Coordinate>& list,
                const Eigen::VectorXd& at, const std::vector<Start>& starts, bool with_jacobian,
                const std::function<void(std::size_t index, const Residuals& residuals)>& use) const {
    evaluate_while(explanation, list, at, starts, with_jacobian,
                   [&use](std::size_t index, const Residuals& residuals) {
                     use(index, residuals);
                     return true;
                   });
  }

  /// The same as long as `use` returns true: what comes after is not looked at.
  void evaluate_while(const Explanation& explanation, const std::vector<Coordinate>& list,
                      const Eigen::VectorXd& at, const std::vector<Start>& starts, bool with_jacobian,
                      const std::function<bool(std::size_t index, const Residuals& residuals)>& use) const {
    if (stop != nullptr && *stop) throw Stopped("the diagnosis was told to stop");
    assert(at.size() == static_cast<Eigen::Index>(list.size()) && starts.size() == segments.size());
    const Plant& plant = this->plant();
    const int parameters = static_cast<int>(list.size());
    const int largest = largest_start_size(plant, segments);
    std::vector<int> columns;  // of the directions: what stays where it is, is none
    if (with_jacobian) {
      for (int i = 0; i < parameters; ++i)
        if (!list[static_cast<std::size_t>(i)].still) columns.push_back(i);
      for (int i = 0; i < largest; ++i) columns.push_back(parameters + i);
    }
    const ParameterPoint point = point_of(*model, explanation, list, at);
    // As few passes as the plant can do with, and those of one size.
    const int directions = static_cast<int>(columns.size()), most = plant.directions_at_once();
    const int count = std::max(1, (directions + most - 1) / most), at_once = (directions + count - 1) / count;
    std::vector<std::pair<Directions, std::unique_ptr<plant::Rollout>>> passes;
    for (int first = 0, pass = 0; pass < count; ++pass, first += at_once) {
      const Directions now{first, std::min(at_once, directions - first)};
      passes.emplace_back(now, plant.rollout(*model, *catalogue, point, now, SimulationMode::free_running));
    }
    Readings readings;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const Segment& segment = segments[i];
      Residuals all;
      reserve(plant, segment, with_jacobian ? parameters + plant.start_size(segment) : 0, all);
      for (const auto& [now, rollout] : passes) {
        rollout->roll(segment, starts[i], readings);
        if (!segment.warm_up) take(plant.signals(segment), segment, readings, now, columns, all);
      }
      if (!use(i, all)) return;
    }
  }

  /// The measured values of a signal of an axis, or of a temperature, at the rows that have residuals. Averages are scaled to the
  /// noise of one sample. Empty for other signals: they jump with what drives them.
  std::vector<double> measured_where_smooth(Signal signal) const {
    std::vector<double> measured;
    const bool is_of_a_body = signal == Signal::motor_C && std::isfinite(model->time_constant_s());
    for (const Segment& segment : segments) {
      const bool is_smooth = segment.axis || is_of_a_body;
      if (segment.warm_up || !is_smooth || !segment.inputs->judged(signal)) continue;
      // A log of an axis may hold its motor's temperature, which is judged in segments of its own.
      const std::vector<Signal>& signals = plant().signals(segment);
      if (std::find(signals.begin(), signals.end(), signal) == signals.end()) continue;
      const Eigen::VectorXd& values = segment.inputs->of(signal);
      for (Eigen::Index row = segment.begin; row < segment.end; ++row)
        if (std::isfinite(values[row]))
          measured.push_back(values[row] * weight_of(*segment.inputs, signal, row) *
                             sigma[static_cast<std::size_t>(signal)]);
    }
    return measured;
  }

  /// Sum of the squares of all residuals. Ends early, with a sum above the limit, because a comparison needs no more.
  /// @param kept  where given, the residuals; fewer of them where it ended early
  double squares(const Explanation& explanation, const std::vector<Coordinate>& list,
                 const Eigen::VectorXd& at, const std::vector<Start>& starts, double limit,
                 ResidualsBySignal* kept = nullptr) const {
    if (kept != nullptr)
      for (std::vector<double>& one : *kept) one.clear();
    if (stop != nullptr && *stop) throw Stopped("the diagnosis was told to stop");
    assert(at.size() == static_cast<Eigen::Index>(list.size()) && starts.size() == segments.size());
    const Plant& plant = this->plant();
    const auto rollout = plant.rollout(*model, *catalogue, point_of(*model, explanation, list, at), {},
                                       SimulationMode::free_running);
    Readings readings;
    double sum = 0.0;
    for (std::size_t i = 0; i < segments.size() && sum <= limit; ++i) {
      const Segment& segment = segments[i];
      rollout->roll(segment, starts[i], readings);
      if (segment.warm_up) continue;
      const std::vector<Signal>& signals = plant.signals(segment);
      double of_segment = 0.0;
      for (std::size_t k = 0; k < signals.size(); ++k) {
        if (!segment.inputs->judged(signals[k])) continue;
        const Eigen::VectorXd& measured = segment.inputs->of(signals[k]);
        for (Eigen::Index row = segment.begin; row < segment.end; ++row) {
          if (!std::isfinite(measured[row])) continue;
          const double residual = bounded((readings.value(row, static_cast<int>(k)) - measured[row]) *
                                          weight_of(*segment.inputs, signals[k], row));
          of_segment += residual * residual;
          if (kept != nullptr) (*kept)[static_cast<std::size_t>(signals[k])].push_back(residual);
        }
      }
      sum += of_segment;
    }
    return sum;
  }

private:
  /// The factor that brings a difference at a row to units of the noise.
  double weight_of(const Inputs& inputs, Signal signal, Eigen::Index row) const {
    assert(sigma[static_cast<std::size_t>(signal)] > 0.0);
    const double repeats = inputs.repeats.size() > 0 ? std::sqrt(inputs.repeats[row]) : 1.0;
    return repeats / sigma[static_cast<std::size_t>(signal)];
  }

  static void reserve(const Plant& plant, const Segment& segment, int columns, Residuals& residuals) {
    const Inputs& inputs = *segment.inputs;
    const std::vector<Signal>& signals = plant.signals(segment);
    for (Eigen::Index row = segment.begin; row < segment.end && !segment.warm_up; ++row)
      for (Signal signal : signals)
        if (inputs.judged(signal) && std::isfinite(inputs.of(signal)[row])) {
          residuals.signal.push_back(signal);
          residuals.row.push_back(row);
        }
    const Eigen::Index count = static_cast<Eigen::Index>(residuals.row.size());
    residuals.value.setZero(count);
    if (columns > 0) residuals.jacobian.setZero(count, columns);
  }

  /// Compares the readings of a segment with what was measured.
  void take(const std::vector<Signal>& signals, const Segment& segment, const Readings& readings,
            const Directions& directions, const std::vector<int>& columns, Residuals& residuals) const {
    std::array<int, signal_count> places{};
    for (std::size_t k = 0; k < signals.size(); ++k)
      places[static_cast<std::size_t>(signals[k])] = static_cast<int>(k);
    const auto column = [&](int d) { return columns[static_cast<std::size_t>(directions.first + d)]; };
    int count = directions.count;  // a segment may have fewer starts than others
    while (count > 0 && column(count - 1) >= residuals.jacobian.cols()) --count;
    for (std::size_t i = 0; i < residuals.row.size(); ++i) {
      const Signal signal = residuals.signal[i];
      const Eigen::Index row = residuals.row[i], at = static_cast<Eigen::Index>(i);
      const int place = places[static_cast<std::size_t>(signal)];
      const double weight = weight_of(*segment.inputs, signal, row);
      residuals.value[at] = bounded((readings.value(row, place) - segment.inputs->of(signal)[row]) * weight);
      const double* const slopes = readings.slopes(row, place);
      for (int d = 0; d < count; ++d) residuals.jacobian(at, column(d)) = bounded(slopes[d] * weight);
    }
  }

  /// A simulation that left the number range counts as very bad, not as undefined.
  static double bounded(double x) {
    constexpr double limit = 1e9;
    if (std::abs(x) <= limit) return x;
    return std::isfinite(x) && x < 0.0 ? -limit : limit;
  }
};

/// Cuts recordings of a plant into segments. They refer to `recordings`, which must outlive them.
inline std::vector<Segment> cut(const std::vector<Inputs>& recordings, double horizon_s, const Plant& plant) {
  std::vector<Segment> segments;
  for (const Inputs& inputs : recordings) plant.cut(inputs, horizon_s, segments);
  return segments;
}

}  // namespace thermopower::gap::engine
