// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/judgeable.hpp>
#include <thermopower/gap/model.hpp>
#include <thermopower/gap/propose/effort_fit.hpp>
#include <thermopower/gap/propose/effort_residual.hpp>
#include <thermopower/gap/propose/effort_rows.hpp>
#include <thermopower/gap/propose/effort_starts.hpp>
#include <thermopower/gap/propose/inverse_score.hpp>
#include <thermopower/gap/propose/loop_kind.hpp>
#include <thermopower/gap/propose/plain_fit.hpp>
#include <thermopower/gap/propose/sampled_motion.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// @file effort_problem.hpp
/// The inverse problem of an axis: which effort does the measured motion need?
namespace thermopower::gap::engine {

/// The inverse problem of an axis, made once from a model and the prepared inputs of a diagnosis.
///
/// Effort is `drive_A`, `voltage_V`, or what a servo makes of its target. It is compared with what the plant needs for the measured
/// motion, both through one low-pass. Rows near rest are left out. Constants are refitted with every explanation.
///
/// How a decision asks it:
///
///     EffortProblem effort(model, catalogue, train_inputs, held_out_inputs);
///     effort.loop();                       // open or closed: which score leads
///     effort.proposals();                  // what to fit, best first, with starting values
///     effort.score({coulomb, constant});   // how well a set does
///
/// Scores are kept: asking twice costs nothing.
class EffortProblem {
public:
  /// Keeps references to model and catalogue: both must outlive this object. The inputs need not.
  /// @param model    has an axis, and is no plant of one's own
  /// @param without  ids of effects that are not proposed
  EffortProblem(const Model& model, const Catalogue& catalogue, const std::vector<Inputs>& train,
                const std::vector<Inputs>& held_out, const std::vector<std::string>& without = {})
      : model_(model), catalogue_(catalogue), without_(without), loop_(loop_of(model, train)) {
    assert(model.axis && !model.own);
    const SampledMotion sampled(model, catalogue, train);
    double cutoff = propose_thresholds.motion_cutoff;
    train_rows_.emplace(sampled, cutoff, propose_thresholds.most_train_rows);
    if (train_rows_->pieces.empty()) return;
    PlainFit plain(model, catalogue, *train_rows_);
    while (cutoff > propose_thresholds.least_cutoff) {
      const double next = cutoff * propose_thresholds.next_cutoff;
      EffortRows rows(sampled, next, propose_thresholds.most_train_rows);
      const PlainFit there(model, catalogue, rows);
      if (!plain.is_noisier_than(there)) break;
      cutoff = next;
      train_rows_ = std::move(rows);
      plain = there;
    }
    held_rows_.emplace(SampledMotion(model, catalogue, held_out), cutoff, propose_thresholds.most_held_rows);
    for (const plant::CatalogueEntry& entry : catalogue.entries())
      if (acts_on_effort(entry) && can_be_judged(entry, model, train) &&
          can_be_judged(entry, model, held_out))
        asked_.push_back(&entry);
    if (has_hidden_states()) return;
    const double rest_rad_per_s = rest_rate(*train_rows_);
    train_.emplace(model, catalogue, *train_rows_, rest_rad_per_s, plain.early_samples());
    held_.emplace(model, catalogue, *held_rows_, rest_rad_per_s, plain.early_samples());
    is_judged_ = train_->compared().effort_rms > 0.0 && held_->compared().effort_rms > 0.0 &&
                 train_->compared().size() >= propose_thresholds.least_residuals &&
                 held_->compared().size() >= propose_thresholds.residuals_in_block;
    if (!is_judged_) return;
    find_blocks();
    constants_ = constants_of(model, catalogue);
    bound_inertia(model, *train_, constants_);
    score({});  // all others are measured by this one
  }

  EffortProblem(const EffortProblem&) = delete;  // its parts refer to each other
  EffortProblem& operator=(const EffortProblem&) = delete;
  /// Whether effort and motion can be compared.
  bool is_judged() const { return is_judged_; }
  /// Who makes the effort.
  LoopKind loop() const { return loop_; }
  /// RMS of held-out effort that the best explanation asked so far leaves, A or V: its noise, or more.
  double effort_noise() const { return least_share_ * held_->compared().effort_rms; }
  /// The residual of training effort with a set of effects, A or V, at the compared rows; empty if it is not judged.
  Eigen::VectorXd train_residual(const EffectSet& effects) { return scored(effects).fit.residual; }
  /// The same of held-out effort.
  Eigen::VectorXd held_out_residual(const EffectSet& effects) {
    const Scored& one = scored(effects);
    if (one.score.refusal == InverseRefusal::not_told) return {};
    return held_->evaluate(one.fit.point, {}).effort;
  }
  /// The residual of held-out effort with the model as configured, A or V.
  Eigen::VectorXd held_out_residual_as_configured() const {
    return held_->evaluate(unmoved_point(model_), {}).effort;
  }
  /// How far constants and effects that were fitted to the motion are from the recorded effort. It is their residual of
  /// held-out effort, over that of refitted constants without effects. Where no motion tells an effect, it is left out of
  /// both, and any dry friction, constant and load may stand in its place.
  /// @param factors  of Model::calibrated(), as ParameterPoint has them
  /// @param effects  with their parameters
  double times_refitted(std::vector<double> factors, const std::vector<plant::AddedEffect<double>>& effects) {
    constexpr double small_share = 0.02;  // of the effort's RMS: less is nobody's loss
    EffortPoint point;
    point.factors = std::move(factors);
    for (const plant::AddedEffect<double>& one : effects) {
      if (makes_a_spring(*one.entry)) return 1.0;  // what the part behind it needs is not in the motion
      if (is_asked(*one.entry)) point.effects.push_back(one);
    }
    const bool unread = point.effects.size() < effects.size();
    const auto share = [&](const EffortPoint& at) {
      Eigen::VectorXd left = held_->evaluate(at, {}).effort;
      if (!left.allFinite()) return 1e9;
      if (unread) left = without_plain_torques(left);
      return share_of(left, *held_) + small_share;
    };
    return share(point) / share(scored({}).fit.point);
  }

  /// How well a set of effects does beside refitted constants.
  /// @param effects  of the catalogue given, each once, in any order; empty: nothing is missing
  const InverseScore& score(const EffectSet& effects) { return scored(effects).score; }

  /// The proposals of held-out effort: single effects, and sets by forward selection. Those that are told first, then by
  /// share. Curves come after everything that has a name: beside the set that was told, in place of its members that act where the curve
  /// does, and alone. They could bend to what named causes do, and must lower the effort materially below those.
  std::vector<InverseProposal> proposals() {
    std::vector<InverseProposal> list;
    if (!is_judged()) return list;
    InverseScore now = score({});
    for (const bool with_curves : {false, true})
      while (now.effects.size() < propose_thresholds.most_causes) {
        const std::vector<InverseProposal> tried = next_to(now, with_curves);
        list.insert(list.end(), tried.begin(), tried.end());
        if (tried.empty()) break;
        const InverseProposal& best = best_of(tried);
        if (!best.is_told) break;
        now = best.score;
      }
    told_ = now;
    std::stable_sort(list.begin(), list.end(), [](const InverseProposal& a, const InverseProposal& b) {
      return a.is_told != b.is_told ? a.is_told : a.score.weighed() < b.score.weighed();
    });
    return list;
  }

  /// The set that forward selection stops at: nothing where it tells none.
  const InverseScore& told() {
    if (!told_) proposals();
    return told_ ? *told_ : score({});
  }

  /// Whether the effort, which tells of other causes, has no use for this one: alone it does not lower held-out effort materially, nor
  /// beside what is told. Nothing is said of a cause that no effort tells.
  bool has_no_use_for(const plant::CatalogueEntry& cause) {
    const InverseScore& best = told();
    if (best.effects.empty() || has(best.effects, cause) || !is_asked(cause)) return false;
    const auto helps = [&](const InverseScore& without) {
      const InverseScore& with = score(and_one(without.effects, cause));
      return with.refusal == InverseRefusal::none ? is_material(without, with)
                                                  : with.refusal != InverseRefusal::not_itself;
    };
    return !helps(score({})) && !helps(best);
  }

private:
  /// A score with the fit that it comes from.
  struct Scored {
    InverseScore score;
    EffortFit fit;
    Eigen::VectorXd log_density;  ///< of each held-out block
  };

  static bool has(const EffectSet& set, const plant::CatalogueEntry& one) {
    return std::find(set.begin(), set.end(), &one) != set.end();
  }

  static EffectSet and_one(EffectSet set, const plant::CatalogueEntry& one) {
    set.push_back(&one);
    return set;
  }

  /// A set and each further effect, in the catalogue's order.
  std::vector<InverseProposal> next_to(const InverseScore& now, bool curves) {
    std::vector<InverseProposal> tried;
    const auto add = [&](const EffectSet& set) {
      const InverseScore& one = score(set);
      if (one.refusal == InverseRefusal::none) tried.push_back({one, is_material(now, one)});
    };
    for (const plant::CatalogueEntry* entry : asked_) {
      if (std::find(without_.begin(), without_.end(), entry->info.id) != without_.end()) continue;
      if (entry->info.curve.has_value() != curves || has(now.effects, *entry)) continue;
      EffectSet others;
      for (const plant::CatalogueEntry* one : now.effects)
        if (!curves || one->info.submodel != entry->info.submodel) others.push_back(one);
      const bool replaces = others.size() < now.effects.size();
      if (!replaces && !others.empty() && !promises(now.effects, *entry)) continue;
      add(and_one(others, *entry));
      if (curves && !others.empty()) add({entry});
    }
    return tried;
  }

  /// What lowers the effort most for its parameters. Of equals it is the one with the fewest parameters, then the first.
  static const InverseProposal& best_of(const std::vector<InverseProposal>& tried) {
    double least = std::numeric_limits<double>::infinity();
    for (const InverseProposal& one : tried) least = std::min(least, one.score.weighed());
    const auto place = [&](const InverseProposal& one) {
      return std::make_pair(!(one.score.weighed() <= least * (1.0 + propose_thresholds.tied)),
                            one.score.parameter_count());
    };
    return *std::min_element(tried.begin(), tried.end(),
                             [&](const auto& a, const auto& b) { return place(a) < place(b); });
  }

  /// The residual of held-out effort after dry friction, a constant and a load of the angle, of any size, are taken out.
  Eigen::VectorXd without_plain_torques(const Eigen::VectorXd& left) const {
    Eigen::MatrixXd columns(left.size(), 5);
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      const Eigen::Index row = held_->compared().rows[static_cast<std::size_t>(i)].row;
      const double angle = held_rows_->angle_rad[row];
      columns.row(i) << std::tanh(held_rows_->rate_rad_per_s[row] / held_->still_rad_per_s()), 1.0, angle,
          std::sin(angle), std::cos(angle);
    }
    return left - columns * columns.completeOrthogonalDecomposition().solve(left);
  }

  /// Whether the model's own effects remember what no motion tells.
  bool has_hidden_states() const {
    const plant::Instance<double> instance(model_, {}, {}, catalogue_);
    return instance.own_states > 0 || instance.axis_structure.compliant;
  }

  /// Whether an effect acts on the effort that a motion needs, and remembers nothing that the motion does not tell.
  static bool acts_on_effort(const plant::CatalogueEntry& entry) {
    const plant::HookSet& hooks = entry.hooks;
    const bool acts = hooks.drive || hooks.axis || hooks.friction || hooks.axis_structure;
    return acts && !hooks.axis_readings && entry.info.states.empty() && !makes_a_spring(entry);
  }

  /// Whether effort and motion tell of an effect.
  bool is_asked(const plant::CatalogueEntry& entry) const { return has(asked_, entry); }

  /// Blocks of held-out residuals: by run, and by time within it.
  void find_blocks() {
    const ComparedRows& compared = held_->compared();
    std::map<std::size_t, std::vector<Eigen::Index>> by_run;
    for (Eigen::Index i = 0; i < compared.size(); ++i)
      by_run[held_rows_->pieces[compared.rows[static_cast<std::size_t>(i)].piece].run].push_back(i);
    for (const auto& [run, rows] : by_run) {
      const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
      const Eigen::Index count =
          std::min<Eigen::Index>(propose_thresholds.blocks_in_run, n / propose_thresholds.residuals_in_block);
      for (Eigen::Index k = 0; k < count; ++k)
        blocks_.emplace_back(rows.begin() + k * n / count, rows.begin() + (k + 1) * n / count);
    }
    if (!blocks_.empty()) return;
    blocks_.emplace_back(static_cast<std::size_t>(compared.size()));
    std::iota(blocks_.front().begin(), blocks_.front().end(), Eigen::Index{0});
  }

  /// Log density of the blocks, each with a noise of its own.
  Eigen::VectorXd log_density(const EffortResiduals& left) const {
    Eigen::VectorXd density(static_cast<Eigen::Index>(blocks_.size()));
    const double rms = held_->compared().effort_rms, floor = propose_thresholds.least_effort * rms;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      double square = 0.0, flat = 0.0;
      for (const Eigen::Index i : blocks_[b]) {
        square += left.effort[i] * left.effort[i];
        flat += left.is_flat[static_cast<std::size_t>(i)] ? 1.0 : 0.0;
      }
      const double n = static_cast<double>(blocks_[b].size());
      const double variance = square / n + floor * floor;
      // Where any effort would do, it is spread over its range.
      density[static_cast<Eigen::Index>(b)] = -(0.5 * (n - flat) * std::log(variance) +
                                                flat * std::log(std::max(2.0 * rms, std::sqrt(variance)))) /
                                              samples_as_one_;
    }
    return density;
  }

  /// RMS of residuals over that of the effort.
  static double share_of(const Eigen::VectorXd& left, const EffortResidual& of) {
    return std::sqrt(left.squaredNorm() / static_cast<double>(left.size())) / of.compared().effort_rms;
  }

  /// The score of a set with its fit. Effects are fitted one after the other, those that go with whole turns of the angle last.
  const Scored& scored(EffectSet effects) {
    const auto place = [](const plant::CatalogueEntry* one) {
      return std::make_pair(counts_cycles(*one), one);
    };
    std::sort(effects.begin(), effects.end(),
              [&](const auto* a, const auto* b) { return place(a) < place(b); });
    const auto found = scores_.find(effects);
    if (found != scores_.end()) return found->second;
    Scored result = evaluated(effects);
    return scores_.emplace(std::move(effects), std::move(result)).first->second;
  }

  /// @param effects  in the order in which they are fitted
  Scored evaluated(const EffectSet& effects) {
    Scored result;
    result.score.effects = effects;
    result.score.refusal = InverseRefusal::not_told;
    if (!is_judged_ ||
        !std::all_of(effects.begin(), effects.end(), [&](const auto* one) { return is_asked(*one); }))
      return result;
    const EffortFitter fitter(*train_, samples_as_one_);
    if (effects.empty()) {
      result.fit = fitter.fit(unmoved_point(model_), coordinates({}), true);
      samples_as_one_ = correlation(result.fit.residual);
    } else {
      const Scored& base = scored(EffectSet(effects.begin(), effects.end() - 1));
      if (base.score.refusal == InverseRefusal::not_told) return result;
      result.fit = with_one_more(fitter, base, *effects.back());
    }
    if (result.fit.found) fill(result);
    return result;
  }

  /// Points from which a fit of one effect more may begin, with the squares that one linear step leaves there, the least first.
  std::vector<std::pair<double, EffortPoint>> starts_beside(const EffortFitter& fitter, const Scored& base,
                                                            const plant::CatalogueEntry& effect) const {
    const std::vector<EffortCoordinate> list = coordinates(and_one(base.score.effects, effect));
    std::vector<std::pair<double, EffortPoint>> starts;
    for (std::vector<double>& parameters : starts_of(effect, *train_, base.fit.residual)) {
      EffortPoint point = base.fit.point;
      point.effects.push_back({&effect, std::move(parameters)});
      const double left = fitter.promise(point, list);
      starts.emplace_back(left, std::move(point));
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return starts;
  }

  /// Whether one linear step with an effect more takes away enough of what a set leaves to be looked at.
  bool promises(const EffectSet& set, const plant::CatalogueEntry& entry) {
    const Scored& base = scored(set);
    const EffortFitter fitter(*train_, samples_as_one_);
    const double without = fitter.promise(base.fit.point, coordinates(base.score.effects));
    const auto starts = starts_beside(fitter, base, entry);
    return std::any_of(starts.begin(), starts.end(), [&](const auto& one) {
      return one.first < (1.0 - propose_thresholds.least_promise) * without;
    });
  }

  /// The best fit of a set and one effect more.
  EffortFit with_one_more(const EffortFitter& fitter, const Scored& base,
                          const plant::CatalogueEntry& effect) const {
    constexpr std::size_t fitted = 2;
    constexpr double close = 1.1;
    const std::vector<EffortCoordinate> list = coordinates(and_one(base.score.effects, effect));
    const auto starts = starts_beside(fitter, base, effect);
    EffortFit best;
    for (std::size_t k = 0; k < starts.size() && k < fitted; ++k) {
      if (k > 0 && starts[k].first > close * starts.front().first) break;
      EffortFit one = fitter.fit(starts[k].second, list, false);
      if (one.found && (!best.found || one.mean_square < best.mean_square)) best = std::move(one);
    }
    return best;
  }

  /// The score of what was fitted.
  void fill(Scored& result) {
    InverseScore& score = result.score;
    const EffortFit& fit = result.fit;
    Eigen::Index coordinate = 0;
    for (const EffortCoordinate& one : coordinates(score.effects))
      if (one.is_constant)
        score.constants.push_back(
            {one.constant, fit.point.factors[one.constant], fit.standard_error[coordinate++]});
    for (const plant::AddedEffect<double>& effect : fit.point.effects)
      for (std::size_t p = 0; p < effect.parameters.size(); ++p) {
        InverseEstimate one{effect.entry, p, effect.parameters[p], 0.0,
                            is_fitted(effect.entry->info.parameters[p])};
        if (one.fitted) one.standard_error = fit.standard_error[coordinate++];
        score.parameters.push_back(one);
      }
    const EffortResiduals left = held_->evaluate(fit.point, {});
    score.share = share_of(left.effort, *held_);
    score.refusal = why_not(fit.point, left);
    if (score.refusal == InverseRefusal::none) least_share_ = std::min(least_share_, score.share);
    result.log_density = log_density(left);
    const Eigen::VectorXd gains =
        result.log_density - (score.effects.empty() ? result : scores_.at({})).log_density;
    score.block_gain.assign(gains.begin(), gains.end());
  }

  /// Why a fit does not count.
  /// @param left  of held-out effort
  InverseRefusal why_not(const EffortPoint& point, const EffortResiduals& left) const {
    if (!left.effort.allFinite()) return InverseRefusal::not_told;
    if (left.flat() * 2.0 > static_cast<double>(left.effort.size())) return InverseRefusal::not_itself;
    const EffortPiece& piece = train_rows_->pieces.front();
    const double least_delay_s =
        propose_thresholds.least_delay_samples * 2.0 * piece.half_sample * piece.interval_s;
    for (const plant::AddedEffect<double>& one : point.effects) {
      const plant::AxisStructure<double> shape = structure_of(*one.entry, one.parameters);
      if (shape.delayed && shape.delay_s < least_delay_s) return InverseRefusal::of_stamps;
      if (!is_itself(*one.entry, one.parameters, model_, train_rows_->rate_rad_per_s))
        return InverseRefusal::not_itself;
    }
    return InverseRefusal::none;
  }

  /// Constants, then parameters, that a fit of these effects moves.
  std::vector<EffortCoordinate> coordinates(const EffectSet& effects) const {
    constexpr std::size_t most = plant::wide_dual_width - 1;
    std::vector<EffortCoordinate> parameters;
    for (std::size_t e = 0; e < effects.size(); ++e)
      for (std::size_t p = 0; p < effects[e]->info.parameters.size(); ++p) {
        const plant::Parameter& parameter = effects[e]->info.parameters[p];
        if (!is_fitted(parameter)) continue;
        EffortCoordinate& one = parameters.emplace_back();
        one.effect = e;
        one.parameter = p;
        one.lower = parameter.lower;
        one.upper = parameter.upper;
        one.logarithmic = parameter.logarithmic;
        if (structure_of(*effects[e]).delayed)
          one.upper = std::min(one.upper, longest_delay_s(train_rows_->pieces.front().interval_s));
      }
    std::vector<EffortCoordinate> list = constants_;
    if (list.size() + parameters.size() > most)
      list.resize(most > parameters.size() ? most - parameters.size() : 0);
    list.insert(list.end(), parameters.begin(), parameters.end());
    return list;
  }

  /// How many residuals of training effort count as one, from how they go with the one before.
  double correlation(const Eigen::VectorXd& residual) const {
    const std::vector<EffortRow>& rows = train_->compared().rows;
    double products = 0.0, squares = 0.0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(residual.size()); ++i) {
      const double now = residual[static_cast<Eigen::Index>(i)];
      if (rows[i].piece != rows[i - 1].piece) continue;
      products += now * residual[static_cast<Eigen::Index>(i) - 1];
      squares += now * now;
    }
    const double ratio = squares > 0.0 ? std::clamp(products / squares, 0.0, 0.95) : 0.0;
    return (1.0 + ratio) / (1.0 - ratio);
  }

  const Model& model_;
  const Catalogue& catalogue_;
  const std::vector<std::string> without_;
  const LoopKind loop_;
  bool is_judged_ = false;
  EffectSet asked_;  ///< what effort and motion tell of, in the catalogue's order
  std::optional<EffortRows> train_rows_, held_rows_;
  std::optional<EffortResidual> train_, held_;
  std::vector<std::vector<Eigen::Index>> blocks_;
  std::vector<EffortCoordinate> constants_;
  double samples_as_one_ = 1.0;
  double least_share_ = 1.0;
  std::optional<InverseScore> told_;
  std::map<EffectSet, Scored> scores_;
};

}  // namespace thermopower::gap::engine
