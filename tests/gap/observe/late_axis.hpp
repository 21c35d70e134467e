// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "../plants.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace test {

/// An axis that a loop sets a new command of at each row and that obeys late, in steps of 0.05 ms.
struct LateAxis {
  double row_s = 0.02;            ///< from command to command, each of which is logged
  double delay_s = 0.0;           ///< of the drive
  double lag_s = 0.0;             ///< time constant of the drive, from rest on
  double coulomb_Nm = 0.0;        ///< of dry friction
  bool commanded_before = false;  ///< the first command is in force before the first row, else none
  bool with_rate = true;          ///< whether the rate is logged
  bool smooth = false;            ///< the command is a sum of slow sines, else it jumps

  /// The simulation of it, whose drive is not late, 2 % off.
  static thermopower::gap::Model model() {
    thermopower::gap::Model model = axis_model();
    model.axis->inertia_kgm2 = 2e-3 * 1.02;
    model.axis->viscous_Nms_per_rad = 1.5e-3;
    model.axis->torque_constant_Nm_per_A = 0.09;
    return model;
  }

  /// 40 s of it.
  thermopower::gap::Recording recording(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Noise noise(seed + 100);
    constexpr double fine_s = 5e-5, deg = 57.29577951308232;
    const int rows = static_cast<int>(40.0 / row_s) + 1, each = static_cast<int>(std::lround(row_s / fine_s)),
              late = static_cast<int>(std::lround(delay_s / fine_s));
    thermopower::gap::Recording r;
    r.name = "late";
    r.t_s.resize(rows);
    Eigen::VectorXd drive(rows), angle(rows), rate(rows);
    double target = 0.0, target_until_s = 0.0, dither = 0.0, dither_until_s = 0.0;
    double rad = 0.0, radps = 0.0, amps = 0.0;
    for (int row = 0; row < rows; ++row) {
      const double now_s = row_s * row;
      if (now_s >= target_until_s) {
        target = row == 0 ? 0.4 : 1.2 * uniform(random) - 0.6;
        target_until_s = now_s + 0.3 + 0.9 * uniform(random);
      }
      if (now_s >= dither_until_s) {
        dither = 0.2 * uniform(random) - 0.1;
        dither_until_s = now_s + 0.04 + 0.26 * uniform(random);
      }
      drive[row] = smooth ? 0.2 * std::sin(2.6 * now_s + static_cast<double>(seed)) +
                                0.1 * std::sin(6.2 * now_s + 1.0) + 0.05 * std::sin(10.6 * now_s + 2.0)
                          : std::clamp(0.8 * (target - rad) - 0.05 * radps + dither, -0.8, 0.8);
      if (smooth) drive[row] = 1e-5 * std::round(1e5 * drive[row]);  // as a log has it
      r.t_s[row] = now_s;
      angle[row] = rad * deg + 0.02 * noise();
      rate[row] = radps * deg + 0.15 * noise();
      for (int k = 0; k < each; ++k) {
        const int at = row * each + k - late;
        const double asked = at >= 0 ? drive[at / each] : commanded_before ? drive[0] : 0.0;
        amps += lag_s > 0.0 ? fine_s / lag_s * (asked - amps) : asked - amps;
        const double next = radps + fine_s * (0.09 * amps - 1.5e-3 * radps) / 2e-3,
                     brake = fine_s * coulomb_Nm / 2e-3;
        const double braked = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
        rad += 0.5 * fine_s * (radps + braked);
        radps = braked;
      }
    }
    r.set("drive_A", drive);
    r.set("angle_deg", angle);
    if (with_rate) r.set("rate_dps", rate);
    return r;
  }
};

}  // namespace test
