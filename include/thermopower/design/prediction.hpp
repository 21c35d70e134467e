// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/limits.hpp>
#include <thermopower/design/possible.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/actuator_plant.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::design {

/// Simulated values of the actuator's signals by row; empty where the model does not have the signal.
using Motion = std::array<Eigen::VectorXd, plant::actuator_signal_count>;

/// How much of a limit an experiment uses.
struct LimitUse {
  std::string limit;   ///< field of Limits
  double share = 0.0;  ///< of the way from the start to the limit: 1 is at the limit, more is beyond
};

/// How much of its limits an explanation's motion uses: the limit that is used most. A simulation that leaves the range of numbers
/// is beyond any limit, and so is every step towards a limit where the motion starts.
inline LimitUse use_of(const Motion& motion, const Limits& limits) {
  constexpr double far = 1e9;
  LimitUse most;
  for (const Limits::Bounded& one : Limits::bounded()) {
    const Eigen::VectorXd& values = motion[static_cast<std::size_t>(one.signal)];
    const Bounds& range = limits.*one.bounds;
    if (values.size() == 0 || !range.any()) continue;
    const double first = std::clamp(one.signal == Signal::current_A ? 0.0 : values[0], range.low, range.high);
    double share = values.allFinite() ? 0.0 : far;
    for (const auto& [distance, allowed] : {std::pair{values.maxCoeff() - first, range.high - first},
                                            {first - values.minCoeff(), first - range.low}})
      if (distance > 0.0) share = std::max(share, allowed > 0.0 ? distance / allowed : far);
    if (share > most.share) most = {one.field, share};
  }
  return most;
}

/// What an explanation predicts of an experiment: each watched signal in units of what the likeliest explanation leaves of it, one
/// after the other, at evenly spaced rows.
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
  static constexpr Eigen::Index most_readings = 40;

  /// All must outlive the object.
  Predictor(const DiagnosedGap& gap, const Catalogue& catalogue, const Limits& limits)
      : gap_(gap), catalogue_(catalogue), limits_(limits) {}

  /// How many rows were simulated so far: what a search has spent.
  double rows_simulated() const { return rows_simulated_; }

  /// Whether an explanation has every input that it needs: its simulation of an experiment at rest has a value in every row.
  bool has_inputs_of(const Possible& one) const {
    Experiment rest;
    rest.courses.resize(limits_.vary.size());
    const Motion motion = free_run(schedule_of(rest, limits_), one.fit());
    return std::all_of(motion.begin(), motion.end(),
                       [](const Eigen::VectorXd& values) { return values.allFinite(); });
  }

  /// The whole experiment from its start on.
  Motion free_run(const Recording& schedule, const ParameterPoint& point) const {
    return rolled(engine::prepare(gap_.model, before(schedule)), 0.0, point);
  }

  /// What explanations predict of an experiment. A bench runs freely. An axis is predicted as a diagnosis does it: in windows that
  /// restart from what was measured, here along the motion of one of the explanations.
  /// @param along  motion of the explanation that is true
  std::vector<Prediction> predictions(const Recording& schedule, const Motion& along,
                                      const std::vector<Possible>& explanations) const {
    Recording log = before(schedule);
    for (std::size_t i = 0; i < along.size(); ++i)
      if (along[i].size() > 0) log.set(to_string(static_cast<Signal>(i)), along[i]);
    const Inputs inputs = engine::prepare(gap_.model, log);
    std::vector<Prediction> all;
    for (const Possible& one : explanations) {
      Prediction& prediction = all.emplace_back();
      prediction.middle = readings(rolled(inputs, gap_.horizon_s, one.fit()));
      prediction.open.resize(prediction.middle.size(), one.directions());
      for (int k = 0; k < one.directions(); ++k)
        prediction.open.col(k) = readings(rolled(inputs, gap_.horizon_s, one.moved(k))) - prediction.middle;
    }
    return all;
  }

private:
  /// A schedule as a recording in which nothing has been measured but the start.
  Recording before(const Recording& schedule) const {
    const Model& model = gap_.model;
    Recording log = schedule;
    const auto begin = [&](bool is_simulated, const char* column, double otherwise) {
      if (!is_simulated || log.find(column) != nullptr) return;
      Eigen::VectorXd values = Eigen::VectorXd::Constant(log.rows(), missing);
      values[0] = Limits::value_or(limits_.start, column, otherwise);
      log.set(column, std::move(values));
    };
    const Eigen::VectorXd* ambient_C = schedule.find("ambient_C");
    begin(model.has_thermal() || model.has_current(), "motor_C",
          ambient_C != nullptr ? (*ambient_C)[0] : 25.0);
    begin(model.has_current() && log.find("power_param") != nullptr, "current_A", 0.0);
    begin(model.has_axis(), "angle_deg", 0.0);
    begin(model.has_axis(), "rate_dps", 0.0);
    return log;
  }

  Motion rolled(const Inputs& inputs, double horizon_s, const ParameterPoint& point) const {
    const Plant& plant = plant_of(gap_.model);
    std::vector<Segment> segments;
    plant.cut(inputs, horizon_s, segments);
    const auto rollout = plant.rollout(gap_.model, catalogue_, point, {}, SimulationMode::free_running);
    Motion motion;
    Readings readings;
    for (const Segment& segment : segments) {
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
    for (const Watched& one : gap_.watched) {
      assert(one.left > 0.0);
      const Eigen::VectorXd& values = motion[static_cast<std::size_t>(one.signal)];
      const Eigen::Index step =
          std::max<Eigen::Index>(1, (values.size() + most_readings - 1) / most_readings);
      for (Eigen::Index row = step - 1; row < values.size(); row += step) {
        // A simulation that runs away is far from every other one, and no farther than counts.
        constexpr double far = 1e10;
        const double value = values[row] / one.left;
        list.push_back(std::isfinite(value) ? std::clamp(value, -far, far) : far);
      }
    }
    return Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  }

  const DiagnosedGap& gap_;
  const Catalogue& catalogue_;
  const Limits& limits_;
  mutable double rows_simulated_ = 0.0;
};

}  // namespace thermopower::design
