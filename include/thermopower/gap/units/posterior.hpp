// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/units/hypothesis.hpp>

#include <algorithm>
#include <cassert>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

/// @file posterior.hpp
/// How likely units are beside constants that are off: one log posterior over all recordings of a source. Constants are shared
/// by the recordings, and every hypothesis competes with constants that moved.

namespace thermopower::gap::engine {

/// Beliefs of the unit posterior, in nats unless said otherwise.
/// Held by tests/gap/units/unit_posterior_test.cpp.
struct UnitBeliefs {
  double unit = 3.0;  ///< price of a column in another unit: one log in twenty
  double sign = 3.5;  ///< price of a turned sign; of a measured column half a nat more than of a command
  double second_column = 0.5;     ///< price of a second column that shares the mistake
  double odd = 2.0;               ///< price of a recording or run that differs from the others
  double sure = 2.0;              ///< margin from which a hypothesis stops a diagnosis
  double impossible = 30.0;       ///< price of what cannot be
  double exchanged = 8.0;         ///< gain of two columns that fit the other way round and not as recorded
  double odd_clock = 5.0;         ///< price of rows that come faster or slower than loggers write
  double constant_sd = 0.05;      ///< of the logarithm of a constant, as KnownConstants::uncertainty
  double drag_sd = 0.3;           ///< of the logarithm of a drag: most are fitted without friction
  double farthest_factor = 30.0;  ///< that a constant is off by, as KnownConstants::farthest_factor
  double farthest_drive = 100.0;  ///< the same of what two constants come to, inertia and torque constant
  double near_drive = 1.6;        ///< factor that a drive's constants may be off beside a wrong unit
  double near_heat = 6.0;         ///< the same of a circuit or a body, which hides heat from its thermometer
  double beyond = 10.0;           ///< price of a constant that is further off
  double angle_scale = 3.0;       ///< price of an angle that moves by another factor than its rate: a cause
  double air_sd_K = 2.5;          ///< of the air in one recording about that of the others
  double room_C = 22.0;           ///< air before any recording
  double room_sd_K = 15.0;        ///< of it
  double most_air = 6.0;          ///< that unusual air costs at most
  double offset_sd_K = 3.0;       ///< of the air to which a motor cools down
  double offset_share = 0.15;     ///< of an expected offset: the same
  double most_offset = 8.0;       ///< that an offset costs at most
  double start_sd_K = 20.0;       ///< of the coldest motor above its air
  double most_start = 3.0;        ///< that a warm motor costs at most
  double whole_kelvin = 2.0;  ///< price of kelvin that are whole numbers: degrees Celsius plus 273.15 are not
};

/// Limits of temperatures and clocks that can be.
struct PossibleUnits {
  double another_unit_C = 200.0;        ///< coldest sample from which a column is not in degrees Celsius
  double coldest_C = -90.0;             ///< colder than any place on earth
  double motor_low_C = -60.0;           ///< of motor and air
  double motor_high_C = 500.0;          ///< of a motor
  double air_high_C = 70.0;             ///< of air
  double below_air_K = 15.0;            ///< that a motor may be colder than its air
  double below_air_fahrenheit_K = 5.0;  ///< the same where degrees Fahrenheit are the question
  double range_K = 150.0;               ///< that a motor goes through
  double least_percent = 40.0;          ///< largest power of one in percent
  double full_percent = 100.0;          ///< largest power of one in percent
  double full_duty = 1.0;               ///< largest power of a duty
  double axis_fastest_s = 1e-5;         ///< interval between rows of an axis
  double axis_slowest_s = 0.5;          ///< the same
  double bench_fastest_s = 5e-3;        ///< interval between rows of a bench
  double bench_slowest_s = 600.0;       ///< the same
};

/// The log posterior of units.
class UnitPosterior {
public:
  /// @param parts  recordings, or runs of them; must outlive this object
  /// @param most_power  largest power_param of all of them
  UnitPosterior(const std::vector<UnitEvidence>& parts, double most_power)
      : parts_(parts), most_power_(most_power) {}

  /// One hypothesis for each part.
  typedef std::vector<const UnitHypothesis*> Assignment;

  /// The log posterior of an assignment.
  /// @param common  what most parts have
  double of(const Assignment& units, const UnitHypothesis& common) const {
    assert(units.size() == parts_.size());
    double sum = common.is_none() ? 0.0 : -price(common);
    for (std::size_t i = 0; i < parts_.size(); ++i) sum += own(i, *units[i], common);
    for (std::size_t k = 0; k < unit_measure_count; ++k) {
      const auto kind = static_cast<UnitMeasure>(k);
      if (kind != UnitMeasure::drive && kind != UnitMeasure::drag) sum += shared({kind}, units).best;
    }
    // A torque constant moves both.
    sum += std::max(shared({UnitMeasure::drive}, units).best + shared({UnitMeasure::drag}, units).best,
                    shared({UnitMeasure::drive, UnitMeasure::drag}, units).best);
    return sum + air(units).best + start(units).best;
  }

  /// Whether a common hypothesis holds in every part: what it leaves of the measures that it changes is near 1.
  bool holds_everywhere(const UnitHypothesis& one, const Assignment& units) const {
    assert(units.size() == parts_.size());
    for (std::size_t k = 0; k < unit_measure_count; ++k) {
      const auto kind = static_cast<UnitMeasure>(k);
      for (std::size_t i = 0; i < parts_.size() && one.turns_sign(); ++i)
        if (units[i] == &one && one.expected(parts_[i])[k] < 0.0 &&
            parts_[i].measures[k].forwards_nats > beliefs.sure)
          return false;
      if (kind == UnitMeasure::drag || kind == UnitMeasure::slope) continue;
      const double near = std::log(kind == UnitMeasure::drive ? beliefs.near_drive : beliefs.near_heat);
      for (std::size_t i = 0; i < parts_.size(); ++i) {
        if (units[i] != &one) continue;
        const Deviation here = deviation(i, kind, one), as_recorded = deviation(i, kind, UnitHypothesis());
        if (here.is_told && here.value != as_recorded.value && std::abs(here.value) > near) return false;
      }
    }
    return true;
  }

  /// What all parts share beside their units: the logarithms by which measures are off, and the air.
  struct Shared {
    std::array<double, unit_measure_count> measures{};  ///< logarithms of what the model is off by
    double air_C = 0.0;                                 ///< temperature of the air where none is recorded
    double start_K = 0.0;                               ///< of the coldest motor above its air
  };
  /// What the recordings share, with the units given.
  Shared shared_by(const Assignment& units) const {
    Shared all;
    for (std::size_t k = 0; k < unit_measure_count; ++k)
      all.measures[k] = shared({static_cast<UnitMeasure>(k)}, units).at;
    all.air_C = air(units).at;
    all.start_K = start(units).at;
    return all;
  }

  /// By how much the logarithm of a measure is off beside the units: the median over the parts; 0 where none tells it.
  double shift(UnitMeasure kind, const Assignment& units) const {
    assert(units.size() == parts_.size());
    std::vector<double> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (const Deviation one = deviation(i, kind, *units[i]); one.is_told) all.push_back(one.value);
    return median_of(all);
  }

  /// What a part says of a hypothesis where the shared constants are given.
  double of_part(std::size_t part, const UnitHypothesis& one, const Shared& shared,
                 const UnitHypothesis& common) const {
    assert(part < parts_.size());
    double sum = own(part, one, common);
    for (std::size_t k = 0; k < unit_measure_count; ++k) {
      const Deviation here = deviation(part, static_cast<UnitMeasure>(k), one);
      if (here.is_told) sum -= misfit((here.value - shared.measures[k]) / here.sd);
    }
    if (parts_[part].air.is_known()) sum -= misfit((air_of(part, one) - shared.air_C) / beliefs.air_sd_K);
    if (parts_[part].motor.is_known())
      sum -= misfit((start_of(part, one) - shared.start_K) / beliefs.start_sd_K);
    return sum;
  }

  /// Whether a part can be in a unit at all.
  bool is_possible(std::size_t part, const UnitHypothesis& one) const {
    return possible_price(parts_[part], one) < beliefs.impossible;
  }

  static constexpr UnitBeliefs beliefs{};  ///< in force

private:
  static constexpr PossibleUnits limit{};

  struct Deviation {
    bool is_told = false;
    double value = 0.0;  // logarithm of measured by expected
    double sd = 1.0;
  };
  struct Best {
    double best = 0.0;  // nats
    double at = 0.0;    // shift
  };

  /// Student's t of two degrees of freedom.
  static double misfit(double standard) { return 1.5 * std::log1p(0.5 * standard * standard); }
  static double moved(double by, double sd) { return std::log1p(by * by / (sd * sd)); }

  static double price(const UnitHypothesis& one) {
    double sum = one.scales.empty() ? beliefs.unit : 0.0;
    for (const ColumnScale& scale : one.scales) {
      const bool measured =
          scale.column == std::string("rate_dps") || scale.column == std::string("angle_deg");
      const double own =
          scale.factor > 0.0 ? beliefs.unit : beliefs.sign + (measured ? beliefs.second_column : 0.0);
      sum += sum > 0.0 ? beliefs.second_column : own;
    }
    return sum;
  }

  /// What only one part's numbers say: signs, temperatures, clocks, exchanged columns.
  double own(std::size_t part, const UnitHypothesis& one, const UnitHypothesis& common) const {
    assert(part < parts_.size());
    const UnitEvidence& of = parts_[part];
    double sum = -possible_price(of, one);
    const bool lacks_column = one.is_none() && !common.applies_to(of);
    if (&one != &common && !lacks_column) sum -= beliefs.odd + (one.is_none() ? 0.0 : price(one));
    if (&one == &common && is_angle_alone(one) && of.has("rate_dps"))
      sum -= beliefs.impossible;  // a cause: angle_scale
    const auto expected = one.expected(of);
    for (std::size_t k = 0; k < unit_measure_count; ++k)
      sum += std::min(0.0, std::copysign(1.0, expected[k]) * of.measures[k].forwards_nats);
    for (const auto& pair : of.exchanged)
      if (pair == one.exchanged) return sum;
    if (!of.exchanged.empty()) sum -= beliefs.exchanged;
    if (!one.exchanged.first.empty()) sum -= 2.0 * beliefs.impossible;
    return sum;
  }

  static bool is_angle_alone(const UnitHypothesis& one) {
    return one.scales.size() == 1 && one.scales.front().column == std::string("angle_deg") &&
           one.scales.front().factor > 0.0;
  }

  double possible_price(const UnitEvidence& of, const UnitHypothesis& one) const {
    double sum = temperatures_price(of, one);
    const double interval_s = of.interval_s / one.factor("t_s");
    const bool too_fast =
        interval_s<(of.is_axis ? limit.axis_fastest_s : limit.bench_fastest_s), too_slow = interval_s>(
            of.is_axis ? limit.axis_slowest_s : limit.bench_slowest_s);
    if ((of.is_axis || of.is_bench) && (too_fast || too_slow))
      sum += one.factor("t_s") == 1.0 ? beliefs.odd_clock : beliefs.impossible;
    if (!of.has("power_param")) return sum;
    const double power = one.factor("power_param");
    const auto is_duty = [&](double most) { return most > 0.0 && most <= limit.full_duty; };
    const bool as_recorded = power == 1.0 && one.exchanged.first.empty();
    const bool is_percent = of.most_power > limit.least_percent && of.most_power <= limit.full_percent;
    if (as_recorded           ? is_duty(most_power_)
        : power == 1.0        ? false
        : power * 255.0 < 1.5 ? !is_duty(of.most_power)
                              : !is_percent)
      sum += beliefs.impossible;
    return sum;
  }

  static bool is_odd(const TemperatureRange& range) {
    return range.low > limit.another_unit_C || range.typical < limit.coldest_C;
  }

  double temperatures_price(const UnitEvidence& of, const UnitHypothesis& one) const {
    double sum = 0.0;
    if (!one.exchanged.first.empty()) {
      const bool moves_motor = one.exchanged.first == "motor_C" || one.exchanged.second == "motor_C",
                 moves_air = one.exchanged.second == "ambient_C";
      return ((!moves_motor || moves_air) && is_odd(of.motor)) || is_odd(of.air) ? beliefs.impossible : 0.0;
    }
    const double air_C = of.air.is_known() ? one.celsius("ambient_C", of.air.typical) : missing;
    const auto price_of = [&](const char* column, const TemperatureRange& range) {
      if (!range.is_known()) return 0.0;
      const double factor = one.factor(column);
      const bool as_recorded = one.celsius(column, 0.0) == 0.0 && factor == 1.0;
      if (as_recorded) return is_odd(range) ? beliefs.impossible : 0.0;
      const double low = one.celsius(column, range.low), typical = one.celsius(column, range.typical),
                   high = one.celsius(column, range.high);
      const bool is_air = column == std::string("ambient_C"), fahrenheit = one.is_fahrenheit(column);
      bool possible = low > limit.motor_low_C && typical < (is_air ? limit.air_high_C : limit.motor_high_C);
      if (!fahrenheit) possible = possible && range.low > limit.another_unit_C;
      if (!is_air) {
        possible = possible && high - low < limit.range_K;
        if (std::isfinite(air_C))
          possible =
              possible && low > air_C - (fahrenheit ? limit.below_air_fahrenheit_K : limit.below_air_K);
      }
      if (factor >= 10.0) possible = possible && range.whole_numbers;
      if (!possible) return 2.0 * beliefs.impossible;
      return factor == 1.0 && range.whole_numbers ? beliefs.whole_kelvin : 0.0;
    };
    sum += price_of("motor_C", of.motor) + price_of("ambient_C", of.air);
    if (std::isfinite(of.air_offset_K)) {
      const double expected_K = one.recorded("motor_C", air_C) - of.air.typical;
      const double sd_K = std::max(beliefs.offset_sd_K, beliefs.offset_share * std::abs(expected_K));
      sum += std::min(misfit((of.air_offset_K - expected_K) / sd_K), beliefs.most_offset);
    }
    return sum;
  }

  Deviation deviation(std::size_t part, UnitMeasure kind, const UnitHypothesis& one) const {
    const Measured& measured = parts_[part][kind];
    if (!measured.is_told() || !one.exchanged.first.empty()) return {};
    // A winding's resistance at an impossible temperature says nothing.
    const bool is_of_winding =
        kind == UnitMeasure::current || kind == UnitMeasure::heating || kind == UnitMeasure::cooling;
    if (is_of_winding && is_odd(parts_[part].motor)) return {};
    const double expected = one.expected(parts_[part])[static_cast<std::size_t>(kind)];
    assert(measured.sd > 0.0 && expected != 0.0);
    return {true, std::log(measured.value / std::abs(expected)), measured.sd};
  }

  static double price_of_shift(UnitMeasure kind, double by) {
    if (kind == UnitMeasure::slope) return std::min(moved(by, beliefs.constant_sd), beliefs.angle_scale);
    const bool loose =
        kind == UnitMeasure::drag || kind == UnitMeasure::supply || kind == UnitMeasure::target;
    const double price = moved(by, loose ? beliefs.drag_sd : beliefs.constant_sd);
    const double farthest = kind == UnitMeasure::drive ? beliefs.farthest_drive : beliefs.farthest_factor;
    const bool is_far = kind != UnitMeasure::drag && std::abs(by) > std::log(farthest);
    return price + (is_far ? beliefs.beyond : 0.0);
  }

  /// The likeliest shift that some measures of all parts share.
  Best shared(const std::vector<UnitMeasure>& kinds, const Assignment& units) const {
    std::vector<Deviation> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      for (const UnitMeasure kind : kinds)
        if (const Deviation one = deviation(i, kind, *units[i]); one.is_told) all.push_back(one);
    return likeliest(
        all, [&](double at) { return price_of_shift(kinds.front(), at); }, 0.0);
  }

  double air_of(std::size_t part, const UnitHypothesis& one) const {
    return one.exchanged.first.empty() ? one.celsius("ambient_C", parts_[part].air.typical) : beliefs.room_C;
  }

  Best air(const Assignment& units) const {
    std::vector<Deviation> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i].air.is_known()) all.push_back({true, air_of(i, *units[i]), beliefs.air_sd_K});
    const auto price_of = [](double at) {
      const double far = (at - beliefs.room_C) / beliefs.room_sd_K;
      return std::min(0.5 * far * far, beliefs.most_air);
    };
    return likeliest(all, price_of, beliefs.room_C);
  }

  double start_of(std::size_t part, const UnitHypothesis& one) const {
    const UnitEvidence& of = parts_[part];
    const bool is_recorded = of.air.is_known() && one.exchanged.first.empty();
    const double air_C = is_recorded ? one.celsius("ambient_C", of.air.typical) : beliefs.room_C;
    return one.celsius("motor_C", of.motor.low) - air_C;
  }

  /// How warm motors are where recordings begin is a habit of their source: it is priced once.
  Best start(const Assignment& units) const {
    std::vector<Deviation> all;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (parts_[i].motor.is_known() && units[i]->exchanged.first.empty())
        all.push_back({true, start_of(i, *units[i]), beliefs.start_sd_K});
    const auto price_of = [](double at) {
      return std::min(moved(at, beliefs.start_sd_K), beliefs.most_start);
    };
    return likeliest(all, price_of, 0.0);
  }

  /// Of the shift that was expected and those that single deviations have, the likeliest.
  template <class Price>
  static Best likeliest(const std::vector<Deviation>& all, Price&& price, double expected) {
    if (all.empty()) return {0.0, expected};
    Best best{-std::numeric_limits<double>::infinity(), expected};
    const auto ask = [&](double at) {
      double sum = -price(at);
      for (const Deviation& one : all) sum -= misfit((one.value - at) / one.sd);
      if (sum > best.best) best = {sum, at};
    };
    ask(expected);
    constexpr std::size_t asked = 64;  // candidates: more say the same
    const std::size_t step = all.size() / asked + 1;
    for (std::size_t i = 0; i < all.size(); i += step) ask(all[i].value);
    return best;
  }

  const std::vector<UnitEvidence>& parts_;
  double most_power_;
};

}  // namespace thermopower::gap::engine
