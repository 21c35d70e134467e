// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/localise/projection.hpp>
#include <thermopower/gap/localise/rows.hpp>
#include <thermopower/gap/localise/smooth_curve.hpp>
#include <thermopower/gap/localise/thresholds.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// The missing quantity itself, read off the recording (watts, newton metres, volts), and ordered by what orders
/// it.

namespace thermopower::gap::engine {

/// Something that may order a missing quantity, one value per sample of it.
struct OrderingAxis {
  std::string name;        ///< a column, or a derived name
  std::string unit;        ///< of the values
  Eigen::VectorXd values;  ///< one per sample
};

/// Samples of a missing quantity, and everything recorded that may order them.
struct Observed {
  plant::SignalName signal;        ///< that it was inferred from
  plant::QuantityName quantity;    ///< the missing quantity
  std::string unit;                ///< of `value`
  Eigen::VectorXd value;           ///< one per sample
  std::vector<OrderingAxis> axes;  ///< as long each
  double interval_s = 1.0;         ///< between samples
  double longest_run_s = 0.0;      ///< of the recording: no longer period can be seen
  double noise = 0.0;  ///< standard deviation that the sensor alone gives `value`; 0 where unknown

  /// The axis of that name, or nullptr.
  const OrderingAxis* find(const std::string& name) const {
    for (const OrderingAxis& axis : axes) {
      if (axis.name == name) return &axis;
    }
    return nullptr;
  }
};

/// Half width in rows at which the sensor's noise is small in the missing quantity.
inline int picture_half_width(const plant::Balance& balance, const LocalisationThresholds& limit) {
  if (balance.picture_half_width > 0) return balance.picture_half_width;
  const Eigen::VectorXd& flow = balance.flow_held.size() > 0 ? balance.flow_held : balance.flow_sampled;
  const double typical =
      std::sqrt(flow.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, flow.size())));
  const double state = state_noise(balance) * capacity_of(balance).mean();
  int half = limit.picture_first;
  while (half < limit.picture_last) {
    const TestFunctions functions(balance.rows, balance.measured, half, limit.picture_samples);
    if (functions.size() < limit.picture_least ||
        state * functions.derivative_gain() < limit.picture_noise * typical)
      break;
    half *= 2;
  }
  return half;
}

/// The missing quantity of a balance, averaged over stretches long enough to see it.
/// @param as_restated  stated as what would drive the balance, where it can be
inline Observed observe(const plant::Balance& balance, bool as_restated,
                        const LocalisationThresholds& limit) {
  using Kind = plant::OrderingVariable::Kind;
  Observed o;
  o.signal = balance.signal;
  o.quantity = balance.quantity;
  o.unit = balance.unit;
  o.interval_s = balance.rows->interval_s;
  for (const RunSpan& run : balance.rows->runs)
    if (run.size() > 1)
      o.longest_run_s =
          std::max(o.longest_run_s, balance.rows->t_s[run.end - 1] - balance.rows->t_s[run.begin]);
  if (balance.form == plant::BalanceForm::algebraic) {
    const Thinning average(balance.rows->runs, balance.measured, limit.picture_samples);
    Eigen::VectorXd value = balance.measured - balance.flow_sampled;
    if (balance.flow_held.size() > 0) value -= balance.flow_held;
    if (as_restated && balance.restated) {
      value = value.cwiseProduct(balance.restated->factor);
      o.quantity = balance.restated->quantity;
      o.unit = balance.restated->unit;
    }
    o.value = average(value);
    o.interval_s *= static_cast<double>(average.stride());
    for (const plant::OrderingVariable& one : balance.variables)
      if (one.kind != Kind::derivative) o.axes.push_back({one.name, one.unit, average(one.values)});
    return o;
  }
  const int half = picture_half_width(balance, limit);
  Eigen::VectorXd needed = balance.measured;
  if (balance.flow_measured.size() > 0) needed += balance.flow_measured;
  const TestFunctions functions(balance.rows, needed, half, limit.picture_samples);
  const Eigen::VectorXd capacity = capacity_of(balance);
  o.value = functions.integral(capacity).cwiseProduct(functions.derivative(balance.state)) -
            functions.integral(balance.flow_sampled);
  if (balance.flow_held.size() > 0)
    o.value -= functions.held_integral(balance.flow_held, balance.held_delay_s);
  o.interval_s *= half;
  o.noise = state_noise(balance) * functions.derivative_gain() * capacity.cwiseAbs().mean();
  for (const plant::OrderingVariable& one : balance.variables) {
    o.axes.push_back({one.name, one.unit,
                      one.kind == Kind::sampled ? functions.integral(one.values)
                      : one.kind == Kind::held  ? functions.held_integral(one.values)
                                                : functions.derivative(one.values)});
  }
  return o;
}

/// Whether a missing quantity scatters in proportion to a variable rather than alike everywhere. A coefficient with a
/// course of its own would make it do so. The likelier of two normal laws decides, after the constant part and the
/// proportional parts have been taken off.
inline bool scatters_with(const Observed& o, const std::string& variable, const std::string& flow) {
  constexpr Eigen::Index least_samples = 12;
  constexpr double least_share = 1e-6, least_size = 1e-4;  // of a variance: keep a perfect fit finite
  const Eigen::Index n = o.value.size();
  const OrderingAxis *along = o.find(variable), *driven = o.find(flow);
  if (n < least_samples || along == nullptr) return false;
  Eigen::MatrixXd x(n, driven != nullptr ? 3 : 2);
  x.col(0).setOnes();
  x.col(1) = along->values;
  if (driven != nullptr) x.col(2) = driven->values;
  const Eigen::VectorXd left = o.value - x * LeastSquares(x).solve(o.value);
  const double noise = o.noise * o.noise, all = left.squaredNorm() / static_cast<double>(n);
  const double scatter = std::max(all - noise, least_share * all),
               typical = along->values.squaredNorm() / static_cast<double>(n);
  double alike = 0.0, in_proportion = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double one = scatter + noise,
                 other = scatter * std::max(std::pow(along->values[i], 2.0) / typical, least_size) + noise;
    alike += std::log(one) + left[i] * left[i] / one;
    in_proportion += std::log(other) + left[i] * left[i] / other;
  }
  return in_proportion < alike;
}

/// Means over bins that the edges part; empty bins are left out.
inline MissingQuantity binned(const Observed& o, const OrderingAxis& axis, const std::vector<double>& edges) {
  assert(axis.values.size() == o.value.size());
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

/// Draws what a simulation with the causes supplies of a missing quantity, over the range in which that is drawn.
/// @param variable, supplied  samples in the order in which they were recorded
inline void set_effect(MissingQuantity& q, const Eigen::VectorXd& variable, const Eigen::VectorXd& supplied) {
  if (q.x.size() < 2) return;
  SmoothCurve curve = smooth_curve(variable, supplied, q.x.minCoeff(), q.x.maxCoeff());
  q.effect_x = std::move(curve.x);
  q.effect = std::move(curve.value);
  q.effect_freedom = curve.freedom;
}

/// The contiguous range of the axis in which the missing quantity is largest: around the largest bin, while
/// above half of it.
inline std::optional<Regime> regime_of(const Observed& o, const OrderingAxis& axis,
                                       const LocalisationThresholds& limit) {
  const std::vector<double> edges = equal_count_edges(axis.values, limit.regime_bins);
  const MissingQuantity q = binned(o, axis, edges);
  if (q.x.size() < 3) return std::nullopt;
  Eigen::Index top = 0;
  const double most = q.value.cwiseAbs().maxCoeff(&top);
  Eigen::Index from = top, to = top;
  while (from > 0 && q.value[from - 1] * q.value[top] > 0.0 &&
         std::fabs(q.value[from - 1]) > limit.regime_half * most)
    --from;
  while (to + 1 < q.x.size() && q.value[to + 1] * q.value[top] > 0.0 &&
         std::fabs(q.value[to + 1]) > limit.regime_half * most)
    ++to;
  const auto below = std::upper_bound(edges.begin(), edges.end(), q.x[from]);
  const auto above = std::upper_bound(edges.begin(), edges.end(), q.x[to]);
  return Regime{axis.name, below == edges.begin() ? edges.front() : *(below - 1),
                above == edges.end() ? edges.back() : *above};
}

/// Which axis orders the quantity most, and what the best of all axes reaches by chance.
struct Ordered {
  std::string axis;     ///< its name
  double ratio = 0.0;   ///< correlation ratio, 0..1
  double chance = 0.0;  ///< largest over all axes when the quantity is shifted in time
};

/// The axis that orders a missing quantity most.
inline Ordered strongest_axis(const Observed& o) {
  Ordered best;
  constexpr int bins = 12, shifts = 12;
  for (const OrderingAxis& axis : o.axes) {
    const BinnedRows rows(axis.values, bins);
    const double ratio = rows.correlation_ratio(o.value);
    if (ratio > best.ratio) {
      best.ratio = ratio;
      best.axis = axis.name;
    }
    for (int s = 1; s <= shifts; ++s) {
      const Eigen::Index shift = o.value.size() * (2 * s + 1) / (2 * shifts + 4);
      best.chance = std::max(best.chance, rows.correlation_ratio(o.value, shift));
    }
  }
  return best;
}

}  // namespace thermopower::gap::engine
