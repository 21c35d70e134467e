// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/random.hpp>
#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/fit/explanation.hpp>
#include <thermopower/plant/calibration_id.hpp>
#include <thermopower/plant/plant.hpp>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// An explanation that the recordings so far leave possible, with what they leave open of its parameters: a normal distribution
/// around the fit, in the fit's coordinates.
///
/// How to: @ref design_the_next_experiment.
class Possible {
public:
  /// @param model      as it was diagnosed
  /// @param catalogue  knows its effects; must outlive the object
  /// @param ranked     of that diagnosis
  /// @return none where the catalogue lacks an effect, or the report its numbers
  static std::optional<Possible> of(const Model& model, const Catalogue& catalogue,
                                    const RankedExplanation& ranked) {
    Possible one;
    one.effects_ = ranked.effects;
    one.probability_ = ranked.probability;
    const std::vector<CalibratedConstant> constants = model.calibrated();
    for (const std::string& id : ranked.effects) {
      if (const CatalogueEntry* entry = catalogue.find(id)) {
        one.explanation_.effects.push_back(entry);
        continue;
      }
      bool found = false;
      for (std::size_t i = 0; i < constants.size(); ++i)
        if (plant::calibration_id(constants[i].id) == id) {
          one.explanation_.released.push_back(static_cast<int>(i));
          found = true;
        }
      if (!found) return std::nullopt;
    }
    one.coordinates_ = engine::coordinates(model, one.explanation_, catalogue);
    const auto size = static_cast<Eigen::Index>(one.coordinates_.size());
    one.at_.resize(size);
    for (Eigen::Index i = 0; i < size; ++i) one.at_[i] = one.coordinates_[static_cast<std::size_t>(i)].start;
    std::vector<Eigen::Index> place;
    for (const auto* list : {&ranked.fitted, &ranked.fixed})
      for (const FittedCoordinate& fitted : *list) {
        Eigen::Index at = -1;
        for (Eigen::Index i = 0; i < size; ++i)
          if (one.coordinates_[static_cast<std::size_t>(i)].name == fitted.name) at = i;
        if (at < 0 || !std::isfinite(fitted.at)) return std::nullopt;
        one.at_[at] = fitted.at;
        if (list == &ranked.fitted) place.push_back(at);
      }
    if (place.empty() && size > 0) return std::nullopt;
    one.spread(ranked.covariance, place);
    one.model_ = &model;
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
  /// Its names in a sentence.
  std::string name() const {
    std::string text;
    for (const std::string& id : effects_) text += (text.empty() ? "" : " with ") + id;
    return text.empty() ? "nothing is missing" : text;
  }

  /// How many directions its parameters are uncertain in.
  int directions() const { return static_cast<int>(axes_.cols()); }
  /// The fit.
  ParameterPoint fit() const { return point(at_); }
  /// The fit, one standard deviation away in one direction. @param direction  0 to directions() - 1
  ParameterPoint moved(int direction, double by = 1.0) const {
    assert(direction >= 0 && direction < directions());
    return point(at_ + by * axes_.col(direction));
  }
  /// Parameters as likely as the recordings make them.
  ParameterPoint draw(Random& random) const {
    Eigen::VectorXd at = at_;
    for (Eigen::Index k = 0; k < axes_.cols(); ++k) at += random.gauss() * axes_.col(k);
    return point(at);
  }
  /// The model with this explanation in it, at its fit.
  Model model() const { return engine::augmented(*model_, explanation_, coordinates_, at_); }
  /// The same at parameters that are drawn.
  Model drawn_model(Random& random) const {
    Eigen::VectorXd at = at_;
    for (Eigen::Index k = 0; k < axes_.cols(); ++k) at += random.gauss() * axes_.col(k);
    return engine::augmented(*model_, explanation_, coordinates_, within(at));
  }

private:
  Eigen::VectorXd within(Eigen::VectorXd at) const {
    assert(at.size() == static_cast<Eigen::Index>(coordinates_.size()) && at_.size() == at.size());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const engine::Coordinate& one = coordinates_[static_cast<std::size_t>(i)];
      if (!one.still && one.upper > one.lower)
        at[i] = std::clamp(at[i], std::min(one.lower, at_[i]), std::max(one.upper, at_[i]));
    }
    return at;
  }

  ParameterPoint point(const Eigen::VectorXd& at) const {
    ParameterPoint result = engine::point_of(*model_, explanation_, coordinates_, within(at));
    result.still.clear();
    return result;
  }

  /// The principal axes of what is open, each one standard deviation long; those that are next to nothing are left out. A parameter
  /// whose value the data do not tell at all is open within reason only: a normal distribution says nothing beyond.
  void spread(const Eigen::MatrixXd& covariance, const std::vector<Eigen::Index>& place) {
    constexpr double most_of_a_logarithm = 0.7, most_of_a_range = 0.25, of_a_value = 0.5, of_a_constant = 1.0;
    const auto count = static_cast<Eigen::Index>(place.size());
    const auto size = static_cast<Eigen::Index>(coordinates_.size());
    Eigen::VectorXd most(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const engine::Coordinate& one =
          coordinates_[static_cast<std::size_t>(place[static_cast<std::size_t>(i)])];
      const double value = std::abs(at_[place[static_cast<std::size_t>(i)]]);
      most[i] = one.prior.sd > 0.0 ? of_a_constant * one.prior.sd
                : one.logarithmic  ? most_of_a_logarithm
                                   : std::min(most_of_a_range * (one.upper - one.lower),
                                             value > 0.0 ? of_a_value * value : 1e300);
    }
    // In units of what is reasonable at most, so that rounding does not depend on anybody's units.
    Eigen::MatrixXd scaled = Eigen::MatrixXd::Identity(count, count);
    if (covariance.rows() == count && covariance.allFinite())
      for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index k = 0; k < count; ++k)
          scaled(i, k) = most[i] > 0.0 && most[k] > 0.0 ? covariance(i, k) / (most[i] * most[k]) : 0.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
    constexpr double hardly = 1e-6;  // of the standard deviation that is reasonable
    axes_.resize(size, 0);
    for (Eigen::Index k = count - 1; k >= 0; --k) {
      const double sd = std::sqrt(std::max(solver.eigenvalues()[k], 0.0));
      if (!(sd > hardly)) continue;
      Eigen::VectorXd axis = Eigen::VectorXd::Zero(size);
      const Eigen::VectorXd unit = solver.eigenvectors().col(k);
      const double reach = std::min(sd, 1.0 / unit.cwiseAbs().maxCoeff());
      for (Eigen::Index i = 0; i < count; ++i)
        axis[place[static_cast<std::size_t>(i)]] = reach * unit[i] * most[i];
      axes_.conservativeResize(Eigen::NoChange, axes_.cols() + 1);
      axes_.col(axes_.cols() - 1) = axis;
    }
  }

  const Model* model_ = nullptr;
  std::vector<std::string> effects_;
  double probability_ = 0.0;
  engine::Explanation explanation_;
  std::vector<engine::Coordinate> coordinates_;
  Eigen::VectorXd at_;
  Eigen::MatrixXd axes_;  ///< a column for each direction
};

}  // namespace thermopower::design
