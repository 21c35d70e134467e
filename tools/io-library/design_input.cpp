// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/design_files.hpp>

#include <thermopower/io/input_error.hpp>
#include <thermopower/io/model_file.hpp>

#include "file_source.hpp"
#include "json_place.hpp"
#include "report_format.hpp"

#include <nlohmann/json.hpp>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <vector>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;
using design::Bounds;
using design::Limits;
using design::VariedInput;

constexpr const char* limits_format = "thermopower-limits/1";

// A JSON text, and errors that name its file, field and line.
class JsonText {
public:
  JsonText(const std::string& file, const std::string& text, const std::string& format)
      : file_(file), text_(text) {
    try {
      root_ = Json::parse(text);
    } catch (const Json::exception& error) {
      std::string what = error.what();
      const auto at = what.find("line ");
      throw InputError(file + ": not JSON: " + (at == std::string::npos ? what : what.substr(at)) +
                       "; expected an object with \"format\": \"" + format + "\"");
    }
  }

  const Json& root() const { return root_; }

  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    throw InputError(file_ + ": " + pointer + ": " + what + " (line " +
                     std::to_string(line_of_pointer(text_, pointer)) + ")");
  }

  static std::string shown(const Json& value) {
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
  }

  void expect_format(const std::string& format) const {
    if (!root_.is_object())
      throw InputError(file_ + ": expected an object with \"format\": \"" + format + "\"");
    if (!root_.contains("format")) fail("/format", "is missing; expected \"" + format + "\"");
    if (root_["format"] != format)
      fail("/format", "is " + shown(root_["format"]) + "; expected \"" + format + "\"");
  }

  const Json& object(const Json& value, const std::string& pointer) const {
    if (!value.is_object()) fail(pointer, "is " + shown(value) + "; expected an object");
    return value;
  }

  void only(const Json& value, const std::string& pointer, const std::vector<std::string>& keys) const {
    for (const auto& item : value.items()) {
      bool found = false;
      std::string known;
      for (const std::string& key : keys) {
        found = found || key == item.key();
        known += (known.empty() ? "" : ", ") + key;
      }
      if (!found) fail(pointer + "/" + item.key(), "unknown key; expected one of " + known);
    }
  }

  double number(const Json& value, const std::string& pointer) const {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      fail(pointer, "is " + shown(value) + "; expected a number");
    return value.get<double>();
  }

  double number_of(const Json& block, const std::string& pointer, const char* key) const {
    if (!block.contains(key)) fail(pointer + "/" + key, "is missing; expected a number");
    return number(block[key], pointer + "/" + key);
  }

private:
  const std::string file_, text_;
  Json root_;
};

// A limit of both signs as one number, or a range as two.
Bounds bounds(const JsonText& file, const char* key, bool both_signs) {
  Bounds range;
  if (!file.root().contains(key)) return range;
  const Json& value = file.root()[key];
  const std::string pointer = std::string("/") + key;
  if (value.is_array()) {
    if (value.size() != 2)
      file.fail(pointer, "is " + JsonText::shown(value) + "; expected two numbers or one");
    return {file.number(value[0], pointer + "/0"), file.number(value[1], pointer + "/1")};
  }
  range.high = file.number(value, pointer);
  if (both_signs) {
    if (!(range.high > 0.0))
      file.fail(pointer, "is " + JsonText::shown(value) + "; expected a number above 0");
    range.low = -range.high;
  }
  return range;
}

std::vector<std::pair<std::string, double>> values(const JsonText& file, const char* key) {
  std::vector<std::pair<std::string, double>> list;
  if (!file.root().contains(key)) return list;
  const std::string pointer = std::string("/") + key;
  for (const auto& item : file.object(file.root()[key], pointer).items())
    list.emplace_back(item.key(), file.number(item.value(), pointer + "/" + item.key()));
  return list;
}

VariedInput varied(const JsonText& file, const std::string& column, const Json& block) {
  const std::string here = "/vary/" + column;
  file.object(block, here);
  file.only(block, here, {"from", "to", "slope_per_s", "once"});
  VariedInput one;
  one.column = column;
  one.from = file.number_of(block, here, "from");
  one.to = file.number_of(block, here, "to");
  if (block.contains("slope_per_s"))
    one.slope_per_s = file.number(block["slope_per_s"], here + "/slope_per_s");
  if (block.contains("once")) {
    if (!block["once"].is_boolean())
      file.fail(here + "/once", "is " + JsonText::shown(block["once"]) + "; expected true or false");
    one.once = block["once"].get<bool>();
  }
  return one;
}

std::string whole_file(const std::string& path, const std::string& what) {
  constexpr std::size_t largest = 64u << 20;
  const OpenFile file = open_input(path, what);
  std::string text;
  char part[65536];
  for (std::size_t got; (got = std::fread(part, 1, sizeof part, file.get())) > 0;) {
    text.append(part, got);
    if (text.size() > largest) throw InputError(path + ": larger than 64 MiB; expected " + what);
  }
  if (std::ferror(file.get())) throw InputError(path + ": cannot be read: " + std::strerror(errno));
  if (text.empty()) throw InputError(path + ": the file is empty; expected " + what);
  return text;
}

double number_or_nan(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

// What report_json() wrote under `fitted` and `fixed`.
std::vector<FittedCoordinate> coordinates(const Json& block) {
  std::vector<FittedCoordinate> list;
  for (std::size_t i = 0; i < block.at("names").size(); ++i)
    list.push_back({block.at("names")[i].get<std::string>(), number_or_nan(block.at("at").at(i)),
                    block.at("logarithmic").at(i).get<bool>(),
                    block.contains("at_bound") && block["at_bound"].at(i).get<bool>()});
  return list;
}

RankedExplanation explanation(const JsonText& file, const Json& entry) {
  RankedExplanation one;
  one.effects = entry.at("effects").get<std::vector<std::string>>();
  one.probability = number_or_nan(entry.at("probability"));
  one.held_out_ratio = number_or_nan(entry.at("held_out_ratio"));
  one.train_gain = number_or_nan(entry.at("train_gain"));
  const std::optional<Lacks> lacks = lacks_of(entry.at("lacks").get<std::string>());
  if (!lacks)
    file.fail("/ranking", "has \"lacks\": " + JsonText::shown(entry["lacks"]) +
                              "; expected a word such as nothing or room");
  one.lacks = *lacks;
  one.fitted = coordinates(entry.at("fitted"));
  one.fixed = coordinates(entry.at("fixed"));
  const Json& triangle = entry.at("fitted").at("covariance");
  const auto size = static_cast<Eigen::Index>(one.fitted.size());
  if (triangle.size() == static_cast<std::size_t>(size * (size + 1) / 2)) {
    one.covariance.resize(size, size);
    std::size_t at = 0;
    for (Eigen::Index row = 0; row < size; ++row)
      for (Eigen::Index column = 0; column <= row; ++column)
        one.covariance(row, column) = one.covariance(column, row) = number_or_nan(triangle[at++]);
  }
  return one;
}

}  // namespace

Limits parse_limits(const std::string& name, const std::string& text) {
  const JsonText file(name, text, limits_format);
  file.expect_format(limits_format);
  const Json& root = file.root();
  file.only(root, "",
            {"format", "duration_s", "row_s", "vary", "hold", "start", "angle_deg", "rate_dps", "current_A",
             "temperature_C"});
  Limits limits;
  limits.duration_s = file.number_of(root, "", "duration_s");
  limits.row_s = file.number_of(root, "", "row_s");
  if (!root.contains("vary"))
    file.fail("/vary", "is missing; expected an object such as {\"drive_A\": {\"from\": -1, \"to\": 1}}");
  for (const auto& item : file.object(root["vary"], "/vary").items())
    limits.vary.push_back(varied(file, item.key(), item.value()));
  limits.hold = values(file, "hold");
  limits.start = values(file, "start");
  limits.angle_deg = bounds(file, "angle_deg", true);
  limits.rate_dps = bounds(file, "rate_dps", true);
  limits.current_A = bounds(file, "current_A", true);
  limits.temperature_C = bounds(file, "temperature_C", false);
  if (const auto problem = limits.validate()) throw InputError(name + ": " + *problem);
  return limits;
}

Limits read_limits(const std::string& path) {
  return parse_limits(path, whole_file(path, "a file of limits (JSON)"));
}

design::DiagnosedGap parse_report(const std::string& name, const std::string& text,
                                  const Catalogue& catalogue) {
  const JsonText file(name, text, report_format);
  file.expect_format(report_format);
  const Json& root = file.root();
  if (!root.contains("model"))
    file.fail("/model", "is missing; expected a report of this version: run diagnose --report again");
  design::DiagnosedGap gap;
  gap.model = parse_model(name + ": /model", root["model"].dump(1), catalogue);
  try {
    const auto verdict = verdict_of(root.at("verdict").get<std::string>());
    if (!verdict)
      file.fail("/verdict",
                "is " + JsonText::shown(root["verdict"]) + "; expected a verdict such as ambiguous");
    gap.verdict = *verdict;
    for (const auto& [signal, score] : root.at("gap").items()) {
      const auto known = plant::SignalName(signal).known();
      const double noise = number_or_nan(score.at("noise_floor"));
      if (known && noise > 0.0)
        gap.watched.push_back(design::Watched::of(*known, noise, number_or_nan(score.at("recalibrated")),
                                                  number_or_nan(score.at("after"))));
      if (score.at("horizon_s").is_number()) gap.horizon_s = score["horizon_s"].get<double>();
    }
    for (const Json& entry : root.at("ranking")) gap.ranking.push_back(explanation(file, entry));
  } catch (const Json::exception& error) {
    std::string what = error.what();
    const auto at = what.find("] ");
    throw InputError(
        name + ": not a report of this version: " + (at == std::string::npos ? what : what.substr(at + 2)) +
        "; run diagnose --report again");
  }
  return gap;
}

design::DiagnosedGap read_report(const std::string& path, const Catalogue& catalogue) {
  return parse_report(path, whole_file(path, "a report (JSON)"), catalogue);
}

}  // namespace thermopower::io
