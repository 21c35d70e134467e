// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/rows.hpp>
#include <thermopower/io/names.hpp>

#include <vector>

namespace thermopower::io {

/// @brief Errors over held-out rows with the runs they belong to, in order; NaN where nothing was judged.
struct RunErrors {
  std::vector<double> errors;        ///< simulated minus measured, in the signal's unit
  std::vector<plant::RunSpan> runs;  ///< rows that belong together
  std::vector<double> t_s;           ///< stamps; as long as `errors`
};

/// @brief A curve of two columns.
struct Curve {
  std::vector<double> x;  ///< abscissae, ascending
  std::vector<double> y;  ///< ordinates
};

/// @brief How often each error occurs: share of the samples in each of 33 bins from -half_width to
/// half_width; samples beyond count in the outermost bins.
/// @param half_width  > 0, in the errors' unit
Curve histogram(const std::vector<double>& errors, double half_width);

/// @brief What histogram() would be of normal noise with this standard deviation.
Curve normal_histogram(double half_width, double sd);

/// @brief Correlation of errors with those some time later, about zero: 1 at no lag, near 0 throughout for white
/// noise. Pairs within one run only; up to a third of the longest run, at most 120 lags, at most 2000 rows.
/// Lags in s, by the median interval. Empty where there is nothing to correlate.
Curve autocorrelation(const RunErrors& of);

}  // namespace thermopower::io
