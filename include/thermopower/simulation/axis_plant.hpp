// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/board_pid.hpp>
#include <thermopower/simulation/gimbal_axis.hpp>
#include <thermopower/simulation/gimbal_drive.hpp>
#include <thermopower/simulation/motor_body.hpp>

/// @file axis_plant.hpp
/// One axis of the rig: mechanics, drive, temperatures and the board's loop.

namespace thermopower::simulation {

/// Degrees in a radian.
constexpr double deg_per_rad = 57.29577951308232;

/// One axis with everything on it. Two clocks: the board's cycle, at which torque is computed and the
/// mechanics move, and a slower one for what changes slowly (temperatures, supply, POWER).
///
///     plant.power(power_param, supply_V);                          // every few milliseconds
///     plant.warm(around, dt_s);
///     for (...) plant.move(plant.ask(error_deg, p_gain, board_dt_s), disturbance_Nm, base, board_dt_s);
///
/// @tparam Number  double, float, or `Lanes`: one axis per lane
///
/// @snippet simulation_examples.cpp axis plant
/// How to: @ref rig.
template <class Number>
class AxisPlant {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  using Real = typename thermopower::detail::Numeric<Number>::Real;

public:
  using Scalar = Number;  ///< What it computes in.

  /// What describes the axis.
  struct Config {
    typename GimbalAxis<Number>::Config mechanics;  ///< Camera, bearing, cable.
    GimbalDrive<Number> drive;                      ///< Motor and amplifier.
    typename MotorBody<Number>::Config body;        ///< Heat.
    typename BoardPid<Number>::Config pid;          ///< The board's loop.
  };

  /// What an axis starts from.
  struct Start {
    Number angle_deg;  ///< Of the camera, in space.
    Number winding_C;  ///< Temperature of the winding.
    Number body_C;     ///< Temperature of the body.
  };

  /// @param config  the axis; taken as it is
  /// @param start   at rest in space, with these temperatures
  AxisPlant(const Config& config, const Start& start) noexcept
      : mechanics_(config.mechanics, {start.angle_deg * rad_per_deg(), start.angle_deg * Real(0)}),
        drive_(config.drive),
        body_(config.body, {start.winding_C, start.body_C}),
        pid_(config.pid),
        driven_(config.drive.at(Number(start.angle_deg * Real(0)), Number(start.angle_deg * Real(0)),
                                start.winding_C, start.body_C)) {}

  /// Conductance this axis would put across the supply. @param power_param  0 .. 255
  Number load_S(const Number& power_param) const noexcept {
    return drive_.load_at(power_param, body_.state().winding_C);
  }

  /// Sets POWER, and the torque and the heat that follow from it. @param power_param  0 .. 255  @param
  /// supply_V  at the board
  void power(const Number& power_param, const Number& supply_V) noexcept {
    driven_ = drive_.at(power_param, supply_V, body_.state().winding_C, body_.state().body_C);
  }

  /// Carries the temperatures on at the heat of the last power(). @param dt_s  up to a second
  void warm(const Surroundings<Number>& around, Real dt_s) noexcept {
    body_.step(driven_.heat_W, around, dt_s);
  }

  /// First half of a board cycle: what its loop asks for.
  /// @param read_error_deg  target less camera angle as the board's IMU tells it; the short way round
  /// @param p_gain          P, 0 .. 255
  /// @return share of the available torque, -1 .. 1
  const Number& ask(const Number& read_error_deg, const Number& p_gain, Real dt_s) noexcept {
    return pid_.step(read_error_deg, rate_deg_per_s(), p_gain, dt_s);
  }

  /// Second half: the mechanics under a share of the torque. @param share  -1 .. 1
  void move(const Number& share, const Number& disturbance_Nm, const BaseMotion<Number>& base,
            Real dt_s) noexcept {
    mechanics_.step({Number(share * driven_.available_Nm), disturbance_Nm, base}, dt_s);
  }

  /// Angle of the camera in space. @return degrees, any number of turns
  Number angle_deg() const noexcept { return mechanics_.state().angle_rad * static_cast<Real>(deg_per_rad); }
  /// Speed of the camera in space. @return deg/s
  Number rate_deg_per_s() const noexcept {
    return mechanics_.state().rate_rad_per_s * static_cast<Real>(deg_per_rad);
  }

  const GimbalAxis<Number>& mechanics() const noexcept { return mechanics_; }  ///< Camera, bearing, cable.
  /// Torque and heat of the last power().
  const typename GimbalDrive<Number>::State& driven() const noexcept { return driven_; }
  /// Winding and body.
  const typename MotorBody<Number>::State& temperatures() const noexcept { return body_.state(); }
  /// The board's loop.
  const typename BoardPid<Number>::State& board() const noexcept { return pid_.state(); }

private:
  static Real rad_per_deg() noexcept { return static_cast<Real>(1.0 / deg_per_rad); }

  GimbalAxis<Number> mechanics_;
  GimbalDrive<Number> drive_;
  MotorBody<Number> body_;
  BoardPid<Number> pid_;
  typename GimbalDrive<Number>::State driven_;
};

}  // namespace thermopower::simulation
