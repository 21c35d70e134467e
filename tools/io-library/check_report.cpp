// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/check_report.hpp>

#include <thermopower/io/report_json.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/plant/variable_words.hpp>
#include "html_text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(double share) {
  char text[32];
  if (share > 10.0) return "not at all";
  std::snprintf(text, sizeof text,
                share < 0.001 ? "%.2f %%"
                : share < 0.1 ? "%.1f %%"
                              : "%.0f %%",
                100.0 * share);
  return text;
}

// Constants that these data only determine in their ratio: a minus in front of a name says that it moves the other way.
std::string together(const std::vector<std::string>& constants, double sd) {
  constexpr double no_limit = 10.0;  // as percent() has it
  const bool opposed =
      std::any_of(constants.begin(), constants.end(), [](const std::string& one) { return one[0] == '-'; });
  return joined(constants, ", ") +
         (sd <= no_limit ? ": these data do not notice when they move together by " + percent(sd)
                         : ": these data do not notice when they move together, by any amount") +
         (opposed ? " (those with a minus the other way)" : "");
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::string check_text(const DataReport& report) {
  constexpr double visible = 0.5;  // noise units
  const bool decided = deciding(report.findings) != nullptr;
  std::string out = decided                      ? "THE DATA CANNOT BE BELIEVED AS THEY STAND\n"
                    : !report.too_little.empty() ? "TOO LITTLE DATA\n"
                    : report.findings.empty()    ? "NOTHING WRONG WITH THE DATA\n"
                                                 : "THE DATA CAN BE USED\n";
  if (!decided && !report.too_little.empty())
    out += summary_line("", report.too_little) + summary_line("next", report.next_experiment);
  out += findings_text(report.findings, Severity::note);
  for (const auto& one : report.not_judged) out += summary_line("not judged", one);
  char row[160];
  if (!report.signals.empty()) {
    std::snprintf(row, sizeof row, "\n  %-24s%10s%14s%14s%18s\n", "signal", "samples", "range", "noise",
                  "as configured");
    out += row;
    for (const auto& one : report.signals) {
      std::snprintf(row, sizeof row, "  %-24s%10td%14s%14s%18s\n",
                    (plant::in_words(one.signal) + " / " + one.unit).c_str(),
                    static_cast<std::ptrdiff_t>(one.samples), readable(one.range).c_str(),
                    readable(one.noise).c_str(), readable(one.misfit).c_str());
      out += row;
    }
  }
  if (!report.constants.empty()) {
    std::snprintf(row, sizeof row, "\n  %-22s%24s%24s\n", "constant, at best to", "if the others are known",
                  "with all unknown");
    out += row;
    for (const auto& one : report.constants) {
      const auto known = [&](double sd) { return one.is_place ? readable(sd) + " rad" : percent(sd); };
      std::snprintf(row, sizeof row, "  %-22s%24s%24s\n", one.constant.c_str(), known(one.alone).c_str(),
                    known(one.together).c_str());
      out += row;
    }
    for (const auto& one : report.only_together)
      out += summary_line("together", together(one.constants, one.sd));
  }
  std::vector<std::string> shown, hidden, absorbed;
  std::string alike;
  for (const auto& one : report.effects) {
    if (one.absorbed) absorbed.push_back(one.effect);
    else if (one.visible < visible) hidden.push_back(one.effect);
    else shown.push_back(one.effect);
    if (!one.alike.empty())
      alike += summary_line("alike", one.effect + " looks like " + joined(one.alike, ", "));
  }
  if (!report.effects.empty()) out += "\n";
  if (!shown.empty()) out += summary_line("can show", joined(shown, ", "));
  if (!hidden.empty())
    out += summary_line("too small", joined(hidden, ", ") + " (of usual size, against the noise)");
  if (!absorbed.empty())
    out += summary_line("absorbed", joined(absorbed, ", ") + " (moved constants look the same)");
  out += alike;
  for (const auto& one : report.need_columns) out += summary_line("log, too", one);
  return out;
}

std::string check_json(const DataReport& report) {
  Json root;
  root["format"] = "thermopower-gap-check/1";
  root["believable"] = deciding(report.findings) == nullptr;
  if (!report.too_little.empty())
    root["too_little"] = {{"reason", report.too_little}, {"next_experiment", report.next_experiment}};
  root["findings"] = Json::parse(findings_json(report.findings));
  root["not_judged"] = report.not_judged;
  root["signals"] = Json::object();
  for (const auto& one : report.signals)
    root["signals"][one.signal] = {{"unit", one.unit},
                                   {"samples", one.samples},
                                   {"range", finite_or_null(one.range)},
                                   {"noise", finite_or_null(one.noise)},
                                   {"as_configured", finite_or_null(one.misfit)}};
  root["constants"] = Json::object();
  for (const auto& one : report.constants)
    root["constants"][one.constant] = {{"sd_alone", finite_or_null(one.alone)},
                                       {"sd_together", finite_or_null(one.together)}};
  for (const auto& one : report.constants)
    if (one.is_place) root["constants"][one.constant]["unit"] = "rad";
  root["only_together"] = Json::array();
  for (const auto& one : report.only_together)
    root["only_together"].push_back({{"constants", one.constants}, {"sd", finite_or_null(one.sd)}});
  root["effects"] = Json::array();
  for (const auto& one : report.effects)
    root["effects"].push_back({{"effect", one.effect},
                               {"visible", finite_or_null(one.visible)},
                               {"absorbed", one.absorbed},
                               {"alike", one.alike}});
  root["need_columns"] = report.need_columns;
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace thermopower::io
