// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/command_between_rows.hpp>
#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/observe/motion_regression.hpp>
#include <thermopower/plant/actuator_plant.hpp>
#include <thermopower/plant/samples.hpp>
#include <thermopower/plant/servo_loop.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

/// @file target_between_rows.hpp
/// A servo's target between the rows. Nobody recorded the servo's command: it is made of the target and of the motion
/// that was measured, and where that turns within a few rows, slopes from row to row are not its rate at the rows. The
/// command's error goes as its steps do and looks like part of the next target, though every target held. The simulation
/// under test says how much of that there is: with targets that hold, and with targets that move, its motion is looked at
/// through the same rows, and the recorded one is placed between the two.

namespace thermopower::gap::engine {

/// Thresholds of the question what a target did between the rows.
/// Held by tests/gap/data/target_test.cpp.
struct TargetThresholds {
  double least_share = 0.12;  ///< of a servo that takes two targets in a row's time: a quarter, less is none
  double of_moving = 0.25;    ///< least share of the targets that move in a simulation
  double as_strong =
      0.05;  ///< share that drives of simulation and axis may differ by: a half hides a tenth of a step
  int adjustments = 3;  ///< of the simulation's inertia, at most
};

/// Asks the motion of axes behind a servo what its target did.
class TargetBetweenRows {
public:
  /// Keeps references to both: they must outlive this object.
  TargetBetweenRows(const Model& model, const Catalogue& catalogue)
      : model_(model), catalogue_(catalogue), gains_(plant::servo_gains(model)) {}

  /// Adds a recording of an axis in the model's closed loop. Keeps a reference to it: it must outlive this object.
  void add(const Inputs& inputs) { recordings_.push_back(&inputs); }

  /// How much of a target's next step the servo is given before it is logged, where the target went on between the rows; nothing
  /// where it held, or where nobody knows. An axis that follows a smooth target closely moves as that steps: then
  /// nobody can tell it from damping; nor where the simulation runs away.
  std::optional<Estimate> steady() const {
    constexpr double agree = 3.0, least = TargetThresholds().least_share;  // standard errors
    const std::optional<Seen> seen = seen_in(recordings_, false);
    if (!seen) return std::nullopt;
    const std::optional<Estimate> sure = sure_of(seen->share);
    if (!sure || !(sure->value > 0.0)) return std::nullopt;
    const std::optional<Estimate> plain = placed(*seen, false);
    const auto steady = plain ? steady_share(sure_of(*plain), least) : std::nullopt;
    if (!steady) return std::nullopt;
    // The part of its command that a drive takes falls with that as the target is followed, and passes for a part of the next step.
    const std::optional<Seen> seen_beside = seen_in(recordings_, true);
    const std::optional<Estimate> beside = seen_beside ? placed(*seen_beside, true) : std::nullopt;
    const bool was_that = beside && beside->value < least &&
                          plain->value - beside->value > agree * std::hypot(plain->error, beside->error);
    return was_that ? std::nullopt : steady;
  }

private:
  /// Result of a regression of the motion on the servo's command and on the command that the target's next step makes.
  struct Seen {
    double response = 0.0;  ///< of the axis to the command, deg/s^2 for each A
    Estimate share;         ///< of the next step
  };

  /// How much of a target's next step the servo is given before it is logged: where what was seen lies between what is seen in
  /// simulations of targets that hold and of targets that move. Nothing where nobody knows.
  /// @param bent  whether it was seen beside what the drive may bend its command by
  std::optional<Estimate> placed(const Seen& seen, bool bent) const {
    constexpr TargetThresholds limit;
    // The error of slopes goes with the loop's gain, and constants are known roughly. The regression tells torque by inertia.
    Model like = model_;
    std::optional<Seen> holding = seen_in_simulation(like, 0.0, bent);
    for (int round = 0; holding && round < limit.adjustments; ++round) {
      const double stronger = seen.response / holding->response;
      if (!(stronger > 0.0)) return std::nullopt;
      if (std::abs(stronger - 1.0) < limit.as_strong) break;
      like.axis->inertia_kgm2 /= stronger;
      holding = seen_in_simulation(like, 0.0, bent);
    }
    if (!holding) return std::nullopt;
    // More moves where a servo takes one target a row: it feels only one that is ahead of what was logged.
    double moves = limit.of_moving;
    for (const Inputs* one : recordings_) moves = std::max(moves, share_of_samples(*one));
    const std::optional<Seen> moving = seen_in_simulation(like, moves, bent);
    const double apart = moving ? moving->share.value - holding->share.value : 0.0;
    if (!(apart > 0.0)) return std::nullopt;
    const double scale = moves / apart;
    return Estimate{
        scale * (seen.share.value - holding->share.value),
        scale * std::hypot(seen.share.error, std::max(holding->share.error, moving->share.error))};
  }

  std::optional<Seen> seen_in(const std::vector<const Inputs*>& recordings, bool bent) const {
    MotionRegression motion;
    for (const Inputs* one : recordings) motion.add(*one, one->servo_A);
    std::optional<BentCommand> drive;
    if (bent) drive = motion.bent_command();
    const std::optional<MotionFit> fit =
        motion.fit([&](const Inputs& inputs, const Eigen::VectorXd& servo_A, const RunSpan& run,
                       Eigen::Index k) { return terms(inputs, servo_A, drive, run, k); });
    if (!fit || !is_followed(*fit, motion.noise(Signal::rate_dps))) return std::nullopt;
    const Estimate share = fit->second_by_first();
    if (!(share.error < CommandThresholds().precise)) return std::nullopt;
    return Seen{fit->value[0], share};
  }

  MotionRegression::Terms terms(const Inputs& inputs, const Eigen::VectorXd& servo_A,
                                const std::optional<BentCommand>& bent, const RunSpan& run,
                                Eigen::Index k) const {
    constexpr double saturated = 0.98;  // of the limit
    if (k + 1 >= run.end || std::abs(servo_A[k]) > saturated * gains_.limit_A) return {};
    const auto step = [&](const Eigen::VectorXd& target) {
      return target.size() > 0 ? target[k + 1] - target[k] : 0.0;
    };
    const double next = gains_.position ? gains_.proportional * step(inputs.target_deg) +
                                              gains_.derivative * step(inputs.target_dps)
                                        : gains_.proportional * step(inputs.target_dps);
    if (!bent) return Eigen::Vector2d(servo_A[k], next);
    return Eigen::Vector4d(servo_A[k], next, bent->small(servo_A[k]), bent->large(servo_A[k]));
  }

  /// The same where a model made the motion of the recorded targets.
  /// @param moves  share of the next step that its servo is given; 0 of targets that hold
  std::optional<Seen> seen_in_simulation(const Model& model, double moves, bool bent) const {
    std::vector<Inputs> simulated;
    for (const Inputs* one : recordings_) simulated.push_back(simulation_of(model, *one, moves));
    std::vector<const Inputs*> list;
    for (const Inputs& one : simulated) list.push_back(&one);
    return seen_in(list, bent);
  }

  /// A recording with the motion that a model makes of its targets, free-running and without noise, at the rows where motion was
  /// measured, and with what the servo makes of that.
  Inputs simulation_of(const Model& model, const Inputs& recorded, double moves) const {
    Inputs driven = recorded;
    driven.target_moves = moves > 0.0;
    driven.target_lead = driven.target_moves ? moves - share_of_samples(recorded) : 0.0;
    const Plant& plant = plant_of(model);
    std::vector<Segment> segments;
    plant.cut(driven, 0.0, segments);
    const auto rollout = plant.rollout(model, catalogue_, {}, {}, SimulationMode::free_running);
    Inputs result = recorded;
    const std::array<Signal, 2> signals{Signal::angle_deg,
                                        Signal::rate_dps};  // as segments of an axis have them
    const auto measured = [&result](Signal signal) -> Eigen::VectorXd& {
      return result.measured[static_cast<std::size_t>(signal)];
    };
    for (const Signal signal : signals) measured(signal).setConstant(missing);
    Readings readings;
    for (const Segment& segment : segments) {
      if (!segment.axis) continue;
      rollout->roll(segment, Start::Zero(plant.start_size(segment)), readings);
      for (std::size_t i = 0; i < signals.size(); ++i) {
        if (!recorded.judged(signals[i])) continue;
        for (Eigen::Index row = segment.begin; row < segment.end; ++row)
          if (std::isfinite(recorded.of(signals[i])[row]))
            measured(signals[i])[row] = readings.value(row, static_cast<int>(i));
      }
    }
    close_loop(model, result);
    return result;
  }

  /// Share of the next step that the servo is given of targets that go straight from row to row.
  double share_of_samples(const Inputs& inputs) const {
    return plant::moving_target_share(gains_.period_s,
                                      plant::median_interval_s(inputs.t_s, inputs.runs, 0.0));
  }

  const Model& model_;
  const Catalogue& catalogue_;
  plant::ServoGains<double> gains_;
  std::vector<const Inputs*> recordings_;
};

}  // namespace thermopower::gap::engine
