// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/plant/catalogue.hpp>

#include <cmath>
#include <string>
#include <vector>

/// @file inverse_score.hpp
/// The scores of explanations in the inverse problem of an axis: values, and no decision.

namespace thermopower::gap::engine {

/// Who makes the effort.
enum class LoopKind {
  unknown,          ///< too little data, or no effort recorded
  open,             ///< effort comes from outside, and knows nothing of the motion
  closed_recorded,  ///< a target is recorded: a controller makes the effort of it and of the motion
  closed_found  ///< no target is recorded, and the effort is as rough as what a controller makes of measured motion
};

/// As reports print it.
inline const char* to_string(LoopKind kind) {
  switch (kind) {
    case LoopKind::unknown:
      return "unknown";
    case LoopKind::open:
      return "open";
    case LoopKind::closed_recorded:
    case LoopKind::closed_found:
      return "closed";
  }
  return "?";
}

/// Why an explanation has no inverse score, or one that must not count for it.
enum class InverseRefusal {
  none,           ///< it has a score
  no_effort,      ///< no effort is recorded, or it is 0 throughout
  too_few_rows,   ///< motion lasts too short, or rests nearly always
  hidden_state,   ///< what it remembers cannot be read from the motion: a spring, a play, a bristle
  not_of_effort,  ///< it acts on a reading, or on the motor's body, and not on the effort that a motion needs
  not_recorded,   ///< model or recordings lack what it needs
  drives_the_motion,  ///< as friction it would have to push; its best size is 0
  vanishes,           ///< its best size is 0
  not_itself,         ///< with the best parameters it is not what it is called, or stands on a bound
  of_stamps,          ///< a delay so short that the stamps of the rows may be off by as much
  switches_off        ///< it takes the drive away, so that any effort would do
};

/// As tables print it.
inline const char* to_string(InverseRefusal refusal) {
  switch (refusal) {
    case InverseRefusal::none:
      return "none";
    case InverseRefusal::no_effort:
      return "no effort";
    case InverseRefusal::too_few_rows:
      return "too few rows";
    case InverseRefusal::hidden_state:
      return "hidden state";
    case InverseRefusal::not_of_effort:
      return "not of effort";
    case InverseRefusal::not_recorded:
      return "not recorded";
    case InverseRefusal::drives_the_motion:
      return "drives the motion";
    case InverseRefusal::vanishes:
      return "vanishes";
    case InverseRefusal::not_itself:
      return "not itself";
    case InverseRefusal::of_stamps:
      return "of stamps";
    case InverseRefusal::switches_off:
      return "switches the drive off";
  }
  return "?";
}

/// A parameter of an effect as the effort of the training data has it.
struct InverseEstimate {
  const plant::CatalogueEntry* effect = nullptr;  ///< not owned
  std::size_t parameter = 0;                      ///< its place in `effect->info.parameters`
  double value = 0.0;                             ///< in the parameter's unit
  double standard_error = 0.0;                    ///< the same; 0 where it was not fitted
  bool fitted = true;  ///< else it stands at its first start: effort does not tell it
};

/// A constant of the model as the effort of the training data has it.
struct InverseConstant {
  std::size_t constant = 0;     ///< its place in Model::calibrated()
  double moved_by = 1.0;        ///< a factor; for a place the addition
  double standard_error = 0.0;  ///< of that
};

/// How well an explanation predicts held-out effort from motion. Constants are refitted in all.
struct InverseScore {
  std::vector<const plant::CatalogueEntry*>
      effects;  ///< that act besides the model's own; empty: nothing missing
  InverseRefusal refusal = InverseRefusal::none;  ///< why it does not count; `none`: it does
  bool judged = false;             ///< it was fitted and scored; where refused, for information
  double train_share = 0.0;        ///< RMS of training effort not accounted for over RMS of effort
  double share = 0.0;              ///< the same of held-out effort
  std::vector<double> block_gain;  ///< log density of each held-out block over "nothing missing", nats
  double gain = 0.0;               ///< mean of these
  double gain_error = 0.0;         ///< its standard error over blocks; 0 with fewer than two
  std::vector<InverseEstimate> parameters;  ///< of its effects, in their order: starting values
  std::vector<InverseConstant> constants;   ///< of the model
  double delay_s = 0.0;                     ///< from effort to torque, the model's own included

  /// Log density of all held-out effort over "nothing missing", nats.
  double total_gain() const { return gain * static_cast<double>(block_gain.size()); }

  /// Whether held-out effort speaks against it: it is judged, and its gain lies below 0 by more than twice its error.
  /// A cause that is missing passes this even where it hardly shows in the effort.
  bool loses() const {
    constexpr double errors = 2.0;
    return judged && refusal == InverseRefusal::none && gain < -errors * gain_error - slack;
  }

  /// Nats per block below which a loss is none: one parameter that fits noise costs about half a nat.
  static constexpr double slack = 0.5;
};

/// An explanation that the inverse problem proposes.
struct InverseProposal {
  InverseScore score;  ///< its effects, starting values, and how well it does
  bool is_told =
      false;  ///< it lowers held-out effort materially, and each of its causes does beside the others
  bool leads = false;    ///< forward selection goes on from it
  double weighed = 0.0;  ///< share of effort, times a price for each parameter: smaller is better
};

}  // namespace thermopower::gap::engine
