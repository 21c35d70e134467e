// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/limits.hpp>
#include <thermopower/design/needs.hpp>
#include <thermopower/design/outcome.hpp>
#include <thermopower/design/remaining.hpp>
#include <thermopower/design/search.hpp>
#include <thermopower/design/words.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::design {

/// What a design may be told.
struct DesignOptions {
  SearchSettings search = {};  ///< how much is tried
  double sure = 0.95;          ///< probability from which on an explanation is sure enough, 0.5..1
  double worth_doing = 0.75;   ///< an experiment is proposed where it is expected to be right so often, 0..1
  unsigned seed = 1;           ///< the same seed gives the same design
};

/// Designs the experiment that best tells apart what a diagnosis leaves open.
///
/// Explanations that nothing within the limits tells apart are put into one class first. Then shapes from a library (steps, reversals,
/// chirps, holds, rests, hot starts) are timed and sized so that the expected share of right answers is largest, and the experiment
/// short. Every limit holds for every explanation with the parameters that the recordings leave possible.
/// @throws InvalidInput where a limit is invalid, or an input lacks that the model needs
inline Design design_experiment(const DiagnosedGap& gap, const Limits& limits,
                                const DesignOptions& options = {},
                                const Catalogue& given = standard_catalogue());

namespace detail {

/// One design under way.
class Designer {
public:
  Designer(const DiagnosedGap& gap, const Limits& limits, const DesignOptions& options,
           const Catalogue& catalogue)
      : gap_(gap), limits_(limits), options_(options), catalogue_(catalogue) {}

  Design run() {
    for (StillOpen& one : still_open(gap_, catalogue_)) {
      has_tie_ = has_tie_ || one.tied;
      explanations_.push_back(std::move(one.explanation));
    }
    if (explanations_.empty())
      throw InvalidInput("the report has no explanation with its numbers: diagnose again");
    weights_ = weights_of(explanations_);
    if (is_over()) return std::move(result_);
    const Predictor predictor(gap_.model, catalogue_, limits_, gap_.watched, gap_.horizon_s);
    Search search(predictor, explanations_, limits_, options_.search, options_.seed);
    const double rows = options_.search.rows;
    search.screen(options_.search.screening * rows);
    if (search.tried().empty()) return nothing_possible(search);
    result_.best_apart = search.best_apart().maxCoeff();
    std::vector<std::size_t> label = classes_of(search.best_apart());
    std::optional<Tried> best;
    if (count_of(label) == 1) {
      // Causes that these limits hide from each other are not an answer; those that nothing tells apart are one.
      write_classes(label);
      result_.expected_right = *std::max_element(weights_.begin(), weights_.end());
      const std::optional<RaisedLimit> helpful = helpful_limit(search);
      return helpful || result_.classes.front().probability < options_.sure ? cannot_decide(helpful)
                                                                            : enough();
    }
    if (count_of(label) > 1) {
      best = search.improve((1.0 - options_.search.screening) * rows, weights_, label);
      if (best) best = search.made_safe(std::move(*best));
      result_.best_apart = search.best_apart().maxCoeff();
    }
    result_.experiments_tried = search.tried().size();
    write_classes(label);
    result_.expected_right = best ? expected_right(best->apart, weights_, label)
                                  : *std::max_element(weights_.begin(), weights_.end());
    if (!best || result_.expected_right < options_.worth_doing) return cannot_decide(helpful_limit(search));
    propose(*best, predictor, label);
    return std::move(result_);
  }

private:
  static std::size_t count_of(const std::vector<std::size_t>& label) {
    assert(!label.empty());
    return 1 + *std::max_element(label.begin(), label.end());
  }

  /// Whether the report leaves nothing to tell apart.
  bool is_over() {
    const Possible& first = explanations_.front();
    for (const Possible& one : explanations_)
      result_.classes.push_back({{one.effects()}, one.probability(), {}});
    if (gap_.verdict == Verdict::no_gap ||
        (is_sure() && first.effects().empty() && gap_.verdict != Verdict::unexplained)) {
      result_.ending = Ending::enough;
      result_.sentence = "Enough: nothing is missing.";
    } else if (gap_.verdict == Verdict::unexplained || (is_sure() && first.is_curve())) {
      result_.ending = Ending::none_of_these;
      result_.sentence = "None of these is still the likeliest: no named cause closes the gap" +
                         (first.is_curve() ? "; " + first.name() + " has " + two_digits(first.probability())
                                           : std::string()) +
                         ". Record what nobody has recorded yet, or add an effect of your own.";
    } else if (is_sure() && !has_tie_) {
      enough();
    } else {
      result_.classes.clear();
      return false;
    }
    result_.expected_right = first.probability();
    return true;
  }

  bool is_sure() const { return explanations_.front().probability() >= options_.sure; }

  Design enough() {
    result_.ending = Ending::enough;
    const ExplanationClass& first = result_.classes.front();
    result_.expected_right = first.probability;
    result_.sentence =
        "Enough: " + first.name() + " has " + two_digits(first.probability) +
        (first.members.size() > 1 ? "; no experiment near these limits tells its members apart." : ".");
    return result_;
  }

  void write_classes(const std::vector<std::size_t>& label) {
    result_.classes.assign(count_of(label), {});
    for (std::size_t i = 0; i < label.size(); ++i) {
      result_.classes[label[i]].members.push_back(explanations_[i].effects());
      result_.classes[label[i]].probability += explanations_[i].probability();
    }
  }

  Design nothing_possible(const Search& search) {
    result_.ending = Ending::nothing_possible;
    const std::string limit = search.stopped_by().empty() ? std::string() : search.stopped_by().front().first;
    result_.sentence = "No experiment keeps these limits for every explanation that is still possible" +
                       (limit.empty() ? "." : "; the limit that stops most of them is " + limit + ".");
    result_.limit_to_raise = limit;
    return std::move(result_);
  }

  /// The first limit that alone, raised, lets an experiment decide.
  std::optional<RaisedLimit> helpful_limit(const Search& search) const {
    constexpr double share_of_rows = 0.1;
    std::vector<RaisedLimit> all = raised_limits(limits_);
    for (RaisedLimit& raised : all) {
      const Predictor predictor(gap_.model, catalogue_, raised.limits, gap_.watched, gap_.horizon_s);
      Search again(predictor, explanations_, raised.limits, options_.search, options_.seed);
      for (std::size_t i = 0; i < std::min<std::size_t>(search.tried().size(), 2); ++i)
        again.add(search.tried()[i].experiment);
      again.screen(share_of_rows * options_.search.rows);
      if (again.tried().empty()) continue;
      const std::vector<std::size_t> label = classes_of(again.best_apart());
      const double right = expected_right(again.best_apart(), weights_, label);
      if (count_of(label) > 1 && right >= options_.worth_doing && right > result_.expected_right)
        return std::move(raised);
    }
    return std::nullopt;
  }

  Design cannot_decide(const std::optional<RaisedLimit>& helpful) {
    result_.ending = Ending::cannot_decide;
    result_.expected_right =
        std::max(result_.expected_right, *std::max_element(weights_.begin(), weights_.end()));
    result_.sentence = "No experiment within these limits can decide between " + words_of_classes() +
                       ": the best one that was found is expected to be right in " +
                       percent(result_.expected_right) + " of all cases";
    if (!helpful) {
      result_.sentence += "; raising one limit alone to four times does not help.";
      return std::move(result_);
    }
    const bool lowered =
        helpful->field.size() > 5 && helpful->field.compare(helpful->field.size() - 5, 5, ".from") == 0;
    result_.limit_to_raise = helpful->field;
    result_.raise_to = helpful->to;
    result_.sentence += std::string(lowered ? "; lower" : "; raise") + " the limit of " + helpful->field +
                        " to " + Limits::text_of(helpful->to) + ".";
    return std::move(result_);
  }

  std::string words_of_classes() const {
    std::vector<std::string> names;
    for (const Possible& one : explanations_)
      if (names.size() < 3) names.push_back(one.name());
    return in_a_row(names);
  }

  void propose(const Tried& best, const Predictor& predictor, const std::vector<std::size_t>& label) {
    result_.ending = Ending::schedule;
    result_.schedule = best.schedule;
    constexpr int draws = 20;
    for (std::size_t k = 0; k < result_.classes.size(); ++k) {
      const std::size_t member =
          static_cast<std::size_t>(std::find(label.begin(), label.end(), k) - label.begin());
      assert(member < explanations_.size());
      const Possible& one = explanations_[member];
      std::vector<Motion> drawn;
      Random random(options_.seed + 17u);
      for (int i = 0; i < draws; ++i) drawn.push_back(predictor.free_run(best.schedule, one.draw(random)));
      const Motion middle = predictor.free_run(best.schedule, one.fit());
      for (const Watched& watched : predictor.watched()) {
        const auto at = static_cast<std::size_t>(watched.signal);
        if (middle[at].size() == 0) continue;
        assert(std::all_of(drawn.begin(), drawn.end(),
                           [&](const Motion& each) { return each[at].size() == middle[at].size(); }));
        PredictedSignal signal{watched.signal, middle[at], middle[at], middle[at]};
        for (Eigen::Index row = 0; row < middle[at].size(); ++row) {
          std::vector<double> values;
          for (const Motion& motion : drawn) values.push_back(motion[at][row]);
          std::sort(values.begin(), values.end());
          signal.low[row] = std::min(values[1], middle[at][row]);
          signal.high[row] = std::max(values[draws - 2], middle[at][row]);
        }
        result_.classes[k].predicted.push_back(std::move(signal));
      }
    }
    std::sort(result_.classes.begin(), result_.classes.end(),
              [](const ExplanationClass& one, const ExplanationClass& other) {
                return one.probability > other.probability;
              });
    std::vector<std::string> names;
    for (const ExplanationClass& one : result_.classes) names.push_back(one.name());
    result_.sentence = "Play this schedule (" + Limits::text_of(best.duration_s) +
                       " s): it is expected to tell " + in_a_row(names) + " apart in " +
                       percent(result_.expected_right) + " of all cases.";
  }

  const DiagnosedGap& gap_;
  const Limits& limits_;
  const DesignOptions options_;
  const Catalogue& catalogue_;
  Design result_;
  std::vector<Possible> explanations_;
  std::vector<double> weights_;
  bool has_tie_ = false;  ///< an explanation predicts as well as the likeliest one
};

}  // namespace detail

inline Design design_experiment(const DiagnosedGap& gap, const Limits& limits, const DesignOptions& options,
                                const Catalogue& given) {
  if (const auto problem = limits.validate()) throw InvalidInput("limits: " + *problem);
  if (const auto problem = gap.model.validate())
    throw InvalidInput("model '" + gap.model.name + "': " + *problem);
  if (const auto problem = lacking_for(gap, limits)) throw InvalidInput("limits: " + *problem);
  if (gap.verdict == Verdict::insufficient)
    throw InvalidInput(
        "the diagnosis had too little data to leave explanations; record what it asks for first");
  return detail::Designer(gap, limits, options, catalogue_of(gap.model, given)).run();
}

}  // namespace thermopower::design
