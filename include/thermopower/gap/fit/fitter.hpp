// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/linear_solve.hpp>
#include <thermopower/gap/data/matrix_product.hpp>
#include <thermopower/gap/fit/fit_problem.hpp>
#include <thermopower/gap/fit/signal_sums.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace thermopower::gap::engine {

/// When a fit stops.
struct FitOptions {
  int iterations = 25;              ///< at most so many Gauss-Newton steps
  double relative_decrease = 1e-5;  ///< of chi^2, below which it has converged
  bool curvature = false;           ///< whether the result holds `information` and `scatter`: one more pass
  double hopeless = 1e300;          ///< cost: a fit that is still above it after `hopeful` steps ends there
  int hopeful = 4;                  ///< steps that every fit may take
};

/// Where a fit ended.
struct FitResult {
  Eigen::VectorXd point;      ///< coordinates
  std::vector<Start> starts;  ///< of every segment
  double chi2 = 1e300;        ///< data only
  double cost = 1e300;        ///< data and priors
  double began_at = 1e300;    ///< the same where it began
  Eigen::MatrixXd
      information;           ///< half the cost's curvature in the coordinates, starts projected out; or empty
  Eigen::MatrixXd pulls;     ///< gradients of contiguous blocks of the data, one column each, in their order
  Eigen::MatrixXd priors;    ///< what the priors have in `information`; empty: nothing
  double per_prior = 1.0;    ///< samples that a prior counts for
  SignalSums sums;           ///< of the squares of the residuals there; empty where no step was allowed
  Eigen::Index samples = 0;  ///< residuals that counted
  int iterations = 0;        ///< steps taken; fewer than allowed: converged
  std::vector<bool> at_bound;  ///< by coordinate
};

/// Gauss-Newton with Levenberg damping inside bounds.
///
/// The segments' starts are eliminated exactly (Schur complement), so the size of the linear system is the
/// number of coordinates, whatever the number of windows. A step never leaves the bounds; coordinates whose
/// gradient pushes against their bound are held there.
///
/// Residuals that are correlated, or larger than the noise because the model is wrong, say less than their number. So
/// priors count for as many samples as make one, times the mean square. A model that misses a cause therefore does not bend
/// its constants far to make up for a little of it.
class Fitter {
public:
  /// Keeps references to its arguments: they must outlive this object.
  Fitter(const FitProblem& problem, const Explanation& explanation, const std::vector<Coordinate>& list)
      : problem_(problem),
        explanation_(explanation),
        list_(list),
        combined_(combined_priors(explanation, list)) {
    Eigen::VectorXd from(static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) from[static_cast<Eigen::Index>(i)] = list[i].start;
    const auto rollout = problem.plant().rollout(*problem.model, *problem.catalogue,
                                                 point_of(*problem.model, explanation, list, from), {},
                                                 SimulationMode::free_running);
    for (const Segment& segment : problem.segments) hidden_.push_back(rollout->hidden_starts(segment));
  }

  /// Minimises from a point.
  FitResult minimise(const Eigen::VectorXd& from, const FitOptions& options = {},
                     const std::vector<Start>* starts = nullptr) {
    FitResult best;
    best.point = from;
    assert(from.size() == static_cast<Eigen::Index>(list_.size()));
    best.starts = starts != nullptr ? *starts : problem_.measured_starts();
    double damping = 1e-4;
    bool seen = false;  // the view is of `best`
    for (best.iterations = 0; best.iterations < options.iterations; ++best.iterations) {
      if (!seen) look_at(best);
      seen = false;
      best.cost = view_.cost;
      best.chi2 = view_.chi2;
      if (best.iterations == 0) best.began_at = best.cost;
      bool goes_on = false;
      double failed = std::numeric_limits<double>::infinity();  // squared length of the last step that did
      Failure failure;
      for (int attempt = 0; attempt < 8; ++attempt, damping = std::min(damping * 8.0, 1e12)) {
        FitResult trial = stepped(best, damping);
        const double length = view_.information.diagonal().dot((trial.point - best.point).cwiseAbs2());
        // A step about as long as one that failed fails, too.
        if (length > shorter * shorter * failed) continue;
        const double promise = best.cost - promised_cost(trial.point - best.point);
        const double enough = options.relative_decrease * best.cost;
        // A step that promises no more than a fit's last gain is tried only as the first one. Beside blows, which fulfil
        // little of a promise, it is tried.
        if (attempt > 0 && promise < enough && !explanation_.strikes()) continue;
        failed = length;
        // A step that promises something is taken more often than not, and the next one needs derivatives there.
        const bool look_ahead = attempt == 0 && best.iterations + 1 < options.iterations && promise > enough;
        trial.cost = look_ahead ? cost_ahead(trial.point, trial.starts, best.cost, trial.chi2)
                                : cost(trial.point, trial.starts, best.cost, trial.chi2);
        if (trial.cost < best.cost) {
          const double decrease = (best.cost - trial.cost) / (best.cost + 1e-300);
          best.point = trial.point;
          best.starts = trial.starts;
          best.cost = trial.cost;
          best.chi2 = trial.chi2;
          if (look_ahead) {
            std::swap(view_, ahead_);
            seen = true;
          }
          kept_.swap(look_ahead ? view_.residuals : plain_);
          // As long a step as has just failed would most likely fail again.
          if (attempt == 0) damping = std::max(damping * 0.2, 1e-9);
          goes_on = !(decrease < options.relative_decrease);
          break;
        }
        const bool to_the_end = samples_in(look_ahead ? ahead_.residuals : plain_) == view_.samples;
        const bool hardly_promised = promise < hardly_any * best.cost;
        const double above = trial.cost - (best.cost - promise);
        if (to_the_end && hardly_promised && failure.is_of_the_ground({length, above})) break;
      }
      if (!goes_on) break;
      if (best.iterations + 1 >= options.hopeful && best.cost > options.hopeless) break;
    }
    if (options.curvature) {
      const Eigen::Index count = static_cast<Eigen::Index>(list_.size());
      pulls_.clear();
      wants_pulls_ = true;
      look_at(best);
      wants_pulls_ = false;
      best.cost = view_.cost;
      best.chi2 = view_.chi2;
      best.information = view_.information;
      best.pulls.resize(count, static_cast<Eigen::Index>(pulls_.size()));
      for (std::size_t k = 0; k < pulls_.size(); ++k)
        best.pulls.col(static_cast<Eigen::Index>(k)) = pulls_[k];
      best.per_prior = view_.per_prior;
      best.priors = view_.priors;
    }
    for (Eigen::Index i = 0; i < best.point.size(); ++i) {
      const Coordinate& one = list_[static_cast<std::size_t>(i)];
      const double margin = std::min(1e-3 * (one.upper - one.lower), 1e-9);
      best.at_bound.push_back(best.point[i] <= one.lower + margin || best.point[i] >= one.upper - margin);
    }
    best.samples = view_.samples;
    for (std::size_t i = 0; i < signal_count; ++i) best.sums.set(i, kept_[i]);
    return best;
  }

  /// The cost of a fit that ended elsewhere, with the weight of priors that the last fit found.
  double cost(const FitResult& other) {
    double chi2 = 0.0;
    return cost(other.point, other.starts, 1e300, chi2);
  }

  /// Cost after one linear step of everything from a point: for choosing where to begin.
  double scan(const Eigen::VectorXd& at, const std::vector<Start>* starts = nullptr) {
    FitResult here;
    here.point = at;
    here.starts = starts != nullptr ? *starts : problem_.measured_starts();
    linearise(at, here.starts, view_);
    return promised_cost(stepped(here, 1e-3).point - at);
  }

private:
  struct Eliminated {
    Eigen::MatrixXd inverse;   ///< of the starts' own block
    Eigen::MatrixXd coupling;  ///< starts by coordinates
    Eigen::VectorXd gradient;
  };

  /// A step that made the fit worse, simulated to the end.
  struct Failure {
    double length = 0.0;  ///< squared; 0: there was none yet
    double above = 0.0;   ///< what it cost above what was promised

    /// Whether a further failure shows that the cost is rough here, as if friction holds or lets go in a window. The error
    /// of a linear view shrinks with the square of a step. The cost is rough if a step of half the length went wrong by
    /// over half as much. Keeps the failure that the next one is compared with.
    bool is_of_the_ground(const Failure& further) {
      const bool as_false = further.above > 0.5 * above;
      if (length > 0.0 && as_false) return further.length < 0.25 * length;
      *this = further;
      return false;
    }
  };

  static Eigen::Index samples_in(const ResidualsBySignal& residuals) {
    std::size_t count = 0;
    for (const std::vector<double>& one : residuals) count += one.size();
    return static_cast<Eigen::Index>(count);
  }

  /// The cost about a point as its first derivatives have it, starts eliminated.
  struct View {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd priors;  ///< their part of the information
    std::vector<Eliminated> eliminated;
    ResidualsBySignal residuals;
    Eigen::Index samples = 0;
    double chi2 = 0.0;       ///< data only
    double of_starts = 0.0;  ///< what the starts cost
    double cost = 0.0;       ///< at the point, priors by what they count for there
    double projected = 0.0;  ///< the same with the best starts
    double per_prior = 1.0;  ///< samples that a prior counts for
  };

  /// The promise of the linear view of the present point for a step of the coordinates.
  double promised_cost(const Eigen::VectorXd& change) const {
    return view_.projected + 2.0 * view_.gradient.dot(change) + quadratic_form(view_.information, change);
  }

  /// Makes `view_` that of a fit's point, and keeps its residuals.
  void look_at(const FitResult& here) {
    linearise(here.point, here.starts, view_);
    kept_.swap(view_.residuals);
  }

  /// Looks at a point. Ends early as soon as data and starts cost more than the limit: then the view is of no use.
  void linearise(const Eigen::VectorXd& at, const std::vector<Start>& starts, View& view,
                 double limit = std::numeric_limits<double>::infinity()) {
    clear(view);
    problem_.evaluate_while(explanation_, list_, at, starts, true,
                            [&](std::size_t i, const FitProblem::Residuals& residuals) {
                              add_segment(i, residuals, starts[i], view);
                              return view.chi2 + view.of_starts <= limit;
                            });
    add_priors(at, view);
  }

  /// An empty view, for segments to be added to.
  void clear(View& view) const {
    const Eigen::Index n = static_cast<Eigen::Index>(list_.size());
    view.information.setZero(n, n);
    view.gradient.setZero(n);
    view.priors.setZero(n, n);
    view.eliminated.resize(problem_.segments.size());
    view.samples = 0;
    view.chi2 = 0.0;
    view.of_starts = 0.0;
    view.projected = 0.0;
    for (std::vector<double>& one : view.residuals) one.clear();
  }

  /// The priors of the constants, to a view of all segments.
  void add_priors(const Eigen::VectorXd& at, View& view) const {
    const double mean = view.samples > 0 ? view.chi2 / static_cast<double>(view.samples) : 1.0;
    view.per_prior = std::max(mean, 1.0) * problem_.correlation;
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const double weight = view.per_prior * list_[static_cast<std::size_t>(i)].prior.weight(at[i]);
      view.priors(i, i) = weight;
      view.gradient[i] += weight * at[i];
    }
    for (const CombinedPrior& one : combined_) {
      const double value = one.value(at), weight = view.per_prior * one.prior.weight(value);
      for (const auto& [i, by] : one.weights) {
        for (const auto& [k, with] : one.weights) view.priors(i, k) += weight * by * with;
        view.gradient[i] += weight * by * value;
      }
    }
    view.information += view.priors;
    view.cost = view.chi2 + view.of_starts + view.per_prior * cost_of_priors(at);
    view.projected += view.cost;
  }

  void add_segment(std::size_t i, const FitProblem::Residuals& residuals, const Start& start, View& view) {
    const Eigen::Index n = static_cast<Eigen::Index>(list_.size());
    const MatrixView own = residuals.jacobian.leftCols(n);
    const MatrixView starts = residuals.jacobian.rightCols(start.size());
    const Start inverse_sd = problem_.start_weight(problem_.segments[i]);
    view.samples += residuals.value.size();
    Eliminated& part = view.eliminated[i];
    part.inverse = gram(starts);
    part.gradient = transposed_times(starts, residuals.value);
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      const double weight = inverse_sd[k] * inverse_sd[k];
      double& diagonal = part.inverse(k, k);
      diagonal += weight;
      if (!(diagonal > 0.0)) diagonal = 1.0;
      part.gradient[k] += weight * start[k];
      view.of_starts += weight * start[k] * start[k];
    }
    invert_symmetric(part.inverse);
    part.coupling = transposed_product(starts, own);
    view.information += gram(own);
    view.information -= transposed_product(part.coupling, transposed_product(part.inverse, part.coupling));
    view.gradient += transposed_times(own, residuals.value);
    view.gradient -= transposed_times(part.coupling, transposed_times(part.inverse, part.gradient));
    view.chi2 += residuals.value.squaredNorm();
    for (std::size_t row = 0; row < residuals.signal.size(); ++row)
      view.residuals[static_cast<std::size_t>(residuals.signal[row])].push_back(
          residuals.value[static_cast<Eigen::Index>(row)]);
    view.projected -= quadratic_form(part.inverse, part.gradient);
    if (wants_pulls_) add_pulls(residuals, part);
  }

  /// Adds the gradients of a segment's blocks: a short window is one, a long run has several.
  void add_pulls(const FitProblem::Residuals& residuals, const Eliminated& part) {
    constexpr Eigen::Index longest =
        120;  // rows that count of a fit of some thousand: twenty blocks and more
    const Eigen::Index n = static_cast<Eigen::Index>(list_.size()), rows = residuals.value.size();
    const Eigen::Index parts = (rows + longest - 1) / longest;
    for (Eigen::Index k = 0; k < parts; ++k) {
      const Eigen::Index begin = rows * k / parts, count = rows * (k + 1) / parts - begin;
      const VectorView value = residuals.value.segment(begin, count);
      const Eigen::VectorXd all = transposed_times(residuals.jacobian.middleRows(begin, count), value);
      const Eigen::VectorXd by_start = transposed_times(part.inverse, all.tail(all.size() - n));
      pulls_.push_back(all.head(n) - transposed_times(part.coupling, by_start));
    }
  }

  FitResult stepped(const FitResult& from, double damping) const {
    const Eigen::Index n = from.point.size();
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Coordinate& one = list_[static_cast<std::size_t>(i)];
      const bool pushed_down = from.point[i] <= one.lower && view_.gradient[i] > 0.0;
      const bool pushed_up = from.point[i] >= one.upper && view_.gradient[i] < 0.0;
      if (!pushed_down && !pushed_up && view_.information(i, i) > 0.0) free.push_back(i);
    }
    Eigen::VectorXd change = Eigen::VectorXd::Zero(n);
    // Coordinates that the step would carry over a bound stop there; the others are solved again without
    // them.
    for (int round = 0; round < 4 && !free.empty(); ++round) {
      const Eigen::Index m = static_cast<Eigen::Index>(free.size());
      Eigen::MatrixXd matrix(m, m);
      Eigen::VectorXd right(m), scale(m);
      const Eigen::VectorXd shifted = view_.gradient + view_.information * change;
      for (Eigen::Index a = 0; a < m; ++a) scale[a] = std::sqrt(view_.information(free[a], free[a]));
      for (Eigen::Index a = 0; a < m; ++a) {
        right[a] = -shifted[free[a]] / scale[a];
        for (Eigen::Index b = 0; b < m; ++b)
          matrix(a, b) = view_.information(free[a], free[b]) / (scale[a] * scale[b]);
        matrix(a, a) += damping;
      }
      const Eigen::VectorXd solved = SymmetricSystem(std::move(matrix)).solve(std::move(right));
      std::vector<Eigen::Index> inside;
      Eigen::VectorXd bounded(m);
      for (Eigen::Index a = 0; a < m; ++a) {
        const Eigen::Index i = free[a];
        const Coordinate& one = list_[static_cast<std::size_t>(i)];
        const double step = std::isfinite(solved[a]) ? solved[a] / scale[a] : 0.0;
        const double target = from.point[i] + step;
        bounded[a] = std::clamp(target, one.lower, one.upper) - from.point[i];
        if (target < one.lower || target > one.upper) change[i] = bounded[a];
        else inside.push_back(i);
      }
      if (inside.size() == free.size() || round == 3) {
        for (Eigen::Index a = 0; a < m; ++a) change[free[a]] = bounded[a];
        break;
      }
      free = inside;
    }
    // A coordinate that is known by its order of magnitude moves by a factor of 3 at most. The linear view is blind far
    // away.
    for (Eigen::Index i = 0; i < n; ++i)
      if (list_[static_cast<std::size_t>(i)].logarithmic) change[i] = std::clamp(change[i], -1.1, 1.1);
    FitResult to;
    to.point = from.point + change;
    to.starts = from.starts;
    for (std::size_t i = 0; i < to.starts.size(); ++i) {
      const Eigen::VectorXd slope = view_.eliminated[i].gradient + view_.eliminated[i].coupling * change;
      to.starts[i] -= transposed_times(view_.eliminated[i].inverse, slope);
    }
    // A start that nobody measures stays among those that a body can have.
    for (std::size_t i = 0; i < to.starts.size(); ++i)
      for (const HiddenStart& one : hidden_[i])
        to.starts[i][one.coordinate] = std::clamp(to.starts[i][one.coordinate], -one.farthest, one.farthest);
    return to;
  }

  /// The cost of the coordinates' priors at a point, each counting for one sample.
  double cost_of_priors(const Eigen::VectorXd& at) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < list_.size(); ++i)
      sum += list_[i].prior.cost(at[static_cast<Eigen::Index>(i)]);
    for (const CombinedPrior& one : combined_) sum += one.prior.cost(one.value(at));
    return sum;
  }

  /// Data and priors, those by what they count for at the present point; where that is above the limit, something above it.
  double cost(const Eigen::VectorXd& at, const std::vector<Start>& starts, double limit, double& chi2) {
    double priors = view_.per_prior * cost_of_priors(at);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const Start inverse_sd = problem_.start_weight(problem_.segments[i]);
      for (Eigen::Index k = 0; k < inverse_sd.size(); ++k) {
        const double off = inverse_sd[k] * starts[i][k];
        priors += off * off;
      }
    }
    chi2 = problem_.squares(explanation_, list_, at, starts, limit - priors, &plain_);
    return priors + chi2;
  }

  /// The same, with a view of that point in `ahead_`; where the cost is above the limit, it is of no use.
  double cost_ahead(const Eigen::VectorXd& at, const std::vector<Start>& starts, double limit, double& chi2) {
    const double priors = view_.per_prior * cost_of_priors(at);
    linearise(at, starts, ahead_, limit - priors);
    chi2 = ahead_.chi2;
    return priors + ahead_.of_starts + chi2;
  }

  static constexpr double hardly_any =
      1e-3;  ///< of the cost: for so little a fit does not go on over rough ground
  static constexpr double shorter = 0.9;  ///< than a step that failed is one worth trying, by its length

  const FitProblem& problem_;
  const Explanation& explanation_;
  const std::vector<Coordinate>& list_;
  const std::vector<CombinedPrior> combined_;     ///< beside those of the coordinates
  View view_;                                     ///< of the present point
  View ahead_;                                    ///< of a step that was tried
  ResidualsBySignal kept_;                        ///< at the present point
  ResidualsBySignal plain_;                       ///< where no view was asked for
  std::vector<std::vector<HiddenStart>> hidden_;  ///< of every segment
  bool wants_pulls_ = false;                      ///< whether the next pass adds to `pulls_`
  std::vector<Eigen::VectorXd> pulls_;            ///< gradients of blocks, in order
};

}  // namespace thermopower::gap::engine
