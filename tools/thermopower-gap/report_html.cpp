// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "report_html.hpp"

#include "report_style.hpp"
#include "svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thermopower::gap::files {
namespace {

std::string unit_text(const std::string& unit) {
  if (unit == "degC") return "\u00b0C";
  if (unit == "deg") return "\u00b0";
  if (unit == "deg/s" || unit == "dps") return "\u00b0/s";
  if (unit == "ohm") return "\u03a9";
  if (unit == "1") return "";
  return unit;
}

std::string with_unit(const std::string& number, const std::string& unit) {
  const std::string text = unit_text(unit);
  return text.empty() ? number : number + "\u00a0" + text;
}

std::string signal_text(const plant::SignalName& signal) {
  const auto known = signal.known();
  if (!known) return to_string(signal);
  switch (*known) {
    case plant::Signal::motor_C:
      return "motor temperature";
    case plant::Signal::current_A:
      return "motor current";
    case plant::Signal::angle_deg:
      return "angle";
    case plant::Signal::rate_dps:
      return "angular rate";
  }
  return to_string(signal);
}

/// Escaped, and a long id may break after its underscores.
std::string breakable(const std::string& id) {
  std::string out;
  for (const char one : escaped(id)) {
    out += one;
    if (one == '_') out += "<wbr>";
  }
  return out;
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "\u2013";
  if (share > 0.99 && share < 1.0) return ">\u200a99\u00a0%";
  if (share > 0.0 && share < 0.01) return "<\u200a1\u00a0%";
  char text[16];
  std::snprintf(text, sizeof text, "%.0f\u00a0%%", 100.0 * share);
  return text;
}

std::string joined(const std::vector<std::string>& ids, const char* between = " + ") {
  std::string out;
  for (const auto& id : ids) out += (out.empty() ? "" : between) + id;
  return out;
}

std::vector<double> numbers(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

std::vector<double> difference(const Eigen::VectorXd& simulated, const Eigen::VectorXd& measured) {
  if (simulated.size() != measured.size()) return {};
  return numbers(simulated - measured);
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  std::size_t n = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value * value;
    ++n;
  }
  return n == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(n));
}

class Page {
public:
  Page(const Diagnosis& diagnosis, const std::string& model_name, const std::vector<EffectInfo>& effects)
      : d_(diagnosis), model_(model_name), effects_(effects) {}

  std::string write() {
    head();
    facts();
    how_far();
    next();
    curves();
    missing();
    where();
    which();
    data();
    foot();
    return std::move(out_);
  }

private:
  bool has_cause() const { return !d_.cause.empty(); }

  const EffectInfo* info(const std::string& id) const {
    for (const auto& one : effects_) {
      if (one.id == id) return &one;
    }
    return nullptr;
  }

  static const char* headline(Verdict verdict) {
    switch (verdict) {
      case Verdict::no_gap:
        return "Simulation and recording agree";
      case Verdict::explained:
        return "The gap is explained";
      case Verdict::partial:
        return "The gap is explained in part";
      case Verdict::ambiguous:
        return "Several explanations fit, and this recording cannot tell them apart";
      case Verdict::unexplained:
        return "There is a gap that no known effect explains";
      case Verdict::insufficient:
        return "Too little data for any statement";
    }
    return "";
  }

  void head() {
    out_ +=
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Gap report: " +
        escaped(model_.empty() ? "model" : model_) + "</title>\n<style>" + report_style +
        "</style>\n</head>\n<body>\n<main>\n";
    out_ += "<div class=\"eyebrow\">Sim-to-real gap" +
            std::string(model_.empty() ? "" : " \u00b7 " + escaped(model_)) + "</div>\n<h1 class=\"" +
            to_string(d_.verdict) + "\">" + headline(d_.verdict) + "</h1>\n";
    if (!d_.reason.empty())
      out_ += "<p class=\"lead\">" + escaped(capital(d_.reason)) + (d_.reason.back() == '.' ? "" : ".") +
              "</p>\n";
  }

  void fact(const std::string& name, const std::string& value, const std::string& more) {
    out_ += "<div class=\"fact\"><span class=\"name\">" + name + "</span><b>" + value +
            "</b><span class=\"more\">" + more + "</span></div>\n";
  }

  void facts() {
    out_ += "<div class=\"facts\">\n";
    if (!d_.where.empty()) {
      const Location& first = d_.where.front();
      std::string more = escaped(signal_text(first.signal)) + ", " + percent(first.share) + " of its gap";
      if (first.regime) {
        more += "; most for <code>" + escaped(first.regime->variable) + "</code> " +
                readable(first.regime->from) + " to " + readable(first.regime->to);
      }
      fact("Where", breakable(to_string(first.submodel)), more);
    }
    for (const auto& cause : d_.cause) {
      std::string more;
      for (const auto& parameter : cause.parameters) {
        more += (more.empty() ? "" : "<br>") + escaped(parameter.name) + " " +
                with_unit(readable(parameter.value), parameter.unit) + " [" + readable(parameter.ci95.low) +
                ", " + readable(parameter.ci95.high) + "]";
      }
      fact("Which \u00b7 probability " + percent(cause.probability), breakable(cause.effect), more);
    }
    const GapScore* most = nullptr;
    for (const auto& gap : d_.gap) {
      const bool named = !d_.where.empty() && d_.where.front().signal == gap.signal;
      if (most == nullptr || named) most = &gap;
    }
    if (most != nullptr && has_cause()) {
      fact("How far it shrinks",
           percent(most->shrunk_by) + " [" + percent(most->ci95.low) + ", " + percent(most->ci95.high) + "]",
           escaped(signal_text(most->signal)) + ": " + readable(most->before) + " to " +
               with_unit(readable(most->after), most->unit) + ", noise floor " + readable(most->noise_floor));
    } else if (most != nullptr) {
      fact("How large", with_unit(readable(most->before), most->unit),
           escaped(signal_text(most->signal)) + ", RMS; noise floor " +
               with_unit(readable(most->noise_floor), most->unit));
    }
    if (d_.remaining) {
      const Remaining& rest = *d_.remaining;
      std::string more = escaped(signal_text(rest.signal)) + " at " + readable(rest.times_floor, 3) +
                         " times its noise floor";
      if (rest.submodel) more += "; " + breakable(to_string(*rest.submodel));
      if (rest.regime)
        more += ", most for <code>" + escaped(rest.regime->variable) + "</code> " +
                readable(rest.regime->from) + " to " + readable(rest.regime->to);
      if (!rest.looks.empty()) more += "<br>" + escaped(rest.looks);
      fact("What remains", percent(rest.share) + " of the gap", more);
    }
    out_ += "</div>\n";
  }

  // Dots on one scale per signal: as configured, recalibrated, with the effect; a tick for what a perfect
  // model would score.
  std::string gap_picture(const GapScore& gap) const {
    double largest = std::max({gap.before, gap.recalibrated, gap.noise_floor, has_cause() ? gap.after : 0.0});
    if (!(largest > 0.0)) largest = 1.0;
    const auto x = [&](double value) {
      char text[16];
      std::snprintf(text, sizeof text, "%.1f", 8.0 + 264.0 * std::min(std::max(value / largest, 0.0), 1.0));
      return std::string(text);
    };
    std::string svg =
        "<svg viewBox=\"0 0 280 24\" style=\"width:280px;height:24px\" aria-hidden=\"true\"><line class=\"gapline\" x1=\"" +
        x(0.0) + "\" x2=\"" + x(largest) + "\" y1=\"12\" y2=\"12\"/>";
    if (has_cause()) {
      svg += "<line class=\"ci\" x1=\"" + x(gap.before * (1.0 - gap.ci95.high)) + "\" x2=\"" +
             x(gap.before * (1.0 - gap.ci95.low)) + "\" y1=\"12\" y2=\"12\"/>";
    }
    svg += "<line class=\"d-floor\" x1=\"" + x(gap.noise_floor) + "\" x2=\"" + x(gap.noise_floor) +
           "\" y1=\"3\" y2=\"21\"/>";
    svg += "<circle class=\"d-before\" r=\"6\" cy=\"12\" cx=\"" + x(gap.before) + "\"/>";
    svg += "<rect class=\"d-recalibrated\" width=\"9\" height=\"9\" y=\"7.5\" x=\"" + x(gap.recalibrated) +
           "\" transform=\"translate(-4.5 0)\"/>";
    if (has_cause()) svg += "<circle class=\"d-after\" r=\"6\" cy=\"12\" cx=\"" + x(gap.after) + "\"/>";
    return svg + "</svg>";
  }

  void how_far() {
    if (d_.gap.empty()) return;
    out_ +=
        "<h2>How far</h2>\n<p class=\"soft\">RMS difference between simulation and recording, on data that was held out.</p>\n<table>\n<tr>"
        "<th class=\"t\">signal</th><th class=\"t\"></th><th><span class=\"explain\" style=\"color:var(--baseline)\">\u25cf</span> as "
        "configured</th><th><span style=\"color:var(--recalibrated)\">\u25a0</span> re\u00adcalibrated</th>";
    if (has_cause()) out_ += "<th><span style=\"color:var(--augmented)\">\u25cf</span> with the effect</th>";
    out_ += "<th>| noise floor</th>" + std::string(has_cause() ? "<th>shrunk by</th>" : "") + "</tr>\n";
    for (const auto& gap : d_.gap) {
      out_ += "<tr><td class=\"t\">" + escaped(signal_text(gap.signal)) + "<small>" + unit_text(gap.unit);
      if (gap.horizon_s) out_ += ", windows of " + readable(*gap.horizon_s, 2) + " s";
      out_ += "</small></td><td class=\"t\">" + gap_picture(gap) + "</td><td>" + readable(gap.before) +
              "</td><td>" + readable(gap.recalibrated) + "</td>";
      if (has_cause()) out_ += "<td>" + readable(gap.after) + "</td>";
      out_ += "<td>" + readable(gap.noise_floor) + "</td>";
      if (has_cause()) {
        out_ += "<td>" + percent(gap.shrunk_by) + "<small>" + percent(gap.ci95.low) + " to " +
                percent(gap.ci95.high) + "</small></td>";
      }
      out_ += "</tr>\n";
    }
    out_ += "</table>\n";
  }

  void next() {
    if (d_.next_experiment.empty()) return;
    out_ += "<h2>Next experiment</h2>\n<p class=\"next\">" + escaped(d_.next_experiment) + "</p>\n";
  }

  Chart overlay(const SignalSeries& s, double from, double to) const {
    Chart chart;
    const std::string unit = unit_text(s.unit);
    chart.x_label = "time / s";
    chart.y_label = signal_text(s.signal) + (unit.empty() ? "" : " / " + unit);
    chart.title = "Measured and simulated " + signal_text(s.signal);
    const auto add = [&](const char* label, const char* role, const Eigen::VectorXd& values) {
      Series series;
      series.label = label;
      series.role = role;
      for (Eigen::Index i = 0; i < values.size() && i < s.t_s.size(); ++i) {
        if (s.t_s[i] < from || s.t_s[i] > to) continue;
        series.x.push_back(s.t_s[i]);
        series.y.push_back(values[i]);
      }
      chart.series.push_back(std::move(series));
    };
    add("measured", "measured", s.measured);
    add("as configured", "baseline", s.baseline);
    if (has_cause()) add("with the effect", "augmented", s.augmented);
    return chart;
  }

  Chart residuals(const SignalSeries& s) const {
    Chart chart;
    const std::string unit = unit_text(s.unit);
    chart.x_label = "time / s";
    chart.y_label = "simulated \u2212 measured" + (unit.empty() ? "" : " / " + unit);
    chart.title = "Simulated minus measured " + signal_text(s.signal);
    chart.zero_line = true;
    chart.height = 220;
    chart.series.push_back({"as configured",
                            "baseline",
                            Series::Style::line,
                            numbers(s.t_s),
                            difference(s.baseline, s.measured),
                            {},
                            {}});
    if (has_cause()) {
      chart.series.push_back({"with the effect",
                              "augmented",
                              Series::Style::line,
                              numbers(s.t_s),
                              difference(s.augmented, s.measured),
                              {},
                              {}});
    }
    return chart;
  }

  // An axis runs in windows of half a second: over a whole run nothing could be seen. The worst few seconds
  // tell.
  std::pair<double, double> stretch_to_show(const SignalSeries& s) const {
    const Eigen::Index n = s.t_s.size();
    const double begin = s.t_s.minCoeff(), end = s.t_s.maxCoeff();  // several runs may start at 0 each
    double horizon = 0.0;
    for (const auto& gap : d_.gap) {
      if (gap.signal == s.signal && gap.horizon_s) horizon = *gap.horizon_s;
    }
    if (!(horizon > 0.0) || end - begin <= 10.0 * horizon) return {begin, end};
    const double length = 8.0 * horizon;
    double best = -1.0, best_from = begin, sum = 0.0;
    Eigen::Index first = 0;
    for (Eigen::Index last = 0; last < n; ++last) {
      const double e = s.baseline[last] - s.measured[last];
      if (std::isfinite(e)) sum += e * e;
      while (s.t_s[last] - s.t_s[first] > length) {
        const double gone = s.baseline[first] - s.measured[first];
        if (std::isfinite(gone)) sum -= gone * gone;
        ++first;
      }
      if (sum > best && s.t_s[last] - begin >= length) {
        best = sum;
        best_from = s.t_s[first];
      }
    }
    return {best_from, best_from + length};
  }

  void figure(const Chart& chart, const std::string& caption) {
    out_ += "<figure>\n" + to_svg(chart) +
            (caption.empty() ? "" : "<figcaption>" + caption + "</figcaption>\n") + "</figure>\n";
  }

  void curves() {
    if (d_.series.empty()) return;
    out_ += "<h2>Measured and simulated</h2>\n";
    std::vector<plant::SignalName> signals;
    for (const auto& s : d_.series) {
      if (std::find(signals.begin(), signals.end(), s.signal) == signals.end()) signals.push_back(s.signal);
    }
    for (const auto& signal : signals) {
      std::vector<const SignalSeries*> runs;
      for (const auto& s : d_.series) {
        if (s.signal == signal && s.t_s.size() > 1 && s.baseline.size() == s.t_s.size() &&
            s.measured.size() == s.t_s.size())
          runs.push_back(&s);
      }
      if (runs.empty()) continue;
      const SignalSeries* worst = runs.front();
      for (const auto* run : runs) {
        if (rms(difference(run->baseline, run->measured)) > rms(difference(worst->baseline, worst->measured)))
          worst = run;
      }
      const auto [from, to] = stretch_to_show(*worst);
      const bool part = from > worst->t_s.minCoeff() || to < worst->t_s.maxCoeff();
      out_ += "<h3>" + escaped(capital(signal_text(signal))) + "</h3>\n";
      std::string caption =
          part
              ? "The stretch where the simulation as configured is worst, each window started from the measured state."
              : "";
      if (runs.size() > 1) {
        caption += std::string(caption.empty() ? "" : " ") + "The run with the largest gap of " +
                   std::to_string(runs.size()) + " held-out runs.";
      }
      figure(overlay(*worst, from, to), caption);
      figure(residuals(*worst), "");
    }
  }

  void missing() {
    bool first = true;
    for (const auto& q : d_.missing_quantities) {
      if (q.x.size() < 2 || q.value.size() != q.x.size()) continue;
      if (first) {
        out_ +=
            "<h2>The missing quantity</h2>\n<p class=\"soft\">What would have to be added to the model's equation to make it follow the "
            "recording, inferred from measurements alone" +
            std::string(has_cause() ? ", and what the effect found supplies.</p>\n" : ".</p>\n");
        first = false;
      }
      Chart chart;
      chart.title = to_string(q.quantity) + " against " + q.variable;
      chart.x_label =
          q.variable + (unit_text(q.variable_unit).empty() ? "" : " / " + unit_text(q.variable_unit));
      chart.y_label = to_string(q.quantity) + (unit_text(q.unit).empty() ? "" : " / " + unit_text(q.unit));
      chart.zero_line = true;
      Series bars{"", "missing", Series::Style::interval, numbers(q.x), numbers(q.value), {}, {}};
      for (Eigen::Index i = 0; i < q.x.size(); ++i) {
        const double half = q.spread.size() == q.x.size() ? 1.96 * q.spread[i] : 0.0;
        bars.low.push_back(q.value[i] - half);
        bars.high.push_back(q.value[i] + half);
      }
      chart.series.push_back(std::move(bars));
      chart.series.push_back({"from the recording, with its 95 % interval",
                              "missing",
                              Series::Style::points,
                              numbers(q.x),
                              numbers(q.value),
                              {},
                              {}});
      if (q.effect.size() == q.x.size()) {
        std::vector<std::string> ids;
        for (const auto& cause : d_.cause) ids.push_back(cause.effect);
        chart.series.push_back(
            {joined(ids), "effect", Series::Style::line, numbers(q.x), numbers(q.effect), {}, {}});
      }
      for (const auto& where : d_.where) {
        if (where.signal == q.signal && where.regime && where.regime->variable == q.variable) {
          chart.shade_from = where.regime->from;
          chart.shade_to = where.regime->to;
        }
      }
      figure(chart, chart.shade_to > chart.shade_from ? "Shaded: where it is largest." : "");
    }
  }

  void where() {
    if (d_.where.empty()) return;
    out_ +=
        "<h2>Where</h2>\n<p class=\"soft\">Found from residuals alone, before any effect is considered.</p>\n";
    for (const auto& one : d_.where) {
      out_ += "<div class=\"where\"><b>" + escaped(to_string(one.submodel)) + "</b> in " +
              escaped(signal_text(one.signal)) + ", " + percent(one.share) + " of its gap";
      if (one.regime) {
        out_ += "; most for <code>" + escaped(one.regime->variable) + "</code> " +
                readable(one.regime->from) + " to " + readable(one.regime->to);
      }
      out_ += ".<br><span class=\"soft\">" + escaped(one.evidence) + "</span></div>\n";
    }
  }

  bool is_chosen(const RankedExplanation& one) const {
    if (one.effects.size() != d_.cause.size()) return false;
    return std::all_of(d_.cause.begin(), d_.cause.end(), [&](const Cause& cause) {
      return std::find(one.effects.begin(), one.effects.end(), cause.effect) != one.effects.end();
    });
  }

  void which() {
    if (d_.ranking.empty()) return;
    out_ +=
        "<h2>Which</h2>\n<table>\n<tr><th class=\"t\">explanation</th><th class=\"t\">probability</th><th>held-out gap<small>against "
        "recalibrated</small></th><th class=\"t\">looks like</th></tr>\n";
    std::size_t rows = 0;
    for (const auto& one : d_.ranking) {
      if (rows == 12) break;
      ++rows;
      const bool chosen = is_chosen(one) && has_cause();
      out_ += std::string("<tr") +
              (chosen                        ? " class=\"chosen\""
               : one.refused || one.absorbed ? " class=\"out\""
                                             : "") +
              "><td class=\"t\">" +
              (one.effects.empty() ? "nothing is missing" : escaped(joined(one.effects)));
      std::string small;
      if (one.effects.size() == 1) {
        if (const EffectInfo* const known = info(one.effects.front())) small = escaped(known->prose);
      }
      if (chosen) {
        for (const auto& parameter : one.parameters) {
          small += "<br>" + escaped(parameter.name) + " = " +
                   with_unit(readable(parameter.value), parameter.unit) + " [" +
                   readable(parameter.ci95.low) + ", " + readable(parameter.ci95.high) + "]";
        }
      }
      for (const auto& [set, text] :
           {std::pair<bool, const char*>{one.absorbed,
                                         "re-calibration imitates it: this recording cannot show it"},
            {one.at_bound, "a parameter ended on its bound"},
            {one.refused, "refused: held-out data gets worse"}}) {
        if (set) small += std::string(small.empty() ? "" : "<br>") + text;
      }
      char width[16];
      std::snprintf(width, sizeof width, "%.0f",
                    std::max(1.0, 88.0 * std::min(1.0, std::max(0.0, one.probability))));
      out_ +=
          (small.empty() ? "" : "<small>" + small + "</small>") +
          "</td><td class=\"t\" style=\"white-space:nowrap\"><span class=\"track\"><span class=\"bar\" style=\"width:" +
          width + "px\"></span></span>" + percent(one.probability) + "</td><td>" +
          (one.held_out_ratio > 0.0 ? "\u00d7\u2009" + readable(one.held_out_ratio, 2) : "\u2013") +
          "</td><td class=\"t\">";
      std::string like;
      std::size_t shown = 0;
      for (const auto& other : one.confusable) {
        if (shown++ == 3) break;
        like += (like.empty() ? "" : "<br>") + escaped(joined(other.effects)) + " (" +
                readable(other.cosine, 2) + ")";
      }
      out_ += "<small>" + like + "</small></td></tr>\n";
    }
    out_ +=
        "<tr><td class=\"t\">none of these</td><td class=\"t\" style=\"white-space:nowrap\"><span class=\"track\"><span class=\"bar\" style=\"width:";
    char width[16];
    std::snprintf(width, sizeof width, "%.0f",
                  std::max(1.0, 88.0 * std::min(1.0, std::max(0.0, d_.none_of_these))));
    out_ += std::string(width) + "px\"></span></span>" + percent(d_.none_of_these) +
            "</td><td></td><td></td></tr>\n</table>\n";
    if (d_.ranking.size() > rows)
      out_ += "<p class=\"soft\">" + std::to_string(d_.ranking.size() - rows) +
              " more were weighed; all are in the JSON report.</p>\n";
    out_ +=
        "<p class=\"soft\">\u201cLooks like\u201d: cosine of the two signatures in this recording, whitened and freed of what the "
        "model\u2019s own constants can imitate. Above 0.95 the recording cannot tell them apart.</p>\n";
    if (!d_.alternatives.empty()) {
      out_ += "<p>Cannot be told apart from: ";
      for (std::size_t i = 0; i < d_.alternatives.size(); ++i)
        out_ += (i == 0 ? "<b>" : ", <b>") + escaped(joined(d_.alternatives[i])) + "</b>";
      out_ += ".</p>\n";
    }
  }

  void data() {
    if (d_.findings.empty() && d_.not_judged.empty() && d_.constants.empty()) return;
    out_ += "<h2>The data and the constants</h2>\n";
    if (!d_.not_judged.empty()) {
      out_ += "<h3>Not judged</h3>\n<ul>\n";
      for (const auto& one : d_.not_judged) out_ += "<li>" + escaped(one) + "</li>\n";
      out_ += "</ul>\n";
    }
    if (!d_.findings.empty()) {
      out_ += "<h3>Noticed in the recordings</h3>\n<ul>\n";
      for (const auto& finding : d_.findings) {
        const char* const kind = finding.severity == Severity::error     ? "error"
                                 : finding.severity == Severity::warning ? "warning"
                                                                         : "note";
        out_ +=
            std::string("<li><span class=\"") + kind + "\">" + kind + "</span> " + escaped(finding.recording);
        if (!finding.column.empty()) out_ += ", <code>" + escaped(finding.column) + "</code>";
        out_ += ": " + escaped(finding.message) + "</li>\n";
      }
      out_ += "</ul>\n";
    }
    if (!d_.constants.empty()) {
      out_ +=
          "<h3>Constants of the model that moved by more than two of their uncertainties</h3>\n<table>\n<tr><th class=\"t\">constant</th><th>as configured</th><th>in the augmented "
          "model</th><th>moved by</th></tr>\n";
      for (const auto& constant : d_.constants) {
        const double moved = constant.configured != 0.0 ? constant.fitted / constant.configured - 1.0 : 0.0;
        char text[24];
        std::snprintf(text, sizeof text, "%+.1f\u00a0%%", 100.0 * moved);
        out_ += "<tr><td class=\"t\"><code>" + escaped(constant.name) + "</code></td><td>" +
                readable(constant.configured, 4) + "</td><td>" + readable(constant.fitted, 4) + "</td><td>" +
                text + "</td></tr>\n";
      }
      out_ += "</table>\n";
    }
  }

  void foot() {
    out_ +=
        "<footer>Intervals cover 95 % and respect that residuals of neighbouring samples are alike. \u201cAs configured\u201d is the model as "
        "given; \u201crecalibrated\u201d is the same with its own constants refitted and nothing added. The noise floor is what a perfect "
        "model would score.</footer>\n</main>\n</body>\n</html>\n";
  }

  const Diagnosis& d_;
  const std::string& model_;
  const std::vector<EffectInfo>& effects_;
  std::string out_;
};

}  // namespace

std::string report_html(const Diagnosis& diagnosis, const std::string& model_name,
                        const std::vector<EffectInfo>& effects) {
  return Page(diagnosis, model_name, effects).write();
}

}  // namespace thermopower::gap::files
