// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/experiment.hpp>
#include <thermopower/design/options.hpp>
#include <thermopower/design/possible.hpp>
#include <thermopower/design/separation.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::design {

/// An experiment that keeps the limits, and what it tells apart.
///
/// How to: @ref design_the_next_experiment.
struct Tried {
  Experiment experiment;  ///< what was tried
  Recording schedule;     ///< its inputs, row by row
  Separations apart;      ///< of each pair of explanations

  /// How long it takes, s.
  double duration_s() const { return schedule.t_s[schedule.rows() - 1]; }
};

/// Looks for experiments that tell explanations apart and keep the limits. The same seed gives the same experiments.
///
/// How to: @ref design_the_next_experiment.
class Search {
public:
  /// All must outlive the object.
  Search(const Predictor& predictor, const std::vector<Possible>& explanations, const Limits& limits,
         const DesignOptions& options)
      : predictor_(predictor),
        explanations_(explanations),
        limits_(limits),
        options_(options),
        library_(limits),
        random_(options.seed) {
    assert(!explanations_.empty());
    for (const Possible& one : explanations_) {
      few_.push_back(one.fit());
      for (std::size_t i = 0; i < options.draws_in_search; ++i) few_.push_back(one.draw(random_));
      for (std::size_t i = 0; i < options.draws; ++i) many_.push_back(one.draw(random_));
    }
    best_.setZero(static_cast<Eigen::Index>(explanations_.size()),
                  static_cast<Eigen::Index>(explanations_.size()));
  }

  /// Tries experiments from the library until so many rows are simulated.
  void screen(double rows) {
    const double end = predictor_.rows_simulated() + rows;
    while (predictor_.rows_simulated() < end) add(library_.draw(random_));
  }

  /// Tries one experiment, made so small that it keeps the limits.
  void add(const Experiment& experiment) {
    if (auto one = attempt(experiment)) {
      best_ = best_.cwiseMax(one->apart);
      tried_.push_back(std::move(*one));
    }
  }

  /// Everything tried so far that keeps the limits.
  const std::vector<Tried>& tried() const { return tried_; }
  /// The largest separation of each pair so far.
  const Separations& best_apart() const { return best_; }

  /// Which limit stopped most experiments; empty: none did.
  std::string stopped_by() const {
    const auto most =
        std::max_element(stopped_.begin(), stopped_.end(),
                         [](const auto& one, const auto& other) { return one.second < other.second; });
    return most == stopped_.end() ? std::string() : most->first;
  }

  /// The best of the tried experiments, changed as long as it becomes better, until so many rows are simulated. None where none keeps
  /// the limits.
  std::optional<Tried> improve(double rows, const Classes& classes) {
    // Being right, less what the time costs.
    const auto worth = [&](const Tried& one) {
      return std::min(classes.expected_right(one.apart), options_.enough_right) -
             options_.whole_duration * one.duration_s() / limits_.duration_s;
    };
    const auto best =
        std::max_element(tried_.begin(), tried_.end(),
                         [&](const Tried& one, const Tried& other) { return worth(one) < worth(other); });
    if (best == tried_.end()) return std::nullopt;
    Tried one = *best;
    const double end = predictor_.rows_simulated() + rows;
    while (predictor_.rows_simulated() < end) {
      auto next = attempt(library_.changed(one.experiment, random_));
      if (next && worth(*next) > worth(one)) one = std::move(*next);
    }
    return one;
  }

  /// The experiment within the limits with all draws of the parameters, made smaller where it must be. Its separations are those
  /// whichever of two explanations is true: the lesser of both.
  std::optional<Tried> made_safe(const Experiment& experiment) {
    auto safe = within_limits(experiment, many_, options_.use_at_most);
    if (!safe) return safe;
    for (std::size_t i = 0; i < explanations_.size(); ++i) {
      const Separations here = apart(safe->schedule, explanations_[i]);
      if (i == 0) safe->apart = here;
      safe->apart = safe->apart.cwiseMin(here);
    }
    return safe;
  }

private:
  std::optional<Tried> attempt(const Experiment& experiment) {
    auto one = within_limits(experiment, few_, options_.use_in_search);
    if (one) one->apart = apart(one->schedule, explanations_.front());
    return one;
  }

  Separations apart(const Recording& schedule, const Possible& truth) const {
    return separations_of(
        predictor_.predictions(schedule, predictor_.free_run(schedule, truth.fit()), explanations_));
  }

  /// An experiment made so small that its motions use at most a share of every limit; none where that takes too many steps.
  std::optional<Tried> within_limits(Experiment experiment, const std::vector<ParameterPoint>& points,
                                     double share) {
    constexpr int most_steps = 5;
    for (int i = 0; i < most_steps; ++i) {
      Tried one{experiment, schedule_of(experiment, limits_), {}};
      const LimitUse use = most_used(one.schedule, points);
      if (use.share <= share) return one;
      ++stopped_[use.limit];
      experiment.scale *= std::clamp(0.9 * share / use.share, 0.2, 0.9);
    }
    return std::nullopt;
  }

  LimitUse most_used(const Recording& schedule, const std::vector<ParameterPoint>& points) const {
    // What is commanded is known without a simulation.
    Motion commanded;
    for (const char* column : {"current_A", "drive_A"})
      if (const Eigen::VectorXd* drive = schedule.find(column))
        commanded[static_cast<std::size_t>(Signal::current_A)] = *drive;
    LimitUse most = use_of(commanded, limits_);
    for (const ParameterPoint& point : points) {
      LimitUse use = use_of(predictor_.free_run(schedule, point), limits_);
      if (use.share > most.share) most = std::move(use);
    }
    return most;
  }

  const Predictor& predictor_;
  const std::vector<Possible>& explanations_;
  const Limits& limits_;
  const DesignOptions& options_;
  const Library library_;
  Random random_;
  std::vector<ParameterPoint> few_, many_;
  std::vector<Tried> tried_;
  Separations best_;
  std::map<std::string, int> stopped_;
};

}  // namespace thermopower::design
