// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/design/words.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/plant/signal.hpp>

#include <Eigen/Core>

#include <cstddef>
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

  /// Its name in a sentence.
  std::string name() const { return words_of(members); }
};

/// The next experiment.
struct Design {
  Ending ending = Ending::nothing_possible;  ///< how it ended
  std::string sentence;                      ///< the same in words, with numbers
  Recording schedule;                        ///< only of Ending::schedule
  std::vector<ExplanationClass> classes;     ///< likeliest first
  double expected_right =
      0.0;  ///< probability that the likeliest class after the experiment is the true one, 0..1
  double best_apart =
      0.0;  ///< the largest separation of two explanations that was reached, in standard deviations
  std::string limit_to_raise;         ///< field of the limits; empty where none helps or none is needed
  double raise_to = 0.0;              ///< to what, in its unit
  std::size_t experiments_tried = 0;  ///< that the search simulated
};

}  // namespace thermopower::design
