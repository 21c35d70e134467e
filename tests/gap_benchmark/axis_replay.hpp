// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "axis_plant.hpp"

namespace gap_benchmark {

/// A position servo that samples at the rows of the log.
struct AxisServo {
  bool closed = false;  ///< it makes the command; else the command is given
  double kp_A_per_deg = 0.0, kd_A_s_per_deg = 0.0, limit_A = 0.0;
  std::vector<double> target_deg, target_dps;

  double command_A(std::size_t row, double angle_deg, double rate_dps) const {
    const double wanted =
        kp_A_per_deg * (target_deg[row] - angle_deg) + kd_A_s_per_deg * (target_dps[row] - rate_dps);
    return std::clamp(wanted, -limit_A, limit_A);
  }
};

/// The row whose target the servo has at a row, when targets are late; before its first one a run had that.
inline std::size_t row_of_target(const std::vector<double>& t_s, std::size_t run_first, std::size_t row,
                                 double late_s) {
  std::size_t from = row;
  while (from > run_first && t_s[from] > t_s[row] - late_s + 1e-9) --from;
  return from;
}

/// Everything that goes into a replay of an axis.
struct AxisDrive {
  std::vector<double> t_s;
  std::vector<AxisInput> input;
  std::vector<std::size_t> run_start;
  AxisServo servo;
};

struct AxisOutput {
  std::vector<double> angle_deg, rate_dps;
};

/// Carries an axis from row `k` to row `k + 1`, with the command as late as it is.
/// @param run_first first row of the run; before it the command was zero
inline void advance_row(const AxisPlant& plant, AxisState& x, const AxisDrive& drive, std::size_t run_first,
                        std::size_t k, double end_s) {
  double now_s = drive.t_s[k];
  AxisInput u = drive.input[k];
  if (plant.delay() <= 0.0) {
    plant.advance(x, u, end_s - now_s);
    return;
  }
  // The last row whose command has arrived by now, if any.
  std::size_t arrived = k + 1;
  while (arrived > run_first && drive.t_s[arrived - 1] + plant.delay() > now_s + 1e-12) --arrived;
  while (now_s < end_s) {
    u.drive_A = arrived > run_first ? drive.input[arrived - 1].drive_A : 0.0;
    const double next_s = arrived <= k ? std::min(end_s, drive.t_s[arrived] + plant.delay()) : end_s;
    plant.advance(x, u, next_s - now_s);
    now_s = next_s;
    ++arrived;
  }
}

/// Replay in windows that restart from what was measured.
/// With a servo in the loop, commands that were given before a window are those that were given.
/// @param restarted receives true for the rows at which a window began
inline AxisOutput replay(const AxisParameters& parameters, const AxisDrive& given, const AxisOutput& measured,
                         double window_s, double step_scale = 1.0, bool absolute = false,
                         std::vector<char>* restarted = nullptr,
                         std::size_t rows = static_cast<std::size_t>(-1)) {
  const AxisPlant plant(parameters, step_scale);
  constexpr double longest_delay_s = 0.1;
  AxisDrive looped;
  if (given.servo.closed) looped = given;
  const AxisDrive& drive = given.servo.closed ? looped : given;
  AxisOutput out;
  AxisState x;
  std::size_t run = 0, first = 0;
  double window_start_s = 0.0;
  rows = std::min(rows, drive.t_s.size());
  for (std::size_t k = 0; k < rows; ++k) {
    const bool starts = run < drive.run_start.size() && drive.run_start[run] == k;
    if (starts) {
      first = k;
      ++run;
    } else {
      advance_row(plant, x, drive, first, k - 1, drive.t_s[k]);
    }
    const double run_time_s = drive.t_s[k] - drive.t_s[first];
    const bool usable = !std::isnan(measured.angle_deg[k]) && !std::isnan(measured.rate_dps[k]);
    const bool again = starts || (usable && drive.t_s[k] - window_start_s >= window_s - 1e-9);
    if (again) {
      plant.restart(x, measured.angle_deg[k], measured.rate_dps[k], run_time_s, starts, absolute);
      window_start_s = drive.t_s[k];
    }
    if (given.servo.closed) {
      for (std::size_t j = k; again && j-- > first && drive.t_s[k] - drive.t_s[j] < longest_delay_s;)
        looped.input[j].drive_A = given.input[j].drive_A;
      looped.input[k].drive_A =
          given.servo.command_A(row_of_target(drive.t_s, first, k, plant.target_delay()),
                                x.angle * degrees_per_radian, x.rate * degrees_per_radian);
    }
    if (restarted) restarted->push_back(again);
    out.angle_deg.push_back(plant.sensed_angle_deg(x, run_time_s));
    out.rate_dps.push_back(plant.sensed_rate_dps(x));
  }
  return out;
}

}  // namespace gap_benchmark
