// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace gap_benchmark {

using Json = nlohmann::ordered_json;
using Explanation = std::set<std::string>;

/// What the program answered on one job, read from its files and nothing else.
struct Verdict {
  int exit_status = -1;
  double seconds = 0.0, processor_s = 0.0;
  std::string verdict = "missing";
  Explanation cause;
  std::vector<Explanation> alternatives;
  double probability = 0.0;  ///< of the least likely of the named causes
  struct Where {
    std::string signal, submodel;
    double share = 0.0;
  };
  std::vector<Where> where;
  struct Gap {
    double before = 0.0, after = 0.0, floor = 0.0, low = 0.0, high = 0.0;
    bool has_interval = false;
  };
  std::map<std::string, Gap> gap;

  struct Parameter {
    double low = 0.0, high = 0.0;
    bool has_interval = false;
  };
  std::map<std::string, Parameter> parameters;  ///< of the named causes, as `effect.parameter`
  Explanation moved;                            ///< constants listed as moved, as `calibration.<constant>`
  /// Whether the report says of an output, or of the stamps, that it cannot be believed as it stands.
  bool has_finding_on_output = false;
  /// Rows [begin, end) of the held-out log that the report does not believe, by column; of all outputs under "".
  std::map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> masked;

  /// The causes, and those of some effects that the report lists as constants that moved beside a cause.
  Explanation told(const Explanation& asked) const {
    Explanation all = cause;
    if (!cause.empty())
      for (const auto& id : moved)
        if (asked.count(id)) all.insert(id);
    return all;
  }

  bool named() const { return verdict == "explained" || verdict == "partial" || verdict == "ambiguous"; }

  /// The cause and everything that the report says could stand in its place.
  std::vector<Explanation> everything() const {
    std::vector<Explanation> all = {cause};
    all.insert(all.end(), alternatives.begin(), alternatives.end());
    return all;
  }
};

inline double number(const Json& j, const char* key, double otherwise = 0.0) {
  return j.is_object() && j.contains(key) && j[key].is_number() ? j[key].get<double>() : otherwise;
}

inline std::string text(const Json& j, const char* key) {
  return j.is_object() && j.contains(key) && j[key].is_string() ? j[key].get<std::string>() : std::string();
}

/// Reads the `ci95` of an entry. @return whether it has one
inline bool interval_of(const Json& entry, double& low, double& high) {
  if (!entry.is_object() || !entry.contains("ci95") || !entry["ci95"].is_array() ||
      entry["ci95"].size() != 2 || !entry["ci95"][0].is_number() || !entry["ci95"][1].is_number())
    return false;
  low = entry["ci95"][0].get<double>();
  high = entry["ci95"][1].get<double>();
  return true;
}

inline Verdict read_verdict(const std::string& directory) {
  Verdict v;
  std::ifstream status(directory + "/status");
  status >> v.exit_status >> v.seconds >> v.processor_s;
  std::ifstream file(directory + "/report.json");
  const Json report = Json::parse(file, nullptr, false);
  if (!report.is_object()) {
    v.verdict = "exit " + std::to_string(v.exit_status);
    return v;
  }
  v.verdict = text(report, "verdict");
  const auto list = [&](const char* key) {
    return report.contains(key) && report[key].is_array() ? report[key] : Json::array();
  };
  v.probability = 1.0;
  for (const auto& cause : list("cause")) {
    v.cause.insert(text(cause, "effect"));
    v.probability = std::min(v.probability, number(cause, "probability", 1.0));
    if (!cause.contains("parameters") || !cause["parameters"].is_object()) continue;
    for (const auto& entry : cause["parameters"].items()) {
      Verdict::Parameter& parameter = v.parameters[text(cause, "effect") + "." + entry.key()];
      parameter.has_interval = interval_of(entry.value(), parameter.low, parameter.high);
    }
  }
  // Constants that moved within what the model file says is known are no gap, and a curve claims no name.
  const bool holds =
      report.contains("decision") && text(report["decision"], "reason") == "constants_within_known";
  const bool only_curves =
      !v.cause.empty() && std::all_of(v.cause.begin(), v.cause.end(),
                                      [](const std::string& id) { return id.rfind("unknown.", 0) == 0; });
  if (holds) v.verdict = "no_gap";
  if (only_curves) v.verdict = "unexplained";
  if (holds || only_curves) v.cause.clear();
  if (v.cause.empty()) v.probability = 0.0;
  for (const auto& alternative : list("alternatives")) {
    Explanation ids;
    if (alternative.is_string()) ids.insert(alternative.get<std::string>());
    if (alternative.is_array())
      for (const auto& id : alternative)
        if (id.is_string()) ids.insert(id.get<std::string>());
    if (!ids.empty()) v.alternatives.push_back(ids);
  }
  if (report.contains("constants") && report["constants"].is_object())
    for (const auto& entry : report["constants"].items())
      if (!entry.value().value("within_known", false)) v.moved.insert("calibration." + entry.key());
  static const std::set<std::string> unbelievable = {"constant_column", "frozen_samples",  "wrong_unit",
                                                     "wrong_sign",      "swapped_columns", "clock_shift",
                                                     "never_driven"};
  for (const auto& finding : list("findings")) {
    v.has_finding_on_output = v.has_finding_on_output || unbelievable.count(text(finding, "kind")) > 0;
    const bool held_out = std::filesystem::path(text(finding, "recording")).filename() == "heldout.csv";
    if (!held_out || text(finding, "action") != "masked" || !finding.contains("rows")) continue;
    for (const auto& range : finding["rows"])
      v.masked[text(finding, "column")].push_back({range[0].get<std::size_t>(), range[1].get<std::size_t>()});
  }
  for (const auto& place : list("where"))
    v.where.push_back({text(place, "signal"), text(place, "submodel"), number(place, "share")});
  if (report.contains("gap") && report["gap"].is_object())
    for (const auto& entry : report["gap"].items()) {
      Verdict::Gap g;
      g.before = number(entry.value(), "before");
      g.after = number(entry.value(), "after");
      g.floor = number(entry.value(), "noise_floor");
      g.has_interval = interval_of(entry.value(), g.low, g.high);
      v.gap[entry.key()] = g;
    }
  return v;
}

/// A CSV file of numbers, by column; what is not a number is NaN.
inline std::map<std::string, std::vector<double>> read_columns(const std::string& path) {
  std::map<std::string, std::vector<double>> columns;
  std::ifstream file(path);
  std::string line, cell;
  std::vector<std::string> names;
  while (std::getline(file, line)) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    std::stringstream cells(line);
    std::vector<std::string> row;
    while (std::getline(cells, cell, ',')) row.push_back(cell);
    if (names.empty()) {
      names = row;
      continue;
    }
    row.resize(names.size());
    for (std::size_t j = 0; j < names.size(); ++j) {
      char* end = nullptr;
      const double value = std::strtod(row[j].c_str(), &end);
      columns[names[j]].push_back(end == row[j].c_str() ? std::nan("") : value);
    }
  }
  return columns;
}

/// RMSE of the predictions a run left behind against the held-out log, on the rows that its report believes; negative where
/// there are none.
inline double predicted_rms(const std::string& case_directory, const std::string& report_directory,
                            const std::string& signal, const Verdict& v) {
  const auto predicted = read_columns(report_directory + "/predictions.csv");
  const auto measured = read_columns(case_directory + "/heldout.csv");
  const auto p = predicted.find(signal + "_augmented");
  const auto m = measured.find(signal);
  if (p == predicted.end() || m == measured.end() || p->second.size() != m->second.size()) return -1.0;
  std::vector<char> believed(p->second.size(), 1);
  for (const std::string& column : {signal, std::string()}) {
    const auto found = v.masked.find(column);
    if (found == v.masked.end()) continue;
    for (const auto& rows : found->second)
      for (std::size_t i = rows.first; i < std::min(rows.second, believed.size()); ++i) believed[i] = 0;
  }
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < p->second.size(); ++i) {
    if (!believed[i]) continue;
    const double error = p->second[i] - m->second[i];
    if (std::isnan(error)) continue;
    sum += error * error;
    ++count;
  }
  return count ? std::sqrt(sum / static_cast<double>(count)) : -1.0;
}

}  // namespace gap_benchmark
