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

/// @brief Spectrum of errors: amplitude density over frequency in Hz, in the errors' unit per root of a hertz, one-sided;
/// its square, integrated over all frequencies, is the errors' mean square but for their mean and what is slower than half a
/// window (Welch 1967: Hann windows that overlap by half, at most 200 of at most 1024 rows, within one run only; at most
/// 12 frequencies an octave). Rows that are missing count as
/// no error; pieces that lack more than a tenth are left out. Empty where no run has 16 rows.
Curve spectrum(const RunErrors& of);

/// @brief What spectrum() would be of white noise with this standard deviation: the same at every frequency.
Curve white_spectrum(const RunErrors& of, double sd);

/// @brief Correlation of errors with those some time later, about zero: 1 at no lag, near 0 throughout for white
/// noise. Pairs within one run only; up to a third of the longest run, at most 120 lags, at most 2000 rows.
/// Lags in s, by the median interval. Empty where there is nothing to correlate.
Curve autocorrelation(const RunErrors& of);

}  // namespace thermopower::io
