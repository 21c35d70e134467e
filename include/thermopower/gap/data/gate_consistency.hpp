// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/gate_channels.hpp>
#include <thermopower/gap/localise/quantity.hpp>

/// @file gate_consistency.hpp
/// What channels tell of each other: units, signs, and loggers whose clocks differ.

namespace thermopower::gap::detail {

/// Slope of y against x through the origin, and how much of y it explains.
struct ThroughOrigin {
  double slope = 0.0, explained = 0.0;
};

inline ThroughOrigin through_origin(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (Eigen::Index i = 0; i < x.size() && i < y.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    xx += x[i] * x[i];
    xy += x[i] * y[i];
    yy += y[i] * y[i];
  }
  if (!(xx > 0.0) || !(yy > 0.0)) return {};
  return {xy / xx, xy * xy / (xx * yy)};
}

inline bool near_factor(double value, double factor) { return value > 0.8 * factor && value < 1.25 * factor; }

inline double median_of_column(const Recording& r, const char* name) {
  std::vector<double> values;
  const Eigen::VectorXd* column = r.find(name);
  for (Eigen::Index i = 0; column != nullptr && i < column->size(); ++i) {
    if (std::isfinite((*column)[i])) values.push_back((*column)[i]);
  }
  return median_of(values);
}

inline void check_units(FindingList& list, const Model& model) {
  const Recording& r = list.recording();
  for (const char* name : {"motor_C", "ambient_C", "neighbour_C"}) {
    if (!r.has(name)) continue;
    const double typical = median_of_column(r, name);
    if (typical > 240.0 && typical < 480.0) {
      list.add("wrong_unit", Severity::warning, name,
               "is " + short_number(typical) + " typically: kelvin? expected degrees Celsius");
    } else if (typical > 2000.0) {
      list.add(
          "wrong_unit", Severity::warning, name,
          "is " + short_number(typical) + " typically: hundredths of a degree? expected degrees Celsius");
    }
  }
  if (r.has("power_param")) {
    const Eigen::VectorXd& power = *r.find("power_param");
    double most = 0.0;
    for (Eigen::Index i = 0; i < power.size(); ++i)
      most = std::isfinite(power[i]) ? std::max(most, power[i]) : most;
    if (most > 0.0 && most <= 1.0)
      list.add("wrong_unit", Severity::warning, "power_param",
               "never exceeds 1: a duty of 0..1? expected 0..255");
  }
  if (r.has("supply_V") && model.supply) {
    const double ratio = median_of_column(r, "supply_V") / model.supply->nominal_V;
    if (near_factor(ratio, 1000.0))
      list.add("wrong_unit", Severity::warning, "supply_V",
               "is a thousand times the model's nominal voltage: millivolts? expected volts");
  }
}

inline void check_current(FindingList& list, const Model& model) {
  const Recording& r = list.recording();
  if (!model.has_current() || !r.has("power_param") || !r.has("current_A")) return;
  const BenchRows rows = bench_rows(model, r);
  const ThroughOrigin fit = through_origin(rows.law_A, rows.current_A);
  if (fit.explained > 0.7) {
    if (fit.slope < 0.0) {
      list.add("wrong_sign", Severity::warning, "current_A",
               "is negative where the model draws current; expected a positive motor current");
    } else if (near_factor(fit.slope, 1000.0)) {
      list.add("wrong_unit", Severity::warning, "current_A",
               "is a thousand times what the model draws: milliamperes? expected amperes");
    } else if (near_factor(fit.slope, 0.001)) {
      list.add("wrong_unit", Severity::warning, "current_A",
               "is a thousandth of what the model draws: kiloamperes? expected amperes");
    }
  }
  // A current follows its voltage within a row: if another shift fits far better, the loggers' clocks differ.
  const auto left_at = [&](Eigen::Index shift) {
    double xx = 0.0, xy = 0.0, yy = 0.0, n = 0.0;
    for (const RunSpan& run : rows.runs) {
      for (Eigen::Index i = run.begin + 12; i + 12 < run.end; ++i) {
        const double x = rows.law_A[i - shift], y = rows.current_A[i];
        if (!std::isfinite(y)) continue;
        xx += x * x;
        xy += x * y;
        yy += y * y;
        n += 1.0;
      }
    }
    return n > 30.0 && xx > 0.0 ? (yy - xy * xy / xx) / n : -1.0;
  };
  const double now = left_at(0);
  double best = now;
  Eigen::Index at = 0;
  for (Eigen::Index shift = -12; shift <= 12; ++shift) {
    const double left = left_at(shift);
    if (left >= 0.0 && left < best) {
      best = left;
      at = shift;
    }
  }
  if (at != 0 && best < 0.6 * now) {
    list.add("clock_shift", Severity::warning, "current_A",
             std::string(at > 0 ? "follows" : "precedes") + " power_param by " +
                 short_number(std::fabs(static_cast<double>(at)) * rows.interval_s) + " s (" +
                 std::to_string(std::abs(at)) + " rows): do the loggers' clocks agree?");
  }
}

inline void check_axis(FindingList& list, const Model& model) {
  const Recording& r = list.recording();
  if (!r.has("rate_dps") && !r.has("angle_deg")) return;
  const AxisRows rows = axis_rows(r);
  if (rows.has_rate && rows.has_angle) {
    const Observed o = observe_instruments(rows);
    const Eigen::VectorXd rate = o.find("rate_dps")->values;
    const ThroughOrigin fit = through_origin(rate, o.value + rate);
    if (fit.explained > 0.5) {
      const double factor = std::fabs(fit.slope);
      const char* guess = near_factor(factor, 57.2958)
                              ? " (radians per second in rate_dps, or an angle multiplied by 180/pi?)"
                          : near_factor(factor, 1.0 / 57.2958) ? " (an angle in radians?)"
                          : near_factor(factor, 6.0) || near_factor(factor, 1.0 / 6.0)
                              ? " (revolutions per minute?)"
                              : "";
      if (fit.slope < 0.0) {
        list.add("wrong_sign", Severity::warning, "angle_deg",
                 "falls where rate_dps is positive: one of the two has the wrong sign");
      } else if (factor > 1.05 || factor < 0.95) {
        list.add("wrong_unit", Severity::warning, "angle_deg",
                 "moves " + short_number(factor) + " times as far as rate_dps says" + guess);
      }
    }
  }
  if (!model.has_axis() || !r.has("drive_A")) return;
  const Bumps bumps(rows, rows.raw_rate, 4, 3000);
  if (bumps.size() < 30) return;
  const Eigen::VectorXd gained = model.axis->inertia_kgm2 * bumps.derivative(rows.rate) +
                                 model.axis->viscous_Nms_per_rad * bumps.integral(rows.rate);
  const ThroughOrigin now =
      through_origin(model.axis->torque_constant_Nm_per_A * bumps.held_integral(rows.drive_A), gained);
  if (now.slope < 0.0 && now.explained > 0.3) {
    list.add("wrong_sign", Severity::warning, "drive_A",
             "accelerates the axis backwards: drive or motion has the wrong sign");
    return;
  }
  // Only the impossible is a clock: a motion that comes before its command. One that comes after may be the
  // drive's own delay.
  double best = now.explained, at = 0.0;
  for (int k = 1; k <= 8; ++k) {
    const double early =
        through_origin(bumps.held_integral(rows.drive_A, -k * rows.interval_s), gained).explained;
    if (early > best) {
      best = early;
      at = k * rows.interval_s;
    }
  }
  if (at > 0.0 && 1.0 - best < 0.3 * (1.0 - now.explained)) {
    list.add("clock_shift", Severity::warning, "drive_A",
             "is stamped " + short_number(at) +
                 " s later than the motion it causes: do the loggers' clocks agree?");
  }
}

}  // namespace thermopower::gap::detail
