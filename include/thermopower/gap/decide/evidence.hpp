// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/decide/search.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::gap {

/// How much the samples of each signal count.
struct Weight {
  std::array<double, signal_count> correlation{1, 1, 1, 1};  ///< samples that count as one
};

/// How many residuals of a candidate count as one, signal by signal.
inline Weight correlation_of(const Candidate& candidate, const FitProblem& problem) {
  Weight weight;
  const auto residuals = Attribution::residuals(candidate, problem, candidate.fit.starts, nullptr);
  for (std::size_t i = 0; i < signal_count; ++i)
    if (!residuals[i].empty()) weight.correlation[i] = correlation_samples(residuals[i]);
  return weight;
}

/// Whether some cause ended with all it has on the bounds of its range, or with one parameter where it is
/// another effect: then it is no explanation, but stands for one that the catalogue lacks. (A transition of
/// friction does not count: at its bound friction sticks.)
inline bool ends_on_bounds(const Candidate& candidate, const Model& model) {
  const std::vector<bool>& at_bound = candidate.fit.at_bound;
  if (at_bound.size() < candidate.list.size()) return false;
  for (int index : candidate.explanation.released)
    if (at_bound[static_cast<std::size_t>(index)]) return true;
  std::size_t at = model.calibrated().size();
  for (const CatalogueEntry* entry : candidate.explanation.effects) {
    bool all = true;
    for (const Parameter& parameter : entry->info.parameters) {
      if (at_bound[at] && parameter.degenerate_at_bounds) return true;
      all = (at_bound[at++] || parameter.standard.has_value()) && all;
    }
    if (all) return true;
  }
  return false;
}

/// Root of the mean square over training and held-out data of a signal, in units of the noise; 0 without
/// samples.
inline double level(const Candidate& candidate, std::size_t signal) {
  const double samples = candidate.train.samples[signal] + candidate.held_out.samples[signal];
  if (!(samples > 0.0)) return 0.0;
  return std::sqrt((candidate.train.squares[signal] + candidate.held_out.squares[signal]) / samples);
}

/// Whether a candidate scores as well as another where it matters: no signal worse by more than half a
/// percent on held-out data, nor by two percent overall. With many rows a smaller difference can still be
/// significant; it then tells of the small errors that every model has, not of the cause.
inline bool scores_alike(const Candidate& candidate, const Candidate& other) {
  for (std::size_t i = 0; i < signal_count; ++i) {
    if (candidate.held_out.samples[i] > 0.0 &&
        candidate.held_out.mean(i) > 1.005 * 1.005 * other.held_out.mean(i))
      return false;
    if (level(candidate, i) > 1.02 * level(other, i)) return false;
  }
  return true;
}

/// Deviance of every candidate and its probability among them; 0 for those that end on their bounds.
///
/// The deviance is that of Gaussian residuals of unknown variance, samples divided by the correlation length
/// of the best candidate's residuals, so that a model error that all share does not decide by sheer number of
/// rows; training and held-out data together, the parameters from training alone; a Bayesian information
/// penalty for every parameter, and a further one for every effect beyond the first (effects are rare). What
/// scores like the best is given its fit: then only the penalties differ.
inline void weigh(std::vector<Candidate>& candidates, const Weight& weight, const Model& model) {
  constexpr double rarity = 6.0;
  double samples = 0.0;
  for (std::size_t i = 0; i < signal_count; ++i)
    samples += candidates.front().train.samples[i] / weight.correlation[i];
  const auto penalty = [&](const Candidate& one) {
    const double further = one.explanation.size() > 1 ? static_cast<double>(one.explanation.size() - 1) : 0.0;
    return one.explanation.parameter_count() * std::log(std::max(samples, 2.0)) + rarity * further;
  };
  const Candidate* best = nullptr;
  for (Candidate& one : candidates) {
    one.deviance = penalty(one);
    for (std::size_t i = 0; i < signal_count; ++i) {
      const auto add = [&](const SignalSums& sums) {
        if (sums.samples[i] > 0.0)
          one.deviance += sums.samples[i] / weight.correlation[i] * std::log(std::max(sums.mean(i), 1e-6));
      };
      add(one.train);
      add(one.held_out);
    }
    one.on_bounds = ends_on_bounds(one, model);
    if (!one.on_bounds && (best == nullptr || one.deviance < best->deviance)) best = &one;
  }
  const double fit_of_best = best->deviance - penalty(*best);
  double least = best->deviance;
  for (Candidate& one : candidates) {
    if (&one != best && scores_alike(one, *best)) one.deviance = fit_of_best + penalty(one);
    if (!one.on_bounds) least = std::min(least, one.deviance);
  }
  double total = 0.0;
  for (Candidate& one : candidates)
    total += one.probability = one.on_bounds ? 0.0 : std::exp(-0.5 * (one.deviance - least));
  for (Candidate& one : candidates) one.probability /= total;
}

/// Change that a candidate makes to the empty explanation's residuals, all signals in one vector.
inline Eigen::VectorXd signature(const Candidate& candidate, const Candidate& empty,
                                 const FitProblem& problem) {
  const auto with = Attribution::residuals(candidate, problem, candidate.fit.starts, nullptr);
  const auto without = Attribution::residuals(empty, problem, empty.fit.starts, nullptr);
  std::size_t count = 0;
  for (const auto& one : with) count += one.size();
  Eigen::VectorXd change(static_cast<Eigen::Index>(count));
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < signal_count; ++i)
    for (std::size_t k = 0; k < with[i].size(); ++k) change[at++] = with[i][k] - without[i][k];
  return change;
}

/// Cosine of two signatures; 0 where one is nothing.
inline double likeness(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double norm = a.norm() * b.norm();
  return norm > 0.0 ? a.dot(b) / norm : 0.0;
}

}  // namespace thermopower::gap
