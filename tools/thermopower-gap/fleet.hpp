// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include <string>
#include <vector>

/// What `thermopower-gap fleet` is asked for.
struct FleetArguments {
  std::string
      manifest;  ///< table of logs (CSV): `log`, `model`, and where they are there `unit`, `time`, `heldout`,
                 ///< `map`
  std::string out;                   ///< folder of the results
  unsigned workers = 0;              ///< processes at a time; 0: one per core
  bool pages = true;                 ///< a page for each log, too
  std::vector<std::string> options;  ///< handed to each diagnosis as they are
};

/// @brief Diagnoses every log of a manifest, each in a process of its own, largest first, writes one report per log, and
/// what all of them say together. Reports that are there are kept, so that the same command resumes; several of the same
/// command, on one machine or on many with one file system, share the work.
/// @return exit status of the program: 0, or 3 where some log has no report
int run_fleet(const FleetArguments& arguments);
