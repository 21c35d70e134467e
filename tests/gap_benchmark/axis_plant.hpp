// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace gap_benchmark {

/// Every number an axis can have; an effect is off at zero (gains: at one).
enum AxisParameter : int {
  // what the simulation under test knows
  inertia,
  viscous,
  torque_constant,
  // friction
  coulomb_Nm,
  asymmetry,
  stick_ratio,
  stribeck_dps,
  stribeck_exponent,
  load_share,
  gear_forward,
  gear_backward,
  film_dps,
  forward_Nms,   ///< viscous friction besides, while the rate is positive, N m s/rad
  backward_Nms,  ///< and while it is negative
  thinning_per_K,
  drag_Nm_per_dps2,
  // drive
  deadband_A,
  delay_s,
  target_delay_s,  ///< from the log's target to the servo that takes it
  torque_limit_Nm,
  fade_per_K,
  lag_s,
  ripple_sin,
  ripple_cos,
  ripple_count,
  // what depends on the angle
  unbalance_sin_Nm,
  unbalance_cos_Nm,
  cable_Nm_per_rad,
  cable_Nm,
  weight_Nm,  ///< on a pulley: the same at every angle
  cogging_sin_Nm,
  cogging_cos_Nm,
  cogging_count,
  cogging_second,
  cogging_second_phase,
  // a spring between motor and load
  far_share,
  spring_Hz,
  spring_damping,
  gap_deg,
  // friction that bends before it slides
  bristle_Nm,
  bristle_deg,
  // sensors
  angle_gain,
  angle_drift_dps,
  rate_bias_dps,
  eccentric_deg,
  eccentric_count,
  // effects that have no name in the catalogue
  notch_Nm,
  notch_deg,
  notch_width_deg,
  run_out_share,
  run_out_count,
  clutch_Nm,
  clutch_dps,
  warming_share,
  warming_s,
  brake_share,
  hardening_Nm_per_rad3,
  stop_deg,
  stop_Nm_per_rad,
  axis_parameter_count
};

using AxisParameters = std::array<double, axis_parameter_count>;

inline AxisParameters axis_defaults() {
  AxisParameters p{};
  p[stribeck_dps] = 10.0;
  p[stribeck_exponent] = 2.0;
  p[cogging_count] = p[ripple_count] = 12.0;
  p[spring_Hz] = 10.0;
  p[spring_damping] = 0.05;
  p[angle_gain] = 1.0;
  p[gear_forward] = p[gear_backward] = 1.0;
  p[notch_width_deg] = p[bristle_deg] = p[warming_s] = p[run_out_count] = p[clutch_dps] = 1.0;
  return p;
}

constexpr double degrees_per_radian = 57.295779513082323;
constexpr double fade_reference_C = 25.0;  ///< of a magnet and of a grease

struct AxisInput {
  double drive_A = 0.0, motor_C = fade_reference_C;
  double hidden_Nm = 0.0, hidden_wear = 1.0;  ///< disturbances that no column shows
};

/// Motor side and far side of the spring, in rad; `bent` is how far the bristles are bent, as a share of the most,
/// `warm` the warmth of the grease, `late_Nm` the torque that a slow drive has reached.
struct AxisState {
  double angle = 0.0, rate = 0.0, far_angle = 0.0, far_rate = 0.0, bent = 0.0, warm = 0.0, late_Nm = 0.0;
  bool touching = false;  ///< of a spring with a gap: one side pushes the other
};

/// An axis with dry friction, as physics: it slides, or it sticks and holds still; or, where it is greased, it
/// creeps on a film that carries all of the friction from `film_dps` on. Classical Runge-Kutta at a quarter of
/// a millisecond, or less where the film is stiff, inside each phase; the moment at which it comes to rest is
/// located, not stepped over, and so is the moment at which the sides of a gap meet or part; a delayed command switches
/// at its own instant.
class AxisPlant {
public:
  explicit AxisPlant(const AxisParameters& parameters, double step_scale = 1.0)
      : p_(parameters), step_scale_(step_scale) {
    step_s_ = 0.25e-3 * step_scale;
    if (p_[far_share] > 0.0) {
      const double omega = 6.283185307179586 * p_[spring_Hz];
      const double reduced = p_[inertia] * p_[far_share] * (1.0 - p_[far_share]);
      spring_ = reduced * omega * omega;
      damper_ = 2.0 * p_[spring_damping] * reduced * omega;
      step_s_ = std::min(step_s_, 0.1 / omega);
    }
    if (p_[lag_s] > 0.0) step_s_ = std::min(step_s_, 0.5 * p_[lag_s]);
    const bool rubs = p_[coulomb_Nm] > 0.0 || p_[load_share] > 0.0 || p_[notch_Nm] > 0.0 ||
                      p_[gear_forward] < 1.0 || p_[gear_backward] < 1.0;
    if (p_[gap_deg] > 0.0) half_gap_ = 0.5 * p_[gap_deg] / degrees_per_radian;
    creeps_ = rubs && p_[film_dps] > 0.0;
    dry_ = rubs && !creeps_;
  }

  double delay() const { return p_[delay_s]; }
  double target_delay() const { return p_[target_delay_s]; }

  double sensed_angle_deg(const AxisState& x, double run_time_s) const {
    return p_[angle_gain] *
               (x.angle * degrees_per_radian + p_[eccentric_deg] * std::sin(p_[eccentric_count] * x.angle)) +
           p_[angle_drift_dps] * run_time_s;
  }
  double sensed_rate_dps(const AxisState& x) const { return x.rate * degrees_per_radian + p_[rate_bias_dps]; }

  /// Puts what the sensors say into the state; what nobody measures is kept, as far as it hangs on the motor
  /// by its twist.
  /// @param absolute keep the far side where it was, instead of how far it was twisted
  void restart(AxisState& x, double angle_deg, double rate_dps, double run_time_s, bool first,
               bool absolute) const {
    double angle = (angle_deg - p_[angle_drift_dps] * run_time_s) / p_[angle_gain] / degrees_per_radian;
    if (p_[eccentric_deg] != 0.0) {
      const double seen = angle;
      for (int i = 0; i < 20; ++i)
        angle = seen - p_[eccentric_deg] / degrees_per_radian * std::sin(p_[eccentric_count] * angle);
    }
    const double rate = (rate_dps - p_[rate_bias_dps]) / degrees_per_radian;
    if (first) {
      x = AxisState{angle, rate, angle, rate, 0.0, 0.0, 0.0, false};
    } else if (absolute) {
      x.angle = angle;
      x.rate = rate;
    } else {
      x.far_angle += angle - x.angle;
      x.far_rate += rate - x.rate;
      x.angle = angle;
      x.rate = rate;
    }
  }

  /// Motor torque for a current, N m.
  double motor_torque(const AxisInput& u) const {
    const double beyond = std::max(0.0, std::fabs(u.drive_A) - p_[deadband_A]);
    double torque = p_[torque_constant] * (1.0 - p_[fade_per_K] * (u.motor_C - fade_reference_C)) *
                    std::copysign(beyond, u.drive_A);
    if (p_[torque_limit_Nm] > 0.0) torque = std::clamp(torque, -p_[torque_limit_Nm], p_[torque_limit_Nm]);
    return torque;
  }

  /// Carries the state over a time in which all inputs are held.
  void advance(AxisState& x, const AxisInput& u, double duration_s) const {
    if (duration_s <= 0.0) return;
    const Held held{motor_torque(u), u.hidden_Nm, u.hidden_wear, thinning(u)};
    double step_s = step_s_;
    if (creeps_) {
      const double film = p_[film_dps] / degrees_per_radian, near = p_[inertia] * (1.0 - p_[far_share]);
      AxisState still = x;
      still.rate = 0.0;
      const double most = std::max(friction(still, held, 1.0), friction(still, held, -1.0));
      if (most > 0.0) step_s = std::min(step_s, 0.04 * step_scale_ * film * near / most);
    }
    const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / step_s - 1e-9)));
    const double h = duration_s / steps;
    for (int i = 0; i < steps; ++i) {
      double left_s = h;
      for (int events = 0; events < 12 && left_s > 0.0; ++events) {
        if (!dry_) {
          const double until_s = until_contact_changes(x, held, 0.0, false, left_s);
          x = stepped(x, held, 0.0, false, until_s);
          if (until_s >= left_s) break;
          x.touching = !x.touching;
          left_s -= until_s;
          continue;
        }
        double way = x.rate > 0.0 ? 1.0 : -1.0;
        bool stuck = false;
        if (x.rate == 0.0) {
          const double push = without_friction(x, held);
          way = push > 0.0 ? 1.0 : -1.0;
          stuck = std::fabs(push) <= friction(x, held, way);
        }
        const AxisState before = x;
        const double until_s = until_contact_changes(before, held, way, stuck, left_s);
        x = stepped(before, held, way, stuck, until_s);
        if (stuck || x.rate * way >= 0.0) {
          if (until_s >= left_s) break;
          x.touching = !x.touching;
          left_s -= until_s;
          continue;
        }
        // It came to rest on the way: find when.
        double low = 0.0, high = until_s, rate_low = before.rate, rate_high = x.rate;
        for (int k = 0; k < 40 && high - low > 1e-12; ++k) {
          double middle =
              k % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * rate_low / (rate_low - rate_high);
          middle = std::clamp(middle, low, high);
          x = stepped(before, held, way, false, middle);
          if (std::fabs(x.rate) < 1e-12) {
            low = high = middle;
            break;
          }
          if (x.rate * way > 0.0) {
            low = middle;
            rate_low = x.rate;
          } else {
            high = middle;
            rate_high = x.rate;
          }
        }
        x = stepped(before, held, way, false, high);
        x.rate = 0.0;
        left_s -= high;
        if (high <= 0.0 && before.rate == 0.0) break;
      }
    }
  }

  /// Kinetic plus potential energy of a rigid or two-inertia axis without angle-dependent loads, J.
  double energy(const AxisState& x) const {
    const double near = 0.5 * p_[inertia] * (1.0 - p_[far_share]) * x.rate * x.rate;
    const double far = 0.5 * p_[inertia] * p_[far_share] * x.far_rate * x.far_rate;
    const double twist = x.angle - x.far_angle;
    return near + far + 0.5 * spring_ * twist * twist;
  }

private:
  struct Held {
    double motor_Nm, hidden_Nm, wear, thin;
  };
  using Rates = std::array<double, 7>;

  AxisParameters p_;
  double step_scale_ = 1.0, step_s_ = 0.25e-3, spring_ = 0.0, damper_ = 0.0, half_gap_ = 0.0;
  bool dry_ = false, creeps_ = false;

  /// What is left of friction in warm grease: Reynolds's law of viscosity, exp(-beta (T - T0)), for all that rubs in it.
  double thinning(const AxisInput& u) const {
    return p_[thinning_per_K] != 0.0 ? std::exp(-p_[thinning_per_K] * (u.motor_C - fade_reference_C)) : 1.0;
  }

  /// What a drive brings to the shaft, N m: of a slow one what it has reached by now, lag dM/dt = commanded - M; and at
  /// some angles, where the magnets and the coils stand well to each other, more for the same current than at others.
  double delivered(const AxisState& x, const Held& held) const {
    const double torque = p_[lag_s] > 0.0 ? x.late_Nm : held.motor_Nm;
    if (p_[ripple_sin] == 0.0 && p_[ripple_cos] == 0.0) return torque;
    const double turn = p_[ripple_count] * x.angle;
    return torque * (1.0 + p_[ripple_sin] * std::sin(turn) + p_[ripple_cos] * std::cos(turn));
  }

  double friction(const AxisState& x, const Held& held, double way) const {
    const double motor_Nm = delivered(x, held);
    double torque = p_[coulomb_Nm] * (1.0 + way * p_[asymmetry]);
    if (p_[stick_ratio] > 0.0) {
      const double v = std::fabs(x.rate) * degrees_per_radian / p_[stribeck_dps];
      torque *= 1.0 + p_[stick_ratio] * std::exp(-std::pow(v, p_[stribeck_exponent]));
    }
    if (p_[run_out_share] > 0.0) torque *= 1.0 + p_[run_out_share] * std::sin(p_[run_out_count] * x.angle);
    const double load_Nm = p_[far_share] > 0.0 ? 0.0 : load_torque(x.angle, x.rate);
    torque = torque * held.wear + p_[load_share] * std::fabs(motor_Nm - load_Nm);
    // A gear hands on a part of the motor's torque; of the load's, when that turns the motor, another part.
    const double arrives_Nm =
        motor_Nm * way > 0.0 ? motor_Nm * p_[gear_forward] : motor_Nm / p_[gear_backward];
    torque += (motor_Nm - arrives_Nm) * way;
    if (p_[notch_Nm] > 0.0) {
      const double z = (x.angle * degrees_per_radian - p_[notch_deg]) / p_[notch_width_deg];
      torque += p_[notch_Nm] * std::exp(-0.5 * z * z);
    }
    return torque * held.thin;
  }

  /// What two sides that are pressed together pass on, N m; they cannot pull.
  double contact_torque(const AxisState& x) const {
    const double twist = x.angle - x.far_angle;
    return spring_ * (twist - std::copysign(half_gap_, twist)) + damper_ * (x.rate - x.far_rate);
  }

  bool pushes(const AxisState& x) const {
    const double twist = x.angle - x.far_angle;
    return std::fabs(twist) > half_gap_ && contact_torque(x) * twist > 0.0;
  }

  /// How long the sides of a gap go on touching, or apart, at most `most_s`.
  double until_contact_changes(const AxisState& x, const Held& held, double way, bool stuck,
                               double most_s) const {
    if (half_gap_ <= 0.0) return most_s;
    const auto changed = [&](double h) { return pushes(stepped(x, held, way, stuck, h)) != x.touching; };
    if (!changed(most_s)) return most_s;
    double low = 0.0, high = most_s;
    for (int k = 0; k < 40 && high - low > 1e-12; ++k) {
      const double middle = 0.5 * (low + high);
      (changed(middle) ? high : low) = middle;
    }
    return high < most_s ? high : std::nextafter(most_s, 0.0);
  }

  /// What passes from the motor's side to the far one, N m.
  double spring_torque(const AxisState& x) const {
    if (p_[clutch_Nm] > 0.0) {
      const double slip = (x.rate - x.far_rate) * degrees_per_radian / p_[clutch_dps];
      return p_[clutch_Nm] * slip / std::sqrt(1.0 + slip * slip);
    }
    if (half_gap_ > 0.0) return x.touching ? contact_torque(x) : 0.0;
    return spring_ * (x.angle - x.far_angle) + damper_ * (x.rate - x.far_rate);
  }

  /// Torque of the surroundings at an angle: weights, cable, end stop.
  double load_torque(double angle, double rate) const {
    double torque = p_[weight_Nm] - p_[cable_Nm_per_rad] * angle - p_[cable_Nm];
    if (p_[unbalance_sin_Nm] != 0.0 || p_[unbalance_cos_Nm] != 0.0)
      torque -= p_[unbalance_sin_Nm] * std::sin(angle) + p_[unbalance_cos_Nm] * std::cos(angle);
    if (p_[hardening_Nm_per_rad3] > 0.0) torque -= p_[hardening_Nm_per_rad3] * angle * angle * angle;
    if (p_[stop_Nm_per_rad] > 0.0) {
      const double over = std::fabs(angle) - p_[stop_deg] / degrees_per_radian;
      if (over > 0.0)
        torque -= std::copysign(p_[stop_Nm_per_rad] * over, angle) + 0.004 * p_[stop_Nm_per_rad] * rate;
    }
    return torque;
  }

  /// All torque on the motor side but dry friction.
  double without_friction(const AxisState& x, const Held& held) const {
    const double motor_Nm = delivered(x, held);
    double torque = motor_Nm + held.hidden_Nm;
    if (p_[brake_share] > 0.0) {  // weak while it turns against its torque, from some 2 deg/s on
      const double against = std::copysign(x.rate * degrees_per_radian / 2.0, -motor_Nm * x.rate);
      torque -= p_[brake_share] * motor_Nm * 0.5 * (1.0 + std::tanh(against));
    }
    double b = p_[viscous] + (x.rate > 0.0 ? p_[forward_Nms] : p_[backward_Nms]);
    if (p_[warming_share] > 0.0) b *= 1.0 - p_[warming_share] * x.warm;
    b *= held.thin;
    if (dry_ || creeps_) torque -= b * x.rate;
    else torque -= b * held.wear * x.rate;
    if (p_[cogging_sin_Nm] != 0.0 || p_[cogging_cos_Nm] != 0.0)
      torque -= p_[cogging_sin_Nm] * std::sin(p_[cogging_count] * x.angle) +
                p_[cogging_cos_Nm] * std::cos(p_[cogging_count] * x.angle);
    if (p_[cogging_second] != 0.0)
      torque -= p_[cogging_second] * std::hypot(p_[cogging_sin_Nm], p_[cogging_cos_Nm]) *
                std::sin(2.0 * p_[cogging_count] * x.angle + p_[cogging_second_phase]);
    if (p_[bristle_Nm] > 0.0) torque -= p_[bristle_Nm] * x.bent * held.thin;
    if (p_[drag_Nm_per_dps2] > 0.0) {
      const double v = x.rate * degrees_per_radian;
      torque -= p_[drag_Nm_per_dps2] * v * std::fabs(v);
    }
    return p_[far_share] > 0.0 ? torque - spring_torque(x) : torque + load_torque(x.angle, x.rate);
  }

  Rates rates(const AxisState& x, const Held& held, double way, bool stuck) const {
    Rates d{};
    const double near = p_[inertia] * (1.0 - p_[far_share]);
    if (!stuck) {
      double torque = without_friction(x, held);
      if (dry_) torque -= way * friction(x, held, way);
      if (creeps_) {
        const double carried = std::clamp(x.rate * degrees_per_radian / p_[film_dps], -1.0, 1.0);
        torque -= carried * friction(x, held, carried > 0.0 ? 1.0 : -1.0);
      }
      d[0] = x.rate;
      d[1] = torque / near;
    }
    if (p_[far_share] > 0.0) {
      d[2] = x.far_rate;
      d[3] = (spring_torque(x) + load_torque(x.far_angle, x.far_rate)) / (p_[inertia] * p_[far_share]);
    }
    if (p_[bristle_Nm] > 0.0)
      d[4] = (x.rate - std::fabs(x.rate) * x.bent) * degrees_per_radian / p_[bristle_deg];
    if (p_[warming_share] > 0.0)
      d[5] = (std::min(1.0, std::fabs(x.rate) * degrees_per_radian / 80.0) - x.warm) / p_[warming_s];
    if (p_[lag_s] > 0.0) d[6] = (held.motor_Nm - x.late_Nm) / p_[lag_s];
    return d;
  }

  static AxisState moved(const AxisState& x, const Rates& d, double h) {
    return {x.angle + h * d[0], x.rate + h * d[1], x.far_angle + h * d[2], x.far_rate + h * d[3],
            x.bent + h * d[4],  x.warm + h * d[5], x.late_Nm + h * d[6],   x.touching};
  }

  AxisState stepped(const AxisState& x, const Held& held, double way, bool stuck, double h) const {
    const Rates a = rates(x, held, way, stuck), b = rates(moved(x, a, 0.5 * h), held, way, stuck),
                c = rates(moved(x, b, 0.5 * h), held, way, stuck),
                d = rates(moved(x, c, h), held, way, stuck);
    Rates mean;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0;
    return moved(x, mean, h);
  }
};

}  // namespace gap_benchmark
