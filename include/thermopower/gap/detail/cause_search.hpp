// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/detail/as_judged.hpp>
#include <thermopower/gap/detail/attempt.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/detail/window_search.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// Searches the causes of what a model and its recordings differ by, and weighs what it finds.
///
/// In long windows at first: they tell more. Over such a window a small error can send an axis into the next dip of a load,
/// and short ones forgive that: where neither a single cause nor a set comes near the noise, they are tried, too. Dips that
/// hold the axis are passed within the windows of the score as well: where a load is blamed and everything leaves more than a tenth of the gap,
/// shorter ones still are tried, and what was found there is judged in those of the score like all else.
class CauseSearch {
public:
  /// All of them must outlive this object.
  /// @param where  in which submodels the measured rows themselves say that something is missing
  /// @param told   what the effort tells, given the motion; without effects where it tells nothing
  CauseSearch(const Posing& posing, const std::vector<Inputs>& train, const std::vector<Inputs>& held_out,
              const std::vector<Location>& where, const InverseScore& told)
      : posing_(posing),
        as_judged_(posing, train, held_out),
        train_(train),
        told_(told),
        suspects_(suspects_among(where)),
        blames_a_load_(!where.empty() && where.front().submodel == plant::Submodel::mechanical_load) {}

  /// A search, and another one with the windows that the first overlooked.
  Attempt run() const {
    const double long_s = posing_.long_window_s(), short_s = posing_.options().horizon_s;
    std::vector<std::size_t> overlooked;
    Attempt attempt = search(long_s, {}, &overlooked);
    if (overlooked.empty() && attempt.horizon_s == long_s) overlooked = attempt.overlooked_windows(short_s);
    if (!overlooked.empty()) attempt = search(long_s, overlooked);
    if (attempt.horizon_s == long_s && train_.front().axis() && short_s < long_s && attempt.is_far()) {
      Attempt shorter = search(short_s);
      if (shorter.is_nearer_than(attempt)) attempt = std::move(shorter);
    }
    constexpr double tenth = 0.1;
    if (blames_a_load_ && train_.front().axis() && attempt.is_far() && attempt.least_left() > tenth) {
      Attempt shortest = search(search_extent.shorter_than_the_score * short_s);
      if (shortest.least_left() < decision.short_windows_lower * attempt.least_left())
        attempt = std::move(shortest);
    }
    return attempt;
  }

private:
  /// @param also        windows to fit, too
  /// @param overlooked  where given, receives the windows that the single causes overlook; where there are such, the
  ///                    search ends there
  Attempt search(double horizon_s, const std::vector<std::size_t>& also = {},
                 std::vector<std::size_t>* overlooked = nullptr) const {
    WindowSearch search(posing_, as_judged_, train_, suspects_, horizon_s, also);
    search.try_singles();
    if (overlooked != nullptr) {
      *overlooked = search.attempt().overlooked_windows(posing_.options().horizon_s);
      if (!overlooked->empty()) return search.take();
    }
    search.look_at_rows();
    search.try_sets();
    search.try_told(told_);
    search.try_curves();
    search.decide();
    search.try_beside_dear_constants();
    search.try_third_causes();
    search.try_instead_of_bounded();
    return search.take();
  }

  const Posing& posing_;
  AsJudged as_judged_;
  const std::vector<Inputs>& train_;
  const InverseScore& told_;
  std::vector<plant::SubmodelName> suspects_;
  bool blames_a_load_;
};

}  // namespace thermopower::gap::engine
