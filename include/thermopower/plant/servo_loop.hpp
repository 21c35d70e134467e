// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/late_target.hpp>
#include <thermopower/plant/model.hpp>
#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// A servo's gains in the scalar of a rollout.
///
/// @snippet plant_examples.cpp servo gains
/// How to: @ref servo_on_a_pendulum.
template <class Scalar>
struct ServoGains {
  bool position = true;        ///< from `target_deg`; else from `target_dps`
  Scalar proportional;         ///< A/deg of a position servo, A s/deg of a velocity servo
  Scalar derivative;           ///< A s/deg; of a position servo
  Scalar integral;             ///< A/(deg s) of a position servo, A/deg of a velocity servo
  double limit_A = 0.0;        ///< of the command, > 0
  double period_s = 1e-3;      ///< between samples, > 0
  Scalar delay_s;              ///< from a sample to its command, >= 0
  double slew_A_per_s = 0.0;   ///< fastest change of the command; 0: any
  double dead_zone_deg = 0.0;  ///< of a position servo: an error within it counts as none

  /// The error of the angle that a position servo acts on.
  template <class Target>
  Scalar angle_error_deg(const Scalar& angle_deg, const Target& target_deg) const {
    const Scalar error = target_deg - angle_deg;
    return dead_zone_deg > 0.0 && std::abs(value_of(error)) <= dead_zone_deg ? constant<Scalar>(0.0) : error;
  }

  /// A command after the one before it, no further from that than the slew allows within a period.
  Scalar after(const Scalar& before, const Scalar& command) const {
    if (!(slew_A_per_s > 0.0)) return command;
    const double most = slew_A_per_s * period_s;
    if (value_of(command) > value_of(before) + most) return Scalar(before + most);
    if (value_of(command) < value_of(before) - most) return Scalar(before - most);
    return command;
  }

  /// The command of a sample, within the limits. Targets are plain numbers, or vary with their delay.
  /// @param accumulated  what integrate() has made of the errors so far, this sample's included
  template <class Target>
  Scalar command_A(const Scalar& angle_deg, const Scalar& rate_dps, const Target& target_deg,
                   const Target& target_dps, const Scalar& accumulated) const {
    Scalar command = integral * accumulated;
    if (position)
      command += proportional * angle_error_deg(angle_deg, target_deg) + derivative * (target_dps - rate_dps);
    else command += proportional * (target_dps - rate_dps);
    if (value_of(command) > limit_A) return constant<Scalar>(limit_A);
    if (value_of(command) < -limit_A) return constant<Scalar>(-limit_A);
    return command;
  }

  /// Adds the error of a sample to the integral (deg s of a position servo, deg of a velocity servo), which is
  /// held where it alone asks for the limit.
  template <class Target>
  void integrate(Scalar& accumulated, const Scalar& angle_deg, const Scalar& rate_dps,
                 const Target& target_deg, const Target& target_dps) const {
    if (!(std::abs(value_of(integral)) > 0.0)) return;
    const Scalar error = position ? angle_error_deg(angle_deg, target_deg) : Scalar(target_dps - rate_dps);
    accumulated += error * period_s;
    const Scalar most = limit_A / magnitude(integral);
    if (value_of(accumulated) > value_of(most)) accumulated = most;
    else if (value_of(accumulated) < -value_of(most)) accumulated = -most;
  }
};

/// The gains of a model's servo, each multiplied by a factor. `Factor` is callable as factor(name).
template <class Scalar, class Factor>
ServoGains<Scalar> servo_gains(const Model& model, Factor&& factor) {
  ServoGains<Scalar> gains;
  gains.derivative = constant<Scalar>(0.0);
  const auto common = [&](const auto& servo) {
    gains.limit_A = servo.limit_A;
    gains.period_s = servo.period_s;
    gains.slew_A_per_s = servo.slew_A_per_s;
    gains.delay_s = constant<Scalar>(servo.delay_s);
  };
  if (const auto* position = std::get_if<PositionPidServo>(&model.servo)) {
    common(*position);
    gains.dead_zone_deg = position->dead_zone_deg;
    gains.proportional = factor("kp_A_per_deg", position->kp_A_per_deg);
    gains.derivative = factor("kd_A_s_per_deg", position->kd_A_s_per_deg);
    gains.integral = factor("ki_A_per_deg_s", position->ki_A_per_deg_s);
  } else if (const auto* velocity = std::get_if<VelocityPiServo>(&model.servo)) {
    common(*velocity);
    gains.position = false;
    gains.proportional = factor("kp_A_s_per_deg", velocity->kp_A_s_per_deg);
    gains.integral = factor("ki_A_per_deg", velocity->ki_A_per_deg);
  }
  return gains;
}

/// The gains as a model has them.
inline ServoGains<double> servo_gains(const Model& model) {
  return servo_gains<double>(model, [](const char*, double value) { return value; });
}

/// Number of the first sample of a servo at or after an instant of a run; samples are taken at multiples of the
/// period from the run's first row on.
inline long first_sample(double t_s, double period_s) {
  constexpr double rounding = 1e-6;  // of a period: stamps have few digits
  return static_cast<long>(std::max(0.0, std::ceil(t_s / period_s - rounding)));
}

/// How many samples a servo has taken up to an instant of a run, that instant included.
inline long samples_until(double t_s, double period_s) {
  constexpr double rounding = 1e-6;  // of a period
  return std::max(0L, static_cast<long>(std::floor(t_s / period_s + rounding)) + 1);
}

/// Part of the way to the next row's that a target which goes straight there has gone, on average, when a servo takes it:
/// between two samples it holds. 0 where the servo takes one a row or fewer.
/// @param period_s    between the servo's samples, > 0
/// @param interval_s  between two rows
inline double moving_target_share(double period_s, double interval_s) {
  return 0.5 - 0.5 * std::min(1.0, period_s / std::max(interval_s, period_s));
}

/// The command of a servo by the measured motion. It tells the servo's memory where a window starts.
///
/// Fills `inputs.servo_A`, the command that the samples of each row's interval yield on average, and
/// `inputs.servo_integral`, what was accumulated before each row. Motion and targets must be without holes.
inline void replay_servo(const Model& model, Inputs& inputs) {
  const ServoGains<double> gains = servo_gains(model);
  const Eigen::Index rows = inputs.rows();
  inputs.servo_A = inputs.servo_integral = Eigen::VectorXd::Zero(rows);
  for (const RunSpan& run : inputs.runs) {
    double accumulated = 0.0, command = 0.0;
    const double start_s = inputs.t_s[run.begin];
    for (Eigen::Index row = run.begin; row < run.end; ++row) {
      inputs.servo_integral[row] = accumulated;
      const double from_s = inputs.t_s[row] - start_s;
      const double to_s = row + 1 < run.end ? inputs.t_s[row + 1] - start_s : from_s + gains.period_s;
      double sum = 0.0;
      long count = 0;
      const long end = std::max(first_sample(from_s, gains.period_s), first_sample(to_s, gains.period_s));
      for (long k = first_sample(from_s, gains.period_s); k < end; ++k, ++count) {
        const double share =
            std::clamp((static_cast<double>(k) * gains.period_s - from_s) / (to_s - from_s), 0.0, 1.0);
        const Eigen::Index next = std::min(row + 1, run.end - 1);
        const double angle = inputs.seen_deg[row] + share * (inputs.seen_deg[next] - inputs.seen_deg[row]),
                     rate = inputs.seen_dps[row] + share * (inputs.seen_dps[next] - inputs.seen_dps[row]);
        const double target_deg = target_between(inputs, inputs.target_deg, run, row, share),
                     target_dps = target_between(inputs, inputs.target_dps, run, row, share);
        gains.integrate(accumulated, angle, rate, target_deg, target_dps);
        command = gains.after(command, gains.command_A(angle, rate, target_deg, target_dps, accumulated));
        sum += command;
      }
      inputs.servo_A[row] = count > 0 ? sum / static_cast<double>(count) : command;
    }
  }
}

/// A servo under way in a window: samples the simulated motion, and lets each command act when its time has come.
///
/// @snippet plant_examples.cpp bench rollout
/// How to: @ref gap_method, @ref servo_on_a_pendulum.
template <class Scalar>
class ServoLoop {
public:
  /// Keeps references to all arguments.
  /// @param late_s  added to the servo's own delay
  /// @param target_delay_s  by which the target reaches the servo late; null: at once
  ServoLoop(const ServoGains<Scalar>& gains, const Inputs& inputs, const RunSpan& run, const Scalar& late_s,
            const Scalar* target_delay_s = nullptr)
      : gains_(gains),
        inputs_(inputs),
        run_(run),
        start_s_(inputs.t_s[run.begin]),
        delay_s_(gains.delay_s + late_s) {
    if (target_delay_s != nullptr) late_target_.emplace(inputs, run, *target_delay_s, gains.period_s);
  }

  /// Sets out at a row with the memory that the measured motion leaves the servo.
  /// @param seen  true angle in deg and rate in deg/s of measured ones: `seen(row, angle_deg, rate_dps)` as a pair
  template <class Seen>
  void start(Eigen::Index begin, Seen&& seen) {
    const double now_s = inputs_.t_s[begin] - start_s_;
    next_ = first_sample(now_s, gains_.period_s);
    const Scalar not_arrived = late_target_ ? missing_integral(begin) : constant<Scalar>(0.0);
    accumulated_ = inputs_.servo_integral[begin] - not_arrived;
    // Back to the sample whose command acts now; before that of the first one a servo is idle.
    const double acting_s = now_s - value_of(delay_s_);
    const long acting = std::min(next_, samples_until(acting_s, gains_.period_s));
    const long first = std::max(0L, acting - 1);
    Eigen::Index row = begin;
    while (row > run_.begin && inputs_.t_s[row] - start_s_ > static_cast<double>(first) * gains_.period_s)
      --row;
    pending_.clear();
    if (acting == 0) pending_.push_back({constant<Scalar>(0.0), constant<Scalar>(0.0)});
    for (long k = first; k < next_; ++k) {
      const double sample_s = static_cast<double>(k) * gains_.period_s;
      while (row + 1 < run_.end && inputs_.t_s[row + 1] - start_s_ <= sample_s) ++row;
      const Eigen::Index after = std::min(row + 1, run_.end - 1);
      const double from_s = inputs_.t_s[row] - start_s_, length_s = inputs_.t_s[after] - inputs_.t_s[row];
      const double share = length_s > 0.0 ? std::clamp((sample_s - from_s) / length_s, 0.0, 1.0) : 0.0;
      const std::pair<Scalar, Scalar> was =
          seen(row, inputs_.seen_deg[row] + share * (inputs_.seen_deg[after] - inputs_.seen_deg[row]),
               inputs_.seen_dps[row] + share * (inputs_.seen_dps[after] - inputs_.seen_dps[row]));
      const Scalar accumulated = inputs_.servo_integral[after] - not_arrived;
      const Scalar before = !pending_.empty() ? pending_.back().command_A
                                              : constant<Scalar>(k > 0 ? inputs_.servo_A[row] : 0.0);
      with_targets(row, share, [&](const auto& target_deg, const auto& target_dps) {
        pending_.push_back(
            {delay_s_ + sample_s, gains_.after(before, gains_.command_A(was.first, was.second, target_deg,
                                                                        target_dps, accumulated))});
      });
    }
  }

  /// The command that acts.
  const Scalar& command_A() const { return pending_.front().command_A; }

  /// Takes the sample that is due at a row, and lets the command act that is: what command_A() is from then on.
  /// @param sense  as interval() has it
  template <class Sense>
  void arrive(Eigen::Index row, double at_s, Sense&& sense) {
    if (samples_until(at_s, gains_.period_s) > next_) sample(row, 0.0, sense());
    const double rounding_s = 1e-6 * gains_.period_s;  // stamps have few digits
    while (pending_.size() > 1 && value_of(pending_[1].from_s) <= at_s + rounding_s)
      pending_.erase(pending_.begin());
  }

  /// Goes through the interval from a row to the next one.
  /// @param sense    the motion as the servo sees it: a pair of angle in deg and rate in deg/s
  /// @param advance  moves the axis: `advance(t_s, length_s)` under command_A()
  template <class Sense, class Advance>
  void interval(Eigen::Index row, double from_s, double to_s, Sense&& sense, Advance&& advance) {
    Scalar now_s = constant<Scalar>(from_s);
    const long end = std::max(next_, first_sample(to_s, gains_.period_s));
    for (;;) {
      const double sample_s = next_ < end ? static_cast<double>(next_) * gains_.period_s : 1e300;
      const double switch_s = pending_.size() > 1 ? value_of(pending_[1].from_s) : 1e300;
      if (switch_s <= sample_s && switch_s < to_s) {
        if (switch_s > value_of(now_s)) {
          advance(value_of(now_s), Scalar(pending_[1].from_s - now_s));
          now_s = pending_[1].from_s;
        }
        pending_.erase(pending_.begin());
        continue;
      }
      if (sample_s < 1e300) {
        if (sample_s > value_of(now_s)) {
          advance(value_of(now_s), Scalar(sample_s - now_s));
          now_s = constant<Scalar>(sample_s);
        }
        sample(row, std::clamp((sample_s - from_s) / (to_s - from_s), 0.0, 1.0), sense());
        continue;
      }
      break;
    }
    if (to_s > value_of(now_s)) advance(value_of(now_s), Scalar(to_s - now_s));
  }

private:
  /// A command and the instant at which it begins to act, since the start of the run.
  struct Pending {
    Scalar from_s, command_A;
  };

  /// Takes the next sample, a part of the way from a row to the next one. @param seen  angle in deg and rate in deg/s
  void sample(Eigen::Index row, double part, const std::pair<Scalar, Scalar>& seen) {
    const double sample_s = static_cast<double>(next_++) * gains_.period_s;
    with_targets(row, part, [&](const auto& target_deg, const auto& target_dps) {
      gains_.integrate(accumulated_, seen.first, seen.second, target_deg, target_dps);
      pending_.push_back(
          {delay_s_ + sample_s,
           gains_.after(pending_.back().command_A,
                        gains_.command_A(seen.first, seen.second, target_deg, target_dps, accumulated_))});
    });
  }

  /// Hands on the targets, in degrees and in degrees per second, that the servo has a part of the way from a row to the next.
  template <class Use>
  void with_targets(Eigen::Index row, double part, Use&& use) const {
    if (late_target_)
      use((*late_target_)(inputs_.target_deg, row, part), (*late_target_)(inputs_.target_dps, row, part));
    else
      use(target_between(inputs_, inputs_.target_deg, run_, row, part),
          target_between(inputs_, inputs_.target_dps, run_, row, part));
  }

  /// The lack of the servo's integral at a row, by the part of the target that has not arrived.
  Scalar missing_integral(Eigen::Index row) const {
    if (!(std::abs(value_of(gains_.integral)) > 0.0)) return constant<Scalar>(0.0);
    return late_target_->missing_integral(gains_.position ? inputs_.target_deg : inputs_.target_dps, row);
  }

  const ServoGains<Scalar>& gains_;
  const Inputs& inputs_;
  const RunSpan& run_;
  double start_s_;
  Scalar delay_s_;
  std::optional<LateTarget<Scalar>> late_target_;
  Scalar accumulated_ = constant<Scalar>(0.0);
  long next_ = 0;
  std::vector<Pending> pending_;  ///< the first acts
};

}  // namespace thermopower::plant
