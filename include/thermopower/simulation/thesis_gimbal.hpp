// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/axis_plant.hpp>
#include <thermopower/simulation/battery.hpp>

/// @file thesis_gimbal.hpp
/// The gimbal of the thesis as a simulated rig: two BGM2606-90T (roll, pitch), one BGM5208-200-12 (yaw).
///
/// Measured there and fitted here: resistance, drive exponent, heat capacities and losses, from Tables 4.1
/// to 4.3 and 4.6; a test compares the outcome with these and with Tables 5.1 and 5.3. The copper's share of
/// the heat capacity and its coupling to the body cannot be seen in those tables and are typical of motors of
/// that size.
///
/// Not measured there, and assumed: torque constants (0.045 and 0.19 N m at full power, cold: the class of
/// such motors), imbalance, friction, cable. Inertias are those for which the thesis's auto-tuned P gains
/// (section 4.2) give every axis the same crossover of about 40 rad/s at POWER 89; D and I are set for a
/// damping of 0.7 and a reset of half a second there.

namespace thermopower::simulation {

/// Electrical and thermal side of the BGM2606-90T.
template <class Number>
void set_bgm2606_90t(typename AxisPlant<Number>::Config& axis) {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  axis.drive = {{number(11.1), number(0.00393), number(25.0)}, number(0.93), number(0.0384), number(-0.0012)};
  axis.body = {number(4.5),
               number(21.5),
               number(0.45),
               {number(0.025), number(0.25), number(20.0)},
               number(0.02),
               number(0.6),
               {number(0.0038), number(0.9)}};
}

/// Electrical and thermal side of the BGM5208-200-12.
template <class Number>
void set_bgm5208_200_12(typename AxisPlant<Number>::Config& axis) {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  axis.drive = {{number(17.5), number(0.00393), number(25.0)}, number(0.95), number(0.256), number(-0.0012)};
  axis.body = {number(18.0),
               number(138.0),
               number(1.2),
               {number(0.058), number(0.25), number(20.0)},
               number(0.05),
               number(0.6),
               {number(0.011), number(0.9)}};
}

/// Share of the torque per degree and count of P: the same for every axis of a board.
constexpr double thesis_share_per_deg = 0.031;

/// The roll axis: small inertia, the least balanced.
template <class Number>
typename AxisPlant<Number>::Config thesis_roll() {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  typename AxisPlant<Number>::Config axis;
  axis.mechanics = {
      number(3.0e-4), number(0.004),
      number(-1.3),   {number(0.0012), number(0.0018), number(0.15), number(0.02), number(2.0e-4)},
      number(0.004),  number(0.1),
      number(3.0e-4), number(84.0)};
  set_bgm2606_90t<Number>(axis);
  axis.pid = {number(thesis_share_per_deg), number(1.05), number(0.0178)};
  return axis;
}

/// The pitch axis: ten times the inertia, better balanced.
template <class Number>
typename AxisPlant<Number>::Config thesis_pitch() {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  typename AxisPlant<Number>::Config axis;
  axis.mechanics = {
      number(3.0e-3), number(0.0025),
      number(0.9),    {number(0.0012), number(0.0018), number(0.15), number(0.02), number(2.0e-4)},
      number(0.003),  number(-0.1),
      number(3.0e-4), number(84.0)};
  set_bgm2606_90t<Number>(axis);
  axis.pid = {number(thesis_share_per_deg), number(9.5), number(0.17)};
  return axis;
}

/// The yaw axis: no weight to hold, the stiffest cable, the strongest motor.
template <class Number>
typename AxisPlant<Number>::Config thesis_yaw() {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  typename AxisPlant<Number>::Config axis;
  axis.mechanics = {
      number(3.0e-3), number(0.0),
      number(0.0),    {number(0.003), number(0.0045), number(0.15), number(0.02), number(5.0e-4)},
      number(0.006),  number(0.2),
      number(1.5e-3), number(84.0)};
  set_bgm5208_200_12<Number>(axis);
  axis.pid = {number(thesis_share_per_deg), number(1.65), number(0.035)};
  return axis;
}

/// The bench supply of the thesis: 13 V that do not move.
template <class Number>
typename Battery<Number>::Config bench_supply() {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const auto number = [](double value) { return Math::constant(static_cast<Real>(value)); };
  return {number(13.0), number(13.0), number(3.6e6), number(0.0)};
}

}  // namespace thermopower::simulation
