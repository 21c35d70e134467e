// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/gate_consistency.hpp>
#include <thermopower/gap/localise/quantity.hpp>

#include <vector>

namespace thermopower::gap {

/// What is suspicious about a recording before any physics of the effects. Findings never change a number of
/// the diagnosis; they tell its reader what to mend first. In a fixed order: stamps, then channel by channel,
/// then channels against each other.
///
/// | code | what |
/// | --- | --- |
/// | `repeated_stamps`, `decreasing_stamps` | times that do not increase inside a run |
/// | `irregular_stamps`, `gap_in_stamps` | intervals that vary, or a pause of more than ten of them |
/// | `empty_channel`, `missing_samples`, `constant_channel` | holes, or nothing but one value |
/// | `frozen_channel` | an output that stands still while its input changes |
/// | `saturated_channel` | an output that stands at its extreme as if it were cut off |
/// | `wrapped_channel` | jumps by a turn, or by 65536 steps |
/// | `outliers` | isolated spikes |
/// | `quantum` | steps that limit what any model can score |
/// | `wrong_unit`, `wrong_sign` | kelvin, milliamperes, radians, millivolts, a duty of 0..1; a channel upside
/// down |
/// | `clock_shift` | an input stamped by another clock than the output |
///
/// @param recording with at least one row; need not satisfy Recording::validate(), so that broken stamps can
///   be described: then
///        only stamps are looked at
/// @param model the simulation under test, for what a channel should look like
inline std::vector<Finding> check_data(const Recording& recording, const Model& model) {
  detail::FindingList list(recording);
  if (recording.rows() == 0) return {};
  detail::check_stamps(list);
  if (recording.validate() || recording.rows() < 10) return list.take();
  for (const Column& column : recording.columns) detail::check_channel(list, column);
  detail::check_units(list, model);
  detail::check_current(list, model);
  detail::check_axis(list, model);
  return list.take();
}

}  // namespace thermopower::gap
