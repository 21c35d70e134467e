// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/where/projection.hpp>
#include <thermopower/gap/where/rows.hpp>
#include <thermopower/gap/where/smooth_curve.hpp>
#include <thermopower/gap/where/thresholds.hpp>

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

  /// The axis of that name, or nullptr.
  const OrderingAxis* find(const std::string& name) const {
    for (const OrderingAxis& axis : axes)
      if (axis.name == name) return &axis;
    return nullptr;
  }
};

/// Half width in rows at which the sensor's noise is small in the missing quantity.
inline int picture_half_width(const plant::Balance& balance, const LocalisationThresholds& limit) {
  if (balance.picture_half_width > 0) return balance.picture_half_width;
  const Eigen::VectorXd& flow = balance.flow_held.size() > 0 ? balance.flow_held : balance.flow_sampled;
  const double typical = flow.norm() / std::sqrt(static_cast<double>(flow.size()));
  const double state = state_noise(balance) * capacity_of(balance).mean();
  int half = limit.picture_first;
  while (half < limit.picture_last) {
    const TestFunctions functions(balance.rows, balance.measured, half, limit.picture_samples);
    if (functions.size() < limit.picture_least ||
        state * functions.derivative().gain() < limit.picture_noise * typical)
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
  Observed o{balance.signal, balance.quantity, balance.unit, {}, {}};
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
    for (const plant::OrderingVariable& one : balance.variables)
      if (one.kind != Kind::derivative) o.axes.push_back({one.name, one.unit, average(one.values)});
    return o;
  }
  Eigen::VectorXd needed = balance.measured;
  if (balance.flow_measured.size() > 0) needed += balance.flow_measured;
  const TestFunctions functions(balance.rows, needed, picture_half_width(balance, limit),
                                limit.picture_samples);
  const RowIntegrals &integral = functions.integral(), &derivative = functions.derivative();
  o.value = integral.of(capacity_of(balance)).cwiseProduct(derivative.of(balance.state)) -
            integral.of(balance.flow_sampled);
  if (balance.flow_held.size() > 0) o.value -= functions.held(balance.held_delay_s).of(balance.flow_held);
  const RowIntegrals held = functions.held();
  for (const plant::OrderingVariable& one : balance.variables)
    o.axes.push_back({one.name, one.unit,
                      (one.kind == Kind::sampled ? integral
                       : one.kind == Kind::held  ? held
                                                 : derivative)
                          .of(one.values)});
  return o;
}

/// A picture of a missing quantity: its means in bins of an axis.
inline MissingQuantity picture_of(const Observed& o, const OrderingAxis& axis,
                                  const LocalisationThresholds& limit) {
  std::vector<Bins::Bin> bins;
  for (const Bins::Bin& one : Bins(axis.values, limit.picture_bins).of(o.value))
    if (one.count >= 2.0) bins.push_back(one);
  const auto column = [&](auto&& value) {
    Eigen::VectorXd list(static_cast<Eigen::Index>(bins.size()));
    for (Eigen::Index k = 0; k < list.size(); ++k) list[k] = value(bins[static_cast<std::size_t>(k)]);
    return list;
  };
  MissingQuantity q;
  q.signal = o.signal;
  q.quantity = o.quantity;
  q.unit = o.unit;
  q.variable = axis.name;
  q.variable_unit = axis.unit;
  q.x = column([](const Bins::Bin& one) { return one.at(); });
  q.value = column([](const Bins::Bin& one) { return one.mean(); });
  q.spread = column([](const Bins::Bin& one) { return one.spread(); });
  return q;
}

/// Draws what a simulation with the causes supplies of a missing quantity, over the range in which that is drawn.
/// @param supplied  samples in the order in which they were recorded; nothing is drawn where they lack the axis
inline void set_effect(MissingQuantity& q, const Observed& supplied) {
  const OrderingAxis* axis = supplied.find(q.variable);
  if (axis == nullptr || q.x.size() < 2) return;
  SmoothCurve curve = smooth_curve(axis->values, supplied.value, q.x.minCoeff(), q.x.maxCoeff());
  q.effect_x = std::move(curve.x);
  q.effect = std::move(curve.value);
  q.effect_freedom = curve.freedom;
}

/// The contiguous range of the axis in which the missing quantity is largest: around the largest bin, while
/// above half of it.
inline std::optional<Regime> regime_of(const Observed& o, const OrderingAxis& axis,
                                       const LocalisationThresholds& limit) {
  const std::vector<Bins::Bin> bins = Bins(axis.values, limit.regime_bins).of(o.value);
  if (bins.size() < 3) return std::nullopt;
  const auto top = std::max_element(bins.begin(), bins.end(), [](const Bins::Bin& a, const Bins::Bin& b) {
    return std::abs(a.mean()) < std::abs(b.mean());
  });
  const auto is_large = [&](const Bins::Bin& one) {
    return one.mean() * top->mean() > limit.regime_half * top->mean() * top->mean();
  };
  auto first = top, last = top;
  while (first != bins.begin() && is_large(*(first - 1))) --first;
  while (last + 1 != bins.end() && is_large(*(last + 1))) ++last;
  return Regime{axis.name, first->from, last->to};
}

/// Which axis orders the quantity most, and what the best of all axes reaches by chance.
struct Ordered {
  const OrderingAxis* axis = nullptr;  ///< none where there is no axis
  double ratio = 0.0;                  ///< correlation ratio, 0..1
  double chance = 0.0;                 ///< largest over all axes when the quantity is shifted in time
};

/// The axis that orders a missing quantity most. @param o  must outlive the result
inline Ordered strongest_axis(const Observed& o) {
  Ordered best;
  constexpr int bins = 12, shifts = 12;
  for (const OrderingAxis& axis : o.axes) {
    const Bins rows(axis.values, bins);
    const double ratio = rows.correlation_ratio(o.value);
    if (ratio > best.ratio) best.ratio = ratio, best.axis = &axis;
    for (int s = 1; s <= shifts; ++s)
      best.chance = std::max(
          best.chance, rows.correlation_ratio(o.value, o.value.size() * (2 * s + 1) / (2 * shifts + 4)));
  }
  return best;
}

}  // namespace thermopower::gap::engine
