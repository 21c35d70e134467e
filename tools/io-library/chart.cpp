// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "chart.hpp"

#include "html_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace thermopower::io {
namespace {

// Per picture, or where only a part is shown at first, for that part and for the rest each.
constexpr int thinning_columns = 300;
// Points further out than this many heights of the picture are drawn there: nobody sees them.
constexpr double far_out = 1000.0;

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
  bool holds(double value) const { return value >= from && value <= to; }
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

// A power of ten, or 2 or 5 times one, of which the axis shows the logarithm.
std::string decade_text(double logarithm) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g", std::pow(10.0, logarithm));
  return text;
}

std::string exact(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string share(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f%%", 100.0 * value);
  return text;
}

/// A path in whole numbers: "M" absolute, then "l" with differences; two numbers need no blank where the second
/// has a minus.
class Path {
public:
  void move(long x, long y) {
    text_ += "M" + std::to_string(x) + " " + std::to_string(y);
    drawn_ = false;
    x_ = x, y_ = y;
  }
  void line(long x, long y) {
    if (x == x_ && y == y_ && drawn_) return;
    text_ += drawn_ ? "" : "l";
    if (drawn_ && x - x_ >= 0) text_ += " ";
    text_ += std::to_string(x - x_);
    if (y - y_ >= 0) text_ += " ";
    text_ += std::to_string(y - y_);
    drawn_ = true;
    x_ = x, y_ = y;
  }
  const std::string& text() const { return text_; }

private:
  std::string text_;
  long x_ = 0, y_ = 0;
  bool drawn_ = false;
};

class Drawing {
public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    for (const auto& series : chart.series)
      for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i)
        if (std::isfinite(series.y[i])) x_.include(series.x[i]);
    x_.settle();
    // Points at the ends are whole.
    if (std::any_of(chart.series.begin(), chart.series.end(),
                    [](const Series& one) { return one.style == Series::Style::points; }))
      x_.widen(0.02);
    view_ = x_;
    if (chart.view && chart.view->second > chart.view->first) {
      view_.from = std::max(x_.from, chart.view->first);
      view_.to = std::min(x_.to, chart.view->second);
      if (!(view_.to > view_.from)) view_ = x_;
    }
    for (const auto& series : chart.series) {
      for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
        if (!view_.holds(series.x[i])) continue;
        y_.include(series.y[i]);
        if (i < series.low.size()) y_.include(series.low[i]);
        if (i < series.high.size()) y_.include(series.high[i]);
      }
    }
    if (chart.zero_line) y_.include(0.0);
    if (chart.band > 0.0) {
      y_.include(chart.band);
      y_.include(-chart.band);
    }
    y_.settle();
    y_.widen(0.06);
  }

  std::string draw() const {
    std::string out = "<div class=\"chart\" data-x=\"" + exact(x_.from) + " " + exact(x_.to) +
                      "\" data-y=\"" + exact(y_.from) + " " + exact(y_.to) + "\"";
    if (!chart_.group.empty())
      out += " data-group=\"" + escaped(chart_.group) + "\" data-view=\"" + exact(view_.from) + " " +
             exact(view_.to) + "\"";
    if (chart_.zero_line) out += " data-zero";
    if (chart_.logarithmic) out += " data-log";
    out += ">\n";
    legend(out);
    out += "<div class=\"plot\" style=\"height:" + std::to_string(chart_.height) + "px\"><svg viewBox=\"" +
           std::to_string(px(view_.from)) + " 0 " + std::to_string(px(view_.to) - px(view_.from)) + " " +
           std::to_string(chart_rows) + "\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"" +
           escaped(chart_.title) + "\">\n";
    backdrop(out);
    for (const auto& series : chart_.series) {
      if (series.style == Series::Style::line || series.style == Series::Style::steps) line(out, series);
      if (series.style == Series::Style::points) points(out, series);
      if (series.style == Series::Style::interval) intervals(out, series);
    }
    out += "</svg>";
    ticks(out);
    out += "</div>\n<div class=\"xl\">" + escaped(chart_.x_label) + "</div></div>\n";
    return out;
  }

private:
  long px(double x) const {
    return std::lround((x - x_.from) / (x_.to - x_.from) * static_cast<double>(chart_columns));
  }
  long py(double y) const {
    const double from_top = std::clamp((y_.to - y) / (y_.to - y_.from), -far_out, far_out);
    return std::lround(from_top * static_cast<double>(chart_rows));
  }

  static std::string rectangle(const char* role, long x, long y, long width, long height) {
    return std::string("<rect class=\"") + role + "\" x=\"" + std::to_string(x) + "\" y=\"" +
           std::to_string(y) + "\" width=\"" + std::to_string(width) + "\" height=\"" +
           std::to_string(height) + "\"/>\n";
  }

  // Zoomed in y, the picture grows: what spans its height spans far more.
  void backdrop(std::string& out) const {
    const long far = static_cast<long>(far_out) * chart_rows;
    if (chart_.shade && chart_.shade->second > chart_.shade->first) {
      const long from = px(std::max(chart_.shade->first, x_.from)),
                 to = px(std::min(chart_.shade->second, x_.to));
      if (to > from) out += rectangle("shade", from, -far, to - from, 2 * far);
    }
    if (chart_.band > 0.0)
      out += rectangle("band", 0, py(chart_.band), chart_columns, py(-chart_.band) - py(chart_.band));
    if (chart_.zero_line)
      out += "<path class=\"zero\" d=\"M0 " + std::to_string(py(0.0)) + "h" + std::to_string(chart_columns) +
             "\"/>\n";
    if (chart_.mark && x_.holds(*chart_.mark))
      out += "<path class=\"from\" d=\"M" + std::to_string(px(*chart_.mark)) + " " + std::to_string(-far) +
             "v" + std::to_string(2 * far) + "\"/>\n";
  }

  // Places and words of about so many ticks.
  std::vector<std::pair<double, std::string>> ticks_of(const Range& range, int about) const {
    std::vector<std::pair<double, std::string>> list;
    if (chart_.logarithmic) {
      const double decades = std::max(1.0, std::ceil((range.to - range.from) / about));
      const bool between = range.to - range.from < 2.0;
      for (double whole = std::floor(range.from / decades) * decades; whole <= range.to; whole += decades)
        for (const double factor : {1.0, 2.0, 5.0}) {
          const double at = whole + std::log10(factor);
          if ((factor == 1.0 || between) && range.holds(at)) list.emplace_back(at, decade_text(at));
        }
      return list;
    }
    // One tick tells no scale.
    for (int finer = about; list.size() < 2 && finer < 4 * about; ++finer) {
      const double step = tick_step(range.to - range.from, finer);
      list.clear();
      for (double at = std::ceil(range.from / step) * step; at <= range.to + 1e-9 * step; at += step)
        list.emplace_back(at, tick_text(at, step));
    }
    return list;
  }

  void ticks(std::string& out) const {
    for (const auto& [x, text] : ticks_of(view_, 6))
      out += "<i class=\"gx\" style=\"left:" + share((x - view_.from) / (view_.to - view_.from)) + "\"><b>" +
             text + "</b></i>";
    for (const auto& [y, text] : ticks_of(y_, std::max(3, chart_.height / 36)))
      out += "<i class=\"gy\" style=\"top:" + share((y_.to - y) / (y_.to - y_.from)) + "\"><b>" + text +
             "</b></i>";
  }

  // Finer where the picture begins, coarser elsewhere.
  long column_of(double x) const {
    const bool part = view_.from > x_.from || view_.to < x_.to;
    const double columns = part ? thinning_columns : 2 * thinning_columns;
    if (!part || view_.holds(x))
      return std::lround(std::floor((x - view_.from) / (view_.to - view_.from) * columns));
    const long coarse = std::lround(std::floor((x - x_.from) / (x_.to - x_.from) * columns));
    return (x < view_.from ? -10 : 10) * thinning_columns + coarse;
  }

  // Per pixel column the first, least, greatest and last value: the drawn line cannot be told from the full
  // one.
  void line(std::string& out, const Series& series) const {
    const std::size_t n = std::min(series.x.size(), series.y.size());
    Path path;
    bool pen_down = false;
    long last_y = 0;
    const auto emit = [&](std::size_t i) {
      const long x = px(series.x[i]), y = py(series.y[i]);
      if (!pen_down) path.move(x, y);
      else {
        if (series.style == Series::Style::steps && y != last_y) path.line(x, last_y);
        path.line(x, y);
      }
      last_y = y;
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
      const long column = column_of(series.x[i]);
      std::size_t low = i, high = i, last = i, j = i;
      while (j < n && std::isfinite(series.y[j]) && (j == i || series.x[j] >= series.x[j - 1]) &&
             column_of(series.x[j]) == column) {
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
    out += "<path class=\"curve " + series.role + "\" d=\"" + path.text() + "\"/>\n";
  }

  // Lines of no length with round ends are dots that stay round however the picture is stretched.
  void points(std::string& out, const Series& series) const {
    const std::size_t n = std::min(series.x.size(), series.y.size());
    const std::size_t stride = n / 1500 + 1;
    out += "<path class=\"dots " + series.role + "\" d=\"";
    for (std::size_t i = 0; i < n; i += stride) {
      if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) continue;
      out += "M" + std::to_string(px(series.x[i])) + " " + std::to_string(py(series.y[i])) + "h0";
    }
    out += "\"/>\n";
  }

  void intervals(std::string& out, const Series& series) const {
    out += "<path class=\"bars " + series.role + "\" d=\"";
    for (std::size_t i = 0; i < series.x.size() && i < series.low.size() && i < series.high.size(); ++i) {
      if (!std::isfinite(series.low[i]) || !std::isfinite(series.high[i])) continue;
      out += "M" + std::to_string(px(series.x[i])) + " " + std::to_string(py(series.low[i])) + "V" +
             std::to_string(py(series.high[i]));
    }
    out += "\"/>\n";
  }

  void legend(std::string& out) const {
    out += "<div class=\"keys\"><span class=\"yl\">" + escaped(chart_.y_label) + "</span>";
    for (const auto& series : chart_.series) {
      if (series.label.empty()) continue;
      const bool dots = series.style == Series::Style::points;
      out += "<span class=\"key\" data-role=\"" + series.role +
             "\"><svg viewBox=\"0 0 24 8\"><path class=\"" + (dots ? "dots " : "curve ") + series.role +
             "\" d=\"" + (dots ? "M12 4h0" : "M1 4h22") + "\"/></svg>" + escaped(series.label) + "</span>";
    }
    if (chart_.band > 0.0) out += "<span class=\"key\"><i class=\"bandkey\"></i>noise floor</span>";
    out += "</div>\n";
  }

  const Chart& chart_;
  Range x_, y_, view_;
};

}  // namespace

std::string to_html(const Chart& chart) {
  if (!chart.logarithmic) return Drawing(chart).draw();
  Chart in_decades = chart;
  const auto decades = [](double value) {
    return value > 0.0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
  };
  for (Series& series : in_decades.series)
    for (auto* values : {&series.x, &series.y, &series.low, &series.high})
      std::transform(values->begin(), values->end(), values->begin(), decades);
  return Drawing(in_decades).draw();
}

}  // namespace thermopower::io
