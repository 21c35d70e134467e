// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap {

/// Why a verdict was given: one line of the verdict table each.
enum class Reason {
  too_little_data,          ///< no statement is possible
  configured_model_passes,  ///< every judged signal is near its floor as configured
  constants_within_known,   ///< refitted constants suffice, and moved no further than the file says they may
  constants_moved,          ///< refitted constants suffice, and one moved further than the file says is known
  common_factor,            ///< several constants are off by one factor: a unit, a gear or a supply
  constants_close_most,     ///< constants alone close most of the gap, and leave a rest
  constants_leave_a_rest,   ///< constants do best, and leave a gap
  cause_explains,           ///< the named cause brings every signal near its floor
  several_explain,          ///< several explanations do
  cause_or_constants,       ///< the named cause does, and so do refitted constants, which it does not spare
  cause_closes_a_part,      ///< the named cause closes a material part of the gap
  several_close_a_part,     ///< several explanations do, none of them likely enough alone
  closes_too_little,        ///< the likeliest explanation closes too little of the gap
  no_explanation_likely,    ///< no explanation is likely enough
  simulation_runs_away,     ///< the simulation leaves the range of numbers
};

/// One sentence in plain words.
inline const char* to_string(Reason reason) {
  switch (reason) {
    case Reason::too_little_data:
      return "the data are too few, or cannot be believed as they stand";
    case Reason::configured_model_passes:
      return "the configured model passes: every judged signal is near its noise floor";
    case Reason::constants_within_known:
      return "refitted constants alone bring every signal near its noise floor, and each stays within what the model file "
             "says is known";
    case Reason::constants_moved:
      return "refitted constants alone bring every signal near its noise floor, and no effect is needed";
    case Reason::common_factor:
      return "one factor does what several constants would have to: look for a unit, a gear or a supply before a constant is blamed";
    case Reason::constants_close_most:
      return "refitted constants alone close most of the held-out gap; a rest stays above the noise floor, and no effect is shown "
             "to take it away";
    case Reason::constants_leave_a_rest:
      return "there is a gap; refitted constants predict held-out data best and leave a gap, and no effect does better";
    case Reason::cause_explains:
      return "the named cause brings held-out data near the noise floor, and no other explanation is as likely";
    case Reason::several_explain:
      return "several explanations bring held-out data near the noise floor, and this recording cannot tell them apart";
    case Reason::cause_or_constants:
      return "the named cause brings held-out data near the noise floor, and so do refitted constants without it: this "
             "recording cannot tell them apart";
    case Reason::cause_closes_a_part:
      return "the named cause closes a proven part of the held-out gap; a rest stays above the noise floor";
    case Reason::several_close_a_part:
      return "several explanations close a part of the held-out gap, and this recording cannot tell them apart";
    case Reason::closes_too_little:
      return "there is a gap, and the likeliest explanation closes too little of it on held-out data";
    case Reason::no_explanation_likely:
      return "there is a gap, and no explanation is likely enough to be named";
    case Reason::simulation_runs_away:
      return "the simulation runs away: its constants do not go with the data as they stand";
  }
  return "";
}

/// The reason as the report spells it.
inline const char* code_of(Reason reason) {
  switch (reason) {
    case Reason::too_little_data:
      return "too_little_data";
    case Reason::configured_model_passes:
      return "configured_model_passes";
    case Reason::constants_within_known:
      return "constants_within_known";
    case Reason::constants_moved:
      return "constants_moved";
    case Reason::common_factor:
      return "common_factor";
    case Reason::constants_close_most:
      return "constants_close_most";
    case Reason::constants_leave_a_rest:
      return "constants_leave_a_rest";
    case Reason::cause_explains:
      return "cause_explains";
    case Reason::several_explain:
      return "several_explain";
    case Reason::cause_or_constants:
      return "cause_or_constants";
    case Reason::cause_closes_a_part:
      return "cause_closes_a_part";
    case Reason::several_close_a_part:
      return "several_close_a_part";
    case Reason::closes_too_little:
      return "closes_too_little";
    case Reason::no_explanation_likely:
      return "no_explanation_likely";
    case Reason::simulation_runs_away:
      return "simulation_runs_away";
  }
  return "";
}

}  // namespace thermopower::gap
