// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/inline.hpp>
#include <thermopower/plant/invalid_input.hpp>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace thermopower::plant {

/// The supply where the recording has no `supply_V`.
struct SupplyModel {
  double nominal_V = 12.0;  ///< V, > 0
};

/// `"law": "ohmic"`: R(T) = resistance (1 + tempco (T - reference)), I = V_rms / R(T).
struct OhmicCurrentModel {
  double resistance_ohm = 10.0;   ///< ohm at the reference temperature, > 0
  double tempco_per_K = 0.00393;  ///< 1/K; 0 for a baseline that knows of none
  double reference_C = 25.0;      ///< degC
};

/// `"law": "thesis"`: I[mA] = (slope_V2 V^2 + slope_V1 V + slope_V0) T_C + base V^exponent with V = V_rms;
/// 0 when V <= minimum_V_rms, never below 0.
struct ThesisCurrentModel {
  double slope_V2_mA_per_K = 0.0;  ///< mA/(K V^2), thesis eq 4.1 to 4.5 with the program's signs
  double slope_V1_mA_per_K = 0.0;  ///< mA/(K V)
  double slope_V0_mA_per_K = 0.0;  ///< mA/K
  double base_mA = 0.0;            ///< mA at 1 V and 0 degC
  double exponent = 1.0;           ///< of the voltage, pure number
  double minimum_V_rms = 1.0;      ///< V, at or below which no current flows
};

/// `"law": "lumped"`: C dT/dt = I^2 R(T) - G (T - T_ambient).
struct LumpedThermalModel {
  double heat_capacity_J_per_K = 60.0;  ///< J/K, > 0
  double conductance_W_per_K = 0.1;     ///< W/K, > 0
};

/// `"law": "thesis"`: dT/dt [K/min] = r V_rms I - cooling (T - T_ambient), with
/// 1/r = (rinv_slope_V1 V + rinv_slope_V0) T_C + rinv_offset_V1 V + rinv_offset_V0 in W min/K.
struct ThesisThermalModel {
  double cooling_per_min = 0.1;  ///< 1/min, > 0
  double rinv_slope_V1 = 0.0;    ///< W min/(K^2 V)
  double rinv_slope_V0 = 0.0;    ///< W min/K^2
  double rinv_offset_V1 = 0.0;   ///< W min/(K V)
  double rinv_offset_V0 = 1.0;   ///< W min/K
  double minimum_V_rms = 1.0;    ///< V, at or below which there is no heat
};

/// `"law": "rigid"`: J dw/dt = Kt drive - b w, for a drive that commands the current. `"law": "voltage"`:
/// J dw/dt = Kt (u - Kt w) / R - b w, for a brushed motor at a voltage u.
///
/// @snippet plant_examples.cpp axis model
/// How to: @ref diagnose_a_gap.
struct RigidAxisModel {
  double inertia_kgm2 = 1e-3;             ///< kg m^2, > 0
  double viscous_Nms_per_rad = 1e-3;      ///< N m s/rad, >= 0
  double torque_constant_Nm_per_A = 0.1;  ///< N m/A, not 0
  double resistance_ohm = 0.0;            ///< ohm, > 0, of a motor at a voltage; 0: its current is commanded

  /// Whether a voltage drives the motor, and not a current.
  bool voltage_driven() const { return resistance_ohm != 0.0; }
  /// What brakes the axis for each rad/s, N m s/rad: viscous friction, and the motor's own voltage where one drives it.
  double drag_Nms_per_rad() const {
    return viscous_Nms_per_rad +
           (voltage_driven() ? torque_constant_Nm_per_A * torque_constant_Nm_per_A / resistance_ohm : 0.0);
  }
};

/// `"law": "position_pid"`: from `target_deg` to a command, sampled every `period_s` and held until the next one:
/// kp (target - angle) + kd (target rate - rate) + ki times the integral of the error. The target's rate is
/// `target_dps` where that is recorded, else 0. The integral is held where it alone asks for the limit.
///
/// The servos of hobby and robot kits do more: they go to a new target by a profile (follow_profile()), ignore a small error, and
/// limit how fast the command changes. These are settings of the servo, so no cause is fitted to them.
struct PositionPidServo {
  double kp_A_per_deg = 0.05;   ///< A/deg
  double kd_A_s_per_deg = 0.0;  ///< A s/deg
  double ki_A_per_deg_s = 0.0;  ///< A/(deg s)
  double limit_A = 1.0;         ///< of the command, > 0
  double period_s = 1e-3;       ///< between samples, > 0
  double delay_s = 0.0;         ///< from a sample to the torque, >= 0
  double slew_A_per_s = 0.0;    ///< largest change of the command in A/s, >= 0; 0: no limit
  double dead_zone_deg = 0.0;   ///< an error of at most that size counts as 0; >= 0
  double profile_dps = 0.0;     ///< largest rate of the set point in deg/s, >= 0; 0: it jumps to the target
  double profile_dps2 = 0.0;    ///< largest acceleration of the set point in deg/s^2, >= 0; 0: no limit
};

/// `"law": "velocity_pi"`: from `target_dps` to a command, sampled alike: kp (target - rate) + ki times the integral
/// of the error.
struct VelocityPiServo {
  double kp_A_s_per_deg = 0.01;  ///< A per deg/s
  double ki_A_per_deg = 0.0;     ///< A/deg
  double limit_A = 1.0;          ///< of the command, > 0
  double period_s = 1e-3;        ///< between samples, > 0
  double delay_s = 0.0;          ///< from a sample to the torque, >= 0
  double slew_A_per_s = 0.0;     ///< largest change of the command in A/s, >= 0; 0: no limit
};

/// `"law": "klipper_pid"`: the loop of a heater as Klipper has it, with the gains of its configuration, which count the duty in 255
/// parts. The slope is smoothed over `smooth_time_s`; the integral stands still while their sum is out of the limits.
struct KlipperPidHeater {
  double kp_per_K = 20.0;      ///< parts of 255 per kelvin, > 0
  double ki_per_K_s = 1.0;     ///< parts of 255 per kelvin second, >= 0
  double kd_s_per_K = 100.0;   ///< parts of 255 per kelvin a second, >= 0
  double max_power = 1.0;      ///< largest duty, above 0 to 1
  double smooth_time_s = 1.0;  ///< over which the slope is smoothed, >= 0
  double period_s = 0.3;       ///< between samples, > 0
};

/// `"law": "marlin_pid"`: the same as Marlin has it. Further than `functional_range_K` from the target there is all power or none,
/// and integral and slope begin anew. The slope is a moving average of which the newest has a share of 0.05.
struct MarlinPidHeater {
  double kp_per_K = 20.0;            ///< parts of 255 per kelvin, > 0
  double ki_per_K_s = 1.0;           ///< parts of 255 per kelvin second, >= 0
  double kd_s_per_K = 100.0;         ///< parts of 255 per kelvin a second, >= 0
  double max_power = 1.0;            ///< largest duty, above 0 to 1
  double functional_range_K = 10.0;  ///< > 0
  double period_s = 0.164;           ///< between samples, > 0
};

/// `"law": "bang_bang"`: all power from `max_delta_K` below the target until as much above it (Klipper's watermark, Marlin's bed).
struct BangBangHeater {
  double max_delta_K = 2.0;  ///< half the band, >= 0
  double max_power = 1.0;    ///< duty where it is on, above 0 to 1
  double period_s = 0.3;     ///< between samples, > 0
};

/// How a heater is driven to `target_C`; `std::monostate`: by nothing that the model knows.
using HeaterLaw = std::variant<std::monostate, KlipperPidHeater, MarlinPidHeater, BangBangHeater>;

/// The temperature that a heater's loop acts on in a diagnosis, where the duty is not recorded and the body's temperature is.
enum class HeaterActsOn {
  usual,  ///< a PID on the simulated one; a two-point loop on the recorded one, as noise makes its phase wander
  recorded,  ///< what the log has: its duty is then known, whatever is wrong with the body
  simulated  ///< the whole loop is simulated, even where the duty is recorded
};

/// Parameters of one effect by name.
using EffectParameters = std::map<std::string, double>;

/// One constant of a model: the block and name it has in the model file, and its value.
struct NamedConstant {
  std::string block;   ///< `supply`, `current`, `thermal`, `axis`, `servo` or `heater`
  std::string name;    ///< as in the file, such as `resistance_ohm`
  double value = 0.0;  ///< in the unit the name ends in
};

/// A constant that may be off: one field of the model, or several that only make sense scaled together (the
/// coefficients of one polynomial). As a cause the diagnosis calls it by its id after `calibration.`
///
/// @snippet plant_examples.cpp model
/// How to: @ref diagnose_a_gap, @ref gap_files.
struct CalibratedConstant {
  std::string id;                   ///< `resistance`, `heat_capacity`, ...
  std::string block;                ///< `current`, `thermal`, `axis`, `servo` or `effects.<id>`
  std::vector<std::string> fields;  ///< the model's fields that scale with it
  bool may_be_cause = true;         ///< off by more than what is known of it, it is a cause of its own
  bool has_slack = true;  ///< is known by itself; of a polynomial each coefficient is, not all together
  /// It is a place and no size, such as the angle at which a load hangs: it is off by so much and not by a factor, and may be 0
  /// or of the other sign. Its uncertainty is in its unit.
  bool is_place = false;

  /// The move of a fit that leaves the constant as it is: a place is moved by adding, another constant by a factor.
  double unmoved() const { return is_place ? 0.0 : 1.0; }

  /// The constant moved. @param by  a factor, of a place what is added
  template <class Scalar, class By>
  Scalar moved(const Scalar& value, const By& by) const {
    return is_place ? Scalar(value + by) : Scalar(value * by);
  }

  /// How far it is from `from` to `to`: the logarithm of the factor, of a place the difference.
  double distance(double from, double to) const { return is_place ? to - from : std::log(to / from); }

  /// Id of the effect whose parameter it is; empty for a constant of a block.
  std::string effect() const { return block.rfind("effects.", 0) == 0 ? block.substr(8) : std::string(); }
};

/// Whether a parameter of an effect is the rate within which a friction turns over: no data sheet has it, and where an axis
/// sticks it is as small as it may be.
inline bool names_a_transition(std::string_view parameter) { return parameter == "transition_rad_per_s"; }

/// Whether a parameter of an effect is a place and no size: a name says so that ends in `phase_rad` or `centre_rad`.
inline bool names_a_place(std::string_view parameter) {
  for (const std::string_view ending : {std::string_view("phase_rad"), std::string_view("centre_rad")})
    if (parameter.size() >= ending.size() && parameter.substr(parameter.size() - ending.size()) == ending)
      return true;
  return false;
}

class Plant;

/// A constant of a plant of one's own.
struct PlantConstant {
  std::string block;         ///< the part of the plant it belongs to
  std::string name;          ///< ends in its unit, as in `outflow_m3_per_s`
  std::string unit;          ///< as reports spell it; "1" for a pure number
  double value = 1.0;        ///< in that unit
  bool may_be_cause = true;  ///< may be off by more than is known of it; a known constant (gravity) is not
  bool above_zero = true;    ///< only values above 0 make sense
};

/// A plant of one's own in a model: its equations, and its constants.
struct PlantModel {
  std::string type;                        ///< what the plant calls itself, in messages
  std::shared_ptr<const Plant> equations;  ///< never null
  std::vector<PlantConstant> constants;    ///< in the order in which the equations read them
};

/// The simulation under test, as in a model file. Blocks may be absent: what they would say is not judged.
///
/// @snippet plant_examples.cpp model
/// How to: @ref diagnose_a_gap, @ref gap_files.
struct Model {
  std::string name;  ///< as reports call it
  /// Needed where the recording has no `supply_V`.
  std::optional<SupplyModel> supply;
  /// From voltage and temperature to current; `std::monostate`: absent.
  std::variant<std::monostate, OhmicCurrentModel, ThesisCurrentModel> current;
  /// From heat to temperature; `std::monostate`: absent.
  std::variant<std::monostate, LumpedThermalModel, ThesisThermalModel> thermal;
  /// From commanded current, or voltage, to motion.
  std::optional<RigidAxisModel> axis;
  /// From target to command, where the recording holds a target and no command; `std::monostate`: absent. Commands
  /// are currents; of a motor at a voltage, currents at standstill.
  std::variant<std::monostate, PositionPidServo, VelocityPiServo> servo;
  /// From a target temperature to the duty of the heater, where the recording holds `target_C` and no `power_param`.
  HeaterLaw heater;
  HeaterActsOn heater_acts_on = HeaterActsOn::usual;  ///< in a diagnosis
  std::map<std::string, EffectParameters> effects;    ///< id -> parameter -> value
  /// How well constants are known: standard deviation as a share of the value, above 0 to 1, by
  /// block.constant (as in `thermal.conductance_W_per_K`) and effects.id.parameter. Those that are not in it are
  /// known to 5 %.
  std::map<std::string, double> uncertainty;
  /// A plant of one's own in place of the blocks above; none: the library's actuator.
  std::optional<PlantModel> own;

  bool has_current() const {
    return !std::holds_alternative<std::monostate>(current);
  }  ///< electrical block?
  bool has_thermal() const { return !std::holds_alternative<std::monostate>(thermal); }  ///< thermal block?
  bool has_axis() const { return axis.has_value(); }                                   ///< mechanical block?
  bool has_servo() const { return !std::holds_alternative<std::monostate>(servo); }    ///< servo block?
  bool has_heater() const { return !std::holds_alternative<std::monostate>(heater); }  ///< heater block?
  /// Whether a diagnosis simulates the heater's whole loop, and not its answer to the recorded temperature.
  bool simulates_heater_loop() const {
    return heater_acts_on == HeaterActsOn::simulated ||
           (heater_acts_on == HeaterActsOn::usual && !std::holds_alternative<BangBangHeater>(heater));
  }

  /// Every constant of every block present, in a fixed order.
  std::vector<NamedConstant> constants() const;

  /// Value of a constant by its name in the file. `minimum_V_rms` exists in two blocks: qualify it as
  /// `current.minimum_V_rms`; any name may be qualified so, and parameters of its effects are
  /// `effects.<id>.<parameter>`. @throws InvalidInput where there is none.
  double get(std::string_view constant_name) const;

  /// Sets a constant by its name in the file (qualified or not). @throws InvalidInput where there is none.
  void set(std::string_view constant_name, double value);

  /// The constants that calibration may move, the parameters of the model's own effects included.
  std::vector<CalibratedConstant> calibrated() const;

  /// By what each of calibrated() is moved where one of them alone is: as ParameterPoint::factors has it.
  /// @param constant  its place in calibrated()
  /// @param distance  the logarithm of a factor; of a place a difference in its unit
  std::vector<double> moved(std::size_t constant, double distance) const;

  /// How well a constant is known, as a share of its value; of fields that scale together the worst known
  /// counts. `otherwise` where nothing is stated.
  double uncertainty_of(const CalibratedConstant& constant, double otherwise = 0.05) const;
  /// The same of a place where nothing is stated, rad: the zero of an angle is read from a log at rest, to a degree.
  static constexpr double place_known_to_rad = 0.02;
  /// The same of the transition of a friction: whoever wrote it down meant small.
  static constexpr double transition_known_to = 1.0;

  /// Time in which the body's temperature comes to within 1/e of where it goes, s, > 0; infinite where the model has no thermal
  /// block.
  double time_constant_s() const;

  /// The first fault, with the field and the expected value, or nothing. Effects are not looked into: the catalogue knows
  /// them.
  std::optional<std::string> validate() const;
};

}  // namespace thermopower::plant

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/plant/detail/model.hpp>
#endif
