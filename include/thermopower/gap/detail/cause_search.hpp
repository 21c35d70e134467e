// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/detail/as_judged.hpp>
#include <thermopower/gap/detail/attempt.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/detail/window_search.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>

#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Searches the causes of what a model and its recordings differ by, and weighs what it finds.
///
/// In long windows at first: they tell more. Over such a window a small error can send an axis into the next dip of a load,
/// and short ones forgive that: where neither a single cause nor a set comes near the noise, they are tried, too.
class CauseSearch {
public:
  /// All of them must outlive this object.
  /// @param where  in which submodels the measured rows themselves say that something is missing
  /// @param told   what the effort tells, given the motion; without effects where it tells nothing
  /// @param effort_may_answer  whether the effort is asked where single causes do not bring the motion to the noise
  CauseSearch(const Posing& posing, const std::vector<Inputs>& train, const std::vector<Inputs>& held_out,
              const std::vector<Location>& where, const InverseScore& told, bool effort_may_answer)
      : posing_(posing),
        as_judged_(posing, train, held_out),
        train_(train),
        told_(told),
        effort_may_answer_(effort_may_answer),
        suspects_(suspects_among(where)) {}

  /// A search in long windows, and one in those of the score where that closes more.
  Attempt run() const {
    const double long_s = posing_.long_window_s(), short_s = posing_.options().horizon_s;
    Attempt attempt = search(long_s);
    if (train_.front().axis() && !effort_may_answer_ && short_s < long_s && attempt.is_far()) {
      Attempt shorter = search(short_s);
      if (shorter.closes_more_than(attempt)) attempt = std::move(shorter);
    }
    return attempt;
  }

private:
  Attempt search(double horizon_s) const {
    WindowSearch search(posing_, as_judged_, train_, suspects_, horizon_s);
    search.try_singles();
    search.look_at_rows();
    if (effort_may_answer_) search.try_told(told_);
    const bool effort_answers = effort_may_answer_ && search.has_room();
    if (!effort_answers) {
      search.try_sets();
      search.try_told(told_);
      search.try_curves();
    }
    search.decide();
    if (!effort_answers) {
      search.try_late();
      search.try_beside_dear_constants();
      search.try_third_causes();
      search.try_simpler_relatives();
    }
    return search.take();
  }

  const Posing& posing_;
  AsJudged as_judged_;
  const std::vector<Inputs>& train_;
  const InverseScore& told_;
  bool effort_may_answer_;
  std::vector<plant::SubmodelName> suspects_;
};

}  // namespace thermopower::gap::engine
