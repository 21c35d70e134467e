// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#pragma once

#include "manifest.hpp"

#include <thermopower/gap/pool/fleet.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

/// The verdict as a report spells it; empty where there is none.
inline std::string spelt(const std::optional<thermopower::gap::Verdict>& verdict) {
  return verdict ? to_string(*verdict) : std::string();
}

/// A log of a fleet, and what came of it.
struct FleetLog {
  const ManifestLog* manifest = nullptr;  ///< its row
  std::string report;                     ///< path of its report (JSON); empty where it has none
  std::string page;   ///< of its page, from the fleet's folder on; empty where it has none
  std::string fault;  ///< why there is no report
};

/// A fleet with everything that was found, as the files about it need it.
struct FleetResults {
  const std::vector<FleetLog>& logs;                       ///< as in the manifest
  std::vector<thermopower::gap::pool::LogResult> results;  ///< of each
  std::vector<std::vector<std::string>> causes;            ///< that each log's diagnosis names
  std::vector<double> probability;                         ///< of the first of them; NaN without
  thermopower::gap::pool::FleetVerdict verdict;            ///< of all together
};

/// Reads the reports, judges the fleet, and writes `logs.csv`, `units.csv`, `fleet.json`, `fleet.html`, `summary.txt` and,
/// where SQLite is there, `fleet.sqlite` into a folder: all of them appear, or none. They depend on nothing but the
/// reports and the manifest. A report that cannot be read becomes a `fault` of its log.
/// @return how many logs have no report
std::size_t write_fleet_results(std::vector<FleetLog>& logs, const std::string& folder);

/// The fleet as one HTML page that loads nothing.
std::string fleet_page(const FleetResults& fleet);

/// The fleet for machines.
std::string fleet_json(const FleetResults& fleet);

/// The fleet in some lines of text.
std::string fleet_summary(const FleetResults& fleet);

/// The bytes of an SQLite database of the fleet; empty where the program was built without SQLite.
std::string fleet_database(const FleetResults& fleet, const std::string& folder);

/// A day since 1970-01-01 as a date, or as a number of days where no log is from such a date; empty for NaN.
std::string date_of(double days);

/// Why no unit's drift is judged; empty where drifts are. A drift needs four dated logs of a unit, and what logs differ by
/// without one is told by other units.
std::string drift_not_judged(const FleetResults& fleet);

/// A coordinate's name as a parameter's: `resistance` for `calibration.resistance`, the effect's own otherwise.
std::string parameter_name(const std::string& coordinate);

/// The value of a coordinate: its exponential where it is a logarithm.
double shown_value(double at, bool logarithmic);
