// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/catalogue.hpp>
#include <thermopower/gap/standard_catalogue.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/recording.hpp>

#include <string>
#include <vector>

namespace thermopower::gap {

/// What a diagnosis may be told.
struct Options {
  double horizon_s = 0.5;            ///< length of the axis' windows in s, > 0
  double slack = 0.04;               ///< how far constants may move for free, as a fraction
  double tolerance = 0.05;           ///< relative shrinkage of the gap below which nobody cares
  double held_out_fraction = 0.3;    ///< held out where no recording is given for it
  int effects_at_once = 2;           ///< the largest set of effects weighed together, 1..3
  std::vector<std::string> without;  ///< ids removed from the catalogue
  unsigned threads = 1;              ///< 1..; the result does not depend on it
  unsigned seed = 1;                 ///< of the bootstrap; equal seeds give equal reports
};

/// Says where a model and recordings part, which effect is missing, and how far the gap shrinks with it.
///
/// `train` serves to find and to fit, `held_out` to judge; where `held_out` is empty, the last
/// `held_out_fraction` of each training recording (whole excitation segments) is taken away for it.
/// @throws InvalidInput where the model, a recording or an option is invalid.
Diagnosis diagnose(const Model& model, const std::vector<Recording>& train,
                   const std::vector<Recording>& held_out = {}, const Options& options = {},
                   const Catalogue& catalogue = standard_catalogue());

}  // namespace thermopower::gap
