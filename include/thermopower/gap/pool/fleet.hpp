// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/pool/causes.hpp>
#include <thermopower/gap/pool/drift.hpp>
#include <thermopower/gap/pool/log_result.hpp>
#include <thermopower/gap/pool/odd_units.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace thermopower::gap::pool {

/// Why a unit is odd.
enum class Oddity {
  none,       ///< it is not
  parameter,  ///< a constant or a parameter is far from the others'
  misfit,     ///< what explains the others does not explain it
};

/// The oddity's name, as reports spell it.
inline const char* to_string(Oddity oddity) {
  return oddity == Oddity::parameter ? "parameter" : oddity == Oddity::misfit ? "misfit" : "none";
}

/// A drift of one coordinate of a unit.
struct UnitDrift {
  std::string coordinate;  ///< its name
  Drift drift;             ///< how it went
  TimeSeries series;       ///< the values of the unit's logs
};

/// One unit after the fleet was looked at.
struct UnitVerdict {
  std::string unit;               ///< its name
  std::vector<std::size_t> logs;  ///< indices of its logs that could be used
  int family = -1;                ///< index of the family it is compared with; -1: none
  bool member = false;            ///< its own diagnoses name that family's cause
  std::string own_cause;         ///< the likeliest explanation of its own logs, the fleet's shares considered
  double own_probability = 0.0;  ///< of that
  Oddity oddity = Oddity::none;  ///< why it is odd
  Standing standing;             ///< among the family, by its parameters
  double misfit = 1.0;           ///< RMSE with the family's cause over the family's usual one
  std::optional<Estimate> estimate;  ///< in the family's coordinates, of all its logs
  std::optional<Estimate> shrunken;  ///< the same drawn to the family
  std::vector<UnitDrift> drifts;     ///< those that stand
};

/// Units that share a cause.
struct Family {
  std::string cause;                     ///< ids with " + " between; empty: nothing is missing
  Prevalence prevalence;                 ///< how common it is
  std::vector<std::string> coordinates;  ///< that its units are compared in
  std::vector<bool> logarithmic;         ///< of each
  MixedEffects spread;        ///< of the units that are not odd; of size 0 where too few could be compared
  std::vector<bool> differs;  ///< by coordinate: the units differ in it beyond their errors
  std::vector<LogScatter> scatter;  ///< by coordinate: between the logs of one unit
};

/// A log that says nothing, and why.
struct BadLog {
  std::size_t log = 0;  ///< its index
  std::string reason;   ///< its fault
};

/// Everything that many logs say together.
struct FleetVerdict {
  std::vector<Family> families;    ///< the commonest first
  std::vector<UnitVerdict> units;  ///< in the order in which they first appear
  std::vector<BadLog> bad_logs;    ///< in the order of the logs
  std::vector<Prevalence> causes;  ///< every explanation that some unit finds likely
  std::vector<WeakEffect> weak;    ///< in units whose own diagnosis finds nothing; those that stand first
  CommonShift
      weak_shift;  ///< that the leading one of those adds to constants; in all units' estimates already
  bool structure_differs = false;  ///< there are several families
  bool parameters_differ = false;  ///< in some family the units differ in some coordinate
};

namespace detail {

/// One fleet under judgement.
class FleetJudge {
public:
  explicit FleetJudge(const std::vector<LogResult>& logs) : logs_(logs) {}

  FleetVerdict run() {
    gather();
    find_families();
    for (std::size_t f = 0; f < result_.families.size(); ++f) judge(f);
    judge_drifts();
    find_weak_effects();
    take_weak_effect_out();
    result_.structure_differs = result_.families.size() > 1;
    for (const Family& one : result_.families)
      for (const bool differs : one.differs) result_.parameters_differ |= differs;
    return std::move(result_);
  }

private:
  static constexpr const char* outside = "outside the catalogue";
  static constexpr double false_odd = 0.01;    ///< probability that a fleet of sound units has an odd one
  static constexpr double false_drift = 0.01;  ///< probability that a fleet without drift has one
  static constexpr double misfit_matters =
      1.25;  ///< factor on the RMSE from which on a worse fit makes a unit odd

  void gather() {
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      const LogResult& log = logs_[i];
      if (!log.verdict || *log.verdict == Verdict::insufficient) {
        result_.bad_logs.push_back({i, log.reason});
        continue;
      }
      const std::string& name = log.unit.empty() ? log.log : log.unit;
      const auto [place, is_new] = known.emplace(name, result_.units.size());
      if (is_new) result_.units.emplace_back().unit = name;
      result_.units[place->second].logs.push_back(i);
    }
    // A log that nobody dated comes last.
    const auto moment = [&](std::size_t log) {
      return std::isnan(logs_[log].time) ? std::numeric_limits<double>::infinity() : logs_[log].time;
    };
    for (UnitVerdict& unit : result_.units)
      std::stable_sort(unit.logs.begin(), unit.logs.end(),
                       [&](std::size_t a, std::size_t b) { return moment(a) < moment(b); });
  }

  static void normalise(Probabilities& all) {
    double total = 0.0;
    for (const auto& [name, probability] : all) total += probability;
    for (auto& [name, probability] : all) probability /= total;
  }

  /// The likely explanations of one log.
  static Probabilities likely(const LogResult& log) {
    if (log.verdict == Verdict::no_gap) return {{"", 1.0}};
    Probabilities result;
    // An explanation with more effects than the named cause counts as doing no more than it.
    for (const FittedExplanation& one : log.ranking)
      if (one.effects <= log.chosen_effects && one.probability > 0.0)
        result[structure_of(one.name)] += one.probability;
    if (log.verdict == Verdict::unexplained || result.empty()) return {{outside, 1.0}};
    normalise(result);
    return result;
  }

  /// The same of all logs of a unit together.
  Probabilities likely(const UnitVerdict& unit) const {
    std::vector<Probabilities> each;
    Probabilities all;
    for (const std::size_t log : unit.logs) {
      each.push_back(likely(logs_[log]));
      for (const auto& [name, probability] : each.back()) all[name] = 0.0;
    }
    double largest = -std::numeric_limits<double>::infinity();
    for (auto& [name, value] : all) {
      for (Probabilities& one : each) value += std::log(std::max(one[name], impossible));
      largest = std::max(largest, value);
    }
    for (auto& [name, value] : all) value = std::exp(value - largest);
    normalise(all);
    return all;
  }

  void find_families() {
    constexpr double family_share = 0.05, family_units = 4.0;  // from which on a cause is a family's
    constexpr double half_a_unit = 0.5, sure = 0.5;
    std::vector<Probabilities> units;
    for (const UnitVerdict& one : result_.units) units.push_back(likely(one));
    const CommonCauses found = common_causes(units);
    const double least = std::max(family_units, family_share * static_cast<double>(units.size()));
    for (const Prevalence& one : found.common) {
      if (one.units >= half_a_unit) result_.causes.push_back(one);
      if (one.explanation == outside || !(one.units >= least - half_a_unit)) continue;
      Family& family = result_.families.emplace_back();
      family.cause = one.explanation;
      family.prevalence = one;
    }
    for (std::size_t i = 0; i < result_.units.size(); ++i) {
      UnitVerdict& unit = result_.units[i];
      std::tie(unit.own_cause, unit.own_probability) =
          *std::max_element(found.units[i].begin(), found.units[i].end(),
                            [](const auto& one, const auto& other) { return one.second < other.second; });
      for (std::size_t f = 0; f < result_.families.size(); ++f)
        if (found.units[i].at(result_.families[f].cause) > sure) unit.family = static_cast<int>(f);
      unit.member = unit.family >= 0;
      if (!unit.member) unit.family = nearest_family(unit);
    }
  }

  /// The family whose cause does most for a unit that has another one of its own.
  int nearest_family(const UnitVerdict& unit) const {
    int best = -1;
    double most = 0.0;
    for (std::size_t f = 0; f < result_.families.size(); ++f) {
      double gain = 0.0;
      for (const std::size_t log : unit.logs) {
        const FittedExplanation* one = logs_[log].likeliest(result_.families[f].cause);
        gain += one == nullptr ? std::nan("")
                               : one->train_gain + one->held_out_gain - 2.0 * one->own_parameters();
      }
      if (std::isfinite(gain) && (best < 0 || gain > most)) {
        best = static_cast<int>(f);
        most = gain;
      }
    }
    return best;
  }

  /// The units that are compared with a family.
  std::vector<UnitVerdict*> held_against(std::size_t family) {
    std::vector<UnitVerdict*> units;
    for (UnitVerdict& one : result_.units)
      if (one.family == static_cast<int>(family)) units.push_back(&one);
    return units;
  }

  /// Coordinates that are free in most members' fits. One on a bound, or fixed, tells nothing.
  void choose_coordinates(Family& family, const std::vector<UnitVerdict*>& units) const {
    constexpr double mostly = 0.8;
    struct Seen {
      std::string name;
      bool is_logarithmic;
      double free, all;
    };
    std::vector<Seen> seen;
    for (const UnitVerdict* unit : units)
      for (const std::size_t log : unit->logs) {
        const FittedExplanation* one = logs_[log].likeliest(family.cause);
        if (!unit->member || one == nullptr || !one->is_usable()) continue;
        for (std::size_t c = 0; c < one->names.size(); ++c) {
          auto place = std::find_if(seen.begin(), seen.end(),
                                    [&](const Seen& each) { return each.name == one->names[c]; });
          if (place == seen.end()) place = seen.insert(place, {one->names[c], one->logarithmic[c], 0.0, 0.0});
          const auto at = static_cast<Eigen::Index>(c);
          place->free += !one->at_bound[c] && one->fit.covariance(at, at) > 0.0 ? 1.0 : 0.0;
          place->all += 1.0;
        }
      }
    for (const Seen& one : seen)
      if (one.free >= mostly * one.all) {
        family.coordinates.push_back(one.name);
        family.logarithmic.push_back(one.is_logarithmic);
      }
  }

  /// A log's estimate in a family's coordinates; none where it lacks one.
  std::optional<Estimate> estimate_of(const Family& family, std::size_t log) const {
    const FittedExplanation* one = logs_[log].likeliest(family.cause);
    if (one == nullptr || family.coordinates.empty()) return std::nullopt;
    return one->estimate_of(family.coordinates);
  }

  TimeSeries series_of(const UnitVerdict& unit, const Family& family, Eigen::Index coordinate) const {
    TimeSeries series;
    for (const std::size_t log : unit.logs)
      if (const std::optional<Estimate> one = estimate_of(family, log)) {
        series.time.push_back(logs_[log].time);
        series.at.push_back(one->at[coordinate]);
        series.variance.push_back(one->covariance(coordinate, coordinate));
      }
    return series;
  }

  /// All logs of a unit in one estimate: weighted by their errors and the scatter between logs. Where this unit's logs
  /// differ by more than that, a coordinate's error is widened by as much (Birge's ratio).
  std::optional<Estimate> together(const UnitVerdict& unit, const Family& family) const {
    const auto k = static_cast<Eigen::Index>(family.coordinates.size());
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(k);
    std::vector<Estimate> used;
    for (const std::size_t log : unit.logs)
      if (std::optional<Estimate> one = estimate_of(family, log)) {
        for (Eigen::Index c = 0; c < k; ++c)
          one->covariance(c, c) += family.scatter[static_cast<std::size_t>(c)].variance;
        const Eigen::MatrixXd weight = inverse_of(one->covariance);
        if (!weight.allFinite()) continue;
        sum += weight;
        right += weight * one->at;
        used.push_back(std::move(*one));
      }
    if (used.empty()) return std::nullopt;
    Estimate result;
    result.covariance = inverse_of(sum);
    result.at = result.covariance * right;
    if (!result.at.allFinite() || !result.covariance.allFinite()) return std::nullopt;
    Eigen::ArrayXd ratio = Eigen::ArrayXd::Zero(k);
    for (const Estimate& one : used)
      ratio += (one.at - result.at).array().square() / one.covariance.diagonal().array();
    if (used.size() > 1) {
      const Eigen::VectorXd widened = (ratio / static_cast<double>(used.size() - 1)).max(1.0).sqrt();
      result.covariance = (widened.asDiagonal() * result.covariance * widened.asDiagonal()).eval();
    }
    return result;
  }

  /// Mean logarithm of the RMSE that a cause leaves of a unit's logs; none where nobody fitted it.
  std::optional<double> misfit_of(const UnitVerdict& unit, const std::string& cause) const {
    double sum = 0.0, count = 0.0;
    for (const std::size_t log : unit.logs)
      if (const FittedExplanation* one = logs_[log].likeliest(cause); one != nullptr && one->misfit > 0.0) {
        sum += 0.5 * std::log(one->misfit);
        count += 1.0;
      }
    if (count == 0.0) return std::nullopt;
    return sum / count;
  }

  void judge(std::size_t f) {
    constexpr double alike_differ =
        0.01;  // probability that alike units' parameter passes for one that differs
    Family& family = result_.families[f];
    const std::vector<UnitVerdict*> units = held_against(f);
    choose_coordinates(family, units);
    const auto k = static_cast<Eigen::Index>(family.coordinates.size());
    for (Eigen::Index c = 0; c < k; ++c) {
      std::vector<TimeSeries> all;
      for (const UnitVerdict* unit : units) all.push_back(series_of(*unit, family, c));
      family.scatter.push_back(log_scatter(all));
    }
    // Both ways of being odd share what a false one may cost, and so do the families.
    const double level = 0.5 * false_odd * static_cast<double>(units.size()) /
                         static_cast<double>(std::max<std::size_t>(result_.units.size(), 1));
    std::vector<Estimate> estimates, misfits;
    std::vector<UnitVerdict*> compared, fitted;
    std::vector<double> usual;
    for (UnitVerdict* unit : units) {
      unit->estimate = together(*unit, family);
      if (unit->estimate) {
        estimates.push_back(*unit->estimate);
        compared.push_back(unit);
      }
      if (const std::optional<double> misfit = misfit_of(*unit, family.cause)) {
        usual.push_back(*misfit);
        misfits.push_back({Eigen::VectorXd::Constant(1, *misfit), Eigen::MatrixXd::Zero(1, 1)});
        fitted.push_back(unit);
      }
    }
    const OddUnits by_misfit = find_odd_units(misfits, level);
    const double middle = median(usual);
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      fitted[i]->misfit = std::exp(usual[i] - middle);
      if (by_misfit.units[i].odd && fitted[i]->misfit > misfit_matters) fitted[i]->oddity = Oddity::misfit;
    }
    if (k == 0) return;
    const OddUnits by_parameter = find_odd_units(estimates, level);
    family.spread = by_parameter.sound;
    for (std::size_t i = 0; i < compared.size(); ++i) {
      compared[i]->standing = by_parameter.units[i];
      if (family.spread.size() > 0) compared[i]->shrunken = shrink(family.spread, estimates[i]);
      if (by_parameter.units[i].odd) compared[i]->oddity = Oddity::parameter;
    }
    for (Eigen::Index c = 0; c < k; ++c)
      family.differs.push_back(family.spread.size() > 0 &&
                               family.spread.heterogeneity_p[c] < alike_differ / static_cast<double>(k));
  }

  void judge_drifts() {
    std::vector<double> p;
    std::vector<std::pair<UnitVerdict*, UnitDrift>> found;
    for (UnitVerdict& unit : result_.units) {
      if (unit.family < 0) continue;
      const Family& family = result_.families[static_cast<std::size_t>(unit.family)];
      for (std::size_t c = 0; c < family.coordinates.size(); ++c) {
        const TimeSeries series = series_of(unit, family, static_cast<Eigen::Index>(c));
        // Undated logs come last.
        if (series.time.empty() || !std::isfinite(series.time.back()) ||
            !(series.time.back() > series.time.front()))
          continue;
        found.push_back({&unit, {family.coordinates[c], find_drift(series, family.scatter[c]), series}});
        p.push_back(found.back().second.drift.p);
      }
    }
    const std::vector<bool> stands = holm(p, false_drift);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (stands[i]) found[i].first->drifts.push_back(found[i].second);
  }

  /// Whether weak effects may be looked for in a unit. A cause that the others lack is not a weak effect, and a fit with a
  /// wrong constant held fixed shows that constant.
  bool lacks_nothing(const UnitVerdict& unit) const {
    return unit.member && result_.families[static_cast<std::size_t>(unit.family)].cause.empty() &&
           unit.oddity == Oddity::none && unit.drifts.empty() &&
           std::all_of(unit.logs.begin(), unit.logs.end(), [&](std::size_t log) {
             const FittedExplanation* one = logs_[log].likeliest("");
             return one != nullptr && one->name.empty();
           });
  }

  /// The shift of the units' constants if all have an effect.
  CommonShift shift_of(const std::string& effect) const {
    const auto fits = [](const FittedExplanation* one) {
      return one != nullptr && one->is_usable() && !one->on_bounds;
    };
    std::vector<std::vector<FittedBothWays>> units;
    for (const UnitVerdict& unit : result_.units) {
      if (!lacks_nothing(unit)) continue;
      std::vector<FittedBothWays> logs;
      for (const std::size_t log : unit.logs) logs.push_back({logs_[log].find(""), logs_[log].find(effect)});
      if (std::all_of(logs.begin(), logs.end(),
                      [&](const FittedBothWays& log) { return fits(log.without) && fits(log.with); }))
        units.push_back(std::move(logs));
    }
    return common_shift(units);
  }

  /// Moves all constants by the shift of a weak effect that stands. The effect is in no unit's model, and would shift all
  /// of them alike, by more than a unit's own error. Who is odd does not hang on that.
  void take_weak_effect_out() {
    if (result_.weak.empty() || !result_.weak.front().stands) return;
    std::vector<CommonShift> others;
    for (const std::string& one : result_.weak.front().not_told_from) others.push_back(shift_of(one));
    result_.weak_shift = either(shift_of(result_.weak.front().explanation), others);
    for (std::size_t f = 0; f < result_.families.size(); ++f) {
      Family& family = result_.families[f];
      for (std::size_t k = 0; k < family.coordinates.size(); ++k) {
        const auto found = result_.weak_shift.find(family.coordinates[k]);
        if (found == result_.weak_shift.end()) continue;
        const auto c = static_cast<Eigen::Index>(k);
        const Shift& shift = found->second;
        for (UnitVerdict* unit : held_against(f))
          for (std::optional<Estimate>* one : {&unit->estimate, &unit->shrunken})
            if (*one) {
              (*one)->at[c] += shift.by;
              (*one)->covariance(c, c) += shift.variance;
            }
        if (family.spread.size() == 0) continue;
        family.spread.mean[c] += shift.by;
        family.spread.mean_covariance(c, c) += shift.error;
      }
    }
  }

  void find_weak_effects() {
    std::vector<std::map<std::string, Gain>> units;
    for (const UnitVerdict& unit : result_.units) {
      if (!lacks_nothing(unit)) continue;
      std::map<std::string, Gain> gains;
      std::map<std::string, std::size_t> seen;
      for (const std::size_t log : unit.logs)
        for (const FittedExplanation& one : logs_[log].ranking) {
          // If a hidden start was fitted to the held-out data, their gain is not a test.
          if (one.effects != 1 || one.hidden_starts > 0 || !std::isfinite(one.held_out_gain)) continue;
          Gain& gain = gains[one.name];
          ++seen[one.name];
          gain.parameters += one.own_parameters();
          gain.train += one.train_gain;
          gain.held_out += one.held_out_gain;
        }
      for (const auto& [name, count] : seen)
        if (count < unit.logs.size()) gains.erase(name);
      units.push_back(std::move(gains));
    }
    result_.weak = weak_effects(units);
  }

  const std::vector<LogResult>& logs_;
  FleetVerdict result_;
};

}  // namespace detail

/// The joint statements of many logs: common cause, spread of parameters, odd units, bad logs, drifts, and effects too weak
/// for any single log.
inline FleetVerdict judge_fleet(const std::vector<LogResult>& logs) { return detail::FleetJudge(logs).run(); }

}  // namespace thermopower::gap::pool
