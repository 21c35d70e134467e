// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

/// @file temperature_check.hpp
/// Temperatures that none can be: kelvin, parts of a degree, what was converted in a wrong way.

namespace thermopower::gap::engine {

/// Thresholds of the check of temperatures.
/// Held by tests/gap/data/scale_test.cpp.
struct TemperatureThresholds {
  double kelvin_C = 200.0;      ///< nothing that a motor is near is so hot throughout: another unit
  double coldest_C = -90.0;     ///< colder than any place on earth
  double hottest_C = 1000.0;    ///< hotter than copper stays solid
  double motor_low_C = -60.0;   ///< of a motor or air in the right unit
  double motor_high_C = 500.0;  ///< of a motor in the right unit
  double air_high_C = 70.0;     ///< of air in the right unit
  double below_air_K = 15.0;    ///< that a motor may be colder than the air around it
  double nearer_K = 20.0;       ///< that it must begin nearer to the air in one unit than in another
  double range_K = 150.0;       ///< that a motor goes through at most
};

/// Looks for temperatures that none can be.
class TemperatureCheck {
public:
  /// @param recorded  what is believed of a recording; must outlive this object
  explicit TemperatureCheck(const Recording& recorded) : recorded_(recorded) {}

  /// Adds what is wrong with motor and air: one finding each at most.
  void find(FindingList& list) const {
    for (const char* name : {"ambient_C", "motor_C"})
      if (recorded_.has(name)) find(name, list);
  }

private:
  struct Range {
    double low, typical, high;
  };

  Range range_of(const char* name) const {
    constexpr double low = 0.005, high = 0.95;
    std::vector<double> values = finite_samples(recorded_.column(name));
    const double least = quantile_of(values, low), most = quantile_of(values, high);
    return {least, median_of(values), most};
  }

  /// The air where it can be one, else NaN.
  double air_C() const {
    constexpr TemperatureThresholds limit;
    if (!recorded_.has("ambient_C")) return missing;
    const double typical = range_of("ambient_C").typical;
    return typical > limit.motor_low_C && typical < limit.air_high_C ? typical : missing;
  }

  void find(const std::string& name, FindingList& list) const {
    constexpr TemperatureThresholds limit;
    const Range range = range_of(name.c_str());
    if (range.low > limit.kelvin_C) {
      struct Unit {
        const char* option;
        const char* words;
        double factor, ice;
      };
      constexpr Unit units[] = {{"K", "kelvin", 1.0, 273.15},
                                {"ddegC", "tenths of a degree", 0.1, 0.0},
                                {"mdegC", "thousandths of a degree", 1e-3, 0.0}};
      for (const Unit& one : units) {
        const auto in_C = [&](double value) { return (value - one.ice) * one.factor; };
        if (!is_possible(name, {in_C(range.low), in_C(range.typical), in_C(range.high)})) continue;
        if (one.ice != 0.0 && are_tenths(name, range.low)) continue;
        list.add(FindingKind::wrong_unit, Severity::error, name,
                 "is at least " + short_number(range.low) + ": in " + one.words +
                     " where degrees Celsius are expected",
                 column_option(name, one.option));
        return;
      }
    }
    if (range.typical > limit.coldest_C && range.typical < limit.hottest_C) return;
    list.add(FindingKind::impossible_samples, Severity::error, name,
             "is about " + short_number(range.typical) + ": no temperature of " +
                 (name == "motor_C" ? "a motor" : "air") + " in degrees Celsius",
             "look at its unit, and at what --column makes of it");
  }

  /// Words of a sensor that counts parts of a degree are whole numbers, and kelvin that were degrees Celsius are none. Kelvin may
  /// be whole, too: where the air is known, tenths of a degree that are taken for kelvin must begin much further from it.
  bool are_tenths(const std::string& name, double low) const {
    constexpr double ice_K = 273.15, tenth = 0.1;
    const double air = air_C();
    if (recorded_.has("ambient_C") &&
        !(std::abs(tenth * low - air) + TemperatureThresholds().nearer_K < std::abs(low - ice_K - air)))
      return false;
    const std::vector<double> values = finite_samples(recorded_.column(name));
    return std::all_of(values.begin(), values.end(), [](double value) { return value == std::round(value); });
  }

  bool is_possible(const std::string& name, const Range& in_C) const {
    constexpr TemperatureThresholds limit;
    if (name != "motor_C") return in_C.typical > limit.motor_low_C && in_C.typical < limit.air_high_C;
    const double air = air_C();
    if (std::isfinite(air) && in_C.low < air - limit.below_air_K) return false;
    return in_C.low > limit.motor_low_C && in_C.typical < limit.motor_high_C &&
           in_C.high - in_C.low < limit.range_K;
  }

  const Recording& recorded_;
};

}  // namespace thermopower::gap::engine
