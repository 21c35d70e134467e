// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_rollout.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/film.hpp>
#include <thermopower/plant/free_play.hpp>
#include <thermopower/plant/piecewise_linear.hpp>
#include <thermopower/plant/samples.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// @file axis_at_rows.hpp
/// The rows of an axis with the terms of its equation: for the balances of axis_balances.hpp.

namespace thermopower::plant {

/// Twist of a spring between two inertias, and its rate, while the near one moves as measured:
/// q'' = -rate' - w^2 q - 2 z w q', with q of the far side relative to the near one.
///
/// How the whole works: @ref gap_method.
struct SpringTwist {
  Eigen::VectorXd angle_rad;        ///< q
  Eigen::VectorXd rate_rad_per_s;   ///< q'
  Eigen::VectorXd pull_rad_per_s2;  ///< w^2 q + 2 z w q', where there is no free play

  /// @param rate        of the near side, rad/s, without holes
  /// @param w_rad_per_s natural frequency of the far side on the spring, > 0
  /// @param damping     its damping ratio, >= 0
  /// @param gap_rad     free play of the spring; 0: none
  SpringTwist(const Eigen::VectorXd& rate, const BalanceRows& rows, double w_rad_per_s, double damping,
              double gap_rad = 0.0)
      : angle_rad(rate.size()), rate_rad_per_s(rate.size()), pull_rad_per_s2(rate.size()) {
    const double w = w_rad_per_s;
    const FreePlay<double> play{gap_rad, w * w, 2.0 * damping * w};
    const auto pulled = [&](double q, double v) {
      return gap_rad > 0.0 ? play.torque(play.touching(q, v), q, v) : w * w * q + 2.0 * damping * w * v;
    };
    // Without free play the motion over an interval is linear in its start and in the torques. Three solutions tell it, for
    // all equal intervals.
    constexpr double alike = 1e-9;
    double step = 0.0;
    Motion by_angle, by_rate, by_pull;
    for (const RunSpan& run : rows.runs) {
      Motion at;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        angle_rad[i] = at.q;
        rate_rad_per_s[i] = at.v;
        pull_rad_per_s2[i] = pulled(at.q, at.v);
        if (i + 1 == run.end) break;
        const double step_s = rows.t_s[i + 1] - rows.t_s[i], pull = -(rate[i + 1] - rate[i]) / step_s;
        if (gap_rad > 0.0) {
          at = moved(at, pull, w, step_s, pulled);
          continue;
        }
        if (std::abs(step_s - step) > alike * step) {
          step = step_s;
          by_angle = moved({1.0, 0.0}, 0.0, w, step, pulled);
          by_rate = moved({0.0, 1.0}, 0.0, w, step, pulled);
          by_pull = moved({0.0, 0.0}, 1.0, w, step, pulled);
        }
        at = {at.q * by_angle.q + at.v * by_rate.q + pull * by_pull.q,
              at.q * by_angle.v + at.v * by_rate.v + pull * by_pull.v};
      }
    }
  }

private:
  struct Motion {
    double q = 0.0, v = 0.0;
  };

  /// Where it is after an interval, by the midpoint rule.
  template <class Pulled>
  static Motion moved(Motion at, double pull, double w_rad_per_s, double step_s, const Pulled& pulled) {
    constexpr double longest_rad = 0.15;  // of the oscillation in a step of the rule
    const int parts = std::max(1, static_cast<int>(std::ceil(w_rad_per_s * step_s / longest_rad)));
    const double h = step_s / parts;
    for (int p = 0; p < parts; ++p) {
      const double k1 = pull - pulled(at.q, at.v);
      const double q2 = at.q + 0.5 * h * at.v, v2 = at.v + 0.5 * h * k1;
      at.q += h * v2;
      at.v += h * (pull - pulled(q2, v2));
    }
    return at;
  }
};

/// The rows of an axis and the terms of its equation, at the measured motion.
///
/// How the whole works: @ref gap_method.
class AxisAtRows {
public:
  /// The quantities that a balance needs of each row.
  struct Values {
    double inertia_kgm2 = 0.0;  ///< that moves with the instruments
    Eigen::VectorXd motion_Nm;  ///< torques of the motion: viscous, load, dry friction, spring, back-EMF
    Eigen::VectorXd drive_Nm;   ///< torque of the drive, of a motor at a voltage at standstill; held
  };

  /// Keeps references to model, catalogue and inputs: they must outlive this object.
  AxisAtRows(const Model& model, const Catalogue& catalogue, const Inputs& inputs,
             const ReadingOffsets& offsets)
      : model_(model), catalogue_(catalogue), inputs_(inputs) {
    rows_ = std::make_shared<BalanceRows>(
        BalanceRows{inputs.t_s, inputs.runs, median_interval_s(inputs.t_s, inputs.runs)});
    measure(offsets);
  }

  /// The equation with the constants multiplied by `factors` (as many as Model::calibrated(), or none).
  Values evaluate(const std::vector<double>& factors = {}) const {
    const Instance<double> instance(model_, factors, {}, catalogue_);
    const AxisRollout<double> rollout(instance, inputs_);
    const auto& shape = instance.axis_structure;
    Values v;
    v.inertia_kgm2 = instance.inertia_kgm2 * (shape.compliant ? 1.0 - shape.far_share : 1.0);
    v.motion_Nm = v.drive_Nm = Eigen::VectorXd::Zero(rate.size());
    const double rest_rad_per_s = 4.0 * rate_noise;
    for (const RunSpan& run : inputs_.runs) {
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        const double t_s = inputs_.t_s[i] - inputs_.t_s[run.begin];
        const AxisDrive<double> drive =
            inputs_.effort_is_output
                ? rollout.driven_by(held_effort_A(i, run, instance.servo.period_s), i, t_s)
            : inputs_.closed_loop ? rollout.drive(rollout.servo_A(i, run), i, t_s)
                                  : rollout.drive(i, run, i, t_s);
        const double drive_Nm = drive.torque_Nm;
        const auto now = rollout.step().torques({angle[i], rate[i], 0.0, 0.0}, t_s, drive);
        // A transition that the noise of the rate hides is as good as none.
        const bool sticks =
            now.transition_rad_per_s <= std::max(friction_sticks_below_rad_per_s, rest_rad_per_s);
        const bool rests = std::fabs(rate[i]) < rest_rad_per_s &&
                           (i == run.begin || std::fabs(rate[i - 1]) < rest_rad_per_s) &&
                           (i + 1 == run.end || std::fabs(rate[i + 1]) < rest_rad_per_s);
        double friction_Nm = 0.0;
        if (sticks && rests) {
          // At rest dry friction takes whatever the other torques give, up to its size.
          friction_Nm = std::clamp(now.torque_Nm, -now.backward_Nm, now.forward_Nm);
        } else if (sticks) {
          const double forward = forward_share(i, run);
          friction_Nm = forward * now.forward_Nm - (1.0 - forward) * now.backward_Nm;
        } else {
          friction_Nm = (rate[i] >= 0.0 ? now.forward_Nm : now.backward_Nm) *
                        film_share(rate[i] / std::max(now.transition_rad_per_s, 1e-12), now.tail);
        }
        v.drive_Nm[i] = drive_Nm;
        v.motion_Nm[i] = now.torque_Nm - drive_Nm - drive.external_Nm - friction_Nm;
      }
    }
    if (shape.compliant) {
      const double w = shape.spring_rad_per_s * std::sqrt(1.0 - shape.far_share);
      const double reduced = v.inertia_kgm2 * shape.far_share;
      const SpringTwist twist(rate, *rows_, w, shape.spring_damping * std::sqrt(1.0 - shape.far_share),
                              shape.gapped ? shape.gap_rad : 0.0);
      v.motion_Nm += reduced / (1.0 - shape.far_share) * twist.pull_rad_per_s2;
    }
    return v;
  }

  /// From command to torque in s, as the model's effects delay it.
  double delay_s() const {
    if (inputs_.effort_is_output) return 0.0;  // what flows has come
    const Instance<double> instance(model_, {}, {}, catalogue_);
    return (instance.axis_structure.delayed ? instance.axis_structure.delay_s : 0.0) +
           (inputs_.closed_loop ? instance.servo.delay_s : 0.0);
  }

  /// Places in Model::calibrated() of the constants of an axis that calibration may move.
  std::vector<std::size_t> constants() const {
    std::vector<std::size_t> list;
    const std::vector<CalibratedConstant> all = model_.calibrated();
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool acts = all[k].block == "axis" ||
                        (all[k].block == "servo" && inputs_.closed_loop && !inputs_.effort_is_output);
      if (all[k].has_slack && acts) list.push_back(k);
    }
    return list;
  }

  /// The change by one more of a constant's logarithm, or of a place's value.
  /// @param constant  its place in Model::calibrated()
  Values slopes(std::size_t constant) const {
    constexpr double step = 1e-4;  // of the logarithm: central differences are then exact to eight digits
    Values result = evaluate(model_.moved(constant, step));
    const Values down = evaluate(model_.moved(constant, -step));
    result.inertia_kgm2 = (result.inertia_kgm2 - down.inertia_kgm2) * (0.5 / step);
    result.motion_Nm = (result.motion_Nm - down.motion_Nm) * (0.5 / step);
    result.drive_Nm = (result.drive_Nm - down.drive_Nm) * (0.5 / step);
    return result;
  }

  /// The current that the servo makes flow by the measured motion, where the effort is an output. A
  /// @param factors  by which the constants are multiplied, as evaluate() has them
  Eigen::VectorXd servo_current_A(const std::vector<double>& factors = {}) const {
    const Instance<double> instance(model_, factors, {}, catalogue_);
    const AxisRollout<double> rollout(instance, inputs_);
    const double late_s =
        instance.servo.delay_s + (instance.axis_structure.delayed ? instance.axis_structure.delay_s : 0.0);
    Eigen::VectorXd current(inputs_.rows());
    for (const RunSpan& run : inputs_.runs)
      for (Eigen::Index i = run.begin; i < run.end; ++i)
        current[i] = rollout.measured_servo_A(i, run, late_s);
    return current;
  }

  Eigen::VectorXd angle;      ///< true one by the model's readings, rad, without holes
  Eigen::VectorXd rate;       ///< true one by the model's readings, rad/s, without holes
  Eigen::VectorXd raw_angle;  ///< the angle with its holes
  Eigen::VectorXd raw_rate;   ///< the rate with its holes; of an angle alone, its slopes
  double rate_noise = 0.0;    ///< rad/s
  bool has_rate = false;      ///< a gyroscope is judged
  bool has_angle = false;     ///< an angle is judged

  /// The rows.
  const std::shared_ptr<const BalanceRows>& rows() const { return rows_; }
  /// The inputs given.
  const Inputs& inputs() const { return inputs_; }
  /// The model given.
  const Model& model() const { return model_; }
  /// The column that commands the axis; of a closed loop, what the servo makes of its target.
  std::string command_name() const {
    if (inputs_.effort_is_output) return "current_A";
    return inputs_.closed_loop ? "servo_A" : model_.axis->voltage_driven() ? "voltage_V" : "drive_A";
  }
  /// Its values.
  const Eigen::VectorXd& command() const {
    if (inputs_.effort_is_output) return inputs_.drive_A;
    return inputs_.closed_loop ? inputs_.servo_A : plant::command(inputs_, model_.axis->voltage_driven());
  }

private:
  /// Mean of the measured current until the next row, where the servo changes it in between. @param period_s  of the servo
  double held_effort_A(Eigen::Index i, const RunSpan& run, double period_s) const {
    const double here_A = inputs_.drive_A[i];
    if (i + 1 >= run.end) return here_A;
    const double between = plant::moving_target_share(period_s, inputs_.t_s[i + 1] - inputs_.t_s[i]);
    return here_A + between * (inputs_.drive_A[i + 1] - here_A);
  }

  /// Share of the time around a row, half an interval each way, in which the rate is positive; it is straight
  /// between rows.
  double forward_share(Eigen::Index i, const RunSpan& run) const {
    const auto half = [&](double here, double next) {
      const double there = 0.5 * (here + next);
      if (here >= 0.0 && there >= 0.0) return 1.0;
      if (here <= 0.0 && there <= 0.0) return 0.0;
      const double before = std::fabs(here) / (std::fabs(here) + std::fabs(there));
      return here > 0.0 ? before : 1.0 - before;
    };
    const double here = rate[i];
    return 0.5 * (half(here, i > run.begin ? rate[i - 1] : here) +
                  half(here, i + 1 < run.end ? rate[i + 1] : here));
  }

  void measure(const ReadingOffsets& offsets) {
    const Eigen::Index n = inputs_.rows();
    has_rate = inputs_.judged(Signal::rate_dps);
    has_angle = inputs_.judged(Signal::angle_deg);
    const Instance<double> instance(model_, {}, {}, catalogue_);
    const AxisRollout<double> rollout(instance, inputs_);
    raw_angle = raw_rate = Eigen::VectorXd::Constant(n, missing);
    for (const RunSpan& run : inputs_.runs)
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        const double shown_deg =
            has_angle ? inputs_.of(Signal::angle_deg)[i] - offsets[Signal::angle_deg] : missing;
        const double shown_dps =
            has_rate ? inputs_.of(Signal::rate_dps)[i] - offsets[Signal::rate_dps] : missing;
        const auto state = rollout.start(i, inputs_.t_s[run.begin], shown_deg, shown_dps);
        raw_angle[i] = state.angle_rad;
        raw_rate[i] = state.rate_rad_per_s;
      }
    if (!has_rate) {  // slopes over four intervals
      for (const RunSpan& run : inputs_.runs)
        for (Eigen::Index i = run.begin + 2; i + 2 < run.end; ++i)
          raw_rate[i] =
              (2.0 * (raw_angle[i + 2] - raw_angle[i - 2]) + (raw_angle[i + 1] - raw_angle[i - 1])) /
              (2.0 * (inputs_.t_s[i + 2] - inputs_.t_s[i - 2]) + (inputs_.t_s[i + 1] - inputs_.t_s[i - 1]));
      rate_noise = sample_noise(raw_angle, inputs_.runs) * slope_noise_per_angle();
    } else {
      rate_noise = sample_noise(raw_rate, inputs_.runs);
    }
    angle =
        has_angle ? without_holes(raw_angle, inputs_.runs, 0.0) : Eigen::VectorXd(Eigen::VectorXd::Zero(n));
    rate = without_holes(raw_rate, inputs_.runs, 0.0);
  }

public:
  /// Noise of a slope over four intervals per noise of the angle, 1/s: sqrt(10) / 10 intervals.
  double slope_noise_per_angle() const { return 1.0 / (3.2 * rows_->interval_s); }

private:
  const Model& model_;
  const Catalogue& catalogue_;
  const Inputs& inputs_;
  std::shared_ptr<const BalanceRows> rows_;
};

}  // namespace thermopower::plant
