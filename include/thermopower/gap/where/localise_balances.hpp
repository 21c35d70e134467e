// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/where/judgement.hpp>
#include <thermopower/gap/where/missing_quantity.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// Where a plant and its recordings part, from the plant's balances alone.

namespace thermopower::gap::engine {

/// Where simulation and recordings part, and the missing quantity itself.
struct Localisation {
  std::vector<Location> where;              ///< the largest first; empty where no submodel is at fault
  std::vector<MissingQuantity> quantities;  ///< one per faulty submodel (`effect` still empty)
};

namespace detail {

/// A localisation under way.
class Localiser {
public:
  explicit Localiser(const std::vector<plant::BalanceSource>& sources) : sources_(sources) {
    for (const plant::BalanceSource& source : sources) {
      const auto same = std::find_if(groups_.begin(), groups_.end(), [&](const Group& one) {
        const plant::BalanceSource& other = *one.sources.front();
        return other.quantity == source.quantity && other.signal == source.signal;
      });
      if (same == groups_.end()) groups_.push_back({{&source}});
      else same->sources.push_back(&source);
    }
  }

  Localisation run() {
    // Balances that have no alternative come first, with the readings as they are.
    for (Group& group : groups_)
      if (!group.has_alternatives()) judge(group, *group.sources.front(), offsets_);
    for (std::size_t i = 0; i < groups_.size(); ++i) correct_by(i);
    for (Group& group : groups_)
      if (group.has_alternatives())
        for (const plant::BalanceSource* source : group.sources) judge(group, *source, offsets_);
    for (const Group& group : groups_)
      if (group.judgement && group.judgement->gap) place(group);
    sort_by(out_.where, [](const Location& one) { return -one.share; });
    return std::move(out_);
  }

private:
  /// The balances of one quantity.
  struct Group {
    std::vector<const plant::BalanceSource*> sources;  ///< one or more
    std::optional<Judgement> judgement = {};           ///< of the one that counts
    const plant::BalanceSource* counts = nullptr;      ///< that one
    plant::ReadingOffsets offsets = {};                ///< by which its readings were corrected
    bool instrument = false;  ///< the first freedom's instrument is at fault, not the plant

    bool has_alternatives() const { return sources.size() > 1; }
    const plant::SignalName& signal() const { return sources.front()->signal; }
  };

  /// Judges a balance. Of several of one quantity the best one counts. One that reads a signal without a gap of its own is not
  /// asked: where law and measurement agree there is one flow, and the law's carries no noise.
  void judge(Group& group, const plant::BalanceSource& source, const plant::ReadingOffsets& offsets) const {
    const auto has_gap = [&](const plant::SignalName& signal) {
      return std::any_of(groups_.begin(), groups_.end(), [&](const Group& one) {
        return one.judgement && one.signal() == signal && one.judgement->gap;
      });
    };
    if (group.judgement && std::none_of(source.reads.begin(), source.reads.end(), has_gap)) return;
    Judgement judgement = judged(source.make(offsets));
    if (group.judgement && !(judgement.cost < group.judgement->cost)) return;
    group.judgement = std::move(judgement);
    group.counts = &source;
    group.offsets = offsets;
  }

  /// Corrects readings by what a balance of two instruments says: surely where the fault is the instrument's own. The other
  /// instrument's are corrected where the other balances leave less then.
  void correct_by(std::size_t index) {
    const Group& group = groups_[index];
    if (!group.judgement || !group.judgement->is_explained_beyond(where_limits.instrument_explained)) return;
    for (const ChosenFreedom& chosen : group.judgement->chosen) {
      const std::optional<plant::Correction>& correction = chosen.freedom.correction;
      if (!correction) continue;
      plant::ReadingOffsets corrected = offsets_;
      corrected[correction->signal] += correction->offset * chosen.coefficient;
      if (!chosen.freedom.or_instrument) {
        offsets_ = corrected;
        continue;
      }
      std::vector<Group> others = groups_;
      double before = 0.0, after = 0.0;
      for (std::size_t i = 0; i < groups_.size(); ++i) {
        if (i == index || !groups_[i].judgement) continue;
        others[i].judgement.reset();
        judge(others[i], *others[i].sources.front(), corrected);
        before += groups_[i].judgement->left;
        after += others[i].judgement->left;
      }
      if (!(after < before)) continue;
      groups_ = std::move(others);
      groups_[index].instrument = true;
      offsets_ = corrected;
      return;
    }
  }

  /// Whether a balance with alternatives holds best without a signal's reading.
  bool holds_without(const plant::SignalName& signal) const {
    return std::any_of(groups_.begin(), groups_.end(), [&](const Group& one) {
      return one.has_alternatives() && one.judgement &&
             std::count(one.counts->reads.begin(), one.counts->reads.end(), signal) == 0;
    });
  }

  /// Whether a variable is the reading of another balance's instrument that is at fault.
  bool is_misled(const plant::Balance& balance, const std::string& variable) const {
    return std::any_of(balance.variables.begin(), balance.variables.end(), [&](const auto& one) {
      return one.name == variable && one.from != balance.signal &&
             std::any_of(groups_.begin(), groups_.end(), [&](const Group& other) {
               const std::optional<Judgement>& of = other.judgement;
               return of && other.signal() == one.from &&
                      of->is_explained_beyond(where_limits.instrument_explained) &&
                      of->chosen.front().freedom.submodel == of->instrument;
             });
    });
  }

  void place(const Group& group) {
    const Judgement& judgement = *group.judgement;
    const plant::Balance balance = group.counts->make(group.offsets);
    if (judgement.is_explained_beyond(where_limits.explained)) {
      for (const ChosenFreedom& one : judgement.chosen) {
        const plant::Freedom& freedom = one.freedom;
        if (is_misled(balance, freedom.variable)) continue;
        const bool first = &one == &judgement.chosen.front();
        Location location{balance.signal, freedom.submodel, one.worth, {}, {}};
        if (first && freedom.or_instrument &&
            (freedom.correction ? group.instrument : holds_without(balance.signal))) {
          location.submodel = *freedom.or_instrument;
          if (freedom.correction && !balance.reads.empty()) location.signal = balance.reads.front();
        }
        report(std::move(location), freedom.variable, one.words, balance);
      }
      return;
    }
    // Of two instruments that part without an order nobody can say which it is.
    if (balance.otherwise == balance.instrument) return;
    const bool is_alone =
        std::all_of(balance.freedoms.begin(), balance.freedoms.end(),
                    [&](const plant::Freedom& one) { return one.submodel == balance.otherwise; });
    if (judgement.before < where_limits.large && !is_alone) return;
    // The submodel of which a freedom has a variable that nothing else is told of.
    const Observed observed = observe(balance, true);
    const plant::OrderingVariable* axis = strongest_axis(observed).axis;
    Location location{balance.signal, balance.otherwise, std::max(0.0, judgement.explained), {}, {}};
    for (const plant::Freedom& one : balance.freedoms)
      if (axis != nullptr && one.variable == axis->name && one.submodel != balance.instrument)
        location.submodel = one.submodel;
    report(std::move(location), "", "no freedom in one submodel helps much; the best", balance);
  }

  void report(Location location, const std::string& variable, const std::string& words,
              const plant::Balance& balance) {
    const Observed observed = observe(balance, location.submodel != balance.instrument);
    const Ordered ordered = strongest_axis(observed);
    const plant::OrderingVariable* named = observed.find(variable);
    const plant::OrderingVariable* axis = named != nullptr ? named : ordered.axis;
    char text[80];
    std::snprintf(text, sizeof text,
                  " explains %.0f %% of the excess on stretches that the fit has not seen.",
                  100.0 * location.share);
    location.evidence = balance.given + ", " + words + text;
    if (ordered.ratio > ordered.chance) {
      std::snprintf(text, sizeof text, " most (correlation ratio %.2f, by chance up to %.2f).", ordered.ratio,
                    ordered.chance);
      location.evidence += " The " + to_string(observed.quantity) + " follows " +
                           plant::the_variable(ordered.axis->name) + text;
    }
    if (axis != nullptr) {
      location.regime = regime_of(observed, *axis);
      MissingQuantity picture = picture_of(observed, *axis);
      picture.signal = location.signal;
      const bool is_drawn =
          std::any_of(out_.quantities.begin(), out_.quantities.end(), [&](const MissingQuantity& one) {
            return one.signal == picture.signal && one.variable == picture.variable;
          });
      if (picture.x.size() > 1 && !is_drawn &&
          (location.share >= where_limits.picture || out_.quantities.empty()))
        out_.quantities.push_back(std::move(picture));
    }
    add(std::move(location));
  }

  /// One row per signal and submodel: a second fault of the same is added to the first.
  void add(Location location) {
    for (Location& one : out_.where) {
      if (one.signal != location.signal || one.submodel != location.submodel) continue;
      if (location.share > one.share) std::swap(one.regime, location.regime);
      one.evidence += " " + location.evidence;
      one.share = std::min(1.0, one.share + location.share);
      return;
    }
    out_.where.push_back(std::move(location));
  }

  const std::vector<plant::BalanceSource>& sources_;
  plant::ReadingOffsets offsets_;  // that the readings are corrected by
  std::vector<Group> groups_;
  Localisation out_;
};

}  // namespace detail

/// Finds where a plant and recordings part, from residuals alone: it knows no effect and no equation.
///
/// Each balance is judged on its measured inputs, so that a fault upstream is not blamed on a part downstream. A submodel
/// is accused if freedom in its equation, without any formula, predicts stretches of the recording that the fit has not
/// seen. The constants may move within their slack. Where no freedom helps, the fault is still placed, in the balance as a
/// whole.
///
/// - An instrument is at fault instead of a part of the plant if the freedom says that it may be (Freedom::or_instrument).
///   The other balances must hold better without its reading or with it corrected.
/// - Of several balances of one quantity (heat by the law, by the measured current) the best one counts. One that reads an
///   instrument without a gap of its own is not asked.
///
/// @param sources of one recording, those that place a fault best first
inline Localisation localise_balances(const std::vector<plant::BalanceSource>& sources) {
  return detail::Localiser(sources).run();
}

/// Fills MissingQuantity::effect. It is the lack of the baseline's balances in recordings that an augmented model
/// simulated. It is a smooth curve over the range of the measured ones.
/// @param sources the baseline's balances of the simulated recordings
inline void draw_supplied(const std::vector<plant::BalanceSource>& sources,
                          std::vector<MissingQuantity>& quantities) {
  for (MissingQuantity& q : quantities) {
    // Of alternatives one that reads a simulated signal is taken: it holds by itself.
    bool is_by_itself = true;
    for (const plant::BalanceSource& source : sources) {
      const bool shows = source.signal == q.signal ||
                         std::find(source.reads.begin(), source.reads.end(), q.signal) != source.reads.end();
      if (!shows || (q.effect.size() > 0 && (!is_by_itself || source.reads.empty()))) continue;
      const plant::Balance balance = source.make({});
      const bool is_restated = balance.restated && balance.restated->quantity == q.quantity;
      if (!is_restated && balance.quantity != q.quantity) continue;
      set_effect(q, observe(balance, is_restated));
      is_by_itself = source.reads.empty();
    }
  }
}

}  // namespace thermopower::gap::engine
