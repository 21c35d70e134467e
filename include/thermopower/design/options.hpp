// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <cstddef>

namespace thermopower::design {

/// What a design goes by; the benchmark `design_benchmark` chose the values.
struct DesignOptions {
  unsigned seed = 1;          ///< the same seed gives the same design
  double sure = 0.95;         ///< probability from which on an explanation is sure enough, 0.5..1
  double worth_doing = 0.75;  ///< an experiment is proposed where it is expected to be right so often, 0..1

  // Which explanations are still open.
  std::size_t most_open = 6;  ///< so many, the likeliest ones
  double likely = 0.01;       ///< probability from which on one is open
  double as_well = 1.01;  ///< so is one whose held-out ratio is within this factor of the likeliest one's ...
  double hardly_less_likely =
      10.0;                  ///< ... and its train gain so near: what a parameter or two are charged with
  double closes_half = 0.5;  ///< held-out ratio below which a curve stands for causes that nobody has named
  double least_weight =
      0.02;  ///< of an open one: an experiment is for a diagnosis that is wrong by more than it says

  double much_left = 10.0;  ///< multiple of the noise; what leaves more is not the answer, however likely

  // How the search spends its time.
  double rows = 6e6;             ///< simulated rows that a design may spend: 5 s on one core
  double screening = 0.35;       ///< share of them to find what can be told apart at all
  double raising = 0.1;          ///< the same to find out whether a raised limit would help
  double enough_right = 0.995;   ///< beyond it a shorter experiment is worth more than a surer one
  double whole_duration = 0.03;  ///< what the longest experiment costs, in units of being right

  // How near a limit it goes.
  double use_in_search = 0.7;       ///< share of a limit, with few draws of the parameters
  double use_at_most = 0.8;         ///< the same with `draws` of them
  std::size_t draws_in_search = 2;  ///< of each explanation's parameters, besides the fit
  std::size_t draws = 24;           ///< the same before an experiment is proposed
};

}  // namespace thermopower::design
