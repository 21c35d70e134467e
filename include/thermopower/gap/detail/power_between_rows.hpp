// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/compare/evidence.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/fit/attribution.hpp>
#include <thermopower/gap/observe/heat_between_rows.hpp>
#include <thermopower/gap/rule.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace thermopower::gap::engine {

/// The power of a body whose loop may have set it between the rows as well, where the check did not tell: how much of the next row's
/// is in force before that row, as a hypothesis of the input.
class PowerBetweenRows {
public:
  /// All of them must outlive this object.
  /// @param train     that explanations are fitted to; let_change() changes them
  /// @param held_out  that they are judged on; let_change() changes them
  PowerBetweenRows(const Posing& posing, std::vector<Inputs>& train, std::vector<Inputs>& held_out)
      : posing_(posing), train_(train), held_out_(held_out) {}

  /// The share of an interval in which the next row's power is in force, by the model's constants alone; 0 where they prefer that power
  /// holds until that row, where no loop sets it anew at most rows, and where the check has told it.
  double share_by_constants() const {
    constexpr double step = 0.25;
    constexpr std::size_t tried = 4;
    const bool is_asked =
        !posing_.model().own &&
        std::all_of(train_.begin(), train_.end(), [](const Inputs& one) { return is_set_anew(one); });
    if (!is_asked) return 0.0;
    Weight weight;
    std::array<double, tried> left{};
    for (std::size_t i = 0; i < tried; ++i) {
      let_change(step * static_cast<double>(i));
      const FitProblem problem = posing_.pose(train_, posing_.fitted(posing_.options().horizon_s));
      const Candidate constants = Attribution(problem).fit({}, {});
      if (i == 0) weight = correlation_of(constants, problem);
      left[i] = misfit_of(constants.train, weight.correlation);
    }
    let_change(0.0);
    const auto best = static_cast<std::size_t>(std::min_element(left.begin(), left.end()) - left.begin());
    if (!(left[0] - left[best] > usual_rarity) || !holds(Rule::heat_between_rows)) return 0.0;
    // The vertex of the parabola through it and its neighbours.
    const std::size_t middle = std::min(best, tried - 2);
    const double slope = 0.5 * (left[middle + 1] - left[middle - 1]),
                 bend = left[middle + 1] - 2.0 * left[middle] + left[middle - 1],
                 vertex = bend > 0.0 ? static_cast<double>(middle) - slope / bend : static_cast<double>(best);
    return step * std::clamp(vertex, 1.0, static_cast<double>(tried));
  }

  /// Lets power that a loop sets anew be that of the next row for a share of each interval. @param share  0: it holds
  void let_change(double share) const {
    for (std::vector<Inputs>* part : {&train_, &held_out_})
      for (Inputs& one : *part) {
        one.next_share.resize(0);
        if (share > 0.0 && is_set_anew(one))
          one.next_share =
              switched_share(one, heat_at_rows(posing_.model(), posing_.catalogue(), one), share);
      }
  }

private:
  const Posing& posing_;
  std::vector<Inputs>&train_, &held_out_;
};

}  // namespace thermopower::gap::engine
