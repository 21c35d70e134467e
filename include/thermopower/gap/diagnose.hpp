// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/options.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <vector>

namespace thermopower::gap {

/// Says where a model and recordings part, which effect is missing, and how far the gap shrinks with it.
///
/// `train` serves to find and to fit, `held_out` to judge. If `held_out` is empty, the last `held_out_fraction` of each
/// training recording (whole excitation segments) is held out.
/// @throws InvalidInput where the model, a recording or an option is invalid
Diagnosis diagnose(const Model& model, const std::vector<Recording>& train,
                   const std::vector<Recording>& held_out = {}, const Options& options = {},
                   const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::gap

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/gap/detail/diagnose.hpp>
#endif
