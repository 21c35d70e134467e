// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/finding_list.hpp>
#include <thermopower/gap/data/heat_scale.hpp>
#include <thermopower/gap/data/prepared_recording.hpp>
#include <thermopower/gap/detail/column_option.hpp>
#include <thermopower/gap/detail/scale_check.hpp>
#include <thermopower/gap/detail/time_units.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/plant/bench_at_rows.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

/// @file bench_scale_check.hpp
/// Units, signs and exchanged columns of a bench by the size of its numbers: the current by what the circuit draws, the rate
/// of warming by what heat and loss make it.

namespace thermopower::gap::engine {

/// Thresholds of the check of a bench's sizes. Factors are compared by the magnitudes of their logarithms.
/// Held by tests/gap/data/scale_test.cpp.
struct BenchScaleThresholds {
  double sound_current = 2.0;      ///< factor by which a current may be off
  double exchanged_current = 1.4;  ///< times that it may be off with two columns exchanged back
  double near_current = 3.0;       ///< times that it may be off a unit's factor
  double percent_low = 1.4;        ///< sqrt(255 / 100) is 1.597: from here
  double percent_high = 1.8;       ///< to here a power of at most 100 is in percent
  double least_percent = 40.0;     ///< largest power of one in percent, at least: else it may be a small one
  double near_supply = 3.0;        ///< times that a supply may be off a thousand nominal ones
  double near_time = 6.0;          ///< times that heat and loss may be off the factor of a unit of time
  double together = 5.0;           ///< times that they may be off each other
  double beyond = 30.0;            ///< factor that no constant is off by
  double shortest_s = 5e-3;        ///< interval between rows of a bench
  double longest_s = 600.0;        ///< interval between rows of a bench
  double coldest_air_F = 50.0;     ///< air that may be in degrees Fahrenheit
  double hottest_air_F = 113.0;    ///< air that may be in degrees Fahrenheit
  double offset_share = 0.25;      ///< that an offset may be off the one that degrees Fahrenheit make
  double offset_partial = 0.6;     ///< correlation of loss and warming that tells it
  double warms_in_fahrenheit =
      1.3;                   ///< by which the heat warms a motor in degrees Fahrenheit too much, at least
  double below_air_K = 3.0;  ///< that thermometers of motor and air may be apart
};

/// Looks for wrong units, signs and exchanged columns of a bench.
class BenchScaleCheck {
public:
  /// All must outlive this object.
  /// @param most_power  largest power_param of all recordings that were given together
  BenchScaleCheck(const Model& model, const PreparedRecording& prepared, const Catalogue& catalogue,
                  double most_power)
      : model_(model), prepared_(prepared), recording_(prepared.recording()), most_power_(most_power) {
    const Inputs& inputs = prepared.inputs();
    const plant::HeatTold heat = plant::heat_told(inputs);
    const plant::BenchAtRows::Values law = plant::BenchAtRows(model, catalogue, inputs, {}).evaluate(heat);
    if (model.has_current() && recording_.has("power_param") && recording_.has("current_A"))
      current_ = factor_of(recording_.column("current_A"), law.law_A);
    const auto* const lumped = std::get_if<LumpedThermalModel>(&model.thermal);
    if (lumped == nullptr || !inputs.judged(Signal::motor_C)) return;
    warming_ =
        regress_warming({inputs.t_s, inputs.runs, inputs.of(Signal::motor_C),
                         law.heat_W.cwiseQuotient(law.capacity), law.loss_W.cwiseQuotient(law.capacity),
                         lumped->conductance_W_per_K / lumped->heat_capacity_J_per_K});
  }

  /// Adds exchanged columns. @return whether there are any
  bool find_exchanged(FindingList& list) const {
    constexpr BenchScaleThresholds limit;
    if (!std::holds_alternative<OhmicCurrentModel>(model_.current) || !recording_.has("power_param") ||
        !recording_.has("current_A"))
      return false;
    if (current_.is_one() && (times_off(current_.value, 1.0) < limit.sound_current || is_of_unit()))
      return false;
    constexpr std::pair<const char*, const char*> pairs[] = {{"power_param", "current_A"},
                                                             {"power_param", "motor_C"},
                                                             {"current_A", "motor_C"},
                                                             {"current_A", "supply_V"},
                                                             {"motor_C", "supply_V"}};
    for (const auto& [a, b] : pairs) {
      if (!recording_.has(a) || !recording_.has(b)) continue;
      const FactorTold then = ohmic_current(a, b);
      if (!then.is_one() || times_off(then.value, 1.0) > limit.exchanged_current) continue;
      list.add(FindingKind::swapped_columns, Severity::error, a,
               std::string("and ") + b + " are exchanged: the current is then " + short_number(then.value) +
                   " times what the circuit draws, as it should",
               exchange_option(a, b));
      return true;
    }
    return false;
  }

  /// How the motor warms by heat and loss.
  const WarmingTold& warming() const { return warming_; }

  /// Adds wrong units and signs, each mistake once.
  void find(FindingList& list) const {
    if (find_supply(list) || find_current(list) || find_time(list)) return;
    find_air(list);
  }

private:
  /// The measured current by that of the circuit, with two columns exchanged.
  FactorTold ohmic_current(const std::string& a, const std::string& b) const {
    const auto& winding = std::get<OhmicCurrentModel>(model_.current);
    const auto column = [&](const std::string& name) -> const Eigen::VectorXd* {
      return recording_.find(name == a ? b : name == b ? a : name);
    };
    constexpr double full_power = 255.0;
    const Eigen::VectorXd &power = *column("power_param"), &amperes = *column("current_A");
    const Eigen::VectorXd *supply = column("supply_V"), *motor = column("motor_C");
    Eigen::VectorXd expected(power.size());
    for (Eigen::Index i = 0; i < power.size(); ++i) {
      const double volts = supply != nullptr ? (*supply)[i] : prepared_.inputs().nominal_V;
      const double above_K = motor != nullptr ? (*motor)[i] - winding.reference_C : 0.0;
      const bool is_power = power[i] >= 0.0 && power[i] <= full_power;
      expected[i] = is_power ? volts * std::sqrt(power[i] / full_power) /
                                   (winding.resistance_ohm * (1.0 + winding.tempco_per_K * above_K))
                             : missing;
    }
    return factor_of(amperes, expected);
  }

  double typical(const char* column) const {
    std::vector<double> values = finite_samples(recording_.column(column));
    return median_of(values);
  }

  bool find_supply(FindingList& list) const {
    constexpr double thousand = 1e3;
    if (!recording_.has("supply_V") || !model_.has_current() || !recording_.has("power_param")) return false;
    const double volts = typical("supply_V");
    if (volts < 0.0) {
      list.add(FindingKind::wrong_sign, Severity::error, "supply_V",
               "has the wrong sign: the voltage of a supply is positive", column_option("supply_V", "-V"));
      return true;
    }
    const double nominal = model_.supply ? model_.supply->nominal_V : 0.0;
    if (!(times_off(volts, thousand * nominal) < BenchScaleThresholds().near_supply)) return false;
    list.add(
        FindingKind::wrong_unit, Severity::error, "supply_V",
        "is in millivolts where volts are expected (the model's nominal_V is " + short_number(nominal) + ")",
        column_option("supply_V", "mV"));
    return true;
  }

  static constexpr double turned = -1.0, milli = 1e3, micro = 1e6;  // of a current in another unit
  bool is_near(double factor) const {
    return times_off(current_.value, factor) < BenchScaleThresholds().near_current;
  }
  bool is_of_unit() const { return is_near(turned) || is_near(milli) || is_near(micro); }

  bool find_current(FindingList& list) const {
    constexpr BenchScaleThresholds limit;
    if (!(current_.low * current_.high > 0.0)) return false;
    const std::string draws = " (it is " + short_number(current_.value) + " times what the circuit draws)";
    const auto add = [&](FindingKind kind, const char* column, const std::string& words, const char* unit) {
      list.add(kind, Severity::error, column, words + draws, column_option(column, unit));
      return true;
    };
    if (is_near(turned))
      return add(FindingKind::wrong_sign, "current_A",
                 "has the wrong sign: a motor's current is positive where its voltage is", "-A");
    constexpr double full_percent = 100.0;
    if (is_near(milli))
      return add(FindingKind::wrong_unit, "current_A", "is in milliamperes where amperes are expected", "mA");
    if (is_near(micro))
      return add(FindingKind::wrong_unit, "current_A", "is in microamperes where amperes are expected", "uA");
    if (!(most_power_ > limit.least_percent && most_power_ <= full_percent)) return false;
    if (!current_.is_one() || !(current_.value > limit.percent_low && current_.value < limit.percent_high))
      return false;
    list.add(FindingKind::wrong_unit, Severity::error, "power_param",
             "never exceeds 100, and the current is " + short_number(current_.value) +
                 " times what the circuit draws: it is in percent where 0..255 is expected",
             column_option("power_param", "%"));
    return true;
  }

  bool find_time(FindingList& list) const {
    constexpr BenchScaleThresholds limit;
    if (!warming_.is_told()) return false;
    const double heat = warming_.heat.value, loss = warming_.loss.value;
    if (find_heating_current(list, heat, loss)) return true;
    if (times_off(heat, loss) > limit.together) return false;
    const double factor = std::sqrt(heat * loss), interval_s = prepared_.interval_s();
    const auto is_possible = [&](double s) { return s >= limit.shortest_s && s <= limit.longest_s; };
    const TimeUnit* best = nullptr;
    for (const TimeUnit& one : time_units)
      if (is_possible(interval_s * one.in_s) && times_off(factor, one.in_s) < limit.near_time &&
          (best == nullptr || times_off(factor, one.in_s) < times_off(factor, best->in_s)))
        best = &one;
    const std::string warms = short_number(heat) + " times as fast as the model's, and cools " +
                              short_number(loss) + " times as fast";
    const bool constants = is_possible(interval_s);
    if (best != nullptr)
      list.add(FindingKind::wrong_unit, Severity::error, "t_s",
               std::string("is in ") + best->words + " where seconds are expected (the motor warms " + warms +
                   (constants ? "; or the model's heat_capacity_J_per_K is off)" : ")"),
               column_option("t_s", best->option));
    else if (times_off(factor, 1.0) > limit.beyond)
      list.add(
          FindingKind::wrong_unit, Severity::error, "t_s",
          "or the model's heat_capacity_J_per_K is off by more than constants are: the motor warms " + warms,
          "look at the clock's unit and at the model's constants");
    else return false;
    return true;
  }

  /// A current that heats by its square, and the heat as it was recorded.
  bool find_heating_current(FindingList& list, double heat, double loss) const {
    constexpr BenchScaleThresholds limit;
    if (times_off(loss, 1.0) > limit.near_time) return false;
    const Inputs& inputs = prepared_.inputs();
    const auto heats = [&](double factor) { return times_off(heat, factor) < limit.near_time; };
    const auto add = [&](const char* column, const char* words, const char* unit) {
      list.add(FindingKind::wrong_unit, Severity::error, column,
               std::string(words) + " (it heats the motor " + short_number(1.0 / heat) + " times too much)",
               column_option(column, unit));
      return true;
    };
    constexpr double thousandth = 1e-3, thousand = 1e3;
    if (inputs.heat_W.size() > 0) {
      if (heats(thousandth)) return add("heat_W", "is in milliwatts where watts are expected", "mW");
      return heats(thousand) && add("heat_W", "is in kilowatts where watts are expected", "kW");
    }
    if (inputs.heat == HeatSource::law || !heats(thousandth * thousandth)) return false;
    return add(inputs.heat == HeatSource::drive ? "drive_A" : "current_A",
               "is in milliamperes where amperes are expected", "mA");
  }

  /// Motor or air in degrees Fahrenheit: the motor cools down to another temperature than the air's.
  void find_air(FindingList& list) const {
    constexpr BenchScaleThresholds limit;
    constexpr double per_kelvin = 1.8, ice_F = 32.0;
    if (!warming_.is_told() || warming_.loss.partial < limit.offset_partial || !recording_.has("ambient_C"))
      return;
    const double air = typical("ambient_C");
    std::vector<double> motor = finite_samples(recording_.column("motor_C"));
    const double coldest = quantile_of(motor, 0.0), offset_K = warming_.offset_K;
    const auto is_near = [&](double expected_K) {
      return std::abs(offset_K - expected_K) < limit.offset_share * std::abs(expected_K);
    };
    const auto add = [&](const char* column, const std::string& words) {
      list.add(FindingKind::wrong_unit, Severity::error, column,
               "is in degrees Fahrenheit where degrees Celsius are expected (the motor cools down to " +
                   short_number(air + offset_K) + words,
               column_option(column, "degF"));
    };
    const bool may_be_F = air > limit.coldest_air_F && air < limit.hottest_air_F;
    if (may_be_F && coldest < air && is_near((air - ice_F) / per_kelvin - air))
      add("ambient_C", " where the air is at " + short_number(air) + ")");
    else if (!may_be_F && warming_.heat.value > limit.warms_in_fahrenheit &&
             coldest > per_kelvin * (air - limit.below_air_K) + ice_F &&
             is_near(per_kelvin * air + ice_F - air))
      add("motor_C", ", which is the air's " + short_number(air) + " degC in degrees Fahrenheit)");
  }

  const Model& model_;
  const PreparedRecording& prepared_;
  const Recording& recording_;
  double most_power_;
  FactorTold current_;
  WarmingTold warming_;
};

}  // namespace thermopower::gap::engine
