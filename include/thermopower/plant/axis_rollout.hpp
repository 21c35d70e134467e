// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_step.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/servo_loop.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// The column that commands an axis: `voltage_V` of a motor at a voltage, else `drive_A`.
inline const Eigen::VectorXd& command(const Inputs& inputs, bool voltage_driven) {
  return voltage_driven ? inputs.voltage_V : inputs.drive_A;
}

/// Simulates angle and rate of one axis over the rows of a window.
///
/// @snippet plant_examples.cpp bench rollout
/// How to: @ref gap_method.
template <class Scalar>
class AxisRollout {
public:
  /// Keeps references to both arguments: they must outlive this object.
  AxisRollout(const Instance<Scalar>& instance, const Inputs& inputs)
      : instance_(instance), inputs_(inputs), step_(instance) {}

  /// The state in which the readings at `row` are these; the spring is relaxed. A reading must grow with what it is of.
  AxisState<Scalar> start(Eigen::Index row, double run_start_s, double angle_deg, double rate_dps) const {
    // Most readings are affine in the state: two evaluations invert them.
    const double t_s = inputs_.t_s[row] - run_start_s;
    const AxisReadings<Scalar> at_0 = read(t_s, constant<Scalar>(0.0), constant<Scalar>(0.0));
    const AxisReadings<Scalar> at_1 = read(t_s, constant<Scalar>(1.0), constant<Scalar>(1.0));
    const Scalar zero = constant<Scalar>(0.0);
    AxisState<Scalar> state{zero, zero, zero, zero, {}};
    state.angle_rad = (angle_deg - at_0.angle_deg) / (at_1.angle_deg - at_0.angle_deg) * rad_per_deg;
    state.rate_rad_per_s = (rate_dps - at_0.rate_dps) / (at_1.rate_dps - at_0.rate_dps) * rad_per_deg;
    approach(t_s, angle_deg, state);
    return state;
  }

  /// Simulates the rows [begin, end) of `run` from `state` at `begin` and hands the readings of each row to
  /// `sink(row, readings)`. Leaves the state at row `end` where the run goes on, else at its last row.
  template <class Sink>
  void window(const RunSpan& run, Eigen::Index begin, Eigen::Index end, AxisState<Scalar>& state,
              Sink&& sink) const {
    const double start_s = inputs_.t_s[run.begin];
    if (inputs_.closed_loop) {
      closed_loop(run, begin, end, state, sink);
      return;
    }
    const double delay_s =
        instance_.axis_structure.delayed ? value_of(instance_.axis_structure.delay_s) : 0.0;
    Eigen::Index commanded = arrived(begin, run, delay_s);
    bring_about(run, begin, state, [&](Eigen::Index place, Eigen::Index row, double t_s) {
      return drive(arrived(place + 1, run, delay_s) - 1, run, row, t_s);
    });
    for (Eigen::Index row = begin; row < end; ++row) {
      const double t_s = inputs_.t_s[row] - start_s;
      sink(row, read(t_s, Scalar(state.angle_rad * deg_per_rad), Scalar(state.rate_rad_per_s * deg_per_rad)));
      if (row + 1 < run.end)
        interval(row, t_s, inputs_.t_s[row + 1] - start_s, start_s, commanded, run, state);
    }
  }

  /// The current that flows at the row that window() handed on last, where the effort is an output; else NaN. A
  const Scalar& effort_A() const { return effort_A_; }

  /// The drive at a row, from a command of the run (of none where that lies before it).
  /// @param commanded  row of the command
  AxisDrive<Scalar> drive(Eigen::Index commanded, const RunSpan& run, Eigen::Index row, double t_s) const {
    const Eigen::Index first = run.begin;
    const double value = commanded >= first ? commanded_value(commanded)
                         : run.was_driven   ? commanded_value(first)
                                            : 0.0;
    if (instance_.voltage_driven) return drive(Scalar(value / instance_.motor_ohm), row, t_s);
    return drive(constant<Scalar>(value), row, t_s);
  }

  /// The drive at a row under a command in A; of a motor at a voltage, the current at standstill.
  AxisDrive<Scalar> drive(const Scalar& command_A, Eigen::Index row, double t_s) const {
    const DriveTerms<Scalar> terms = drive_terms(command_A, row, t_s);
    return driven(terms, terms.drive_A, row);
  }

  /// The drive at a row under a measured current: what the drive's effects do to a current is in it.
  AxisDrive<Scalar> driven_by(double measured_A, Eigen::Index row, double t_s) const {
    const Scalar flows_A = constant<Scalar>(measured_A);
    return driven(drive_terms(flows_A, row, t_s), flows_A, row);
  }

  /// The current that flows under a command, after the drive's effects: what an ammeter shows. A
  Scalar current_A(const Scalar& command_A, Eigen::Index row, double t_s) const {
    return drive_terms(command_A, row, t_s).drive_A;
  }

  /// The current that the servo's command by the measured motion makes flow when a row is read, its delay included. A
  /// @param late_s  of the servo's commands
  double measured_servo_A(Eigen::Index row, const RunSpan& run, double late_s) const {
    const double then_s = inputs_.t_s[row] - late_s;
    Eigen::Index at = row;
    while (at > run.begin && inputs_.t_s[at] > then_s) --at;
    const double here_A = measured_sample_A(at, at, run);
    const double length_s = at + 1 < run.end ? inputs_.t_s[at + 1] - inputs_.t_s[at] : 0.0,
                 past_s = then_s - inputs_.t_s[at];
    const bool samples_between = instance_.servo.period_s < several_samples * length_s;
    const double part = samples_between && past_s > 0.0 ? past_s / length_s : 0.0;
    const double command_A =
        part > 0.0 ? here_A + part * (measured_sample_A(at + 1, at + 1, run) - here_A) : here_A;
    return value_of(current_A(constant<Scalar>(command_A), row, inputs_.t_s[row] - inputs_.t_s[run.begin]));
  }

  /// The servo's command by the motion measured around a row, without its delay.
  double servo_A(Eigen::Index row, const RunSpan& run) const {
    const auto at = [&](Eigen::Index i) { return measured_sample_A(row, i, run); };
    if (row + 1 >= run.end) return at(row);
    const double from_s = inputs_.t_s[row] - inputs_.t_s[run.begin],
                 to_s = inputs_.t_s[row + 1] - inputs_.t_s[run.begin], period_s = instance_.servo.period_s;
    // Of several samples in an interval the mean; of none the one before.
    if (period_s < several_samples * (to_s - from_s)) return 0.5 * (at(row) + at(row + 1));
    const long sample = std::max(0L, first_sample(to_s, period_s) - 1);
    while (row > run.begin &&
           inputs_.t_s[row] - inputs_.t_s[run.begin] > (static_cast<double>(sample) + 0.5) * period_s)
      --row;
    return at(row);
  }

  /// The equations of motion.
  const AxisStep<Scalar>& step() const { return step_; }

private:
  /// Share of an interval between rows below which a servo's period leaves room for several samples.
  static constexpr double several_samples = 0.7;

  DriveTerms<Scalar> drive_terms(const Scalar& command_A, Eigen::Index row, double t_s) const {
    DriveTerms<Scalar> terms;
    terms.t_s = t_s;
    terms.motor_C = inputs_.covariate_motor_C.size() > 0 ? inputs_.covariate_motor_C[row] : missing;
    terms.drive_A = command_A;
    terms.torque_constant_Nm_per_A = instance_.torque_constant_Nm_per_A;
    for (const auto& effect : instance_.drive) effect(terms);
    return terms;
  }

  /// The drive at a row. @param current_A  that flows
  AxisDrive<Scalar> driven(const DriveTerms<Scalar>& terms, const Scalar& current_A, Eigen::Index row) const {
    const double external_Nm = inputs_.torque_Nm.size() > 0 ? inputs_.torque_Nm[row] : 0.0;
    AxisDrive<Scalar> drive{Scalar(terms.torque_constant_Nm_per_A * current_A), terms.motor_C, external_Nm};
    if (instance_.voltage_driven)
      drive.back_Nms_per_rad =
          terms.torque_constant_Nm_per_A * terms.torque_constant_Nm_per_A / instance_.motor_ohm;
    return drive;
  }

  /// The servo's command by the motion measured at row `i`, which is `row` or the next one, as the target of `row` goes on.
  double measured_sample_A(Eigen::Index row, Eigen::Index i, const RunSpan& run) const {
    const auto& shape = instance_.axis_structure;
    const LateTarget<double> late(inputs_, run, shape.target_delayed ? value_of(shape.target_delay_s) : 0.0,
                                  instance_.servo.period_s);
    const double part = i > row ? 1.0 : 0.0;
    const auto [angle_deg, rate_dps] = seen(i, run, inputs_.seen_deg[i], inputs_.seen_dps[i]);
    double accumulated = inputs_.servo_integral[std::min(i + 1, run.end - 1)];
    if (shape.target_delayed && std::abs(value_of(instance_.servo.integral)) > 0.0)
      accumulated -= late.missing_integral(instance_.servo.position ? inputs_.target_deg : inputs_.target_dps,
                                           std::min(i, run.end - 1));
    return value_of(instance_.servo.command_A(angle_deg, rate_dps, late(inputs_.target_deg, row, part),
                                              late(inputs_.target_dps, row, part),
                                              constant<Scalar>(accumulated)));
  }

  /// True angle in deg and rate in deg/s behind readings at a row.
  std::pair<Scalar, Scalar> seen(Eigen::Index row, const RunSpan& run, double angle_deg,
                                 double rate_dps) const {
    const AxisState<Scalar> state = start(row, inputs_.t_s[run.begin], angle_deg, rate_dps);
    return {Scalar(state.angle_rad * deg_per_rad), Scalar(state.rate_rad_per_s * deg_per_rad)};
  }

  /// Newton's steps to the angle whose reading is the measured one, for readings that bend.
  void approach(double t_s, double angle_deg, AxisState<Scalar>& state) const {
    constexpr double near_deg = 1e-9, apart_deg = 1e-4;
    bool there = instance_.axis_readings.empty();
    for (int step = 0; step < 12 && !there; ++step) {
      const Scalar at_deg = state.angle_rad * deg_per_rad, rate_dps = constant<Scalar>(0.0);
      const AxisReadings<Scalar> here = read(t_s, at_deg, rate_dps);
      const double off_deg = value_of(here.angle_deg) - angle_deg;
      if (step == 0 && std::abs(off_deg) < near_deg) return;
      there = std::abs(off_deg) < near_deg;  // one step more, for the derivatives
      const AxisReadings<Scalar> beside = read(t_s, Scalar(at_deg + apart_deg), rate_dps);
      const double slope = (value_of(beside.angle_deg) - value_of(here.angle_deg)) / apart_deg;
      if (!(std::abs(slope) > near_deg)) return;
      state.angle_rad -= (here.angle_deg - angle_deg) * (rad_per_deg / slope);
    }
  }

  AxisReadings<Scalar> read(double t_s, const Scalar& angle_deg, const Scalar& rate_dps) const {
    AxisReadings<Scalar> readings{t_s, angle_deg, rate_dps};
    for (const auto& effect : instance_.axis_readings) effect(readings);
    return readings;
  }

  /// The same as window() with a servo in the loop.
  template <class Sink>
  void closed_loop(const RunSpan& run, Eigen::Index begin, Eigen::Index end, AxisState<Scalar>& state,
                   Sink&& sink) const {
    const double start_s = inputs_.t_s[run.begin];
    const auto& shape = instance_.axis_structure;
    ServoLoop<Scalar> servo(instance_.servo, inputs_, run,
                            shape.delayed ? shape.delay_s : constant<Scalar>(0.0),
                            shape.target_delayed ? &shape.target_delay_s : nullptr);
    servo.start(begin, [&](Eigen::Index row, double angle_deg, double rate_dps) {
      return seen(row, run, angle_deg, rate_dps);
    });
    bring_about(run, begin, state, [&](Eigen::Index place, Eigen::Index row, double t_s) {
      if (place + 1 == begin) return drive(servo.command_A(), row, t_s);
      return drive(constant<Scalar>(servo_A(row, run)), row, t_s);
    });
    const auto sense = [&] {
      return std::pair<Scalar, Scalar>(state.angle_rad * deg_per_rad, state.rate_rad_per_s * deg_per_rad);
    };
    for (Eigen::Index row = begin; row < end; ++row) {
      const double t_s = inputs_.t_s[row] - start_s;
      const auto [angle_deg, rate_dps] = sense();
      if (inputs_.effort_is_output) {
        servo.arrive(row, t_s, sense);
        effort_A_ = current_A(servo.command_A(), row, t_s);
      }
      sink(row, read(t_s, angle_deg, rate_dps));
      if (row + 1 < run.end)
        servo.interval(row, t_s, inputs_.t_s[row + 1] - start_s, sense,
                       [&](double now_s, const Scalar& length_s) {
                         step_.advance(state, now_s, length_s, drive(servo.command_A(), row, now_s));
                       });
    }
  }

  /// Brings about the effects' own states at a row into which no window carries them. Before its first row a run is idle;
  /// the commands since then act for as long as they did, and the motion is as it is now. Where the first row is long
  /// ago the last command alone tells.
  /// @param before  the drive in force when the command at a place among all ends: `before(place, row, t_s)`
  template <class Before>
  void bring_about(const RunSpan& run, Eigen::Index begin, AxisState<Scalar>& state, Before&& before) const {
    if (state.own.count == instance_.own_states) return;
    const double start_s = inputs_.t_s[run.begin], now_s = inputs_.t_s[begin] - start_s;
    if (now_s > AxisStep<Scalar>::settled_for_s) {
      step_.settle(state, now_s, before(begin - 1, begin, now_s));
      return;
    }
    step_.settle(state, 0.0, drive(run.begin - 1, run, run.begin, 0.0));
    for (Eigen::Index row = run.begin; row < begin; ++row) {
      const double t_s = inputs_.t_s[row] - start_s;
      step_.follow(state, t_s, inputs_.t_s[row + 1] - inputs_.t_s[row], before(row, row, t_s));
    }
  }

  /// The command that reaches the drive when that at a place is set; before its first row a run is idle.
  Eigen::Index arrived(Eigen::Index place, const RunSpan& run, double delay_s) const {
    const double now_s = inputs_.t_s[place];
    while (place >= run.begin && inputs_.t_s[place] + delay_s > now_s) --place;
    return place;
  }

  void interval(Eigen::Index row, double from_s, double to_s, double start_s, Eigen::Index& commanded,
                const RunSpan& run, AxisState<Scalar>& state) const {
    if (!instance_.axis_structure.delayed) {
      step_.advance(state, from_s, constant<Scalar>(to_s - from_s), drive(row, run, row, from_s));
      return;
    }
    // The command switches inside the interval, at its stamp plus the delay: any delay acts smoothly.
    const Scalar& delay_s = instance_.axis_structure.delay_s;
    Scalar now_s = constant<Scalar>(from_s);
    while (commanded + 1 < run.end) {
      const Scalar switch_s = delay_s + (inputs_.t_s[commanded + 1] - start_s);
      if (!(value_of(switch_s) < to_s)) break;
      step_.advance(state, value_of(now_s), Scalar(switch_s - now_s),
                    drive(commanded, run, row, value_of(now_s)));
      if (value_of(switch_s) > value_of(now_s)) now_s = switch_s;
      ++commanded;
    }
    step_.advance(state, value_of(now_s), Scalar(to_s - now_s), drive(commanded, run, row, value_of(now_s)));
  }

  double commanded_value(Eigen::Index commanded) const {
    return command(inputs_, instance_.voltage_driven)[commanded];
  }

  const Instance<Scalar>& instance_;
  const Inputs& inputs_;
  AxisStep<Scalar> step_;
  mutable Scalar effort_A_ = constant<Scalar>(missing);  ///< at the row that was handed on last
};

/// When a run under way is known well enough to be judged: states that nobody measures are about what the motion makes of them,
/// and commands from before its first row have arrived. That takes 0.5 s, 1 s where a spring swings on; but no more than half
/// of a run, and a quarter of what is longer. At once where a run begins at rest.
inline double known_from_s(const Inputs& inputs, const RunSpan& run) {
  constexpr double least_s = 0.5, enough_s = 1.0;
  const double begin_s = inputs.t_s[run.begin], length_s = inputs.t_s[run.end - 1] - begin_s;
  if (!run.goes_on) return begin_s;
  return begin_s + std::min(0.5 * length_s, std::clamp(0.25 * length_s, least_s, enough_s));
}

/// Whether a row is before a time, by more than stamps are rounded.
inline bool is_before(const Inputs& inputs, const RunSpan& run, Eigen::Index row, double at_s) {
  return inputs.t_s[row] < at_s - stamp_rounding_s(at_s, inputs.t_s[run.begin]);
}

/// The rows at which windows of `horizon_s` begin in a run; whole runs where the horizon is not positive. One begins where a
/// run under way is known.
inline std::vector<Eigen::Index> window_starts(const Inputs& inputs, const RunSpan& run, double horizon_s) {
  std::vector<Eigen::Index> starts;
  const auto usable = [&](Eigen::Index row) {
    for (Signal signal : {Signal::angle_deg, Signal::rate_dps})
      if (inputs.judged(signal) && !std::isfinite(inputs.start_of(signal, row))) return false;
    return true;
  };
  double next_s = -1e300;
  for (Eigen::Index row = run.begin; row < run.end; ++row) {
    if (is_before(inputs, run, row, next_s) || !usable(row)) continue;
    starts.push_back(row);
    if (!(horizon_s > 0.0) || !std::isfinite(horizon_s)) break;
    const double known_s = known_from_s(inputs, run);
    next_s = inputs.t_s[row] + horizon_s;
    if (is_before(inputs, run, row, known_s)) next_s = std::min(next_s, known_s);
  }
  return starts;
}

}  // namespace thermopower::plant
