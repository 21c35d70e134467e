// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <thermopower/gap/observe/prepared_recording.hpp>
#include <thermopower/plant/catalogue.hpp>

#include <vector>

/// @file check.hpp
/// The first stage of a diagnosis: from recordings as they were given to recordings that can be judged.

namespace thermopower::gap::engine {

/// The recordings of a diagnosis, prepared, and everything the check has to say about them.
struct CheckedRecordings {
  std::vector<PreparedRecording> train;     ///< to find and to fit
  std::vector<PreparedRecording> held_out;  ///< to judge on
  std::vector<Finding> findings;            ///< those that decide first, then recording by recording

  /// All recordings, those in training first.
  std::vector<PreparedRecording*> all() {
    std::vector<PreparedRecording*> list;
    for (std::vector<PreparedRecording>* const part : {&train, &held_out})
      for (PreparedRecording& one : *part) list.push_back(&one);
    return list;
  }
};

/// How to check.
struct CheckOptions {
  double horizon_s = 0.5;    ///< length of the axis' windows in s
  bool as_recorded = false;  ///< report faults, but mask and cut nothing
};

/// Checks and prepares all recordings of a diagnosis. Each is let go of as soon as it is prepared: they may be long.
/// @param held_out  may be empty where only the data are looked at
/// @throws InvalidInput where a recording is invalid
CheckedRecordings check(const Model& model, std::vector<Recording> train, std::vector<Recording> held_out,
                        const CheckOptions& options, const Catalogue& catalogue);

}  // namespace thermopower::gap::engine

#ifndef THERMOPOWER_GAP_LIBRARY
#include <thermopower/gap/detail/check.hpp>
#endif
