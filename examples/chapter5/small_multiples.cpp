// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "small_multiples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace figures {

namespace {

constexpr double panel_width = 330.0, panel_height = 215.0, plot_left = 52.0, plot_top = 30.0,
                 plot_width = 262.0, plot_height = 140.0, header = 70.0, margin = 14.0;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else out += c;
  }
  return out;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", std::fabs(value) < 1e-12 ? 0.0 : value);
  return text;
}

// A step of 1, 2 or 5 times a power of ten that makes four to eight ticks.
double tick_step(double span) {
  const double rough = span / 5.0, decade = std::pow(10.0, std::floor(std::log10(rough))),
               part = rough / decade;
  return decade * (part < 1.5 ? 1.0 : part < 3.5 ? 2.0 : part < 7.5 ? 5.0 : 10.0);
}

struct Range {
  double from = 1e300, to = -1e300;
  void take(double value) {
    if (!std::isfinite(value)) return;
    from = std::min(from, value);
    to = std::max(to, value);
  }
  void settle(double room) {
    if (from > to) from = 0.0, to = 1.0;
    if (to - from < 1e-9) from -= 0.5, to += 0.5;
    const double more = room * (to - from);
    from -= more, to += more;
  }
};

class Drawing {
public:
  Drawing(std::ostream& out, const Panel& panel, double left, double top)
      : out_(out), panel_(panel), left_(left), top_(top) {
    for (const Series& series : panel.series) {
      for (const double value : series.x) x_.take(value);
      for (const double value : series.y) y_.take(value);
    }
    x_.settle(0.0);
    if (panel.x_from != panel.x_to) x_.from = panel.x_from, x_.to = panel.x_to;
    if (panel.limit != 0.0) y_.take(panel.limit);
    y_.settle(0.06);
    if (panel.y_from != panel.y_to) y_.from = panel.y_from, y_.to = panel.y_to;
  }

  void draw(int number) {
    out_ << "<g transform='translate(" << left_ << ',' << top_ << ")'>\n<text x='" << plot_left
         << "' y='18' class='t'>" << escaped(panel_.title) << "</text>\n<clipPath id='c" << number
         << "'><rect x='" << plot_left - 4 << "' y='" << plot_top - 4 << "' width='" << plot_width + 8
         << "' height='" << plot_height + 8 << "'/></clipPath>\n";
    ticks();
    if (panel_.limit != 0.0)
      out_ << "<line class='m' x1='" << plot_left << "' x2='" << plot_left + plot_width << "' y1='"
           << at_y(panel_.limit) << "' y2='" << at_y(panel_.limit) << "'/>\n";
    out_ << "<g clip-path='url(#c" << number << ")'>\n";
    for (const Series& series : panel_.series) one(series);
    out_ << "</g>\n<text class='l' text-anchor='middle' x='" << plot_left + 0.5 * plot_width << "' y='"
         << plot_top + plot_height + 30 << "'>" << escaped(panel_.x_label)
         << "</text>\n<text class='l' text-anchor='middle' "
         << "transform='translate(13," << plot_top + 0.5 * plot_height << ") rotate(-90)'>"
         << escaped(panel_.y_label) << "</text>\n</g>\n";
  }

private:
  double at_x(double x) const { return plot_left + plot_width * (x - x_.from) / (x_.to - x_.from); }
  double at_y(double y) const { return plot_top + plot_height * (1.0 - (y - y_.from) / (y_.to - y_.from)); }

  void ticks() {
    const double x_step = tick_step(x_.to - x_.from), y_step = tick_step(y_.to - y_.from);
    for (double y = std::ceil(y_.from / y_step) * y_step; y <= y_.to + 1e-9 * y_step; y += y_step)
      out_ << "<line class='g' x1='" << plot_left << "' x2='" << plot_left + plot_width << "' y1='" << at_y(y)
           << "' y2='" << at_y(y) << "'/><text class='n' text-anchor='end' x='" << plot_left - 5 << "' y='"
           << at_y(y) + 3.5 << "'>" << short_number(y) << "</text>\n";
    for (double x = std::ceil(x_.from / x_step) * x_step; x <= x_.to + 1e-9 * x_step; x += x_step)
      out_ << "<text class='n' text-anchor='middle' x='" << at_x(x) << "' y='" << plot_top + plot_height + 14
           << "'>" << short_number(x) << "</text>\n";
  }

  void one(const Series& series) {
    const std::size_t count = std::min(series.x.size(), series.y.size());
    if (series.mark == Mark::dots) {
      for (std::size_t i = 0; i < count; ++i)
        if (std::isfinite(series.y[i]))
          out_ << "<circle cx='" << at_x(series.x[i]) << "' cy='" << at_y(series.y[i]) << "' r='3' fill='"
               << series.colour << "'/>\n";
      return;
    }
    out_ << "<path fill='none' stroke='" << series.colour << "' stroke-width='1.3'"
         << (series.mark == Mark::dashed ? " stroke-dasharray='5 3'" : "") << " d='";
    // At most the least and the largest of each half pixel, so that a long run stays a small file.
    const std::size_t chunk = std::max<std::size_t>(1, count / static_cast<std::size_t>(2.0 * plot_width));
    bool is_down = false;
    char text[48];
    const auto point = [&](std::size_t i) {
      if (!std::isfinite(series.y[i])) return static_cast<void>(is_down = false);
      const double y = std::clamp(at_y(series.y[i]), plot_top - 50.0, plot_top + plot_height + 50.0);
      std::snprintf(text, sizeof text, "%c%.1f %.1f", is_down ? 'L' : 'M', at_x(series.x[i]), y);
      out_ << text;
      is_down = true;
    };
    for (std::size_t begin = 0; begin < count; begin += chunk) {
      std::size_t least = begin, most = begin;
      for (std::size_t i = begin; i < std::min(count, begin + chunk); ++i) {
        if (series.y[i] < series.y[least]) least = i;
        if (series.y[i] > series.y[most]) most = i;
      }
      point(std::min(least, most));
      if (least != most) point(std::max(least, most));
    }
    out_ << "'/>\n";
  }

  std::ostream& out_;
  const Panel& panel_;
  double left_, top_;
  Range x_, y_;
};

void legend(std::ostream& out, const std::vector<Panel>& panels) {
  std::vector<const Series*> entries;
  for (const Panel& panel : panels)
    for (const Series& series : panel.series)
      if (std::none_of(entries.begin(), entries.end(),
                       [&](const Series* other) { return other->name == series.name; }))
        entries.push_back(&series);
  double x = margin + 6.0;
  for (const Series* entry : entries) {
    if (entry->mark == Mark::dots)
      out << "<circle cx='" << x + 10 << "' cy='52' r='3' fill='" << entry->colour << "'/>";
    else
      out << "<line x1='" << x << "' x2='" << x + 20 << "' y1='52' y2='52' stroke='" << entry->colour
          << "' stroke-width='2'" << (entry->mark == Mark::dashed ? " stroke-dasharray='5 3'" : "") << "/>";
    out << "<text class='l' x='" << x + 25 << "' y='56'>" << escaped(entry->name) << "</text>\n";
    x += 45.0 + 6.1 * static_cast<double>(entry->name.size());
  }
}

}  // namespace

void write_small_multiples(const std::string& path, const std::string& title,
                           const std::vector<Panel>& panels, int columns) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  const double width = 2 * margin + columns * panel_width, height = header + rows * panel_height + margin;
  std::ostringstream out;
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' viewBox='0 0 " << width << ' ' << height
      << "' "
         "font-family='Helvetica,Arial,sans-serif'>\n<style>.t{font-size:12.5px;font-weight:bold;fill:#"
         "1f2933}"
      << ".l{font-size:11px;fill:#3e4c59}.n{font-size:10px;fill:#616e7c}.g{stroke:#e4e7eb}.m{stroke:#c92a2a;"
         "stroke-dasharray:2 3}"
      << "</style>\n<rect width='100%' height='100%' fill='white'/>\n<text x='" << margin + 6
      << "' y='30' font-size='16' "
      << "font-weight='bold' fill='#1f2933'>" << escaped(title) << "</text>\n";
  legend(out, panels);
  for (std::size_t i = 0; i < panels.size(); ++i)
    Drawing(out, panels[i], margin + panel_width * static_cast<double>(static_cast<int>(i) % columns),
            header + panel_height * static_cast<double>(static_cast<int>(i) / columns))
        .draw(static_cast<int>(i));
  out << "</svg>\n";

  const std::string unfinished = path + ".part";
  std::ofstream file(unfinished, std::ios::binary);
  file << out.str();
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(unfinished, path, error);
  if (!file || error) {
    std::filesystem::remove(unfinished, error);
    throw std::runtime_error("cannot write " + path);
  }
}

}  // namespace figures
