// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <iterator>

#ifdef THERMOPOWER_ABLATION
#include <cstdlib>
#include <set>
#include <string>
#endif

/// @file rule.hpp
/// The rules of the diagnosis by name, so that each can be taken away and its worth counted (target `gap_ablation`).
///
/// To add a rule: one line in Rule, one in rule_names, and `holds(Rule::name)` where it acts. It is asked last, where all else says that
/// the rule would change something: a recording that did not ask for a rule has the same answer without it.

namespace thermopower::gap::engine {

/// A rule that the ablation takes away.
enum class Rule {
  outlier_rejection,     ///< isolated samples far from all around them are masked
  bursts,                ///< stretches that jump away and back are masked
  clipping,              ///< samples at the end of a sensor's range are masked
  frozen,                ///< stretches that stand where noise or motion would show are masked
  impossible,            ///< temperatures that no motor has are masked
  repeated_frames,       ///< rows that repeat all outputs of the row before are masked
  lost_frames,           ///< rows in which the sensors say nothing are masked
  slow_sensors,          ///< rows between the readings of a slower sensor are masked
  clock,                 ///< stamps that jitter around a clock are set to its ticks
  pauses,                ///< runs are cut where time passed unrecorded
  resets,                ///< runs are cut where an axis was put elsewhere
  under_way,             ///< the first second of a run that begins in motion is not judged
  driven_before,         ///< the command before a run is told by the first rows of its motion
  dead_columns,          ///< outputs that stand still while they are driven are left out
  units,                 ///< units, signs and exchanged columns are asked for
  detached_sensors,      ///< sensors that show nothing of what they measure are refused
  lag,                   ///< a rate that comes behind its angle is read earlier
  command_between_rows,  ///< a command that went on between the rows is averaged
  command_noise,         ///< noise of a command that no motion follows counts as noise
  target_between_rows,   ///< a target that went on between the rows is averaged
  current_noise,         ///< the square of a current sensor's noise is taken off the heat
  heat_between_rows,     ///< power that was switched between the rows is averaged
  parsimony,             ///< parameters of an effect cost
  twins,                 ///< what another explanation says with less is not named
  evidence_bound,        ///< odds are at most those of the difference in standard errors
  constants_first        ///< an effect beside constants that explain everything is not named
};

/// The rules as the page and the environment spell them, in their order.
inline constexpr const char* rule_names[] = {"outlier_rejection",
                                             "bursts",
                                             "clipping",
                                             "frozen",
                                             "impossible",
                                             "repeated_frames",
                                             "lost_frames",
                                             "slow_sensors",
                                             "clock",
                                             "pauses",
                                             "resets",
                                             "under_way",
                                             "driven_before",
                                             "dead_columns",
                                             "units",
                                             "detached_sensors",
                                             "lag",
                                             "command_between_rows",
                                             "command_noise",
                                             "target_between_rows",
                                             "current_noise",
                                             "heat_between_rows",
                                             "parsimony",
                                             "twins",
                                             "evidence_bound",
                                             "constants_first"};

/// Number of rules.
inline constexpr int count_of(Rule) { return static_cast<int>(std::size(rule_names)); }
static_assert(count_of(Rule{}) == static_cast<int>(Rule::constants_first) + 1, "each rule has a name");

/// As the page and the environment spell it.
inline const char* to_string(Rule rule) { return rule_names[static_cast<int>(rule)]; }

#ifdef THERMOPOWER_ABLATION
/// The rules that were asked for so far. Only one thread asks.
inline std::set<std::string>& rules_asked_for() {
  static std::set<std::string> asked;
  return asked;
}

/// Whether a rule is in force: the one that the environment names in THERMOPOWER_WITHOUT_RULE is not.
inline bool holds(Rule rule) {
  rules_asked_for().insert(to_string(rule));
  static const char* const without = std::getenv("THERMOPOWER_WITHOUT_RULE");
  return without == nullptr || std::string(without) != to_string(rule);
}
#else
/// Whether a rule is in force: all are, but in the build of the ablation.
constexpr bool holds(Rule) { return true; }
#endif

}  // namespace thermopower::gap::engine
