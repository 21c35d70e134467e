// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/limits.hpp>
#include <thermopower/design/possible.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace thermopower::design {

/// Simulated values of the actuator's signals by row; empty where the model does not have the signal.
using Motion = std::array<Eigen::VectorXd, plant::actuator_signal_count>;

/// What an explanation predicts of an experiment: each watched signal in units of its noise, one after the other, at evenly spaced
/// rows.
struct Prediction {
  Eigen::VectorXd middle;  ///< at the fit
  Eigen::MatrixXd
      open;  ///< how one standard deviation of its parameters moves that; a column for each direction
};

/// Simulates experiments with explanations.
///
/// How to: @ref design_the_next_experiment.
class Predictor {
public:
  /// Readings of a signal that count: neighbouring ones err alike, and more would promise too much.
  static constexpr Eigen::Index most_readings = 200;

  /// All must outlive the object.
  /// @param horizon_s  of the axis' windows, as in the diagnosis, s
  Predictor(const Model& model, const Catalogue& catalogue, const Limits& limits,
            std::vector<Watched> watched, double horizon_s)
      : model_(model),
        catalogue_(catalogue),
        limits_(limits),
        watched_(std::move(watched)),
        horizon_s_(horizon_s) {}

  /// The signals that are recorded.
  const std::vector<Watched>& watched() const { return watched_; }

  /// How many rows were simulated so far: what a search has spent.
  double rows_simulated() const { return rows_simulated_; }

  /// A schedule as a recording in which nothing has been measured but the start.
  Recording before(const Recording& schedule) const {
    Recording log = schedule;
    const auto begin = [&](const char* column, double value) {
      if (log.find(column) != nullptr) return;
      assert(log.rows() > 0);
      Eigen::VectorXd values = Eigen::VectorXd::Constant(log.rows(), missing);
      values[0] = value;
      log.set(column, std::move(values));
    };
    if (model_.has_thermal() || model_.has_current())
      begin("motor_C", Limits::value_or(limits_.start, "motor_C", ambient_C(schedule)));
    if (model_.has_current() && log.find("power_param") != nullptr) begin("current_A", 0.0);
    if (model_.has_axis()) {
      begin("angle_deg", Limits::value_or(limits_.start, "angle_deg", 0.0));
      begin("rate_dps", Limits::value_or(limits_.start, "rate_dps", 0.0));
    }
    return log;
  }

  /// The whole experiment from its start on.
  Motion free_run(const Recording& schedule, const ParameterPoint& point) const {
    const std::vector<Inputs> inputs{engine::prepare(model_, before(schedule))};
    std::vector<Segment> segments;
    plant_of(model_).cut(inputs.front(), 0.0, segments);
    return rolled(inputs.front(), segments, point);
  }

  /// A recording of the experiment as an explanation would make it, without noise.
  Recording recorded(const Recording& schedule, const Motion& motion) const {
    Recording log = schedule;
    for (int i = 0; i < plant::actuator_signal_count; ++i) {
      const auto& values = motion[static_cast<std::size_t>(i)];
      assert(values.size() == 0 || values.size() == schedule.rows());
      if (values.size() > 0) log.set(to_string(static_cast<Signal>(i)), values);
    }
    return log;
  }

  /// What explanations predict of an experiment. A bench runs freely. An axis is predicted as a diagnosis does it: in windows that
  /// restart from what was measured, here along the motion of one of the explanations.
  /// @param along  motion of the explanation that is true
  std::vector<Prediction> predictions(const Recording& schedule, const Motion& along,
                                      const std::vector<Possible>& explanations) const {
    const std::vector<Inputs> inputs{engine::prepare(model_, recorded(before(schedule), along))};
    std::vector<Segment> segments;
    plant_of(model_).cut(inputs.front(), horizon_s_, segments);
    std::vector<Prediction> all;
    for (const Possible& one : explanations) {
      Prediction prediction;
      prediction.middle = readings(rolled(inputs.front(), segments, one.fit()));
      prediction.open.resize(prediction.middle.size(), one.directions());
      for (int k = 0; k < one.directions(); ++k)
        prediction.open.col(k) = readings(rolled(inputs.front(), segments, one.moved(k))) - prediction.middle;
      all.push_back(std::move(prediction));
    }
    return all;
  }

private:
  double ambient_C(const Recording& schedule) const {
    const Eigen::VectorXd* values = schedule.find("ambient_C");
    return values != nullptr ? (*values)[0] : 25.0;
  }

  Motion rolled(const Inputs& inputs, const std::vector<Segment>& segments,
                const ParameterPoint& point) const {
    const Plant& plant = plant_of(model_);
    const auto rollout = plant.rollout(model_, catalogue_, point, {}, SimulationMode::free_running);
    Motion motion;
    Readings readings;
    for (const Segment& segment : segments) {
      assert(segment.begin >= 0 && segment.end <= inputs.rows());
      rollout->roll(segment, Start::Zero(plant.start_size(segment)), readings);
      rows_simulated_ += static_cast<double>(segment.end - segment.begin);
      const std::vector<Signal>& signals = plant.signals(segment);
      for (std::size_t k = 0; k < signals.size(); ++k) {
        if (!inputs.judged(signals[k])) continue;
        Eigen::VectorXd& values = motion[static_cast<std::size_t>(signals[k])];
        if (values.size() == 0) values = Eigen::VectorXd::Constant(inputs.rows(), missing);
        for (Eigen::Index row = segment.begin; row < segment.end; ++row)
          values[row] = readings.value(row, static_cast<int>(k));
      }
    }
    return motion;
  }

  Eigen::VectorXd readings(const Motion& motion) const {
    std::vector<double> list;
    for (const Watched& one : watched_) {
      assert(one.noise > 0.0);
      const Eigen::VectorXd& values = motion[static_cast<std::size_t>(one.signal)];
      const Eigen::Index step =
          std::max<Eigen::Index>(1, (values.size() + most_readings - 1) / most_readings);
      for (Eigen::Index row = step - 1; row < values.size(); row += step) {
        // A simulation that runs away is far from every other one, and no farther than counts.
        constexpr double far = 1e4;
        const double value = values[row] / one.noise;
        list.push_back(std::isfinite(value) ? std::clamp(value, -1e6 * far, 1e6 * far) : 1e6 * far);
      }
    }
    return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  }

  const Model& model_;
  const Catalogue& catalogue_;
  const Limits& limits_;
  std::vector<Watched> watched_;
  double horizon_s_;
  mutable double rows_simulated_ = 0.0;
};

}  // namespace thermopower::design
