// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/detail/check.hpp>

/// @file board_pid.hpp
/// What a gimbal board does between telemetry and torque, as far as it is published.

namespace thermopower::simulation {

/// The board's loop of one axis. The vendor publishes the parameters, not the equations; this is the
/// assumption the rig makes:
///
///     share = P s_P error + integral(s_I error) - s_D rate      within -1 .. 1
///     torque = share * (torque that POWER makes available)
///
/// `share` is the sine of the angle by which the field leads the rotor. So the loop's stiffness is P times
/// the available torque, which is why P must fall when POWER rises (eq 4.27). I and D stay as tuned. The
/// integral stops where the whole torque is used.
///
/// @snippet simulation_examples.cpp parts of an axis
/// How to: @ref rig.
template <class Number>
class BoardPid {
  static_assert(
      thermopower::detail::IsModelNumber<Number>::value,
      "thermopower: the Number of a simulated part must be float, double or a class that stands for one, such as lanes");

  using Real = typename thermopower::detail::Numeric<Number>::Real;

public:
  /// What one tunes on the board.
  struct Config {
    Number share_per_deg;    ///< s_P: share of the torque for a degree of error and one count of P. Above 0.
    Number share_per_deg_s;  ///< s_I: share for a degree of error that lasts a second. >= 0.
    Number share_per_deg_per_s;  ///< s_D: share for a degree per second. >= 0.
  };

  /// What one logs.
  struct State {
    Number integral;  ///< Share held by the integral, -1 .. 1.
    Number share;     ///< Share asked for in the last cycle, -1 .. 1.
  };

  /// Starts with an empty integral.
  explicit BoardPid(const Config& config) noexcept : config_(config) {
    state_.integral = config.share_per_deg * Real(0);
    state_.share = state_.integral;
  }

  /// One cycle of the board. @param p_gain  P, 0 .. 255  @return share of the available torque
  const Number& step(const Number& error_deg, const Number& rate_deg_per_s, const Number& p_gain,
                     Real dt_s) noexcept {
    state_.integral = within_one(Number(state_.integral + config_.share_per_deg_s * error_deg * dt_s));
    state_.share = within_one(Number(config_.share_per_deg * p_gain * error_deg + state_.integral -
                                     config_.share_per_deg_per_s * rate_deg_per_s));
    return state_.share;
  }

  const State& state() const noexcept { return state_; }     ///< After the last cycle.
  const Config& config() const noexcept { return config_; }  ///< The constants.

private:
  static Number within_one(const Number& share) noexcept {
    using Math = thermopower::detail::Numeric<Number>;
    return thermopower::detail::at_most(thermopower::detail::at_least(share, Math::constant(Real(-1))),
                                        Math::constant(Real(1)));
  }

  Config config_;
  State state_;
};

}  // namespace thermopower::simulation
