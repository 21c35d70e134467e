// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <array>
#include <cmath>

#include <thermopower/simulation/optics.hpp>

/// @file rig_metrics.hpp
/// What a run is judged by.

namespace thermopower::simulation {

/// Figures of one axis over the counted part of a run.
struct AxisMetrics {
  double error_rms_deg = 0.0;    ///< Of the true pointing error.
  double error_peak_deg = 0.0;   ///< Largest magnitude.
  double blur_rms_px = 0.0;      ///< Eq 2.2 with the camera's own turning rate.
  double blurred_share = 0.0;    ///< Share of the time with more than half a pixel.
  double energy_J = 0.0;         ///< Drawn from the supply, settling included.
  double mean_power = 0.0;       ///< Of the POWER parameter.
  double peak_winding_C = -1e9;  ///< Over the whole run.
  double peak_body_C = -1e9;     ///< Over the whole run.
  double over_limit_s = 0.0;     ///< Time in which the body was above its limit.
  double limiting_s = 0.0;       ///< Time in which the controller gave less than it asked for.
};

/// Figures of a run.
///
/// @snippet simulation_examples.cpp rig
/// How to: @ref rig.
struct RigMetrics {
  std::array<AxisMetrics, 3> axes;  ///< Roll, pitch, yaw.
  double time_s = 0.0;              ///< Counted.
  double energy_J = 0.0;            ///< All axes at the supply, settling included.
  double lowest_supply_V = 1e9;     ///< At the board.

  /// Error of the line of sight: the root of the sum of the axes' squares. @return degrees
  double error_rms_deg() const noexcept {
    double sum = 0.0;
    for (const AxisMetrics& axis : axes) sum += axis.error_rms_deg * axis.error_rms_deg;
    return std::sqrt(sum);
  }
  /// Largest error of any axis. @return degrees
  double error_peak_deg() const noexcept { return largest(&AxisMetrics::error_peak_deg); }
  /// Blur, combined as the error is. @return pixels
  double blur_rms_px() const noexcept {
    double sum = 0.0;
    for (const AxisMetrics& axis : axes) sum += axis.blur_rms_px * axis.blur_rms_px;
    return std::sqrt(sum);
  }
  double peak_body_C() const noexcept { return largest(&AxisMetrics::peak_body_C); }        ///< degC
  double peak_winding_C() const noexcept { return largest(&AxisMetrics::peak_winding_C); }  ///< degC
  double over_limit_s() const noexcept {
    return largest(&AxisMetrics::over_limit_s);
  }                                                                                 ///< Of the worst axis.
  double limiting_s() const noexcept { return largest(&AxisMetrics::limiting_s); }  ///< Of the worst axis.

private:
  double largest(double AxisMetrics::*figure) const noexcept {
    return std::fmax(axes[0].*figure, std::fmax(axes[1].*figure, axes[2].*figure));
  }
};

}  // namespace thermopower::simulation
