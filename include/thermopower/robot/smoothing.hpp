// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>

namespace thermopower::robot {

/// @brief A low-pass filter without phase: a Butterworth filter of third order, run forwards and backwards.
///
/// The same filter on both sides of an equation leaves the equation true (Gautier 1997).
/// @par Rules
/// At both ends the series is continued by its mirror image, as is usual.
///
/// How to: @ref diagnose_a_robot.
class ZeroPhaseFilter {
public:
  /// @param cutoff  share of the sampling rate, above 0 and below 0.5
  explicit ZeroPhaseFilter(double cutoff) {
    // Bilinear transform of 1 / ((s + 1) (s^2 + s + 1)).
    constexpr double pi = 3.14159265358979323846;
    const double k = std::tan(pi * cutoff);
    first_ = {k / (1.0 + k), k / (1.0 + k), (k - 1.0) / (1.0 + k)};
    const double norm = 1.0 / (1.0 + k + k * k);
    second_ = {k * k * norm, 2.0 * k * k * norm, k * k * norm, 2.0 * (k * k - 1.0) * norm,
               (1.0 - k + k * k) * norm};
    margin_ = static_cast<Eigen::Index>(std::ceil(2.0 / cutoff));
  }

  /// Rows at each end that the continuation reaches.
  Eigen::Index margin() const { return margin_; }

  /// @param series  evenly spaced samples, at least two
  Eigen::VectorXd operator()(const Eigen::VectorXd& series) const {
    const Eigen::Index n = series.size(), pad = std::min(3 * margin_, n - 1);
    if (n < 2) return series;
    Eigen::VectorXd x(n + 2 * pad);
    for (Eigen::Index i = 0; i < pad; ++i) {
      x[i] = 2.0 * series[0] - series[pad - i];
      x[n + pad + i] = 2.0 * series[n - 1] - series[n - 2 - i];
    }
    x.segment(pad, n) = series;
    once(x);
    x.reverseInPlace();
    once(x);
    x.reverseInPlace();
    return x.segment(pad, n);
  }

private:
  void once(Eigen::VectorXd& x) const {
    double in = x[0], out = x[0];
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double now = x[i];
      out = first_[0] * now + first_[1] * in - first_[2] * out;
      in = now;
      x[i] = out;
    }
    double in1 = x[0], in2 = x[0], out1 = x[0], out2 = x[0];
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double now = x[i];
      const double value =
          second_[0] * now + second_[1] * in1 + second_[2] * in2 - second_[3] * out1 - second_[4] * out2;
      in2 = in1;
      in1 = now;
      out2 = out1;
      out1 = value;
      x[i] = value;
    }
  }

  std::array<double, 3> first_{};
  std::array<double, 5> second_{};
  Eigen::Index margin_ = 0;
};

/// @brief Central differences of evenly spaced samples; one-sided at both ends.
inline Eigen::VectorXd derivative(const Eigen::VectorXd& series, double step_s) {
  const Eigen::Index n = series.size();
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(n);
  if (n < 2) return rate;
  for (Eigen::Index i = 1; i + 1 < n; ++i) rate[i] = (series[i + 1] - series[i - 1]) / (2.0 * step_s);
  rate[0] = (series[1] - series[0]) / step_s;
  rate[n - 1] = (series[n - 1] - series[n - 2]) / step_s;
  return rate;
}

}  // namespace thermopower::robot
