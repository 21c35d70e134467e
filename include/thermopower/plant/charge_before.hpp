// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/rows.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace thermopower::plant {

/// Share of a motor's current that its supply carries at a power parameter of 0..255: sqrt(duty).
inline double share_of_supply(double power_param) {
  return std::sqrt(std::clamp(power_param, 0.0, 255.0) / 255.0);
}

/// The charge that a supply has given by the recorded current; a missing sample counts as none.
///
/// @snippet plant_examples.cpp charge
/// How to: @ref gap_method.
class RecordedCharge {
public:
  /// Keeps references to all.
  /// @param current_A    by row, NaN where missing; empty: nothing is known
  /// @param power_param  by row; empty: the supply carries the motor's current
  RecordedCharge(const Eigen::VectorXd& t_s, const Eigen::VectorXd& current_A,
                 const Eigen::VectorXd& power_param)
      : t_s_(t_s), current_A_(current_A), power_param_(power_param) {}

  /// Charge when a row of a run is reached, in Ah.
  double until(const RunSpan& run, Eigen::Index row) const {
    double drawn_As = 0.0;
    for (Eigen::Index i = run.begin; i < row; ++i) drawn_As += supply_A(i) * (t_s_[i + 1] - t_s_[i]);
    return run.drawn_Ah + drawn_As / seconds_per_h;
  }

  /// Tells the runs that go on what their supply had given before: a battery is not charged anew where a logger pauses or rows are
  /// left out. Meanwhile the mean of the currents before and after flows; over a pause longer than all that the run before
  /// lasted nobody knows. A run that goes on from nothing that was recorded keeps what it has.
  void tell(std::vector<RunSpan>& runs) const {
    for (std::size_t i = 1; i < runs.size(); ++i) {
      const RunSpan& before = runs[i - 1];
      RunSpan& run = runs[i];
      if (!run.goes_on || before.label != run.label || before.end != run.begin || before.size() < 1) continue;
      const Eigen::Index last = before.end - 1;
      const double pause_s = t_s_[run.begin] - t_s_[last];
      if (pause_s > t_s_[last] - t_s_[before.begin]) continue;
      run.drawn_Ah =
          until(before, last) + 0.5 * (supply_A(last) + supply_A(run.begin)) * pause_s / seconds_per_h;
    }
  }

private:
  static constexpr double seconds_per_h = 3600.0;

  double supply_A(Eigen::Index row) const {
    if (current_A_.size() == 0) return 0.0;
    const double amps =
        current_A_[row] * (power_param_.size() > 0 ? share_of_supply(power_param_[row]) : 1.0);
    return std::isfinite(amps) ? amps : 0.0;
  }

  const Eigen::VectorXd& t_s_;
  const Eigen::VectorXd& current_A_;
  const Eigen::VectorXd& power_param_;
};

}  // namespace thermopower::plant
