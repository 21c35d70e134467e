// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/fit/attribution.hpp>

#include <algorithm>
#include <vector>

namespace thermopower::gap::engine {

/// Places of the windows of an axis that an explanation fits worst, as many as were looked at, in order. Empty if the
/// windows that were looked at speak for all. Something may happen outside of them: a limit that is reached in some windows
/// alone.
///
/// @param part       what the explanation was fitted to
/// @param all        the segments that `part` has some of, in the same order
/// @param best       the explanation
/// @param horizon_s  length of the windows of the comparison: short, so that an unknown start does little
inline std::vector<std::size_t> overlooked(const FitProblem& part, const std::vector<Segment>& all,
                                           const Candidate& best, double horizon_s) {
  constexpr double clearly = 1.5;
  if (all.size() == part.segments.size()) return {};
  FitProblem whole = part;
  whole.segments.clear();
  for (const Segment& segment : all)
    if (whole.segments.empty() || whole.segments.back().inputs != segment.inputs)
      part.plant().cut(*segment.inputs, horizon_s, whole.segments);
  struct Sum {
    double squares = 0.0, samples = 0.0;
    void add(const Sum& other) { squares += other.squares, samples += other.samples; }
    double mean() const { return squares / std::max(samples, 1.0); }
  };
  const auto within = [](const Segment& small, const Segment& large) {
    return small.inputs == large.inputs && small.axis == large.axis && small.begin >= large.begin &&
           small.begin < large.end;
  };
  std::vector<Sum> of(all.size());
  std::size_t place = 0;
  whole.evaluate(best.explanation, best.list, best.fit.point, whole.measured_starts(), false,
                 [&](std::size_t i, const FitProblem::Residuals& one) {
                   while (place + 1 < all.size() && !within(whole.segments[i], all[place])) ++place;
                   of[place].add({one.value.squaredNorm(), static_cast<double>(one.value.size())});
                 });
  Sum total, seen;
  std::vector<std::size_t> order;
  auto looked_at = part.segments.begin();
  for (place = 0; place < all.size(); ++place) {
    if (!all[place].axis) continue;
    order.push_back(place);
    total.add(of[place]);
    while (looked_at != part.segments.end() && !looked_at->axis) ++looked_at;
    if (looked_at == part.segments.end() || looked_at->inputs != all[place].inputs ||
        looked_at->begin != all[place].begin)
      continue;
    ++looked_at;
    seen.add(of[place]);
  }
  if (total.mean() < clearly * clearly * seen.mean()) return {};
  sort_by(order, [&](std::size_t i) { return -of[i].mean(); });
  order.resize(std::min(order.size(), part.segments.size()));
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace thermopower::gap::engine
