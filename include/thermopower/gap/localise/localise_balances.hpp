// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/sort_by.hpp>
#include <thermopower/gap/localise/judgement.hpp>
#include <thermopower/gap/localise/missing_quantity.hpp>
#include <thermopower/plant/balance.hpp>
#include <thermopower/plant/variable_words.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file
/// Where a plant and its recordings part, from the plant's balances alone.

namespace thermopower::gap::engine {

/// Options of a localisation.
struct LocalisationOptions {
  /// How far the baseline's constants may be off without that being a gap, as a fraction.
  double slack = 0.04;
  LocalisationThresholds thresholds = {};  ///< of the stage
};

/// Where simulation and recordings part, and the missing quantity itself.
struct Localisation {
  std::vector<Location> where;              ///< the largest first; empty where no submodel is at fault
  std::vector<MissingQuantity> quantities;  ///< one per faulty submodel (`effect` still empty)
};

/// Finds where a plant and recordings part, from residuals alone: it knows no effect and no equation.
///
/// Each balance is judged on its measured inputs, so that a fault upstream is not blamed on a part downstream. A submodel
/// is accused if freedom in its equation, without any formula, predicts stretches of the recording that the fit has not
/// seen. The constants may move within their slack. Where no freedom helps, the fault is still placed, by what orders it
/// best.
///
/// - An instrument is at fault instead of a part of the plant if the freedom says that it may be (Freedom::or_instrument).
///   The other balances must hold better without its reading or with it corrected.
/// - Of several balances of one quantity (heat by the law, by the measured current) the best one counts. One that reads an
///   instrument without a gap of its own is not asked.
/// - What seems to depend on the reading of an instrument that is itself at fault is not blamed.
///
/// @param sources of one recording, those that place a fault best first
/// @param signals number of signals of the plant, for the corrections of their readings
Localisation localise_balances(const std::vector<plant::BalanceSource>& sources, int signals,
                               const LocalisationOptions& options = {});

namespace detail {

inline std::string percent_text(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.0f %%", 100.0 * share);
  return text;
}

inline std::string evidence_text(const std::string& given, const std::string& words, double share,
                                 const Observed& o) {
  const Ordered ordered = strongest_axis(o);
  std::string text = given + ", " + words + " explains " + percent_text(share) +
                     " of the excess on stretches that the fit has not seen.";
  char more[80];
  if (ordered.ratio > ordered.chance) {
    std::snprintf(more, sizeof more, " most (correlation ratio %.2f, by chance up to %.2f).", ordered.ratio,
                  ordered.chance);
    text += " The " + to_string(o.quantity) + " follows " + plant::the_variable(ordered.axis) + more;
  }
  const double period = half_power_period(o.value, o.interval_s);
  if (period > 0.0 && period < o.longest_run_s) {
    std::snprintf(more, sizeof more, " Half of its power lies at periods above %.3g s.", period);
    text += more;
  }
  return text;
}

/// A localisation under way.
class Localiser {
public:
  Localiser(const std::vector<plant::BalanceSource>& sources, int signals, const LocalisationOptions& options)
      : sources_(sources), options_(options), limit_(options.thresholds), offsets_(signals, 0.0) {}

  Localisation run() {
    judge_lone();
    settle_instruments();
    judge_alternatives();
    for (const Group& group : groups_)
      if (group.judgement) place(group);
    sort_by(out_.where, [](const Location& one) { return -one.share; });
    return std::move(out_);
  }

private:
  /// The balances of one quantity.
  struct Group {
    std::vector<std::size_t> sources;    ///< indices
    std::optional<Judgement> judgement;  ///< of the one that counts
    std::size_t counts = 0;              ///< its index among all sources
    plant::ReadingOffsets offsets;       ///< by which its readings were corrected
    bool instrument = false;             ///< the first freedom's instrument is at fault, not the plant
  };

  static void settle(Group& group, std::size_t source, const plant::ReadingOffsets& offsets,
                     Judgement judgement) {
    group.judgement.emplace(std::move(judgement));
    group.counts = source;
    group.offsets = offsets;
  }

  Judgement judged(std::size_t source, const plant::ReadingOffsets& offsets) const {
    return Judgement(sources_[source].make(offsets), options_.slack, limit_);
  }

  /// Balances that have no alternative, with the readings as they are.
  void judge_lone() {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      Group* group = nullptr;
      for (Group& one : groups_)
        if (sources_[one.sources.front()].quantity == sources_[i].quantity) group = &one;
      if (group == nullptr) group = &groups_.emplace_back();
      group->sources.push_back(i);
    }
    for (Group& group : groups_)
      if (group.sources.size() == 1)
        settle(group, group.sources.front(), offsets_, judged(group.sources.front(), offsets_));
  }

  static bool accuses(const Judgement& judgement, double explained) {
    return judgement.gap() && !judgement.chosen().empty() && judgement.explained() > explained;
  }

  /// Corrections of readings: surely where a freedom is the instrument's own, on trial where it may be.
  void settle_instruments() {
    for (Group& group : groups_) {
      if (!group.judgement || !accuses(*group.judgement, limit_.instrument_explained)) continue;
      const Judgement& judgement = *group.judgement;
      for (std::size_t k = 0; k < judgement.chosen().size(); ++k) {
        const plant::Freedom& freedom = judgement.freedom(k);
        if (!freedom.correction) continue;
        plant::ReadingOffsets corrected = offsets_;
        corrected[freedom.correction->signal] += freedom.correction->offset * judgement.coefficient(k);
        if (!freedom.or_instrument) {
          offsets_ = corrected;
        } else if (k == 0 && better(group, corrected)) {
          group.instrument = true;
          offsets_ = corrected;
        }
      }
    }
  }

  /// Whether the other lone balances leave less with corrected readings; they are kept so where they do.
  bool better(const Group& corrected_by, const plant::ReadingOffsets& corrected) {
    double before = 0.0, after = 0.0;
    std::vector<std::pair<Group*, Judgement>> again;
    for (Group& group : groups_) {
      if (&group == &corrected_by || !group.judgement) continue;
      Judgement judgement = judged(group.sources.front(), corrected);
      before += group.judgement->left();
      after += judgement.left();
      again.emplace_back(&group, std::move(judgement));
    }
    if (!(after < limit_.better_corrected * before)) return false;
    for (auto& [group, judgement] : again)
      settle(*group, group->sources.front(), corrected, std::move(judgement));
    return true;
  }

  bool has_gap(const plant::SignalName& signal) const {
    for (const Group& group : groups_)
      if (group.judgement && group.judgement->balance().signal == signal && group.judgement->gap())
        return true;
    return false;
  }

  void judge_alternatives() {
    for (Group& group : groups_) {
      if (group.sources.size() == 1) continue;
      for (const std::size_t source : group.sources) {
        const std::vector<plant::SignalName>& reads = sources_[source].reads;
        // Where law and measurement agree there is one flow, and the law's carries no noise.
        const bool asked = std::any_of(reads.begin(), reads.end(),
                                       [&](const plant::SignalName& one) { return has_gap(one); });
        if (group.judgement && !asked) continue;
        Judgement judgement = judged(source, offsets_);
        if (group.judgement && !(judgement.cost() < group.judgement->cost())) continue;
        settle(group, source, offsets_, std::move(judgement));
      }
    }
    for (Group& group : groups_) {
      if (!group.judgement || group.judgement->chosen().empty()) continue;
      const plant::Freedom& freedom = group.judgement->freedom(0);
      if (freedom.or_instrument && !freedom.correction)
        group.instrument = holds_without(group.judgement->balance().signal);
    }
  }

  /// Whether the balances that could do with or without a signal's reading hold better without.
  bool holds_without(const plant::SignalName& signal) const {
    for (const Group& group : groups_) {
      if (group.sources.size() == 1 || !group.judgement) continue;
      const auto& reads = sources_[group.counts].reads;
      if (std::find(reads.begin(), reads.end(), signal) == reads.end()) return true;
    }
    return false;
  }

  /// Signals whose instrument is at fault.
  bool distrusted(const plant::SignalName& signal) const {
    for (const Group& group : groups_)
      if (group.judgement && group.judgement->balance().signal == signal &&
          accuses(*group.judgement, limit_.instrument_explained) &&
          group.judgement->freedom(0).submodel == group.judgement->balance().instrument)
        return true;
    return false;
  }

  /// Whether the variable is the reading of another balance's instrument that is at fault.
  bool misled(const plant::Balance& balance, const std::string& variable) const {
    for (const plant::OrderingVariable& one : balance.variables)
      if (one.name == variable && one.from != balance.signal && distrusted(one.from)) return true;
    return false;
  }

  void place(const Group& group) {
    const Judgement& judgement = *group.judgement;
    if (!judgement.gap()) return;
    const plant::Balance balance = sources_[group.counts].make(group.offsets);
    if (const plant::Freedom* course = judgement.course()) {
      const Observed observed = observe(balance, true, limit_);
      const plant::Freedom& one = scattering(balance, *course, observed);
      report(one, balance.signal, one.submodel, judgement.course_share(), one.words, balance, observed,
             judgement.before(), one.variable.empty() || one.is_nobodys);
      return;
    }
    const bool named = !judgement.chosen().empty() && judgement.explained() > limit_.explained;
    bool excused = false;
    for (std::size_t k = 0; named && k < judgement.chosen().size(); ++k) {
      const plant::Freedom& freedom = judgement.freedom(k);
      if (misled(balance, freedom.variable)) {
        excused = true;
        continue;
      }
      const bool instrument = k == 0 && group.instrument && freedom.or_instrument;
      const plant::SubmodelName submodel = instrument ? *freedom.or_instrument : freedom.submodel;
      const bool own = submodel == balance.instrument;
      plant::SignalName signal = balance.signal;
      if (instrument && freedom.correction) signal = signal_of(freedom.correction->signal, balance);
      report(freedom, signal, submodel, judgement.worth(k), judgement.words(k), balance,
             observe(balance, !own, limit_), judgement.before());
    }
    // Of two instruments that part without an order nobody can say which it is.
    if (named || excused || judgement.before() < limit_.large || balance.otherwise == balance.instrument)
      return;
    const Observed observed = observe(balance, true, limit_);
    const std::string axis = strongest_axis(observed).axis;
    plant::Freedom none;
    none.variable = axis;
    report(none, balance.signal, submodel_of(balance, axis), std::max(0.0, judgement.explained()),
           "no freedom in one submodel helps much; the best", balance, observed, judgement.before());
  }

  /// The name of a signal whose reading was corrected: one that the balance reads.
  static plant::SignalName signal_of(plant::Signal signal, const plant::Balance& balance) {
    return balance.reads.empty() ? plant::SignalName(signal) : balance.reads.front();
  }

  /// Of courses that follow no variable, the one whose scatter the missing quantity has.
  static const plant::Freedom& scattering(const plant::Balance& balance, const plant::Freedom& course,
                                          const Observed& observed) {
    if (!course.variable.empty()) return course;
    const plant::Freedom *with = nullptr, *without = nullptr;
    std::string held;
    for (const plant::OrderingVariable& one : balance.variables)
      if (one.kind == plant::OrderingVariable::Kind::held && held.empty()) held = one.name;
    for (const plant::Freedom& one : balance.courses) {
      if (!one.scatters_with.empty()) with = &one;
      else if (one.variable.empty()) without = &one;
    }
    if (with == nullptr || without == nullptr) return course;
    return scatters_with(observed, with->scatters_with, held) ? *with : *without;
  }

  /// The submodel that most freedoms along a variable accuse.
  static plant::SubmodelName submodel_of(const plant::Balance& balance, const std::string& variable) {
    std::vector<std::pair<plant::SubmodelName, int>> votes;
    for (const plant::Freedom& freedom : balance.freedoms) {
      if (freedom.variable != variable || freedom.submodel == balance.instrument) continue;
      const auto found = std::find_if(votes.begin(), votes.end(),
                                      [&](const auto& one) { return one.first == freedom.submodel; });
      if (found == votes.end()) votes.emplace_back(freedom.submodel, 1);
      else ++found->second;
    }
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == votes.end() ? balance.otherwise : most->first;
  }

  void report(const plant::Freedom& freedom, const plant::SignalName& signal,
              const plant::SubmodelName& submodel, double share, const std::string& words,
              const plant::Balance& balance, const Observed& observed, double times_noise,
              bool has_own_course = false) {
    Location location;
    location.times_noise = times_noise;
    location.has_own_course = has_own_course;
    location.signal = signal;
    location.submodel = submodel;
    location.share = std::clamp(share, 0.0, 1.0);
    const OrderingAxis* axis = observed.find(freedom.variable);
    if (axis == nullptr) axis = observed.find(strongest_axis(observed).axis);
    if (axis != nullptr) location.regime = regime_of(observed, *axis, limit_);
    location.evidence = evidence_text(balance.given, words, location.share, observed);
    add(std::move(location));
    if (axis == nullptr || (share < limit_.picture && !out_.quantities.empty())) return;
    MissingQuantity quantity = binned(observed, *axis, equal_count_edges(axis->values, limit_.picture_bins));
    quantity.signal = signal;
    for (const MissingQuantity& one : out_.quantities)
      if (one.signal == quantity.signal && one.variable == quantity.variable) return;
    if (quantity.x.size() > 1) out_.quantities.push_back(std::move(quantity));
  }

  /// One row per signal and submodel: a second fault of the same is added to the first.
  void add(Location location) {
    for (Location& one : out_.where) {
      if (one.signal != location.signal || one.submodel != location.submodel) continue;
      if (location.share > one.share) std::swap(one.regime, location.regime);
      one.evidence += " " + location.evidence;
      one.share = std::min(1.0, one.share + location.share);
      one.has_own_course = one.has_own_course || location.has_own_course;
      one.times_noise = std::max(one.times_noise, location.times_noise);
      return;
    }
    out_.where.push_back(std::move(location));
  }

  const std::vector<plant::BalanceSource>& sources_;
  LocalisationOptions options_;
  LocalisationThresholds limit_;
  plant::ReadingOffsets offsets_;
  std::vector<Group> groups_;
  Localisation out_;
};

}  // namespace detail

inline Localisation localise_balances(const std::vector<plant::BalanceSource>& sources, int signals,
                                      const LocalisationOptions& options) {
  return detail::Localiser(sources, signals, options).run();
}

/// Fills MissingQuantity::effect. It is the lack of the baseline's balances in recordings that an augmented model
/// simulated. It is a smooth curve over the range of the measured ones.
/// @param sources the baseline's balances of the simulated recordings
/// @param signals number of signals of the plant
inline void draw_supplied(const std::vector<plant::BalanceSource>& sources, int signals,
                          std::vector<MissingQuantity>& quantities,
                          const LocalisationThresholds& limit = {}) {
  for (MissingQuantity& q : quantities) {
    if (q.x.size() < 2) continue;
    // Of alternatives one that reads a simulated signal is taken: it holds by itself.
    const plant::BalanceSource* chosen = nullptr;
    for (const plant::BalanceSource& source : sources)
      if (source.quantity == q.quantity &&
          (chosen == nullptr || (chosen->reads.empty() && !source.reads.empty())))
        chosen = &source;
    const auto made = [&](const plant::BalanceSource& source) {
      return source.make(plant::ReadingOffsets(signals, 0.0));
    };
    std::optional<plant::Balance> balance;
    const bool restated = chosen == nullptr;
    if (chosen != nullptr) balance = made(*chosen);
    for (std::size_t i = 0; restated && !balance && i < sources.size(); ++i) {
      plant::Balance one = made(sources[i]);
      if (one.restated && one.restated->quantity == q.quantity) balance = std::move(one);
    }
    if (!balance) continue;
    const Observed observed = observe(*balance, restated, limit);
    const OrderingAxis* axis = observed.find(q.variable);
    if (axis == nullptr) continue;
    set_effect(q, axis->values, observed.value);
  }
}

}  // namespace thermopower::gap::engine
