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

namespace {

// Median interval between rows of a run; 0 without any.
double median_interval(const RunErrors& of) {
  std::vector<double> steps;
  for (const auto& run : of.runs)
    for (auto row = static_cast<std::size_t>(run.begin) + 1; row < static_cast<std::size_t>(run.end); ++row)
      steps.push_back(of.t_s[row] - of.t_s[row - 1]);
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

// Pieces of a run that lack little, each half over the one before.
struct Pieces {
  std::ptrdiff_t length = 0;
  std::vector<std::size_t> begin;
};

Pieces pieces_of(const RunErrors& of) {
  constexpr std::ptrdiff_t longest_piece = 1024, shortest_piece = 16, overlap = 2;
  constexpr double least_there = 0.9;
  std::ptrdiff_t longest = 0;
  for (const auto& run : of.runs) longest = std::max(longest, static_cast<std::ptrdiff_t>(run.size()));
  Pieces pieces;
  // Four pieces of the longest run at least, where it is long enough: one alone scatters as much as it says.
  for (std::ptrdiff_t length = longest_piece; length >= shortest_piece; length /= 2)
    if (2 * length <= longest || length / 2 < shortest_piece) {
      pieces.length = length;
      break;
    }
  for (const auto& run : of.runs)
    for (std::ptrdiff_t begin = run.begin; begin + pieces.length <= run.end;
         begin += pieces.length / overlap) {
      std::ptrdiff_t there = 0;
      for (std::ptrdiff_t i = 0; i < pieces.length; ++i)
        there += std::isfinite(of.errors[static_cast<std::size_t>(begin + i)]) ? 1 : 0;
      if (static_cast<double>(there) >= least_there * static_cast<double>(pieces.length))
        pieces.begin.push_back(static_cast<std::size_t>(begin));
    }
  return pieces;
}

}  // namespace

Curve spectrum(const RunErrors& of) {
  constexpr double pi = 3.14159265358979323846, per_octave = 12.0;
  constexpr std::size_t most_pieces = 200;
  Curve curve;
  const double step_s = median_interval(of);
  Pieces pieces = pieces_of(of);
  if (!(step_s > 0.0) || pieces.begin.empty()) return curve;
  if (pieces.begin.size() > most_pieces) {
    std::vector<std::size_t> fewer;
    for (std::size_t i = 0; i < most_pieces; ++i)
      fewer.push_back(pieces.begin[i * pieces.begin.size() / most_pieces]);
    pieces.begin = fewer;
  }
  const auto length = static_cast<std::size_t>(pieces.length);
  std::vector<double> window(length), turn_cos(length), turn_sin(length);
  for (std::size_t i = 0; i < length; ++i) {
    const double angle = 2.0 * pi * static_cast<double>(i) / static_cast<double>(length);
    window[i] = 0.5 - 0.5 * std::cos(angle + pi / static_cast<double>(length));
    turn_cos[i] = std::cos(angle);
    turn_sin[i] = std::sin(angle);
  }
  double last = 0.0;
  // From the second on: the window lets none of the mean into it.
  for (std::size_t k = 2; k <= length / 2; ++k) {
    if (static_cast<double>(k) < last * std::exp2(1.0 / per_octave)) continue;
    last = static_cast<double>(k);
    double power = 0.0;
    for (const std::size_t begin : pieces.begin) {
      double re = 0.0, im = 0.0, weight = 0.0;
      for (std::size_t i = 0; i < length; ++i) {
        const double error = of.errors[begin + i];
        if (!std::isfinite(error)) continue;
        const std::size_t turn = i * k % length;
        re += window[i] * error * turn_cos[turn];
        im += window[i] * error * turn_sin[turn];
        weight += window[i] * window[i];
      }
      const double sides = 2 * k == length ? 1.0 : 2.0;
      power += sides * step_s * (re * re + im * im) / weight;
    }
    curve.x.push_back(last / (static_cast<double>(length) * step_s));
    curve.y.push_back(std::sqrt(power / static_cast<double>(pieces.begin.size())));
  }
  return curve;
}

Curve white_spectrum(const RunErrors& of, double sd) {
  Curve curve = spectrum(of);
  std::fill(curve.y.begin(), curve.y.end(), sd * std::sqrt(2.0 * median_interval(of)));
  return curve;
}

Curve autocorrelation(const RunErrors& of) {
  double square = 0.0;
  std::ptrdiff_t samples = 0, longest = 0;
  for (const auto& run : of.runs) {
    longest = std::max(longest, static_cast<std::ptrdiff_t>(run.size()));
    for (auto row = static_cast<std::size_t>(run.begin); row < static_cast<std::size_t>(run.end); ++row) {
      if (!std::isfinite(of.errors[row])) continue;
      square += of.errors[row] * of.errors[row];
      ++samples;
    }
  }
  Curve curve;
  const double step_s = median_interval(of);
  if (samples < 10 || !(square > 0.0) || step_s == 0.0) return curve;
  const double mean_square = square / static_cast<double>(samples);
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
