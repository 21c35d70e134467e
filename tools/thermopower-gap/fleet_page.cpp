// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "fleet_results.hpp"

#include "chart.hpp"
#include "html_text.hpp"
#include "report_style.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace io = thermopower::io;
namespace pool = thermopower::gap::pool;

namespace {

using io::escaped;
using io::readable;

// What a fleet has beyond a report: a strip of dots for each parameter.
constexpr const char* style = R"css(
.strip{position:relative;height:58px;margin:2px 0 0}.strip a{position:absolute;width:9px;height:9px;margin:-4.5px 0 0 -4.5px;border-radius:5px;background:var(--augmented);opacity:.45}
.strip a:hover,.strip a:focus{opacity:1;outline:2px solid var(--ink)}.strip a.odd{background:var(--baseline);opacity:1;border-radius:1px;transform:rotate(45deg);z-index:1}
.strip .span{position:absolute;top:8px;bottom:8px;background:var(--band)}.strip .mean{position:absolute;top:3px;bottom:3px;width:2px;margin-left:-1px;background:var(--ink)}
.scale{display:flex;justify-content:space-between;font-size:13px;color:var(--soft);border-top:1px solid var(--soft);padding-top:2px;font-variant-numeric:tabular-nums}
.parameter{margin:18px 0 26px}.parameter .head{display:flex;flex-wrap:wrap;gap:0 18px;align-items:baseline}.parameter .head b{margin-right:auto}
a{color:var(--augmented)}.scroll{overflow-x:auto}
@media (max-width:600px){.strip a{width:8px;height:8px}}
)css";

std::string count_of(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string family_name(const pool::Family& family) {
  return family.cause.empty() ? "nothing missing" : family.cause;
}

class Page {
public:
  explicit Page(const FleetResults& fleet) : fleet_(fleet), verdict_(fleet.verdict) {}

  std::string run() {
    out_ =
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width,initial-scale=1\"><title>Fleet: " +
        count_of(verdict_.units.size(), "unit", "units") + "</title><style>" + io::report_style + style +
        "</style></head><body><main>\n";
    head();
    odd_units();
    drifts();
    weak_effects();
    for (const pool::Family& family : verdict_.families) strips(family);
    bad_logs();
    all_units();
    out_ +=
        "<footer>thermopower-fleet/1. The same for machines: <code>fleet.json</code>, <code>units.csv</code>, "
        "<code>logs.csv</code>, <code>fleet.sqlite</code>.</footer>\n</main></body></html>\n";
    return std::move(out_);
  }

private:
  std::size_t odd_count() const {
    return static_cast<std::size_t>(
        std::count_if(verdict_.units.begin(), verdict_.units.end(),
                      [](const auto& one) { return one.oddity != pool::Oddity::none; }));
  }

  void fact(const std::string& name, const std::string& value, const std::string& more) {
    out_ += "<div class=\"fact\"><span class=\"name\">" + name + "</span><b>" + value +
            "</b><span class=\"more\">" + more + "</span></div>\n";
  }

  void head() {
    std::size_t drifting = 0;
    for (const pool::UnitVerdict& one : verdict_.units) drifting += one.drifts.empty() ? 0 : 1;
    out_ += "<p class=\"eyebrow\">Fleet</p><h1>" + count_of(verdict_.units.size(), "unit", "units") + " in " +
            count_of(fleet_.logs.size(), "log", "logs") + "</h1>\n<p class=\"lead\">" + sentence() + "</p>\n";
    out_ += "<div class=\"facts\">\n";
    std::string causes;
    for (const pool::Family& one : verdict_.families) {
      if (!causes.empty()) causes += "<br>";
      causes += io::breakable(family_name(one)) + ": " +
                count_of(static_cast<std::size_t>(std::lround(one.prevalence.units)), "unit", "units");
    }
    fact("Families", std::to_string(verdict_.families.size()), causes);
    fact("Odd units", std::to_string(odd_count()),
         "a fleet without any would have one named once in a hundred fleets");
    const std::string not_judged = drift_not_judged(fleet_);
    if (drifting > 0 || not_judged.empty())
      fact("Units that drift", std::to_string(drifting), "a false one once in a hundred fleets");
    else fact("Units that drift", "not judged", escaped(not_judged));
    fact("Logs that say nothing", std::to_string(verdict_.bad_logs.size()),
         "too little data, or data that cannot be believed");
    out_ += "</div>\n";
  }

  std::string sentence() const {
    if (verdict_.families.empty()) return "No cause is shared by enough units to be called a family's.";
    std::string text = verdict_.structure_differs
                           ? "The units differ in structure: " + std::to_string(verdict_.families.size()) +
                                 " families have causes of their own"
                           : "One structure holds for all units";
    text += verdict_.parameters_differ
                ? ", and within a family they differ in their parameters."
                : ", and what differs between their parameters is within their errors.";
    return text;
  }

  std::string page_of(const pool::UnitVerdict& unit) const {
    for (const std::size_t log : unit.logs)
      if (!fleet_.logs[log].page.empty()) return fleet_.logs[log].page;
    return {};
  }

  /// The unit's name, a click from the page of its first log. A short one does not break.
  std::string linked(const pool::UnitVerdict& unit) const {
    constexpr std::size_t is_short = 16;
    const std::string page = page_of(unit), name = named(unit, page);
    return unit.unit.size() > is_short ? name : "<span class=\"nowrap\">" + name + "</span>";
  }

  static std::string named(const pool::UnitVerdict& unit, const std::string& page) {
    return page.empty() ? io::breakable(unit.unit)
                        : "<a href=\"" + escaped(page) + "\">" + io::breakable(unit.unit) + "</a>";
  }

  /// The pages of a unit's logs, each a click away.
  std::string logs_of(const pool::UnitVerdict& unit) const {
    constexpr std::size_t shown = 12;
    std::string text;
    for (std::size_t i = 0; i < std::min(shown, unit.logs.size()); ++i) {
      const FleetLog& log = fleet_.logs[unit.logs[i]];
      const double days = log.manifest->time_days;
      const std::string name = std::isfinite(days) ? date_of(days) : "log " + std::to_string(i + 1);
      text += text.empty() ? "" : " ";
      text += log.page.empty() ? "<span class=\"nowrap\">" + name + "</span>"
                               : "<a class=\"nowrap\" href=\"" + escaped(log.page) + "\">" + name + "</a>";
    }
    return text;
  }

  const pool::Family* family_of(const pool::UnitVerdict& unit) const {
    return unit.family >= 0 ? &verdict_.families[static_cast<std::size_t>(unit.family)] : nullptr;
  }

  std::string value_of(const pool::Family& family, std::size_t c, double at, int digits = 3) const {
    return readable(shown_value(at, family.logarithmic[c]), digits);
  }

  /// So many digits that the ends of a range differ in the last two.
  int digits_of(const pool::Family& family, std::size_t c, double low, double high) const {
    const double from = shown_value(low, family.logarithmic[c]),
                 to = shown_value(high, family.logarithmic[c]);
    const double share = std::abs(to - from) / std::max(std::abs(from), std::abs(to));
    return share > 0.0 && share < 1.0
               ? std::min(8, std::max(3, 2 + static_cast<int>(std::ceil(-std::log10(share)))))
               : 3;
  }

  std::string why_odd(const pool::UnitVerdict& unit) const {
    const pool::Family& family = *family_of(unit);
    std::string text;
    if (unit.oddity == pool::Oddity::misfit) {
      text = "What its family lacks (" + io::breakable(family_name(family)) + ") leaves " +
             readable(unit.misfit, 3) + " times the others' error.";
    } else {
      const auto c = static_cast<std::size_t>(unit.standing.coordinate);
      const auto at = static_cast<Eigen::Index>(c);
      text = io::breakable(parameter_name(family.coordinates[c])) + " is " +
             value_of(family, c, unit.estimate->at[at]) + " where the others have " +
             value_of(family, c, family.spread.mean[at]) + ", " +
             readable(std::abs(unit.standing.standard_deviations), 2) + " standard deviations off" +
             (unit.standing.distance > 1.5 * std::abs(unit.standing.standard_deviations)
                  ? "; with the others of its parameters " + readable(unit.standing.distance, 2) + "."
                  : std::string("."));
    }
    if (!unit.member && !unit.own_cause.empty())
      text += " Its own logs say: " + io::breakable(unit.own_cause) + ".";
    return text;
  }

  std::vector<const pool::UnitVerdict*> odd_first() const {
    std::vector<const pool::UnitVerdict*> units;
    for (const pool::UnitVerdict& one : verdict_.units) units.push_back(&one);
    std::stable_sort(units.begin(), units.end(), [](const auto* a, const auto* b) {
      const bool first = a->oddity != pool::Oddity::none, second = b->oddity != pool::Oddity::none;
      if (first != second) return first;
      return first && a->standing.distance > b->standing.distance;
    });
    return units;
  }

  void odd_units() {
    out_ += "<h2>Odd units</h2>\n";
    if (odd_count() == 0) {
      out_ += "<p>None: every unit is what its family's spread would have.</p>\n";
      return;
    }
    out_ +=
        "<table><tr><th class=\"t\">unit</th><th class=\"t\">why</th><th class=\"t wide\">logs</th></tr>\n";
    for (const pool::UnitVerdict* unit : odd_first())
      if (unit->oddity != pool::Oddity::none)
        out_ += "<tr><td class=\"t\">" + linked(*unit) + "</td><td class=\"t\">" + why_odd(*unit) +
                "</td><td class=\"t wide\">" + logs_of(*unit) + "</td></tr>\n";
    out_ += "</table>\n";
  }

  void drifts() {
    bool any = false;
    for (const pool::UnitVerdict& unit : verdict_.units)
      for (const pool::UnitDrift& one : unit.drifts) {
        if (!any)
          out_ +=
              "<h2>Drift</h2>\n<table><tr><th class=\"t\">unit</th><th class=\"t\">parameter</th><th>by</th><th "
              "class=\"t\">since</th></tr>\n";
        any = true;
        const pool::Family& family = *family_of(unit);
        const auto place = std::find(family.coordinates.begin(), family.coordinates.end(), one.coordinate);
        const bool logarithmic =
            family.logarithmic[static_cast<std::size_t>(place - family.coordinates.begin())];
        const std::string size = logarithmic ? readable(100.0 * std::expm1(one.drift.size), 2) + "&nbsp;%"
                                             : readable(one.drift.size, 2);
        out_ += "<tr><td class=\"t\">" + linked(unit) + "</td><td class=\"t\">" +
                io::breakable(parameter_name(one.coordinate)) + "</td><td class=\"nowrap\">" + size +
                "</td><td class=\"t\">" +
                (one.drift.kind == pool::DriftKind::slope ? "steadily, " : "at once, between ") +
                date_of(one.drift.since) + (one.drift.kind == pool::DriftKind::slope ? " to " : " and ") +
                date_of(one.drift.until) + "</td></tr>\n";
      }
    if (!any) return;
    out_ += "</table>\n";
    constexpr std::size_t most = 24;
    std::size_t drawn = 0, count = 0;
    for (const pool::UnitVerdict& unit : verdict_.units) count += unit.drifts.size();
    for (const pool::UnitVerdict& unit : verdict_.units)
      for (const pool::UnitDrift& one : unit.drifts)
        if (drawn++ < most) out_ += io::to_html(course(unit, one));
    if (count > most)
      out_ += "<p class=\"soft\">The first " + std::to_string(most) + " of " + std::to_string(count) +
              " are drawn.</p>\n";
  }

  /// The values of a unit's logs over time, with their 95 % intervals, and the course that was found.
  io::Chart course(const pool::UnitVerdict& unit, const pool::UnitDrift& one) const {
    const pool::Family& family = *family_of(unit);
    const auto c = static_cast<std::size_t>(
        std::find(family.coordinates.begin(), family.coordinates.end(), one.coordinate) -
        family.coordinates.begin());
    const auto shown = [&](double at) { return shown_value(at, family.logarithmic[c]); };
    const pool::TimeSeries& logs = one.series;
    const double first = logs.time.front();
    io::Series values{
        "each log, with its 95 % interval", "missing", io::Series::Style::points, {}, {}, {}, {}};
    io::Series bars{"", "missing", io::Series::Style::interval, {}, {}, {}, {}};
    io::Series fitted{"the drift", "augmented", io::Series::Style::line, {}, {}, {}, {}};
    double sum = 0.0, weighed = 0.0;
    // What is left when the drift is taken off says where it begins.
    const auto drifted = [&](std::size_t i) {
      if (one.drift.kind == pool::DriftKind::slope) return one.drift.per_day * (logs.time[i] - first);
      return logs.time[i] >= middle_of(one.drift) ? one.drift.size : 0.0;
    };
    for (std::size_t i = 0; i < logs.at.size(); ++i) {
      const double variance = logs.variance[i] + family.scatter[c].variance,
                   reach = 1.96 * std::sqrt(variance);
      sum += 1.0 / std::max(variance, 1e-300);
      weighed += (logs.at[i] - drifted(i)) / std::max(variance, 1e-300);
      for (io::Series* series : {&values, &bars}) {
        series->x.push_back(logs.time[i] - first);
        series->y.push_back(shown(logs.at[i]));
      }
      bars.low.push_back(shown(logs.at[i] - reach));
      bars.high.push_back(shown(logs.at[i] + reach));
    }
    for (std::size_t i = 0; i < logs.at.size(); ++i) {
      fitted.x.push_back(logs.time[i] - first);
      fitted.y.push_back(shown(weighed / sum + drifted(i)));
    }
    io::Chart chart;
    chart.title = unit.unit + ": " + parameter_name(one.coordinate);
    chart.x_label = "days since " + date_of(first);
    chart.y_label =
        unit.unit + ": " + parameter_name(one.coordinate) +
        (parameter_name(one.coordinate) != one.coordinate ? ", as a share of the configured" : "");
    chart.series = {bars, values, fitted};
    chart.height = 150;
    return chart;
  }

  /// Between the logs between which a change lies.
  static double middle_of(const pool::Drift& drift) { return 0.5 * (drift.since + drift.until); }

  void weak_effects() {
    if (verdict_.weak.empty() || !verdict_.weak.front().stands) return;
    const pool::WeakEffect& one = verdict_.weak.front();
    out_ +=
        "<h2>Too weak for any single log</h2>\n<p>Among the units whose own logs find nothing missing, <b>" +
        io::breakable(one.explanation) + "</b> helps a little in most: on held-out data of " +
        std::to_string(one.units) + " units by chance only with a probability of " + readable(one.p, 2) + ".";
    if (!one.not_told_from.empty())
      out_ += " The fleet cannot tell it from " + io::breakable(io::joined(one.not_told_from, ", ")) + ".";
    if (!verdict_.weak_shift.empty())
      out_ += " What it makes of the constants of all units is in the values here.";
    out_ += "</p>\n";
  }

  /// Dots of one parameter over all units of a family; a stable draw of the sound ones where there are very many.
  void strips(const pool::Family& family) {
    const auto index = static_cast<int>(&family - verdict_.families.data());
    out_ += "<h2>Family: " + io::breakable(family_name(family)) + ", " +
            count_of(static_cast<std::size_t>(std::lround(family.prevalence.units)), "unit", "units") +
            "</h2>\n<p class=\"soft\">" + io::percent_html(family.prevalence.share90.low) + " to " +
            io::percent_html(family.prevalence.share90.high) + " of all units (90 % interval).</p>\n";
    if (family.spread.size() == 0) {
      out_ += "<p>Too few units to compare parameters.</p>\n";
      return;
    }
    std::vector<const pool::UnitVerdict*> units;
    for (const pool::UnitVerdict& one : verdict_.units)
      if (one.family == index && one.estimate && one.shrunken) units.push_back(&one);
    constexpr std::size_t most = 500;
    const std::size_t step = units.size() / most + 1;
    for (std::size_t c = 0; c < family.coordinates.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const pool::Range range = pool::prediction_range(family.spread, at, 0.9);
      double low = range.low, high = range.high;
      for (const pool::UnitVerdict* one : units) {
        low = std::min(low, one->shrunken->at[at]);
        high = std::max(high, one->shrunken->at[at]);
      }
      const double margin = 0.04 * std::max(high - low, 1e-9);
      low -= margin;
      high += margin;
      const int digits = digits_of(family, c, low, high);
      const auto place = [&](double value) {
        char text[24];
        std::snprintf(text, sizeof text, "%.2f%%", 100.0 * (value - low) / (high - low));
        return std::string(text);
      };
      const double sd = std::sqrt(std::max(family.spread.between(at, at), 0.0));
      const std::string spread =
          family.differs[c]
              ? "spread " + (family.logarithmic[c] ? readable(100.0 * sd, 2) + "&nbsp;%" : readable(sd, 2))
              : "no spread beyond the errors";
      out_ += "<div class=\"parameter\"><div class=\"head\"><b>" +
              io::breakable(parameter_name(family.coordinates[c])) +
              (parameter_name(family.coordinates[c]) != family.coordinates[c]
                   ? " <span class=\"soft\">(of the configured)</span>"
                   : "") +
              "</b><span>mean " + value_of(family, c, family.spread.mean[at], digits) + "</span><span>" +
              spread + "</span><span>nine in ten within " + value_of(family, c, range.low, digits) + " to " +
              value_of(family, c, range.high, digits) +
              "</span></div>\n<div class=\"strip\"><i class=\"span\" style=\"left:" + place(range.low) +
              ";width:calc(" + place(range.high) + " - " + place(range.low) +
              ")\"></i><i class=\"mean\" style=\"left:" + place(family.spread.mean[at]) + "\"></i>";
      for (std::size_t i = 0; i < units.size(); ++i) {
        const pool::UnitVerdict& one = *units[i];
        const bool odd = one.oddity != pool::Oddity::none;
        if (!odd && i % step != 0) continue;
        const std::string page = page_of(one);
        const double lane = odd ? 0.5 : 0.2 + 0.6 * static_cast<double>((i * 7) % 11) / 10.0;
        char top[16];
        std::snprintf(top, sizeof top, "%.0f%%", 100.0 * lane);
        out_ += std::string("<a") + (odd ? " class=\"odd\"" : "") +
                (page.empty() ? std::string() : " href=\"" + escaped(page) + "\"") +
                " style=\"left:" + place(one.shrunken->at[at]) + ";top:" + top + "\" title=\"" +
                escaped(one.unit) + ": " + value_of(family, c, one.shrunken->at[at], digits) +
                "\" aria-label=\"" + escaped(one.unit) + "\"></a>";
      }
      out_ += "</div>\n<div class=\"scale\"><span>" + value_of(family, c, low, digits) + "</span><span>" +
              value_of(family, c, 0.5 * (low + high), digits) + "</span><span>" +
              value_of(family, c, high, digits) + "</span></div></div>\n";
    }
    if (step > 1)
      out_ += "<p class=\"soft\">Of the units that are not odd one in " + std::to_string(step) +
              " is drawn.</p>\n";
  }

  void bad_logs() {
    if (verdict_.bad_logs.empty()) return;
    out_ +=
        "<h2>Logs that say nothing</h2>\n<table><tr><th class=\"t\">log</th><th class=\"t\">why</th></tr>\n";
    constexpr std::size_t most = 200;
    for (std::size_t i = 0; i < std::min(most, verdict_.bad_logs.size()); ++i) {
      const pool::BadLog& one = verdict_.bad_logs[i];
      const FleetLog& log = fleet_.logs[one.log];
      const std::string name = io::breakable(log.manifest->cell("log"));
      out_ += "<tr><td class=\"t\">" +
              (log.page.empty() ? name : "<a href=\"" + escaped(log.page) + "\">" + name + "</a>") +
              "</td><td class=\"t\">" + escaped(one.reason) + "</td></tr>\n";
    }
    out_ += "</table>\n";
    if (verdict_.bad_logs.size() > most)
      out_ += "<p class=\"soft\">And " + std::to_string(verdict_.bad_logs.size() - most) +
              " more in <code>logs.csv</code>.</p>\n";
  }

  void all_units() {
    constexpr std::size_t most = 1000;
    out_ +=
        "<h2>All units</h2>\n<table><tr><th class=\"t\">unit</th><th class=\"t\">family</th><th "
        "class=\"t\">furthest off</th><th>distance</th><th class=\"t wide\">logs</th></tr>\n";
    const std::vector<const pool::UnitVerdict*> units = odd_first();
    for (std::size_t i = 0; i < std::min(most, units.size()); ++i) {
      const pool::UnitVerdict& unit = *units[i];
      const pool::Family* family = family_of(unit);
      const bool compared = family != nullptr && unit.estimate && family->spread.size() > 0;
      out_ += std::string("<tr") + (unit.oddity != pool::Oddity::none ? " class=\"chosen\"" : "") +
              "><td class=\"t\">" + linked(unit) + "</td><td class=\"t\">" +
              (family == nullptr ? "none" : io::breakable(family_name(*family))) +
              (unit.member
                   ? ""
                   : "<small>by what fits it best; its own: " + io::breakable(unit.own_cause) + "</small>") +
              "</td><td class=\"t\">" +
              (compared ? io::breakable(parameter_name(
                              family->coordinates[static_cast<std::size_t>(unit.standing.coordinate)]))
                        : std::string()) +
              "</td><td>" + (compared ? readable(unit.standing.distance, 2) : std::string()) +
              "</td><td class=\"t wide\">" + logs_of(unit) + "</td></tr>\n";
    }
    out_ += "</table>\n";
    if (units.size() > most)
      out_ += "<p class=\"soft\">And " + std::to_string(units.size() - most) +
              " more in <code>units.csv</code>.</p>\n";
  }

  const FleetResults& fleet_;
  const pool::FleetVerdict& verdict_;
  std::string out_;
};

}  // namespace

std::string fleet_page(const FleetResults& fleet) { return Page(fleet).run(); }
