// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/propose/thresholds.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// @file inverse_score.hpp
/// The scores of explanations in the inverse problem of an axis, and which of two is the better one.

namespace thermopower::gap::engine {

/// A set of effects, not owned.
using EffectSet = std::vector<const plant::CatalogueEntry*>;

/// Why an explanation has no inverse score, or one that must not count for it.
enum class InverseRefusal {
  none,        ///< it has a score
  not_told,    ///< effort and motion do not tell it: a spring, a reading, or what is not recorded
  not_itself,  ///< with the best parameters it is absent, stands on a bound, or takes the drive away
  of_stamps    ///< a delay so short that the stamps of the rows may be off by as much
};

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
  EffectSet effects;  ///< that act besides the model's own; empty: nothing missing
  InverseRefusal refusal = InverseRefusal::none;  ///< why it does not count; `none`: it does
  double share = 0.0;              ///< RMS of held-out effort not accounted for over RMS of effort
  std::vector<double> block_gain;  ///< log density of each held-out block over "nothing missing", nats
  std::vector<InverseEstimate> parameters;  ///< of its effects, in their order: starting values
  std::vector<InverseConstant> constants;   ///< of the model

  /// How many parameters of its effects were fitted.
  int parameter_count() const {
    return static_cast<int>(std::count_if(parameters.begin(), parameters.end(),
                                          [](const InverseEstimate& one) { return one.fitted; }));
  }

  /// The share of held-out effort that it leaves, times a price for each parameter: smaller is better.
  double weighed() const { return share * (1.0 + propose_thresholds.per_parameter * parameter_count()); }
};

/// An explanation that the inverse problem proposes.
struct InverseProposal {
  InverseScore score;    ///< its effects, starting values, and how well it does
  bool is_told = false;  ///< it lowers held-out effort materially, beside the causes found before
};

/// Whether a set lowers held-out effort by a share that matters, and by more than chance over blocks.
inline bool is_material(const InverseScore& before, const InverseScore& after) {
  if (after.share > (1.0 - propose_thresholds.least_reduction) * before.share) return false;
  if (after.share > before.share - propose_thresholds.least_share) return false;
  const std::size_t n = after.block_gain.size();
  assert(n > 0 && before.block_gain.size() == n);
  Eigen::VectorXd gain(static_cast<Eigen::Index>(n));
  for (std::size_t b = 0; b < n; ++b)
    gain[static_cast<Eigen::Index>(b)] = after.block_gain[b] - before.block_gain[b];
  if (n < 2) return gain[0] > 0.0;
  const double mean = gain.mean(),
               error = std::sqrt((gain.array() - mean).square().sum() / static_cast<double>(n * (n - 1)));
  return mean >= propose_thresholds.least_deviations * error && mean > 0.0;
}

}  // namespace thermopower::gap::engine
