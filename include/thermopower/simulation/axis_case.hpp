// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/simulation/axis_plant.hpp>

/// @file axis_case.hpp
/// One axis at constant POWER in sway and wind: the unit of a batch.

namespace thermopower::simulation {

/// One axis and what happens to it. Numbers, or lanes of numbers: then one axis per lane.
template <class Number>
struct AxisCase {
  typename AxisPlant<Number>::Config config;  ///< The axis.
  typename AxisPlant<Number>::Start start;    ///< What it starts from; the angle is also the target.
  Number power;                               ///< POWER, 0 .. 255.
  Number p_gain;                              ///< P, 0 .. 255.
  Number supply_V;                            ///< Stiff.
  Surroundings<Number> around;                ///< Air.
  Number sway_deg;                            ///< Amplitude of the base's motion.
  Number sway_Hz;                             ///< Its frequency.
  Number sway_turns;                          ///< Its phase at the start, in turns.
  Number wind_Nm;                             ///< Amplitude of the torque on the camera.
  Number wind_Hz;                             ///< Its frequency.
  Number wind_turns;                          ///< Its phase at the start, in turns.
};

/// What came out.
template <class Number>
struct AxisOutcome {
  Number error_rms_deg;   ///< Pointing error.
  Number error_peak_deg;  ///< Largest magnitude.
  Number energy_J;        ///< Drawn from the supply.
  Number winding_C;       ///< At the end.
  Number body_C;          ///< At the end.
};

/// Clocks of a run.
struct AxisClock {
  double board_cycle_s = 0.0008;  ///< Torque and mechanics.
  int cycles_per_slow = 100;  ///< Temperatures and what follows from them: every 80 ms, against 10 s of the
                              ///< fastest winding.
};

/// Simulates a case.
/// @param duration_s  rounded to whole slow steps
template <class Number>
AxisOutcome<Number> run_case(const AxisCase<Number>& happens, double duration_s,
                             const AxisClock& clock = {}) noexcept {
  using Math = thermopower::detail::Numeric<Number>;
  using Real = typename Math::Real;
  const Real turn = static_cast<Real>(6.283185307179586), quarter = static_cast<Real>(1.5707963267948966);
  const Real cycle_s = static_cast<Real>(clock.board_cycle_s);
  const Real slow_s = static_cast<Real>(clock.board_cycle_s * clock.cycles_per_slow);
  const auto slow_steps = static_cast<long>(duration_s / (clock.board_cycle_s * clock.cycles_per_slow) + 0.5);

  AxisPlant<Number> plant(happens.config, happens.start);
  const Number zero = Math::constant(Real(0));
  const Number sway_rad = happens.sway_deg * static_cast<Real>(1.0 / deg_per_rad);
  const Number sway_omega = happens.sway_Hz * turn, wind_omega = happens.wind_Hz * turn;
  Number squares = zero, peak = zero, energy_J = zero;
  for (long slow = 0; slow < slow_steps; ++slow) {
    plant.power(happens.power, happens.supply_V);
    plant.warm(happens.around, slow_s);
    energy_J += plant.driven().heat_W * slow_s;
    Number recent = zero;
    for (int i = 0; i < clock.cycles_per_slow; ++i) {
      const Real now_s =
          static_cast<Real>((static_cast<double>(slow) * clock.cycles_per_slow + i) * clock.board_cycle_s);
      const Number sway = sway_omega * now_s + happens.sway_turns * turn;
      const Number wind = wind_omega * now_s + happens.wind_turns * turn;
      const Number sway_sine = sway_rad * sine(sway);
      const BaseMotion<Number> base = {sway_sine, sway_rad * sway_omega * sine(Number(sway + quarter)),
                                       -sway_omega * sway_omega * sway_sine};
      const Number error_deg = happens.start.angle_deg - plant.angle_deg();
      const Number share = plant.ask(error_deg, happens.p_gain, cycle_s);
      plant.move(share, Number(happens.wind_Nm * sine(wind)), base, cycle_s);
      const Number square = error_deg * error_deg;
      recent += square;
      peak = thermopower::detail::at_least(peak, square);
    }
    squares += recent;
  }
  const Real count = static_cast<Real>(slow_steps * clock.cycles_per_slow);
  AxisOutcome<Number> outcome = {Math::square_root(Number(squares / count)), Math::square_root(peak),
                                 energy_J, plant.temperatures().winding_C, plant.temperatures().body_C};
  return outcome;
}

}  // namespace thermopower::simulation
