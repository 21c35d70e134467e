// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "residual_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thermopower::io {
namespace {

constexpr int bins = 33;  // odd: one is around zero
constexpr std::ptrdiff_t most_lags = 120, most_rows = 2000;

double bin_width(double half_width) { return 2.0 * half_width / bins; }

Curve empty_histogram(double half_width) {
  Curve curve;
  for (int i = 0; i < bins; ++i) {
    curve.x.push_back(-half_width + (i + 0.5) * bin_width(half_width));
    curve.y.push_back(0.0);
  }
  return curve;
}

}  // namespace

Curve histogram(const std::vector<double>& errors, double half_width) {
  Curve curve = empty_histogram(half_width);
  double all = 0.0;
  for (const double error : errors) {
    if (!std::isfinite(error)) continue;
    const double bin = std::floor((error + half_width) / bin_width(half_width));
    curve.y[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1.0))] += 1.0;
    all += 1.0;
  }
  for (double& share : curve.y) share /= std::max(all, 1.0);
  return curve;
}

Curve normal_histogram(double half_width, double sd) {
  Curve curve = empty_histogram(half_width);
  const auto below = [sd](double x) { return 0.5 * std::erfc(-x / (sd * std::sqrt(2.0))); };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double half = 0.5 * bin_width(half_width);
    curve.y[i] = below(curve.x[i] + half) - below(curve.x[i] - half);
  }
  return curve;
}

Curve autocorrelation(const RunErrors& of) {
  double square = 0.0;
  std::ptrdiff_t samples = 0, longest = 0;
  std::vector<double> steps;
  for (const auto& run : of.runs) {
    longest = std::max(longest, static_cast<std::ptrdiff_t>(run.size()));
    for (auto row = static_cast<std::size_t>(run.begin); row < static_cast<std::size_t>(run.end); ++row) {
      if (row > static_cast<std::size_t>(run.begin)) steps.push_back(of.t_s[row] - of.t_s[row - 1]);
      if (!std::isfinite(of.errors[row])) continue;
      square += of.errors[row] * of.errors[row];
      ++samples;
    }
  }
  Curve curve;
  if (samples < 10 || !(square > 0.0) || steps.empty()) return curve;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  const double step_s = steps[steps.size() / 2], mean_square = square / static_cast<double>(samples);
  const std::ptrdiff_t last = std::min(longest / 3, most_rows),
                       stride = std::max<std::ptrdiff_t>(1, last / most_lags);
  for (std::ptrdiff_t lag = 0; lag <= last; lag += stride) {
    double sum = 0.0;
    std::ptrdiff_t pairs = 0;
    for (const auto& run : of.runs) {
      for (std::ptrdiff_t row = run.begin; row + lag < run.end; ++row) {
        const double product =
            of.errors[static_cast<std::size_t>(row)] * of.errors[static_cast<std::size_t>(row + lag)];
        if (!std::isfinite(product)) continue;
        sum += product;
        ++pairs;
      }
    }
    if (pairs == 0) break;
    curve.x.push_back(static_cast<double>(lag) * step_s);
    curve.y.push_back(sum / static_cast<double>(pairs) / mean_square);
  }
  return curve;
}

}  // namespace thermopower::io
