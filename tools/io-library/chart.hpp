// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::io {

/// @brief One curve or cloud of a chart. NaN breaks a line and hides a point.
struct Series {
  /// How it is drawn. `steps` holds each value until the next; `interval` draws a vertical bar from `low` to
  /// `high`.
  enum class Style { line, steps, points, interval };

  std::string label;  ///< in the legend; empty: none
  std::string role;   ///< CSS class: `measured`, `baseline`, `recalibrated`, `augmented`, `effect`, ...
  Style style = Style::line;      ///< line, steps, points or interval
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
  std::optional<std::pair<double, double>> shade;  ///< range of x that is shaded (where the gap lies)
  std::optional<std::pair<double, double>> view;   ///< range of x shown at first; else all of it
  std::optional<double> mark;                      ///< an x with a line of its own
  double band = 0.0;  ///< half height of a band around y = 0: what noise makes; 0: none
  /// Decades on an axis; what is not above 0 is left out there. With neither shade, view, mark nor band.
  bool logarithmic = false;
  bool zero_line = false;  ///< y = 0 is on the picture and has a line, for quantities whose ideal is none
  std::string group;       ///< charts of one group are zoomed together; empty: this one cannot be zoomed
  int height = 240;        ///< of the plot, in CSS pixels; its width is the page's
};

/// @brief The chart as HTML: labels are text of the page and keep their size at any width, curves are one SVG
/// that stretches. Colours come from CSS classes of the page, so that it follows light and dark.
///
/// Curves are paths in whole numbers, 0 to chart_columns over the chart's range of x and 0 (top) to chart_rows
/// over its first view's range of y (`data-x`, `data-y`): the page's script reads them back for zoom and hover.
/// They keep at most about 2400 points: per column of the picture the first, least, greatest and last value, so
/// that no peak is lost.
std::string to_html(const Chart& chart);

/// @brief Width of a chart's drawing, in its own units.
inline constexpr int chart_columns = 100000;
/// @brief Height of a chart's drawing, in its own units.
inline constexpr int chart_rows = 10000;

}  // namespace thermopower::io
