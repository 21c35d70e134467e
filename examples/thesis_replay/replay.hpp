// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <string>
#include <vector>

namespace thesis {

/// One point: what was measured and what the two models say there.
struct Point {
  double x;          ///< Minutes, or degC where the quantity is a current.
  double measured;   ///< NaN between the measurements.
  double program;    ///< The thesis's program: rounded constants, Euler, its form of eq 4.18.
  double corrected;  ///< The same laws with the constants that the tables give.
};

/// One measured experiment, replayed.
struct Experiment {
  enum class Kind { current, heating, cooling, protection };
  Kind kind;
  std::string motor;         ///< "BGM2606-90T" or "BGM5208-200-12".
  std::string table;         ///< "4.1" ...
  int power_param;           ///< 0 while cooling.
  std::vector<Point> curve;  ///< Dense, for traces and pictures; the measured points are among them.

  /// How far a model is from what was measured.
  struct Distance {
    int points;    ///< Compared: the starting point of a simulation is given, not predicted, and left out.
    double rmse;   ///< Root mean square.
    double worst;  ///< Signed difference model less measurement where it is largest.
  };
  Distance distance(double Point::*model) const;

  bool is_current() const { return kind == Kind::current; }
};

/// Replays every measured experiment of the thesis.
/// @param folder  where table4_1.csv ... table5_4.csv are
/// @param air_C   air temperature of chapter 5, which the text does not give
/// @throws TableError
std::vector<Experiment> replay(const std::string& folder, double air_C);

/// The report: a row per experiment, per motor a summary.
std::string report(const std::vector<Experiment>& experiments);
/// Every curve, a row per point: motor, table, power_param, quantity, x, measured, program, corrected.
std::string traces(const std::vector<Experiment>& experiments);
/// Every experiment as a small picture, on one sheet.
std::string picture(const std::vector<Experiment>& experiments);

}  // namespace thesis
