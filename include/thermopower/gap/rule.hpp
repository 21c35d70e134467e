// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#ifdef THERMOPOWER_ABLATION
#include <cstdlib>
#include <string>
#endif

/// @file rule.hpp
/// The rules of the diagnosis by name, so that each can be taken away and its worth counted (target `gap_ablation`).
///
/// To add a rule: one line in Rule, one in to_string(), and `if (!holds(Rule::name))` where it acts.

namespace thermopower::gap::engine {

/// A rule that the ablation takes away.
enum class Rule {
  outlier_rejection,  ///< isolated samples far from all around them are masked
  clipping,           ///< samples at the end of a sensor's range are masked
  clock,              ///< stamps that jitter around a clock are set to its ticks
  lag,                ///< a rate that comes behind its angle is read earlier
  parsimony,          ///< parameters of an effect cost
  twins,              ///< what another explanation says with less is not named
  evidence_bound,     ///< odds are at most those of the difference in standard errors
  constants_first     ///< an effect beside constants that explain everything is not named
};

/// Number of rules.
inline constexpr int count_of(Rule) { return 8; }

/// As the page and the environment spell it.
inline const char* to_string(Rule rule) {
  static const char* const names[] = {"outlier_rejection", "clipping", "clock",          "lag",
                                      "parsimony",         "twins",    "evidence_bound", "constants_first"};
  return names[static_cast<int>(rule)];
}

#ifdef THERMOPOWER_ABLATION
/// Whether a rule is in force: the one that the environment names in THERMOPOWER_WITHOUT_RULE is not.
inline bool holds(Rule rule) {
  static const char* const without = std::getenv("THERMOPOWER_WITHOUT_RULE");
  return without == nullptr || std::string(without) != to_string(rule);
}
#else
/// Whether a rule is in force: all are, but in the build of the ablation.
constexpr bool holds(Rule) { return true; }
#endif

}  // namespace thermopower::gap::engine
