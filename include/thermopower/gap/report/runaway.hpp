// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/report/parts.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>

namespace thermopower::gap::engine {

/// From here on a simulated signal has left what numbers are for: no motor is as hot, and no axis as fast.
inline constexpr double runaway = 1e8;

/// Takes back whatever was concluded where a simulation ran away, as configured and refitted, or is so stiff that no noise of its
/// starts can be carried through it: nothing can be near a floor that is no number. Says which signal it is and where to look.
/// @param model  as configured
/// @return whether it did
inline bool take_back_a_runaway(Diagnosis& result, const Model& model) {
  const auto is_lost = [](const GapScore& gap) {
    return !std::isfinite(gap.noise_floor) || !(std::min(gap.recalibrated, gap.after) < runaway);
  };
  const auto lost = std::find_if(result.gap.begin(), result.gap.end(), is_lost);
  if (lost == result.gap.end()) return false;
  Conclusion nothing;
  nothing.verdict = Verdict::insufficient;
  take_causes_back(result, model, nothing);
  result.reason = "the simulation of " + plant::the_variable(to_string(lost->signal)) +
                  " runs away: its constants do not go with the data as they stand";
  result.next_experiment =
      "None yet: look at the unit of t_s and of the inputs ('thermopower-gap check' lists them), and at the model's "
      "constants, one of which may be off by orders of magnitude.";
  return true;
}

}  // namespace thermopower::gap::engine
