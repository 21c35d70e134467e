// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include "residual_statistics.hpp"

#include <thermopower/gap/diagnosis.hpp>
#include <thermopower/gap/recording.hpp>
#include <thermopower/io/names.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thermopower::io {

/// @brief One run of held-out data: rows [begin, end) of the series of a recording.
struct HeldOutRun {
  std::string recording;                     ///< its name
  std::string label;                         ///< of the run, may be empty
  std::size_t number = 0;                    ///< of the run in its recording, from 0
  std::size_t of = 1;                        ///< runs in its recording
  Eigen::Index begin = 0;                    ///< first row
  Eigen::Index end = 0;                      ///< one past the last row
  const Recording* recorded = nullptr;       ///< for inputs; nullptr where it was not given
  std::vector<const SignalSeries*> signals;  ///< judged in it

  /// The series of a signal, or nullptr.
  const SignalSeries* of_signal(const plant::SignalName& signal) const {
    for (const SignalSeries* one : signals)
      if (one->signal == signal) return one;
    return nullptr;
  }
};

/// @brief The runs of the held-out data in their order. Recordings tell their labels; where they are not given, a
/// run begins where the stamps fall.
std::vector<HeldOutRun> held_out_runs(const Diagnosis& diagnosis, const std::vector<Recording>& held_out);

/// @brief RMS of a simulated signal against the measured one over a run; NaN without samples.
double rms_of(const HeldOutRun& run, const SignalSeries& series, const Eigen::VectorXd& simulated);

/// @brief The eight windows on end in which the simulation as configured is worst; none where a run is little longer.
std::optional<std::pair<double, double>> worst_stretch(const HeldOutRun& run, const SignalSeries& series,
                                                       double horizon_s);

/// @brief Errors of a signal over all runs, one after another.
/// @param augmented  with the causes, else as configured
RunErrors errors_of(const std::vector<HeldOutRun>& runs, const plant::SignalName& signal, bool augmented);

/// @brief A recorded input over a run.
struct RunInput {
  std::string column;          ///< its name
  std::vector<double> t_s;     ///< stamps
  std::vector<double> values;  ///< NaN where missing
};

/// @brief The inputs of a run worth a picture, at most four: what drives it, and supply, air and wind where they vary.
std::vector<RunInput> inputs_of(const HeldOutRun& run);

}  // namespace thermopower::io
