// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/motion_scale.hpp>
#include <thermopower/gap/data/prepared_recording.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/detail/time_units.hpp>
#include <thermopower/gap/model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// @file scale_check.hpp
/// Units, signs and exchanged columns of an axis by the size of its numbers: what the command does to the acceleration is as
/// large as the model's constants say, whatever friction or load the simulation lacks, or it is off by a unit.

namespace thermopower::gap::engine {

/// Thresholds of the check of sizes. Factors are compared by the magnitudes of their logarithms.
/// Held by tests/gap/data/scale_test.cpp.
struct ScaleThresholds {
  double sound = 3.0;      ///< factor by which constants may be off: no unit is asked for
  double near_unit = 1.6;  ///< times that a factor may be off a unit's
  double near_small_unit =
      1.3;  ///< times that it may be off one of less than ten, where no other column confirms it
  double small_unit = 10.0;  ///< factor of such a unit
  double same_ratio = 1.1;   ///< times that the ratio of two columns may be off the one expected
  double same_column =
      1.05;              ///< times that a column may be off another one's slope, where the two are exchanged
  double beyond = 30.0;  ///< factor that no constant of a model is off by
  double sure_partial = 0.8;        ///< correlation of command and acceleration that tells the command's sign
  double sure_significance = 15.0;  ///< standard errors that it is from 0 then
  double shortest_axis_s = 1e-5;    ///< interval between rows of an axis
  double longest_axis_s = 0.5;      ///< interval between rows of an axis
};

/// How far two factors are from each other, as a factor of 1 and above; without end where their signs differ.
inline double times_off(double a, double b) {
  const double ratio = a / b;
  return ratio > 0.0 ? std::max(ratio, 1.0 / ratio) : std::numeric_limits<double>::infinity();
}

/// A mistake in the units of an axis' columns: by what each number is larger than it should be.
struct AxisMistake {
  std::string column;    ///< whose finding it is
  std::string words;     ///< follows the column
  std::string mend;      ///< options of the program
  double rate = 1.0;     ///< factor
  double angle = 1.0;    ///< factor
  double time = 1.0;     ///< factor
  double command = 1.0;  ///< factor

  /// What the recorded rate is then by the slope of the recorded angle.
  double rate_by_slope() const { return rate * time / angle; }
  /// What the command does to the slope of the recorded rate then, by what it should.
  double drive_by_rate() const { return rate / (time * command); }
  /// The same of the curvature of the recorded angle.
  double drive_by_angle() const { return angle / (time * time * command); }
};

/// Looks for wrong units, signs and exchanged columns of an axis.
class AxisScaleCheck {
public:
  /// @param model  with an axis; must outlive this object
  /// @param prepared  the recording; must outlive this object
  AxisScaleCheck(const Model& model, const PreparedRecording& prepared)
      : voltage_(model.axis->voltage_driven()),
        interval_s_(prepared.interval_s()),
        rate_(prepared.inputs().judged(Signal::rate_dps)),
        angle_(prepared.inputs().judged(Signal::angle_deg)),
        scale_(prepared.inputs(), voltage_) {
    ratio_ = scale_.rate_by_slope_of_angle();
    const MotionTold by_rate = scale_.regressed(true), by_angle = scale_.regressed(false);
    const RigidAxisModel& axis = *model.axis;
    const double ohm = voltage_ ? axis.resistance_ohm : 1.0;
    const double expected_dps2 = deg_per_rad * axis.torque_constant_Nm_per_A / (axis.inertia_kgm2 * ohm);
    const bool closer = by_rate.drive.partial >= by_angle.drive.partial;
    sure_ = is_sure(closer ? by_rate : by_angle);
    if (by_rate.is_told()) drive_by_rate_ = by_rate.drive.value / expected_dps2;
    if (by_angle.is_told()) drive_by_angle_ = by_angle.drive.value / expected_dps2;
    if (!ratio_.is_told()) return;
    // The two differ by the ratio of the columns: the one that is told better tells the other.
    if (std::isfinite(drive_by_rate_) && (closer || !std::isfinite(drive_by_angle_)))
      drive_by_angle_ = drive_by_rate_ / ratio_.value;
    else if (std::isfinite(drive_by_angle_)) drive_by_rate_ = drive_by_angle_ * ratio_.value;
  }

  /// Whether the command moves the axis about as the model says, and the rate, where there is one, is the angle's in the same
  /// unit: then no unit of theirs is wrong.
  bool is_sound() const {
    constexpr ScaleThresholds limit;
    const bool ratio =
        !rate_ || !angle_ || (ratio_.is_told() && times_off(ratio_.value, 1.0) < limit.same_ratio);
    return ratio && times_off(drive(), 1.0) < limit.sound;
  }

  /// Adds what is wrong; at most one finding, for the mistakes are told apart together.
  void find(FindingList& list) const {
    if (find_exchanged(list) || find_sign(list)) return;
    if (!std::isfinite(drive()) || times_off(drive(), 1.0) < ScaleThresholds().sound) return;
    find_unit(list);
  }

private:
  static bool is_sure(const MotionTold& told) {
    constexpr ScaleThresholds limit;
    return told.is_told() && told.drive.partial > limit.sure_partial &&
           told.drive.significance() > limit.sure_significance;
  }

  const char* command() const { return voltage_ ? "voltage_V" : "drive_A"; }
  /// What the command does by what it should, as the rate has it, or without one the angle; NaN where that is not told.
  double drive() const { return rate_ ? drive_by_rate_ : drive_by_angle_; }

  bool find_exchanged(FindingList& list) const {
    constexpr ScaleThresholds limit;
    if (ratio_.is_told() && times_off(ratio_.value, 1.0) < limit.same_column) return false;
    const auto is_slope = [&](const ColumnRatio& ratio) {
      return ratio.is_told() && times_off(ratio.value, 1.0) < limit.same_column;
    };
    const auto add = [&](const std::string& a, const std::string& b, const std::string& slope,
                         const std::string& whole) {
      list.add(FindingKind::swapped_columns, Severity::error, a,
               "and " + b + " are exchanged: " + slope + " is the slope of " + whole, exchange_option(a, b));
      return true;
    };
    if (!rate_ || !angle_) return false;
    if (is_slope(scale_.angle_by_slope_of_rate()))
      return add("angle_deg", "rate_dps", "angle_deg", "rate_dps");
    if (is_slope(scale_.rate_by_slope_of_command()))
      return add(command(), "angle_deg", "rate_dps", command());
    if (is_slope(scale_.command_by_slope_of_angle()))
      return add(command(), "rate_dps", command(), "angle_deg");
    return false;
  }

  bool find_sign(FindingList& list) const {
    const auto add = [&](const std::string& column, const std::string& unit, const std::string& words) {
      list.add(FindingKind::wrong_sign, Severity::error, column, "has the wrong sign" + words,
               column_option(column, "-" + unit));
      return true;
    };
    if (ratio_.is_told() && ratio_.value < 0.0) {
      if (sure_ && drive_by_rate_ < 0.0)
        return add("rate_dps", "deg/s", " against the command and angle_deg");
      return add("angle_deg", "deg", ": it falls where rate_dps says that the axis turns forwards");
    }
    if (!sure_ || !(drive() < 0.0)) return false;
    return add(command(), voltage_ ? "V" : "A",
               std::string(": it accelerates the axis backwards (or ") +
                   (rate_ && angle_ ? "angle_deg and rate_dps have"
                    : rate_         ? "rate_dps has"
                                    : "angle_deg has") +
                   " the wrong one)");
  }

  std::vector<AxisMistake> mistakes() const {
    struct Unit {
      const char* option;
      const char* words;
      double factor;
    };
    constexpr double turn_deg = 360.0, rpm_dps = 6.0;
    constexpr Unit rates[] = {{"rad/s", "radians per second", 1.0 / deg_per_rad},
                              {"rpm", "turns per minute", 1.0 / rpm_dps},
                              {"rev/s", "turns per second", 1.0 / turn_deg}};
    constexpr Unit angles[] = {{"rad", "radians", 1.0 / deg_per_rad}, {"rev", "turns", 1.0 / turn_deg}};
    constexpr Unit amperes[] = {{"mA", "milliamperes", 1e3}, {"uA", "microamperes", 1e6}};
    constexpr Unit volts[] = {{"mV", "millivolts", 1e3}};
    constexpr ScaleThresholds limit;
    std::vector<AxisMistake> list;
    const auto is_where = [](const std::string& unit, const std::string& expected) {
      return "is in " + unit + " where " + expected + " are expected";
    };
    if (rate_)
      for (const Unit& one : rates)
        list.push_back({"rate_dps", is_where(one.words, "degrees per second"),
                        column_option("rate_dps", one.option), one.factor});
    if (angle_ && !rate_)  // beside a rate that is right, a cause
      for (const Unit& one : angles)
        list.push_back({"angle_deg", is_where(one.words, "degrees"), column_option("angle_deg", one.option),
                        1.0, one.factor});
    if (angle_ && rate_)
      for (const Unit& turned : angles)
        for (const Unit& one : rates)
          list.push_back(
              {"rate_dps",
               std::string("is in ") + one.words + " and angle_deg in " + turned.words +
                   " where degrees per second and degrees are expected",
               column_option("rate_dps", one.option) + " " + column_option("angle_deg", turned.option),
               one.factor, turned.factor});
    for (const TimeUnit& one : time_units) {
      const double then_s = interval_s_ * one.in_s;
      if (then_s > limit.shortest_axis_s && then_s < limit.longest_axis_s)
        list.push_back({"t_s", is_where(one.words, "seconds"), column_option("t_s", one.option), 1.0, 1.0,
                        1.0 / one.in_s});
    }
    const auto command_in = [&](const Unit& one, const char* expected) {
      list.push_back({command(), is_where(one.words, expected), column_option(command(), one.option), 1.0,
                      1.0, 1.0, one.factor});
    };
    if (voltage_)
      for (const Unit& one : volts) command_in(one, "volts");
    else
      for (const Unit& one : amperes) command_in(one, "amperes");
    return list;
  }

  /// How far a mistake is from what was found: a factor of 1 and above; without end where it is too far.
  /// @param ratio  what rate and angle are to each other counts
  double distance(const AxisMistake& one, bool ratio) const {
    constexpr ScaleThresholds limit;
    constexpr double never = std::numeric_limits<double>::infinity();
    if (ratio && times_off(ratio_.value, one.rate_by_slope()) > limit.same_ratio) return never;
    const double expected = rate_ ? one.drive_by_rate() : one.drive_by_angle();
    const double off = times_off(drive(), expected);
    const bool is_small = times_off(expected, 1.0) < limit.small_unit;
    if (off > (is_small && !ratio ? limit.near_small_unit : limit.near_unit)) return never;
    // Rows that come so seldom were stamped in another unit, rather than driven in one.
    if (!ratio && interval_s_ > limit.longest_axis_s && one.time == 1.0) return never;
    return off;
  }

  void find_unit(FindingList& list) const {
    const std::vector<AxisMistake> all = mistakes();
    const auto nearest = [&](bool ratio) {
      const AxisMistake* best = nullptr;
      for (const AxisMistake& one : all) {
        if (!ratio && one.rate != 1.0 && one.angle != 1.0) continue;
        const double off = distance(one, ratio);
        if (std::isfinite(off) && (best == nullptr || off < distance(*best, ratio))) best = &one;
      }
      return best;
    };
    const AxisMistake* best = ratio_.is_told() ? nearest(true) : nullptr;
    // An angle that is off by a factor besides hides none of the other mistakes; a rate that is its angle's has none of its own.
    const bool belong_together =
        ratio_.is_told() && times_off(ratio_.value, 1.0) < ScaleThresholds().same_ratio;
    if (best == nullptr && !belong_together) best = nearest(false);
    const std::string moves = short_number(std::abs(drive()));
    if (best != nullptr)
      list.add(
          FindingKind::wrong_unit, Severity::error, best->column,
          best->words + " (" + command() + " moves the axis " + moves + " times as much as the model says)",
          best->mend);
    else if (times_off(drive(), 1.0) > ScaleThresholds().beyond)
      list.add(FindingKind::wrong_unit, Severity::error, command(),
               "moves the axis " + moves +
                   " times as much as the model says: it is in another unit, or the model's " +
                   "inertia_kgm2 or torque_constant_Nm_per_A is",
               "look at the unit of the command and at the model's constants");
  }

  bool voltage_;
  double interval_s_;
  bool rate_;
  bool angle_;
  MotionScale scale_;
  ColumnRatio ratio_;
  bool sure_ = false;
  double drive_by_rate_ = missing;
  double drive_by_angle_ = missing;
};

}  // namespace thermopower::gap::engine
