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
#include <thermopower/gap/propose/weighed_score.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <Eigen/Core>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
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
///     effort.loop();                            // open or closed: which score leads
///     effort.proposals();                       // what to fit, best first, with starting values
///     effort.score({coulomb, constant}).loses();  // a cause must not lose in the other direction
///
/// Scores are kept: asking twice costs nothing. One that is not judged says why in `refusal`, and speaks neither way.
class EffortProblem {
public:
  /// Keeps references to model and catalogue: both must outlive this object. The inputs need not.
  /// @param without  ids of effects that are not proposed
  EffortProblem(const Model& model, const Catalogue& catalogue, const std::vector<Inputs>& train,
                const std::vector<Inputs>& held_out, const std::vector<std::string>& without = {})
      : model_(model), catalogue_(catalogue), without_(without) {
    if (!model.axis || model.own) return;
    const SampledMotion sampled(model, catalogue, train, propose_thresholds.most_samples);
    loop_ = loop_of(model, train);
    double cutoff = propose_thresholds.motion_cutoff;
    train_rows_.emplace(sampled, cutoff, propose_thresholds.most_train_rows);
    if (train_rows_->pieces.empty()) return;
    PlainFit plain(model, catalogue, *train_rows_);
    while (cutoff > propose_thresholds.least_cutoff) {
      const double next = cutoff * propose_thresholds.next_cutoff;
      EffortRows rows(sampled, next, propose_thresholds.most_train_rows);
      const PlainFit there(model, catalogue, rows);
      if (!plain.is_noisier_than(there, sampled.noise_share(cutoff))) break;
      cutoff = next;
      train_rows_ = std::move(rows);
      plain = there;
    }
    held_rows_.emplace(SampledMotion(model, catalogue, held_out, propose_thresholds.most_samples), cutoff,
                       propose_thresholds.most_held_rows);
    for (const plant::CatalogueEntry& entry : catalogue.entries())
      if (entry.hooks.any_axis())
        judgeable_[&entry] = can_be_judged(entry, model, train) && can_be_judged(entry, model, held_out);
    if (has_hidden_states()) {
      refusal_ = InverseRefusal::hidden_state;
      return;
    }
    const double rest_rad_per_s = rest_rate(*train_rows_);
    train_.emplace(model, catalogue, *train_rows_, rest_rad_per_s, plain.early_samples());
    held_.emplace(model, catalogue, *held_rows_, rest_rad_per_s, plain.early_samples());
    if (!(train_->compared().effort_rms > 0.0) || !(held_->compared().effort_rms > 0.0)) return;
    if (train_->compared().size() < propose_thresholds.least_residuals ||
        held_->compared().size() < propose_thresholds.residuals_in_block) {
      refusal_ = InverseRefusal::too_few_rows;
      return;
    }
    refusal_ = InverseRefusal::none;
    find_blocks();
    constants_ = constants_of(model, catalogue);
    bound_inertia(model, *train_, constants_);
    nothing_ = score({});
  }

  EffortProblem(const EffortProblem&) = delete;  // its parts refer to each other
  EffortProblem& operator=(const EffortProblem&) = delete;
  /// Whether effort and motion can be compared.
  bool is_judged() const { return refusal_ == InverseRefusal::none; }
  /// Why they cannot; `none` where they can.
  InverseRefusal refusal() const { return refusal_; }
  /// Who makes the effort.
  const LoopEvidence& loop() const { return loop_; }
  /// RMS of held-out effort at the rows that are compared, A or V.
  double effort_rms() const { return is_judged() ? held_->compared().effort_rms : 0.0; }
  /// RMS of held-out effort that the best explanation asked so far leaves, A or V: its noise, or more.
  double effort_noise() const { return least_share_ * effort_rms(); }
  /// Cutoff of the low-pass that effort and motion go through, Hz; of the first recording.
  double low_pass_Hz() const {
    return is_judged() ? propose_thresholds.motion_cutoff / train_rows_->pieces.front().interval_s : 0.0;
  }
  /// The residual of training effort with a set of effects, A or V, at the compared rows; empty if it is not judged.
  Eigen::VectorXd train_residual(std::vector<const plant::CatalogueEntry*> effects) {
    score(effects);
    order(effects);
    return scores_.at(effects).fit.residual;
  }
  /// The same of held-out effort.
  Eigen::VectorXd held_out_residual(std::vector<const plant::CatalogueEntry*> effects) {
    if (!score(effects).judged) return {};
    order(effects);
    return held_->evaluate(scores_.at(effects).fit.point, {}).effort;
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
  double times_refitted(std::vector<double> factors,
                        const std::vector<plant::AddedEffect<double>>& effects) const {
    EffortPoint point;
    point.factors = std::move(factors);
    bool unread = false;
    for (const plant::AddedEffect<double>& one : effects) {
      if (makes_a_spring(*one.entry)) return 1.0;  // what the part behind it needs is not in the motion
      const bool acts = why_not(*one.entry) == InverseRefusal::none;
      if (acts) point.effects.push_back(one);
      unread = unread || !acts;
    }
    const auto share = [&](const EffortPoint& at) {
      Eigen::VectorXd left = held_->evaluate(at, {}).effort;
      if (!left.allFinite()) return 1e9;
      if (unread) left = without_plain_torques(left);
      return std::sqrt(left.squaredNorm() / static_cast<double>(left.size())) / effort_rms() + small_share;
    };
    return share(point) / share(scores_.at({}).fit.point);
  }
  /// Nothing is missing, constants refitted.
  const InverseScore& nothing() const { return nothing_; }

  /// How well a set of effects does beside refitted constants.
  /// @param effects  of the catalogue given, each once, in any order
  const InverseScore& score(std::vector<const plant::CatalogueEntry*> effects) {
    order(effects);
    const auto found = scores_.find(effects);
    if (found != scores_.end()) return found->second.score;
    return scores_.emplace(effects, evaluated(effects)).first->second.score;
  }

  /// Scores of every single effect of the catalogue that may act on an axis, in the catalogue's order.
  std::vector<InverseScore> singles() {
    std::vector<InverseScore> list;
    for (const plant::CatalogueEntry& entry : catalogue_.entries())
      if (entry.hooks.any_axis() && model_.effects.count(entry.info.id) == 0) list.push_back(score({&entry}));
    return list;
  }

  /// The proposals of held-out effort: single effects, and sets by forward selection. Those that are told first, then by
  /// share. Curves come after everything that has a name: beside the set that was told, in place of its members that act where the curve
  /// does, and alone. They could bend to what named causes do, and must lower the effort materially below those.
  std::vector<InverseProposal> proposals() {
    std::vector<InverseProposal> list;
    if (!is_judged()) return list;
    InverseScore now = nothing_;
    for (const bool with_curves : {false, true}) {
      while (now.effects.size() < static_cast<std::size_t>(propose_thresholds.most_causes)) {
        std::vector<InverseProposal> tried = next_to(now, with_curves);
        const bool goes_on = !tried.empty() && tried.front().is_told;
        if (goes_on) tried.front().leads = true, now = tried.front().score;
        list.insert(list.end(), tried.begin(), tried.end());
        if (!goes_on) break;
      }
      told_ = now;
    }
    std::stable_sort(list.begin(), list.end(), [](const InverseProposal& a, const InverseProposal& b) {
      return a.is_told != b.is_told ? a.is_told : a.weighed < b.weighed;
    });
    return list;
  }

  /// The set that forward selection stops at; that of nothing() where it tells none.
  const InverseScore& told() {
    if (!told_) proposals();
    if (!told_) told_ = nothing_;
    return *told_;
  }

  /// Whether the effort, which tells of other causes, has no use for this one: alone it does not lower held-out effort materially, nor
  /// beside what is told. Nothing is said of a cause that no effort tells.
  bool has_no_use_for(const plant::CatalogueEntry& cause) {
    const InverseScore best = told();
    const bool is_told = std::find(best.effects.begin(), best.effects.end(), &cause) != best.effects.end();
    if (best.effects.empty() || is_told || why_not(cause) != InverseRefusal::none) return false;
    const auto helps = [&](const InverseScore& without) {
      std::vector<const plant::CatalogueEntry*> set = without.effects;
      set.push_back(&cause);
      const InverseScore& with = score(set);
      return !with.judged || with.refusal == InverseRefusal::of_stamps ||
             (with.refusal == InverseRefusal::none && is_material(without, with));
    };
    return !helps(nothing_) && !helps(best);
  }

private:
  /// A score with the fit that it comes from.
  struct Scored {
    InverseScore score;
    EffortFit fit;
    Eigen::VectorXd log_density;  ///< of each held-out block
  };

  static constexpr double small_share = 0.02;  ///< of the effort's RMS: less is nobody's loss

  /// A set and each further effect, the best first: what lowers the effort most for its parameters. Of equals the one with the fewest
  /// parameters comes first, then the first of the catalogue.
  std::vector<InverseProposal> next_to(const InverseScore& now, bool curves) {
    std::vector<InverseProposal> tried;
    const auto place = [&](const InverseProposal& one) {
      std::ptrdiff_t last = 0;
      for (const plant::CatalogueEntry* effect : one.score.effects)
        if (std::find(now.effects.begin(), now.effects.end(), effect) == now.effects.end())
          last = effect - catalogue_.entries().data();
      return std::make_pair(parameter_count(one.score), last);
    };
    const auto add = [&](const std::vector<const plant::CatalogueEntry*>& set) {
      const InverseScore& one = score(set);
      if (one.judged && one.refusal == InverseRefusal::none)
        tried.push_back({one, is_material(now, one), false, weighed(one)});
    };
    for (const plant::CatalogueEntry& entry : catalogue_.entries()) {
      if (!entry.hooks.any_axis() || model_.effects.count(entry.info.id) > 0) continue;
      if (std::find(without_.begin(), without_.end(), entry.info.id) != without_.end()) continue;
      if (static_cast<bool>(entry.info.curve) != curves) continue;
      if (std::find(now.effects.begin(), now.effects.end(), &entry) != now.effects.end()) continue;
      std::vector<const plant::CatalogueEntry*> set = now.effects, others;
      for (const plant::CatalogueEntry* one : set)
        if (one->info.submodel != entry.info.submodel) others.push_back(one);
      const bool replaces = curves && others.size() < set.size();
      if (!replaces && !set.empty() && !promises(set, entry)) continue;
      if (replaces) set = others;
      set.push_back(&entry);
      add(set);
      if (curves && set.size() > 1) add({&entry});
    }
    std::stable_sort(tried.begin(), tried.end(), [](const InverseProposal& a, const InverseProposal& b) {
      return a.weighed < b.weighed;
    });
    if (tried.empty()) return tried;
    const double tied = tried.front().weighed * (1.0 + propose_thresholds.tied);
    const auto first = std::min_element(tried.begin(), tried.end(), [&](const auto& a, const auto& b) {
      const bool a_tied = a.weighed <= tied, b_tied = b.weighed <= tied;
      return a_tied != b_tied ? a_tied : a_tied && place(a) < place(b);
    });
    std::rotate(tried.begin(), first, first + 1);
    return tried;
  }

  /// The residual of held-out effort after dry friction, a constant and a load of the angle, of any size, are taken out.
  Eigen::VectorXd without_plain_torques(const Eigen::VectorXd& left) const {
    const ComparedRows& compared = held_->compared();
    Eigen::MatrixXd columns(left.size(), 5);
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      const Eigen::Index row = compared.rows[static_cast<std::size_t>(i)];
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

  /// Blocks of held-out residuals: by run, and by time within it.
  void find_blocks() {
    const ComparedRows& compared = held_->compared();
    std::map<std::size_t, std::vector<Eigen::Index>> by_run;
    for (Eigen::Index i = 0; i < compared.size(); ++i)
      by_run[held_rows_->pieces[compared.piece[static_cast<std::size_t>(i)]].run].push_back(i);
    for (const auto& [run, rows] : by_run) {
      const Eigen::Index n = static_cast<Eigen::Index>(rows.size());
      const Eigen::Index count =
          std::min<Eigen::Index>(propose_thresholds.blocks_in_run, n / propose_thresholds.residuals_in_block);
      for (Eigen::Index k = 0; k < count; ++k)
        blocks_.emplace_back(rows.begin() + k * n / count, rows.begin() + (k + 1) * n / count);
    }
    if (blocks_.empty()) {
      blocks_.emplace_back();
      for (Eigen::Index i = 0; i < compared.size(); ++i) blocks_.front().push_back(i);
    }
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

  /// Effects in the order in which they are fitted one after the other: what goes with whole turns of the angle comes last.
  void order(std::vector<const plant::CatalogueEntry*>& effects) const {
    const auto place = [&](const plant::CatalogueEntry* one) {
      return std::make_pair(counts_cycles(*one), one - catalogue_.entries().data());
    };
    std::sort(effects.begin(), effects.end(),
              [&](const auto* a, const auto* b) { return place(a) < place(b); });
  }

  Scored evaluated(const std::vector<const plant::CatalogueEntry*>& effects) {
    Scored result;
    result.score.effects = effects;
    result.score.refusal = refusal_;
    for (const plant::CatalogueEntry* one : effects)
      if (result.score.refusal == InverseRefusal::none) result.score.refusal = why_not(*one);
    if (result.score.refusal != InverseRefusal::none) return result;
    const EffortFitter fitter(*train_, samples_as_one_);
    if (effects.empty()) {
      result.fit = fitter.fit(unmoved_point(model_), coordinates({}), true);
      samples_as_one_ = correlation(result.fit.residual);
    } else {
      const std::vector<const plant::CatalogueEntry*> fewer(effects.begin(), effects.end() - 1);
      score(fewer);
      const Scored& base = scores_.at(fewer);
      if (!base.score.judged) {
        result.score.refusal = base.score.refusal;
        return result;
      }
      result.fit = with_one_more(fitter, base.fit.point, base.fit.residual, effects);
    }
    if (!result.fit.found) {
      result.score.refusal = InverseRefusal::too_few_rows;
      return result;
    }
    fill(effects, result);
    return result;
  }

  /// Whether one linear step with an effect more takes away enough of what a set leaves to be looked at.
  bool promises(std::vector<const plant::CatalogueEntry*> set, const plant::CatalogueEntry& entry) {
    if (why_not(entry) != InverseRefusal::none) return false;
    order(set);
    const EffortFit& base = scores_.at(set).fit;
    const EffortFitter fitter(*train_, samples_as_one_);
    const double without = fitter.promise(base.point, coordinates(set));
    set.push_back(&entry);
    const std::vector<BoundedCoordinate> list = coordinates(set);
    for (std::vector<double>& parameters : starts_of(entry, *train_, base.residual)) {
      EffortPoint point = base.point;
      point.effects.push_back({&entry, std::move(parameters)});
      if (fitter.promise(point, list) < (1.0 - propose_thresholds.least_promise) * without) return true;
    }
    return false;
  }

  /// The best fit of a set from the starts of its last effect.
  EffortFit with_one_more(const EffortFitter& fitter, const EffortPoint& base, const Eigen::VectorXd& left,
                          const std::vector<const plant::CatalogueEntry*>& effects) const {
    const std::vector<BoundedCoordinate> list = coordinates(effects);
    std::vector<std::pair<double, EffortPoint>> starts;
    for (std::vector<double>& parameters : starts_of(*effects.back(), *train_, left)) {
      EffortPoint point = base;
      point.effects.push_back({effects.back(), std::move(parameters)});
      const double promise = fitter.promise(point, list);
      starts.emplace_back(promise, std::move(point));
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    constexpr std::size_t fitted = 2;
    constexpr double close = 1.1;
    EffortFit best;
    for (std::size_t k = 0; k < starts.size() && k < fitted; ++k) {
      if (k > 0 && starts[k].first > close * starts.front().first) break;
      EffortFit one = fitter.fit(std::move(starts[k].second), list, false);
      if (one.found && (!best.found || one.mean_square < best.mean_square)) best = std::move(one);
    }
    return best;
  }

  void fill(const std::vector<const plant::CatalogueEntry*>& effects, Scored& result) {
    InverseScore& score = result.score;
    const EffortFit& fit = result.fit;
    const std::vector<BoundedCoordinate> list = coordinates(effects);
    const EffortResiduals left = held_->evaluate(fit.point, {});
    const auto share = [](const Eigen::VectorXd& of, double rms) {
      return std::sqrt(of.squaredNorm() / static_cast<double>(of.size())) / rms;
    };
    score.train_share = share(fit.residual, train_->compared().effort_rms);
    score.share = share(left.effort, held_->compared().effort_rms);
    score.judged = left.effort.allFinite();
    score.delay_s = train_->delay_s(fit.point);
    std::size_t coordinate = 0;
    for (; coordinate < list.size() && list[coordinate].at.is_constant; ++coordinate)
      score.constants.push_back({list[coordinate].at.constant,
                                 fit.point.factors[list[coordinate].at.constant],
                                 fit.standard_error[static_cast<Eigen::Index>(coordinate)]});
    for (std::size_t e = 0; e < effects.size(); ++e)
      for (std::size_t p = 0; p < effects[e]->info.parameters.size(); ++p) {
        InverseEstimate one{effects[e], p, fit.point.effects[e].parameters[p], 0.0,
                            is_fitted(effects[e]->info.parameters[p])};
        if (one.fitted) one.standard_error = fit.standard_error[static_cast<Eigen::Index>(coordinate++)];
        score.parameters.push_back(one);
      }
    result.log_density = log_density(left);
    score.refusal = left.flat * 2 > left.effort.size() ? InverseRefusal::switches_off : InverseRefusal::none;
    for (std::size_t e = 0; e < effects.size() && score.refusal == InverseRefusal::none; ++e) {
      const std::vector<double>& parameters = fit.point.effects[e].parameters;
      score.refusal = is_of_stamps(*effects[e], parameters)
                          ? InverseRefusal::of_stamps
                          : why_not_with(*effects[e], parameters, model_, train_rows_->rate_rad_per_s);
    }
    const Eigen::VectorXd gains = effects.empty()
                                      ? Eigen::VectorXd(Eigen::VectorXd::Zero(result.log_density.size()))
                                      : Eigen::VectorXd(result.log_density - scores_.at({}).log_density);
    score.block_gain.assign(gains.begin(), gains.end());
    const double n = static_cast<double>(gains.size());
    score.gain = gains.mean();
    score.gain_error = n > 1.0 ? std::sqrt((gains.array() - score.gain).square().sum() / (n - 1.0) / n) : 0.0;
    if (score.refusal == InverseRefusal::none) least_share_ = std::min(least_share_, score.share);
  }

  /// Whether an effect is a delay so short that stamps may be off by as much.
  bool is_of_stamps(const plant::CatalogueEntry& entry, const std::vector<double>& parameters) const {
    const plant::AxisStructure<double> shape = structure_of(entry, parameters);
    const EffortPiece& piece = train_rows_->pieces.front();
    return shape.delayed && shape.delay_s < propose_thresholds.least_delay_samples * 2.0 * piece.half_sample *
                                                piece.interval_s;
  }

  /// Why an effect cannot be asked after at all.
  InverseRefusal why_not(const plant::CatalogueEntry& entry) const {
    const plant::HookSet& hooks = entry.hooks;
    if (!hooks.drive && !hooks.axis && !hooks.friction && !hooks.axis_structure)
      return InverseRefusal::not_of_effort;
    if (hooks.axis_readings) return InverseRefusal::not_of_effort;
    if (!entry.info.states.empty() || makes_a_spring(entry)) return InverseRefusal::hidden_state;
    const auto found = judgeable_.find(&entry);
    return found != judgeable_.end() && found->second ? InverseRefusal::none : InverseRefusal::not_recorded;
  }

  /// Constants, then parameters, that a fit of these effects moves.
  std::vector<BoundedCoordinate> coordinates(const std::vector<const plant::CatalogueEntry*>& effects) const {
    constexpr std::size_t most = plant::wide_dual_width - 1;
    std::vector<BoundedCoordinate> parameters;
    for (std::size_t e = 0; e < effects.size(); ++e)
      for (std::size_t p = 0; p < effects[e]->info.parameters.size(); ++p) {
        const plant::Parameter& parameter = effects[e]->info.parameters[p];
        if (!is_fitted(parameter)) continue;
        BoundedCoordinate one;
        one.at.effect = e;
        one.at.parameter = p;
        one.lower = parameter.lower;
        one.upper = parameter.upper;
        one.logarithmic = parameter.logarithmic;
        if (structure_of(*effects[e]).delayed)
          one.upper = std::min(one.upper, longest_delay_s(train_rows_->pieces.front().interval_s));
        parameters.push_back(one);
      }
    std::vector<BoundedCoordinate> list = constants_;
    if (list.size() + parameters.size() > most)
      list.resize(most > parameters.size() ? most - parameters.size() : 0);
    list.insert(list.end(), parameters.begin(), parameters.end());
    return list;
  }

  /// How many residuals of training effort count as one, from how they go with the one before.
  double correlation(const Eigen::VectorXd& residual) const {
    const std::vector<std::size_t>& piece = train_->compared().piece;
    double products = 0.0, squares = 0.0;
    for (Eigen::Index i = 1; i < residual.size(); ++i)
      if (piece[static_cast<std::size_t>(i)] == piece[static_cast<std::size_t>(i - 1)]) {
        products += residual[i] * residual[i - 1];
        squares += residual[i] * residual[i];
      }
    const double ratio = squares > 0.0 ? std::clamp(products / squares, 0.0, 0.95) : 0.0;
    return (1.0 + ratio) / (1.0 - ratio);
  }

  const Model& model_;
  const Catalogue& catalogue_;
  std::vector<std::string> without_;
  LoopEvidence loop_;
  InverseRefusal refusal_ = InverseRefusal::no_effort;
  std::map<const plant::CatalogueEntry*, bool> judgeable_;
  std::optional<EffortRows> train_rows_, held_rows_;
  std::optional<EffortResidual> train_, held_;
  std::vector<std::vector<Eigen::Index>> blocks_;
  std::vector<BoundedCoordinate> constants_;
  double samples_as_one_ = 1.0;
  double least_share_ = 1.0;
  InverseScore nothing_;
  std::optional<InverseScore> told_;
  std::map<std::vector<const plant::CatalogueEntry*>, Scored> scores_;
};

}  // namespace thermopower::gap::engine
