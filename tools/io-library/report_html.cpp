// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/report_html.hpp>
#include <thermopower/io/sentences.hpp>

#include "chart.hpp"
#include "held_out_runs.hpp"
#include "html_text.hpp"
#include "report_script.hpp"
#include "report_style.hpp"
#include "residual_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thermopower::io {
namespace {

// Curves are most of a page: so many are drawn, of the runs where the gap is largest.
constexpr const char* rival_roles[] = {"rival1", "rival2", "rival3"};
constexpr std::size_t most_rivals = 3, most_together = 8;
constexpr std::size_t most_pictures = 6, most_runs_drawn = 4, most_runs_listed = 40, most_ranked = 12;

std::vector<double> numbers(const Eigen::VectorXd& values) {
  return {values.data(), values.data() + values.size()};
}

std::string regime_html(const Regime& regime) {
  const VariableText variable = variable_text(regime.variable);
  const std::string text =
      variable.in_words ? escaped(variable.text) : "<code>" + breakable(variable.text) + "</code>";
  return text + " " + range_text(regime.from, regime.to) +
         (variable.unit.empty() ? "" : "\u00a0" + variable.unit);
}

class Page {
public:
  Page(const Diagnosis& diagnosis, const std::string& model_name, const std::vector<EffectInfo>& effects,
       const std::vector<Recording>& held_out, const Provenance& made_of)
      : d_(diagnosis),
        model_(model_name),
        effects_(effects),
        made_of_(made_of),
        runs_(held_out_runs(diagnosis, held_out)) {}

  std::string write() {
    head();
    findings();
    facts();
    how_far();
    next();
    curves();
    rests();
    missing();
    where();
    which();
    constants();
    together();
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

  const char* headline() const {
    switch (d_.verdict) {
      case Verdict::no_gap:
        return "Simulation and recording agree";
      case Verdict::explained:
        return "The gap is explained";
      case Verdict::partial:
        return "The gap is explained in part";
      case Verdict::ambiguous:
        return "Several explanations fit, and this recording cannot tell them apart";
      case Verdict::unexplained:
        switch (d_.why) {
          case Reason::constants_leave_a_rest:
            return "Refitted constants take a part of the gap away, and no known effect the rest";
          case Reason::simulation_runs_away:
            return "The simulation runs away";
          default:
            return "There is a gap that no known effect explains";
        }
      case Verdict::insufficient:
        return deciding(d_.findings) != nullptr ? "The data cannot be believed as they stand"
                                                : "Too little data for any statement";
    }
    return "";
  }

  // The answer in words; then why, and what it was made of.
  void head() {
    out_ +=
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Gap report: " +
        escaped(model_.empty() ? "model" : model_) + "</title>\n<style>" + report_style +
        "</style>\n</head>\n<body>\n<main>\n";
    out_ += "<div class=\"eyebrow\">Sim-to-real gap" +
            std::string(model_.empty() ? "" : " \u00b7 " + escaped(model_)) + "</div>\n<h1 class=\"" +
            to_string(d_.verdict) + "\">" + headline() + "</h1>\n";
    const std::string words = joined(sentences(d_, effects_), " ");
    if (!words.empty()) out_ += "<p class=\"words\">" + escaped(with_signs(words)) + "</p>\n";
    if (!d_.reason.empty())
      out_ += "<p class=\"lead\">" + escaped(with_signs(capital(d_.reason))) +
              (d_.reason.back() == '.' ? "" : ".") + "</p>\n";
    provenance();
  }

  void provenance() {
    const std::string line = provenance_line(made_of_);
    if (!line.empty()) out_ += "<p class=\"from\">" + breakable(line) + "</p>\n";
  }

  // The same fault in several recordings is told once.
  void finding(const Finding& one) {
    std::vector<std::string> recordings;
    for (const auto& other : d_.findings) {
      if (other.column != one.column || other.message != one.message) continue;
      if (recordings.empty() && &other != &one) return;  // told with the first
      if (std::find(recordings.begin(), recordings.end(), other.recording) == recordings.end())
        recordings.push_back(other.recording);
    }
    for (std::string& name : recordings) name = path_for_others(name);
    out_ += std::string("<div class=\"finding ") + to_string(one.severity) + "\"><span class=\"tag\">" +
            to_string(one.severity) + "</span>" + breakable(joined(recordings, ", "));
    if (!one.column.empty()) out_ += ", <code>" + breakable(one.column) + "</code>";
    out_ += ": " + escaped(with_signs(one.message)) + ".";
    if (one.action != FindingAction::none) {
      const auto rows = one.row_count();
      out_ += std::string(" <span class=\"soft\">") +
              (one.action == FindingAction::masked ? "Counted as missing" : "The run is cut there") +
              (rows > 0 ? ": " + std::to_string(rows) + (rows == 1 ? " row" : " rows") : std::string()) +
              ".</span>";
    }
    if (!one.mend.empty()) out_ += "<span class=\"mend\">To mend it: <b>" + escaped(one.mend) + "</b></span>";
    out_ += "</div>\n";
  }

  void findings() {
    for (const Severity severity : {Severity::error, Severity::warning})
      for (const auto& one : d_.findings)
        if (one.severity == severity) finding(one);
  }

  void fact(const std::string& name, const std::string& value, const std::string& more) {
    out_ += "<div class=\"fact\"><span class=\"name\">" + name + "</span><b>" + value +
            "</b><span class=\"more\">" + more + "</span></div>\n";
  }

  static std::string small_print(const std::string& id) {
    return "<br><code class=\"id\">" + breakable(id) + "</code>";
  }

  std::string occurrences(const std::vector<Occurrence>& list) const {
    std::string text;
    for (const auto& one : list) {
      text += (text.empty() ? "" : "; ") + breakable(short_name(one.recording));
      if (!one.run.empty()) text += ", run " + escaped(one.run);
      if (one.held_out) text += " (held out)";
      if (one.from_s) text += ", from " + readable(*one.from_s) + "\u00a0s on";
    }
    return text;
  }

  // The file's name where that is enough to tell it from the others.
  std::string short_name(const std::string& name) const {
    const auto file = [](const std::string& path) { return path.substr(path.find_last_of('/') + 1); };
    for (const auto& one : runs_)
      if (one.recording != name && file(one.recording) == file(name)) return name;
    return file(name).empty() ? name : file(name);
  }

  std::string title_of(const HeldOutRun& run) const {
    std::string text = short_name(run.recording);
    if (!run.label.empty()) text += ", run " + run.label;
    else if (run.of > 1) text += ", run " + std::to_string(run.number + 1);
    return text;
  }

  /// How much of its signal's gap a place takes away. Constants within what is known of them may take away what the model
  /// as configured shows: then there is no gap.
  std::string share_of_gap(const Location& place) const {
    const std::string difference = d_.verdict == Verdict::no_gap ? "difference as configured" : "gap";
    return takes_gap_away(place) ? percent_html(place.share) + " of its " + difference
                                 : "where no one place takes its " + difference + " away";
  }

  void facts() {
    if (d_.verdict == Verdict::insufficient && d_.where.empty() && d_.gap.empty()) return;
    out_ += "<div class=\"facts\">\n";
    if (!d_.where.empty()) {
      const Location& first = d_.where.front();
      std::string more = escaped(signal_text(first.signal)) + ", " + share_of_gap(first);
      if (first.regime) more += "; most for " + regime_html(*first.regime);
      if (!first.only_in.empty()) more += "<br>Only in " + occurrences(first.only_in);
      if (const std::string elsewhere = acts_elsewhere(); !elsewhere.empty())
        more +=
            "<br>The cause acts in the " + escaped(elsewhere) + ": from residuals alone it looks like this.";
      more += small_print(to_string(first.submodel));
      fact("Where", escaped(capital(part_in_words(to_string(first.submodel)))), more);
    }
    for (const auto& cause : d_.cause) {
      std::string more;
      for (const auto& parameter : cause.parameters) {
        more += (more.empty() ? "" : "<br>") + breakable(parameter.name) + " " +
                with_unit(readable(parameter.value), parameter.unit) + " " + known_to(parameter);
      }
      more += small_print(cause.effect);
      fact("Which \u00b7 probability " + percent_html(cause.probability),
           escaped(capital(effect_in_words(cause.effect))), more);
    }
    if (!d_.alternatives.empty()) {
      std::string text;
      for (const auto& one : d_.alternatives) text += (text.empty() ? "" : "<br>") + breakable(joined(one));
      fact("Or", text, "this recording cannot tell them apart");
    }
    const GapScore* most = nullptr;
    for (const auto& gap : d_.gap) {
      const bool named = !d_.where.empty() && d_.where.front().signal == gap.signal;
      if (most == nullptr || named) most = &gap;
    }
    if (most != nullptr && has_cause()) {
      const PercentTexts shrunk = percent_texts(most->shrunk_by, most->ci95);
      fact(
          "How far it shrinks", shrunk.value + "\u00a0% " + shrunk.interval,
          escaped(signal_text(most->signal)) + ": " + readable(most->before) + " to " +
              with_unit(readable(most->after), most->unit) + ", noise floor " + readable(most->noise_floor) +
              (most->ci95.low < 0.0
                   ? "<br>The interval reaches below 0: what is proven is a smaller held-out error than with recalibrated constants alone, not than as configured."
                   : ""));
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
      if (rest.regime) more += ", most for " + regime_html(*rest.regime);
      if (!rest.looks.empty()) more += "<br>" + escaped(capital(rest.looks)) + ".";
      fact("What remains", percent_html(rest.share) + " of the gap", more);
    }
    out_ += "</div>\n";
  }

  // A score with a bar below it, on one scale per signal: number and mark stand in one place.
  static std::string score_cell(double value, double largest, const char* role) {
    char width[16];
    std::snprintf(width, sizeof width, "%.1f%%",
                  largest > 0.0 ? 100.0 * std::clamp(value / largest, 0.0, 1.0) : 0.0);
    return "<td>" + readable(value) + "<span class=\"score " + role +
           "\" style=\"width:" + (std::isfinite(value) ? std::string(width) : "0") + "\"></span></td>";
  }

  void how_far() {
    if (d_.gap.empty()) return;
    out_ +=
        "<h2>How far</h2>\n<p class=\"soft\">RMS difference between simulation and recording, on data that was held out.</p>\n"
        "<table class=\"scores\">\n<tr><th class=\"t\">as con\u00adfigured</th>"
        "<th>con\u00adstants re\u00adfitted</th>";
    if (has_cause()) out_ += "<th>with the effect</th>";
    out_ += "<th>noise floor</th>" + std::string(has_cause() ? "<th>shrunk by</th>" : "") + "</tr>\n";
    for (const auto& gap : d_.gap) {
      const double largest =
          std::max({gap.before, gap.recalibrated, gap.noise_floor, has_cause() ? gap.after : 0.0});
      out_ += "<tr class=\"name\"><td class=\"t\" colspan=\"" + std::string(has_cause() ? "5" : "3") + "\">" +
              escaped(capital(signal_text(gap.signal))) + "<span class=\"soft\">" +
              (unit_text(gap.unit).empty() ? "" : " in " + escaped(unit_text(gap.unit)));
      if (gap.horizon_s) out_ += ", windows of " + readable(*gap.horizon_s, 2) + "\u00a0s";
      out_ += "</span></td></tr>\n<tr>" + score_cell(gap.before, largest, "before") +
              score_cell(gap.recalibrated, largest, "refitted");
      if (has_cause()) out_ += score_cell(gap.after, largest, "after");
      out_ += score_cell(gap.noise_floor, largest, "noise");
      if (has_cause()) {
        const PercentTexts shrunk = percent_texts(gap.shrunk_by, gap.ci95);
        out_ += "<td>" + shrunk.value + "\u00a0%<small>" + shrunk.interval + "</small></td>";
      }
      out_ += "</tr>\n";
    }
    out_ += "</table>\n";
    if (!d_.recalibration.empty()) out_ += "<p>" + escaped(with_signs(capital(d_.recalibration))) + ".</p>\n";
  }

  void next() {
    if (d_.next_experiment.empty()) return;
    out_ += std::string("<h2>") + (d_.verdict == Verdict::insufficient ? "What to do" : "Next experiment") +
            "</h2>\n<p class=\"next\">" + escaped(d_.next_experiment) + "</p>\n";
  }

  Series part(const HeldOutRun& run, const SignalSeries& s, const std::string& label, const char* role,
              const Eigen::VectorXd& values, bool minus_measured) const {
    Series series{label, role, Series::Style::line, {}, {}, {}, {}};
    for (Eigen::Index i = run.begin; i < run.end && i < values.size(); ++i) {
      series.x.push_back(s.t_s[i]);
      series.y.push_back(minus_measured ? values[i] - s.measured[i] : values[i]);
    }
    return series;
  }

  Chart signal_chart(const HeldOutRun& run, const SignalSeries& s, bool minus_measured) const {
    Chart chart;
    const std::string unit = unit_text(s.unit).empty() ? "" : " / " + unit_text(s.unit);
    chart.x_label = "time / s";
    chart.y_label = (minus_measured ? "simulated \u2212 measured" : signal_text(s.signal)) + unit;
    chart.title = (minus_measured ? "Simulated minus measured " : "Measured and simulated ") +
                  signal_text(s.signal) + ", " + title_of(run);
    if (!minus_measured) chart.series.push_back(part(run, s, "measured", "measured", s.measured, false));
    chart.series.push_back(part(run, s, "as configured", "baseline", s.baseline, minus_measured));
    if (s.recalibrated.size() == s.t_s.size())
      chart.series.push_back(part(run, s, "recalibrated", "recalibrated", s.recalibrated, minus_measured));
    if (has_cause() && s.augmented.size() == s.t_s.size())
      chart.series.push_back(part(run, s, "with the effect", "augmented", s.augmented, minus_measured));
    for (std::size_t i = 0; i < s.rivals.size() && i < most_rivals; ++i)
      if (s.rivals[i].values.size() == s.t_s.size())
        chart.series.push_back(part(run, s, joined(s.rivals[i].effects).c_str(), rival_roles[i],
                                    s.rivals[i].values, minus_measured));
    if (minus_measured) {
      chart.zero_line = true;
      chart.height = 170;
      const GapScore* const gap = score_of(s.signal);
      if (gap != nullptr && std::isfinite(gap->noise_floor)) chart.band = std::max(gap->noise_floor, 0.0);
    }
    return chart;
  }

  const GapScore* score_of(const plant::SignalName& signal) const {
    for (const auto& gap : d_.gap)
      if (gap.signal == signal) return &gap;
    return nullptr;
  }

  std::optional<double> shows_from(const HeldOutRun& run) const {
    for (const auto& where : d_.where)
      for (const auto& one : where.only_in)
        if (one.held_out && one.recording == run.recording && one.run == run.label && one.from_s)
          return one.from_s;
    return std::nullopt;
  }

  double wrongness(const HeldOutRun& run) const {
    double worst = 0.0;
    for (const SignalSeries* s : run.signals) {
      const GapScore* const gap = score_of(s->signal);
      const double floor = gap != nullptr && gap->noise_floor > 0.0 ? gap->noise_floor : 1.0;
      worst = std::max(worst, rms_of(run, *s, s->baseline) / floor);
    }
    return worst;
  }

  void run_table() {
    out_ += "<p class=\"soft\">RMS difference in each run: as configured \u2192 " +
            std::string(has_cause() ? "with the effect" : "recalibrated") +
            ".</p>\n<table>\n<tr><th class=\"t\">run</th><th class=\"wide\">rows</th>";
    for (const auto& gap : d_.gap)
      out_ += "<th>" + escaped(axis_label({signal_text(gap.signal), unit_text(gap.unit)})) + "</th>";
    out_ += "</tr>\n";
    std::size_t listed = 0;
    for (const auto& run : runs_) {
      if (listed++ == most_runs_listed) break;
      out_ += "<tr><td class=\"t\">" + breakable(title_of(run)) + "</td><td class=\"wide\">" +
              std::to_string(run.end - run.begin) + "</td>";
      for (const auto& gap : d_.gap) {
        const SignalSeries* s = run.of_signal(gap.signal);
        out_ += s == nullptr
                    ? "<td>\u2013</td>"
                    : "<td>" + readable(rms_of(run, *s, s->baseline)) + " \u2192 " +
                          readable(rms_of(run, *s, has_cause() ? s->augmented : s->recalibrated)) + "</td>";
      }
      out_ += "</tr>\n";
    }
    out_ += "</table>\n";
    if (runs_.size() > most_runs_listed)
      out_ += "<p class=\"soft\">" + std::to_string(runs_.size() - most_runs_listed) +
              " more runs were judged.</p>\n";
  }

  void curves() {
    if (runs_.empty()) return;
    out_ += "<h2>Measured and simulated</h2>\n";
    if (runs_.size() > 1) run_table();
    std::vector<std::size_t> order(runs_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return wrongness(runs_[a]) > wrongness(runs_[b]); });
    const std::size_t signals = std::max<std::size_t>(1, d_.gap.size());
    const std::size_t drawn =
        std::min({order.size(), most_runs_drawn, std::max<std::size_t>(1, most_pictures / signals)});
    order.resize(drawn);
    std::sort(order.begin(), order.end());
    if (drawn < runs_.size())
      out_ += drawn == 1
                  ? std::string("<p class=\"soft\">Drawn is the run in which the gap is largest.</p>\n")
                  : "<p class=\"soft\">Drawn are the " + std::to_string(drawn) +
                        " runs in which the gap is largest.</p>\n";
    for (const std::size_t index : order) run_pictures(runs_[index], "r" + std::to_string(index));
  }

  void run_pictures(const HeldOutRun& run, const std::string& name) {
    out_ += "<h3>" + breakable(title_of(run)) + "</h3>\n<figure>\n";
    const std::size_t caption_at = out_.size();
    const std::optional<double> from = shows_from(run);
    // An axis runs in windows of half a second: over a whole run nothing could be seen. The worst few seconds
    // tell; other signals are seen whole.
    std::optional<std::pair<double, double>> stretch;
    bool windows = false;
    double worst = -1.0;
    for (const SignalSeries* s : run.signals) {
      const GapScore* const gap = score_of(s->signal);
      if (gap == nullptr || !gap->horizon_s) continue;
      windows = true;
      const double ratio = rms_of(run, *s, s->baseline) / (gap->noise_floor > 0.0 ? gap->noise_floor : 1.0);
      if (!(ratio > worst)) continue;
      worst = ratio;
      stretch = worst_stretch(run, *s, *gap->horizon_s);
    }
    const auto draw = [&](Chart chart, bool in_windows) {
      chart.group = name + (in_windows ? "w" : "");
      if (in_windows) chart.view = stretch;
      chart.mark = from;
      out_ += to_html(chart);
    };
    for (const auto& gap : d_.gap) {
      const SignalSeries* s = run.of_signal(gap.signal);
      if (s == nullptr) continue;
      draw(signal_chart(run, *s, false), gap.horizon_s.has_value());
      draw(signal_chart(run, *s, true), gap.horizon_s.has_value());
    }
    for (const RunInput& input : inputs_of(run)) {
      Chart chart;
      chart.x_label = "time / s";
      chart.y_label = "input: " + axis_label(variable_text(input.column));
      chart.title = variable_text(input.column).text + ", " + title_of(run);
      chart.height = 90;
      chart.series.push_back({"", "input", Series::Style::steps, input.t_s, input.values, {}, {}});
      draw(std::move(chart), windows);
    }
    std::string caption;
    if (stretch) {
      const Eigen::VectorXd& t_s = run.signals.front()->t_s;
      const double whole = t_s[run.end - 1] - t_s[run.begin], shown = stretch->second - stretch->first;
      if (whole > 1.01 * shown)
        caption = "Shown: " + readable(shown, 2) + "\u00a0s of " + readable(whole) +
                  "\u00a0s, in which the simulation as configured is worst. ";
      caption += "Each window starts from the measured state.";
    }
    if (from)
      caption += std::string(caption.empty() ? "" : " ") + "The red line: from " + readable(*from) +
                 "\u00a0s on the fault shows.";
    if (!caption.empty()) out_.insert(caption_at, "<figcaption>" + caption + "</figcaption>\n");
    out_ += "</figure>\n";
  }

  // What is left on held-out data, against what noise alone would leave.
  void rests() {
    bool first = true;
    for (const auto& gap : d_.gap) {
      const RunErrors of = errors_of(runs_, gap.signal, has_cause());
      const Curve correlation = autocorrelation(of);
      const double rms = has_cause() ? gap.after : gap.before;
      if (correlation.x.size() < 3 || !(rms > 0.0)) continue;
      if (first)
        out_ +=
            "<h2>What is left</h2>\n<p class=\"soft\">Errors " +
            std::string(has_cause() ? "with the effect" : "as configured") +
            ", over all held-out rows. Noise alone would follow the dashed curve on the left, fall to zero at once on the right"
            " (an axis\u2019s errors are alike within a window), and have the same spectrum at every frequency.</p>\n";
      first = false;
      const double width = 4.0 * std::max(rms, gap.noise_floor);
      const std::string unit = unit_text(gap.unit).empty() ? "" : " / " + unit_text(gap.unit);
      const char* const role = has_cause() ? "augmented" : "baseline";
      Chart left;
      left.title = "How often each error of the " + signal_text(gap.signal) + " occurs";
      left.x_label = "simulated \u2212 measured" + unit;
      left.y_label = signal_text(gap.signal) + ": share of samples";
      left.height = 170;
      left.zero_line = true;
      Curve counts = histogram(of.errors, width);
      left.series.push_back({"errors", role, Series::Style::line, counts.x, counts.y, {}, {}});
      if (gap.noise_floor > 0.0) {
        counts = normal_histogram(width, gap.noise_floor);
        left.series.push_back({"noise alone", "noise", Series::Style::line, counts.x, counts.y, {}, {}});
      }
      Chart right;
      right.title = "How errors of the " + signal_text(gap.signal) + " resemble later ones";
      right.x_label = "time between the two / s";
      right.y_label = "correlation of errors";
      right.height = 170;
      right.zero_line = true;
      right.series.push_back({"errors", role, Series::Style::line, correlation.x, correlation.y, {}, {}});
      out_ += "<div class=\"pair\">\n" + to_html(left) + to_html(right) + "</div>\n" +
              spectrum_picture(gap, of, unit);
    }
  }

  std::string spectrum_picture(const GapScore& gap, const RunErrors& left, const std::string& unit) const {
    Chart chart;
    chart.title = "Spectrum of the errors of the " + signal_text(gap.signal);
    chart.x_label = "frequency / Hz";
    chart.y_label =
        signal_text(gap.signal) + ": spectrum of the errors" + (unit.empty() ? unit : unit + " per \u221aHz");
    chart.height = 190;
    chart.logarithmic = true;
    const auto draw = [&chart](const char* label, const char* role, const Curve& curve) {
      if (curve.x.size() > 2)
        chart.series.push_back({label, role, Series::Style::line, curve.x, curve.y, {}, {}});
    };
    draw("as configured", "baseline", spectrum(errors_of(runs_, gap.signal, false)));
    if (has_cause()) draw("with the effect", "augmented", spectrum(left));
    if (gap.noise_floor > 0.0)
      draw("noise floor, were it white", "noise", white_spectrum(left, gap.noise_floor));
    return chart.series.empty() ? "" : to_html(chart);
  }

  void missing() {
    bool first = true;
    for (const auto& q : d_.missing_quantities) {
      if (q.x.size() < 2 || q.value.size() != q.x.size()) continue;
      if (first) {
        out_ +=
            "<h2>The missing quantity</h2>\n<p class=\"soft\">What would have to be added to the model's equation to make it follow the "
            "recording, inferred from measurements alone" +
            std::string(
                has_cause()
                    ? ", and what the model supplies of it with the effect found and its constants refitted.</p>\n"
                    : ".</p>\n");
        first = false;
      }
      Chart chart;
      const VariableText variable = variable_text(q.variable, q.variable_unit);
      chart.title = to_string(q.quantity) + " against " + variable.text;
      chart.x_label = axis_label(variable);
      chart.y_label = axis_label({to_string(q.quantity), unit_text(q.unit)});
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
      std::string said;
      if (q.effect.size() > 1 && q.effect.size() == q.effect_x.size()) {
        std::vector<std::string> ids;
        for (const auto& cause : d_.cause) ids.push_back(cause.effect);
        chart.series.push_back(
            {joined(ids), "effect", Series::Style::line, numbers(q.effect_x), numbers(q.effect), {}, {}});
        if (q.effect_freedom > 0.0)
          said = "The curve is a smoothing spline with " + readable(q.effect_freedom, 2) +
                 " degrees of freedom.";
      }
      for (const auto& where : d_.where) {
        if (where.signal == q.signal && where.regime && where.regime->variable == q.variable)
          chart.shade = {where.regime->from, where.regime->to};
      }
      if (chart.shade) said = "Shaded: where it is largest." + std::string(said.empty() ? "" : " ") + said;
      out_ += "<figure>\n" + to_html(chart) +
              (said.empty() ? "" : "<figcaption>" + said + "</figcaption>\n") + "</figure>\n";
    }
  }

  // The place in which the causes act, where residuals alone point at another one first; else empty.
  std::string acts_elsewhere() const {
    if (d_.where.empty() || !has_cause()) return {};
    std::string place;
    for (const Cause& cause : d_.cause) {
      const EffectInfo* const known = info(cause.effect);
      if (known == nullptr || known->submodel == d_.where.front().submodel) return {};
      const std::string words = part_in_words(to_string(known->submodel));
      if (place.find(words) == std::string::npos) place += (place.empty() ? "" : " and the ") + words;
    }
    return place;
  }

  void where() {
    if (d_.where.empty()) return;
    out_ +=
        "<h2>Where</h2>\n<p class=\"soft\">Found from residuals alone, before any effect is considered.</p>\n";
    if (const std::string elsewhere = acts_elsewhere(); !elsewhere.empty())
      out_ +=
          "<p>The residuals point at the " + escaped(part_in_words(to_string(d_.where.front().submodel))) +
          " first, and the explanation acts in the " + escaped(elsewhere) +
          ". A cause in one place may look like one in another; held-out data decide between explanations, not between places.</p>\n";
    for (const auto& one : d_.where) {
      out_ += "<div class=\"where\"><b>" + breakable(to_string(one.submodel)) + "</b> in " +
              escaped(signal_text(one.signal)) + ", " + share_of_gap(one);
      if (one.regime) out_ += "; most for " + regime_html(*one.regime);
      out_ += ".";
      if (!one.only_in.empty()) out_ += "<br>Only in " + occurrences(one.only_in) + ".";
      out_ += "<br><span class=\"soft\">" + escaped(with_signs(capital(one.evidence))) + "</span></div>\n";
    }
  }

  bool is_chosen(const RankedExplanation& one) const {
    if (one.effects.size() != d_.cause.size()) return false;
    return std::all_of(d_.cause.begin(), d_.cause.end(), [&](const Cause& cause) {
      return std::find(one.effects.begin(), one.effects.end(), cause.effect) != one.effects.end();
    });
  }

  static std::string probability(double share) {
    char width[16];
    std::snprintf(width, sizeof width, "%.0f", std::max(1.0, 88.0 * std::min(1.0, std::max(0.0, share))));
    return "<td class=\"t nowrap\"><span class=\"track\"><span class=\"bar\" style=\"width:" +
           std::string(width) + "px\"></span></span>" + percent_html(share) + "</td>";
  }

  // The class of an explanation's curves; empty where none are drawn.
  std::string role_of(const RankedExplanation& one) const {
    if (runs_.empty()) return {};
    if (has_cause() && is_chosen(one)) return "augmented";
    for (const HeldOutRun& run : runs_)
      for (const SignalSeries* s : run.signals)
        for (std::size_t i = 0; i < s->rivals.size() && i < most_rivals; ++i)
          if (s->rivals[i].effects == one.effects) return rival_roles[i];
    return {};
  }

  void explanation(const RankedExplanation& one) {
    const bool chosen = is_chosen(one) && has_cause();
    out_ += std::string("<tr") +
            (chosen                        ? " class=\"chosen\""
             : one.lacks != Lacks::nothing ? " class=\"out\""
                                           : "") +
            "><td class=\"t\">" +
            (one.effects.empty() ? "nothing is missing" : breakable(joined(one.effects)));
    std::string small;
    const auto add = [&small](const std::string& text) { small += (small.empty() ? "" : "<br>") + text; };
    if (one.effects.size() == 1) {
      if (const EffectInfo* const known = info(one.effects.front())) add(escaped(known->prose));
    }
    if (chosen) {
      for (const auto& parameter : one.parameters)
        add(breakable(parameter.name) + " = " + with_unit(readable(parameter.value), parameter.unit) + " " +
            known_to(parameter));
    }
    if (one.lacks != Lacks::nothing) add(in_words(one.lacks).words);
    if (const std::string why = why_less_likely(one); !why.empty()) add(why);
    std::string like;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, one.confusable.size()); ++i)
      like += (like.empty() ? "" : ", ") + breakable(joined(one.confusable[i].effects)) + " (" +
              readable(one.confusable[i].cosine, 2) + ")";
    if (!like.empty()) add("looks like " + like);
    const std::string role = role_of(one);
    if (!role.empty())
      small += "<span class=\"key switch\" data-role=\"" + role +
               "\"><svg viewBox=\"0 0 24 8\"><path class=\"curve " + role +
               "\" d=\"M1 4h22\"/></svg>in the pictures</span>";
    out_ += (small.empty() ? "" : "<small>" + small + "</small>") + "</td>" + probability(one.probability) +
            "<td>" + (one.held_out_ratio > 0.0 ? percent_html(1.0 - one.held_out_ratio) : "\u2013") +
            "</td></tr>\n";
  }

  // What speaks against an explanation that leaves less on held-out data than the chosen one.
  std::string why_less_likely(const RankedExplanation& one) const {
    if (!has_cause() || one.lacks != Lacks::nothing || !(one.held_out_ratio > 0.0)) return {};
    for (const RankedExplanation& chosen : d_.ranking) {
      if (!is_chosen(chosen)) continue;
      if (!(one.held_out_ratio < chosen.held_out_ratio) || one.probability >= chosen.probability) return {};
      if (one.effects.size() > chosen.effects.size())
        return "takes more away, with more causes than the recording proves";
      return "takes more away there, and is less likely on all data with what is known of the constants";
    }
    return {};
  }

  void which() {
    if (d_.ranking.empty()) return;
    out_ +=
        "<h2>Which</h2>\n<table>\n<tr><th class=\"t\">explanation</th><th class=\"t\">probability</th>"
        "<th>takes away<small>of the held-out error that refitted constants leave</small></th></tr>\n";
    std::vector<RankedExplanation> order = d_.ranking;
    std::stable_sort(order.begin(), order.end(), [](const RankedExplanation& a, const RankedExplanation& b) {
      const auto at = [](const RankedExplanation& one) {
        return std::isfinite(one.probability) ? one.probability : -1.0;
      };
      return at(a) > at(b);
    });
    for (std::size_t i = 0; i < std::min(most_ranked, order.size()); ++i) explanation(order[i]);
    out_ += "<tr><td class=\"t\">none of these</td>" + probability(d_.none_of_these) +
            "<td></td></tr>\n</table>\n";
    if (d_.ranking.size() > most_ranked)
      out_ += "<p class=\"soft\">" + std::to_string(d_.ranking.size() - most_ranked) +
              " more were weighed; all are in the JSON report.</p>\n";
    out_ +=
        "<p class=\"soft\">\u201cLooks like\u201d: cosine of the two signatures in this recording, whitened and freed of what the "
        "model\u2019s own constants can imitate. Above 0.95 the recording cannot tell them apart.</p>\n";
  }

  void constants() {
    if (d_.constants.empty()) return;
    out_ +=
        "<h2>Constants</h2>\n<p class=\"soft\">Every constant that a fit may move.</p>\n"
        "<table>\n<tr><th class=\"t\">constant</th><th>as con\u00adfigured</th><th>" +
        std::string(d_.cause.empty() ? "re\u00adcalibrated" : "with the effect") +
        "</th><th>moved by</th><th>known to</th></tr>\n";
    for (const auto& constant : d_.constants) {
      const double moved = constant.configured != 0.0 ? constant.fitted / constant.configured - 1.0 : 0.0;
      char text[24];
      if (constant.is_place)
        std::snprintf(text, sizeof text, "%+.3g\u00a0rad", constant.fitted - constant.configured);
      else std::snprintf(text, sizeof text, "%+.1f\u00a0%%", 100.0 * moved);
      const std::string known = constant.is_place ? readable(constant.uncertainty) + "\u00a0rad"
                                                  : percent_html(constant.uncertainty);
      out_ += "<tr><td class=\"t\"><code>" + breakable(constant.name) + "</code></td><td>" +
              readable(constant.configured, 4) + "</td><td>" + readable(constant.fitted, 4) + "</td><td>" +
              text + "</td><td>" + (constant.uncertainty > 0.0 ? "\u00b1\u2009" + known : "\u2013") +
              "</td></tr>\n";
    }
    out_ += "</table>\n";
  }

  // Those of the effect first, then the constants that hang together with them most.
  std::vector<std::size_t> shown_together() const {
    const auto& names = d_.correlation.names;
    const auto largest = [&](std::size_t i) {
      double most = 0.0;
      for (std::size_t k = 0; k < names.size(); ++k)
        if (k != i)
          most = std::fmax(
              most, std::fabs(d_.correlation.of(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k))));
      return most;
    };
    const auto is_constant = [&](std::size_t i) {
      const std::string& name = names[i];
      const auto ends = [&](const char* ending) {
        return name.size() > 6 && name.compare(name.size() - 6, 6, ending) == 0;
      };
      return ends(".scale") || ends(".shift");
    };
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < names.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return is_constant(a) != is_constant(b) ? is_constant(b) : largest(a) > largest(b);
    });
    order.resize(std::min(order.size(), most_together));
    return order;
  }

  void together() {
    const auto& all = d_.correlation;
    if (all.names.size() < 2 || all.of.rows() != static_cast<Eigen::Index>(all.names.size())) return;
    const std::vector<std::size_t> shown = shown_together();
    const auto at = [&](std::size_t a, std::size_t b) {
      return all.of(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    };
    out_ +=
        "<h2>What the estimates have in common</h2>\n<p class=\"soft\">Correlation of the parameters that were fitted together. Near 1 or "
        "\u22121 the recording shows little more of two of them than one combination.</p>\n"
        "<table class=\"together\">\n<tr><th class=\"t\">parameter</th>";
    for (std::size_t k = 0; k < shown.size(); ++k) out_ += "<th>" + std::to_string(k + 1) + "</th>";
    out_ += "</tr>\n";
    for (std::size_t i = 0; i < shown.size(); ++i) {
      out_ += "<tr><td class=\"t\">" + std::to_string(i + 1) + "\u2002" + breakable(all.names[shown[i]]) +
              "</td>";
      for (std::size_t k = 0; k < shown.size(); ++k) {
        const double value = at(shown[i], shown[k]);
        if (k > i) out_ += "<td></td>";
        else if (k == i) out_ += "<td>1</td>";
        else if (!std::isfinite(value)) out_ += "<td>\u2013</td>";
        else {
          char text[96];
          std::snprintf(text, sizeof text, "<td style=\"background:rgba(%s,%.2f)\">%s%.2f</td>",
                        value < 0.0 ? "213,94,0" : "0,114,178", 0.5 * std::fabs(value),
                        value < 0.0 ? "\u2212" : "", std::fabs(value));
          out_ += text;
        }
      }
      out_ += "</tr>\n";
    }
    out_ += "</table>\n";
    if (shown.size() < all.names.size())
      out_ += "<p class=\"soft\">" + std::to_string(all.names.size() - shown.size()) +
              " more constants were fitted along; all are in the JSON report.</p>\n";
  }

  void data() {
    const bool notes = std::any_of(d_.findings.begin(), d_.findings.end(),
                                   [](const Finding& one) { return one.severity == Severity::note; });
    if (!notes && d_.not_judged.empty()) return;
    out_ += "<h2>About the data</h2>\n";
    if (!d_.not_judged.empty()) {
      out_ += "<h3>Not judged</h3>\n<ul>\n";
      for (const auto& one : d_.not_judged) out_ += "<li>" + escaped(one) + "</li>\n";
      out_ += "</ul>\n";
    }
    if (!notes) return;
    out_ += "<h3>Good to know</h3>\n";
    for (const auto& one : d_.findings)
      if (one.severity == Severity::note) finding(one);
  }

  void foot() {
    out_ +=
        "<footer>Intervals cover 95 % and respect that residuals of neighbouring samples are alike. \u201cAs configured\u201d is the model as "
        "given; \u201crecalibrated\u201d is the same with its own constants refitted and nothing added. The noise floor is what a perfect "
        "model would score.</footer>\n</main>\n<script>" +
        std::string(report_script) + "</script>\n</body>\n</html>\n";
  }

  const Diagnosis& d_;
  const std::string& model_;
  const std::vector<EffectInfo>& effects_;
  const Provenance& made_of_;
  std::vector<HeldOutRun> runs_;
  std::string out_;
};

}  // namespace

std::string report_html(const Diagnosis& diagnosis, const std::string& model_name,
                        const std::vector<EffectInfo>& effects, const std::vector<Recording>& held_out,
                        const Provenance& made_of) {
  return Page(diagnosis, model_name, effects, held_out, made_of).write();
}

}  // namespace thermopower::io
