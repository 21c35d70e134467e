// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file optics.hpp
/// What a pointing error costs in the picture, eq 2.1 to 2.3.

namespace thermopower::simulation {

/// A camera and what it looks at.
///
/// @snippet simulation_examples.cpp optics
/// How to: @ref rig.
struct Optics {
  double distance_m;  ///< D, to the target.
  double pixel_m;     ///< p_x, size of a pixel.
  double focal_m;     ///< f, focal length.
  double exposure_s;  ///< t.

  /// A line-scan camera as in the thesis: 5.5 um pixels, 16 mm lens, 5 ms, 50 m above ground.
  static Optics line_scan() noexcept { return {50.0, 5.5e-6, 0.016, 0.005}; }

  /// Ground sampling distance, eq 2.1. @return m
  double sampling_m() const noexcept { return distance_m * pixel_m / focal_m; }
  /// Blur of a target that moves, eq 2.2. @param velocity_mps  across the line of sight  @return pixels
  double blur_px(double velocity_mps) const noexcept { return velocity_mps * exposure_s / sampling_m(); }
  /// Velocity that blurs by half a pixel, eq 2.3. @return m/s
  double sharp_mps() const noexcept { return sampling_m() / (2.0 * exposure_s); }
  /// Blur of a camera that turns: the target sweeps by at D times the rate. @return pixels
  double blur_of_rate_px(double rate_deg_per_s) const noexcept {
    return blur_px(distance_m * rate_deg_per_s * (3.14159265358979324 / 180.0));
  }
};

}  // namespace thermopower::simulation
