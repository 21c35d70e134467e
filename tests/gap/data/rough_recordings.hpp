// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <cmath>
#include <functional>
#include <random>
#include <string>

/// Recordings that the simulation does not follow whatever their units, stepped apart from the library's equations, and what puts
/// their columns in other units.
namespace test {

using thermopower::gap::Model;
using thermopower::gap::Recording;

constexpr double deg = 57.29577951308232;  ///< a radian

/// An axis with dry friction, of the constants of rubbing_model(), as it is recorded.
struct RubbingAxis {
  unsigned seed = 1;
  double drive = 1.0;  ///< times the usual one
  double friction_Nm = 0.03;
  int rows = 3000;
  double step_s = 5e-3;
  bool voltage = false;  ///< it is driven by one, through 2 ohm
};

inline Model rubbing_model(bool voltage = false) {
  Model model;
  model.axis = thermopower::gap::RigidAxisModel{2e-3, 1e-3, 0.1};
  if (voltage) model.axis->resistance_ohm = 2.0;
  return model;
}

inline Recording recorded(const RubbingAxis& run) {
  constexpr int parts = 50;
  const int rows = run.rows;
  const double h = run.step_s / parts;
  std::mt19937 numbers(run.seed);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> phase(0.0, 6.28);
  const double a = phase(numbers), b = phase(numbers), c = phase(numbers);
  Recording r;
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows);
  double theta = 0.0, omega = 0.0;
  for (int i = 0; i < rows; ++i) {
    const double t = r.t_s[i] = run.step_s * i;
    drive[i] = run.drive *
               (0.3 * std::sin(2.0 * t + a) + 0.2 * std::sin(5.3 * t + b) + 0.1 * std::sin(13.7 * t + c));
    angle[i] = theta * deg + 0.02 * noise(numbers);
    rate[i] = omega * deg + 0.15 * noise(numbers);
    for (int k = 0; k < parts; ++k) {
      const double friction = run.friction_Nm * std::tanh(omega / 0.01);
      const double ampere = run.voltage ? (2.0 * drive[i] - 0.1 * omega) / 2.0 : drive[i];
      omega += h * (0.1 * ampere - 1e-3 * omega - friction) / 2e-3;
      theta += h * omega;
    }
  }
  if (run.voltage) r.set("voltage_V", 2.0 * drive);
  else r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  return r;
}

/// A motor of the constants of cased_model(), but with a winding of a quarter of its heat capacity in a case, every 2 s.
struct CasedMotor {
  unsigned seed = 1;
  double air_C = 22.0;
  double start_C = 23.0;
  double supply_V = 12.0;
  int rows = 1500;
};

inline Model cased_model() {
  Model model;
  model.supply = thermopower::gap::SupplyModel{12.0};
  model.current = thermopower::gap::OhmicCurrentModel{10.0, 0.00393, 25.0};
  model.thermal = thermopower::gap::LumpedThermalModel{80.0, 0.15};
  return model;
}

inline Recording recorded(const CasedMotor& run) {
  constexpr int parts = 20;
  const int rows = run.rows;
  constexpr double step_s = 2.0, h = step_s / parts;
  std::mt19937 numbers(run.seed);
  std::normal_distribution<double> noise;
  std::uniform_int_distribution<int> level(0, 250), length(20, 120);
  Recording r;
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), air(rows), supply(rows);
  double winding = run.start_C, housing = run.start_C;
  int left = 0, now = 0;
  for (int i = 0; i < rows; ++i) {
    if (left-- == 0) now = level(numbers) < 60 ? 0 : level(numbers), left = length(numbers);
    r.t_s[i] = step_s * i;
    power[i] = now;
    const auto ohm = [&] { return 10.0 * (1.0 + 0.00393 * (winding - 25.0)); };
    const double volts = run.supply_V * std::sqrt(now / 255.0);
    current[i] = volts / ohm() + 0.003 * noise(numbers);
    motor[i] = std::round(10.0 * (winding + 0.1 * noise(numbers))) / 10.0;
    air[i] = run.air_C + 0.05 * noise(numbers);
    supply[i] = run.supply_V + 0.01 * noise(numbers);
    for (int k = 0; k < parts; ++k) {
      const double inward_W = 0.5 * (winding - housing);
      winding += h * (volts * volts / ohm() - inward_W) / 20.0;
      housing += h * (inward_W - 0.15 * (housing - run.air_C)) / 60.0;
    }
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", air);
  r.set("supply_V", supply);
  return r;
}

inline void change(Recording& r, const std::string& column, const std::function<double(double)>& f) {
  if (column == "t_s") {
    for (double& value : r.t_s) value = f(value);
    return;
  }
  Eigen::VectorXd values = r.column(column);
  for (double& value : values) value = f(value);
  r.set(column, values);
}

inline std::function<double(double)> times(double factor) {
  return [factor](double x) { return factor * x; };
}
inline double fahrenheit(double x) { return 1.8 * x + 32.0; }
inline double kelvin(double x) { return x + 273.15; }

}  // namespace test
