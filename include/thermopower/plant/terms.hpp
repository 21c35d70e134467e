// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/dual.hpp>
#include <thermopower/plant/given.hpp>

#include <cmath>

namespace thermopower::plant {

/// @file terms.hpp
/// The terms of the model's equations, as the hooks of an effect see and change them.
///
/// Members above the line "to change" are given: states, inputs, covariates (NaN where not recorded). A hook
/// adds to or multiplies the members below it, so that several effects act together. Scalar is double in a
/// simulation, an automatic-differentiation number in a fit, and an Expression where the equation writes itself
/// down for firmware and pages.

/// Before the current law is evaluated: I = (supply_V sqrt(duty) - counter_V) / (R(T) factor + series + sag).
template <class Scalar>
struct ElectricalTerms {
  Given<Scalar> t_s = 0.0;       ///< time since the start of the run
  Given<Scalar> rate_dps = 0.0;  ///< recorded rotation of the motor, deg/s
  Scalar winding_C;              ///< temperature of the winding
  Scalar charge_Ah;              ///< charge drawn since the start of the run
  // to change
  Scalar supply_V;      ///< open-circuit supply
  Scalar source_ohm;    ///< resistance between the supply and the bridge: sags with the motor's current
  Scalar duty;          ///< 0..1
  Scalar tempco_per_K;  ///< of the winding (ohmic law only)
  Scalar series_ohm;    ///< in the motor's circuit, outside of the thermometered body
  Scalar counter_V;     ///< voltage against the drive
};

/// The air that the body feels. Hooks on these terms act before all hooks on ThermalTerms, so that every loss
/// sees the same air whatever the order of the effects.
template <class Scalar>
struct AirTerms {
  Given<Scalar> t_s = 0.0;                 ///< time since the start of the run
  Given<Scalar> measured_ambient_C = 0.0;  ///< as recorded; `ambient_C` starts from it
  // to change
  Scalar ambient_C;  ///< air temperature that the body feels
};

/// Heat balance of the body: what comes in, what goes out, W.
template <class Scalar>
struct ThermalTerms {
  Given<Scalar> t_s = 0.0;                 ///< time since the start of the run
  Given<Scalar> airspeed_mps = 0.0;        ///< covariate
  Given<Scalar> neighbour_C = 0.0;         ///< covariate
  Given<Scalar> rate_dps = 0.0;            ///< covariate
  Given<Scalar> measured_ambient_C = 0.0;  ///< as recorded
  Scalar ambient_C;  ///< air temperature that the body feels, after the hooks on AirTerms
  Scalar winding_C;  ///< node that the heat enters
  Scalar surface_C;  ///< node that loses it; the same where there is one node
  Scalar current_A;  ///< motor current
  Scalar supply_V;   ///< supply at the bridge
  Scalar v_rms_V;    ///< voltage at the motor
  // to change
  Scalar heat_W;              ///< into the winding node
  Scalar conductance_factor;  ///< multiplies the baseline's loss
  Scalar extra_loss_W;        ///< out of the surface node
};

/// The shape of the thermal model, set once per simulation.
///
/// @snippet plant_examples.cpp thermal structure
/// How to: @ref diagnose_a_gap.
template <class Scalar>
struct ThermalStructure {
  Scalar winding_share;         ///< of the heat capacity; 1: a single node
  Scalar coupling_W_per_K;      ///< between winding and surface node
  Scalar thermometer_lag_s;     ///< time constant of the thermometer; 0: none
  Scalar soaking_share;         ///< of the heat capacity, in a node behind the surface
  Scalar soaking_W_per_K;       ///< between that node and the surface
  Scalar enclosed_share;        ///< heat capacity of the air around the body, relative to the body's
  Scalar enclosed_W_per_K;      ///< from that air to the measured one
  Scalar soaking_loss_W_per_K;  ///< from the node behind the surface to the air; 0: it loses nothing itself
  Scalar soaking_J_per_K;       ///< its heat capacity, where it comes on top of the body's
  bool two_nodes = false;       ///< to be set with the share: winding and surface are nodes of their own
  bool lagged = false;          ///< to be set with the lag: the thermometer follows the winding late
  bool soaks = false;           ///< to be set with its share: there is a node behind the surface
  bool soaking_added =
      false;  ///< to be set with `soaking_J_per_K` instead of the share: it is no part of the body
  bool enclosed = false;  ///< to be set with its share: the air around the body warms up
  bool heating_exchanged =
      false;  ///< the thesis's heating law takes the temperature for the voltage, and the reverse

  /// Share of the body's heat capacity that is in winding and surface.
  Scalar own_share() const { return soaking_added ? Scalar(1.0) : Scalar(1.0 - soaking_share); }

  /// The rise of the node behind the surface by a joule. @param rise_K_per_J  the rise of the body by a joule
  Scalar soaking_K_per_J(const Scalar& rise_K_per_J) const {
    return soaking_added ? Scalar(1.0 / soaking_J_per_K) : Scalar(rise_K_per_J / soaking_share);
  }

  /// Whether there are nodes besides winding and surface.
  bool has_further_nodes() const { return soaks || enclosed; }
};

/// Drive path, evaluated once per interval.
template <class Scalar>
struct DriveTerms {
  Given<Scalar> t_s = 0.0;      ///< time since the start of the run
  Given<Scalar> motor_C = 0.0;  ///< recorded; NaN where it is not
  // to change
  /// Command, delayed where there is a delay. Of a motor at a voltage: the current that it drives at standstill.
  Scalar drive_A;
  Scalar torque_constant_Nm_per_A;  ///< as in the model file, to be multiplied
};

/// A transition of dry friction at or below this, in rad/s, is none: the axis sticks at rest.
inline constexpr double friction_sticks_below_rad_per_s = 5e-4;

/// A state that an effect brings to the joint, by the equation dz/dt = slope - per_s z: a hook reads the value
/// and sets the two. Where nothing is known of it, it starts as a second of these leaves it: at slope / per_s where that is fast.
template <class Scalar>
struct OwnState {
  Scalar value;  ///< z, in the unit that the effect's info says
  // to change
  Scalar slope;  ///< in that unit per second
  Scalar per_s;  ///< 1/s, >= 0
};

/// States of their own that the effects of one model may bring together.
inline constexpr int most_own_states = 2;

/// Torques on the driven inertia, dry friction left out.
template <class Scalar>
struct AxisTerms {
  Given<Scalar> t_s;             ///< time since the start of the run
  const Scalar& angle_rad;       ///< of the driven inertia
  const Scalar& rate_rad_per_s;  ///< its derivative
  const Scalar& drive_Nm;        ///< torque that is asked of the drive, after its own effects
  // to change
  Scalar load_Nm;                   ///< added to the drive; starts from the recorded external torque
  Scalar delivered_Nm;              ///< what arrives of the drive's torque; starts from all of it
  OwnState<Scalar>* own = nullptr;  ///< the effect's states, in the order of its info
};

/// Dry friction of the driven inertia. Hooks on these terms act after all hooks on AxisTerms, so that
/// friction sees every load whatever the order of the effects.
///
/// @snippet plant_examples.cpp effect of one's own
/// How to: @ref diagnose_a_gap.
template <class Scalar>
struct FrictionTerms {
  Given<Scalar> t_s;             ///< time since the start of the run
  Given<Scalar> motor_C;         ///< recorded; NaN where it is not
  const Scalar& angle_rad;       ///< of the driven inertia
  const Scalar& rate_rad_per_s;  ///< its derivative
  const Scalar& drive_Nm;        ///< torque that arrives of the drive
  const Scalar& load_Nm;         ///< all that the effects add to it, such as gravity and springs
  // to change
  Scalar forward_Nm = 0.0;            ///< magnitude while the rate is positive, >= 0
  Scalar backward_Nm = 0.0;           ///< magnitude while the rate is negative, >= 0
  Scalar transition_rad_per_s = 0.0;  ///< rate within which it turns over, by `film_share`; 0: sticks at rest
  Scalar factor = 1.0;                ///< multiplies all friction, the viscous one too, >= 0
  Scalar torque_Nm = 0.0;           ///< friction of other kinds than the dry one, taken off the other torques
  bool dry = false;                 ///< some effect has dry friction
  OwnState<Scalar>* own = nullptr;  ///< the effect's states, in the order of its info
  Scalar tail = 0.0;  ///< how slowly it becomes full beyond the transition, -1..1, by `film_share`

  /// No friction yet. Its arguments must outlive it.
  FrictionTerms(Given<Scalar> at_s, Given<Scalar> recorded_C, const Scalar& angle, const Scalar& rate,
                const Scalar& drive, const Scalar& load)
      : t_s(at_s),
        motor_C(recorded_C),
        angle_rad(angle),
        rate_rad_per_s(rate),
        drive_Nm(drive),
        load_Nm(load) {}

  /// Torque that the gears transmit, N m: |drive - load|. A drive that holds a load against it passes both.
  Scalar transmitted_Nm() const { return magnitude(Scalar(drive_Nm - load_Nm)); }

  /// Adds dry friction of a magnitude for each direction. The widest transition among all frictions holds, and the
  /// longest tail.
  void add_friction(const Scalar& forward, const Scalar& backward, const Scalar& transition,
                    const Scalar& longest_tail = 0.0) {
    forward_Nm += forward;
    backward_Nm += backward;
    transition_rad_per_s = larger(transition_rad_per_s, transition);
    if (!dry || !(value_of(longest_tail) < value_of(tail)))
      tail = longest_tail;  // equal: it is the one that may vary
    dry = true;
  }
};

/// The shape of the mechanical model, set once per simulation.
template <class Scalar>
struct AxisStructure {
  Scalar delay_s;               ///< from command to torque
  Scalar far_share;             ///< of the inertia, behind a spring; 0: rigid
  Scalar spring_rad_per_s;      ///< natural frequency of the two inertias against each other
  Scalar spring_damping;        ///< damping ratio of that motion
  Scalar gap_rad;               ///< free play of the spring, from end to end
  bool delayed = false;         ///< to be set with the delay
  bool compliant = false;       ///< to be set with the share: there is a far side
  bool gapped = false;          ///< to be set with the gap: the spring has free play
  Scalar target_delay_s = 0.0;  ///< from the recorded target to the servo that takes it
  bool target_delayed = false;  ///< to be set with it
};

/// The readings of the instruments of a bench.
template <class Scalar>
struct BenchReadings {
  Given<Scalar> t_s = 0.0;                 ///< time since the start of the run
  Given<Scalar> measured_ambient_C = 0.0;  ///< as recorded
  // to change
  Scalar current_A;  ///< what the ammeter shows; given as the true current
  Scalar motor_C;    ///< what the thermometer shows; given as its node's temperature
};

/// The readings of the instruments of an axis.
template <class Scalar>
struct AxisReadings {
  Given<Scalar> t_s = 0.0;  ///< time since the start of the run
  // to change
  Scalar angle_deg;  ///< what the encoder or IMU shows; given as the true angle
  Scalar rate_dps;   ///< what the gyroscope shows; given as the true rate
};

}  // namespace thermopower::plant
