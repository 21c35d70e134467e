// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "replay.hpp"

namespace thesis {
namespace {

// Colours of Okabe and Ito, told apart by colour-blind readers; the dashes do the same in print.
const char* const style =
    "<style>"
    "text{font-family:'DejaVu Sans',Verdana,sans-serif;font-size:11px;fill:#333}"
    ".title{font-size:20px;font-weight:bold;fill:#111}.part{font-size:14px;font-weight:bold;fill:#111}"
    ".name{font-size:11.5px;fill:#111}.small{font-size:10px;fill:#666}"
    ".grid{stroke:#e4e4e4}.frame{fill:none;stroke:#999}"
    ".program{fill:none;stroke:#D55E00;stroke-width:1.8;stroke-dasharray:5 3}"
    ".corrected{fill:none;stroke:#0072B2;stroke-width:1.8}"
    ".measured{fill:#111;stroke:#fff;stroke-width:.8}.limit{stroke:#888;stroke-dasharray:2 3}"
    "</style>\n";

std::string format(const char* pattern, double a, double b, double c = 0.0, double d = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, a, b, c, d);
  return text;
}

std::string label(double x, double y, const std::string& text, const char* anchor = "start",
                  const char* kind = "", const char* more = "") {
  return format("<text x='%.1f' y='%.1f'", x, y) + " text-anchor='" + anchor + "' class='" + kind + "' " +
         more + ">" + text + "</text>\n";
}

/// A rectangle of the sheet with its axes.
struct Panel {
  double left, top, width, height;
  double x_from, x_to, x_step, y_from, y_to, y_step;

  double x(double value) const { return left + (value - x_from) / (x_to - x_from) * width; }
  double y(double value) const { return top + height - (value - y_from) / (y_to - y_from) * height; }

  std::string axes(bool has_y_labels) const {
    std::string text;
    for (double value = x_from; value <= x_to + 1e-9; value += x_step) {
      text += format("<line class='grid' x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f'/>\n", x(value), top,
                     x(value), top + height);
      text += label(x(value), top + height + 13, std::to_string(static_cast<int>(value)), "middle", "small");
    }
    for (double value = y_from; value <= y_to + 1e-9; value += y_step) {
      text += format("<line class='grid' x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f'/>\n", left, y(value),
                     left + width, y(value));
      if (has_y_labels)
        text += label(left - 5, y(value) + 3.5, std::to_string(static_cast<int>(value)), "end", "small");
    }
    return text + format("<rect class='frame' x='%.1f' y='%.1f' width='%.1f' height='%.1f'/>\n", left, top,
                         width, height);
  }

  std::string curve(const Experiment& experiment, double Point::*model, const char* kind) const {
    std::string points;
    for (const Point& point : experiment.curve) points += format("%.1f,%.1f ", x(point.x), y(point.*model));
    return std::string("<polyline class='") + kind + "' points='" + points + "'/>\n";
  }

  std::string all(const Experiment& experiment) const {
    std::string text =
        curve(experiment, &Point::program, "program") + curve(experiment, &Point::corrected, "corrected");
    for (const Point& point : experiment.curve)
      if (!std::isnan(point.measured))
        text +=
            format("<circle class='measured' cx='%.1f' cy='%.1f' r='3.2'/>\n", x(point.x), y(point.measured));
    return text;
  }
};

std::string name_of(const Experiment& experiment) {
  std::string power =
      experiment.power_param > 0 ? "power " + std::to_string(experiment.power_param) : "cooling";
  if (experiment.kind == Experiment::Kind::protection) power += ", limited";
  return "Table " + experiment.table + ", " + power;
}

}  // namespace

std::string picture(const std::vector<Experiment>& experiments) {
  constexpr int columns = 7;
  constexpr double width = 1440, height = 1040, margin = 62, gap = 16, first_top = 120, row_height = 222,
                   panel_height = 160, part_gap = 26;
  constexpr double panel_width = (width - margin - 20 - gap * (columns - 1)) / columns;

  std::string text =
      format("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f %.0f' width='%.0f' height='%.0f'>\n",
             width, height, width, height);
  text += style;
  text += "<rect width='100%' height='100%' fill='#fff'/>\n";
  text += label(
      24, 36,
      "Two gimbal motors: measured, as the thesis's program computes them, and with the constants corrected",
      "start", "title");
  text += "<circle class='measured' cx='32' cy='58' r='3.6'/>\n" + label(42, 62, "measured");
  text += "<line class='program' x1='124' y1='58' x2='158' y2='58'/>\n" + label(165, 62, "thesis program");
  text +=
      "<line class='corrected' x1='282' y1='58' x2='316' y2='58'/>\n" + label(323, 62, "corrected constants");
  text +=
      label(width - 20, 62,
            "a motor's temperature panels share their axis; both models start at the first measured point",
            "end", "small");

  int second_part = 1000;  // the row at which the second motor begins
  const auto place = [&](int row, int column, int span = 1) {
    Panel panel = {};
    panel.left = margin + column * (panel_width + gap);
    panel.top = first_top + row * row_height + (row >= second_part ? part_gap : 0.0);
    panel.width = span * panel_width + (span - 1) * gap;
    panel.height = panel_height;
    return panel;
  };

  int row = 0;
  for (const std::string motor : {"BGM2606-90T", "BGM5208-200-12"}) {
    if (row > 0) second_part = row;
    double hottest = 0.0;
    for (const Experiment& experiment : experiments)
      for (const Point& point : experiment.curve)
        if (!experiment.is_current() && experiment.motor == motor)
          hottest = std::max({hottest, point.program, point.corrected, point.measured});
    const double top_C = 10.0 * std::ceil(hottest / 10.0);
    text += label(24, place(row, 0).top - 27,
                  motor + (motor == "BGM2606-90T" ? " (roll and pitch)" : " (yaw)"), "start", "part");
    int column = 0;
    for (const std::string table : {"4.1", "4.2", "4.3", "4.6", "5.1", "5.2", "5.3", "5.4"}) {
      for (const Experiment& experiment : experiments) {
        if (experiment.motor != motor || experiment.table != table || experiment.is_current()) continue;
        Panel panel = place(row, column);
        panel.x_to = std::max(5.0, std::ceil(experiment.curve.back().x));
        panel.x_step = panel.x_to > 5.0 ? 2.0 : 1.0;
        panel.y_from = 20.0;
        panel.y_to = top_C;
        panel.y_step = 10.0;
        text += panel.axes(column == 0);
        if (experiment.kind == Experiment::Kind::protection)
          text += format("<line class='limit' x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f'/>\n", panel.left,
                         panel.y(60.0), panel.left + panel.width, panel.y(60.0));
        text +=
            panel.all(experiment) + label(panel.left, panel.top - 7, name_of(experiment), "start", "name");
        if (column == 0)
          text += label(
              0, 0, "motor / °C", "middle", "small",
              (format("transform='translate(%.1f %.1f) rotate(-90)'", 20.0, panel.top + panel.height / 2))
                  .c_str());
        text += label(panel.left + panel.width / 2, panel.top + panel.height + 27, "time / min", "middle",
                      "small");
        if (++column == columns) {
          column = 0;
          ++row;
        }
      }
    }
    // Every experiment's current in one panel, at the end of the last row.
    const int span = std::min(2, columns - column);
    Panel panel = place(row, column, span);
    panel.left += 26;
    panel.width -= 26;
    double largest = 0.0, warmest = 0.0;
    for (const Experiment& experiment : experiments)
      for (const Point& point : experiment.curve)
        if (experiment.is_current() && experiment.motor == motor) {
          largest = std::max({largest, point.measured, point.program, point.corrected});
          warmest = std::max(warmest, point.x);
        }
    panel.x_from = 20.0;
    panel.x_to = 10.0 * std::ceil(warmest / 10.0);
    panel.x_step = 10.0;
    panel.y_to = 200.0 * std::ceil(largest / 200.0);
    panel.y_step = 200.0;
    if (span > 0 && column > 0) {
      text += panel.axes(true);
      for (const Experiment& experiment : experiments)
        if (experiment.is_current() && experiment.motor == motor) text += panel.all(experiment);
      text += label(panel.left, panel.top - 7, "current, every power / mA", "start", "name");
      text +=
          label(panel.left + panel.width / 2, panel.top + panel.height + 27, "motor / °C", "middle", "small");
      ++row;
    }
  }
  return text + "</svg>\n";
}

}  // namespace thesis
