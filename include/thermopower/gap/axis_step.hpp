// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/instance.hpp>

#include <cmath>

namespace thermopower::gap {

/// What the axis remembers. The far side is stated relative to the near one: 0 while the spring is relaxed.
template <class Scalar>
struct AxisState {
  Scalar angle_rad, rate_rad_per_s, twist_rad, twist_rate_rad_per_s;
};

/// Integrates the axis under a constant drive, with dry friction by events.
///
/// Between events (a zero crossing of the rate, a break-away) the equations are smooth and the classical
/// Runge-Kutta rule integrates them, halving its step where the acceleration bends. At a crossing the step is
/// cut there: the axis sticks while friction holds the other torques, else it leaves with friction reversed.
/// With an automatic-differentiation scalar the cut's position is differentiated too, so derivatives are
/// exact through reversals.
template <class Scalar>
class AxisStep {
public:
  explicit AxisStep(const Instance<Scalar>& instance) : instance_(instance) {
    const auto& shape = instance.axis_structure;
    near_inertia_kgm2_ = instance.inertia_kgm2;
    if (shape.compliant) {
      near_inertia_kgm2_ = instance.inertia_kgm2 * (1.0 - shape.far_share);
      far_inertia_kgm2_ = instance.inertia_kgm2 * shape.far_share;
      const Scalar reduced = near_inertia_kgm2_ * shape.far_share;
      spring_Nm_per_rad_ = reduced * shape.spring_rad_per_s * shape.spring_rad_per_s;
      damper_Nms_per_rad_ = reduced * shape.spring_rad_per_s * shape.spring_damping * 2.0;
    }
    double fastest = std::abs(value_of(instance.viscous_Nms_per_rad) / value_of(near_inertia_kgm2_));
    if (shape.compliant) fastest = std::fmax(fastest, value_of(shape.spring_rad_per_s));
    longest_s_ = 0.6 / std::fmax(fastest, 1e-9);
  }

  /// Moves the state by `h_s` under the drive torque `drive_Nm`.
  void advance(AxisState<Scalar>& state, double t_s, Scalar h_s, const Scalar& drive_Nm) const {
    const double length = value_of(h_s);
    if (!(length > 0.0)) return;
    const int pieces = static_cast<int>(std::fmin(2000.0, std::ceil(length / longest_s_)));
    for (int i = 0; i < pieces; ++i)
      smooth(state, t_s + length * i / pieces, Scalar(h_s * (1.0 / pieces)), drive_Nm, 6);
  }

private:
  struct Slope {
    Scalar angle, rate, twist, twist_rate;
  };
  struct Balance {
    Scalar torque_Nm, forward_Nm, backward_Nm;
  };

  Balance balance(const AxisState<Scalar>& state, double t_s, const Scalar& drive_Nm) const {
    const Scalar viscous = instance_.viscous_Nms_per_rad * state.rate_rad_per_s;
    if (instance_.axis.empty()) {
      const Scalar zero = constant<Scalar>(0.0);
      return {drive_Nm - viscous, zero, zero};
    }
    AxisTerms<Scalar> terms;
    terms.t_s = t_s;
    terms.angle_rad = state.angle_rad;
    terms.rate_rad_per_s = state.rate_rad_per_s;
    terms.drive_Nm = drive_Nm;
    terms.load_Nm = terms.friction_forward_Nm = terms.friction_backward_Nm = constant<Scalar>(0.0);
    for (const auto& effect : instance_.axis) effect(terms);
    return {drive_Nm + terms.load_Nm - viscous, terms.friction_forward_Nm, terms.friction_backward_Nm};
  }

  Scalar spring(const AxisState<Scalar>& state) const {
    return spring_Nm_per_rad_ * state.twist_rad + damper_Nms_per_rad_ * state.twist_rate_rad_per_s;
  }

  /// @param direction  +1 or -1: which way friction acts against; 0: sticking
  Slope slope(const AxisState<Scalar>& state, double t_s, const Scalar& drive_Nm, int direction) const {
    const bool compliant = instance_.axis_structure.compliant;
    Slope rate;
    const Scalar zero = constant<Scalar>(0.0);
    Scalar spring_Nm = zero;
    if (compliant) spring_Nm = spring(state);
    if (direction == 0) {
      rate.angle = rate.rate = zero;
    } else {
      const Balance now = balance(state, t_s, drive_Nm);
      rate.angle = state.rate_rad_per_s;
      rate.rate = now.torque_Nm;
      if (!instance_.axis.empty()) {
        if (direction > 0) rate.rate -= now.forward_Nm;
        else rate.rate += now.backward_Nm;
      }
      if (compliant) rate.rate += spring_Nm;
      rate.rate /= near_inertia_kgm2_;
    }
    if (compliant) {
      rate.twist = state.twist_rate_rad_per_s;
      rate.twist_rate = -spring_Nm / far_inertia_kgm2_ - rate.rate;
    } else {
      rate.twist = rate.twist_rate = zero;
    }
    return rate;
  }

  AxisState<Scalar> moved(const AxisState<Scalar>& from, const Slope& rate, const Scalar& h_s) const {
    AxisState<Scalar> to = from;
    to.angle_rad += rate.angle * h_s;
    to.rate_rad_per_s += rate.rate * h_s;
    if (instance_.axis_structure.compliant) {
      to.twist_rad += rate.twist * h_s;
      to.twist_rate_rad_per_s += rate.twist_rate * h_s;
    }
    return to;
  }

  /// One Runge-Kutta step; `bend` is how far the acceleration strays from a straight line, as a rate.
  AxisState<Scalar> runge_kutta(const AxisState<Scalar>& from, double t_s, const Scalar& h_s, const Scalar& drive_Nm,
                                int direction, double& bend) const {
    const double h = value_of(h_s);
    const Scalar half_s = h_s * 0.5;
    const Slope k1 = slope(from, t_s, drive_Nm, direction);
    const Slope k2 = slope(moved(from, k1, half_s), t_s + 0.5 * h, drive_Nm, direction);
    const Slope k3 = slope(moved(from, k2, half_s), t_s + 0.5 * h, drive_Nm, direction);
    const Slope k4 = slope(moved(from, k3, h_s), t_s + h, drive_Nm, direction);
    bend = h * std::abs(value_of(k1.rate) - value_of(k2.rate) - value_of(k3.rate) + value_of(k4.rate)) / 6.0;
    Slope mean;
    mean.angle = (k1.angle + 2.0 * (k2.angle + k3.angle) + k4.angle) * (1.0 / 6.0);
    mean.rate = (k1.rate + 2.0 * (k2.rate + k3.rate) + k4.rate) * (1.0 / 6.0);
    if (instance_.axis_structure.compliant) {
      mean.twist = (k1.twist + 2.0 * (k2.twist + k3.twist) + k4.twist) * (1.0 / 6.0);
      mean.twist_rate = (k1.twist_rate + 2.0 * (k2.twist_rate + k3.twist_rate) + k4.twist_rate) * (1.0 / 6.0);
    }
    return moved(from, mean, h_s);
  }

  int direction_of(const AxisState<Scalar>& state, double t_s, const Scalar& drive_Nm) const {
    const double rate = value_of(state.rate_rad_per_s);
    if (rate != 0.0) return rate > 0.0 ? 1 : -1;
    const Balance now = balance(state, t_s, drive_Nm);
    double torque = value_of(now.torque_Nm);
    if (instance_.axis_structure.compliant) torque += value_of(spring(state));
    if (torque > value_of(now.forward_Nm)) return 1;
    if (-torque > value_of(now.backward_Nm)) return -1;
    return 0;
  }

  void smooth(AxisState<Scalar>& state, double t_s, Scalar left_s, const Scalar& drive_Nm, int depth) const {
    constexpr double bend_limit_rad_per_s = 5e-4;
    const bool dry = !instance_.axis.empty();
    for (int event = 0; event < 12; ++event) {
      const int direction = dry ? direction_of(state, t_s, drive_Nm) : 1;
      double bend = 0.0;
      const AxisState<Scalar> reached = runge_kutta(state, t_s, left_s, drive_Nm, direction, bend);
      if (bend > bend_limit_rad_per_s && depth > 0) {
        const Scalar half_s = left_s * 0.5;
        smooth(state, t_s, half_s, drive_Nm, depth - 1);
        smooth(state, t_s + value_of(half_s), half_s, drive_Nm, depth - 1);
        return;
      }
      if (!dry || direction == 0 || value_of(reached.rate_rad_per_s) * direction >= 0.0 || event == 11) {
        state = reached;
        return;
      }
      // The rate crosses zero on the way: find where (linear guess, one Newton step), stop there, go on.
      const double before = value_of(state.rate_rad_per_s), after = value_of(reached.rate_rad_per_s);
      if (before == 0.0) {  // would start and turn back at once: it stays
        state.rate_rad_per_s = constant<Scalar>(0.0);
        state = runge_kutta(state, t_s, left_s, drive_Nm, 0, bend);
        return;
      }
      Scalar cut_s = left_s * (before / (before - after));
      AxisState<Scalar> at_cut = runge_kutta(state, t_s, cut_s, drive_Nm, direction, bend);
      const Slope there = slope(at_cut, t_s, drive_Nm, direction);
      if (value_of(there.rate) * direction < 0.0) {
        const Scalar correction_s = at_cut.rate_rad_per_s / there.rate;
        const double corrected = value_of(cut_s) - value_of(correction_s);
        if (corrected > 0.0 && corrected < value_of(left_s)) {
          cut_s -= correction_s;
          at_cut = runge_kutta(state, t_s, cut_s, drive_Nm, direction, bend);
        }
      }
      at_cut.rate_rad_per_s = constant<Scalar>(0.0);
      state = at_cut;
      t_s += value_of(cut_s);
      left_s -= cut_s;
      if (!(value_of(left_s) > 0.0)) return;
    }
  }

  const Instance<Scalar>& instance_;
  Scalar near_inertia_kgm2_, far_inertia_kgm2_, spring_Nm_per_rad_, damper_Nms_per_rad_;
  double longest_s_ = 1e9;
};

}  // namespace thermopower::gap
