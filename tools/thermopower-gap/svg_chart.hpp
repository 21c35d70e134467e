// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

namespace thermopower::gap::files {

/// @brief One curve or cloud of a chart. NaN breaks a line and hides a point.
struct Series {
  /// How it is drawn. `interval` draws a vertical bar from `low` to `y` (used with `high`).
  enum class Style { line, points, interval };

  std::string label;              ///< in the legend; empty: none
  std::string role;               ///< CSS class: `measured`, `baseline`, `augmented`, `effect`
  Style style = Style::line;      ///< line or points
  std::vector<double> x;          ///< abscissae; where they fall, a new line begins
  std::vector<double> y;          ///< ordinates
  std::vector<double> low, high;  ///< ends of the bars, for `interval` only
};

/// @brief A picture: axes with units, curves, and a shaded range.
struct Chart {
  std::string title;    ///< what it shows, one phrase
  std::string x_label;  ///< with unit: "time / s"
  std::string y_label;  ///< with unit: "motor temperature / degC"
  std::vector<Series> series;
  double shade_from =
      0.0;  ///< range of x that is shaded (where the gap lies); none if `shade_to` is not larger
  double shade_to = 0.0;   ///< upper end of that range
  bool zero_line = false;  ///< draws y = 0, for quantities whose ideal is none
  int width = 860;         ///< in CSS pixels; the picture scales with the page
  int height = 300;        ///< in CSS pixels
};

/// @brief The chart as one `<svg>` element. Colours come from CSS classes of the page, so that it follows
/// light and dark.
///
/// Lines keep at most about 1500 points: per column of the picture the first, least, greatest and last value,
/// so that no peak is lost.
std::string to_svg(const Chart& chart);

/// @brief Text with `& < > "` escaped and bytes that are no UTF-8 replaced, for HTML and SVG.
std::string escaped(const std::string& text);

/// @brief A number for people: `digits` significant digits, no exponent between 0.001 and 99999, a dash for
/// NaN.
std::string readable(double value, int digits = 3);

}  // namespace thermopower::gap::files
