// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "axis_plant.hpp"
#include "effect.hpp"

namespace gap_benchmark {

/// What an effect's size is chosen against.
struct AxisContext {
  AxisParameters model = axis_defaults();  ///< what model.json says
  AxisParameters plant = axis_defaults();  ///< the same axis as it is, before the effect
  double torque_Nm = 0.01;                 ///< RMS torque of the command
  double drive_A = 0.1;                    ///< RMS of the command
  double rate_dps = 80.0;                  ///< RMS rate
  double swing_rad = 0.5;                  ///< RMS angle
  double dt_s = 0.01;
  bool has_motor = false;
  bool servo = false;  ///< the log holds a servo's target, and no current
};

using AxisEffect = Effect<AxisContext, AxisParameters>;

inline const std::vector<AxisEffect>& axis_effects() {
  using Context = AxisContext;
  using Values = AxisParameters;
  using List = std::vector<Free>;
  const auto always = [](const Context&) { return true; };
  const std::vector<std::string> motion = {"rate_dps", "angle_deg"};
  const auto constant = [always, motion](const char* id, const char* submodel, AxisParameter parameter) {
    const auto index = static_cast<std::size_t>(parameter);
    return AxisEffect{id,
                      submodel,
                      motion,
                      always,
                      [index](Random& r, const Context&, Values& p) {
                        p[index] *= std::exp(r.sign() * r.uniform(0.1, 0.45));
                      },
                      [index](const Context& c) {
                        const double x = c.model[index];
                        return List{{static_cast<int>(index), 0.35 * x, 2.8 * x, {x}}};
                      },
                      {}};
  };
  static const std::vector<AxisEffect> effects = {
      {"coulomb_friction",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) { p[coulomb_Nm] = c.torque_Nm * r.log_uniform(0.03, 0.5); },
       [](const Context& c) {
         return List{{coulomb_Nm, 0.0, 2.0 * c.torque_Nm, {0.15 * c.torque_Nm}}};
       },
       {}},
      {"asymmetric_friction",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[coulomb_Nm] = c.torque_Nm * r.log_uniform(0.05, 0.45);
         p[asymmetry] = r.sign() * r.uniform(0.25, 0.6);
       },
       [](const Context& c) {
         return List{{coulomb_Nm, 0.0, 2.0 * c.torque_Nm, {0.15 * c.torque_Nm}},
                     {asymmetry, -1.0, 1.0, {-0.3, 0.3}}};
       },
       {"coulomb_friction"}},
      {"stribeck_friction",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[coulomb_Nm] = c.torque_Nm * r.log_uniform(0.1, 0.35);
         p[stick_ratio] = r.uniform(0.5, 1.6);
         p[stribeck_dps] = r.log_uniform(5.0, 40.0);
       },
       [](const Context& c) {
         return List{{coulomb_Nm, 0.0, 2.0 * c.torque_Nm, {0.15 * c.torque_Nm}},
                     {stick_ratio, 0.1, 3.0, {0.8}},
                     {stribeck_dps, 2.0, 80.0, {8.0, 30.0}}};
       },
       {"coulomb_friction"}},
      // J dw/dt = M - (b + c) w, c one number forward and another backward: a lip seal, a screw with oil on one flank.
      {"asymmetric_viscous",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         const double b = c.plant[viscous], mean = b * r.uniform(0.8, 2.0),
                      tilt = r.sign() * r.uniform(0.2, 0.6);
         p[forward_Nms] = mean * (1.0 + tilt) - b;
         p[backward_Nms] = mean * (1.0 - tilt) - b;
       },
       [](const Context& c) {
         const double b = c.model[viscous];
         return List{{forward_Nms, -0.9 * b, 5.0 * b, {0.0, 0.5 * b}},
                     {backward_Nms, -0.9 * b, 5.0 * b, {0.0, 0.5 * b}}};
       },
       {"calibration.viscous"}},
      // J dw/dt = M - b exp(-k (T - 25)) w, T the motor's temperature: Reynolds's law of viscosity.
      {"warm_friction",
       "mechanical.friction",
       motion,
       [](const Context& c) { return c.has_motor; },
       [](Random& r, const Context&, Values& p) { p[thinning_per_K] = r.log_uniform(0.008, 0.04); },
       [](const Context&) {
         return List{{thinning_per_K, -0.03, 0.12, {0.005, 0.02}}};
       },
       {}},
      // J dw/dt = M - b w - c w |w|: a propeller in air, a pump in water.
      {"quadratic_drag",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[drag_Nm_per_dps2] = c.torque_Nm * r.log_uniform(0.1, 1.5) / (c.rate_dps * c.rate_dps);
       },
       [](const Context& c) {
         const double unit = c.torque_Nm / (c.rate_dps * c.rate_dps);
         return List{{drag_Nm_per_dps2, 0.0, 5.0 * unit, {0.3 * unit}}};
       },
       {}},
      {"load_friction",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context&, Values& p) { p[load_share] = r.uniform(0.08, 0.35); },
       [](const Context&) {
         return List{{load_share, 0.0, 0.7, {0.15}}};
       },
       {}},
      {"drive_efficiency",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context&, Values& p) {
         // A worm is hard to turn from behind; a preloaded thread may be easy.
         const bool worm = r.chance(0.6);
         const double lost = worm ? r.uniform(0.04, 0.2) : r.uniform(0.15, 0.4);
         p[gear_forward] = 1.0 - lost;
         p[gear_backward] = 1.0 / (1.0 + lost * (worm ? r.uniform(2.5, 6.0) : r.uniform(0.0, 0.25)));
       },
       [](const Context&) {
         return List{{gear_forward, 0.3, 1.0, {0.85}}, {gear_backward, 0.2, 1.0, {0.7, 0.95}}};
       },
       {"load_friction"}},
      {"drive_deadband",
       "mechanical.drive",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) { p[deadband_A] = c.drive_A * r.log_uniform(0.03, 0.4); },
       [](const Context& c) {
         return List{{deadband_A, 0.0, 1.5 * c.drive_A, {0.15 * c.drive_A}}};
       },
       {}},
      {"imbalance",
       "mechanical.load",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         const double size = c.torque_Nm * r.log_uniform(0.04, 0.7), phase = r.uniform(-3.1, 3.1);
         p[unbalance_sin_Nm] = size * std::cos(phase);
         p[unbalance_cos_Nm] = size * std::sin(phase);
       },
       [](const Context& c) {
         const double m = 3.0 * c.torque_Nm;
         return List{{unbalance_sin_Nm, -m, m, {0.1 * m}}, {unbalance_cos_Nm, -m, m, {0.0}}};
       },
       {}},
      // J dw/dt = M - b w + T, T the same at every angle and rate.
      {"constant_torque",
       "mechanical.load",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[weight_Nm] = r.sign() * c.torque_Nm * r.log_uniform(0.04, 0.5);
       },
       [](const Context& c) {
         const double m = 2.0 * c.torque_Nm;
         return List{{weight_Nm, -m, m, {-0.05 * m, 0.05 * m}}};
       },
       {}},
      {"cable_spring",
       "mechanical.load",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[cable_Nm_per_rad] = c.torque_Nm * r.log_uniform(0.04, 0.6) / c.swing_rad;
         p[cable_Nm] = p[cable_Nm_per_rad] * r.uniform(-0.4, 0.4);
       },
       [](const Context& c) {
         const double m = 3.0 * c.torque_Nm;
         return List{{cable_Nm_per_rad, 0.0, m / c.swing_rad, {0.1 * m / c.swing_rad}},
                     {cable_Nm, -m, m, {0.0}}};
       },
       {"constant_torque"}},
      {"cogging",
       "mechanical.load",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         const double size = c.torque_Nm * r.log_uniform(0.04, 0.45), phase = r.uniform(-3.1, 3.1);
         p[cogging_sin_Nm] = size * std::cos(phase);
         p[cogging_cos_Nm] = size * std::sin(phase);
         p[cogging_count] = r.pick({6.0, 7.0, 8.0, 11.0, 12.0, 14.0, 18.0, 21.0, 22.0, 24.0});
       },
       [](const Context& c) {
         const double m = 1.5 * c.torque_Nm;
         return List{{cogging_sin_Nm, -m, m, {0.05 * m}},
                     {cogging_cos_Nm, -m, m, {0.0}},
                     {cogging_count, 4.0, 30.0, {6.0, 12.0, 22.0}}};
       },
       {}},
      {"compliance",
       "mechanical.structure",
       motion,
       [](const Context& c) { return c.dt_s <= 0.0101; },
       [](Random& r, const Context& c, Values& p) {
         p[far_share] = r.uniform(0.25, 0.75);
         p[spring_Hz] = r.log_uniform(3.5, std::min(18.0, 0.2 / c.dt_s));
         p[spring_damping] = r.log_uniform(0.02, 0.12);
       },
       [](const Context&) {
         return List{{far_share, 0.08, 0.92, {0.3, 0.6}},
                     {spring_Hz, 2.0, 30.0, {5.0, 12.0}},
                     {spring_damping, 0.005, 0.4, {0.06}}};
       },
       {}},
      {"backlash",
       "mechanical.structure",
       motion,
       [](const Context& c) { return c.dt_s <= 0.0101; },
       [](Random& r, const Context&, Values& p) {
         p[far_share] = r.uniform(0.3, 0.8);
         p[spring_Hz] = r.uniform(14.0, 25.0);
         p[spring_damping] = r.uniform(0.1, 0.3);
         p[gap_deg] = r.log_uniform(0.8, 9.0);
       },
       [](const Context&) {
         return List{{far_share, 0.08, 0.92, {0.35, 0.6}},
                     {spring_Hz, 5.0, 40.0, {18.0}},
                     {spring_damping, 0.02, 0.8, {0.2}},
                     {gap_deg, 0.2, 20.0, {1.5, 5.0}}};
       },
       {"compliance"}},
      {"presliding_friction",
       "mechanical.friction",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[bristle_Nm] = c.torque_Nm * r.log_uniform(0.1, 0.6);
         p[bristle_deg] = r.log_uniform(0.8, 20.0);
       },
       [](const Context& c) {
         return List{{bristle_Nm, 0.0, 2.0 * c.torque_Nm, {0.2 * c.torque_Nm}},
                     {bristle_deg, 0.2, 40.0, {2.0, 10.0}}};
       },
       {"coulomb_friction"}},
      {"actuation_delay",
       "mechanical.drive",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[delay_s] = r.uniform(std::max(0.004, 0.4 * c.dt_s), 0.028);
       },
       [](const Context&) {
         return List{{delay_s, 0.0, 0.06, {0.005, 0.015}}};
       },
       {}},
      // The servo takes the target that was logged s ago: a bus, a PWM frame.
      {"target_delay",
       "mechanical.drive",
       motion,
       [](const Context& c) { return c.servo; },
       [](Random& r, const Context& c, Values& p) {
         p[target_delay_s] = r.uniform(std::max(0.012, 1.5 * c.dt_s), 0.08);
       },
       [](const Context&) {
         return List{{target_delay_s, 0.0, 0.15, {0.01, 0.03, 0.06}}};
       },
       {}},
      // J dw/dt = M - b w, lag dM/dt = Kt i - M: the current rises slowly in its winding.
      {"drive_lag",
       "mechanical.drive",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) {
         p[lag_s] = r.log_uniform(std::max(0.008, c.dt_s), 0.15);
       },
       [](const Context&) {
         return List{{lag_s, 0.002, 0.4, {0.01, 0.06}}};
       },
       {}},
      // J dw/dt = Kt i (1 + s sin(n theta) + c cos(n theta)) - b w: slots and magnets, n times a turn.
      {"torque_ripple",
       "mechanical.drive",
       motion,
       always,
       [](Random& r, const Context&, Values& p) {
         const double size = r.log_uniform(0.04, 0.4), phase = r.uniform(-3.1, 3.1);
         p[ripple_sin] = size * std::cos(phase);
         p[ripple_cos] = size * std::sin(phase);
         p[ripple_count] = r.pick({3.0, 4.0, 6.0, 7.0, 8.0, 11.0, 12.0, 14.0, 18.0, 21.0, 24.0});
       },
       [](const Context&) {
         return List{{ripple_sin, -0.9, 0.9, {0.08}},
                     {ripple_cos, -0.9, 0.9, {0.0}},
                     {ripple_count, 2.0, 30.0, {3.0, 6.0, 12.0, 22.0}}};
       },
       {}},
      {"torque_saturation",
       "mechanical.drive",
       motion,
       always,
       [](Random& r, const Context& c, Values& p) { p[torque_limit_Nm] = c.torque_Nm * r.uniform(0.7, 1.7); },
       [](const Context& c) {
         return List{
             {torque_limit_Nm, 0.2 * c.torque_Nm, 4.0 * c.torque_Nm, {0.9 * c.torque_Nm, 1.5 * c.torque_Nm}}};
       },
       {}},
      {"torque_fade",
       "mechanical.drive",
       motion,
       [](const Context& c) { return c.has_motor; },
       [](Random& r, const Context&, Values& p) { p[fade_per_K] = r.uniform(0.0015, 0.006); },
       [](const Context&) {
         return List{{fade_per_K, 0.0, 0.015, {0.002}}};
       },
       {}},
      constant("calibration.inertia", "mechanical.structure", inertia),
      constant("calibration.viscous", "mechanical.friction", viscous),
      constant("calibration.torque_constant", "mechanical.drive", torque_constant),
      {"angle_scale",
       "sensing.angle",
       {"angle_deg"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[angle_gain] =
             r.pick({57.29577951, 18.0, 1.0 / 18.0, 10.0, 2.0, 0.5, 1.25, 0.8, 1.1, 0.9, 0.01745329});
       },
       [](const Context&) {
         return List{{angle_gain, 0.01, 80.0, {0.02, 0.9, 1.5, 18.0, 57.0}}};
       },
       {}},
      {"angle_bias_drift",
       "sensing.angle",
       {"angle_deg", "rate_dps"},
       always,
       [](Random& r, const Context&, Values& p) { p[angle_drift_dps] = r.sign() * r.log_uniform(0.4, 4.0); },
       [](const Context&) {
         return List{{angle_drift_dps, -12.0, 12.0, {0.2}}};
       },
       {}},
      {"encoder_eccentricity",
       "sensing.angle",
       {"angle_deg"},
       always,
       [](Random& r, const Context&, Values& p) {
         p[eccentric_deg] = r.log_uniform(0.3, 3.0);
         p[eccentric_count] = r.pick({2.0, 4.0, 6.0, 8.0});
       },
       [](const Context&) {
         return List{{eccentric_deg, -6.0, 6.0, {0.5}}, {eccentric_count, 0.8, 12.0, {2.0, 4.0, 6.0, 8.0}}};
       },
       {}},
      {"rate_bias",
       "sensing.rate",
       {"rate_dps", "angle_deg"},
       always,
       [](Random& r, const Context&, Values& p) { p[rate_bias_dps] = r.sign() * r.log_uniform(0.5, 6.0); },
       [](const Context&) {
         return List{{rate_bias_dps, -20.0, 20.0, {0.3}}};
       },
       {}},
  };
  return effects;
}

/// Whether a cause shows only where the log holds a servo's target.
inline bool needs_servo(const std::string& id) { return id == "target_delay"; }

/// What is the same physics as a cause of the list, by other names: where one is the truth, the other is in its class.
///
/// Dry friction of F (1 + a) forward and F (1 - a) backward is friction of F either way and a torque of a F against
/// them both, while it slides and in what it takes to break away.
struct SamePhysics {
  std::vector<std::string> one, other;
};

inline const std::vector<SamePhysics>& axis_same_physics() {
  static const std::vector<SamePhysics> list = {
      {{"asymmetric_friction"}, {"coulomb_friction", "constant_torque"}},
  };
  return list;
}

/// The baseline's own constants with the slack that anybody's explanation may use.
inline std::vector<Free> axis_slack(const AxisContext& c, double slack = 0.04) {
  std::vector<Free> free;
  for (const int index : {inertia, viscous, torque_constant}) {
    const double value = c.model[static_cast<std::size_t>(index)];
    free.push_back({index, value * (1.0 - slack), value * (1.0 + slack), {value}});
  }
  return free;
}

/// Causes that no catalogue of INTERFACE lists.
enum class AxisUnknown {
  none,
  slipping_clutch,
  notch,
  run_out,
  warming_grease,
  gusts,
  wear,
  hardening_cable,
  vibration,
  weak_brake,
  end_stop
};

inline const std::vector<std::pair<AxisUnknown, std::string>>& axis_unknowns() {
  static const std::vector<std::pair<AxisUnknown, std::string>> list = {
      {AxisUnknown::slipping_clutch, "a clutch that slips between motor and load"},
      {AxisUnknown::notch, "a notch: it sticks at one position"},
      {AxisUnknown::run_out, "a bent shaft: friction that varies over the turn"},
      {AxisUnknown::warming_grease, "grease that thins while it is worked"},
      {AxisUnknown::gusts, "gusts of wind on the load"},
      {AxisUnknown::wear, "a bearing that breaks in mid recording"},
      {AxisUnknown::hardening_cable, "a cable that stiffens as it bends"},
      {AxisUnknown::vibration, "a vibration from outside, not logged"},
      {AxisUnknown::weak_brake, "a drive that is weak while it brakes"},
      {AxisUnknown::end_stop, "an elastic end stop"},
  };
  return list;
}

}  // namespace gap_benchmark
