// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/hyperbolic_tangent.hpp>
#include <thermopower/plant/rows.hpp>
#include <thermopower/plant/state_plant.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// A joint of a gimbal, from the frame to the camera.
enum class GimbalJoint {
  yaw,   ///< about the frame's z, which points down
  roll,  ///< about the yaw stage's x, which points ahead
  pitch  ///< about the roll arm's y, which points right
};

/// `yaw`, `roll` or `pitch`, as columns, constants and effects begin.
inline const char* to_string(GimbalJoint joint) {
  constexpr const char* names[] = {"yaw", "roll", "pitch"};
  return names[static_cast<int>(joint)];
}

/// A symmetric matrix over the joints: inertias in kg m^2, or their derivatives by an angle in kg m^2/rad.
///
/// @snippet plant_examples.cpp joint matrix
/// How to: @ref gimbal_how_to.
template <class Scalar>
struct JointMatrix {
  Scalar yaw{0.0};         ///< yaw with itself
  Scalar roll{0.0};        ///< roll with itself
  Scalar pitch{0.0};       ///< pitch with itself
  Scalar yaw_roll{0.0};    ///< yaw with roll
  Scalar yaw_pitch{0.0};   ///< yaw with pitch
  Scalar roll_pitch{0.0};  ///< roll with pitch

  /// The matrix times a vector, in the order yaw, roll, pitch.
  std::array<Scalar, 3> times(const std::array<Scalar, 3>& v) const {
    return {yaw * v[0] + yaw_roll * v[1] + yaw_pitch * v[2],
            yaw_roll * v[0] + roll * v[1] + roll_pitch * v[2],
            yaw_pitch * v[0] + roll_pitch * v[1] + pitch * v[2]};
  }

  /// The vector that it maps to `v`; the matrix must be positive definite.
  std::array<Scalar, 3> solve(const std::array<Scalar, 3>& v) const {
    // L D L^T from pitch inwards: without coupling nothing but the diagonal is left.
    const Scalar by_yaw = yaw_pitch / pitch, by_roll = roll_pitch / pitch;
    const Scalar r = roll - by_roll * roll_pitch, yr = yaw_roll - by_yaw * roll_pitch;
    const Scalar slope = yr / r;
    const Scalar of_roll = v[1] - by_roll * v[2];
    const Scalar at_yaw = (v[0] - by_yaw * v[2] - slope * of_roll) / (yaw - by_yaw * yaw_pitch - slope * yr);
    const Scalar at_roll = of_roll / r - slope * at_yaw;
    return {at_yaw, at_roll, v[2] / pitch - by_yaw * at_yaw - by_roll * at_roll};
  }
};

/// A row of a body's angular velocity: how the rates of yaw, roll and pitch turn it about one of its axes, and how
/// that depends on the angles of roll and pitch.
template <class Scalar>
struct AngularRow {
  std::array<Scalar, 3> share;     ///< of each joint's rate
  std::array<Scalar, 3> by_roll;   ///< derivative by the roll angle
  std::array<Scalar, 3> by_pitch;  ///< derivative by the pitch angle
};

/// Three joints that carry a camera, each moved by a motor: yaw, then roll, then pitch, about axes that meet in one
/// point.
///
/// Without effects each joint is a rigid axis by itself: J dw/dt = Kt drive - b w. What couples them is an effect
/// (GimbalCoupling), so that whoever simulates the axes apart is told so, and whoever knows the coupling has it in
/// the model. J of a joint is what it moves where all angles are 0. The frame does not turn; that it
/// accelerates, or stands askew, is in `gravity_*_mps2`, the gravity less the frame's acceleration in
/// the frame's axes (x ahead, y right, z down), 9.81 m/s^2 downwards where nothing else is recorded. Angles
/// in degrees; columns `yaw_A`, `yaw_deg`, `yaw_dps` and so on.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
struct GimbalJoints {
  /// Its constants, inputs and signals.
  static PlantInfo info() {
    PlantInfo info;
    info.type = "gimbal_joints";
    info.windowed = true;
    const double inertia[] = {2e-3, 1e-3, 5e-4};
    for (int i = 0; i < 3; ++i) {
      const std::string joint = to_string(static_cast<GimbalJoint>(i));
      info.constants.push_back({joint, joint + "_inertia_kgm2", "kg m^2", inertia[i]});
      info.constants.push_back({joint, joint + "_viscous_Nms_per_rad", "N m s/rad", 1e-3});
      info.constants.push_back({joint, joint + "_torque_constant_Nm_per_A", "N m/A", 0.1});
      info.inputs.push_back({joint + "_A", "A"});
    }
    for (const char* axis : {"x", "y", "z"})
      info.inputs.push_back({std::string("gravity_") + axis + "_mps2", "m/s^2", axis[0] == 'z' ? 9.81 : 0.0});
    for (const bool rate : {false, true})
      for (int i = 0; i < 3; ++i) {
        const std::string joint = to_string(static_cast<GimbalJoint>(i));
        info.states.push_back({joint + (rate ? "_rate" : "_angle"), rate ? "deg/s" : "deg",
                               static_cast<int>(info.states.size()), 0.0, rate ? 100.0 : 30.0});
        info.signals.push_back({joint + (rate ? "_dps" : "_deg"), rate ? "deg/s" : "deg",
                                joint + (rate ? ".torque" : ".angle")});
      }
    return info;
  }

  /// The terms of its equations of motion.
  template <class Scalar>
  struct Terms {
    std::array<Scalar, 3> angle_rad;       ///< yaw, roll, pitch
    std::array<Scalar, 3> rate_rad_per_s;  ///< their derivatives
    std::array<Scalar, 3> gravity_mps2;    ///< less the frame's acceleration, in the frame's axes
    Scalar sin_yaw;                        ///< of the yaw angle
    Scalar cos_yaw;                        ///< of the yaw angle
    Scalar sin_roll;                       ///< of the roll angle
    Scalar cos_roll;                       ///< of the roll angle
    Scalar sin_pitch;                      ///< of the pitch angle
    Scalar cos_pitch;                      ///< of the pitch angle
    // to change
    std::array<Scalar, 3> torque_Nm;  ///< on each joint, from motor, gravity and friction
    JointMatrix<Scalar> inertia;      ///< of the joints in this pose
    JointMatrix<Scalar> by_roll;      ///< its derivative by the roll angle
    JointMatrix<Scalar> by_pitch;     ///< its derivative by the pitch angle
    bool coupled = false;             ///< to be set by who makes the inertia depend on the pose

    /// The camera's angular velocity about its x (ahead), y (right) and z (down).
    std::array<AngularRow<Scalar>, 3> camera() const {
      const Scalar zero(0.0), one(1.0), &sr = sin_roll, &cr = cos_roll, &sp = sin_pitch, &cp = cos_pitch;
      return {{{{-cr * sp, cp, zero}, {sr * sp, zero, zero}, {-cr * cp, -sp, zero}},
               {{sr, zero, one}, {cr, zero, zero}, {zero, zero, zero}},
               {{cr * cp, sp, zero}, {-sr * cp, zero, zero}, {-cr * sp, cp, zero}}}};
    }

    /// The roll arm's angular velocity about its x, y and z.
    std::array<AngularRow<Scalar>, 3> arm() const {
      const Scalar zero(0.0), one(1.0);
      return {{{{zero, one, zero}, {zero, zero, zero}, {zero, zero, zero}},
               {{sin_roll, zero, zero}, {cos_roll, zero, zero}, {zero, zero, zero}},
               {{cos_roll, zero, zero}, {-sin_roll, zero, zero}, {zero, zero, zero}}}};
    }

    /// Adds kinetic energy `kgm2` a b, with a and b rows of the angular velocity of one body.
    void add_energy(const Scalar& kgm2, const AngularRow<Scalar>& a, const AngularRow<Scalar>& b) {
      const auto add = [&](JointMatrix<Scalar>& to, const std::array<Scalar, 3>& u,
                           const std::array<Scalar, 3>& v) {
        const auto pair = [&](std::size_t i, std::size_t k) { return kgm2 * (u[i] * v[k] + v[i] * u[k]); };
        to.yaw += pair(0, 0);
        to.roll += pair(1, 1);
        to.pitch += pair(2, 2);
        to.yaw_roll += pair(0, 1);
        to.yaw_pitch += pair(0, 2);
        to.roll_pitch += pair(1, 2);
      };
      add(inertia, a.share, b.share);
      add(by_roll, a.by_roll, b.share);
      add(by_roll, a.share, b.by_roll);
      add(by_pitch, a.by_pitch, b.share);
      add(by_pitch, a.share, b.by_pitch);
      coupled = true;
    }

    /// Gravity along the yaw stage's x and y.
    std::array<Scalar, 2> gravity_at_yaw() const {
      return {cos_yaw * gravity_mps2[0] + sin_yaw * gravity_mps2[1],
              cos_yaw * gravity_mps2[1] - sin_yaw * gravity_mps2[0]};
    }

    /// Gravity in the roll arm's axes.
    std::array<Scalar, 3> gravity_at_arm() const {
      const std::array<Scalar, 2> at_yaw = gravity_at_yaw();
      return {at_yaw[0], cos_roll * at_yaw[1] + sin_roll * gravity_mps2[2],
              cos_roll * gravity_mps2[2] - sin_roll * at_yaw[1]};
    }
  };

  /// d(state)/dt: M(q) dw/dt = torques - (dM/dt w - 1/2 d(w M w)/dq), Lagrange's equations.
  template <class Scalar, class Effects>
  static void flow(const Scalar* constants, const Scalar* states, const Scalar* inputs,
                   const Effects& effects, Scalar* rates) {
    using std::cos;
    using std::sin;
    Terms<Scalar> terms;
    std::array<Scalar, 3>& w = terms.rate_rad_per_s;
    Scalar* const diagonal[] = {&terms.inertia.yaw, &terms.inertia.roll, &terms.inertia.pitch};
    for (std::size_t i = 0; i < 3; ++i) {
      terms.angle_rad[i] = states[i] * rad_per_deg;
      w[i] = states[3 + i] * rad_per_deg;
      terms.gravity_mps2[i] = inputs[3 + i];
      *diagonal[i] = constants[3 * i];
      terms.torque_Nm[i] = constants[3 * i + 2] * inputs[i] - constants[3 * i + 1] * w[i];
    }
    terms.sin_yaw = sin(terms.angle_rad[0]), terms.cos_yaw = cos(terms.angle_rad[0]);
    terms.sin_roll = sin(terms.angle_rad[1]), terms.cos_roll = cos(terms.angle_rad[1]);
    terms.sin_pitch = sin(terms.angle_rad[2]), terms.cos_pitch = cos(terms.angle_rad[2]);
    effects(terms);
    std::array<Scalar, 3> torque = terms.torque_Nm;
    if (terms.coupled) {
      const std::array<Scalar, 3> roll = terms.by_roll.times(w), pitch = terms.by_pitch.times(w);
      for (std::size_t i = 0; i < 3; ++i) torque[i] -= roll[i] * w[1] + pitch[i] * w[2];
      torque[1] += 0.5 * (w[0] * roll[0] + w[1] * roll[1] + w[2] * roll[2]);
      torque[2] += 0.5 * (w[0] * pitch[0] + w[1] * pitch[1] + w[2] * pitch[2]);
    }
    const std::array<Scalar, 3> turning = terms.inertia.solve(torque);
    for (std::size_t i = 0; i < 3; ++i) {
      rates[i] = states[3 + i];
      rates[3 + i] = turning[i] / rad_per_deg;
    }
  }

  /// Encoders and gyroscopes at the joints.
  template <class Scalar, class Effects>
  static void read(const Scalar*, const Scalar* states, const Scalar*, const Effects&, Scalar* signals) {
    for (int i = 0; i < 6; ++i) signals[i] = states[i];
  }
};

/// Joints that move each other: the inertia of each depends on the pose of those behind it, and what turns about
/// two axes at once is torqued about the third.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
struct GimbalCoupling {
  /// Its parameters, in this order.
  enum Parameters {
    camera_z_less_x_kgm2,  ///< the camera's moment of inertia about its z less that about its x, kg m^2
    rolled_yaw_kgm2  ///< how much larger the inertia that yaw moves is at a roll of 90 degrees than at 0, kg m^2
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    return {
        "coupling",
        SubmodelName("gimbal.coupling"),
        "M = M(roll, pitch) in the place of the diagonal: M_yaw_pitch = J_pitch sin roll, ...",
        "The joints are simulated apart, but carry each other: what one does moves the others.",
        // The camera's moments of inertia about its z less about its x, and by how much the inertia that yaw
        // moves is larger at a roll of 90 degrees than at 0.
        {parameter(camera_z_less_x_kgm2, "camera_z_less_x_kgm2")
             .unit("kg m^2")
             .within(-1.0, 1.0)
             .starts({0.0}),
         parameter(rolled_yaw_kgm2, "rolled_yaw_kgm2").unit("kg m^2").within(-1.0, 1.0).starts({0.0})},
        {},
        "move all joints at once, far from their middle"};
  }
  /// Adds what couples them.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    const Scalar &d = p[camera_z_less_x_kgm2], &e = p[rolled_yaw_kgm2], &pitch = terms.inertia.pitch;
    const Scalar &sr = terms.sin_roll, &cr = terms.cos_roll, &sp = terms.sin_pitch, &cp = terms.cos_pitch;
    const Scalar crsp = cr * sp, dspcp = d * sp * cp, ersr = e * sr;
    terms.inertia.yaw += ersr * sr - d * crsp * crsp;
    terms.inertia.roll += d * sp * sp;
    terms.inertia.yaw_roll += dspcp * cr;
    terms.inertia.yaw_pitch += pitch * sr;
    terms.by_roll.yaw += 2.0 * (ersr * cr + d * crsp * sp * sr);
    terms.by_roll.yaw_roll -= dspcp * sr;
    terms.by_roll.yaw_pitch += pitch * cr;
    terms.by_pitch.yaw -= 2.0 * dspcp * cr * cr;
    terms.by_pitch.roll += 2.0 * dspcp;
    terms.by_pitch.yaw_roll += d * (cp * cp - sp * sp) * cr;
    terms.coupled = true;
  }
};

/// Of a gimbal: what turns with the roll arm and not with pitch, or what pitch turns too.
enum class GimbalBody {
  arm,    ///< the roll arm, with the pitch motor's housing
  camera  ///< all that pitch turns
};

/// A body whose principal axes are not those of the joints.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
template <GimbalBody body>
struct GimbalProducts {
  /// Its parameters, in this order: integrals of xy, yz and xz over the body's mass.
  enum Parameters {
    xy_kgm2,  ///< integral of xy over the mass, kg m^2
    yz_kgm2,  ///< integral of yz, kg m^2
    xz_kgm2   ///< integral of xz, kg m^2
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    const std::string name = body == GimbalBody::camera ? "camera" : "arm";
    const auto product = [](int index, const char* parameter_name) {
      return parameter(index, parameter_name).unit("kg m^2").within(-1.0, 1.0).starts({0.0});
    };
    return {name + "_products",
            SubmodelName("gimbal.coupling"),
            "energy -= xy wx wy + yz wy wz + xz wx wz",
            "The mass of the " + name +
                " lies askew to the joints: products of inertia, also where all angles are 0.",
            {product(xy_kgm2, "xy_kgm2"), product(yz_kgm2, "yz_kgm2"), product(xz_kgm2, "xz_kgm2")},
            {},
            "accelerate one joint at a time, and watch the others"};
  }
  /// Adds their kinetic energy.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    const std::array<AngularRow<Scalar>, 3> rows = body == GimbalBody::camera ? terms.camera() : terms.arm();
    terms.add_energy(-p[xy_kgm2], rows[0], rows[1]);
    terms.add_energy(-p[yz_kgm2], rows[1], rows[2]);
    terms.add_energy(-p[xz_kgm2], rows[0], rows[2]);
  }
};

namespace detail {

// Mass times the lever along one axis of a body.
inline Parameter lever(int index, const char* name) {
  return parameter(index, name).unit("kg m").within(-10.0, 10.0).starts({0.0});
}

// A body whose centre of mass is off a joint's axis.
inline EffectInfo imbalance(const char* name, const char* equation, const char* meaning,
                            std::vector<Parameter> levers, const char* experiment) {
  return {name, SubmodelName("gimbal.gravity"), equation, meaning, std::move(levers), {}, experiment};
}

}  // namespace detail

/// A camera whose centre of mass is not where the axes meet.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
struct CameraImbalance {
  /// Its parameters, in this order: mass times the lever along the camera's x, y and z.
  enum Parameters {
    ahead_kgm,  ///< mass times the lever along the camera's x, kg m
    right_kgm,  ///< along its y, kg m
    below_kgm   ///< along its z, kg m
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    return detail::imbalance(
        "camera_imbalance", "torque += (m r x g) about each joint's axis",
        "The camera is not balanced: gravity turns pitch and roll, and yaw where the frame is askew.",
        {detail::lever(ahead_kgm, "ahead_kgm"), detail::lever(right_kgm, "right_kgm"),
         detail::lever(below_kgm, "below_kgm")},
        "turn pitch and roll slowly through all of their range");
  }
  /// Adds gravity's torques.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    const std::array<Scalar, 3> arm = terms.gravity_at_arm();
    const Scalar &sp = terms.sin_pitch, &cp = terms.cos_pitch;
    const Scalar g[] = {cp * arm[0] - sp * arm[2], arm[1], sp * arm[0] + cp * arm[2]};
    const Scalar about_x = p[right_kgm] * g[2] - p[below_kgm] * g[1];
    const Scalar about_y = p[below_kgm] * g[0] - p[ahead_kgm] * g[2];
    const Scalar about_z = p[ahead_kgm] * g[1] - p[right_kgm] * g[0];
    const Scalar across = cp * about_z - sp * about_x;
    terms.torque_Nm[0] += terms.cos_roll * across + terms.sin_roll * about_y;
    terms.torque_Nm[1] += cp * about_x + sp * about_z;
    terms.torque_Nm[2] += about_y;
  }
};

/// A roll arm whose centre of mass, with the pitch motor on it, is beside, above or below the roll axis.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
struct ArmImbalance {
  /// Its parameters, in this order: mass times the lever along the arm's y and z.
  enum Parameters {
    right_kgm,  ///< mass times the lever along the arm's y, kg m
    below_kgm   ///< along its z, kg m
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    return detail::imbalance("arm_imbalance", "torque += (m r x g) about roll and yaw",
                             "The roll arm is not balanced: gravity turns roll, whatever the pitch.",
                             {detail::lever(right_kgm, "right_kgm"), detail::lever(below_kgm, "below_kgm")},
                             "turn roll slowly through all of its range, at several pitches");
  }
  /// Adds gravity's torques.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    const std::array<Scalar, 3> g = terms.gravity_at_arm();
    const Scalar about_y = p[below_kgm] * g[0], about_z = -p[right_kgm] * g[0];
    terms.torque_Nm[0] += terms.sin_roll * about_y + terms.cos_roll * about_z;
    terms.torque_Nm[1] += p[right_kgm] * g[2] - p[below_kgm] * g[1];
  }
};

/// A centre of mass off the yaw axis: the yaw stage's own, or the roll arm's ahead of it.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
struct YawImbalance {
  /// Its parameters, in this order: mass times the lever along the yaw stage's x and y.
  enum Parameters {
    ahead_kgm,  ///< mass times the lever along the yaw stage's x, kg m
    right_kgm   ///< along its y, kg m
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    return detail::imbalance(
        "yaw_imbalance", "torque += (m r x g) about yaw",
        "What yaw turns is not balanced: where the frame is askew or accelerates, gravity turns yaw.",
        {detail::lever(ahead_kgm, "ahead_kgm"), detail::lever(right_kgm, "right_kgm")},
        "turn yaw with the frame askew, and record gravity_x_mps2 and gravity_y_mps2");
  }
  /// Adds gravity's torque.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    const std::array<Scalar, 2> g = terms.gravity_at_yaw();
    terms.torque_Nm[0] += p[ahead_kgm] * g[1] - p[right_kgm] * g[0];
  }
};

/// Dry friction in one joint.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
template <GimbalJoint joint>
struct JointFriction {
  /// Its parameter.
  enum Parameters {
    size_Nm  ///< torque against the motion, N m
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    const std::string name = to_string(joint);
    return {name + "_coulomb_friction",
            SubmodelName(name + ".torque"),
            "torque -= Nm tanh(w / 1 deg/s)",
            "Dry friction in the " + name + " joint: seals, slip rings, a dry bearing.",
            {parameter(size_Nm, "Nm").unit("N m").within(0.0, 1e3).starts({0.0})},
            {},
            "slow reversals of " + name};
  }
  /// Adds dry friction, turned over within a film of 1 deg/s.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    constexpr std::size_t at = static_cast<std::size_t>(joint);
    terms.torque_Nm[at] -= p[size_Nm] * hyperbolic_tangent(terms.rate_rad_per_s[at] / rad_per_deg);
  }
};

/// Cables that bend with one joint.
///
/// @snippet plant_examples.cpp gimbal
/// How to: @ref gimbal_how_to, @ref three_joints.
template <GimbalJoint joint>
struct JointCable {
  /// Its parameters, in this order.
  enum Parameters {
    Nm_per_rad,  ///< stiffness of the cables, N m/rad
    at_0_Nm      ///< their torque against positive angles at angle 0, N m
  };
  /// Its description, parameters and needs.
  static EffectInfo info() {
    const std::string name = to_string(joint);
    return {name + "_cable_spring",
            SubmodelName(name + ".torque"),
            "torque -= k angle + torque at 0",
            "The cables through the " + name + " joint pull it towards where they were laid.",
            {parameter(Nm_per_rad, "Nm_per_rad").unit("N m/rad").within(0.0, 1e3).starts({0.0}),
             parameter(at_0_Nm, "at_0_Nm").unit("N m").within(-1e3, 1e3).starts({0.0})},
            {},
            "hold " + name + " at several angles"};
  }
  /// Adds the cables' torque.
  template <class Scalar>
  static void act(const Scalar* p, GimbalJoints::Terms<Scalar>& terms) {
    constexpr std::size_t at = static_cast<std::size_t>(joint);
    terms.torque_Nm[at] -= p[Nm_per_rad] * terms.angle_rad[at] + p[at_0_Nm];
  }
};

/// A gimbal as `gap::diagnose` takes it, its joints apart, with all of the effects above; effects that are known
/// (a coupling among them) and constants are then set in the model, as in `model.effects["coupling"] = {...}`.
/// @param name  as reports call it
inline Model gimbal_model(std::string name) {
  using J = GimbalJoint;
  return adapt<GimbalJoints, GimbalCoupling, GimbalProducts<GimbalBody::camera>,
               GimbalProducts<GimbalBody::arm>, CameraImbalance, ArmImbalance, YawImbalance,
               JointFriction<J::yaw>, JointFriction<J::roll>, JointFriction<J::pitch>, JointCable<J::yaw>,
               JointCable<J::roll>, JointCable<J::pitch>>(std::move(name));
}

}  // namespace thermopower::plant
