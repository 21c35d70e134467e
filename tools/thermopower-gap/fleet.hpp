// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "program.hpp"

#include <functional>
#include <string>
#include <vector>

/// One log of a fleet, as a diagnosis is asked for it: paths, empty where there is none.
struct FleetDiagnosis {
  std::string model;      ///< the simulation under test
  std::string recording;  ///< the log
  std::string held_out;   ///< a recording to judge on
  std::string map;        ///< which column is which
  std::string report;     ///< where the report goes
  std::string page;       ///< where its page goes
};

/// What `thermopower-gap fleet` is asked for.
struct FleetArguments {
  std::string
      manifest;  ///< table of logs (CSV): `log`, `model`, and where they are there `unit`, `time`, `heldout`,
                 ///< `map`
  std::string out;                   ///< folder of the results
  unsigned workers = 0;              ///< processes at a time; 0: one per core
  bool pages = true;                 ///< a page for each log, too
  std::vector<std::string> options;  ///< what else the reports depend on, as text
  /// Diagnoses a log on one thread and writes what is asked for; must not throw. @return what is wrong; empty where all
  /// was written
  std::function<std::string(const FleetDiagnosis&)> diagnose;
  bool quiet = false;  ///< prints nothing on any stream
  std::function<bool()>
      stop;  ///< asked ten times a second; true ends the fleet, whose reports so far stay. May be empty
};

/// What run_fleet() throws where `stop` said so.
struct FleetStopped {};

/// @brief A diagnosis of one log of a fleet, for FleetArguments::diagnose. @param asked  the options of every log @return what is wrong
std::string diagnose_of_fleet(const FleetDiagnosis& one, const Arguments& asked);

/// @brief The options of every diagnosis as text, for FleetArguments::options. @param horizon  whether it was asked for
std::vector<std::string> options_of_fleet(const Arguments& each, bool horizon);

/// @brief Diagnoses every log of a manifest, in processes that take one log after the other, largest first, writes one report per log, and
/// what all of them say together. Reports that are there are kept, so that the same command resumes; several of the same
/// command, on one machine or on many with one file system, share the work.
/// @return exit status of the program: 0, or 3 where some log has no report
int run_fleet(const FleetArguments& arguments);
