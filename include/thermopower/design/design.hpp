// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/diagnosed.hpp>
#include <thermopower/design/limits.hpp>
#include <thermopower/design/options.hpp>
#include <thermopower/design/outcome.hpp>
#include <thermopower/design/search.hpp>
#include <thermopower/plant/standard_catalogue.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::design {

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
      : gap_(gap),
        limits_(limits),
        options_(options),
        catalogue_(catalogue),
        explanations_(still_open(gap, catalogue, options)) {}

  Design run() {
    if (explanations_.empty())
      throw InvalidInput("the report has no explanation with its numbers: diagnose again");
    if (is_over()) return result_;
    const Predictor predictor(gap_, catalogue_, limits_);
    leave_out_those_without_inputs(predictor);
    const std::vector<double> weights = weights_of(explanations_, options_);
    Search search(predictor, explanations_, limits_, options_);
    search.screen(options_.screening * options_.rows);
    if (search.tried().empty()) return nothing_possible(search.stopped_by());
    const Classes classes(weights, search.best_apart());
    for (std::size_t i = 0; i < explanations_.size(); ++i) {
      result_.classes.resize(classes.count);
      result_.classes[classes.label[i]].members.push_back(explanations_[i].effects());
      result_.classes[classes.label[i]].probability += explanations_[i].probability();
    }
    result_.expected_right = *std::max_element(weights.begin(), weights.end());
    // Causes that these limits hide from each other are not an answer; those that nothing tells apart are one.
    if (classes.count == 1) {
      const std::optional<RaisedLimit> helpful = helpful_limit(search, weights);
      const bool is_sure =
          result_.classes.front().probability >= options_.sure && gap_.times_noise() <= options_.much_left;
      return helpful || !is_sure ? cannot_decide(helpful) : enough();
    }
    std::optional<Tried> best = search.improve((1.0 - options_.screening) * options_.rows, classes);
    if (best) best = search.made_safe(best->experiment);
    if (best) result_.expected_right = classes.expected_right(best->apart);
    if (!best || result_.expected_right < options_.worth_doing)
      return cannot_decide(helpful_limit(search, weights));
    return propose(*best, predictor, classes);
  }

private:
  /// The limits give no value to an input of theirs: the experiment says nothing of them. The sentence names the likely ones.
  void leave_out_those_without_inputs(const Predictor& predictor) {
    const auto end = std::stable_partition(explanations_.begin(), explanations_.end(),
                                           [&](const Possible& one) { return predictor.has_inputs_of(one); });
    std::vector<std::string> names;
    for (auto one = end; one != explanations_.end(); ++one)
      if (one->probability() >= options_.likely) names.push_back(name_of(one->effects()));
    if (!names.empty())
      left_out_ = " Left out, because the limits give no value to an input of it: " + in_a_row(names) + ".";
    if (end != explanations_.begin()) explanations_.erase(end, explanations_.end());
  }

  /// Whether the report leaves nothing to tell apart.
  bool is_over() {
    const Possible& first = explanations_.front();
    const bool is_sure = first.probability() >= options_.sure && gap_.verdict != Verdict::ambiguous;
    // A report may call a gap unexplained over a small rest, and name a sure cause of a small part.
    const bool is_unexplained =
        is_sure ? gap_.times_noise() > options_.much_left : gap_.verdict == Verdict::unexplained;
    const auto is_tied = [](const Possible& one) { return one.is_tied; };
    if (gap_.verdict == Verdict::no_gap || (is_sure && first.effects().empty() && !is_unexplained)) {
      end(Ending::enough, "Enough: nothing is missing.");
    } else if (is_unexplained || (is_sure && first.is_curve())) {
      end(Ending::none_of_these, "None of these is still the likeliest: no named cause closes the gap; " +
                                     name_of(first.effects()) + " has " + two_digits(first.probability()) +
                                     rest() + ". " + advice);
    } else if (is_sure && std::none_of(explanations_.begin(), explanations_.end(), is_tied)) {
      end(Ending::enough,
          "Enough: " + name_of(first.effects()) + " has " + two_digits(first.probability()) + rest() + ".");
    } else {
      return false;
    }
    for (const Possible& one : explanations_)
      result_.classes.push_back({{one.effects()}, one.probability(), {}});
    result_.expected_right = first.probability();
    return true;
  }

  /// What a sure explanation leaves, where that is more than noise.
  std::string rest() const {
    constexpr double hardly = 1.5;
    if (gap_.times_noise() < hardly) return {};
    char text[64];
    std::snprintf(text, sizeof text, "; it leaves %.1f times the noise", gap_.times_noise());
    return text;
  }

  Design& end(Ending ending, const std::string& sentence) {
    result_.ending = ending;
    result_.sentence = sentence + left_out_;
    return result_;
  }

  Design enough() {
    const ExplanationClass& first = result_.classes.front();
    result_.expected_right = first.probability;
    return end(Ending::enough, "Enough: " + first.name() + " has " + two_digits(first.probability) +
                                   "; no experiment near these limits tells its members apart.");
  }

  Design nothing_possible(const std::string& limit) {
    result_.limit_to_raise = limit;
    return end(Ending::nothing_possible,
               "No experiment keeps these limits for every explanation that is still possible" +
                   (limit.empty() ? "." : "; the limit that stops most of them is " + limit + "."));
  }

  /// The first limit that alone, raised, lets an experiment decide.
  std::optional<RaisedLimit> helpful_limit(const Search& search, const std::vector<double>& weights) const {
    for (RaisedLimit& raised : raised_limits(limits_)) {
      const Predictor predictor(gap_, catalogue_, raised.limits);
      Search again(predictor, explanations_, raised.limits, options_);
      for (std::size_t i = 0; i < std::min<std::size_t>(search.tried().size(), 2); ++i)
        again.add(search.tried()[i].experiment);
      again.screen(options_.raising * options_.rows);
      const Classes classes(weights, again.best_apart());
      const double right = classes.expected_right(again.best_apart());
      if (classes.count > 1 && right >= options_.worth_doing && right > result_.expected_right)
        return std::move(raised);
    }
    return std::nullopt;
  }

  Design cannot_decide(const std::optional<RaisedLimit>& helpful) {
    std::vector<std::string> names;
    for (const Possible& one : explanations_)
      if (names.size() < 3) names.push_back(name_of(one.effects()));
    if (gap_.times_noise() > options_.much_left)
      return end(Ending::none_of_these, "None of these is still the likeliest: " + names.front() +
                                            " leaves " + Limits::text_of(std::round(gap_.times_noise())) +
                                            " times the noise, and no experiment within these limits tells " +
                                            in_a_row(names) + " apart against that. " + advice);
    std::string sentence = "No experiment within these limits can decide between " + in_a_row(names) +
                           ": the best one that was found is expected to be right in " + per_cent() +
                           " of all cases";
    if (!helpful)
      return end(Ending::cannot_decide, sentence + "; raising one limit alone to four times does not help.");
    const VariedInput* input = nullptr;
    for (const VariedInput& one : limits_.vary)
      if (helpful->field == "vary." + one.column + ".from") input = &one;
    result_.limit_to_raise = helpful->field;
    result_.raise_to = helpful->to;
    return end(Ending::cannot_decide, sentence + (input != nullptr ? "; lower" : "; raise") +
                                          " the limit of " + helpful->field + " to " +
                                          Limits::text_of(helpful->to) + ".");
  }

  Design propose(const Tried& best, const Predictor& predictor, const Classes& classes) {
    result_.schedule = best.schedule;
    for (std::size_t k = 0; k < classes.count; ++k) {
      const auto member = std::find(classes.label.begin(), classes.label.end(), k) - classes.label.begin();
      result_.classes[k].predicted =
          predicted(best.schedule, predictor, explanations_[static_cast<std::size_t>(member)]);
    }
    std::stable_sort(result_.classes.begin(), result_.classes.end(),
                     [](const ExplanationClass& one, const ExplanationClass& other) {
                       return one.probability > other.probability;
                     });
    std::vector<std::string> names;
    for (const ExplanationClass& one : result_.classes) names.push_back(one.name());
    return end(Ending::schedule, "Play this schedule (" + Limits::text_of(best.duration_s()) +
                                     " s): it is expected to tell " + in_a_row(names) + " apart in " +
                                     per_cent() + " of all cases.");
  }

  /// Of each watched signal the range of nine in ten draws, and the fit.
  std::vector<PredictedSignal> predicted(const Recording& schedule, const Predictor& predictor,
                                         const Possible& one) const {
    constexpr std::size_t draws = 20, outside = 1;
    Random random(options_.seed + 17u);
    const Motion middle = predictor.free_run(schedule, one.fit());
    std::vector<Motion> drawn;
    for (std::size_t i = 0; i < draws; ++i) drawn.push_back(predictor.free_run(schedule, one.draw(random)));
    std::vector<PredictedSignal> all;
    for (const Watched& watched : gap_.watched) {
      const auto at = static_cast<std::size_t>(watched.signal);
      if (middle[at].size() == 0) continue;
      PredictedSignal signal{watched.signal, middle[at], middle[at], middle[at]};
      for (Eigen::Index row = 0; row < middle[at].size(); ++row) {
        std::vector<double> values;
        for (const Motion& motion : drawn) values.push_back(motion[at][row]);
        std::sort(values.begin(), values.end());
        signal.low[row] = std::min(values[outside], middle[at][row]);
        signal.high[row] = std::max(values[draws - 1 - outside], middle[at][row]);
      }
      all.push_back(std::move(signal));
    }
    return all;
  }

  /// The expected share of right answers in per cent; 100 is never claimed.
  std::string per_cent() const {
    return std::to_string(std::lround(std::min(100.0 * result_.expected_right, 99.0))) + " %";
  }

  static constexpr const char* advice = "Record what nobody has recorded yet, or add an effect of your own.";

  const DiagnosedGap& gap_;
  const Limits& limits_;
  const DesignOptions options_;
  const Catalogue& catalogue_;
  std::vector<Possible> explanations_;
  std::string left_out_;
  Design result_;
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
