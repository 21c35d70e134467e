// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../detail/numeric.hpp"
#include "cooling.hpp"
#include "detail/composition.hpp"
#include "heating.hpp"
#include "thermal_step.hpp"

/// @file actuator/thermal_model.hpp
/// The temperature of an actuator with one node, eq 3.9: dT/dt = r P - cooling.

namespace thermopower {

/// One-node thermal model: an actuator that is equally warm everywhere.
/// @tparam Heating  how a watt warms it: actuator/heating.hpp
/// @tparam Cooling  how it loses heat: cooling.hpp
/// @tparam Step     how a time step is made: thermal_step.hpp
///
/// Energy balance: with `HeatCapacityHeating` and a cooling law in watts, C (T2 - T1) is the heat in less the
/// heat lost. With constant power the temperature settles where the cooling equals r P; for `NewtonCooling`
/// that is T_air + P / G.
///
/// @snippet actuator_examples.cpp thermal model
/// How to: @ref custom_motor, @ref laws. Menu: @ref policies.
/// @ingroup actuator
template <class Heating = HeatCapacityHeating<>, class Cooling = NewtonCooling<>, class Step = ExactStep>
class ThermalModel {
  static_assert(
      detail::IsHeatingLaw<Heating>::value,
      "thermopower: the first parameter of ThermalModel must be a heating law, such as HeatCapacityHeating");

  static_assert(
      detail::IsCoolingLaw<Cooling>::value,
      "thermopower: the second parameter of ThermalModel must be a cooling law, such as NewtonCooling");

  static_assert(
      detail::IsThermalStep<Step>::value,
      "thermopower: the third parameter of ThermalModel must be EulerStep, ExactStep or LinearizedStep");

public:
  typedef typename Heating::Scalar Scalar;  ///< What it computes in.
  static_assert(!Step::needs_linear_laws() || (Heating::is_linear() && Cooling::is_linear()),
                "thermopower: ExactStep needs linear heating and cooling laws; take LinearizedStep or "
                "EulerStep for these");
  static_assert(Heating::is_heat_capacity() || !Cooling::is_in_watts(),
                "thermopower: this heating law has no heat capacity to turn a loss in watts into a rate; "
                "take RateCooling with it");

  /// What one tunes: the constants of both laws.
  struct Config {
    Heating heating;  ///< How a watt warms it.
    Cooling cooling;  ///< How it loses heat.

    /// Hands each field to an archive, in the order of a record: config_record.hpp.
    template <class Self, class Archive>
    static void each_field(Self& self, Archive& archive) {
      archive(self.heating, self.cooling);
    }
    /// First constant out of its range, or ConfigError::none.
    ConfigError validate() const noexcept { return first_error(heating.validate(), cooling.validate()); }
  };

  /// What acts on the actuator during a step; constant over the step.
  struct Inputs {
    Scalar power_W;  ///< Heat, normally V_rms I. For `ThesisHeating` it must be V_rms I (that is how r was
                     ///< fitted).
    Scalar v_rms_V;  ///< Read by `ThesisHeating` only.
    Surroundings<Scalar> around;  ///< Air temperature and speed.
  };

  /// What one logs: the temperature and how it came about.
  struct State {
    Scalar motor_C;          ///< Temperature after the last step.
    Scalar heating_K_per_s;  ///< r P at the start of the last step.
    Scalar cooling_K_per_s;  ///< Cooling at the start of the last step.
    Scalar rate_K_per_s;     ///< heating - cooling: dT/dt of eq 3.9, which the limiter of eq 4.23 uses.
  };

  /// @param config   constants; call `validate()` once
  /// @param motor_C  temperature to start from
  ThermalModel(const Config& config, const Scalar& motor_C) noexcept : config_(config) { start(motor_C); }

  /// First constant out of its range, or ConfigError::none.
  ConfigError validate() const noexcept { return config_.validate(); }

  /// Sets the temperature and forgets the rest.
  void start(const Scalar& motor_C) noexcept {
    const Scalar zero = motor_C * Real(0);
    state_.motor_C = motor_C;
    state_.heating_K_per_s = zero;
    state_.cooling_K_per_s = zero;
    state_.rate_K_per_s = zero;
  }

  /// Advances by `dt_s` seconds (>= 0). NaN or Inf in an input makes the temperature NaN, which the limiter
  /// treats as hot.
  const State& step(const Inputs& inputs, const Scalar& dt_s) noexcept {
    const Scalar rise = config_.heating.rise_K_per_J(inputs.v_rms_V, state_.motor_C);
    state_.heating_K_per_s = rise * inputs.power_W;
    state_.cooling_K_per_s = config_.cooling.rate_K_per_s(state_.motor_C, inputs.around, rise);
    state_.rate_K_per_s = state_.heating_K_per_s - state_.cooling_K_per_s;
    const Scalar slope = config_.cooling.slope_per_s(state_.motor_C, inputs.around, rise) -
                         inputs.power_W * config_.heating.rise_slope_per_J(inputs.v_rms_V, state_.motor_C);
    state_.motor_C = state_.motor_C + Step::change_K(state_.rate_K_per_s, slope, dt_s);
    return state_;
  }

  const State& state() const noexcept { return state_; }                        ///< After the last step.
  Scalar hottest_C() const noexcept { return state_.motor_C; }                  ///< The only node.
  Scalar hottest_rate_K_per_s() const noexcept { return state_.rate_K_per_s; }  ///< dT/dt of eq 3.9.
  const Config& config() const noexcept { return config_; }                     ///< The constants.

private:
  typedef typename detail::Numeric<Scalar>::Real Real;
  Config config_;
  State state_;
};

}  // namespace thermopower
