// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/design_files.hpp>

#include <thermopower/io/summary.hpp>

#include "chart.hpp"
#include "html_text.hpp"
#include "report_script.hpp"
#include "report_style.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace thermopower::io {
namespace {

using design::Design;
using design::Ending;
using design::ExplanationClass;
using design::Limits;
using design::VariedInput;

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value == 0.0 ? 0.0 : value);
  return text;
}

// Rows a second seldom divide evenly into binary numbers; a microsecond is finer than any player's clock.
std::string stamp(double t_s) {
  char text[40];
  int length = std::snprintf(text, sizeof text, "%.6f", t_s);
  while (text[length - 1] == '0') --length;
  if (text[length - 1] == '.') --length;
  return std::string(text, static_cast<std::size_t>(length));
}

std::vector<double> list(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

const char* const roles[] = {"augmented", "baseline", "recalibrated", "rival3", "measured", "noise"};

std::string html_of(const Chart& chart) { return to_html(chart); }

}  // namespace

std::string schedule_csv(const Design& design) {
  std::string out = "t_s";
  for (const Column& one : design.schedule.columns) out += "," + one.name;
  out += "\n";
  for (Eigen::Index row = 0; row < design.schedule.rows(); ++row) {
    out += stamp(design.schedule.t_s[row]);
    for (const Column& one : design.schedule.columns) out += "," + number(one.values[row], 6);
    out += "\n";
  }
  return out;
}

std::string schedule_header(const Design& design, const Limits& limits) {
  std::vector<const Column*> played;
  for (const Column& one : design.schedule.columns)
    if (const VariedInput* input = limits.varied(one.name); input != nullptr && !input->once)
      played.push_back(&one);
  constexpr double largest = 32767.0;
  std::string out =
      "/* The next experiment, written by thermopower-gap design. An input holds its value until the next row:\n"
      "   value = schedule_values[row][input] * schedule_unit[input]. Inputs, in their order:";
  for (const Column* const one : played) out += " " + one->name;
  for (const VariedInput& input : limits.vary)
    if (input.once)
      out += "\n   Before the start: " + input.column + " = " +
             number(design.schedule.column(input.column)[0], 4);
  out +=
      ". */\n#pragma once\n#include <stdint.h>\n#ifdef __AVR__\n#include <avr/pgmspace.h>\n#endif\n#ifndef PROGMEM\n"
      "#define PROGMEM\n#endif\n\n";
  const auto rows = static_cast<long>(design.schedule.rows());
  out += "enum { schedule_rows = " + std::to_string(rows) +
         ", schedule_inputs = " + std::to_string(played.size()) + " };\n";
  out += "static const float schedule_row_s = " + number(limits.row_s, 7) +
         (limits.row_s == std::floor(limits.row_s) ? ".0f" : "f") + ";\n";
  out += "static const char* const schedule_names[] = {";
  for (std::size_t i = 0; i < played.size(); ++i) out += (i == 0 ? "\"" : ", \"") + played[i]->name + "\"";
  out += "};\nstatic const float schedule_unit[] = {";
  std::vector<double> unit;
  for (std::size_t i = 0; i < played.size(); ++i) {
    const double most = played[i]->values.cwiseAbs().maxCoeff();
    unit.push_back(most > 0.0 ? most / largest : 1.0);
    char text[40];
    std::snprintf(text, sizeof text, "%.8ef", unit.back());
    out += (i == 0 ? "" : ", ") + std::string(text);
  }
  out += "};\nstatic const int16_t schedule_values[][" + std::to_string(played.size()) + "] PROGMEM = {\n";
  for (long row = 0; row < rows; ++row) {
    out += "{";
    for (std::size_t i = 0; i < played.size(); ++i)
      out += (i == 0 ? "" : ", ") + std::to_string(std::lround(played[i]->values[row] / unit[i]));
    out += row + 1 == rows ? "}\n" : row % 8 == 7 ? "},\n" : "}, ";
  }
  return out + "};\n";
}

std::string design_summary(const Design& design, const Limits& limits) {
  std::string out;
  switch (design.ending) {
    case Ending::schedule:
      out = "NEXT EXPERIMENT\n";
      break;
    case Ending::enough:
      out = "ENOUGH\n";
      break;
    case Ending::none_of_these:
      out = "NONE OF THESE\n";
      break;
    case Ending::cannot_decide:
    case Ending::nothing_possible:
      out = "CANNOT DECIDE\n";
      break;
  }
  out += summary_line("", design.sentence);
  for (const ExplanationClass& one : design.classes)
    out += summary_line(&one == &design.classes.front() ? "classes" : "",
                        design::two_digits(one.probability) + "  " + one.name());
  if (design.ending == Ending::schedule)
    for (const VariedInput& input : limits.vary)
      if (input.once)
        out += summary_line("before", "set " + input.column + " to " +
                                          number(design.schedule.column(input.column)[0], 4) +
                                          " before the start");
  return out;
}

std::string design_html(const Design& design, const Limits& limits, const std::string& title) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Next experiment: " +
      escaped(title) +
      "</title>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>" +
      report_style + "</style>\n</head>\n<body>\n<main>\n<div class=\"eyebrow\">Next experiment</div>\n<h1>" +
      escaped(title.empty() ? std::string("model") : title) + "</h1>\n<p class=\"lead\">" +
      escaped(design.sentence) + "</p>\n";
  out += "<table><tr><th class=\"t\">class</th><th>probability so far</th></tr>\n";
  for (const ExplanationClass& one : design.classes)
    out += "<tr><td class=\"t\">" + escaped(one.name()) + "</td><td>" + design::two_digits(one.probability) +
           "</td></tr>\n";
  out += "</table>\n";
  if (design.ending == Ending::schedule) {
    out += "<h2>What is played</h2>\n";
    for (const VariedInput& input : limits.vary) {
      Chart chart;
      const VariableText words = variable_text(input.column);
      chart.title = words.text;
      chart.x_label = "time / s";
      chart.y_label = axis_label(words);
      chart.group = "time";
      chart.height = 140;
      chart.series.push_back({"",
                              "input",
                              Series::Style::steps,
                              list(design.schedule.t_s),
                              list(design.schedule.column(input.column)),
                              {},
                              {}});
      out += html_of(chart);
    }
    out +=
        "<h2>What each class predicts</h2>\n<p>The curves are those of the fits. Thin lines enclose nine of ten draws of the "
        "parameters that are still possible. Where the curves are apart and the lines do not overlap, the experiment decides.</p>\n";
    for (std::size_t s = 0; !design.classes.empty() && s < design.classes.front().predicted.size(); ++s) {
      const auto& first = design.classes.front().predicted[s];
      Chart chart;
      const VariableText words = variable_text(plant::to_string(first.signal));
      chart.title = words.text;
      chart.x_label = "time / s";
      chart.y_label = axis_label(words);
      chart.group = "time";
      std::size_t shown = 0;
      for (const ExplanationClass& one : design.classes) {
        if (s >= one.predicted.size() || shown == std::size(roles)) continue;
        const std::string role = roles[shown++];
        const std::vector<double> t_s = list(design.schedule.t_s);
        chart.series.push_back(
            {one.name(), role, Series::Style::line, t_s, list(one.predicted[s].middle), {}, {}});
        chart.series.push_back({"", role, Series::Style::line, t_s, list(one.predicted[s].low), {}, {}});
        chart.series.push_back({"", role, Series::Style::line, t_s, list(one.predicted[s].high), {}, {}});
      }
      out += html_of(chart);
    }
  }
  return out + "</main>\n<script>" + report_script + "</script>\n</body>\n</html>\n";
}

}  // namespace thermopower::io
