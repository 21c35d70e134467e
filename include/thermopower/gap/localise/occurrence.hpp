// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/localise/localisation.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// In which runs a fault shows while it does not in others, and from when on.

namespace thermopower::gap::engine {

/// Thresholds of the question in which runs, and from when on, a fault shows.
/// Held by tests/gap/localise/occurrence_test.cpp.
struct OccurrenceThresholds {
  Eigen::Index least_rows = 150;   ///< of a run that is asked about: eight stretches of some twenty rows
  Eigen::Index most_rows = 20000;  ///< of a run: the first of them; more say no more about whether
  std::size_t most_runs = 12;      ///< that are asked about, evenly spread
  double holds =
      1.5;  ///< floors that the constants may leave where a balance holds: noise is known to some 20 %
  double clearly = 4.0;  ///< floors that they leave at least where it does not
  int stretches = 20;    ///< of a run, at the ends of which a fault may begin
  int first = 3;         ///< stretches that must hold before it
};

/// One run of a recording.
struct RunPart {
  Recording recording;    ///< its rows alone
  std::string name;       ///< of the recording
  std::string run;        ///< label of the run, may be empty
  bool held_out = false;  ///< it is among the held-out data
};

namespace detail {

/// How one balance does in one run.
struct Holding {
  plant::QuantityName quantity;  ///< of the balance
  plant::SignalName signal;      ///< of the balance
  double level = 0.0;            ///< floors that the constants within their slack leave
  std::size_t source = 0;        ///< which of the run's balances it is
};

/// The rows of a problem on one side of a stretch.
inline Problem part_of(const Problem& whole, const Eigen::VectorXi& stretch, int from, int to) {
  assert(stretch.size() == whole.y.size());
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < whole.y.size(); ++i)
    if (stretch[i] >= from && stretch[i] < to) rows.push_back(i);
  Problem part;
  part.slack = whole.slack;
  part.y = whole.y(rows);
  part.nuisance = whole.nuisance(rows, Eigen::all);
  part.free = whole.free(rows, Eigen::all);
  part.folds = 1;
  part.fold = Eigen::VectorXi::Zero(part.y.size());
  return part;
}

/// A balance of a run and what its constants, moving within their slack, leave of it.
class HeldBalance {
public:
  /// @param slack  how far a constant may be off, as a fraction
  HeldBalance(plant::Balance balance, double slack)
      : balance_(std::move(balance)),
        projection_(projection_of(balance_, stage_)),
        whole_(problem_of(balance_, *projection_, slack)),
        floor_per_row_(projection_->floor() / static_cast<double>(whole_.y.size())),
        stretch_(projection_->stretches(limit_.stretches)) {}

  HeldBalance(const HeldBalance&) = delete;  // the projection refers to the balance
  HeldBalance& operator=(const HeldBalance&) = delete;

  /// Which quantity it is of, and what it says of it.
  const plant::Balance& balance() const { return balance_; }

  /// Floors that the constants leave of the run; 0 where it has too few rows to tell.
  double left() const { return left_before(limit_.stretches); }

  /// Up to when it holds, of one that does not hold to the end; none: there is no such time.
  std::optional<double> holds_until_s() const {
    int held = 0;
    for (int end = 1; end < limit_.stretches && left_before(end) <= limit_.holds; ++end)
      if (tells_before(end)) held = end;
    if (held < limit_.first || !could_show_before(held)) return {};
    const Eigen::Index row = balance_.rows->size() * held / limit_.stretches;
    return balance_.rows->t_s[std::min(row, balance_.rows->size() - 1)];
  }

private:
  /// Whether the rows before a stretch are enough to tell anything.
  bool tells_before(int stretch) const { return (stretch_.array() < stretch).count() >= stage_.least_rows; }

  double left_before(int stretch) const {
    if (!tells_before(stretch)) return 0.0;
    const Problem part = part_of(whole_, stretch_, 0, stretch);
    return sum_of_squares_left(part, Eigen::MatrixXd(part.y.size(), 0)) /
           (floor_per_row_ * static_cast<double>(part.y.size()));
  }

  /// Whether the rows before a stretch would have shown the fault of the later rows. If nothing drives a fault there, its
  /// absence says nothing. The freedom with the smallest rest decides.
  bool could_show_before(int held) const {
    const Problem later = part_of(whole_, stretch_, held, limit_.stretches);
    Problem before = part_of(whole_, stretch_, 0, held);
    std::vector<Eigen::Index> after, first;
    for (Eigen::Index i = 0; i < whole_.y.size(); ++i) (stretch_[i] < held ? first : after).push_back(i);
    double least = std::numeric_limits<double>::infinity();
    for (const plant::Freedom& freedom : balance_.freedoms) {
      const Block all = block_of(freedom, *projection_, whole_);
      Block block = all;
      block.columns = all.columns(after, Eigen::all);
      const std::vector<Block> blocks{block};
      const BlockFit fit = BlockFitter(later, blocks).fit({0});
      if (!(fit.seen_total < least)) continue;
      least = fit.seen_total;
      before.y = all.columns(first, Eigen::all) * fit.coefficients.tail(block.columns.cols());
    }
    return std::isfinite(least) && sum_of_squares_left(before, Eigen::MatrixXd(before.y.size(), 0)) >
                                       limit_.clearly * floor_per_row_ * static_cast<double>(before.y.size());
  }

  static constexpr OccurrenceThresholds limit_{};
  static constexpr LocalisationThresholds stage_{};
  plant::Balance balance_;
  std::unique_ptr<Projection> projection_;
  Problem whole_;
  double floor_per_row_;
  Eigen::VectorXi stretch_;
};

/// The balances of a run.
class RunBalances {
public:
  /// Keeps references to model and catalogue: they must outlive it. @param slack  as for HeldBalance
  RunBalances(const Model& model, const RunPart& part, double slack, const Catalogue& catalogue)
      : balances_(model, {part.recording}, catalogue), slack_(slack) {}

  /// One of them.
  HeldBalance at(std::size_t source) const {
    return HeldBalance(
        balances_.sources()[source].make(plant::ReadingOffsets(plant::actuator_signal_count, 0.0)), slack_);
  }

  /// How each quantity's does; of alternatives the one that holds best.
  std::vector<Holding> holdings() const {
    std::vector<Holding> list;
    for (std::size_t i = 0; i < balances_.sources().size(); ++i) {
      const HeldBalance held = at(i);
      Holding one{held.balance().quantity, held.balance().signal, held.left(), i};
      const auto same = std::find_if(list.begin(), list.end(),
                                     [&](const Holding& other) { return other.quantity == one.quantity; });
      if (same == list.end()) list.push_back(std::move(one));
      else if (one.level < same->level) *same = std::move(one);
    }
    return list;
  }

private:
  RecordedBalances balances_;
  double slack_;
};

/// The runs of recordings that are long enough, evenly spread where there are many.
inline std::vector<RunPart> runs_of(const std::vector<Recording>& recordings, bool held_out,
                                    const OccurrenceThresholds& limit) {
  std::vector<RunPart> all;
  for (const Recording& one : recordings)
    for (const RunSpan& run : one.spans())
      if (run.size() >= limit.least_rows)
        all.push_back({one.slice(run.begin, std::min(run.end, run.begin + limit.most_rows)), one.name,
                       run.label, held_out});
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
  constexpr OccurrenceThresholds limit;
  std::vector<RunPart> parts = detail::runs_of(train, false, limit);
  for (RunPart& one : detail::runs_of(held_out, true, limit)) parts.push_back(std::move(one));
  std::vector<std::vector<detail::Holding>> holdings;
  for (const RunPart& part : parts)
    holdings.push_back(detail::RunBalances(model, part, options.slack, catalogue).holdings());
  const auto of_one_run = [](const auto& a, const auto& b) {
    return a.recording == b.recording && a.run == b.run && a.held_out == b.held_out;
  };
  std::vector<Occurrence> runs;  // a run that was cut is one all the same
  for (const RunPart& part : parts) {
    const Occurrence whole{part.name, part.run, part.held_out, {}};
    if (runs.empty() || !of_one_run(runs.back(), whole)) runs.push_back(whole);
  }
  const auto occurrences = [&](const plant::SignalName& signal) {
    std::vector<Occurrence> list;
    std::vector<std::pair<std::size_t, std::size_t>> of;  // part and balance of each
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (const detail::Holding& one : holdings[i]) {
        if (one.signal != signal || one.level < limit.clearly) continue;
        const Occurrence here{parts[i].name, parts[i].run, parts[i].held_out, {}};
        if (!list.empty() && of_one_run(list.back(), here)) break;
        list.push_back(here);
        of.push_back({i, one.source});
        break;
      }
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto [part, source] = of[i];
      list[i].from_s =
          detail::RunBalances(model, parts[part], options.slack, catalogue).at(source).holds_until_s();
      // A fault that shows throughout the first run did not begin in a later one, so the others are not asked.
      if (list.size() == runs.size() && !list.front().from_s) return std::vector<Occurrence>();
    }
    return list;
  };
  const auto held_anywhere = [&](const plant::SignalName& signal) {
    for (const auto& list : holdings)
      for (const detail::Holding& one : list)
        if (one.signal == signal && one.level < limit.holds) return true;
    return false;
  };
  for (auto one = found.where.begin(); one != found.where.end(); ++one) {
    const auto same = std::find_if(found.where.begin(), one,
                                   [&](const Location& before) { return before.signal == one->signal; });
    if (same != one) {
      one->only_in = same->only_in;
      continue;
    }
    std::vector<Occurrence> list = occurrences(one->signal);
    const bool later =
        std::any_of(list.begin(), list.end(), [](const Occurrence& o) { return o.from_s.has_value(); });
    if (held_anywhere(one->signal) || later) one->only_in = std::move(list);
  }
  bool held_out_alone = false;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const detail::Holding& one : holdings[i])
      held_out_alone =
          held_out_alone || (parts[i].held_out && one.level >= limit.clearly &&
                             std::none_of(found.where.begin(), found.where.end(),
                                          [&](const Location& l) { return l.signal == one.signal; }));
  if (!held_out_alone) return;
  const Localisation later = localise(model, held_out, options, catalogue);
  for (Location one : later.where) {
    if (std::any_of(found.where.begin(), found.where.end(),
                    [&](const Location& l) { return l.signal == one.signal; }))
      continue;
    one.only_in = occurrences(one.signal);
    if (one.only_in.empty()) continue;
    found.where.push_back(std::move(one));
  }
  if (found.quantities.empty()) found.quantities = later.quantities;
}

}  // namespace thermopower::gap::engine
