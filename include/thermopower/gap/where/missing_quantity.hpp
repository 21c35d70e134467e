// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/where/projection.hpp>
#include <thermopower/gap/where/smooth_curve.hpp>
#include <thermopower/gap/where/thresholds.hpp>
#include <thermopower/plant/balance.hpp>

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

/// Rows in bins of a variable, about as many in each. Rows of equal values are in the same one.
class Bins {
public:
  /// The rows of one bin.
  struct Bin {
    double from = 0.0;     ///< least value of the variable
    double to = 0.0;       ///< largest value of the variable
    double sum_at = 0.0;   ///< sum of the variable
    double count = 0.0;    ///< rows in which something is measured
    double sum = 0.0;      ///< sum of what is measured
    double squares = 0.0;  ///< sum of its squares

    double at() const { return sum_at / count; }  ///< mean of the variable
    double mean() const { return sum / count; }   ///< of what is measured
    /// Standard error of the mean.
    double spread() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean()) / count); }
  };

  /// @param variable  one value per row; rows without one are in no bin
  /// @param most      how many bins, 1 or more
  Bins(const Eigen::VectorXd& variable, int most) : variable_(variable) {
    for (Eigen::Index row = 0; row < variable.size(); ++row)
      if (std::isfinite(variable[row])) rows_.push_back(row);
    sort_by(rows_, [&](Eigen::Index row) { return variable[row]; });
    const std::size_t count = rows_.size(), bins = static_cast<std::size_t>(std::max(1, most));
    for (std::size_t k = 1; k <= bins; ++k) {
      std::size_t end = count * k / bins;
      if (end <= (ends_.empty() ? 0 : ends_.back())) continue;
      while (end < count && variable[rows_[end]] == variable[rows_[end - 1]]) ++end;
      ends_.push_back(end);
    }
  }

  /// The bins of what was measured. @param value  one per row, of which those that are not finite are left out
  /// @param shift  rows by which it is moved against the variable, in a circle: 0 to the number of rows
  std::vector<Bin> of(const Eigen::VectorXd& value, Eigen::Index shift = 0) const {
    assert(value.size() == variable_.size() && shift >= 0 && shift <= value.size());
    std::vector<Bin> bins;
    std::size_t at = 0;
    for (const std::size_t end : ends_) {
      Bin bin{variable_[rows_[at]], variable_[rows_[end - 1]]};
      for (; at < end; ++at) {
        const Eigen::Index row = rows_[at] + shift;
        const double v = value[row < value.size() ? row : row - value.size()];
        if (!std::isfinite(v)) continue;
        bin.sum_at += variable_[rows_[at]];
        bin.count += 1.0;
        bin.sum += v;
        bin.squares += v * v;
      }
      if (bin.count > 0.0) bins.push_back(bin);
    }
    return bins;
  }

  /// Share of the variance of what was measured that the means of its bins explain, 0..1. Parameters as for of().
  double correlation_ratio(const Eigen::VectorXd& value, Eigen::Index shift = 0) const {
    double count = 0.0, sum = 0.0, squares = 0.0, of_means = 0.0;
    for (const Bin& one : of(value, shift)) {
      count += one.count;
      sum += one.sum;
      squares += one.squares;
      of_means += one.sum * one.mean();
    }
    const double variance = count > 0.0 ? squares - sum * sum / count : 0.0;
    return variance > 0.0 ? std::clamp((of_means - sum * sum / count) / variance, 0.0, 1.0) : 0.0;
  }

private:
  const Eigen::VectorXd& variable_;
  std::vector<Eigen::Index> rows_;  // in the order of the variable
  std::vector<std::size_t> ends_;   // of each bin in them
};

/// Samples of a missing quantity, and everything recorded that may order them.
struct Observed {
  plant::SignalName signal;                   ///< that it was inferred from
  plant::QuantityName quantity;               ///< the missing quantity
  std::string unit;                           ///< of `value`
  Eigen::VectorXd value;                      ///< one per sample
  std::vector<plant::OrderingVariable> axes;  ///< with as many values each

  /// The axis of that name, or nullptr.
  const plant::OrderingVariable* find(const std::string& name) const {
    for (const plant::OrderingVariable& axis : axes)
      if (axis.name == name) return &axis;
    return nullptr;
  }
};

/// Half width in rows at which the sensor's noise is small in the missing quantity.
inline int picture_half_width(const plant::Balance& balance) {
  if (balance.picture_half_width > 0) return balance.picture_half_width;
  const Eigen::VectorXd& flow = balance.flow_held.size() > 0 ? balance.flow_held : balance.flow_sampled;
  const double typical = flow.norm() / std::sqrt(static_cast<double>(flow.size()));
  const double state = state_noise(balance) * capacity_of(balance).mean();
  for (int half = where_limits.picture_first;; half *= 2) {
    const TestFunctions functions(balance.rows, balance.measured, half, where_limits.picture_samples);
    if (functions.size() < where_limits.picture_least ||
        state * functions.derivative().gain() < where_limits.picture_noise * typical)
      return half;
  }
}

/// The missing quantity of a balance, averaged over stretches long enough to see it.
/// @param as_restated  stated as what would drive the balance, where it can be
inline Observed observe(const plant::Balance& balance, bool as_restated) {
  using Kind = plant::OrderingVariable::Kind;
  Observed o{balance.signal, balance.quantity, balance.unit, {}, {}};
  if (balance.form == plant::BalanceForm::algebraic) {
    const Thinning average(balance.rows->runs, balance.measured, where_limits.picture_samples);
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
  const TestFunctions functions(balance.rows, needed_by(balance), picture_half_width(balance),
                                where_limits.picture_samples);
  const RowIntegrals held = functions.held();
  o.value = missing_of(balance, functions, functions.held(balance.held_delay_s));
  for (const plant::OrderingVariable& one : balance.variables) {
    const RowIntegrals& average = one.kind == Kind::sampled ? functions.integral()
                                  : one.kind == Kind::held  ? held
                                                            : functions.derivative();
    o.axes.push_back({one.name, one.unit, average.of(one.values)});
  }
  return o;
}

/// A picture of a missing quantity: its means in bins of an axis.
inline MissingQuantity picture_of(const Observed& o, const plant::OrderingVariable& axis) {
  std::vector<Bins::Bin> bins = Bins(axis.values, where_limits.picture_bins).of(o.value);
  bins.erase(std::remove_if(bins.begin(), bins.end(), [](const Bins::Bin& one) { return one.count < 2.0; }),
             bins.end());
  const auto count = static_cast<Eigen::Index>(bins.size());
  MissingQuantity q;
  q.signal = o.signal;
  q.quantity = o.quantity;
  q.unit = o.unit;
  q.variable = axis.name;
  q.variable_unit = axis.unit;
  q.x = q.value = q.spread = Eigen::VectorXd(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Bins::Bin& one = bins[static_cast<std::size_t>(k)];
    q.x[k] = one.at();
    q.value[k] = one.mean();
    q.spread[k] = one.spread();
  }
  return q;
}

/// Draws what a simulation with the causes supplies of a missing quantity, over the range in which that is drawn.
/// @param supplied  samples in the order in which they were recorded; nothing is drawn where they lack the axis
inline void set_effect(MissingQuantity& q, const Observed& supplied) {
  const plant::OrderingVariable* axis = supplied.find(q.variable);
  if (axis == nullptr || q.x.size() < 2) return;
  SmoothCurve curve = smooth_curve(axis->values, supplied.value, q.x.minCoeff(), q.x.maxCoeff());
  q.effect_x = std::move(curve.x);
  q.effect = std::move(curve.value);
  q.effect_freedom = curve.freedom;
}

/// The contiguous range of the axis in which the missing quantity is largest: around the largest bin, while
/// above half of it.
inline std::optional<Regime> regime_of(const Observed& o, const plant::OrderingVariable& axis) {
  const std::vector<Bins::Bin> bins = Bins(axis.values, where_limits.regime_bins).of(o.value);
  if (bins.size() < 3) return std::nullopt;
  const auto top = std::max_element(bins.begin(), bins.end(), [](const Bins::Bin& a, const Bins::Bin& b) {
    return std::abs(a.mean()) < std::abs(b.mean());
  });
  const auto is_large = [&](const Bins::Bin& one) {
    return one.mean() * top->mean() > where_limits.regime_half * top->mean() * top->mean();
  };
  auto first = top, last = top;
  while (first != bins.begin() && is_large(*(first - 1))) --first;
  while (last + 1 != bins.end() && is_large(*(last + 1))) ++last;
  return Regime{axis.name, first->from, last->to};
}

/// Which axis orders the quantity most, and what the best of all axes reaches by chance.
struct Ordered {
  const plant::OrderingVariable* axis = nullptr;  ///< none where there is no axis
  double ratio = 0.0;                             ///< correlation ratio, 0..1
  double chance = 0.0;  ///< largest over all axes when the quantity is shifted in time
};

/// The axis that orders a missing quantity most. @param o  must outlive the result
inline Ordered strongest_axis(const Observed& o) {
  Ordered best;
  constexpr int bins = 12, shifts = 12;
  for (const plant::OrderingVariable& axis : o.axes) {
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
