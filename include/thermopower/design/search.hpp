// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/library.hpp>
#include <thermopower/design/limit_check.hpp>
#include <thermopower/design/remaining.hpp>
#include <thermopower/design/separation.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace thermopower::design {

/// What the search for an experiment goes by.
struct SearchSettings {
  double rows = 6e6;  ///< simulated rows a design may spend: 5 s on one core, benchmark `design_benchmark`
  double screening = 0.35;          ///< share of them to find what can be told apart at all
  double enough_right = 0.98;       ///< beyond it a shorter experiment is worth more than a surer one
  double whole_duration = 0.06;     ///< what the longest experiment costs, in units of being right
  double use_in_search = 0.8;       ///< of a limit, with few draws of the parameters
  double use_at_most = 0.9;         ///< of a limit, with `draws` of them
  std::size_t draws_in_search = 2;  ///< of each explanation's parameters, besides the fit
  std::size_t draws = 24;           ///< the same before an experiment is proposed
  std::size_t starts = 3;           ///< best screened experiments that are improved
};

/// An experiment that keeps the limits, and what it tells apart.
struct Tried {
  Experiment experiment;    ///< what was tried
  Recording schedule;       ///< its inputs, row by row
  Separations apart;        ///< of each pair of explanations
  double duration_s = 0.0;  ///< of the schedule
};

/// Looks for experiments that tell explanations apart and keep the limits. The same seed gives the same experiments.
///
/// How to: @ref design_the_next_experiment.
class Search {
public:
  /// All must outlive the object.
  Search(const Predictor& predictor, const std::vector<Possible>& explanations, const Limits& limits,
         const SearchSettings& settings, unsigned seed)
      : predictor_(predictor),
        explanations_(explanations),
        limits_(limits),
        settings_(settings),
        library_(limits),
        random_(seed) {
    assert(!explanations_.empty());
    for (const Possible& one : explanations_) {
      few_.push_back(one.fit());
      for (std::size_t i = 0; i < settings.draws_in_search; ++i) few_.push_back(one.draw(random_));
      for (std::size_t i = 0; i < settings.draws; ++i) many_.push_back(one.draw(random_));
    }
    best_ = Separations::Zero(static_cast<Eigen::Index>(explanations_.size()),
                              static_cast<Eigen::Index>(explanations_.size()));
  }

  /// Tries experiments from the library until so many rows are simulated.
  void screen(double rows) {
    const double end = predictor_.rows_simulated() + rows;
    while (predictor_.rows_simulated() < end)
      if (auto tried = attempt(library_.draw(random_))) keep(std::move(*tried));
  }

  /// Everything tried so far that keeps the limits.
  const std::vector<Tried>& tried() const { return tried_; }
  /// The largest separation of each pair so far.
  const Separations& best_apart() const { return best_; }
  /// Which limit stopped an experiment how often, most often first.
  const std::vector<std::pair<std::string, int>>& stopped_by() const { return stopped_by_; }

  /// Being right, less what the time costs.
  double worth(const Tried& one, const std::vector<double>& weights,
               const std::vector<std::size_t>& label) const {
    return std::min(expected_right(one.apart, weights, label), settings_.enough_right) -
           settings_.whole_duration * one.duration_s / limits_.duration_s;
  }

  /// The best experiment: the best ones that were screened, each changed as long as it becomes better, until so many rows are
  /// simulated. None where none keeps the limits.
  std::optional<Tried> improve(double rows, const std::vector<double>& weights,
                               const std::vector<std::size_t>& label) {
    if (tried_.empty()) return std::nullopt;
    std::vector<Tried> starts = tried_;
    const auto better = [&](const Tried& one, const Tried& other) {
      return worth(one, weights, label) > worth(other, weights, label);
    };
    std::stable_sort(starts.begin(), starts.end(), better);
    starts.resize(std::min(starts.size(), settings_.starts));
    assert(!starts.empty());
    const double begin = predictor_.rows_simulated();
    for (std::size_t i = 0; i < starts.size(); ++i) {
      // The first third of the rows goes to all of them alike, the rest to the best.
      const double share = 0.4 * static_cast<double>(i + 1) / static_cast<double>(starts.size());
      climb(starts[i], begin + share * rows, weights, label);
    }
    std::stable_sort(starts.begin(), starts.end(), better);
    climb(starts.front(), begin + rows, weights, label);
    return starts.front();
  }

  /// The experiment with so many draws of the parameters within the limits: made smaller where one of them is not.
  std::optional<Tried> made_safe(Tried one) {
    for (int i = 0; i < 6; ++i) {
      const LimitUse use = most_used(one.schedule, many_);
      if (use.share <= settings_.use_at_most) {
        one.apart = apart_along_each(one.schedule);
        return one;
      }
      one.experiment.scale *= std::clamp(0.95 * settings_.use_at_most / use.share, 0.3, 0.95);
      one.schedule = schedule_of(one.experiment, limits_);
    }
    return std::nullopt;
  }

  /// Adds an experiment from elsewhere. @return whether it keeps the limits
  bool add(const Experiment& experiment) {
    auto tried = attempt(experiment);
    if (tried) keep(std::move(*tried));
    return tried.has_value();
  }

private:
  void climb(Tried& one, double until, const std::vector<double>& weights,
             const std::vector<std::size_t>& label) {
    while (predictor_.rows_simulated() < until) {
      auto next = attempt(library_.changed(one.experiment, random_));
      if (next && worth(*next, weights, label) > worth(one, weights, label)) one = std::move(*next);
    }
  }

  void keep(Tried one) {
    assert(one.apart.rows() == best_.rows() && one.apart.cols() == best_.cols());
    best_ = best_.cwiseMax(one.apart);
    tried_.push_back(std::move(one));
  }

  LimitUse most_used(const Recording& schedule, const std::vector<ParameterPoint>& points) const {
    LimitUse most = use_of_commands(schedule, limits_);
    for (const ParameterPoint& point : points) {
      LimitUse use = use_of(predictor_.free_run(schedule, point), limits_);
      if (use.share > most.share) most = std::move(use);
    }
    return most;
  }

  /// An experiment made so small that it keeps the limits; none where that takes too many steps.
  std::optional<Tried> attempt(Experiment experiment) {
    for (int i = 0; i < 4; ++i) {
      Tried one{experiment, schedule_of(experiment, limits_), {}, 0.0};
      one.duration_s = one.schedule.t_s[one.schedule.rows() - 1];
      const LimitUse use = most_used(one.schedule, few_);
      if (use.share <= settings_.use_in_search) {
        const Motion along = predictor_.free_run(one.schedule, explanations_.front().fit());
        one.apart = separations_of(predictor_.predictions(one.schedule, along, explanations_));
        return one;
      }
      note(use.limit);
      experiment.scale *= std::clamp(0.9 * settings_.use_in_search / use.share, 0.2, 0.9);
    }
    return std::nullopt;
  }

  void note(const std::string& limit) {
    for (auto& [name, count] : stopped_by_)
      if (name == limit) {
        ++count;
        std::stable_sort(stopped_by_.begin(), stopped_by_.end(),
                         [](const auto& a, const auto& b) { return a.second > b.second; });
        return;
      }
    stopped_by_.emplace_back(limit, 1);
  }

  /// Separations whichever of two explanations is true: the lesser of both.
  Separations apart_along_each(const Recording& schedule) const {
    const auto count = static_cast<Eigen::Index>(explanations_.size());
    Separations least = Separations::Constant(count, count, 1e300);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Motion along = predictor_.free_run(schedule, explanations_[static_cast<std::size_t>(i)].fit());
      const Separations here = separations_of(predictor_.predictions(schedule, along, explanations_));
      for (Eigen::Index k = 0; k < count; ++k) least(i, k) = least(k, i) = std::min(least(i, k), here(i, k));
    }
    return least;
  }

  const Predictor& predictor_;
  const std::vector<Possible>& explanations_;
  const Limits& limits_;
  const SearchSettings settings_;
  const Library library_;
  Random random_;
  std::vector<ParameterPoint> few_, many_;
  std::vector<Tried> tried_;
  Separations best_;
  std::vector<std::pair<std::string, int>> stopped_by_;
};

}  // namespace thermopower::design
