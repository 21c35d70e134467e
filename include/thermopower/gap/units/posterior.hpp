// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/gap/units/table.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

/// @file posterior.hpp
/// How likely units are beside constants that are off: one log posterior over all recordings of a source. Constants are shared
/// by the recordings, and every hypothesis competes with constants that moved.

namespace thermopower::gap::engine {

/// The log posterior of units, in nats.
class UnitPosterior {
public:
  /// @param parts  recordings, or runs of them; must outlive this object
  /// @param most_power  largest power_param of all of them
  UnitPosterior(const std::vector<UnitEvidence>& parts, double most_power)
      : parts_(parts), most_power_(most_power) {}

  /// One hypothesis for each part.
  typedef std::vector<const UnitHypothesis*> Assignment;
  /// Shared by all parts: the logarithms by which measures are off, then in kelvin the air above a room, the coldest motor above
  /// its air, and the air that cools the motor above the recorded one.
  typedef std::array<double, unit_measure_count + 3> Shared;

  /// The log posterior of an assignment. @param common  what most parts have
  double of(const Assignment& units, const UnitHypothesis& common) const {
    assert(units.size() == parts_.size());
    double sum = -price(common);
    for (std::size_t i = 0; i < parts_.size(); ++i) sum += own(i, *units[i], common);
    constexpr auto drive = static_cast<std::size_t>(UnitMeasure::drive),
                   drag = static_cast<std::size_t>(UnitMeasure::drag);
    for (std::size_t k = 0; k < Shared().size(); ++k)
      if (k != drive && k != drag) sum += likeliest({k}, units).nats;
    // A torque constant moves both.
    return sum + std::max(likeliest({drive}, units).nats + likeliest({drag}, units).nats,
                          likeliest({drive, drag}, units).nats);
  }

  /// The likeliest values that the recordings share, with the units given.
  Shared shared_by(const Assignment& units) const {
    Shared all{};
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = likeliest({k}, units).at;
    return all;
  }

  /// Log posterior of a hypothesis in one part, where the shared constants are given.
  double of_part(std::size_t part, const UnitHypothesis& one, const Shared& shared,
                 const UnitHypothesis& common) const {
    double sum = own(part, one, common);
    for (std::size_t k = 0; k < shared.size(); ++k) sum += likelihood(deviation(part, k, one), shared[k]);
    return sum;
  }

  /// Whether a common hypothesis holds in every part: no sign speaks against it, and what it leaves of the measures that it
  /// changes is near 1, and of warming and cooling alike.
  bool holds_everywhere(const UnitHypothesis& one, const Assignment& units) const {
    constexpr UnitThresholds limit;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      for (std::size_t k = 0; units[i] == &one && k < unit_measure_count; ++k) {
        const auto kind = static_cast<UnitMeasure>(k);
        const UnitEvidence& of = parts_[i];
        const double expected = one.expected(kind, of);
        if (expected < 0.0 && of[kind].forwards_nats > limit.sure) return false;
        if (kind == UnitMeasure::drag || kind == UnitMeasure::slope || std::abs(expected) == 1.0) continue;
        const double near = std::log(kind == UnitMeasure::drive ? limit.near_motion : limit.near_heat);
        if (std::abs(deviation(i, k, one).value) > near) return false;
      }
    // A clock makes a body warm and cool faster by one factor.
    for (std::size_t i = 0; one.of("t_s") != nullptr && i < parts_.size(); ++i) {
      const Deviation warms = deviation(i, static_cast<std::size_t>(UnitMeasure::heating), one),
                      cools = deviation(i, static_cast<std::size_t>(UnitMeasure::cooling), one);
      if (units[i] == &one && warms.is_told && cools.is_told &&
          std::abs(warms.value - cools.value) > std::log(limit.alike_heat))
        return false;
    }
    return true;
  }

  /// By how much the logarithm of a measure is off beside the units: the median over the parts; 0 where none tells it.
  double shift(UnitMeasure kind, const Assignment& units) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (const Deviation one = deviation(i, static_cast<std::size_t>(kind), *units[i]); one.is_told)
        all.push_back(one.value);
    return median_of(all);
  }

private:
  static constexpr std::size_t air = unit_measure_count, start = air + 1, offset = start + 1;
  static constexpr double room_C = 22.0;

  struct Deviation {
    bool is_told = false;
    double value = 0.0;  // logarithm of measured by expected, or kelvin
    double sd = 1.0;
  };
  struct Likeliest {
    double nats = 0.0;
    double at = 0.0;  // shift
  };

  static double price(const UnitHypothesis& one) {
    constexpr UnitThresholds limit;
    if (one.is_none()) return 0.0;
    const std::string column = one.column();
    const bool is_measured = column == "rate_dps" || column == "angle_deg";  // and no command
    if (one.turns_sign()) return limit.sign + (is_measured ? limit.detail : 0.0);
    return limit.unit + (one.scales.size() > 1 ? limit.detail : 0.0);
  }

  /// Log likelihood of one part's own numbers: signs, temperatures, clocks.
  double own(std::size_t part, const UnitHypothesis& one, const UnitHypothesis& common) const {
    constexpr UnitThresholds limit;
    assert(part < parts_.size());
    const UnitEvidence& of = parts_[part];
    if (one.exchanges()) return &one == &common ? 0.0 : -limit.odd - price(one);
    double sum = -price_of_numbers(of, one) - (of.exchanged.empty() ? 0.0 : limit.misplaced);
    const bool lacks_column = one.is_none() && !common.applies_to(of);
    if (&one != &common && !lacks_column) sum -= limit.odd + price(one);
    for (std::size_t k = 0; k < unit_measure_count; ++k)
      sum += std::min(0.0, std::copysign(1.0, one.expected(static_cast<UnitMeasure>(k), of)) *
                               of.measures[k].forwards_nats);
    return sum;
  }

  /// Price of clocks, powers and temperatures that cannot be, or hardly.
  double price_of_numbers(const UnitEvidence& of, const UnitHypothesis& one) const {
    constexpr UnitThresholds limit;
    constexpr double fastest_axis_s = 1e-5, slowest_axis_s = 0.5, fastest_bench_s = 5e-3,
                     slowest_bench_s = 600.0;
    constexpr double low_percent = 40.0, odd_clock = 5.0;
    double sum = price_of_temperatures(of, one);
    const double interval_s = of.interval_s / one.factor("t_s");
    if ((of.is_axis && (interval_s < fastest_axis_s || interval_s > slowest_axis_s)) ||
        (!of.is_axis && of.is_bench && (interval_s < fastest_bench_s || interval_s > slowest_bench_s)))
      sum += one.of("t_s") == nullptr ? odd_clock : limit.impossible;
    if (!of.has("power_param")) return sum;
    const double unit = one.factor("power_param"), most = unit == 1.0 ? most_power_ : of.most_power;
    const bool is_duty = most > 0.0 && most <= 1.0, is_percent = most > low_percent && most <= 100.0;
    const bool possible = unit == 1.0 ? !is_duty : unit < 0.1 ? is_duty : is_percent;
    return sum + (possible ? 0.0 : limit.impossible);
  }

  static double price_of_temperatures(const UnitEvidence& of, const UnitHypothesis& one) {
    constexpr UnitThresholds limit;
    using Place = PossibleTemperature;
    constexpr double hottest_air_C = 70.0, below_air_K = 15.0, most_range_K = 150.0;
    const double air_C = one.celsius("ambient_C", of.air.typical);
    double sum = 0.0;
    for (const bool is_air : {false, true}) {
      const TemperatureRange& range = is_air ? of.air : of.motor;
      const ColumnScale* const scale = one.of(is_air ? "ambient_C" : "motor_C");
      if (!range.is_known()) continue;
      if (scale == nullptr) {
        sum += range.is_odd() ? limit.impossible : 0.0;
        continue;
      }
      const double low_C = one.celsius(scale->column, range.low),
                   high_C = one.celsius(scale->column, range.high);
      bool possible = low_C > Place::low_C && high_C < (is_air ? hottest_air_C : Place::high_C);
      possible =
          possible && (scale->factor == 1.8 || range.is_odd());  // only degrees Fahrenheit look like Celsius
      possible = possible && (scale->factor < 10.0 || range.whole_numbers);
      if (!is_air) possible = possible && !(low_C < air_C - below_air_K) && high_C - low_C < most_range_K;
      sum += possible ? 0.0 : 2.0 * limit.impossible;
      if (scale->factor == 1.0 && range.whole_numbers)
        sum += limit.odd;  // degrees Celsius plus 273.15 are not
    }
    return sum;
  }

  Deviation deviation(std::size_t part, std::size_t k, const UnitHypothesis& one) const {
    constexpr double air_sd_K = 2.5, start_sd_K = 20.0;
    if (one.exchanges()) return {};
    const UnitEvidence& of = parts_[part];
    const double air_C = of.air.is_known() ? one.celsius("ambient_C", of.air.typical) : room_C;
    if (k == air) return {of.air.is_known(), air_C - room_C, air_sd_K};
    if (k == start)
      return {of.motor.is_known(), of.motor.is_known() ? one.celsius("motor_C", of.motor.low) - air_C : 0.0,
              start_sd_K};
    if (k == offset)
      return {std::isfinite(of.air_offset_K),
              of.air_offset_K - (one.recorded("motor_C", air_C) - of.air.typical), air_sd_K};
    const Measured& measured = of.measures[k];
    if (!measured.is_told()) return {};
    return {true, std::log(measured.value / std::abs(one.expected(static_cast<UnitMeasure>(k), of))),
            measured.sd};
  }

  /// Student's t of two degrees of freedom.
  static double likelihood(const Deviation& one, double shared) {
    if (!one.is_told) return 0.0;
    const double standard = (one.value - shared) / one.sd;
    return -1.5 * std::log1p(0.5 * standard * standard);
  }

  /// Price of what all parts share: constants, the air, and how warm motors are where recordings begin.
  static double price_of_shift(std::size_t k, double by) {
    constexpr UnitThresholds limit;
    constexpr double constant_sd = 0.05, loose_sd = 0.3, air_sd_K = 5.0, start_sd_K = 20.0, offset_sd_K = 1.5;
    const auto kind = static_cast<UnitMeasure>(k);
    // A second mass or a lag makes the rate of warming another one, as often as not.
    const bool is_loose = kind == UnitMeasure::drag || kind == UnitMeasure::supply ||
                          kind == UnitMeasure::target || kind == UnitMeasure::heating;
    const double sd = k == air      ? air_sd_K
                      : k == start  ? start_sd_K
                      : k == offset ? offset_sd_K
                      : is_loose    ? loose_sd
                                    : constant_sd;
    const double price = std::log1p(by * by / (sd * sd));
    return kind == UnitMeasure::slope || k == start ? std::min(price, limit.unit)
                                                    : price;  // an angle may be scaled: a cause
  }

  /// Of no shift and of those that single parts have, the likeliest.
  Likeliest likeliest(const std::vector<std::size_t>& kinds, const Assignment& units) const {
    std::vector<Deviation> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      for (const std::size_t k : kinds)
        if (const Deviation one = deviation(i, k, *units[i]); one.is_told) all.push_back(one);
    if (all.empty()) return {};
    Likeliest best{-std::numeric_limits<double>::infinity(), 0.0};
    constexpr std::size_t asked = 64;  // more say the same
    for (std::size_t i = 0; i <= all.size(); i += all.size() / asked + 1) {
      const double at = i == 0 ? 0.0 : all[i - 1].value;
      double sum = -price_of_shift(kinds.front(), at);
      for (const Deviation& one : all) sum += likelihood(one, at);
      if (sum > best.nats) best = {sum, at};
    }
    return best;
  }

  const std::vector<UnitEvidence>& parts_;
  double most_power_;
};

}  // namespace thermopower::gap::engine
