// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/localise/axis.hpp>
#include <thermopower/gap/localise/current.hpp>
#include <thermopower/gap/localise/thermal.hpp>

/// @file quantity.hpp
/// The missing quantity itself: watts, newton metres, volts, read off the recording and ordered by what
/// orders them.

namespace thermopower::gap::detail {

/// Something that may order a missing quantity, one value per sample of it.
struct OrderingAxis {
  std::string name, unit;
  Eigen::VectorXd values;
};

/// Samples of a missing quantity, and everything recorded that may order them.
struct Observed {
  plant::SignalName signal;
  plant::QuantityName quantity;
  std::string unit;
  Eigen::VectorXd value;
  std::vector<OrderingAxis> axes;
  double interval_s = 1.0;  ///< between samples
  double noise = 0.0;       ///< standard deviation that the sensor alone gives `value`; 0 where unknown

  const OrderingAxis* find(const std::string& name) const {
    for (const OrderingAxis& axis : axes) {
      if (axis.name == name) return &axis;
    }
    return nullptr;
  }
};

inline std::string unit_of_column(const std::string& name) {
  const auto ends = [&](const std::string& tail) {
    return name.size() > tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
  };
  if (ends("_C")) return "degC";
  if (ends("_mps")) return "m/s";
  if (ends("_dps")) return "deg/s";
  if (ends("_deg")) return "deg";
  if (ends("_pct")) return "%";
  const auto at = name.rfind('_');
  return at == std::string::npos ? "" : name.substr(at + 1);
}

/// Missing voltage: what would have to be added to V_rms for the law to give the measured current.
inline Observed observe_current(const BenchRows& b, bool as_current) {
  Observed o{Signal::current_A,
             as_current ? plant::Quantity::missing_current : plant::Quantity::missing_voltage,
             as_current ? "A" : "V",
             {},
             {},
             b.interval_s,
             0.0};
  const Thinning thin(b.runs, b.current_A, 4000);
  Eigen::VectorXd value(b.t_s.size());
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const double gap = b.current_A[i] - b.law_A[i];
    value[i] = as_current ? gap : b.v_rms_V[i] > 0.0 ? gap * b.law_ohm[i] : 0.0;
  }
  o.value = thin(value);
  o.interval_s *= static_cast<double>(thin.stride());
  o.axes = {{"v_rms_V", "V", thin(b.v_rms_V)},
            {"motor_C", "degC", thin(b.winding_C)},
            {"law_A", "A", thin(b.law_A)},
            {"t_s", "s", thin(b.t_s)}};
  for (const Column& column : b.covariates)
    o.axes.push_back({column.name, unit_of_column(column.name), thin(column.values)});
  return o;
}

/// Missing heat: C dT/dt + G (T - Ta) - P, averaged over stretches long enough that the thermometer's noise
/// is small in it.
inline Observed observe_heat(const BenchRows& b, const ThermalJudge& judge) {
  Observed o{Signal::motor_C, plant::Quantity::missing_heat, "W", {}, {}, b.interval_s, 0.0};
  AxisRows frame;  // only its times and runs are used
  frame.runs = b.runs;
  frame.t_s = b.t_s;
  frame.interval_s = b.interval_s;
  const double sigma = noise_of(b.motor_C, b.runs);
  const Eigen::VectorXd capacity = judge.capacity(), loss = judge.loss_W(), heat = judge.heat();
  int half = 4;
  while (half < 400) {
    const Bumps bumps(frame, b.motor_C, half, 4000);
    if (bumps.size() < 60) break;
    const double noise = sigma * bumps.derivative_gain() * capacity.mean();
    if (noise < 0.04 * std::sqrt(heat.squaredNorm() / static_cast<double>(heat.size()))) break;
    half *= 2;
  }
  const Bumps bumps(frame, b.motor_C, half, 4000);
  const Eigen::VectorXd slope = bumps.derivative(b.winding_C);
  o.value = bumps.integral(capacity).cwiseProduct(slope) + bumps.integral(loss) - bumps.held_integral(heat);
  o.interval_s *= half;
  o.noise = sigma * bumps.derivative_gain() * capacity.mean();
  o.axes = {{"rise_K", "K", bumps.integral(b.winding_C - b.ambient_C)},
            {"motor_C", "degC", bumps.integral(b.winding_C)},
            {"heat_W", "W", bumps.held_integral(heat)},
            {"dT_dt", "K/s", slope},
            {"v_rms_V", "V", bumps.held_integral(b.v_rms_V)},
            {"t_s", "s", bumps.integral(b.t_s)}};
  for (const Column& column : b.covariates)
    o.axes.push_back({column.name, unit_of_column(column.name), bumps.integral(column.values)});
  return o;
}

/// Whether a missing heat scatters in proportion to the rise, as a conductance of its own course would make
/// it, rather than alike at every rise: the likelier of two normal laws, after what is constant, or in
/// proportion to rise or heat, has been taken off.
inline bool scatters_with_rise(const Observed& o) {
  const Eigen::Index n = o.value.size();
  const OrderingAxis *rise = o.find("rise_K"), *heat = o.find("heat_W");
  if (n < 12 || rise == nullptr || heat == nullptr) return false;
  Eigen::MatrixXd x(n, 3);
  x << Eigen::VectorXd::Ones(n), rise->values, heat->values;
  const Eigen::VectorXd left = o.value - x * x.colPivHouseholderQr().solve(o.value);
  const double noise = o.noise * o.noise, all = left.squaredNorm() / static_cast<double>(n);
  const double scatter = std::max(all - noise, 1e-6 * all),
               typical = rise->values.squaredNorm() / static_cast<double>(n);
  double alike = 0.0, with_rise = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double one = scatter + noise,
                 other = scatter * std::max(std::pow(rise->values[i], 2.0) / typical, 1e-4) + noise;
    alike += std::log(one) + left[i] * left[i] / one;
    with_rise += std::log(other) + left[i] * left[i] / other;
  }
  return with_rise < alike;
}

/// Missing torque: J dw/dt + b w - Kt i, averaged over short stretches.
inline Observed observe_torque(const RigidAxisModel& axis, const AxisRows& a) {
  Observed o{a.has_rate ? Signal::rate_dps : Signal::angle_deg,
             plant::Quantity::missing_torque,
             "N m",
             {},
             {},
             a.interval_s,
             0.0};
  const Bumps bumps(a, a.raw_rate, 6, 4000);
  const Eigen::VectorXd acceleration = bumps.derivative(a.rate);
  const Eigen::VectorXd drive = bumps.held_integral(a.drive_A);
  o.value = axis.inertia_kgm2 * acceleration + axis.viscous_Nms_per_rad * bumps.integral(a.rate) -
            axis.torque_constant_Nm_per_A * drive;
  o.interval_s *= 6;
  Eigen::VectorXd centre(drive.size());
  for (Eigen::Index i = 0; i < drive.size(); ++i)
    centre[i] = bumps.list()[static_cast<std::size_t>(i)].middle;
  o.axes = {{"rate_dps", "deg/s", bumps.integral(a.rate) / rad_per_deg},
            {"drive_A", "A", drive},
            {"drive_A_per_s", "A/s", bumps.derivative(a.drive_A)},
            {"acceleration_rad_per_s2", "rad/s2", acceleration},
            {"t_s", "s", centre}};
  if (a.has_angle) o.axes.push_back({"angle_deg", "deg", bumps.integral(a.angle) / rad_per_deg});
  if (a.motor_C.size() > 0) o.axes.push_back({"motor_C", "degC", bumps.integral(a.motor_C)});
  for (const Column& column : a.covariates)
    o.axes.push_back({column.name, unit_of_column(column.name), bumps.integral(column.values)});
  return o;
}

/// What the angle's slope has more than the rate says.
inline Observed observe_instruments(const AxisRows& a) {
  Observed o{Signal::angle_deg, plant::Quantity::angle_slope_minus_rate, "deg/s", {}, {}, a.interval_s, 0.0};
  const Bumps bumps(a, a.raw_rate + a.raw_angle, 16, 4000);
  const Eigen::VectorXd rate = bumps.integral(a.rate);
  o.value = (bumps.derivative(a.angle) - rate) / rad_per_deg;
  o.interval_s *= 16;
  o.axes = {{"rate_dps", "deg/s", rate / rad_per_deg},
            {"angle_deg", "deg", bumps.integral(a.angle) / rad_per_deg},
            {"t_s", "s", bumps.integral(a.t_s)}};
  return o;
}

/// Means over bins that the edges part; empty bins are left out.
inline MissingQuantity binned(const Observed& o, const OrderingAxis& axis, const std::vector<double>& edges) {
  MissingQuantity q;
  q.signal = o.signal;
  q.quantity = o.quantity;
  q.unit = o.unit;
  q.variable = axis.name;
  q.variable_unit = axis.unit;
  const std::size_t bins = edges.empty() ? 0 : edges.size() - 1;
  std::vector<double> n(bins, 0.0), x(bins, 0.0), y(bins, 0.0), yy(bins, 0.0);
  for (Eigen::Index i = 0; i < o.value.size(); ++i) {
    const double at = axis.values[i], v = o.value[i];
    if (bins == 0 || !std::isfinite(at) || !std::isfinite(v) || at < edges.front() || at > edges.back())
      continue;
    const std::size_t k =
        static_cast<std::size_t>(std::upper_bound(edges.begin() + 1, edges.end() - 1, at) - edges.begin()) -
        1;
    n[k] += 1.0;
    x[k] += at;
    y[k] += v;
    yy[k] += v * v;
  }
  std::vector<double> qx, qy, qs;
  for (std::size_t k = 0; k < bins; ++k) {
    if (n[k] < 2.0) continue;
    qx.push_back(x[k] / n[k]);
    qy.push_back(y[k] / n[k]);
    qs.push_back(std::sqrt(std::max(0.0, yy[k] / n[k] - qy.back() * qy.back()) / n[k]));
  }
  const auto vector = [](const std::vector<double>& list) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  q.x = vector(qx);
  q.value = vector(qy);
  q.spread = vector(qs);
  return q;
}

/// The contiguous range of the axis in which the missing quantity is largest: around the largest bin, while
/// above half of it.
inline std::optional<Regime> regime_of(const Observed& o, const OrderingAxis& axis) {
  const std::vector<double> edges = equal_count_edges(axis.values, 10);
  const MissingQuantity q = binned(o, axis, edges);
  if (q.x.size() < 3) return std::nullopt;
  Eigen::Index top = 0;
  const double most = q.value.cwiseAbs().maxCoeff(&top);
  Eigen::Index from = top, to = top;
  while (from > 0 && q.value[from - 1] * q.value[top] > 0.0 && std::fabs(q.value[from - 1]) > 0.5 * most)
    --from;
  while (to + 1 < q.x.size() && q.value[to + 1] * q.value[top] > 0.0 &&
         std::fabs(q.value[to + 1]) > 0.5 * most)
    ++to;
  const auto below = std::upper_bound(edges.begin(), edges.end(), q.x[from]);
  const auto above = std::upper_bound(edges.begin(), edges.end(), q.x[to]);
  return Regime{axis.name, below == edges.begin() ? edges.front() : *(below - 1),
                above == edges.end() ? edges.back() : *above};
}

/// Which axis orders the quantity most, and what the best of all axes reaches by chance.
struct Ordered {
  std::string axis;
  double ratio = 0.0;   ///< correlation ratio, 0..1
  double chance = 0.0;  ///< largest over all axes when the quantity is shifted in time
};

inline Ordered strongest_axis(const Observed& o) {
  Ordered best;
  constexpr int bins = 12, shifts = 12;
  for (const OrderingAxis& axis : o.axes) {
    const double ratio = correlation_ratio(o.value, axis.values, bins);
    if (ratio > best.ratio) {
      best.ratio = ratio;
      best.axis = axis.name;
    }
    for (int s = 1; s <= shifts; ++s) {
      const Eigen::Index shift = o.value.size() * (2 * s + 1) / (2 * shifts + 4);
      best.chance = std::max(best.chance, correlation_ratio(o.value, axis.values, bins, shift));
    }
  }
  return best;
}

}  // namespace thermopower::gap::detail
