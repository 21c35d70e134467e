// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/compare_reports.hpp>

#include "html_text.hpp"
#include "json_place.hpp"
#include "report_format.hpp"

#include <thermopower/gap/verdict.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/sentences.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;

// Of a 95 % interval in standard deviations.
constexpr double interval_width = 3.92;
// Two values that are further apart than that many standard deviations of their difference differ.
constexpr double they_differ = 2.0;

// What a comparison reads of a report, with an error that names the file, the line and the place.
class ReportShape {
public:
  explicit ReportShape(const NamedReport& report) : report_(report) {}

  void expect(const Json& json) const {
    const Json& verdict = at(json, "", "verdict");
    if (!verdict.is_string() || !gap::verdict_of(verdict.get<std::string>()))
      fail("/verdict", verdict, "a verdict such as explained");
    const Json& causes = at(json, "", "cause");
    if (!causes.is_array()) fail("/cause", causes, "a list");
    for (std::size_t i = 0; i < causes.size(); ++i) {
      const std::string here = "/cause/" + std::to_string(i);
      text(causes[i], here, "effect");
      for (const auto& [name, one] :
           object(at(causes[i], here, "parameters"), here + "/parameters").items()) {
        const std::string parameter = here + "/parameters/" + name;
        text(one, parameter, "unit");
        known(one, parameter, "value");
      }
    }
    for (const auto& [signal, one] : object(at(json, "", "gap"), "/gap").items()) {
      text(one, "/gap/" + signal, "unit");
      for (const char* key : {"before", "after", "noise_floor"}) number(one, "/gap/" + signal, key);
    }
    for (const auto& [name, one] : object(at(json, "", "constants"), "/constants").items()) {
      known(one, "/constants/" + name, "fitted");
      number(one, "/constants/" + name, "configured");
    }
  }

private:
  [[noreturn]] void fail(const std::string& pointer, const Json& value, const std::string& expected) const {
    std::string shown = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    if (shown.size() > 40) shown = shown.substr(0, 40) + "...";
    throw InputError(report_.name + ": " + pointer + ": is " + shown + "; expected " + expected + " (line " +
                     std::to_string(line_of_pointer(report_.text, pointer)) + ")");
  }
  const Json& object(const Json& value, const std::string& pointer) const {
    if (!value.is_object()) fail(pointer, value, "an object");
    return value;
  }
  const Json& at(const Json& block, const std::string& pointer, const char* key) const {
    object(block, pointer);
    if (!block.contains(key))
      throw InputError(report_.name + ": " + pointer + "/" + key +
                       ": is missing; expected a report that 'diagnose --report' wrote");
    return block.at(key);
  }
  void text(const Json& block, const std::string& pointer, const char* key) const {
    const Json& value = at(block, pointer, key);
    if (!value.is_string()) fail(pointer + "/" + key, value, "text");
  }
  void number(const Json& block, const std::string& pointer, const char* key) const {
    const Json& value = at(block, pointer, key);
    if (!value.is_number() && !value.is_null()) fail(pointer + "/" + key, value, "a number or null");
  }
  void known(const Json& block, const std::string& pointer, const char* key) const {
    number(block, pointer, key);
    const Json& interval = at(block, pointer, "ci95");
    if (!interval.is_array() && !interval.is_null()) fail(pointer + "/ci95", interval, "two numbers or null");
  }

  const NamedReport& report_;
};

Json parsed(const NamedReport& report) {
  Json json;
  try {
    json = Json::parse(report.text);
  } catch (const Json::parse_error& error) {
    const std::string what = error.what();
    const auto at = what.find("line ");
    throw InputError(report.name + ": not JSON: " + (at == std::string::npos ? what : what.substr(at)) +
                     "; expected a report that 'diagnose --report' wrote");
  }
  const std::string format = json.is_object() && json.contains("format") && json["format"].is_string()
                                 ? json["format"].get<std::string>()
                                 : std::string("missing");
  if (format != report_format)
    throw InputError(report.name + ": /format is " + format + "; expected " + report_format);
  ReportShape(report).expect(json);
  return json;
}

double number_at(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

// A number of a report with its 95 % interval.
struct Known {
  double value = 0.0, low = 0.0, high = 0.0;

  double deviation() const { return (high - low) / interval_width; }
  std::string text() const {
    return readable(value) + (std::isfinite(low) && high > low ? " " + interval_text(low, high) : "");
  }
};

Known known(const Json& one, const char* key) {
  Known result;
  result.value = number_at(one.at(key));
  const Json& interval = one.at("ci95");
  result.low = interval.size() == 2 ? number_at(interval[0]) : result.value;
  result.high = interval.size() == 2 ? number_at(interval[1]) : result.value;
  return result;
}

// Standard deviations of their difference that two values are apart; none where nothing is known of that.
std::optional<double> apart(const Known& a, const Known& b) {
  const double deviation = std::hypot(a.deviation(), b.deviation());
  if (!(deviation > 0.0) || !std::isfinite(deviation)) return std::nullopt;
  return std::fabs(a.value - b.value) / deviation;
}

std::string difference(const Known& a, const Known& b, const std::string& unit) {
  std::string text = a.text() + " -> " + b.text() + (unit.empty() || unit == "1" ? "" : " " + unit);
  const std::optional<double> far = apart(a, b);
  if (far && *far > they_differ)
    return text + ": they differ, by " + readable(*far, 2) + " standard deviations";
  if (far) return text + ": no difference beyond their errors";
  return text;
}

std::string causes_of(const Json& report) {
  std::string text;
  for (const Json& one : report.at("cause"))
    text += (text.empty() ? "" : " + ") + one.at("effect").get<std::string>();
  return text.empty() ? "" : " by " + text;
}

const Json* cause_in(const Json& report, const std::string& effect) {
  for (const Json& one : report.at("cause"))
    if (one.at("effect") == effect) return &one;
  return nullptr;
}

std::string word_of(const Json& verdict) {
  std::string text = verdict.get<std::string>();
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string score(const Json& gap, const char* key) { return readable(number_at(gap.at(key))); }

std::string compared(const NamedReport& name_a, const NamedReport& name_b, const Json& a, const Json& b) {
  std::string out = summary_line("A", name_a.name + ": " + word_of(a.at("verdict")) + causes_of(a)) +
                    summary_line("B", name_b.name + ": " + word_of(b.at("verdict")) + causes_of(b));
  bool any = a.at("verdict") != b.at("verdict");
  for (const Json& cause : a.at("cause")) {
    const std::string effect = cause.at("effect");
    const Json* const other = cause_in(b, effect);
    if (other == nullptr) {
      out += summary_line("only A", effect);
      any = true;
      continue;
    }
    for (const auto& [name, one] : cause.at("parameters").items())
      if (other->at("parameters").contains(name))
        out += summary_line(
            "both", effect + ", " + name + " " +
                        difference(known(one, "value"), known(other->at("parameters").at(name), "value"),
                                   one.at("unit").get<std::string>()));
  }
  for (const Json& cause : b.at("cause"))
    if (cause_in(a, cause.at("effect").get<std::string>()) == nullptr) {
      out += summary_line("only B", cause.at("effect").get<std::string>());
      any = true;
    }
  for (const auto& [name, one] : a.at("constants").items()) {
    if (!b.at("constants").contains(name)) continue;
    const Json& other = b.at("constants")[name];
    const Known first = known(one, "fitted"), second = known(other, "fitted");
    const std::optional<double> far = apart(first, second);
    const bool configured = number_at(one.at("configured")) != number_at(other.at("configured"));
    if (far && *far > they_differ)
      out += summary_line("constant", name + " " + difference(first, second, ""));
    if (configured)
      out += summary_line("configured",
                          name + " " + score(one, "configured") + " -> " + score(other, "configured"));
    any = any || configured || (far && *far > they_differ);
  }
  char row[200];
  std::snprintf(row, sizeof row, "\n  %-26s%22s%22s%22s\n", "RMSE, held out", "as configured", "with effect",
                "noise floor");
  std::string table;
  for (const auto& entry : a.at("gap").items()) {
    const std::string& signal = entry.key();
    const Json& gap = entry.value();
    if (!b.at("gap").contains(signal)) continue;
    const Json& other = b.at("gap")[signal];
    char cells[300];
    const std::string name = plant::in_words(signal) + " / " + gap.at("unit").get<std::string>();
    const auto both = [&](const char* key) { return score(gap, key) + " -> " + score(other, key); };
    std::snprintf(cells, sizeof cells, "  %-26s%22s%22s%22s\n", name.c_str(), both("before").c_str(),
                  both("after").c_str(), both("noise_floor").c_str());
    table += cells;
    if (gap.at("unit") != other.at("unit"))
      table += summary_line("", "B has it in " + other.at("unit").get<std::string>());
  }
  if (!table.empty()) out += row + table;
  for (const auto& [signal, gap] : a.at("gap").items())
    if (!b.at("gap").contains(signal)) out += summary_line("only A", plant::in_words(signal) + " is judged");
  for (const auto& [signal, gap] : b.at("gap").items())
    if (!a.at("gap").contains(signal)) out += summary_line("only B", plant::in_words(signal) + " is judged");
  if (!any) out += summary_line("", "Both say the same.");
  return out;
}

}  // namespace

std::string comparison(const NamedReport& a, const NamedReport& b) {
  const Json first = parsed(a), second = parsed(b);
  return compared(a, b, first, second);
}

}  // namespace thermopower::io
