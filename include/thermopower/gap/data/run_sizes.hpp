// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/robust.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

/// @file run_sizes.hpp
/// How large the numbers of each run are: a run whose numbers are of another size than those of the others may be in another
/// unit. That costs next to nothing, and tells which runs are worth the questions about units.

namespace thermopower::gap::engine {

/// Thresholds of what is another size. Factors are compared by the magnitudes of their logarithms.
/// Held by tests/gap/data/run_units_test.cpp.
struct RunSizeThresholds {
  Eigen::Index looked_at = 400;  ///< rows of a run, about
  Eigen::Index least_rows = 20;  ///< of a run
  double motion = 2.5;           ///< of a motion by its command: turns per minute are a sixth
  double angle = 4.0;            ///< of an angle by its rate, which swings of another pace change, too
  double circuit = 1.3;          ///< of a current by the root of its power: percent are 1.6 times
  double power = 1.8;            ///< of a power: percent are 2.55 times
  double interval = 5.0;         ///< of the time between rows
  double thousand = 30.0;        ///< of what comes in thousandths
  double warmer_K = 25.0;        ///< of temperatures, in the numbers
};

/// A number that tells how large a run's columns are.
struct RunSize {
  std::vector<std::string> columns;  ///< that may be in another unit where it is of another size
  double value = missing;            ///< NaN: the run tells nothing of it
  double apart = 1.0;                ///< what makes it another size: a factor, or a difference
  bool is_difference = false;        ///< of temperatures
};

/// The sizes of some rows of a recording: the same ones, in the same order, whatever the rows.
class RunSizes {
public:
  /// @param rows  of the recording that are looked at
  RunSizes(const Model& model, const Recording& recording, std::pair<Eigen::Index, Eigen::Index> rows)
      : recording_(recording), rows_(rows) {
    if (rows.second - rows.first < RunSizeThresholds().least_rows) return;
    motion(model);
    bench();
    add({"t_s"}, interval_s(), RunSizeThresholds().interval);
    temperature("motor_C", 0.05);
    temperature("ambient_C", 0.5);
  }

  /// The sizes.
  const std::vector<RunSize>& all() const { return sizes_; }

private:
  void add(std::initializer_list<const char*> columns, double value, double apart,
           bool is_difference = false) {
    sizes_.push_back({{columns.begin(), columns.end()}, value, apart, is_difference});
  }

  std::vector<double> some_of(const char* name) const {
    std::vector<double> list;
    if (const Eigen::VectorXd* values = recording_.find(name)) {
      const Eigen::Index step = 1 + (rows_.second - rows_.first) / RunSizeThresholds().looked_at;
      for (Eigen::Index i = rows_.first; i < rows_.second; i += step)
        if (std::isfinite((*values)[i])) list.push_back((*values)[i]);
    }
    return list;
  }

  /// How far a column goes from 0; NaN where it does not.
  double largest(const char* name) const {
    constexpr double share = 0.9;
    std::vector<double> list = some_of(name);
    for (double& one : list) one = std::abs(one);
    const double value = quantile_of(list, share);
    return value > 0.0 ? value : missing;
  }

  /// How far a column goes up and down; NaN where it does not.
  double range(const char* name) const {
    constexpr double share = 0.05;
    std::vector<double> list = some_of(name);
    const double value = quantile_of(list, 1.0 - share) - quantile_of(list, share);
    return value > 0.0 ? value : missing;
  }

  double interval_s() const {
    std::vector<double> steps;
    const Eigen::Index step = 1 + (rows_.second - rows_.first) / RunSizeThresholds().looked_at;
    for (Eigen::Index i = rows_.first; i + 1 < rows_.second; i += step)
      steps.push_back(recording_.t_s[i + 1] - recording_.t_s[i]);
    return median_of(steps);
  }

  void motion(const Model& model) {
    constexpr RunSizeThresholds limit;
    if (!model.has_axis()) return;
    const double rate = largest("rate_dps"), angle = range("angle_deg");
    for (const char* command : {"drive_A", "voltage_V", "target_deg", "target_dps", "torque_Nm"}) {
      if (!recording_.has(command)) continue;
      const double size = largest(command);
      if (recording_.has("rate_dps")) add({command, "rate_dps"}, rate / size, limit.motion);
      else add({command, "angle_deg"}, angle / size, limit.motion);
    }
    if (recording_.has("rate_dps")) add({"angle_deg", "rate_dps"}, angle / rate, limit.angle);
  }

  void bench() {
    constexpr RunSizeThresholds limit;
    const double power = largest("power_param"), current = largest("current_A");
    if (recording_.has("power_param"))
      add({"current_A", "power_param"}, current / std::sqrt(power), limit.circuit);
    else add({"current_A"}, current, limit.thousand);
    add({"power_param"}, power, limit.power);
    add({"supply_V"}, largest("supply_V"), limit.thousand);
    add({"heat_W"}, largest("heat_W"), limit.thousand);
  }

  void temperature(const char* name, double share) {
    std::vector<double> list = some_of(name);
    add({name}, list.empty() ? missing : quantile_of(list, share), RunSizeThresholds().warmer_K, true);
  }

  const Recording& recording_;
  std::pair<Eigen::Index, Eigen::Index> rows_;
  std::vector<RunSize> sizes_;
};

/// What is of another size in a run than in most.
struct OddSizes {
  std::vector<std::string> columns;  ///< that may be in another unit; empty: none
  double apart = 0.0;                ///< how far the furthest is, by what is far

  /// Whether it is one of the columns.
  bool has(const std::string& column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
};

/// Compares one size over runs.
class SizeOfMost {
public:
  /// Adds a run's.
  void add(const RunSize& size) {
    if (std::isfinite(size.value)) values_.push_back(size.value);
  }
  /// To be asked when all are added: how far a size is from that of most, by what is far.
  double apart(const RunSize& size) {
    if (!std::isfinite(size.value) || values_.size() < 2) return 0.0;
    if (!std::isfinite(middle_)) middle_ = median_of(values_);
    if (size.is_difference) return std::abs(size.value - middle_) / size.apart;
    return std::abs(std::log(size.value / middle_)) / std::log(size.apart);
  }

private:
  std::vector<double> values_;
  double middle_ = missing;
};

/// What is odd in each run. @param runs  the sizes of each; empty where it has too few rows
inline std::vector<OddSizes> odd_sizes(const std::vector<std::vector<RunSize>>& runs) {
  std::vector<std::pair<std::string, SizeOfMost>> most;
  const auto of_most = [&](const RunSize& size) -> SizeOfMost& {
    // Recordings may have different columns.
    std::string key;
    for (const std::string& column : size.columns) key += column + " ";
    for (auto& [name, one] : most)
      if (name == key) return one;
    most.emplace_back(key, SizeOfMost());
    return most.back().second;
  };
  for (const std::vector<RunSize>& run : runs)
    for (const RunSize& size : run) of_most(size).add(size);
  std::vector<OddSizes> odd(runs.size());
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (const RunSize& size : runs[i]) {
      const double apart = of_most(size).apart(size);
      if (apart > 1.0) odd[i].columns.insert(odd[i].columns.end(), size.columns.begin(), size.columns.end());
      odd[i].apart = std::max(odd[i].apart, apart);
    }
  return odd;
}

}  // namespace thermopower::gap::engine
