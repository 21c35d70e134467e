// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/data/inputs.hpp>
#include <thermopower/gap/compare/thresholds.hpp>
#include <thermopower/gap/detail/attempt.hpp>
#include <thermopower/gap/detail/posing.hpp>
#include <thermopower/gap/fit/in_parallel.hpp>
#include <thermopower/gap/compare/fit_noise.hpp>
#include <thermopower/gap/compare/score.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace thermopower::gap::engine {

/// Scores explanations as a gap is judged: free-running, in the windows of the score.
class AsJudged {
public:
  /// All of them must outlive this object.
  AsJudged(const Posing& posing, const std::vector<Inputs>& train, const std::vector<Inputs>& held_out)
      : posing_(posing),
        model_(posing.model()),
        catalogue_(posing.catalogue()),
        train_(train),
        held_out_(held_out) {}

  /// Whether an explanation lowers the error of some signal by a fifth on the data it was fitted to.
  bool lowers(const Candidate& one) const {
    const auto errors = training_errors(model_of(one));
    return std::any_of(errors.begin(), errors.end(), [](const BeforeAfter& signal) {
      return signal.after < decision.lowered_without_costly * signal.before;
    });
  }

  /// The model with its constants refitted: the best explanation by constants alone, or as configured where that
  /// scores better on the very data.
  Model recalibrate(std::vector<Candidate>& candidates, const Attribution& fine) const {
    Candidate* best = &candidates.front();
    for (Candidate& one : candidates)
      if (one.explanation.effects.empty() && fitness(one) < fitness(*best)) best = &one;
    fine.polish(*best, {});
    const Model fitted = model_of(*best);
    double worse = 0.0;
    for (const auto& [before, after] : training_errors(fitted))
      if (before > 0.0 && after > 0.0) worse += std::log(after / before);
    return worse > 0.0 ? model_ : fitted;
  }

  /// Scores the empty explanation, those by constants alone, and the best ones on held-out data. The others are out of
  /// the running.
  void judge(Attempt& attempt, const Attribution& fine) const {
    std::vector<Candidate>& candidates = attempt.candidates;
    for (Candidate& one : candidates) {
      one.held_out = {};
      one.hidden_starts = 0;
    }
    const std::vector<Segment> segments = posing_.judged(held_out_);
    const Model best = model_of(attempt.best());
    const Model& witness = follows_its_data(attempt.best()) ? best : model_;
    const Errors errors = errors_of(best, segments, catalogue_);
    const Yardstick yardstick = yardstick_of(witness, errors, segments);
    for (std::size_t i = 0; i < signal_count; ++i)
      if (!errors.of[i].empty()) attempt.weight.held_out[i] = correlation_samples(errors.of[i]);
    const std::vector<std::size_t> order = by_fitness(candidates, 0);
    std::vector<std::size_t> looked_at;
    std::size_t single = 0;
    const std::vector<std::size_t> fairly_modest = modest(candidates, model_);
    // A set that lost by far on what it was fitted to is in nobody's way.
    const double lost = Attribution::lost_from * attempt.best().train.total();
    for (std::size_t place = 0; place < order.size(); ++place) {
      const Explanation& one = candidates[order[place]].explanation;
      // Curves bend to what several causes with a name do alike: they take the place of none.
      const bool among_singles = one.size() == 1 && (one.has_curve() || single++ < 7);
      const bool is_lost = one.effects.size() > 1 && candidates[order[place]].train.total() > lost;
      const bool is_modest =
          std::find(fairly_modest.begin(), fairly_modest.end(), order[place]) != fairly_modest.end();
      if ((place < 14 && !is_lost) || among_singles || is_modest || one.effects.empty())
        looked_at.push_back(order[place]);
    }
    in_parallel(looked_at.size(), posing_.options().threads, [&](std::size_t i) {
      Candidate& one = candidates[looked_at[i]];
      const Model model = model_of(one);
      one.held_out = sums_of(model, segments, yardstick);
      fine.survey(one);
      const auto rollout = plant_of(model).rollout(model, catalogue_, {}, {}, SimulationMode::free_running);
      for (const Segment& segment : segments)
        one.hidden_starts += static_cast<int>(rollout->hidden_starts(segment).size());
    });
    refer(attempt, segments, yardstick);
  }

  /// Scores some candidates on held-out data: nothing missing, the chosen one, and the likeliest.
  void score(Attempt& attempt, std::size_t chosen) const {
    constexpr std::size_t most = 10;
    const std::vector<Segment> segments = posing_.judged(held_out_);
    const Model best = model_of(attempt.candidates[chosen]);
    const Yardstick yardstick = yardstick_of(best, errors_of(best, segments, catalogue_), segments);
    std::vector<std::size_t> order(attempt.candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    sort_by(order,
            [&](std::size_t i) { return i == 0 || i == chosen ? -2.0 : -attempt.candidates[i].probability; });
    order.resize(std::min(order.size(), most));
    in_parallel(order.size(), posing_.options().threads, [&](std::size_t i) {
      Candidate& one = attempt.candidates[order[i]];
      one.held_out = sums_of(model_of(one), segments, yardstick);
    });
    refer(attempt, segments, yardstick);
  }

  /// The evidence of held-out motion against candidates, in nats: how much worse than the best of those with a name
  /// they predict it from starts as measured. A window counts once, since its errors go together. In a closed loop
  /// a heavy axis predicts motion well, and true causes somewhat worse: that far nothing is said.
  Eigen::VectorXd lost_in_motion(const std::vector<Candidate>& candidates) const {
    constexpr double somewhat_worse = 1.5;  // times; cogging of a real motor under a stiff loop makes 1.3
    const std::vector<Segment> segments = posing_.judged(held_out_);
    Eigen::VectorXd nats(static_cast<Eigen::Index>(candidates.size()));
    in_parallel(candidates.size(), posing_.options().threads, [&](std::size_t i) {
      nats[static_cast<Eigen::Index>(i)] =
          static_cast<double>(segments.size()) * log_error(model_of(candidates[i]), segments);
    });
    double best = nats[0];
    for (std::size_t i = 1; i < candidates.size(); ++i)
      if (!candidates[i].explanation.has_curve()) best = std::min(best, nats[static_cast<Eigen::Index>(i)]);
    const double unheard = best + static_cast<double>(segments.size()) * std::log(somewhat_worse);
    return (nats.array() - unheard).max(0.0);
  }

  /// Whether a candidate predicts held-out motion so much worse than the model as configured that it closes nothing
  /// there.
  bool opens_the_gap(const Candidate& one) const {
    constexpr double times = 3.0;  // a wrist behind a torque sensor makes 2.3 with its true friction
    const std::vector<Segment> segments = posing_.judged(held_out_);
    return log_error(model_of(one), segments) > log_error(model_, segments) + std::log(times);
  }

private:
  /// RMS errors of a signal: of the model as configured, and of another one; in the signal's unit.
  struct BeforeAfter {
    double before, after;
  };

  /// Those on the training data.
  std::array<BeforeAfter, signal_count> training_errors(const Model& other) const {
    const std::vector<Segment> segments = posing_.judged(train_);
    const Errors before = errors_of(model_, segments, catalogue_),
                 after = errors_of(other, segments, catalogue_);
    std::array<BeforeAfter, signal_count> errors{};
    for (int i = 0; i < signal_count; ++i)
      errors[static_cast<std::size_t>(i)] = {before.rms(static_cast<Signal>(i)),
                                             after.rms(static_cast<Signal>(i))};
    return errors;
  }

  /// The mean over the signals of the logarithm of their RMS errors.
  double log_error(const Model& model, const std::vector<Segment>& segments) const {
    const Errors errors = errors_of(model, segments, catalogue_);
    double sum = 0.0, signals = 0.0;
    for (std::size_t k = 0; k < signal_count; ++k) {
      if (errors.of[k].empty()) continue;
      sum += std::log(std::max(errors.rms(static_cast<Signal>(k)), 1e-300));
      signals += 1.0;
    }
    return sum / std::max(signals, 1.0);
  }

  /// The noise of each signal, and the error of a perfect model; both in the signal's unit.
  struct Yardstick {
    std::array<double, signal_count> sigma, floor;
  };

  /// @param witness  follows its data  @param errors  of the best explanation
  Yardstick yardstick_of(const Model& witness, const Errors& errors,
                         const std::vector<Segment>& segments) const {
    const std::array<double, signal_count> sigma = noise_of(errors, segments, held_out_);
    const auto floor_by = [&](const Model& model) {
      return floor_of(model, errors, sigma, segments, catalogue_, FirstReadings::within_their_noise);
    };
    Yardstick yardstick{sigma, floor_by(witness)};
    // A witness that runs away somewhere, by a drag that drives, tells no floor.
    const auto is_told = [](double one) { return std::isfinite(one); };
    if (!std::all_of(yardstick.floor.begin(), yardstick.floor.end(), is_told))
      yardstick.floor = floor_by(model_);
    return yardstick;
  }

  /// The errors of a model in some segments, in units of the noise floor. Of two explanations one may fit starts
  /// that nobody measures: then both may move the measured one within its noise, or a wrong first reading speaks
  /// for hidden nodes.
  SignalSums sums_of(const Model& model, const std::vector<Segment>& segments,
                     const Yardstick& yardstick) const {
    const Errors own = errors_of(model, segments, catalogue_, &yardstick.sigma);
    SignalSums sums;
    for (std::size_t i = 0; i < signal_count; ++i)
      sums.set(i, own.of[i], std::max(yardstick.floor[i], 1e-12));
    return sums;
  }

  /// Scores what explanations are compared with: the model as configured, and with refitted constants.
  void refer(Attempt& attempt, const std::vector<Segment>& segments, const Yardstick& yardstick) const {
    attempt.reference = {sums_of(model_, segments, yardstick),
                         sums_of(attempt.recalibrated, segments, yardstick)};
  }

  Model model_of(const Candidate& one) const {
    return augmented(model_, one.explanation, one.list, one.fit.point);
  }

  const Posing& posing_;
  const Model& model_;
  const Catalogue& catalogue_;
  const std::vector<Inputs>& train_;
  const std::vector<Inputs>& held_out_;
};

}  // namespace thermopower::gap::engine
