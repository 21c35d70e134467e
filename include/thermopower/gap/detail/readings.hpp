// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/finding.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

/// @file readings.hpp
/// What may be wrong with the units, signs and order of a recording's columns, and how to read it then.

namespace thermopower::gap::engine {

/// Thresholds of the unit check. A misfit is the root mean square of simulated minus measured over that of
/// measured minus where the simulation started: 0 for a perfect simulation, 1 for one that is no better than
/// standing still.
/// Held by tests/gap/data/units_test.cpp.
struct UnitThresholds {
  double follows =
      0.2;  ///< misfit below which the simulation follows the data as they are, and nothing is asked
  double far_better =
      3.0;  ///< times by which another unit must lower the misfit: no effect of a real motor does that
  double believable = 0.7;  ///< misfit that the data must have in the other unit
  double better_than_without =
      0.9;  ///< of the misfit without a column: what that column must lower it to in the unit that makes it small
  double off_by_factor =
      0.1;  ///< of the factor by which an output is said to be too small: what the misfit must be as it is
  double fahrenheit_C = 45.0;      ///< air hardly ever is: degrees Fahrenheit are asked about
  double fahrenheit_low = 59.0;    ///< air of 15 degC in degrees Fahrenheit
  double fahrenheit_high = 113.0;  ///< air of 45 degC in degrees Fahrenheit
  double better_in_fahrenheit =
      1.15;  ///< times by which such air in degrees Celsius must lower the misfit: it is odd already
  double stands_still_K =
      10.0;  ///< that the simulation warms by: thermometers come in steps of a degree or two, none of ten
  double warmer_than_air_K =
      15.0;                       ///< a motor that starts so much above the air may be in degrees Fahrenheit
  Eigen::Index rows = 3000;       ///< of the recording that are simulated
  Eigen::Index window_rows = 50;  ///< of an axis between restarts
  double shifted_back =
      0.6;  ///< of the current's variance that remains when another shift of the clock is right
  double shifted_axis = 0.55;  ///< of an axis's misfit
  double largest_square =
      1e18;  ///< of an error: a simulation that left the number range is very bad, not undefined
};

/// Another reading of a recording: what might be wrong with it, and how to read it then.
struct Reading {
  FindingKind kind = FindingKind::wrong_unit;  ///< wrong_unit, wrong_sign or swapped_columns
  std::string column;                          ///< whose finding it is
  std::string words;                           ///< "is in kelvin where degrees Celsius are expected"
  std::string mend;                            ///< options of the program
  std::function<void(Recording&)> apply;       ///< turns the recording into what it should be
  double least_misfit = 0.0;                   ///< misfit as recorded below which it cannot be that
  std::function<void(Recording&)> without =
      nullptr;  ///< takes away what it makes small; empty where it does not
  double far_better = UnitThresholds().far_better;  ///< times by which it must lower the misfit
};

/// Whether the model's axis is judged on a recording, and not its body.
inline bool moves(const Model& model, const Recording& recording) {
  return model.has_axis() && (recording.has("rate_dps") || recording.has("angle_deg"));
}

/// Makes the readings of a recording that are worth asking about.
class ReadingList {
public:
  /// @param model     what judges them
  /// @param recording as it was given
  ReadingList(const Model& model, const Recording& recording) : recording_(recording) {
    times();
    temperatures();
    electrical(model);
    if (moves(model, recording)) motion();
    swaps();
  }
  /// The readings, the commonest mistakes first.
  std::vector<Reading> take() { return std::move(list_); }

private:
  static void scale(Recording& r, const char* column, double factor, double offset = 0.0) {
    if (!r.has(column)) return;
    r.set(column, ((r.column(column).array() - offset) * factor).matrix());
  }
  void scaled(const char* column, const char* unit, double factor, const std::string& words) {
    if (!recording_.has(column)) return;
    const std::string name = column;
    list_.push_back({FindingKind::wrong_unit, name, words, column_option(name, unit),
                     [name, factor](Recording& r) { scale(r, name.c_str(), factor); }});
    constexpr const char* outputs[] = {"current_A", "angle_deg", "rate_dps"};
    if (factor < 1.0 && std::find(std::begin(outputs), std::end(outputs), name) == std::end(outputs))
      list_.back().without = [name](Recording& r) { scale(r, name.c_str(), 0.0); };
  }
  void turned(const char* column, const char* unit, const std::string& words) {
    if (!recording_.has(column)) return;
    const std::string name = column;
    list_.push_back({FindingKind::wrong_sign, name, words, column_option(name, std::string("-") + unit),
                     [name](Recording& r) { scale(r, name.c_str(), -1.0); }});
  }
  double typical(const char* column) const {
    std::vector<double> values = finite_samples(recording_.column(column));
    return median_of(values);
  }
  double first_of(const char* column) const {
    for (const double value : recording_.column(column))
      if (std::isfinite(value)) return value;
    return missing;
  }
  double largest(const char* column) const {
    std::vector<double> values = finite_samples(recording_.column(column).cwiseAbs());
    return quantile_of(values, 1.0);
  }

  void times() {
    const auto add = [&](const char* unit, double factor, const char* words) {
      list_.push_back({FindingKind::wrong_unit, "t_s", words, column_option("t_s", unit),
                       [factor](Recording& r) { r.t_s *= factor; }});
      if (factor < 1.0)
        list_.back().without = [](Recording& r) { r.t_s *= 1e-9; };  // everything stands still
    };
    add("ms", 1e-3, "is in milliseconds where seconds are expected");
    add("us", 1e-6, "is in microseconds where seconds are expected");
    add("min", 60.0, "is in minutes where seconds are expected");
  }

  void temperatures() {
    constexpr UnitThresholds limit;
    const bool motor = recording_.has("motor_C"), air = recording_.has("ambient_C");
    const auto both = [&](const char* unit, double factor, double offset, const char* words) {
      std::string mend;
      for (const char* name : {"motor_C", "ambient_C", "neighbour_C"})
        if (recording_.has(name)) mend += (mend.empty() ? "" : " ") + column_option(name, unit);
      list_.push_back({FindingKind::wrong_unit, motor ? "motor_C" : "ambient_C", words, mend,
                       [factor, offset](Recording& r) {
                         for (const char* name : {"motor_C", "ambient_C", "neighbour_C"})
                           scale(r, name, factor, offset);
                       }});
    };
    const auto one = [&](const char* name, const char* unit, double factor, double offset,
                         const char* words) {
      const std::string column = name;
      list_.push_back({FindingKind::wrong_unit, column, words, column_option(column, unit),
                       [column, factor, offset](Recording& r) { scale(r, column.c_str(), factor, offset); }});
    };
    constexpr double per_fahrenheit = 5.0 / 9.0, ice_F = 32.0, ice_K = 273.15;
    const char* const fahrenheit = "is in degrees Fahrenheit where degrees Celsius are expected";
    const char* const kelvin = "is in kelvin where degrees Celsius are expected";
    const bool hot_air = air && typical("ambient_C") > limit.fahrenheit_C;
    const double typical_air = air ? typical("ambient_C") : 0.0;
    const double in_fahrenheit = typical_air > limit.fahrenheit_low && typical_air < limit.fahrenheit_high
                                     ? limit.better_in_fahrenheit
                                     : limit.far_better;
    const bool hot_start = motor && first_of("motor_C") > limit.fahrenheit_C &&
                           (!air || first_of("motor_C") > first_of("ambient_C") + limit.warmer_than_air_K);
    if (hot_air && motor) {
      both("degF", per_fahrenheit, ice_F, fahrenheit);
      list_.back().far_better = in_fahrenheit;
      both("K", 1.0, ice_K, kelvin);
    }
    if (hot_air) {
      one("ambient_C", "degF", per_fahrenheit, ice_F, fahrenheit);
      list_.back().far_better = in_fahrenheit;
    }
    if (hot_air) one("ambient_C", "K", 1.0, ice_K, kelvin);
    if (hot_start) one("motor_C", "degF", per_fahrenheit, ice_F, fahrenheit);
    if (hot_start) one("motor_C", "K", 1.0, ice_K, kelvin);
  }

  void electrical(const Model& model) {
    if (recording_.has("power_param")) {
      const double most = largest("power_param");
      if (most <= 1.0) scaled("power_param", "1", 255.0, "is a duty of 0..1 where 0..255 is expected");
      else if (most <= 100.0) scaled("power_param", "%", 2.55, "is in percent where 0..255 is expected");
    }
    scaled("supply_V", "mV", 1e-3, "is in millivolts where volts are expected");
    scaled("current_A", "mA", 1e-3, "is in milliamperes where amperes are expected");
    turned("current_A", "A", "has the wrong sign: a motor's current is positive where its voltage is");
    if (model.has_thermal()) {
      scaled("heat_W", "mW", 1e-3, "is in milliwatts where watts are expected");
      scaled("heat_W", "kW", 1e3, "is in kilowatts where watts are expected");
      turned("heat_W", "W", "has the wrong sign: it cools the body");
    }
    if (moves(model, recording_)) {
      scaled("drive_A", "mA", 1e-3, "is in milliamperes where amperes are expected");
      scaled("voltage_V", "mV", 1e-3, "is in millivolts where volts are expected");
      if (model.has_servo() && !recording_.has("drive_A")) {
        scaled("target_deg", "rad", deg_per_rad, "is in radians where degrees are expected");
        scaled("target_dps", "rad/s", deg_per_rad,
               "is in radians per second where degrees per second are expected");
        turned("target_deg", "deg", "has the wrong sign: the axis moves the other way");
        turned("target_dps", "deg/s", "has the wrong sign: the axis moves the other way");
      }
      scaled("torque_Nm", "mNm", 1e-3, "is in millinewton metres where newton metres are expected");
      scaled("torque_Nm", "Ncm", 1e-2, "is in newton centimetres where newton metres are expected");
      turned("torque_Nm", "Nm", "has the wrong sign: it accelerates the axis backwards");
      turned("drive_A", "A", "has the wrong sign: it accelerates the axis backwards");
      turned("voltage_V", "V", "has the wrong sign: it accelerates the axis backwards");
    }
  }

  void motion() {
    constexpr double rpm = 6.0;  // deg/s in one turn a minute
    const bool rate = recording_.has("rate_dps"), angle = recording_.has("angle_deg");
    if (rate && angle)
      list_.push_back({FindingKind::wrong_unit, "rate_dps",
                       "and angle_deg are in radians where degrees are expected",
                       column_option("rate_dps", "rad/s") + " " + column_option("angle_deg", "rad"),
                       [](Recording& r) {
                         scale(r, "rate_dps", deg_per_rad);
                         scale(r, "angle_deg", deg_per_rad);
                       },
                       UnitThresholds().off_by_factor * deg_per_rad});
    scaled("rate_dps", "rad/s", deg_per_rad,
           "is in radians per second where degrees per second are expected");
    scaled("rate_dps", "rpm", rpm, "is in turns per minute where degrees per second are expected");
    // With a rate beside it, an angle that is off by a factor is a cause (angle_scale) and no finding.
    if (!rate) scaled("angle_deg", "rad", deg_per_rad, "is in radians where degrees are expected");
    turned("rate_dps", "deg/s", "has the wrong sign against drive and angle");
    turned("angle_deg", "deg", "has the wrong sign: it falls where the axis is driven and turns forwards");
  }

  void swaps() {
    constexpr std::pair<const char*, const char*> pairs[] = {{"motor_C", "ambient_C"},
                                                             {"angle_deg", "rate_dps"},
                                                             {"current_A", "supply_V"},
                                                             {"current_A", "motor_C"},
                                                             {"ambient_C", "neighbour_C"}};
    for (const auto& [a, b] : pairs) {
      if (!recording_.has(a) || !recording_.has(b)) continue;
      const std::string first = a, second = b;
      list_.push_back({FindingKind::swapped_columns, first, "and " + second + " are exchanged",
                       exchange_option(first, second), [first, second](Recording& r) {
                         const Eigen::VectorXd kept = r.column(first);
                         r.set(first, r.column(second));
                         r.set(second, kept);
                       }});
    }
  }

  const Recording& recording_;
  std::vector<Reading> list_;
};

}  // namespace thermopower::gap::engine
