// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include <thermopower/io/report_json.hpp>

#include "report_format.hpp"

#include <thermopower/io/model_file.hpp>
#include <thermopower/io/sentences.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace thermopower::io {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return value == 0.0 ? 0.0 : value;  // no negative zero: equal results should be equal bytes
}

Json interval(const Interval& ci) { return Json::array({number(ci.low), number(ci.high)}); }

Json parameters(const std::vector<ParameterEstimate>& list) {
  Json object = Json::object();
  for (const auto& one : list) {
    object[one.name] = {{"value", number(one.value)}, {"ci95", interval(one.ci95)}, {"unit", one.unit}};
    if (one.at_bound) object[one.name]["at_bound"] = true;
    if (!one.told) object[one.name]["told"] = false;
  }
  return object;
}

Json regime(const std::optional<Regime>& part) {
  if (!part) return nullptr;
  return {{"variable", part->variable}, {"from", number(part->from)}, {"to", number(part->to)}};
}

Json location(const Location& where) {
  Json object = {{"signal", to_string(where.signal)},
                 {"submodel", to_string(where.submodel)},
                 {"share", number(where.share)}};
  object["regime"] = regime(where.regime);
  object["evidence"] = where.evidence;
  if (!where.only_in.empty()) {
    object["only_in"] = Json::array();
    for (const auto& one : where.only_in) {
      object["only_in"].push_back({{"recording", one.recording},
                                   {"run", one.run},
                                   {"held_out", one.held_out},
                                   {"from_s", one.from_s ? number(*one.from_s) : Json(nullptr)}});
    }
  }
  return object;
}

Json remaining(const Remaining& rest) {
  Json object = {{"signal", to_string(rest.signal)},
                 {"share", number(rest.share)},
                 {"times_floor", number(rest.times_floor)},
                 {"submodel", rest.submodel ? Json(to_string(*rest.submodel)) : Json(nullptr)},
                 {"regime", regime(rest.regime)},
                 {"looks", rest.looks}};
  return object;
}

Json score(const GapScore& gap) {
  return {{"unit", gap.unit},
          {"horizon_s", gap.horizon_s ? number(*gap.horizon_s) : Json(nullptr)},
          {"before", number(gap.before)},
          {"recalibrated", number(gap.recalibrated)},
          {"after", number(gap.after)},
          {"noise_floor", number(gap.noise_floor)},
          {"shrunk_by", number(gap.shrunk_by)},
          {"ci95", interval(gap.ci95)}};
}

// The covariance's lower triangle, row by row; six digits are more than it is known to.
Json fitted(const RankedExplanation& one) {
  const auto rounded = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return number(std::strtod(text, nullptr));
  };
  Json object = {{"names", Json::array()},
                 {"at", Json::array()},
                 {"logarithmic", Json::array()},
                 {"at_bound", Json::array()},
                 {"covariance", Json::array()}};
  for (const FittedCoordinate& coordinate : one.fitted) {
    object["names"].push_back(coordinate.name);
    object["at"].push_back(number(coordinate.at));
    object["logarithmic"].push_back(coordinate.logarithmic);
    object["at_bound"].push_back(coordinate.at_bound);
  }
  for (Eigen::Index row = 0; row < one.covariance.rows(); ++row)
    for (Eigen::Index column = 0; column <= row; ++column)
      object["covariance"].push_back(rounded(one.covariance(row, column)));
  return object;
}

Json fixed(const RankedExplanation& one) {
  Json object = {{"names", Json::array()}, {"at", Json::array()}, {"logarithmic", Json::array()}};
  for (const FittedCoordinate& coordinate : one.fixed) {
    object["names"].push_back(coordinate.name);
    object["at"].push_back(number(coordinate.at));
    object["logarithmic"].push_back(coordinate.logarithmic);
  }
  return object;
}

Json ranked(const RankedExplanation& one) {
  Json confusable = Json::array();
  for (const auto& other : one.confusable)
    confusable.push_back({{"effects", other.effects}, {"cosine", number(other.cosine)}});
  return {{"effects", one.effects},
          {"probability", number(one.probability)},
          {"held_out_ratio", number(one.held_out_ratio)},
          {"lacks", in_words(one.lacks).id},
          {"parameters", parameters(one.parameters)},
          {"confusable", confusable},
          {"misfit", number(one.score)},
          {"train_gain", number(one.train_gain)},
          {"held_out_gain", number(one.held_out_gain)},
          {"hidden_starts", one.hidden_starts},
          {"fitted", fitted(one)},
          {"fixed", fixed(one)}};
}

// Who recomputes a score needs the rows that were masked; of a file in which nothing is right, the first ones, and how many
// rows there are in all.
Json finding_json(const Finding& finding) {
  constexpr std::size_t shown = 2000;
  Json rows = Json::array();
  for (std::size_t i = 0; i < std::min(shown, finding.rows.size()); ++i)
    rows.push_back({finding.rows[i].begin, finding.rows[i].end});
  return {{"kind", to_string(finding.kind)},
          {"severity", to_string(finding.severity)},
          {"recording", finding.recording},
          {"column", finding.column},
          {"message", finding.message},
          {"rows", rows},
          {"row_count", finding.row_count()},
          {"action", to_string(finding.action)},
          {"mend", finding.mend}};
}

}  // namespace

std::string findings_json(const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const auto& one : findings) list.push_back(finding_json(one));
  return list.dump(1, ' ', false, Json::error_handler_t::replace);
}

namespace {

Json report(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects, const Provenance& made_of) {
  Json root;
  root["format"] = report_format;
  root["verdict"] = to_string(diagnosis.verdict);
  root["where"] = Json::array();
  for (const auto& where : diagnosis.where) root["where"].push_back(location(where));
  root["cause"] = Json::array();
  for (const auto& cause : diagnosis.cause) {
    root["cause"].push_back({{"effect", cause.effect},
                             {"probability", number(cause.probability)},
                             {"parameters", parameters(cause.parameters)}});
  }
  root["alternatives"] = diagnosis.alternatives;
  root["gap"] = Json::object();
  for (const auto& gap : diagnosis.gap) root["gap"][to_string(gap.signal)] = score(gap);
  if (diagnosis.remaining) root["remaining"] = remaining(*diagnosis.remaining);
  root["next_experiment"] = diagnosis.next_experiment;
  root["reason"] = diagnosis.reason;
  root["words"] = sentences(diagnosis, effects);
  if (is_told(made_of))
    root["made_of"] = {{"version", version_text()},
                       {"model", made_of.model},
                       {"recordings", made_of.recordings},
                       {"held_out", made_of.held_out},
                       {"options", made_of.options}};
  if (!diagnosis.loop.empty()) root["loop"] = diagnosis.loop;
  const DecisionNumbers& numbers = diagnosis.numbers;
  root["decision"] = {{"reason", code_of(diagnosis.why)},
                      {"configured_over_floor", number(numbers.configured)},
                      {"refitted_over_floor", number(numbers.refitted)},
                      {"left_over_floor", number(numbers.left)},
                      {"twice_horizon_over_floor", number(numbers.twice_horizon)},
                      {"share_closed", number(1.0 - numbers.share.of_configured)},
                      {"share_closed_at_least", number(1.0 - numbers.share.most)},
                      {"left_of_refitted_constants", number(numbers.share.of_refitted_constants)},
                      {"probability", number(numbers.probability)},
                      {"probability_with_alternatives", number(numbers.together)}};
  root["none_of_these"] = number(diagnosis.none_of_these);
  root["not_judged"] = diagnosis.not_judged;
  root["findings"] = Json::array();
  for (const auto& finding : diagnosis.findings) {
    root["findings"].push_back(finding_json(finding));
  }
  root["constants"] = Json::object();
  for (const auto& constant : diagnosis.constants) {
    root["constants"][constant.name] = {
        {"configured", number(constant.configured)}, {"fitted", number(constant.fitted)},
        {"ci95", interval(constant.ci95)},           {"uncertainty", number(constant.uncertainty)},
        {"determined", constant.determined},         {"on_bound", constant.on_bound},
        {"within_known", constant.within_known}};
    if (constant.is_place) root["constants"][constant.name]["unit"] = "rad";
  }
  Json matrix = Json::array();
  for (Eigen::Index i = 0; i < diagnosis.correlation.of.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index k = 0; k < diagnosis.correlation.of.cols(); ++k)
      row.push_back(number(diagnosis.correlation.of(i, k)));
    matrix.push_back(std::move(row));
  }
  root["correlation"] = {{"names", diagnosis.correlation.names}, {"of", std::move(matrix)}};
  root["recalibration"] = diagnosis.recalibration;
  root["ranking"] = Json::array();
  for (const auto& one : diagnosis.ranking) root["ranking"].push_back(ranked(one));
  return root;
}

std::string text_of(const Json& root) {
  return root.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string report_json(const Diagnosis& diagnosis, const std::vector<EffectInfo>& effects,
                        const Provenance& made_of) {
  return text_of(report(diagnosis, effects, made_of));
}

std::string report_json(const Diagnosis& diagnosis, const Model& model,
                        const std::vector<EffectInfo>& effects, const Provenance& made_of) {
  Json root = report(diagnosis, effects, made_of);
  root["model"] = Json::parse(to_json(model));
  return text_of(root);
}

}  // namespace thermopower::io
