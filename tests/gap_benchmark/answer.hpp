// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "verdict.hpp"

/// @file answer.hpp
/// Whether an answer is right, honest or wrong, by the label of its case.

namespace gap_benchmark {

/// Whether an id is a constant that is off.
inline bool is_constant(const std::string& id) { return id.rfind("calibration.", 0) == 0; }

/// Whether an id is a curve: a function of a recorded variable that nobody has named.
inline bool is_curve(const std::string& id) { return id.rfind("unknown.", 0) == 0; }

/// Whether nothing but curves is named.
inline bool names_curves(const Explanation& cause) {
  return !cause.empty() && std::all_of(cause.begin(), cause.end(), is_curve);
}

/// The truth, or what is the same physics by another name, is part of the cause or of an alternative.
inline bool in_class(const Verdict& v, const Json& label, const Explanation& truth) {
  std::vector<Explanation> same = {truth};
  if (label.contains("same"))
    for (const auto& ids : label["same"]) same.push_back(ids.get<Explanation>());
  const auto all = v.everything();
  return v.named() && std::any_of(all.begin(), all.end(), [&](const Explanation& e) {
           return std::any_of(same.begin(), same.end(), [&](const Explanation& one) {
             return std::includes(e.begin(), e.end(), one.begin(), one.end());
           });
         });
}

/// A beginner's gap: the very constants, and the cause beside them; or nothing named where the data are wrong.
inline bool is_right_for_a_beginner(const Verdict& v, const Json& label) {
  if (label["refuse"].get<bool>())
    return v.cause.empty() && v.verdict != "no_gap" && (v.exit_status == 4 || v.has_finding_on_output);
  if (label["common_factor"].get<bool>()) {
    const bool by_constants = std::all_of(v.cause.begin(), v.cause.end(), is_constant);
    return v.exit_status == 4 || v.verdict == "unexplained" ||
           (!(v.verdict == "explained" && by_constants) && v.has_finding_on_output);
  }
  return std::any_of(label["accept"].begin(), label["accept"].end(), [&](const Json& ids) {
    const Explanation one = ids.get<Explanation>();
    return v.named() && v.told(one) == one;
  });
}

/// An answer to a case whose cause is known by its family.
struct FamilyAnswer {
  bool named =
      false;  ///< one of the family at least is named, and no effect of another one; constants may move beside it
  bool wrong =
      false;  ///< an effect of another family is named, and none of this one stands beside it as an alternative
  bool honest =
      false;  ///< not wrong, and not passed over: constants alone, or no gap, where there is a cause
};

inline FamilyAnswer answer_of_family(const Verdict& v, const Json& label) {
  const Explanation family = label["family"].get<Explanation>();
  Explanation effects;
  for (const auto& id : v.cause)
    if (!is_constant(id) && !is_curve(id)) effects.insert(id);
  const bool strays = !std::includes(family.begin(), family.end(), effects.begin(), effects.end());
  const auto all = v.everything();
  const bool beside = std::any_of(all.begin(), all.end(), [&](const Explanation& one) {
    return std::any_of(one.begin(), one.end(), [&](const std::string& id) { return family.count(id) > 0; });
  });
  FamilyAnswer answer;
  answer.named = v.named() && !effects.empty() && !strays;
  answer.wrong = v.named() && strays && !(v.verdict == "ambiguous" && beside);
  const bool passed_over = !family.empty() && effects.empty() &&
                           (v.verdict == "no_gap" || (v.verdict == "explained" && !names_curves(v.cause)));
  const bool answered = v.verdict.rfind("exit", 0) != 0 && v.verdict != "missing";
  answer.honest = answered && !answer.wrong && !passed_over;
  return answer;
}

/// Whether an answer to any case of the benchmark is right or honest.
inline bool is_right(const Verdict& v, const Json& label) {
  const std::string half = text(label, "half");
  if (half == "beginner") return is_right_for_a_beginner(v, label);
  if (label.contains("family")) return answer_of_family(v, label).honest;
  const Explanation truth = label["effects"].get<Explanation>();
  if (label["unknown"].is_string())
    return v.verdict == "unexplained" || v.verdict == "insufficient" || names_curves(v.cause);
  if (truth.empty()) return v.verdict == "no_gap";
  return in_class(v, label, truth);
}

/// Whether an answer to a real recording is right, by an entry of truths.json: every pattern of `named` is among the causes and
/// closes `least_share` of the signal, or the verdict is among `right_without_cause`; and no cause is in `never`.
inline bool is_right_of_real(const Verdict& v, const Json& truth) {
  const auto matches = [&](const Json& pattern) {
    const std::regex wanted(pattern.get<std::string>());
    return std::any_of(v.cause.begin(), v.cause.end(),
                       [&](const std::string& id) { return std::regex_match(id, wanted); });
  };
  const auto& never = truth["never"];
  if (std::any_of(never.begin(), never.end(), matches)) return false;
  for (const auto& one : truth["right_without_cause"]) {
    const std::string accepted = one.get<std::string>();
    if (v.cause.empty() && accepted == v.verdict) return true;
    for (const auto& id : v.cause)
      if (accepted == v.verdict + ":" + id) return true;
  }
  const auto& named = truth["named"];
  if (!v.named() || named.empty() || !std::all_of(named.begin(), named.end(), matches)) return false;
  if (!truth["least_share"].is_number()) return true;
  const auto found = v.gap.find(text(truth, "signal"));
  return found != v.gap.end() && found->second.before > 0.0 &&
         1.0 - found->second.after / found->second.before >= truth["least_share"].get<double>();
}

}  // namespace gap_benchmark
