// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/axis_state.hpp>
#include <thermopower/plant/film.hpp>
#include <thermopower/plant/free_play.hpp>
#include <thermopower/plant/instance.hpp>

#include <cmath>

namespace thermopower::plant {

/// Integrates the axis under a constant drive, with dry friction.
///
/// Where the equations are smooth the classical Runge-Kutta rule integrates them, halving its step where the
/// acceleration bends by more than 0.0005 rad/s, beyond 10 rad/s in proportion to the rate. Drag that settles the rate of a
/// rigid axis within a step, and friction that turns over within a transition near standstill, are smooth but stiff: there an
/// exponential Rosenbrock rule of third order takes over, which follows a creeping axis at any step length.
/// Friction without a transition goes by events: at a zero crossing of the rate the step is cut; the axis
/// sticks while friction holds the other torques, else it leaves with friction reversed. With an
/// automatic-differentiation scalar the cut's position is differentiated too, so derivatives are exact
/// through reversals.
///
/// How the whole works: @ref gap_method.
template <class Scalar>
class AxisStep {
public:
  /// How long effects' own states settle: longer than what a joint remembers, shorter than a drift.
  static constexpr double settled_for_s = 1.0;

  /// Precomputes what stays the same; keeps a reference to `instance`, which must outlive this object.
  explicit AxisStep(const Instance<Scalar>& instance) : instance_(instance) {
    const auto& shape = instance.axis_structure;
    Scalar near_inertia_kgm2 = instance.inertia_kgm2;
    if (shape.compliant) {
      near_inertia_kgm2 = instance.inertia_kgm2 * (1.0 - shape.far_share);
      far_inertia_kgm2_ = instance.inertia_kgm2 * shape.far_share;
      const Scalar reduced = near_inertia_kgm2 * shape.far_share;
      spring_Nm_per_rad_ = reduced * shape.spring_rad_per_s * shape.spring_rad_per_s;
      damper_Nms_per_rad_ = reduced * shape.spring_rad_per_s * shape.spring_damping * 2.0;
      play_ = {shape.gap_rad, spring_Nm_per_rad_, damper_Nms_per_rad_};
    }
    per_near_inertia_ = 1.0 / near_inertia_kgm2;
    double drag_Nms_per_rad = value_of(instance.viscous_Nms_per_rad);
    if (instance.voltage_driven)
      drag_Nms_per_rad +=
          std::pow(value_of(instance.torque_constant_Nm_per_A), 2.0) / value_of(instance.motor_ohm);
    double fastest = std::abs(drag_Nms_per_rad / value_of(near_inertia_kgm2));
    if (shape.compliant) fastest = std::fmax(fastest, value_of(shape.spring_rad_per_s));
    longest_s_ = 0.6 / std::fmax(fastest, 1e-9);
    const Scalar zero = constant<Scalar>(0.0);
    AxisState<Scalar> rest{zero, zero, zero, zero, {}};
    const AxisDrive<Scalar> none{zero};
    settle(rest, 0.0, none);
    const Torques at_rest = torques(rest, 0.0, none);
    soft_ = value_of(at_rest.transition_rad_per_s) > 1.001 * friction_sticks_below_rad_per_s;
    dry_ = at_rest.dry && !soft_;
  }

  /// Lets the effects' own states start as they are after they have moved for a while as they do now, from 0: settled
  /// where they settle fast. At rest a bristle is not bent, whatever the sign of the rate's noise.
  void settle(AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive) const {
    state.own.count = instance_.own_states;
    for (int i = 0; i < state.own.count; ++i) state.own.at[i] = constant<Scalar>(0.0);
    follow(state, t_s, settled_for_s, drive);
  }

  /// Lets the effects' own states move for a while in which the motion stays what it is. A state that drifts without an end
  /// stays.
  void follow(AxisState<Scalar>& state, double t_s, double length_s, const AxisDrive<Scalar>& drive) const {
    if (state.own.count == 0) return;
    OwnState<Scalar> own[most_own_states];
    torques(state, t_s, drive, own);
    using std::exp;
    for (int i = 0; i < state.own.count; ++i)
      if (value_of(own[i].per_s) > 0.0)
        state.own.at[i] +=
            (own[i].slope / own[i].per_s - state.own.at[i]) * (1.0 - exp(Scalar(-own[i].per_s * length_s)));
  }

  /// Moves the state by `h_s` under a drive that stays the same.
  void advance(AxisState<Scalar>& state, double t_s, Scalar h_s, const AxisDrive<Scalar>& drive) const {
    const double length = value_of(h_s);
    if (!(length > 0.0)) return;
    constexpr double most_pieces = 2000.0;
    constexpr int halved = 9;
    const double pieces = std::fmin(most_pieces, std::ceil(length / longest_s_));
    touch(state);
    if (!instance_.axis_structure.compliant) {
      smooth<false>(state, t_s, h_s, drive, halved + static_cast<int>(std::ceil(std::log2(pieces))));
      return;
    }
    for (int i = 0; i < static_cast<int>(pieces); ++i)
      smooth<true>(state, t_s + length * i / pieces, h_s * (1.0 / pieces), drive, halved);
  }

  /// The torques on the driven inertia at an instant.
  struct Torques {
    Scalar torque_Nm;             ///< drive, load and viscous drag
    Scalar forward_Nm;            ///< dry friction while the rate is positive, >= 0
    Scalar backward_Nm;           ///< dry friction while the rate is negative, >= 0
    Scalar transition_rad_per_s;  ///< of dry friction; 0: it sticks
    Scalar tail;                  ///< of its transition, by `film_share`
    bool dry;                     ///< there is dry friction
  };

  /// The torques in a state under a drive; a spring's is not among them.
  Torques torques(const AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive) const {
    OwnState<Scalar> own[most_own_states];
    return torques(state, t_s, drive, own);
  }

  /// The same.
  /// @param own  receives how the effects' own states move; room for `most_own_states`
  Torques torques(const AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive,
                  OwnState<Scalar>* own) const {
    const Scalar zero = constant<Scalar>(0.0);
    for (int i = 0; i < instance_.own_states; ++i)
      own[i] = {i < state.own.count ? state.own.at[i] : zero, zero, zero};
    Scalar at_rate_Nm;
    if (instance_.voltage_driven)
      at_rate_Nm = drive.torque_Nm - drive.back_Nms_per_rad * state.rate_rad_per_s;
    const Scalar& drive_Nm = instance_.voltage_driven ? at_rate_Nm : drive.torque_Nm;
    AxisTerms<Scalar> terms{
        t_s, state.angle_rad, state.rate_rad_per_s, drive_Nm, constant<Scalar>(drive.external_Nm), drive_Nm};
    for (const auto& effect : instance_.axis) {
      terms.own = own + effect.own_states;
      effect(terms);
    }
    Scalar torque_Nm = terms.delivered_Nm + terms.load_Nm;
    const Scalar viscous_Nm = instance_.viscous_Nms_per_rad * state.rate_rad_per_s;
    if (instance_.friction.empty()) {
      torque_Nm -= viscous_Nm;
      return {torque_Nm, zero, zero, zero, zero, false};
    }
    FrictionTerms<Scalar> dry(t_s, drive.motor_C, state.angle_rad, state.rate_rad_per_s, terms.delivered_Nm,
                              terms.load_Nm);
    for (const auto& effect : instance_.friction) {
      dry.own = own + effect.own_states;
      effect(dry);
    }
    torque_Nm -= (viscous_Nm + dry.torque_Nm) * dry.factor;
    return {torque_Nm,
            Scalar(dry.forward_Nm * dry.factor),
            Scalar(dry.backward_Nm * dry.factor),
            dry.transition_rad_per_s,
            dry.tail,
            dry.dry};
  }

private:
  static constexpr double fast_rad_per_s = 10.0;  ///< beyond, errors grow in proportion to the rate
  static constexpr double series_below = 1e-3;    ///< decay for which a quotient would lose half its digits

  struct Slope {
    Scalar angle, rate, twist, twist_rate;
    OwnState<Scalar> own[most_own_states];  ///< how the effects' own states move
  };

  /// Friction inside its transition. `stiffness`, where asked for, receives its derivative by the rate.
  static Scalar soft_friction(const Torques& now, const Scalar& rate_rad_per_s, Scalar* stiffness) {
    const bool forward = value_of(rate_rad_per_s) >= 0.0;
    const Scalar& size_Nm = forward ? now.forward_Nm : now.backward_Nm;
    constexpr double saturated = 18.0;  // tanh is 1 from here on, in double precision
    const bool has_tail = !is_constant(now.tail, 0.0);
    if (!has_tail && std::abs(value_of(rate_rad_per_s)) > saturated * value_of(now.transition_rad_per_s)) {
      if (stiffness != nullptr) *stiffness = constant<Scalar>(0.0);
      return forward ? size_Nm : Scalar(-size_Nm);
    }
    const Scalar x = rate_rad_per_s / now.transition_rad_per_s;
    if (!has_tail) {
      const Scalar share = hyperbolic_tangent(x);
      if (stiffness != nullptr) *stiffness = size_Nm * (1.0 - share * share) / now.transition_rad_per_s;
      return size_Nm * share;
    }
    if (stiffness == nullptr) return size_Nm * film_share(x, now.tail);
    const FilmWithSlope<Scalar> film(x, now.tail);
    *stiffness = size_Nm * film.slope / now.transition_rad_per_s;
    return size_Nm * film.share;
  }

  Scalar spring(const AxisState<Scalar>& state) const {
    if (instance_.axis_structure.gapped)
      return play_.torque(state.touching, state.twist_rad, state.twist_rate_rad_per_s);
    return spring_Nm_per_rad_ * state.twist_rad + damper_Nms_per_rad_ * state.twist_rate_rad_per_s;
  }

  /// @param direction  +1 or -1: which way friction acts against; 0: sticking
  template <bool compliant>
  void slope(const AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive, int direction,
             Slope& rate, Scalar* stiffness = nullptr) const {
    if (direction == 0) {
      rate.angle = rate.rate = constant<Scalar>(0.0);
      if (state.own.count > 0) torques(state, t_s, drive, rate.own);
    } else {
      rate.angle = state.rate_rad_per_s;
      if (instance_.axis.empty() && instance_.friction.empty()) {
        rate.rate = drive.torque_Nm - instance_.viscous_Nms_per_rad * state.rate_rad_per_s;
        if (instance_.voltage_driven) rate.rate -= drive.back_Nms_per_rad * state.rate_rad_per_s;
        rate.rate += drive.external_Nm;
      } else {
        const Torques now = torques(state, t_s, drive, rate.own);
        rate.rate = now.torque_Nm;
        if (soft_) rate.rate -= soft_friction(now, state.rate_rad_per_s, stiffness);
        else if (dry_ && direction > 0) rate.rate -= now.forward_Nm;
        else if (dry_) rate.rate += now.backward_Nm;
      }
      if constexpr (compliant) rate.rate += spring(state);
      rate.rate *= per_near_inertia_;
    }
    if constexpr (compliant) {
      rate.twist = state.twist_rate_rad_per_s;
      rate.twist_rate = -spring(state) / far_inertia_kgm2_ - rate.rate;
    }
  }

  /// Writes only what moves: a rigid axis has no twist.
  template <bool compliant>
  void move(const AxisState<Scalar>& from, const Slope& rate, const Scalar& h_s,
            AxisState<Scalar>& to) const {
    to.angle_rad = from.angle_rad + rate.angle * h_s;
    to.rate_rad_per_s = from.rate_rad_per_s + rate.rate * h_s;
    if constexpr (compliant) {
      to.twist_rad = from.twist_rad + rate.twist * h_s;
      to.twist_rate_rad_per_s = from.twist_rate_rad_per_s + rate.twist_rate * h_s;
    }
    if (from.own.count > 0) move_own(from, rate, h_s, to);
  }

  /// The effects' own states, each solved exactly for a slope and a decay that stay as they are.
  void move_own(const AxisState<Scalar>& from, const Slope& rate, const Scalar& h_s,
                AxisState<Scalar>& to) const {
    for (int i = 0; i < from.own.count; ++i) {
      const OwnState<Scalar>& own = rate.own[i];
      to.own.at[i] = from.own.at[i] +
                     h_s * settled_share(Scalar(own.per_s * h_s)) * (own.slope - own.per_s * from.own.at[i]);
    }
  }

  /// (1 - exp(-decay)) / decay: the mean of what decays over a step, as a share of its beginning.
  static Scalar settled_share(const Scalar& decay) {
    using std::exp;
    return value_of(decay) > series_below ? Scalar((1.0 - exp(Scalar(-decay))) / decay)
                                          : Scalar(1.0 - decay * (0.5 - decay * (1.0 / 6.0)));
  }

  /// One Runge-Kutta step from `from`, where the slope is `k1`; `bend` is how far the acceleration strays
  /// from a straight line, as a rate.
  template <bool compliant>
  AxisState<Scalar> runge_kutta(const AxisState<Scalar>& from, double t_s, const Scalar& h_s,
                                const AxisDrive<Scalar>& drive, int direction, const Slope& k1,
                                double& bend) const {
    const double h = value_of(h_s);
    const Scalar half_s = h_s * 0.5;
    Slope k2, k3, k4;
    AxisState<Scalar> point = from;
    move<compliant>(from, k1, half_s, point);
    slope<compliant>(point, t_s + 0.5 * h, drive, direction, k2);
    move<compliant>(from, k2, half_s, point);
    slope<compliant>(point, t_s + 0.5 * h, drive, direction, k3);
    move<compliant>(from, k3, h_s, point);
    slope<compliant>(point, t_s + h, drive, direction, k4);
    bend = h * std::abs(value_of(k1.rate) - value_of(k2.rate) - value_of(k3.rate) + value_of(k4.rate)) / 6.0;
    // A transition of friction between the second and the third slope shows in their difference only, and so
    // does a state of an effect's own that moves fast.
    if (soft_ || from.own.count > 0) bend += h * std::abs(value_of(k2.rate) - value_of(k3.rate)) / 6.0;
    const auto mean = [](const Scalar& a, const Scalar& b, const Scalar& c, Scalar& d) {
      d += a;
      d += 2.0 * (b + c);
      d *= 1.0 / 6.0;
    };
    mean(k1.angle, k2.angle, k3.angle, k4.angle);
    mean(k1.rate, k2.rate, k3.rate, k4.rate);
    if constexpr (compliant) {
      mean(k1.twist, k2.twist, k3.twist, k4.twist);
      mean(k1.twist_rate, k2.twist_rate, k3.twist_rate, k4.twist_rate);
    }
    for (int i = 0; i < from.own.count; ++i) {
      mean(k1.own[i].slope, k2.own[i].slope, k3.own[i].slope, k4.own[i].slope);
      mean(k1.own[i].per_s, k2.own[i].per_s, k3.own[i].per_s, k4.own[i].per_s);
    }
    move<compliant>(from, k4, h_s, point);
    return point;
  }

  template <bool compliant>
  int direction_of(const AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive) const {
    const double rate = value_of(state.rate_rad_per_s);
    if (rate != 0.0) return rate > 0.0 ? 1 : -1;
    const Torques now = torques(state, t_s, drive);
    double torque = value_of(now.torque_Nm);
    if constexpr (compliant) torque += value_of(spring(state));
    if (torque > value_of(now.forward_Nm)) return 1;
    if (-torque > value_of(now.backward_Nm)) return -1;
    return 0;
  }

  /// How the state moves where a step begins.
  struct Beginning {
    int direction;
    Slope slope;
    Scalar stiffness;
  };

  template <bool compliant>
  void look_at(const AxisState<Scalar>& state, double t_s, const AxisDrive<Scalar>& drive,
               Beginning& begins) const {
    begins.direction = dry_ ? direction_of<compliant>(state, t_s, drive) : 1;
    begins.stiffness = constant<Scalar>(0.0);
    slope<compliant>(state, t_s, drive, begins.direction, begins.slope, &begins.stiffness);
  }

  /// @param known  of the state, where somebody looked; else null
  template <bool compliant>
  void smooth(AxisState<Scalar>& state, double t_s, Scalar left_s, const AxisDrive<Scalar>& drive, int depth,
              const Beginning* known = nullptr) const {
    const double bend_limit_rad_per_s = bend_limit(state);
    for (int event = 0; event < 12; ++event) {
      Beginning found;
      if (known == nullptr) look_at<compliant>(state, t_s, drive, found);
      const Beginning& begins = known != nullptr ? *known : found;
      known = nullptr;  // it moves on
      if (creep<compliant>(state, t_s, left_s, drive, depth, begins)) {
        if (!(value_of(left_s) > 0.0)) return;
        continue;
      }
      const int direction = begins.direction;
      const Slope& start = begins.slope;
      constexpr int last_event = 11;
      double bend = 0.0;
      const AxisState<Scalar> reached =
          runge_kutta<compliant>(state, t_s, left_s, drive, direction, start, bend);
      if (bend > bend_limit_rad_per_s && depth > 0) {
        const Scalar half_s = left_s * 0.5;
        smooth<compliant>(state, t_s, half_s, drive, depth - 1, &begins);
        smooth<compliant>(state, t_s + value_of(half_s), half_s, drive, depth - 1);
        return;
      }
      if constexpr (compliant) {
        Scalar cut_s = left_s;
        AxisState<Scalar> at_cut = reached;
        if (event < last_event && meets_or_parts(state, t_s, drive, direction, start, cut_s, at_cut) &&
            !(dry_ && value_of(at_cut.rate_rad_per_s) * direction < 0.0)) {
          state = at_cut;
          t_s += value_of(cut_s);
          left_s -= cut_s;
          if (!(value_of(left_s) > 0.0)) return;
          continue;
        }
      }
      if (!dry_ || direction == 0 || value_of(reached.rate_rad_per_s) * direction >= 0.0 ||
          event == last_event) {
        state = reached;
        if (event == last_event) touch(state);
        return;
      }
      // The rate crosses zero on the way: find where (linear guess, one Newton step), stop there, go on.
      const double before = value_of(state.rate_rad_per_s), after = value_of(reached.rate_rad_per_s);
      if (before == 0.0) {  // would start and turn back at once: it stays
        state.rate_rad_per_s = constant<Scalar>(0.0);
        Slope at_rest;
        slope<compliant>(state, t_s, drive, 0, at_rest);
        state = runge_kutta<compliant>(state, t_s, left_s, drive, 0, at_rest, bend);
        return;
      }
      Scalar cut_s = left_s * (before / (before - after));
      AxisState<Scalar> at_cut = runge_kutta<compliant>(state, t_s, cut_s, drive, direction, start, bend);
      Slope there;
      slope<compliant>(at_cut, t_s, drive, direction, there);
      if (value_of(there.rate) * direction < 0.0) {
        const Scalar correction_s = at_cut.rate_rad_per_s / there.rate;
        const double corrected = value_of(cut_s) - value_of(correction_s);
        if (corrected > 0.0 && corrected < value_of(left_s)) {
          cut_s -= correction_s;
          at_cut = runge_kutta<compliant>(state, t_s, cut_s, drive, direction, start, bend);
        }
      }
      at_cut.rate_rad_per_s = constant<Scalar>(0.0);
      state = at_cut;
      t_s += value_of(cut_s);
      left_s -= cut_s;
      if (!(value_of(left_s) > 0.0)) return;
    }
  }

  /// Lets a state touch the end of the free play that it lies beyond.
  void touch(AxisState<Scalar>& state) const {
    if (instance_.axis_structure.gapped)
      state.touching = play_.touching(state.twist_rad, state.twist_rate_rad_per_s);
  }

  /// Cuts a step where the sides of the free play meet or part. Between two such events the equations are linear in the
  /// twist, and across one the torque jumps.
  /// @param start   slope of `from`
  /// @param cut_s   in: the whole step; out: as far as the event, with its derivatives
  /// @param at_cut  in: what the whole step reaches; out: the state at the event, touching what it touches after it
  /// @return false: neither happens, nothing was changed
  bool meets_or_parts(const AxisState<Scalar>& from, double t_s, const AxisDrive<Scalar>& drive,
                      int direction, const Slope& start, Scalar& cut_s, AxisState<Scalar>& at_cut) const {
    if (!instance_.axis_structure.gapped) return false;
    const int end = from.touching != 0 ? from.touching : value_of(at_cut.twist_rad) < 0.0 ? -1 : 1;
    const bool parts = from.touching != 0;
    // They part where nothing presses any more, and meet at the end of the gap; beyond it, where they had parted
    // before, where something presses again.
    const bool by_pressure = parts || value_of(play_.beyond(end, from.twist_rad)) > 0.0;
    const auto margin = [&](const AxisState<Scalar>& at) {
      const Scalar m =
          by_pressure ? Scalar(play_.pressed(end, at.twist_rad, at.twist_rate_rad_per_s) / spring_Nm_per_rad_)
                      : play_.beyond(end, at.twist_rad);
      return parts ? Scalar(-m) : m;
    };
    double low_s = 0.0, high_s = value_of(cut_s);
    double low = value_of(margin(from)), high = value_of(margin(at_cut));
    if (!(high > 0.0) || !(low <= 0.0)) return false;
    const double near = 1e-4 * value_of(play_.gap_rad);  // from here on one step of Newton's is exact enough
    double bend = 0.0, guess_s = high_s;
    AxisState<Scalar> point = at_cut;
    for (int k = 0; k < 20 && std::abs(high) > near && std::abs(low) > near; ++k) {
      // Regula falsi, as the Illinois rule has it; halves where it creeps.
      guess_s = k % 3 == 2 ? 0.5 * (low_s + high_s) : low_s + (high_s - low_s) * (low / (low - high));
      point = runge_kutta<true>(from, t_s, constant<Scalar>(guess_s), drive, direction, start, bend);
      const double there = value_of(margin(point));
      if (there > 0.0) high_s = guess_s, high = there;
      else low_s = guess_s, low = there;
      if (std::abs(there) <= near) break;
    }
    Scalar at_s = constant<Scalar>(std::abs(low) < std::abs(high) && low_s > 0.0 ? low_s : high_s);
    point = runge_kutta<true>(from, t_s, at_s, drive, direction, start, bend);
    Slope there;
    slope<true>(point, t_s + value_of(at_s), drive, direction, there);
    Scalar grows = static_cast<double>(end) * there.twist;
    if (by_pressure)
      grows += (damper_Nms_per_rad_ / spring_Nm_per_rad_) * (static_cast<double>(end) * there.twist_rate);
    if (parts) grows = -grows;
    if (value_of(grows) > 0.0) {
      const Scalar corrected_s = at_s - margin(point) / grows;
      if (value_of(corrected_s) > 0.0 && value_of(corrected_s) <= value_of(cut_s)) {
        at_s = corrected_s;
        point = runge_kutta<true>(from, t_s, at_s, drive, direction, start, bend);
      }
    }
    cut_s = at_s;
    at_cut = point;
    at_cut.touching = parts ? 0 : end;
    return true;
  }

  /// A step inside friction's transition, or one in which drag settles the rate. The equation of the rate is linearised about
  /// the start and solved exactly. What the linearisation missed is the error: it limits the step, and most of it is made good
  /// afterwards. Where sticking friction stops the axis, the step ends, and nothing is.
  /// @param t_s     in: when it begins; out: when it ended
  /// @param left_s  in: its length; out: what is left of it
  /// @param begins  how the state moves at the start
  /// @return false: not stiff here, nothing was done
  template <bool compliant>
  bool creep(AxisState<Scalar>& state, double& t_s, Scalar& left_s, const AxisDrive<Scalar>& drive, int depth,
             const Beginning& begins) const {
    constexpr double stiff_transition = 0.3, stiff = 0.6;
    using std::log;
    if (begins.direction == 0) return false;
    const Slope& now = begins.slope;
    Scalar per_s = begins.stiffness * per_near_inertia_;
    bool is_stiff = soft_ && value_of(per_s) * value_of(left_s) > stiff_transition;
    if constexpr (!compliant) {
      per_s += instance_.viscous_Nms_per_rad * per_near_inertia_;
      if (instance_.voltage_driven) per_s += drive.back_Nms_per_rad * per_near_inertia_;
      is_stiff = is_stiff || value_of(per_s) * value_of(left_s) > stiff;
    }
    if (!is_stiff) return false;
    Scalar h_s = left_s, decay = per_s * h_s, phi_1 = settled_share(decay);
    const double end_rate =
        value_of(state.rate_rad_per_s) + value_of(now.rate) * value_of(h_s) * value_of(phi_1);
    const bool stops = dry_ && end_rate * begins.direction < 0.0;
    if (stops) {
      h_s = -log(Scalar(1.0 + per_s * state.rate_rad_per_s / now.rate)) / per_s;
      if (!(value_of(h_s) > 0.0 && value_of(h_s) < value_of(left_s))) return false;
      decay = per_s * h_s;
      phi_1 = settled_share(decay);
    }
    const double h = value_of(h_s);
    const Scalar phi_2 =
        value_of(decay) > series_below ? Scalar((1.0 - phi_1) / decay) : Scalar(0.5 - decay * (1.0 / 6.0));
    AxisState<Scalar> reached = state;
    reached.angle_rad += h_s * (state.rate_rad_per_s + now.rate * h_s * phi_2);
    const Scalar gain_rad_per_s = now.rate * h_s * phi_1;
    reached.rate_rad_per_s += gain_rad_per_s;
    if constexpr (compliant) {
      // Symplectic Euler: the spring neither gains nor loses energy by it.
      reached.twist_rate_rad_per_s += h_s * now.twist_rate;
      reached.twist_rad += h_s * reached.twist_rate_rad_per_s;
    }
    if (state.own.count > 0) move_own(state, now, h_s, reached);
    Slope there;
    slope<compliant>(reached, t_s + h, drive, begins.direction, there);
    const Scalar missed = there.rate - now.rate + per_s * gain_rad_per_s;
    if (std::abs(value_of(missed)) * h * value_of(phi_2) > bend_limit(state) && depth > 0) {
      const Scalar half_s = left_s * 0.5;
      smooth<compliant>(state, t_s, half_s, drive, depth - 1, &begins);
      smooth<compliant>(state, t_s + value_of(half_s), half_s, drive, depth - 1);
      left_s = constant<Scalar>(0.0);
      return true;
    }
    if (!stops) {
      // What was missed grows about with the square of the time: that much of it is made good, by which the rule is of third order
      // (Hochbruck, Ostermann and Schweitzer 2009, exprb32).
      const Scalar twice_phi_3 = (1.0 - 2.0 * phi_2) / decay;
      reached.rate_rad_per_s += h_s * twice_phi_3 * missed;
      reached.angle_rad += h_s * h_s * ((1.0 / 3.0 - twice_phi_3) / decay) * missed;
    }
    state = reached;
    if (stops) {
      state.rate_rad_per_s = constant<Scalar>(0.0);
      t_s += h;
      left_s -= h_s;
    } else {
      left_s = constant<Scalar>(0.0);
    }
    touch(state);
    return true;
  }

  /// By how much the rate may be off after one step.
  double bend_limit(const AxisState<Scalar>& state) const {
    return (soft_ || state.own.count > 0 ? 1e-4 : 5e-4) *
           std::fmax(1.0, std::abs(value_of(state.rate_rad_per_s)) / fast_rad_per_s);
  }

  const Instance<Scalar>& instance_;
  Scalar per_near_inertia_, far_inertia_kgm2_, spring_Nm_per_rad_, damper_Nms_per_rad_;
  FreePlay<Scalar> play_;
  double longest_s_ = 1e9;
  bool soft_ = false;  ///< dry friction has a transition
  bool dry_ = false;   ///< dry friction has none: the axis sticks
};

}  // namespace thermopower::plant
