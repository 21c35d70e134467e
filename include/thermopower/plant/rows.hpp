// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/invalid_input.hpp>
#include <thermopower/plant/radians.hpp>
#include <thermopower/plant/signal.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace thermopower::plant {

/// A missing sample.
inline constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// The distance by which a stamp may miss a grid's next point and still belong to it. It covers rounding of the stamp,
/// which may count from 1970, and of the seconds since a run began.
inline double stamp_rounding_s(double at_s, double run_start_s) {
  return 4e-16 * std::abs(at_s) + 1e-9 * (1.0 + std::abs(at_s - run_start_s));
}

/// Half-open range of rows [begin, end) that belong to one run; the model's state starts anew at `begin`.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method.
struct RunSpan {
  Eigen::Index begin = 0;  ///< first row
  Eigen::Index end = 0;    ///< one past the last row
  std::string label;       ///< text of the `run` column, may be empty
  /// Whether it was under way before its first row, and nobody knows how: what it was commanded, and states that nobody
  /// measures, are unknown there.
  bool goes_on = false;
  /// Charge that the supply had given before its first row, as far as that is known; see RecordedCharge.
  double drawn_Ah = 0.0;
  /// Whether the command of its first row was in force before that, too; else an axis was idle there.
  bool was_driven = false;

  /// Number of rows.
  Eigen::Index size() const { return end - begin; }
};

/// The unknown part of a command between the rows: errors by row of its mean until the next one, in its unit.
///
/// @snippet plant_examples.cpp unknown command
/// How to: @ref gap_files.
struct UnknownCommand {
  Eigen::VectorXd between;  ///< of each row on its own; empty: it is known
  Eigen::VectorXd
      shift;  ///< of all rows together, with signs: all are early or late by as much; empty: they are not

  /// Whether anything is unknown.
  bool any() const { return between.size() > 0 || shift.size() > 0; }
  /// An error of a row's command: its own, of so many standard deviations, and what all may be off by.
  double error(Eigen::Index row, double standard_deviations) const {
    return (between.size() > 0 ? standard_deviations * between[row] : 0.0) +
           (shift.size() > 0 ? shift[row] : 0.0);
  }
};

/// Where the heat of the thermal model comes from.
enum class HeatSource {
  law,       ///< the current law, from `power_param`
  measured,  ///< the recorded `current_A`
  drive,     ///< the recorded `drive_A`
  recorded,  ///< nothing but the recorded `heat_W`
  none,      ///< nothing recorded: temperature is not judged
};

/// Something that is left out, because a column is missing or cannot be believed.
struct NotJudged {
  std::string what;      ///< the column that would show it, or `the axis`; empty: all that is left
  std::string sentence;  ///< what is not judged, and why
};

/// A recording as a rollout wants it: inputs without holes, outputs with theirs, and what can be judged.
///
/// @snippet plant_examples.cpp rollout
/// How to: @ref gap_method.
struct Inputs {
  std::string name;           ///< of the recording
  Eigen::VectorXd t_s;        ///< stamps of the rows, strictly increasing in a run
  std::vector<RunSpan> runs;  ///< rows between which time passes
  // Held inputs and covariates by row; empty where not recorded. Holes hold the value before them.
  Eigen::VectorXd power_param;     ///< POWER, 0..255
  Eigen::VectorXd drive_A;         ///< commanded current of the axis
  Eigen::VectorXd voltage_V;       ///< at a brushed motor that drives the axis
  Eigen::VectorXd torque_Nm;       ///< external torque on the driven inertia
  Eigen::VectorXd heat_W;          ///< into the body, in the place of the winding's
  bool closed_loop = false;        ///< the command is not recorded: a servo makes it of its target
  Eigen::VectorXd target_deg;      ///< of the servo
  Eigen::VectorXd target_dps;      ///< of the servo
  bool target_moves = false;       ///< targets go straight from row to row; else they hold
  double target_lead = 0.0;        ///< rows by which moving targets are ahead of that
  Eigen::VectorXd seen_deg;        ///< measured angle without holes, of a closed loop; else empty
  Eigen::VectorXd seen_dps;        ///< measured rate without holes, of a closed loop; else empty
  bool effort_is_output = false;   ///< of a closed loop: `current_A` is compared with what the servo asks for
  Eigen::VectorXd servo_A;         ///< of a closed loop: what the servo makes of the measured motion
  Eigen::VectorXd servo_integral;  ///< of a closed loop: the servo's integral before each row
  Eigen::VectorXd target_C;        ///< of the heater's loop
  bool heater_closed = false;      ///< the duty is not recorded: a loop makes it of `target_C`
  Eigen::VectorXd supply_V;        ///< supply voltage
  Eigen::VectorXd ambient_C;       ///< air temperature
  Eigen::VectorXd airspeed_mps;    ///< of the air past the motor
  Eigen::VectorXd neighbour_C;     ///< temperature of what is mounted next to it
  Eigen::VectorXd covariate_rate_dps;       ///< rotation as an input of the bench models
  Eigen::VectorXd covariate_motor_C;        ///< motor temperature as an input of the axis
  Eigen::VectorXd held_current_A;           ///< current as an input of the thermal model
  Eigen::VectorXd held_motor_C;             ///< temperature as an input of the electrical model
  double nominal_V = 12.0;                  ///< stands in for `supply_V` where that is empty
  std::vector<Eigen::VectorXd> own_inputs;  ///< of a plant of one's own, in its order; held, complete
  bool own = false;                         ///< the signals are those of a plant of one's own
  Eigen::VectorXd repeats;                  ///< samples averaged in each row; empty: one
  std::array<double, actuator_signal_count>
      sample_noise{};              ///< of what was averaged: standard deviation of one sample's
                                   ///< noise, as all of them tell it; 0: not told
  double command_noise = 0.0;      ///< standard deviation of what is noise in the command, in its unit
  UnknownCommand command_unknown;  ///< what it did between the rows, as far as nobody knows
  double current_noise_A = 0.0;    ///< the same of a recorded current that heats: its variance heats nothing
  HeatSource heat = HeatSource::none;  ///< what drives the thermal model
  Eigen::VectorXd
      next_share;  ///< of a bench: part of the interval after each row in which the next row's inputs are in
                   ///< force already, 0..1; empty: they hold until that row
  std::array<Eigen::VectorXd, signal_count> measured;  ///< by Signal; empty where not judged
  /// By Signal: readings between samples, for the starts of windows where another signal stands alone; NaN or empty where
  /// there are none. Nothing is judged by them.
  std::array<Eigen::VectorXd, signal_count> between_samples;
  std::vector<NotJudged> not_judged;  ///< what is left out, and why

  /// Number of rows.
  Eigen::Index rows() const { return t_s.size(); }
  /// Whether the duty is what a heater's loop makes of the recorded temperature.
  bool heater_answers() const { return target_C.size() > 0 && !heater_closed; }
  /// Whether inputs change at instants between the rows that nobody knows: `next_share` is their mean.
  bool switched_anytime() const { return (next_share.array() > 0.0 && next_share.array() < 1.0).any(); }
  /// Whether the command is known but for some error.
  bool errs_in_command() const { return command_noise > 0.0 || command_unknown.any(); }
  /// Whether the signal is recorded and has a law.
  bool judged(Signal signal) const { return measured[static_cast<std::size_t>(signal)].size() > 0; }
  /// Measured values of a judged signal.
  const Eigen::VectorXd& of(Signal signal) const { return measured[static_cast<std::size_t>(signal)]; }
  /// The start of a window at a row: the measured value, else one between samples; NaN without either.
  double start_of(Signal signal, Eigen::Index row) const {
    const auto at = static_cast<std::size_t>(signal);
    const double value = measured[at][row];
    return std::isfinite(value) || between_samples[at].size() == 0 ? value : between_samples[at][row];
  }
  /// Whether temperature or current is judged.
  bool bench() const {
    return !own && ((judged(Signal::current_A) && !effort_is_output) || judged(Signal::motor_C));
  }
  /// Whether angle or rate is judged.
  bool axis() const { return !own && (judged(Signal::angle_deg) || judged(Signal::rate_dps)); }
};

}  // namespace thermopower::plant
