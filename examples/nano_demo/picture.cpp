// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "trace.hpp"

namespace nano {
namespace {

constexpr double left = 78, panel_width = 392, gap = 26, top = 96;
constexpr double width = left + 3 * panel_width + 2 * gap + 24;
constexpr double height = 752;

struct Panel {
  double x, y, height;
  double low, high;  // of the quantity

  double at_time(double time_s) const { return x + panel_width * time_s / Story::end_s(); }
  double at(double value) const {
    return y + height * (1 - (std::clamp(value, low, high) - low) / (high - low));
  }
};

std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f", value);
  return buffer;
}

std::string text(double x, double y, const std::string& css, const std::string& content) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" class=\"" + css + "\">" + content +
         "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& css) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
         number(y2) + "\" class=\"" + css + "\"/>\n";
}

std::string box(double x, double y, double box_width, double box_height, const std::string& css) {
  return "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"" + number(box_width) +
         "\" height=\"" + number(box_height) + "\" class=\"" + css + "\"/>\n";
}

// Where the picture has fewer columns than there are points, each column keeps its first, least, greatest and
// last: no peak is lost.
std::string curve(const Panel& panel, const std::vector<Point>& points,
                  const std::function<double(const Point&)>& value, bool is_stepped, const std::string& css) {
  std::string path;
  double last_y = 0;
  std::string waiting;  // the last point of a flat stretch, which its first point already stands for
  const auto add = [&](const Point& point) {
    const double x = panel.at_time(point.time_s), y = panel.at(value(point));
    const std::string here = "L" + number(x) + " " + number(y);
    if (path.empty()) {
      path = "M" + number(x) + " " + number(y);
    } else if (std::fabs(y - last_y) < 0.05) {
      waiting = here;
      return;
    } else {
      path += waiting;
      if (is_stepped) path += "L" + number(x) + " " + number(last_y);
      path += here;
    }
    waiting.clear();
    last_y = y;
  };
  for (std::size_t index = 0; index < points.size();) {
    const double column = std::floor(panel.at_time(points[index].time_s));
    std::size_t end = index, least = index, greatest = index;
    for (; end < points.size() && std::floor(panel.at_time(points[end].time_s)) <= column; ++end) {
      if (value(points[end]) < value(points[least])) least = end;
      if (value(points[end]) > value(points[greatest])) greatest = end;
    }
    std::array<std::size_t, 4> kept = {index, least, greatest, end - 1};
    std::sort(kept.begin(), kept.end());
    for (std::size_t at = 0; at < kept.size(); ++at)
      if (at == 0 || kept[at] != kept[at - 1]) add(points[kept[at]]);
    index = end;
  }
  return "<path d=\"" + path + waiting + "\" class=\"" + css + "\"/>\n";
}

std::string frame(const Panel& panel, const std::vector<double>& ticks, bool has_labels, bool has_times) {
  std::string svg;
  for (std::size_t index = 0; index < Story::phases().size(); index += 2) {
    const Phase& phase = Story::phases()[index];
    svg += box(panel.at_time(phase.from_s), panel.y, panel.at_time(phase.to_s) - panel.at_time(phase.from_s),
               panel.height, "band");
  }
  for (const double tick : ticks) {
    svg += line(panel.x, panel.at(tick), panel.x + panel_width, panel.at(tick), "grid");
    char label[32];
    std::snprintf(label, sizeof label, "%g", tick);
    if (has_labels) svg += text(panel.x - 8, panel.at(tick) + 4, "tick end", label);
  }
  svg += box(panel.x, panel.y, panel_width, panel.height, "frame");
  for (double time_s = 0; has_times && time_s <= Story::end_s(); time_s += 10)
    svg +=
        text(panel.at_time(time_s), panel.y + panel.height + 17, "tick middle", std::to_string(int(time_s)));
  return svg;
}

const char* css_of(thermopower::LimitReason reason) {
  switch (reason) {
    case thermopower::LimitReason::none:
      return "granted";
    case thermopower::LimitReason::safety_temperature:
      return "safety";
    case thermopower::LimitReason::over_temperature:
      return "over";
    case thermopower::LimitReason::recovering:
      return "recovering";
    default:
      return "fault";
  }
}

// From the gravest, which lies at the bottom of the strip, to the mildest.
constexpr thermopower::LimitReason by_gravity[] = {
    thermopower::LimitReason::over_temperature, thermopower::LimitReason::safety_temperature,
    thermopower::LimitReason::recovering, thermopower::LimitReason::none};

// The limiter alternates faster than a picture can show: each column is divided by how often each reason was
// given in it.
std::string strip(const Panel& panel, const std::vector<Point>& points, std::size_t axis) {
  constexpr double column_s = 0.5;
  std::string svg = box(panel.x, panel.y, panel_width, panel.height, "fault");
  for (std::size_t index = 0; index < points.size();) {
    const double from_s = std::floor(points[index].time_s / column_s) * column_s;
    std::size_t end = index;
    while (end < points.size() && points[end].time_s < from_s + column_s) ++end;
    const double x = panel.at_time(from_s),
                 column_width = panel.at_time(std::min(from_s + column_s, Story::end_s())) - x;
    double bottom = panel.y + panel.height;
    for (const thermopower::LimitReason reason : by_gravity) {
      const auto given =
          std::count_if(points.begin() + std::ptrdiff_t(index), points.begin() + std::ptrdiff_t(end),
                        [&](const Point& point) { return point.axes[axis].reason == reason; });
      const double part = panel.height * double(given) / double(end - index);
      if (given > 0) svg += box(x, bottom - part, column_width, part, css_of(reason));
      bottom -= part;
    }
    index = end;
  }
  return svg;
}

constexpr const char* style =
    "<style>text{font-family:'Helvetica "
    "Neue',Helvetica,Arial,sans-serif;fill:#222}.title{font-size:19px;font-weight:600}"
    ".sub{font-size:12.5px;fill:#555}.axis{font-size:15px;font-weight:600}.tick{font-size:11.5px;fill:#555}."
    "end{text-anchor:end}"
    ".middle{text-anchor:middle}.label{font-size:12.5px}.frame{fill:none;stroke:#888}.grid{stroke:#e2e2e2}."
    "band{fill:#f5f6f8}"
    ".error{fill:none;stroke:#4a5568;stroke-width:1.1}.demand{fill:none;stroke:#7f8fa9;stroke-width:1.1;"
    "stroke-dasharray:3 2}"
    ".power{fill:none;stroke:#1f5fa8;stroke-width:1.5}.estimate{fill:none;stroke:#c4441c;stroke-width:2}"
    ".true{fill:none;stroke:#222;stroke-width:1.3;stroke-dasharray:5 "
    "3}.limit{stroke:#a3123a;stroke-width:1.2;stroke-dasharray:2 3}"
    ".granted{fill:#d9e6dc}.safety{fill:#f0a432}.over{fill:#a3123a}.recovering{fill:#5aa0d0}.fault{fill:#444}"
    ".granted,.safety,.over,.recovering{shape-rendering:crispEdges}</style>\n";

}  // namespace

std::string Trace::svg() const {
  const std::string size = " width=\"" + number(width) + "\" height=\"" + number(height) + "\"";
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + size + " viewBox=\"0 0 " + number(width) +
                    " " + number(height) + "\">\n";
  svg += style;
  svg += "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  svg += text(left, 32, "title",
              "nano_gimbal on a simulated ATmega328P, talking to an emulated SimpleBGC board");
  std::string phases = "Phases (shaded alternately): ";
  for (const Phase& phase : Story::phases()) {
    if (&phase != &Story::phases().front()) phases += ", ";
    phases += std::string(phase.name) + " to " + std::to_string(int(phase.to_s)) + " s";
  }
  svg += text(left, 52, "sub", phases + ".");

  constexpr const char* names[] = {"Roll (BGM2606-90T)", "Pitch (BGM2606-90T)", "Yaw (BGM5208-200-12)"};
  double hottest_C = 62, coldest_C = 1e9;
  for (const Point& point : points)
    for (const AxisPoint& axis : point.axes) {
      hottest_C = std::max({hottest_C, axis.estimate_C + 2, axis.true_C + 2});
      coldest_C = std::min({coldest_C, axis.estimate_C, axis.true_C});
    }
  coldest_C = std::floor(coldest_C / 10) * 10;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = left + double(axis) * (panel_width + gap);
    const bool is_first = axis == 0;
    svg += text(x, top - 14, "axis", names[axis]);

    const Panel error = {x, top, 110, -2.5, 2.5};
    svg += frame(error, {-2, -1, 0, 1, 2}, is_first, false);
    svg += curve(
        error, points, [axis](const Point& point) { return point.axes[axis].error_deg; }, false, "error");
    if (axis == 2)
      svg += text(error.x + panel_width - 6, error.y + error.height - 8, "tick end",
                  "off the scale: to 180 and back");

    const Panel power = {x, top + 136, 130, 0, 260};
    svg += frame(power, {0, 50, 100, 150, 200, 250}, is_first, false);
    svg += curve(
        power, points, [axis](const Point& point) { return double(point.axes[axis].demand); }, true,
        "demand");
    svg += curve(
        power, points, [axis](const Point& point) { return double(point.axes[axis].power); }, true, "power");

    const Panel warmth = {x, top + 292, 170, coldest_C, hottest_C};
    std::vector<double> ticks;
    for (double tick = coldest_C; tick <= hottest_C; tick += 5) ticks.push_back(tick);
    svg += frame(warmth, ticks, is_first, false);
    svg += line(x, warmth.at(60), x + panel_width, warmth.at(60), "limit");
    svg += curve(
        warmth, points, [axis](const Point& point) { return point.axes[axis].true_C; }, false, "true");
    svg += curve(
        warmth, points, [axis](const Point& point) { return point.axes[axis].estimate_C; }, false,
        "estimate");

    const Panel reason = {x, top + 488, 26, 0, 1};
    svg += frame(reason, {}, false, true) + strip(reason, points, axis);
    svg += text(x + panel_width / 2, reason.y + 62, "label middle", "time / s");
  }
  const auto vertical = [&](double y, const std::string& label) {
    svg += "<text transform=\"translate(26 " + number(y) + ") rotate(-90)\" class=\"label middle\">" + label +
           "</text>\n";
  };
  vertical(top + 55, "error / deg");
  vertical(top + 201, "POWER / count");
  vertical(top + 377, "motor / degC");
  svg += text(left - 8, top + 505, "label end", "reasons");

  double x = left;
  double y = height - 60;
  const auto key = [&](const std::string& css, bool is_area, const std::string& label, double length) {
    svg += is_area ? box(x, y - 10, 18, 12, css)
                   : "<path d=\"M" + number(x) + " " + number(y - 4) + "h22\" class=\"" + css + "\"/>\n";
    svg += text(x + 27, y, "label", label);
    x += length;
  };
  key("demand", false, "asked for", 104);
  key("power", false, "granted", 96);
  key("estimate", false, "estimate of the chip", 168);
  key("true", false, "true (corrected laws)", 172);
  key("limit", false, "limit 60 degC", 128);
  x = left;
  y = height - 32;
  key("granted", true, "demand granted", 150);
  key("safety", true, "heating too fast: ceiling falls", 236);
  key("over", true, "above the limit: cut", 178);
  key("recovering", true, "ceiling recovers", 150);
  key("fault", true, "fault: least power", 100);
  return svg + "</svg>\n";
}

}  // namespace nano
