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
    for (std::size_t i = 0; i < signal_count; ++i) result.set(i, by_signal[i], 1.0);
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
    for (std::size_t i = 0; i < candidate.list.size(); ++i)
      for (std::size_t k = 0; k < other.list.size(); ++k)
        if (candidate.list[i].name == other.list[k].name || same_parameter(candidate, i, other, k) ||
            is_where_equal(candidate, i, other, k))
          from[static_cast<Eigen::Index>(i)] = std::clamp(other.fit.point[static_cast<Eigen::Index>(k)],
                                                          candidate.list[i].lower, candidate.list[i].upper);
    // The noise may have been measured anew since the candidate was fitted: both costs are in units of the present one.
    Fitter fitter(problem_, candidate.explanation, candidate.list);
    FitOptions in_sight = options;
    in_sight.hopeless = out_of_sight * other.train.total();
    const double lost = lost_from * other.train.total();
    if (candidate.train.total() > lost &&
        (runs_away(candidate, from, starts_of(other)) || !(fitter.scan(from, starts_of(other)) <= lost)))
      return false;
    FitResult again = fitter.minimise(from, in_sight, starts_of(other));
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
                 const std::vector<Start>* starts) const {
    const double far = 1e6 * candidate.train.total();
    return problem_.squares(candidate.explanation, candidate.list, at,
                            starts != nullptr ? *starts : problem_.measured_starts(), far) > far;
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

  /// Whether two coordinates are parameters of one name in effects of one submodel.
  static bool same_parameter(const Candidate& one, std::size_t i, const Candidate& other, std::size_t k) {
    const auto submodel = [](const Candidate& of, std::size_t index) {
      const std::string& name = of.list[index].name;
      for (const CatalogueEntry* entry : of.explanation.effects)
        if (name.compare(0, entry->info.id.size() + 1, entry->info.id + ".") == 0)
          return &entry->info.submodel;
      return static_cast<const decltype(EffectInfo::submodel)*>(nullptr);
    };
    const auto bare = [](const std::string& name) { return name.substr(name.rfind('.')); };
    const auto first = submodel(one, i), second = submodel(other, k);
    return first != nullptr && second != nullptr && *first == *second &&
           bare(one.list[i].name) == bare(other.list[k].name) &&
           one.list[i].logarithmic == other.list[k].logarithmic;
  }

  /// Whether a coordinate is the first parameter of what another one's effect is where two of its own are equal: the friction that
  /// one by direction is.
  static bool is_where_equal(const Candidate& one, std::size_t i, const Candidate& other, std::size_t k) {
    for (const CatalogueEntry* rich : other.explanation.effects)
      for (const CatalogueEntry* plain : one.explanation.effects)
        if (rich->info.where_equal && rich->info.where_equal->cause == plain->info.id &&
            one.list[i].name == plain->info.id + "." + plain->info.parameters.front().name &&
            other.list[k].name ==
                rich->info.id + "." +
                    rich->info.parameters[static_cast<std::size_t>(rich->info.where_equal->one)].name)
          return true;
    return false;
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

  std::vector<Eigen::VectorXd> start_points(const Explanation& explanation, const Candidate* near) const {
    const Candidate candidate = unfitted(explanation);
    Eigen::VectorXd base(static_cast<Eigen::Index>(candidate.list.size()));
    for (std::size_t i = 0; i < candidate.list.size(); ++i) {
      const Coordinate& one = candidate.list[i];
      double value = one.start;
      if (near != nullptr)
        for (std::size_t k = 0; k < near->list.size(); ++k)
          if (near->list[k].name == one.name) value = near->fit.point[static_cast<Eigen::Index>(k)];
      base[static_cast<Eigen::Index>(i)] = std::clamp(value, one.lower, one.upper);
    }
    std::vector<Eigen::VectorXd> points{base};
    Eigen::Index index = static_cast<Eigen::Index>(problem_.model->calibrated().size());
    for (const CatalogueEntry* entry : candidate.explanation.effects) {
      const bool known =
          near != nullptr && std::find(near->explanation.effects.begin(), near->explanation.effects.end(),
                                       entry) != near->explanation.effects.end();
      for (const Parameter& parameter : entry->info.parameters) {
        if (!known)
          points = spread(points, index, parameter, candidate.list[static_cast<std::size_t>(index)]);
        ++index;
      }
    }
    return points;
  }

  std::vector<Eigen::VectorXd> spread(const std::vector<Eigen::VectorXd>& points, Eigen::Index index,
                                      const Parameter& parameter, const Coordinate& coordinate) const {
    std::vector<Eigen::VectorXd> wider;
    for (const Eigen::VectorXd& point : points)
      for (double start : parameter.starts) {
        Eigen::VectorXd one = point;
        if (parameter.starts_relative_to != Input::none) start *= scale_of(parameter.starts_relative_to);
        one[index] = std::clamp(coordinate.coordinate_of(start), coordinate.lower, coordinate.upper);
        wider.push_back(one);
      }
    return wider;
  }

  /// Largest magnitude of an input over the data of the fit.
  double scale_of(Input input) const {
    double largest = 0.0;
    for (const Segment& segment : problem_.segments) {
      const Inputs& inputs = *segment.inputs;
      const Eigen::VectorXd* values = input == Input::drive_A       ? &inputs.drive_A
                                      : input == Input::power_param ? &inputs.power_param
                                      : input == Input::supply_V    ? &inputs.supply_V
                                                                    : nullptr;
      double per_unit = 1.0;
      if (input == Input::drive_A && inputs.closed_loop) values = &inputs.servo_A;
      else if (input == Input::drive_A && problem_.model->axis && problem_.model->axis->voltage_driven()) {
        values = &inputs.voltage_V;  // as a current at standstill
        per_unit = 1.0 / problem_.model->axis->resistance_ohm;
      }
      if (values != nullptr && values->size() > 0)
        largest = std::max(
            largest,
            per_unit * values->segment(segment.begin, segment.end - segment.begin).cwiseAbs().maxCoeff());
    }
    return largest > 0.0 ? largest : 1.0;
  }

  static constexpr std::size_t tried_ = 5;  ///< of the starts of an explanation
  static constexpr double noise_ = 1.2;     ///< mean square up to which there is nothing left but noise

  const FitProblem& problem_;
  const FitProblem& glimpse_;
};

}  // namespace thermopower::gap::engine
