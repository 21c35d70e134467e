// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace gap_benchmark {

/// Every number the motor on the bench can have; an effect is off at the value in `bench_defaults()`.
/// Plain indices, so that a fit can move any of them.
enum BenchParameter : int {
  // what the simulation under test knows
  resistance_ohm,
  tempco_per_K,
  reference_C,
  heat_capacity,
  conductance,
  // the thesis's law, in its own units
  thesis_law,
  slope_V2,
  slope_V1,
  slope_V0,
  base_mA,
  exponent,
  cooling_per_min,
  rinv_slope_V1,
  rinv_slope_V0,
  rinv_offset_V1,
  rinv_offset_V0,
  // electrical effects
  series_ohm,
  internal_ohm,
  volt_per_Ah,
  dead_duty,
  emf_V_per_dps,
  current_offset_A,
  current_gain,
  current_curve_per_A,
  // thermal effects
  winding_share,
  coupling_W_per_K,
  radiation_W_per_K4,
  convection_exponent,
  convection_reference_K,
  airflow_gain,
  airflow_exponent,
  air_bias_K,
  neighbour_W_per_K,
  motion_W_per_dps2,
  idle_W,  ///< of the electronics, at all times
  sensor_lag_s,
  sensor_gain,
  supply_heating,
  box_J_per_K,
  box_W_per_K,
  sink_J_per_K,
  sink_W_per_K,
  contact_K_per_W,
  hysteresis_W_per_dps,
  eddy_W_per_dps2,
  // what nobody measures at the start of a run
  housing_start_K,
  winding_start_K,
  box_start_K,
  sink_start_K,
  // effects that have no name in the catalogue
  fan_gain,
  fan_on_C,
  fan_off_C,
  latent_J,
  melting_C,
  melting_width_K,
  short_share,
  short_C,
  soak_W_per_K,
  soak_J_per_K,
  bench_parameter_count
};

using BenchParameters = std::array<double, bench_parameter_count>;

inline BenchParameters bench_defaults() {
  BenchParameters p{};
  p[tempco_per_K] = 0.00393;
  p[reference_C] = 25.0;
  p[current_gain] = p[winding_share] = p[convection_reference_K] = p[airflow_exponent] = p[sensor_gain] = 1.0;
  p[melting_width_K] = 0.4;
  return p;
}

/// What holds over one interval of the log. The hidden ones are disturbances that no column shows.
struct BenchInput {
  double power_param = 0.0, supply_V = 12.0, ambient_C = 20.0, airspeed_mps = 0.0, neighbour_C = 20.0,
         rate_dps = 0.0;
  double measured_current_A = -1.0;  ///< when not negative: the heating is computed from it
  double hidden_W = 0.0, hidden_ohm = 0.0, hidden_loss = 1.0;
};

struct BenchState {
  double winding_C = 20.0, housing_C = 20.0, sensor_C = 20.0, soak_C = 20.0, charge_Ah = 0.0;
  double box_C = 20.0;   ///< air around the motor, where that stands in a box
  double sink_C = 20.0;  ///< what the motor is bolted to
  bool fan = false;
};

/// A motor under power on a bench, as physics and not as a list of corrections: winding, housing,
/// thermometer, battery. Integrated by classical Runge-Kutta at a small fraction of the fastest time
/// constant; the moment a thermostat switches is found by bisection.
class BenchPlant {
public:
  explicit BenchPlant(const BenchParameters& parameters, double step_scale = 1.0) : p_(parameters) {
    double fastest_s = p_[thesis_law] > 0.0 ? 60.0 / std::max(p_[cooling_per_min], 1e-3)
                                            : p_[heat_capacity] / std::max(p_[conductance], 1e-9);
    if (two_nodes())
      fastest_s = std::min(fastest_s, p_[winding_share] * p_[heat_capacity] / p_[coupling_W_per_K]);
    if (p_[sensor_lag_s] > 0.0) fastest_s = std::min(fastest_s, p_[sensor_lag_s]);
    if (p_[soak_J_per_K] > 0.0) fastest_s = std::min(fastest_s, p_[soak_J_per_K] / p_[soak_W_per_K]);
    if (p_[box_J_per_K] > 0.0)
      fastest_s = std::min(fastest_s, p_[box_J_per_K] / (p_[box_W_per_K] + 2.0 * p_[conductance]));
    if (p_[sink_J_per_K] > 0.0) {
      const double per_contact = 1.0 / p_[contact_K_per_W];
      fastest_s = std::min(fastest_s, p_[sink_J_per_K] / (per_contact + p_[sink_W_per_K]));
      fastest_s = std::min(fastest_s, p_[heat_capacity] / (per_contact + p_[conductance]));
    }
    step_s_ = std::min(0.5, fastest_s / 12.0);
    if (p_[latent_J] > 0.0 || p_[short_share] > 0.0) step_s_ = std::min(step_s_, 0.1);
    step_s_ *= step_scale;
  }

  bool two_nodes() const { return p_[coupling_W_per_K] > 0.0; }

  double resistance(double winding_C) const {
    double r = p_[resistance_ohm] * (1.0 + p_[tempco_per_K] * (winding_C - p_[reference_C]));
    if (p_[short_share] > 0.0)
      r *= 1.0 - p_[short_share] / (1.0 + std::exp(-(winding_C - p_[short_C]) / 0.7));
    return r;
  }

  /// RMS current through the winding. The bus capacitor sees the mean of the pulses, duty times the pulse
  /// current, so that is what sags the supply and empties the battery.
  double current(const BenchInput& u, const BenchState& x) const {
    const double duty = std::max(0.0, std::min(1.0, u.power_param / 255.0) - p_[dead_duty]);
    if (duty <= 0.0) return 0.0;
    const double root = std::sqrt(duty);
    const double open_V = u.supply_V - p_[volt_per_Ah] * x.charge_Ah;
    if (p_[thesis_law] > 0.0) {
      const double v = open_V * root;
      if (v <= 1.0) return 0.0;
      const double slope = (p_[slope_V2] * v + p_[slope_V1]) * v + p_[slope_V0];
      return std::max(0.0, slope * x.winding_C + p_[base_mA] * std::pow(v, p_[exponent])) * 1e-3;
    }
    const double total_ohm =
        resistance(x.winding_C) + p_[series_ohm] + u.hidden_ohm + p_[internal_ohm] * duty;
    return std::max(0.0, open_V * root - p_[emf_V_per_dps] * std::fabs(u.rate_dps)) / total_ohm;
  }

  double sensed_current(const BenchInput& u, const BenchState& x) const {
    const double true_A = current(u, x);
    return (p_[current_gain] + p_[current_curve_per_A] * true_A) * true_A + p_[current_offset_A];
  }

  double sensed_temperature(const BenchInput& u, const BenchState& x) const {
    const double seen = p_[sensor_lag_s] > 0.0 ? x.sensor_C : x.winding_C;
    return u.ambient_C + p_[sensor_gain] * (seen - u.ambient_C);
  }

  /// The state a replay starts from when the thermometer says `measured_C`.
  BenchState start(const BenchInput& u, double measured_C) const {
    BenchState x;
    x.sensor_C = u.ambient_C + (measured_C - u.ambient_C) / p_[sensor_gain];
    x.winding_C = x.sensor_C + (p_[sensor_lag_s] > 0.0 ? p_[winding_start_K] : 0.0);
    x.housing_C = x.winding_C + (two_nodes() ? p_[housing_start_K] : 0.0);
    x.soak_C = x.winding_C;
    x.box_C = u.ambient_C + p_[air_bias_K] + p_[box_start_K];
    x.sink_C = x.housing_C + p_[sink_start_K];
    return x;
  }

  /// Carries the state over one interval in which all inputs are held.
  void advance(BenchState& x, const BenchInput& u, double duration_s) const {
    const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / step_s_)));
    for (int i = 0; i < steps; ++i) {
      double left_s = duration_s / steps;
      for (int switches = 0; switches < 4 && left_s > 0.0; ++switches) {
        const BenchState before = x;
        x = stepped(before, u, left_s);
        if (!thermostat_due(x)) break;
        double low = 0.0, high = left_s;
        for (int k = 0; k < 30; ++k) {
          const double middle = 0.5 * (low + high);
          (thermostat_due(stepped(before, u, middle)) ? high : low) = middle;
        }
        x = stepped(before, u, high);
        x.fan = !x.fan;
        left_s -= high;
      }
    }
  }

  /// Heat into the winding, W.
  double heating(const BenchInput& u, const BenchState& x) const {
    const double i = u.measured_current_A >= 0.0 ? u.measured_current_A : current(u, x);
    if (p_[thesis_law] <= 0.0) return i * i * resistance(x.winding_C);
    const double root = std::sqrt(std::min(1.0, u.power_param / 255.0));
    return i * u.supply_V * (root + p_[supply_heating] * (1.0 - root));
  }

  /// The air around the motor.
  double air_around(const BenchInput& u, const BenchState& x) const {
    return p_[box_J_per_K] > 0.0 ? x.box_C : u.ambient_C + p_[air_bias_K];
  }

  /// Heat from the outermost node to everything around, W.
  double loss(const BenchInput& u, double outer_C, bool fan, double base_W_per_K, double air_C) const {
    const double rise = outer_C - air_C;
    double g = base_W_per_K * u.hidden_loss;
    if (p_[convection_exponent] > 0.0)
      g *= std::pow(std::hypot(rise, 0.05) / p_[convection_reference_K], p_[convection_exponent]);
    if (p_[airflow_gain] > 0.0 && u.airspeed_mps > 0.0)
      g *= 1.0 + p_[airflow_gain] * std::pow(u.airspeed_mps, p_[airflow_exponent]);
    if (fan) g *= 1.0 + p_[fan_gain];
    double watts = g * rise + p_[neighbour_W_per_K] * (outer_C - u.neighbour_C);
    if (p_[radiation_W_per_K4] > 0.0) {
      const double hot = outer_C + 273.15, cold = air_C + 273.15;
      watts += p_[radiation_W_per_K4] * (hot * hot + cold * cold) * (hot + cold) * rise;
    }
    return watts;
  }

private:
  BenchParameters p_;
  double step_s_ = 0.5;

  bool thermostat_due(const BenchState& x) const {
    if (p_[fan_gain] <= 0.0) return false;
    return x.fan ? x.winding_C < p_[fan_off_C] : x.winding_C > p_[fan_on_C];
  }

  using Rates = std::array<double, 7>;

  Rates rates(const BenchState& x, const BenchInput& u) const {
    double capacity = p_[heat_capacity], base = p_[conductance];
    if (p_[thesis_law] > 0.0) {
      const double v = u.supply_V * std::sqrt(std::min(1.0, u.power_param / 255.0));
      const double rinv = (p_[rinv_slope_V1] * v + p_[rinv_slope_V0]) * x.winding_C + p_[rinv_offset_V1] * v +
                          p_[rinv_offset_V0];
      // Below 1 V nothing heats, and only the ratio of loss to capacity matters.
      capacity = v > 1.0 ? 60.0 * std::max(rinv, 0.02) : 60.0 * 0.2;
      base = capacity * p_[cooling_per_min] / 60.0;
    }
    Rates d{};
    const double heat_W = heating(u, x),
                 outside_W = p_[motion_W_per_dps2] * u.rate_dps * u.rate_dps + p_[idle_W] + u.hidden_W;
    const double speed_dps = std::fabs(u.rate_dps);
    const double iron_W = (p_[hysteresis_W_per_dps] + p_[eddy_W_per_dps2] * speed_dps) * speed_dps;
    const double outer_C = two_nodes() ? x.housing_C : x.winding_C;
    const double sunk_W = p_[sink_J_per_K] > 0.0 ? (outer_C - x.sink_C) / p_[contact_K_per_W] : 0.0;
    const double air_C = air_around(u, x), lost_W = loss(u, outer_C, x.fan, base, air_C);
    const double soak_W = p_[soak_J_per_K] > 0.0 ? p_[soak_W_per_K] * (x.winding_C - x.soak_C) : 0.0;
    if (two_nodes()) {
      const double across = p_[coupling_W_per_K] * (x.winding_C - x.housing_C);
      d[0] = (heat_W + outside_W - across - soak_W) / (p_[winding_share] * capacity);
      d[1] = (across + iron_W - lost_W - sunk_W) / ((1.0 - p_[winding_share]) * capacity);
    } else {
      if (p_[latent_J] > 0.0) {
        const double z = (x.winding_C - p_[melting_C]) / p_[melting_width_K];
        capacity += p_[latent_J] * std::exp(-0.5 * z * z) / (p_[melting_width_K] * 2.5066282746310002);
      }
      d[0] = (heat_W + outside_W + iron_W - soak_W - lost_W - sunk_W) / capacity;
    }
    if (p_[sensor_lag_s] > 0.0) d[2] = (x.winding_C - x.sensor_C) / p_[sensor_lag_s];
    if (p_[soak_J_per_K] > 0.0) d[3] = soak_W / p_[soak_J_per_K];
    if (p_[box_J_per_K] > 0.0)
      d[5] = (lost_W - p_[box_W_per_K] * (x.box_C - u.ambient_C - p_[air_bias_K])) / p_[box_J_per_K];
    if (p_[sink_J_per_K] > 0.0)
      d[6] = (sunk_W - p_[sink_W_per_K] * (x.sink_C - u.ambient_C - p_[air_bias_K])) / p_[sink_J_per_K];
    if (p_[internal_ohm] > 0.0 || p_[volt_per_Ah] > 0.0)
      d[4] = current(u, x) * std::sqrt(std::max(0.0, u.power_param / 255.0 - p_[dead_duty])) / 3600.0;
    return d;
  }

  static BenchState moved(const BenchState& x, const Rates& d, double h) {
    BenchState y = x;
    y.winding_C += h * d[0];
    y.housing_C += h * d[1];
    y.sensor_C += h * d[2];
    y.soak_C += h * d[3];
    y.charge_Ah += h * d[4];
    y.box_C += h * d[5];
    y.sink_C += h * d[6];
    return y;
  }

  BenchState stepped(const BenchState& x, const BenchInput& u, double h) const {
    const Rates a = rates(x, u), b = rates(moved(x, a, 0.5 * h), u), c = rates(moved(x, b, 0.5 * h), u),
                d = rates(moved(x, c, h), u);
    Rates mean;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (a[i] + 2.0 * (b[i] + c[i]) + d[i]) / 6.0;
    return moved(x, mean, h);
  }
};

/// Everything that goes into a replay: rows of inputs, where the runs begin, and what was measured there.
struct BenchDrive {
  std::vector<double> t_s;
  std::vector<BenchInput> input;
  std::vector<std::size_t> run_start;  ///< first row of each run
  std::vector<double> start_C;         ///< measured temperature at each of them
};

struct BenchOutput {
  std::vector<double> current_A, motor_C;
};

/// Free-running replay of whole runs from their first measured temperature.
inline BenchOutput replay(const BenchParameters& parameters, const BenchDrive& drive,
                          double step_scale = 1.0) {
  const BenchPlant plant(parameters, step_scale);
  BenchOutput out;
  out.current_A.reserve(drive.t_s.size());
  out.motor_C.reserve(drive.t_s.size());
  BenchState x;
  std::size_t run = 0;
  for (std::size_t k = 0; k < drive.t_s.size(); ++k) {
    const bool starts = run < drive.run_start.size() && drive.run_start[run] == k;
    if (starts) x = plant.start(drive.input[k], drive.start_C[run++]);
    else plant.advance(x, drive.input[k - 1], drive.t_s[k] - drive.t_s[k - 1]);
    out.current_A.push_back(plant.sensed_current(drive.input[k], x));
    out.motor_C.push_back(plant.sensed_temperature(drive.input[k], x));
  }
  return out;
}

}  // namespace gap_benchmark
