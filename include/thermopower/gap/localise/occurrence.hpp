// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/localisation.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// In which runs a fault shows while it does not in others, and from when on.

namespace thermopower::gap::engine {

/// One run of a recording, by itself.
struct RunPart {
  Recording recording;  ///< its rows alone
  Occurrence of;        ///< which it is
};

/// How the constants of a model, moving within their slack, do in one run.
struct Holding {
  plant::QuantityName quantity;  ///< of the balance
  plant::SignalName signal;      ///< of the balance
  double level = 0.0;            ///< floors that they leave; of alternatives the least
  std::optional<double>
      from_s;  ///< stamp up to which they leave no more than noise, where they leave more later
};

namespace detail {

/// The rows of a problem before a stretch.
inline Problem before(const Problem& whole, const Eigen::VectorXi& stretch, int end) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < whole.y.size(); ++i)
    if (stretch[i] < end) rows.push_back(i);
  Problem part;
  part.slack = whole.slack;
  part.y = whole.y(rows);
  part.nuisance = whole.nuisance(rows, Eigen::all);
  part.free = whole.free(rows, Eigen::all);
  return part;
}

/// How one balance does in one run. @param slack  how far a constant may be off, as a fraction
inline Holding holding_of(const plant::Balance& balance, double slack) {
  constexpr LocalisationThresholds limit;
  const std::unique_ptr<Projection> projection = projection_of(balance, limit);
  const Problem whole = problem_of(balance, *projection, slack);
  const double floor = projection->floor() / static_cast<double>(whole.y.size());
  const Eigen::VectorXi stretch = projection->stretches(limit.run_stretches);
  // Too few rows tell nothing, and are taken to hold.
  const auto left_before = [&](int end) -> std::optional<double> {
    const Problem part = before(whole, stretch, end);
    if (part.y.size() < limit.least_rows) return std::nullopt;
    return sum_of_squares_left(part, Eigen::MatrixXd(part.y.size(), 0)) /
           (floor * static_cast<double>(part.y.size()));
  };
  Holding result{balance.quantity, balance.signal, left_before(limit.run_stretches).value_or(0.0), {}};
  if (result.level < limit.shows) return result;
  int held = 0;
  for (int end = 1; end < limit.run_stretches; ++end) {
    const std::optional<double> left = left_before(end);
    if (left.value_or(0.0) > limit.nothing_shows) break;
    if (left) held = end;
  }
  if (held >= limit.first_stretches)
    result.from_s =
        balance.rows
            ->t_s[std::min(balance.rows->size() * held / limit.run_stretches, balance.rows->size() - 1)];
  return result;
}

/// How each quantity does in a run; of alternatives the one that holds best.
inline std::vector<Holding> holdings_in(const Model& model, const RunPart& part, double slack,
                                        const Catalogue& catalogue) {
  const RecordedBalances balances(model, {part.recording}, catalogue);
  std::vector<Holding> list;
  for (const plant::BalanceSource& source : balances.sources()) {
    Holding one = holding_of(source.make(plant::ReadingOffsets(plant::actuator_signal_count, 0.0)), slack);
    const auto same = std::find_if(list.begin(), list.end(),
                                   [&](const Holding& other) { return other.quantity == one.quantity; });
    if (same == list.end()) list.push_back(std::move(one));
    else if (one.level < same->level) *same = std::move(one);
  }
  return list;
}

/// The runs of recordings that are long enough, evenly spread where there are many.
inline std::vector<RunPart> runs_of(const std::vector<Recording>& recordings, bool held_out) {
  constexpr LocalisationThresholds limit;
  std::vector<RunPart> all;
  for (const Recording& one : recordings)
    for (const RunSpan& run : one.spans())
      if (run.size() >= limit.run_least_rows)
        all.push_back({one.slice(run.begin, std::min(run.end, run.begin + limit.run_most_rows)),
                       {one.name, run.label, held_out, {}}});
  if (all.size() <= limit.most_runs) return all;
  std::vector<RunPart> some;
  for (std::size_t i = 0; i < limit.most_runs; ++i)
    some.push_back(std::move(all[i * (all.size() - 1) / (limit.most_runs - 1)]));
  return some;
}

}  // namespace detail

/// Says of each location in which runs the fault shows while others hold, and from when on. It adds the places of faults
/// that show in held-out runs only.
/// @param train, held_out as the diagnosis is given them
inline void add_occurrences(const Model& model, const std::vector<Recording>& train,
                            const std::vector<Recording>& held_out, const LocalisationOptions& options,
                            const Catalogue& catalogue, Localisation& found) {
  constexpr LocalisationThresholds limit;
  std::vector<RunPart> parts = detail::runs_of(train, false);
  for (RunPart& one : detail::runs_of(held_out, true)) parts.push_back(std::move(one));
  std::vector<std::vector<Holding>> holdings;
  for (const RunPart& part : parts)
    holdings.push_back(detail::holdings_in(model, part, options.slack, catalogue));
  const auto of_one_run = [](const Occurrence& a, const Occurrence& b) {
    return a.recording == b.recording && a.run == b.run && a.held_out == b.held_out;
  };
  /// The runs that show a fault in a signal; none where all do, throughout.
  const auto occurrences = [&](const plant::SignalName& signal) {
    std::vector<Occurrence> list;
    bool holds = false;
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (const Holding& one : holdings[i]) {
        if (one.signal != signal) continue;
        holds = holds || one.level < limit.nothing_shows || one.from_s;
        // A run that was cut is one all the same.
        if (one.level < limit.shows || (!list.empty() && of_one_run(list.back(), parts[i].of))) continue;
        list.push_back(parts[i].of);
        list.back().from_s = one.from_s;
      }
    return holds ? list : std::vector<Occurrence>();
  };
  const auto is_placed = [&](const plant::SignalName& signal) {
    return std::any_of(found.where.begin(), found.where.end(),
                       [&](const Location& one) { return one.signal == signal; });
  };
  for (Location& one : found.where) one.only_in = occurrences(one.signal);
  bool held_out_alone = false;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const Holding& one : holdings[i])
      held_out_alone =
          held_out_alone || (parts[i].of.held_out && one.level >= limit.shows && !is_placed(one.signal));
  if (!held_out_alone) return;
  const Localisation later = localise(model, held_out, options, catalogue);
  for (Location one : later.where) {
    if (is_placed(one.signal)) continue;
    one.only_in = occurrences(one.signal);
    if (!one.only_in.empty()) found.where.push_back(std::move(one));
  }
  if (found.quantities.empty()) found.quantities = later.quantities;
}

}  // namespace thermopower::gap::engine
