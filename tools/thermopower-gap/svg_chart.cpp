// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace thermopower::gap::files {
namespace {

struct Range {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();

  void include(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  // A flat or empty range still needs an axis.
  void settle() {
    if (!(from <= to)) {
      from = 0.0;
      to = 1.0;
    }
    if (!(to - from > 1e-9 * std::max(std::fabs(from), std::fabs(to)))) {
      const double half = std::max(0.5 * std::fabs(from) * 0.1, 0.5);
      from -= half;
      to += half;
    }
  }
  void widen(double share) {
    const double margin = share * (to - from);
    from -= margin;
    to += margin;
  }
};

double tick_step(double span, int about) {
  const double rough = span / about;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

std::string tick_text(double value, double step) {
  if (std::fabs(value) < 1e-9 * step) value = 0.0;
  char text[48];
  if (std::max(std::fabs(value), step) >= 1e6 || step < 1e-5) {
    std::snprintf(text, sizeof text, "%.3g", value);
  } else {
    const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  }
  return std::string(text[0] == '-' ? "\u2212" : "") + (text[0] == '-' ? text + 1 : text);
}

class Canvas {
public:
  explicit Canvas(const Chart& chart) : chart_(chart) {
    for (const auto& series : chart.series) {
      for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        if (!std::isfinite(series.y[i])) continue;
        x_.include(series.x[i]);
        y_.include(series.y[i]);
      }
      for (const double value : series.low) y_.include(value);
      for (const double value : series.high) y_.include(value);
    }
    x_.settle();
    if (chart.zero_line) y_.include(0.0);
    y_.settle();
    y_.widen(0.06);
    right_ = chart.width - 14;
    bottom_ = chart.height - 42;
  }

  std::string draw() {
    std::string out;
    out.reserve(1 << 16);
    out += "<svg viewBox=\"0 0 " + std::to_string(chart_.width) + " " + std::to_string(chart_.height) +
           "\" role=\"img\" aria-label=\"" + escaped(chart_.title) + "\">\n";
    shade(out);
    grid(out);
    for (const auto& series : chart_.series) {
      if (series.style == Series::Style::line) line(out, series);
      if (series.style == Series::Style::points) points(out, series);
      if (series.style == Series::Style::interval) intervals(out, series);
    }
    legend(out);
    out += "</svg>\n";
    return out;
  }

private:
  double px(double x) const { return left_ + (x - x_.from) / (x_.to - x_.from) * (right_ - left_); }
  double py(double y) const { return bottom_ - (y - y_.from) / (y_.to - y_.from) * (bottom_ - top_); }

  static std::string at(double value) {
    char text[24];
    std::snprintf(text, sizeof text, "%.1f", value);
    return text;
  }

  void shade(std::string& out) const {
    if (!(chart_.shade_to > chart_.shade_from)) return;
    const double from = std::max(px(chart_.shade_from), left_), to = std::min(px(chart_.shade_to), right_);
    if (to - from < 1.0) return;
    out += "<rect class=\"shade\" x=\"" + at(from) + "\" y=\"" + at(top_) + "\" width=\"" + at(to - from) +
           "\" height=\"" + at(bottom_ - top_) + "\"/>\n";
  }

  void grid(std::string& out) const {
    const double y_step = tick_step(y_.to - y_.from, 5);
    for (double y = std::ceil(y_.from / y_step) * y_step; y <= y_.to + 1e-9 * y_step; y += y_step) {
      out += "<line class=\"grid\" x1=\"" + at(left_) + "\" x2=\"" + at(right_) + "\" y1=\"" + at(py(y)) +
             "\" y2=\"" + at(py(y)) + "\"/><text class=\"tick\" text-anchor=\"end\" x=\"" + at(left_ - 8) +
             "\" y=\"" + at(py(y) + 4) + "\">" + tick_text(y, y_step) + "</text>\n";
    }
    const double x_step = tick_step(x_.to - x_.from, 8);
    for (double x = std::ceil(x_.from / x_step) * x_step; x <= x_.to + 1e-9 * x_step; x += x_step) {
      out += "<line class=\"mark\" x1=\"" + at(px(x)) + "\" x2=\"" + at(px(x)) + "\" y1=\"" + at(bottom_) +
             "\" y2=\"" + at(bottom_ + 5) + "\"/><text class=\"tick\" text-anchor=\"middle\" x=\"" +
             at(px(x)) + "\" y=\"" + at(bottom_ + 19) + "\">" + tick_text(x, x_step) + "</text>\n";
    }
    if (chart_.zero_line) {
      out += "<line class=\"axis\" x1=\"" + at(left_) + "\" x2=\"" + at(right_) + "\" y1=\"" + at(py(0.0)) +
             "\" y2=\"" + at(py(0.0)) + "\"/>\n";
    }
    out += "<line class=\"axis\" x1=\"" + at(left_) + "\" x2=\"" + at(right_) + "\" y1=\"" + at(bottom_) +
           "\" y2=\"" + at(bottom_) + "\"/>\n";
    out += "<text class=\"label\" text-anchor=\"end\" x=\"" + at(right_) + "\" y=\"" + at(bottom_ + 36) +
           "\">" + escaped(chart_.x_label) + "</text>\n<text class=\"label\" x=\"2\" y=\"13\">" +
           escaped(chart_.y_label) + "</text>\n";
  }

  // Per pixel column the first, least, greatest and last value: the drawn line cannot be told from the full
  // one.
  void line(std::string& out, const Series& series) const {
    const std::size_t n = std::min(series.x.size(), series.y.size());
    const int columns = static_cast<int>(right_ - left_) / 2;
    std::string path;
    bool pen_down = false;
    const auto emit = [&](std::size_t i) {
      path += (pen_down ? "L" : "M") + at(px(series.x[i])) + " " + at(py(series.y[i]));
      pen_down = true;
    };
    std::size_t i = 0;
    while (i < n) {
      if (!std::isfinite(series.y[i]) || !std::isfinite(series.x[i])) {
        pen_down = false;
        ++i;
        continue;
      }
      if (i > 0 && series.x[i] < series.x[i - 1]) pen_down = false;  // another run begins
      const int column = static_cast<int>((series.x[i] - x_.from) / (x_.to - x_.from) * columns);
      std::size_t low = i, high = i, last = i, j = i;
      while (j < n && std::isfinite(series.y[j]) && (j == i || series.x[j] >= series.x[j - 1]) &&
             static_cast<int>((series.x[j] - x_.from) / (x_.to - x_.from) * columns) == column) {
        if (series.y[j] < series.y[low]) low = j;
        if (series.y[j] > series.y[high]) high = j;
        last = j++;
      }
      std::size_t order[4] = {i, std::min(low, high), std::max(low, high), last};
      for (int k = 0; k < 4; ++k) {
        if (k == 0 || order[k] != order[k - 1]) emit(order[k]);
      }
      i = j;
    }
    out += "<path class=\"curve " + series.role + "\" d=\"" + path + "\"/>\n";
  }

  void points(std::string& out, const Series& series) const {
    const std::size_t n = std::min(series.x.size(), series.y.size());
    const std::size_t stride = n / 1500 + 1;
    out += "<g class=\"dots " + series.role + "\">";
    for (std::size_t i = 0; i < n; i += stride) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      out += "<circle cx=\"" + at(px(series.x[i])) + "\" cy=\"" + at(py(series.y[i])) + "\" r=\"3\"/>";
    }
    out += "</g>\n";
  }

  void intervals(std::string& out, const Series& series) const {
    out += "<g class=\"bars " + series.role + "\">";
    for (std::size_t i = 0; i < series.x.size() && i < series.low.size() && i < series.high.size(); ++i) {
      if (!std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) continue;
      out += "<line x1=\"" + at(px(series.x[i])) + "\" x2=\"" + at(px(series.x[i])) + "\" y1=\"" +
             at(py(series.low[i])) + "\" y2=\"" + at(py(series.high[i])) + "\"/>";
    }
    out += "</g>\n";
  }

  void legend(std::string& out) const {
    double x = right_;
    for (auto series = chart_.series.rbegin(); series != chart_.series.rend(); ++series) {
      if (series->label.empty()) continue;
      x -= 7.0 * static_cast<double>(series->label.size());
      out += "<text class=\"key\" x=\"" + at(x) + "\" y=\"13\">" + escaped(series->label) + "</text>";
      x -= 28.0;
      if (series->style == Series::Style::line) {
        out += "<line class=\"curve " + series->role + "\" x1=\"" + at(x) + "\" x2=\"" + at(x + 22) +
               "\" y1=\"9\" y2=\"9\"/>\n";
      } else {
        out += "<g class=\"dots " + series->role + "\"><circle cx=\"" + at(x + 14) +
               "\" cy=\"9\" r=\"3.2\"/></g>\n";
      }
      x -= 16.0;
    }
  }

  const Chart& chart_;
  Range x_, y_;
  double left_ = 58.0, top_ = 26.0, right_ = 0.0, bottom_ = 0.0;
};

}  // namespace

std::string to_svg(const Chart& chart) { return Canvas(chart).draw(); }

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size() + 16);
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char byte = static_cast<unsigned char>(text[i]);
    std::size_t length = byte < 0x80                   ? 1
                         : byte >= 0xc2 && byte < 0xe0 ? 2
                         : byte >= 0xe0 && byte < 0xf0 ? 3
                         : byte >= 0xf0 && byte < 0xf5 ? 4
                                                       : 0;
    for (std::size_t k = 1; k < length; ++k) {
      if (i + k >= text.size() || (static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) length = 0;
    }
    if (length == 0 || (byte < 0x20 && byte != '\n' && byte != '\t')) {
      out += "\uFFFD";
      ++i;
      continue;
    }
    if (length > 1) {
      out.append(text, i, length);
    } else if (byte == '&') {
      out += "&amp;";
    } else if (byte == '<') {
      out += "&lt;";
    } else if (byte == '>') {
      out += "&gt;";
    } else if (byte == '"') {
      out += "&quot;";
    } else {
      out += static_cast<char>(byte);
    }
    i += length;
  }
  return out;
}

std::string readable(double value, int digits) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::fabs(value);
  char text[48];
  if (size != 0.0 && (size < 1e-3 || size >= 1e5)) {
    std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  } else {
    const int decimals =
        size == 0.0 ? 0 : std::max(0, digits - 1 - static_cast<int>(std::floor(std::log10(size))));
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
  }
  return text;
}

}  // namespace thermopower::gap::files
