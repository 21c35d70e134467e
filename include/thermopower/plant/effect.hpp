// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/joint_description.hpp>
#include <thermopower/plant/submodel.hpp>

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thermopower::plant {

/// A need of an effect before it can be judged: a block of the model, or a column of the recordings.
enum class Need {
  current_model,         ///< the model says how much current flows
  thermal_model,         ///< the model says how the body warms, and `motor_C` is recorded
  axis_model,            ///< the model says how the axis moves, and its motion is recorded
  ohmic_without_tempco,  ///< the model's winding is ohmic and has no temperature coefficient
  current_A,             ///< recorded
  motor_C,               ///< recorded
  angle_deg,             ///< recorded
  rate_dps,              ///< recorded
  power_param,           ///< recorded
  airspeed_mps,          ///< recorded
  neighbour_C,           ///< recorded
  two_nodes,  ///< the model's body has winding and surface: `second_thermal_mass` is among its effects
  supply_not_logged,  ///< there is no column `supply_V`
  thesis_thermal,  ///< the body warms by the thesis's law, whose heat capacity depends on voltage and temperature
  open_loop,       ///< the command is recorded
  closed_loop,  ///< the model has a servo, its target is recorded and the command is not
  shown_inertia  ///< drag does not settle the axis within a row: else no row tells what is driven from what hangs on it
};

/// As lists of effects print it.
inline const char* to_string(Need need) {
  switch (need) {
    case Need::current_model:
      return "current";
    case Need::thermal_model:
      return "thermal";
    case Need::axis_model:
      return "axis";
    case Need::ohmic_without_tempco:
      return "ohmic current without tempco";
    case Need::current_A:
      return "current_A";
    case Need::motor_C:
      return "motor_C";
    case Need::angle_deg:
      return "angle_deg";
    case Need::rate_dps:
      return "rate_dps";
    case Need::power_param:
      return "power_param";
    case Need::airspeed_mps:
      return "airspeed_mps";
    case Need::neighbour_C:
      return "neighbour_C";
    case Need::supply_not_logged:
      return "no supply_V";
    case Need::two_nodes:
      return "a model with second_thermal_mass";
    case Need::thesis_thermal:
      return "the thesis's thermal law";
    case Need::open_loop:
      return "command recorded";
    case Need::closed_loop:
      return "servo and target, no command";
    case Need::shown_inertia:
      return "rows shorter than the axis settles in";
  }
  return "?";
}

/// An input by whose largest magnitude the starts of a parameter may be scaled.
enum class Input {
  none,         ///< the starts are in the parameter's unit
  drive_A,      ///< shares of the largest command
  power_param,  ///< shares of the largest power parameter
  supply_V      ///< shares of the largest supply voltage
};

/// A recorded variable that a curve is a function of.
enum class CurveVariable {
  angle_deg,  ///< measured angle
  rate_dps,   ///< measured rate, or the angle's slope
  drive_A,    ///< command; of a motor at a voltage, the current at standstill
  rise_K,     ///< measured temperature over that of the air
  current_A,  ///< measured current
  motor_C     ///< measured temperature
};

/// The reference of a curve's values, for their likely size.
enum class CurveScale {
  drive_Nm,  ///< largest torque of the drive
  drive_A,   ///< largest command
  heat_W,    ///< largest heat
  supply_V   ///< largest voltage
};

/// The mark of a curve: a smooth function of a recorded variable that nobody has named.
///
/// Its first two parameters are where its first and its last knot lie; they are not fitted but taken from the range of the
/// data. The others are the values at the knots, evenly spaced between these.
struct CurveShape {
  CurveVariable variable = CurveVariable::angle_deg;  ///< that it is a function of
  CurveScale scale = CurveScale::drive_Nm;            ///< what its values are relative to
  /// Size of that in the data, in the unit of the values; 0 where no data have given the curve its range. Then it cannot be
  /// judged.
  double size = 0.0;
};

/// Parameters of a curve before its knots.
inline constexpr int curve_support_count = 2;

/// Values at the knots of a curve.
inline constexpr int curve_knot_count = 10;

/// One parameter of an effect. `parameter()` builds one.
struct Parameter {
  std::string name;                 ///< as in model files and reports
  std::string unit;                 ///< "1" for a pure number
  double lower = 0.0;               ///< physical bound
  double upper = 1.0;               ///< physical bound
  std::vector<double> starts = {};  ///< where fits begin, inside the bounds, at least one
  bool logarithmic = false;  ///< positive and known by order of magnitude only: fitted as its logarithm
  Input starts_relative_to = Input::none;  ///< the starts are fractions of its largest magnitude
  std::optional<double> standard = {};     ///< its value where a model leaves it out; none: it must be given
  double absent_at = 0.0;                  ///< where it is this, the effect is not there: 1 of a gain
  /// At its bounds the effect is another one: a fit that ends there explains nothing.
  bool degenerate_at_bounds = false;
  /// The same at its upper bound alone.
  bool degenerate_at_upper = false;
  /// It is a detail of the effect's shape: it stays at its standard, which it must have, until the effect without it is
  /// fitted and leaves what the detail takes away.
  bool refines = false;
  /// Two families of shapes meet at its standard: a fit that ends below it looks at the other side, too.
  bool two_families = false;
  /// Name of another parameter of the effect that it must exceed: below, nothing shows it, and a fit that ends
  /// there explains nothing. Empty: none.
  std::string exceeds = {};
  /// It counts periods of the angle in radians per radian; so many of them must lie within the recorded travel, or
  /// they only imitate something slower. 0: any.
  double periods_in_travel = 0.0;
  /// A rate that the motion must reach: beyond its fastest nothing shows it, and a fit that ends there explains nothing.
  bool within_the_motion = false;
  /// The data give it its value, and it is not fitted: an end of the range of a curve (CurveShape).
  bool given_by_data = false;
  int index = -1;  ///< by which the effect reads it; -1: unchecked, it is read in the order of the list
};

/// Builds a Parameter, each property by its name.
///
/// @snippet plant_examples.cpp effect of one's own
/// How to: @ref diagnose_a_gap.
class ParameterBuilder {
public:
  /// @param index  by which the effect reads it, an enumerator: the catalogue checks it against the list
  /// @param name   as in model files and reports
  ParameterBuilder(int index, std::string_view name) {
    parameter_.index = index;
    parameter_.name = name;
    parameter_.unit = "1";
  }
  /// Of its value; "1" (a pure number) unless said otherwise.
  ParameterBuilder& unit(std::string_view text) { return parameter_.unit = text, *this; }
  /// Physical bounds, lower < upper.
  ParameterBuilder& within(double lower, double upper) {
    return parameter_.lower = lower, parameter_.upper = upper, *this;
  }
  /// Positive, and known by order of magnitude only: fits move its logarithm.
  ParameterBuilder& logarithmic() { return parameter_.logarithmic = true, *this; }
  /// Where fits begin, within the bounds.
  ParameterBuilder& starts(std::initializer_list<double> values) { return parameter_.starts = values, *this; }
  /// Where fits begin, as shares of the largest magnitude of an input.
  ParameterBuilder& starts_as_shares_of(Input input, std::initializer_list<double> values) {
    return parameter_.starts_relative_to = input, parameter_.starts = values, *this;
  }
  /// Its value where a model leaves it out.
  ParameterBuilder& standard(double value) { return parameter_.standard = value, *this; }
  /// Where it is this, the effect is not there; 0 unless said otherwise.
  ParameterBuilder& absent_at(double value) { return parameter_.absent_at = value, *this; }
  /// It must exceed another parameter of the effect, by name: below, the effect does not show.
  ParameterBuilder& exceeds(std::string_view other) { return parameter_.exceeds = other, *this; }
  /// A rate that the motion must reach.
  ParameterBuilder& within_the_motion() { return parameter_.within_the_motion = true, *this; }
  /// A constant of the model that does the same where it moves, by its id.
  /// It counts periods in the angle, and so many must lie within the recorded travel.
  ParameterBuilder& periods_in_travel(double least) { return parameter_.periods_in_travel = least, *this; }
  /// It stays at its standard until the effect without it leaves what it takes away.
  ParameterBuilder& refines() { return parameter_.refines = true, *this; }
  /// Two families of shapes meet at its standard.
  ParameterBuilder& two_families() { return parameter_.two_families = true, *this; }
  /// The data give it its value, and it is not fitted.
  ParameterBuilder& given_by_data() { return parameter_.given_by_data = true, *this; }
  /// At its bounds the effect is another one: a fit that ends there explains nothing.
  ParameterBuilder& degenerate_at_bounds() { return parameter_.degenerate_at_bounds = true, *this; }
  /// The same at its upper bound alone.
  ParameterBuilder& degenerate_at_upper() { return parameter_.degenerate_at_upper = true, *this; }

  /// The finished parameter.
  operator Parameter() const { return parameter_; }  // NOLINT: lists of parameters are lists of these

private:
  Parameter parameter_;
};

/// Begins a parameter: `parameter(lag_s, "lag_s").unit("s").within(0.05, 3000.0).logarithmic().starts({3.0})`.
/// @param index  by which the effect reads it: `enum Parameters { lag_s };` and `p[lag_s]`
/// @param name   as in model files and reports
inline ParameterBuilder parameter(int index, std::string_view name) { return {index, name}; }

/// A state of the joint that an effect brings: its hooks find it in `terms.own`.
struct HiddenState {
  std::string name;  ///< as exports call it, with its unit: `bristle_rad`
  std::string unit;  ///< of its value
};

/// The name of an effect if two of its parameters are equal: dry friction that is alike in both directions is dry friction.
struct WhereEqual {
  int one = -1;       ///< place of a parameter among the effect's
  int other = -1;     ///< place of another, in the same unit
  std::string cause;  ///< the other effect's id, or that of a constant, such as `calibration.viscous`
};

/// The name of an effect if one of its parameters is small beside another: dry friction that hardly rises near standstill
/// is dry friction.
struct WhereSmall {
  int small = -1;     ///< place of a parameter among the effect's
  int beside = -1;    ///< place of the one that it is measured against, in the same unit
  std::string cause;  ///< as in WhereEqual
};

/// The description of an effect, for people and for the engine. The equation in code is the effect's hooks.
struct EffectInfo {
  std::string id;                     ///< stable, snake_case
  SubmodelName submodel;              ///< where it acts
  std::string equation;               ///< one line of text
  std::string prose;                  ///< one line: what it is and how it shows
  std::vector<Parameter> parameters;  ///< in the order the hooks see them
  std::vector<Need> needs;            ///< without which it cannot be judged
  std::string experiment;             ///< the excitation that shows it best
  /// What the joint remembers because of it; only with hooks on AxisTerms or FrictionTerms, at most
  /// `most_own_states` in a model.
  std::vector<HiddenState> states = {};
  /// Whether it is looked at only where no other single cause brings the training data to their noise, or where what does fails on
  /// held-out data: it costs much to
  /// simulate, or is a richer kind of a cause that is cheaper.
  bool costly = false;
  /// The slowest time constant in s that its parameters bring, where it needs to be seen: one that exceeds the
  /// longest run stands for something that does not change in it. None: any.
  double (*slowest_s)(const double* parameters) = nullptr;
  /// Whether it is what it is called with these parameters; a fit that ends where it is not stands for something else. None:
  /// always.
  bool (*is_itself)(const double* parameters) = nullptr;
  /// The same of a friction where the model has no dry friction already, to which it may add. None: always.
  bool (*is_itself_alone)(const double* parameters) = nullptr;
  /// Its name if two of its parameters are equal. A fit that ends there is not a rival of that cause. None: itself.
  std::optional<WhereEqual> where_equal = {};
  /// The same where one of its parameters is small beside another.
  std::optional<WhereSmall> where_small = {};
  /// Its counterpart in simulators of bodies: adds itself to a joint. Null: they have no words for it, and an export leaves
  /// it out with its numbers.
  void (*in_a_joint)(const double* parameters, JointDescription& joint) = nullptr;
  /// Whether sides meet and part in it: each blow moves all later ones, and a fit of its parameters stands in one of many hollows.
  /// The diagnosis looks beside the place where it ended.
  bool strikes = false;
  /// Its shape as a curve; none: it is a cause with a name.
  std::optional<CurveShape> curve = {};
  /// Twice the log odds against it before any data, 0 or more. By default one in twenty of the causes that are looked for is there.
  double rarity = 6.0;
};

}  // namespace thermopower::plant
