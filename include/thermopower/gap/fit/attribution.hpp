// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/fit/candidate.hpp>
#include <thermopower/gap/fit/fitter.hpp>
#include <thermopower/gap/fit/signal_sums.hpp>
#include <thermopower/gap/fit/traps.hpp>
#include <thermopower/gap/observe/noise.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace thermopower::gap::engine {

/// The promise of one linear step from some starts.
struct LinearGuess {
  double cost = 1e300;                  ///< after the step from the best of them
  std::vector<Eigen::VectorXd> starts;  ///< those that promise most, the best first
};

/// Fits explanations to training data.
class Attribution {
public:
  static constexpr double out_of_sight = 4.0;  ///< times the least cost: residuals twice as large
  static constexpr double lost_from = 400.0;   ///< times the least cost: residuals twenty times as large

  /// @param problem  the training data and the model; must outlive this object
  explicit Attribution(const FitProblem& problem) : problem_(problem), glimpse_(problem) {}
  /// @param glimpse  the same question to few of the data, on which starts are compared; must outlive this object
  Attribution(const FitProblem& problem, const FitProblem& glimpse) : problem_(problem), glimpse_(glimpse) {}

  /// Fits one explanation from all its starts; `near` is a fit of part of it to begin from.
  /// @param further  where given, one more start: coordinates in the order of coordinates()
  Candidate fit(const Explanation& explanation, const FitOptions& options, const Candidate* near = nullptr,
                const Eigen::VectorXd* further = nullptr) const {
    std::vector<Eigen::VectorXd> starts = start_points(explanation, near);
    if (starts.size() > tried_) starts = guess(glimpse_, explanation, starts).starts;
    if (further != nullptr) starts.push_back(*further);
    return fit_from(explanation, starts, options);
  }

  /// Fits one explanation from the best of some starts. It takes a few steps from each, and one more from those in sight of
  /// the best one. From the best it goes to the end, unless that is hopeless. A set begins where a part of it was fitted.
  /// No further starts are tried if two explain much more than that part and as much as each other. The same holds if two
  /// end far beyond hope.
  /// @param starts  at least one; coordinates in the order of coordinates()
  Candidate fit_from(const Explanation& explanation, const std::vector<Eigen::VectorXd>& starts,
                     const FitOptions& options) const {
    Candidate candidate = unfitted(explanation);
    Fitter fitter(problem_, candidate.explanation, candidate.list);
    if (starts.size() > 1) {
      FitOptions few = options;
      few.iterations = std::min(4, options.iterations);
      few.hopeful = few.iterations - 1;
      int lost = 0;
      for (const Eigen::VectorXd& start : starts) {
        FitResult trial = fitter.minimise(start, few);
        lost += trial.cost > out_of_sight * options.hopeless ? 1 : 0;
        const bool enough = explanation.effects.size() > 1 && (lead_alike(trial, candidate.fit) || lost == 2);
        if (trial.cost < candidate.fit.cost || candidate.fit.point.size() == 0)
          candidate.fit = std::move(trial);
        if (enough) break;
        few.hopeless = std::min(options.hopeless, out_of_sight * candidate.fit.cost);
      }
      if (!(candidate.fit.cost > options.hopeless))
        candidate.fit = fitter.minimise(candidate.fit.point, options, &candidate.fit.starts);
    } else {
      candidate.fit = fitter.minimise(starts.front(), options);
    }
    free_from_traps(fitter, candidate, options);
    candidate.train = candidate.fit.sums;
    return candidate;
  }

  /// Takes a candidate that was fitted to other data as it stands, segments starting as measured.
  void adopt(Candidate& candidate) const {
    candidate.fit.starts = problem_.measured_starts();
    candidate.train = sums(candidate, problem_, candidate.fit.starts);
  }

  /// Goes on from where a fit stopped, possibly on other data.
  void polish(Candidate& candidate, const FitOptions& options) const {
    Fitter fitter(problem_, candidate.explanation, candidate.list);
    candidate.fit = fitter.minimise(candidate.fit.point, options, starts_of(candidate));
    if (options.iterations > 2) free_from_traps(fitter, candidate, options);
    candidate.train = candidate.fit.sums;
  }

  /// Frees the details of a candidate's effects and fits once more from where it ended. Details become part of the effects
  /// if they take away at least `share` of the rest above the noise. Else the candidate stays.
  void refine(Candidate& candidate, double share, const FitOptions& options) const {
    if (!candidate.explanation.can_be_refined() || candidate.train.within(noise_)) return;
    Candidate finer = with_details_free(candidate);
    finer.fit = Fitter(problem_, finer.explanation, finer.list)
                    .minimise(candidate.fit.point, options, starts_of(candidate));
    finer.train = finer.fit.sums;
    finer.settled = false;
    if (takes_away(finer, candidate, share)) candidate = std::move(finer);
  }

  /// Looks at the curvature where a fit ended: what the intervals of its parameters are made of.
  void survey(Candidate& candidate) const {
    if (candidate.fit.information.size() > 0) return;
    FitOptions look;
    look.iterations = 0;
    look.curvature = true;
    candidate.fit = Fitter(problem_, candidate.explanation, candidate.list)
                        .minimise(candidate.fit.point, look, starts_of(candidate));
  }

  /// The problem that explanations are fitted to.
  const FitProblem& problem() const { return problem_; }

  /// How far one linear step from the fit of a part of it lowers the cost of an explanation: the promise of a set.
  LinearGuess promise(const Explanation& together, const Candidate& near) const {
    return guess(problem_, together, start_points(together, &near));
  }

  /// The same from given starts. @param starts  at least one; coordinates in the order of coordinates()
  LinearGuess promise(const Explanation& together, const std::vector<Eigen::VectorXd>& starts) const {
    return guess(problem_, together, starts);
  }

  /// Squared residuals of a candidate on a problem, segments starting as given.
  static SignalSums sums(const Candidate& candidate, const FitProblem& problem,
                         const std::vector<Start>& starts) {
    const auto by_signal = residuals(candidate, problem, starts);
    SignalSums result;
    for (std::size_t i = 0; i < signal_count; ++i) result.set(i, by_signal[i]);
    return result;
  }

  /// Residuals of a candidate by signal, in units of the noise; starts as fitted.
  static ResidualsBySignal residuals(const Candidate& candidate, const FitProblem& problem,
                                     const std::vector<Start>& starts) {
    ResidualsBySignal result;
    problem.evaluate(candidate.explanation, candidate.list, candidate.fit.point, starts, false,
                     [&](std::size_t, const FitProblem::Residuals& one) {
                       for (std::size_t i = 0; i < one.signal.size(); ++i)
                         result[static_cast<std::size_t>(one.signal[i])].push_back(
                             one.value[static_cast<Eigen::Index>(i)]);
                     });
    return result;
  }

  /// Fits a candidate once more from where another one ended. It takes the constants and the parameters that both have.
  /// Between effects of one submodel, equal names count as the same parameter. Keeps the better of both fits. If details of
  /// the other one's effects are free, the candidate's are freed, too. They stay so if they take away at least `share` of
  /// the rest above the noise.
  /// @return whether the candidate was worth a fit: what is lost, where it ended and by the first derivatives there, has lost
  ///         whatever its constants are
  bool refit_from(Candidate& candidate, const Candidate& other, const FitOptions& options,
                  double share) const {
    if (other.explanation.refined && candidate.explanation.can_be_refined()) {
      Candidate finer = with_details_free(candidate);
      const bool was_worth_it = refit_from(finer, other, options, share);
      if (takes_away(finer, candidate, share)) candidate = std::move(finer);
      return was_worth_it;
    }
    Eigen::VectorXd from = candidate.fit.point;
    const std::vector<Owner> owners = owners_in(candidate), other_owners = owners_in(other);
    for (std::size_t i = 0; i < candidate.list.size(); ++i)
      for (std::size_t k = 0; k < other.list.size(); ++k) {
        const Coordinate &one = candidate.list[i], &its = other.list[k];
        const bool is_same = one.logarithmic == its.logarithmic && owners[i].is_like(other_owners[k]);
        if (one.name == its.name || is_same || owners[i].is_where_equal(other_owners[k]))
          from[static_cast<Eigen::Index>(i)] =
              std::clamp(other.fit.point[static_cast<Eigen::Index>(k)], one.lower, one.upper);
      }
    // The noise may have been measured anew since the candidate was fitted: both costs are in units of the present one.
    Fitter fitter(problem_, candidate.explanation, candidate.list);
    FitOptions in_sight = options;
    in_sight.hopeless = out_of_sight * other.train.total();
    const double lost = lost_from * other.train.total();
    const std::vector<Start>* fitted = starts_of(other);
    const std::vector<Start> starts = fitted != nullptr ? *fitted : problem_.measured_starts();
    if (candidate.train.total() > lost &&
        (runs_away(candidate, from, starts) || !(fitter.scan(from, &starts) <= lost)))
      return false;
    FitResult again = fitter.minimise(from, in_sight, &starts);
    if (starts_of(candidate) != nullptr && !(again.cost < fitter.cost(candidate.fit))) return true;
    candidate.fit = std::move(again);
    candidate.settled = false;
    candidate.train = candidate.fit.sums;
    return true;
  }

private:
  /// The starts that a fit ended with, where it was of as many segments; else null: a fit then begins at the measured ones.
  const std::vector<Start>* starts_of(const Candidate& candidate) const {
    return candidate.fit.starts.size() == problem_.segments.size() ? &candidate.fit.starts : nullptr;
  }

  /// Whether a simulation at other coordinates is worse than a candidate by orders of magnitude. It grows without an end
  /// there, in ever smaller steps, and its derivatives would take minutes and say nothing.
  bool runs_away(const Candidate& candidate, const Eigen::VectorXd& at,
                 const std::vector<Start>& starts) const {
    const double far = 1e6 * candidate.train.total();
    return problem_.squares(candidate.explanation, candidate.list, at, starts, far) > far;
  }

  /// A candidate with the details of its effects free, where its fit ended without them.
  Candidate with_details_free(Candidate candidate) const {
    candidate.explanation.refined = true;
    candidate.list = coordinates(*problem_.model, candidate.explanation, *problem_.catalogue);
    return candidate;
  }

  /// Whether one fit takes away at least so large a share of what another one leaves above the noise, if that is anything.
  static bool takes_away(const Candidate& finer, const Candidate& plain, double share) {
    if (plain.train.within(noise_)) return false;
    const auto above_noise = [](const Candidate& one) {
      double sum = 0.0;
      for (std::size_t i = 0; i < signal_count; ++i)
        sum += std::max(one.train.squares[i] - one.train.samples[i], 0.0);
      return sum;
    };
    return above_noise(finer) <= (1.0 - share) * above_noise(plain);
  }

  /// What a coordinate belongs to; null of a constant.
  struct Owner {
    const CatalogueEntry* effect = nullptr;
    const Parameter* parameter = nullptr;

    /// Whether both are parameters of one name in effects of one submodel.
    bool is_like(const Owner& other) const {
      return effect != nullptr && other.effect != nullptr &&
             effect->info.submodel == other.effect->info.submodel && parameter->name == other.parameter->name;
    }

    /// Whether it is the first parameter of what the other one's effect is where two of its own are equal: the friction that one by
    /// direction is.
    bool is_where_equal(const Owner& other) const {
      if (effect == nullptr || other.effect == nullptr || !other.effect->info.where_equal) return false;
      const auto& equal = *other.effect->info.where_equal;
      return equal.cause == effect->info.id && parameter == &effect->info.parameters.front() &&
             other.parameter == &other.effect->info.parameters[static_cast<std::size_t>(equal.one)];
    }
  };

  /// By coordinate.
  static std::vector<Owner> owners_in(const Candidate& candidate) {
    std::vector<Owner> parameters;
    for (const CatalogueEntry* effect : candidate.explanation.effects)
      for (const Parameter& parameter : effect->info.parameters) parameters.push_back({effect, &parameter});
    std::vector<Owner> all(candidate.list.size() - parameters.size());
    all.insert(all.end(), parameters.begin(), parameters.end());
    return all;
  }

  /// An explanation of which nothing is known yet.
  Candidate unfitted(const Explanation& explanation) const {
    Candidate candidate;
    candidate.explanation = explanation;
    candidate.list = coordinates(*problem_.model, explanation, *problem_.catalogue);
    return candidate;
  }

  /// Whether fits from two starts leave little of what there was, and as much as each other.
  static bool lead_alike(const FitResult& one, const FitResult& other) {
    constexpr double alike = 0.01, much = 0.25;
    return one.cost < much * one.began_at && std::abs(one.cost - other.cost) < alike * other.cost;
  }

  /// One linear step from each of some starts.
  LinearGuess guess(const FitProblem& problem, const Explanation& explanation,
                    const std::vector<Eigen::VectorXd>& starts) const {
    const Candidate candidate = unfitted(explanation);
    Fitter fitter(problem, candidate.explanation, candidate.list);
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < starts.size(); ++i) order.push_back({fitter.scan(starts[i]), i});
    std::sort(order.begin(), order.end());
    LinearGuess found{order.front().first, {}};
    order.resize(std::min(tried_, order.size()));
    for (const auto& one : order) found.starts.push_back(starts[one.second]);
    return found;
  }

  /// Points to begin from: those of a fit of part of it, and every combination of the starts of the other effects' parameters.
  std::vector<Eigen::VectorXd> start_points(const Explanation& explanation, const Candidate* near) const {
    const Candidate candidate = unfitted(explanation);
    const std::vector<Coordinate>& list = candidate.list;
    Eigen::VectorXd base(static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) {
      double value = list[i].start;
      if (near != nullptr)
        for (std::size_t k = 0; k < near->list.size(); ++k)
          if (near->list[k].name == list[i].name) value = near->fit.point[static_cast<Eigen::Index>(k)];
      base[static_cast<Eigen::Index>(i)] = std::clamp(value, list[i].lower, list[i].upper);
    }
    std::vector<Eigen::VectorXd> points{base};
    const std::vector<Owner> owners = owners_in(candidate);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (owners[i].effect == nullptr || (near != nullptr && near->explanation.has(*owners[i].effect)))
        continue;
      const Parameter& parameter = *owners[i].parameter;
      const double unit =
          parameter.starts_relative_to == Input::none ? 1.0 : scale_of(parameter.starts_relative_to);
      std::vector<Eigen::VectorXd> wider;
      for (const Eigen::VectorXd& point : points)
        for (const double start : parameter.starts) {
          const double value = list[i].coordinate_of(start * unit);
          wider.push_back(point);
          wider.back()[static_cast<Eigen::Index>(i)] = std::clamp(value, list[i].lower, list[i].upper);
        }
      points = std::move(wider);
    }
    return points;
  }

  /// Largest magnitude of an input over the data of the fit.
  double scale_of(Input input) const {
    double largest = 0.0;
    for (const Segment& segment : problem_.segments) {
      const Inputs& inputs = *segment.inputs;
      const bool is_drive = input == Input::drive_A;
      const bool is_voltage = is_drive && !inputs.closed_loop && problem_.model->axis &&
                              problem_.model->axis->voltage_driven();  // taken as a current at standstill
      const Eigen::VectorXd& values = is_voltage                       ? inputs.voltage_V
                                      : is_drive && inputs.closed_loop ? inputs.servo_A
                                      : is_drive                       ? inputs.drive_A
                                      : input == Input::power_param    ? inputs.power_param
                                                                       : inputs.supply_V;
      if (values.size() == 0) continue;
      const double per_unit = is_voltage ? 1.0 / problem_.model->axis->resistance_ohm : 1.0;
      largest = std::max(
          largest,
          per_unit * values.segment(segment.begin, segment.end - segment.begin).cwiseAbs().maxCoeff());
    }
    return largest > 0.0 ? largest : 1.0;
  }

  static constexpr std::size_t tried_ = 5;  ///< of the starts of an explanation
  static constexpr double noise_ = 1.2;     ///< mean square up to which there is nothing left but noise

  const FitProblem& problem_;
  const FitProblem& glimpse_;
};

}  // namespace thermopower::gap::engine
