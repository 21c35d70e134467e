// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/experiment.hpp>
#include <thermopower/design/options.hpp>
#include <thermopower/design/outcome.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/plant.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::design {

/// An explanation that the recordings so far leave possible, with what they leave open of its parameters: a normal distribution
/// around the fit, in the fit's coordinates.
///
/// How to: @ref design_the_next_experiment.
class Possible {
public:
  /// @param model      as it was diagnosed; must outlive the object
  /// @param catalogue  knows its effects; must outlive the object
  /// @param ranked     of that diagnosis
  /// @return none where the catalogue lacks an effect, or the report its numbers
  static std::optional<Possible> of(const Model& model, const Catalogue& catalogue,
                                    const RankedExplanation& ranked) {
    Possible one(model);
    one.effects_ = ranked.effects;
    one.probability_ = ranked.probability;
    const std::vector<CalibratedConstant> constants = model.calibrated();
    for (const std::string& id : ranked.effects) {
      const auto constant =
          std::find_if(constants.begin(), constants.end(),
                       [&](const CalibratedConstant& each) { return plant::calibration_id(each.id) == id; });
      if (const CatalogueEntry* entry = catalogue.find(id)) one.explanation_.effects.push_back(entry);
      else if (constant != constants.end())
        one.explanation_.released.push_back(static_cast<int>(constant - constants.begin()));
      else return std::nullopt;
    }
    one.coordinates_ = engine::coordinates(model, one.explanation_, catalogue);
    one.at_.resize(static_cast<Eigen::Index>(one.coordinates_.size()));
    for (Eigen::Index i = 0; i < one.at_.size(); ++i) one.at_[i] = one.coordinate(i).start;
    std::vector<Eigen::Index> place;
    for (const auto* list : {&ranked.fitted, &ranked.fixed})
      for (const FittedCoordinate& fitted : *list) {
        Eigen::Index at = 0;
        while (at < one.at_.size() && one.coordinate(at).name != fitted.name) ++at;
        if (at == one.at_.size() || !std::isfinite(fitted.at)) return std::nullopt;
        one.at_[at] = fitted.at;
        if (list == &ranked.fitted) place.push_back(at);
      }
    if (place.empty() && one.at_.size() > 0) return std::nullopt;
    one.spread(ranked.covariance, place);
    return one;
  }

  /// Its ids; empty: nothing is missing.
  const std::vector<std::string>& effects() const { return effects_; }
  /// As the report has it, 0..1.
  double probability() const { return probability_; }
  /// Whether all of its causes are curves: a cause that nobody has named.
  bool is_curve() const {
    return !effects_.empty() && std::all_of(effects_.begin(), effects_.end(), [](const std::string& id) {
      return id.rfind("unknown.", 0) == 0;
    });
  }
  /// Whether it names constants alone, or nothing.
  bool is_constants() const { return explanation_.effects.empty(); }
  /// Whether only what was known before the data speaks against it: it predicts them as well as the likeliest one.
  bool is_tied = false;

  /// Whether it is another explanation with more: it has all of its causes. Constants are free in every explanation.
  bool is_more_than(const Possible& other) const {
    const auto &mine = explanation_.effects, &its = other.explanation_.effects;
    return std::all_of(its.begin(), its.end(), [&](const CatalogueEntry* one) {
      return std::find(mine.begin(), mine.end(), one) != mine.end();
    });
  }

  /// How many directions its parameters are uncertain in.
  int directions() const { return static_cast<int>(axes_.cols()); }
  /// The fit.
  ParameterPoint fit() const { return point(at_); }
  /// The fit, one standard deviation away in one direction. @param direction  0 to directions() - 1
  ParameterPoint moved(int direction) const {
    assert(direction >= 0 && direction < directions());
    return point(at_ + axes_.col(direction));
  }
  /// Parameters as likely as the recordings make them.
  ParameterPoint draw(Random& random) const {
    return point(at_ + axes_ * Eigen::VectorXd::NullaryExpr(axes_.cols(), [&] { return random.gauss(); }));
  }

private:
  explicit Possible(const Model& model) : model_(&model) {}

  const engine::Coordinate& coordinate(Eigen::Index i) const {
    return coordinates_[static_cast<std::size_t>(i)];
  }

  ParameterPoint point(Eigen::VectorXd at) const {
    for (Eigen::Index i = 0; i < at.size(); ++i)
      if (const engine::Coordinate& one = coordinate(i); !one.still && one.upper > one.lower)
        at[i] = std::clamp(at[i], std::min(one.lower, at_[i]), std::max(one.upper, at_[i]));
    ParameterPoint result = engine::point_of(*model_, explanation_, coordinates_, at);
    result.still.clear();
    return result;
  }

  /// The principal axes of what is open, each one standard deviation long; those that are next to nothing are left out. A parameter
  /// whose value the data do not tell at all is open within reason only: a normal distribution says nothing beyond.
  void spread(const Eigen::MatrixXd& covariance, const std::vector<Eigen::Index>& place) {
    constexpr double of_a_logarithm = 0.7, of_a_range = 0.25, of_a_value = 0.5, hardly = 1e-6;
    const auto count = static_cast<Eigen::Index>(place.size());
    Eigen::VectorXd most(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index at = place[static_cast<std::size_t>(i)];
      const engine::Coordinate& one = coordinate(at);
      const double range = of_a_range * (one.upper - one.lower), value = of_a_value * std::abs(at_[at]);
      most[i] = one.prior.sd > 0.0 ? one.prior.sd
                : one.logarithmic  ? of_a_logarithm
                : value > 0.0      ? std::min(range, value)
                                   : range;
    }
    // In units of what is reasonable at most, so that rounding does not depend on anybody's units.
    const Eigen::VectorXd units = most.unaryExpr([](double one) { return one > 0.0 ? 1.0 / one : 0.0; });
    Eigen::MatrixXd scaled = Eigen::MatrixXd::Identity(count, count);
    if (covariance.rows() == count && covariance.allFinite())
      scaled = units.asDiagonal() * covariance * units.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
    const Eigen::VectorXd sd = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    const Eigen::VectorXd within = solver.eigenvectors().cwiseAbs().colwise().maxCoeff().cwiseInverse();
    const Eigen::MatrixXd axes = most.asDiagonal() * solver.eigenvectors() * sd.cwiseMin(within).asDiagonal();
    const Eigen::Index kept = (sd.array() > hardly).count();
    axes_ = Eigen::MatrixXd::Zero(at_.size(), kept);
    for (Eigen::Index i = 0; i < count; ++i)
      axes_.row(place[static_cast<std::size_t>(i)]) = axes.row(i).tail(kept);
  }

  const Model* model_;
  std::vector<std::string> effects_;
  double probability_ = 0.0;
  engine::Explanation explanation_;
  std::vector<engine::Coordinate> coordinates_;
  Eigen::VectorXd at_;
  Eigen::MatrixXd axes_;  ///< a column for each direction
};

/// The explanations that an experiment has to tell apart: those that are likely, those that predict held-out data as well as the
/// likeliest one, and where none is sure the likeliest curve, which stands for every cause that nobody has named. A report may call a sure
/// cause ambiguous because refitted constants do without it: then these are open, too. Likeliest first.
/// @param catalogue  must outlive them; so must `gap`
inline std::vector<Possible> still_open(const DiagnosedGap& gap, const Catalogue& catalogue,
                                        const DesignOptions& options = {}) {
  std::vector<const RankedExplanation*> order;
  for (const RankedExplanation& one : gap.ranking)
    if (one.lacks != Lacks::room || one.probability >= options.likely) order.push_back(&one);
  const auto ratio = [](const RankedExplanation* one) {
    return std::isfinite(one->held_out_ratio) ? one->held_out_ratio : 1e9;
  };
  std::stable_sort(
      order.begin(), order.end(), [&](const RankedExplanation* one, const RankedExplanation* other) {
        const bool is_likely = one->probability >= options.likely || other->probability >= options.likely;
        return is_likely ? one->probability > other->probability : ratio(one) < ratio(other);
      });
  const auto predicts_as_well = [&](const RankedExplanation* one) {
    return ratio(one) <= options.as_well * ratio(order.front()) &&
           one->train_gain >= order.front()->train_gain - options.hardly_less_likely;
  };
  std::vector<Possible> all, as_good;
  bool needs_curve = !order.empty() && order.front()->probability < options.sure;
  bool needs_constants =
      gap.verdict == Verdict::ambiguous && !order.empty() && order.front()->probability >= options.sure;
  for (const RankedExplanation* one : order) {
    std::optional<Possible> possible = Possible::of(gap.model, catalogue, *one);
    if (!possible) continue;
    // A curve can be like any cause of its place, and a likelier explanation with more is like it: that they predict as well says
    // nothing against the cause.
    possible->is_tied = !all.empty() && !possible->is_curve() && predicts_as_well(one) &&
                        std::none_of(as_good.begin(), as_good.end(), [&](const Possible& likelier) {
                          return possible->is_more_than(likelier);
                        });
    if (predicts_as_well(one)) as_good.push_back(*possible);
    const bool is_open =
        (one->probability >= options.likely || possible->is_tied) && all.size() < options.most_open;
    const bool is_first_curve =
        needs_curve && possible->is_curve() && one->held_out_ratio < options.closes_half;
    const bool is_first_of_constants = needs_constants && possible->is_constants();
    if (!is_open && !is_first_curve && !is_first_of_constants && !all.empty()) continue;
    needs_curve = needs_curve && !possible->is_curve();
    needs_constants = needs_constants && !possible->is_constants();
    all.push_back(std::move(*possible));
  }
  return all;
}

/// Weights that sum up to 1.
inline std::vector<double> weights_of(const std::vector<Possible>& explanations,
                                      const DesignOptions& options) {
  std::vector<double> weights;
  double sum = 0.0;
  for (const Possible& one : explanations)
    sum += weights.emplace_back(std::max(one.probability(), options.least_weight));
  for (double& one : weights) one /= sum;
  return weights;
}

}  // namespace thermopower::design
