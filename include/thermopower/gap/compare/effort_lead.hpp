// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/bootstrap_weights.hpp>
#include <thermopower/gap/compare/choice.hpp>
#include <thermopower/gap/compare/verdict_table.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/gap/propose/effort_problem.hpp>
#include <thermopower/gap/compare/score.hpp>
#include <thermopower/plant/signal.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// @file effort_lead.hpp
/// The answer of a joint in a closed loop: what the effort says, given the motion.

namespace thermopower::gap::engine {

/// An explanation as the effort has it: constants and parameters from effort given motion.
inline Candidate candidate_of(const InverseScore& score, const FitProblem& problem) {
  Candidate one;
  one.explanation.effects = score.effects;
  one.list = coordinates(*problem.model, one.explanation, *problem.catalogue);
  const Eigen::Index count = static_cast<Eigen::Index>(one.list.size());
  one.fit.point = Eigen::VectorXd::Zero(count);
  one.fit.at_bound.assign(one.list.size(), false);
  Eigen::VectorXd information = Eigen::VectorXd::Constant(count, 1e-12);
  const auto set = [&](Eigen::Index place, double value, double standard_error) {
    const Coordinate& coordinate = one.list[static_cast<std::size_t>(place)];
    one.fit.point[place] = coordinate.coordinate_of(value);
    const double error =
        coordinate.logarithmic ? standard_error / std::max(std::abs(value), 1e-300) : standard_error;
    if (error > 0.0) information[place] = 1.0 / (error * error);
  };
  for (std::size_t i = 0; i < one.list.size(); ++i)
    one.fit.point[static_cast<Eigen::Index>(i)] = one.list[i].start;
  for (const InverseConstant& constant : score.constants)
    set(static_cast<Eigen::Index>(constant.constant), constant.moved_by, constant.standard_error);
  for (std::size_t i = 0; i < problem.model->calibrated().size(); ++i) {
    Coordinate& constant =
        one.list[i];  // an inertia that was fitted without friction may be off by any factor
    const double at = one.fit.point[static_cast<Eigen::Index>(i)];
    constant.lower = std::min(constant.lower, at);
    constant.upper = std::max(constant.upper, at);
  }
  Eigen::Index place = static_cast<Eigen::Index>(problem.model->calibrated().size());
  for (const InverseEstimate& parameter : score.parameters) {
    if (parameter.fitted) set(place, parameter.value, parameter.standard_error);
    else one.fit.point[place] = one.list[static_cast<std::size_t>(place)].coordinate_of(parameter.value);
    ++place;
  }
  one.fit.information = information.asDiagonal();
  return one;
}

/// The explanations that the effort proposes, weighed by held-out effort, "nothing missing" first.
class EffortLead {
public:
  /// @param effort  must outlive this object
  EffortLead(EffortProblem& effort, const FitProblem& problem) : effort_(effort) {
    std::set<std::vector<const CatalogueEntry*>> seen{{}};
    std::vector<InverseScore> scores{effort.score({})};
    for (const InverseProposal& proposal : effort.proposals()) {
      if (scores.size() < most && seen.insert(sorted(proposal.score.effects)).second)
        scores.push_back(proposal.score);
      is_told_ = is_told_ || proposal.is_told;
    }
    for (const InverseScore& score : scores) candidates_.push_back(candidate_of(score, problem));
    weigh_all(scores);
  }

  /// Whether a set of effects lowers held-out effort materially.
  bool is_told() const { return is_told_; }
  /// The explanations, with their probabilities.
  std::vector<Candidate>& candidates() { return candidates_; }

  /// Weighs the explanations with what something else says against them. @param nats  by candidate
  void weigh_with(const Eigen::VectorXd& nats) {
    double sum = 0.0;
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      sum += candidates_[i].probability *= std::exp(-nats[static_cast<Eigen::Index>(i)]);
    if (sum > 0.0)
      for (Candidate& one : candidates_) one.probability /= sum;
  }

  /// The answer: the likeliest of what is no larger than the set that forward selection stops at, or of all where that set is
  /// out of the running, with the class of what predicts alike and acts in the same place. Where that class is not likely, and a
  /// part of the set has one that is, that part.
  /// @param set  of the effort
  Answer answer(const InverseScore& set) const {
    const std::vector<const CatalogueEntry*> told = sorted(set.effects);
    std::size_t whole = likeliest(candidates_);
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (sorted(candidates_[i].explanation.effects) == told && candidates_[i].probability > hardly)
        whole = likeliest_as_simple(i);
    Answer found = answer_of(whole);
    if (found.probability >= verdict_limits.likely) return found;
    for (std::size_t i = 1; i < candidates_.size(); ++i) {
      if (!candidates_[whole].explanation.includes(candidates_[i].explanation)) continue;
      Answer part = answer_of(i);
      if (part.probability >= verdict_limits.likely && part.probability > found.probability)
        found = std::move(part);
    }
    return found;
  }

private:
  static constexpr std::size_t most = 40;     ///< explanations that are weighed
  static constexpr double hardly = 1e-9;      ///< probability of what is out of the running
  static constexpr double alike_from = 0.95;  ///< cosine of what two explanations do to the effort

  static std::vector<const CatalogueEntry*> sorted(std::vector<const CatalogueEntry*> list) {
    std::sort(list.begin(), list.end());
    return list;
  }

  /// The likeliest of what has as many causes as a candidate or fewer, and no curve in place of a name.
  std::size_t likeliest_as_simple(std::size_t place) const {
    std::size_t best = place;
    for (std::size_t i = 1; i < candidates_.size(); ++i)
      if (candidates_[i].explanation.size() <= candidates_[place].explanation.size() &&
          candidates_[i].explanation.has_curve() <= candidates_[place].explanation.has_curve() &&
          candidates_[i].probability > candidates_[best].probability)
        best = i;
    return best;
  }

  /// Where the effects of a candidate act. Frictions that predict alike are one answer; a friction and a load are two.
  static std::multiset<std::string> submodels_of(const Candidate& one) {
    std::multiset<std::string> all;
    for (const CatalogueEntry* entry : one.explanation.effects) all.insert(to_string(entry->info.submodel));
    return all;
  }

  /// A candidate as the answer.
  Answer answer_of(std::size_t place) const {
    Answer found;
    found.chosen = place;
    const Explanation& chosen = candidates_[place].explanation;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const bool is_more = candidates_[i].explanation.includes(chosen);
      const bool alike = likeness(signatures_[i], signatures_[place]) >= alike_from &&
                         submodels_of(candidates_[i]) == submodels_of(candidates_[place]);
      if (is_more || alike) found.probability += candidates_[i].probability;
      if (i == place || i == 0 || is_more || !(candidates_[i].probability > decision.alternative)) continue;
      found.alternatives.push_back(i);
      if (!alike) found.together += candidates_[i].probability;
    }
    found.together += found.probability;
    return found;
  }

  void weigh_all(const std::vector<InverseScore>& scores) {
    const auto count = static_cast<Eigen::Index>(scores.size());
    const auto blocks = static_cast<Eigen::Index>(scores.front().block_gain.size());
    Eigen::MatrixXd density(count, blocks);
    Eigen::VectorXd prior(count);
    const Eigen::VectorXd nothing = effort_.train_residual({});
    for (Eigen::Index i = 0; i < count; ++i) {
      const InverseScore& score = scores[static_cast<std::size_t>(i)];
      for (Eigen::Index k = 0; k < blocks; ++k) density(i, k) = score.block_gain[static_cast<std::size_t>(k)];
      const Explanation& explanation = candidates_[static_cast<std::size_t>(i)].explanation;
      // That a cause is missing is known where one is told: the first one of an explanation is no news.
      const double news = i == 0 ? 0.0 : explanation.rarity() - usual_rarity;
      prior[i] = -0.5 * news - static_cast<double>(score.parameters.size());
      signatures_.push_back(effort_.train_residual(score.effects) - nothing);
    }
    const Eigen::VectorXd weight = bootstrap_weights(density, prior);
    for (Eigen::Index i = 0; i < count; ++i) {
      Candidate& one = candidates_[static_cast<std::size_t>(i)];
      one.probability = weight[i];
      one.deviance = -2.0 * (density.row(i).sum() + prior[i]);
    }
  }

  EffortProblem& effort_;
  bool is_told_ = false;
  std::vector<Candidate> candidates_;
  std::vector<Eigen::VectorXd> signatures_;
};

}  // namespace thermopower::gap::engine
