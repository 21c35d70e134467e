// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

/// A grid of small charts with one legend, written as SVG.
namespace figures {

/// How a series is drawn.
enum class Mark {
  line,    ///< A line.
  dashed,  ///< A dashed line.
  dots     ///< Points only: what was measured.
};

/// One series of a panel.
struct Series {
  std::string name;        ///< In the legend, which shows each name once.
  std::string colour;      ///< Any SVG colour.
  Mark mark = Mark::line;  ///< How it is drawn.
  std::vector<double> x;   ///< As many as `y`.
  std::vector<double> y;   ///< NaN breaks the line.
};

/// One chart.
struct Panel {
  std::string title;                ///< Above the chart.
  std::string x_label;              ///< With its unit.
  std::string y_label;              ///< With its unit.
  std::vector<Series> series;       ///< Drawn in this order.
  double y_from = 0.0, y_to = 0.0;  ///< Range; equal: from the data. What lies outside is cut off.
  double limit = 0.0;               ///< A horizontal line here, when it is not 0.
  double x_from = 0.0, x_to = 0.0;  ///< Range; equal: from the data.
};

/// Colours that tell apart and print well.
struct Palette {
  static constexpr const char* thesis = "#d9730d";
  static constexpr const char* constant = "#868e96";
  static constexpr const char* corrected = "#5c7cfa";
  static constexpr const char* ours = "#0b7285";
  static constexpr const char* truth = "#1f2933";
  static constexpr const char* power = "#d9730d";
};

/// Writes the file, all of it or nothing.
/// @throws std::runtime_error naming the file when it cannot be written
void write_small_multiples(const std::string& path, const std::string& title,
                           const std::vector<Panel>& panels, int columns);

}  // namespace figures
