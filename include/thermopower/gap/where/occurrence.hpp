// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/where/localisation.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// In which runs a fault shows while it does not in others, and from when on.

namespace thermopower::gap::engine {

/// Thresholds of the question in which runs, and from when on, a fault shows. A balance holds where its
/// constants leave no more than LocalisationThresholds::gap_seen.
/// Held by tests/gap/where/occurrence_test.cpp.
struct OccurrenceThresholds {
  Eigen::Index least_rows = 150;   ///< of a run that is asked about: eight stretches of some twenty rows
  Eigen::Index most_rows = 20000;  ///< of a run: the first of them; more say no more about whether
  std::size_t most_runs = 12;      ///< that are asked about, evenly spread
  double clearly = 4.0;            ///< floors that the constants leave at least where a balance does not hold
  int stretches = 20;              ///< of a run, at the ends of which a fault may begin
  int first = 3;                   ///< stretches that must hold before it
};

/// The thresholds of every question about runs.
inline constexpr OccurrenceThresholds occurrence_limits;

namespace detail {

/// A balance of a run and what its constants, moving within their slack, leave of it.
class HeldBalance {
public:
  /// @param balance  with readings as they are
  explicit HeldBalance(plant::Balance balance)
      : balance_(std::move(balance)),
        projection_(projection_of(balance_)),
        whole_(problem_of(balance_, *projection_)),
        stretch_(projection_->stretches(occurrence_limits.stretches)) {}

  HeldBalance(const HeldBalance&) = delete;  // the projection refers to the balance
  HeldBalance& operator=(const HeldBalance&) = delete;

  /// Floors that the constants leave of the run; 0 where it has too few rows to tell.
  double left() const { return left_of(part(rows_of(0, occurrence_limits.stretches))); }

  /// Up to when it holds, of one that does not hold to the end; none: there is no such time.
  std::optional<double> holds_until_s() const {
    int held = 0;
    for (int end = 1; end < occurrence_limits.stretches; ++end) {
      const Problem before = part(rows_of(0, end));
      if (left_of(before) > where_limits.gap_seen) break;
      if (before.y.size() >= where_limits.least_rows) held = end;
    }
    if (held < occurrence_limits.first || !could_show_before(held)) return {};
    return balance_.rows->t_s[balance_.rows->size() * held / occurrence_limits.stretches];
  }

private:
  /// Rows of the stretches [from, to).
  std::vector<Eigen::Index> rows_of(int from, int to) const {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < stretch_.size(); ++i)
      if (stretch_[i] >= from && stretch_[i] < to) rows.push_back(i);
    return rows;
  }

  /// Some rows of the run.
  Problem part(const std::vector<Eigen::Index>& rows) const {
    Problem part;
    part.y = whole_.y(rows);
    part.nuisance = whole_.nuisance(rows, Eigen::all);
    part.free = whole_.free(rows, Eigen::all);
    part.fold = Eigen::VectorXi::Zero(part.y.size());
    return part;
  }

  double left_of(const Problem& part) const {
    if (part.y.size() < where_limits.least_rows) return 0.0;
    const double floor =
        projection_->floor() * static_cast<double>(part.y.size()) / static_cast<double>(whole_.y.size());
    return sum_of_squares_left(part, Eigen::MatrixXd(part.y.size(), 0)) / floor;
  }

  /// Whether the rows before a stretch would have shown the fault of the later rows. If nothing drives a fault there, its
  /// absence says nothing. The freedom with the smallest rest decides.
  bool could_show_before(int held) const {
    const std::vector<Eigen::Index> after = rows_of(held, occurrence_limits.stretches),
                                    first = rows_of(0, held);
    const Problem later = part(after);
    Problem before = part(first);
    double least = std::numeric_limits<double>::infinity();
    for (const plant::Freedom& freedom : balance_.freedoms) {
      const Block all = block_of(freedom, *projection_, whole_);
      Block block = all;
      block.columns = all.columns(after, Eigen::all);
      const BlockFit fit = BlockFitter(later, {block}).fit_all({0});
      if (!(fit.seen < least)) continue;
      least = fit.seen;
      before.y = all.columns(first, Eigen::all) * fit.coefficients.tail(all.columns.cols());
    }
    return std::isfinite(least) && left_of(before) > occurrence_limits.clearly;
  }

  plant::Balance balance_;
  std::unique_ptr<Projection> projection_;
  Problem whole_;
  Eigen::VectorXi stretch_;
};

/// One run of a recording, or a part of one that was cut, and its balances.
struct AskedRun {
  /// Of the alternatives of a signal the balance that holds best.
  struct Best {
    const plant::BalanceSource* source;  ///< it
    double level;                        ///< floors that the constants leave of it
  };
  Occurrence name;                             ///< the run
  std::unique_ptr<RecordedBalances> balances;  ///< of it alone
  std::map<std::string, Best> best = {};       ///< by signal

  /// Whether it is of the same run as another.
  bool is_of(const Occurrence& run) const {
    return name.recording == run.recording && name.run == run.run && name.held_out == run.held_out;
  }
  /// Floors that the constants leave of a signal; NaN where it is not judged.
  double level(const std::string& signal) const {
    const auto known = best.find(signal);
    return known == best.end() ? missing : known->second.level;
  }
};

/// The runs that are long enough, evenly spread where there are many. @param list  they are added to it
inline void add_runs(const Model& model, const std::vector<Recording>& recordings, bool held_out,
                     const Catalogue& catalogue, std::vector<AskedRun>& list) {
  std::vector<std::pair<const Recording*, RunSpan>> runs;
  for (const Recording& one : recordings)
    for (const RunSpan& run : one.spans())
      if (run.size() >= occurrence_limits.least_rows) runs.push_back({&one, run});
  const std::size_t asked = std::min(runs.size(), occurrence_limits.most_runs);
  for (std::size_t i = 0; i < asked; ++i) {
    const auto& [recording, run] = runs[asked < 2 ? 0 : i * (runs.size() - 1) / (asked - 1)];
    const Eigen::Index end = std::min(run.end, run.begin + occurrence_limits.most_rows);
    const std::vector<Recording> rows{recording->slice(run.begin, end)};
    AskedRun& part = list.emplace_back();
    part.name = {recording->name, run.label, held_out, {}};
    part.balances = std::make_unique<RecordedBalances>(model, rows, catalogue);
    for (const plant::BalanceSource& source : part.balances->sources()) {
      const double level = HeldBalance(source.make({})).left();
      const auto [known, is_new] =
          part.best.try_emplace(to_string(source.signal), AskedRun::Best{&source, level});
      if (!is_new && level < known->second.level) known->second = {&source, level};
    }
  }
}

}  // namespace detail

/// Says of each location in which runs the fault shows while others hold, and from when on. It adds the places of faults
/// that show in held-out runs only.
/// @param train, held_out as the diagnosis is given them
inline void add_occurrences(const Model& model, const std::vector<Recording>& train,
                            const std::vector<Recording>& held_out, const Catalogue& catalogue,
                            Localisation& found) {
  using detail::AskedRun;
  std::vector<AskedRun> parts;
  detail::add_runs(model, train, false, catalogue, parts);
  detail::add_runs(model, held_out, true, catalogue, parts);
  // Runs in which a signal clearly does not hold, and from when on. Empty where it shows in all of them from the first row on.
  const auto occurrences = [&](const std::string& signal) {
    std::vector<Occurrence> list;
    std::vector<const AskedRun*> of;
    std::size_t runs = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i == 0 || !parts[i].is_of(parts[i - 1].name)) ++runs;
      if (!(parts[i].level(signal) >= occurrence_limits.clearly) ||
          (!list.empty() && parts[i].is_of(list.back())))
        continue;
      list.push_back(parts[i].name);
      of.push_back(&parts[i]);
    }
    for (std::size_t i = 0; i < list.size(); ++i) {
      list[i].from_s = detail::HeldBalance(of[i]->best.at(signal).source->make({})).holds_until_s();
      // A fault that shows throughout the first run did not begin in a later one, so the others are not asked.
      if (list.size() == runs && !list.front().from_s) return std::vector<Occurrence>();
    }
    return list;
  };
  const auto place_of = [&](const std::string& signal) {
    return std::find_if(found.where.begin(), found.where.end(),
                        [&](const Location& one) { return to_string(one.signal) == signal; });
  };
  for (auto one = found.where.begin(); one != found.where.end(); ++one) {
    const std::string signal = to_string(one->signal);
    if (const auto same = place_of(signal); same != one) {
      one->only_in = same->only_in;
      continue;
    }
    std::vector<Occurrence> list = occurrences(signal);
    const bool holds_in_some =
        std::any_of(parts.begin(), parts.end(),
                    [&](const AskedRun& part) { return part.level(signal) < where_limits.gap_seen; }) ||
        std::any_of(list.begin(), list.end(), [](const Occurrence& run) { return run.from_s.has_value(); });
    if (holds_in_some) one->only_in = std::move(list);
  }
  const bool is_off_in_held_out_alone = std::any_of(parts.begin(), parts.end(), [&](const AskedRun& part) {
    return part.name.held_out && std::any_of(part.best.begin(), part.best.end(), [&](const auto& one) {
             return one.second.level >= occurrence_limits.clearly && place_of(one.first) == found.where.end();
           });
  });
  if (!is_off_in_held_out_alone) return;
  Localisation later = localise(model, held_out, catalogue);
  std::vector<Location> more;
  for (Location& one : later.where) {
    const std::string signal = to_string(one.signal);
    if (place_of(signal) != found.where.end()) continue;
    one.only_in = occurrences(signal);
    if (!one.only_in.empty()) more.push_back(std::move(one));
  }
  found.where.insert(found.where.end(), more.begin(), more.end());
  if (found.quantities.empty()) found.quantities = std::move(later.quantities);
}

}  // namespace thermopower::gap::engine
