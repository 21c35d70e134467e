// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace test {

/// Whether a simulation holds up to its constants: it passes as configured, or with constants within what is known of them.
inline bool holds(const thermopower::gap::Diagnosis& diagnosis) {
  return diagnosis.verdict == thermopower::gap::Verdict::no_gap ||
         diagnosis.why == thermopower::gap::Reason::constants_within_known;
}

/// The constants that moved by more than is known of them.
inline std::vector<thermopower::gap::ConstantEstimate> moved(const thermopower::gap::Diagnosis& diagnosis) {
  std::vector<thermopower::gap::ConstantEstimate> list;
  for (const auto& one : diagnosis.constants)
    if (!one.within_known) list.push_back(one);
  return list;
}

/// Reproducible noise that needs no library: a linear congruential generator, twelve uniforms to a normal
/// number.
class Noise {
public:
  explicit Noise(std::uint64_t seed) : state_(seed * 2862933555777941757ull + 3037000493ull) {}
  double operator()() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) {
      state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
      sum += static_cast<double>(state_ >> 11) * 0x1.0p-53;
    }
    return sum;
  }

private:
  std::uint64_t state_;
};

/// What a diagnosis made of a parameter of the causes it names; NaN where none of them has it.
inline double parameter_of(const thermopower::gap::Diagnosis& diagnosis, const std::string& name) {
  for (const thermopower::gap::Cause& cause : diagnosis.cause)
    for (const thermopower::gap::ParameterEstimate& one : cause.parameters)
      if (one.name == name) return one.value;
  return std::numeric_limits<double>::quiet_NaN();
}

/// The effects that a diagnosis names, in its order.
inline std::vector<std::string> causes_in_order(const thermopower::gap::Diagnosis& diagnosis) {
  std::vector<std::string> ids;
  for (const thermopower::gap::Cause& cause : diagnosis.cause) ids.push_back(cause.effect);
  return ids;
}

/// The same in alphabetical order.
inline std::vector<std::string> causes_of(const thermopower::gap::Diagnosis& diagnosis) {
  std::vector<std::string> ids = causes_in_order(diagnosis);
  std::sort(ids.begin(), ids.end());
  return ids;
}

inline thermopower::gap::Model bench_model() {
  thermopower::gap::Model model;
  model.name = "bench motor";
  model.supply = thermopower::gap::SupplyModel{12.0};
  model.current = thermopower::gap::OhmicCurrentModel{8.0, 0.00393, 25.0};
  model.thermal = thermopower::gap::LumpedThermalModel{60.0, 0.15};
  return model;
}

inline thermopower::gap::Model axis_model() {
  thermopower::gap::Model model;
  model.name = "bench axis";
  model.axis = thermopower::gap::RigidAxisModel{1e-3, 1e-3, 0.2};
  return model;
}

/// What is wrong with a motor on a bench; everything off by default.
struct BenchFault {
  double extra_loss_W_per_K2 = 0.0;  ///< loss that grows with the square of the rise
  double sensor_offset_A = 0.0;
  double sensor_gain = 1.0;
  double series_ohm = 0.0;
  double lag_s = 0.0;
  double motor_scale = 1.0;  ///< of C and G: a small error of the baseline
};

/// A motor under power steps, integrated at a fiftieth of the log's interval.
inline thermopower::gap::Recording bench_recording(const BenchFault& fault, int rows, std::uint64_t seed) {
  Noise noise(seed);
  thermopower::gap::Recording r;
  r.name = "bench";
  r.t_s.resize(rows);
  Eigen::VectorXd power(rows), current(rows), motor(rows), ambient(rows), supply(rows);
  const double capacity = 60.0 * fault.motor_scale, conductance = 0.15 * fault.motor_scale;
  double winding = 24.0, sensor = 24.0, level = 200.0;
  for (int i = 0; i < rows; ++i) {
    if (i % 75 == 0) level = 25.0 * std::floor(5.2 + 5.0 * std::sin(1.7 * i + static_cast<double>(seed)));
    if ((i / 75) % 4 == 3) level = 0.0;
    r.t_s[i] = 2.0 * i;
    power[i] = level;
    supply[i] = 12.0;
    const double v = 12.0 * std::sqrt(level / 255.0);
    const auto amps = [&] { return v / (8.0 * (1.0 + 0.00393 * (winding - 25.0)) + fault.series_ohm); };
    current[i] = fault.sensor_gain * amps() + fault.sensor_offset_A + 0.003 * noise();
    motor[i] = std::round(10.0 * ((fault.lag_s > 0.0 ? sensor : winding) + 0.1 * noise())) / 10.0;
    ambient[i] = 23.0;
    for (int k = 0; k < 50; ++k) {
      const double heat = amps() * amps() * 8.0 * (1.0 + 0.00393 * (winding - 25.0)), rise = winding - 23.0;
      const double h = 0.04;
      winding +=
          h * (heat - conductance * rise - fault.extra_loss_W_per_K2 * rise * std::fabs(rise)) / capacity;
      if (fault.lag_s > 0.0) sensor += h * (winding - sensor) / fault.lag_s;
    }
  }
  r.set("power_param", power);
  r.set("current_A", current);
  r.set("motor_C", motor);
  r.set("ambient_C", ambient);
  r.set("supply_V", supply);
  return r;
}

/// What is wrong with an axis.
struct AxisFault {
  double coulomb_Nm = 0.0;
  double run_out_share = 0.0;  ///< of that friction, with the sine of the angle: a bent shaft
  double spring_Nm_per_rad = 0.0;
  double angle_gain = 1.0;
  int delay_rows = 0;
  double ripple_share = 0.0;    ///< of the torque, six times a turn
  double thinning_per_K = 0.0;  ///< of viscous friction with the motor's temperature, which is recorded then
  double weight_Nm = 0.0;       ///< of a load off the axis
  double soft_within_rad_per_s = 0.0;  ///< of the friction; 0: it sticks
  double drag_Nms2 = 0.0;              ///< of the air, with the square of the rate
};

/// An axis driven by a sum of sines.
inline thermopower::gap::Recording axis_recording(const AxisFault& fault, int rows, std::uint64_t seed) {
  Noise noise(seed);
  thermopower::gap::Recording r;
  r.name = "axis";
  r.t_s.resize(rows);
  Eigen::VectorXd drive(rows), angle(rows), rate(rows), motor_C(rows);
  for (int i = 0; i < rows; ++i) {
    const double t = 0.01 * i + static_cast<double>(seed);
    r.t_s[i] = 0.01 * i;
    motor_C[i] = 50.0 - 25.0 * std::cos(0.2 * t);
    drive[i] = 0.1 * std::sin(2.1 * t) + 0.08 * std::sin(5.3 * t + 1.0) + 0.05 * std::sin(11.0 * t) +
               0.03 * std::sin(0.7 * t);
  }
  double theta = 0.0, omega = 0.0;
  for (int i = 0; i < rows; ++i) {
    angle[i] = fault.angle_gain * theta * 57.29577951308232 + 0.02 * noise();
    rate[i] = omega * 57.29577951308232 + 0.15 * noise();
    const double torque = 0.2 * drive[std::max(0, i - fault.delay_rows)];
    for (int k = 0; k < 200; ++k) {
      const double h = 5e-5;
      const double thin = std::exp(-fault.thinning_per_K * (motor_C[i] - 25.0));
      const double push = torque * (1.0 + fault.ripple_share * std::sin(6.0 * theta)) - 1e-3 * thin * omega -
                          fault.spring_Nm_per_rad * theta - fault.weight_Nm * std::sin(theta + 0.4) -
                          fault.drag_Nms2 * omega * std::fabs(omega);
      const double next = omega + h * push / 1e-3;
      const double brake = h * fault.coulomb_Nm * (1.0 + fault.run_out_share * std::sin(theta)) / 1e-3;
      if (fault.soft_within_rad_per_s > 0.0)
        omega = next - brake * std::fmax(-1.0, std::fmin(1.0, omega / fault.soft_within_rad_per_s));
      else omega = next > brake ? next - brake : next < -brake ? next + brake : 0.0;
      theta += h * omega;
    }
  }
  r.set("drive_A", drive);
  r.set("angle_deg", angle);
  r.set("rate_dps", rate);
  if (fault.thinning_per_K > 0.0) r.set("motor_C", motor_C);
  return r;
}

}  // namespace test
