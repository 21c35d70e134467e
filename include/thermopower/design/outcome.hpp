// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/signal.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace thermopower::design {

using namespace gap;  // NOLINT: what a user of a design names comes from the diagnosis, too

/// How a design ends.
enum class Ending {
  schedule,          ///< an experiment is proposed
  enough,            ///< one explanation is sure enough: no experiment is needed
  none_of_these,     ///< a cause that nobody has named is sure enough, or no explanation closes the gap
  cannot_decide,     ///< no experiment within the limits tells the explanations apart
  nothing_possible,  ///< no experiment keeps the limits at all
};

/// As files have it.
inline const char* to_string(Ending ending) {
  constexpr const char* names[] = {"schedule", "enough", "none_of_these", "cannot_decide",
                                   "nothing_possible"};
  return names[static_cast<int>(ending)];
}

/// Names in a row: `a, b and c`. @param last  between the last two
inline std::string in_a_row(const std::vector<std::string>& names, const std::string& between = ", ",
                            const std::string& last = " and ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? between : last) + names[i];
  return text;
}

/// An explanation in words. @param effects  ids of its causes
inline std::string name_of(const std::vector<std::string>& effects) {
  return effects.empty() ? "nothing is missing" : in_a_row(effects, " with ", " with ");
}

/// A probability with two digits; 1 is never claimed.
inline std::string two_digits(double probability) {
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", std::min(probability, 0.99));
  return text;
}

/// What a class of explanations predicts of one signal.
struct PredictedSignal {
  Signal signal = Signal::motor_C;  ///< that is predicted
  Eigen::VectorXd middle;  ///< at the fit of the likeliest member, a value for each row of the schedule
  Eigen::VectorXd low;     ///< where the range begins in which nine of ten draws of its parameters lie
  Eigen::VectorXd high;    ///< where that range ends
};

/// Explanations that no experiment within the limits tells apart.
///
/// How to: @ref design_the_next_experiment.
struct ExplanationClass {
  std::vector<std::vector<std::string>> members;  ///< ids of each; an empty one: nothing is missing
  double probability = 0.0;                       ///< of all of them, as the report has it
  std::vector<PredictedSignal> predicted;  ///< of the proposed experiment, one for each recorded signal

  /// Its name in a sentence: the first members, and how many others look alike.
  std::string name() const {
    constexpr std::size_t shown = 2;
    std::vector<std::string> names;
    for (const std::vector<std::string>& ids : members) names.push_back(name_of(ids));
    if (names.size() > shown + 1) {
      names.resize(shown);
      names.push_back(std::to_string(members.size() - shown) + " others");
    }
    return in_a_row(names, " or ", " or ");
  }
};

/// The next experiment.
struct Design {
  Ending ending = Ending::nothing_possible;  ///< how it ended
  std::string sentence;                      ///< the same in words, with numbers
  Recording schedule;                        ///< only of Ending::schedule
  std::vector<ExplanationClass> classes;     ///< likeliest first
  double expected_right =
      0.0;  ///< probability that the likeliest class after the experiment is the true one, 0..1
  std::string limit_to_raise;  ///< field of the limits; empty where none helps or none is needed
  double raise_to = 0.0;       ///< to what, in its unit
};

}  // namespace thermopower::design
