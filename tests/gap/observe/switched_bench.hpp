// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <cmath>
#include <random>
#include <string>

namespace test {

/// A motor whose power is switched when it pleases, in steps of 0.05 s, and the ways in which it is logged. Its winding may
/// be a body of its own, which its simulation does not know.
class SwitchedBench {
public:
  enum class Log {
    at_rows,    ///< switched when a row is written, and held until the next
    anytime,    ///< a row says what the power is at its instant
    afterwards  ///< a row says what the power was since the row before it
  };

  double rows_s = 1.0;       ///< between rows
  Log log = Log::anytime;    ///< how power and rows go together
  bool has_winding = false;  ///< apart from the housing
  double noise_C = 0.1;      ///< of the thermometer
  double read_late = 0.0;    ///< part of an interval after which the thermometer is read

  static thermopower::gap::Model model() {
    thermopower::gap::Model model;
    model.name = "switched motor";
    model.supply = thermopower::gap::SupplyModel{13.0};
    model.current = thermopower::gap::OhmicCurrentModel{8.2, 0.00393, 25.0};
    model.thermal = thermopower::gap::LumpedThermalModel{60.0, 0.11};
    return model;
  }

  thermopower::gap::Recording recording(double lasts_s, unsigned seed) const {
    constexpr double step_s = 0.05;
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> holds_s(40.0, 200.0), level(0.0, 255.0);
    std::normal_distribution<double> normal;
    const auto rows = static_cast<Eigen::Index>(lasts_s / rows_s);
    const int steps = static_cast<int>(std::lround(rows_s / step_s));
    thermopower::gap::Recording r;
    r.name = "switched";
    r.t_s.resize(rows);
    Eigen::VectorXd power(rows), ambient(rows), current(rows), motor(rows);
    double winding_C = 22.0, housing_C = 22.0, now = level(random), until_s = holds_s(random), switched = now;
    for (Eigen::Index k = 0; k < rows; ++k) {
      const double at_s = rows_s * static_cast<double>(k), before = now;
      if (log == Log::at_rows) now = switched;
      const double amps = 13.0 * std::sqrt(now / 255.0) / ohm(winding_C);
      r.t_s[k] = at_s;
      power[k] = log == Log::afterwards ? before : now;
      ambient[k] = 22.0 + 0.02 * normal(random);
      current[k] = amps + 0.005 * normal(random);
      if (log == Log::afterwards) now = switched;
      for (int i = 0; i < steps; ++i) {
        if (at_s + i * step_s >= until_s) {
          switched = random() % 3 == 0 ? 0.0 : level(random);
          until_s += holds_s(random);
        }
        if (log == Log::anytime) now = switched;
        if (i == static_cast<int>(std::lround(read_late * steps)))
          motor[k] = winding_C + noise_C * normal(random);
        const double flows_A = 13.0 * std::sqrt(now / 255.0) / ohm(winding_C);
        const double heat_W = flows_A * flows_A * ohm(winding_C);
        if (has_winding) {
          const double across_W = 0.45 * (winding_C - housing_C);
          winding_C += step_s * (heat_W - across_W) / 18.0;
          housing_C += step_s * (across_W - 0.11 * (housing_C - 22.0)) / 42.0;
        } else {
          winding_C += step_s * (heat_W - 0.11 * (winding_C - 22.0)) / 60.0;
        }
      }
    }
    r.set("power_param", power);
    r.set("ambient_C", ambient);
    if (log != Log::afterwards) r.set("current_A", current);
    r.set("motor_C", motor);
    return r;
  }

private:
  static double ohm(double winding_C) { return 8.2 * (1.0 + 0.00393 * (winding_C - 25.0)); }
};

}  // namespace test
